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
    0, 0, 0, 20, 63, 82, 97, 108, 121, 131, 143, 155, 167, 181, 193, 200, 201, 199, 199, 198, 194, 184, 179, 172, 170,
    169, 172, 172, 167, 162, 154, 149, 133, 111, 70, 20, 9, 15, 61, 91, 114, 129, 130, 113, 84, 13, 0, 6, 80, 142,
    194, 232, 250, 255, 255, 250, 236, 224, 210, 197, 187, 186, 187, 195, 208, 231, 241, 238, 213, 174, 121, 31, 0, 1,
    59, 85, 113, 141, 146, 139, 111, 80, 4, 0, 0, 77, 146, 193, 235, 255, 255, 255, 240, 200, 148, 73, 0, 0, 0, 0, 54,
    88, 122, 151, 185, 195, 198, 192, 190, 187, 190, 201, 212, 230, 240, 248, 252, 255, 255, 249, 223, 154, 36, 0, 8,
    72, 79, 65, 9, 0, 0, 0, 6, 68, 108, 121, 110, 80, 7, 0, 0, 19, 75, 99, 114, 114, 105, 93, 78, 56, 27, 19, 20, 19,
    14, 8, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0
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
