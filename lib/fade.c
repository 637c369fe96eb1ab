/*
 * fade.c - the way of a delivered pose to another one (fade.h).
 */
#include "fade.h"

#include <string.h>

#include "fixed.h"

unsigned labial_fade_frames(uint32_t milliseconds, uint32_t frames_per_second)
{
    uint32_t frames;
    if (milliseconds > LABIAL_DURATION_MAX)
        milliseconds = LABIAL_DURATION_MAX;
    frames = labial_quotient(milliseconds * frames_per_second + 999u, 1000u);
    return (unsigned)(frames < 1u ? 1u : frames < LABIAL_CANCEL_MAX ? frames : LABIAL_CANCEL_MAX);
}

void labial_fade_begin(labial_fade_t *fade, unsigned length, unsigned closing, int goes_on)
{
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++) {
        fade->earlier[k] = (int16_t)(goes_on && fade->step == 0 ? fade->pose[k] - fade->earlier[k] : 0);
        fade->from[k] = fade->pose[k];
    }
    fade->step = 1;
    fade->length = (uint16_t)length;
    fade->closing = (uint16_t)closing;
}

/* How much of a way of so many steps has been gone, Q14. */
static int32_t share_at(unsigned step, unsigned steps)
{
    return step < steps ? labial_ease(step, steps) : (int32_t)1 << 14;
}

void labial_fade_to(labial_fade_t *fade, const int16_t *motion)
{
    const unsigned step = fade->step, halvings = step < 15u ? step : 15u;
    unsigned closing = LABIAL_FADE_CLOSING, k; /* bit 0 is that of channel k */
    int32_t share, closed;
    if (step == 0 || step >= fade->length) { /* not on a way, or at its end */
        for (k = 0; k < LABIAL_CHANNELS; k++) {
            fade->earlier[k] = fade->pose[k];
            fade->pose[k] = motion[k];
        }
        fade->step = 0;
        return;
    }
    share = share_at(step, fade->length);
    closed = fade->closing == fade->length ? share : share_at(step, fade->closing);
    for (k = 0; k < LABIAL_CHANNELS; k++, closing >>= 1) {
        const int32_t from = fade->from[k] + fade->earlier[k] - (fade->earlier[k] >> halvings);
        const int32_t own = closing & 1u ? closed : share;
        fade->pose[k] = (int16_t)labial_clamp(from + (((motion[k] - from) * own + 8192) >> 14), INT16_MAX);
    }
    fade->step = (uint16_t)(step + 1u);
}

/* A channel in whole FAP units. */
static int rounded(const labial_fade_t *fade, unsigned channel)
{
    return (fade->pose[channel] + 8) >> 4;
}

int labial_fade_rests(const labial_fade_t *fade)
{
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        if (rounded(fade, k) != 0)
            return 0;
    return 1;
}

int labial_fade_opening(const labial_fade_t *fade)
{
    return -(rounded(fade, 3) + rounded(fade, 4));
}

void labial_fade_faps(const labial_fade_t *fade, int16_t faps[LABIAL_CHANNELS])
{
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        faps[k] = (int16_t)rounded(fade, k);
}
