/*
 * test_trajectory.c - equation 3 in integers, against a dense solution in doubles of the same weights and means.
 *
 * The oracle writes W row by row as in the paper and multiplies W' U^-1 W out; none of it knows of diagonals.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "fixture.h"
#include "trajectory.h"

#define FRAMES LABIAL_WINDOW
#define STATES 12 /* that a path may take; the others of the model are like the first */

static fixture_model_t model;
static labial_state_t states[LABIAL_STATES_MAX];
static labial_channel_t channel;
static uint8_t path[FRAMES];
static int16_t target[FRAMES];
static double matrix[FRAMES][FRAMES], right[FRAMES];

/* Adds one row of W, three coefficients around frame t, with its precision and mean. */
static void add_row(unsigned t, const double *coefficients, double precision, double mean)
{
    int i, k;
    for (i = -1; i <= 1; i++) {
        if (coefficients[i + 1] == 0.0)
            continue;
        for (k = -1; k <= 1; k++)
            if (coefficients[k + 1] != 0.0)
                matrix[(int)t + i][(int)t + k] += coefficients[i + 1] * coefficients[k + 1] * precision;
        right[(int)t + i] += coefficients[i + 1] * precision * mean;
    }
}

static void eliminate(unsigned n)
{
    unsigned i, k, j;
    for (i = 0; i < n; i++)
        for (k = i + 1; k < n; k++) {
            const double factor = matrix[k][i] / matrix[i][i];
            for (j = i; j < n; j++)
                matrix[k][j] -= factor * matrix[i][j];
            right[k] -= factor * right[i];
        }
    for (i = n; i-- > 0;) {
        for (k = i + 1; k < n; k++)
            right[i] -= matrix[i][k] * right[k];
        right[i] /= matrix[i][i];
    }
}

/* The exact trajectory, in `right`. */
static void oracle(unsigned length)
{
    static const double still[3] = {0, 1, 0}, delta[3] = {-0.5, 0, 0.5}, delta2[3] = {1, -2, 1};
    unsigned t;
    memset(matrix, 0, sizeof matrix);
    memset(right, 0, sizeof right);
    for (t = 0; t < length; t++) {
        const labial_state_t *s = &states[path[t]];
        add_row(t, still, fixture_weight_value(s->weight[0]), s->mean[0]);
        add_row(t, still, fixture_weight_value(s->anchor), target[t]);
        if (t > 0 && t + 1 < length) {
            add_row(t, delta, 4.0 * fixture_weight_value(s->weight[1]), s->mean[1]);
            add_row(t, delta2, fixture_weight_value(s->weight[2]), s->mean[2]);
        }
    }
    eliminate(length);
}

static double worst, sum_of_squares;
static unsigned long compared;

/* The limits that the solver is promised: labial_model_check() itself says whether a test keeps to them. */
static void require_accepted(const char *what, unsigned round)
{
    unsigned q;
    for (q = STATES; q < LABIAL_STATES_MAX; q++)
        states[q] = states[0];
    channel = model.channels[0];
    channel.states = states;
    model.channels[0].states = states;
    if (labial_model_check(&model.model) != LABIAL_OK)
        fail_msg("%s, round %u: the test's own weights are out of range", what, round);
}

/* The library's solution, in the place of the targets in `positions`; `rows` of it in every call. */
static void solve(unsigned length, int16_t *positions, int32_t *factors, unsigned rows)
{
    labial_solver_t solver;
    unsigned t, end;
    memset(&solver, 0, sizeof solver);
    for (t = 0; t < length + 1; t = end) {
        end = t + rows < length + 1 ? t + rows : length + 1;
        labial_trajectory_forward(&solver, &channel, path, length, positions, t, end, factors);
    }
    for (t = length; t > 0; t = end) {
        end = t > rows ? t - rows : 0;
        labial_trajectory_backward(&solver, factors, t, end, positions);
    }
}

/* Solves with the library and compares, in FAP units; frames beyond the range of positions must be at its end. */
static void compare(unsigned length, const char *what, unsigned round)
{
    static int16_t positions[FRAMES * LABIAL_CHANNELS];
    static int32_t factors[LABIAL_FACTORS * FRAMES + 1];
    unsigned t, c;
    for (t = 0; t < FRAMES; t++)
        for (c = 0; c < LABIAL_CHANNELS; c++)
            positions[t * LABIAL_CHANNELS + c] = (int16_t)(c == 0 && t < length ? target[t] : 12345);
    factors[LABIAL_FACTORS * length] = 54321;
    require_accepted(what, round);
    solve(length, positions, factors, 1 + (round + length) % 17);
    oracle(length);
    for (t = 0; t < length; t++) {
        const double limit = LABIAL_POSITION_MAX;
        const double wanted = right[t] > limit ? limit : right[t] < -limit ? -limit : right[t];
        const double error = fabs(positions[t * LABIAL_CHANNELS] - wanted) / 16.0;
        if (error > 0.1)
            fail_msg("%s, round %u, %u frames: frame %u is %g FAP, not %g", what, round, length, t,
                     positions[t * LABIAL_CHANNELS] / 16.0, wanted / 16.0);
        worst = error > worst ? error : worst;
        sum_of_squares += error * error;
        compared++;
        for (c = 1; c < LABIAL_CHANNELS; c++)
            assert_int_equal(positions[t * LABIAL_CHANNELS + c], 12345); /* other channels are not its own */
    }
    assert_int_equal(factors[LABIAL_FACTORS * length], 54321);
}

