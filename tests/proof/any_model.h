/*
 * any_model.h - any model that labial_model_check() accepts, as far as values of single members say it. Its tables are as
 * long as the largest counts ask for.
 */
#ifndef ANY_MODEL_H
#define ANY_MODEL_H

#include "labial/labial.h"
#include "prove.h"

#define COMPONENTS 65535
#define PAIRS 65535
#define FLOORS 255

static labial_phoneme_t phonemes[LABIAL_PHONEMES_MAX];
static labial_component_t components[COMPONENTS];
static uint8_t contexts[COMPONENTS * LABIAL_CLASSES_MAX];
static int8_t shapes[COMPONENTS * LABIAL_CHANNELS], slopes[COMPONENTS * LABIAL_CHANNELS];
static uint32_t kernels[LABIAL_PHONEMES_MAX * LABIAL_KERNEL_TAPS_MAX * 3];
static int8_t last_kernels[LABIAL_PHONEMES_MAX * LABIAL_KERNEL_TAPS_MAX];
static uint16_t pair_keys[PAIRS];
static int8_t pairs[PAIRS * 2 * LABIAL_CHANNELS];
static int16_t floors[FLOORS * LABIAL_CHANNELS];
static uint16_t contacts[FLOORS];
static labial_emission_t emissions[LABIAL_STATES_MAX];
static labial_state_t states[LABIAL_STATES_MAX];
static uint16_t transitions[LABIAL_STATES_MAX * LABIAL_STATES_MAX];
static uint8_t initials[LABIAL_STATES_MAX];
static labial_channel_t channels[LABIAL_CHANNELS];

static int16_t any_position(void)
{
    return (int16_t)Frama_C_interval(-LABIAL_POSITION_MAX, LABIAL_POSITION_MAX);
}

/* Weights of codes beyond 0xaf are above LABIAL_WEIGHT_SUM_MAX, so is six times one beyond 0x85. */
static void any_states(void)
{
    unsigned i;
    FILL(emissions);
    FILL(states);
    FILL(transitions);
    FILL(initials);
    /*@ loop unroll 64; */
    for (i = 0; i < LABIAL_STATES_MAX; i++) {
        emissions[i].mean = any_position();
        states[i].mean = any_position();
        states[i].hold = (uint8_t)Frama_C_interval(8, 0xaf);
        states[i].weight[0] = (uint8_t)Frama_C_interval(0, 0x85);
        states[i].weight[1] = (uint8_t)Frama_C_interval(0, 0x85);
    }
}

static void any_channel(labial_channel_t *channel)
{
    channel->centre = any_position();
    channel->shape_scale = (uint16_t)Frama_C_interval(0, 32767);
    channel->slope_scale = (uint16_t)Frama_C_interval(0, 16383);
    channel->kernel_scale = any_uint16;
    channel->pair_scale = any_uint16;
    channel->motion_scale[0] = any_uint16;
    channel->motion_scale[1] = any_uint16;
    channel->contact_weight = (uint8_t)Frama_C_interval(0, 0xaf);
    channel->emissions = emissions;
    channel->states = states;
    channel->transitions = transitions;
    channel->initials = initials;
}

/* `count` is that of each phoneme's components: of one step, which looks at one phoneme. */
static void any_phonemes(int count)
{
    unsigned i;
    /*@ loop unroll 128; */
    for (i = 0; i < LABIAL_PHONEMES_MAX; i++) {
        phonemes[i].first_component = (uint16_t)Frama_C_interval(0, COMPONENTS - count);
        phonemes[i].component_count = (uint8_t)count;
        phonemes[i].viseme_class = (uint8_t)Frama_C_interval(0, LABIAL_CLASSES_MAX - 1);
        phonemes[i].boundary = (uint8_t)Frama_C_interval(0, 1);
        phonemes[i].floor = any_uint8;
    }
}

static void any_model(labial_model_t *model, int count)
{
    unsigned i;
    any_phonemes(count);
    any_states();
    FILL(components);
    FILL(contexts);
    FILL(shapes);
    FILL(slopes);
    FILL(kernels);
    FILL(last_kernels);
    FILL(pair_keys);
    FILL(pairs);
    FILL(floors);
    FILL(contacts);
    /*@ loop unroll 13; */
    for (i = 0; i < LABIAL_CHANNELS; i++)
        any_channel(&channels[i]);
    model->format = LABIAL_MODEL_FORMAT;
    model->frames_per_second = (uint16_t)Frama_C_interval(1, 250);
    model->component_count = (uint16_t)Frama_C_interval(1, COMPONENTS);
    model->phoneme_count = (uint8_t)Frama_C_interval(1, LABIAL_PHONEMES_MAX);
    model->class_count = (uint8_t)Frama_C_interval(1, LABIAL_CLASSES_MAX);
    model->state_count = (uint8_t)Frama_C_interval(1, LABIAL_STATES_MAX);
    model->predecessors = (uint8_t)Frama_C_interval(1, LABIAL_STATES_MAX);
    model->search_stride = (uint8_t)Frama_C_interval(1, LABIAL_SEARCH_STRIDE_MAX);
    model->silence = (uint8_t)Frama_C_interval(0, LABIAL_PHONEMES_MAX - 1);
    model->mixture_mean = (uint8_t)Frama_C_interval(0, 1);
    model->kernel_taps = (uint8_t)Frama_C_interval(0, LABIAL_KERNEL_TAPS_MAX);
    model->kernel_stride = any_uint8;
    model->kernel_behind = (uint8_t)Frama_C_interval(0, LABIAL_KERNEL_TAPS_MAX - 1);
    model->floor_count = any_uint8;
    model->pair_knots = (uint8_t)Frama_C_interval(1, 2);
    model->pair_count = any_uint16;
    model->phonemes = phonemes;
    model->components = components;
    model->contexts = OR_NULL(const uint8_t *, contexts);
    model->shapes = shapes;
    model->slopes = OR_NULL(const int8_t *, slopes);
    model->kernels = kernels;
    model->last_kernels = last_kernels;
    model->pair_keys = pair_keys;
    model->pairs = pairs;
    model->floors = floors;
    model->contacts = contacts;
    model->channels = channels;
}

#endif
