/*
 * trajectory.h - states to motion: equation 3 of one channel, solved as the frames come.
 *
 *     (W' U^-1 W + A) m = W' U^-1 mu_q + A x
 *
 * q is the state path, U the diagonal of the states' variances, A that of the anchors' precisions and x the targets.
 * Rows of W whose delta window would leave the solution are dropped. The factorisation continues from frame to frame;
 * the way back starts LABIAL_WINDOW frames ahead of those that are wanted, as if all frames beyond were equal to the
 * first of them. With weights that labial_model_check() accepts, the error is below a tenth of a FAP unit (as the tests
 * show).
 */
#ifndef LABIAL_TRAJECTORY_H
#define LABIAL_TRAJECTORY_H

#include "labial/labial.h"

/* What a state adds to equation 3 in each of its frames. */
typedef struct {
    int32_t position;    /* Q12 FAP: the mean of the static feature */
    int32_t origin;      /* the target, a position, at which the anchor agrees with it */
    int32_t share;       /* of the anchor in `hold`, in 1/256 */
    int32_t hold;        /* weight */
    int32_t firm;        /* the least weight of a frame in contact */
    int32_t delta;       /* a quarter of its weight */
    int32_t delta2;      /* weight of delta-delta */
    int32_t delta_pull;  /* twice `delta` times delta's mean, Q4 */
    int32_t delta2_pull; /* `delta2` times its mean, Q4 */
} labial_terms_t;

/* The terms of a state of a channel. */
void labial_trajectory_terms(const labial_channel_t *channel, unsigned state, labial_terms_t *terms);

/*
 * Adds the row of a frame, whose target is `position`; in `contact` its hold is at least `firm` and ties it to this
 * target. `marks` say whether it is the solution's first or last. Every row but the first factors the frame before it,
 * for which it needs `before`, its place in the ring; the last one factors its own frame too, `own`.
 */
void labial_trajectory_row(labial_solver_t *solver, const labial_terms_t *terms, int32_t position, int contact,
                           unsigned marks, labial_factors_t *before, labial_factors_t *own);

/*
 * The way back through the newest `count` frames of a ring of `size` factors, the newest being at `newest`. Of these
 * the last `wanted` are put into `motion`, a ring of as many `places`, from `place` backwards: Q4 FAP, one frame every
 * LABIAL_CHANNELS.
 */
void labial_trajectory_back(const labial_factors_t *factors, unsigned size, unsigned newest, unsigned count,
                            unsigned wanted, unsigned place, unsigned places, int16_t *motion);

#endif
