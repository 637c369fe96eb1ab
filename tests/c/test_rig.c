/*
 * test_rig.c - FAPs to outputs: random rigs against a computation in double, by hand what that leaves out, and what must
 * hold for every table and every FAP.
 */
#include "suite.h"

#define FAP3 0
#define FAP51 3
#define FAP52 4

/* An output that moves one unit per FAP unit of FAP 3, from 1500, within 1000 .. 2000. */
static labial_rig_output_t plain(void)
{
    const labial_rig_output_t output = {
        .weights = { LABIAL_RIG_ONE }, .gain = LABIAL_RIG_GAIN(1, 1), .neutral = 1500, .minimum = 1000, .maximum = 2000
    };
    return output;
}

/* The value of an output that stood at `last` when FAP 3 becomes `fap3`. */
static int32_t moved(const labial_rig_output_t *output, int32_t last, int16_t fap3)
{
    const labial_rig_t rig = { output, 1 };
    int16_t faps[LABIAL_CHANNELS] = { 0 };
    int32_t value[2] = { last, -77 };
    faps[FAP3] = fap3;
    assert_ok(labial_rig_apply(&rig, faps, value));
    assert_int_equal(value[1], -77); /* nothing beyond the rig's outputs is written */
    return value[0];
}

TEST(jaw_macro_closes_and_opens)
{
    static const labial_rig_output_t up = LABIAL_RIG_JAW(1400, 1900), down = LABIAL_RIG_JAW(1900, 1400);
    static const struct {
        int16_t top, bottom;
        int32_t up;
    } poses[] = {
        { 0, 0, 1400 },    { 90, -90, 1400 },  { 0, -600, 1900 }, { -100, -500, 1900 },
        { 0, -300, 1650 }, { 90, -390, 1650 }, { 200, 0, 1400 },  { -32768, -32768, 1900 },
        { 0, -72, 1400 },  { 20, -92, 1400 },  { 0, -136, 1513 }, { 0, -104, 1443 },
    };
    for (unsigned i = 0; i < COUNT_OF(poses); i++) {
        const labial_rig_output_t both[2] = { up, down };
        const labial_rig_t rig = { both, 2 };
        int16_t faps[LABIAL_CHANNELS] = { 500, 1, 2, 0, 0, 3, 4, 5, 6, 7, 8, 9, 10 }; /* others must not matter */
        int32_t values[2] = { 1400, 1900 };
        faps[FAP51] = poses[i].top;
        faps[FAP52] = poses[i].bottom;
        assert_ok(labial_rig_check(&rig));
        labial_rig_apply(&rig, faps, values);
        assert_in_range(values[0] - poses[i].up + 1, 0, 2);
        assert_in_range(values[1] + values[0] - 3300 + 1, 0, 2);
    }
}

/* A slow servo that sees where lips touch sets out early and is closed there; one that does not is late. What it does
 * may change no frame by more than its limit, and with one frame in sight it is labial_rig_apply(). */
