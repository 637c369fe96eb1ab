/*
 * stream.c - the calls of labial.h: one frame in, one frame out.
 *
 *     queue --units--> phoneme --shape--> target --viterbi--> state --trajectory--> motion --output--> callback
 *     pushed           one frame, all channels    a third of the channels, three frames    one frame
 *
 * Each tick takes one frame from the queue and finds its target, searches and solves the channels that are next
 * (channels.c), and delivers the frame that is due.
 *
 * Where the model changes, and at the end, the solution ends with the last frame and the next one begins anew; the
 * backward pass does not couple the two, for rho is one there and kappa zero. Frames that are delivered then fade from
 * the pose that was delivered last, which moves on a little as it did before.
 */
#include <string.h>

#include "channels.h"
#include "fixed.h"
#include "shape.h"
#include "trajectory.h"
#include "units.h"

#define MAGIC 0x4c41424cu /* "LABL" */

/* Frames over which a solution that begins anew fades in. */
#define FADE 8u

/* Percent by which the articulation changes from frame to frame, at most. */
#define SLEW 10

uint32_t labial_workspace_size(const labial_model_t *model)
{
    return model ? LABIAL_WORKSPACE_SIZE((uint32_t)model->search_stride) : 0;
}

/* LABIAL_OK for an initialised stream, else the error that every call on it returns. */
static int status(const labial_t *stream)
{
    return !stream ? LABIAL_ERROR_NULL : stream->magic != MAGIC ? LABIAL_ERROR_STATE : LABIAL_OK;
}

/* ---- One frame in ------------------------------------------------------------------------------------------------ */

/* Does up to `halves` of selecting the shape of the phoneme that begins next, if all that it depends on is known. */
static void select_halves(labial_t *stream, unsigned halves)
{
    labial_spoken_t spoken;
    for (; halves > 0 && stream->next.halves < 2u; halves--)
        if (labial_units_next(&stream->units, stream->models, stream->ended, &spoken))
            labial_shape_select(stream->models[spoken.slot], spoken.phoneme, spoken.ms, spoken.previous, spoken.next,
                                &stream->next);
}

/* Percent in 1/LABIAL_GAIN_ONE, rounded: times 2.56, which is 5243 / 2^11. */
static int32_t gain_of(unsigned percent)
{
    return (int32_t)((percent * 5243u + 1024u) >> 11);
}

/* Stores a frame that was taken, and its target. */
static void store(labial_t *stream, const labial_taken_t *taken)
{
    labial_frame_t *frame = labial_channels_enter(&stream->channels, stream->models, taken->slot);
    if (taken->is_first) {
        stream->shape = stream->next.shape;
        stream->next.halves = 0;
    }
    frame->contacts = labial_shape_target(stream->models[taken->slot], &stream->shape, taken, frame->target);
    frame->marks = taken->marks;
    stream->articulation =
        (uint8_t)(stream->articulation + labial_clamp((int32_t)stream->wanted - stream->articulation, SLEW));
    if ((taken->marks & LABIAL_BEGINS) && (stream->channels.entered > 1u || stream->shown))
        stream->begins[0] |= 1u;
}

/*
 * Advances by a tick: takes the next frame and finds its target or, after the last one, lets those that were taken run
 * out.
 *
 * Returns LABIAL_OK, LABIAL_STARVED when more phonemes must be known, or LABIAL_DONE when nothing is left.
 */
static int take_frame(labial_t *stream)
{
    labial_taken_t taken;
    unsigned i;
    int result;
    result = labial_units_take(&stream->units, stream->models, stream->ended, &taken);
    if (result == LABIAL_STARVED || (result == LABIAL_DONE && stream->pending == 0))
        return result;
    for (i = LABIAL_BEGINS_WORDS_; --i > 0;)
        stream->begins[i] = stream->begins[i] << 1 | stream->begins[i - 1u] >> 31;
    stream->begins[0] <<= 1;
    if (result == LABIAL_OK)
        store(stream, &taken);
    else
        labial_channels_run_out(&stream->channels);
    return LABIAL_OK;
}

/* ---- One frame out ----------------------------------------------------------------------------------------------- */

/* Q4 to whole FAP units. */
static void call_back(labial_t *stream, const int16_t motion[LABIAL_CHANNELS])
{
    int16_t faps[LABIAL_CHANNELS];
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        faps[k] = (int16_t)((motion[k] + 8) >> 4);
    stream->shown = 1;
    stream->callback(stream->user, stream->frame++, faps); /* last: it may call anything */
}

/* Begins to fade from the pose that was delivered last, which moves on as far as the last frame moved it, half as far
 * with each frame. */
static void begin_fade(labial_t *stream)
{
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++) {
        stream->earlier[k] = (int16_t)(stream->fade_step == 0 ? stream->pose[k] - stream->earlier[k] : 0);
        stream->faded[k] = stream->pose[k];
    }
    stream->fade_step = 1;
}

