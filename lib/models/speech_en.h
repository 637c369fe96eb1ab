/*
 * speech_en.h - the speech model, method labial, 50 frames per second. Written by labial export 0.4.0; do not
 * edit. Trained on the GRID audio-visual speech corpus (Cooke, Barker, Cunningham and Shao, 2006), CC BY 4.0, and
 * on measurements of addresses by presidents of the United States, works of the federal government (public
 * domain, 17 USC 105).
 */
#ifndef LABIAL_MODEL_SPEECH_EN_H
#define LABIAL_MODEL_SPEECH_EN_H

#include "labial/labial.h"
#include "labial/names.h"

#if LABIAL_MODEL_FORMAT != 7
#error "speech_en was exported for another version of Labial: run labial export again."
#endif

#if LABIAL_REACH < 18
#error "speech_en needs LABIAL_REACH of 18 at least: its targets depend on what is so far away."
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define SPEECH_EN_FPS 50
#define SPEECH_EN_PHONEMES 40
#define SPEECH_EN_STATES 50
#define SPEECH_EN_WORKSPACE_SIZE LABIAL_WORKSPACE_SIZE(3, 8)

/* Phoneme numbers. */
enum {
    SPEECH_EN_SIL = 0,
    SPEECH_EN_AA = 1,
    SPEECH_EN_AE = 2,
    SPEECH_EN_AH = 3,
    SPEECH_EN_AO = 4,
    SPEECH_EN_AW = 5,
    SPEECH_EN_AY = 6,
    SPEECH_EN_B = 7,
    SPEECH_EN_CH = 8,
    SPEECH_EN_D = 9,
    SPEECH_EN_DH = 10,
    SPEECH_EN_EH = 11,
    SPEECH_EN_ER = 12,
    SPEECH_EN_EY = 13,
    SPEECH_EN_F = 14,
    SPEECH_EN_G = 15,
    SPEECH_EN_HH = 16,
    SPEECH_EN_IH = 17,
    SPEECH_EN_IY = 18,
    SPEECH_EN_JH = 19,
    SPEECH_EN_K = 20,
    SPEECH_EN_L = 21,
    SPEECH_EN_M = 22,
    SPEECH_EN_N = 23,
    SPEECH_EN_NG = 24,
    SPEECH_EN_OW = 25,
    SPEECH_EN_OY = 26,
    SPEECH_EN_P = 27,
    SPEECH_EN_R = 28,
    SPEECH_EN_S = 29,
    SPEECH_EN_SH = 30,
    SPEECH_EN_T = 31,
    SPEECH_EN_TH = 32,
    SPEECH_EN_UH = 33,
    SPEECH_EN_UW = 34,
    SPEECH_EN_V = 35,
    SPEECH_EN_W = 36,
    SPEECH_EN_Y = 37,
    SPEECH_EN_Z = 38,
    SPEECH_EN_ZH = 39
};

/* The model, 24446 bytes on a 32-bit target. */
extern const labial_model_t speech_en;

/* Its labels and aliases; linked only when used. */
extern const labial_names_t speech_en_names;

#ifdef __cplusplus
}
#endif

#endif
