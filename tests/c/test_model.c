/*
 * test_model.c - labial_model_check() accepts what labial/model.h allows and refuses every rule's violation alone.
 *
 * Each refusal starts from a model that is accepted and changes one thing, so that a check that was forgotten shows. The
 * limits of equation 3 are accepted at their bounds and refused beyond them; test_trajectory.c says that the solver keeps
 * its promise within them.
 */
#include "suite.h"

static fixture_model_t f; /* what TRY() changes */

SETUP(setup)
{
    fixture_rich(&f);
    return 0;
}

TEST_AFTER(setup, refuses_null)
{
    assert_int_equal(labial_model_check(NULL), LABIAL_ERROR_NULL);
    TRY(const labial_phoneme_t *, f.model.phonemes, NULL, LABIAL_ERROR_NULL);
    TRY(const labial_component_t *, f.model.components, NULL, LABIAL_ERROR_NULL);
    TRY(const int8_t *, f.model.shapes, NULL, LABIAL_ERROR_NULL);
    TRY(const uint32_t *, f.model.kernels, NULL, LABIAL_ERROR_NULL);  /* there are taps */
    TRY(const int16_t *, f.model.floors, NULL, LABIAL_ERROR_NULL);    /* there are floors */
    TRY(const uint16_t *, f.model.contacts, NULL, LABIAL_ERROR_NULL); /* there are floors, contact or not */
    TRY(const labial_channel_t *, f.model.channels, NULL, LABIAL_ERROR_NULL);
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
        TRY(const labial_emission_t *, f.channels[c].emissions, NULL, LABIAL_ERROR_NULL);
        TRY(const labial_state_t *, f.channels[c].states, NULL, LABIAL_ERROR_NULL);
        TRY(const labial_transition_t *, f.channels[c].transitions, NULL, LABIAL_ERROR_NULL);
        TRY(const uint8_t *, f.channels[c].initials, NULL, LABIAL_ERROR_NULL);
    }
}

/* Would catch a model that must carry tables of what it does not use. */
TEST_AFTER(setup, optional_tables_may_be_null)
{
    ACCEPTED(const uint8_t *, f.model.contexts, NULL);
    ACCEPTED(const int8_t *, f.model.slopes, NULL);
    f.model.kernel_taps = f.model.kernel_behind = 0;
    ACCEPTED(const uint32_t *, f.model.kernels, NULL);
    f.model.floor_count = 0;
    f.phonemes[FIXTURE_P].floor = f.phonemes[FIXTURE_O].floor = 0;
    f.phonemes[FIXTURE_S].floor = f.phonemes[FIXTURE_SIL].floor = 0;
    ACCEPTED(const int16_t *, f.model.floors, NULL);
    ACCEPTED(const uint16_t *, f.model.contacts, NULL);
    REFUSED(uint8_t, f.phonemes[FIXTURE_P].floor, 1); /* a row of a table that is not there */
}

/* Would catch tables of 13 channels asked of a model that has 8, a bit of a ninth let through, and sources that no channel
 * is. */
TEST_AFTER(setup, models_have_the_channels_that_they_solve)
{
    fixture_narrow(&f, fixture_mirrored);
    assert_int_equal(f.model.channel_count, 8);
    assert_ok(labial_model_check(&f.model));
    TRY(const uint32_t *, f.model.kernels, NULL, LABIAL_ERROR_NULL);
    TRY(const labial_protrusion_t *, f.model.protrusion, NULL, LABIAL_ERROR_NULL);
    for (unsigned c = 0; c < 8; c++)
        TRY(const labial_state_t *, f.channels[c].states, NULL, LABIAL_ERROR_NULL);
    REFUSED(uint16_t, f.contacts[0], 1u << 8);
    ACCEPTED(uint16_t, f.contacts[0], 1u << 7);
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++) {
        ACCEPTED(uint8_t, f.model.sources[k], 7);
        REFUSED(uint8_t, f.model.sources[k], 8);
        REFUSED(uint8_t, f.model.sources[k], 254);
        if (k != 2)
            REFUSED(uint8_t, f.model.sources[k], LABIAL_FROM_CORNERS);
    }
    f.model.sources[2] = 0;
    ACCEPTED(const labial_protrusion_t *, f.model.protrusion, NULL);
    f.model.sources[2] = LABIAL_FROM_CORNERS;
    REFUSED(uint8_t, f.model.channel_count, 0);
    REFUSED(uint8_t, f.model.channel_count, 7);
    TRY(uint8_t, f.model.channel_count, 9, LABIAL_ERROR_NULL); /* whose tables are not there */
    fixture_rich(&f);
    ACCEPTED(uint8_t, f.model.channel_count, LABIAL_CHANNELS);
    REFUSED(uint8_t, f.model.channel_count, LABIAL_CHANNELS + 1);
    REFUSED(uint8_t, f.model.channel_count, 255);
    fixture_narrow(&f, fixture_mirrored);
    ACCEPTED(int16_t, f.protrusion.low, -32768);
    ACCEPTED(uint16_t, f.protrusion.gain, 65535);
    ACCEPTED(int16_t, f.protrusion.values[16], -32768);
    REFUSED(int16_t, f.floors[FIXTURE_FLOORS * 8 - 1], LABIAL_NO_FLOOR - 1);
    ACCEPTED(int16_t, f.floors[FIXTURE_FLOORS * 8], LABIAL_NO_FLOOR - 1); /* behind the table */
}

