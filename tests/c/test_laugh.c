/*
 * test_laugh.c - laughs of a wanted length: exact totals, no state but the caller's, phonemes that the model has.
 */
#include "suite.h"
#include "labial/laugh.h"
#include "laugh_table.h"
#include "laughs.h"
#include "laughter_synthetic.h"

typedef struct {
    uint32_t total, shortest;
    unsigned phonemes;
} sum_t;

static sum_t sum_of(uint32_t length, unsigned intensity, uint32_t seed)
{
    labial_laugh_t laugh, moved;
    sum_t sum = { 0 };
    unsigned phoneme;
    uint32_t ms;
    sum.shortest = UINT32_MAX;
    memset(&laugh, 0xee, sizeof laugh);
    assert_ok(labial_laugh_init(&laugh, length, intensity, fixture_seed(seed)));
    for (;;) {
        moved = laugh;
        memset(&laugh, 0xdd, sizeof laugh);
        const int result = labial_laugh_next(&moved, &phoneme, &ms);
        laugh = moved;
        if (result != LABIAL_OK) {
            assert_int_equal(result, LABIAL_DONE);
            break;
        }
        assert_true(phoneme < LABIAL_LAUGH_PHONEMES);
        assert_true(++sum.phonemes <= length / 20u + 1u);
        sum.total += ms;
        sum.shortest = ms < sum.shortest ? ms : sum.shortest;
    }
    assert_int_equal(labial_laugh_next(&laugh, &phoneme, &ms), LABIAL_DONE);
    return sum;
}

/* Would catch a phoneme that is lost, counted twice or cut to nothing at the end, at any length. */
TEST(totals_are_exact)
{
    for (uint32_t length = 0; length < 6000; length += length < 700 ? 1 : 37)
        for (uint32_t seed = 0; seed < 4; seed++)
            for (unsigned intensity = 0; intensity <= LABIAL_LAUGH_FULL; intensity += 64) {
                const sum_t sum = sum_of(length, intensity, seed * 77u);
                assert_int_equal(sum.total, length);
                assert_true(sum.phonemes == 0 || sum.shortest >= (length < 20 ? length : 20));
            }
    assert_int_equal(sum_of(LABIAL_DURATION_MAX, 128, 5).total, LABIAL_DURATION_MAX);
}

/* Would catch a generator that stays where it is: of its own this seed's state would be 0. */
TEST(the_generators_state_is_never_none)
{
    labial_laugh_t laugh;
    assert_ok(labial_laugh_init(&laugh, 5000, 128, 2342946167u));
    assert_int_not_equal(laugh.random, 0);
}

/* Would catch a step of the grammar, a draw or a rounding that is not the exporter's: each laugh is the reference's, phoneme
 * by phoneme. */
TEST(laughs_are_those_of_the_reference)
{
    for (unsigned i = 0; i < COUNT_OF(laughs); i++) {
        static uint8_t bytes[3 * 2000];
        labial_laugh_t laugh;
        unsigned phoneme;
        uint32_t count = 0, ms;
        assert_ok(labial_laugh_init(&laugh, laughs[i].milliseconds, laughs[i].intensity, laughs[i].seed));
        for (; labial_laugh_next(&laugh, &phoneme, &ms) == LABIAL_OK; count++) {
            assert_true(3u * count < sizeof bytes && ms < 65536u);
            bytes[3u * count] = (uint8_t)phoneme;
            bytes[3u * count + 1u] = (uint8_t)ms;
            bytes[3u * count + 2u] = (uint8_t)(ms >> 8);
        }
        assert_int_equal(count, laughs[i].count);
        assert_int_equal(fixture_crc32(bytes, 3u * count), laughs[i].crc);
    }
}

TEST(more_than_the_highest_intensity_is_the_highest)
{
    const sum_t most = sum_of(9000, LABIAL_LAUGH_FULL, 3), more = sum_of(9000, LABIAL_LAUGH_FULL + 1u, 3),
                far = sum_of(9000, 70000u, 3);
    assert_memory_equal(&most, &more, sizeof most);
    assert_memory_equal(&most, &far, sizeof most);
}

