/*
 * labial/face_private.h - the parts of a face, for labial/face.h alone. They are declared so that programs can allocate a
 * face statically. All members are private and may change with any version.
 */
#ifndef LABIAL_FACE_PRIVATE_H
#define LABIAL_FACE_PRIVATE_H

#include <stdint.h>

#include "labial/rig.h"

/* A face (face.c). 40 bytes where a pointer has 4. */
typedef struct {
    const labial_rig_t *rig; /* null until the face is initialised */
    int32_t *memory;         /* of each output: value, change, wanted; then the frames that wait, a ring */
    uint16_t ahead;          /* the ring has room for one frame more */
    uint16_t first, held;    /* the frames in it */
    uint16_t waited;         /* ticks that the first of them has waited */
    uint16_t frames_per_second;
    uint16_t attached;     /* outputs that follow frames */
    uint8_t plays;         /* frames are shown, one each tick */
    uint8_t quiet;         /* ticks without a frame, up to LABIAL_FACE_HOLD + 1 */
    uint16_t easing;       /* ticks in which the outputs then come to rest, 0 when none are left */
    uint8_t apart, left;   /* ticks from one output of a soft start to the next, and until that */
    uint8_t timed, passes; /* the clock runs; the next tick comes too soon for outputs to move */
    uint16_t part;         /* of a millisecond by which `next` is too early, in 1/frames_per_second */
    uint32_t next, moved;  /* milliseconds: when a tick is due, and when outputs moved last */
} labial_face_t;

/* The speed that an output reaches (labial_rig_output_t): by its acceleration it has LABIAL_RIG_SIGHT frames. */
#define LABIAL_FACE_SPEED_(slew, acceleration)                                                                         \
    ((slew) > 0 && (slew) < LABIAL_RIG_SIGHT * (acceleration) ? (slew) : LABIAL_RIG_SIGHT * (acceleration))

#endif
