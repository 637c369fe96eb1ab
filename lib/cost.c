/*
 * cost.c - what a model and a stream take: work (labial/model.h), memory, time, and the model's bytes
 * (labial/labial.h). It reads what the steps of a stream hold and changes nothing; a program that only plays links none
 * of it.
 */
#include "fixed.h"
#include "locks.h"
#include "units.h"

/* ---- Work -------------------------------------------------------------------------------------------------------- */

/* Each term of a cost is the number of times that a step can occur in one tick, times the most instructions that a
 * Cortex-M0 takes for it, compiled by GCC with -Os or -O2. tests/device/model_cost.c counts them. */
enum {
    PER_TICK = 3200,     /* the queue, floors and contact, fades, the callback's frame */
    PER_TAP = 190,       /* of the kernels, in all channels */
    PER_COMPONENT = 600, /* of a phoneme whose shape is selected, in all channels */
    PER_KNOT = 400,      /* of a pair, in all channels */
    PER_COMPARISON = 20, /* of a binary search */
    PER_SEARCH = 300,    /* of one channel */
    PER_STATE = 100,     /* that is searched */
    PER_TRANSITION = 11, /* into such a state */
    PER_LAG = 60,        /* frame of the lag, in one channel */
    PER_ROW = 650,       /* of equation 3 */
    PER_STEP_BACK = 32   /* of the backward pass */
};

/* Shapes that one tick can select: that of the phoneme that begins, and that of the next. */
#define SELECTED 2u

/* Comparisons of a binary search among `count`. */
static uint32_t comparisons(uint32_t count)
{
    uint32_t result = 0;
    for (; count > 0; count >>= 1)
        result++;
    return result;
}

static uint32_t selection(const labial_model_t *model)
{
    uint32_t most = 0, pairs = 0;
    unsigned p;
    for (p = 0; p < model->phoneme_count; p++)
        if (model->phonemes[p].component_count > most)
            most = model->phonemes[p].component_count;
    if (model->pair_count) /* with the phoneme before and with the one after */
        pairs = 2u * (comparisons(model->pair_count) * PER_COMPARISON + (uint32_t)model->pair_knots * PER_KNOT);
    return most * PER_COMPONENT + pairs;
}

#if LABIAL_PAPER

/* Instructions of one channel in the tick that ends a piece: all its steps, over all states, and all its rows. */
static uint32_t channel_step(const labial_model_t *model, uint32_t stride)
{
    const uint32_t steps = (LABIAL_PIECE + stride - 1u) / stride;
    return steps * (PER_SEARCH + model->state_count * (PER_STATE + 4u * model->predecessor_fours * PER_TRANSITION)) +
           LABIAL_PIECE * (PER_ROW + PER_STEP_BACK);
}

#else

/* Instructions of one channel step: a step of the search, the rows of its frames and one more at the end, the backward
 * pass. */
static uint32_t channel_step(const labial_model_t *model, uint32_t stride)
{
    const uint32_t states = model->state_count < LABIAL_SEARCHED ? model->state_count : LABIAL_SEARCHED;
    return PER_SEARCH + comparisons(model->state_count) * PER_COMPARISON + LABIAL_LAG * PER_LAG +
           states * (PER_STATE + 4u * model->predecessor_fours * PER_TRANSITION) + (stride + 1u) * PER_ROW +
           (LABIAL_WINDOW + 1u + stride) * PER_STEP_BACK;
}

#endif

uint32_t labial_model_cost(const labial_model_t *model)
{
    uint32_t stride, channels;
    if (!model || model->search_stride == 0)
        return 0;
    stride = model->search_stride;
    channels = LABIAL_PAPER ? model->channel_count : (model->channel_count + stride - 1u) / stride;
    return PER_TICK + (uint32_t)model->kernel_taps * PER_TAP + SELECTED * selection(model) +
           channels * channel_step(model, stride);
}

/* ---- Memory, time, the model's bytes ----------------------------------------------------------------------------- */

uint32_t labial_workspace_size(const labial_model_t *model)
{
    return model ? LABIAL_WORKSPACE_SIZE((uint32_t)model->search_stride, model->channel_count) : 0;
}

/* Frames as milliseconds, rounded. */
static uint32_t milliseconds_of_frames(uint32_t frames, uint32_t rate)
{
    const uint32_t seconds = labial_quotient(frames, rate), rest = frames - seconds * rate;
    return seconds * 1000u + labial_quotient(rest * 1000u + rate / 2u, rate);
}

/* Whether the stream is initialised. */
static int is_initialised(const labial_t *stream)
{
    return stream && stream->magic == LABIAL_MAGIC_;
}

labial_latency_t labial_latency(const labial_t *stream)
{
    labial_latency_t latency = { 0, 0, 0, 0, 0 };
    LABIAL_LOCK(stream);
    if (is_initialised(stream)) {
        const uint32_t rate = stream->models[stream->slot]->frames_per_second;
        latency.frames = stream->pending;
        latency.milliseconds = milliseconds_of_frames(latency.frames, rate);
        latency.phonemes = stream->units.count;
        latency.delay = LABIAL_DELAY((unsigned)stream->channels.stride);
        latency.delay_milliseconds = milliseconds_of_frames(latency.delay, rate);
    }
    LABIAL_UNLOCK(stream);
    return latency;
}

int labial_uses(const labial_t *stream, const labial_model_t *model)
{
    int uses = 0;
    unsigned slot;
    LABIAL_LOCK(stream);
    for (slot = 0; is_initialised(stream) && slot < LABIAL_MODELS; slot++)
        uses |= stream->models[slot] == model &&
                (slot == stream->slot || labial_units_uses(&stream->units, slot, stream->pending));
    LABIAL_UNLOCK(stream);
    return uses;
}