TEST(errors)
{
    labial_laugh_t laugh;
    unsigned phoneme = 99;
    uint32_t ms = 99;
    assert_int_equal(labial_laugh_init(NULL, 100, 1, 1), LABIAL_ERROR_NULL);
    assert_int_equal(labial_laugh_init(&laugh, LABIAL_DURATION_MAX + 1u, 1, 1), LABIAL_ERROR_DURATION);
    assert_ok(labial_laugh_init(&laugh, 0, 1, 1));
    assert_int_equal(labial_laugh_next(&laugh, &phoneme, &ms), LABIAL_DONE);
    assert_true(phoneme == 99 && ms == 99);
    assert_ok(labial_laugh_init(&laugh, 100, 1, 1));
    assert_int_equal(labial_laugh_next(NULL, &phoneme, &ms), LABIAL_ERROR_NULL);
    assert_int_equal(labial_laugh_next(&laugh, NULL, &ms), LABIAL_ERROR_NULL);
    assert_int_equal(labial_laugh_next(&laugh, &phoneme, NULL), LABIAL_ERROR_NULL);
}

/* What a laugh came to, FAP units. */
typedef struct {
    int32_t opening, jaw; /* the largest */
    int32_t corner;       /* the sum of all frames' FAP 53 */
    uint32_t frames;
} seen_t;

static void see(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    seen_t *seen = (seen_t *)user;
    const int32_t opening = -(faps[3] + faps[4]);
    (void)frame;
    seen->opening = opening > seen->opening ? opening : seen->opening;
    seen->jaw = faps[0] > seen->jaw ? faps[0] : seen->jaw;
    seen->corner += faps[5];
    seen->frames++;
}

/* Three seconds of laughter by the bundled model, as a program would have them. */
static seen_t laughed(unsigned intensity, uint32_t seed)
{
    static labial_t stream;
    static uint32_t workspace[LAUGHTER_SYNTHETIC_WORKSPACE_SIZE / 4];
    labial_laugh_t laugh;
    unsigned phoneme;
    uint32_t ms;
    seen_t seen = { 0 };
    int result;
    assert_int_equal(labial_init(&stream, &laughter_synthetic, workspace, sizeof workspace, see, &seen), 0);
    assert_ok(labial_exact(&stream, 1));
    assert_ok(labial_laugh_init(&laugh, 3000, intensity, seed));
    while (labial_laugh_next(&laugh, &phoneme, &ms) == LABIAL_OK) {
        while (labial_room(&stream) == 0)
            assert_true(labial_tick(&stream) >= 0);
        assert_ok(labial_push(&stream, phoneme, ms));
    }
    assert_ok(labial_end(&stream));
    while ((result = labial_tick(&stream)) != LABIAL_DONE)
        assert_true(result >= 0);
    assert_int_equal(seen.frames, 3u * LAUGHTER_SYNTHETIC_FPS);
    return seen;
}

/* Would catch phoneme numbers that are not the bundled model's. */
#define PAIR(name) LABIAL_LAUGH_##name, LAUGHTER_SYNTHETIC_##name
TEST(the_numbers_are_the_bundled_models)
{
    static const unsigned pairs[] = { PAIR(PHONEMES),
                                      PAIR(SILENCE),
                                      PAIR(NE),
                                      PAIR(CLICK),
                                      PAIR(NASAL),
                                      PAIR(PLOSIVE),
                                      PAIR(FRICATIVE),
                                      PAIR(IC),
                                      PAIR(E),
                                      PAIR(O),
                                      PAIR(GRUNT),
                                      PAIR(CACKLE),
                                      PAIR(A),
                                      PAIR(FRICATIVE_SOFT),
                                      PAIR(FRICATIVE_LOUD),
                                      PAIR(IC_SOFT),
                                      PAIR(IC_LOUD),
                                      PAIR(E_SOFT),
                                      PAIR(E_LOUD),
                                      PAIR(O_SOFT),
                                      PAIR(O_LOUD),
                                      PAIR(CACKLE_SOFT),
                                      PAIR(CACKLE_LOUD),
                                      PAIR(A_SOFT),
                                      PAIR(A_LOUD) };
    for (unsigned i = 0; i < COUNT_OF(pairs); i += 2)
        assert_int_equal(pairs[i], pairs[i + 1]);
}

/* Would catch an intensity that does not reach the mouth: at 0 a hum behind nearly closed lips, at the highest a mouth
 * wide open, jaw and corners with it, and in each step between more than in the one before. */
