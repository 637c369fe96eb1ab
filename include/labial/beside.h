/*
 * labial/beside.h - plays lips that a server computed and sent beside its sound: a byte for each output, 50 times a
 * second, in step with the samples that are heard. For toys that neither know phonemes nor have room for a model.
 *
 *     static labial_beside_t lips;
 *     static uint8_t memory[LABIAL_BESIDE_SIZE(1, 128)];      // one output, 128 frames (2.56 s) ahead of the sound
 *     uint8_t values[1];
 *
 *     labial_beside_init(&lips, 1, 24000, memory, sizeof memory);
 *
 *     labial_beside_push(&lips, packet, size);                // each packet, as it arrives
 *
 *     if (labial_beside_tick(&lips, sample, values) >= 0)     // every 20 ms
 *         set_servo(labial_beside_value(values[0], 1400, 1900));
 *
 * `sample` is the number of the sample that is heard now: the first sample of a session has the number 0, and each one
 * that the server sent since is counted, played or not. Dropping sound therefore does not shift the lips.
 *
 * docs/beside.md has the format of packets, how a server makes them, and how far they are trusted. With any bytes,
 * of any size, and any sample number, the library reads and writes only the memory it was given; whoever can send to
 * the player moves the face, within its limits (labial_beside_limit()). Integers only, no allocation, the same bits
 * on every target, also where an int has 16 bits: the files beside.h, beside.c and result.h need no other file of
 * the library. Calls on one player must not overlap; the structure may be moved between calls.
 */
#ifndef LABIAL_BESIDE_H
#define LABIAL_BESIDE_H

#include <stddef.h>
#include <stdint.h>

#include "labial/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Version of the packets' format. Packets of another version are refused. */
#define LABIAL_BESIDE_FORMAT 2

/* Frames per second. */
#define LABIAL_BESIDE_FPS 50u

/* Bytes of a packet before the face at rest, and of the longest packet. */
#define LABIAL_BESIDE_HEAD 10u
#define LABIAL_BESIDE_LONGEST (LABIAL_BESIDE_HEAD + 255u * 256u)

/* Most frames that a player keeps: 11 minutes. */
#define LABIAL_BESIDE_FRAMES_MAX 32768u

/* A player; its members are private. */
typedef struct labial_beside labial_beside_t;

/* Bytes of memory for so many outputs and frames, a constant expression when they are. The frames must cover the sound
 * that the server sends before it is heard; a power of two wastes nothing. */
#define LABIAL_BESIDE_SIZE(outputs, frames) ((size_t)(outputs)*4u + ((size_t)(outputs) + 1u) * (frames))

/*
 * Prepares a player for packets of `outputs` values, 1 .. 255, beside sound of 1 .. 50,000,000 `samples_per_second`.
 * `memory` of `size` bytes belongs to the player from now on. It keeps as many frames as fit, the largest power of two
 * up to LABIAL_BESIDE_FRAMES_MAX. It does not know where the outputs stand: the first packet puts them at rest,
 * without a limit. Outputs have no limits until labial_beside_limit().
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL, LABIAL_ERROR_RANGE (outputs), LABIAL_ERROR_SAMPLE_RATE, or
 * LABIAL_ERROR_WORKSPACE where there is memory for less than a frame.
 */
int labial_beside_init(labial_beside_t *player, unsigned outputs, uint32_t samples_per_second, void *memory,
                       size_t size);

/*
 * The largest change of an output, 0 .. outputs - 1, from one call of labial_beside_tick() to the next: `most` steps of
 * the 255 between its ends, 1 .. 255. It is the servo's, and holds for every packet; give the server's description of
 * the face the same (`slew`), so that what it sends arrives unchanged.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL, LABIAL_ERROR_STATE (not initialised) or LABIAL_ERROR_RANGE.
 */
int labial_beside_limit(labial_beside_t *player, unsigned output, unsigned most);

/*
 * A connection begins, beside sound of so many samples per second: samples count from 0, and the next packet is the
 * first of its session. Frames are dropped; the face eases to rest from where it is, within its limits, which stay. A
 * program that learns of sessions by packets alone (LABIAL_NEW_SESSION) does not need it.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL, LABIAL_ERROR_STATE (not initialised) or LABIAL_ERROR_SAMPLE_RATE.
 */
int labial_beside_restart(labial_beside_t *player, uint32_t samples_per_second);

