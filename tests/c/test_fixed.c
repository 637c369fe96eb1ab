/*
 * test_fixed.c - the shared arithmetic, in both of its forms, against exact 64-bit integers and doubles.
 */
#include "suite.h"

/* Header and division twice: once for cores with 64-bit products, once for those without. */
#define LABIAL_NARROW_MULTIPLY 0
#include "fixed.h"
#undef LABIAL_FIXED_H
#undef LABIAL_NARROW_MULTIPLY
#define LABIAL_NARROW_MULTIPLY 1
#define labial_arithmetic_shift_is_required narrow_arithmetic_shift_is_required
#define labial_part16 narrow_part16
#define labial_part24 narrow_part24
#define labial_add narrow_add
#define labial_sub narrow_sub
#define labial_mulshift narrow_mulshift
#define labial_weight narrow_weight
#define labial_z narrow_z
#define labial_z_cost narrow_z_cost
#define labial_ease narrow_ease
#define labial_clamp narrow_clamp
#define labial_position narrow_position
#define labial_scaled narrow_scaled
#define labial_quotient narrow_quotient
#include "fixed.h"
#include "fixed.c"
#undef labial_add
#undef labial_sub
#undef labial_mulshift
#undef labial_part16
#undef labial_part24
#undef labial_weight
#undef labial_z
#undef labial_z_cost
#undef labial_ease
#undef labial_clamp
#undef labial_position
#undef labial_scaled
#undef labial_quotient

static const int32_t corners[] = {
    0,     1,       -1,         2,          -2,          3,         255,           -256,
    32767, 32768,   -32768,     -32769,     65535,       65536,     -65536,        -65537,
    98304, 1 << 20, 0x7fff8000, 0x7fffffff, -0x7fffffff, INT32_MIN, INT32_MIN + 1, 0x55555555
};

#define CORNERS COUNT_OF(corners)

/* floor((a b + offset) / 2^shift) modulo 2^32, by division. */
static uint32_t wanted_product(int32_t a, int32_t b, int64_t offset, unsigned shift)
{
    const int64_t unit = (int64_t)1 << shift, sum = (int64_t)a * b + offset;
    int64_t quotient = sum / unit;
    if (sum % unit < 0)
        quotient--;
    return (uint32_t)(quotient & 0xffffffff);
}

static void check_product(int32_t a, int32_t b, unsigned shift)
{
    const uint32_t wanted = wanted_product(a, b, 0, shift);
    assert_int_equal((uint32_t)labial_mulshift(a, b, shift), wanted);
    assert_int_equal((uint32_t)narrow_mulshift(a, b, shift), wanted);
}

/* Would catch a lost carry between the four small products, and rounding that differs from target to target. */
TEST(products_are_rounded_alike_and_exactly)
{
    fixture_random_t random = { 1 };
    for (unsigned shift = 16; shift <= 31; shift++) {
        for (unsigned i = 0; i < CORNERS; i++)
            for (unsigned k = 0; k < CORNERS; k++)
                check_product(corners[i], corners[k], shift);
        for (unsigned i = 0; i < 20000; i++) {
            const int32_t a = (int32_t)fixture_random(&random), b = (int32_t)fixture_random(&random);
            check_product(a, b, shift);
            check_product(a >> (i % 31), b >> (i / 31 % 31), shift);
        }
    }
}

/* x f / 2^16 rounded down, for every f up to one, and x f / 2^24 less than three below it. Would catch a sign lost between
 * the halves of x, and a target whose parts differ from another's. */
TEST(parts_are_rounded_alike)
{
    fixture_random_t random = { 2 };
    for (unsigned i = 0; i < 400000; i++) {
        const int32_t x = i < 24 * CORNERS ? corners[i % CORNERS] : (int32_t)fixture_random(&random) >> i % 31;
        const uint32_t f = i % 5 ? fixture_below(&random, 65537) : i % 10 ? 65536 : 0;
        const uint32_t g = i % 5 ? fixture_below(&random, (1u << 24) + 1) : i % 10 ? 1u << 24 : 255;
        const double exact = (double)x * g / 16777216.0;
        assert_int_equal((uint32_t)labial_part16(x, f), wanted_product(x, (int32_t)f, 0, 16));
        assert_int_equal(narrow_part16(x, f), labial_part16(x, f));
        assert_int_equal(narrow_part24(x, g), labial_part24(x, g));
        assert_true((double)labial_part24(x, g) <= exact && (double)labial_part24(x, g) > exact - 3.0);
    }
}

