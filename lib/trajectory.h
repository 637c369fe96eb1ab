/*
 * trajectory.h - states to motion: equation 3 of one channel, solved as the frames come.
 *
 *     (W' U^-1 W + A) m = W' U^-1 mu_q + A x
 *
 * q is the state path, U the diagonal of the states' variances, A that of the anchors' precisions and x the targets.
 * Rows of W whose delta window would leave the solution are dropped. With an articulation g, mu_q and x are g times as
 * far from the neutral face, and so is m: the matrix and the path are the same. In contact x is so at most once.
 *
 * The factorisation continues from frame to frame; the backward pass starts LABIAL_WINDOW frames ahead of those that are
 * wanted, as if all frames beyond were equal to the first of them. With weights that labial_model_check() accepts, the error is below .1 FAP unit (as the tests
 * show), and below .2 with the largest articulation.
 */
#ifndef LABIAL_TRAJECTORY_H
#define LABIAL_TRAJECTORY_H

#include "labial/labial.h"

/* What a state adds to equation 3 in each of its frames. */
typedef struct {
    int32_t position;       /* Q12 FAP: the pose to which `hold` pulls with a target of 0 */
    int32_t share;          /* of the target in that pose, Q12 */
    int32_t hold;           /* weight */
    int32_t centre;         /* Q4 FAP: of positions */
    int32_t gain;           /* articulation, in 1/256 */
    int32_t contact_weight; /* weight of a frame in contact */
    int32_t delta;          /* a quarter of its weight */
    int32_t stiff;          /* weight of delta-delta, less `delta` */
    int32_t delta_pull;     /* twice `delta` times delta's mean, Q4 */
    int32_t delta2_pull;    /* delta-delta's weight times its mean, Q4 */
} labial_terms_t;

/* An articulation of 1; the largest is twice that. */
#define LABIAL_GAIN_ONE 256

/* The terms of a state of a channel, with an articulation in 1/256. */
void labial_trajectory_terms(const labial_channel_t *channel, unsigned state, int32_t gain, labial_terms_t *terms);

/*
 * Adds the rows of `count` successive frames of `channel`, one at least, that have the same terms. A frame in contact is
 * tied to its target alone, by `contact_weight`. Every row but a solution's first factors the frame before it, into
 * own[-1]; a solution's last row factors its own frame too, into own[0]; then `own` moves on with the frames.
 */
void labial_trajectory_rows(labial_solver_t *solver, const labial_terms_t *terms, const labial_frame_t *frame,
                            unsigned channel, unsigned count, labial_factors_t *own);

/*
 * The backward pass from the frame of `newest`, with the factors of those before it in front of its own. The `wanted`
 * frames that end `ahead` frames before it are put into `motion`, a ring of `places` frames, from `place` backwards,
 * Q4 FAP.
 */
void labial_trajectory_back(const labial_factors_t *newest, unsigned ahead, unsigned wanted, unsigned place,
                            unsigned places, int16_t *motion);

#endif
