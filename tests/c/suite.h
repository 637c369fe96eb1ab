/*
 * suite.h - what a suite of cmocka's begins with. Its tests enter themselves, in their order; SUITE() at its end runs
 * them.
 */
#ifndef LABIAL_TEST_SUITE_H
#define LABIAL_TEST_SUITE_H

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

/* All tests of the suite, and behind them nothing. */
static struct CMUnitTest suite[40];
static size_t suite_count;

/* A test, or one after `setup`. Its `state` is cmocka's, which few need. */
#define TEST(name) TEST_AFTER(NULL, name)
#define TEST_AFTER(setup, name)                                                                                        \
    static void name(void **);                                                                                         \
    __attribute__((constructor)) static void enter_##name(void)                                                        \
    {                                                                                                                  \
        const struct CMUnitTest entered = cmocka_unit_test_setup(name, setup);                                         \
        suite[suite_count++] = entered;                                                                                \
    }                                                                                                                  \
    static void name(void **state __attribute__((unused)))

/* What is done before a test, or with SUITE() before the first one. */
#define SETUP(name) static int name(void **state __attribute__((unused)))

/* Fails unless a fixture_host_t played to its end: `result` is that of fixture_play() or fixture_run(). */
#define assert_played(host, result)                                                                                    \
    do {                                                                                                               \
        if ((result) != 0)                                                                                             \
            fail_msg("%s (frame %zu)", (host)->complaint, (host)->recorder.count);                                     \
    } while (0)

#define SUITE(setup, teardown)                                                                                         \
    int main(void)                                                                                                     \
    {                                                                                                                  \
        return cmocka_run_group_tests(suite, setup, teardown);                                                         \
    }

#endif
