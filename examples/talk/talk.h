/*
 * talk.h - 3.5 s of motion from talk.lab, 50 frames a second, a byte for each of 1 output. Values are microseconds.
 * Written by labial bake 0.3.0; do not edit.
 */
#ifndef LABIAL_BAKED_TALK_H
#define LABIAL_BAKED_TALK_H

#include "labial_player.h"

#if LABIAL_PLAYER_FORMAT != 1
#error "talk was written for another version of Labial: run labial bake again."
#endif

#define TALK_FRAMES 174u
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

static const uint8_t talk_bytes[174] LABIAL_PLAYER_FLASH = {
    0, 0, 0, 0, 12, 45, 69, 83, 100, 116, 137, 154, 166, 171, 178, 182, 183, 184, 190, 198, 198, 189, 184, 177, 176,
    176, 179, 175, 166, 158, 147, 142, 125, 98, 29, 0, 0, 0, 5, 67, 88, 106, 111, 101, 75, 14, 0, 0, 41, 122, 182,
    216, 229, 240, 244, 246, 241, 241, 245, 249, 248, 252, 248, 241, 241, 250, 253, 245, 221, 185, 134, 44, 0, 7, 83,
    112, 133, 142, 141, 131, 107, 79, 7, 0, 0, 62, 154, 209, 243, 255, 255, 255, 253, 218, 154, 38, 0, 0, 0, 6, 61,
    85, 108, 131, 167, 179, 186, 177, 174, 174, 185, 207, 221, 235, 241, 248, 251, 255, 255, 255, 242, 174, 58, 0, 39,
    111, 123, 103, 37, 0, 0, 0, 0, 45, 122, 149, 136, 96, 24, 0, 0, 19, 90, 120, 130, 122, 109, 99, 85, 66, 37, 13, 2,
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0
};

/* Goes to the beginning. */
static inline void talk_begin(labial_player_t *player)
{
    labial_player_begin(player, talk_bytes, TALK_FRAMES);
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
