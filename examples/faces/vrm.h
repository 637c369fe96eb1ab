/*
 * vrm.h - what moves a face. Values are weights, 1000 for 1. Written by labial rig 0.4.0; do not edit.
 */
#ifndef LABIAL_RIG_VRM_H
#define LABIAL_RIG_VRM_H

#include "labial/rig.h"

#if LABIAL_RIG_FORMAT != 3
#error "vrm was written for another version of Labial: run labial rig again."
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define VRM_OUTPUTS 5

/* What initialises an array of the outputs' names. */
#define VRM_OUTPUT_NAMES { \
    "aa", "ih", "ou", "ee", "oh" \
}

/* Places of the outputs among the values. */
enum {
    VRM_AA = 0,
    VRM_IH = 1,
    VRM_OU = 2,
    VRM_EE = 3,
    VRM_OH = 4
};

extern const labial_rig_t vrm;

#ifdef __cplusplus
}
#endif

#endif
