/* Any counts and values, pointers null or not; the tables as long as the largest counts ask for. */
#include "labial/labial.h"
#include "prove.h"

#define COMPONENTS 65535
#define PAIRS 65535
#define FLOORS 255

static labial_phoneme_t phonemes[LABIAL_PHONEMES_MAX];
static labial_component_t components[COMPONENTS];
static uint8_t bytes[1];
static uint16_t pair_keys[PAIRS];
static int16_t floors[FLOORS * LABIAL_CHANNELS];
static uint16_t contacts[FLOORS];
static labial_emission_t emissions[LABIAL_STATES_MAX];
static labial_state_t states[LABIAL_STATES_MAX];
static labial_transition_t transitions[LABIAL_STATES_MAX * LABIAL_STATES_MAX];
static uint32_t words[1];
static labial_protrusion_t protrusion;
static labial_channel_t channels[LABIAL_CHANNELS];

/* With one number of channels, or those that no model has: EVA, which sees a number and the tables of the channels apart,
 * sees then whose tables are there. */
static void check_with(labial_model_t *model, int least, int most)
{
    model->channel_count = (uint8_t)Frama_C_interval(least, most);
    model->pair_keys = model->contacts = 0;
    model->floors = 0;
    labial_model_check(model);
    model->floors = floors;
    labial_model_check(model);
    model->contacts = contacts;
    labial_model_check(model);
    model->pair_keys = pair_keys;
    labial_model_check(model);
}

int main(void)
{
    labial_model_t model;
    FILL(phonemes);
    FILL(components);
    FILL(pair_keys);
    FILL(floors);
    FILL(contacts);
    FILL(emissions);
    FILL(states);
    FILL(transitions);
    FILL(channels);
    for (unsigned i = 0; i < LABIAL_CHANNELS; i++) {
        channels[i].emissions = OR_NULL(const labial_emission_t *, emissions);
        channels[i].states = OR_NULL(const labial_state_t *, states);
        channels[i].transitions = OR_NULL(const labial_transition_t *, transitions);
        channels[i].initials = OR_NULL(const uint8_t *, bytes);
    }
    FILL(model);
    model.phonemes = OR_NULL(const labial_phoneme_t *, phonemes);
    model.components = OR_NULL(const labial_component_t *, components);
    model.shapes = OR_NULL(const int8_t *, bytes);
    model.kernels = OR_NULL(const uint32_t *, words);
    model.pairs = OR_NULL(const int8_t *, bytes);
    model.protrusion = OR_NULL(const labial_protrusion_t *, &protrusion);
    model.channels = OR_NULL(const labial_channel_t *, channels);
    labial_model_check(0);
    /*@ loop unroll 14; */
    for (int i = 0; i <= LABIAL_CHANNELS; i++)
        check_with(&model, i, i);
    check_with(&model, LABIAL_CHANNELS + 1, 255);
    return 0;
}
