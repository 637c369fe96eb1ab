/*
 * test_stream_steps.c - the stream against its own steps put together by hand: pieces, shapes, targets, paths,
 * trajectories and cross-fades, each of which has a suite of its own.
 *
 * Would catch what those suites cannot see: a neighbour's class taken from the wrong phoneme, a part of the workspace
 * laid over another, a state searched for the target of the wrong frame, a channel's centre forgotten.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "shape.h"
#include "trajectory.h"
#include "units.h"
#include "viterbi.h"

#define COUNT 90
#define MAX_FRAMES 6000

/* A phoneme with a frame of its own. */
typedef struct {
    uint32_t begin, frames, ms;
    uint8_t phoneme, model;
} held_t;

static fixture_model_t rich, laugh, slow;
static fixture_phoneme_t input[COUNT];
static const labial_model_t *models[2];
static held_t held[COUNT];
static unsigned held_count;
static int16_t wanted[MAX_FRAMES][LABIAL_CHANNELS]; /* Q4 FAP */
static uint32_t wanted_count;

static int setup(void **state)
{
    (void)state;
    fixture_rich(&rich);
    fixture_laughter(&laugh);
    fixture_slow(&slow);
    return 0;
}

/* Where every phoneme lies: frames are those of the rounded sum of all durations up to it. */
static void hold(void)
{
    uint64_t ms = 0;
    uint32_t end = 0;
    unsigned i;
    held_count = 0;
    for (i = 0; i < COUNT; i++) {
        const uint32_t begin = end;
        ms += input[i].ms;
        end = (uint32_t)((ms * FIXTURE_RATE * 2 + 1000) / 2000);
        if (end > begin) {
            held_t *h = &held[held_count++];
            h->begin = begin;
            h->frames = end - begin;
            h->ms = input[i].ms < 65535 ? input[i].ms : 65535;
            h->phoneme = input[i].phoneme;
            h->model = input[i].model;
        }
    }
    wanted_count = end;
    assert_true(end <= MAX_FRAMES);
}

/* The i-th phoneme as a model sees it: silence outside the stream and where it is another model's. */
static unsigned seen(long i, unsigned model)
{
    return i < 0 || i >= (long)held_count || held[i].model != model ? models[model]->silence : held[i].phoneme;
}

static unsigned class_of(long i, unsigned model)
{
    return models[model]->phonemes[seen(i, model)].viseme_class;
}

/* Decodes the piece that begins at frame `at` into `out`, in Q4 FAP. */
static void decode(const labial_piece_t *piece, uint32_t at, unsigned model, const uint8_t *labels,
                   int16_t out[][LABIAL_CHANNELS])
{
    static uint32_t scores[2][LABIAL_STATES_MAX + 1];
    static uint8_t back[LABIAL_WINDOW * LABIAL_STATES_MAX], path[LABIAL_WINDOW];
    static int32_t factors[LABIAL_FACTORS * LABIAL_WINDOW];
    const labial_model_t *m = models[model];
    const unsigned stride = m->search_stride, steps = (piece->length + stride - 1) / stride;
    labial_solver_t solver;
    unsigned t, c;
    long i = 0;
    for (t = 0; t < piece->length; t++) {
        int16_t shape[LABIAL_CHANNELS];
        while (held[i].begin + held[i].frames <= at + t)
            i++;
        labial_shape_select(m, seen(i, model), (uint16_t)held[i].ms, class_of(i - 1, model), class_of(i + 1, model),
                            shape);
        labial_shape_add_pair(m, seen(i, model), seen(i - 1, model), 0, shape);
        labial_shape_add_pair(m, seen(i, model), seen(i + 1, model), 1, shape);
        labial_shape_target(m, shape, labels + LABIAL_REACH + t, out[t]);
    }
    for (c = 0; c < LABIAL_CHANNELS; c++) {
        const labial_channel_t *channel = &m->channels[c];
        for (t = 0; t < steps; t++) {
            /* of the frames that share a state, the middle one or the later of two; or the piece's last, if sooner */
            const unsigned middle = t * stride + stride / 2;
            const int16_t target = out[middle < piece->length ? middle : piece->length - 1u][c];
            if (t == 0)
                labial_viterbi_start(m, channel, target, scores[0]);
            else
                labial_viterbi_step(m, channel, target, scores[(t - 1) % 2], scores[t % 2],
                                    back + (t - 1) * m->state_count);
        }
        labial_viterbi_path(m, piece->length, scores[(steps - 1) % 2], back, path);
        memset(&solver, 0, sizeof solver);
        labial_trajectory_forward(&solver, channel, path, piece->length, &out[0][c], 0, piece->length + 1u, factors);
        labial_trajectory_backward(&solver, factors, piece->length, 0, &out[0][c]);
        for (t = 0; t < piece->length; t++)
            out[t][c] = (int16_t)(out[t][c] + channel->centre);
    }
}

