/*
 * The stream: pushes fill the queue (units), work turns it into pieces' trajectories one small step at a time, joining
 * lays these end to end in the ring of ready frames, and ticks play the ring.
 *
 *     queue --FIND--> piece --TARGET--> targets --SEARCH--> path --SOLVE--> trajectory --JOIN--> ring --> callback
 *                              once per frame     once per channel and frame       once per frame
 *
 * Why ticks of equal work suffice: a piece delivers at least half of the frames that it decodes (what it shares with its
 * successor, it does not share with its predecessor), so the work of two decoded frames per tick keeps up on average;
 * and half a window of ready frames bridges the time in which the longest piece is decoded.
 */
#include <string.h>

#include "fixed.h"
#include "shape.h"
#include "trajectory.h"
#include "units.h"
#include "viterbi.h"

#define MAGIC 0x4c41424cu /* "LABL" */

typedef char labial_limits_are_sound[LABIAL_WINDOW >= 4 && LABIAL_WINDOW <= 1000 &&
                                             2 * LABIAL_OVERLAP <= LABIAL_WINDOW && LABIAL_CUT_OVERLAP >= 1 &&
                                             LABIAL_CUT_OVERLAP <= LABIAL_OVERLAP && LABIAL_REACH >= 0 &&
                                             LABIAL_REACH <= 250 && 2 * LABIAL_READY >= LABIAL_WINDOW &&
                                             LABIAL_PREROLL >= 1 && LABIAL_PREROLL <= LABIAL_READY &&
                                             LABIAL_MODELS >= 1 && LABIAL_MODELS <= 255
                                         ? 1
                                         : -1];

enum { STAGE_FIND, STAGE_TARGET, STAGE_SEARCH, STAGE_SOLVE, STAGE_JOIN };

/* What a step of each stage takes, in quarters of a Viterbi step; measured on Cortex-M0. */
#define COST_FIND 1u
#define COST_TARGET 3u
#define COST_SEARCH 4u
#define COST_SOLVE(frames) (1u + (frames) / 2u)
#define COST_JOIN 1u

/* The share of one tick: what the shortest pieces take, two frames of which one is delivered. */
#define TICK_SHARE                                                                  \
    (COST_FIND + 2u * (COST_TARGET + LABIAL_CHANNELS * COST_SEARCH + COST_JOIN) +   \
     LABIAL_CHANNELS * COST_SOLVE(2u))

/* The workspace's parts, in the order that LABIAL_WORKSPACE_SIZE counts them. */
typedef struct {
    uint32_t *scores[2];
    uint8_t *back;   /* Viterbi */
    int32_t *solver; /* the same memory, trajectory */
    int16_t *positions;
    uint16_t *component, *share;
    uint8_t *path, *labels;
} workspace_t;

static uint32_t workspace_size(unsigned states)
{
    return LABIAL_WORKSPACE_SIZE(states);
}

static void lay_out(const labial_t *stream, workspace_t *workspace)
{
    /* Scores and back-pointers are laid out for the piece's own model, which may have fewer states than the workspace
     * has room for; what follows them is counted from the end. */
    const unsigned states = stream->models[stream->piece.slot]->state_count;
    uint8_t *tail = stream->workspace + stream->workspace_size;
    workspace->scores[0] = (uint32_t *)(void *)stream->workspace;
    workspace->scores[1] = workspace->scores[0] + states;
    workspace->solver = (int32_t *)(void *)(workspace->scores[1] + states);
    workspace->back = (uint8_t *)workspace->solver;
    tail -= (LABIAL_WINDOW * 2u + 2u * LABIAL_REACH + 3u) / 4u * 4u;
    workspace->path = tail;
    workspace->labels = tail + LABIAL_WINDOW;
    tail -= LABIAL_WINDOW * 4u;
    workspace->component = (uint16_t *)(void *)tail;
    workspace->share = workspace->component + LABIAL_WINDOW;
    workspace->positions = (int16_t *)(void *)(tail - LABIAL_WINDOW * LABIAL_CHANNELS * 2u);
}

