/*
 * servos.h - what moves a face. Values are ticks of 4.88 us (PCA9685 with prescale register 121, 50.03 Hz).
 * Written by labial rig 0.4.0; do not edit.
 */
#ifndef LABIAL_RIG_SERVOS_H
#define LABIAL_RIG_SERVOS_H

#include "labial/rig.h"

#if LABIAL_RIG_FORMAT != 3
#error "servos was written for another version of Labial: run labial rig again."
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define SERVOS_OUTPUTS 5

/* What initialises an array of the outputs' names. */
#define SERVOS_OUTPUT_NAMES { \
    "jaw", "upper_lip", "lower_lip", "corner_left", "corner_right" \
}

/* What the PCA9685's prescale register must hold for these ticks. */
#define SERVOS_PCA9685_PRESCALE 121

/* Places of the outputs among the values. */
enum {
    SERVOS_JAW = 0,
    SERVOS_UPPER_LIP = 1,
    SERVOS_LOWER_LIP = 2,
    SERVOS_CORNER_LEFT = 3,
    SERVOS_CORNER_RIGHT = 4
};

extern const labial_rig_t servos;

#ifdef __cplusplus
}
#endif

#endif
