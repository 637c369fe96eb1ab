/*
 * test_cost.c - what a tick costs: the most that a model is said to ask for, which grows with everything that it has, and
 * the even share of ticks: which channels a tick searches and solves, and when it selects a shape. What is delivered does
 * not tell, but a tick that does the work of several is late on a small processor. The figures themselves are held
 * against counted instructions on the boards (tests/device/model_cost.c).
 */
#include "suite.h"
#include "laughter_synthetic.h"
#include "speech_en.h"

/* ---- The most ---------------------------------------------------------------------------------------------------- */

static fixture_model_t f;

TEST(no_model_costs_nothing)
{
    fixture_plain(&f);
    assert_int_equal(labial_model_cost(NULL), 0);
    f.model.search_stride = 0;
    assert_int_equal(labial_model_cost(&f.model), 0);
}

/* How a change of the model moves its cost: 1, 0 or -1. */
#define MOVES(change) (before = labial_model_cost(&f.model), change, moved(before))

static int moved(uint32_t before)
{
    const uint32_t cost = labial_model_cost(&f.model);
    return cost > before ? 1 : cost < before ? -1 : 0;
}

/* Would catch a table that is not counted, and one phoneme taken for all of them. */
TEST(everything_adds_to_the_cost)
{
    uint32_t before;
    fixture_plain(&f);
    assert_true(labial_model_cost(&f.model) > 0);
    assert_int_equal(MOVES(f.phonemes[FIXTURE_T].component_count++), 1);
    assert_int_equal(MOVES(f.phonemes[FIXTURE_A].component_count--), 0); /* which is not the largest */
    assert_int_equal(MOVES(f.model.pair_count = f.model.pair_knots = 1), 1);
    assert_int_equal(MOVES(f.model.pair_knots = 2), 1);
    assert_int_equal(MOVES(f.model.pair_count = 2), 1);
    assert_int_equal(MOVES(f.model.kernel_taps = 1), 1);
    assert_int_equal(MOVES(f.model.predecessor_fours--), -1);
    assert_int_equal(MOVES(f.model.state_count = LABIAL_SEARCHED - 1), -1); /* fewer than are looked at */
    assert_int_equal(MOVES(f.model.state_count = LABIAL_SEARCHED), 1);
    assert_int_equal(MOVES(f.model.search_stride++), -1); /* channels take turns */
}

/* "The bundled models cost about 29,000 and 24,000" (labial/model.h). Would catch a part that is counted once more, or not at all. */
TEST(bundled_models_cost_what_the_header_says)
{
    assert_in_range(labial_model_cost(&speech_en), 28500, 29999);
    assert_in_range(labial_model_cost(&laughter_synthetic), 23500, 24999);
}

static uint32_t cost_of_stride(unsigned stride)
{
    f.model.search_stride = (uint8_t)stride;
    return labial_model_cost(&f.model);
}

/* Of 13 channels three at most have their turn in one tick with strides of 5 and 6, two with 7 and 8: each frame more in a
 * turn costs that many times the same. Would catch frames that are not counted, and channels. */
TEST(frames_of_a_turn_cost_alike)
{
    fixture_plain(&f);
    const uint32_t of_three = cost_of_stride(6) - cost_of_stride(5);
    const uint32_t of_two = cost_of_stride(8) - cost_of_stride(7);
    assert_true(of_two > 0 && of_two < cost_of_stride(7));
    assert_int_equal(2u * of_three, 3u * of_two);
}

/* The comparisons of a binary search for the `wanted`-th of `count` entries, or for what lies before or behind all. */
static uint32_t steps_of_search(unsigned count, unsigned wanted)
{
    unsigned low = 0, high = count;
    uint32_t steps = 0;
    while (low < high) {
        const unsigned middle = (low + high) / 2u;
        steps++;
        if (middle < wanted)
            low = middle + 1u;
        else
            high = middle;
    }
    return steps;
}

/* Pairs without knots cost what it takes to find them. Would catch a search that takes a comparison more or less than is
 * counted, of few pairs or of many. */
TEST(pairs_cost_the_comparisons_of_their_search)
{
    fixture_plain(&f);
    f.model.pair_knots = 0;
    f.model.pair_count = 0;
    const uint32_t none = labial_model_cost(&f.model);
    f.model.pair_count = 1;
    uint32_t each = labial_model_cost(&f.model);
    f.model.pair_count = 2; /* may take two comparisons */
    each = labial_model_cost(&f.model) - each;
    assert_true(each > 0);
    for (unsigned count = 0; count <= 300; count++) {
        uint32_t most = 0;
        for (unsigned wanted = 0; wanted <= count; wanted++)
            if (steps_of_search(count, wanted) > most)
                most = steps_of_search(count, wanted);
        f.model.pair_count = (uint16_t)count;
        assert_int_equal(labial_model_cost(&f.model), none + most * each);
    }
}