uint32_t labial_workspace_size(const labial_model_t *model)
{
    return model ? workspace_size(model->state_count) : 0;
}

static int is_live(const labial_t *stream)
{
    return stream->magic == MAGIC;
}

/* ---- Input ------------------------------------------------------------------------------------------------------- */

static void forget_input(labial_t *stream)
{
    stream->queue_frames = stream->next_begin = stream->pending = 0;
    stream->queue_head = stream->queue_count = stream->next_fade_in = 0;
    stream->remainder = 500; /* so that frames are those of the rounded sum */
    stream->stage = STAGE_FIND;
    stream->ready_head = stream->ready_count = stream->held_count = 0;
    stream->overspent = 0;
    stream->begun = stream->rolling = 0;
    stream->ended = 0;
    stream->resumed = 0;
    stream->ease_length = stream->ease_step = 0;
}

int labial_init(labial_t *stream, const labial_model_t *model, void *workspace, size_t size, labial_frame_fn callback,
                void *user)
{
    int result;
    if (!stream)
        return LABIAL_ERROR_NULL;
    stream->magic = 0;
    if (!model || !workspace || !callback)
        return LABIAL_ERROR_NULL;
    result = labial_model_check(model);
    if (result != LABIAL_OK)
        return result;
    if (((uintptr_t)workspace & 3u) || size < workspace_size(model->state_count))
        return LABIAL_ERROR_WORKSPACE;
    memset(stream, 0, sizeof *stream);
    stream->models[0] = model;
    stream->callback = callback;
    stream->user = user;
    stream->workspace = (uint8_t *)workspace;
    stream->workspace_size = size < UINT32_MAX ? (uint32_t)size & ~(uint32_t)3 : UINT32_MAX - 3u;
    stream->magic = MAGIC;
    forget_input(stream);
    return LABIAL_OK;
}

/* Whether phonemes of the model in `slot` are still held, or it is being decoded. */
static int is_waited_for(const labial_t *stream, unsigned slot)
{
    unsigned i;
    for (i = 0; i < stream->queue_count; i++)
        if (labial_units_segment(stream, i)->slot == slot)
            return 1;
    return stream->stage != STAGE_FIND && stream->piece.slot == slot;
}

