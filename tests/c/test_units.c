/*
 * test_units.c - phonemes to frames: random streams against oracle_steps.c, which expands the whole of its input at once,
 * and by hand what that leaves out.
 */
#include "suite.h"
#include "oracle.h"
#include "units.h"

#define COUNT 300
#define MANY 20000

static fixture_model_t plain, rich, laugh;
static labial_model_t floored, near; /* the rich one without kernels; one that sees a single frame ahead */
static labial_units_t units;
static const labial_model_t *models[LABIAL_MODELS > 1 ? LABIAL_MODELS : 2];
static fixture_phoneme_t input[COUNT];
static oracle_frame_t wanted[MANY];

SETUP(setup)
{
    fixture_plain(&plain);
    fixture_rich(&rich);
    fixture_laughter(&laugh);
    floored = rich.model;
    floored.kernel_taps = floored.kernel_behind = 0;
    near = floored;
    near.kernel_taps = LABIAL_REACH >= 1 ? 2 : 0;
    near.kernel_stride = 1;
    near.floor_count = 0;
    return 0;
}

static void begin(const labial_model_t *model)
{
    memset(&units, 0xa5, sizeof units);
    labial_units_reset(&units);
    memset(units.since, 0, sizeof units.since); /* as labial_init() makes them; a reset leaves them */
    models[0] = model;
    models[1] = &laugh.model;
}

/* `frames` frames of a phoneme of model 0 or 1. */
static void push(unsigned phoneme, unsigned slot, uint32_t frames)
{
    assert_int_equal(labial_units_push(&units, phoneme, slot, frames * 1000 / FIXTURE_RATE, FIXTURE_RATE), frames);
}

/* Random phonemes of one or two models. */
static void compose(int kind, uint32_t seed)
{
    fixture_random_t random = { seed + 100 };
    uint8_t current = 0;
    fixture_stream(input, COUNT, (fixture_kind_t)kind, seed);
    for (unsigned i = 0; i < COUNT; i++) {
        if (LABIAL_MODELS > 1 && i > 0 && seed % 2 && fixture_below(&random, 1 + seed % 6) == 0)
            current = !current;
        input[i].model = current;
        input[i].phoneme = (uint8_t)(input[i].phoneme % (current ? FIXTURE_LAUGH_COUNT : FIXTURE_SPEECH_COUNT));
        input[i].ms %= 1500;
        if (seed % 5 == 4) /* many short ones, some of no frame */
            input[i].ms %= 50;
    }
}

static unsigned long compared, waits, cuts, open, rested;

/* Where the frame lies in its phoneme, whether a contact is open there, how far the mouth came to rest. */
static void check_place(const labial_taken_t *taken, const oracle_frame_t *frame)
{
    assert_near(taken->share, 16384 * ((double)frame->number + 0.5) / (double)frame->whole, 1.6);
    if (frame->phoneme != models[frame->model]->silence) {
        assert_int_equal(taken->is_open, !oracle_is_made(frame->number, frame->whole));
        open += taken->is_open;
    }
    assert_int_equal(taken->rest, frame->rest);
    rested += frame->rest == 16;
}

/* What begins with the first of the frames from `at` on that begins a phoneme; whenever it is told, it must be right, and
 * before that frame is taken it must be told. */
static void compare_next(size_t at, size_t count, int ended, int must)
{
    labial_spoken_t spoken;
    const int told = labial_units_next(&units, models, ended, &spoken);
    const oracle_frame_t *frame;
    uint32_t left = 0;
    assert_in_range(told, 0, 1);
    while (at + left < count && !wanted[at + left].is_first)
        left++;
    assert_true(units.count == 0 || at + left == count || labial_units_left(&units, models) == left);
    assert_true(told || !must || !wanted[at].is_first);
    while (at < count && !wanted[at].is_first)
        at++;
    if (!told)
        return;
    assert_true(at < count);
    frame = &wanted[at];
    assert_int_equal(spoken.slot, frame->model);
    assert_int_equal(spoken.phoneme, frame->phoneme);
    assert_int_equal(spoken.previous, frame->previous);
    assert_int_equal(spoken.next, frame->next);
    assert_int_equal(spoken.ms, frame->ms);
}

/* What is taken must be the oracle's frame `at`. */
static void compare(const labial_taken_t *taken, size_t at, size_t count)
{
    const oracle_frame_t *frame = &wanted[at];
    const labial_model_t *model = models[frame->model];
    const unsigned marks = (frame->begins ? LABIAL_BEGINS : 0u) | (frame->ends ? LABIAL_ENDS : 0u) |
                           (frame->unit_ends ? LABIAL_UNIT_ENDS : 0u);
    const int ahead = (model->kernel_taps ? model->kernel_taps - 1 - model->kernel_behind : 0) * model->kernel_stride;
    const int behind = model->kernel_behind * model->kernel_stride;
    check_place(taken, frame);
    assert_int_equal(taken->slot, frame->model);
    assert_int_equal(taken->is_first, frame->is_first);
    assert_int_equal(taken->marks, marks);
    for (int k = model->floor_count && behind < 2 ? -2 : -behind; k <= (model->floor_count && ahead < 3 ? 3 : ahead);
         k++)
        assert_int_equal(taken->labels[k], oracle_label(models, wanted, count, at, k));
    cuts += frame->is_first && at > 0 && !frame->begins && frame->previous == model->silence &&
            wanted[at - 1].phoneme == model->silence;
    compared++;
}

