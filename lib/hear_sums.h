/*
 * hear_sums.h - labial_hear_sums(): four rows of weights times a vector (labial/hear_model.h), which takes about half
 * of the time of hearing.
 */
#ifndef LABIAL_HEAR_SUMS_H
#define LABIAL_HEAR_SUMS_H

#include <string.h>

#include "labial/hear_model.h"

#if LABIAL_HEAR_SUMS
/* The program's own. */
#elif defined(__ARM_FEATURE_DSP) && defined(__ARM_FEATURE_SIMD32) && !defined(__ARM_BIG_ENDIAN)

#include <arm_acle.h>

/* With -ffreestanding memcpy() would be a call. */
#if defined(__GNUC__)
#define LABIAL_HEAR_COPY_ __builtin_memcpy
#else
#define LABIAL_HEAR_COPY_ memcpy
#endif

/* Four weights or two activations, at any address. */
static inline uint32_t labial_hear_word(const void *from)
{
    uint32_t word;
    LABIAL_HEAR_COPY_(&word, from, sizeof word);
    return word;
}

/* Multiplies a pair of columns at a time. The weights of a and c are extended to halfwords; those of b and d stay in
 * the upper bytes of halfwords, so that their sums are 256 times as large and take 64 bits. */
static inline void labial_hear_sums(const int8_t *weights, const int16_t *x, unsigned columns, int32_t sums[4])
{
    const int16_t *const end = x + columns;
    int32_t a = 0, c = 0;
    int64_t b = 0, d = 0;
    do {
        const int16x2_t values = (int16x2_t)labial_hear_word(x);
        const uint32_t ab = labial_hear_word(weights), cd = labial_hear_word(weights + 4);
        a = __smlad(__sxtb16((int8x4_t)ab), values, a);
        b = __smlald((int16x2_t)(ab & 0xff00ff00u), values, b);
        c = __smlad(__sxtb16((int8x4_t)cd), values, c);
        d = __smlald((int16x2_t)(cd & 0xff00ff00u), values, d);
        x += 2;
        weights += 8;
    } while (x < end);
    sums[0] = a;
    sums[1] = (int32_t)(b >> 8);
    sums[2] = c;
    sums[3] = (int32_t)(d >> 8);
}

#else

static inline void labial_hear_sums(const int8_t *weights, const int16_t *x, unsigned columns, int32_t sums[4])
{
    const int16_t *const end = x + columns;
    int32_t a = 0, b = 0, c = 0, d = 0;
    do {
        int32_t value = x[0];
        a += weights[0] * value;
        b += weights[1] * value;
        c += weights[4] * value;
        d += weights[5] * value;
        value = x[1];
        a += weights[2] * value;
        b += weights[3] * value;
        c += weights[6] * value;
        d += weights[7] * value;
        x += 2;
        weights += 8;
    } while (x < end);
    sums[0] = a;
    sums[1] = b;
    sums[2] = c;
    sums[3] = d;
}

#endif
#endif
