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
    for (unsigned t = 0; t < BENCH_UNIT; t++) {
        const int32_t here = states[state_of(model, k, t)].mean;
        const int32_t next = states[state_of(model, k, t + HOLD)].mean;
        unit->path[t] = (uint8_t)state_of(model, k, t);
        unit->targets[t] = (int16_t)(here + (next - here) * (int32_t)(t % HOLD) / (int32_t)HOLD);
    }
}

static uint8_t marks_of(unsigned t, unsigned length)
{
    return (uint8_t)((t == 0 ? (unsigned)LABIAL_BEGINS : 0u) | (t + 1u == length ? (unsigned)LABIAL_ENDS : 0u));
}

void bench_unit_solve(const bench_unit_t *unit, const labial_model_t *model, unsigned k, int16_t motion[HOLD])
{
    static labial_kept_t kept;
    static labial_solver_t solver;
    static labial_frame_t frames[HOLD];
    labial_factors_t work[LABIAL_WINDOW + HOLD + 1];
    labial_terms_t terms;
    for (unsigned t = 0; t < BENCH_UNIT; t += HOLD) {
        *(labial_kept_t *)(void *)work = kept;
        for (unsigned i = 0; i < HOLD; i++) {
            frames[i].target[k] = unit->targets[t + i];
            frames[i].marks = marks_of(t + i, BENCH_UNIT);
        }
        labial_trajectory_terms(&model->channels[k], unit->path[t], LABIAL_GAIN_ONE, &terms);
        labial_trajectory_rows(&solver, &terms, frames, k, HOLD, work + LABIAL_WINDOW + 1);
        if (t >= LABIAL_WINDOW + HOLD)
            labial_trajectory_back(work + LABIAL_WINDOW + HOLD - 1, LABIAL_WINDOW, HOLD, HOLD - 1u, HOLD, motion);
        kept = *(const labial_kept_t *)(const void *)(work + HOLD);
    }
}

void bench_solve(const labial_model_t *model, unsigned k, const uint8_t *path, unsigned length, int16_t *positions)
{
    static labial_factors_t factors[BENCH_SOLVE];
    static labial_solver_t solver;
    static labial_frame_t frame;
    labial_terms_t terms;
    for (unsigned t = 0; t < length; t++) {
        labial_trajectory_terms(&model->channels[k], path[t], LABIAL_GAIN_ONE, &terms);
        frame.target[k] = positions[t];
        frame.marks = marks_of(t, length);
        labial_trajectory_rows(&solver, &terms, &frame, k, 1, &factors[t]);
    }
    labial_trajectory_back(&factors[length - 1u], 0, length, length - 1u, length, positions);
    for (unsigned t = 0; t < length; t++)
        positions[t] = (int16_t)(positions[t] - model->channels[k].centre);
}