/* Pushes in random bursts, or one phoneme only when a frame is lacking, and takes what can be had: no frame sooner than
 * what it needs is known, none later, whatever the feeding. */
static void follow(int kind, uint32_t seed, int hungry)
{
    static const labial_model_t *const others[] = { &plain.model, &floored, &near };
    fixture_random_t random = { seed + 7 };
    labial_taken_t taken;
    size_t at = 0, pushed = 0;
    int result = LABIAL_STARVED;
    compose(kind, seed);
    begin(seed % 3 ? &rich.model : others[seed / 3 % 3]);
    const size_t count = oracle_units(models, input, COUNT, wanted, MANY);
    while (result != LABIAL_DONE) {
        uint32_t more = hungry ? result == LABIAL_STARVED : fixture_below(&random, 5);
        const int ended = pushed == COUNT;
        for (; pushed < COUNT && more > 0 && units.count < LABIAL_QUEUE; pushed++, more--)
            (void)labial_units_push(&units, input[pushed].phoneme, input[pushed].model, input[pushed].ms, FIXTURE_RATE);
        compare_next(at, count, ended, at < count && (ended || pushed >= wanted[at].needs));
        result = labial_units_take(&units, models, ended, &taken);
        if (at == count) {
            assert_int_equal(result, ended ? LABIAL_DONE : LABIAL_STARVED);
        } else if (ended || pushed >= wanted[at].needs) {
            assert_ok(result);
            compare(&taken, at++, count);
        } else {
            assert_int_equal(result, LABIAL_STARVED); /* else it was taken too early */
            assert_true(units.count < LABIAL_QUEUE);  /* a full queue never waits */
            waits++;
        }
    }
    assert_int_equal(at, count);
    assert_int_equal(units.count, 0);
    assert_int_equal(units.frames, 0);
}

/* Would catch a neighbour, a label or a cut that depends on what happens to be in the queue; a frame that is held back or
 * let go too early; frames lost or doubled; a segment of no frame that leaves a trace. */
TEST(random_streams_are_taken_frame_by_frame)
{
    for (int kind = 0; kind < FIXTURE_HOUR; kind++) {
        for (uint32_t seed = 0; seed < 30; seed++) {
            follow(kind, seed, 0);
            follow(kind, seed, 1);
        }
    }
    assert_true(compared > 100000 && waits > 1000);
    assert_true(cuts > 100 || LABIAL_REACH < 4);
    assert_true((open > 1000 && rested > 1000) || LABIAL_REACH < 4);
}

TEST(the_queue_knows_its_models)
{
    labial_taken_t taken;
    begin(&plain.model);
    for (unsigned slot = 0; slot < LABIAL_MODELS; slot++)
        assert_int_equal(labial_units_uses(&units, slot, units.frames), 0);
    push(FIXTURE_A, 0, 1), push(FIXTURE_O, 0, 1);
    assert_int_equal(labial_units_uses(&units, 0, units.frames), 1);
    for (unsigned slot = 1; slot < LABIAL_MODELS; slot++)
        assert_int_equal(labial_units_uses(&units, slot, units.frames), 0);
    assert_ok(labial_units_take(&units, models, 0, &taken));
    assert_int_equal(labial_units_uses(&units, 0, units.frames), 1);
    assert_ok(labial_units_take(&units, models, 1, &taken));
    assert_int_equal(labial_units_uses(&units, 0, units.frames), 0);
}

/* Of the longest phoneme there may be, at 250 frames a second: every frame's share, as for few frames. Would catch numbers
 * that leave 16 or 32 bits, and frames that are halved without their sum. */
TEST(shares_of_the_longest_phoneme_ascend)
{
    static const uint32_t lengths[] = { 65535, 65536, 65537, 131071, 131072, 262143, 262144, 900000 };
    labial_model_t fast = plain.model;
    labial_taken_t taken;
    fast.frames_per_second = 250;
    for (unsigned i = 0; i < COUNT_OF(lengths); i++) {
        begin(&fast);
        assert_int_equal(labial_units_push(&units, FIXTURE_S, 0, lengths[i] * 4u, 250), lengths[i]);
        for (uint32_t n = 0; n < lengths[i]; n++) {
            assert_ok(labial_units_take(&units, models, 1, &taken));
            assert_near(taken.share, 16384.0 * (n + 0.5) / lengths[i], 1.6); /* to halving, 1 in 32,768 */
        }
        assert_int_equal(labial_units_take(&units, models, 1, &taken), LABIAL_DONE);
    }
}

SUITE(setup, NULL)
