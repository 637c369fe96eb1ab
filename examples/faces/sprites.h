/*
 * sprites.h - what moves a face. Values are plain units. Written by labial rig 0.4.0; do not edit.
 */
#ifndef LABIAL_RIG_SPRITES_H
#define LABIAL_RIG_SPRITES_H

#include "labial/rig.h"

#if LABIAL_RIG_FORMAT != 3
#error "sprites was written for another version of Labial: run labial rig again."
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define SPRITES_OUTPUTS 4

/* What initialises an array of the outputs' names. */
#define SPRITES_OUTPUT_NAMES { \
    "opening", "smile", "rounding", "upper" \
}

/* Places of the outputs among the values. */
enum {
    SPRITES_OPENING = 0,
    SPRITES_SMILE = 1,
    SPRITES_ROUNDING = 2,
    SPRITES_UPPER = 3
};

extern const labial_rig_t sprites;

#ifdef __cplusplus
}
#endif

#endif
