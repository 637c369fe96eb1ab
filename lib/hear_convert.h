/*
 * hear_convert.h - the conversion of a sound to 16 kHz, sample by sample.
 */
#ifndef LABIAL_HEAR_CONVERT_H
#define LABIAL_HEAR_CONVERT_H

#include "labial/hear.h"

/* Samples at 16 kHz that a sample of the sound can complete, at most. */
#define LABIAL_HEAR_CONVERTED_MAX 2

/* Prepares the conversion from so many samples per second. Returns LABIAL_OK or LABIAL_ERROR_SAMPLE_RATE. */
int labial_hear_convert_init(labial_hear_convert_t *convert, uint32_t samples_per_second);

/* Begins again. The samples before the next one count as equal to it: an offset does not begin with a step. */
void labial_hear_convert_reset(labial_hear_convert_t *convert);

/* The last sample that was taken; any if none was. */
static inline int32_t labial_hear_convert_last(const labial_hear_convert_t *convert)
{
    return convert->past[convert->at + LABIAL_HEAR_TAPS_ - 1];
}

/* For rates other than 16 kHz: takes a sample, and writes those at 16 kHz that it completes to `out`; returns how many. */
unsigned labial_hear_convert(labial_hear_convert_t *convert, int32_t sample, int16_t out[LABIAL_HEAR_CONVERTED_MAX]);

#endif
