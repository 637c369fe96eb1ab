/*
 * fade.h - the way of a delivered pose to another one: to motion that begins anew, or to rest.
 *
 * Where e is the way's step of its length, the pose is from + (aim - from) (3 e^2 - 2 e^3), and the aim itself with the
 * last step. A way to motion begins with a pose that moves: `from` goes on as far as the last frame moved it, half as
 * far with each frame; jaw and lips may arrive sooner than the rest. A way to rest begins with a pose that stands
 * still, so that it never leads away from rest.
 */
#ifndef LABIAL_FADE_H
#define LABIAL_FADE_H

#include "labial/labial.h"

#include "fixed.h"

/* Steps of a way to motion that begins anew: the motion itself is reached with the last one. */
#define LABIAL_FADE_STEPS 9u

/* Channels that meet in time for a contact, those of the jaw and the lips: FAPs 3, 51, 52 and 55 to 58. */
#define LABIAL_FADE_CLOSING 0x799u

/* Steps in which these reach motion that begins anew with the frame of `age` in `stream`, on a way of `length` steps
 * from lips that are `opening` FAP units apart: where lips that are apart must meet before the way's end, as many as
 * lead to the second frame of their contact (stream.c). */
unsigned labial_fade_closing(const labial_t *stream, unsigned age, unsigned length, int opening);

/* Frames of a cancel over `milliseconds` (labial/result.h). */
unsigned labial_fade_frames(uint32_t milliseconds, uint32_t frames_per_second);

/* Begins a way of 1 to 65535 steps from the pose that was delivered last, which goes on moving or stands still. Jaw and
 * lips arrive with step `closing`. */
void labial_fade_begin(labial_fade_t *fade, unsigned length, unsigned closing, int goes_on);

/* Delivers the next pose: that of the way, if there is one, else `motion`; Q4 FAP. */
void labial_fade_to(labial_fade_t *fade, const int16_t *motion);

/* What is left of `whole` on the way, in even steps; 0 at its end, and without one. */
static inline uint32_t labial_fade_left(const labial_fade_t *fade, uint32_t whole)
{
    if (fade->step == 0 || fade->step >= fade->length)
        return 0;
    return labial_quotient(((uint32_t)fade->length - fade->step) * whole, (uint32_t)fade->length);
}

/* Whether the pose that was delivered last is the neutral face. */
int labial_fade_rests(const labial_fade_t *fade);

/* How far apart the lips are in it, FAP 51 + FAP 52 downwards, FAP units. */
int labial_fade_opening(const labial_fade_t *fade);

/* That pose in whole FAP units. */
void labial_fade_faps(const labial_fade_t *fade, int16_t faps[LABIAL_CHANNELS]);

#endif
