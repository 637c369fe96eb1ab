/*
 * test_ticks.c - a frame in, a frame out: each tick delivers what was taken up a constant number of ticks before. Told in
 * ticks rather than in time, so that the verdict is the same on every board.
 */
#include "device.h"

#define DELAY LABIAL_DELAY((unsigned)speech_en.search_stride)

static unsigned delivered;

static void count(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)user;
    (void)frame;
    (void)faps;
    delivered++;
}

static void begin(void)
{
    delivered = 0;
    assert_int_equal(LABIAL_OK, labial_init(&device_memory.stream, &speech_en, device_memory.workspace,
                                            DEVICE_WORKSPACE, count, NULL));
}

static void tick(unsigned times, int wanted)
{
    while (times-- > 0)
        assert_int_equal(wanted, labial_tick(&device_memory.stream));
}

/* Would catch a tick that is late or two frames in one: both jerk the face. */
TEST(the_delay_is_constant)
{
    const unsigned frames = 100;
    begin();
    for (unsigned i = 0; i < 10; i++) /* vowels and consonants of ten frames */
        assert_int_equal(
            LABIAL_OK, labial_push(&device_memory.stream, i % 2u ? SPEECH_EN_S : SPEECH_EN_AA, 10000u / SPEECH_EN_FPS));
    assert_int_equal(LABIAL_OK, labial_end(&device_memory.stream));
    assert_int_equal(DELAY, labial_latency(&device_memory.stream).delay);
    tick(DELAY, LABIAL_WAITING);
    tick(frames, LABIAL_OK);
    assert_int_equal(frames, delivered);
    tick(3, LABIAL_DONE);
}

/* Would catch a pause that holds up what comes before it: it is pushed whole when it begins. */
TEST(pauses_hold_nothing_up)
{
    begin();
    assert_int_equal(LABIAL_OK, labial_push(&device_memory.stream, SPEECH_EN_M, 100));
    assert_int_equal(LABIAL_OK, labial_push(&device_memory.stream, SPEECH_EN_SIL, 60000));
    tick(DELAY, LABIAL_WAITING);
    tick(500, LABIAL_OK);
}

/* Would catch a stream that takes silence for the end, or that does not go on after a shortage. */
TEST(a_shortage_is_made_up_for)
{
    begin();
    tick(10, LABIAL_WAITING);
    assert_int_equal(LABIAL_OK, labial_push(&device_memory.stream, SPEECH_EN_AA, 1000));
    tick(10, LABIAL_WAITING); /* what follows is not known */
    assert_int_equal(LABIAL_OK, labial_push(&device_memory.stream, SPEECH_EN_SIL, 1000));
    while (labial_tick(&device_memory.stream) != LABIAL_STARVED)
        assert_true(delivered < 2 * SPEECH_EN_FPS);
    tick(10, LABIAL_STARVED);
    assert_int_equal(LABIAL_OK, labial_end(&device_memory.stream));
    while (delivered < 2 * SPEECH_EN_FPS)
        tick(1, LABIAL_OK);
    tick(3, LABIAL_DONE);
}

int test_ticks(void)
{
    static const struct CMUnitTest tests[] = {
        DEVICE_TEST(the_delay_is_constant),
        DEVICE_TEST(pauses_hold_nothing_up),
        DEVICE_TEST(a_shortage_is_made_up_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
