/*
 * any_model.h - any model that labial_model_check() accepts, as far as values of single members say it (assumed.h). Its
 * tables are as long as the largest counts ask for.
 */
#ifndef ANY_MODEL_H
#define ANY_MODEL_H

#include "assumed.h"
#include "labial/labial.h"
#include "prove.h"

#define COMPONENTS 65535
#define PAIRS 65535
#define FLOORS 255

static labial_phoneme_t phonemes[LABIAL_PHONEMES_MAX];
static labial_component_t components[COMPONENTS];
static uint8_t contexts[COMPONENTS * LABIAL_CLASSES_MAX];
static int8_t shapes[COMPONENTS * LABIAL_CHANNELS], slopes[COMPONENTS * LABIAL_CHANNELS];
static uint32_t kernels[LABIAL_PHONEMES_MAX * LABIAL_KERNEL_TAPS_MAX * LABIAL_KERNEL_WORDS(LABIAL_CHANNELS)];
static uint16_t pair_keys[PAIRS];
static int8_t pairs[PAIRS * 2 * LABIAL_CHANNELS];
static int16_t floors[FLOORS * LABIAL_CHANNELS];
static uint16_t contacts[FLOORS];
static labial_protrusion_t protrusion;
static labial_emission_t emissions[LABIAL_STATES_MAX];
static labial_state_t states[LABIAL_STATES_MAX];
static labial_transition_t transitions[LABIAL_STATES_MAX * LABIAL_STATES_MAX];
static uint8_t initials[LABIAL_STATES_MAX];
static labial_channel_t channels[LABIAL_CHANNELS];

static int16_t any_position(void)
{
    return (int16_t)Frama_C_interval(-LABIAL_POSITION_MAX, LABIAL_POSITION_MAX);
}

/* Gives a member of `object` any value that assumed.h allows it. */
#define ANY(member, least, most) object->member = Frama_C_interval(least, most);

static void any_emission(labial_emission_t *object)
{
    ASSUMED_OF_EMISSION(ANY)
}

static void any_state(labial_state_t *object)
{
    ASSUMED_OF_STATE(ANY)
}

static void any_states(void)
{
    unsigned i;
    FILL(emissions);
    FILL(states);
    FILL(transitions);
    FILL(initials);
    /*@ loop unroll 64; */
    for (i = 0; i < LABIAL_STATES_MAX; i++) {
        any_emission(&emissions[i]);
        any_state(&states[i]);
    }
}

static void any_channel(labial_channel_t *object)
{
    ASSUMED_OF_CHANNEL(ANY)
    object->emissions = emissions;
    object->states = states;
    object->transitions = transitions;
    object->initials = initials;
}

/* `count` is that of each phoneme's components: of one step, which looks at one phoneme. */
static void any_phonemes(int count)
{
    unsigned i;
    /*@ loop unroll 128; */
    for (i = 0; i < LABIAL_PHONEMES_MAX; i++) {
        labial_phoneme_t *const object = &phonemes[i];
        ASSUMED_OF_PHONEME(ANY)
        object->first_component = (uint16_t)Frama_C_interval(0, COMPONENTS - count);
        object->component_count = (uint8_t)count;
    }
}

static void any_model(labial_model_t *object, int count)
{
    unsigned i;
    any_phonemes(count);
    any_states();
    FILL(components);
    FILL(contexts);
    FILL(shapes);
    FILL(slopes);
    FILL(kernels);
    FILL(pair_keys);
    FILL(pairs);
    FILL(floors);
    FILL(contacts);
    FILL(protrusion);
    /*@ loop unroll 13; */
    for (i = 0; i < LABIAL_CHANNELS; i++)
        any_channel(&channels[i]);
    object->format = LABIAL_MODEL_FORMAT;
    ASSUMED_OF_MODEL(ANY)
    object->phonemes = phonemes;
    object->components = components;
    object->contexts = OR_NULL(const uint8_t *, contexts);
    object->shapes = shapes;
    object->slopes = OR_NULL(const int8_t *, slopes);
    object->kernels = kernels;
    object->pair_keys = pair_keys;
    object->pairs = pairs;
    object->floors = floors;
    object->contacts = contacts;
    object->protrusion = &protrusion; /* needed where FAP 17 is computed of the corners */
    object->channels = channels;
    /*@ loop unroll 13; */
    for (i = 0; i < LABIAL_CHANNELS; i++)
        object->sources[i] = (uint8_t)Frama_C_interval(0, LABIAL_CHANNELS - 1);
    if (any_int)
        object->sources[2] = LABIAL_FROM_CORNERS;
}

#endif