/* A weight of any size up to `most`, all magnitudes alike. */
static uint8_t any_weight(fixture_random_t *random, double most)
{
    uint8_t code = fixture_weight_code(pow(2.0, 15.0 * fixture_below(random, 1001) / 1000.0) * most / 32768.0);
    while (fixture_weight_value(code) > most)
        code--;
    return code;
}

/* What pulls a frame to static means and targets may weigh this much, half of what labial_model_check() allows. */
#define HELD_MAX ((double)LABIAL_PULL_MAX / LABIAL_POSITION_MAX / 2.0)

/* Random states whose diagonals stay within `total`, held by `hold` at least; means of up to the given sizes. */
static void make(fixture_random_t *random, double total, double hold, int still, int delta, int delta2)
{
    const double part = total / 16.0, held = 2 * part < HELD_MAX / 2 ? 2 * part : HELD_MAX / 2;
    unsigned q, t;
    for (q = 0; q < STATES; q++) {
        labial_state_t *s = &states[q];
        s->mean[0] = (int16_t)((int)fixture_below(random, 2u * (unsigned)still + 1u) - still);
        s->mean[1] = (int16_t)((int)fixture_below(random, 2u * (unsigned)delta + 1u) - delta);
        s->mean[2] = (int16_t)((int)fixture_below(random, 2u * (unsigned)delta2 + 1u) - delta2);
        s->weight[0] = any_weight(random, held);
        s->weight[1] = any_weight(random, 2 * part);
        s->weight[2] = any_weight(random, part);
        s->anchor = fixture_below(random, 2) ? any_weight(random, held) : 0;
        if (fixture_weight_value(s->weight[0]) + fixture_weight_value(s->anchor) < hold)
            s->weight[0] = fixture_weight_code(hold);
    }
    for (t = 0; t < FRAMES; t++) {
        path[t] = (uint8_t)(t > 0 && fixture_below(random, 4) ? path[t - 1] : fixture_below(random, STATES));
        target[t] = (int16_t)((int)fixture_below(random, 2u * (unsigned)still + 1u) - still);
    }
}

static void ordinary_weights(void **state)
{
    fixture_random_t random = {21};
    unsigned round;
    (void)state;
    for (round = 0; round < 2000; round++) {
        make(&random, 3000, 64, 4800, 300, 100);
        compare(1 + round % FRAMES, "ordinary", round);
    }
    assert_true(compared > 10000);
    assert_true(sqrt(sum_of_squares / (double)compared) < 0.03); /* rounding to 1/16 alone is 0.018 */
}

/* All magnitudes that labial_model_check() lets pass, from the weakest hold on. */
static void any_weights_within_the_limits(void **state)
{
    fixture_random_t random = {22};
    unsigned round;
    (void)state;
    for (round = 0; round < 6000; round++) {
        make(&random, round % 2 ? LABIAL_WEIGHT_SUM_MAX : 30000, LABIAL_WEIGHT_MIN, 9600, 200, 50);
        compare(1 + round % FRAMES, "any", round);
    }
}

/* The worst condition: hardly held, and as stiff as may be. */
static void weakest_hold_and_stiffest_motion(void **state)
{
    fixture_random_t random = {23};
    unsigned round, q;
    (void)state;
    for (round = 0; round < 2000; round++) {
        const double total = (round / 4 % 2 ? LABIAL_WEIGHT_SUM_MAX : 32767) * 0.95;
        make(&random, total, LABIAL_WEIGHT_MIN, 9600, round % 3 == 0 ? 100 : 0, round % 5 == 0 ? 10 : 0);
        for (q = 0; q < STATES; q++) {
            states[q].weight[0] = LABIAL_WEIGHT_MIN;
            states[q].anchor = 0;
            states[q].weight[1] = round % 4 < 2 ? fixture_weight_code(total / 4) : 0;
            states[q].weight[2] = round % 4 != 1 ? fixture_weight_code(round % 4 ? total / 6 : total / 12) : 0;
        }
        compare(1 + fixture_below(&random, FRAMES), "stiff", round);
    }
}

