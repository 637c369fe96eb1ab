/*
 * unity_fails.c - assertions that must fail and some that must hold, of each kind that the device tests use.
 *
 * Would catch a framework or a configuration of it that lets everything pass: numbers cut to fewer bits, a test that
 * fails but is not counted, failures that the status of the image does not show, messages that leave out what was
 * compared. With DEVICE_MUST_FAIL the image itself must end in failure.
 */
#include <stddef.h>

#include "board.h"
#include "messages.h"

/* A test for each assertion, which does not hold. */
#define FAILING(X)                                                                                                     \
    X(is_failure, TEST_FAIL_MESSAGE("as wanted"))                                                                      \
    X(is_true, TEST_ASSERT_TRUE(1 > 2))                                                                                \
    X(is_true_with_message, TEST_ASSERT_TRUE_MESSAGE(1 > 2, "as wanted"))                                              \
    X(is_null, TEST_ASSERT_NULL(board_name))                                                                           \
    X(is_signed, TEST_ASSERT_EQUAL_INT32(1, 3 - 4))                                                                    \
    X(is_signed_of_32_bits, TEST_ASSERT_EQUAL_INT32(-2147483647, 2147483647))                                          \
    X(is_unsigned, TEST_ASSERT_EQUAL_UINT32(0, 0x80000000u))                                                           \
    X(is_unsigned_in_its_low_bits, TEST_ASSERT_EQUAL_UINT32(0xffffffffu, 0xfffffffeu))                                 \
    X(is_hexadecimal, TEST_ASSERT_EQUAL_HEX32(0x0badf00du, 0x8badf00du))

#define DEFINE(name, assertion)                                                                                        \
    static void name(void)                                                                                             \
    {                                                                                                                  \
        assertion;                                                                                                     \
    }
FAILING(DEFINE)

static int before, after; /* how often setUp() and tearDown() ran */
static int fails_after;

void setUp(void)
{
    before++;
}

void tearDown(void)
{
    after++;
    TEST_ASSERT_TRUE_MESSAGE(!fails_after, "as wanted");
}

static void all_hold(void)
{
    TEST_ASSERT_TRUE(2 > 1);
    TEST_ASSERT_TRUE_MESSAGE(2 > 1, "not wanted");
    TEST_ASSERT_NULL((const char *)0);
    TEST_ASSERT_EQUAL_INT32(-1, -1);
    TEST_ASSERT_EQUAL_UINT32(0x80000000u, 0x80000000u);
    TEST_ASSERT_EQUAL_HEX32(0xffffffffu, 0xffffffffu);
}

int main(void)
{
#define COUNT(name, assertion) +1
#define RUN(name, assertion) RUN_TEST(name);
    const int wanted = 1 FAILING(COUNT);
    int failures, is_as_wanted;
    UNITY_BEGIN();
    FAILING(RUN)
    RUN_TEST(all_hold);
    fails_after = 1;
    RUN_TEST(all_hold); /* fails in tearDown() */
    failures = UNITY_END();
    is_as_wanted = failures == wanted && before == wanted + 1 && after == wanted + 1;
    board_print(is_as_wanted ? "All of these failures are wanted.\n" : "Not as many failures as wanted.\n");
#ifdef DEVICE_MUST_FAIL
    return failures > 0;
#else
    return is_as_wanted ? 0 : 1;
#endif
}
