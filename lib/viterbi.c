#include "viterbi.h"

#include <stddef.h>

#include "fixed.h"

/* Largest z of an emission, just below 16 in Q6: beyond some 22 standard deviations a state costs no more. It keeps the
 * scores of the longest window within 24 bits. */
#define EMISSION_Z_MAX 1023u

/* Negative log-likelihood of a position in a state. */
static uint32_t emission(const labial_emission_t *state, int32_t position)
{
    const int32_t distance = position - state->mean;
    return labial_z_cost(labial_z((uint32_t)(distance < 0 ? -distance : distance), state->gain, EMISSION_Z_MAX)) + state->cost;
}

void labial_viterbi_start(const labial_channel_t *channel, unsigned states, int32_t position, uint32_t *scores)
{
    unsigned q;
    for (q = 0; q < states; q++) {
        const labial_emission_t *state = &channel->emissions[q];
        scores[q] = (emission(state, position) + state->initial) << 8 | q;
    }
}

void labial_viterbi_step(const labial_channel_t *channel, unsigned states, int32_t position, const uint32_t *from,
                         uint32_t *to, uint8_t *back)
{
    const uint16_t *edge = channel->edges;
    const uint16_t *row = channel->rows;
    unsigned q;
    for (q = 0; q < states; q++) {
        const uint16_t *end = channel->edges + *++row;
        uint32_t best = UINT32_MAX;
        do {
            const uint32_t packed = *edge++;
            const uint32_t score = from[packed & 0xffu] + (packed & 0xff00u);
            if (score < best)
                best = score;
        } while (edge < end);
        back[q] = (uint8_t)best;
        to[q] = (best & ~(uint32_t)0xff) + (emission(&channel->emissions[q], position) << 8) + q;
    }
}

void labial_viterbi_path(unsigned states, unsigned length, const uint32_t *scores, const uint8_t *back, uint8_t *path)
{
    uint32_t best = scores[0];
    unsigned q, t;
    for (q = 1; q < states; q++)
        if (scores[q] < best)
            best = scores[q];
    path[length - 1u] = (uint8_t)best;
    for (t = length - 1u; t > 0; t--)
        path[t - 1u] = back[(size_t)(t - 1u) * states + path[t]];
}