TEST_AFTER(setup, refuses_other_versions)
{
    TRY(uint16_t, f.model.format, 0, LABIAL_ERROR_VERSION);
    TRY(uint16_t, f.model.format, LABIAL_MODEL_FORMAT + 1, LABIAL_ERROR_VERSION);
    TRY(uint16_t, f.model.format, LABIAL_MODEL_FORMAT << 8, LABIAL_ERROR_VERSION);
}

/* What each count may be is tried in test_model_assumed.c; here what depends on what the tables hold. */
TEST_AFTER(setup, refuses_counts_that_tables_contradict)
{
    REFUSED(uint16_t, f.model.component_count, 2 * FIXTURE_SPEECH_COUNT - 1);
    ACCEPTED(uint16_t, f.model.component_count, 2 * FIXTURE_SPEECH_COUNT);
    REFUSED(uint8_t, f.model.class_count, FIXTURE_CLASSES - 1);
    ACCEPTED(uint8_t, f.model.class_count, FIXTURE_CLASSES);
    REFUSED(uint8_t, f.model.silence, FIXTURE_SPEECH_COUNT);
    ACCEPTED(uint8_t, f.model.silence, FIXTURE_SPEECH_COUNT - 1);
    for (unsigned i = 1; i <= FIXTURE_PREDECESSORS / 4; i++)
        ACCEPTED(uint8_t, f.model.predecessor_fours, (uint8_t)i); /* the same transitions, read as other states' */
}

TEST_AFTER(setup, refuses_bad_phonemes)
{
    for (unsigned p = 0; p < FIXTURE_SPEECH_COUNT; p++) {
        REFUSED(uint8_t, f.phonemes[p].component_count, 0);
        REFUSED(uint8_t, f.phonemes[p].component_count, LABIAL_PHONEME_COMPONENTS_MAX + 1);
        REFUSED(uint16_t, f.phonemes[p].first_component, 2 * FIXTURE_SPEECH_COUNT - 1); /* the second lies outside */
        REFUSED(uint16_t, f.phonemes[p].first_component, 65535);
        REFUSED(uint8_t, f.phonemes[p].viseme_class, FIXTURE_CLASSES);
        ACCEPTED(uint8_t, f.phonemes[p].viseme_class, FIXTURE_CLASSES - 1);
        REFUSED(uint8_t, f.phonemes[p].boundary, 2);
        REFUSED(uint8_t, f.phonemes[p].floor, FIXTURE_FLOORS + 1);
        ACCEPTED(uint8_t, f.phonemes[p].floor, FIXTURE_FLOORS);
        ACCEPTED(uint16_t, f.phonemes[p].first_component, 3); /* components may be shared */
    }
    ACCEPTED(uint8_t, f.phonemes[0].component_count, LABIAL_PHONEME_COMPONENTS_MAX);
}

