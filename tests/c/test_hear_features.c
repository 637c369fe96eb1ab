/*
 * test_hear_features.c - what the network hears, against a plain transform in double precision: energies of bands, the
 * level that they are relative to, and sounds that have neither.
 */
#include "suite.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "hear_parts.h"

#define PI 3.14159265358979323846
#define WINDOW LABIAL_HEAR_WINDOW_
#define BANDS LABIAL_HEAR_BANDS
#define LEAST (-1152) /* -2.25 in Q9, the feature of silence */

static double mel(double hertz)
{
    return 1127 * log(1 + hertz / 700);
}

/* log2 energies of the bands of a window, by the definitions in features.py. */
static void energies(const int16_t *window, double out[BANDS])
{
    double sums[BANDS] = { 0 };
    unsigned k, i, b;
    for (k = 1; k < WINDOW / 2; k++) {
        const double place = (mel(62.5 * k) - mel(120)) / (mel(7600) - mel(120)) * (BANDS + 1);
        double re = 0, im = 0;
        for (i = 0; i < WINDOW; i++) {
            const double value = window[i] * (0.5 - 0.5 * cos(2 * PI * i / WINDOW));
            re += value * cos(2 * PI * k * i / WINDOW);
            im -= value * sin(2 * PI * k * i / WINDOW);
        }
        for (b = 0; b < BANDS; b++) {
            const double distance = fabs(place - b - 1);
            sums[b] += distance < 1 ? (1 - distance) * (re * re + im * im) : 0;
        }
    }
    for (b = 0; b < BANDS; b++)
        out[b] = sums[b] > 2 ? log2(sums[b]) : 1;
}

static double mean_of(const double *values)
{
    double sum = 0;
    unsigned b;
    for (b = 0; b < BANDS; b++)
        sum += values[b] / BANDS;
    return sum;
}

/* The features of a window after one of this level, and the level, in log2. */
static double hear_after(double level, const int16_t *window, int16_t features[BANDS])
{
    labial_hear_level_t state = { 0, 0, 0, 0 };
    int16_t copy[WINDOW];
    state.level = 1; /* which any sound reaches */
    memset(copy, 0, sizeof copy);
    labial_hear_level_wait(&state);
    labial_hear_features(copy, 1, &state, features);
    assert_true(labial_hear_level_voiced(&state));
    state.level = (int32_t)lround(level * 64 * 256 * BANDS);
    memcpy(copy, window, sizeof copy);
    labial_hear_features(copy, 0, &state, features);
    return state.level / (64.0 * 256 * BANDS);
}

static double wanted(double energy, double level)
{
    const double relative = energy - level;
    return ((relative < -12 ? -12 : relative > 8 ? 8 : relative) + 3) / 4;
}

static fixture_random_t chance = { 5 };

/* A number in -1 .. 1. */
static double drawn(void)
{
    return (double)fixture_random(&chance) / 2147483648.0 - 1;
}

/* Sounds of the kinds that occur: noise, tones, clicks, at any level, with an offset or without. */
static void draw_window(unsigned kind, int16_t window[WINDOW])
{
    const double level = pow(10, -2.2 * fabs(drawn())) * 32000, offset = kind & 1u ? drawn() * 700 : 0;
    const double tones[3] = { fabs(drawn()) * PI, fabs(drawn()) * PI, fabs(drawn()) * 0.2 };
    unsigned i;
    for (i = 0; i < WINDOW; i++) {
        double value = 0;
        if (kind % 4u == 0u)
            value = drawn();
        else if (kind % 4u == 1u)
            value = (sin(tones[0] * i) + sin(tones[1] * i) + sin(tones[2] * i)) / 3;
        else if (kind % 4u == 2u)
            value = i == 100u ? 1 : 0.01 * drawn();
        else
            value = sin(tones[2] * i) > 0 ? 0.5 : -0.5;
        value = value * level + offset;
        window[i] = (int16_t)(value > 32767 ? 32767 : value < -32768 ? -32768 : lround(value));
    }
}

/* log2 of the energy of a tone that is as large as the window's sound. */
static double largest(const int16_t *window)
{
    int low = window[0], high = window[0];
    unsigned i;
    for (i = 0; i < WINDOW; i++) {
        low = window[i] < low ? window[i] : low;
        high = window[i] > high ? window[i] : high;
    }
    return high > low ? 2 * log2((high - low) / 2.0) + 12 : 0;
}

/* Would catch a wrong twiddle, window, bin, band, exponent or logarithm. Bands that are weak beside the window's sound
 * (by 42 dB and more) hold the rounding of 16 bits. */
