/*
 * hear_small.h - the model of hearing, 68 units in 3 blocks, 120 ms from a frame's begin until it is known.
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
#ifndef LABIAL_MODEL_HEAR_SMALL_H
#define LABIAL_MODEL_HEAR_SMALL_H

#include "labial/hear.h"

#if LABIAL_HEAR_MODEL_FORMAT != 3
#error "hear_small was exported for another version of Labial: run labial export again."
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define HEAR_SMALL_WORKSPACE_SIZE LABIAL_HEAR_WORKSPACE_SIZE(68, 27)
#define HEAR_SMALL_CLASSES 26

/* Lip classes, each named by a phoneme that stands for it. */
enum {
    HEAR_SMALL_SIL = 0,
    HEAR_SMALL_M = 1,
    HEAR_SMALL_F = 2,
    HEAR_SMALL_TH = 3,
    HEAR_SMALL_T = 4,
    HEAR_SMALL_L = 5,
    HEAR_SMALL_S = 6,
    HEAR_SMALL_SH = 7,
    HEAR_SMALL_K = 8,
    HEAR_SMALL_HH = 9,
    HEAR_SMALL_R = 10,
    HEAR_SMALL_ER = 11,
    HEAR_SMALL_W = 12,
    HEAR_SMALL_IY = 13,
    HEAR_SMALL_IH = 14,
    HEAR_SMALL_EH = 15,
    HEAR_SMALL_AE = 16,
    HEAR_SMALL_AH = 17,
    HEAR_SMALL_AA = 18,
    HEAR_SMALL_AO = 19,
    HEAR_SMALL_OW = 20,
    HEAR_SMALL_UW = 21,
    HEAR_SMALL_UH = 22,
    HEAR_SMALL_AY = 23,
    HEAR_SMALL_AW = 24,
    HEAR_SMALL_EY = 25
};

/* The model, 22660 bytes on a 32-bit target. */
extern const labial_hear_model_t hear_small;

/* The names of the classes; linked only when used. */
extern const char *const hear_small_classes[HEAR_SMALL_CLASSES];

#ifdef __cplusplus
}
#endif

#endif