/*
 * Accepts a packet of `size` bytes, all of one message. Its frames replace earlier ones of the same numbers. Those that
 * were shown, whose time has passed, or for which the ring has no room yet are ignored.
 *
 * Returns LABIAL_OK; LABIAL_CANCELLED, after which the program drops the sound that it has not played;
 * LABIAL_NEW_SESSION, after which it does the same and counts samples as this session does; or with nothing changed
 * LABIAL_ERROR_NULL, LABIAL_ERROR_STATE (not initialised) or LABIAL_ERROR_PACKET.
 */
int labial_beside_push(labial_beside_t *player, const void *packet, size_t size);

/*
 * The values to show while sample number `sample` is heard, modulo 2^32. Call it every 20 ms, also in silence with a
 * number that stands still: as it eases by a step in each call, it needs no other clock. Numbers may skip any distance;
 * one that is less than the ring's length below the last is jitter, one further below starts over from there.
 *
 * Returns with the values of all outputs, 0 .. 255, in `values` LABIAL_OK when they are those of a frame or on the way
 * there, and LABIAL_STARVED when there is none and the face goes to rest or is there; or with nothing written
 * LABIAL_ERROR_NULL or LABIAL_ERROR_STATE (also before the first packet).
 */
int labial_beside_tick(labial_beside_t *player, uint32_t sample, uint8_t *values);

/*
 * Drops all frames, because the program drops the sound that it has not played; the face eases to rest over
 * `milliseconds`, rounded up to whole frames, 1 .. LABIAL_CANCEL_MAX, or longer where a limit asks for it.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE (not initialised).
 */
int labial_beside_cancel(labial_beside_t *player, uint32_t milliseconds);

/*
 * A byte in the units of its output: at_0 for 0, at_255 for 255, in between at_0 + (at_255 - at_0) * byte / 255,
 * rounded to the nearest, as labial_player_value() of baked motion. Either may be the larger; they differ by at most
 * 8,000,000.
 */
int32_t labial_beside_value(uint8_t byte, int32_t at_0, int32_t at_255);

/* ---- Limits and times -------------------------------------------------------------------------------------------- */

/* A change in the units of an output whose bytes 0 and 255 stand for at_0 and at_255, in bytes for
 * labial_beside_limit(): LABIAL_BESIDE_CHANGE(100, 1400, 1900) is 51. A constant expression; 1 .. 255. */
#define LABIAL_BESIDE_SPAN_(at_0, at_255) ((at_255) < (at_0) ? (long)(at_0) - (at_255) : (long)(at_255) - (at_0))
#define LABIAL_BESIDE_CHANGE(change, at_0, at_255)                                                                     \
    ((change) >= LABIAL_BESIDE_SPAN_(at_0, at_255) ? 255u                                                              \
     : (change)*255L < 2 * LABIAL_BESIDE_SPAN_(at_0, at_255)                                                           \
         ? 1u                                                                                                          \
         : (unsigned)((change)*255L / LABIAL_BESIDE_SPAN_(at_0, at_255)))

/* Calls of labial_beside_tick() for which the last frame stays when no other comes, 1 .. 120: 100 ms. */
#ifndef LABIAL_BESIDE_HOLD
#define LABIAL_BESIDE_HOLD 5
#endif

/* Calls in which the face then eases to rest, 1 .. 120: 120 ms. */
#ifndef LABIAL_BESIDE_EASE
#define LABIAL_BESIDE_EASE 6
#endif

#if LABIAL_BESIDE_HOLD < 1 || LABIAL_BESIDE_HOLD > 120
#error "LABIAL_BESIDE_HOLD must be a number from 1 to 120."
#endif
#if LABIAL_BESIDE_EASE < 1 || LABIAL_BESIDE_EASE > 120
#error "LABIAL_BESIDE_EASE must be a number from 1 to 120."
#endif

/* ---- Private ----------------------------------------------------------------------------------------------------- */

/* 32 bytes where a pointer has 4. */
struct labial_beside {
    uint8_t outputs;  /* 0 before labial_beside_init() */
    uint8_t known;    /* 0 nothing; 1 the face at rest; 2 also the session */
    uint8_t quiet;    /* calls without a frame to show, up to LABIAL_BESIDE_HOLD + 1 */
    uint16_t left;    /* calls in which the face then comes to rest, 1 and more */
    uint16_t frames;  /* that the ring holds, a power of two */
    uint16_t session; /* of the latest packet */
    uint32_t samples_per_second;
    uint32_t now;    /* the frame that is heard, or that comes next after a cancel: the first one of the ring */
    uint32_t sample; /* a sample at most a second before the last one of labial_beside_tick(), */
    uint32_t frame;  /* and the frame that begins with it */
    uint8_t
        *memory; /* the caller's: the face at rest, its present pose, the frame that it approaches, limits, the ring */
};

#ifdef __cplusplus
}
#endif

#endif
