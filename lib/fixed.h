/*
 * fixed.h - arithmetic that all steps share: rounded products, minifloat weights, Gaussian costs.
 *
 * Signed right shifts must be arithmetic; the build stops where they are not. Sums that a damaged model could drive
 * beyond 32 bits are computed in uint32, whose overflow is defined.
 */
#ifndef LABIAL_FIXED_H
#define LABIAL_FIXED_H

#include <stdint.h>

typedef char labial_arithmetic_shift_is_required[((-1) >> 1) == -1 ? 1 : -1];

/* 1 for cores whose widest product is 32 x 32 -> 32 bits: wider products are computed in parts. Set by hand to test
 * that both variants give the same bits. */
#ifndef LABIAL_NARROW_MULTIPLY
#if defined(__ARM_ARCH_6M__) || defined(__ARM_ARCH_8M_BASE__)
#define LABIAL_NARROW_MULTIPLY 1
#else
#define LABIAL_NARROW_MULTIPLY 0
#endif
#endif

/* A condition that holds for a reason that the prover cannot see; an ACSL assertion beside it states it to the prover.
 * Checked where LABIAL_CHECKED is defined, as in the sanitizer build (docs/testing.md). */
#ifdef LABIAL_CHECKED
#define LABIAL_CHECK(condition) ((condition) ? (void)0 : __builtin_trap())
#else
#define LABIAL_CHECK(condition) ((void)0)
#endif

/* a + b and a - b, modulo 2^32. */
static inline int32_t labial_add(int32_t a, int32_t b)
{
    return (int32_t)((uint32_t)a + (uint32_t)b);
}

static inline int32_t labial_sub(int32_t a, int32_t b)
{
    return (int32_t)((uint32_t)a - (uint32_t)b);
}

/* a * b / 2^shift, rounded down, modulo 2^32. 16 <= shift <= 31. */
static inline int32_t labial_mulshift(int32_t a, int32_t b, unsigned shift)
{
#if LABIAL_NARROW_MULTIPLY
    /* a = ah * 2^16 + al with al unsigned, likewise b. No sum overflows: 32767 * 65535 + 65535 < 2^31. */
    const int32_t al = (int32_t)((uint32_t)a & 0xffffu), bl = (int32_t)((uint32_t)b & 0xffffu);
    const int32_t ah = a >> 16, bh = b >> 16;
    const int32_t cross_a = ah * bl + (int32_t)(((uint32_t)al * (uint32_t)bl) >> 16);
    const int32_t cross_b = al * bh + (int32_t)((uint32_t)cross_a & 0xffffu);
    const int32_t high = ah * bh + (cross_a >> 16) + (cross_b >> 16);
    return (int32_t)(((uint32_t)high << (32u - shift)) | (((uint32_t)cross_b & 0xffffu) >> (shift - 16u)));
#else
    return (int32_t)(uint32_t)(uint64_t)(((int64_t)a * b) >> shift);
#endif
}

/* x * f / 2^16, rounded down, for f up to 65536. The result is not larger than x. */
static inline int32_t labial_part16(int32_t x, uint32_t f)
{
#if LABIAL_NARROW_MULTIPLY
    const uint32_t low = ((uint32_t)x & 0xffffu) * f; /* below 2^32 */
    return (x >> 16) * (int32_t)f + (int32_t)(low >> 16);
#else
    return (int32_t)(((int64_t)x * (int32_t)f) >> 16);
#endif
}

/* x * f / 2^24 for f up to 2^24: the upper 16 bits of f times x, plus the lower eight times the upper half of x. The
 * result is below the true value by less than three. */
static inline int32_t labial_part24(int32_t x, uint32_t f)
{
    return labial_part16(x, f >> 8) + (((x >> 16) * (int32_t)(f & 255u)) >> 8);
}

/* The value of an 8-bit minifloat weight, 0 .. 507904. */
static inline uint32_t labial_weight(uint8_t code)
{
    const uint32_t exponent = (uint32_t)code >> 4, mantissa = (uint32_t)code & 15u;
    return exponent ? (16u + mantissa) << (exponent - 1u) : mantissa;
}

/* Steps of a scale (labial/model.h) as positions. */
static inline int32_t labial_scaled(int32_t steps, uint16_t scale)
{
    return (steps * (int32_t)scale + 128) >> 8;
}

/* |distance| * gain as z in Q6 (labial/model.h), at most `limit`; distance up to 65535, limit likewise. */
static inline uint32_t labial_z(uint32_t distance, uint16_t gain, uint32_t limit)
{
    const uint32_t z = (distance * gain) >> 12;
    return z < limit ? z : limit;
}

/* A Gaussian's exponent z^2 as a cost. */
static inline uint32_t labial_z_cost(uint32_t z)
{
    return (z * z) >> 7;
}

/* a / b, for b > 0. A function, since compilers that know the operands' ranges would also link signed division. */
uint32_t labial_quotient(uint32_t a, uint32_t b);

/* Progress of a smooth transition at `step` of `steps`, which are at most 65535: 3 s^2 - 2 s^3, Q14. */
static inline int32_t labial_ease(unsigned step, unsigned steps)
{
    const uint32_t s = labial_quotient((uint32_t)step << 14, steps);
    return (int32_t)(((s * s >> 14) * ((3u << 14) - 2u * s)) >> 14);
}

/* A position (labial/model.h), limited to +-LABIAL_POSITION_MAX. A function, which several places share. */
int16_t labial_position(int32_t position);

/* value, limited to +-limit. */
static inline int32_t labial_clamp(int32_t value, int32_t limit)
{
    return value > limit ? limit : value < -limit ? -limit : value;
}

#endif
