/*
 * rig_parts.h - the steps of an output (rig.c), for what applies rigs: from FAPs to the value that they mean, and from
 * there to the next one that limits of speed and acceleration allow.
 */
#ifndef LABIAL_RIG_PARTS_H
#define LABIAL_RIG_PARTS_H

#include "labial/rig.h"

/* No frame in sight in which lips touch. */
#define LABIAL_RIG_NEVER UINT32_MAX

/* The frames ahead of an output, for limits from above; limits from below use the mirrored values. */
typedef struct {
    int32_t wanted[LABIAL_RIG_SIGHT]; /* units, of this frame and those that follow */
    int32_t
        highest[LABIAL_RIG_SIGHT]; /* units: from here it can still come to rest at the wanted value of each frame */
    unsigned count;                /* of frames, 1 or more; the last one continues without end */
    int32_t rest;                  /* units: the value of the output at rest, which is always allowed */
    int32_t speed, acceleration;   /* units per frame, and per frame and frame; both positive */
} labial_sight_t;

/* value within the output's limits; the maximum where an unchecked table has minimum > maximum. */
int32_t labial_rig_limited(const labial_rig_output_t *output, int32_t value);

/* The value of the face at rest. */
int32_t labial_rig_resting(const labial_rig_output_t *output);

/* The value that FAPs and the shares of sounds mean, within the output's limits; `shares` is null where they are not
 * known. */
int32_t labial_rig_target(const labial_rig_output_t *output, const int16_t faps[LABIAL_CHANNELS],
                          const uint8_t *shares);

/*
 * The value that follows `last`, which the last frame changed by `change`, on the way to those of `sight`: `count` of
 * them are set, 1 .. LABIAL_RIG_SIGHT, the others 0. Without a limit of acceleration only the first one is looked at,
 * and `touch` is the number of the frame, 0 for this one, in which lips touch next.
 */
int32_t labial_rig_step(const labial_rig_output_t *output, labial_sight_t *sight, uint32_t touch, int32_t last,
                        int32_t change);

#endif
