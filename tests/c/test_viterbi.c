/*
 * test_viterbi.c - the search for the likeliest state path, against the dense programme of oracle_steps.c. Costs are those
 * of labial/model.h.
 */
#include "suite.h"
#include "oracle.h"
#include "viterbi.h"

#define STEPS 120

static labial_model_t model;
static labial_emission_t emissions[LABIAL_STATES_MAX];
static labial_transition_t transitions[LABIAL_STATES_MAX * LABIAL_STATES_MAX];
static uint8_t initials[LABIAL_STATES_MAX];
static labial_channel_t channel;
static int32_t position[STEPS];
static oracle_step_t steps[STEPS];

/* A random channel of `states` states in order, each with `density` in 256 of the possible predecessors and one at
 * least. The spread of positions and the gains decide how many states are dead. */
static void make(fixture_random_t *random, unsigned states, uint32_t density, uint32_t spread, uint32_t gains)
{
    labial_transition_t lists[LABIAL_STATES_MAX][LABIAL_STATES_MAX];
    unsigned counts[LABIAL_STATES_MAX], most = 0, p;
    for (unsigned q = 0; q < states; q++) {
        const int16_t mean = (int16_t)((int)fixture_below(random, 2 * spread + 1) - (int)spread);
        unsigned n = 0;
        for (p = q; p > 0 && emissions[p - 1].mean > mean; p--)
            emissions[p].mean = emissions[p - 1].mean;
        emissions[p].mean = mean;
        emissions[q].gain = fixture_gain_code(262144.0 / ((gains / 20 + fixture_below(random, gains)) * 1.41421356237));
        emissions[q].cost = (uint8_t)(fixture_below(random, 256) >> fixture_below(random, 3));
        initials[q] = (uint8_t)fixture_below(random, 256);
        for (p = 0; p < states; p++)
            if (p == (q + 1) % states || fixture_below(random, 256) < density)
                lists[q][n++] = (labial_transition_t){ (uint8_t)p, (uint8_t)(fixture_below(random, 256) >>
                                                                             fixture_below(random, 6)) };
        counts[q] = n;
        most = n > most ? n : most;
    }
    most = (most + 3u) / 4u * 4u;
    for (unsigned q = 0; q < states; q++)
        for (p = 0; p < most; p++)
            transitions[q * most + p] = lists[q][p < counts[q] ? p : counts[q] - 1];
    model.state_count = (uint8_t)states;
    model.predecessor_fours = (uint8_t)(most / 4u);
    channel.emissions = emissions;
    channel.transitions = transitions;
    channel.initials = initials;
    for (unsigned q = 0; q < STEPS; q++) {
        position[q] = (int32_t)fixture_below(random, 2 * spread + 1) - (int32_t)spread;
        if (q > 0 && fixture_below(random, 3)) /* mostly near the one before, as speech is */
            position[q] = position[q - 1] + ((int32_t)fixture_below(random, spread / 4 + 1) - (int32_t)spread / 8);
        position[q] = position[q] > LABIAL_POSITION_MAX ? LABIAL_POSITION_MAX : position[q];
        position[q] = position[q] < -LABIAL_POSITION_MAX ? -LABIAL_POSITION_MAX : position[q];
    }
}

static unsigned width(void)
{
    return model.state_count < LABIAL_SEARCHED ? model.state_count : LABIAL_SEARCHED;
}

/* Takes step t with the library and the oracle; the latter's path begins with step `begin`. */
static void take_step(labial_search_t *search, unsigned t, unsigned begin, unsigned span, int ends_unit)
{
    const unsigned begins = t == begin ? (unsigned)LABIAL_BEGINS : 0u;
    const unsigned ends = ends_unit ? (unsigned)LABIAL_UNIT_ENDS : 0u;
    labial_viterbi_step(&model, &channel, position[t], begins | ends, search);
    labial_viterbi_span(search, span);
    oracle_step(&model, &channel, position[t], t == begin ? NULL : &steps[t - 1], &steps[t]);
    steps[t].ends_unit = ends_unit;
}

/* The library's scores must be these costs, less the least of them; where a unit ends the best state alone has one. */
static void check_scores(const labial_search_t *search, const double *cost, int ends_unit)
{
    double least = ORACLE_NONE;
    for (unsigned q = 0; q < model.state_count; q++)
        least = cost[q] < least ? cost[q] : least;
    assert_int_equal(search->count, ends_unit ? 1 : width());
    for (unsigned i = 0; i < search->count; i++) {
        const double above = cost[search->first + i] - least;
        assert_near(search->scores[i], above < 255.0 ? above : 255.0, 0);
    }
}

/* What the library says of all frames that it may be asked for. `spans` are the frames of each step and `begins` the
 * first step of its solution; the oracle traces back from the last step, or from the end of the unit. */
static unsigned check_path(const labial_search_t *search, unsigned last, unsigned begin, const unsigned *spans)
{
    unsigned step = last, left = spans[last], changed = 0;
    for (unsigned age = 0; age + 1 < spans[last] + LABIAL_LAG + 1; age++, left--) {
        unsigned end;
        while (left == 0) {
            if (step == begin)
                return changed;
            left = spans[--step];
        }
        for (end = step; end < last && !steps[end].ends_unit;)
            end++;
        const unsigned wanted = oracle_traced(steps, end, step);
        changed += wanted != steps[step].best;
        if (labial_viterbi_state(search, age) != wanted)
            fail_msg("step %u, %u frames back, step %u: state %u, not %u", last, age, step,
                     labial_viterbi_state(search, age), wanted);
    }
    return changed;
}

/* Long runs over all sizes of models, with units and solutions that end at random: would catch a transition taken the other
 * way round or into a wrong state, a leap from any but the best state or at another cost, a score cut off too early, an
 * initial cost that is forgotten, a back-pointer or a window
 * of the wrong step, a unit's end that loses the path or lets another state live, steps of several frames taken for
 * single ones, a path that forgets what was decided in the solution before. */
TEST(paths_are_those_of_the_dense_programme)
{
    fixture_random_t random = { 12 };
    unsigned changed = 0, leaps = 0, units = 0;
    for (unsigned round = 0; round < FIXTURE_ROUNDS(400); round++) {
        unsigned spans[STEPS], begin = 0;
        labial_search_t search;
        make(&random, 1 + fixture_below(&random, LABIAL_STATES_MAX), round % 3 ? 30 : 256,
             round % 2 ? LABIAL_POSITION_MAX : 4000, round % 4 < 2 ? 3000 : 100);
        memset(&search, 0x5a, sizeof search);
        for (unsigned t = 0; t < STEPS; t++) {
            spans[t] = 1 + fixture_below(&random, LABIAL_SEARCH_STRIDE_MAX);
            take_step(&search, t, begin, spans[t], fixture_below(&random, 10) == 0);
            check_scores(&search, steps[t].cost, steps[t].ends_unit);
            assert_int_equal(search.first, steps[t].ends_unit ? steps[t].best : steps[t].first);
            leaps += t > begin && steps[t].from[steps[t].best] == steps[t - 1].best &&
                     steps[t].cost[steps[t].best] - steps[t - 1].cost[steps[t - 1].best] >= 255.0;
            units += (unsigned)steps[t].ends_unit;
            changed += check_path(&search, t, begin, spans);
            if (steps[t].ends_unit && fixture_below(&random, 3) == 0)
                begin = t + 1;
        }
    }
    assert_true(leaps > 100 && units > 100);
#if LABIAL_LAG > 0
    assert_true(changed > 1000); /* the lag made a difference */
#else
    assert_int_equal(changed, 0);
#endif
}

SUITE(NULL, NULL)
