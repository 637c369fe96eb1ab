/*
 * cmocka.h - what the C suites use of cmocka, for targets that it is not packaged for. A suite is one source, and so
 * all of it stands here.
 */
#ifndef LABIAL_TEST_CMOCKA_H
#define LABIAL_TEST_CMOCKA_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

struct CMUnitTest {
    const char *name;
    void (*test)(void **state);
    int (*setup)(void **state);
};

#define cmocka_unit_test(function)                                                                                     \
    {                                                                                                                  \
#function, function, NULL                                                                                      \
    }
#define cmocka_unit_test_setup(function, setup)                                                                        \
    {                                                                                                                  \
#function, function, setup                                                                                     \
    }
#define cmocka_run_group_tests(tests, setup, teardown) shim_run(tests, sizeof(tests) / sizeof *(tests), setup, teardown)

static jmp_buf shim_end_of_test;

/* Ends the test that runs. */
static inline void shim_fail(const char *file, int line, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    printf("%s:%d: ", file, line);
    vprintf(format, arguments);
    putchar('\n');
    va_end(arguments);
    longjmp(shim_end_of_test, 1);
}

static inline int shim_run(const struct CMUnitTest *tests, size_t count, int (*setup)(void **),
                           int (*teardown)(void **))
{
    static void *state;
    static size_t i, failures; /* not lost by longjmp() */
    if (setup && setup(&state))
        return -1;
    for (i = 0; i < count; i++) {
        int failed = setjmp(shim_end_of_test);
        if (!failed) {
            failed = tests[i].setup && tests[i].setup(&state);
            if (!failed)
                tests[i].test(&state);
        }
        printf("[%s] %s\n", failed ? "  FAILED  " : "       OK ", tests[i].name);
        failures += failed != 0;
    }
    if (teardown && teardown(&state))
        failures++;
    return (int)failures;
}

#define fail_msg(...) shim_fail(__FILE__, __LINE__, __VA_ARGS__)
#define print_message(...) printf(__VA_ARGS__)

#define shim_require(condition, text)                                                                                  \
    do {                                                                                                               \
        if (!(condition))                                                                                              \
            shim_fail(__FILE__, __LINE__, "%s", text);                                                                 \
    } while (0)

/* Numbers are compared as unsigned ones, as cmocka compares them. */
static inline void shim_numbers(uintmax_t a, uintmax_t b, int wanted_equal, const char *file, int line)
{
    if ((a == b) != wanted_equal)
        shim_fail(file, line, "%ju %s %ju", a, wanted_equal ? "!=" : "==", b);
}

#define assert_true(condition) shim_require(condition, #condition)
#define assert_null(pointer) shim_require((pointer) == NULL, #pointer " is not null")
#define assert_non_null(pointer) shim_require((pointer) != NULL, #pointer " is null")
#define assert_int_equal(a, b) shim_numbers((uintmax_t)(a), (uintmax_t)(b), 1, __FILE__, __LINE__)
#define assert_int_not_equal(a, b) shim_numbers((uintmax_t)(a), (uintmax_t)(b), 0, __FILE__, __LINE__)
#define assert_in_range(x, least, most)                                                                                \
    shim_require((uintmax_t)(x) >= (uintmax_t)(least) && (uintmax_t)(x) <= (uintmax_t)(most), #x " is out of range")
#define assert_memory_equal(a, b, size) shim_require(memcmp(a, b, size) == 0, #a " differs from " #b)
#define assert_string_equal(a, b) shim_require(strcmp(a, b) == 0, #a " differs from " #b)
#define assert_string_not_equal(a, b) shim_require(strcmp(a, b) != 0, #a " is " #b)

#endif