/* Delivers the frame that is due; returns whether one is. */
static int deliver(labial_t *stream)
{
    const unsigned delay = LABIAL_DELAY(stream->channels.stride);
    const int16_t *motion = labial_channels_due(&stream->channels, stream->models);
    unsigned k;
    if (!motion)
        return 0;
    if (stream->begins[delay / 32u] >> (delay % 32u) & 1u)
        begin_fade(stream);
    if (stream->fade_step == 0) {
        for (k = 0; k < LABIAL_CHANNELS; k++) {
            stream->earlier[k] = stream->begun ? stream->pose[k] : motion[k]; /* nothing moved to a first frame */
            stream->pose[k] = motion[k];
        }
    } else {
        const int32_t share = labial_ease(stream->fade_step, FADE + 1u);
        for (k = 0; k < LABIAL_CHANNELS; k++) {
            const int32_t from = stream->faded[k] + stream->earlier[k] - (stream->earlier[k] >> stream->fade_step);
            const int32_t value = from + (((motion[k] - from) * share + 8192) >> 14);
            stream->pose[k] = (int16_t)labial_clamp(value, INT16_MAX);
        }
        if (++stream->fade_step > FADE) {
            stream->fade_step = 0;
            memcpy(stream->earlier, stream->pose, sizeof stream->earlier);
        }
    }
    stream->pending--;
    stream->begun = 1;
    call_back(stream, stream->pose);
    return 1;
}

/* The face at the present step of the way from `pose` to the neutral one. */
static void eased(const labial_t *stream, int16_t motion[LABIAL_CHANNELS])
{
    const int32_t left = 16384 - labial_ease(stream->ease_step, stream->ease_length);
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        motion[k] = (int16_t)((stream->pose[k] * left + 8192) >> 14);
}

/* Delivers the next frame of the way from `pose` to the neutral face. */
static void ease(labial_t *stream)
{
    int16_t motion[LABIAL_CHANNELS];
    stream->ease_step++;
    eased(stream, motion);
    if (stream->ease_step == stream->ease_length) {
        stream->ease_length = 0;
        memset(stream->pose, 0, sizeof stream->pose);
    }
    call_back(stream, motion);
}

/* ---- The calls --------------------------------------------------------------------------------------------------- */

static void reset_input(labial_t *stream)
{
    labial_units_reset(&stream->units);
    labial_channels_reset(&stream->channels);
    stream->pending = 0;
    stream->ended = stream->begun = stream->next.halves = 0;
    stream->articulation = stream->wanted;
    stream->fade_step = 0;
    stream->ease_length = stream->ease_step = 0;
}

int labial_init(labial_t *stream, const labial_model_t *model, void *workspace, size_t size, labial_frame_fn callback,
                void *user)
{
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
    stream->callback = callback;
    stream->user = user;
    stream->wanted = 100;
    labial_channels_init(&stream->channels, model->search_stride, workspace);
    stream->magic = MAGIC;
    reset_input(stream);
    return LABIAL_OK;
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
        model->search_stride != stream->channels.stride)
        return LABIAL_ERROR_RATE;
    for (slot = LABIAL_MODELS; slot-- > 0;) {
        if (stream->models[slot] == model) {
            chosen = slot;
            break;
        }
        if (!labial_channels_uses(&stream->channels, slot) && !labial_units_uses(&stream->units, slot))
            chosen = slot; /* neither frames to be delivered nor phonemes in the queue are of its model */
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
    int must_select, result = status(stream);
    if (result != LABIAL_OK)
        return result;
    if (stream->ease_length) {
        ease(stream);
        return LABIAL_OK;
    }
    must_select = stream->next.halves < 2u && labial_units_at_first(&stream->units, stream->models);
    if (must_select)
        select_halves(stream, 2);
    result = take_frame(stream);
    if (result == LABIAL_OK) {
        labial_channels_step(&stream->channels, stream->models, gain_of(stream->articulation));
        if (stream->channels.phase > 0) { /* the first of a stride's ticks has most channels, and should not have to */
            const int is_last = stream->channels.phase + 1u == stream->channels.stride;
            if (is_last && labial_units_at_first(&stream->units, stream->models))
                select_halves(stream, 2);
            else if (!must_select)
                select_halves(stream, 1);
        }
        if (deliver(stream))
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
    frames = labial_quotient(milliseconds * stream->models[stream->slot]->frames_per_second + 999u, 1000u);
    if (stream->ease_length) /* cancelled again on the way */
        eased(stream, stream->pose);
    reset_input(stream);
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
    reset_input(stream);
    memcpy(stream->earlier, stream->pose, sizeof stream->earlier); /* which is at rest */
    return LABIAL_OK;
}

int labial_articulation(labial_t *stream, unsigned percent)
{
    const int result = status(stream);
    if (result != LABIAL_OK)
        return result;
    stream->wanted = (uint8_t)(percent < LABIAL_ARTICULATION_MAX ? percent : LABIAL_ARTICULATION_MAX);
    if (stream->channels.entered == 0) /* nothing moves yet that could be jolted */
        stream->articulation = stream->wanted;
    return LABIAL_OK;
}

labial_latency_t labial_latency(const labial_t *stream)
{
    labial_latency_t latency = { 0, 0, 0, 0 };
    if (status(stream) == LABIAL_OK) {
        const uint32_t rate = stream->models[stream->slot]->frames_per_second;
        const uint32_t seconds = labial_quotient(stream->pending, rate), rest = stream->pending - seconds * rate;
        latency.milliseconds = seconds * 1000u + labial_quotient(rest * 1000u + rate / 2u, rate);
        latency.frames = stream->pending;
        latency.phonemes = stream->units.count;
        latency.delay = LABIAL_DELAY((unsigned)stream->channels.stride);
    }
    return latency;
}
