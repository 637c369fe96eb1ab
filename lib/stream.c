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
 * the pose that was delivered last (fade.h). When there is no frame to deliver, because the stream is over, was
 * cancelled or waits for phonemes, the face goes to rest; from there, or from where it is on its way, later frames fade
 * in.
 */
#include <string.h>

#include "articulation.h"
#include "channels.h"
#include "fade.h"
#include "fixed.h"
#include "locks.h"
#include "shape.h"
#include "trajectory.h"
#include "units.h"

/* With LABIAL_LOCKS the calls here have other names, and locks.c has theirs. */
#if LABIAL_LOCKS > 0
#define labial_use labial_unlocked_use
#define labial_push labial_unlocked_push
#define labial_room labial_unlocked_room
#define labial_end labial_unlocked_end
#define labial_tick labial_unlocked_tick
#define labial_cancel labial_unlocked_cancel
#define labial_restart labial_unlocked_restart
#define labial_exact labial_unlocked_exact
#define labial_articulation labial_unlocked_articulation
#endif

/* The end of what a tick does with its stream, before it calls the callback. */
#if LABIAL_LOCKS > 1
#define LABIAL_TICK_ENDS(stream) labial_unlock(stream)
#else
#define LABIAL_TICK_ENDS(stream) ((void)0)
#endif

/* FAP units: lips that are no farther apart close in time by themselves. */
#define CLOSED 24

/* LABIAL_OK for an initialised stream, else the error that every call on it returns. */
static int status(const labial_t *stream)
{
    return !stream ? LABIAL_ERROR_NULL : stream->magic != LABIAL_MAGIC_ ? LABIAL_ERROR_STATE : LABIAL_OK;
}

/* ---- One frame in ------------------------------------------------------------------------------------------------ */

/* Does half of selecting the shape of the phoneme that begins next, or with `all` what is left of that, if everything
 * that it depends on is known. */
static void select_more(labial_t *stream, int all)
{
    labial_spoken_t spoken;
    if (stream->next.halves == 2u || !labial_units_next(&stream->units, stream->models, stream->ended, &spoken))
        return;
    do
        labial_shape_select(stream->models[spoken.slot], &spoken, &stream->next);
    while (stream->next.halves < 2u && all);
}

/* Does its share of selecting the shape of the phoneme that begins next. The last of a stride's ticks has the fewest
 * channels, and selects. Where the phoneme begins before that tick, those until then share it; where it begins after
 * the next such tick, both do. */
static void select_ahead(labial_t *stream)
{
    const unsigned stride = stream->channels.stride, wait = stride - 1u - stream->channels.phase;
    const uint32_t left = labial_units_left(&stream->units, stream->models);
    if (wait == 0)
        select_more(stream, left < stride);
    else if (left < wait)
        select_more(stream, left == 0);
}

/* Stores an accepted frame and its target; returns it. */
static const labial_frame_t *store(labial_t *stream, const labial_taken_t *taken)
{
    labial_frame_t *frame = labial_channels_enter(&stream->channels, stream->models, taken->slot);
    labial_articulation_step(&stream->articulation);
    if (taken->is_first) { /* its place is free for the one after it */
        labial_shape_t *const before = stream->shape;
        stream->shape = stream->next.shape;
        stream->next.shape = before;
        stream->next.halves = 0;
    }
    frame->contacts = labial_shape_target(stream->models[taken->slot], stream->shape, taken, frame->target);
    frame->marks = taken->marks;
    return frame;
}

/* Adds a tick to the age of every frame: bit i of `frames` is that of age i, and `newest` that of age 0. */
static void grow_older(uint32_t frames[LABIAL_DELAY_WORDS_], uint32_t newest)
{
    unsigned i;
    for (i = LABIAL_DELAY_WORDS_; --i > 0;)
        frames[i] = frames[i] << 1 | frames[i - 1u] >> 31;
    frames[0] = frames[0] << 1 | newest;
}

