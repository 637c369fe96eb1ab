/*
 * hear_network.h - the network of hearing, a frame at a time.
 */
#ifndef LABIAL_HEAR_NETWORK_H
#define LABIAL_HEAR_NETWORK_H

#include "labial/hear.h"

/* Forgets all frames. */
void labial_hear_network_reset(labial_hear_t *hear);

/* Hears the features of a frame. Returns the heads for the frame that is known by now, classes and FAPs in Q9, which lie
 * in the window; null for the first `ahead` frames. */
const int16_t *labial_hear_network(labial_hear_t *hear);

/* The class that leads. */
unsigned labial_hear_leader(const labial_hear_model_t *model, const int16_t *heads);

/* The pose, Q4, with closed lips as far as the closure leads. */
void labial_hear_pose(const labial_hear_model_t *model, const int16_t *heads, int16_t pose[LABIAL_CHANNELS]);

#endif
