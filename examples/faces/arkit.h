/*
 * arkit.h - what moves a face. Values are weights, 1000 for 1. Written by labial rig 0.4.0; do not edit.
 */
#ifndef LABIAL_RIG_ARKIT_H
#define LABIAL_RIG_ARKIT_H

#include "labial/rig.h"

#if LABIAL_RIG_FORMAT != 3
#error "arkit was written for another version of Labial: run labial rig again."
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define ARKIT_OUTPUTS 17

/* What initialises an array of the outputs' names. */
#define ARKIT_OUTPUT_NAMES { \
    "jawOpen", "mouthClose", "mouthPucker", "mouthSmileLeft", "mouthSmileRight", "mouthStretchLeft", \
    "mouthStretchRight", "mouthUpperUpLeft", "mouthUpperUpRight", "mouthRollLower", "mouthRollUpper", \
    "mouthPressLeft", "mouthPressRight", "mouthFunnel", "mouthLowerDownLeft", "mouthLowerDownRight", \
    "tongueOut" \
}

/* Places of the outputs among the values. */
enum {
    ARKIT_JAWOPEN = 0,
    ARKIT_MOUTHCLOSE = 1,
    ARKIT_MOUTHPUCKER = 2,
    ARKIT_MOUTHSMILELEFT = 3,
    ARKIT_MOUTHSMILERIGHT = 4,
    ARKIT_MOUTHSTRETCHLEFT = 5,
    ARKIT_MOUTHSTRETCHRIGHT = 6,
    ARKIT_MOUTHUPPERUPLEFT = 7,
    ARKIT_MOUTHUPPERUPRIGHT = 8,
    ARKIT_MOUTHROLLLOWER = 9,
    ARKIT_MOUTHROLLUPPER = 10,
    ARKIT_MOUTHPRESSLEFT = 11,
    ARKIT_MOUTHPRESSRIGHT = 12,
    ARKIT_MOUTHFUNNEL = 13,
    ARKIT_MOUTHLOWERDOWNLEFT = 14,
    ARKIT_MOUTHLOWERDOWNRIGHT = 15,
    ARKIT_TONGUEOUT = 16
};

extern const labial_rig_t arkit;

#ifdef __cplusplus
}
#endif

#endif
