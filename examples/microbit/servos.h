/*
 * servos.h - three servo pulses at 50 Hz from TIMER1's interrupt, on the pads 0, 1 and 2 of the edge connector, and the
 * queue of faces that they show.
 *
 * TIMER1 counts microseconds and starts anew every 20 ms. Servo n's pulse begins 0.1 + 3 n ms into the period, so that
 * pulses of at most 2.5 ms never overlap and the servos do not all draw their current at once; its length determines
 * its end. The interrupt handler makes both edges with the same delay after the timer's event, so that a pulse has its
 * length to within about a microsecond, whatever the main program computes meanwhile.
 *
 * The main program puts faces into the queue as it has computed them, early or late within a period; the handler shows
 * one per period. So the motion is even although some frames take longer to compute than others.
 */
#ifndef EXAMPLE_SERVOS_H
#define EXAMPLE_SERVOS_H

#include <stdint.h>

#define SERVOS_COUNT 3u
#define SERVOS_PERIOD 20000u /* microseconds; the frame period of the bundled models */
#define SERVOS_PULSE_MAX 2500u
#define SERVOS_QUEUE 16u /* faces; a power of two */

/* A face: the lengths of its pulses, microseconds, and those that the pins had when it was shown. */
typedef struct {
    uint16_t lengths[SERVOS_COUNT];
    uint16_t measured[SERVOS_COUNT];
} servos_face_t;

/* Starts the timers, for a face that is shown until others come, by the servos that are attached: none yet. Lengths
 * beyond SERVOS_PULSE_MAX, and negative ones, are cut to that, here and in servos_push(). */
void servos_start(const int32_t lengths[SERVOS_COUNT]);

/* Attaches the first `count` servos: they have pulses from now on. */
void servos_attach(unsigned count);

/* Faces that can be pushed. A face leaves the queue when it was shown and servos_shown() has passed it on. */
unsigned servos_room(void);

/* Puts a face into the queue; there must be room. */
void servos_push(const int32_t lengths[SERVOS_COUNT]);

/* Shows one face per period from the next period on. The last one stays when there is none, which counts as late unless
 * servos_end() has said that no more will come; after that, faces wait for servos_play() again. */
void servos_play(void);
void servos_end(void);

/* Passes on the next face whose period has ended. Returns 1, or 0 when there is none. */
int servos_shown(servos_face_t *face);

/* Sleeps until the next interrupt, of which there are several per period. */
void servos_wait(void);

/* Microseconds since servos_start(), from a timer of their own. */
uint32_t servos_clock(void);

/* Counters: periods that ended, interrupts, and periods in which a face was late. */
typedef struct {
    uint32_t periods, interrupts, late;
} servos_counts_t;

servos_counts_t servos_counts(void);

#endif
