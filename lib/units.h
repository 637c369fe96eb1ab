/*
 * units.h - phonemes to frames: the queue of pushed phonemes, read frame by frame.
 *
 * A frame is accepted, and leaves the queue, once everything that its target depends on has come: the phonemes
 * that its model's kernels reach, and the next phoneme. So frames never depend on when their phonemes were pushed. A
 * pause adds no delay: a silence that is longer than the kernels look ahead is treated as two phonemes, the first of
 * which does not depend on what follows.
 *
 *     pushed    | m |  ey  | b |   iy   |          silence           | m |
 *     taken     | m |  ey  | b |   iy   |      silence     | silence | m |
 *     units     | m    ey  | b |   iy   |      silence       silence   m |
 *
 * A unit runs from the end of a boundary phoneme (a vowel, p, b, m) to the end of the next. Where the model changes, a
 * solution ends, and another begins with the next frame.
 */
#ifndef LABIAL_UNITS_H
#define LABIAL_UNITS_H

#include "labial/labial.h"

/* A phoneme as its model sees it: a neighbour that belongs to another model, or does not exist, is the model's
 * silence. */
typedef struct {
    uint8_t slot; /* its model */
    uint8_t phoneme, previous, next;
    uint16_t ms;
} labial_spoken_t;

/* An accepted frame. */
typedef struct {
    const uint8_t *labels; /* its phoneme, amid those of LABIAL_REACH frames to either side, of which those within the
                            * kernels' reach are set; valid until the next frame is accepted */
    uint16_t share;        /* its place from the start of its phoneme to the end, Q14 */
    uint8_t slot;          /* its model */
    uint8_t is_first;      /* of its phoneme */
    uint8_t is_open;       /* it lies outside of the contact that its phoneme may make */
    uint8_t rest;          /* progress to rest in a pause, 1 .. LABIAL_REST_FRAMES; 0 elsewhere */
    uint8_t marks;
} labial_taken_t;

enum {
    LABIAL_BEGINS = 1,        /* the first frame of a solution */
    LABIAL_ENDS = 2,          /* the last one */
    LABIAL_UNIT_ENDS = 4,     /* the last frame of a unit */
    LABIAL_PHONEME_BEGINS = 8 /* the first frame of a phoneme; set with LABIAL_PAPER alone */
};

/* The i-th segment of the queue, the oldest being 0. Not static, like the next one, or compilers would copy it to
 * every place that calls it. */
const labial_segment_t *labial_units_at(const labial_units_t *units, unsigned i);

/* A model's look-ahead in frames, for its kernels and for short contacts. */
unsigned labial_units_ahead(const labial_model_t *model);

/* Empties the queue. */
void labial_units_reset(labial_units_t *units);

/* Makes the labels those around the frame that was accepted so many frames before the last one, within their reach. */
void labial_units_go_back(labial_units_t *units, uint32_t frames);

/* Appends a phoneme; the queue must have room. Returns its frames, which may be none. */
uint32_t labial_units_push(labial_units_t *units, unsigned phoneme, unsigned slot, uint32_t milliseconds,
                           uint32_t frames_per_second);

/*
 * Accepts the next frame; `ended` says that no more phonemes will come.
 *
 * Returns LABIAL_OK, LABIAL_STARVED when more phonemes are needed, or LABIAL_DONE after the last frame.
 */
int labial_units_take(labial_units_t *units, const labial_model_t *const models[LABIAL_MODELS], int ended,
                      labial_taken_t *taken);

/* Finds the phoneme that begins next, with the next frame or later; returns whether everything that it depends on is
 * known. */
int labial_units_next(const labial_units_t *units, const labial_model_t *const models[LABIAL_MODELS], int ended,
                      labial_spoken_t *spoken);

/* Frames before the next phoneme begins; 0 where the next frame does. */
uint32_t labial_units_left(const labial_units_t *units, const labial_model_t *const models[LABIAL_MODELS]);

/* Whether one of the latest `pending` frames that were pushed is of the model in `slot`. */
static inline int labial_units_uses(const labial_units_t *units, unsigned slot, uint32_t pending)
{
    return units->since[slot] < pending;
}

#endif
