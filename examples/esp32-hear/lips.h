/*
 * lips.h - lips in step with a loudspeaker: sound that a program is about to play goes in, and the frame of what is
 * heard at this moment comes out.
 *
 *     lips_begin(24000, 1);
 *
 *     // where sound is put into the queue of the player
 *     first = lips_feed(samples, count);
 *
 *     // where sound is taken out of the queue
 *     lips_playing(first, count, esp_timer_get_time());
 *     write_to_loudspeaker(samples, count);              // may block
 *
 *     // where lips are moved or drawn, 50 times a second or as often as you like
 *     lips_frame(esp_timer_get_time(), faps);
 *
 * Feed sound before it is heard, by the latency of hearing (labial_hear_latency(); docs/hearing.md says how long it
 * is): of sound that comes later, the lips are late by what is missing. The clock is the loudspeaker: what is written
 * is heard when what was written before has ended, or at once if it has. So lips_playing() takes the time before the
 * write, and need not know the size of the driver's buffer.
 *
 * Where a sound ends, lips_frame() ends hearing, so that its last frames are known, too: when a frame is due that is
 * not known, and the next sound is late (LIPS_DRY). What comes then is heard anew.
 *
 * Sound that is fed and never played, because a queue was emptied, moves nothing. When everything that was given to the
 * loudspeaker has been heard, the mouth eases to the neutral face, and from there into the next words.
 *
 * Threads: lips_feed() in one thread, lips_playing() in one, lips_frame() in one, which may be three different ones;
 * lips_cancel() in any; lips_begin() in any while lips_feed() does not run. lips_feed() takes long, as it hears, and
 * lips_frame() once at the end of a sound: six frames of 20 ms, less than the hearing of 140 ms of sound.
 * Nothing is allocated: there is one mouth in a program.
 */
#ifndef LIPS_H
#define LIPS_H

#include <stddef.h>
#include <stdint.h>

#include "labial/labial.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How many frames of 20 ms wait for their time, 26 bytes each. They must cover the sound between lips_feed() and the
 * loudspeaker; of more, the oldest are lost. */
#ifndef LIPS_FRAMES
#define LIPS_FRAMES 64
#endif

/* Milliseconds by which lips are shown before their sound: the time that a servo needs, less the time from the driver's
 * buffer to the ear. */
#ifndef LIPS_LEAD
#define LIPS_LEAD 0
#endif

/* Milliseconds without sound after which the mouth goes to the neutral face, and how long it takes to ease there, and
 * back into speech. */
#ifndef LIPS_GRACE
#define LIPS_GRACE 40
#endif
#ifndef LIPS_EASE
#define LIPS_EASE 120
#endif

/* A sound has ended when the next lips_feed() is late by so many milliseconds, and its frames are due. */
#ifndef LIPS_DRY
#define LIPS_DRY 20
#endif

/* Prepares for sound of one rate and 1 or 2 channels, those of labial/hear.h; what was heard before is forgotten.
 * Returns as labial_hear_init() does. Until it succeeds the other functions do nothing, and the face is neutral. */
int lips_begin(uint32_t samples_per_second, unsigned channels);

/* Hears `count` samples of 16 bits, of two channels as many pairs, at any address. Returns the number of the first of
 * them since lips_begin(); the next ones follow it. */
uint64_t lips_feed(const void *samples, size_t count);

/* `count` samples from number `first` on are given to the loudspeaker at the time `now`, in microseconds. */
void lips_playing(uint64_t first, size_t count, int64_t now);

/* The loudspeaker was silenced: the mouth eases to the neutral face, whatever was given to it. */
void lips_cancel(void);

/* The frame to show at the time `now`. Returns 1, or 0 when the face is neutral or on the way there. */
int lips_frame(int64_t now, int16_t faps[LABIAL_CHANNELS]);

/* ---- The jaw (servo.c): one servo that follows lips_frame(), with ESP-IDF or Arduino ----------------------------- */

/* Pulses in microseconds: mouth closed and wide open. Find yours before you connect the linkage (docs/servos.md). */
#ifndef SERVO_CLOSED
#define SERVO_CLOSED 1400
#endif
#ifndef SERVO_OPEN
#define SERVO_OPEN 1900
#endif

/* Microseconds by which a pulse changes at most in 20 ms: what a common servo can follow. */
#ifndef SERVO_SLEW
#define SERVO_SLEW 160
#endif

/* Moves the servo on a pin every 20 ms from now on. Returns 0, or an error of ESP-IDF. */
int servo_begin(int pin);

#ifdef __cplusplus
}
#endif

#endif
