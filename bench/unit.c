#include "unit.h"

#include "labial/labial.h"
#include "trajectory.h"

#define HOLD 4u /* frames that a state lasts */

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

void bench_unit_solve(bench_unit_t *unit, const labial_model_t *model, unsigned k)
{
    bench_solve(model, k, unit->path, BENCH_UNIT, &unit->targets[0][k]);
}

void bench_solve(const labial_model_t *model, unsigned k, const uint8_t *path, unsigned length, int16_t *positions)
{
    static int32_t factors[LABIAL_FACTORS * LABIAL_WINDOW];
    static const labial_solver_t zero;
    labial_solver_t solver = zero;
    labial_trajectory_forward(&solver, &model->channels[k], path, length, positions, 0, length + 1u, factors);
    labial_trajectory_backward(&solver, factors, length, 0, positions);
}
