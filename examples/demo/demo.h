/*
 * demo.h - what the parts of the demo offer each other: the score of a performance, and the performance.
 */
#ifndef LABIAL_EXAMPLE_DEMO_H
#define LABIAL_EXAMPLE_DEMO_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "labial/model.h"
#include "labial/names.h"

/* ---- score.c: phonemes one after the other, and laughs under the words ------------------------------------------- */

/* Time before and after the laugh in which words are spoken laughing, milliseconds. */
#define SCORE_LEAD 2000u
#define SCORE_TRAIL 900u

/* The voice of a file's phonemes. */
typedef struct {
    const labial_model_t *model;
    const labial_names_t *names;
    const char *kind; /* of the phonemes, as page_phoneme_t has it; static */
} score_voice_t;

typedef struct {
    const labial_model_t *model;
    const char *label, *kind; /* for the page; static */
    uint64_t begin;           /* milliseconds from the start of the score */
    uint32_t milliseconds;
    uint8_t number; /* of the model */
} score_phoneme_t;

/* A laugh, in milliseconds from the start of the score: begin <= alone <= words <= end, each no earlier than the end of
 * the laugh before. */
typedef struct {
    uint64_t begin;     /* sets in under the words */
    uint64_t alone;     /* the words stop */
    uint64_t words;     /* they go on */
    uint64_t end;       /* has died away */
    unsigned intensity; /* of labial_laugh_init() */
} score_laugh_t;

/* Zero-initialise, fill with score_read(), release with score_release(). */
typedef struct {
    score_phoneme_t *phonemes;
    size_t phoneme_count, phoneme_room;
    score_laugh_t *laughs;
    size_t laugh_count, laugh_room;
    uint64_t end; /* milliseconds */
} score_t;

/* Appends the timings of a file (say/timings.h) in a voice. A laugh in a file of speech is a pause in the words, and
 * begins SCORE_LEAD before it. Returns 0, or -1 after printing the error. */
int score_read(score_t *score, const char *path, const score_voice_t *voice);

void score_release(score_t *score);

/* ---- together.c: two streams in step, one that talks and one that laughs, and their blended frames --------------- */

typedef void (*together_sink_t)(void *user, const int16_t faps[LABIAL_CHANNELS]);

/* Performs a score whose phonemes are those of speech_en and laughter_synthetic, and passes its frames to `sink`.
 * Returns LABIAL_OK or the labial_result_t that ended it early. */
int together_play(const score_t *score, together_sink_t sink, void *user);

#endif