TEST(intensity_reaches_the_mouth)
{
    enum { SEEDS = 12, STEPS = 4 };
    seen_t sum[STEPS + 1];
    memset(sum, 0, sizeof sum);
    for (unsigned step = 0; step <= STEPS; step++)
        for (uint32_t seed = 0; seed < SEEDS; seed++) {
            const seen_t seen = laughed(step * LABIAL_LAUGH_FULL / STEPS, seed);
            sum[step].opening += seen.opening;
            sum[step].jaw += seen.jaw;
            sum[step].corner += seen.corner;
            assert_true(step > 0 || seen.opening < 180);
            assert_true(step < STEPS || seen.opening >= 400);
        }
    assert_true(sum[0].opening < 120 * SEEDS && sum[0].jaw < 140 * SEEDS);
    assert_true(sum[STEPS].jaw > 3 * sum[0].jaw && 2 * sum[STEPS].corner > 3 * sum[0].corner);
    for (unsigned step = 1; step <= STEPS; step++) {
        assert_true(sum[step].opening > sum[step - 1].opening);
        assert_true(sum[step].jaw > sum[step - 1].jaw);
        assert_true(sum[step].corner > sum[step - 1].corner);
    }
}

/* The first train's pulses: the median, two thirds of the corpus's without intensity and four thirds at the highest,
 * times a factor that the first draw chooses (Marsaglia's xorshift of 13, 17 and 5), rounded to the nearest. Would catch
 * another median, another draw, and a half that is off by the least that can be. */
TEST(trains_are_as_long_as_intensity_and_chance_have_it)
{
    for (unsigned intensity = 0; intensity <= LABIAL_LAUGH_FULL; intensity++)
        for (uint32_t seed = 0; seed < 300; seed++) {
            labial_laugh_t laugh;
            uint32_t x = (uint32_t)(((uint64_t)seed + 1u) * 2654435761u) + 8u;
            assert_ok(labial_laugh_init(&laugh, 5000, intensity, seed));
            x ^= x << 13;
            x ^= x >> 17;
            x ^= x << 5;
            const double wanted = TRAIN_MEDIAN * (2.0 / 3.0) * (1.0 + intensity / 256.0) * (lengths[x >> 27] / 32.0);
            assert_int_equal(laugh.pulses, (unsigned)(wanted + 0.5 + 1e-9));
        }
}

static unsigned sum_of_shares(const uint8_t *shares, const int16_t *tilts, size_t count)
{
    unsigned sum = 0;
    for (size_t i = 0; i < count; i++) {
        sum += shares[i];
        assert_true(!tilts || (tilts[i] >= -255 && tilts[i] <= 255)); /* no weight below 0 at any intensity */
    }
    return sum;
}

/* Would catch tables from other statistics, for which the generator, that clamps nothing, is not built: a duration
 * below the shortest, a period beyond its limits, a train without pulses. */
TEST(the_tables_keep_the_limits)
{
    for (size_t i = 0; i < COUNT_OF(stretches); i++)
        for (size_t j = 1; j < COUNT_OF(medians); j++)
            assert_true(medians[j] * stretches[i] / 128 * 218 / 256 >= SHORTEST);
    for (size_t i = 0; i < COUNT_OF(deviates); i++) {
        const double period = PERIOD + PERIOD_SPREAD * deviates[i] / 32.0;
        assert_true(period >= PERIOD_SHORTEST + 1 && period <= PERIOD_LONGEST);
    }
    for (size_t i = 0; i < COUNT_OF(lengths); i++) {
        assert_true(TRAIN_MEDIAN * 2.0 / 3.0 * lengths[i] / 32.0 >= .5);
        assert_true(TRAIN_MEDIAN * 4.0 / 3.0 * lengths[i] / 32.0 < TRAIN_LONGEST + .5);
    }
    assert_true(sum_of_shares(pulse_shares, pulse_tilts, COUNT_OF(pulse_shares)) <= 256);
    assert_true(sum_of_shares(vowel_shares, vowel_tilts, COUNT_OF(vowel_shares)) <= 256);
    assert_true(sum_of_shares(onset_shares, NULL, COUNT_OF(onset_shares)) <= 256);
    for (size_t i = 0; i < COUNT_OF(vowels); i++)
        assert_true(vowels[i] < COUNT_OF(soft_grades) && soft_grades[vowels[i]] > 0);
    for (size_t i = 0; i < COUNT_OF(onsets); i++)
        assert_true(onsets[i] > 0 && onsets[i] < COUNT_OF(medians));
    for (size_t i = 0; i < COUNT_OF(soft_grades); i++)
        assert_true(soft_grades[i] == 0 ||
                    (soft_grades[i] >= COUNT_OF(soft_grades) && soft_grades[i] + 1 < LABIAL_LAUGH_PHONEMES));
}

SUITE(NULL, NULL)
