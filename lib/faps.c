/*
 * faps.c - the channels' MPEG-4 numbers, and their extension to 23 FAPs (labial/faps.h).
 */
#include "labial/faps.h"

#include <stddef.h>

const uint8_t labial_fap_numbers[LABIAL_CHANNELS] = { 3, 16, 17, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60 };

const uint8_t labial_fap_numbers_expanded[LABIAL_FAPS_EXPANDED] = { 3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 16,
                                                                    17, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60 };

void labial_expand(const int16_t faps[LABIAL_CHANNELS], int16_t expanded[LABIAL_FAPS_EXPANDED])
{
    unsigned i;
    if (!faps || !expanded)
        return;
    expanded[0] = faps[0];
    expanded[11] = faps[1];
    expanded[12] = faps[2];
    for (i = 0; i < 10; i++) {
        expanded[1 + i] = faps[3 + i];
        expanded[13 + i] = faps[3 + i];
    }
}