TEST(looking_ahead_closes_in_time)
{
    static const struct {
        int32_t slew, closed; /* 0: no contact */
        unsigned frame;
        uint16_t sight;
        int32_t from, to;
    } cases[] = {
        { 40, 1400, 6, 3, 1600, 1560 }, /* out of reach: as fast as it goes */
        { 40, 1400, 6, 2, 1600, 1600 }, /* not in sight */
        { 0, 1400, 7, 2, 1500, 1600 },  /* no limit: nothing to be early for */
        { 40, 0, 7, 2, 1600, 1600 },
        { LABIAL_RIG_VALUE_MAX, 2000, 0, 12, 1600, 1600 }, /* far ahead, where the room is as large as can be */
        { 150, 2000, 7, 2, 1600, 1750 },                   /* from below: wanted 1850, 150 short of 2000 */
    };
    labial_rig_output_t output = fixture_jaw(2000, 40, 0);
    const labial_rig_t rig = { &output, 1 };
    int16_t frames[12][LABIAL_CHANNELS] = { { 0 } };
    int32_t blind = 1400, seeing = 1400, value;
    for (unsigned i = 0; i < 12; i++)
        frames[i][FAP52] = i == 8 ? -60 : -200; /* open, but for the ninth frame: 1600, and 1400 in p, b, m */
    for (unsigned i = 0; i < 12; i++) {
        static const int32_t wanted[12] = { 1440, 1480, 1520, 1560, 1560, 1520, 1480, 1440, 1400, 1440, 1480, 1520 };
        const int32_t last = seeing;
        labial_rig_apply(&rig, frames[i], &blind);
        assert_ok(labial_rig_apply_ahead(&rig, frames[i], (uint16_t)(12 - i), &seeing, NULL));
        assert_int_equal(seeing, wanted[i]);
        assert_true(seeing - last <= 40 && last - seeing <= 40);
        if (i == 8)
            assert_int_equal(blind, 1560);
    }
    for (unsigned i = 0; i < COUNT_OF(cases); i++) {
        output.slew = cases[i].slew;
        output.contact = cases[i].closed > 0;
        output.closed = cases[i].closed;
        value = cases[i].from;
        assert_ok(labial_rig_apply_ahead(&rig, frames[cases[i].frame], cases[i].sight, &value, NULL));
        assert_int_equal(value, cases[i].to);
    }
    assert_int_equal(labial_rig_apply_ahead(&rig, frames[0], 0, &value, NULL), LABIAL_ERROR_NULL);
}

/* By hand: a linkage that opens by half of what is wanted at first, then by twice as much. */
TEST(curve_bends)
{
    static const labial_rig_curve_t curve = { 2, { { 1500, 1500, 1 << 19 }, { 1700, 1600, 1 << 21 } } };
    labial_rig_output_t output = plain();
    output.curve = &curve;
    assert_int_equal(moved(&output, 1500, 100), 1550);
    assert_int_equal(moved(&output, 1500, 101), 1551); /* 50.5 goes up */
    assert_int_equal(moved(&output, 1500, 199), 1600);
    assert_int_equal(moved(&output, 1500, 200), 1600);
    assert_int_equal(moved(&output, 1500, 300), 1800);
    assert_int_equal(moved(&output, 1500, 401), 2000); /* the limit is that of what comes out */
    assert_int_equal(moved(&output, 1500, -100), 1450);
    output.invert = 1;
    assert_int_equal(moved(&output, 1500, -100), 1550);
    assert_int_equal(moved(&output, 1500, INT16_MIN), 2000);
    assert_int_equal(moved(&output, 1500, INT16_MAX), 1000);
}

/* Each of as many segments as a curve may have. */
TEST(full_curve_bends_everywhere)
{
    labial_rig_curve_t curve = { LABIAL_RIG_SEGMENTS, { { 0, 0, 0 } } };
    labial_rig_output_t output = plain();
    for (int32_t i = 0; i < LABIAL_RIG_SEGMENTS; i++) {
        curve.segments[i].from = 1500 + 10 * i;
        curve.segments[i].to = 1900 - 100 * i;
    }
    output.curve = &curve;
    for (int16_t i = 0; i < LABIAL_RIG_SEGMENTS; i++) {
        assert_int_equal(moved(&output, 1500, (int16_t)(10 * i)), 1900 - 100 * i);
        assert_int_equal(moved(&output, 1500, (int16_t)(10 * i + 9)), 1900 - 100 * i);
    }
}

/* What is LABIAL_RIG_SIGHT frames ahead is seen, the present one included: from standing at 2720, with 10 more in each frame,
 * a servo comes to 0 in just as many, half of them ever faster. And its speed is what it reaches in as many. */