TEST(features_are_those_of_a_transform_in_double_precision)
{
    unsigned round, b, compared = 0;
    double squares = 0;
    for (round = 0; round < FIXTURE_ROUNDS(600); round++) {
        int16_t window[WINDOW], features[BANDS];
        double energy[BANDS], level;
        unsigned strong = 0;
        draw_window(round, window);
        energies(window, energy);
        level = hear_after(13, window, features);
        for (b = 0; b < BANDS; b++) {
            const double error = features[b] / 512.0 - wanted(energy[b], level);
            if (energy[b] < largest(window) - 14)
                continue;
            assert_true(fabs(error) < 0.06);
            squares += error * error;
            strong++;
        }
        if (strong == BANDS)
            assert_true(fabs(level - (mean_of(energy) > 13 ? mean_of(energy) : 13)) < 0.03);
        compared += strong;
    }
    assert_true(compared > 8u * round);
    assert_true(sqrt(squares / compared) < 0.005);
}

/* Would catch a level that loses its way: at once up, 2.4 dB a second down, never below the least. */
TEST(the_level_follows_peaks_and_falls_slowly)
{
    int16_t window[WINDOW] = { 0 }, features[BANDS];
    double level, peak;
    unsigned hop, i;
    for (i = 0; i < WINDOW; i++)
        window[i] = (int16_t)(drawn() * 20000);
    peak = hear_after(13, window, features);
    assert_true(peak > 28 && peak < 40);
    assert_true(fabs(hear_after(peak - 5, window, features) - peak) < 1e-9);
    assert_true(fabs(hear_after(peak + 5, window, features) - (peak + 5 - 0.008)) < 1e-4);
    memset(window, 0, sizeof window);
    for (hop = 0, level = peak; hop < 100u; hop++)
        level = hear_after(level, window, features);
    assert_true(fabs(level - (peak - 0.8)) < 0.001);
    for (; hop < 4000u; hop++)
        level = hear_after(level, window, features);
    assert_true(fabs(level - 13) < 1e-9);
}

/* A level before which nothing was heard. */
static labial_hear_level_t waiting(double level)
{
    labial_hear_level_t voice = { 0, 0, 0, 0 };
    voice.level = (int32_t)lround(level * 64 * 256 * BANDS);
    labial_hear_level_wait(&voice);
    return voice;
}

/* Hears hops of white noise that is `amplitude` large; returns the level. */
static double hear_noise(labial_hear_level_t *voice, unsigned hops, double amplitude, int silent)
{
    int16_t window[WINDOW], features[BANDS];
    unsigned i;
    for (; hops > 0; hops--) {
        for (i = 0; i < WINDOW; i++)
            window[i] = (int16_t)lround(drawn() * amplitude);
        labial_hear_features(window, silent, voice, features);
    }
    return voice->level / (64.0 * 256 * BANDS);
}

/* Would catch noise before the first word that is taken for a voice, however long it lasts, and whether silence is before
 * it or the noise sets in slowly; and a level that falls meanwhile. */
TEST(noise_is_no_voice)
{
    labial_hear_level_t voice = waiting(26);
    assert_true(fabs(hear_noise(&voice, 600, 30, 0) - 26) < 1e-9 && !labial_hear_level_voiced(&voice));
    voice = waiting(26);
    hear_noise(&voice, 20, 3, 1);
    hear_noise(&voice, 1, 8, 0);
    assert_true(fabs(hear_noise(&voice, 600, 30, 0) - 26) < 1e-9 && !labial_hear_level_voiced(&voice));
}

/* Would catch a voice that is not noticed 10 dB above the noise, or one 8 dB above it that is; and one within 12 dB of the
 * level. White noise of 1,500 has a level of 27.9, and twice of that is 2 more. */
TEST(a_voice_rises_above_the_noise_or_comes_near_the_level)
{
    labial_hear_level_t voice = waiting(40);
    hear_noise(&voice, 100, 30, 0);
    hear_noise(&voice, 1, 72, 0);
    assert_false(labial_hear_level_voiced(&voice));
    hear_noise(&voice, 1, 100, 0);
    assert_true(labial_hear_level_voiced(&voice));
    voice = waiting(33);
    hear_noise(&voice, 1, 1500, 0);
    assert_false(labial_hear_level_voiced(&voice));
    voice = waiting(31);
    hear_noise(&voice, 1, 1500, 0);
    assert_true(labial_hear_level_voiced(&voice));
}

