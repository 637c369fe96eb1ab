/*
 * trajectory.h - states to motion: equation 3, solved for one channel of one piece, frame by frame.
 *
 *     (W' U^-1 W + A) m = W' U^-1 mu_q + A x
 *
 * q is the state path, U the diagonal of the states' variances, A that of the anchors' precisions and x the targets.
 * Rows of W whose delta window would leave the piece are dropped. With weights that labial_model_check() accepts the
 * error is below a tenth of a FAP unit (the tests hold it to that).
 */
#ifndef LABIAL_TRAJECTORY_H
#define LABIAL_TRAJECTORY_H

#include "labial/model.h"

/* Where a solution stands; all zero before the first frame. trajectory.c says what the members mean. */
typedef struct {
    int32_t a0, r0;         /* what the rows so far add to the frame of the next row */
    int32_t a1, b1, r1;     /* and to the frame before it */
    int32_t e, c1, c2;      /* of the factorisation */
    int32_t lambda, kappa1, kappa2;
    int32_t z1, z2;
    int32_t m1, m2; /* of the substitution */
} labial_solver_t;

/* Numbers that a solution keeps for each frame. */
#define LABIAL_FACTORS 3

/*
 * Forward: takes up rows t .. end - 1; row t factors frame t - 1. All rows from 0 to `length`, of which the last is
 * empty, are taken up in their order, in as many calls as it pleases. `path` is the piece's, `positions` its targets,
 * one every LABIAL_CHANNELS; `factors` has LABIAL_FACTORS numbers per frame.
 */
void labial_trajectory_forward(labial_solver_t *solver, const labial_channel_t *channel, const uint8_t *path,
                               unsigned length, const int16_t *positions, unsigned t, unsigned end, int32_t *factors);

/* Backward: puts the solutions of frames t - 1 .. end, in this order, in the place of their targets; from the last
 * frame to the first, in as many calls as it pleases. */
void labial_trajectory_backward(labial_solver_t *solver, const int32_t *factors, unsigned t, unsigned end,
                                int16_t *positions);

/* Moves `held`, one frame in Q4 FAP, from the old trajectory towards `fresh`: the cross-fade of frames that two pieces
 * share, `step` of `steps`. */
void labial_trajectory_fade(int16_t held[LABIAL_CHANNELS], const int16_t fresh[LABIAL_CHANNELS], unsigned step,
                            unsigned steps);

#endif
