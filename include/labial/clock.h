/*
 * labial/clock.h - which sample is heard now, told by what a program gives to its loudspeaker and when.
 *
 *     static labial_clock_t clock;
 *     int64_t sample;
 *
 *     labial_clock_init(&clock, 24000);
 *
 *     labial_clock_play(&clock, number, count, now);          // before each write, which may block
 *     write_to_loudspeaker(samples, count);
 *
 *     if (labial_clock_at(&clock, now, &sample) >= 0)         // at any time
 *         show_frame(sample * 50 / 24000);
 *
 * What is written is heard when what was written before has ended, or at once if it has. So the clock needs neither the
 * size of the driver's buffer nor an interrupt. Samples have the caller's numbers: those that were dropped from a
 * queue, and never played, move nothing. Numbers and times have 64 bits, and do not wrap.
 *
 * Integers only, no allocation, no state but the structure, the same values on every target. Calls on one clock must
 * not overlap; the structure may be moved or copied between calls. Pointers must not be null but in
 * labial_clock_init(). The files clock.h, clock.c and result.h need no other file of the library.
 */
#ifndef LABIAL_CLOCK_H
#define LABIAL_CLOCK_H

#include <stdint.h>

#include "labial/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The most samples per second. */
#define LABIAL_CLOCK_SAMPLE_RATE_MAX 1000000u

/* The number of a sound whose samples have none, such as a sound of the device's own. */
#define LABIAL_CLOCK_NONE INT64_C(-1)

/* Numbers and times, in microseconds, are below this; larger ones count as it. */
#define LABIAL_CLOCK_MAX (INT64_C(1) << 60)

/* The longest sound that waits to be heard, microseconds: a day. Of more, the beginning counts as heard. */
#define LABIAL_CLOCK_AHEAD INT64_C(86400000000)

/* A clock; its members are private. All zero it is one that was not initialised. */
typedef struct labial_clock labial_clock_t;

/* Prepares a clock for sound of 1 .. LABIAL_CLOCK_SAMPLE_RATE_MAX samples per second, of which nothing was heard.
 * Returns LABIAL_OK, LABIAL_ERROR_NULL, or LABIAL_ERROR_SAMPLE_RATE with a clock that is not initialised. */
int labial_clock_init(labial_clock_t *clock, uint32_t samples_per_second);

/*
 * `count` samples, of several channels as many tuples, are given to the loudspeaker at the time `now`. The first of
 * them has the number `first`, 0 .. LABIAL_CLOCK_MAX, or LABIAL_CLOCK_NONE. `now` is in microseconds, of any clock that
 * does not run back. Does nothing on a clock that was not initialised.
 */
void labial_clock_play(labial_clock_t *clock, int64_t first, uint32_t count, int64_t now);

/* The loudspeaker was silenced: nothing is heard until labial_clock_play(). What was given and not heard is over: the
 * sample is then the last one that was given with a number. */
void labial_clock_stop(labial_clock_t *clock);

/*
 * Writes the number of the sample that is heard at the time `now`; in silence, and while a sound without numbers is
 * heard, of the last one given before, or 0 without one; while a sound is still heard whose numbers these do not
 * follow, of the first that waits behind it.
 *
 * Returns for how long nothing was heard, in microseconds: 0 while a sound is; -1 when nothing was given yet, and after
 * labial_clock_stop().
 */
int64_t labial_clock_at(const labial_clock_t *clock, int64_t now, int64_t *sample);

/* ---- Private ----------------------------------------------------------------------------------------------------- */

struct labial_clock {
    uint32_t samples_per_second; /* 0 before labial_clock_init() */
    uint32_t fraction;           /* of the microsecond `silent`, in parts of the rate */
    int64_t first, end;          /* the latest samples that were given with numbers that follow each other */
    int64_t silent;              /* when they will have been heard */
    uint8_t plays;               /* something was given, and not stopped */
};

#ifdef __cplusplus
}
#endif

#endif
