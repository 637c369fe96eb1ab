/*
 * hear_convert.c - the conversion of a sound to 16 kHz: a windowed sinc, whose samples lie on a fine grid.
 * export/labial/hearing/convert.py describes and computes the same, and its tables are written from there.
 *
 * Times are in tenths of a point of the grid, of which 48 and 44.1 kHz have 16 for each sample.
 */
#include "hear_parts.h"

#include "fixed.h"
#include "hear_convert_table.h"

int labial_hear_convert_init(labial_hear_convert_t *convert, uint32_t samples_per_second)
{
    unsigned i;
    for (i = 0; i < sizeof conversions / sizeof conversions[0]; i++)
        if (conversions[i].samples_per_second == samples_per_second) {
            convert->reach = conversions[i].reach;
            convert->spacing = conversions[i].spacing;
            convert->step = conversions[i].step;
            labial_hear_convert_reset(convert);
            return LABIAL_OK;
        }
    return LABIAL_ERROR_SAMPLE_RATE;
}

void labial_hear_convert_reset(labial_hear_convert_t *convert)
{
    /* The first converted sample has the time of the first sample, and needs the `reach` samples behind it. */
    convert->phase = (uint16_t)((convert->reach + 1u) * convert->spacing * 10u);
    convert->at = LABIAL_HEAR_TAPS_;
}

/* The sound at the phase after `left`, the latest sample of the filter's left half. */
static int16_t interpolated(const labial_hear_convert_t *convert, const int16_t *left)
{
    const unsigned spacing = convert->spacing;
    const unsigned distance = ((convert->phase + 5u) * 6554u) >> 16; /* a tenth, rounded: the phase is at most 479 */
    const int16_t *right = left + 1, *near_left = filter + distance, *near_right = filter + (spacing - distance);
    int32_t total = 0;
    unsigned k = convert->reach;
    for (;; left--, right++, near_left += spacing, near_right += spacing) {
        total += *left * *near_left; /* below 2^31 in all: the filter's magnitudes add up to less than 2^16 */
        total += *right * *near_right;
        if (--k == 0)
            break;
    }
    total = ((total >> 10) * (int32_t)spacing + 256) >> 9;
    return (int16_t)(total < -32768 ? -32768 : total > 32767 ? 32767 : total);
}

unsigned labial_hear_convert(labial_hear_convert_t *convert, int32_t sample, int16_t out[LABIAL_HEAR_CONVERTED_MAX])
{
    const unsigned stride = convert->spacing * 10u;
    unsigned i, count = 0;
    if (convert->at == LABIAL_HEAR_TAPS_) { /* the first sample */
        for (i = 0; i < 2u * LABIAL_HEAR_TAPS_; i++)
            convert->past[i] = (int16_t)sample;
        convert->at = 0;
    }
    convert->past[convert->at] = convert->past[convert->at + LABIAL_HEAR_TAPS_] = (int16_t)sample;
    convert->at = (uint8_t)((convert->at + 1u) % LABIAL_HEAR_TAPS_);
    for (convert->phase = (uint16_t)(convert->phase - stride); convert->phase < stride;
         convert->phase = (uint16_t)(convert->phase + convert->step))
        out[count++] = interpolated(convert, convert->past + convert->at + (LABIAL_HEAR_TAPS_ - 1u) - convert->reach);
    return count;
}