/* Whether the frame of an age is among them. */
static int is_among(const uint32_t frames[LABIAL_DELAY_WORDS_], unsigned age)
{
#if LABIAL_DELAY_WORDS_ > 1
    frames += age / 32u;
    age %= 32u;
#endif
    return (int)(*frames >> age & 1u);
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
    uint32_t begins = 0, touches = 0;
    const int result = labial_units_take(&stream->units, stream->models, stream->ended, &taken);
    if (result == LABIAL_OK) {
        const labial_frame_t *const frame = store(stream, &taken);
        begins = (frame->marks & LABIAL_BEGINS) != 0;
        touches = frame->contacts != 0;
    } else if (result == LABIAL_DONE && stream->pending > 0) {
        labial_channels_run_out(&stream->channels);
    } else {
        return result;
    }
    grow_older(stream->begins, begins);
    grow_older(stream->touches, touches);
    return LABIAL_OK;
}

/* ---- One frame out ----------------------------------------------------------------------------------------------- */

/* Delivers the pose, as the next frame or in its place. */
static void call_back(labial_t *stream, unsigned counts)
{
    const uint32_t frame = stream->frame;
    int16_t faps[LABIAL_CHANNELS];
    labial_fade_faps(&stream->fade, faps);
    stream->frame = frame + counts;
    LABIAL_TICK_ENDS(stream);
    stream->callback(stream->user, frame, faps); /* last: it may call anything */
}

unsigned labial_fade_closing(const labial_t *stream, unsigned age, unsigned length, int opening)
{
    unsigned step;
    if (opening <= CLOSED)
        return length;
    for (step = 1; step < length; step++) {
        if (is_among(stream->touches, age))
            return step + 1u;
        if (age-- == 0 || is_among(stream->begins, age))
            break;
    }
    return length;
}

/* Makes the frame that is due the pose to deliver; returns whether one is due. */
static int deliver(labial_t *stream)
{
    int16_t motion[LABIAL_CHANNELS];
    if (!labial_channels_due(&stream->channels, stream->models, motion))
        return 0;
    if (stream->resting || is_among(stream->begins, LABIAL_DELAY(stream->channels.stride))) {
        const unsigned closing = labial_fade_closing(stream, LABIAL_DELAY(stream->channels.stride), LABIAL_FADE_STEPS,
                                                     labial_fade_opening(&stream->fade));
        labial_fade_begin(&stream->fade, LABIAL_FADE_STEPS, closing, !stream->resting);
    }
    labial_fade_to(&stream->fade, motion);
    stream->pending--;
    stream->resting = stream->held = 0;
    stream->begun = 1;
    return 1;
}

/* Makes the next pose of the way to rest the one to deliver; returns whether there is one. */
static int rest(labial_t *stream)
{
    int16_t neutral[LABIAL_CHANNELS];
    if (!stream->resting) {
        if (stream->exact || labial_fade_rests(&stream->fade))
            return 0;
        labial_fade_begin(&stream->fade, LABIAL_EASE_FRAMES, LABIAL_EASE_FRAMES, 0);
        stream->resting = 1;
    }
    if (stream->fade.step == 0)
        return 0;
    memset(neutral, 0, sizeof neutral);
    labial_fade_to(&stream->fade, neutral);
    return 1;
}

/* The same where no frame is due: the face keeps its pose for a while before. */
static int hold_or_rest(labial_t *stream)
{
    if (stream->exact)
        return 0;
    if (stream->resting || stream->held == LABIAL_HOLD_TICKS)
        return rest(stream);
    stream->held++;
    return 0;
}

/* ---- The calls --------------------------------------------------------------------------------------------------- */

static void reset_input(labial_t *stream)
{
    labial_units_reset(&stream->units);
    labial_channels_reset(&stream->channels);
    stream->pending = 0;
    stream->ended = stream->begun = stream->next.halves = 0;
    stream->held = 0;
    stream->articulation.present = stream->articulation.wanted;
}

