/*
 * hear_motion.c - from the network's poses of single frames to motion. hearing/integer.py computes the same integers.
 *
 * What the network tells of single frames moves faster than lips, so a pose becomes motion with a quarter of the one
 * before and of the one after it, which it waits for.
 *
 * Silence is rest, whatever the network makes of it: as the frames after the one that is due are known, the face leaves
 * rest so early that it is all there when the sound begins.
 */
#include "hear_parts.h"

#include <string.h>

#include "articulation.h"

/* A frame is silent when it, as many before it and the next ones are, as far as they are known; the face comes to rest,
 * and leaves it, in as many frames as these. */
#define SILENT_BEFORE 2u
#define RESTING 5u

void labial_hear_motion_reset(labial_hear_motion_t *motion)
{
    motion->held = 0;
    motion->loud = 0;
    motion->rest = RESTING;
    motion->articulation.present = motion->articulation.wanted;
}

void labial_hear_motion_hear(labial_hear_motion_t *motion, int loud)
{
    motion->loud = motion->loud << 1 | (loud ? 1u : 0u);
}

/* Whether the frame is silent that is due once so many after it have come. */
static int frame_is_silent(const labial_hear_motion_t *motion, unsigned known)
{
    const unsigned after = known < RESTING ? known : RESTING, further = known > RESTING ? known - RESTING : 0u;
    return (motion->loud >> further & ((1u << (SILENT_BEFORE + 1u + after)) - 1u)) == 0;
}

int32_t labial_hear_motion_share(const labial_hear_motion_t *motion)
{
    return labial_ease(RESTING - motion->rest, RESTING);
}

int labial_hear_motion_next(labial_hear_motion_t *motion, const labial_hear_model_t *model, const int16_t *heads,
                            int16_t pose[LABIAL_CHANNELS])
{
    int16_t next[LABIAL_CHANNELS];
    int32_t share;
    unsigned k;
    motion->leader = (uint8_t)labial_hear_leader(model, heads);
    labial_hear_pose(model, heads, labial_articulation_gain(&motion->articulation), next);
    labial_articulation_step(&motion->articulation);
    if (!motion->held) {
        motion->held = 1;
        memcpy(motion->before, next, sizeof motion->before);
        memcpy(motion->now, next, sizeof motion->now);
        return 0;
    }
    if (frame_is_silent(motion, model->ahead + 1u))
        motion->rest = (uint8_t)(motion->rest < RESTING ? motion->rest + 1u : RESTING);
    else
        motion->rest = (uint8_t)(motion->rest > 0 ? motion->rest - 1u : 0u);
    share = labial_hear_motion_share(motion);
    for (k = 0; k < LABIAL_CHANNELS; k++) {
        pose[k] = (int16_t)((motion->before[k] + 2 * (int32_t)motion->now[k] + next[k] + 2) >> 2);
        pose[k] = (int16_t)((pose[k] * share + 8192) >> 14);
        motion->before[k] = motion->now[k];
        motion->now[k] = next[k];
    }
    return 1;
}
