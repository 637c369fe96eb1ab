/*
 * hear_ahead.h - the model of hearing, 192 units in 4 blocks, 280 ms from a frame's begin until it is known.
 * Written by labial export 0.4.0; do not edit. Trained on speech of LibriSpeech (c) 2014 Vassil Panayotov, Guoguo
 * Chen, Daniel Povey and Sanjeev Khudanpur, CC BY 4.0, https://www.openslr.org/12; LibriTTS (c) 2019 Heiga Zen
 * and others, Google, CC BY 4.0, https://www.openslr.org/60; the CSTR VCTK Corpus 0.92 (c) 2019 Junichi
 * Yamagishi, Christophe Veaux and Kirsten MacDonald, University of Edinburgh, CC BY 4.0,
 * https://datashare.ed.ac.uk/handle/10283/3443; CMU ARCTIC (c) 2003 Carnegie Mellon University, John Kominek and
 * Alan W Black, http://festvox.org/cmu_arctic; Kathleen, of the Rhasspy project (CC0 1.0); LJ Speech (public
 * domain); and of the synthesisers flite, Festival and espeak-ng. The sound was resampled, mixed and distorted.
 * The lips are those of Labial's model speech_en, trained on the GRID audio-visual speech corpus (Cooke, Barker,
 * Cunningham and Shao, 2006), CC BY 4.0, and on measurements of addresses by presidents of the United States
 * (public domain).
 */
#ifndef LABIAL_MODEL_HEAR_AHEAD_H
#define LABIAL_MODEL_HEAR_AHEAD_H

#include "labial/hear.h"

#if LABIAL_HEAR_MODEL_FORMAT != 3
#error "hear_ahead was exported for another version of Labial: run labial export again."
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define HEAR_AHEAD_WORKSPACE_SIZE LABIAL_HEAR_WORKSPACE_SIZE(192, 41)
#define HEAR_AHEAD_CLASSES 26

/* Lip classes, each named by a phoneme that stands for it. */
enum {
    HEAR_AHEAD_SIL = 0,
    HEAR_AHEAD_M = 1,
    HEAR_AHEAD_F = 2,
    HEAR_AHEAD_TH = 3,
    HEAR_AHEAD_T = 4,
    HEAR_AHEAD_L = 5,
    HEAR_AHEAD_S = 6,
    HEAR_AHEAD_SH = 7,
    HEAR_AHEAD_K = 8,
    HEAR_AHEAD_HH = 9,
    HEAR_AHEAD_R = 10,
    HEAR_AHEAD_ER = 11,
    HEAR_AHEAD_W = 12,
    HEAR_AHEAD_IY = 13,
    HEAR_AHEAD_IH = 14,
    HEAR_AHEAD_EH = 15,
    HEAR_AHEAD_AE = 16,
    HEAR_AHEAD_AH = 17,
    HEAR_AHEAD_AA = 18,
    HEAR_AHEAD_AO = 19,
    HEAR_AHEAD_OW = 20,
    HEAR_AHEAD_UW = 21,
    HEAR_AHEAD_UH = 22,
    HEAR_AHEAD_AY = 23,
    HEAR_AHEAD_AW = 24,
    HEAR_AHEAD_EY = 25
};

/* For builds that have room for it (labial/config.h). */
#if LABIAL_HEAR_UNITS_MAX >= 192

/* The model, 175292 bytes on a 32-bit target. */
extern const labial_hear_model_t hear_ahead;

/* The names of the classes; linked only when used. */
extern const char *const hear_ahead_classes[HEAR_AHEAD_CLASSES];

#else

/* Any use is an error that says what the model needs. */
#define hear_ahead hear_ahead_needs_a_build_with_LABIAL_HEAR_UNITS_MAX_192
#define hear_ahead_classes hear_ahead_needs_a_build_with_LABIAL_HEAR_UNITS_MAX_192

#endif

#ifdef __cplusplus
}
#endif

#endif
