/*
 * livelink.h - the columns of a Live Link Face recording, and which of them lips and jaw move.
 */
#ifndef LABIAL_EXAMPLE_LIVELINK_H
#define LABIAL_EXAMPLE_LIVELINK_H

/* Columns behind Timecode and BlendShapeCount: ARKit's 52 blendshapes and 9 rotations. */
#define LIVELINK_COLUMNS 61

/* Their names: JawOpen; ARKit's own name is the same with a small letter in front. */
extern const char *const livelink_columns[LIVELINK_COLUMNS];

/* The place of a column's blendshape among the values of the rig arkit, or -1 where neither lips nor jaw move it. */
int livelink_output(const char *column);

#endif
