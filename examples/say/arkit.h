/*
 * arkit.h - ARKit's blendshapes of the mouth from the 13 FAPs. FAPs move both ways, blendshapes only up from 0: each
 * takes its side of the motion.
 */
#ifndef LABIAL_EXAMPLE_ARKIT_H
#define LABIAL_EXAMPLE_ARKIT_H

#include <stdint.h>

#include "labial/faps.h"

/* Blendshapes that lips and jaw move, of ARKit's 52. */
#define ARKIT_SHAPES 14

/* Columns of a Live Link Face recording behind Timecode and BlendShapeCount: 52 blendshapes and 9 rotations. */
#define ARKIT_COLUMNS 61

typedef struct {
    const char *name;                 /* as ARKit has it: jawOpen */
    int32_t offset;                   /* of the weight at rest, thousandths; below 0 nothing moves at first */
    int32_t weights[LABIAL_CHANNELS]; /* millionths per FAP unit */
} arkit_shape_t;

extern const arkit_shape_t arkit_shapes[ARKIT_SHAPES];
extern const char *const arkit_columns[ARKIT_COLUMNS];

/* Weights in thousandths, 0 to 1000. */
void arkit_weights(const int16_t faps[LABIAL_CHANNELS], int weights[ARKIT_SHAPES]);

/* Whether a column is that shape's; Live Link starts names with a capital. */
int arkit_is_column(const arkit_shape_t *shape, const char *column);

#endif
