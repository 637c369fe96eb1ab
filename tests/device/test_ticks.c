/*
 * test_ticks.c - a frame in, a frame out: each tick delivers what was taken up a constant number of ticks before. Told in
 * ticks rather than in time, so that the verdict is the same on every board.
 */
#include "device.h"

#define DELAY LABIAL_DELAY((unsigned)speech_en.search_stride)

static unsigned delivered;
static int16_t jaw; /* of the last of them */

static void count(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)user;
    (void)frame;
    jaw = faps[0];
    delivered++;
}

static void begin(void)
{
    delivered = 0;
    ASSERT_RESULT(LABIAL_OK, labial_init(&device_memory.stream, &speech_en, device_memory.workspace, DEVICE_WORKSPACE,
                                         count, NULL));
    ASSERT_RESULT(LABIAL_OK, labial_exact(&device_memory.stream, 1));
}

static void tick(unsigned times, int wanted)
{
    while (times-- > 0)
        ASSERT_RESULT(wanted, labial_tick(&device_memory.stream));
}

/* Would catch a tick that is late or two frames in one: both jerk the face. */
static void the_delay_is_constant(void)
{
    const unsigned frames = 100;
    begin();
    for (unsigned i = 0; i < 10; i++) /* vowels and consonants of ten frames */
        ASSERT_RESULT(LABIAL_OK,
                      labial_push(&device_memory.stream, i % 2u ? SPEECH_EN_S : SPEECH_EN_AA, 10000u / SPEECH_EN_FPS));
    ASSERT_RESULT(LABIAL_OK, labial_end(&device_memory.stream));
    TEST_ASSERT_EQUAL_UINT32(DELAY, labial_latency(&device_memory.stream).delay);
    tick(DELAY, LABIAL_WAITING);
    tick(frames, LABIAL_OK);
    TEST_ASSERT_EQUAL_UINT32(frames, delivered);
    tick(3, LABIAL_DONE);
}

/* Would catch a mouth that stays open. */
static void the_end_is_rest(void)
{
    begin();
    ASSERT_RESULT(LABIAL_OK, labial_exact(&device_memory.stream, 0));
    ASSERT_RESULT(LABIAL_OK, labial_push(&device_memory.stream, SPEECH_EN_AA, 10000u / SPEECH_EN_FPS));
    ASSERT_RESULT(LABIAL_OK, labial_end(&device_memory.stream));
    tick(DELAY, LABIAL_WAITING);
    tick(10, LABIAL_OK);
    TEST_ASSERT_TRUE(jaw > 50);
    tick(LABIAL_EASE_FRAMES, LABIAL_OK);
    TEST_ASSERT_EQUAL_INT32(0, jaw);
    tick(3, LABIAL_DONE);
}

void test_ticks(void)
{
    Unity.TestFile = __FILE__;
    RUN_TEST(the_delay_is_constant);
    RUN_TEST(the_end_is_rest);
}