/* Would catch a predecessor that the model does not have, in any of the transitions. Costs may be any. */
TEST_AFTER(setup, refuses_bad_transitions)
{
    const unsigned last = FIXTURE_SPEECH_STATES - 1;
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
        for (unsigned i = 0; i < FIXTURE_SPEECH_STATES * FIXTURE_PREDECESSORS; i++) {
            REFUSED(uint8_t, f.transitions[c][i].predecessor, last + 1);
            REFUSED(uint8_t, f.transitions[c][i].predecessor, 0xff);
            REFUSED(uint8_t, f.transitions[c][i].predecessor, 4 * last);
            ACCEPTED(uint8_t, f.transitions[c][i].predecessor, last);
            ACCEPTED(uint8_t, f.transitions[c][i].predecessor, 0);
            ACCEPTED(uint8_t, f.transitions[c][i].cost, 0xff);
            ACCEPTED(uint8_t, f.transitions[c][i].cost, 0);
        }
    }
}

/* Would catch a limit on transitions that is narrower than the largest model. */
TEST_AFTER(setup, accepts_transitions_of_the_largest_model)
{
    static labial_transition_t transitions[LABIAL_STATES_MAX * LABIAL_STATES_MAX];
    fixture_slow(&f);
    for (unsigned i = 0; i < LABIAL_STATES_MAX * LABIAL_STATES_MAX; i++)
        transitions[i] = (labial_transition_t){ (uint8_t)(i % LABIAL_STATES_MAX), 7 };
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++)
        f.channels[c].transitions = transitions;
    f.model.predecessor_fours = LABIAL_STATES_MAX / 4;
    assert_ok(labial_model_check(&f.model));
    REFUSED(uint8_t, transitions[LABIAL_STATES_MAX * LABIAL_STATES_MAX - 1].predecessor, LABIAL_STATES_MAX);
    REFUSED(uint8_t, f.model.state_count, LABIAL_STATES_MAX - 1);
}

/* The window of states that is searched is found by halves: would catch an order that is not looked at, at either end.
 * Equal means are in order. */
TEST_AFTER(setup, refuses_states_out_of_order)
{
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
        for (unsigned q = 1; q < FIXTURE_SPEECH_STATES; q++) {
            REFUSED(int16_t, f.emissions[c][q].mean, f.emissions[c][q - 1].mean - 1);
            ACCEPTED(int16_t, f.emissions[c][q].mean, f.emissions[c][q - 1].mean);
        }
        REFUSED(int16_t, f.emissions[c][0].mean, f.emissions[c][1].mean + 1);
    }
}

TEST_AFTER(setup, refuses_floors_out_of_range)
{
    const unsigned last = FIXTURE_FLOORS * LABIAL_CHANNELS - 1;
    REFUSED(int16_t, f.floors[0], LABIAL_POSITION_MAX + 1);
    REFUSED(int16_t, f.floors[last], LABIAL_NO_FLOOR - 1);
    REFUSED(int16_t, f.floors[last], INT16_MIN);
    ACCEPTED(int16_t, f.floors[0], LABIAL_NO_FLOOR);
    ACCEPTED(int16_t, f.floors[last], LABIAL_POSITION_MAX);
    REFUSED(uint8_t, f.model.floor_count, FIXTURE_FLOORS - 1); /* the last phoneme's row lies outside */
}

/* Would catch contact of a channel that there is not: the run-time shifts by channels. */
TEST_AFTER(setup, refuses_contacts_of_no_channel)
{
    for (unsigned row = 0; row < FIXTURE_FLOORS; row++) {
        for (unsigned bit = 0; bit < 16; bit++)
            TRY(uint16_t, f.contacts[row], 1u << bit, bit < LABIAL_CHANNELS ? LABIAL_OK : LABIAL_ERROR_MODEL);
        ACCEPTED(uint16_t, f.contacts[row], 0);
        ACCEPTED(uint16_t, f.contacts[row], 0x1fff);
        REFUSED(uint16_t, f.contacts[row], 0x3fff);
        REFUSED(uint16_t, f.contacts[row], 0xffff);
    }
}

/* Would catch keys that the binary search cannot find. */
TEST_AFTER(setup, refuses_pairs_out_of_order)
{
    REFUSED(uint16_t, f.pair_keys[1], f.pair_keys[0]);
    REFUSED(uint16_t, f.pair_keys[FIXTURE_PAIRS - 1], 0);
    REFUSED(uint16_t, f.pair_keys[0], 65535);
    ACCEPTED(uint16_t, f.pair_keys[FIXTURE_PAIRS - 1], 65535);
    TRY(const uint16_t *, f.model.pair_keys, NULL, LABIAL_ERROR_NULL);
    TRY(const int8_t *, f.model.pairs, NULL, LABIAL_ERROR_NULL);
}

