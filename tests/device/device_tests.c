/*
 * device_tests.c - the suite that accepts a port: flash it to a board, or run it under QEMU, and read the last line.
 * docs/porting.md says what to do with it. Each test says what it would catch.
 */
#include "device.h"

#include <string.h>

#define FILLING 0x5ac3u

device_memory_t device_memory;

void device_memory_fill(void)
{
    uint32_t *word = (uint32_t *)(void *)&device_memory;
    for (size_t i = 0; i < sizeof device_memory / 4u; i++)
        word[i] = (uint32_t)i * 0x9e3779b1u ^ FILLING;
}

static int is_filled(const uint32_t *canaries)
{
    const size_t first = (size_t)(canaries - (const uint32_t *)(const void *)&device_memory);
    for (size_t i = 0; i < DEVICE_CANARIES; i++)
        if (canaries[i] != ((uint32_t)(first + i) * 0x9e3779b1u ^ FILLING))
            return 0;
    return 1;
}

int device_memory_is_whole(void)
{
    return is_filled(device_memory.before) && is_filled(device_memory.between) && is_filled(device_memory.after);
}

const conformance_stream_t *device_stream(const char *name)
{
    for (unsigned i = 0; i < conformance_stream_count; i++)
        if (strcmp(conformance_streams[i].name, name) == 0)
            return &conformance_streams[i];
    TEST_FAIL_MESSAGE(name);
    return &conformance_streams[0];
}

void setUp(void)
{
    device_memory_fill();
}

void tearDown(void)
{
    TEST_ASSERT_TRUE_MESSAGE(device_memory_is_whole(), "memory beside the stream or the workspace was written to");
}

int device_tests(void)
{
    UNITY_BEGIN(); /* before any text: a framework's Unity opens its port there */
    board_print("Device tests on ");
    board_print(board_name);
    board_put('\n');
    test_arithmetic();
    test_memory();
    return UNITY_END() > 0;
}
