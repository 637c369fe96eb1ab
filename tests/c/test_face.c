/*
 * test_face.c - the contract of labial/face.h: each part by hand, calls drawn at random against a slow model in double,
 * and real streams that end, starve, are cancelled, go on and change their model.
 */
#include "suite.h"

#include <math.h>
#include <string.h>

#include "fixture.h"
#include "labial/face.h"

enum {
    HOLD = LABIAL_FACE_HOLD,
    EASE = LABIAL_FACE_EASE,
    OUTPUTS = 3,
    AHEAD_MOST = 40,
    JAW_REST = 1400,
    JAW_WIDE = 1900,
    CANARY = -77
};

#define FAP3 0
#define FAP51 3
#define FAP52 4

static labial_face_t face;
static int32_t memory[LABIAL_FACE_SIZE(OUTPUTS, AHEAD_MOST) / 4 + 1];
static labial_rig_output_t outputs[OUTPUTS];
static labial_rig_t rig = { outputs, 1 };
static int32_t values[OUTPUTS + 1];
static fixture_random_t dice;

static uint32_t below(uint32_t limit)
{
    return fixture_below(&dice, limit);
}

static int32_t between(int32_t low, int32_t high)
{
    return low + (int32_t)below((uint32_t)(high - low) + 1u);
}

/* A jaw without limits of its motion: 1400 at rest, 1 unit for each unit of the lips' opening beyond contact. */
static labial_rig_output_t jaw(int32_t slew, int32_t acceleration)
{
    const labial_rig_output_t output = { .weights = { [FAP52] = -LABIAL_RIG_ONE },
                                         .contact = 1,
                                         .gain = LABIAL_RIG_GAIN(1, 1),
                                         .neutral = JAW_REST,
                                         .minimum = JAW_REST,
                                         .maximum = JAW_WIDE,
                                         .slew = slew,
                                         .closed = JAW_REST,
                                         .acceleration = acceleration };
    return output;
}

/* The first tests have one jaw, and begin a face of it. */
static void begin(int32_t slew, int32_t acceleration, unsigned ahead)
{
    outputs[0] = jaw(slew, acceleration);
    rig.count = 1;
    memset(memory, 0xa5, sizeof memory);
    memory[LABIAL_FACE_SIZE(1, ahead) / 4] = CANARY;
    values[1] = CANARY;
    assert_ok(labial_rig_check(&rig));
    assert_ok(labial_face_init(&face, &rig, 50, ahead, memory, LABIAL_FACE_SIZE(1, ahead)));
    assert_int_equal(memory[LABIAL_FACE_SIZE(1, ahead) / 4], CANARY);
}

/* A frame that wants the jaw at `wanted`, 1536 .. 1900 or 1400. */
static void give(int32_t wanted)
{
    int16_t faps[LABIAL_CHANNELS] = { 0 };
    faps[FAP52] = (int16_t)(JAW_REST - wanted);
    labial_face_frame(&face, 12345, faps);
}

/* The jaw in the next tick, which must have that result. */
static int32_t tick(int result)
{
    assert_int_equal(labial_face_tick(&face, values), result);
    assert_int_equal(values[1], CANARY); /* nothing beyond the rig's outputs is written */
    return values[0];
}

/* ---- By hand ----------------------------------------------------------------------------------------------------- */

TEST(face_begins_at_rest)
{
    begin(0, 0, 3);
    for (unsigned i = 0; i < 20; i++)
        assert_int_equal(tick(LABIAL_DONE), JAW_REST);
}

/* Frames come out in their order, `ahead` ticks late, and then the jaw holds and goes to rest. */
TEST(frames_come_out_in_order)
{
    static const unsigned aheads[] = { 0, 1, 2, 7, AHEAD_MOST };
    for (unsigned k = 0; k < COUNT_OF(aheads); k++) {
        const unsigned ahead = aheads[k];
        begin(0, 0, ahead);
        for (unsigned i = 0; i < 100; i++) {
            give(1600 + (int32_t)(i * 37 % 300));
            assert_int_equal(tick(i < ahead ? LABIAL_WAITING : LABIAL_OK),
                             i < ahead ? JAW_REST : 1600 + (int32_t)((i - ahead) * 37 % 300));
        }
        for (unsigned i = 100 - ahead; i < 100; i++)
            assert_int_equal(tick(LABIAL_OK), 1600 + (int32_t)(i * 37 % 300));
        for (unsigned i = 0; i < HOLD; i++)
            assert_int_equal(tick(LABIAL_STARVED), 1600 + 99 * 37 % 300);
        assert_int_equal(memory[LABIAL_FACE_SIZE(1, ahead) / 4], CANARY);
    }
}

/* Holds 5 ticks, then a sixth of the way, a fifth of the rest, ...; says when it has come to rest. */
TEST(face_holds_and_rests)
{
    static const int32_t way[EASE] = { 1650, 1600, 1550, 1500, 1450, 1400 };
    for (unsigned round = 0; round < 2; round++) {
        begin(0, 0, 0);
        give(1600);
        tick(LABIAL_OK);
        give(1700);
        assert_int_equal(tick(LABIAL_OK), 1700);
        if (round == 0) {
            for (unsigned i = 0; i < HOLD; i++)
                assert_int_equal(tick(LABIAL_STARVED), 1700);
        } else {
            give(1900); /* and is not shown */
            assert_ok(labial_face_cancel(&face, 20 * EASE));
        }
        for (unsigned i = 0; i < EASE; i++)
            assert_int_equal(tick(LABIAL_STARVED), way[i]);
        assert_int_equal(tick(LABIAL_DONE), 1400);
        assert_ok(labial_face_cancel(&face, 20 * EASE));
        assert_int_equal(tick(LABIAL_DONE), 1400);
        give(1700); /* and goes on */
        assert_int_equal(tick(LABIAL_OK), 1700);
    }
}

