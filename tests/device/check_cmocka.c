/*
 * check_cmocka.c - assertions that must fail and some that must hold: without it, a framework that lets everything pass
 * would accept every port. It is for both forms of setup/cmocka/cmocka.h, on a board and on the host.
 */
#include "board.h"

#ifdef CHECK_HOSTED
#undef BOARD_H
#endif
#include <cmocka.h>

/* A test for each assertion, which does not hold. */
#define FAILING(X)                                                                                                     \
    X(is_failure, fail())                                                                                              \
    X(is_true, assert_true(1 > 2))                                                                                     \
    X(is_null, assert_null(board_name))                                                                                \
    X(is_non_null, assert_non_null((const char *)0))                                                                   \
    X(is_int, assert_int_equal(1, -1))                                                                                 \
    X(is_int_of_32_bits, assert_int_equal(-2147483647, 2147483647))                                                    \
    X(is_unsigned, assert_int_equal(0, 0x80000000u))                                                                   \
    X(is_number_in_its_low_bits, assert_int_equal(0xffffffffu, 0xfffffffeu))                                           \
    X(is_number_in_its_high_bits, assert_int_equal((uint64_t)1 << 32, 0))                                              \
    X(is_not, assert_int_not_equal(3, 3))                                                                              \
    X(is_at_least, assert_in_range(2, 3, 5))                                                                           \
    X(is_at_most, assert_in_range(6, 3, 5))                                                                            \
    X(is_same_memory, assert_memory_equal("ab", "ac", 2))                                                              \
    X(is_same_text, assert_string_equal("ab", "abc"))                                                                  \
    X(is_other_text, assert_string_not_equal("ab", "ab"))

#define DEFINE(name, assertion)                                                                                        \
    static void name(void **state)                                                                                     \
    {                                                                                                                  \
        (void)state;                                                                                                   \
        assertion;                                                                                                     \
    }
FAILING(DEFINE)

static int set_up, torn_down;

static int count_setup(void **state)
{
    (void)state;
    set_up++;
    return 0;
}

static int count_teardown(void **state)
{
    (void)state;
    torn_down++;
    return 0;
}

static int fail_to(void **state)
{
    (void)state;
    return 1;
}

static void all_hold(void **state)
{
    (void)state;
    assert_true(2 > 1);
    assert_null((const char *)0);
    assert_non_null(board_name);
    assert_int_equal(-1, -1);
    assert_int_equal(0x80000000u, 0x80000000u);
    assert_int_not_equal(1, -1);
    assert_in_range(3, 3, 3);
    assert_memory_equal("ab", "ac", 1);
    assert_string_equal("ab", "ab");
    assert_string_not_equal("ab", "abc");
}

int main(void)
{
#define ROW(name, assertion) cmocka_unit_test_setup_teardown(name, count_setup, count_teardown),
    static const struct CMUnitTest failing[] = { FAILING(ROW) };
    static const struct CMUnitTest holding[] = { cmocka_unit_test(all_hold) };
    static const struct CMUnitTest unready[] = { cmocka_unit_test_setup_teardown(all_hold, fail_to, NULL),
                                                 cmocka_unit_test_setup_teardown(all_hold, NULL, fail_to) };
    const int wanted = (int)(sizeof failing / sizeof *failing);
    const int fails = cmocka_run_group_tests(failing, NULL, NULL) == wanted && set_up == wanted &&
                      torn_down == wanted && cmocka_run_group_tests(unready, NULL, NULL) == 2 &&
                      cmocka_run_group_tests(holding, NULL, fail_to) == 1;
    const int holds = cmocka_run_group_tests(holding, count_setup, NULL) == 0;
    board_print(fails && holds ? "All of these failures are wanted.\n" : "Not as many failures as wanted.\n");
    return fails && holds ? 0 : 1;
}
