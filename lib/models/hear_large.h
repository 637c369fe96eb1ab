/*
 * hear_large.h - the model of hearing, 76 units in 4 blocks, 120 ms from a frame's begin until it is known.
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
#ifndef LABIAL_MODEL_HEAR_LARGE_H
#define LABIAL_MODEL_HEAR_LARGE_H

#include "labial/hear.h"

#if LABIAL_HEAR_MODEL_FORMAT != 3
#error "hear_large was exported for another version of Labial: run labial export again."
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define HEAR_LARGE_WORKSPACE_SIZE LABIAL_HEAR_WORKSPACE_SIZE(76, 27)
#define HEAR_LARGE_CLASSES 26

/* Lip classes, each named by a phoneme that stands for it. */
enum {
    HEAR_LARGE_SIL = 0,
    HEAR_LARGE_M = 1,
    HEAR_LARGE_F = 2,
    HEAR_LARGE_TH = 3,
    HEAR_LARGE_T = 4,
    HEAR_LARGE_L = 5,
    HEAR_LARGE_S = 6,
    HEAR_LARGE_SH = 7,
    HEAR_LARGE_K = 8,
    HEAR_LARGE_HH = 9,
    HEAR_LARGE_R = 10,
    HEAR_LARGE_ER = 11,
    HEAR_LARGE_W = 12,
    HEAR_LARGE_IY = 13,
    HEAR_LARGE_IH = 14,
    HEAR_LARGE_EH = 15,
    HEAR_LARGE_AE = 16,
    HEAR_LARGE_AH = 17,
    HEAR_LARGE_AA = 18,
    HEAR_LARGE_AO = 19,
    HEAR_LARGE_OW = 20,
    HEAR_LARGE_UW = 21,
    HEAR_LARGE_UH = 22,
    HEAR_LARGE_AY = 23,
    HEAR_LARGE_AW = 24,
    HEAR_LARGE_EY = 25
};

/* The model, 33744 bytes on a 32-bit target. */
extern const labial_hear_model_t hear_large;

/* The names of the classes; linked only when used. */
extern const char *const hear_large_classes[HEAR_LARGE_CLASSES];

#ifdef __cplusplus
}
#endif

#endif
