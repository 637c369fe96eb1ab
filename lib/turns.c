/*
 * turns.c - the channels whose turn it is: search, solution and way back.
 *
 * A state lasts `stride` frames, and so the channels take turns: in each tick those whose turn it is are searched and
 * solved for the frames since their last turn, up to the latest one, and go back from there to the frames that are due.
 * Channel c has its turn every `stride` ticks, c ticks apart from channel 0. So every tick does about the same work,
 * and a frame is complete LABIAL_DELAY(stride) ticks after it was taken.
 *
 * Frames are named by their age here: how many ticks ago they were taken.
 */
#include "stream.h"
#include "trajectory.h"
#include "units.h"
#include "viterbi.h"

/* One channel in its turn. */
typedef struct {
    const labial_t *stream;
    labial_track_t *track;
    labial_factors_t *factors; /* the channel's ring */
    unsigned channel;
} turn_t;

static const labial_frame_t *frame_of(const labial_t *stream, int age)
{
    return &stream->frames[labial_ring_back(stream->frame_place, (unsigned)age, stream->stride + LABIAL_LAG)];
}

static unsigned factor_place(const labial_t *stream, int age)
{
    return labial_ring_back(stream->factor_place, (unsigned)(age - LABIAL_LAG), LABIAL_FACTORS_(stream->stride));
}

/* Searches a state for the turn's frames from `age` on that belong to one solution; returns the age of the last. */
static int search(const turn_t *turn, int age)
{
    const labial_t *stream = turn->stream;
    const labial_frame_t *frame = frame_of(stream, age);
    const labial_model_t *model = stream->models[frame->slot];
    const labial_channel_t *channel = &model->channels[turn->channel];
    const int begins = frame->marks & LABIAL_BEGINS, first = age;
    int seen = (stream->stride - 1) - stream->stride / 2; /* the middle of the turn, if it is one of these */
    unsigned marks = frame->marks;
    int32_t position;
    while (!(marks & LABIAL_ENDS) && age > stream->beyond)
        marks |= frame_of(stream, --age)->marks;
    seen = seen > first ? first : seen < age ? age : seen;
    position = frame_of(stream, seen)->target[turn->channel];
    if (begins)
        labial_viterbi_begin(model, channel, position, &turn->track->search);
    else
        labial_viterbi_step(model, channel, position, &turn->track->search);
    labial_viterbi_span(&turn->track->search, (unsigned)(first - age + 1));
    if (marks & LABIAL_UNIT_ENDS)
        labial_viterbi_end_unit(&turn->track->search);
    return age;
}

/* The terms of a frame whose state is `state`. */
static void terms_of(const turn_t *turn, const labial_frame_t *frame, unsigned state, labial_terms_t *terms)
{
    labial_trajectory_terms(&turn->stream->models[frame->slot]->channels[turn->channel], state, terms);
}

/* Takes up the rows of the frames from age `age` to `last`; the search stands at the frame of age `searched`. */
static void solve(const turn_t *turn, int age, int last, int searched)
{
    const labial_t *stream = turn->stream;
    const labial_frame_t *const frames_end = stream->frames + stream->stride + LABIAL_LAG, *frame;
    const labial_factors_t *const factors_end = turn->factors + LABIAL_FACTORS_(stream->stride);
    labial_factors_t *previous, *own;
    labial_terms_t terms;
    unsigned current, state;
    if (age < last)
        return;
    frame = frame_of(stream, age);
    previous = &turn->factors[factor_place(stream, age + 1)];
    current = labial_viterbi_state(&turn->track->search, (unsigned)(age - searched));
    terms_of(turn, frame, current, &terms);
    for (;;) {
        own = previous + 1 < factors_end ? previous + 1 : turn->factors;
        labial_trajectory_row(&turn->track->solver, &terms, frame->target[turn->channel],
                              frame->contacts >> turn->channel & 1, frame->marks, previous, own);
        if (age == last)
            return;
        previous = own;
        frame = frame + 1 < frames_end ? frame + 1 : stream->frames;
        state = labial_viterbi_state(&turn->track->search, (unsigned)(--age - searched));
        if (state != current || (frame->marks & LABIAL_BEGINS))
            terms_of(turn, frame, state, &terms);
        current = state;
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
                               labial_ring_back(stream->phase, (unsigned)(first - due + 1), (unsigned)stride),
                               (unsigned)stride, stream->motion + turn->channel);
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
        if (row >= searched + LABIAL_LAG)
            row = searched + LABIAL_LAG - 1;
        age = searched - 1;
    }
    solve(turn, row, newest, beyond);
    if (LABIAL_LAG == 0 || newest < entered) /* else nothing is due yet */
        go_back(turn, beyond > LABIAL_LAG || (frame_of(stream, newest)->marks & LABIAL_ENDS) ? newest : newest + 1);
}

void labial_turns_take(labial_t *stream)
{
    const unsigned size = LABIAL_FACTORS_(stream->stride);
    labial_factors_t *factors = (labial_factors_t *)(void *)(stream->tracks + LABIAL_CHANNELS);
    turn_t turn;
    turn.stream = stream;
    for (turn.channel = stream->phase; turn.channel < LABIAL_CHANNELS; turn.channel += stream->stride) {
        turn.track = &stream->tracks[turn.channel];
        turn.factors = factors + turn.channel * size;
        take_turn(&turn);
    }
}
