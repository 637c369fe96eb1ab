/*
 * arkit.h - what moves a face. Values are thousandths of a weight. Written by labial rig 0.3.0; do not edit.
 */
#ifndef LABIAL_RIG_ARKIT_H
#define LABIAL_RIG_ARKIT_H

#include "labial/rig.h"

#if LABIAL_RIG_FORMAT != 1
#error "arkit was written for another version of Labial: run labial rig again."
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define ARKIT_OUTPUTS 20

/* What initialises an array of the outputs' names. */
#define ARKIT_OUTPUT_NAMES { \
    "jawOpen", "mouthClose", "mouthFunnel", "mouthPucker", "mouthStretchLeft", "mouthStretchRight", \
    "mouthSmileLeft", "mouthSmileRight", "mouthFrownLeft", "mouthFrownRight", "mouthUpperUpLeft", \
    "mouthUpperUpRight", "mouthLowerDownLeft", "mouthLowerDownRight", "mouthPressLeft", "mouthPressRight", \
    "mouthRollUpper", "mouthRollLower", "mouthShrugLower", "mouthShrugUpper" \
}

/* Places of the outputs among the values. */
enum {
    ARKIT_JAWOPEN = 0,
    ARKIT_MOUTHCLOSE = 1,
    ARKIT_MOUTHFUNNEL = 2,
    ARKIT_MOUTHPUCKER = 3,
    ARKIT_MOUTHSTRETCHLEFT = 4,
    ARKIT_MOUTHSTRETCHRIGHT = 5,
    ARKIT_MOUTHSMILELEFT = 6,
    ARKIT_MOUTHSMILERIGHT = 7,
    ARKIT_MOUTHFROWNLEFT = 8,
    ARKIT_MOUTHFROWNRIGHT = 9,
    ARKIT_MOUTHUPPERUPLEFT = 10,
    ARKIT_MOUTHUPPERUPRIGHT = 11,
    ARKIT_MOUTHLOWERDOWNLEFT = 12,
    ARKIT_MOUTHLOWERDOWNRIGHT = 13,
    ARKIT_MOUTHPRESSLEFT = 14,
    ARKIT_MOUTHPRESSRIGHT = 15,
    ARKIT_MOUTHROLLUPPER = 16,
    ARKIT_MOUTHROLLLOWER = 17,
    ARKIT_MOUTHSHRUGLOWER = 18,
    ARKIT_MOUTHSHRUGUPPER = 19
};

extern const labial_rig_t arkit;

#ifdef __cplusplus
}
#endif

#endif