TEST(weights_are_minifloats)
{
    for (unsigned code = 0; code < 256; code++) {
        assert_true((double)labial_weight((uint8_t)code) == fixture_weight_value((uint8_t)code));
        assert_true(code == 0 || labial_weight((uint8_t)code) > labial_weight((uint8_t)(code - 1)));
    }
    assert_int_equal(labial_weight(0x0f), 15);
    assert_int_equal(labial_weight(0x10), 16);
    assert_int_equal(labial_weight(0xff), 507904);
}

/* steps * scale / 2^8, halves up: with every step, at the ends of the scale and between. */
TEST(steps_are_scaled_and_rounded)
{
    static const uint16_t scales[] = { 0, 1, 127, 128, 255, 256, 257, 16383, 32767, 65535 };
    for (unsigned i = 0; i < COUNT_OF(scales); i++)
        for (int steps = -4096; steps <= 4096; steps++)
            assert_int_equal(labial_scaled(steps, scales[i]), (int)floor(steps * (double)scales[i] / 256.0 + 0.5));
}

/* z = x * gain / 2^12 in Q6 and z^2 / 2^7 the exponent, both rounded down; z ends at the limit. */
TEST(gaussian_costs_follow_their_formula)
{
    fixture_random_t random = { 3 };
    for (unsigned i = 0; i < 200000; i++) {
        const uint32_t x = fixture_random(&random) >> (16 + i % 16);
        const uint16_t gain = (uint16_t)(fixture_random(&random) >> (16 + i / 16 % 16));
        const uint32_t limit = i % 3 ? 1023 : fixture_random(&random) >> 16;
        const double exact = (double)x * gain / 4096.0;
        const uint32_t z = labial_z(x, gain, limit);
        if (exact < (double)limit)
            assert_true((double)z <= exact && exact < (double)z + 1.0);
        else
            assert_int_equal(z, limit);
        assert_int_equal(labial_z_cost(z), (uint32_t)((double)z * (double)z / 128.0));
    }
    assert_int_equal(labial_z(65535, 65535, 65535), 65535);
    assert_int_equal(labial_z(65535, 65535, 1023), 1023);
    /* One standard deviation of 100 is half a nat, 16 cost units. */
    assert_in_range(labial_z_cost(labial_z(100, (uint16_t)(262144.0 / 141.421356 + 0.5), 1023)), 15, 16);
}

/* 3 s^2 - 2 s^3 in Q14, of an s that is rounded down as its square and the result are: would catch a jolt, a turn, an
 * end that is not reached, and an overflow with the longest easing there is (1,000 frames), the shortest, or what is
 * said to be the most. */
TEST(easing_follows_its_curve)
{
    for (unsigned steps = 1; steps <= 65535; steps = steps < 1000 ? steps + 1 : steps < 1002 ? 65535 : 65536) {
        int32_t last = 0;
        assert_int_equal(labial_ease(0, steps), 0);
        assert_int_equal(labial_ease(steps, steps), 16384);
        for (unsigned step = 1; step <= steps; step++) {
            const double s = (double)step / steps, wanted = 16384.0 * s * s * (3.0 - 2.0 * s);
            const int32_t gone = labial_ease(step, steps);
            /* 1.5 for s, 3 for its square, 1 for the result */
            if ((double)gone > wanted + 1e-6 || (double)gone < wanted - 5.5 || (steps <= 1000 && gone < last))
                fail_msg("step %u of %u: %d after %d, not %g", step, steps, gone, last, wanted);
            last = gone;
        }
    }
}

/* Would catch a bit of the quotient that is skipped or taken twice, and a divisor that is shifted out. */
TEST(quotients_are_exact)
{
    fixture_random_t random = { 7 };
    for (unsigned i = 0; i < CORNERS; i++)
        for (unsigned j = 0; j < CORNERS; j++) {
            const uint32_t a = (uint32_t)corners[i], b = (uint32_t)corners[j];
            if (b > 0) {
                assert_int_equal(labial_quotient(a, b), a / b);
                assert_int_equal(narrow_quotient(a, b), a / b);
            }
        }
    for (unsigned i = 0; i < FIXTURE_ROUNDS(1000000); i++) {
        const uint32_t a = fixture_below(&random, UINT32_MAX) >> fixture_below(&random, 32);
        const uint32_t b = (fixture_below(&random, UINT32_MAX) >> fixture_below(&random, 32)) + 1u;
        assert_int_equal(narrow_quotient(a, b), a / b);
    }
}

SUITE(NULL, NULL)
