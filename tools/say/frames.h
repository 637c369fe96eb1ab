/*
 * frames.h - frames written as text, in the formats that docs/avatar.md describes. They are one list, in frames.c, to
 * which the faces of faces.h are added. The header of `fap` needs the number of frames, so they are kept in memory and
 * written by frames_finish().
 */
#ifndef LABIAL_EXAMPLE_FRAMES_H
#define LABIAL_EXAMPLE_FRAMES_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "faces.h"
#include "labial/faps.h"
#include "labial/labial.h"
#include "labial/visemes.h"

typedef struct frames_format frames_format_t; /* of frames.c */

/* A frame that is kept. Private. */
typedef struct {
    int16_t faps[LABIAL_CHANNELS], tongue[LABIAL_TONGUE_FAPS];
    uint8_t has_tongue;
} frames_kept_t;

/* A writer. Private. */
typedef struct {
    FILE *out;
    const frames_format_t *format;
    const char *name;
    unsigned frames_per_second;
    uint32_t count;
    int failed;
    const face_t *face;                 /* null where a format has no weights */
    int32_t weights[FACES_OUTPUTS_MAX]; /* of the latest frame */
    frames_kept_t *kept;                /* fap: `count` frames in room for `room`, owned */
    size_t room;
} frames_t;

/* The name of a format, numbered from 0, which is csv; null beyond the last. */
const char *frames_format_name(unsigned format);

/* Writes what --help says of every format. */
void frames_help(FILE *out);

/* Prepares a writer and writes what precedes the first frame. `name` is the animation's in a fap file and must stay
 * valid. frames_finish() releases what the writer owns. */
void frames_init(frames_t *frames, FILE *out, unsigned format, const char *name, unsigned frames_per_second);

/* Appends a frame with the shares of its sounds (labial/visemes.h), null where they are not known. Failures are
 * remembered and returned by frames_flush() and frames_finish(). */
void frames_put(frames_t *frames, const int16_t faps[LABIAL_CHANNELS], const uint8_t *shares);

/* Sends what is written so far on its way. Returns 0, or -1 when writing failed or memory was short. */
int frames_flush(frames_t *frames);

/* Writes what is still kept and flushes, or drops it when `complete` is 0. Returns as frames_flush() does. */
int frames_finish(frames_t *frames, int complete);

#endif