/* What lags behind its frames opens no further when they are cancelled, and closes no more slowly than it can. */
TEST(slow_servo_turns_at_once)
{
    begin(60, 0, 0);
    for (unsigned i = 0; i < 5; i++) {
        give(1900);
        tick(LABIAL_OK);
    }
    assert_int_equal(values[0], 1700);
    labial_face_cancel(&face, 20 * EASE);
    assert_int_equal(tick(LABIAL_STARVED), 1650); /* a sixth of the way */
    begin(60, 0, 0);
    for (unsigned i = 0; i < 5; i++) {
        give(1900);
        tick(LABIAL_OK);
    }
    give(1400);
    assert_int_equal(tick(LABIAL_OK), 1640);
    labial_face_cancel(&face, 20 * EASE);
    assert_int_equal(tick(LABIAL_STARVED), 1580);
}

/* A cancel during the hold ends that, and one on the way to rest begins the way anew, from where the outputs are. */
TEST(cancel_takes_its_time)
{
    begin(0, 0, 0);
    give(1700);
    tick(LABIAL_OK);
    tick(LABIAL_STARVED);
    labial_face_cancel(&face, 20 * EASE);
    assert_int_equal(tick(LABIAL_STARVED), 1650);
    labial_face_cancel(&face, 81); /* five ticks */
    assert_int_equal(tick(LABIAL_STARVED), 1600);
    for (unsigned i = 0; i < 2; i++) {
        labial_face_cancel(&face, i); /* one tick is the least */
        assert_int_equal(tick(LABIAL_STARVED), 1400);
        assert_int_equal(tick(LABIAL_DONE), 1400);
        labial_face_cancel(&face, 1000); /* at rest there is nothing to do */
        assert_int_equal(tick(LABIAL_DONE), 1400);
        give(1700);
        tick(LABIAL_OK);
    }
    labial_face_cancel(&face, UINT32_MAX);
    for (unsigned i = 1; i < LABIAL_CANCEL_MAX; i++)
        tick(LABIAL_STARVED);
    assert_int_equal(tick(LABIAL_STARVED), 1400);
    tick(LABIAL_DONE);
}

/* Frames after a pause wait until as many are known as the face looks ahead; a few, until that many ticks have passed;
 * meanwhile it goes to rest. */
TEST(frames_wait_again_after_a_pause)
{
    begin(0, 0, 4);
    for (unsigned i = 0; i < 5; i++)
        give(1700);
    for (unsigned i = 0; i < 5; i++)
        assert_int_equal(tick(LABIAL_OK), 1700);
    assert_int_equal(tick(LABIAL_STARVED), 1700);
    give(1800);
    give(1801);
    for (unsigned i = 0; i < 4; i++)
        assert_int_equal(tick(LABIAL_WAITING), 1700);
    assert_int_equal(tick(LABIAL_OK), 1800);
    assert_int_equal(tick(LABIAL_OK), 1801);
    for (unsigned i = 0; i < HOLD + 3; i++)
        tick(LABIAL_STARVED);
    give(1900);
    assert_int_equal(tick(LABIAL_WAITING), 1801 - 66 * 4 - 3);
    labial_face_cancel(&face, 20 * EASE); /* what waits is dropped, and the next frame waits as long as the first */
    give(1700);
    for (unsigned i = 0; i < 4; i++)
        tick(LABIAL_WAITING);
    assert_int_equal(tick(LABIAL_OK), 1700);
}

/* A motion that is known whole need not wait, however short. */
TEST(play_does_not_wait)
{
    begin(0, 0, 9);
    assert_ok(labial_face_play(&face)); /* there is nothing */
    give(1700);
    give(1800);
    tick(LABIAL_WAITING);
    assert_ok(labial_face_play(&face));
    assert_int_equal(tick(LABIAL_OK), 1700);
    assert_int_equal(tick(LABIAL_OK), 1800);
    tick(LABIAL_STARVED);
    give(1700);
    tick(LABIAL_WAITING);
}

/* Frames whose time has gone by are passed over, unless they wait for those that follow. */
TEST(skip_passes_over)
{
    begin(0, 0, 3);
    for (int32_t i = 0; i < 3; i++)
        give(1700 + i);
    assert_ok(labial_face_skip(&face, 2));
    tick(LABIAL_WAITING);
    give(1703);
    assert_int_equal(tick(LABIAL_OK), 1700);
    assert_ok(labial_face_skip(&face, 0));
    assert_ok(labial_face_skip(&face, 1));
    assert_int_equal(tick(LABIAL_OK), 1702);
    assert_ok(labial_face_skip(&face, 9));
    assert_int_equal(tick(LABIAL_STARVED), 1702);
}

