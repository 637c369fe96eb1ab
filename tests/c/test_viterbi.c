/*
 * test_viterbi.c - the search for the likeliest state path, against exhaustive search and against a dense dynamic
 * programme in doubles. Costs are those of labial/model.h.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>

#include "fixture.h"
#include "viterbi.h"

#define FRAMES LABIAL_WINDOW
#define NONE 1e30

static labial_emission_t emissions[LABIAL_STATES_MAX];
static uint16_t rows[LABIAL_STATES_MAX + 1];
static uint16_t edges[LABIAL_STATES_MAX * LABIAL_STATES_MAX];
static double transition[LABIAL_STATES_MAX][LABIAL_STATES_MAX]; /* [from][to], NONE where there is no edge */
static labial_channel_t channel;
static int32_t position[FRAMES];

/* A random channel of `states` states, each with `density` in 256 of the possible predecessors and one at least. */
static void make(fixture_random_t *random, unsigned states, uint32_t density, uint32_t spread)
{
    unsigned q, p, n = 0;
    for (q = 0; q < states; q++) {
        emissions[q].mean = (int16_t)((int)fixture_below(random, 2 * spread + 1) - (int)spread);
        emissions[q].gain = (uint16_t)(50 + fixture_below(random, 3000));
        emissions[q].cost = (uint8_t)fixture_random(random);
        emissions[q].initial = (uint8_t)fixture_random(random);
        rows[q] = (uint16_t)n;
        for (p = 0; p < states; p++) {
            transition[p][q] = NONE;
            if (p == (q + 1) % states || fixture_below(random, 256) < density) {
                const uint32_t cost = fixture_below(random, 256);
                edges[n++] = (uint16_t)(cost << 8 | p);
                transition[p][q] = (double)cost;
            }
        }
    }
    rows[states] = (uint16_t)n;
    channel.emissions = emissions;
    channel.rows = rows;
    channel.edges = edges;
    for (q = 0; q < FRAMES; q++)
        position[q] = (int32_t)fixture_below(random, 2 * spread + 1) - (int32_t)spread;
}

/* A Gaussian's exponent and log sigma. Costs are whole numbers, rounded down, and end where z does, at 1023 / 64. */
static double emission(unsigned q, int32_t x)
{
    double z = floor(fabs((double)x - emissions[q].mean) * emissions[q].gain / 4096.0);
    z = z < 1023.0 ? z : 1023.0;
    return floor(z * z / 128.0) + emissions[q].cost;
}

static double path_cost(const uint8_t *path, unsigned length)
{
    double cost = emissions[path[0]].initial + emission(path[0], position[0]);
    unsigned t;
    for (t = 1; t < length; t++)
        cost += transition[path[t - 1]][path[t]] + emission(path[t], position[t]);
    return cost;
}

/* The library's path; `score` receives the least cost it found. */
static void search(unsigned states, unsigned length, uint8_t *path, double *score)
{
    static uint32_t scores[2][LABIAL_STATES_MAX];
    static uint8_t back[FRAMES * LABIAL_STATES_MAX];
    unsigned t, q;
    uint32_t least = UINT32_MAX;
    labial_viterbi_start(&channel, states, position[0], scores[0]);
    for (t = 1; t < length; t++)
        labial_viterbi_step(&channel, states, position[t], scores[(t - 1) % 2], scores[t % 2],
                            back + (t - 1) * states);
    labial_viterbi_path(states, length, scores[(length - 1) % 2], back, path);
    for (q = 0; q < states; q++)
        least = scores[(length - 1) % 2][q] < least ? scores[(length - 1) % 2][q] : least;
    *score = (double)(least >> 8);
}

/* Least cost of all paths, each of them tried. */
static double exhaustive(unsigned states, unsigned length)
{
    uint8_t path[8] = {0};
    double best = NONE;
    unsigned t;
    for (;;) {
        const double cost = path_cost(path, length);
        best = cost < best ? cost : best;
        for (t = 0; t < length && ++path[t] == states; t++)
            path[t] = 0;
        if (t == length)
            return best;
    }
}

/* Least cost by dynamic programming over the dense matrix. */
static double dense(unsigned states, unsigned length)
{
    double now[LABIAL_STATES_MAX], next[LABIAL_STATES_MAX], best = NONE;
    unsigned t, p, q;
    for (q = 0; q < states; q++)
        now[q] = emissions[q].initial + emission(q, position[0]);
    for (t = 1; t < length; t++) {
        for (q = 0; q < states; q++) {
            next[q] = NONE;
            for (p = 0; p < states; p++)
                if (now[p] + transition[p][q] < next[q])
                    next[q] = now[p] + transition[p][q];
            next[q] += emission(q, position[t]);
        }
        for (q = 0; q < states; q++)
            now[q] = next[q];
    }
    for (q = 0; q < states; q++)
        best = now[q] < best ? now[q] : best;
    return best;
}

static void check(unsigned states, unsigned length, double best)
{
    uint8_t path[FRAMES];
    double score, cost;
    search(states, length, path, &score);
    cost = path_cost(path, length); /* NONE when it takes an edge that is not there */
    if (cost > best + 0.5 || fabs(score - best) > 0.5)
        fail_msg("%u states, %u frames: a path of %g, said to be %g, where the best is %g", states, length, cost, score,
                 best);
}

/* Would catch a wrong back-pointer, a wrong row of them, a transition taken the other way round. */
static void small_problems_are_solved_as_by_exhaustive_search(void **state)
{
    fixture_random_t random = {11};
    unsigned round;
    (void)state;
    for (round = 0; round < 400; round++) {
        const unsigned states = 1 + round % 4, length = 1 + round / 4 % 6;
        make(&random, states, 40 + fixture_below(&random, 200), 300 + round * 10);
        check(states, length, exhaustive(states, length));
    }
}

/* Would catch an overflow of scores over a whole window, with the largest costs there are. */
static void large_problems_are_solved_as_by_doubles(void **state)
{
    fixture_random_t random = {12};
    unsigned round, q;
    (void)state;
    for (round = 0; round < 150; round++) {
        const unsigned states = 1 + fixture_below(&random, LABIAL_STATES_MAX);
        make(&random, states, round % 3 ? 30 : 256, round % 2 ? LABIAL_POSITION_MAX : 4000);
        if (round % 5 == 0)
            for (q = 0; q < states; q++)
                emissions[q].gain = 65535; /* every cost at its limit */
        check(states, FRAMES, dense(states, FRAMES));
    }
}

/* "The lower number at a tie": without it targets could differ. */
static void ties_go_to_the_lower_state(void **state)
{
    uint8_t path[FRAMES];
    double score;
    unsigned q, t, n = 0;
    (void)state;
    for (q = 0; q < 5; q++) {
        emissions[q].mean = 0;
        emissions[q].gain = 100;
        emissions[q].cost = emissions[q].initial = 7;
        rows[q] = (uint16_t)n;
        for (t = 5; t-- > 0;) /* listed from the highest to the lowest */
            edges[n++] = (uint16_t)(9u << 8 | t);
    }
    rows[5] = (uint16_t)n;
    channel.emissions = emissions;
    channel.rows = rows;
    channel.edges = edges;
    for (t = 0; t < FRAMES; t++)
        position[t] = 50;
    search(5, FRAMES, path, &score);
    for (t = 0; t < FRAMES; t++)
        assert_int_equal(path[t], 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_problems_are_solved_as_by_exhaustive_search),
        cmocka_unit_test(large_problems_are_solved_as_by_doubles),
        cmocka_unit_test(ties_go_to_the_lower_state),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
