/*
 * test_ticks.c - a tick does a bounded share of the work, counted in steps of labial_work() rather than in time, so
 * that the verdict is the same on every board.
 */
#include "device.h"

#include <unity.h>

#include "board.h"

/* Frames of the streams that are counted, few enough that all can be ready before the first is delivered. */
#define FRAMES (LABIAL_PREROLL - 1u)

static unsigned delivered;

static void count(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)user;
    (void)frame;
    (void)faps;
    delivered++;
}

/* Starts a stream of FRAMES frames, phonemes of `each` frames; with more than one phoneme in turn an edge and none. */
static void begin(unsigned each)
{
    const uint32_t ms = 1000u / SPEECH_EN_FPS;
    unsigned left = FRAMES, i = 0;
    delivered = 0;
    TEST_ASSERT_EQUAL_INT(LABIAL_OK, labial_init(&device_memory.stream, &speech_en, device_memory.workspace,
                                                 DEVICE_WORKSPACE, count, NULL));
    while (left > 0) {
        const unsigned frames = left < each ? left : each;
        TEST_ASSERT_EQUAL_INT(LABIAL_OK, labial_push(&device_memory.stream, i++ % 2u ? SPEECH_EN_S : SPEECH_EN_AA,
                                                     ms * frames));
        left -= frames;
    }
    TEST_ASSERT_EQUAL_INT(LABIAL_OK, labial_end(&device_memory.stream));
}

/* Steps that are left to do after so many ticks of that stream. */
static unsigned steps_after(unsigned each, unsigned ticks)
{
    unsigned steps = 0;
    begin(each);
    while (ticks-- > 0)
        TEST_ASSERT_EQUAL_INT(LABIAL_BUSY, labial_tick(&device_memory.stream));
    while (labial_work(&device_memory.stream) == LABIAL_OK)
        steps++;
    TEST_ASSERT_EQUAL_UINT(FRAMES, labial_latency(&device_memory.stream).ready);
    return steps;
}

static void check_share(unsigned each)
{
    unsigned ticks = 0, most = 0, steps, before, i;
    begin(each);
    while (labial_tick(&device_memory.stream) == LABIAL_BUSY)
        ticks++;
    TEST_ASSERT_EQUAL_UINT_MESSAGE(1, delivered, "the first tick that is not busy delivers one frame");
    steps = before = steps_after(each, 0);
    for (i = 1; i <= ticks; i++) {
        const unsigned left = steps_after(each, i);
        most = before - left > most ? before - left : most;
        before = left;
    }
    board_print_unsigned(FRAMES);
    board_print(" frames: ");
    board_print_unsigned(steps);
    board_print(" steps in ");
    board_print_unsigned(ticks + 1u);
    board_print(" ticks, at most ");
    board_print_unsigned(most);
    board_put('\n');
    TEST_ASSERT_GREATER_OR_EQUAL_UINT_MESSAGE(FRAMES / 4u, ticks, "the work is shared out to many ticks");
    TEST_ASSERT_LESS_OR_EQUAL_UINT_MESSAGE(FRAMES, ticks, "no more ticks than frames: the work keeps up");
    TEST_ASSERT_LESS_OR_EQUAL_UINT_MESSAGE(3u * ((steps + ticks) / (ticks + 1u)), most, "no tick does far more");
}

/* Would catch a tick that decodes a whole unit at once, and one that falls behind: both are late on a small board. */
static void long_units_are_shared_out(void)
{
    check_share(FRAMES);
}

/* The same for units of two frames, of which many are decoded together. */
static void short_units_are_shared_out(void)
{
    check_share(1);
}

/* Would catch work that is done again and again when there is nothing to do. */
static void waiting_costs_nothing(void)
{
    unsigned i;
    TEST_ASSERT_EQUAL_INT(LABIAL_OK, labial_init(&device_memory.stream, &speech_en, device_memory.workspace,
                                                 DEVICE_WORKSPACE, count, NULL));
    delivered = 0;
    for (i = 0; i < 10; i++) {
        TEST_ASSERT_EQUAL_INT(LABIAL_WAITING, labial_work(&device_memory.stream));
        TEST_ASSERT_EQUAL_INT(LABIAL_WAITING, labial_tick(&device_memory.stream));
    }
    TEST_ASSERT_EQUAL_INT(LABIAL_OK, labial_end(&device_memory.stream));
    TEST_ASSERT_EQUAL_INT(LABIAL_DONE, labial_tick(&device_memory.stream));
    TEST_ASSERT_EQUAL_UINT(0, delivered);
}

void test_ticks(void)
{
    UnitySetTestFile(__FILE__);
    RUN_TEST(long_units_are_shared_out);
    RUN_TEST(short_units_are_shared_out);
    RUN_TEST(waiting_costs_nothing);
}
