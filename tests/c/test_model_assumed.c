/*
 * test_model_assumed.c - what the proofs take for granted of a model (tests/proof/assumed.h) is what
 * labial_model_check() grants: every value of each member, in a model all of whose tables are longer than any count may
 * be, so that nothing but the rule for that member refuses it.
 */
#include "suite.h"
#include "../proof/assumed.h"

#define MANY 256 /* more than what counts have room for, of what a byte counts */

static labial_model_t model;
static labial_channel_t channels[LABIAL_CHANNELS];
static labial_phoneme_t phonemes[MANY];
static labial_component_t components[1];
static int8_t shapes[1], pairs[1];
static uint32_t kernels[1];
static int16_t floors[MANY * LABIAL_CHANNELS];
static uint16_t contacts[MANY], pair_keys[65536];
static labial_emission_t emissions[MANY];
static labial_state_t states[MANY];
static labial_transition_t transitions[MANY * MANY];
static uint8_t initials[MANY];

/* As little as there can be of everything. */
SETUP(setup)
{
    memset(&model, 0, sizeof model);
    memset(channels, 0, sizeof channels);
    memset(phonemes, 0, sizeof phonemes);
    memset(emissions, 0, sizeof emissions);
    memset(states, 0, sizeof states);
    for (unsigned i = 0; i < MANY; i++) {
        phonemes[i].component_count = 1;
        states[i].hold = LABIAL_WEIGHT_MIN;
    }
    for (unsigned i = 0; i < 65536; i++)
        pair_keys[i] = (uint16_t)i;
    for (unsigned i = 0; i < LABIAL_CHANNELS; i++) {
        channels[i].emissions = emissions;
        channels[i].states = states;
        channels[i].transitions = transitions;
        channels[i].initials = initials;
    }
    model.format = LABIAL_MODEL_FORMAT;
    model.frames_per_second = model.component_count = 1;
    model.phoneme_count = model.class_count = model.state_count = model.predecessor_fours = model.search_stride = 1;
    model.pair_knots = 1;
    model.channel_count = LABIAL_CHANNELS;
    model.phonemes = phonemes;
    model.components = components;
    model.shapes = shapes;
    model.kernels = kernels;
    model.pair_keys = pair_keys;
    model.pairs = pairs;
    model.floors = floors;
    model.contacts = contacts;
    model.channels = channels;
    assert_ok(labial_model_check(&model));
    return 0;
}

/* Tries every value of the member's type, or where that takes long the ends and a share of the others: from LEAST to
 * MOST, and nowhere else, it is accepted. */
#define TRY_ALL(member, least, most) try_all(#member, &object->member, sizeof object->member, least, most);

static void try_all(const char *member, void *place, size_t size, long least, long most)
{
    uint8_t old[2];
    const int is_signed = least < 0;
    const long lowest = is_signed ? -32768 : 0, highest = size == 1 ? 255 : is_signed ? 32767 : 65535;
    /* Where any is accepted there is no rule to try; the ends do, for some tables are as long as the value. */
    const long step = least == lowest && most == highest ? highest : 1;
    memcpy(old, place, size);
    for (long value = lowest; value <= highest; value += step) {
        const uint8_t byte = (uint8_t)value;
        const uint16_t word = (uint16_t)value;
        if (size > 1 && value % LABIAL_TEST_SHARE != 0 && labs(value - least) > 1 && labs(value - most) > 1)
            continue;
        if (size == 1)
            memcpy(place, &byte, 1);
        else
            memcpy(place, &word, 2);
        if ((labial_model_check(&model) == LABIAL_OK) != (value >= least && value <= most))
            fail_msg("%s of %ld is %s", member, value, value >= least && value <= most ? "refused" : "accepted");
    }
    memcpy(place, old, size);
}

/* Would catch a limit that is one off, or that another rule keeps only in models whose tables are full. */
TEST_AFTER(setup, members_of_the_model)
{
    labial_model_t *const object = &model;
    model.phoneme_count = LABIAL_PHONEMES_MAX; /* of which silence is any */
    try_all("silence", &object->silence, 1, 0, LABIAL_PHONEMES_MAX - 1);
    model.phoneme_count = 1;
    model.kernel_taps = LABIAL_KERNEL_TAPS_MAX; /* all of which may lie before the frame where they are one */
    try_all("kernel_behind", &object->kernel_behind, 1, 0, LABIAL_KERNEL_TAPS_MAX - 1);
    model.kernel_taps = 0;
#define TRY_OTHER(member, least, most)                                                                                 \
    if (strcmp(#member, "silence") != 0 && strcmp(#member, "kernel_behind") != 0)                                      \
    TRY_ALL(member, least, most)
    ASSUMED_OF_MODEL(TRY_OTHER)
}

TEST_AFTER(setup, members_of_phonemes)
{
    model.phoneme_count = 2;
    model.class_count = LABIAL_CLASSES_MAX;
    model.component_count = 65535;
    model.floor_count = ASSUMED_FLOORS;
    for (unsigned i = 0; i < 2; i++) {
        labial_phoneme_t *const object = &phonemes[i];
        ASSUMED_OF_PHONEME(TRY_ALL)
        object->component_count = LABIAL_PHONEME_COMPONENTS_MAX;
        try_all("first_component", &object->first_component, 2, 0, 65535 - LABIAL_PHONEME_COMPONENTS_MAX);
    }
}

TEST_AFTER(setup, members_of_channels)
{
    for (unsigned i = 0; i < LABIAL_CHANNELS; i += LABIAL_CHANNELS - 1) {
        labial_channel_t *const object = &channels[i];
        ASSUMED_OF_CHANNEL(TRY_ALL)
    }
}

/* Of the lowest and the highest of two states, which must stay in order. */
TEST_AFTER(setup, members_of_emissions)
{
    model.state_count = 1;
    {
        labial_emission_t *const object = &emissions[0];
        ASSUMED_OF_EMISSION(TRY_ALL)
    }
    model.state_count = 2;
    emissions[0].mean = -LABIAL_POSITION_MAX;
    try_all("last mean", &emissions[1].mean, 2, -LABIAL_POSITION_MAX, LABIAL_POSITION_MAX);
}

/* What one weight may be depends on the others: with these each may be as large as anywhere. */
TEST_AFTER(setup, members_of_states)
{
    labial_state_t *const object = &states[1];
    model.state_count = 2;
    try_all("mean", &object->mean, 2, -LABIAL_POSITION_MAX, LABIAL_POSITION_MAX);
    try_all("hold", &object->hold, 1, 8, 0xaf);
    object->hold = 0x4f;
    try_all("weight[1]", &object->weight[1], 1, 0, 0x85);
    for (unsigned hold = 0; hold < 256; hold++)
        for (unsigned code = 0; code < 256; code++) { /* the most that weight[0] may be, and a little more */
            object->hold = (uint8_t)hold;
            object->weight[0] = object->weight[1] = (uint8_t)code;
#define IS_ASSUMED(member, least, most) &&object->member >= (least) && object->member <= (most)
            if (labial_model_check(&model) == LABIAL_OK && !(1 ASSUMED_OF_STATE(IS_ASSUMED)))
                fail_msg("a hold of 0x%02x and weights of 0x%02x are accepted", hold, code);
        }
}

SUITE(NULL, NULL)