int labial_init(labial_t *stream, const labial_model_t *model, void *workspace, size_t size, labial_frame_fn callback,
                void *user)
{
    unsigned width; /* channels that the workspace has room for */
    if (!stream)
        return LABIAL_ERROR_NULL;
    stream->magic = 0;
    if (!model || !workspace || !callback)
        return LABIAL_ERROR_NULL;
    if (model->format != LABIAL_MODEL_FORMAT)
        return LABIAL_ERROR_VERSION;
    if ((uintptr_t)workspace & 3u)
        return LABIAL_ERROR_WORKSPACE;
    for (width = LABIAL_CHANNELS; LABIAL_WORKSPACE_SIZE((uint32_t)model->search_stride, width) > size; width--)
        if (width == model->channel_count)
            return LABIAL_ERROR_WORKSPACE;
    memset(stream, 0, sizeof *stream);
    stream->models[0] = model;
    stream->callback = callback;
    stream->user = user;
    stream->articulation.wanted = 100;
    stream->resting = 1;
    stream->shape = labial_channels_init(&stream->channels, model->search_stride, width, workspace);
    stream->next.shape = stream->shape + width;
    stream->magic = LABIAL_MAGIC_;
    reset_input(stream);
    return LABIAL_OK;
}

int labial_use(labial_t *stream, const labial_model_t *model)
{
    unsigned slot;
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
        return LABIAL_ERROR_FRAME_RATE;
    if (model->channel_count > stream->channels.width)
        return LABIAL_ERROR_WORKSPACE;
    for (slot = 0; slot < LABIAL_MODELS && stream->models[slot] != model; slot++)
        continue;
    if (slot == LABIAL_MODELS) { /* none yet: the first place whose model is no longer used */
        for (slot = 0; slot < LABIAL_MODELS && labial_units_uses(&stream->units, slot, stream->pending); slot++)
            continue;
        if (slot == LABIAL_MODELS)
            return LABIAL_ERROR_MODELS;
    }
    stream->models[slot] = model;
    stream->slot = (uint8_t)slot;
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
    stream->held = 0;
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
    int is_late, is_due = 0, has_pose = 0, result = status(stream);
    if (result != LABIAL_OK)
        return result;
    is_late = stream->next.halves < 2u && labial_units_left(&stream->units, stream->models) == 0;
    if (is_late) /* it was not known before what it depends on */
        select_more(stream, 1);
    result = take_frame(stream);
    if (result == LABIAL_OK) {
        labial_channels_step(&stream->channels, stream->models, labial_articulation_gain(&stream->articulation));
        if (!is_late)
            select_ahead(stream);
        has_pose = is_due = deliver(stream);
    }
    if (result == LABIAL_DONE) {
        has_pose = is_due = rest(stream);
        if (is_due)
            result = LABIAL_OK;
    } else if (!is_due) {
        result = stream->begun ? LABIAL_STARVED : LABIAL_WAITING;
        has_pose = hold_or_rest(stream);
    }
    if (has_pose)
        call_back(stream, (unsigned)is_due);
    else
        LABIAL_TICK_ENDS(stream);
    return result;
}

int labial_cancel(labial_t *stream, uint32_t milliseconds)
{
    unsigned frames;
    const int result = status(stream);
    if (result != LABIAL_OK)
        return result;
    if (!LABIAL_PAPER) /* labial_visemes() goes on from the frame that was delivered */
        labial_units_go_back(&stream->units, stream->pending - stream->units.frames);
    reset_input(stream);
    stream->ended = stream->resting = 1;
    frames = labial_fade_frames(milliseconds, stream->models[stream->slot]->frames_per_second);
    labial_fade_begin(&stream->fade, frames, frames, 0);
    return LABIAL_OK;
}

int labial_restart(labial_t *stream)
{
    const int result = status(stream);
    if (result != LABIAL_OK)
        return result;
    if (!stream->ended || stream->pending)
        return LABIAL_ERROR_STATE;
    reset_input(stream);
    if (!stream->resting)
        labial_fade_begin(&stream->fade, 1, 1, 0); /* which goes nowhere: the face stays where it is */
    return LABIAL_OK;
}

int labial_exact(labial_t *stream, int exact)
{
    const int result = status(stream);
    if (result == LABIAL_OK)
        stream->exact = exact != 0;
    return result;
}

int labial_articulation(labial_t *stream, unsigned percent)
{
    const int result = status(stream);
    if (result == LABIAL_OK)
        labial_articulation_set(&stream->articulation, percent, stream->channels.entered == 0);
    return result;
}
