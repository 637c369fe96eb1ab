/*
 * clock.c - the clock of a loudspeaker (labial/clock.h): what was given to it, and when that will have been heard.
 */
#include "labial/clock.h"

#include <string.h>

#define CLOCK_SECOND 1000000u /* microseconds */

static int64_t clock_within(int64_t value, int64_t least, int64_t most)
{
    return value < least ? least : value > most ? most : value;
}

int labial_clock_init(labial_clock_t *clock, uint32_t samples_per_second)
{
    if (!clock)
        return LABIAL_ERROR_NULL;
    memset(clock, 0, sizeof *clock);
    if (samples_per_second == 0 || samples_per_second > LABIAL_CLOCK_SAMPLE_RATE_MAX)
        return LABIAL_ERROR_SAMPLE_RATE;
    clock->samples_per_second = samples_per_second;
    return LABIAL_OK;
}

void labial_clock_play(labial_clock_t *clock, int64_t first, uint32_t count, int64_t now)
{
    uint64_t lasts;
    if (clock->samples_per_second == 0 || count == 0)
        return;
    now = clock_within(now, -LABIAL_CLOCK_MAX, LABIAL_CLOCK_MAX);
    if (!clock->plays || clock->silent < now) {
        clock->silent = now;
        clock->fraction = 0;
    }
    lasts = (uint64_t)count * CLOCK_SECOND + clock->fraction;
    clock->silent =
        clock_within(clock->silent + (int64_t)(lasts / clock->samples_per_second), now, now + LABIAL_CLOCK_AHEAD);
    clock->fraction = (uint32_t)(lasts % clock->samples_per_second);
    if (first < 0) {
        clock->first = clock->end;
    } else {
        first = clock_within(first, 0, LABIAL_CLOCK_MAX);
        if (first != clock->end || !clock->plays)
            clock->first = first;
        clock->end = first + (int64_t)count;
    }
    clock->plays = 1;
}

void labial_clock_stop(labial_clock_t *clock)
{
    clock->first = clock->end;
    clock->plays = 0;
}

int64_t labial_clock_at(const labial_clock_t *clock, int64_t now, int64_t *sample)
{
    int64_t left = 0, at = clock->end;
    now = clock_within(now, -LABIAL_CLOCK_MAX, LABIAL_CLOCK_MAX);
    if (clock->plays) {
        left = clock_within(clock->silent - now, 0, LABIAL_CLOCK_AHEAD) * (int64_t)clock->samples_per_second /
               (int64_t)CLOCK_SECOND;
        at = clock->end - left > clock->first ? clock->end - left : clock->first;
    }
    *sample = at == clock->end && at > 0 ? at - 1 : at; /* the next one has not begun */
    if (!clock->plays)
        return -1;
    return clock->silent < now ? now - clock->silent : 0;
}
