/*
 * prove_fade.c - drivers of files that divide, prove_NAME() that of lib/NAME.c, with a stand-in for fixed.c.
 */
#include <string.h>

#include "fade.h"
#include "hear_parts.h"
#include "prove.h"

/* ---- Fades ------------------------------------------------------------------------------------------------------- */

/* Any pose and any motion, at every step of a way to motion, and at every step of ways to rest of every length. */

/* In the place of fixed.c, which does the same bit by bit (tests/c/test_fixed.c). */
uint32_t labial_quotient(uint32_t a, uint32_t b)
{
    /*@ assert b > 0; */
    return a / b;
}

static labial_fade_t fade;
static int16_t wanted[LABIAL_CHANNELS], faps[LABIAL_CHANNELS];

static void any_pose(void)
{
    FILL(fade.pose);
    FILL(fade.earlier);
    FILL(fade.from);
    FILL(wanted);
}

/* A step of a way to any wanted, on which jaw and lips arrive with step `closing`. */
static void fade_to_motion(int step, int length, int closing)
{
    any_pose();
    fade.step = (uint16_t)step;
    fade.length = (uint16_t)length;
    fade.closing = (uint16_t)closing;
    labial_fade_to(&fade, wanted);
}

/* Of a way to rest of `least` to `most` frames, on which nothing goes on. */
static void fade_to_rest(int least, int most)
{
    any_pose();
    memset(fade.earlier, 0, sizeof fade.earlier);
    fade.step = (uint16_t)Frama_C_interval(0, most);
    fade.length = fade.closing = (uint16_t)Frama_C_interval(least, most);
    memset(wanted, 0, sizeof wanted);
    labial_fade_to(&fade, wanted);
    any_pose();
    labial_fade_begin(&fade, (unsigned)Frama_C_interval(least, most), (unsigned)Frama_C_interval(0, most), any_int);
}

int prove_fade(void)
{
    int i, closing;
    for (i = 0; i <= (int)LABIAL_FADE_STEPS; i++)
        for (closing = 2; closing <= (int)LABIAL_FADE_STEPS; closing++)
            fade_to_motion(i, (int)LABIAL_FADE_STEPS, closing);
    /* In groups so small that EVA, which sees a step and a number of frames apart, sees how far their quotient goes. */
    /*@ loop unroll 120; */
    for (i = 1; i <= 1000; i = i + i / 16 + 1)
        fade_to_rest(i, i + i / 16);
    labial_fade_frames(any_uint32, (uint32_t)Frama_C_interval(1, 255));
    any_pose();
    labial_fade_faps(&fade, faps);
    labial_fade_rests(&fade);
    labial_fade_opening(&fade);
    return 0;
}

/* ---- The motion of hearing --------------------------------------------------------------------------------------- */

/* Any heads of any number of classes, after any poses, in silence or not, at any articulation. hear_network.c and
 * fixed.c are not part of it. */

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

int prove_hear_motion(void)
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
