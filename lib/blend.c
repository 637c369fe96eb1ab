/*
 * blend.c - blends a frame of speech and a frame of laughter, keeping the closures of speech (labial/blend.h).
 */
#include "labial/blend.h"

#include "fixed.h"
#include "labial/labial.h"

/* Channels, and bits of the channels that follow speech in a closure. */
#define JAW 0u
#define UPPER_MIDLIP 3u
#define LOWER_MIDLIP 4u
#define UPPER_LIP_CHANNELS ((1u << 3) | (1u << 7) | (1u << 8))
#define LOWER_LIP_CHANNELS ((1u << 4) | (1u << 9) | (1u << 10))

#define ONE_Q14 16384u

const labial_blend_t labial_blend_default = {
    { 90, 154, 154, 90, 90, 230, 230, 90, 90, 90, 90, 230, 230 }, 120, 240, 150, 270,
};

/* How free the channel is of a closure, Q14, at a `distance` from it: 0 up to `low`, one from `high` on. */
static uint32_t freedom(int32_t distance, int32_t low, int32_t high)
{
    if (distance <= low)
        return 0;
    if (distance >= high)
        return ONE_Q14;
    return (uint32_t)labial_ease((unsigned)(distance - low), (unsigned)(high - low));
}

static uint32_t at_most_full(uint32_t value)
{
    return value < LABIAL_BLEND_FULL ? value : LABIAL_BLEND_FULL;
}

int labial_blend(const labial_blend_t *blend, unsigned intensity, unsigned words, const int16_t speech[LABIAL_CHANNELS],
                 const int16_t laugh[LABIAL_CHANNELS], int16_t out[LABIAL_CHANNELS])
{
    uint32_t lips, lower;
    unsigned c;
    if (!blend || !speech || !laugh || !out)
        return LABIAL_ERROR_NULL;
    intensity = at_most_full(intensity);
    words = at_most_full(words);
    lips = freedom(-(int32_t)speech[UPPER_MIDLIP] - speech[LOWER_MIDLIP], blend->closed, blend->open);
    lower = freedom(-(int32_t)speech[LOWER_MIDLIP], blend->touching, blend->dropped);
    if (lower > lips)
        lower = lips;
    for (c = 0; c < LABIAL_CHANNELS; c++) {
        const int32_t from = speech[c], to = laugh[c];
        const uint32_t way = to < from ? (uint32_t)(from - to) : (uint32_t)(to - from);
        uint32_t share = at_most_full(blend->shares[c]) * ONE_Q14; /* Q22 */
        if (UPPER_LIP_CHANNELS >> c & 1u)
            share = (share >> 14) * lips;
        else if ((LOWER_LIP_CHANNELS >> c & 1u) || (c == JAW && to > from))
            share = (share >> 14) * lower;
        /* Q30 without words, then Q22 times Q8 = Q30, then Q16: at most one, so that the product of 16 and 17 bits with
         * its half for rounding stays below 2^32. */
        share = (1u << 30) - words * ((1u << 22) - share);
        share = ((share >> 8) * intensity + (1u << 13)) >> 14;
        share = (way * share + 32768u) >> 16;
        out[c] = (int16_t)(to < from ? from - (int32_t)share : from + (int32_t)share);
    }
    return LABIAL_OK;
}
