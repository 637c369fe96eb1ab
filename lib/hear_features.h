/*
 * hear_features.h - what the network hears: energies of bands, relative to the level of the voice.
 */
#ifndef LABIAL_HEAR_FEATURES_H
#define LABIAL_HEAR_FEATURES_H

#include "labial/hear.h"

/* A log2 energy of one as a level, and one that no sound has. */
#define LABIAL_HEAR_LEVEL_ONE (256 * 64 * LABIAL_HEAR_BANDS)
#define LABIAL_HEAR_LEVEL_NONE (64 * LABIAL_HEAR_LEVEL_ONE)

/* Samples that a window shares with the next one. */
#define LABIAL_HEAR_SHARED (LABIAL_HEAR_WINDOW_ - LABIAL_HEAR_HOP_)

/* Begins a sound, with its first sample as the silence before it. The level stays, and the sound waits for a voice. */
void labial_hear_features_reset(labial_hear_features_t *features);

/* Whether the next sample is not the first one of a frame. */
static inline int labial_hear_features_begun(const labial_hear_features_t *features)
{
    return features->hop != 0 || features->filled > LABIAL_HEAR_SHARED;
}

/* The last sample that was taken; any if none was. */
static inline int16_t labial_hear_features_last(const labial_hear_features_t *features)
{
    return features->filled > LABIAL_HEAR_SHARED ? features->window[features->filled - 1u]
                                                 : features->tail[LABIAL_HEAR_SHARED - 1];
}

/* Takes a sample. Returns whether it completes a frame: then `bands` and `loud` are the frame's, and the window is free
 * until the next sample. */
int labial_hear_features_take(labial_hear_features_t *features, int16_t sample);

/* Computes the features of a hop, Q9, from the window of samples that ends with it, which is lost. Moves the level on.
 * `silent` tells that the hop's own samples hardly differ. */
void labial_hear_features(int16_t window[LABIAL_HEAR_WINDOW_], int silent, labial_hear_level_t *level,
                          int16_t features[LABIAL_HEAR_BANDS]);

/* Waits for a voice again. */
void labial_hear_level_wait(labial_hear_level_t *level);

/* Whether a voice was there. */
static inline int labial_hear_level_voiced(const labial_hear_level_t *level)
{
    return level->stage != 0; /* WAITS */
}

#endif