TEST(sight_is_32_frames)
{
    enum { CLOSES = 90, FASTEST = 10 * LABIAL_RIG_SIGHT };
    static int16_t frames[CLOSES + 2 * LABIAL_RIG_SIGHT][LABIAL_CHANNELS];
    labial_rig_output_t output = fixture_jaw(2000, 0, 10);
    const labial_rig_t rig = { &output, 1 };
    int32_t value = 0, change = 0, most = 0;
    output.gain = LABIAL_RIG_GAIN(10, 1);
    output.neutral = output.minimum = output.contact = 0;
    output.closed = 0;
    output.maximum = 2720;
    for (unsigned t = 0; t < CLOSES; t++)
        frames[t][FAP52] = -272;
    for (unsigned t = 0; t <= CLOSES; t++) {
        assert_ok(labial_rig_apply_ahead(&rig, frames[t], LABIAL_RIG_SIGHT, &value, &change));
        if (t + LABIAL_RIG_SIGHT == CLOSES)
            assert_int_equal(value, 2720); /* nothing is seen of it yet */
    }
    assert_int_equal(value, 0);
    output.maximum = 30000;
    for (unsigned t = 0; t < CLOSES; t++)
        frames[t][FAP52] = -3000;
    for (unsigned t = 0; t < CLOSES - LABIAL_RIG_SIGHT; t++) {
        assert_ok(labial_rig_apply_ahead(&rig, frames[t], LABIAL_RIG_SIGHT, &value, &change));
        most = change > most ? change : most;
    }
    assert_int_equal(most, FASTEST);
}

/* A servo with a limit of acceleration, on its way down from 1600 to 1400 in the frame 8 with all in sight: it sets out
 * where it must, comes to rest there and goes no further; with nothing in sight it is late, and does not go beyond. */
TEST(acceleration_comes_to_rest)
{
    labial_rig_output_t output = fixture_jaw(2000, 60, 20);
    const labial_rig_t rig = { &output, 1 };
    int16_t frames[24][LABIAL_CHANNELS] = { { 0 } };
    assert_ok(labial_rig_check(&rig));
    for (unsigned i = 0; i < 24; i++)
        frames[i][FAP52] = i < 8 ? -200 : 0;
    for (unsigned sight = 1; sight <= 24; sight++) {
        int32_t value = 1600, change = 0, arrived = 0;
        for (unsigned i = 0; i < 24; i++) {
            const int32_t last = value, before = change;
            const unsigned left = 24u - i;
            assert_ok(
                labial_rig_apply_ahead(&rig, frames[i], (uint16_t)(sight < left ? sight : left), &value, &change));
            assert_int_equal(change, value - last);
            assert_true(change <= 60 && change >= -60 && change - before <= 20 && before - change <= 20);
            assert_true(value >= 1400 && value <= 1600);
            if (value == 1400 && !arrived)
                arrived = (int32_t)i;
        }
        assert_true(arrived > 0 && (sight < 7 || arrived <= 8) && (sight > 1 || arrived > 12));
    }
    int32_t value = 1600; /* without changes the limit is not kept, as by labial_rig_apply() */
    labial_rig_apply_ahead(&rig, frames[8], 1, &value, NULL);
    assert_int_equal(value, 1540);
}

/* Whatever is asked, seen or claimed of the last change, the limits hold. */
TEST(acceleration_holds_for_all)
{
    draw_from(5);
    for (unsigned round = 0; round < 300; round++) {
        labial_rig_output_t output = plain();
        const labial_rig_t rig = { &output, 1 };
        int16_t frames[40][LABIAL_CHANNELS];
        int32_t value, change = 0;
        const unsigned sight = 1u + chance() % 40u;
        output.weights[FAP52] = LABIAL_RIG_ONE;
        output.gain = between(-LABIAL_RIG_GAIN_MAX, LABIAL_RIG_GAIN_MAX) >> chance() % 20u;
        output.slew = between(0, 400);
        output.acceleration = between(1, 300) >> chance() % 8u;
        output.acceleration += !output.acceleration;
        output.contact = (uint8_t)(chance() % 2u);
        output.closed = output.contact ? between(output.minimum, output.maximum) : 0;
        assert_ok(labial_rig_check(&rig));
        for (unsigned i = 0; i < 40; i++)
            for (unsigned frame = 0; frame < LABIAL_CHANNELS; frame++)
                frames[i][frame] = (int16_t)between(-400, 400);
        labial_rig_rest(&rig, &value);
        for (unsigned frame = 0; frame < 40; frame++) {
            const int32_t last = value, before = change;
            const unsigned left = 40u - frame;
            labial_rig_apply_ahead(&rig, frames[frame], (uint16_t)(sight < left ? sight : left), &value, &change);
            assert_true(value >= output.minimum && value <= output.maximum && change == value - last);
            assert_true(change - before <= output.acceleration && before - change <= output.acceleration);
            assert_true(!output.slew || (change <= output.slew && change >= -output.slew));
        }
        change = INT32_MIN;
        value = INT32_MAX;
        labial_rig_apply_ahead(&rig, frames[0], 40, &value, &change);
        assert_true(value >= output.minimum && value <= output.maximum);
    }
}

