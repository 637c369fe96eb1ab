/*
 * fixed.c - the one division, and the limits of positions (fixed.h).
 */
#include "fixed.h"

#include "labial/model.h"

uint32_t labial_quotient(uint32_t a, uint32_t b)
{
#if LABIAL_NARROW_MULTIPLY && !defined(__ARM_FEATURE_IDIV)
    /* Bit by bit: smaller than the division that compilers link. */
    uint32_t quotient = 0, bit = 1;
    for (; b <= a >> 5; b <<= 4)
        bit <<= 4;
    for (; b <= a >> 1; b <<= 1)
        bit <<= 1;
    do {
        if (a >= b) {
            a -= b;
            quotient += bit;
        }
        b >>= 1;
        bit >>= 1;
    } while (bit > 0);
    return quotient;
#else
    return a / b;
#endif
}

int16_t labial_position(int32_t position)
{
    return (int16_t)labial_clamp(position, LABIAL_POSITION_MAX);
}
