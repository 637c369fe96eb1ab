/*
 * labial-bench-mlpg labial|hts|compare|sptk|about N - equation 3 of N units of 12 channels, for callgrind and massif:
 *
 *   labial    by the library
 *   hts       by hts_engine's HTS_PStreamSet_create(), which takes the same means and variances as public structures
 *   compare   by both, and says how far apart they are
 *   about     by nobody: says whether hts_engine is built in, and what memory Labial needs
 *   sptk      by nobody: writes means and precisions, float32, as SPTK's `mlpg -i 1` reads them from a file
 *
 * The anchors of Labial's equation 3 are a second static row; others know only one, so the two are merged into one, as
 * Labial's tables have them.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fixed.h"
#include "speech_en.h"
#include "unit.h"

#define WINDOWS 3 /* static, delta, delta-delta */

static const labial_model_t *const model = &speech_en;

/* Means, positions, and precisions of the rows of frame t, delta's precision in full. */
static void rows(const bench_unit_t *unit, unsigned k, unsigned t, double mean[WINDOWS], double precision[WINDOWS])
{
    const labial_state_t *state = &model->channels[k].states[unit->path[t]];
    const double share = (state->share + (state->share >> 7)) / 256.0;
    const int inside = t > 0 && t + 1 < BENCH_UNIT;
    precision[0] = labial_weight(state->hold);
    mean[0] = state->mean + share * (unit->targets[t] - state->mean);
    precision[1] = inside ? 4.0 * labial_weight(state->weight[0]) : 0.0;
    mean[1] = labial_scaled(state->motion[0], model->channels[k].motion_scale[0]);
    precision[2] = inside ? labial_weight(state->weight[1]) : 0.0;
    mean[2] = labial_scaled(state->motion[1], model->channels[k].motion_scale[1]);
}

#ifdef BENCH_HTS
#include <HTS_engine.h>

/* Exported by the library, declared in a header that Debian does not install. */
extern void HTS_PStreamSet_initialize(HTS_PStreamSet *set);
extern HTS_Boolean HTS_PStreamSet_create(HTS_PStreamSet *set, HTS_SStreamSet *states, double *msd_threshold,
                                         double *gv_weight);
extern double HTS_PStreamSet_get_parameter(HTS_PStreamSet *set, size_t stream, size_t frame, size_t dimension);
extern void HTS_PStreamSet_clear(HTS_PStreamSet *set);

static double means[BENCH_UNIT][WINDOWS * BENCH_CHANNELS], variances[BENCH_UNIT][WINDOWS * BENCH_CHANNELS];

/* Every frame is a state of its own, since the channels' states change apart. */
static void hts_states(const bench_unit_t *unit)
{
    for (unsigned t = 0; t < BENCH_UNIT; t++)
        for (unsigned k = 0; k < BENCH_CHANNELS; k++) {
            double mean[WINDOWS], precision[WINDOWS];
            rows(&unit[k], k, t, mean, precision);
            for (unsigned w = 0; w < WINDOWS; w++) {
                means[t][w * BENCH_CHANNELS + k] = mean[w];
                variances[t][w * BENCH_CHANNELS + k] = precision[w] > 0.0 ? 1.0 / precision[w] : 1e30;
            }
        }
}

