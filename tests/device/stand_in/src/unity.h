/*
 * unity.h - the assertions of ThrowTheSwitch's Unity that the device tests use, by the same names and with the same
 * verdicts, for builds that cannot have Unity itself (unity.cmake). As Unity does without setjmp(), a test goes on after
 * an assertion that failed.
 */
#ifndef LABIAL_UNITY_STAND_IN_H
#define LABIAL_UNITY_STAND_IN_H

#include <stdint.h>

#include "board.h"

/* What a suite brings: called before and after each test. */
void setUp(void);
void tearDown(void);

void stand_in_begin(void);
int stand_in_end(void); /* prints the verdict; returns how many tests failed */
void stand_in_set_file(const char *file);
void stand_in_run(void (*test)(void), const char *name, unsigned line);
void stand_in_fail(unsigned line, const char *what, const char *message);
void stand_in_ignore(unsigned line, const char *message);

/* Compares `actual` with `wanted` by `relation`: '=', '<', '>' or 'n' for at most; with `is_signed` as int32_t. */
void stand_in_compare(uint32_t wanted, uint32_t actual, char relation, int is_signed, unsigned line,
                      const char *message);

#define UNITY_BEGIN() stand_in_begin()
#define UNITY_END() stand_in_end()
#define UnitySetTestFile(file) stand_in_set_file(file)
#define RUN_TEST(test) stand_in_run(test, #test, __LINE__)

#define TEST_FAIL_MESSAGE(message) stand_in_fail(__LINE__, "", message)
#define TEST_IGNORE_MESSAGE(message) stand_in_ignore(__LINE__, message)
#define TEST_ASSERT_TRUE_MESSAGE(condition, message)                                                                   \
    do {                                                                                                               \
        if (!(condition))                                                                                              \
            stand_in_fail(__LINE__, "expected TRUE was FALSE", message);                                               \
    } while (0)
#define TEST_ASSERT_NULL(pointer) TEST_ASSERT_TRUE_MESSAGE((pointer) == 0, "expected NULL")

#define STAND_IN_COMPARE_(wanted, actual, relation, is_signed, message)                                                \
    stand_in_compare((uint32_t)(wanted), (uint32_t)(actual), relation, is_signed, __LINE__, message)
#define TEST_ASSERT_EQUAL_INT(wanted, actual) STAND_IN_COMPARE_(wanted, actual, '=', 1, 0)
#define TEST_ASSERT_EQUAL_INT32(wanted, actual) STAND_IN_COMPARE_(wanted, actual, '=', 1, 0)
#define TEST_ASSERT_EQUAL_UINT(wanted, actual) STAND_IN_COMPARE_(wanted, actual, '=', 0, 0)
#define TEST_ASSERT_EQUAL_UINT32(wanted, actual) STAND_IN_COMPARE_(wanted, actual, '=', 0, 0)
#define TEST_ASSERT_EQUAL_UINT32_MESSAGE(wanted, actual, message) STAND_IN_COMPARE_(wanted, actual, '=', 0, message)
#define TEST_ASSERT_EQUAL_HEX32(wanted, actual) STAND_IN_COMPARE_(wanted, actual, '=', 0, 0)
#define TEST_ASSERT_EQUAL_HEX32_MESSAGE(wanted, actual, message) STAND_IN_COMPARE_(wanted, actual, '=', 0, message)
#define TEST_ASSERT_LESS_THAN_UINT(limit, actual) STAND_IN_COMPARE_(limit, actual, '<', 0, 0)
#define TEST_ASSERT_GREATER_THAN_UINT(limit, actual) STAND_IN_COMPARE_(limit, actual, '>', 0, 0)
#define TEST_ASSERT_LESS_OR_EQUAL_UINT32(limit, actual) STAND_IN_COMPARE_(limit, actual, 'n', 0, 0)

#endif
