#include "viterbi.h"

#include <stddef.h>

#include "fixed.h"

/* Largest z of an emission, just below 16 in Q6: beyond some 22 standard deviations a state costs no more. It keeps the
 * scores of the longest window within 24 bits. */
#define EMISSION_Z_MAX 1023u

/* The highest cost of a transition, as a score. */
#define LEAP 0xff00u

/* Negative log-likelihood of a position in a state. */
static inline uint32_t emission(const labial_emission_t *state, int32_t position)
{
    const int32_t distance = position - state->mean;
    const uint32_t z = labial_z((uint32_t)(distance < 0 ? -distance : distance), state->gain, EMISSION_Z_MAX);
    return labial_z_cost(z) + state->cost;
}

void labial_viterbi_start(const labial_model_t *model, const labial_channel_t *channel, int32_t position,
                          uint32_t *scores)
{
    const unsigned states = model->state_count;
    uint32_t best = UINT32_MAX;
    unsigned q;
    for (q = 0; q < states; q++) {
        const labial_emission_t *state = &channel->emissions[q];
        const uint32_t score = (emission(state, position) + state->initial) << 8;
        scores[q] = score;
        if (score + 4u * q < best)
            best = score + 4u * q;
    }
    scores[states] = best;
}

/* Emissions of all states for a position, as scores; returns the least. */
static uint32_t emit(const labial_emission_t *state, unsigned states, int32_t position, uint32_t *scores)
{
    const uint32_t *end = scores + states;
    uint32_t least = UINT32_MAX;
    do {
        const uint32_t cost = emission(state++, position) << 8;
        if (cost < least)
            least = cost;
        *scores++ = cost;
    } while (scores < end);
    return least;
}

/* The better of `best` and of what an edge makes of the last step's score of its predecessor. */
static inline uint32_t better(const uint8_t *scores, const uint16_t *edge, uint32_t best)
{
    const uint32_t score = *edge + *(const uint32_t *)(const void *)(scores + (uint8_t)*edge);
    if (score < best)
        best = score;
    return best;
}

/* The best of `best` and of `count` edges, a multiple of four. */
static uint32_t enter(const uint8_t *scores, const uint16_t *edge, unsigned count, uint32_t best)
{
    const uint16_t *end = edge + count;
    do {
        best = better(scores, edge, best);
        best = better(scores, edge + 1, best);
        best = better(scores, edge + 2, best);
        best = better(scores, edge + 3, best);
        edge += 4;
    } while (edge < end);
    return best;
}

void labial_viterbi_step(const labial_model_t *model, const labial_channel_t *channel, int32_t position,
                         const uint32_t *from, uint32_t *to, uint8_t *back)
{
    const unsigned states = model->state_count, predecessors = model->predecessors;
    const uint16_t *edge = channel->edges;
    const uint32_t limit = emit(channel->emissions, states, position, to) + (LABIAL_BEAM << 8);
    const uint32_t leap = from[states] + LEAP;
    uint32_t winner = UINT32_MAX;
    unsigned q;

    for (q = 0; q < 4u * states; q += 4u, edge += predecessors) {
        const uint32_t cost = *to;
        uint32_t best = leap;
        if (cost <= limit)
            best = enter((const uint8_t *)from, edge, predecessors, leap);
        *back++ = (uint8_t)best;
        best = best - (uint8_t)best + cost;
        *to++ = best;
        if (cost <= limit && best + q < winner)
            winner = best + q;
    }
    *to = winner;
}

void labial_viterbi_path(const labial_model_t *model, unsigned length, const uint32_t *scores, const uint8_t *back,
                         uint8_t *path)
{
    const unsigned states = model->state_count, stride = model->search_stride;
    unsigned q, state = 0, step = (length - 1u) / stride, t = length;
    for (q = 1; q < states; q++)
        if (scores[q] < scores[state])
            state = q;
    for (;;) {
        while (t > step * stride)
            path[--t] = (uint8_t)state;
        if (step == 0)
            return;
        state = back[(size_t)--step * states + state] >> 2;
    }
}
