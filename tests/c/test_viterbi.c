/*
 * test_viterbi.c - the search for the likeliest state path, against exhaustive search and against a dense dynamic
 * programme in doubles. Costs are those of labial/model.h.
 *
 * Both oracles know the search's two rules from lib/viterbi.h, in different words: the exhaustive one lets every state
 * that was not passed over be left at the cost of a leap, the dense one the best of them alone.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "fixture.h"
#include "viterbi.h"

#define STEPS LABIAL_WINDOW
#define NONE 1e30
#define LEAP 255.0

static labial_model_t model;
static labial_emission_t emissions[LABIAL_STATES_MAX];
static uint16_t edges[LABIAL_STATES_MAX * LABIAL_STATES_MAX];
static double transition[LABIAL_STATES_MAX][LABIAL_STATES_MAX]; /* [from][to], NONE where there is no edge */
static labial_channel_t channel;
static int32_t position[STEPS];

/* A random channel of `states` states, each with `density` in 256 of the possible predecessors and one at least, the
 * last repeated up to a multiple of four. The spread of positions and the gains decide how many states are passed
 * over. */
static void make(fixture_random_t *random, unsigned states, uint32_t density, uint32_t spread, uint32_t gains)
{
    uint16_t lists[LABIAL_STATES_MAX][LABIAL_STATES_MAX];
    unsigned counts[LABIAL_STATES_MAX], most = 0, q, p;
    for (q = 0; q < states; q++) {
        unsigned n = 0;
        emissions[q].mean = (int16_t)((int)fixture_below(random, 2 * spread + 1) - (int)spread);
        emissions[q].gain = (uint16_t)(gains / 20 + fixture_below(random, gains));
        emissions[q].cost = (uint8_t)fixture_random(random);
        emissions[q].initial = (uint8_t)fixture_random(random);
        for (p = 0; p < states; p++) {
            transition[p][q] = NONE;
            if (p == (q + 1) % states || fixture_below(random, 256) < density) {
                const uint32_t cost = fixture_below(random, 256);
                lists[q][n++] = (uint16_t)(cost << 8 | 4 * p);
                transition[p][q] = (double)cost;
            }
        }
        counts[q] = n;
        most = n > most ? n : most;
    }
    most = (most + 3) / 4 * 4;
    for (q = 0; q < states; q++)
        for (p = 0; p < most; p++)
            edges[q * most + p] = lists[q][p < counts[q] ? p : counts[q] - 1];
    model.state_count = (uint8_t)states;
    model.predecessors = (uint8_t)most;
    model.search_stride = 1;
    channel.emissions = emissions;
    channel.edges = edges;
    for (q = 0; q < STEPS; q++)
        position[q] = (int32_t)fixture_below(random, 2 * spread + 1) - (int32_t)spread;
}

/* A Gaussian's exponent and log sigma. Costs are whole numbers, rounded down, and end where z does, at 1023 / 64. */
static double emission(unsigned q, int32_t x)
{
    double z = floor(fabs((double)x - emissions[q].mean) * emissions[q].gain / 4096.0);
    z = z < 1023.0 ? z : 1023.0;
    return floor(z * z / 128.0) + emissions[q].cost;
}

/* Whether step t passes state q over: never the first. */
static int is_passed(unsigned q, unsigned t)
{
    double least = NONE;
    unsigned p;
    for (p = 0; p < model.state_count; p++)
        least = emission(p, position[t]) < least ? emission(p, position[t]) : least;
    return t > 0 && emission(q, position[t]) > least + LABIAL_BEAM;
}

/* From p into q at step t; NONE when there is no way. */
static double entry(unsigned p, unsigned q, unsigned t)
{
    const double edge = is_passed(q, t) ? NONE : transition[p][q];
    return is_passed(p, t - 1) || edge < LEAP ? edge : LEAP;
}

static double path_cost(const uint8_t *path, unsigned steps)
{
    double cost = emissions[path[0]].initial + emission(path[0], position[0]);
    unsigned t;
    for (t = 1; t < steps; t++)
        cost += entry(path[t - 1], path[t], t) + emission(path[t], position[t]);
    return cost;
}