/* Of more frames than the face looks ahead the oldest are passed over. */
TEST(surplus_passes_the_oldest_over)
{
    begin(0, 0, 2);
    for (int32_t i = 0; i < 9; i++)
        give(1700 + i);
    for (int32_t i = 6; i < 9; i++)
        assert_int_equal(tick(LABIAL_OK), 1700 + i);
    tick(LABIAL_STARVED);
    begin(0, 0, 0);
    give(1700);
    give(1800);
    assert_int_equal(tick(LABIAL_OK), 1800);
    tick(LABIAL_STARVED);
}

/* A slow servo is still open when its source is done; the face goes on. A cancel left it at 1846 of 1400 .. 1900. */
TEST(slow_servo_closes_after_its_source)
{
    for (unsigned round = 0; round < 2; round++) {
        unsigned ticks = 0;
        begin(20, round ? 5 : 0, 0);
        for (unsigned i = 0; i < 60; i++) {
            give(1900);
            tick(LABIAL_OK);
        }
        assert_int_equal(values[0], 1900);
        give(JAW_REST); /* labial_cancel() with 0 milliseconds */
        tick(LABIAL_OK);
        assert_true(values[0] > 1800);
        for (; labial_face_tick(&face, values) != LABIAL_DONE; ticks++)
            assert_true(ticks < 60);
        assert_int_equal(values[0], JAW_REST);
        assert_in_range(ticks, 24, round ? 34 : 26);
    }
}

/* With `deadband` a value stays where it would change little, but at the end it is at rest all the same. */
TEST(deadband_does_not_keep_it_from_rest)
{
    begin(0, 0, 0);
    outputs[0].deadband = 150;
    give(1700);
    tick(LABIAL_OK);
    give(1600);
    assert_int_equal(tick(LABIAL_OK), 1700);
    for (unsigned i = 0; i < 2 * HOLD; i++) {
        give(1560);
        assert_int_equal(tick(LABIAL_OK), 1700);
    }
    for (unsigned i = 1; i < HOLD + EASE; i++)
        assert_true(tick(LABIAL_STARVED) >= 1530);
    assert_int_equal(tick(LABIAL_STARVED), JAW_REST);
    tick(LABIAL_DONE);
}

/* Values instead of FAPs go the same way. */
TEST(values_are_frames)
{
    static const int32_t wanted[] = { 1450, 99999, -99999, 1600 };
    static const int32_t shown[] = { 1450, 1510, 1450, 1510 };
    begin(60, 0, 0);
    for (unsigned i = 0; i < 4; i++) {
        assert_ok(labial_face_values(&face, &wanted[i]));
        assert_int_equal(tick(LABIAL_OK), shown[i]);
    }
}

/* An output that follows sounds does so within the same limits, and goes to rest like any other. */
TEST(sounds_move_it)
{
    static const int16_t amounts[LABIAL_VISEMES] = { [LABIAL_VISEME_TH] = 128 };
    static const int16_t faps[LABIAL_CHANNELS] = { 0 };
    const uint8_t shares[LABIAL_VISEMES] = { [LABIAL_VISEME_TH] = 100 };
    begin(60, 0, 0);
    outputs[0].visemes = amounts;
    outputs[0].contact = 0;
    outputs[0].closed = 0;
    outputs[0].neutral = JAW_REST;
    assert_ok(labial_face_visemes(&face, faps, shares));
    assert_int_equal(tick(LABIAL_OK), JAW_REST + 60);
    assert_ok(labial_face_visemes(&face, faps, shares));
    assert_int_equal(tick(LABIAL_OK), JAW_REST + 100);
    assert_ok(labial_face_visemes(&face, faps, NULL));
    assert_int_equal(tick(LABIAL_OK), JAW_REST + 40);
    for (unsigned i = 0; i < HOLD + EASE && labial_face_tick(&face, values) != LABIAL_DONE; i++)
        assert_in_range(values[0], JAW_REST, JAW_REST + 40);
    assert_int_equal(values[0], JAW_REST);
    assert_int_equal(labial_face_visemes(&face, NULL, shares), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_visemes(NULL, faps, shares), LABIAL_ERROR_NULL);
    memset(&face, 0, sizeof face);
    assert_int_equal(labial_face_visemes(&face, faps, shares), LABIAL_ERROR_STATE);
}

/* Outputs with limits see as far as labial_rig_apply_ahead() with the same frames. */
TEST(look_ahead_is_that_of_the_rig)
{
    dice.state = fixture_seed(7);
    for (unsigned round = 0; round < FIXTURE_ROUNDS(60); round++) {
        int16_t frames[120][LABIAL_CHANNELS] = { { 0 } };
        const unsigned ahead = below(AHEAD_MOST + 1u);
        int32_t value = JAW_REST, change = 0;
        begin(between(20, 200), round % 2 ? between(3, 60) : 0, ahead);
        for (unsigned i = 0; i < 120; i++) {
            frames[i][FAP52] = (int16_t)(i % 11u < 3u ? -between(0, 72) : -between(137, 500));
            frames[i][FAP51] = (int16_t)between(-5, 0);
            frames[i][FAP52] = (int16_t)(frames[i][FAP52] - frames[i][FAP51]);
        }
        for (unsigned i = 0; i < 120 + ahead; i++) {
            if (i < 120)
                labial_face_frame(&face, i, frames[i]);
            labial_face_tick(&face, values);
            if (i >= ahead) {
                const unsigned left = 120u + ahead - i;
                const unsigned known = left < ahead + 1u ? left : ahead + 1u;
                labial_rig_apply_ahead(&rig, frames[i - ahead], (uint16_t)known, &value, &change);
                assert_int_equal(values[0], value);
            }
        }
    }
}

