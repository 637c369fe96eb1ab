/*
 * hear_motion.h - what the network tells of single frames, as the motion of a face.
 */
#ifndef LABIAL_HEAR_MOTION_H
#define LABIAL_HEAR_MOTION_H

#include "labial/hear.h"

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
