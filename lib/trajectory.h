/*
 * trajectory.h - states to motion: equation 3, solved for one channel of one piece.
 */
#ifndef LABIAL_TRAJECTORY_H
#define LABIAL_TRAJECTORY_H

#include "labial/model.h"

/*
 * What ties frame t to its target beside the state's own anchor: the precision of component[t] in this channel, times
 * share[t] / 2^16, rounded to a whole weight. `precisions` is the model's table at the channel; null without such a table.
 */
typedef struct {
    const uint8_t *precisions;
    const uint16_t *component;
    const uint16_t *share;
} labial_ties_t;

/*
 * Solves (W' U^-1 W + A) m = W' U^-1 mu_q + A x for the trajectory m of `length` frames, where q is `path`, U the
 * diagonal of the states' variances, A that of the anchors' precisions and x the targets, which `positions` holds, one
 * every LABIAL_CHANNELS; m replaces them. Rows whose delta window would leave the piece are dropped. `scratch` has room
 * for 3 * length numbers.
 *
 * Error: with weights that labial_model_check() accepts, less than a tenth of a FAP unit (the tests hold it to that).
 */
void labial_trajectory_solve(const labial_channel_t *channel, const labial_ties_t *ties, const uint8_t *path,
                             unsigned length, int16_t *positions, int32_t *scratch);

/* Moves `held`, one frame in Q4 FAP, from the old trajectory towards `fresh` by step / steps: the linear cross-fade of a
 * phoneme that two pieces share. */
void labial_trajectory_fade(int16_t held[LABIAL_CHANNELS], const int16_t fresh[LABIAL_CHANNELS], unsigned step,
                            unsigned steps);

#endif
