/*
 * face.h - what moves a face. Values are microseconds. Written by labial rig 0.4.0; do not edit.
 */
#ifndef LABIAL_RIG_FACE_H
#define LABIAL_RIG_FACE_H

#include "labial/rig.h"

#if LABIAL_RIG_FORMAT != 3
#error "face was written for another version of Labial: run labial rig again."
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define FACE_OUTPUTS 3

/* What initialises an array of the outputs' names. */
#define FACE_OUTPUT_NAMES { \
    "jaw", "upper_lip", "corners" \
}

/* Places of the outputs among the values. */
enum {
    FACE_JAW = 0,
    FACE_UPPER_LIP = 1,
    FACE_CORNERS = 2
};

extern const labial_rig_t face;

#ifdef __cplusplus
}
#endif

#endif
