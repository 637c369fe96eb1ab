/*
 * cmocka.h - what the suites use of cmocka, by the same names, for targets that it is not packaged for. A suite is one
 * source, and so all of it stands here.
 *
 * Where board.h is included before, text goes to the board, and a test goes on after an assertion that failed, since a
 * board may lack setjmp(); fail_msg(), print_message() and skip() then do not exist.
 */
#ifndef LABIAL_TEST_CMOCKA_H
#define LABIAL_TEST_CMOCKA_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#ifndef BOARD_H
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#endif

struct CMUnitTest {
    const char *name;
    void (*test)(void **state);
    int (*setup)(void **state);
    int (*teardown)(void **state);
};

/* clang-format off */
#define cmocka_unit_test(function) { #function, function, NULL, NULL }
#define cmocka_unit_test_setup(function, setup) { #function, function, setup, NULL }
#define cmocka_unit_test_setup_teardown(function, setup, teardown) { #function, function, setup, teardown }
/* clang-format on */
#define cmocka_run_group_tests(tests, setup, teardown) shim_run(tests, sizeof(tests) / sizeof *(tests), setup, teardown)

static int shim_failed; /* the test that runs */

#ifdef BOARD_H

#define SHIM_CATCH() 0

static inline void shim_print(const char *text)
{
    board_print(text);
}

static inline void shim_print_at(const char *file, unsigned line)
{
    board_print(file);
    board_put(':');
    board_print_unsigned(line);
    board_print(": ");
}

static inline void shim_print_number(uintmax_t number)
{
    board_print("0x");
    board_print_hex((uint32_t)(number >> 31 >> 1));
    board_print_hex((uint32_t)number);
}

static inline void shim_end(void)
{
    board_put('\n');
    shim_failed = 1;
}

#else

static jmp_buf shim_end_of_test;

#define SHIM_CATCH() setjmp(shim_end_of_test)

static inline void shim_print(const char *text)
{
    fputs(text, stdout);
}

static inline void shim_print_at(const char *file, unsigned line)
{
    printf("%s:%u: ", file, line);
}

static inline void shim_print_number(uintmax_t number)
{
    printf("%#jx", number);
}

/* Ends the test that runs. */
static inline void shim_end(void)
{
    putchar('\n');
    shim_failed = 1;
    longjmp(shim_end_of_test, 1);
}

static inline void shim_fail_msg(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
    shim_end();
}

#define fail_msg(...) (shim_print_at(__FILE__, __LINE__), shim_fail_msg(__VA_ARGS__))
#define print_message(...) printf(__VA_ARGS__)

#endif

static inline int shim_run(const struct CMUnitTest *tests, size_t count, int (*setup)(void **),
                           int (*teardown)(void **))
{
    static void *state;
    static size_t i, failures; /* not lost by longjmp() */
    failures = 0;
    if (setup && setup(&state))
        return -1;
    for (i = 0; i < count && tests[i].test; i++) {
        shim_failed = 0;
        if (!SHIM_CATCH()) {
            if (tests[i].setup && tests[i].setup(&state))
                shim_failed = 1;
            else
                tests[i].test(&state);
        }
        if (tests[i].teardown && tests[i].teardown(&state))
            shim_failed = 1;
        shim_print(shim_failed ? "[  FAILED  ] " : "[       OK ] ");
        shim_print(tests[i].name);
        shim_print("\n");
        failures += shim_failed != 0;
    }
    if (teardown && teardown(&state))
        failures++;
    return (int)failures;
}

static inline void shim_require(int holds, const char *text, const char *file, unsigned line)
{
    if (holds)
        return;
    shim_print_at(file, line);
    shim_print(text);
    shim_end();
}

/* Numbers are compared as unsigned ones, as cmocka compares them. */
static inline void shim_numbers(uintmax_t a, uintmax_t b, int wanted_equal, const char *file, unsigned line)
{
    if ((a == b) == wanted_equal)
        return;
    shim_print_at(file, line);
    shim_print_number(a);
    shim_print(wanted_equal ? " != " : " == ");
    shim_print_number(b);
    shim_end();
}

#define SHIM_REQUIRE(condition, text) shim_require((condition) ? 1 : 0, text, __FILE__, __LINE__)

#define fail() SHIM_REQUIRE(0, "fails")
#define assert_true(condition) SHIM_REQUIRE(condition, #condition)
#define assert_null(pointer) SHIM_REQUIRE((pointer) == NULL, #pointer " is not null")
#define assert_non_null(pointer) SHIM_REQUIRE((pointer) != NULL, #pointer " is null")
#define assert_int_equal(a, b) shim_numbers((uintmax_t)(a), (uintmax_t)(b), 1, __FILE__, __LINE__)
#define assert_int_not_equal(a, b) shim_numbers((uintmax_t)(a), (uintmax_t)(b), 0, __FILE__, __LINE__)
#define assert_in_range(x, least, most)                                                                                \
    SHIM_REQUIRE((uintmax_t)(x) >= (uintmax_t)(least) && (uintmax_t)(x) <= (uintmax_t)(most), #x " is out of range")
#define assert_memory_equal(a, b, size) SHIM_REQUIRE(memcmp(a, b, size) == 0, #a " differs from " #b)
#define assert_string_equal(a, b) SHIM_REQUIRE(strcmp(a, b) == 0, #a " differs from " #b)
#define assert_string_not_equal(a, b) SHIM_REQUIRE(strcmp(a, b) != 0, #a " is " #b)

#endif