/* Every number of taps, stride and place: accepted exactly where no tap reads a label that the library does not keep, which
 * is what lib/shape.c and the proofs take for granted. */
TEST_AFTER(setup, kernels_stay_within_the_labels)
{
    static uint32_t kernels[FIXTURE_SPEECH_COUNT * (LABIAL_KERNEL_TAPS_MAX + 1) * FIXTURE_KERNEL_WORDS];
    int accepted = 0;
    f.model.kernels = kernels;
    for (int taps = 1; taps <= LABIAL_KERNEL_TAPS_MAX + 1; taps++)
        for (int stride = 0; stride < 256; stride += stride <= LABIAL_REACH + 1 ? 1 : 31)
            for (int behind = 0; behind <= taps; behind++) {
                const int first = -behind * stride, last = (taps - 1 - behind) * stride;
                const int sound =
                    taps <= LABIAL_KERNEL_TAPS_MAX && behind < taps && first >= -LABIAL_REACH && last <= LABIAL_REACH;
                f.model.kernel_taps = (uint8_t)taps;
                f.model.kernel_stride = (uint8_t)stride;
                f.model.kernel_behind = (uint8_t)behind;
                if ((labial_model_check(&f.model) == LABIAL_OK) != sound)
                    fail_msg("%d taps every %d frames, %d of them before", taps, stride, behind);
                accepted += sound;
            }
    assert_true(accepted > 500);
    f.model.kernel_taps = 0;
    f.model.kernel_behind = 1;
    REFUSED(uint8_t, f.model.kernel_stride, 1); /* taps before the frame, though there are none */
    f.model.kernel_behind = 0;
    ACCEPTED(uint8_t, f.model.kernel_stride, 255);
}

/* Would catch an index or a product that is too narrow for the largest model the limits allow. */
TEST_AFTER(setup, accepts_the_largest_counts)
{
    enum { COMPONENTS = LABIAL_PHONEMES_MAX * LABIAL_PHONEME_COMPONENTS_MAX };
    static labial_phoneme_t phonemes[LABIAL_PHONEMES_MAX];
    static labial_component_t components[COMPONENTS];
    static int8_t shapes[COMPONENTS * LABIAL_CHANNELS];
    fixture_slow(&f);
    for (unsigned p = 0; p < LABIAL_PHONEMES_MAX; p++) {
        phonemes[p].first_component = (uint16_t)(p * LABIAL_PHONEME_COMPONENTS_MAX);
        phonemes[p].component_count = LABIAL_PHONEME_COMPONENTS_MAX;
        phonemes[p].viseme_class = (uint8_t)(p % LABIAL_CLASSES_MAX);
    }
    f.model.phonemes = phonemes;
    f.model.components = components;
    f.model.shapes = shapes;
    f.model.contexts = NULL;
    f.model.slopes = NULL;
    f.model.kernel_taps = f.model.kernel_behind = 0;
    f.model.kernels = NULL;
    f.model.floor_count = 0;
    f.model.floors = NULL;
    f.model.phoneme_count = LABIAL_PHONEMES_MAX;
    f.model.class_count = LABIAL_CLASSES_MAX;
    f.model.component_count = COMPONENTS;
    assert_ok(labial_model_check(&f.model));
    REFUSED(uint16_t, f.model.component_count, COMPONENTS - 1);
    REFUSED(uint8_t, phonemes[LABIAL_PHONEMES_MAX - 1].viseme_class, LABIAL_CLASSES_MAX);
}

/* ---- The limits of equation 3 ------------------------------------------------------------------------------------ */

/* The least weight above `value`, and the largest that is not. */
static uint8_t above(double value)
{
    uint8_t code = 0;
    while (fixture_weight_value(code) <= value)
        code++;
    return code;
}

static uint8_t not_above(double value)
{
    return (uint8_t)(above(value) - 1);
}

/* All states of a channel alike: no pull, and what is given. */
static void hold_all(unsigned c, uint8_t hold, uint8_t delta, uint8_t delta2)
{
    for (unsigned q = 0; q < FIXTURE_SPEECH_STATES; q++) {
        labial_state_t *s = &f.states[c][q];
        s->hold = hold;
        s->weight[0] = delta;
        s->weight[1] = delta2;
        s->motion[0] = s->motion[1] = 0;
    }
    f.channels[c].motion_scale[0] = f.channels[c].motion_scale[1] = 256;
}

