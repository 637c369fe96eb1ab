/*
 * test_cost.c - what a tick is said to cost at most grows with everything that a model can ask for. The figures
 * themselves are held against counted instructions on the boards (tests/device/model_cost.c).
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include "fixture.h"

static fixture_model_t f;

static void no_model_costs_nothing(void **state)
{
    (void)state;
    fixture_plain(&f);
    assert_int_equal(labial_model_cost(NULL), 0);
    f.model.search_stride = 0;
    assert_int_equal(labial_model_cost(&f.model), 0);
}

/* Would catch a table that is not counted, and one phoneme taken for all of them. */
static void everything_adds_to_the_cost(void **state)
{
    uint32_t plain, more;
    (void)state;
    fixture_plain(&f);
    plain = labial_model_cost(&f.model);
    assert_true(plain > 0);
    f.phonemes[FIXTURE_T].component_count++;
    more = labial_model_cost(&f.model);
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
    f.model.predecessors--;
    assert_true(labial_model_cost(&f.model) < more);
    f.model.predecessors++;
    f.model.state_count = LABIAL_SEARCHED - 1; /* fewer than are looked at */
    assert_true(labial_model_cost(&f.model) < more);
    f.model.state_count = LABIAL_SEARCHED;
    f.model.search_stride++; /* channels take turns */
    assert_true(labial_model_cost(&f.model) < more);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_model_costs_nothing),
        cmocka_unit_test(everything_adds_to_the_cost),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
