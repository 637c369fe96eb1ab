/*
 * talk.h - 3.4 s of motion from talk.lab, 50 frames a second, a byte for each of 1 output. Values are microseconds.
 * Written by labial bake 0.4.0; do not edit.
 */
#ifndef LABIAL_BAKED_TALK_H
#define LABIAL_BAKED_TALK_H

#include "labial_player.h"

#if LABIAL_PLAYER_FORMAT != 2
#error "talk was written for another version of Labial: run labial bake again."
#endif

#define TALK_FRAMES 168u
#define TALK_OUTPUTS 1u

/* Places of the outputs among a frame's bytes. */
enum {
    TALK_JAW = 0
};

/* What the bytes 0 and 255 of jaw stand for. A program may define both before it includes this file. */
#ifndef TALK_JAW_AT_0
#define TALK_JAW_AT_0 1400
#define TALK_JAW_AT_255 1900
#endif

static const uint8_t talk_bytes[168] LABIAL_PLAYER_FLASH = {
    0, 0, 0, 0, 0, 24, 65, 86, 106, 122, 142, 156, 172, 198, 216, 228, 236, 233, 225, 205, 192, 177, 170, 167, 176,
    185, 193, 192, 186, 180, 170, 162, 144, 116, 63, 4, 0, 0, 24, 77, 102, 115, 116, 100, 72, 0, 0, 0, 78, 167, 221,
    255, 255, 255, 255, 255, 255, 245, 218, 203, 188, 187, 192, 211, 236, 255, 255, 255, 244, 192, 118, 0, 0, 0, 35,
    89, 121, 136, 131, 114, 83, 33, 0, 0, 0, 84, 165, 218, 255, 255, 255, 255, 255, 208, 137, 60, 0, 0, 0, 0, 16, 76,
    121, 167, 205, 213, 207, 191, 184, 183, 194, 220, 243, 255, 255, 255, 255, 255, 255, 255, 238, 144, 2, 0, 0, 63,
    73, 62, 0, 0, 0, 0, 0, 65, 106, 125, 114, 82, 0, 0, 0, 14, 74, 94, 108, 103, 92, 79, 56, 0, 0, 0, 0, 0, 1, 10, 9,
    6, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0
};

/* Goes to the beginning. */
static inline void talk_init(labial_player_t *player)
{
    labial_player_init(player, talk_bytes, TALK_FRAMES);
}

/* The next frame, every 20 ms, or NULL when the motion is over. */
static inline const uint8_t *talk_next(labial_player_t *player)
{
    return labial_player_next(player, TALK_OUTPUTS);
}

/* What jaw is to do in a frame, microseconds. */
static inline int32_t talk_jaw(const uint8_t *frame)
{
    return labial_player_value(frame, TALK_JAW, TALK_JAW_AT_0, TALK_JAW_AT_255);
}

#endif