/* Outputs follow one after the other, each in the time that it is given. */
TEST(soft_start_attaches_one_by_one)
{
    outputs[0] = outputs[1] = outputs[2] = jaw(0, 0);
    outputs[2].acceleration = 100;
    rig.count = 3;
    assert_ok(labial_face_init(&face, &rig, 50, 1, memory, sizeof memory));
    assert_int_equal(labial_face_attached(&face), 3);
    assert_ok(labial_face_soft_start(&face, 4));
    for (unsigned i = 0; i < 20; i++) {
        const unsigned attached = 1 + i / 4;
        assert_int_equal(labial_face_attached(&face), attached < 3 ? attached : 3);
        give(1800);
        labial_face_tick(&face, values);
        for (unsigned k = 0; k < 2; k++)
            assert_int_equal(values[k], i >= 1 && i >= 4 * (k + 1) ? 1800 : JAW_REST);
        assert_true(i < 12 ? values[2] == JAW_REST : values[2] > JAW_REST);
    }
    labial_face_soft_start(&face, 0);
    for (unsigned i = 1; i <= 4; i++) {
        assert_int_equal(labial_face_attached(&face), i < 3 ? i : 3);
        labial_face_tick(&face, values);
    }
    labial_face_soft_start(&face, 1000);
    for (unsigned i = 0; i < 300; i++) {
        assert_int_equal(labial_face_attached(&face), i < 255 ? 1 : 2);
        labial_face_tick(&face, values);
    }
}

/* A place that is told is where the next motion begins, and ends a soft start. */
TEST(place_is_where_it_begins)
{
    static const int32_t there = 1700, far = 99999;
    begin(60, 0, 0);
    labial_face_soft_start(&face, 9);
    assert_ok(labial_face_place(&face, &there));
    assert_int_equal(labial_face_attached(&face), 1);
    assert_int_equal(tick(LABIAL_STARVED), 1640);
    give(1900);
    assert_int_equal(tick(LABIAL_OK), 1700);
    labial_face_place(&face, &far);
    assert_int_equal(tick(LABIAL_STARVED), 1900);
}

TEST(errors_change_nothing)
{
    static const labial_rig_t none = { outputs, 0 }, empty = { NULL, 1 };
    static const int16_t faps[LABIAL_CHANNELS] = { 0 };
    labial_face_t never;
    int32_t value = CANARY;
    memset(&never, 0, sizeof never);
    begin(0, 0, 3);
    assert_int_equal(labial_face_init(NULL, &rig, 50, 0, memory, sizeof memory), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_init(&face, NULL, 50, 0, memory, sizeof memory), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_tick(&face, &value), LABIAL_ERROR_STATE);
    assert_int_equal(labial_face_init(&face, &empty, 50, 0, memory, sizeof memory), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_init(&face, &rig, 50, 0, NULL, sizeof memory), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_init(&face, &none, 50, 0, memory, sizeof memory), LABIAL_ERROR_RIG);
    assert_int_equal(labial_face_init(&face, &rig, 0, 0, memory, sizeof memory), LABIAL_ERROR_FRAME_RATE);
    assert_int_equal(labial_face_init(&face, &rig, 1001, 0, memory, sizeof memory), LABIAL_ERROR_FRAME_RATE);
    assert_int_equal(labial_face_init(&face, &rig, 50, LABIAL_FACE_AHEAD_MAX + 1, memory, sizeof memory),
                     LABIAL_ERROR_RANGE);
    assert_int_equal(labial_face_init(&face, &rig, 50, 3, memory, LABIAL_FACE_SIZE(1, 3) - 1), LABIAL_ERROR_WORKSPACE);
    labial_face_frame(NULL, 0, faps);
    labial_face_frame(&never, 0, faps);
    assert_int_equal(labial_face_values(&never, &value), LABIAL_ERROR_STATE);
    assert_int_equal(labial_face_values(NULL, &value), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_values(&never, NULL), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_tick(NULL, &value), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_tick(&never, NULL), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_tick(&never, &value), LABIAL_ERROR_STATE);
    assert_int_equal(labial_face_play(NULL), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_play(&never), LABIAL_ERROR_STATE);
    assert_int_equal(labial_face_skip(NULL, 1), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_skip(&never, 1), LABIAL_ERROR_STATE);
    assert_int_equal(labial_face_cancel(NULL, 0), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_cancel(&never, 0), LABIAL_ERROR_STATE);
    assert_int_equal(labial_face_soft_start(NULL, 1), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_soft_start(&never, 1), LABIAL_ERROR_STATE);
    assert_int_equal(labial_face_attached(NULL), 0);
    assert_int_equal(labial_face_attached(&never), 0);
    assert_int_equal(labial_face_place(NULL, &value), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_place(&never, &value), LABIAL_ERROR_STATE);
    assert_int_equal(labial_face_place(&never, NULL), LABIAL_ERROR_NULL);
    assert_int_equal(labial_face_due(NULL, 0), 0);
    assert_int_equal(labial_face_due(&never, 0), 0);
    assert_int_equal(value, CANARY);
    begin(0, 0, 3);
    labial_face_frame(&face, 0, NULL);
    assert_int_equal(tick(LABIAL_DONE), JAW_REST);
}

/* ---- The clock --------------------------------------------------------------------------------------------------- */

