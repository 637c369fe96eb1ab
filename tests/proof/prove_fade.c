/* Any pose and any motion, at every step of a way to motion, and at every step of ways to rest of every length. */
#include "fade.h"

#include <string.h>

#include "prove.h"

/* In the place of fixed.c, which does the same bit by bit (tests/c/test_fixed.c). */
uint32_t labial_quotient(uint32_t a, uint32_t b)
{
    /*@ assert b > 0; */
    return a / b;
}

static labial_fade_t fade;
static int16_t motion[LABIAL_CHANNELS], faps[LABIAL_CHANNELS];

static void any_pose(void)
{
    FILL(fade.pose);
    FILL(fade.earlier);
    FILL(fade.from);
    FILL(motion);
}

/* A step of a way to any motion, on which jaw and lips arrive with step `closing`. */
static void fade_to_motion(int step, int length, int closing)
{
    any_pose();
    fade.step = (uint16_t)step;
    fade.length = (uint16_t)length;
    fade.closing = (uint16_t)closing;
    labial_fade_to(&fade, motion);
}

/* Of a way to rest of `least` to `most` frames, on which nothing goes on. */
static void fade_to_rest(int least, int most)
{
    any_pose();
    memset(fade.earlier, 0, sizeof fade.earlier);
    fade.step = (uint16_t)Frama_C_interval(0, most);
    fade.length = fade.closing = (uint16_t)Frama_C_interval(least, most);
    labial_fade_to(&fade, NULL);
    any_pose();
    labial_fade_begin(&fade, (unsigned)Frama_C_interval(least, most), (unsigned)Frama_C_interval(0, most), any_int);
}

int main(void)
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
