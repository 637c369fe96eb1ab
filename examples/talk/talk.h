/*
 * talk.h - 3.1 s of motion from talk.lab, 50 frames a second, a byte for each of 1 output. Values are microseconds.
 * Written by labial bake 0.2.0; do not edit.
 */
#ifndef LABIAL_TRACK_TALK_H
#define LABIAL_TRACK_TALK_H

#include "labial_track.h"

#if LABIAL_TRACK_FORMAT != 1
#error "talk was written for another version of Labial: run labial bake again."
#endif

#define TALK_FRAMES 156u
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

static const uint8_t talk_bytes[156] LABIAL_TRACK_FLASH = {
    0, 8, 16, 26, 38, 52, 67, 82, 100, 115, 137, 155, 167, 173, 179, 183, 184, 184, 190, 197, 198, 188, 183, 176, 176,
    176, 179, 175, 166, 157, 149, 142, 125, 99, 49, 22, 14, 18, 35, 67, 87, 102, 106, 96, 75, 38, 23, 25, 53, 122,
    179, 215, 231, 241, 244, 245, 241, 241, 245, 250, 249, 253, 249, 243, 244, 253, 255, 247, 223, 187, 135, 50, 22,
    37, 87, 114, 133, 141, 139, 130, 106, 78, 38, 21, 24, 60, 152, 208, 242, 255, 255, 255, 253, 218, 154, 52, 17, 13,
    21, 34, 63, 87, 109, 130, 167, 178, 185, 177, 174, 174, 186, 207, 220, 234, 241, 247, 251, 255, 255, 255, 244,
    176, 58, 26, 52, 111, 123, 103, 50, 27, 21, 19, 26, 54, 123, 149, 136, 98, 45, 24, 24, 43, 88, 113, 123, 120, 113,
    103, 82, 43, 16, 12, 21, 29, 36, 42
};

/* Goes to the beginning. */
static inline void talk_begin(labial_track_t *track)
{
    labial_track_begin(track, talk_bytes, TALK_FRAMES);
}

/* The next frame, every 20 ms, or NULL when the motion is over. */
static inline const uint8_t *talk_next(labial_track_t *track)
{
    return labial_track_next(track, TALK_OUTPUTS);
}

/* What jaw is to do in a frame, microseconds. */
static inline int32_t talk_jaw(const uint8_t *frame)
{
    return labial_track_value(frame, TALK_JAW, TALK_JAW_AT_0, TALK_JAW_AT_255);
}

#endif
