/*
 * test_cost.c - what a tick is said to cost at most grows with everything that a model can ask for. The figures
 * themselves are held against counted instructions on the boards (tests/device/model_cost.c).
 */
#include "suite.h"

#include "fixture.h"
#include "laughter_synthetic.h"
#include "speech_en.h"

static fixture_model_t f;

TEST(no_model_costs_nothing)
{
    fixture_plain(&f);
    assert_int_equal(labial_model_cost(NULL), 0);
    f.model.search_stride = 0;
    assert_int_equal(labial_model_cost(&f.model), 0);
}

/* Would catch a table that is not counted, and one phoneme taken for all of them. */
TEST(everything_adds_to_the_cost)
{
    fixture_plain(&f);
    uint32_t plain = labial_model_cost(&f.model);
    assert_true(plain > 0);
    f.phonemes[FIXTURE_T].component_count++;
    uint32_t more = labial_model_cost(&f.model);
    assert_true(more > plain);
    f.phonemes[FIXTURE_A].component_count--; /* which is not the largest */
    assert_true(labial_model_cost(&f.model) == more);
    f.model.pair_count = 1;
    f.model.pair_knots = 1;
    plain = labial_model_cost(&f.model);
    assert_true(plain > more);
    f.model.pair_knots = 2;
    more = labial_model_cost(&f.model);
    assert_true(more > plain);
    f.model.pair_count = 2;
    plain = labial_model_cost(&f.model);
    assert_true(plain > more);
    f.model.kernel_taps = 1;
    more = labial_model_cost(&f.model);
    assert_true(more > plain);
    f.model.predecessor_fours--;
    assert_true(labial_model_cost(&f.model) < more);
    f.model.predecessor_fours++;
    f.model.state_count = LABIAL_SEARCHED - 1; /* fewer than are looked at */
    assert_true(labial_model_cost(&f.model) < more);
    f.model.state_count = LABIAL_SEARCHED;
    f.model.search_stride++; /* channels take turns */
    assert_true(labial_model_cost(&f.model) < more);
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

SUITE(NULL, NULL)
