/*
 * work.h - pieces to frames: the work of a stream, one small step at a time.
 *
 *     queue --FIND--> piece --TARGET--> targets --SEARCH--> path --SOLVE--> trajectory --JOIN--> ring
 *                              once per frame     once per channel and frame       once per frame
 */
#ifndef LABIAL_WORK_H
#define LABIAL_WORK_H

#include "labial/labial.h"

/* Stages of a piece. */
enum { LABIAL_STAGE_FIND, LABIAL_STAGE_TARGET, LABIAL_STAGE_SEARCH, LABIAL_STAGE_SOLVE, LABIAL_STAGE_JOIN };

/* What a step of each stage takes, in quarters of a Viterbi step of 50 states: estimates for a small core. How even the
 * ticks are depends on their proportions, what they compute does not. */
#define LABIAL_COST_FIND 1u
#define LABIAL_COST_TARGET 3u
#define LABIAL_COST_SEARCH 4u
#define LABIAL_COST_SOLVE(frames) (1u + (frames) / 2u)
#define LABIAL_COST_JOIN 1u

/* What the shortest pieces take, two frames of which one is delivered. */
#define LABIAL_COST_PIECE                                                                                   \
    (LABIAL_COST_FIND +                                                                                     \
     2u * (LABIAL_COST_TARGET + LABIAL_CHANNELS * LABIAL_COST_SEARCH + LABIAL_COST_JOIN) +                  \
     LABIAL_CHANNELS * LABIAL_COST_SOLVE(2u))

/*
 * Does one step and adds its cost to `spent`.
 *
 * Returns LABIAL_OK; LABIAL_WAITING when it needs phonemes, or room in the ring; LABIAL_DONE.
 */
int labial_work_step(labial_t *stream, unsigned *spent);

/* The frame in the ring that is `i` after the oldest. */
int16_t *labial_work_frame(labial_t *stream, unsigned i);

#endif
