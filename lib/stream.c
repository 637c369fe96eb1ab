/*
 * stream.c - the calls of labial.h: one frame in, one frame out.
 *
 *     queue --units--> phoneme --shape--> target --viterbi--> state --trajectory--> motion --output--> callback
 *     pushed           one frame, all channels    a third of the channels, three frames    one frame
 *
 * Each tick takes one frame from the queue and finds its target (input.c), searches and solves the channels whose turn
 * it is (turns.c), and delivers the frame that is due (output.c).
 *
 * Where the model changes, and at the end, the solution ends with the last frame and the next one begins anew; the way
 * back crosses the two without a trace, for rho is one there and kappa zero. Frames that are delivered then fade from
 * the pose that was delivered last, which moves on a little as it did before.
 */
#include <string.h>

#include "stream.h"
#include "units.h"

#define MAGIC 0x4c41424cu /* "LABL" */

uint32_t labial_workspace_size(const labial_model_t *model)
{
    return model ? LABIAL_WORKSPACE_SIZE((uint32_t)model->search_stride) : 0;
}

/* LABIAL_OK for an initialised stream, else the error that every call on it returns. */
static int status(const labial_t *stream)
{
    return !stream ? LABIAL_ERROR_NULL : stream->magic != MAGIC ? LABIAL_ERROR_STATE : LABIAL_OK;
}

/* ---- Input ------------------------------------------------------------------------------------------------------- */

static void forget_input(labial_t *stream)
{
    labial_units_forget(&stream->units);
    stream->pending = 0;
    stream->begins[0] = stream->begins[1] = 0;
    stream->ended = stream->begun = stream->selected = 0;
    stream->entered = stream->beyond = 0;
    stream->phase = (uint8_t)(stream->stride - 1u);
    stream->frame_place = stream->factor_place = 0;
    stream->fade_step = 0;
    stream->ease_length = stream->ease_step = 0;
}

int labial_init(labial_t *stream, const labial_model_t *model, void *workspace, size_t size, labial_frame_fn callback,
                void *user)
{
    labial_factors_t *factors;
    if (!stream)
        return LABIAL_ERROR_NULL;
    stream->magic = 0;
    if (!model || !workspace || !callback)
        return LABIAL_ERROR_NULL;
    if (model->format != LABIAL_MODEL_FORMAT)
        return LABIAL_ERROR_VERSION;
    if (((uintptr_t)workspace & 3u) || size < labial_workspace_size(model))
        return LABIAL_ERROR_WORKSPACE;
    memset(stream, 0, sizeof *stream);
    stream->models[0] = model;
    stream->stride = model->search_stride;
    stream->callback = callback;
    stream->user = user;
    stream->tracks = (labial_track_t *)workspace;
    factors = (labial_factors_t *)(void *)(stream->tracks + LABIAL_CHANNELS);
    stream->frames = (labial_frame_t *)(void *)(factors + LABIAL_CHANNELS * LABIAL_FACTORS_((unsigned)stream->stride));
    stream->motion = (int16_t *)(void *)(stream->frames + stream->stride + LABIAL_LAG);
    stream->magic = MAGIC;
    forget_input(stream);
    return LABIAL_OK;
}

/* Whether the model in `slot` is still needed: for phonemes in the queue or frames that are not yet solved. */
static int is_in_use(const labial_t *stream, unsigned slot)
{
    const unsigned size = stream->stride + LABIAL_LAG;
    unsigned age;
    for (age = 0; age < size && age < stream->entered; age++)
        if (stream->frames[labial_ring_back(stream->frame_place, age, size)].slot == slot)
            return 1;
    return labial_units_hold(&stream->units, slot);
}