/* Once per period, wherever the counter begins and wraps, and on time for rates that do not divide a second. */
TEST(clock_keeps_its_rate)
{
    static const uint32_t starts[] = { 0, 0x7ffffff0u, 0x80000000u, 0xfffffc18u, 0xffffffffu };
    static const unsigned rates[] = { 1, 7, 24, 25, 30, 50, 60, 300, 999, 1000 };
    for (unsigned s = 0; s < COUNT_OF(starts); s++) {
        for (unsigned r = 0; r < COUNT_OF(rates); r++) {
            begin(0, 0, 0);
            assert_ok(labial_face_init(&face, &rig, rates[r], 0, memory, sizeof memory));
            uint32_t count = 0;
            for (uint32_t ms = 0; ms < 10000; ms++) {
                while (labial_face_due(&face, starts[s] + ms)) {
                    give(1900);
                    assert_int_equal(tick(LABIAL_OK), 1900);
                    count++;
                }
                /* Tick n is due at n * 1000 / rate, up to a millisecond early. */
                assert_in_range(count, ms * rates[r] / 1000 + 1, (ms + 1) * rates[r] / 1000 + 1);
            }
        }
    }
}

/* How many ticks are due at a time, and how far the jaw moves in them, 10 units in each. */
static unsigned due_at(uint32_t now, int32_t *moved)
{
    const int32_t before = values[0];
    unsigned count = 0;
    for (; labial_face_due(&face, now); count++) {
        give(1900);
        tick(LABIAL_OK);
        assert_true(count < 60);
    }
    *moved = values[0] - before;
    return count;
}

/* After a delay the source catches up, and the jaw moves by one tick. */
TEST(clock_catches_up)
{
    int32_t moved;
    begin(10, 0, 0);
    tick(LABIAL_DONE);
    assert_int_equal(due_at(5000, &moved), 1);
    assert_int_equal(moved, 10);
    assert_int_equal(due_at(5019, &moved), 0);
    assert_int_equal(due_at(5020, &moved), 1);
    assert_int_equal(due_at(5199, &moved), 8);
    assert_int_equal(moved, 10);
    assert_int_equal(due_at(5200, &moved), 1); /* a millisecond later: too soon to move */
    assert_int_equal(moved, 0);
    assert_int_equal(due_at(5229, &moved), 1);
    assert_int_equal(moved, 10);
    assert_int_equal(due_at(6220, &moved), 50);
    assert_int_equal(moved, 10);
    assert_int_equal(due_at(7241, &moved), 1); /* 1,001 ms late: begins anew */
    assert_int_equal(moved, 10);
    assert_int_equal(due_at(7260, &moved), 0);
    assert_int_equal(due_at(7261, &moved), 1);
    assert_int_equal(due_at(7240, &moved), 1); /* back */
    assert_int_equal(due_at(7259, &moved), 0);
    assert_int_equal(due_at(7260, &moved), 1);
    assert_int_equal(due_at(7260u - 0x7fffffffu, &moved), 1);
    assert_int_equal(due_at(7260u - 0x7fffffffu + 19u, &moved), 0);
    assert_int_equal(due_at(7260u - 0x7fffffffu + 20u, &moved), 1);
}

/* A program that is always too slow still moves its servos, in every round. */
TEST(clock_of_a_slow_program)
{
    begin(10, 0, 0);
    tick(LABIAL_DONE);
    for (uint32_t now = 0; now < 3000; now += 31) {
        const int32_t before = values[0];
        assert_true(labial_face_due(&face, now));
        give(1900);
        tick(LABIAL_OK);
        assert_int_equal(values[0], before + 10 < 1900 ? before + 10 : 1900);
    }
}

/* ---- Random calls, against a slow model in double ------------------------------------------------------------------ */

typedef struct {
    double frames[4096][OUTPUTS];
    long arrival[4096];
    size_t head, tail;
    long now;   /* ticks so far */
    long since; /* the tick at which the frames that wait began to */
    int plays;
    long silent; /* ticks without a frame, of which a cancel may skip the first */
    long left;   /* ticks of the way to rest */
    double wanted[OUTPUTS], value[OUTPUTS], change[OUTPUTS];
    long start, apart; /* of the soft start: its tick, and ticks from one output to the next, 0 for none */
    unsigned ahead;
} model_t;

static model_t model;

static double limited(double value, double low, double high)
{
    return value < low ? low : value > high ? high : value;
}

static double resting(const labial_rig_output_t *output)
{
    return limited(output->contact ? output->closed : output->neutral, output->minimum, output->maximum);
}

/* The header's equations; all sums and products of these rigs are exact. */
static double meant(const labial_rig_output_t *output, const int16_t faps[LABIAL_CHANNELS])
{
    double move = 0, value;
    for (unsigned i = 0; i < LABIAL_CHANNELS; i++)
        move += (double)output->weights[i] / 4096.0 * faps[i];
    move = floor(move * output->gain / 65536.0 + 0.5);
    value = limited(output->neutral + (output->invert ? -move : move), output->minimum, output->maximum);
    if (output->contact)
        value =
            floor(value + (output->closed - value) * limited((136.0 + faps[FAP51] + faps[FAP52]) / 64.0, 0, 1) + .5);
    return value;
}

