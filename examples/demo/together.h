/*
 * together.h - two streams in step, one that talks and one that laughs, and their blended frames.
 */
#ifndef LABIAL_EXAMPLE_TOGETHER_H
#define LABIAL_EXAMPLE_TOGETHER_H

#include "score.h"

typedef void (*together_sink_t)(void *user, const int16_t faps[LABIAL_CHANNELS]);

/* Performs a score whose phonemes are those of speech_en and laughter_synthetic, and passes its frames to `sink`.
 * Returns LABIAL_OK or the labial_result_t that ended it early. */
int together_play(const score_t *score, together_sink_t sink, void *user);

#endif
