/*
 * hear_parts.h - what the steps of hearing offer each other and hear.c, in their order.
 */
#ifndef LABIAL_HEAR_PARTS_H
#define LABIAL_HEAR_PARTS_H

#include "labial/hear.h"

/* ---- hear_convert.c: the conversion of a sound to 16 kHz, sample by sample --------------------------------------- */

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

/* For rates other than 16 kHz: takes a sample, and writes those at 16 kHz that it completes to `out`; returns how
 * many. */
unsigned labial_hear_convert(labial_hear_convert_t *convert, int32_t sample, int16_t out[LABIAL_HEAR_CONVERTED_MAX]);

/* ---- hear_features.c: what the network hears: energies of bands, relative to the level of the voice -------------- */

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

/* Takes as many of `count` samples as a hop that has begun still lacks, except its last one. Returns how many. */
size_t labial_hear_features_fill(labial_hear_features_t *features, const int16_t *samples, size_t count);

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

/* ---- hear_network.c: the network, a frame at a time -------------------------------------------------------------- */

/* Numbers that the network writes beside its memory. */
#define LABIAL_HEAR_SCRATCH (2 * LABIAL_HEAR_UNITS_MAX)

/* Forgets all frames. */
void labial_hear_network_reset(labial_hear_network_t *network);

/* Hears the features of a frame. Returns the heads for the frame that is complete with it, in Q9, which lie
 * in `scratch`; null for the first `ahead` frames. */
const int16_t *labial_hear_network(labial_hear_network_t *network, const int16_t features[LABIAL_HEAR_INPUTS],
                                   int16_t scratch[LABIAL_HEAR_SCRATCH]);

/* The class that leads. */
unsigned labial_hear_leader(const labial_hear_model_t *model, const int16_t *heads);

/* The pose, Q4, times an articulation, 0 .. 512 in 1/256; with lips closed as far as their score says, which the
 * articulation moves by 256 at most. */
void labial_hear_pose(const labial_hear_model_t *model, const int16_t *heads, int32_t gain,
                      int16_t pose[LABIAL_CHANNELS]);

/* ---- hear_motion.c: what the network tells of single frames, as the motion of a face ----------------------------- */

/* Forgets all frames: there was silence before. */
void labial_hear_motion_reset(labial_hear_motion_t *motion);

/* The network hears another frame, with sound or without. */
void labial_hear_motion_hear(labial_hear_motion_t *motion, int loud);

/* Takes the heads of a frame, and writes the pose, Q4, of the frame before it, which is smoothed with its neighbours.
 * Returns 0 where there was none. */
int labial_hear_motion_next(labial_hear_motion_t *motion, const labial_hear_model_t *model, const int16_t *heads,
                            int16_t pose[LABIAL_CHANNELS]);

/* How far the pose that was written last shows sound rather than silence, 0 .. 1 in Q14. */
int32_t labial_hear_motion_share(const labial_hear_motion_t *motion);

#endif