/* Least cost of all paths, each of them tried. */
static double exhaustive(unsigned states, unsigned steps)
{
    uint8_t path[8] = {0};
    double best = NONE;
    unsigned t;
    for (;;) {
        const double cost = path_cost(path, steps);
        best = cost < best ? cost : best;
        for (t = 0; t < steps && ++path[t] == states; t++)
            path[t] = 0;
        if (t == steps)
            return best;
    }
}

/* What the dense programme has found: the least cost of each state in each step, the best state that was not passed
 * over, and the path, the lower state wherever several are alike. */
typedef struct {
    double cost[STEPS][LABIAL_STATES_MAX];
    unsigned best[STEPS];
    uint8_t path[STEPS];
    unsigned leaps;  /* on the path */
    unsigned passed; /* states in all steps */
} dense_t;

/* With `rules` unset: no leaps, and nothing is passed over. */
static void dense(unsigned steps, int rules, dense_t *found)
{
    static unsigned back[STEPS][LABIAL_STATES_MAX];
    const unsigned states = model.state_count;
    unsigned t, p, q;
    memset(found, 0, sizeof *found);
    for (t = 0; t < steps; t++) {
        double best = NONE;
        for (q = 0; q < states; q++) {
            const int passed = rules && is_passed(q, t);
            double least = t > 0 ? NONE : emissions[q].initial;
            for (p = 0; t > 0 && p < states; p++) {
                double cost = passed ? NONE : found->cost[t - 1][p] + transition[p][q];
                if (rules && p == found->best[t - 1] && found->cost[t - 1][p] + LEAP < cost)
                    cost = found->cost[t - 1][p] + LEAP;
                if (cost < least) {
                    least = cost;
                    back[t][q] = p;
                }
            }
            found->cost[t][q] = least + emission(q, position[t]);
            found->passed += (unsigned)passed;
            if (!passed && found->cost[t][q] < best) {
                best = found->cost[t][q];
                found->best[t] = q;
            }
        }
    }
    for (q = 0, t = steps - 1; q < states; q++)
        if (found->cost[t][q] < found->cost[t][found->path[t]])
            found->path[t] = (uint8_t)q;
    for (; t > 0; t--) {
        found->path[t - 1] = (uint8_t)back[t][found->path[t]];
        found->leaps += transition[found->path[t - 1]][found->path[t]] > LEAP || is_passed(found->path[t], t);
    }
}

/* The library's path; `score` receives the least cost it found. Scores of every step are compared with `wanted`, unless
 * that is null. Nothing is written behind what is the library's own. */
static void search(unsigned steps, uint8_t *path, double *score, const dense_t *wanted)
{
    static uint32_t scores[2][LABIAL_STATES_MAX + 2];
    static uint8_t back[STEPS * LABIAL_STATES_MAX + 1];
    const unsigned states = model.state_count;
    unsigned t, q;
    uint32_t least = UINT32_MAX;
    memset(back, 0xff, sizeof back);
    for (t = 0; t < steps; t++) {
        uint32_t *to = scores[t % 2];
        to[states + 1] = 0xc3c3c3c3u;
        if (t == 0)
            labial_viterbi_start(&model, &channel, position[0], to);
        else
            labial_viterbi_step(&model, &channel, position[t], scores[(t - 1) % 2], to, back + (t - 1) * states);
        assert_int_equal(to[states + 1], 0xc3c3c3c3u);
        assert_int_equal(back[t * states], 0xff);
        for (q = 0; wanted && q < states; q++)
            if ((double)(to[q] >> 8) != wanted->cost[t][q])
                fail_msg("step %u, state %u: %u, not %g", t, q, to[q] >> 8, wanted->cost[t][q]);
        if (wanted && (to[states] & 0xffu) != 4 * wanted->best[t])
            fail_msg("step %u: state %u is the best, not %u", t, (to[states] & 0xffu) / 4, wanted->best[t]);
        if (wanted)
            assert_int_equal(to[states] >> 8, (uint32_t)wanted->cost[t][wanted->best[t]]);
    }
    labial_viterbi_path(&model, steps, scores[(steps - 1) % 2], back, path);
    for (q = 0; q < states; q++)
        least = scores[(steps - 1) % 2][q] < least ? scores[(steps - 1) % 2][q] : least;
    *score = (double)(least >> 8);
}

