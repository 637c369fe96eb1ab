/*
 * followers.h - the channels of a frame that follow others: the same value again, or FAP 17 of the corners.
 */
#ifndef LABIAL_FOLLOWERS_H
#define LABIAL_FOLLOWERS_H

#include "labial/model.h"

enum { LABIAL_FAP_17 = 2, LABIAL_FAP_53 = 5, LABIAL_FAP_54 = 6 }; /* places in a frame */

/* FAP 17 for the sum of both corners, each Q4 FAP of 16 bits; Q4 FAP. */
int16_t labial_protrusion(const labial_protrusion_t *table, int32_t corners);

/* The frame that a model's channels make, Q4 FAP: channel c moves to motion[c * spacing]. */
void labial_followers_complete(const labial_model_t *model, const int16_t *motion, unsigned spacing,
                               int16_t frame[LABIAL_CHANNELS]);

#endif
