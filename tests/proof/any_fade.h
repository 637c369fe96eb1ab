/*
 * any_fade.h - fade.c as its callers see it: any pose, at any step. It has a proof of its own.
 */
#ifndef ANY_FADE_H
#define ANY_FADE_H

#include "fade.h"
#include "prove.h"

unsigned labial_fade_frames(uint32_t milliseconds, uint32_t frames_per_second)
{
    (void)milliseconds;
    (void)frames_per_second;
    return (unsigned)Frama_C_interval(1, 1000);
}

void labial_fade_begin(labial_fade_t *fade, unsigned length, unsigned closing, int goes_on)
{
    /*@ assert 1 <= length <= 1000; */
    /*@ assert closing <= 1000; */
    (void)goes_on;
    fade->step = 1;
    fade->length = (uint16_t)length;
    fade->closing = (uint16_t)closing;
}

void labial_fade_to(labial_fade_t *fade, const int16_t *motion)
{
    fade->pose[0] = motion[LABIAL_CHANNELS - 1];
    FILL(fade->pose);
    fade->step = any_uint16;
}

int labial_fade_rests(const labial_fade_t *fade)
{
    return fade->pose[LABIAL_CHANNELS - 1] == 0 && any_int;
}

int labial_fade_opening(const labial_fade_t *fade)
{
    return fade->pose[LABIAL_CHANNELS - 1] + any_int16;
}

void labial_fade_faps(const labial_fade_t *fade, int16_t faps[LABIAL_CHANNELS])
{
    faps[0] = fade->pose[LABIAL_CHANNELS - 1];
    Frama_C_make_unknown((char *)faps, LABIAL_CHANNELS * sizeof *faps);
}

#endif
