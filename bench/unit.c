#include "unit.h"

#include "labial/labial.h"
#include "trajectory.h"
#include "units.h"

#define HOLD BENCH_HOLD

static unsigned state_of(const labial_model_t *model, unsigned k, unsigned t)
{
    return (t / HOLD * 7u + k * 3u) % model->state_count;
}

void bench_unit_fill(bench_unit_t *unit, const labial_model_t *model, unsigned k)
{
    const labial_state_t *states = model->channels[k].states;
    unsigned t;
    for (t = 0; t < BENCH_UNIT; t++) {
        const int32_t here = states[state_of(model, k, t)].mean[0];
        const int32_t next = states[state_of(model, k, t + HOLD)].mean[0];
        unit->path[t] = (uint8_t)state_of(model, k, t);
        unit->targets[t][k] = (int16_t)(here + (next - here) * (int32_t)(t % HOLD) / (int32_t)HOLD);
    }
}

static unsigned marks_of(unsigned t, unsigned length)
{
    return (t == 0 ? (unsigned)LABIAL_BEGINS : 0u) | (t + 1u == length ? (unsigned)LABIAL_ENDS : 0u);
}

void bench_unit_solve(const bench_unit_t *unit, const labial_model_t *model, unsigned k,
                      int16_t motion[HOLD][LABIAL_CHANNELS])
{
    static labial_factors_t factors[LABIAL_FACTORS_(HOLD)];
    static labial_solver_t solver;
    const unsigned size = LABIAL_FACTORS_(HOLD);
    unsigned t, place = 0, before = 0, turn = 0;
    labial_terms_t terms;
    for (t = 0; t < BENCH_UNIT; t++) {
        if (turn == 0)
            labial_trajectory_terms(&model->channels[k], unit->path[t], &terms);
        labial_trajectory_row(&solver, &terms, unit->targets[t][k], 0, marks_of(t, BENCH_UNIT), &factors[before],
                              &factors[place]);
        turn = turn + 1u < HOLD ? turn + 1u : 0u;
        if (turn == 0 && t >= LABIAL_WINDOW + HOLD)
            labial_trajectory_back(factors, size, before, LABIAL_WINDOW + HOLD, HOLD, HOLD - 1u, HOLD, &motion[0][k]);
        before = place;
        place = place + 1u < size ? place + 1u : 0u;
    }
}

void bench_solve(const labial_model_t *model, unsigned k, const uint8_t *path, unsigned length, int16_t *positions)
{
    static labial_factors_t factors[BENCH_SOLVE];
    static labial_solver_t solver;
    unsigned t;
    labial_terms_t terms;
    for (t = 0; t < length; t++) {
        labial_trajectory_terms(&model->channels[k], path[t], &terms);
        labial_trajectory_row(&solver, &terms, positions[t * LABIAL_CHANNELS], 0, marks_of(t, length),
                              &factors[t > 0 ? t - 1u : 0u], &factors[t]);
    }
    labial_trajectory_back(factors, BENCH_SOLVE, length - 1u, length, length, length - 1u, length, positions);
    for (t = 0; t < length; t++)
        positions[t * LABIAL_CHANNELS] = (int16_t)(positions[t * LABIAL_CHANNELS] - model->channels[k].centre);
}
