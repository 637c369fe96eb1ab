#include "work.h"

#include <string.h>

#include "shape.h"
#include "trajectory.h"
#include "units.h"
#include "viterbi.h"

/* The workspace's parts, in the order that LABIAL_WORKSPACE_SIZE counts them. */
typedef struct {
    uint32_t *scores[2];
    uint8_t *back;   /* Viterbi */
    int32_t *solver; /* the same memory, trajectory */
    int16_t *positions;
    uint16_t *component, *share;
    uint8_t *path, *labels;
} workspace_t;

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

int16_t *labial_work_frame(labial_t *stream, unsigned i)
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
                labial_work_frame(stream, i)[k] = (int16_t)(stream->pose[k] * 16);
        stream->held_count = piece->fade_in;
        stream->resumed = 0;
    }
    lay_out(stream, &workspace);
    labial_units_labels(stream, piece, workspace.labels);
    stream->segment = (uint16_t)labial_units_first(stream, piece, &stream->segment_end);
    stream->step = 0;
    stream->stage = LABIAL_STAGE_TARGET;
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
        stream->stage = LABIAL_STAGE_SEARCH;
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
        stream->stage = LABIAL_STAGE_SOLVE;
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
    stream->stage = ++stream->channel == LABIAL_CHANNELS ? LABIAL_STAGE_JOIN : LABIAL_STAGE_SEARCH;
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
        labial_trajectory_fade(labial_work_frame(stream, stream->ready_count), fresh, t + 1u, piece->fade_in + 1u);
        stream->held_count--;
        stream->ready_count++;
    } else {
        memcpy(labial_work_frame(stream, (unsigned)stream->ready_count + stream->held_count), fresh, sizeof fresh);
        if (t + piece->fade_out < piece->length)
            stream->ready_count++;
        else
            stream->held_count++;
    }
    if (++stream->step == piece->length)
        stream->stage = LABIAL_STAGE_FIND;
    return 1;
}

int labial_work_step(labial_t *stream, unsigned *spent)
{
    workspace_t workspace;
    if (stream->stage == LABIAL_STAGE_FIND) {
        *spent += LABIAL_COST_FIND;
        return find_piece(stream);
    }
    lay_out(stream, &workspace);
    switch (stream->stage) {
    case LABIAL_STAGE_TARGET:
        *spent += LABIAL_COST_TARGET;
        set_target(stream, &workspace);
        break;
    case LABIAL_STAGE_SEARCH:
        *spent += LABIAL_COST_SEARCH;
        search(stream, &workspace);
        break;
    case LABIAL_STAGE_SOLVE:
        *spent += LABIAL_COST_SOLVE(stream->piece.length);
        solve(stream, &workspace);
        break;
    default:
        *spent += LABIAL_COST_JOIN;
        if (!join(stream, &workspace))
            return LABIAL_WAITING;
        break;
    }
    return LABIAL_OK;
}