/* Would catch a level that stays above a quiet voice: it falls by 3 a second until a hop reaches it, then by .8. */
TEST(the_level_looks_for_a_quiet_voice)
{
    labial_hear_level_t voice = waiting(26);
    double level, before;
    hear_noise(&voice, 10, 30, 0);
    before = hear_noise(&voice, 1, 100, 0);
    assert_true(fabs(before - (26 - 0.03)) < 1e-4);
    level = hear_noise(&voice, 50, 100, 0);
    assert_true(fabs(before - level - 1.5) < 1e-3);
    before = hear_noise(&voice, 400, 100, 0);
    assert_true(before > 19 && before < 22);
    level = hear_noise(&voice, 100, 3, 0);
    assert_true(fabs(before - level - 0.8) < 1e-3);
}

/* Would catch silence, or a constant, that sounds like anything; also after the loudest sound. */
TEST(silence_and_constants_have_the_least_features)
{
    static const int16_t constants[] = { 0, 1, -1, 8520, 32767, -32768 };
    unsigned i, k, b;
    for (i = 0; i < sizeof constants / sizeof constants[0]; i++) {
        int16_t window[WINDOW], features[BANDS];
        for (k = 0; k < WINDOW; k++)
            window[k] = constants[i];
        hear_after(i % 2u ? 13 : 40, window, features);
        for (b = 0; b < BANDS; b++)
            assert_int_equal(features[b], LEAST);
    }
}

/* Would catch an offset that covers a quiet voice: the same voice, 40 dB below full scale, with and without. */
TEST(an_offset_is_not_heard)
{
    int16_t plain[WINDOW], moved[WINDOW], features[2][BANDS];
    unsigned i, b;
    for (i = 0; i < WINDOW; i++) {
        plain[i] = (int16_t)(150 * sin(0.1 * i) + 100 * sin(0.7 * i) + 70 * drawn());
        moved[i] = (int16_t)(plain[i] + 8520);
    }
    hear_after(13, plain, features[0]);
    hear_after(13, moved, features[1]);
    for (b = 0; b < BANDS; b++)
        assert_int_equal(features[0][b], features[1][b]);
}

/* Would catch a voice that is heard otherwise when it is quiet: 40 dB less, after its own level. */
TEST(a_quiet_voice_has_the_features_of_a_loud_one)
{
    int16_t loud[WINDOW], quiet[WINDOW], features[2][BANDS];
    unsigned i, b;
    for (i = 0; i < WINDOW; i++) {
        loud[i] = (int16_t)(9000 * sin(0.11 * i) + 6000 * sin(0.72 * i) + 4000 * drawn());
        quiet[i] = (int16_t)lround(loud[i] / 100.0);
    }
    hear_after(13, loud, features[0]);
    hear_after(13, quiet, features[1]);
    for (b = 0; b < BANDS; b++)
        assert_true(abs(features[0][b] - features[1][b]) < 0.1 * 512);
}

/* Would catch a sound that is clipped at both ends and heard louder than one that is clipped a step before. */
TEST(the_whole_range_is_heard_like_nearly_all_of_it)
{
    unsigned round, i, b;
    for (round = 0; round < FIXTURE_ROUNDS(100); round++) {
        int16_t whole[WINDOW], nearly[WINDOW], features[2][BANDS];
        for (i = 0; i < WINDOW; i++) {
            const double value = 60000 * sin(0.05 * (1 + round % 20) * i) + 9000 * drawn();
            whole[i] = (int16_t)(value > 32767 ? 32767 : value < -32768 ? -32768 : value);
            nearly[i] = (int16_t)(whole[i] < -32767 ? -32767 : whole[i]);
        }
        assert_true(fabs(hear_after(13, whole, features[0]) - hear_after(13, nearly, features[1])) < 0.05);
        for (b = 0; b < BANDS; b++)
            assert_true(abs(features[0][b] - features[1][b]) < 0.1 * 512);
    }
}

/* Would catch an intermediate sum beyond its type, which the sanitizer reports: the loudest sounds there are. */
TEST(the_loudest_sounds_stay_within_their_types)
{
    unsigned round, i, b;
    for (round = 0; round < FIXTURE_ROUNDS(200); round++) {
        int16_t window[WINDOW], features[BANDS];
        const unsigned period = 1u + round % 64u;
        for (i = 0; i < WINDOW; i++)
            window[i] = round < 100u                    ? (i / period % 2u ? 32767 : -32768)
                        : fixture_random(&chance) >> 31 ? 32767
                                                        : -32768;
        assert_true(hear_after(13, window, features) < 45);
        for (b = 0; b < BANDS; b++)
            assert_true(features[b] >= LEAST && features[b] <= 1408);
    }
}

SUITE(NULL, NULL)
