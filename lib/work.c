#include "work.h"

#include <string.h>

#include "fixed.h"
#include "shape.h"
#include "trajectory.h"
#include "units.h"
#include "viterbi.h"

/* The workspace's parts, in the order that LABIAL_WORKSPACE_SIZE counts them. */
typedef struct {
    uint32_t *scores[2];
    uint8_t *back;           /* Viterbi */
    labial_solver_t *solver; /* the same memory, trajectory */
    int32_t *factors;
    int16_t *positions;
    uint8_t *path, *labels;
} workspace_t;

typedef char labial_solver_fits[sizeof(labial_solver_t) == 60 ? 1 : -1]; /* LABIAL_SOLVER_SIZE_ */

static void lay_out(const labial_t *stream, workspace_t *workspace)
{
    /* Scores and back-pointers are laid out for the piece's own model, which may have fewer states than the workspace
     * has room for; what follows them is counted from the end. */
    const unsigned row = stream->models[stream->piece.slot]->state_count + 1u;
    uint8_t *tail = stream->workspace + stream->workspace_size;
    workspace->scores[0] = (uint32_t *)(void *)stream->workspace;
    workspace->scores[1] = workspace->scores[0] + row;
    workspace->back = (uint8_t *)(workspace->scores[1] + row);
    workspace->solver = (labial_solver_t *)(void *)stream->workspace;
    workspace->factors = (int32_t *)(workspace->solver + 1);
    tail -= LABIAL_LABELS_SIZE_; /* path and labels */
    workspace->path = tail;
    workspace->labels = tail + LABIAL_WINDOW;
    workspace->positions = (int16_t *)(void *)(tail - LABIAL_WINDOW * LABIAL_CHANNELS * 2u);
}

int16_t *labial_work_frame(labial_t *stream, unsigned i)
{
    i += stream->ready_head;
    return stream->ready[i < LABIAL_READY + LABIAL_OVERLAP ? i : i - (LABIAL_READY + LABIAL_OVERLAP)];
}

/*
 * How much work ticks do on the piece that was found: that of 1.4 of its frames, or as much more as leaves half a
 * window ready when it is done, which is what the longest next one may take. Never more than that of two, which is
 * always in time, since a piece delivers at least half of its frames.
 */
static uint16_t pace_of(const labial_t *stream)
{
    const labial_piece_t *piece = &stream->piece;
    const unsigned frames = piece->length, stride = stream->models[piece->slot]->search_stride;
    const unsigned channel = (frames + stride - 1u) / stride * LABIAL_COST_SEARCH +
                             (frames / LABIAL_SOLVE_ROWS + frames / LABIAL_SOLVE_FRAMES + 2u) * LABIAL_COST_SOLVE;
    const unsigned all = frames * (LABIAL_COST_TARGET + LABIAL_COST_JOIN) + LABIAL_CHANNELS * channel;
    unsigned ticks = 5u * frames / 7u;
    if (stream->rolling || stream->ready_count >= LABIAL_PREROLL) {
        const unsigned ready = stream->ready_count, delivered = frames - piece->fade_out;
        unsigned most = ready; /* ticks that there are frames for, and that leave half a window */
        if (delivered < LABIAL_WINDOW / 2)
            most = ready + delivered > LABIAL_WINDOW / 2 ? ready + delivered - LABIAL_WINDOW / 2 : 0u;
        if (ticks > most)
            ticks = most > frames / 2u ? most : frames / 2u;
    }
    return (uint16_t)(all / (ticks ? ticks : 1u) + 1u);
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
        piece->fade_in = (uint16_t)(own < LABIAL_OVERLAP ? own : LABIAL_OVERLAP);
        for (i = 0; i < piece->fade_in; i++)
            for (k = 0; k < LABIAL_CHANNELS; k++)
                labial_work_frame(stream, i)[k] = (int16_t)labial_clamp(stream->pose[k] * 16, INT16_MAX);
        stream->held_count = piece->fade_in;
        stream->resumed = 0;
    }
    lay_out(stream, &workspace);
    stream->pace = pace_of(stream);
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
    labial_shape_select(model, phoneme, segment->ms, model->phonemes[previous].viseme_class,
                        model->phonemes[next].viseme_class, stream->shape);
    labial_shape_add_pair(model, phoneme, previous, 0, stream->shape);
    labial_shape_add_pair(model, phoneme, next, 1, stream->shape);
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
    const unsigned last = stream->piece.length - 1u, stride = model->search_stride, step = stream->step++;
    const unsigned begin = step * stride, middle = begin + stride / 2u;
    const int32_t position =
        workspace->positions[(size_t)(middle < last ? middle : last) * LABIAL_CHANNELS + stream->channel];
    if (step == 0)
        labial_viterbi_start(model, channel, position, workspace->scores[0]);
    else
        labial_viterbi_step(model, channel, position, workspace->scores[(step - 1u) & 1u], workspace->scores[step & 1u],
                            workspace->back + (size_t)(step - 1u) * model->state_count);
    if (begin + stride > last) {
        labial_viterbi_path(model, last + 1u, workspace->scores[step & 1u], workspace->back, workspace->path);
        memset(workspace->solver, 0, sizeof *workspace->solver);
        stream->step = 0;
        stream->stage = LABIAL_STAGE_SOLVE;
    }
}

static void solve(labial_t *stream, const workspace_t *workspace)
{
    /* Steps 0 .. length are rows forwards, those after them frames backwards, from the last. */
    const unsigned length = stream->piece.length, step = stream->step, rows = length + 1u, all = rows + length;
    int16_t *positions = workspace->positions + stream->channel;
    unsigned end;
    if (step < rows) {
        end = step + LABIAL_SOLVE_ROWS < rows ? step + LABIAL_SOLVE_ROWS : rows;
        labial_trajectory_forward(workspace->solver, &stream->models[stream->piece.slot]->channels[stream->channel],
                                  workspace->path, length, positions, step, end, workspace->factors);
    } else {
        end = step + LABIAL_SOLVE_FRAMES < all ? step + LABIAL_SOLVE_FRAMES : all;
        labial_trajectory_backward(workspace->solver, workspace->factors, all - step, all - end, positions);
    }
    stream->step = (uint16_t)end;
    if (end == all) {
        stream->step = 0;
        stream->stage = ++stream->channel == LABIAL_CHANNELS ? LABIAL_STAGE_JOIN : LABIAL_STAGE_SEARCH;
    }
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
    if (stream->stage == LABIAL_STAGE_FIND) { /* which ends a tick's work, so that each tick is that of one piece */
        const int result = find_piece(stream);
        *spent = stream->pace;
        return result;
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
        *spent += LABIAL_COST_SOLVE;
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
