/*
 * unit.h - equation 3 alone: a unit of BENCH_UNIT frames whose states and targets are those of a model.
 */
#ifndef BENCH_UNIT_H
#define BENCH_UNIT_H

#include "labial/model.h"

#define BENCH_UNIT 40 /* frames */

/* A unit of one channel: where its states are and where its frames are drawn to. */
typedef struct {
    uint8_t path[BENCH_UNIT];
    int16_t targets[BENCH_UNIT][LABIAL_CHANNELS]; /* every channel's, so that the solver's stride is the library's */
} bench_unit_t;

/* Channel k of the unit: ten states of four frames each, spread over the codebook, and targets on straight lines from
 * one state's mean to the next. */
void bench_unit_fill(bench_unit_t *unit, const labial_model_t *model, unsigned k);

/* The library's solution of channel k, which takes the targets' place. */
void bench_unit_solve(bench_unit_t *unit, const labial_model_t *model, unsigned k);

/* The same for a unit of up to LABIAL_WINDOW frames from elsewhere; `positions` holds a target every LABIAL_CHANNELS.
 * All that measures the solver calls it here: the solver's state zeroed, all rows forwards, all frames backwards. */
void bench_solve(const labial_model_t *model, unsigned k, const uint8_t *path, unsigned length, int16_t *positions);

#endif
