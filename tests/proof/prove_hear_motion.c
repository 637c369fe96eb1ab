/*
 * Any heads of any number of classes, after any poses, in silence or not, at any articulation. hear_network.c and fixed.c
 * are not part of it.
 */
#include "hear_parts.h"

#include "prove.h"

static labial_hear_motion_t motion;
static labial_hear_model_t model;

unsigned labial_hear_leader(const labial_hear_model_t *any, const int16_t *heads)
{
    any_int = heads[0] + heads[any->classes - 1];
    return (unsigned)Frama_C_interval(0, LABIAL_HEAR_CLASSES_MAX - 1);
}

void labial_hear_pose(const labial_hear_model_t *any, const int16_t *heads, int32_t gain, int16_t pose[LABIAL_CHANNELS])
{
    /*@ assert 0 <= gain <= 512; */
    any_int = heads[any->classes + LABIAL_CHANNELS - 1] + gain;
    Frama_C_make_unknown((char *)pose, LABIAL_CHANNELS * sizeof *pose);
}

/* fixed.c's, which has its own proof. */
uint32_t labial_quotient(uint32_t a, uint32_t b)
{
    /*@ assert b > 0; */
    return a / b;
}

int main(void)
{
    static int16_t heads[LABIAL_HEAR_CLASSES_MAX + 1 + LABIAL_CHANNELS], pose[LABIAL_CHANNELS];
    FILL(heads);
    FILL(motion.before);
    FILL(motion.now);
    model.classes = (uint8_t)Frama_C_interval(2, LABIAL_HEAR_CLASSES_MAX);
    model.ahead = (uint8_t)Frama_C_interval(0, LABIAL_HEAR_AHEAD_MAX);
    motion.held = (uint8_t)Frama_C_interval(0, 1);
    motion.loud = any_uint32;
    motion.rest = (uint8_t)Frama_C_interval(0, 5);
    motion.articulation.wanted = (uint8_t)Frama_C_interval(0, LABIAL_ARTICULATION_MAX);
    motion.articulation.present = (uint8_t)Frama_C_interval(0, LABIAL_ARTICULATION_MAX);
    labial_hear_motion_hear(&motion, any_int);
    labial_hear_motion_next(&motion, &model, heads, pose);
    (void)labial_hear_motion_share(&motion);
    labial_hear_motion_reset(&motion);
    return 0;
}
