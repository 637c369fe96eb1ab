/*
 * viterbi.h - targets to states: the most likely path of one channel through its codebook (section 3 of the method).
 *
 * A score is the cost of the best path into a state, times 256; its low byte is free. An edge holds four times its
 * predecessor's number there, so that one addition makes a candidate that names where it comes from: the least of
 * several is the best path, the lower number at a tie. Beside its predecessors, every state can be entered from the
 * best state of the step before, at the highest cost of a transition.
 *
 * States whose emission costs more than LABIAL_BEAM above the least are passed over: their predecessors are not looked
 * at, and they are not counted for the best. Likely paths do not run through them, and they are most of the work.
 */
#ifndef LABIAL_VITERBI_H
#define LABIAL_VITERBI_H

#include "labial/model.h"

/* Cost: three nats. */
#define LABIAL_BEAM 96u

/* Scores of the first step, whose target is `position`: one for each state, and behind them the best of those that were
 * not passed over, with four times its number in the low byte. */
void labial_viterbi_start(const labial_model_t *model, const labial_channel_t *channel, int32_t position,
                          uint32_t *scores);

/* Scores `to` of the next step from those of the last; `back` receives four times each state's best predecessor. */
void labial_viterbi_step(const labial_model_t *model, const labial_channel_t *channel, int32_t position,
                         const uint32_t *from, uint32_t *to, uint8_t *back);

/* The best path that ends in the last step's `scores`, a state for each of `length` frames; `back` holds a row of
 * predecessors for each step but the first. */
void labial_viterbi_path(const labial_model_t *model, unsigned length, const uint32_t *scores, const uint8_t *back,
                         uint8_t *path);

#endif