/* ---- The even share ---------------------------------------------------------------------------------------------- */

static fixture_model_t rich, slow;

SETUP(setup)
{
    fixture_rich(&rich);
    fixture_slow(&slow);
    return 0;
}

static void ignore(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)user;
    (void)frame;
    (void)faps;
}

typedef struct {
    labial_t stream;
    uint32_t workspace[LABIAL_WORKSPACE_SIZE(LABIAL_SEARCH_STRIDE_MAX, LABIAL_CHANNELS) / 4];
} place_t;

static place_t place;

static void begin(const labial_model_t *model)
{
    assert_ok(labial_init(&place.stream, model, place.workspace, sizeof place.workspace, ignore, NULL));
}

/* Fills the queue with phonemes that last `ms`, or three frames and more by turns where that is 0; ends the stream once
 * `left` is 0. */
static void feed(unsigned phonemes, unsigned ms, unsigned *left)
{
    for (; *left > 0 && labial_room(&place.stream) > 0; --*left)
        assert_ok(labial_push(&place.stream, *left * 7u % phonemes, ms ? ms : 60u + *left % 5u * 20u));
    if (*left == 0)
        assert_ok(labial_end(&place.stream));
}

/* Would catch a channel whose turn comes in another's tick, twice or never: ticks that do more than their share. */
static void channels_take_turns(const labial_model_t *model)
{
    labial_progress_t before[LABIAL_CHANNELS];
    const unsigned stride = model->search_stride;
    unsigned left = 60, moved = 0, turns = 0;
    begin(model);
    for (unsigned tick = 0;; tick++) {
        feed(model->phoneme_count, 0, &left);
        memcpy(before, place.stream.channels.progress, sizeof before);
        if (labial_tick(&place.stream) == LABIAL_DONE)
            break;
        for (unsigned c = 0; c < model->channel_count; c++) {
            const int changed = memcmp(&before[c], &place.stream.channels.progress[c], sizeof before[c]) != 0;
            if (c % stride != tick % stride && changed)
                fail_msg("tick %u works on channel %u", tick, c);
            turns += c % stride == tick % stride;
            moved += (unsigned)changed;
        }
    }
    assert_true(turns > 400 && moved * 10 > turns * 8);
}

TEST(channels_take_turns_in_every_stride)
{
    channels_take_turns(&rich.model);
    channels_take_turns(&slow.model);
    channels_take_turns(&speech_en);
}

/* Halves of a selection that a tick makes. */
typedef struct {
    unsigned tick, halves, begun; /* `begun`: a phoneme, with the shape that was selected */
} work_t;

/* The work of the next tick of a stream; false at the end. */
static int next_work(unsigned ms, unsigned *left, work_t *work)
{
    const uint8_t was = place.stream.next.halves;
    const labial_shape_t *const spoken = place.stream.shape;
    feed(SPEECH_EN_PHONEMES, ms, left);
    if (labial_tick(&place.stream) == LABIAL_DONE)
        return 0;
    work->begun = place.stream.shape != spoken;
    work->halves = place.stream.next.halves + (work->begun ? 2u : 0u) - was;
    work->tick++;
    return 1;
}

/* Would catch a shape that is selected in a tick that has enough to do: where phonemes are known and last as many frames
 * as channels have turns, it is selected in the ticks with the fewest channels. */
TEST(shapes_are_selected_in_the_lightest_ticks)
{
    work_t work = { 0, 0, 0 };
    unsigned left = 120, begun = 0, halves = 0;
    begin(&speech_en);
    while (next_work(0, &left, &work)) {
        if (work.tick > 1 && work.tick % speech_en.search_stride != 0)
            assert_int_equal(work.halves, 0);
        halves += work.halves;
        begun += work.begun;
    }
    assert_in_range(begun, 100, 130);
    assert_in_range(halves, 200, 260);
}

/* Phonemes of one and of two frames leave no such tick between some of them. Would catch a tick that selects more than
 * one shape, and one that selects a whole one though the tick before or after could have shared it. */
TEST(short_phonemes_share_the_selection)
{
    for (unsigned frames = 1; frames <= 2; frames++) {
        work_t work = { 0, 0, 0 };
        unsigned left = 120, begun = 0, whole = 0;
        begin(&speech_en);
        while (next_work(20u * frames, &left, &work)) {
            assert_true(work.halves <= 2);
            whole += work.halves == 2 && work.tick % speech_en.search_stride != 0;
            begun += work.begun;
        }
        assert_in_range(begun, 100, 130);
        assert_true(frames == 1 || whole <= 45);
    }
}

SUITE(setup, NULL)
