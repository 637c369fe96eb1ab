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

/* Rows forwards and frames backwards that one step of the solution takes. */
#define LABIAL_SOLVE_ROWS 4u
#define LABIAL_SOLVE_FRAMES 16u

/* What a step of each stage takes, in some 250 instructions of a Cortex-M0 with a model of 50 states. How even the
 * ticks are depends on their proportions, what they compute does not. */
#define LABIAL_COST_TARGET 12u
#define LABIAL_COST_SEARCH 18u
#define LABIAL_COST_SOLVE 6u
#define LABIAL_COST_JOIN 1u

/*
 * Does one step and adds its cost to `spent`; a step that finds a piece uses up what is left.
 *
 * Returns LABIAL_OK; LABIAL_WAITING when it needs phonemes, or room in the ring; LABIAL_DONE.
 */
int labial_work_step(labial_t *stream, unsigned *spent);

/* The frame in the ring that is `i` after the oldest. */
int16_t *labial_work_frame(labial_t *stream, unsigned i);

#endif
