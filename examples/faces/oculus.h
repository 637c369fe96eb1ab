/*
 * oculus.h - what moves a face. Values are weights, 1000 for 1. Written by labial rig 0.4.0; do not edit.
 */
#ifndef LABIAL_RIG_OCULUS_H
#define LABIAL_RIG_OCULUS_H

#include "labial/rig.h"

#if LABIAL_RIG_FORMAT != 3
#error "oculus was written for another version of Labial: run labial rig again."
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define OCULUS_OUTPUTS 15

/* What initialises an array of the outputs' names. */
#define OCULUS_OUTPUT_NAMES { \
    "sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "ih", "oh", "ou" \
}

/* Places of the outputs among the values. */
enum {
    OCULUS_SIL = 0,
    OCULUS_PP = 1,
    OCULUS_FF = 2,
    OCULUS_TH = 3,
    OCULUS_DD = 4,
    OCULUS_KK = 5,
    OCULUS_CH = 6,
    OCULUS_SS = 7,
    OCULUS_NN = 8,
    OCULUS_RR = 9,
    OCULUS_AA = 10,
    OCULUS_E = 11,
    OCULUS_IH = 12,
    OCULUS_OH = 13,
    OCULUS_OU = 14
};

extern const labial_rig_t oculus;

#ifdef __cplusplus
}
#endif

#endif
