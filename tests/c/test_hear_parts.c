/*
 * test_hear_parts.c - the steps of hearing before its network (lib/hear_parts.h).
 *
 * The conversion of rates: tones keep their level and their place below the half of either rate, and vanish above; a
 * constant stays one; what is added up stays within 32 bits. What the network hears, against a plain transform in double
 * precision: energies of bands, the level that they are relative to, and sounds that have neither.
 */
#include "suite.h"
#include "hear_convert_table.h"
#include "hear_parts.h"

/* ---- The conversion of rates ------------------------------------------------------------------------------------- */

#define PI 3.14159265358979323846
#define OUT 1600u
#define EDGE 100u

static labial_hear_convert_t convert;
static int16_t out[2u * OUT];

/* Converts a tone of `hertz` and amplitude 10000; returns how many samples came of `count`. */
static unsigned convert_tone(uint32_t rate, double hertz, unsigned count)
{
    unsigned made = 0;
    assert_ok(labial_hear_convert_init(&convert, rate));
    for (unsigned i = 0; i < count; i++) {
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
    for (unsigned i = EDGE; i < made - EDGE; i++) {
        const double error = out[i] - amplitude * sin(2 * PI * hertz * i / 16000);
        sum += error * error;
    }
    return sqrt(sum / (made - 2 * EDGE));
}

static const struct {
    uint32_t rate;
    unsigned reach; /* samples that follow before a sample is converted */
} rates[] = { { 8000, 6 }, { 12000, 6 }, { 22050, 8 }, { 24000, 8 }, { 32000, 11 }, { 44100, 16 }, { 48000, 16 } };

#define RATES COUNT_OF(rates)

/* Would catch another gain or delay than none, and phases that jump. */
TEST(low_tones_keep_their_level_and_place)
{
    static const double tones[] = { 100, 500, 1000, 2000, 3000 };
    for (unsigned i = 0; i < RATES; i++)
        for (unsigned t = 0; t < COUNT_OF(tones); t++) {
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
    for (unsigned i = 0; i < RATES; i++)
        for (unsigned t = 0; t < COUNT_OF(tones); t++)
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
    int16_t two[LABIAL_HEAR_CONVERTED_MAX];
    for (unsigned i = 0; i < RATES; i++) {
        const uint64_t rate = rates[i].rate;
        uint64_t made = 0;
        assert_ok(labial_hear_convert_init(&convert, rates[i].rate));
        assert_int_equal(convert.reach, rates[i].reach);
        for (unsigned n = 0; n < 30000u; n++) {
            const uint64_t known = n < rates[i].reach ? 0 : n + 1u - rates[i].reach; /* samples with all that follows */
            made += labial_hear_convert(&convert, 0, two);
            assert_int_equal(made, (known * 16000u + rate - 1u) / rate);
        }
    }
}

/* The worst sum of the filter, over all phases, times the worst sample, and a sum that is one. */
TEST(no_sum_overflows)
{
    for (unsigned i = 0; i < COUNT_OF(conversions); i++) {
        const unsigned spacing = conversions[i].spacing;
        for (unsigned distance = 0; distance <= spacing; distance++) {
            int32_t sum = 0, magnitude = 0;
            for (unsigned k = 0; k < conversions[i].reach; k++) {
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
    unsigned made = 0;
    for (unsigned i = 0; i < RATES; i++) {
        assert_ok(labial_hear_convert_init(&convert, rates[i].rate));
        for (unsigned l = 0; l < COUNT_OF(levels); l++) {
            labial_hear_convert_reset(&convert);
            for (unsigned n = 0; n < 2000u; n++) {
                const unsigned count = labial_hear_convert(&convert, levels[l], out);
                assert_int_equal(labial_hear_convert_last(&convert), levels[l]);
                for (unsigned k = 0; k < count; k++)
                    assert_true(abs(out[k] - levels[l]) <= abs(levels[l]) / 4000);
                made += count;
            }
        }
    }
    assert_true(made > 5u * RATES * 600u);
    assert_int_equal(labial_hear_convert_init(&convert, 11025), LABIAL_ERROR_SAMPLE_RATE);
}

/* ---- Features ---------------------------------------------------------------------------------------------------- */

#define WINDOW LABIAL_HEAR_WINDOW_
#define BANDS LABIAL_HEAR_BANDS
#define LEAST (-1152) /* -2.25 in Q9, the feature of silence */

static double mel(double hertz)
{
    return 1127 * log(1 + hertz / 700);
}

/* log2 energies of the bands of a window, by the definitions in features.py. */
static void energies(const int16_t *window, double found[BANDS])
{
    double sums[BANDS] = { 0 };
    for (unsigned k = 1; k < WINDOW / 2; k++) {
        const double place = (mel(62.5 * k) - mel(120)) / (mel(7600) - mel(120)) * (BANDS + 1);
        double re = 0, im = 0;
        for (unsigned i = 0; i < WINDOW; i++) {
            const double value = window[i] * (0.5 - 0.5 * cos(2 * PI * i / WINDOW));
            re += value * cos(2 * PI * k * i / WINDOW);
            im -= value * sin(2 * PI * k * i / WINDOW);
        }
        for (unsigned b = 0; b < BANDS; b++) {
            const double distance = fabs(place - b - 1);
            sums[b] += distance < 1 ? (1 - distance) * (re * re + im * im) : 0;
        }
    }
    for (unsigned b = 0; b < BANDS; b++)
        found[b] = sums[b] > 2 ? log2(sums[b]) : 1;
}

static double mean_of(const double *values)
{
    double sum = 0;
    for (unsigned b = 0; b < BANDS; b++)
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

/* A number in -1 .. 1. */
static double drawn(void)
{
    return (double)chance() / 2147483648.0 - 1;
}

/* Sounds of the kinds that occur: noise, tones, clicks, at any level, with an offset or without. */
static void draw_window(unsigned kind, int16_t window[WINDOW])
{
    const double level = pow(10, -2.2 * fabs(drawn())) * 32000, offset = kind & 1u ? drawn() * 700 : 0;
    const double tones[3] = { fabs(drawn()) * PI, fabs(drawn()) * PI, fabs(drawn()) * 0.2 };
    for (unsigned i = 0; i < WINDOW; i++) {
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
    for (unsigned i = 0; i < WINDOW; i++) {
        low = window[i] < low ? window[i] : low;
        high = window[i] > high ? window[i] : high;
    }
    return high > low ? 2 * log2((high - low) / 2.0) + 12 : 0;
}

/* Would catch a wrong twiddle, window, bin, band, exponent or logarithm. Bands that are weak beside the window's sound
 * (by 42 dB and more) hold the rounding of 16 bits. */
TEST(features_are_those_of_a_transform_in_double_precision)
{
    unsigned round, compared = 0;
    double squares = 0;
    for (round = 0; round < FIXTURE_ROUNDS(600); round++) {
        int16_t window[WINDOW], features[BANDS];
        double energy[BANDS], level;
        unsigned strong = 0;
        draw_window(round, window);
        energies(window, energy);
        level = hear_after(13, window, features);
        for (unsigned b = 0; b < BANDS; b++) {
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
    unsigned hop;
    for (unsigned i = 0; i < WINDOW; i++)
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
    for (; hops > 0; hops--) {
        for (unsigned i = 0; i < WINDOW; i++)
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

/* Would catch an intermediate sum beyond its type, which the sanitizer reports: the loudest sounds there are. */
TEST(the_loudest_sounds_stay_within_their_types)
{
    for (unsigned round = 0; round < FIXTURE_ROUNDS(200); round++) {
        int16_t window[WINDOW], features[BANDS];
        const unsigned period = 1u + round % 64u;
        for (unsigned i = 0; i < WINDOW; i++)
            window[i] = round < 100u ? (i / period % 2u ? 32767 : -32768) : chance() >> 31 ? 32767 : -32768;
        assert_true(hear_after(13, window, features) < 45);
        for (unsigned b = 0; b < BANDS; b++)
            assert_true(features[b] >= LEAST && features[b] <= 1408);
    }
}

SUITE(NULL, NULL)