/* A face that stops beside its rest would stay there until it speaks again. */
TEST(deadband_does_not_keep_it_from_rest)
{
    for (int32_t acceleration = 0; acceleration < 3; acceleration++) {
        labial_rig_output_t output = plain();
        const labial_rig_t rig = { &output, 1 };
        int16_t frames[2][LABIAL_CHANNELS] = { { 0 } };
        int32_t value = 1502, change = 0;
        output.deadband = 5;
        output.acceleration = acceleration;
        for (unsigned i = 0; i < 4; i++)
            labial_rig_apply_ahead(&rig, frames[0], 2, &value, &change);
        assert_int_equal(value, 1500);
        frames[0][FAP3] = 4;
        labial_rig_apply_ahead(&rig, frames[0], 1, &value, &change);
        assert_int_equal(value, 1500);
        assert_int_equal(moved(&output, 1498, 0), 1500);
        output.contact = 1;
        output.closed = 1497;
        assert_int_equal(moved(&output, 1499, 0), 1497);
    }
}

/* Sounds count in the frames ahead, too: a heavy tongue that sees the end of a sound stops in time, as one that follows
 * the same way by FAPs. */
TEST(sounds_ahead_equal_faps_ahead)
{
    static const int16_t amounts[LABIAL_VISEMES] = { [LABIAL_VISEME_TH] = 128 };
    static const int16_t still[20][LABIAL_CHANNELS] = { { 0 } };
    int16_t frames[20][LABIAL_CHANNELS] = { { 0 } };
    uint8_t shares[20][LABIAL_VISEMES] = { { 0 } };
    for (unsigned limits = 0; limits < 4; limits++) {
        labial_rig_output_t output = plain(), tongue = plain();
        const labial_rig_t faps = { &output, 1 }, sounds = { &tongue, 1 };
        int32_t values[2] = { 1500, 1500 }, changes[2] = { 0, 0 }, most = 1500;
        memset(tongue.weights, 0, sizeof tongue.weights);
        tongue.visemes = amounts;
        output.slew = tongue.slew = limits & 1u ? 20 : 0;
        output.acceleration = tongue.acceleration = limits & 2u ? 6 : 0;
        for (unsigned i = 0; i < 20; i++)
            frames[i][FAP3] = shares[i][LABIAL_VISEME_TH] = i > 3 && i < 10 ? 100 : 0;
        for (unsigned i = 0; i < 20; i++) {
            const uint16_t left = (uint16_t)(20 - i);
            assert_ok(labial_rig_apply_ahead(&faps, frames[i], left, &values[0], &changes[0]));
            const int result =
                labial_rig_apply_visemes_ahead(&sounds, still[i], shares[i], left, &values[1], &changes[1]);
            assert_ok(result);
            assert_int_equal(values[0], values[1]);
            most = values[1] > most ? values[1] : most;
        }
        assert_in_range(most, 1520, 1600);
    }
}

