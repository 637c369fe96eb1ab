/*
 * hear_host.h - the model of hearing, 192 units in 4 blocks, 120 ms from a frame's begin until it is known.
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
#ifndef LABIAL_MODEL_HEAR_HOST_H
#define LABIAL_MODEL_HEAR_HOST_H

#include "labial/hear.h"

#if LABIAL_HEAR_MODEL_FORMAT != 3
#error "hear_host was exported for another version of Labial: run labial export again."
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define HEAR_HOST_WORKSPACE_SIZE LABIAL_HEAR_WORKSPACE_SIZE(192, 27)
#define HEAR_HOST_CLASSES 26

/* Lip classes, each named by a phoneme that stands for it. */
enum {
    HEAR_HOST_SIL = 0,
    HEAR_HOST_M = 1,
    HEAR_HOST_F = 2,
    HEAR_HOST_TH = 3,
    HEAR_HOST_T = 4,
    HEAR_HOST_L = 5,
    HEAR_HOST_S = 6,
    HEAR_HOST_SH = 7,
    HEAR_HOST_K = 8,
    HEAR_HOST_HH = 9,
    HEAR_HOST_R = 10,
    HEAR_HOST_ER = 11,
    HEAR_HOST_W = 12,
    HEAR_HOST_IY = 13,
    HEAR_HOST_IH = 14,
    HEAR_HOST_EH = 15,
    HEAR_HOST_AE = 16,
    HEAR_HOST_AH = 17,
    HEAR_HOST_AA = 18,
    HEAR_HOST_AO = 19,
    HEAR_HOST_OW = 20,
    HEAR_HOST_UW = 21,
    HEAR_HOST_UH = 22,
    HEAR_HOST_AY = 23,
    HEAR_HOST_AW = 24,
    HEAR_HOST_EY = 25
};

/* For builds that have room for it (labial/config.h). */
#if LABIAL_HEAR_UNITS_MAX >= 192

/* The model, 173756 bytes on a 32-bit target. */
extern const labial_hear_model_t hear_host;

/* The names of the classes; linked only when used. */
extern const char *const hear_host_classes[HEAR_HOST_CLASSES];

#else

/* Any use is an error that says what the model needs. */
#define hear_host hear_host_needs_a_build_with_LABIAL_HEAR_UNITS_MAX_192
#define hear_host_classes hear_host_needs_a_build_with_LABIAL_HEAR_UNITS_MAX_192

#endif

#ifdef __cplusplus
}
#endif

#endif
