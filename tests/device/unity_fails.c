/*
 * unity_fails.c - assertions that must fail and some that must hold: without it, a framework that lets everything pass
 * would accept every port. It is for Unity and for what stands in for it alike.
 */
#include <unity.h>

#include "board.h"

/* A test for each assertion, which does not hold. */
#define FAILING(X)                                                                                                     \
    X(is_true, TEST_ASSERT_TRUE_MESSAGE(1 > 2, "1 > 2"))                                                               \
    X(is_null, TEST_ASSERT_NULL(board_name))                                                                           \
    X(failed, TEST_FAIL_MESSAGE("as it must"))                                                                         \
    X(is_int, TEST_ASSERT_EQUAL_INT(1, -1))                                                                            \
    X(is_int32, TEST_ASSERT_EQUAL_INT32(-2147483647, 2147483647))                                                      \
    X(is_uint, TEST_ASSERT_EQUAL_UINT(2, 3))                                                                           \
    X(is_uint32, TEST_ASSERT_EQUAL_UINT32(0, 0x80000000u))                                                             \
    X(is_uint32_message, TEST_ASSERT_EQUAL_UINT32_MESSAGE(4, 5, "4 and 5"))                                            \
    X(is_hex32, TEST_ASSERT_EQUAL_HEX32(0xffffffffu, 0xfffffffeu))                                                     \
    X(is_hex32_message, TEST_ASSERT_EQUAL_HEX32_MESSAGE(1, 0x10001u, "high bits"))                                     \
    X(is_less, TEST_ASSERT_LESS_THAN_UINT(3, 3))                                                                       \
    X(is_greater, TEST_ASSERT_GREATER_THAN_UINT(3, 3))                                                                 \
    X(is_at_most, TEST_ASSERT_LESS_OR_EQUAL_UINT32(3, 4))

#define DEFINE(name, assertion)                                                                                        \
    static void name(void)                                                                                             \
    {                                                                                                                  \
        assertion;                                                                                                     \
    }
FAILING(DEFINE)

static int torn_down, wanted_failures;

void setUp(void);
void tearDown(void);

void setUp(void)
{
}

void tearDown(void)
{
    torn_down++;
}

static void all_hold(void)
{
    TEST_ASSERT_TRUE_MESSAGE(2 > 1, "2 > 1");
    TEST_ASSERT_NULL((const char *)0);
    TEST_ASSERT_EQUAL_INT(-1, -1);
    TEST_ASSERT_EQUAL_UINT32(0x80000000u, 0x80000000u);
    TEST_ASSERT_LESS_THAN_UINT(3, 2);
    TEST_ASSERT_LESS_THAN_UINT(0x80000001u, 0x7fffffffu);
    TEST_ASSERT_GREATER_THAN_UINT(3, 4);
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(3, 3);
}

static void is_ignored(void)
{
    TEST_IGNORE_MESSAGE("as it must be");
}

int main(void)
{
    int failures;
    UNITY_BEGIN();
    UnitySetTestFile(__FILE__);
#define RUN(name, assertion)                                                                                           \
    RUN_TEST(name);                                                                                                    \
    wanted_failures++;
    FAILING(RUN)
    RUN_TEST(all_hold);
    RUN_TEST(is_ignored);
    failures = UNITY_END();
    board_print(failures == wanted_failures ? "All of these failures are wanted.\n"
                                            : "Not as many failures as wanted.\n");
    return failures == wanted_failures && torn_down == wanted_failures + 2 ? 0 : 1;
}
