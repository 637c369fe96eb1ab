/*
 * test_faps.c - FAP numbers and the 23 FAPs of a mouth with inner lips, against MPEG-4's own numbering.
 */
#include "suite.h"

#include <string.h>

#include "labial/faps.h"

/* Would catch a channel out of order: every model trained with the right order would move the wrong point. */
TEST(channels_have_their_numbers)
{
    static const uint8_t numbers[LABIAL_CHANNELS] = { 3, 16, 17, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60 };
    assert_memory_equal(labial_fap_numbers, numbers, sizeof numbers);
}

TEST(expanded_numbers_ascend)
{
    unsigned i = 0;
    for (unsigned fap = 3; fap <= 60; fap++)
        if (fap <= 13 || fap == 16 || fap == 17 || fap >= 51)
            assert_int_equal(labial_fap_numbers_expanded[i++], fap);
    assert_int_equal(i, LABIAL_FAPS_EXPANDED);
}

/* Value of one FAP in a frame whose FAP n is `1000 + n`, inner lips as the outer ones (4 as 51 .. 13 as 60). */
static int wanted(unsigned fap)
{
    return 1000 + (int)(fap >= 4 && fap <= 13 ? fap - 4 + 51 : fap);
}

TEST(inner_lip_moves_as_the_outer)
{
    struct {
        int16_t before, faps[LABIAL_FAPS_EXPANDED], after;
    } out = { -77, { 0 }, -78 };
    int16_t in[LABIAL_CHANNELS];
    for (unsigned i = 0; i < LABIAL_CHANNELS; i++)
        in[i] = (int16_t)(1000 + labial_fap_numbers[i]);
    labial_expand(in, out.faps);
    for (unsigned i = 0; i < LABIAL_FAPS_EXPANDED; i++)
        assert_int_equal(out.faps[i], wanted(labial_fap_numbers_expanded[i]));
    assert_int_equal(out.before, -77);
    assert_int_equal(out.after, -78);
}

/* Would catch arithmetic on the values, which must be copies. */
TEST(extreme_values_are_copied)
{
    int16_t in[LABIAL_CHANNELS], out[LABIAL_FAPS_EXPANDED];
    for (unsigned i = 0; i < LABIAL_CHANNELS; i++)
        in[i] = i % 2 ? INT16_MIN : INT16_MAX;
    labial_expand(in, out);
    for (unsigned i = 0; i < LABIAL_FAPS_EXPANDED; i++)
        assert_true(out[i] == INT16_MIN || out[i] == INT16_MAX);
    assert_int_equal(out[0], INT16_MAX);  /* 3, channel 0 */
    assert_int_equal(out[1], INT16_MIN);  /* 4 as 51, channel 3 */
    assert_int_equal(out[22], INT16_MAX); /* 60, channel 12 */
}

TEST(null_does_nothing)
{
    const int16_t in[LABIAL_CHANNELS] = { 1 };
    int16_t out[LABIAL_FAPS_EXPANDED], kept[LABIAL_FAPS_EXPANDED];
    memset(out, 0x33, sizeof out);
    memcpy(kept, out, sizeof out);
    labial_expand(NULL, out);
    labial_expand(in, NULL);
    labial_expand(NULL, NULL);
    assert_memory_equal(out, kept, sizeof out);
}

SUITE(NULL, NULL)
