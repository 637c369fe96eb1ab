/*
 * The stream: one frame in, one frame out.
 *
 *     queue --units--> phoneme --shape--> target --viterbi--> state --trajectory--> motion --> fade --> callback
 *     pushed           one frame, all channels    a third of the channels, three frames        one frame
 *
 * Each tick takes one frame from the queue and finds its target. A state lasts `stride` frames, and so the channels
 * take turns: in each tick those whose turn it is are searched and solved for the frames since their last turn, on to
 * the latest one, and go back from there to the frames that are due. Channel c has its turn every `stride` ticks, c
 * ticks apart from channel 0. So all ticks do alike, and frame t is complete LABIAL_DELAY(stride) ticks after it was
 * taken.
 *
 * Where the model changes, and at the end, the solution ends with the last frame and the next one begins anew; the way
 * back crosses the two without a trace, for rho is one there and kappa zero. Frames that are delivered then fade from
 * the pose that was delivered last, which moves on a little as it did before.
 */
#include <string.h>

#include "fixed.h"
#include "shape.h"
#include "trajectory.h"
#include "units.h"
#include "viterbi.h"

#define MAGIC 0x4c41424cu /* "LABL" */

/* Frames over which what begins anew fades in. */
#define FADE 8u

typedef char labial_limits_are_sound[LABIAL_WINDOW >= 1 && LABIAL_WINDOW <= 48 && LABIAL_LAG >= 0 &&
                                             LABIAL_LAG <= 40 &&
                                             LABIAL_WINDOW + LABIAL_LAG + LABIAL_SEARCH_STRIDE_MAX <= 63 &&
                                             LABIAL_REACH >= 0 && LABIAL_REACH <= 60 &&
                                             LABIAL_QUEUE >= LABIAL_REACH + 2 && LABIAL_QUEUE <= 255 &&
                                             LABIAL_MODELS >= 1 && LABIAL_MODELS <= 255
                                         ? 1
                                         : -1];

uint32_t labial_workspace_size(const labial_model_t *model)
{
    return model ? LABIAL_WORKSPACE_SIZE((uint32_t)model->search_stride) : 0;
}

/* LABIAL_OK for an initialised stream, else the error that every call on it returns. */
static int status(const labial_t *stream)
{
    return !stream ? LABIAL_ERROR_NULL : stream->magic != MAGIC ? LABIAL_ERROR_STATE : LABIAL_OK;
}

/* ---- The workspace ----------------------------------------------------------------------------------------------- */

typedef struct {
    labial_factors_t *factors; /* LABIAL_CHANNELS rings of LABIAL_FACTORS_(stride) */
    labial_track_t *tracks;    /* LABIAL_CHANNELS */
    labial_frame_t *frames;    /* a ring of stride + LABIAL_LAG */
    int16_t *motion;           /* a ring of stride x LABIAL_CHANNELS, Q4 FAP */
} workspace_t;

static workspace_t lay_out(const labial_t *stream)
{
    workspace_t parts;
    const unsigned stride = stream->stride;
    parts.factors = (labial_factors_t *)(void *)stream->workspace;
    parts.tracks = (labial_track_t *)(void *)(parts.factors + LABIAL_CHANNELS * LABIAL_FACTORS_(stride));
    parts.frames = (labial_frame_t *)(void *)(parts.tracks + LABIAL_CHANNELS);
    parts.motion = (int16_t *)(void *)(parts.frames + stride + LABIAL_LAG);
    return parts;
}

/* The place that is `back` places before `place` in a ring of `size`; both below size. */
static unsigned before(unsigned place, unsigned back, unsigned size)
{
    return place >= back ? place - back : place + size - back;
}

static uint8_t after(unsigned place, unsigned size)
{
    return (uint8_t)(place + 1u < size ? place + 1u : 0u);
}

/* ---- Input ------------------------------------------------------------------------------------------------------- */

