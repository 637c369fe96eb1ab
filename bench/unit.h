/*
 * unit.h - equation 3 alone: a unit of BENCH_UNIT frames whose states and targets are those of a model.
 */
#ifndef BENCH_UNIT_H
#define BENCH_UNIT_H

#include "labial/labial.h"

#define BENCH_CHANNELS 8 /* that the bundled models have at least */
#define BENCH_UNIT 42    /* frames */
#define BENCH_HOLD 3u    /* frames that a state lasts, and that a channel's turn takes */
#define BENCH_SOLVE 400  /* frames that bench_solve() takes at most */

/* Bytes that the solver needs of a channel, as the workspace holds them. */
#define BENCH_MEMORY (sizeof(labial_solver_t) + sizeof(labial_kept_t))

/* A unit of one channel: where its states are and where its frames are drawn to. */
typedef struct {
    uint8_t path[BENCH_UNIT];
    int16_t targets[BENCH_UNIT];
} bench_unit_t;

/* Channel k of the unit: states of three frames each, spread over the codebook, and targets on straight lines from one
 * state's mean to the next. */
void bench_unit_fill(bench_unit_t *unit, const labial_model_t *model, unsigned k);

/* Solves channel k as a stream does, a turn of three frames at a time, each with its way back. `motion` receives what a
 * turn delivers. */
void bench_unit_solve(const bench_unit_t *unit, const labial_model_t *model, unsigned k, int16_t motion[BENCH_HOLD]);

/* The whole solution of up to BENCH_SOLVE frames, with the way back from the last one; it takes the place of the targets in
 * `positions`. */
void bench_solve(const labial_model_t *model, unsigned k, const uint8_t *path, unsigned length, int16_t *positions);

#endif
