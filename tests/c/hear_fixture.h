/*
 * hear_fixture.h - the model of hearing, 8 units in 3 blocks, 100 ms from a frame's begin until it is known.
 * Written by labial export 0.4.0; do not edit.
 */
#ifndef LABIAL_MODEL_HEAR_FIXTURE_H
#define LABIAL_MODEL_HEAR_FIXTURE_H

#include "labial/hear.h"

#if LABIAL_HEAR_MODEL_FORMAT != 3
#error "hear_fixture was exported for another version of Labial: run labial export again."
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define HEAR_FIXTURE_WORKSPACE_SIZE LABIAL_HEAR_WORKSPACE_SIZE(8, 11)
#define HEAR_FIXTURE_CLASSES 5

/* Lip classes, each named by a phoneme that stands for it. */
enum {
    HEAR_FIXTURE_SIL = 0,
    HEAR_FIXTURE_M = 1,
    HEAR_FIXTURE_AA = 2,
    HEAR_FIXTURE_S = 3,
    HEAR_FIXTURE_IY = 4
};

/* The model, 1232 bytes on a 32-bit target. */
extern const labial_hear_model_t hear_fixture;

/* The names of the classes; linked only when used. */
extern const char *const hear_fixture_classes[HEAR_FIXTURE_CLASSES];

#ifdef __cplusplus
}
#endif

#endif