int labial_use(labial_t *stream, const labial_model_t *model)
{
    unsigned slot, chosen = LABIAL_MODELS;
    int result;
    if (!stream || !model)
        return LABIAL_ERROR_NULL;
    if (!is_live(stream) || stream->ended)
        return LABIAL_ERROR_STATE;
    result = labial_model_check(model);
    if (result != LABIAL_OK)
        return result;
    if (model->frames_per_second != stream->models[stream->slot]->frames_per_second)
        return LABIAL_ERROR_RATE;
    if (stream->workspace_size < workspace_size(model->state_count))
        return LABIAL_ERROR_WORKSPACE;
    for (slot = LABIAL_MODELS; slot-- > 0;) {
        if (stream->models[slot] == model) {
            chosen = slot;
            break;
        }
        if (!stream->models[slot] || !is_waited_for(stream, slot))
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
    labial_segment_t segment;
    uint32_t thousandths;
    if (!stream)
        return LABIAL_ERROR_NULL;
    if (!is_live(stream) || stream->ended)
        return LABIAL_ERROR_STATE;
    if (phoneme >= stream->models[stream->slot]->phoneme_count)
        return LABIAL_ERROR_PHONEME;
    if (milliseconds > LABIAL_DURATION_MAX)
        return LABIAL_ERROR_DURATION;
    if (stream->queue_count == LABIAL_QUEUE)
        return LABIAL_ERROR_FULL;
    thousandths = milliseconds * stream->models[stream->slot]->frames_per_second + stream->remainder;
    stream->remainder = (uint16_t)(thousandths % 1000u);
    segment.frames = thousandths / 1000u;
    segment.ms = (uint16_t)(milliseconds < 65535u ? milliseconds : 65535u);
    segment.phoneme = (uint8_t)phoneme;
    segment.slot = stream->slot;
    if (segment.frames > 0)
        labial_units_push(stream, &segment);
    stream->pending += segment.frames;
    return LABIAL_OK;
}

unsigned labial_room(const labial_t *stream)
{
    return stream && is_live(stream) && !stream->ended ? LABIAL_QUEUE - (unsigned)stream->queue_count : 0;
}

int labial_end(labial_t *stream)
{
    if (!stream)
        return LABIAL_ERROR_NULL;
    if (!is_live(stream))
        return LABIAL_ERROR_STATE;
    stream->ended = 1;
    return LABIAL_OK;
}

/* ---- Work -------------------------------------------------------------------------------------------------------- */

/* The frame in the ring that is `i` after the oldest. */
static int16_t *ring_frame(labial_t *stream, unsigned i)
{
    i += stream->ready_head;
    return stream->ready[i < LABIAL_READY + LABIAL_OVERLAP ? i : i - (LABIAL_READY + LABIAL_OVERLAP)];
}

static int find_piece(labial_t *stream)
{
    labial_piece_t *piece = &stream->piece;
    workspace_t workspace;
    unsigned i, k;
    const int result = labial_units_next(stream, piece);
    if (result != LABIAL_OK)
        return result;
    if (stream->resumed) { /* the pose that was held takes the place of an earlier piece */
        const unsigned own = (unsigned)piece->length - piece->fade_out;
        piece->fade_in = (uint16_t)(own < LABIAL_CUT_OVERLAP ? own : LABIAL_CUT_OVERLAP);
        for (i = 0; i < piece->fade_in; i++)
            for (k = 0; k < LABIAL_CHANNELS; k++)
                ring_frame(stream, i)[k] = (int16_t)(stream->pose[k] * 16);
        stream->held_count = piece->fade_in;
        stream->resumed = 0;
    }
    lay_out(stream, &workspace);
    labial_units_labels(stream, piece, workspace.labels);
    stream->segment = (uint16_t)labial_units_first(stream, piece, &stream->segment_end);
    stream->step = 0;
    stream->stage = STAGE_TARGET;
    return LABIAL_OK;
}

/* The phoneme of segment `i` as the piece's model sees it; silence outside the stream. */
static unsigned phoneme_of(const labial_t *stream, unsigned i)
{
    const unsigned slot = stream->piece.slot;
    return i < stream->queue_count ? labial_units_phoneme(stream, labial_units_segment(stream, i), slot)
                                   : stream->models[slot]->silence;
}

/* Selects the shape of the next segment, which is held until that segment ends. */
static void select_shape(labial_t *stream)
{
    const unsigned i = stream->segment++;
    const labial_segment_t *segment = labial_units_segment(stream, i);
    const labial_model_t *model = stream->models[stream->piece.slot];
    const unsigned phoneme = phoneme_of(stream, i), next = phoneme_of(stream, i + 1u),
                   previous = phoneme_of(stream, i > 0 ? i - 1u : LABIAL_QUEUE);
    stream->component = (uint16_t)labial_shape_select(model, phoneme, segment->ms,
                                                      model->phonemes[previous].viseme_class,
                                                      model->phonemes[next].viseme_class, stream->shape);
    labial_shape_add_pair(model, phoneme, previous, 0, stream->shape);
    labial_shape_add_pair(model, phoneme, next, 1, stream->shape);
    stream->share = (uint16_t)(segment->frames > 65536u ? 0u : segment->frames > 1u ? 65536u / segment->frames : 65535u);
    stream->segment_end += segment->frames;
}

static void set_target(labial_t *stream, const workspace_t *workspace)
{
    const labial_model_t *model = stream->models[stream->piece.slot];
    const unsigned t = stream->step;
    while (stream->piece.begin + t >= stream->segment_end)
        select_shape(stream);
    labial_shape_target(model, stream->shape, workspace->labels + LABIAL_REACH + t,
                        workspace->positions + (size_t)t * LABIAL_CHANNELS);
    workspace->component[t] = stream->component;
    workspace->share[t] = stream->share;
    if (++stream->step == stream->piece.length) {
        labial_units_trim(stream);
        stream->stage = STAGE_SEARCH;
        stream->step = 0;
        stream->channel = 0;
    }
}

static void search(labial_t *stream, const workspace_t *workspace)
{
    const labial_model_t *model = stream->models[stream->piece.slot];
    const labial_channel_t *channel = &model->channels[stream->channel];
    const unsigned t = stream->step, states = model->state_count;
    const int32_t position = workspace->positions[(size_t)t * LABIAL_CHANNELS + stream->channel];
    if (t == 0)
        labial_viterbi_start(channel, states, position, workspace->scores[0]);
    else
        labial_viterbi_step(channel, states, position, workspace->scores[(t - 1u) & 1u], workspace->scores[t & 1u],
                            workspace->back + (size_t)(t - 1u) * states);
    if (++stream->step == stream->piece.length) {
        labial_viterbi_path(states, stream->piece.length, workspace->scores[t & 1u], workspace->back,
                            workspace->path);
        stream->stage = STAGE_SOLVE;
    }
}

static void solve(labial_t *stream, const workspace_t *workspace)
{
    const labial_model_t *model = stream->models[stream->piece.slot];
    labial_ties_t ties;
    ties.precisions = model->precisions ? model->precisions + stream->channel : NULL;
    ties.component = workspace->component;
    ties.share = workspace->share;
    labial_trajectory_solve(&model->channels[stream->channel], &ties, workspace->path, stream->piece.length,
                            workspace->positions + stream->channel, workspace->solver);
    stream->step = 0;
    stream->stage = ++stream->channel == LABIAL_CHANNELS ? STAGE_JOIN : STAGE_SEARCH;
}

/* Puts one frame behind those that are ready, unless there is no room; returns whether it did. */
static int join(labial_t *stream, const workspace_t *workspace)
{
    const labial_piece_t *piece = &stream->piece;
    const labial_model_t *model = stream->models[piece->slot];
    const unsigned t = stream->step;
    int16_t fresh[LABIAL_CHANNELS];
    unsigned k;

    if (stream->ready_count == LABIAL_READY)
        return 0;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        fresh[k] = (int16_t)(workspace->positions[(size_t)t * LABIAL_CHANNELS + k] + model->channels[k].centre);
    if (t < piece->fade_in) {
        labial_trajectory_fade(ring_frame(stream, stream->ready_count), fresh, t + 1u, piece->fade_in + 1u);
        stream->held_count--;
        stream->ready_count++;
    } else {
        memcpy(ring_frame(stream, (unsigned)stream->ready_count + stream->held_count), fresh, sizeof fresh);
        if (t + piece->fade_out < piece->length)
            stream->ready_count++;
        else
            stream->held_count++;
    }
    if (++stream->step == piece->length)
        stream->stage = STAGE_FIND;
    return 1;
}

/* One step of work; adds what it took to `spent`. */
static int work(labial_t *stream, unsigned *spent)
{
    workspace_t workspace;
    if (stream->stage == STAGE_FIND) {
        *spent += COST_FIND;
        return find_piece(stream);
    }
    lay_out(stream, &workspace);
    switch (stream->stage) {
    case STAGE_TARGET:
        *spent += COST_TARGET;
        set_target(stream, &workspace);
        break;
    case STAGE_SEARCH:
        *spent += COST_SEARCH;
        search(stream, &workspace);
        break;
    case STAGE_SOLVE:
        *spent += COST_SOLVE(stream->piece.length);
        solve(stream, &workspace);
        break;
    default:
        *spent += COST_JOIN;
        if (!join(stream, &workspace))
            return LABIAL_WAITING;
        break;
    }
    return LABIAL_OK;
}

int labial_work(labial_t *stream)
{
    unsigned spent = 0;
    int result;
    if (!stream)
        return LABIAL_ERROR_NULL;
    if (!is_live(stream))
        return LABIAL_ERROR_STATE;
    if (stream->ease_length)
        return LABIAL_WAITING;
    result = work(stream, &spent);
    return result == LABIAL_DONE && stream->ready_count ? LABIAL_WAITING : result;
}

/* ---- Playing ----------------------------------------------------------------------------------------------------- */

static void deliver(labial_t *stream, const int16_t faps[LABIAL_CHANNELS])
{
    stream->callback(stream->user, stream->frame, faps);
    stream->frame++;
}

static void deliver_ready(labial_t *stream)
{
    const int16_t *frame = ring_frame(stream, 0);
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        stream->pose[k] = (int16_t)((frame[k] + 8) >> 4);
    stream->ready_head = (uint16_t)(stream->ready_head + 1u < LABIAL_READY + LABIAL_OVERLAP ? stream->ready_head + 1u
                                                                                           : 0u);
    stream->ready_count--;
    stream->pending--;
    stream->begun = 1;
    deliver(stream, stream->pose);
}

/* One frame from `pose` to the neutral face along 3 s^2 - 2 s^3, which starts and ends without a jolt. */
static void deliver_eased(labial_t *stream)
{
    const uint32_t s = ((uint32_t)++stream->ease_step << 10) / stream->ease_length;
    const int32_t gone = (int32_t)((s * s * (3072u - 2u * s)) >> 20); /* Q10 */
    const int last = stream->ease_step == stream->ease_length;
    int16_t faps[LABIAL_CHANNELS];
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        faps[k] = (int16_t)((stream->pose[k] * (1024 - gone) + 512) >> 10);
    if (last) {
        stream->ease_length = 0;
        memset(stream->pose, 0, sizeof stream->pose);
    }
    deliver(stream, faps);
}

int labial_tick(labial_t *stream)
{
    unsigned spent;
    int result = LABIAL_OK;
    if (!stream)
        return LABIAL_ERROR_NULL;
    if (!is_live(stream))
        return LABIAL_ERROR_STATE;
    if (stream->ease_length) {
        deliver_eased(stream);
        return LABIAL_OK;
    }
    for (spent = stream->overspent; spent < TICK_SHARE && result == LABIAL_OK;)
        result = work(stream, &spent);
    stream->overspent = (uint16_t)(spent > TICK_SHARE ? spent - TICK_SHARE : 0u);

    if (stream->ready_count >= LABIAL_PREROLL || (stream->ready_count && result != LABIAL_OK))
        stream->rolling = 1;
    if (stream->rolling && stream->ready_count) {
        deliver_ready(stream);
        return LABIAL_OK;
    }
    stream->rolling = 0;
    if (result == LABIAL_OK)
        return LABIAL_BUSY;
    if (result == LABIAL_WAITING && stream->begun)
        return LABIAL_STARVED;
    return result;
}

int labial_cancel(labial_t *stream, uint32_t milliseconds)
{
    uint32_t frames;
    if (!stream)
        return LABIAL_ERROR_NULL;
    if (!is_live(stream))
        return LABIAL_ERROR_STATE;
    if (milliseconds > LABIAL_DURATION_MAX)
        milliseconds = LABIAL_DURATION_MAX;
    frames = (milliseconds * stream->models[stream->slot]->frames_per_second + 999u) / 1000u;
    forget_input(stream);
    stream->ended = 1;
    stream->ease_length = (uint16_t)(frames < 1u ? 1u : frames < 1000u ? frames : 1000u);
    return LABIAL_OK;
}

int labial_restart(labial_t *stream)
{
    if (!stream)
        return LABIAL_ERROR_NULL;
    if (!is_live(stream) || !stream->ended || stream->pending || stream->ease_length)
        return LABIAL_ERROR_STATE;
    forget_input(stream);
    stream->resumed = stream->frame > 0;
    return LABIAL_OK;
}

labial_latency_t labial_latency(const labial_t *stream)
{
    labial_latency_t latency = { 0, 0, 0, 0 };
    if (stream && is_live(stream)) {
        const uint32_t rate = stream->models[stream->slot]->frames_per_second;
        latency.frames = stream->pending;
        latency.milliseconds = stream->pending / rate * 1000u + (stream->pending % rate * 1000u + rate / 2u) / rate;
        latency.phonemes = stream->queue_count;
        latency.ready = stream->ready_count;
    }
    return latency;
}
