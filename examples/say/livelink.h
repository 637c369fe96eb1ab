/*
 * livelink.h - the columns of a Live Link Face recording, and which of them lips and jaw move.
 */
#ifndef LABIAL_EXAMPLE_LIVELINK_H
#define LABIAL_EXAMPLE_LIVELINK_H

/* Columns behind Timecode and BlendShapeCount: ARKit's 52 blendshapes and 9 rotations. */
#define LIVELINK_COLUMNS 61

typedef struct {
    const char *name; /* JawOpen; ARKit's own name is the same with a small letter in front */
    int output;       /* the blendshape's place among the values of the rig arkit, or -1 */
} livelink_column_t;

extern const livelink_column_t livelink_columns[LIVELINK_COLUMNS];

#endif