static void forget_input(labial_t *stream)
{
    const unsigned stride = stream->stride;
    labial_units_forget(&stream->units);
    stream->pending = 0;
    stream->begins[0] = stream->begins[1] = 0;
    stream->ended = stream->begun = stream->resumed = stream->selected = 0;
    stream->entered = stream->beyond = 0;
    stream->phase = (uint8_t)(stride - 1u);
    stream->frame_place = stream->factor_place = 0;
    /* A frame is delivered from the place that it was put into, LABIAL_WINDOW + LABIAL_LAG ticks after its turn. */
    stream->motion_place = (uint8_t)(stride - 1u - (LABIAL_WINDOW + LABIAL_LAG) % stride);
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
    stream->stride = model->search_stride;
    stream->callback = callback;
    stream->user = user;
    stream->workspace = (uint8_t *)workspace;
    stream->magic = MAGIC;
    forget_input(stream);
    return LABIAL_OK;
}

/* Whether the model in `slot` is still needed: for phonemes that are held or frames that are not yet solved. */
static int is_in_use(const labial_t *stream, unsigned slot)
{
    const unsigned size = stream->stride + LABIAL_LAG;
    const labial_frame_t *frames = lay_out(stream).frames;
    unsigned age;
    for (age = 0; age < size && age < stream->entered; age++)
        if (frames[before(stream->frame_place, age, size)].slot == slot)
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
    stream->pending += labial_units_push(&stream->units, phoneme, stream->slot, milliseconds,
                                         model->frames_per_second);
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

/* ---- One frame in -------------------------------------------------------------------------------------------------- */

/* Selects the shape of the phoneme that begins next, if it is known. */
static void select(labial_t *stream)
{
    labial_spoken_t spoken;
    if (!stream->selected && labial_units_next(&stream->units, stream->models, stream->ended, &spoken)) {
        labial_shape_select(stream->models[spoken.slot], spoken.phoneme, spoken.ms, spoken.previous, spoken.next,
                            &stream->next_shape);
        stream->selected = 1;
    }
}

/* Puts the target of a frame that was taken into the ring. */
static void enter(labial_t *stream, const labial_taken_t *taken)
{
    labial_frame_t *frame = &lay_out(stream).frames[stream->frame_place];
    if (taken->is_first) {
        stream->shape = stream->next_shape;
        stream->selected = 0;
    }
    frame->contacts = labial_shape_target(stream->models[taken->slot], &stream->shape, taken, frame->target);
    frame->slot = taken->slot;
    frame->marks = taken->marks;
    if ((taken->marks & LABIAL_BEGINS) && (stream->entered || stream->resumed))
        stream->begins[0] |= 1u;
}

/* Moves on by a tick: takes a frame, or lets those that were taken run out. Returns LABIAL_OK, LABIAL_STARVED, or
 * LABIAL_DONE when nothing is left. */
static int advance(labial_t *stream)
{
    labial_taken_t taken;
    const unsigned stride = stream->stride;
    int result;
    if (labial_units_at_first(&stream->units, stream->models))
        select(stream);
    result = labial_units_take(&stream->units, stream->models, stream->ended, &taken);
    if (result == LABIAL_STARVED || (result == LABIAL_DONE && stream->pending == 0))
        return result;
    stream->phase = after(stream->phase, stride);
    stream->motion_place = after(stream->motion_place, stride);
    stream->factor_place = after(stream->factor_place, LABIAL_FACTORS_(stride));
    stream->frame_place = after(stream->frame_place, stride + LABIAL_LAG);
    stream->begins[1] = stream->begins[1] << 1 | stream->begins[0] >> 31;
    stream->begins[0] <<= 1;
    if (result == LABIAL_OK)
        enter(stream, &taken);
    else
        stream->beyond++;
    if (stream->entered < 255u)
        stream->entered++;
    return LABIAL_OK;
}

/* ---- The channels whose turn it is ------------------------------------------------------------------------------- */

/* One channel in its turn. Frames are told by their age: how many ticks ago they were taken. */
typedef struct {
    const labial_t *stream;
    const labial_frame_t *frames;
    labial_track_t *track;
    labial_factors_t *factors;
    int16_t *motion; /* the channel's, in the ring's first row */
    unsigned channel;
} turn_t;

static const labial_frame_t *frame_of(const turn_t *turn, int age)
{
    const labial_t *stream = turn->stream;
    return &turn->frames[before(stream->frame_place, (unsigned)age, stream->stride + LABIAL_LAG)];
}

static unsigned factor_place(const labial_t *stream, int age)
{
    return before(stream->factor_place, (unsigned)(age - LABIAL_LAG), LABIAL_FACTORS_(stream->stride));
}

/* Searches a state for the turn's frames from `age` on that belong to one solution; returns the age of the last. */
static int search(const turn_t *turn, int age)
{
    const labial_t *stream = turn->stream;
    const labial_frame_t *frame = frame_of(turn, age);
    const labial_model_t *model = stream->models[frame->slot];
    const labial_channel_t *channel = &model->channels[turn->channel];
    const int begins = frame->marks & LABIAL_BEGINS, first = age;
    int seen = (stream->stride - 1) - stream->stride / 2; /* the middle of the turn, if it is one of these */
    unsigned marks = frame->marks;
    int32_t position;
    while (!(marks & LABIAL_ENDS) && age > stream->beyond)
        marks |= frame_of(turn, --age)->marks;
    seen = seen > first ? first : seen < age ? age : seen;
    position = frame_of(turn, seen)->target[turn->channel];
    if (begins)
        labial_viterbi_begin(model, channel, position, &turn->track->search);
    else
        labial_viterbi_step(model, channel, position, &turn->track->search);
    labial_viterbi_span(&turn->track->search, (unsigned)(first - age + 1));
    if (marks & LABIAL_UNIT_ENDS)
        labial_viterbi_end_unit(&turn->track->search);
    return age;
}

/* Takes up the rows of the frames from age `age` to `last`; the search stands at the frame of age `searched`. */
static void solve(const turn_t *turn, int age, int last, int searched)
{
    const labial_t *stream = turn->stream;
    const unsigned size = LABIAL_FACTORS_(stream->stride);
    const labial_frame_t *frame;
    labial_factors_t *before, *own;
    unsigned asked = LABIAL_STATES_MAX;
    labial_ask_t ask = { 0, 0, 0, 0, 0, 0, 0, 0, 0 };
    if (age < last)
        return;
    frame = frame_of(turn, age);
    before = &turn->factors[factor_place(stream, age + 1)];
    own = &turn->factors[factor_place(stream, age)];
    for (;; age--) {
        const unsigned state = labial_viterbi_state(&turn->track->search, (unsigned)(age - searched));
        if (state != asked || (frame->marks & LABIAL_BEGINS))
            labial_trajectory_ask(&stream->models[frame->slot]->channels[turn->channel], state, &ask);
        asked = state;
        labial_trajectory_row(&turn->track->solver, &ask, frame->target[turn->channel],
                              frame->contacts >> turn->channel & 1, frame->marks, before, own);
        if (age == last)
            return;
        before = own;
        if (++own == turn->factors + size)
            own = turn->factors;
        if (++frame == turn->frames + stream->stride + LABIAL_LAG)
            frame = turn->frames;
    }
}

/* Goes back from the newest frame that is factored and puts those that are due into the ring of motion. */
static void go_back(const turn_t *turn, int newest)
{
    const labial_t *stream = turn->stream;
    const int stride = stream->stride, due = LABIAL_WINDOW + LABIAL_LAG + 1;
    const int last = due + stride <= stream->entered ? due + stride - 1 : stream->entered - 1;
    const int first = newest > due ? newest : due;
    if (first <= last)
        labial_trajectory_back(turn->factors, LABIAL_FACTORS_((unsigned)stride), factor_place(stream, newest),
                               (unsigned)(last - newest + 1), (unsigned)(last - first + 1),
                               before(stream->motion_place, (unsigned)(first - due + 1), (unsigned)stride),
                               (unsigned)stride, turn->motion);
}

static void take_turn(const turn_t *turn)
{
    const labial_t *stream = turn->stream;
    const int stride = stream->stride, beyond = stream->beyond, entered = stream->entered;
    const int newest = beyond > LABIAL_LAG ? beyond : LABIAL_LAG; /* whose row is due */
    int age = (stride < entered ? stride : entered) - 1;
    int row = (stride + LABIAL_LAG < entered ? stride + LABIAL_LAG : entered) - 1;
    while (age >= beyond) {
        const int searched = search(turn, age);
        solve(turn, row, searched + LABIAL_LAG, searched);
        row = row < searched + LABIAL_LAG ? row : searched + LABIAL_LAG - 1;
        age = searched - 1;
    }
    solve(turn, row, newest, beyond);
    go_back(turn, beyond > LABIAL_LAG || (frame_of(turn, newest)->marks & LABIAL_ENDS) ? newest : newest + 1);
}

static void take_turns(const labial_t *stream)
{
    const workspace_t parts = lay_out(stream);
    turn_t turn;
    turn.stream = stream;
    turn.frames = parts.frames;
    for (turn.channel = stream->phase; turn.channel < LABIAL_CHANNELS; turn.channel += stream->stride) {
        turn.track = &parts.tracks[turn.channel];
        turn.factors = parts.factors + turn.channel * LABIAL_FACTORS_(stream->stride);
        turn.motion = parts.motion + turn.channel;
        take_turn(&turn);
    }
}

/* ---- One frame out ----------------------------------------------------------------------------------------------- */

/* Q4 to whole FAP units. */
static void deliver(labial_t *stream, const int16_t motion[LABIAL_CHANNELS])
{
    int16_t faps[LABIAL_CHANNELS];
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        faps[k] = (int16_t)((motion[k] + 8) >> 4);
    stream->callback(stream->user, stream->frame, faps);
    stream->frame++;
}

/* Begins to fade: the pose delivered last is held, and moves on as far as the last frame moved it, half as far with
 * each frame. */
static void begin_fade(labial_t *stream)
{
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++) {
        stream->earlier[k] = (int16_t)(stream->fade_step == 0 ? stream->pose[k] - stream->earlier[k] : 0);
        stream->held[k] = stream->pose[k];
    }
    stream->fade_step = 1;
}

