/*
 * test_streams.c - the conformance streams of tests/conformance: the same frames as on every target, bit for bit.
 */
#include "device.h"

#include <unity.h>

static void play_all(conformance_feed_t feed)
{
    unsigned i;
    TEST_ASSERT_GREATER_THAN_UINT(0, conformance_stream_count);
    for (i = 0; i < conformance_stream_count; i++) {
        const conformance_stream_t *script = &conformance_streams[i];
        conformance_digest_t digest = { 0, 0 };
        const char *complaint = conformance_play(script, feed, &device_memory.stream, device_memory.workspace,
                                                 DEVICE_WORKSPACE, conformance_digest, &digest);
        if (complaint)
            TEST_FAIL_MESSAGE(complaint);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(script->frames, digest.frames, script->name);
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(script->digest, digest.crc, script->name);
    }
}

/* Would catch any difference of arithmetic, layout or order: see streams.txt for what each stream is for. */
static void filled_streams_conform(void)
{
    play_all(CONFORMANCE_FILL);
}

/* Would catch frames that depend on when phonemes are pushed. */
static void streams_fed_one_by_one_conform(void)
{
    play_all(CONFORMANCE_SINGLE);
}

static void starving_streams_conform(void)
{
    play_all(CONFORMANCE_HUNGRY);
}

/* Would catch frames that depend on what is known when they are taken up. */
static void streams_fed_in_real_time_conform(void)
{
    play_all(CONFORMANCE_REAL_TIME);
}

void test_streams(void)
{
    UnitySetTestFile(__FILE__);
    RUN_TEST(filled_streams_conform);
    RUN_TEST(streams_fed_one_by_one_conform);
    RUN_TEST(starving_streams_conform);
    RUN_TEST(streams_fed_in_real_time_conform);
}