static void model_begin(unsigned ahead)
{
    memset(&model, 0, sizeof model);
    model.ahead = ahead;
    model.silent = HOLD + 1;
    for (unsigned i = 0; i < rig.count; i++)
        model.value[i] = model.wanted[i] = resting(&outputs[i]);
}

static void model_frame(const double *wanted)
{
    if (model.head == model.tail)
        model.since = model.now;
    if (model.tail == 4096) { /* room at the end */
        memmove(model.frames, model.frames + model.head, (model.tail - model.head) * sizeof model.frames[0]);
        model.tail -= model.head;
        model.head = 0;
    }
    memcpy(model.frames[model.tail++], wanted, rig.count * sizeof *wanted);
    if (model.tail - model.head > model.ahead + 1u)
        model.head++;
}

static void model_cancel(uint32_t ms)
{
    model.head = model.tail;
    if (model.silent < HOLD)
        model.silent = HOLD;
    if (model.left > 0)
        model.left = (long)limited(ceil(ms / 20.0), 1, 1000);
}

static void model_skip(unsigned count)
{
    for (; count > 0 && model.plays && model.head < model.tail; count--)
        model.head++;
}

static int model_follows(unsigned output)
{
    return model.apart == 0 || model.now - model.start >= model.apart * (long)(output + 1u);
}

/* A tick; outputs with a limit of acceleration are left to the caller. */
static void model_tick(int moves)
{
    const size_t held = model.tail - model.head;
    model.plays = held > 0 && (model.plays || held > model.ahead || model.now - model.since >= (long)model.ahead);
    model.silent = model.plays ? 0 : model.silent < HOLD + 1 ? model.silent + 1 : model.silent;
    if (model.plays)
        model.left = EASE;
    const long left = model.left;
    if (model.silent > HOLD && model.left > 0)
        model.left--;
    for (unsigned i = 0; i < rig.count; i++) {
        const labial_rig_output_t *output = &outputs[i];
        const double rest = resting(output);
        double wanted, step;
        if (model.plays) {
            model.wanted[i] = model.frames[model.head][i];
        } else if (model.silent > HOLD && left > 0) {
            if (fabs(rest - model.value[i]) < fabs(rest - model.wanted[i]))
                model.wanted[i] = model.value[i];
            step = floor(fabs(rest - model.wanted[i]) / (double)left);
            model.wanted[i] += model.wanted[i] < rest ? step : -step;
        }
        wanted = model.wanted[i];
        const int rests = !model_follows(i) || model.left == 0;
        if (rests)
            wanted = rest;
        else if (model.plays && output->contact && output->slew > 0)
            for (size_t k = 0; k < held; k++)
                if (model.frames[model.head + k][i] - output->closed == 0) {
                    wanted = limited(wanted, output->closed - (double)k * output->slew,
                                     output->closed + (double)k * output->slew);
                    break;
                }
        step = wanted - model.value[i];
        if (fabs(wanted - rest) > 0 && fabs(step) < output->deadband)
            step = 0;
        if (output->slew > 0)
            step = limited(step, -output->slew, output->slew);
        if (moves && output->acceleration == 0)
            model.value[i] += step;
    }
    if (model.plays)
        model.head++;
    model.now++;
}

/* A checked output whose FAPs are exact in double: of a servo mostly, or with numbers as large as can be. */
static labial_rig_output_t any_output(void)
{
    labial_rig_output_t output = { 0 };
    const int32_t most = below(6) ? 3000 : LABIAL_RIG_VALUE_MAX;
    output.weights[FAP3] = (int16_t)between(-4096, 4096);
    output.weights[FAP52] = (int16_t)between(-8192, 8192);
    output.gain = between(-(1 << 21), 1 << 21) >> below(12);
    output.minimum = between(-most, most);
    output.maximum = between(output.minimum, most);
    output.neutral = between(-most, most);
    output.invert = (uint8_t)below(2);
    output.contact = (uint8_t)below(2);
    output.closed = output.contact ? between(output.minimum, output.maximum) : 0;
    output.slew = below(4) ? 1 + (int32_t)below(1u << (1u + below(most > 3000 ? 23 : 9))) : 0;
    output.deadband = below(3) ? 0 : (int32_t)below(40);
    output.acceleration = below(2) ? 1 + (int32_t)below(1u << (1u + below(most > 3000 ? 23 : 7))) : 0;
    return output;
}

/* Long enough for every output to come to rest, by the header. */
static uint32_t time_to_rest(unsigned ahead)
{
    int32_t most = 0;
    for (unsigned i = 0; i < rig.count; i++) {
        const int32_t travel =
            LABIAL_FACE_TRAVEL(outputs[i].maximum - outputs[i].minimum, outputs[i].slew, outputs[i].acceleration);
        most = travel > most ? travel : most;
    }
    return ahead + HOLD + EASE + (uint32_t)most;
}

static int32_t last[OUTPUTS], before[OUTPUTS];