int labial_use(labial_t *stream, const labial_model_t *model)
{
    unsigned slot, chosen = LABIAL_MODELS;
    const int result = status(stream);
    if (result != LABIAL_OK)
        return result;
    if (!model)
        return LABIAL_ERROR_NULL;
    if (stream->ended)
        return LABIAL_ERROR_STATE;
    if (model->format != LABIAL_MODEL_FORMAT)
        return LABIAL_ERROR_VERSION;
    if (model->frames_per_second != stream->models[stream->slot]->frames_per_second ||
        model->search_stride != stream->stride)
        return LABIAL_ERROR_RATE;
    for (slot = LABIAL_MODELS; slot-- > 0;) {
        if (stream->models[slot] == model) {
            chosen = slot;
            break;
        }
        if (!stream->models[slot] || !is_in_use(stream, slot))
            chosen = slot;
    }
    if (chosen == LABIAL_MODELS)
        return LABIAL_ERROR_MODELS;
    stream->models[chosen] = model;
    stream->slot = (uint8_t)chosen;
    return LABIAL_OK;
}

int labial_push(labial_t *stream, unsigned phoneme, uint32_t milliseconds)
{
    const labial_model_t *model;
    const int result = status(stream);
    if (result != LABIAL_OK)
        return result;
    if (stream->ended)
        return LABIAL_ERROR_STATE;
    model = stream->models[stream->slot];
    if (phoneme >= model->phoneme_count)
        return LABIAL_ERROR_PHONEME;
    if (milliseconds > LABIAL_DURATION_MAX)
        return LABIAL_ERROR_DURATION;
    if (stream->units.count == LABIAL_QUEUE)
        return LABIAL_ERROR_FULL;
    stream->pending += labial_units_push(&stream->units, phoneme, stream->slot, milliseconds, model->frames_per_second);
    return LABIAL_OK;
}

unsigned labial_room(const labial_t *stream)
{
    return status(stream) == LABIAL_OK && !stream->ended ? LABIAL_QUEUE - (unsigned)stream->units.count : 0;
}

int labial_end(labial_t *stream)
{
    const int result = status(stream);
    if (result == LABIAL_OK)
        stream->ended = 1;
    return result;
}

int labial_tick(labial_t *stream)
{
    int result = status(stream);
    if (result != LABIAL_OK)
        return result;
    if (stream->ease_length) {
        labial_output_ease(stream);
        return LABIAL_OK;
    }
    result = labial_input_advance(stream);
    if (result == LABIAL_OK) {
        labial_turns_take(stream);
        if (stream->phase > 0) /* the first turn has most channels; what is selected is the same at any time */
            labial_input_select(stream);
        if (labial_output_deliver(stream))
            return LABIAL_OK;
    }
    return result == LABIAL_DONE ? LABIAL_DONE : stream->begun ? LABIAL_STARVED : LABIAL_WAITING;
}

int labial_cancel(labial_t *stream, uint32_t milliseconds)
{
    uint32_t frames;
    const int result = status(stream);
    if (result != LABIAL_OK)
        return result;
    if (milliseconds > LABIAL_DURATION_MAX)
        milliseconds = LABIAL_DURATION_MAX;
    frames = (milliseconds * stream->models[stream->slot]->frames_per_second + 999u) / 1000u;
    labial_output_stop_easing(stream); /* cancelled again on the way */
    forget_input(stream);
    stream->ended = 1;
    stream->ease_length = (uint16_t)(frames < 1u ? 1u : frames < 1000u ? frames : 1000u);
    return LABIAL_OK;
}

int labial_restart(labial_t *stream)
{
    const int result = status(stream);
    if (result != LABIAL_OK)
        return result;
    if (!stream->ended || stream->pending || stream->ease_length)
        return LABIAL_ERROR_STATE;
    forget_input(stream);
    memcpy(stream->earlier, stream->pose, sizeof stream->earlier); /* which is at rest */
    return LABIAL_OK;
}

labial_latency_t labial_latency(const labial_t *stream)
{
    labial_latency_t latency = { 0, 0, 0, 0 };
    if (status(stream) == LABIAL_OK) {
        const uint32_t rate = stream->models[stream->slot]->frames_per_second;
        latency.frames = stream->pending;
        latency.milliseconds = stream->pending / rate * 1000u + (stream->pending % rate * 1000u + rate / 2u) / rate;
        latency.phonemes = stream->units.count;
        latency.delay = LABIAL_DELAY((unsigned)stream->stride);
    }
    return latency;
}
