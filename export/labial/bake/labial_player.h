/*
 * labial_player.h - plays baked motion (`labial bake`): a byte per output and frame, 50 frames a second. For boards
 * that are too small to compute motion, such as an Arduino Uno; the program needs nothing else of Labial. `labial bake`
 * writes this file beside each header that needs it; docs/arduino.md shows how to move a jaw.
 *
 *     #include "talk.h"                                  // labial bake talk.wav -o talk.h
 *     static labial_player_t player;
 *
 *     talk_init(&player);                                // when the sound begins
 *     const uint8_t *frame = talk_next(&player);          // every 20 ms
 *     if (frame)                                         // NULL when the motion is over: the servo stays where it is
 *         servo.writeMicroseconds(talk_jaw(frame));
 *
 * C99 and C++. On an AVR the bytes stay in flash. There a player takes 4 bytes of RAM, 8 where pointers have 32 bits;
 * docs/arduino.md has the size of its code. Nothing is checked at run time, since all input is compiled in.
 */
#ifndef LABIAL_PLAYER_H
#define LABIAL_PLAYER_H

#include <stddef.h>
#include <stdint.h>

#if defined(__AVR__)
#include <avr/pgmspace.h>
#define LABIAL_PLAYER_FLASH PROGMEM
#define LABIAL_PLAYER_READ(address) pgm_read_byte(address)
#else
#define LABIAL_PLAYER_FLASH
#define LABIAL_PLAYER_READ(address) (*(address))
#endif

/* Version of the format of `labial bake`. Headers of another version do not compile. */
#define LABIAL_PLAYER_FORMAT 2

/* The position in a track. The program owns it; it may be copied. */
typedef struct {
    const uint8_t *next; /* the frame that comes next, in flash */
    size_t left;         /* frames that are still to come */
} labial_player_t;

/* Goes to the beginning of `frames` consecutive frames at `bytes`. */
static inline void labial_player_init(labial_player_t *player, const uint8_t *bytes, size_t frames)
{
    player->next = bytes;
    player->left = frames;
}

/*
 * Advances to the next frame, which has `outputs` bytes. Call it every 20 ms. Returns the frame, which
 * labial_player_value() reads, or NULL when there is none.
 */
static inline const uint8_t *labial_player_next(labial_player_t *player, size_t outputs)
{
    const uint8_t *frame = player->next;
    if (player->left == 0)
        return NULL;
    player->left--;
    player->next = frame + outputs;
    return frame;
}

/*
 * The value of a frame's byte number `output` in the units of that output: at_0 for the byte 0, at_255 for 255, and in
 * between
 *
 *     at_0 + (at_255 - at_0) * byte / 255    rounded to the nearest
 *
 * Either may be the larger; they differ by at most 8,000,000.
 */
static inline int32_t labial_player_value(const uint8_t *frame, size_t output, int32_t at_0, int32_t at_255)
{
    const int32_t move = (at_255 - at_0) * (int32_t)LABIAL_PLAYER_READ(frame + output);
    return at_0 + (move + (move < 0 ? -127 : 127)) / 255;
}

#endif
