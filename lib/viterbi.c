/*
 * viterbi.c - targets to states (viterbi.h).
 */
#include "viterbi.h"

#include <string.h>

/* States of the window. */
static unsigned searched(const labial_model_t *model)
{
    return model->state_count < LABIAL_SEARCHED ? model->state_count : LABIAL_SEARCHED;
}

/* First state of the window around the one whose mean is nearest to `position`, the lower one at a tie. */
static unsigned first_of_window(const labial_model_t *model, const labial_channel_t *channel, int32_t position)
{
    const labial_emission_t *emissions = channel->emissions;
    const unsigned states = model->state_count, last = states > LABIAL_SEARCHED ? states - LABIAL_SEARCHED : 0u;
    unsigned low = 0, high = states - 1u;
    while (low < high) { /* the next state is nearer where their middle lies below the position */
        const unsigned middle = (low + high) / 2u;
        if (emissions[middle].mean + emissions[middle + 1u].mean < 2 * position)
            low = middle + 1u;
        else
            high = middle;
    }
    low = low > LABIAL_SEARCHED / 2u ? low - LABIAL_SEARCHED / 2u : 0u;
    return low < last ? low : last;
}

/* Ages the stored paths by a step, or drops them. */
static void age(labial_search_t *search, int is_first)
{
#if LABIAL_LAG > 0
    memmove(search->path + 1, search->path, LABIAL_LAG);
    memmove(search->spans + 1, search->spans, LABIAL_LAG);
    memmove(search->back[1], search->back[0], sizeof search->back[0] * (LABIAL_LAG - 1u));
    memmove(search->firsts + 1, search->firsts, LABIAL_LAG - 1u);
    search->firsts[0] = search->first;
    search->undecided = (uint8_t)(is_first ? 0 : search->undecided + (search->undecided < LABIAL_LAG));
#else
    (void)search;
    (void)is_first;
#endif
}

/* The least of a cost and of that of entering a state by a transition from a window of `count` states from `first` on;
 * stores the predecessor in `back`, which is null without a lag. */
static inline uint32_t cross(const labial_transition_t *transition, const uint8_t *scores, unsigned first,
                             unsigned count, uint8_t *back, uint32_t least)
{
    const unsigned predecessor = transition->predecessor - first;
    if (predecessor < count) {
        const uint32_t score = (uint32_t)scores[predecessor] + transition->cost;
        if (score < least) {
#if LABIAL_LAG > 0
            *back = (uint8_t)predecessor;
#else
            (void)back;
#endif
            return score;
        }
    }
    return least;
}

void labial_viterbi_enter(labial_search_t *search, const labial_transition_t *transition, unsigned fours, unsigned size,
                          uint32_t *costs)
{
    const unsigned first = search->first, count = search->count;
    const uint8_t *const scores = search->scores;
    uint8_t *back = NULL;
    unsigned i;
    for (i = 0; i < size; i++) {
        uint32_t least = LABIAL_DEAD; /* from the best, whose score is 0 */
        unsigned left = fours;
#if LABIAL_LAG > 0
        back = &search->back[0][i];
        *back = search->best;
#endif
        do {
            least = cross(transition, scores, first, count, back, least);
            least = cross(transition + 1, scores, first, count, back, least);
            least = cross(transition + 2, scores, first, count, back, least);
            least = cross(transition + 3, scores, first, count, back, least);
            transition += 4;
        } while (--left > 0);
        costs[i] = least;
    }
}

/* Finds the states of the undecided steps from state `best` of the latest; at the end of a unit they are decided. */
static void trace(labial_search_t *search, unsigned best, int ends_unit)
{
#if LABIAL_LAG > 0
    unsigned i;
    for (i = 0; i < search->undecided; i++) {
        best = search->back[i][best];
        search->path[i + 1u] = (uint8_t)(search->firsts[i] + best);
    }
    if (ends_unit)
        search->undecided = 0;
#else
    (void)search;
    (void)best;
    (void)ends_unit;
#endif
}

void labial_viterbi_step(const labial_model_t *model, const labial_channel_t *channel, int32_t position, unsigned marks,
                         labial_search_t *search)
{
    unsigned first = first_of_window(model, channel, position), size = searched(model), best, i;
    const unsigned into = 4u * model->predecessor_fours; /* each state */
    const labial_emission_t *state = channel->emissions + first;
    const labial_transition_t *transition = channel->transitions + (size_t)first * into;
    uint32_t costs[LABIAL_SEARCHED], *cost, *least = costs;
    const uint32_t *const end = costs + size;

    age(search, (int)(marks & LABIAL_BEGINS));
    if (marks & LABIAL_BEGINS)
        for (i = 0; i < size; i++)
            costs[i] = channel->initials[first + i];
    else
        labial_viterbi_enter(search, transition, model->predecessor_fours, size, costs);
    for (cost = costs; cost < end; cost++, state++) {
        *cost += labial_viterbi_emission(state, position);
        if (*cost < *least)
            least = cost;
    }
    best = (unsigned)(least - costs);
    search->path[0] = (uint8_t)(first + best);
    trace(search, best, (int)(marks & LABIAL_UNIT_ENDS));
    if (marks & LABIAL_UNIT_ENDS) { /* the next step sees the best state alone */
        first += best;
        size = 1;
        best = 0;
        costs[0] = *least;
        least = costs;
    }
    search->first = (uint8_t)first;
    search->count = (uint8_t)size;
#if LABIAL_LAG > 0
    search->best = (uint8_t)best;
#endif
    for (i = 0; i < size; i++) {
        const uint32_t above = costs[i] - *least;
        search->scores[i] = (uint8_t)(above < LABIAL_DEAD ? above : LABIAL_DEAD);
    }
}
