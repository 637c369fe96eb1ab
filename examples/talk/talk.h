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

/* What the bytes 0 and 255 of jaw stand for. A program may define them before it includes this file. */
#ifndef TALK_JAW_AT_0
#define TALK_JAW_AT_0 1400
#endif
#ifndef TALK_JAW_AT_255
#define TALK_JAW_AT_255 1900
#endif

static const uint8_t talk_bytes[168] LABIAL_PLAYER_FLASH = {
    0, 0, 0, 0, 0, 2, 25, 56, 83, 107, 138, 164, 181, 211, 230, 239, 241, 233, 217, 187, 169, 154, 152, 155, 168, 180,
    187, 185, 175, 168, 159, 149, 122, 92, 61, 31, 0, 0, 17, 47, 78, 93, 92, 61, 31, 0, 0, 0, 31, 61, 92, 122, 153,
    184, 214, 245, 252, 238, 215, 202, 187, 186, 194, 220, 245, 214, 184, 153, 122, 92, 61, 31, 0, 0, 31, 61, 92, 122,
    122, 92, 61, 31, 0, 0, 0, 31, 61, 92, 122, 153, 184, 153, 122, 92, 61, 31, 0, 0, 0, 0, 12, 42, 73, 104, 134, 165,
    195, 191, 183, 181, 190, 214, 238, 255, 255, 245, 214, 184, 153, 122, 92, 61, 31, 0, 0, 31, 61, 61, 31, 0, 0, 0,
    6, 37, 67, 92, 61, 31, 0, 0, 0, 21, 52, 83, 110, 102, 89, 61, 31, 0, 0, 0, 0, 0, 2, 10, 9, 6, 2, 0, 0, 0, 0, 0, 0,
    0, 0, 0
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
