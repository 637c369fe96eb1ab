/*
 * oracle_viterbi.c - the search over a whole solution, with costs that are never cut off.
 */
#include "oracle.h"

#include <math.h>
#include <stdlib.h>

/* A transition that is dearer than this, or is not in the table, costs as much: it can be leapt. */
#define LEAP 255.0

double oracle_emission(const labial_emission_t *state, int32_t position)
{
    /* A Gaussian's exponent and log sigma. Costs are whole numbers, rounded down, and end where z does, at 1023 / 64. */
    double z = floor(fabs((double)position - state->mean) * fixture_gain_value(state->gain) / 4096.0);
    z = z < 1023.0 ? z : 1023.0;
    return floor(z * z / 128.0) + state->cost;
}

/* Whether state a is the nearer one: of two that are as near the lower mean is, and of equal means the one that is next
 * to the position in order. */
static int is_nearer(const labial_emission_t *emissions, unsigned a, unsigned b, int32_t position)
{
    const double from_a = fabs((double)position - emissions[a].mean),
                 from_b = fabs((double)position - emissions[b].mean);
    if (from_a != from_b)
        return from_a < from_b;
    if (emissions[a].mean != emissions[b].mean)
        return emissions[a].mean < emissions[b].mean;
    return emissions[a].mean < position ? a > b : a < b;
}

unsigned oracle_window(const labial_model_t *model, const labial_channel_t *channel, int32_t position)
{
    const int states = model->state_count, width = states < LABIAL_SEARCHED ? states : LABIAL_SEARCHED;
    unsigned nearest = 0;
    for (unsigned q = 1; q < model->state_count; q++)
        if (is_nearer(channel->emissions, q, nearest, position))
            nearest = q;
    const int first = (int)nearest - width / 2;
    return (unsigned)(first < 0 ? 0 : first > states - width ? states - width : first);
}

/* Cost of the way from state p of a step into state q, ORACLE_NONE when there is none. */
static double through(const labial_model_t *model, const labial_channel_t *channel, const oracle_step_t *before,
                      unsigned p, unsigned q)
{
    double cost = LEAP;
    if (before->cost[p] >= ORACLE_NONE || (before->ends_unit && p != before->best))
        return ORACLE_NONE;
    for (unsigned i = 0; i < 4u * model->predecessor_fours; i++) {
        const labial_transition_t *const transition = &channel->transitions[q * 4u * model->predecessor_fours + i];
        if (transition->predecessor == p && transition->cost < cost)
            cost = transition->cost;
    }
    return before->cost[p] + cost;
}

void oracle_step(const labial_model_t *model, const labial_channel_t *channel, int32_t position,
                 const oracle_step_t *before, oracle_step_t *step)
{
    step->first = oracle_window(model, channel, position);
    step->ends_unit = 0;
    step->best = step->first;
    for (unsigned q = 0; q < model->state_count; q++) {
        step->cost[q] = ORACLE_NONE;
        if (q < step->first || q >= step->first + LABIAL_SEARCHED)
            continue;
        if (!before) {
            step->cost[q] = channel->initials[q];
        } else { /* of ways that cost the same a leap from the best is taken, or that from the lower state */
            step->cost[q] = before->cost[before->best] + LEAP;
            step->from[q] = before->best;
            for (unsigned p = 0; p < model->state_count; p++) {
                const double cost = through(model, channel, before, p, q);
                if (cost < step->cost[q]) {
                    step->cost[q] = cost;
                    step->from[q] = p;
                }
            }
        }
        step->cost[q] += oracle_emission(&channel->emissions[q], position);
        if (step->cost[q] < step->cost[step->best])
            step->best = q;
    }
}

unsigned oracle_traced(const oracle_step_t *steps, size_t from, size_t at)
{
    unsigned state = steps[from].best;
    for (; from > at; from--)
        state = steps[from].from[state];
    return state;
}

/* Whether a channel has its turn with a frame of a stream. */
static int is_turn(const labial_model_t *model, unsigned channel, size_t frame)
{
    return frame % model->search_stride == channel % model->search_stride;
}

void oracle_search(const labial_model_t *model, unsigned channel, const oracle_frame_t *frames,
                   const int16_t (*targets)[LABIAL_CHANNELS], size_t first, size_t count, uint8_t *path)
{
    const size_t stride = model->search_stride;
    oracle_step_t *steps = (oracle_step_t *)malloc(count * sizeof *steps);
    size_t *block = (size_t *)malloc(count * sizeof *block); /* of each frame */
    size_t begin = 0, blocks = 0;
    if (!steps || !block)
        abort();
    for (size_t t = 0; t < count; t++) {
        block[t] = blocks;
        if (is_turn(model, channel, first + t) || t + 1 == count) {
            size_t turn = first + t; /* of the whole block */
            while (!is_turn(model, channel, turn))
                turn++;
            size_t seen =
                turn + 1 + stride / 2 < first + begin + stride ? begin : turn + 1 + stride / 2 - stride - first;
            seen = seen > t ? t : seen;
            oracle_step(model, &model->channels[channel], targets[seen][channel], blocks ? &steps[blocks - 1] : NULL,
                        &steps[blocks]);
            for (size_t i = begin; i <= t; i++)
                steps[blocks].ends_unit |= frames[i].unit_ends;
            blocks++;
            begin = t + 1;
        }
    }
    for (size_t t = 0; t < count; t++) {
        size_t end = block[t], known = t + LABIAL_LAG;
        while (known < count && !is_turn(model, channel, first + known))
            known++;
        known = known < count ? block[known] : blocks - 1;
        while (end < known && !steps[end].ends_unit)
            end++;
        path[t] = (uint8_t)oracle_traced(steps, end, block[t]);
    }
    free(steps);
    free(block);
}