/* A sound output with every number anywhere in its range, small moves as likely as ones that saturate. */
static labial_rig_output_t any_sound_output(void)
{
    labial_rig_output_t output = { 0 };
    const unsigned gain_shift = chance() % 28u, value_shift = chance() % 16u;
    int32_t left = LABIAL_RIG_WEIGHT_SUM_MAX;
    unsigned k = chance() % LABIAL_CHANNELS;
    for (unsigned i = 0; i < LABIAL_CHANNELS; i++, k = (k + 1u) % LABIAL_CHANNELS) {
        int32_t most = left < 32767 ? left : 32767;
        if (chance() % 4u == 0)
            most = most / 64;
        output.weights[k] = (int16_t)between(-most, most);
        left -= output.weights[k] < 0 ? -output.weights[k] : output.weights[k];
    }
    output.gain = between(-LABIAL_RIG_GAIN_MAX, LABIAL_RIG_GAIN_MAX) >> gain_shift;
    output.neutral = between(-LABIAL_RIG_VALUE_MAX, LABIAL_RIG_VALUE_MAX) >> value_shift;
    output.minimum = between(-LABIAL_RIG_VALUE_MAX, LABIAL_RIG_VALUE_MAX) >> value_shift;
    output.maximum = between(output.minimum, LABIAL_RIG_VALUE_MAX >> value_shift);
    output.slew = chance() % 2u ? 0 : between(0, LABIAL_RIG_VALUE_MAX) >> (chance() % 24u);
    output.invert = (uint8_t)(chance() % 2u);
    output.contact = (uint8_t)(chance() % 2u);
    output.closed = output.contact ? between(output.minimum, output.maximum) : 0;
    output.deadband = chance() % 3u ? 0 : between(0, LABIAL_RIG_VALUE_MAX) >> (chance() % 24u);
    return output;
}

static int16_t any_fap(void)
{
    switch (chance() % 6u) {
    case 0:
        return INT16_MIN;
    case 1:
        return INT16_MAX;
    case 2:
        return (int16_t)between(INT16_MIN, INT16_MAX);
    default:
        return (int16_t)between(-600, 600);
    }
}

/* The header's equations in double precision, of an output that stood at `last`. */
static double expected(const labial_rig_output_t *output, const int16_t faps[LABIAL_CHANNELS], const uint8_t *shares,
                       double last)
{
    const double value = fixture_output(output, faps, shares);
    if (fabs(value - last) < output->deadband && fabs(value - fixture_rest(output)) > 0)
        return last;
    return output->slew > 0 ? fixture_limited(value, last - output->slew, last + output->slew) : value;
}

/* Would catch an overflow, a wrong rounding or a limit that is left, anywhere in the range of a checked table. All sums
 * and products are exact in double: they are below 2^59 in steps of which at most 53 bits matter after rounding; where
 * that rounding of the double itself could decide, one unit is allowed. */
TEST(random_rigs_equal_double)
{
    unsigned off = 0;
    draw_from(1);
    for (unsigned round = 0; round < 4000; round++) {
        int16_t amounts[LABIAL_VISEMES];
        labial_rig_output_t output = any_sound_output();
        const labial_rig_t rig = { &output, 1 };
        int32_t value;
        for (unsigned i = 0; i < LABIAL_VISEMES; i++)
            amounts[i] = (int16_t)between(round % 3u ? -1000 : INT16_MIN, round % 3u ? 1000 : INT16_MAX);
        output.visemes = chance() % 2u ? amounts : NULL;
        assert_ok(labial_rig_check(&rig));
        assert_ok(labial_rig_rest(&rig, &value));
        assert_int_equal(value, (int32_t)fixture_rest(&output));
        for (unsigned frame = 0; frame < 12; frame++) {
            int16_t faps[LABIAL_CHANNELS];
            if (chance() % 8u == 0) /* never set, or set by a fault */
                value = (int32_t)(chance() & 0x7fffffffu) - (int32_t)(chance() & 0x7fffffffu);
            const int32_t last = (int32_t)fixture_limited(value, output.minimum, output.maximum);
            for (unsigned i = 0; i < LABIAL_CHANNELS; i++)
                faps[i] = any_fap();
            uint8_t shares[LABIAL_VISEMES];
            for (unsigned i = 0; i < LABIAL_VISEMES; i++)
                shares[i] = (uint8_t)chance();
            const uint8_t *const known = frame % 3u ? shares : NULL;
            const double wanted = expected(&output, faps, known, last);
            assert_ok(labial_rig_apply_visemes(&rig, faps, known, &value));
            assert_near(value, wanted, 1.0);
            off += wanted < value || wanted > value;
            assert_true(value >= output.minimum && value <= output.maximum);
            if (output.slew > 0)
                assert_true(value - last <= output.slew && last - value <= output.slew);
        }
    }
    assert_true(off < 5); /* of 48,000 */
}

