/*
 * mouth.h - the mouth of a toy whose server sends lips beside the sound (docs/beside.md): a servo, in step with the
 * loudspeaker.
 *
 *     mouth_begin(24000);                                     // for each connection
 *
 *     // where messages arrive
 *     mouth_packet(packet, size);                             // of lips
 *     number = mouth_receive(count);                          // of sound, which then waits in the player's queue
 *
 *     // where sound is taken out of the queue
 *     mouth_playing(number, count, esp_timer_get_time());
 *     write_to_loudspeaker(samples, count);                   // may block
 *
 * The clock is the loudspeaker: what is written is heard when what was written before has ended, or at once if it has.
 * Sound that is received and never played, because a queue was emptied, moves nothing. In silence the mouth eases to
 * rest.
 *
 * Threads: mouth_packet() and mouth_receive() in one, mouth_playing() in one, mouth_values() in one; mouth_begin() and
 * mouth_cancel() in any. A lock is held for as long as a call of labial/beside.h takes.
 */
#ifndef MOUTH_H
#define MOUTH_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Values of a frame, of which the first moves the servo. */
#ifndef MOUTH_OUTPUTS
#define MOUTH_OUTPUTS 1
#endif

/* Frames of 20 ms that are kept: they must cover the sound between its arrival and the loudspeaker. */
#ifndef MOUTH_FRAMES
#define MOUTH_FRAMES 256
#endif

/* Microseconds of the servo's pulses for the bytes 0 and 255. */
#ifndef MOUTH_AT_0
#define MOUTH_AT_0 1400
#endif
#ifndef MOUTH_AT_255
#define MOUTH_AT_255 1900
#endif

/* The largest change in 20 ms that the servo follows, in microseconds. It is never exceeded. */
#ifndef MOUTH_CHANGE
#define MOUTH_CHANGE 100
#endif

/* Milliseconds in which the mouth comes to rest when the loudspeaker is silenced. */
#ifndef MOUTH_EASE
#define MOUTH_EASE 120
#endif

/* What mouth_playing() is told of sound that did not come from the server: LABIAL_CLOCK_NONE. */
#define MOUTH_NONE (-1)

/* A connection begins, with sound of so many samples per second; the mouth eases to rest from where it is. Returns 0,
 * or a negative number for a rate that cannot be (labial/result.h). */
int mouth_begin(uint32_t samples_per_second);

/* A packet of lips. Returns as labial_beside_push(). */
int mouth_packet(const void *packet, size_t size);

/* `count` samples, of two channels as many pairs, have arrived, whether they will be played or not. Returns the number
 * of the first. */
int64_t mouth_receive(size_t count);

/* `count` samples from number `first` on, or from MOUTH_NONE, are given to the loudspeaker at the time `now`, in
 * microseconds. */
void mouth_playing(int64_t first, size_t count, int64_t now);

/* The loudspeaker was silenced, and what it had not played was dropped: the mouth eases to rest. */
void mouth_cancel(void);

/* The values to show at the time `now`; call it every 20 ms. Returns as labial_beside_tick(). */
int mouth_values(int64_t now, uint8_t values[MOUTH_OUTPUTS]);

/* Moves a servo at a pin by the first value, every 20 ms. Returns 0 or an error of ESP-IDF. */
int mouth_servo(int pin);

#ifdef __cplusplus
}
#endif

#endif
