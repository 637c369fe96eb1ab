#include "shape.h"

#include <stddef.h>

#include "fixed.h"

#define ONE 4096 /* a component's share of the mixture, Q12 */

/* Largest z of a duration: over a thousand standard deviations, so that the widest component takes an endless pause. */
#define DURATION_Z_MAX 65535u

/* Durations farther than three standard deviations from a component's mean change its shape no more: 3 / sqrt 2, Q6. */
#define SLOPE_Z_MAX 136

/* exp(-i / 2) and exp(-i / 32), Q15: a cost difference of 16 h + l has likelihood coarse[h] * fine[l]. */
static const uint16_t coarse[16] = { 32768, 19875, 12055, 7312, 4435, 2690, 1631, 990,
                                     600,   364,   221,   134,  81,   49,   30,   18 };
static const uint16_t fine[16] = { 32768, 31760, 30783, 29836, 28918, 28028, 27166, 26330,
                                   25520, 24735, 23974, 23236, 22521, 21828, 21157, 20506 };

static uint32_t likelihood(uint32_t cost)
{
    if (cost > 255u)
        return 0;
    return ((uint32_t)coarse[cost >> 4] * fine[cost & 15u]) >> 15;
}

/* Costs and signed, limited z of a phoneme's components; returns the best one's index within the phoneme. */
static unsigned score(const labial_model_t *model, const labial_phoneme_t *phoneme, uint16_t ms,
                      unsigned previous_class, unsigned next_class, uint32_t *costs, int16_t *deviations)
{
    const unsigned classes = model->class_count;
    unsigned c, best = 0;
    for (c = 0; c < phoneme->component_count; c++) {
        const unsigned index = phoneme->first_component + c;
        const labial_component_t *component = &model->components[index];
        const int32_t distance = (int32_t)ms - component->duration_mean;
        const uint32_t z = labial_z((uint32_t)(distance < 0 ? -distance : distance), component->duration_gain,
                                    DURATION_Z_MAX);
        const int32_t reach = z < SLOPE_Z_MAX ? (int32_t)z : SLOPE_Z_MAX;
        uint32_t cost = component->cost + labial_z_cost(z);
        if (model->contexts) {
            const uint8_t *context = model->contexts + (size_t)index * 2u * classes;
            cost += (uint32_t)context[previous_class] + context[classes + next_class];
        }
        costs[c] = cost;
        deviations[c] = (int16_t)(distance < 0 ? -reach : reach);
        if (cost < costs[best])
            best = c;
    }
    return best;
}

/* The shape of a phoneme between neighbours of the given viseme classes. */
static void mix(const labial_model_t *model, const labial_phoneme_t *phoneme, uint16_t ms, unsigned previous_class,
                unsigned next_class, int16_t shape[LABIAL_CHANNELS])
{
    const unsigned count = phoneme->component_count;
    uint32_t shares[LABIAL_PHONEME_COMPONENTS_MAX] = { 0 }; /* first costs, then the mixture's weights, Q12 */
    int16_t deviations[LABIAL_PHONEME_COMPONENTS_MAX];      /* first z, Q6, held to SLOPE_Z_MAX, then share * z, Q12 */
    const unsigned best = score(model, phoneme, ms, previous_class, next_class, shares, deviations);
    unsigned c, k;

    if (model->soft) {
        const uint32_t least = shares[best];
        uint32_t sum = 0, rest = ONE;
        for (c = 0; c < count; c++) {
            shares[c] = likelihood(shares[c] - least);
            sum += shares[c];
        }
        for (c = 0; c < count; c++) {
            shares[c] = shares[c] * ONE / sum;
            rest -= shares[c];
        }
        shares[best] += rest;
    } else {
        for (c = 0; c < count; c++)
            shares[c] = c == best ? ONE : 0;
    }
    for (c = 0; c < count; c++)
        deviations[c] = (int16_t)(((int32_t)shares[c] * deviations[c]) >> 6);

    for (k = 0; k < LABIAL_CHANNELS; k++) {
        const labial_channel_t *channel = &model->channels[k];
        const size_t first = (size_t)phoneme->first_component * LABIAL_CHANNELS + k;
        int32_t mean = 0, change = 0; /* in table steps, Q12 */
        for (c = 0; c < count; c++) {
            mean += (int32_t)shares[c] * model->shapes[first + c * LABIAL_CHANNELS];
            if (model->slopes)
                change += deviations[c] * model->slopes[first + c * LABIAL_CHANNELS];
        }
        mean = ((mean >> 4) * channel->shape_scale + 32768) >> 16;
        change = ((change >> 4) * channel->slope_scale + 32768) >> 16;
        shape[k] = (int16_t)labial_clamp(mean + change, LABIAL_POSITION_MAX);
    }
}

/* Steps of a scale as positions. */
static int32_t scaled(int32_t steps, uint16_t scale)
{
    return (steps * (int32_t)scale + 128) >> 8;
}

/* Adds what a neighbour adds to the shape of a phoneme; nothing for pairs that the model does not know. `key` is theirs
 * in `pair_keys`. */
static void add_pair(const labial_model_t *model, unsigned key, int16_t shape[LABIAL_CHANNELS])
{
    unsigned low = 0, high = model->pair_count, k;
    while (low < high) {
        const unsigned middle = low + (high - low) / 2u;
        if (model->pair_keys[middle] < key)
            low = middle + 1u;
        else
            high = middle;
    }
    if (low == model->pair_count || model->pair_keys[low] != key)
        return;
    for (k = 0; k < LABIAL_CHANNELS; k++) {
        const int32_t added = scaled(model->pairs[(size_t)low * LABIAL_CHANNELS + k], model->channels[k].pair_scale);
        shape[k] = (int16_t)labial_clamp(shape[k] + added, LABIAL_POSITION_MAX);
    }
}

void labial_shape_select(const labial_model_t *model, unsigned phoneme, uint16_t ms, unsigned previous, unsigned next,
                         int16_t shape[LABIAL_CHANNELS])
{
    const labial_phoneme_t *phonemes = model->phonemes;
    mix(model, &phonemes[phoneme], ms, phonemes[previous].viseme_class, phonemes[next].viseme_class, shape);
    add_pair(model, phoneme << 8 | previous, shape);
    add_pair(model, phoneme << 8 | 128u | next, shape);
}

void labial_shape_target(const labial_model_t *model, const int16_t shape[LABIAL_CHANNELS], const uint8_t *labels,
                         int16_t target[LABIAL_CHANNELS])
{
    const int8_t *rows[LABIAL_KERNEL_TAPS_MAX]; /* what each tap's phoneme adds */
    const unsigned taps = model->kernel_taps, floor = model->phonemes[*labels].floor;
    const int16_t *least = floor ? model->floors + (floor - 1u) * LABIAL_CHANNELS : NULL;
    int lag = -(int)(model->kernel_behind * model->kernel_stride); /* an index, as no pointer may pass the array's end */
    unsigned k, tap;
    for (tap = 0; tap < taps; tap++, lag += model->kernel_stride)
        rows[tap] = model->kernels + ((size_t)labels[lag] * taps + tap) * LABIAL_CHANNELS;
    for (k = 0; k < LABIAL_CHANNELS; k++) {
        int32_t sum = 0;
        const int8_t *const *row = rows;
        for (tap = taps; tap > 0; tap--)
            sum += (*row++)[k];
        sum = labial_clamp(shape[k] + scaled(sum, model->channels[k].kernel_scale), LABIAL_POSITION_MAX);
        target[k] = (int16_t)(least && sum < least[k] ? least[k] : sum);
    }
}