/* Would catch a wrong back-pointer, a wrong row of them, a transition taken the other way round; a leap from any but
 * the best state, into a state that has a cheaper edge, or at another cost; a state that is passed over too early, too
 * late or in the first step. */
static void small_problems_are_solved_as_by_exhaustive_search(void **state)
{
    fixture_random_t random = {11};
    unsigned round, leaps = 0, ruled = 0;
    dense_t free_of_rules, ruled_by;
    (void)state;
    for (round = 0; round < 1200; round++) {
        const unsigned states = 1 + round % 4, steps = 1 + round / 4 % 6;
        uint8_t path[STEPS];
        double score, cost, best;
        make(&random, states, 40 + fixture_below(&random, 200), 300 + round % 400 * 10, round % 7 ? 3000 : 300);
        best = exhaustive(states, steps);
        search(steps, path, &score, NULL);
        cost = path_cost(path, steps); /* NONE when it takes a way that is not there */
        if (cost != best || score != best)
            fail_msg("%u states, %u steps: a path of %g, said to be %g, where the best is %g", states, steps, cost,
                     score, best);
        dense(steps, 0, &free_of_rules);
        dense(steps, 1, &ruled_by);
        leaps += ruled_by.leaps;
        ruled += memcmp(free_of_rules.path, ruled_by.path, sizeof ruled_by.path) != 0;
    }
    assert_true(leaps > 100 && ruled > 100); /* both rules were met */
}

/* Would catch an overflow of scores over a whole window, with the largest costs there are; and every difference in a
 * state's score, in the state that leaps start from, or in the path. */
static void large_problems_are_solved_as_by_doubles(void **state)
{
    static dense_t wanted;
    fixture_random_t random = {12};
    unsigned round, q, leaps = 0, passed = 0, all = 0;
    (void)state;
    for (round = 0; round < 150; round++) {
        const unsigned states = 1 + fixture_below(&random, LABIAL_STATES_MAX);
        uint8_t path[STEPS];
        double score;
        make(&random, states, round % 3 ? 30 : 256, round % 2 ? LABIAL_POSITION_MAX : 4000, round % 4 < 2 ? 3000 : 100);
        if (round % 5 == 0)
            for (q = 0; q < states; q++)
                emissions[q].gain = 65535; /* every cost at its limit */
        dense(STEPS, 1, &wanted);
        search(STEPS, path, &score, &wanted);
        assert_memory_equal(path, wanted.path, STEPS);
        assert_true(score == wanted.cost[STEPS - 1][wanted.path[STEPS - 1]]);
        leaps += wanted.leaps;
        passed += wanted.passed;
        all += states * STEPS;
    }
    assert_true(leaps > 100);
    assert_in_range(passed, all / 5, all * 4 / 5);
}

/* Costs at the edges of both rules: would catch `<` for `<=`, or a beam or a leap of another size. The only way into
 * state 1 is its edge from itself or a leap. */
