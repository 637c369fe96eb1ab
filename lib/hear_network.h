/*
 * hear_network.h - the network of hearing, a frame at a time.
 */
#ifndef LABIAL_HEAR_NETWORK_H
#define LABIAL_HEAR_NETWORK_H

#include "labial/hear.h"

/* Numbers that the network writes beside its memory. */
#define LABIAL_HEAR_SCRATCH (2 * LABIAL_HEAR_UNITS_MAX)

/* Forgets all frames. */
void labial_hear_network_reset(labial_hear_network_t *network);

/* Hears the features of a frame. Returns the heads for the frame that is known by now, in Q9, which lie
 * in `scratch`; null for the first `ahead` frames. */
const int16_t *labial_hear_network(labial_hear_network_t *network, const int16_t features[LABIAL_HEAR_INPUTS],
                                   int16_t scratch[LABIAL_HEAR_SCRATCH]);

/* The class that leads. */
unsigned labial_hear_leader(const labial_hear_model_t *model, const int16_t *heads);

/* The pose, Q4, times an articulation, 0 .. 512 in 1/256; with lips closed as far as their score says, which the
 * articulation moves by 256 at most. */
void labial_hear_pose(const labial_hear_model_t *model, const int16_t *heads, int32_t gain,
                      int16_t pose[LABIAL_CHANNELS]);

#endif
