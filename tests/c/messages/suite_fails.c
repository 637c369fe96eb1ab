/*
 * suite_fails.c - comparisons that fail: what they print says what differs, in decimals, and of which seed.
 *
 * Would catch messages such as "0x3b6 != 0x320", from which nobody sees what was compared. All of its tests but the last one must fail.
 */
#include "suite.h"

static int frames(void)
{
    return 950;
}

#define FAILS(name, assertion)                                                                                         \
    TEST(name)                                                                                                         \
    {                                                                                                                  \
        assertion;                                                                                                     \
    }

static const int16_t fap = -7;
static const uint32_t most = 0xffffffffu;

FAILS(equal, assert_int_equal(frames() + 0, 800))
FAILS(negative, assert_int_equal(fap, 3))
FAILS(large, assert_int_equal(most, -1))
FAILS(unequal, assert_int_not_equal(frames(), 950))
FAILS(too_low, assert_in_range(-frames(), -900, 900))
FAILS(too_high, assert_in_range(frames(), -900, 900))

TEST(drawn)
{
    fixture_phoneme_t input[4];
    fixture_stream(input, 4, FIXTURE_PAUSES, 77);
    assert_int_equal(frames(), 800);
}

FAILS(not_drawn_any_more, assert_int_equal(frames(), 801))

/* Holds: both sides are evaluated once. */
TEST(once)
{
    int calls = 0, more = 0;
    assert_int_equal(++calls, ++more);
    assert_int_not_equal(++calls, ++more - 1);
    assert_in_range(++calls, ++more, 3);
    assert_true(calls == 3 && more == 3);
}

SUITE(NULL, NULL)
