/*
 * jaw.h - what moves a face. Values are microseconds. Written by labial rig 0.4.0; do not edit.
 */
#ifndef LABIAL_RIG_JAW_H
#define LABIAL_RIG_JAW_H

#include "labial/rig.h"

#if LABIAL_RIG_FORMAT != 3
#error "jaw was written for another version of Labial: run labial rig again."
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define JAW_OUTPUTS 1

/* What initialises an array of the outputs' names. */
#define JAW_OUTPUT_NAMES { \
    "jaw" \
}

/* Places of the outputs among the values. */
enum {
    JAW_JAW = 0
};

extern const labial_rig_t jaw;

#ifdef __cplusplus
}
#endif

#endif
