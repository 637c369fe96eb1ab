/*
 * laughter_synthetic.h - the laughter model, method labial, 50 frames per second. Written by labial export 0.4.0;
 * do not edit. Trained on a synthetic corpus: the timings follow published statistics, the amplitudes are design
 * choices.
 */
#ifndef LABIAL_MODEL_LAUGHTER_SYNTHETIC_H
#define LABIAL_MODEL_LAUGHTER_SYNTHETIC_H

#include "labial/labial.h"
#include "labial/names.h"

#if LABIAL_MODEL_FORMAT != 7
#error "laughter_synthetic was exported for another version of Labial: run labial export again."
#endif

#if LABIAL_REACH < 18
#error "laughter_synthetic needs LABIAL_REACH of 18 at least: its targets depend on what is so far away."
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define LAUGHTER_SYNTHETIC_FPS 50
#define LAUGHTER_SYNTHETIC_PHONEMES 24
#define LAUGHTER_SYNTHETIC_STATES 10
#define LAUGHTER_SYNTHETIC_WORKSPACE_SIZE LABIAL_WORKSPACE_SIZE(3, 8)

/* Phoneme numbers. */
enum {
    LAUGHTER_SYNTHETIC_SILENCE = 0,
    LAUGHTER_SYNTHETIC_NE = 1,
    LAUGHTER_SYNTHETIC_CLICK = 2,
    LAUGHTER_SYNTHETIC_NASAL = 3,
    LAUGHTER_SYNTHETIC_PLOSIVE = 4,
    LAUGHTER_SYNTHETIC_FRICATIVE = 5,
    LAUGHTER_SYNTHETIC_IC = 6,
    LAUGHTER_SYNTHETIC_E = 7,
    LAUGHTER_SYNTHETIC_O = 8,
    LAUGHTER_SYNTHETIC_GRUNT = 9,
    LAUGHTER_SYNTHETIC_CACKLE = 10,
    LAUGHTER_SYNTHETIC_A = 11,
    LAUGHTER_SYNTHETIC_FRICATIVE_SOFT = 12,
    LAUGHTER_SYNTHETIC_FRICATIVE_LOUD = 13,
    LAUGHTER_SYNTHETIC_IC_SOFT = 14,
    LAUGHTER_SYNTHETIC_IC_LOUD = 15,
    LAUGHTER_SYNTHETIC_E_SOFT = 16,
    LAUGHTER_SYNTHETIC_E_LOUD = 17,
    LAUGHTER_SYNTHETIC_O_SOFT = 18,
    LAUGHTER_SYNTHETIC_O_LOUD = 19,
    LAUGHTER_SYNTHETIC_CACKLE_SOFT = 20,
    LAUGHTER_SYNTHETIC_CACKLE_LOUD = 21,
    LAUGHTER_SYNTHETIC_A_SOFT = 22,
    LAUGHTER_SYNTHETIC_A_LOUD = 23
};

/* The model, 8418 bytes on a 32-bit target. */
extern const labial_model_t laughter_synthetic;

/* Its labels and aliases; linked only when used. */
extern const labial_names_t laughter_synthetic_names;

#ifdef __cplusplus
}
#endif

#endif
