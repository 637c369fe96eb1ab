/*
 * vectors.h - phoneme streams and what their frames must be, bit for bit. vectors.c is made by regenerate.py from
 * streams.txt, which says what each stream is for; frames.txt holds the frames themselves.
 */
#ifndef CONFORMANCE_VECTORS_H
#define CONFORMANCE_VECTORS_H

#include "labial/labial.h"

enum { CONFORMANCE_SPEECH, CONFORMANCE_LAUGHTER, CONFORMANCE_MODELS };

/* One step of a stream. */
typedef struct {
    uint8_t kind;
    uint8_t model;  /* push: CONFORMANCE_SPEECH or CONFORMANCE_LAUGHTER */
    uint16_t value; /* push: the phoneme; cancel, articulation: the frames of the part that come before it; again:
                            * those of the easing */
    uint32_t milliseconds; /* push, cancel, again; articulation: percent */
} conformance_step_t;

/* CONFORMANCE_AGAIN follows a cancel, which it repeats while the face eases. CONFORMANCE_ARTICULATION comes before what
 * else a part has, in the order of the frames. */
enum { CONFORMANCE_PUSH, CONFORMANCE_END, CONFORMANCE_CANCEL, CONFORMANCE_AGAIN, CONFORMANCE_ARTICULATION };

/* A stream: its steps, of which the last ends or cancels it (again). */
typedef struct {
    const char *name;
    const conformance_step_t *steps;
    uint16_t step_count;
    uint16_t frames; /* delivered in all */
    uint32_t digest; /* CRC-32 (ISO 3309) of all frames, each 13 little-endian int16 */
} conformance_stream_t;

extern const conformance_stream_t conformance_streams[];
extern const unsigned conformance_stream_count;

#endif
