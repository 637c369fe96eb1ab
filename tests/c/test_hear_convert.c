/*
 * test_hear_convert.c - the conversion of rates: tones keep their level and their place below the half of either rate,
 * and vanish above; a constant stays one; what is added up stays within 32 bits.
 */
#include "suite.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "hear_parts.h"
#include "hear_convert_table.h"

#define PI 3.14159265358979323846
#define OUT 1600u
#define EDGE 100u

static labial_hear_convert_t convert;
static int16_t out[2u * OUT];

/* Converts a tone of `hertz` and amplitude 10000; returns how many samples came of `count`. */
static unsigned convert_tone(uint32_t rate, double hertz, unsigned count)
{
    unsigned i, made = 0;
    assert_int_equal(labial_hear_convert_init(&convert, rate), LABIAL_OK);
    for (i = 0; i < count; i++) {
        const int32_t sample = (int32_t)lround(10000 * sin(2 * PI * hertz * i / rate));
        const unsigned more = labial_hear_convert(&convert, sample, out + made);
        assert_true(more <= LABIAL_HEAR_CONVERTED_MAX);
        made += more;
    }
    return made;
}

/* The root of the mean square of what differs from a tone of this amplitude in its place, away from both ends. */
static double deviation(unsigned made, double hertz, double amplitude)
{
    double sum = 0;
    unsigned i;
    for (i = EDGE; i < made - EDGE; i++) {
        const double error = out[i] - amplitude * sin(2 * PI * hertz * i / 16000);
        sum += error * error;
    }
    return sqrt(sum / (made - 2 * EDGE));
}

static const struct {
    uint32_t rate;
    unsigned reach; /* samples that follow before a sample is converted */
} rates[] = { { 8000, 6 }, { 12000, 6 }, { 22050, 8 }, { 24000, 8 }, { 32000, 11 }, { 44100, 16 }, { 48000, 16 } };

#define RATES (sizeof rates / sizeof rates[0])

/* Would catch another gain or delay than none, and phases that jump. */
TEST(low_tones_keep_their_level_and_place)
{
    static const double tones[] = { 100, 500, 1000, 2000, 3000 };
    unsigned i, t;
    for (i = 0; i < RATES; i++)
        for (t = 0; t < sizeof tones / sizeof tones[0]; t++) {
            const unsigned made = convert_tone(rates[i].rate, tones[t], rates[i].rate / 10u);
            if (tones[t] > rates[i].rate * 0.3)
                continue;
            assert_true(made > 1500u && made < OUT);
            assert_true(deviation(made, tones[t], 10000) < 7071 * 0.02); /* 34 dB below the tone */
        }
}

/* Would catch a filter that lets high tones through, which would be heard as low ones. */
TEST(tones_beyond_8_kHz_vanish)
{
    static const double tones[] = { 10500, 12000, 15000, 19000, 21000 };
    unsigned i, t;
    for (i = 0; i < RATES; i++)
        for (t = 0; t < sizeof tones / sizeof tones[0]; t++)
            if (tones[t] < rates[i].rate / 2u)
                assert_true(deviation(convert_tone(rates[i].rate, tones[t], rates[i].rate / 10u), 0, 0) < 7071 * 0.01);
}

/* Would catch images of a sound of 8 kHz, which would sound like s: what differs from a tone of 1.5 kHz in any way. */
TEST(no_image_remains_above_the_sound)
{
    assert_true(deviation(convert_tone(8000, 1500, 800), 1500, 10000) < 7071 * 0.005);
    assert_true(deviation(convert_tone(12000, 1500, 1200), 1500, 10000) < 7071 * 0.005);
}