/* One tick of face and model, in which the outputs move or not; what is promised of each. */
static int tick_both(int moves)
{
    const int result = labial_face_tick(&face, values);
    const int waits = model.tail > model.head;
    int rests = 1;
    assert_true(result >= 0);
    model_tick(moves);
    for (unsigned i = 0; i < rig.count; i++) {
        const labial_rig_output_t *output = &outputs[i];
        const int32_t change = values[i] - last[i];
        assert_true(values[i] >= output->minimum && values[i] <= output->maximum);
        assert_true(output->slew == 0 || (change <= output->slew && change >= -output->slew));
        if (moves && output->acceleration)
            assert_true(change - before[i] <= output->acceleration && before[i] - change <= output->acceleration);
        if (output->acceleration)
            model.value[i] = values[i];
        if (fabs(model.value[i] - values[i]) > 0)
            fail_msg("output %u, tick %ld: %ld instead of %.0f", i, model.now, (long)values[i], model.value[i]);
        if (moves)
            before[i] = change;
        else
            assert_int_equal(change, 0);
        rests = rests && fabs(resting(output) - values[i]) == 0;
        last[i] = values[i];
    }
    assert_int_equal(values[rig.count], CANARY);
    assert_true(result != LABIAL_DONE || (rests && !waits));
    assert_int_equal(result == LABIAL_OK, model.plays);
    assert_int_equal(result == LABIAL_WAITING, waits && !model.plays);
    return result;
}

/* The clock in 64 bits: whether a tick is due, and whether outputs move in it. */
static int64_t now, due, moved_at;
static int is_timed;

static int model_due(int *moves)
{
    if (is_timed && now < due && due - now <= 21)
        return 0;
    if (!is_timed || now < due || now - due > 1000) {
        due = now;
        moved_at = now - 20;
    }
    is_timed = 1;
    due += 20;
    *moves = now - moved_at >= 10;
    moved_at = *moves ? now : moved_at;
    return 1;
}

static void any_frame(void)
{
    double wanted[OUTPUTS];
    if (below(4)) {
        int16_t faps[LABIAL_CHANNELS] = { 0 };
        const int32_t most = below(8) ? 500 : INT16_MAX;
        if (below(5)) {
            faps[FAP3] = (int16_t)between(-most, most);
            faps[FAP51] = (int16_t)between(-most, most);
            faps[FAP52] = (int16_t)between(-most, most);
        }
        for (unsigned i = 0; i < rig.count; i++)
            wanted[i] = meant(&outputs[i], faps);
        labial_face_frame(&face, fixture_random(&dice), faps);
    } else {
        int32_t numbers[OUTPUTS];
        for (unsigned i = 0; i < rig.count; i++) {
            numbers[i] = below(9) ? between(outputs[i].minimum, outputs[i].maximum)
                                  : (int32_t)(fixture_random(&dice) & 0x7fffffffu) - 0x40000000;
            wanted[i] = limited(numbers[i], outputs[i].minimum, outputs[i].maximum);
        }
        assert_ok(labial_face_values(&face, numbers));
    }
    model_frame(wanted);
}

/* Any calls in any order: what was promised holds in every tick, and once nothing more comes, everything rests in time. */
TEST(contract_holds_for_all_calls)
{
    static uint32_t rests;
    dice.state = fixture_seed(11);
    for (unsigned round = 0; round < FIXTURE_ROUNDS(700); round++) {
        const unsigned ahead = below(3) ? below(8) : below(AHEAD_MOST + 1u);
        rig.count = (uint16_t)(1u + below(OUTPUTS));
        for (unsigned i = 0; i < rig.count; i++)
            outputs[i] = any_output();
        assert_ok(labial_rig_check(&rig));
        const size_t size = LABIAL_FACE_SIZE(rig.count, ahead);
        memset(memory, 0xa5, sizeof memory);
        memory[size / 4] = CANARY;
        values[rig.count] = CANARY;
        assert_ok(labial_face_init(&face, &rig, 50, ahead, memory, size));
        model_begin(ahead);
        labial_rig_rest(&rig, last);
        memset(before, 0, sizeof before);
        now = below(2) ? fixture_random(&dice) : UINT32_MAX - 200;
        is_timed = 0;
        for (unsigned phase = 0; phase < 6; phase++) {
            const unsigned steady = below(4); /* a source that is never late, or one that often is */
            for (unsigned call = 0; call < 80; call++) {
                const unsigned late = below(6);
                uint32_t slow;
                switch (steady ? 0 : below(26)) {
                case 25:
                    assert_ok(labial_face_play(&face));
                    model.plays = model.plays || model.tail > model.head;
                    break;
                case 24:
                    assert_ok(labial_face_skip(&face, late));
                    model_skip(late);
                    break;
                case 20:
                    slow = late < 5 ? late * late * 13 : UINT32_MAX;
                    assert_ok(labial_face_cancel(&face, slow));
                    model_cancel(slow);
                    break;
                case 21:
                    model.apart = between(1, 30);
                    model.start = model.now;
                    assert_ok(labial_face_soft_start(&face, (unsigned)model.apart));
                    break;
                case 22:
                    for (unsigned i = 0; i < rig.count; i++) {
                        last[i] = between(outputs[i].minimum, outputs[i].maximum);
                        before[i] = 0;
                        model.value[i] = last[i];
                    }
                    model.apart = 0;
                    assert_ok(labial_face_place(&face, last));
                    break;
                case 23:
                    for (unsigned burst = below(2 * ahead + 3); burst > 0; burst--)
                        any_frame();
                    break;
                case 19: /* a clock that stands still, goes on and jumps far, forward and back */
                    now += below(2)   ? (int64_t)below(60)
                           : below(2) ? (int64_t)below(1200)
                                      : between(-(1 << 29), 1 << 29);
                    int moves = 1;
                    assert_int_equal(labial_face_due(&face, (uint32_t)now), model_due(&moves));
                    tick_both(moves);
                    break;
                default:
                    if (steady || below(3))
                        any_frame();
                    tick_both(1);
                }
            }
            /* Nothing more comes. */
            const uint32_t most = time_to_rest(ahead) + (uint32_t)(model.apart * (long)rig.count);
            if (most > 20000) /* a servo that takes hours */
                continue;
            const uint32_t longer = model.left > EASE ? (uint32_t)model.left : 0;
            uint32_t ticks = 0;
            while (tick_both(1) != LABIAL_DONE)
                assert_true(++ticks <= most + longer);
            rests++;
            for (unsigned i = 0; i < 3; i++)
                assert_int_equal(tick_both(1), LABIAL_DONE);
        }
        assert_int_equal(memory[size / 4], CANARY);
    }
    assert_true(rests > FIXTURE_ROUNDS(700));
}

