#include <stddef.h>

#include "fixed.h"
#include "labial/labial.h"

static int phonemes_are_sound(const labial_model_t *model)
{
    unsigned p;
    for (p = 0; p < model->phoneme_count; p++) {
        const labial_phoneme_t *phoneme = &model->phonemes[p];
        if (phoneme->component_count == 0 || phoneme->component_count > LABIAL_PHONEME_COMPONENTS_MAX ||
            (uint32_t)phoneme->first_component + phoneme->component_count > model->component_count ||
            phoneme->viseme_class >= model->class_count || phoneme->boundary > 1 ||
            phoneme->floor > model->floor_count)
            return 0;
    }
    return 1;
}

static int is_position(int32_t value)
{
    return value >= -LABIAL_POSITION_MAX && value <= LABIAL_POSITION_MAX;
}

static uint32_t larger(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

static uint32_t smaller(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* weight * |mean|, below 2^33 / 4 with any weight within the limits. */
static uint32_t pull(uint32_t weight, int32_t mean)
{
    return weight * (uint32_t)(mean < 0 ? -mean : mean);
}

/* States are in order and in range, and equation 3 is within the limits that lib/trajectory.c needs. */
static int states_are_sound(const labial_model_t *model, const labial_channel_t *channel)
{
    uint32_t least = UINT32_MAX, most = labial_weight(channel->firm), delta = 0, delta2 = 0, delta_pull = 0, delta2_pull = 0;
    unsigned q, i;
    for (q = 0; q < model->state_count; q++) {
        const labial_state_t *state = &channel->states[q];
        const uint32_t hold = labial_weight(state->hold), d = labial_weight(state->weight[0]),
                       dd = labial_weight(state->weight[1]);
        if (!is_position(channel->emissions[q].mean) ||
            (q > 0 && channel->emissions[q].mean < channel->emissions[q - 1u].mean))
            return 0;
        for (i = 0; i < 3; i++)
            if (!is_position(state->mean[i]))
                return 0;
        if (hold < LABIAL_WEIGHT_MIN || hold > LABIAL_WEIGHT_SUM_MAX || d > dd || dd > LABIAL_STIFFNESS_MAX * hold ||
            dd > LABIAL_WEIGHT_SUM_MAX / 6)
            return 0;
        least = smaller(least, hold);
        most = larger(most, hold);
        delta = larger(delta, d);
        delta2 = larger(delta2, dd);
        delta_pull = larger(delta_pull, pull(d, state->mean[1]));
        delta2_pull = larger(delta2_pull, pull(dd, state->mean[2]));
    }
    return most + 2u * delta + 6u * delta2 <= LABIAL_WEIGHT_SUM_MAX &&
           4u * delta_pull + 4u * delta2_pull <= LABIAL_PULL_MAX * least;
}

static int transitions_are_sound(const labial_model_t *model, const labial_channel_t *channel)
{
    unsigned i;
    for (i = 0; i < (unsigned)model->state_count * model->predecessors; i++)
        if ((channel->edges[i] & 0xffu) >= model->state_count)
            return 0;
    return 1;
}

static int channel_is_sound(const labial_model_t *model, unsigned k)
{
    const labial_channel_t *channel = &model->channels[k];
    if (!is_position(channel->centre) || channel->shape_scale > 32767u || channel->slope_scale > 16383u)
        return 0;
    return states_are_sound(model, channel) && transitions_are_sound(model, channel);
}

int labial_model_check(const labial_model_t *model)
{
    unsigned k;
    size_t i;
    if (!model)
        return LABIAL_ERROR_NULL;
    if (model->format != LABIAL_MODEL_FORMAT)
        return LABIAL_ERROR_VERSION;
    if (!model->phonemes || !model->components || !model->shapes || !model->channels ||
        (model->kernel_taps && !model->kernels) || (model->floor_count && (!model->floors || !model->contacts)) ||
        (model->pair_count && (!model->pair_keys || !model->pairs)))
        return LABIAL_ERROR_NULL;
    if (model->frames_per_second == 0 || model->frames_per_second > 250u || model->component_count == 0 ||
        model->phoneme_count == 0 || model->phoneme_count > LABIAL_PHONEMES_MAX || model->class_count == 0 ||
        model->class_count > LABIAL_CLASSES_MAX || model->state_count == 0 ||
        model->state_count > LABIAL_STATES_MAX || model->predecessors == 0 ||
        model->predecessors > LABIAL_STATES_MAX || model->search_stride == 0 ||
        model->search_stride > LABIAL_SEARCH_STRIDE_MAX || model->silence >= model->phoneme_count || model->soft > 1)
        return LABIAL_ERROR_MODEL;
    if (model->kernel_taps) {
        if (model->kernel_taps > LABIAL_KERNEL_TAPS_MAX || model->kernel_behind >= model->kernel_taps ||
            (uint32_t)model->kernel_behind * model->kernel_stride > LABIAL_REACH ||
            (model->kernel_taps - 1u - model->kernel_behind) * model->kernel_stride > LABIAL_REACH)
            return LABIAL_ERROR_MODEL;
    } else if (model->kernel_behind) {
        return LABIAL_ERROR_MODEL;
    }
    for (k = 0; k < LABIAL_CHANNELS; k++) {
        const labial_channel_t *channel = &model->channels[k];
        if (!channel->emissions || !channel->states || !channel->edges)
            return LABIAL_ERROR_NULL;
    }
    for (i = 1; i < model->pair_count; i++)
        if (model->pair_keys[i] <= model->pair_keys[i - 1u])
            return LABIAL_ERROR_MODEL;
    if (model->pair_knots < 1u || model->pair_knots > 2u || (model->floor_count && LABIAL_REACH < LABIAL_CONTACT_FRAMES))
        return LABIAL_ERROR_MODEL;
    for (i = 0; i < model->floor_count; i++)
        if (model->contacts[i] >> LABIAL_CHANNELS)
            return LABIAL_ERROR_MODEL;
    for (i = 0; i < (size_t)model->floor_count * LABIAL_CHANNELS; i++)
        if (model->floors[i] > LABIAL_POSITION_MAX || model->floors[i] < LABIAL_NO_FLOOR)
            return LABIAL_ERROR_MODEL;
    if (!phonemes_are_sound(model))
        return LABIAL_ERROR_MODEL;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        if (!channel_is_sound(model, k))
            return LABIAL_ERROR_MODEL;
    return LABIAL_OK;
}
