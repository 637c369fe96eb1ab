/*
 * model.c - checks that a model's tables are as labial/model.h requires.
 */
#include <stddef.h>

#include "channels.h"
#include "fixed.h"
#include "labial/labial.h"

static int is_within(uint32_t value, uint32_t least, uint32_t most)
{
    return value >= least && value <= most;
}

static int is_position(int32_t value)
{
    return value >= -LABIAL_POSITION_MAX && value <= LABIAL_POSITION_MAX;
}

static uint32_t larger(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/* Whether all pointers that the counts require are set. */
static int tables_are_there(const labial_model_t *model)
{
    unsigned k;
    if (!model->phonemes || !model->components || !model->shapes || !model->channels)
        return 0;
    if (model->kernel_taps && !model->kernels)
        return 0;
    if (model->pair_count && (!model->pair_keys || !model->pairs))
        return 0;
    if (model->floor_count && (!model->floors || !model->contacts))
        return 0;
    if (model->sources[LABIAL_FAP_17] == LABIAL_FROM_CORNERS && !model->protrusion)
        return 0;
    for (k = 0; k < model->channel_count && k < LABIAL_CHANNELS; k++)
        if (!model->channels[k].emissions || !model->channels[k].states || !model->channels[k].transitions ||
            !model->channels[k].initials)
            return 0;
    return 1;
}

static int counts_are_sound(const labial_model_t *model)
{
    return is_within(model->frames_per_second, 1, 250) && model->component_count > 0 &&
           is_within(model->phoneme_count, 1, LABIAL_PHONEMES_MAX) &&
           is_within(model->class_count, 1, LABIAL_CLASSES_MAX) &&
           is_within(model->state_count, 1, LABIAL_STATES_MAX) &&
           is_within(model->predecessor_fours, 1, LABIAL_STATES_MAX / 4) &&
           is_within(model->search_stride, 1, LABIAL_SEARCH_STRIDE_MAX) && model->silence < model->phoneme_count &&
           model->mixture_mean <= 1;
}

/* Whether every channel of a frame is one of the model's, or FAP 17 computed of two that are. */
static int sources_are_sound(const labial_model_t *model)
{
    unsigned k;
    if (!is_within(model->channel_count, 1, LABIAL_CHANNELS))
        return 0;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        if (model->sources[k] >= model->channel_count &&
            (k != LABIAL_FAP_17 || model->sources[k] != LABIAL_FROM_CORNERS))
            return 0;
    return 1;
}

static int kernels_are_sound(const labial_model_t *model)
{
    if (model->kernel_taps == 0)
        return model->kernel_behind == 0;
    return model->kernel_taps <= LABIAL_KERNEL_TAPS_MAX && model->kernel_behind < model->kernel_taps &&
           (uint32_t)model->kernel_behind * model->kernel_stride <= LABIAL_REACH &&
           (model->kernel_taps - 1u - model->kernel_behind) * model->kernel_stride <= LABIAL_REACH;
}

static int pairs_are_sound(const labial_model_t *model)
{
    unsigned i;
    for (i = 1; i < model->pair_count; i++)
        if (model->pair_keys[i] <= model->pair_keys[i - 1u])
            return 0;
    return is_within(model->pair_knots, 1, 2);
}

static int floors_are_sound(const labial_model_t *model)
{
    const unsigned width = model->channel_count;
    unsigned i, k;
    for (i = 0; i < model->floor_count; i++) {
        if (model->contacts[i] >> width)
            return 0;
        for (k = 0; k < width; k++) {
            const int16_t floor = model->floors[i * width + k];
            if (floor < LABIAL_NO_FLOOR || floor > LABIAL_POSITION_MAX)
                return 0;
        }
    }
    return model->floor_count == 0 || LABIAL_REACH >= LABIAL_CONTACT_FRAMES;
}

static int phonemes_are_sound(const labial_model_t *model)
{
    unsigned p;
    for (p = 0; p < model->phoneme_count; p++) {
        const labial_phoneme_t *phoneme = &model->phonemes[p];
        if (!is_within(phoneme->component_count, 1, LABIAL_PHONEME_COMPONENTS_MAX) ||
            (uint32_t)phoneme->first_component + phoneme->component_count > model->component_count ||
            phoneme->viseme_class >= model->class_count || phoneme->boundary > 1 || phoneme->floor > model->floor_count)
            return 0;
    }
    return 1;
}

static int emissions_are_sound(const labial_model_t *model, const labial_channel_t *channel)
{
    unsigned q;
    for (q = 0; q < model->state_count; q++)
        if (!is_position(channel->emissions[q].mean) ||
            (q > 0 && channel->emissions[q].mean < channel->emissions[q - 1u].mean))
            return 0;
    return 1;
}

static int transitions_are_sound(const labial_model_t *model, const labial_channel_t *channel)
{
    unsigned i;
    for (i = 0; i < 4u * model->state_count * model->predecessor_fours; i++)
        if (channel->transitions[i].predecessor >= model->state_count)
            return 0;
    return 1;
}

/* weight * |mean|: below 2^26 for weights within the limits; modulo 2^32 for others, whose sum is refused. */
static uint32_t pull(uint32_t weight, int32_t mean)
{
    return weight * (uint32_t)(mean < 0 ? -mean : mean);
}

/* Extreme weights of a channel's states in equation 3, and of their products with the means. */
typedef struct {
    uint32_t least_hold, most_hold, delta, delta2, delta_pull, delta2_pull;
} extremes_t;

/* Whether one state is in range; updates `extremes`. */
static int state_is_sound(const labial_channel_t *channel, const labial_state_t *state, extremes_t *extremes)
{
    const int32_t motion = labial_scaled(state->motion[0], channel->motion_scale[0]),
                  motion2 = labial_scaled(state->motion[1], channel->motion_scale[1]);
    const uint32_t hold = labial_weight(state->hold), delta = labial_weight(state->weight[0]),
                   delta2 = labial_weight(state->weight[1]);
    if (!is_position(state->mean) || !is_position(motion) || !is_position(motion2))
        return 0;
    if (!is_within(hold, LABIAL_WEIGHT_MIN, LABIAL_WEIGHT_SUM_MAX) || delta > delta2 ||
        delta2 > LABIAL_STIFFNESS_MAX * hold)
        return 0;
    extremes->least_hold = hold < extremes->least_hold ? hold : extremes->least_hold;
    extremes->most_hold = larger(extremes->most_hold, hold);
    extremes->delta = larger(extremes->delta, delta);
    extremes->delta2 = larger(extremes->delta2, delta2);
    extremes->delta_pull = larger(extremes->delta_pull, pull(delta, motion));
    extremes->delta2_pull = larger(extremes->delta2_pull, pull(delta2, motion2));
    return 1;
}

/* Whether equation 3 of a channel is within the limits that lib/trajectory.c needs. */
static int states_are_sound(const labial_model_t *model, const labial_channel_t *channel)
{
    extremes_t extremes = { UINT32_MAX, 0, 0, 0, 0, 0 };
    unsigned q;
    extremes.most_hold = labial_weight(channel->contact_weight);
    for (q = 0; q < model->state_count; q++)
        if (!state_is_sound(channel, &channel->states[q], &extremes))
            return 0;
    return extremes.most_hold + 2u * extremes.delta + 6u * extremes.delta2 <= LABIAL_WEIGHT_SUM_MAX &&
           4u * extremes.delta_pull + 4u * extremes.delta2_pull <= LABIAL_PULL_MAX * extremes.least_hold;
}

static int channels_are_sound(const labial_model_t *model)
{
    unsigned k;
    for (k = 0; k < model->channel_count; k++) {
        const labial_channel_t *channel = &model->channels[k];
        if (!is_position(channel->centre) || channel->shape_scale > 32767u || channel->slope_scale > 16383u ||
            !emissions_are_sound(model, channel) || !states_are_sound(model, channel) ||
            !transitions_are_sound(model, channel))
            return 0;
    }
    return 1;
}

int labial_model_check(const labial_model_t *model)
{
    if (!model)
        return LABIAL_ERROR_NULL;
    if (model->format != LABIAL_MODEL_FORMAT)
        return LABIAL_ERROR_VERSION;
    if (!tables_are_there(model))
        return LABIAL_ERROR_NULL;
    return counts_are_sound(model) && sources_are_sound(model) && kernels_are_sound(model) && pairs_are_sound(model) &&
                   floors_are_sound(model) && phonemes_are_sound(model) && channels_are_sound(model)
               ? LABIAL_OK
               : LABIAL_ERROR_MODEL;
}