/* A table that was not checked: whatever comes out, no sanitizer may object and nothing else is written. */
TEST(unchecked_rigs_stay_defined)
{
    dice.state = fixture_seed(3);
    for (unsigned round = 0; round < FIXTURE_ROUNDS(3000); round++) {
        uint8_t *bytes = (uint8_t *)outputs;
        rig.count = 1;
        for (unsigned i = 0; i < offsetof(labial_rig_output_t, curve); i++)
            bytes[i] = (uint8_t)(below(3) ? below(256) : below(2) ? 0x80 : 0xff);
        outputs[0].curve = NULL;
        values[1] = CANARY;
        assert_ok(labial_face_init(&face, &rig, 1u + below(1000), 3, memory, sizeof memory));
        for (unsigned i = 0; i < 20; i++) {
            int32_t any = (int32_t)(fixture_random(&dice) & 0x7fffffffu) - (int32_t)below(0x7fffffff);
            give((int32_t)below(3000));
            labial_face_values(&face, &any);
            if (below(8) == 0)
                labial_face_place(&face, &any);
            labial_face_due(&face, fixture_random(&dice));
            labial_face_tick(&face, values);
            assert_int_equal(values[1], CANARY);
        }
    }
}

/* ---- Streams ----------------------------------------------------------------------------------------------------- */

static fixture_model_t speech, laughter;
static labial_t stream;
static uint32_t workspace[4096];

/* Ticks of the stream and the face until the face rests: as many as that takes, which is bounded. */
static unsigned until_rest(void)
{
    unsigned ticks = 0;
    int result = LABIAL_OK;
    while (result != LABIAL_DONE || labial_latency(&stream).frames > 0) {
        const int32_t was = values[0];
        assert_true(labial_tick(&stream) >= 0);
        result = labial_face_tick(&face, values);
        assert_true(values[0] - was <= 25 && was - values[0] <= 25);
        assert_true(++ticks < 400);
    }
    assert_int_equal(values[0], JAW_REST);
    return ticks;
}

/* Whatever becomes of a stream, the jaw closes: its end, hunger, a cancel of any length, a restart, another model, and a
 * stream that is just no longer ticked. */
TEST(streams_always_close)
{
    unsigned wide = 0;
    dice.state = fixture_seed(5);
    fixture_rich(&speech);
    fixture_laughter(&laughter);
    for (unsigned round = 0; round < FIXTURE_ROUNDS(200); round++) {
        begin(25, round % 2 ? 8 : 0, below(12));
        outputs[0].gain = LABIAL_RIG_GAIN(4, 1);
        assert_ok(labial_init(&stream, &speech.model, workspace, sizeof workspace, labial_face_frame, &face));
        labial_face_tick(&face, values);
        for (unsigned turn = 0; turn < 4; turn++) {
            const unsigned phonemes = 1 + below(6);
            for (unsigned i = 0; i < phonemes; i++)
                assert_ok(labial_push(&stream, below(4), 60 + below(300)));
            for (unsigned left = 10 + below(40); left > 0; left--) {
                assert_true(labial_tick(&stream) >= 0);
                labial_face_tick(&face, values);
                wide += values[0] > JAW_REST + 200;
            }
            switch (below(5)) {
            case 0:
                labial_end(&stream);
                until_rest();
                break;
            case 1:
                labial_cancel(&stream, below(2) ? 0 : below(320));
                if (below(2))
                    labial_face_cancel(&face, 20 * EASE);
                until_rest();
                break;
            case 2: /* starves, for as long as it takes */
                for (unsigned i = 0; i < 200; i++) {
                    labial_tick(&stream);
                    labial_face_tick(&face, values);
                }
                assert_int_equal(labial_face_tick(&face, values), LABIAL_DONE);
                labial_end(&stream);
                until_rest();
                break;
            case 3: /* stops */
                for (unsigned i = 0; i < 100; i++)
                    labial_face_tick(&face, values);
                assert_int_equal(labial_face_tick(&face, values), LABIAL_DONE);
                labial_init(&stream, &speech.model, workspace, sizeof workspace, labial_face_frame, &face);
                continue;
            default:
                assert_ok(labial_use(&stream, &laughter.model));
                assert_ok(labial_push(&stream, FIXTURE_HA, 200));
                labial_end(&stream);
                until_rest();
                assert_ok(labial_restart(&stream));
                assert_ok(labial_use(&stream, &speech.model));
                continue;
            }
            assert_ok(labial_restart(&stream));
        }
    }
    assert_true(wide > FIXTURE_ROUNDS(200));
}

SUITE(NULL, NULL)
