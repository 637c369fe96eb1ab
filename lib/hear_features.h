/*
 * hear_features.h - what the network hears: energies of bands, relative to the level of the voice.
 */
#ifndef LABIAL_HEAR_FEATURES_H
#define LABIAL_HEAR_FEATURES_H

#include "labial/hear.h"

/* The level before any sound, which is also the least. */
#define LABIAL_HEAR_LEVEL_LEAST (13 * 256 * 64 * LABIAL_HEAR_BANDS)

/* Computes the features of a hop, Q9, from the window of samples that ends with it, which is lost. Moves the level on,
 * which is 64 times the sum of the bands' log2 energies in Q8. */
void labial_hear_features(int16_t window[LABIAL_HEAR_WINDOW_], int32_t *level, int16_t features[LABIAL_HEAR_BANDS]);

#endif
