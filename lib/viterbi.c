/*
 * viterbi.c - targets to states (viterbi.h).
 */
#include "viterbi.h"

#include <string.h>

#include "fixed.h"

/* Largest z of an emission, just below 16 in Q6: beyond some 22 standard deviations a state costs no more. */
#define EMISSION_Z_MAX 1023u

/* States of the window. */
static unsigned searched(const labial_model_t *model)
{
    return model->state_count < LABIAL_SEARCHED ? model->state_count : LABIAL_SEARCHED;
}

/* First state of the window around the one whose mean is nearest to `position`, the lower one at a tie. */
static unsigned first_of_window(const labial_model_t *model, const labial_channel_t *channel, int32_t position)
{
    const labial_emission_t *emissions = channel->emissions;
    const unsigned states = model->state_count, size = searched(model);
    unsigned low = 0, high = states;
    while (low < high) {
        const unsigned middle = (low + high) / 2u;
        if (emissions[middle].mean < position)
            low = middle + 1u;
        else
            high = middle;
    }
    if (low >= states || (low > 0 && position - emissions[low - 1u].mean <= emissions[low].mean - position))
        low--;
    low = low > size / 2u ? low - size / 2u : 0u;
    return low + size < states ? low : states - size;
}

/* Negative log-likelihood of a position in a state. */
static inline uint16_t emission(const labial_emission_t *state, int32_t position)
{
    const int32_t distance = position - state->mean;
    const uint32_t z =
        ((uint32_t)(distance < 0 ? -distance : distance) * (16u + (state->gain & 15u))) >> (state->gain >> 4);
    return (uint16_t)(labial_z_cost(z < EMISSION_Z_MAX ? z : EMISSION_Z_MAX) + state->cost);
}

/* The paths so far move back by a step. */
static void age(labial_search_t *search)
{
#if LABIAL_LAG > 0
    memmove(search->path + 1, search->path, LABIAL_LAG);
    memmove(search->spans + 1, search->spans, LABIAL_LAG);
    memmove(search->back[1], search->back[0], sizeof search->back[0] * (LABIAL_LAG - 1u));
    memmove(search->firsts + 1, search->firsts, LABIAL_LAG - 1u);
#else
    (void)search;
#endif
}

/* Takes up the costs of the window's states, of which `best` is the least: the scores, and the path into that state. */
static void take(labial_search_t *search, unsigned first, unsigned size, const uint16_t *costs, unsigned best)
{
    unsigned i;
    for (i = 0; i < size; i++) {
        const uint32_t above = (uint32_t)costs[i] - costs[best];
        search->scores[i] = (uint8_t)(above < LABIAL_DEAD ? above : LABIAL_DEAD);
    }
    search->first = (uint8_t)first;
    search->best = (uint8_t)best;
    search->path[0] = (uint8_t)(first + best);
#if LABIAL_LAG > 0
    /* Trace back through the steps that are not decided. */
    for (i = 0; i < search->undecided; i++) {
        best = search->back[i][best];
        search->path[i + 1u] = (uint8_t)(search->firsts[i] + best);
    }
#endif
}

/* The least cost of entering state `i` of a window, by its transitions or from the best state; notes where from. */
static inline uint32_t enter(labial_search_t *search, unsigned size, const uint16_t *transition, unsigned predecessors,
                             unsigned i)
{
    const unsigned first = search->first;
    const uint16_t *const end = transition + predecessors;
    uint32_t least = LABIAL_DEAD; /* from the best, whose score is 0 */
#if LABIAL_LAG > 0
    search->back[0][i] = search->best;
#else
    (void)i;
#endif
    do {
        const unsigned predecessor = (*transition & 0xffu) - first;
        if (predecessor < size) {
            const uint32_t score = search->scores[predecessor] + ((uint32_t)*transition >> 8);
            if (score < least) {
                least = score;
#if LABIAL_LAG > 0
                search->back[0][i] = (uint8_t)predecessor;
#endif
            }
        }
        transition++;
    } while (transition < end);
    return least;
}

/* The next step of a path, or its first one. */
static void step(const labial_model_t *model, const labial_channel_t *channel, int32_t position,
                 labial_search_t *search, int is_first)
{
    const unsigned first = first_of_window(model, channel, position), size = searched(model);
    const unsigned predecessors = model->predecessors;
    const labial_emission_t *states = channel->emissions + first;
    const uint16_t *transition = channel->transitions + (size_t)first * predecessors;
    uint16_t costs[LABIAL_SEARCHED];
    unsigned i, best = 0;

    age(search);
#if LABIAL_LAG > 0
    if (is_first)
        search->undecided = 0;
    else if (search->undecided < LABIAL_LAG)
        search->undecided++;
#endif
    if (is_first)
        for (i = 0; i < size; i++)
            costs[i] = channel->initials[first + i];
    else
        for (i = 0; i < size; i++, transition += predecessors)
            costs[i] = (uint16_t)enter(search, size, transition, predecessors, i);
    for (i = 0; i < size; i++) {
        costs[i] = (uint16_t)(costs[i] + emission(&states[i], position));
        if (costs[i] < costs[best])
            best = i;
    }
#if LABIAL_LAG > 0
    search->firsts[0] = search->first;
#endif
    take(search, first, size, costs, best);
}

void labial_viterbi_begin(const labial_model_t *model, const labial_channel_t *channel, int32_t position,
                          labial_search_t *search)
{
    step(model, channel, position, search, 1);
}

void labial_viterbi_step(const labial_model_t *model, const labial_channel_t *channel, int32_t position,
                         labial_search_t *search)
{
    step(model, channel, position, search, 0);
}

void labial_viterbi_end_unit(labial_search_t *search)
{
    memset(search->scores, (int)LABIAL_DEAD, sizeof search->scores);
    search->scores[search->best] = 0;
#if LABIAL_LAG > 0
    search->undecided = 0;
#endif
}
