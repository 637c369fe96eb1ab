/*
 * demo.h - what the parts of the demo offer each other: the score of a performance, and the performance.
 */
#ifndef LABIAL_EXAMPLE_DEMO_H
#define LABIAL_EXAMPLE_DEMO_H

#include <stddef.h>
#include <stdint.h>

#include "labial/model.h"

typedef struct {
    const labial_model_t *model;
    const char *label, *kind; /* for the page; static. The kind is "speech", "laughing" (spoken while laughing),
                               * "laughter" or "silence" */
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

/* Phonemes one after the other, and laughs under the words. */
typedef struct {
    score_phoneme_t *phonemes;
    size_t phoneme_count, phoneme_room;
    score_laugh_t *laughs;
    size_t laugh_count, laugh_room;
    uint64_t end; /* milliseconds */
} score_t;

typedef void (*together_sink_t)(void *user, const int16_t faps[LABIAL_CHANNELS]);

/* together.c: performs a score whose phonemes are those of speech_en and laughter_synthetic, and passes its frames to
 * `sink`. Returns LABIAL_OK or the labial_result_t that ended it early. */
int together_play(const score_t *score, together_sink_t sink, void *user);

#endif
