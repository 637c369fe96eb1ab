/*
 * labial/faps.h - the channels of a frame, and their extension to the 23 FAPs of a whole mouth.
 */
#ifndef LABIAL_FAPS_H
#define LABIAL_FAPS_H

#include <stdint.h>

#include "labial/model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* FAPs of a mouth with inner and outer lips. */
#define LABIAL_FAPS_EXPANDED 23

/* MPEG-4 FAP number of each channel: 3, 16, 17, 51 .. 60. */
extern const uint8_t labial_fap_numbers[LABIAL_CHANNELS];

/* MPEG-4 FAP number of each expanded FAP, ascending: 3 .. 13, 16, 17, 51 .. 60. */
extern const uint8_t labial_fap_numbers_expanded[LABIAL_FAPS_EXPANDED];

/* Copies the 13 channels to their places among the 23 FAPs; the inner lip (FAPs 4 to 13) moves like the outer one (51
 * to 60). The arrays must not overlap. Does nothing when a pointer is null. */
void labial_expand(const int16_t faps[LABIAL_CHANNELS], int16_t expanded[LABIAL_FAPS_EXPANDED]);

#ifdef __cplusplus
}
#endif

#endif
