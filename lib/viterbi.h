/*
 * viterbi.h - targets to states: the most likely path of one channel through its codebook (section 3 of the method).
 *
 * A score is the cost of the best path into a state, times 256, plus the state's number: the least of several is the
 * best path and names where it comes from, the lower number at a tie.
 */
#ifndef LABIAL_VITERBI_H
#define LABIAL_VITERBI_H

#include "labial/model.h"

/* Scores of the first frame, whose target is `position`. */
void labial_viterbi_start(const labial_channel_t *channel, unsigned states, int32_t position, uint32_t *scores);

/* Scores `to` of the next frame from those of the last; `back` receives each state's best predecessor. */
void labial_viterbi_step(const labial_channel_t *channel, unsigned states, int32_t position, const uint32_t *from,
                         uint32_t *to, uint8_t *back);

/* The best path that ends in the last frame's `scores`; `back` holds `length - 1` rows of `states` predecessors. */
void labial_viterbi_path(unsigned states, unsigned length, const uint32_t *scores, const uint8_t *back, uint8_t *path);

#endif