/* Tables and values of random bytes: whatever comes out, no sanitizer may object and nothing else is written. */
TEST(unchecked_tables_stay_defined)
{
    unsigned sound = 0;
    draw_from(2);
    for (unsigned round = 0; round < 20000; round++) {
        labial_rig_output_t output;
        labial_rig_curve_t curve;
        const labial_rig_t rig = { &output, 1 };
        uint8_t *bytes = (uint8_t *)&output, *bends = (uint8_t *)&curve;
        int16_t faps[LABIAL_CHANNELS];
        int32_t values[2], changes[2];
        for (unsigned i = 0; i < offsetof(labial_rig_output_t, curve); i++)
            bytes[i] = (uint8_t)(chance() % 3u ? chance() : (chance() % 2u ? 0x80u : 0xffu));
        for (unsigned i = 0; i < sizeof curve; i++)
            bends[i] = (uint8_t)chance();
        output.curve = chance() % 4u ? NULL : &curve;
        for (unsigned i = 0; i < LABIAL_CHANNELS; i++)
            faps[i] = any_fap();
        changes[0] = (int32_t)(chance() & 0x7fffffffu) - (int32_t)(chance() & 0x7fffffffu);
        changes[1] = -77;
        values[0] = (int32_t)(chance() & 0x7fffffffu) - (int32_t)(chance() & 0x7fffffffu);
        values[1] = -77;
        sound += labial_rig_check(&rig) == LABIAL_OK;
        assert_ok(labial_rig_apply(&rig, faps, values));
        assert_ok(labial_rig_apply_ahead(&rig, faps, 1, values, changes));
        assert_ok(labial_rig_rest(&rig, values));
        assert_int_equal(values[1], -77);
        assert_int_equal(changes[1], -77);
    }
    assert_int_equal(sound, 0);
}

/* Behind a sound output, so that a check of the first alone would show. */
#define FAULTY(change)                                                                                                 \
    do {                                                                                                               \
        labial_rig_output_t outputs[2] = { good, good }, *const bad = &outputs[1];                                     \
        const labial_rig_t both = { outputs, 2 };                                                                      \
        change;                                                                                                        \
        assert_int_equal(labial_rig_check(&both), LABIAL_ERROR_RIG);                                                   \
    } while (0)

TEST(check_names_every_fault)
{
    static const labial_rig_curve_t curves[] = { { 0, { { 0, 0, 0 } } },
                                                 { 9, { { 0, 0, 0 } } },
                                                 { 1, { { LABIAL_RIG_VALUE_MAX + 1, 0, 0 } } },
                                                 { 1, { { 0, -LABIAL_RIG_VALUE_MAX - 1, 0 } } },
                                                 { 1, { { 0, 0, LABIAL_RIG_SLOPE_MAX + 1 } } },
                                                 { 2, { { 5, 0, 1 }, { 5, 0, 1 } } } };
    const labial_rig_output_t good = plain();
    const labial_rig_t rig = { &good, 1 };
    assert_ok(labial_rig_check(&rig));
    FAULTY(bad->gain = LABIAL_RIG_GAIN_MAX + 1);
    FAULTY(bad->gain = INT32_MIN);
    FAULTY(bad->neutral = LABIAL_RIG_VALUE_MAX + 1);
    FAULTY(bad->neutral = INT32_MIN);
    FAULTY(bad->minimum = -LABIAL_RIG_VALUE_MAX - 1);
    FAULTY(bad->maximum = LABIAL_RIG_VALUE_MAX + 1);
    FAULTY(bad->minimum = 2001);
    FAULTY(bad->slew = -1);
    FAULTY(bad->slew = LABIAL_RIG_VALUE_MAX + 1);
    FAULTY(bad->invert = 2);
    FAULTY(bad->contact = 2);
    FAULTY(bad->closed = 1500); /* without contact */
    FAULTY(bad->contact = 1; bad->closed = 999);
    FAULTY(bad->contact = 1; bad->closed = 2001);
    FAULTY(bad->deadband = -1);
    FAULTY(bad->deadband = LABIAL_RIG_VALUE_MAX + 1);
    FAULTY(bad->acceleration = -1);
    FAULTY(bad->acceleration = LABIAL_RIG_VALUE_MAX + 1);
    FAULTY(bad->weights[1] = 32767; bad->weights[2] = -32767); /* with 4096: above 65535 */
    FAULTY(bad->weights[1] = bad->weights[2] = INT16_MIN);
    for (unsigned i = 0; i < COUNT_OF(curves); i++)
        FAULTY(bad->curve = &curves[i]);
}