/* Solves the unit `count` times; the last solution is left in `result`, positions, when that is not null. */
static int hts_solve(const bench_unit_t *unit, unsigned long count, double (*result)[LABIAL_CHANNELS])
{
    static double still[1] = { 1.0 }, delta[3] = { -0.5, 0.0, 0.5 }, delta2[3] = { 1.0, -2.0, 1.0 };
    double *centres[WINDOWS] = { still, delta + 1, delta2 + 1 }; /* the engine counts from the window's middle */
    int left[WINDOWS] = { 0, -1, -1 }, right[WINDOWS] = { 0, 1, 1 };
    double *mean_rows[BENCH_UNIT], *variance_rows[BENCH_UNIT];
    size_t durations[BENCH_UNIT];
    HTS_SStream stream = { 0 };
    HTS_SStreamSet states = { 0 };

    hts_states(unit);
    for (unsigned t = 0; t < BENCH_UNIT; t++) {
        mean_rows[t] = means[t];
        variance_rows[t] = variances[t];
        durations[t] = 1;
    }
    stream.vector_length = BENCH_CHANNELS;
    stream.mean = mean_rows;
    stream.vari = variance_rows;
    stream.win_size = WINDOWS;
    stream.win_l_width = left;
    stream.win_r_width = right;
    stream.win_coefficient = centres;
    stream.win_max_width = 1;
    states.sstream = &stream;
    states.nstream = states.nstate = 1;
    states.duration = durations;
    states.total_state = states.total_frame = BENCH_UNIT;
    while (count-- > 0) {
        HTS_PStreamSet solved;
        HTS_PStreamSet_initialize(&solved);
        if (!HTS_PStreamSet_create(&solved, &states, NULL, NULL))
            return 1;
        if (result && count == 0)
            for (unsigned t = 0; t < BENCH_UNIT; t++)
                for (unsigned k = 0; k < BENCH_CHANNELS; k++)
                    result[t][k] = HTS_PStreamSet_get_parameter(&solved, 0, t, k);
        HTS_PStreamSet_clear(&solved);
    }
    return 0;
}

static int compare(bench_unit_t *unit)
{
    static double expected[BENCH_UNIT][LABIAL_CHANNELS];
    double largest = 0.0;
    if (hts_solve(unit, 1, expected))
        return 1;
    for (unsigned k = 0; k < BENCH_CHANNELS; k++) {
        bench_solve(model, k, unit[k].path, BENCH_UNIT, unit[k].targets);
        for (unsigned t = 0; t < BENCH_UNIT; t++) {
            const double difference = fabs(unit[k].targets[t] - expected[t][k]) / 16.0;
            largest = difference > largest ? difference : largest;
        }
    }
    printf("largest difference %.4f FAP units\n", largest);
    return largest < 0.1 ? 0 : 1;
}
#endif

static void sptk_write(const bench_unit_t *unit, unsigned long count)
{
    while (count-- > 0)
        for (unsigned t = 0; t < BENCH_UNIT; t++) {
            float frame[2][WINDOWS][BENCH_CHANNELS];
            for (unsigned k = 0; k < BENCH_CHANNELS; k++) {
                double mean[WINDOWS], precision[WINDOWS];
                rows(&unit[k], k, t, mean, precision);
                for (unsigned w = 0; w < WINDOWS; w++) {
                    frame[0][w][k] = (float)mean[w];
                    frame[1][w][k] = (float)precision[w];
                }
            }
            fwrite(frame, sizeof frame, 1, stdout);
        }
}

int main(int argc, char **argv)
{
    static bench_unit_t unit[BENCH_CHANNELS];
    static int16_t motion[BENCH_HOLD];
    const long count = argc == 3 ? atol(argv[2]) : 0;
    if (count > 0) {
        if (strcmp(argv[1], "about") == 0) {
#ifdef BENCH_HTS
            puts("hts_engine: yes");
#else
            puts("hts_engine: no");
#endif
            printf("memory: %u bytes\n", (unsigned)(BENCH_CHANNELS * BENCH_MEMORY));
            return 0;
        }
        for (unsigned k = 0; k < BENCH_CHANNELS; k++)
            bench_unit_fill(&unit[k], model, k);
        if (strcmp(argv[1], "labial") == 0) {
            for (long i = 0; i < count; i++)
                for (unsigned k = 0; k < BENCH_CHANNELS; k++)
                    bench_unit_solve(&unit[k], model, k, motion);
            return 0;
        }
        if (strcmp(argv[1], "sptk") == 0) {
            sptk_write(unit, (unsigned long)count);
            return 0;
        }
#ifdef BENCH_HTS
        if (strcmp(argv[1], "hts") == 0)
            return hts_solve(unit, (unsigned long)count, NULL);
        if (strcmp(argv[1], "compare") == 0)
            return compare(unit);
#endif
    }
    fputs("usage: labial-bench-mlpg labial|hts|compare|sptk|about N\n"
          "hts and compare where it was built with hts_engine\n",
          stderr);
    return 2;
}