SETUP(set_plain)
{
    fixture_plain(&f);
    return 0;
}

/* The largest hold, twice the largest weight of delta and six times that of delta-delta, each of any state: would catch
 * a sum over the weights of each state for itself, and another factor. */
TEST_AFTER(set_plain, refuses_weights_beyond_the_largest_sum)
{
    const double sum = LABIAL_WEIGHT_SUM_MAX;
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
        const uint8_t dd = not_above(1400), d = not_above(1000);
        labial_state_t *const s = f.states[c];
        hold_all(c, not_above(500), 0, 0);
        ACCEPTED(uint8_t, s[1].hold, not_above(sum));
        REFUSED(uint8_t, s[1].hold, above(sum));
        REFUSED(uint8_t, s[1].hold, 0xff);
        s[7].weight[1] = dd; /* in one state, */
        ACCEPTED(uint8_t, s[1].hold, not_above(sum - 6 * fixture_weight_value(dd)));
        REFUSED(uint8_t, s[1].hold, above(sum - 6 * fixture_weight_value(dd)));
        s[4].weight[1] = dd; /* and in another */
        ACCEPTED(uint8_t, s[4].weight[0], d);
        s[4].weight[0] = d;
        ACCEPTED(uint8_t, s[0].hold, not_above(sum - 6 * fixture_weight_value(dd) - 2 * fixture_weight_value(d)));
        REFUSED(uint8_t, s[0].hold, above(sum - 6 * fixture_weight_value(dd) - 2 * fixture_weight_value(d)));
        hold_all(c, not_above(500), 0, 0);
        ACCEPTED(uint8_t, s[2].weight[1], not_above((sum - fixture_weight_value(not_above(500))) / 6));
        REFUSED(uint8_t, s[2].weight[1], above((sum - fixture_weight_value(not_above(500))) / 6));
        REFUSED(uint8_t, s[2].weight[1], 0xff);
    }
}

/* `contact_weight` takes the place of the largest hold where it is larger, in every channel for itself: would catch a
 * sum without it, one with both, and a limit that a model without contact would have. */
TEST_AFTER(set_plain, refuses_contact_that_is_too_firm)
{
    const double sum = LABIAL_WEIGHT_SUM_MAX;
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
        const uint8_t dd = not_above(1400), d = not_above(1000);
        const double room = sum - 6 * fixture_weight_value(dd) - 2 * fixture_weight_value(d);
        hold_all(c, not_above(500), 0, 0);
        ACCEPTED(uint8_t, f.channels[c].contact_weight, 0);
        ACCEPTED(uint8_t, f.channels[c].contact_weight, 1); /* weaker than what holds all others: nothing changes */
        ACCEPTED(uint8_t, f.channels[c].contact_weight, not_above(sum));
        REFUSED(uint8_t, f.channels[c].contact_weight, above(sum));
        REFUSED(uint8_t, f.channels[c].contact_weight, 0xff);
        f.states[c][3].weight[1] = dd;
        f.states[c][5].weight[1] = dd;
        f.states[c][5].weight[0] = d;
        ACCEPTED(uint8_t, f.channels[c].contact_weight, not_above(room));
        REFUSED(uint8_t, f.channels[c].contact_weight, above(room));
        f.channels[c].contact_weight = not_above(room);
        ACCEPTED(uint8_t, f.states[c][0].hold, not_above(room));
        REFUSED(uint8_t, f.states[c][0].hold, above(room));
    }
}

/* Would catch a stiffness measured by another state's hold, and motion that no factorisation of this kind bears. */
TEST_AFTER(set_plain, refuses_motion_that_is_too_stiff)
{
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
        labial_state_t *const s = &f.states[c][c % FIXTURE_SPEECH_STATES];
        hold_all(c, not_above(500), 0, 0);
        for (unsigned code = not_above(LABIAL_WEIGHT_MIN); code <= not_above(120); code++) {
            const double hold = fixture_weight_value((uint8_t)code);
            s->hold = (uint8_t)code;
            ACCEPTED(uint8_t, s->weight[1], not_above(LABIAL_STIFFNESS_MAX * hold));
            REFUSED(uint8_t, s->weight[1], above(LABIAL_STIFFNESS_MAX * hold));
        }
        s->weight[1] = 40; /* delta is no heavier than delta-delta */
        ACCEPTED(uint8_t, s->weight[0], 40);
        REFUSED(uint8_t, s->weight[0], 41);
        s->weight[1] = 0;
        REFUSED(uint8_t, s->weight[0], 1);
    }
}