TEST(check_accepts_the_very_limits)
{
    labial_rig_curve_t curve = { LABIAL_RIG_SEGMENTS, { { 0, 0, 0 } } };
    labial_rig_output_t output = plain();
    const labial_rig_t rig = { &output, 1 };
    for (int32_t i = 0; i < LABIAL_RIG_SEGMENTS; i++) {
        curve.segments[i].from = i ? LABIAL_RIG_VALUE_MAX - LABIAL_RIG_SEGMENTS + 1 + i : -LABIAL_RIG_VALUE_MAX;
        curve.segments[i].to = LABIAL_RIG_VALUE_MAX;
        curve.segments[i].slope = -LABIAL_RIG_SLOPE_MAX;
    }
    output.curve = &curve;
    output.weights[0] = 32767;
    output.weights[7] = INT16_MIN; /* 65535 together */
    output.gain = -LABIAL_RIG_GAIN_MAX;
    output.neutral = -LABIAL_RIG_VALUE_MAX;
    output.minimum = -LABIAL_RIG_VALUE_MAX;
    output.maximum = output.slew = output.closed = output.deadband = output.acceleration = LABIAL_RIG_VALUE_MAX;
    output.invert = output.contact = 1;
    assert_ok(labial_rig_check(&rig));
    output.minimum = output.maximum;
    assert_ok(labial_rig_check(&rig));
}

TEST(null_and_empty_are_refused)
{
    const labial_rig_output_t output = plain();
    const labial_rig_t rig = { &output, 1 }, empty = { &output, 0 }, hollow = { NULL, 1 };
    const int16_t faps[LABIAL_CHANNELS] = { 0 };
    int32_t value = 5;
    assert_int_equal(labial_rig_check(NULL), LABIAL_ERROR_NULL);
    assert_int_equal(labial_rig_check(&hollow), LABIAL_ERROR_NULL);
    assert_int_equal(labial_rig_check(&empty), LABIAL_ERROR_RIG);
    assert_int_equal(labial_rig_rest(NULL, &value), LABIAL_ERROR_NULL);
    assert_int_equal(labial_rig_rest(&hollow, &value), LABIAL_ERROR_NULL);
    assert_int_equal(labial_rig_rest(&rig, NULL), LABIAL_ERROR_NULL);
    assert_int_equal(labial_rig_apply(NULL, faps, &value), LABIAL_ERROR_NULL);
    assert_int_equal(labial_rig_apply(&hollow, faps, &value), LABIAL_ERROR_NULL);
    assert_int_equal(labial_rig_apply(&rig, NULL, &value), LABIAL_ERROR_NULL);
    assert_int_equal(labial_rig_apply(&rig, faps, NULL), LABIAL_ERROR_NULL);
    assert_int_equal(labial_rig_apply_visemes(&rig, faps, NULL, NULL), LABIAL_ERROR_NULL);
    assert_ok(labial_rig_apply(&empty, faps, &value));
    assert_int_equal(labial_rig_apply_ahead(NULL, faps, 1, &value, NULL), LABIAL_ERROR_NULL);
    assert_int_equal(labial_rig_apply_ahead(&hollow, faps, 1, &value, NULL), LABIAL_ERROR_NULL);
    assert_int_equal(labial_rig_apply_ahead(&rig, NULL, 1, &value, NULL), LABIAL_ERROR_NULL);
    assert_int_equal(labial_rig_apply_ahead(&rig, faps, 1, NULL, NULL), LABIAL_ERROR_NULL);
    assert_int_equal(value, 5);
    assert_int_equal(sizeof output, sizeof(void *) == 4 ? 68 : 80);
    assert_int_equal(sizeof(labial_rig_curve_t), 100);
}

SUITE(NULL, NULL)