static void the_rules_are_exact_at_their_limits(void **state)
{
    static const struct {
        uint8_t cost, edge, leapt;
    } cases[] = {
        /* state 1 is at the beam's limit and beyond it, its own edge is cheap: passed over, it must be leapt into */
        {LABIAL_BEAM, 3, 0}, {LABIAL_BEAM + 1, 3, 1}, {0, 3, 0},
        /* an edge as dear as a leap, from the dearer of two states */
        {0, 244, 0}, {0, 245, 0}, {0, 246, 1}, {0, 255, 1},
    };
    unsigned i, k;
    (void)state;
    memset(emissions, 0, sizeof emissions);
    model.state_count = 2;
    model.predecessors = 4;
    model.search_stride = 1;
    channel.emissions = emissions;
    channel.edges = edges;
    for (i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        uint32_t from[3], to[3];
        uint8_t back[2];
        const uint32_t edge = 10u + cases[i].edge, leap = 255u;
        emissions[0].initial = 0;
        emissions[1].initial = 10;
        emissions[0].cost = emissions[1].cost = 0;
        for (k = 0; k < 4; k++) {
            edges[k] = 7u << 8;
            edges[4 + k] = (uint16_t)((uint32_t)cases[i].edge << 8 | 4u);
        }
        labial_viterbi_start(&model, &channel, 0, from);
        emissions[1].cost = cases[i].cost;
        labial_viterbi_step(&model, &channel, 0, from, to, back);
        assert_int_equal(to[0], 7u << 8);
        assert_int_equal(back[0], 0);
        if (to[1] != ((cases[i].leapt ? leap : edge) + cases[i].cost) << 8)
            fail_msg("case %u: state 1 at %u", i, to[1] >> 8);
        /* Where a leap and an edge cost the same (case 4), the lower state is where it comes from. */
        assert_int_equal(back[1], cases[i].leapt || edge == leap ? 0 : 4);
    }
}

/* "The lower number at a tie": without it targets could differ. */
static void ties_go_to_the_lower_state(void **state)
{
    uint8_t path[STEPS];
    double score;
    unsigned q, t, n = 0;
    (void)state;
    for (q = 0; q < 5; q++) {
        emissions[q].mean = 0;
        emissions[q].gain = 100;
        emissions[q].cost = emissions[q].initial = 7;
        for (t = 8; t-- > 0;) /* listed from the highest to the lowest */
            edges[n++] = (uint16_t)(9u << 8 | 4 * (t < 5 ? t : 4));
    }
    model.state_count = 5;
    model.predecessors = 8;
    model.search_stride = 1;
    channel.emissions = emissions;
    channel.edges = edges;
    for (t = 0; t < STEPS; t++)
        position[t] = 50;
    search(STEPS, path, &score, NULL);
    for (t = 0; t < STEPS; t++)
        assert_int_equal(path[t], 0);
}

/* A path of every length at every stride: would catch a step too many or too few, frames given to the wrong step, and a
 * path written beyond its length. The steps themselves are those of a stride of one. */
static void every_stride_repeats_its_states(void **state)
{
    static uint32_t scores[2][LABIAL_STATES_MAX + 1];
    static uint8_t back[STEPS * LABIAL_STATES_MAX];
    fixture_random_t random = {13};
    unsigned length, stride, t, changes = 0;
    (void)state;
    for (stride = 1; stride <= LABIAL_SEARCH_STRIDE_MAX; stride++) {
        for (length = 1; length <= LABIAL_WINDOW; length++) {
            const unsigned steps = (length + stride - 1) / stride;
            uint8_t wanted[STEPS], path[LABIAL_WINDOW + 1];
            double score;
            make(&random, 2 + fixture_below(&random, 12), 100, 3000, 3000);
            search(steps, wanted, &score, NULL);
            labial_viterbi_start(&model, &channel, position[0], scores[0]);
            for (t = 1; t < steps; t++)
                labial_viterbi_step(&model, &channel, position[t], scores[(t - 1) % 2], scores[t % 2],
                                    back + (t - 1) * model.state_count);
            model.search_stride = (uint8_t)stride;
            memset(path, 0xee, sizeof path);
            labial_viterbi_path(&model, length, scores[(steps - 1) % 2], back, path);
            for (t = 0; t < length; t++) {
                if (path[t] != wanted[t / stride])
                    fail_msg("%u frames, stride %u: frame %u in state %u, not %u", length, stride, t, path[t],
                             wanted[t / stride]);
                changes += t > 0 && path[t] != path[t - 1];
            }
            assert_int_equal(path[length], 0xee);
        }
    }
    assert_true(changes > 500);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_problems_are_solved_as_by_exhaustive_search),
        cmocka_unit_test(large_problems_are_solved_as_by_doubles),
        cmocka_unit_test(the_rules_are_exact_at_their_limits),
        cmocka_unit_test(ties_go_to_the_lower_state),
        cmocka_unit_test(every_stride_repeats_its_states),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
