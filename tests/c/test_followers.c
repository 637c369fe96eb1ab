/*
 * test_followers.c - FAP 17 of the corners: the table of labial/model.h against doubles; and frames of their sources.
 */
#include "suite.h"

#include <math.h>
#include <string.h>

#include "followers.h"
#include "oracle.h"

static labial_model_t model;
static labial_protrusion_t table;

SETUP(setup)
{
    model.protrusion = &table;
    return 0;
}

static void fill(uint32_t seed, int16_t low, uint16_t gain, uint32_t range)
{
    fixture_random_t random;
    random.state = fixture_seed(seed);
    table.low = low;
    table.gain = gain;
    for (unsigned i = 0; i < LABIAL_PROTRUSION_VALUES; i++)
        table.values[i] = (int16_t)((int)fixture_below(&random, 2 * range) - (int)range);
}

/* Every sum of two corners there is, with tables of every width and place: would catch a product that overflows, a value
 * beyond the table, an interval that is off by one, rounding that is not to the nearest. */
TEST(tables_are_interpolated)
{
    static const int16_t lows[] = { -32768, -32767, -800, 0, 5, 32767 };
    static const uint16_t gains[] = { 0, 1, 127, 128, 700, 4096, 65535 };
    for (unsigned l = 0; l < sizeof lows / sizeof lows[0]; l++)
        for (unsigned g = 0; g < sizeof gains / sizeof gains[0]; g++) {
            fill(l * 16 + g + 1, lows[l], gains[g], g % 2 ? 32767 : 600);
            for (int32_t sum = 2 * INT16_MIN; sum <= 2 * INT16_MAX; sum += g % 2 ? 1 : 7) {
                const int32_t above = sum - 2 * lows[l];
                const double place = above < 0 ? 0 : above > 65535 ? 65535 : above;
                const double at = floor(place * gains[g] / 4096) / 256;
                const int i = at >= 16 ? 15 : (int)at;
                const double share = at >= 16 ? 1 : at - i;
                const double wanted = table.values[i] + share * (table.values[i + 1] - table.values[i]);
                if (fabs(labial_protrusion(&table, sum) - wanted) > 0.5)
                    fail_msg("from %d, gain %u: %d for %ld, not %g", lows[l], gains[g], labial_protrusion(&table, sum),
                             (long)sum, wanted);
            }
        }
}

/* A case by hand: 16 intervals of 10 FAP units from -80 on, which rise by 20 each. */
TEST(a_table_by_hand)
{
    table.low = -80 * 16;
    table.gain = 3277; /* 2^24 / (2 * 160 * 16) */
    for (unsigned i = 0; i < LABIAL_PROTRUSION_VALUES; i++)
        table.values[i] = (int16_t)(i * 20 * 16);
    assert_int_equal(labial_protrusion(&table, 2 * -200 * 16), 0);
    assert_int_equal(labial_protrusion(&table, 2 * -80 * 16), 0);
    assert_in_range(labial_protrusion(&table, 2 * -75 * 16), 10 * 16 - 2, 10 * 16 + 2);
    assert_in_range(labial_protrusion(&table, (10 - 10) * 16), 160 * 16 - 2, 160 * 16 + 2);
    assert_int_equal(labial_protrusion(&table, 2 * 80 * 16), 320 * 16);
    assert_int_equal(labial_protrusion(&table, 2 * 2000 * 16), 320 * 16);
}

/* Would catch channels that end up in the place of others, a spacing that is not kept, corners of another channel. */
TEST(frames_are_made_of_their_sources)
{
    enum { SPACING = 3 };
    static const uint8_t sources[LABIAL_CHANNELS] = { 0, 1, LABIAL_FROM_CORNERS, 2, 3, 4, 7, 5, 5, 6, 6, 7, 0 };
    int16_t motion[8 * SPACING], frame[LABIAL_CHANNELS];
    fill(3, -1000, 900, 4000);
    memcpy(model.sources, sources, sizeof sources);
    for (unsigned i = 0; i < sizeof motion / sizeof motion[0]; i++)
        motion[i] = (int16_t)(100 * (int)i - 700);
    labial_followers_complete(&model, motion + 1, SPACING, frame);
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++)
        if (k == 2)
            assert_int_equal(frame[k], labial_protrusion(&table, motion[4 * SPACING + 1] + motion[7 * SPACING + 1]));
        else
            assert_int_equal(frame[k], motion[sources[k] * SPACING + 1]);
    model.sources[2] = 3;
    labial_followers_complete(&model, motion, SPACING, frame);
    assert_int_equal(frame[2], motion[3 * SPACING]);
}

SUITE(setup, NULL)
