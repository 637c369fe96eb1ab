/*
 * test_model_equation.c - the limits of equation 3 that labial_model_check() holds a model to: each is accepted at its
 * bound and refused beyond it. test_trajectory.c says that the solver keeps its promise within them.
 */
#include "suite.h"

#include "fixture.h"

static fixture_model_t f; /* what TRY() changes */

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

SETUP(setup)
{
    fixture_plain(&f);
    return 0;
}

/* The largest hold, twice the largest weight of delta and six times that of delta-delta, each of any state: would catch
 * a sum over the weights of each state for itself, and another factor. */
TEST_AFTER(setup, refuses_weights_beyond_the_largest_sum)
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
TEST_AFTER(setup, refuses_contact_that_is_too_firm)
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
TEST_AFTER(setup, refuses_motion_that_is_too_stiff)
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
TEST_AFTER(setup, refuses_pulls_beyond_the_largest)
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
TEST_AFTER(setup, refuses_motion_out_of_range)
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

TEST_AFTER(setup, refuses_states_that_nothing_holds)
{
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
        labial_state_t *s = &f.states[c][c % FIXTURE_SPEECH_STATES];
        hold_all(c, 40, 0, 0);
        REFUSED(uint8_t, s->hold, 0);
        REFUSED(uint8_t, s->hold, LABIAL_WEIGHT_MIN - 1);
        ACCEPTED(uint8_t, s->hold, LABIAL_WEIGHT_MIN);
        ACCEPTED(uint8_t, s->share, 0);
        ACCEPTED(uint8_t, s->share, 255);
    }
}

/* Would catch a check whose own products leave 32 bits: weights and means as large as they can be, which amount to little
 * modulo 2^32, and a delta-delta that is light enough for its hold and too heavy by itself. */
TEST_AFTER(setup, refuses_products_that_overflow)
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