/* All pieces of the input, decoded and cross-faded. */
static void decode_all(void)
{
    static uint32_t workspace[LABIAL_WORKSPACE_SIZE(LABIAL_STATES_MAX, 1) / 4];
    static uint8_t labels[LABIAL_WINDOW + 2 * LABIAL_REACH];
    static int16_t out[LABIAL_WINDOW][LABIAL_CHANNELS];
    static labial_t walker;
    labial_piece_t piece;
    uint32_t trimmed = 0;
    unsigned i = 0, current = 0, t;
    int result = LABIAL_OK;
    assert_int_equal(labial_init(&walker, models[0], workspace, sizeof workspace, fixture_record, NULL), LABIAL_OK);
    while (result != LABIAL_DONE) {
        for (; i < COUNT && labial_room(&walker) > 0; i++) {
            if (input[i].model != current)
                assert_int_equal(labial_use(&walker, models[current = input[i].model]), LABIAL_OK);
            assert_int_equal(labial_push(&walker, input[i].phoneme, input[i].ms), LABIAL_OK);
        }
        if (i == COUNT)
            assert_int_equal(labial_end(&walker), LABIAL_OK);
        result = labial_units_next(&walker, &piece);
        if (result == LABIAL_OK) {
            const uint32_t before = walker.queue_frames, at = trimmed + piece.begin;
            labial_units_labels(&walker, &piece, labels);
            decode(&piece, at, walker.models[piece.slot] == models[1] ? 1 : 0, labels, out);
            for (t = 0; t < piece.length; t++) {
                assert_true(at + t < wanted_count);
                if (t < piece.fade_in)
                    labial_trajectory_fade(wanted[at + t], out[t], t + 1u, piece.fade_in + 1u);
                else
                    memcpy(wanted[at + t], out[t], sizeof out[t]);
            }
            labial_units_trim(&walker);
            trimmed += before - walker.queue_frames;
        }
    }
}

static void compare(const char *what, uint32_t seed)
{
    fixture_host_t host;
    uint32_t t;
    unsigned c;
    hold();
    decode_all();
    assert_int_equal(fixture_open(&host, models, 2), LABIAL_OK);
    if (fixture_play(&host, input, COUNT, seed % 2 ? FIXTURE_FILL : FIXTURE_CHANCE) != 0)
        fail_msg("%s: %s", what, host.complaint);
    assert_int_equal(host.recorder.count, wanted_count);
    for (t = 0; t < wanted_count; t++)
        for (c = 0; c < LABIAL_CHANNELS; c++)
            if (abs(host.recorder.frames[t][c] * 16 - wanted[t][c]) > 8) /* rounded to whole FAP units, no more */
                fail_msg("%s, seed %u: frame %u, channel %u is %d, not %d / 16", what, seed, t, c,
                         host.recorder.frames[t][c], wanted[t][c]);
    fixture_close(&host);
}

static void one_model_is_the_sum_of_its_steps(void **state)
{
    int kind;
    uint32_t seed;
    (void)state;
    models[1] = &laugh.model;
    for (kind = 0; kind < FIXTURE_MILLI; kind++) {
        for (seed = 0; seed < 4; seed++) {
            unsigned i;
            models[0] = seed < 3 ? &rich.model : &slow.model;
            fixture_stream(input, COUNT, (fixture_kind_t)kind, seed);
            for (i = 0; kind == FIXTURE_PAUSES && i < COUNT; i++)
                input[i].ms %= 2500;
            compare("one model", seed);
        }
    }
}

/* Every stride there is, of few and of many states: would catch a workspace that is laid out for another. */
static void every_stride_is_the_sum_of_its_steps(void **state)
{
    unsigned stride;
    (void)state;
    models[1] = &laugh.model;
    for (stride = 1; stride <= LABIAL_SEARCH_STRIDE_MAX; stride++) {
        fixture_model_t *const f = stride % 2 ? &rich : &slow;
        const uint8_t own = f->model.search_stride;
        f->model.search_stride = (uint8_t)stride;
        models[0] = &f->model;
        fixture_stream(input, COUNT, FIXTURE_RANDOM, stride);
        compare("strides", stride);
        fixture_stream(input, COUNT, FIXTURE_ONE_FRAME, stride);
        compare("strides", stride);
        f->model.search_stride = own;
    }
}

static void two_models_are_the_sum_of_their_steps(void **state)
{
    fixture_random_t random = {41};
    uint32_t seed;
    unsigned i;
    (void)state;
    models[1] = &laugh.model;
    for (seed = 0; seed < 10; seed++) {
        uint8_t model = 0;
        models[0] = seed % 4 == 3 ? &slow.model : &rich.model; /* strides 2 or 3, and 1 */
        fixture_stream(input, COUNT, seed % 3 ? FIXTURE_RANDOM : FIXTURE_ONE_FRAME, seed);
        for (i = 0; i < COUNT; i++) {
            if (fixture_below(&random, 2 + seed) == 0)
                model = !model;
            input[i].model = model;
            input[i].phoneme = (uint8_t)(input[i].phoneme % (model ? FIXTURE_LAUGH_COUNT : FIXTURE_SPEECH_COUNT));
        }
        compare("two models", seed);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_model_is_the_sum_of_its_steps),
        cmocka_unit_test(every_stride_is_the_sum_of_its_steps),
        cmocka_unit_test(two_models_are_the_sum_of_their_steps),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
