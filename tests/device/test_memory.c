/*
 * test_memory.c - the library keeps to the memory that it was given, wherever that lies, and to little of the stack.
 */
#include "device.h"

/* Stack that the deepest call of the library may take, with the player's and the callback's own, and what a tick alone
 * may; bytes. */
#define STACK_LIMIT 1024u
#define TICK_STACK_LIMIT 512u

/* Phonemes of speech in the queue, the rest being laughter. */
#define SPOKEN (LABIAL_QUEUE * 3u / 4u)

static void ignore(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)user;
    (void)frame;
    (void)faps;
}

/* Would catch a workspace whose parts overlap or end elsewhere than LABIAL_WORKSPACE_SIZE says: canaries are checked
 * after every test. The streams are those that fill the queue and the rings. */
static void fullest_streams_stay_inside(void)
{
    static const char *const names[] = { "queue", "long_vowel", "switch_in_long", "turns", "one_frame", "cancelled" };
    for (unsigned i = 0; i < sizeof names / sizeof names[0]; i++)
        for (unsigned feed = 0; feed < CONFORMANCE_FEEDS; feed++) {
            const conformance_stream_t *script = device_stream(names[i]);
            TEST_ASSERT_NULL(conformance_play(script, (conformance_feed_t)feed, &device_memory.stream,
                                              device_memory.workspace, DEVICE_WORKSPACE, ignore, NULL));
            TEST_ASSERT_TRUE_MESSAGE(device_memory_is_whole(), names[i]);
        }
}

/* Would catch an access of eight bytes at once, which four-byte alignment does not allow on every processor. */
static void alignment_to_four_bytes_is_enough(void)
{
    const conformance_stream_t *script = device_stream("sentence");
    for (unsigned offset = 0; offset < 2; offset++) {
        conformance_digest_t digest = { 0, 0 };
        uint32_t *workspace = device_memory.workspace + (((uintptr_t)device_memory.workspace >> 2) + offset) % 2u;
        /* The last word, one canary, is lent to the workspace where it begins a word later. */
        const uint32_t lent = device_memory.after[0];
        TEST_ASSERT_NULL(conformance_play(script, CONFORMANCE_FILL, &device_memory.stream, workspace, DEVICE_WORKSPACE,
                                          conformance_digest, &digest));
        device_memory.after[0] = lent;
        TEST_ASSERT_EQUAL_HEX32(script->digest, digest.crc);
    }
}

/* Would catch a check that lets the library read or write where it must not. */
static void unfit_workspaces_are_refused(void)
{
    labial_t *stream = &device_memory.stream;
    uint8_t *workspace = (uint8_t *)(void *)device_memory.workspace;
    const uint32_t size = labial_workspace_size(&speech_en);
    TEST_ASSERT_EQUAL_UINT32(SPEECH_EN_WORKSPACE_SIZE, size);
    TEST_ASSERT_EQUAL_UINT32(LAUGHTER_SYNTHETIC_WORKSPACE_SIZE, labial_workspace_size(&laughter_synthetic));
    for (unsigned offset = 1; offset < 4; offset++)
        ASSERT_RESULT(LABIAL_ERROR_WORKSPACE, labial_init(stream, &speech_en, workspace + offset, size, ignore, NULL));
    ASSERT_RESULT(LABIAL_ERROR_WORKSPACE, labial_init(stream, &speech_en, workspace, size - 1u, ignore, NULL));
    ASSERT_RESULT(LABIAL_ERROR_NULL, labial_init(stream, &speech_en, NULL, size, ignore, NULL));
    ASSERT_RESULT(LABIAL_ERROR_STATE, labial_tick(stream));
    ASSERT_RESULT(LABIAL_OK, labial_init(stream, &speech_en, workspace, size, ignore, NULL));
}

/* Would catch tables that were damaged on their way to flash, and structures with another layout. */
static void models_are_sound(void)
{
    ASSERT_RESULT(LABIAL_OK, labial_model_check(&speech_en));
    ASSERT_RESULT(LABIAL_OK, labial_model_check(&laughter_synthetic));
}

/* Would catch an image whose models are of another format than its library. */
static void other_formats_are_refused(void)
{
    labial_t *stream = &device_memory.stream;
    labial_model_t other = speech_en;
    other.format++;
    ASSERT_RESULT(LABIAL_ERROR_VERSION, labial_model_check(&other));
    ASSERT_RESULT(LABIAL_ERROR_VERSION,
                  labial_init(stream, &other, device_memory.workspace, DEVICE_WORKSPACE, ignore, NULL));
    ASSERT_RESULT(LABIAL_ERROR_STATE, labial_tick(stream));
    ASSERT_RESULT(LABIAL_OK, labial_init(stream, &speech_en, device_memory.workspace, DEVICE_WORKSPACE, ignore, NULL));
    ASSERT_RESULT(LABIAL_ERROR_VERSION, labial_use(stream, &other));
}

/* Stack below this function of the ticks of a sentence and a laugh, all pushed before, callback included. */
__attribute__((noinline)) static uint32_t depth_of_ticks(void)
{
    labial_t *stream = &device_memory.stream;
    ASSERT_RESULT(LABIAL_OK, labial_init(stream, &speech_en, device_memory.workspace, DEVICE_WORKSPACE, ignore, NULL));
    for (unsigned i = 0; i < LABIAL_QUEUE; i++) {
        if (i == SPOKEN)
            ASSERT_RESULT(LABIAL_OK, labial_use(stream, &laughter_synthetic));
        ASSERT_RESULT(LABIAL_OK, labial_push(stream, i % LAUGHTER_SYNTHETIC_PHONEMES, 90));
    }
    ASSERT_RESULT(LABIAL_OK, labial_end(stream));
    board_stack_paint();
    while (labial_tick(stream) != LABIAL_DONE) {
    }
    return board_stack_depth();
}

/* Would catch a buffer or a recursion that a small stack does not bear. */
static void stack_is_small(void)
{
    const conformance_stream_t *script = device_stream("switch");
    if (board_stack_left() == UINT32_MAX) {
        board_print("[  SKIPPED ] stack_is_small: this board cannot tell how deep the stack is\n");
        return;
    }
    board_stack_paint();
    TEST_ASSERT_NULL(conformance_play(script, CONFORMANCE_FILL, &device_memory.stream, device_memory.workspace,
                                      DEVICE_WORKSPACE, ignore, NULL));
    uint32_t depth = board_stack_depth();
    board_print_within("stack: ", depth, " bytes, ");
    TEST_ASSERT_TRUE(depth <= STACK_LIMIT);
    depth = depth_of_ticks();
    board_print_within("of a tick alone: ", depth, " bytes\n");
    TEST_ASSERT_TRUE(depth <= TICK_STACK_LIMIT);
}

void test_memory(void)
{
    Unity.TestFile = __FILE__;
    RUN_TEST(models_are_sound);
    RUN_TEST(unfit_workspaces_are_refused);
    RUN_TEST(other_formats_are_refused);
    RUN_TEST(fullest_streams_stay_inside);
    RUN_TEST(alignment_to_four_bytes_is_enough);
    RUN_TEST(stack_is_small);
}