/* A scale by which 127 steps of motion are `mean`, and as many steps back less that. */
static uint16_t scale_of(int mean)
{
    const unsigned scale = ((unsigned)mean * 256u + 63u) / 127u;
    assert_int_equal((127 * scale + 128) / 256, mean);
    return (uint16_t)scale;
}

/* Four times the largest weight times mean of delta, and of delta-delta, whatever their signs and states, over the least
 * hold: exactly, for weights of 8 and 16. */
TEST_AFTER(set_plain, refuses_pulls_beyond_the_largest)
{
    const int all = LABIAL_PULL_MAX * LABIAL_WEIGHT_MIN / 4 / 16; /* of a weight of 16; rounded down */
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
        labial_state_t *const s = f.states[c];
        uint16_t *const scale = f.channels[c].motion_scale;
        for (int sign = -1; sign <= 1; sign += 2) {
            hold_all(c, 16, 16, 16);
            s[6].hold = LABIAL_WEIGHT_MIN;
            s[2].motion[0] = (int8_t)(127 * sign);
            ACCEPTED(uint16_t, scale[0], scale_of(all));
            REFUSED(uint16_t, scale[0], scale_of(all + 1));
            s[2].motion[0] = 0;
            s[2].motion[1] = (int8_t)(-127 * sign);
            ACCEPTED(uint16_t, scale[1], scale_of(all));
            REFUSED(uint16_t, scale[1], scale_of(all + 1));
            s[1].motion[0] = (int8_t)(-127 * sign);
            scale[0] = scale_of(5000);
            ACCEPTED(uint16_t, scale[1], scale_of(all - 5000));
            REFUSED(uint16_t, scale[1], scale_of(all - 4999));
            s[6].hold = 16; /* twice as much */
            ACCEPTED(uint16_t, scale[1], scale_of(all - 4999));
            ACCEPTED(uint16_t, scale[1], scale_of(2 * all + 1 - 5000));
            REFUSED(uint16_t, scale[1], scale_of(2 * all + 2 - 5000));
        }
    }
}

/* Means are positions, whatever they weigh, to either side. */
TEST_AFTER(set_plain, refuses_motion_out_of_range)
{
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++)
        for (unsigned i = 0; i < 2; i++)
            for (int sign = -1; sign <= 1; sign += 2) {
                hold_all(c, 16, 0, 0);
                f.states[c][c % FIXTURE_SPEECH_STATES].motion[i] = (int8_t)(127 * sign);
                ACCEPTED(uint16_t, f.channels[c].motion_scale[i], scale_of(LABIAL_POSITION_MAX));
                REFUSED(uint16_t, f.channels[c].motion_scale[i], scale_of(LABIAL_POSITION_MAX + 1));
                REFUSED(uint16_t, f.channels[c].motion_scale[i], 65535);
                f.states[c][c % FIXTURE_SPEECH_STATES].motion[i] = 0;
                ACCEPTED(uint16_t, f.channels[c].motion_scale[i], 65535);
            }
}

/* Would catch a check whose own products leave 32 bits: weights and means as large as they can be, which amount to little
 * modulo 2^32, and a delta-delta that is light enough for its hold and too heavy by itself. */
TEST_AFTER(set_plain, refuses_products_that_overflow)
{
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
        labial_state_t *const s = &f.states[c][c % FIXTURE_SPEECH_STATES];
        hold_all(c, not_above(500), 0, 0);
        s->motion[0] = s->motion[1] = 127;
        f.channels[c].motion_scale[0] = f.channels[c].motion_scale[1] = scale_of(LABIAL_POSITION_MAX);
        s->weight[0] = s->weight[1] = 0xb0;
        REFUSED(uint8_t, s->hold, 0x30);
        REFUSED(uint8_t, s->hold, 0xa0);
        s->weight[0] = s->weight[1] = 0xff;
        REFUSED(uint8_t, s->hold, 0xff);
        s->motion[0] = s->motion[1] = 0;
        s->weight[0] = 0;
        s->weight[1] = above(LABIAL_WEIGHT_SUM_MAX / 6);
        REFUSED(uint8_t, s->hold, not_above(500));
    }
}

SUITE(NULL, NULL)