/* Would catch a sample that is converted too early, too late or twice: as many as fit before `reach` samples ago. */
TEST(samples_come_when_their_time_is_known)
{
    unsigned i, n;
    int16_t two[LABIAL_HEAR_CONVERTED_MAX];
    for (i = 0; i < RATES; i++) {
        const uint64_t rate = rates[i].rate;
        uint64_t made = 0;
        assert_int_equal(labial_hear_convert_init(&convert, rates[i].rate), LABIAL_OK);
        assert_int_equal(convert.reach, rates[i].reach);
        for (n = 0; n < 30000u; n++) {
            const uint64_t known = n < rates[i].reach ? 0 : n + 1u - rates[i].reach; /* samples with all that follows */
            made += labial_hear_convert(&convert, 0, two);
            assert_int_equal(made, (known * 16000u + rate - 1u) / rate);
        }
    }
}

/* The worst sum of the filter, over all phases, times the worst sample, and a sum that is one. */
TEST(no_sum_overflows)
{
    unsigned i, distance, k;
    for (i = 0; i < sizeof conversions / sizeof conversions[0]; i++) {
        const unsigned spacing = conversions[i].spacing;
        for (distance = 0; distance <= spacing; distance++) {
            int32_t sum = 0, magnitude = 0;
            for (k = 0; k < conversions[i].reach; k++) {
                sum += filter[distance + k * spacing] + filter[spacing - distance + k * spacing];
                magnitude += abs(filter[distance + k * spacing]) + abs(filter[spacing - distance + k * spacing]);
            }
            assert_true(magnitude < 65536);
            assert_true(!conversions[i].reach || abs(sum * (int32_t)spacing / 16 - 32768) < 10);
        }
    }
}

/* Would catch an offset that begins with a step, or is heard as a tone since phases of the filter add up to different
 * sums; and one of the sound before that is left after a reset. */
TEST(a_constant_stays_one_from_its_first_sample_on)
{
    static const int32_t levels[] = { 9830, -12000, 32767, -32768, 1 };
    unsigned i, n, k, l, made = 0;
    for (i = 0; i < RATES; i++) {
        assert_int_equal(labial_hear_convert_init(&convert, rates[i].rate), LABIAL_OK);
        for (l = 0; l < sizeof levels / sizeof levels[0]; l++) {
            labial_hear_convert_reset(&convert);
            for (n = 0; n < 2000u; n++) {
                const unsigned count = labial_hear_convert(&convert, levels[l], out);
                assert_int_equal(labial_hear_convert_last(&convert), levels[l]);
                for (k = 0; k < count; k++)
                    assert_true(abs(out[k] - levels[l]) <= abs(levels[l]) / 4000);
                made += count;
            }
        }
    }
    assert_true(made > 5u * RATES * 600u);
}

/* Would catch a sum that wraps round where it should be held. */
TEST(full_scale_is_held)
{
    static const int32_t levels[] = { 32767, -32768 };
    unsigned i, n, k, most = 0, least = 0;
    for (i = 0; i < RATES; i++) {
        int last = 0;
        assert_int_equal(labial_hear_convert_init(&convert, rates[i].rate), LABIAL_OK);
        for (n = 0; n < 20000u; n++) {
            const unsigned level = n / 50u % 2u, count = labial_hear_convert(&convert, levels[level], out);
            for (k = 0; k < count; k++) {
                most += out[k] == 32767;
                least += out[k] == -32768;
                if (n % 50u > 40u) /* in the middle of a half wave, whose ripple is small */
                    assert_true(level ? out[k] < -30000 : out[k] > 30000);
                last = out[k];
            }
        }
        assert_true(last != 0);
    }
    assert_true(most > 100u && least > 100u);
}

TEST(other_rates_are_refused)
{
    assert_int_equal(labial_hear_convert_init(&convert, 0), LABIAL_ERROR_SAMPLE_RATE);
    assert_int_equal(labial_hear_convert_init(&convert, 11025), LABIAL_ERROR_SAMPLE_RATE);
    assert_int_equal(labial_hear_convert_init(&convert, 96000), LABIAL_ERROR_SAMPLE_RATE);
}

SUITE(NULL, NULL)