/* Means at both ends of the range, as a jump of the whole face is. */
static void extreme_positions(void **state)
{
    fixture_random_t random = {24};
    unsigned round, q;
    (void)state;
    for (round = 0; round < 1000; round++) {
        make(&random, LABIAL_WEIGHT_SUM_MAX, LABIAL_WEIGHT_MIN, LABIAL_POSITION_MAX, 0, 0);
        for (q = 0; q < STATES; q++)
            states[q].mean[0] = (int16_t)(q % 2 ? LABIAL_POSITION_MAX : -LABIAL_POSITION_MAX);
        compare(1 + round % FRAMES, "extreme", round);
    }
}

/* Whatever the means: within the range, and no arithmetic that is undefined (with a sanitizer). */
static void absurd_means_stay_within_the_range(void **state)
{
    fixture_random_t random = {26};
    static int16_t positions[FRAMES * LABIAL_CHANNELS];
    static int32_t factors[LABIAL_FACTORS * FRAMES];
    unsigned round, t;
    (void)state;
    for (round = 0; round < 2000; round++) {
        make(&random, HELD_MAX, LABIAL_WEIGHT_MIN, LABIAL_POSITION_MAX, LABIAL_POSITION_MAX, LABIAL_POSITION_MAX);
        require_accepted("absurd", round);
        for (t = 0; t < FRAMES; t++)
            positions[t * LABIAL_CHANNELS] = target[t];
        solve(FRAMES, positions, factors, FRAMES + 1);
        for (t = 0; t < FRAMES; t++)
            assert_true(positions[t * LABIAL_CHANNELS] >= -LABIAL_POSITION_MAX &&
                        positions[t * LABIAL_CHANNELS] <= LABIAL_POSITION_MAX);
    }
}

/* In as many calls as it pleases: would catch a solution that loses where it stands between two of them. */
static void calls_may_be_of_any_size(void **state)
{
    fixture_random_t random = {27};
    static int16_t wanted[FRAMES * LABIAL_CHANNELS], positions[FRAMES * LABIAL_CHANNELS];
    static int32_t factors[LABIAL_FACTORS * FRAMES];
    unsigned length, rows, t;
    (void)state;
    for (length = 1; length <= FRAMES; length++) {
        make(&random, 30000, LABIAL_WEIGHT_MIN, 9600, 200, 50);
        require_accepted("calls", length);
        for (rows = 1; rows <= length + 1; rows++) {
            for (t = 0; t < length; t++)
                positions[t * LABIAL_CHANNELS] = target[t];
            solve(length, positions, factors, rows);
            if (rows == 1)
                memcpy(wanted, positions, sizeof wanted);
            for (t = 0; t < length; t++)
                assert_int_equal(positions[t * LABIAL_CHANNELS], wanted[t * LABIAL_CHANNELS]);
        }
    }
}

/* The cross-fade along 3 s^2 - 2 s^3 in steps of 2^-14, to the nearest sixteenth: at its ends, between, and where the
 * difference is the largest there is. Would catch a fade that is linear, runs backwards or overflows. */
static void fading_follows_its_curve(void **state)
{
    unsigned steps, step, c;
    (void)state;
    for (steps = 2; steps <= LABIAL_OVERLAP + 1; steps++) {
        for (step = 0; step <= steps; step++) {
            const double s = (double)step / steps, share = s * s * (3.0 - 2.0 * s);
            int16_t held[LABIAL_CHANNELS], fresh[LABIAL_CHANNELS];
            for (c = 0; c < LABIAL_CHANNELS; c++) {
                held[c] = (int16_t)(c == 0 ? -32767 : c == 1 ? 32767 : (int)c * 700 - 4000);
                fresh[c] = (int16_t)(c == 0 ? 32767 : c == 1 ? -32767 : 3000 - (int)(c * c) * 50);
            }
            labial_trajectory_fade(held, fresh, step, steps);
            for (c = 0; c < LABIAL_CHANNELS; c++) {
                const double from = c == 0 ? -32767 : c == 1 ? 32767 : (int)c * 700 - 4000;
                const double wanted = from + (fresh[c] - from) * share;
                if (fabs(held[c] - wanted) > 0.5 + fabs(fresh[c] - from) * 5.5 / 16384.0)
                    fail_msg("step %u of %u, channel %u: %d, not %g", step, steps, c, held[c], wanted);
            }
        }
    }
}

static int setup(void **state)
{
    (void)state;
    fixture_slow(&model);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ordinary_weights),
        cmocka_unit_test(any_weights_within_the_limits),
        cmocka_unit_test(weakest_hold_and_stiffest_motion),
        cmocka_unit_test(extreme_positions),
        cmocka_unit_test(absurd_means_stay_within_the_range),
        cmocka_unit_test(calls_may_be_of_any_size),
        cmocka_unit_test(fading_follows_its_curve),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
