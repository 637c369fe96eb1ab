/*
 * hear_features.h - what the network hears: energies of bands, relative to the level of the voice.
 */
#ifndef LABIAL_HEAR_FEATURES_H
#define LABIAL_HEAR_FEATURES_H

#include "labial/hear.h"

/* The level before any sound, which is also the least. */
#define LABIAL_HEAR_LEVEL_LEAST (13 * 256 * 64 * LABIAL_HEAR_BANDS)

/* Samples that a window shares with the next one. */
#define LABIAL_HEAR_SHARED (LABIAL_HEAR_WINDOW_ - LABIAL_HEAR_HOP_)

/* Begins again with silence before. */
void labial_hear_features_reset(labial_hear_features_t *features);

/* Whether the next sample is not the first one of a frame. */
static inline int labial_hear_features_begun(const labial_hear_features_t *features)
{
    return features->hop != 0 || features->filled > LABIAL_HEAR_SHARED;
}

/* Takes a sample. Returns whether it completes a frame: then `bands` and `loud` are the frame's, and the window is free
 * until the next sample. */
int labial_hear_features_take(labial_hear_features_t *features, int16_t sample);

/* Computes the features of a hop, Q9, from the window of samples that ends with it, which is lost. Moves the level on,
 * which is 64 times the sum of the bands' log2 energies in Q8. */
void labial_hear_features(int16_t window[LABIAL_HEAR_WINDOW_], int32_t *level, int16_t features[LABIAL_HEAR_BANDS]);

#endif
