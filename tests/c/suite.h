/*
 * suite.h - what a suite of cmocka's begins with. Its tests enter themselves, in their order; SUITE() at its end runs
 * them.
 */
#ifndef LABIAL_TEST_SUITE_H
#define LABIAL_TEST_SUITE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "fixture.h"

/* cmocka's comparisons of numbers print neither the expression nor decimals: "0x3b6 != 0x320". These do, and the seed
 * of what was drawn last: "labial_room(&stream) is 950, not 800 (seed 7)". */
#undef assert_int_equal
#undef assert_int_not_equal
#undef assert_in_range
#define assert_int_equal(found, wanted)                                                                                \
    suite_equal(#found, (long long)(found), (long long)(wanted), 1, __FILE__, __LINE__)
#define assert_int_not_equal(found, refused)                                                                           \
    suite_equal(#found, (long long)(found), (long long)(refused), 0, __FILE__, __LINE__)
#define assert_in_range(found, low, high)                                                                              \
    suite_within(#found, (long long)(found), (long long)(low), (long long)(high), __FILE__, __LINE__)

/* Likewise of numbers in double precision, `most` apart. */
#define assert_near(found, wanted, most) suite_near(#found, (double)(found), (double)(wanted), most, __FILE__, __LINE__)

/* A call that must succeed. */
#define assert_ok(call) assert_int_equal(call, LABIAL_OK)

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

/* What a test draws: from a seed on, 32 bits, a number below a limit, and one from `low` to `high`. */
static inline void draw_from(uint32_t seed)
{
    fixture_dice.state = fixture_seed(seed);
}

static inline uint32_t chance(void)
{
    return fixture_random(&fixture_dice);
}

static inline uint32_t below(uint32_t limit)
{
    return fixture_below(&fixture_dice, limit);
}

static inline int32_t between(int32_t low, int32_t high)
{
    return low + (int32_t)below((uint32_t)(high - low) + 1u);
}

/* Ends the line of a comparison, and the test. */
static inline void suite_fail(const char *file, int line)
{
    if (fixture_seed_count() > 0)
        print_error(" (seed %lu)", (unsigned long)fixture_seed_last());
    print_error("\n");
    _fail(file, line);
}

static inline void suite_equal(const char *expression, long long found, long long other, int equal, const char *file,
                               int line)
{
    if ((found == other) == equal)
        return;
    print_error("%s is %lld", expression, found);
    if (equal)
        print_error(", not %lld", other);
    suite_fail(file, line);
}

static inline void suite_within(const char *expression, long long found, long long low, long long high,
                                const char *file, int line)
{
    if (found >= low && found <= high)
        return;
    print_error("%s is %lld, not from %lld to %lld", expression, found, low, high);
    suite_fail(file, line);
}

static inline void suite_near(const char *expression, double found, double wanted, double most, const char *file,
                              int line)
{
    if (fabs(found - wanted) <= most)
        return;
    print_error("%s is %g, not %g", expression, found, wanted);
    suite_fail(file, line);
}

/* All tests of the suite, and behind them nothing. */
static struct CMUnitTest suite[64];
static size_t suite_count;

/* A test, or one after `setup`. Its `state` is cmocka's, which few need. */
#define TEST(name) TEST_AFTER(NULL, name)
#define TEST_AFTER(setup, name)                                                                                        \
    static void test_##name(void **);                                                                                  \
    static void name(void **state)                                                                                     \
    {                                                                                                                  \
        fixture_seed_forget();                                                                                         \
        test_##name(state);                                                                                            \
    }                                                                                                                  \
    __attribute__((constructor)) static void enter_##name(void)                                                        \
    {                                                                                                                  \
        const struct CMUnitTest entered = cmocka_unit_test_setup(name, setup);                                         \
        if (suite_count == sizeof suite / sizeof *suite)                                                               \
            abort(); /* there is no room for so many tests */                                                          \
        suite[suite_count++] = entered;                                                                                \
    }                                                                                                                  \
    static void test_##name(void **state __attribute__((unused)))

/* What is done before a test, or with SUITE() before the first one. */
#define SETUP(name) static int name(void **state __attribute__((unused)))

/* Fails unless a fixture_host_t played to its end: `result` is that of fixture_play() or fixture_run(). */
#define assert_played(host, result)                                                                                    \
    do {                                                                                                               \
        if ((result) != 0)                                                                                             \
            fail_msg("%s (frame %zu)", (host)->complaint, (host)->recorder.count);                                     \
    } while (0)

/* For suites that have an accepted fixture_model_t `f`: sets `place` in it to a value, wants `expected` from
 * labial_model_check(), and puts the old value back. */
#define TRY(type, place, value, expected)                                                                              \
    do {                                                                                                               \
        type const old_ = (place);                                                                                     \
        int got_;                                                                                                      \
        (place) = (type)(value);                                                                                       \
        got_ = labial_model_check(&f.model);                                                                           \
        (place) = old_;                                                                                                \
        if (got_ != (expected))                                                                                        \
            fail_msg("%s = %s gives %d, not %s", #place, #value, got_, #expected);                                     \
    } while (0)

#define REFUSED(type, place, value) TRY(type, place, value, LABIAL_ERROR_MODEL)
#define ACCEPTED(type, place, value) TRY(type, place, value, LABIAL_OK)

/* The program's main(), or in a program of several suites a function that theirs calls. */
#ifndef SUITE_MAIN
#define SUITE_MAIN main
#endif
#define SUITE(setup, teardown)                                                                                         \
    int SUITE_MAIN(void);                                                                                              \
    int SUITE_MAIN(void)                                                                                               \
    {                                                                                                                  \
        return cmocka_run_group_tests(suite, setup, teardown);                                                         \
    }

#endif