/* Delivers the frame that is due, if there is one yet; returns whether there was. */
static int deliver_due(labial_t *stream)
{
    const unsigned delay = LABIAL_DELAY(stream->stride);
    const int16_t *motion = lay_out(stream).motion + stream->motion_place * LABIAL_CHANNELS;
    unsigned k;
    if (stream->entered <= delay)
        return 0;
    if (stream->begins[delay / 32u] >> (delay % 32u) & 1u)
        begin_fade(stream);
    for (k = 0; k < LABIAL_CHANNELS; k++) {
        int32_t value = motion[k];
        if (stream->fade_step) {
            const int32_t held = stream->held[k] + stream->earlier[k] - (stream->earlier[k] >> stream->fade_step);
            value = held + (((value - held) * labial_ease(stream->fade_step, FADE + 1u) + 8192) >> 14);
        } else {
            stream->earlier[k] = stream->begun ? stream->pose[k] : (int16_t)value; /* nothing moved to a first frame */
        }
        stream->pose[k] = (int16_t)labial_clamp(value, INT16_MAX);
    }
    if (stream->fade_step && ++stream->fade_step > FADE) {
        stream->fade_step = 0;
        memcpy(stream->earlier, stream->pose, sizeof stream->earlier);
    }
    stream->pending--;
    stream->begun = 1;
    deliver(stream, stream->pose);
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

static void deliver_eased(labial_t *stream)
{
    int16_t motion[LABIAL_CHANNELS];
    stream->ease_step++;
    eased(stream, motion);
    if (stream->ease_step == stream->ease_length) {
        stream->ease_length = 0;
        memset(stream->pose, 0, sizeof stream->pose);
    }
    deliver(stream, motion);
}

int labial_tick(labial_t *stream)
{
    int result = status(stream);
    if (result != LABIAL_OK)
        return result;
    if (stream->ease_length) {
        deliver_eased(stream);
        return LABIAL_OK;
    }
    result = advance(stream);
    if (result == LABIAL_OK) {
        take_turns(stream);
        if (stream->phase > 0) /* the first turn has most channels; what is selected is the same at any time */
            select(stream);
        if (deliver_due(stream))
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
    if (stream->ease_length) /* cancelled again on the way */
        eased(stream, stream->pose);
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
    stream->resumed = stream->frame > 0;
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
