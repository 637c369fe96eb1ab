/*
 * units.h - phonemes to frames: the queue of what was pushed, taken frame by frame.
 *
 * A frame is taken when everything that its target depends on is known: what its model's kernels reach, and the next
 * phoneme. So frames never depend on when their phonemes were pushed. A pause delays nothing: a silence that is longer
 * than the kernels look ahead is treated as two phonemes, the first of which does not depend on what follows.
 *
 *     pushed    | m |  ey  | b |   iy   |          silence           | m |
 *     taken     | m |  ey  | b |   iy   |      silence     | silence | m |
 *     units     | m    ey  | b |   iy   |      silence       silence   m |
 *
 * A unit runs from the end of a boundary phoneme (a vowel, p, b, m) to that of the next. Where the model changes a
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

/* A frame that was taken. */
typedef struct {
    const uint8_t *labels; /* its phoneme, among those of the frames around it, LABIAL_REACH to either side, of which
                            * those that the kernels reach count; valid until the next is taken */
    uint16_t share;        /* how far it lies from the start of its phoneme to its end, Q14 */
    uint8_t slot;          /* its model */
    uint8_t is_first;      /* of its phoneme */
    uint8_t is_open;       /* it lies in a phoneme that includes a pause, before its contact */
    uint8_t rest;          /* how far the mouth has come to rest in a pause, of LABIAL_REST_FRAMES; 0 elsewhere */
    uint8_t marks;
} labial_taken_t;

enum {
    LABIAL_BEGINS = 1,   /* the first frame of a solution */
    LABIAL_ENDS = 2,     /* the last one */
    LABIAL_UNIT_ENDS = 4 /* the last frame of a unit */
};

/* Empties the queue. */
void labial_units_reset(labial_units_t *units);

/* Appends a phoneme; the queue must have room. Returns its frames, which may be none. */
uint32_t labial_units_push(labial_units_t *units, unsigned phoneme, unsigned slot, uint32_t milliseconds,
                           uint32_t frames_per_second);

/*
 * Takes the next frame; `ended` says that no more phonemes will come.
 *
 * Returns LABIAL_OK, LABIAL_STARVED when more must be known, or LABIAL_DONE when every frame was taken.
 */
int labial_units_take(labial_units_t *units, const labial_model_t *const models[LABIAL_MODELS], int ended,
                      labial_taken_t *taken);

/* Finds the phoneme that begins next, with the next frame or later; returns whether everything that it depends on is
 * known. */
int labial_units_next(const labial_units_t *units, const labial_model_t *const models[LABIAL_MODELS], int ended,
                      labial_spoken_t *spoken);

/* Whether the next frame begins a phoneme. */
int labial_units_at_first(const labial_units_t *units, const labial_model_t *const models[LABIAL_MODELS]);

/* Whether phonemes of the model in `slot` are in the queue. */
int labial_units_uses(const labial_units_t *units, unsigned slot);

#endif
