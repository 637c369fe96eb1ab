/*
 * labial/hear_model.h - the tables of a model of hearing, as the exporter writes them and the run-time reads them.
 *
 * A model is a network. It takes the features of 20 ms of sound and returns the lips of an earlier frame, `ahead`
 * frames ago. It is constant: it stays in flash and may serve any number of streams at once. Programs do not fill these
 * structures by hand: `labial export` writes a C file that does.
 *
 * A block is y = relu(W x + b), then z = memory(y): for each unit its own weighted sum of frames of y around the
 * present one. All blocks but the first add their input x to z. A dense layer follows, and three heads: a score for
 * each lip class, a score of closed lips, and 13 FAPs.
 *
 * Number formats, the same in every table:
 *
 *   activation int16, Q9, held to +-64: features, what layers put out, scores, biases
 *   weight     int8; each row of weights has its own power of two: the weight is the number / 2^shift, shift 0 .. 15
 *   position   int16, Q4: 1/16 FAP unit
 */
#ifndef LABIAL_HEAR_MODEL_H
#define LABIAL_HEAR_MODEL_H

#include <stdint.h>

#include "labial/config.h"
#include "labial/model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Version of this format. A generated model of another version does not compile. */
#define LABIAL_HEAR_MODEL_FORMAT 3

/* What a frame of 20 ms hears: this many bands in each of its two hops. */
#define LABIAL_HEAR_BANDS 24
#define LABIAL_HEAR_INPUTS (2 * LABIAL_HEAR_BANDS)

/* Limits, to which the exporter keeps; LABIAL_HEAR_UNITS_MAX of labial/config.h is that of a layer's units. */
#define LABIAL_HEAR_BLOCKS_MAX 8   /* blocks */
#define LABIAL_HEAR_AHEAD_MAX 25   /* frames that must follow a frame */
#define LABIAL_HEAR_CLASSES_MAX 64 /* lip classes */
#define LABIAL_HEAR_TAPS_MAX 16    /* taps of a block's memory */
#define LABIAL_HEAR_ROWS_MAX 64    /* frames that a block's memory holds */

/* W and b. Rows go in groups of four, a, b, c and d, of which the last is filled up with zeros. A group has eight
 * weights for each pair of columns 0 and 1: a0 b0 a1 b1 c0 d0 c1 d1. The number of columns is a multiple of four. */
typedef struct {
    const int8_t *weights;
    const int16_t *biases; /* of each row, also of those that fill up */
    const uint8_t *shifts; /* likewise */
} labial_hear_dense_t;

/* A block. Its memory holds (past + ahead) * dilation frames. */
typedef struct {
    labial_hear_dense_t dense;
    const int8_t *taps;    /* past + ahead + 1 weights of each unit, the oldest first */
    const uint8_t *shifts; /* of each unit */
    uint8_t past;          /* taps into the past */
    uint8_t ahead;         /* and ahead; past + ahead is 1 .. LABIAL_HEAR_TAPS_MAX - 1 */
    uint8_t dilation;      /* frames from tap to tap, 1 and more */
} labial_hear_block_t;

/* A model. */
typedef struct {
    uint16_t format; /* LABIAL_HEAR_MODEL_FORMAT */
    uint8_t units;   /* of every layer, a multiple of four */
    uint8_t blocks;  /* 1 and more */
    uint8_t classes; /* 2 and more */
    uint8_t ahead;   /* frames that a frame waits for: the sum of ahead * dilation */
    uint8_t rows;    /* of the workspace: the sum of (past + ahead) * dilation, and of ahead * dilation but the first */
    int32_t close_from;     /* score of closed lips at which they begin to close, Q9 */
    int32_t close_width;    /* how much more of it closes them, Q9, 1 .. 65536 */
    const int16_t *mean;    /* 13 positions; a frame is mean + scale * head */
    const int16_t *scale;   /* 13 positions */
    const int16_t *closed;  /* 13 positions, the pose of closed lips */
    const int16_t *closing; /* 13 shares, Q8, 0 .. 256: how far each channel follows that pose when lips are closed */
    const labial_hear_block_t *block;
    labial_hear_dense_t last;
    labial_hear_dense_t heads; /* rows of the classes, then of closed lips, then of the 13 FAPs */
} labial_hear_model_t;

#if LABIAL_HEAR_SUMS
/*
 * Defined by the program. Sets sums[r] to the sum of row r's weights times `x` over all columns, for the four rows of
 * a group: exactly, which takes less than 31 bits. `weights` are the group's 4 * `columns`, in the order above; `x`
 * are `columns` activations; `columns` is a multiple of four, 4 .. LABIAL_HEAR_UNITS_MAX. Neither needs to be aligned
 * beyond its type. labial_hear_push() and labial_hear_end() call this about a hundred times for each frame.
 */
void labial_hear_sums(const int8_t *weights, const int16_t *x, unsigned columns, int32_t sums[4]);
#endif

#ifdef __cplusplus
}
#endif

#endif
