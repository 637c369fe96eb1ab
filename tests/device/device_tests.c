/*
 * device_tests.c - the suite that accepts a port: flash it to a board, or run it under QEMU, and read the last line.
 * docs/porting.md says what to do with it. Each test says what it would catch.
 */
#include "device.h"

#include <string.h>

#define FILLING 0x5ac3u

device_memory_t device_memory;

static int is_sound; /* whether all held that the present test required */

void device_require(int holds, const char *what)
{
    if (holds)
        return;
    board_print(what);
    board_print(": FAILED\n");
    is_sound = 0;
}

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
    device_require(0, name);
    return &conformance_streams[0];
}

int device_setup(void **state)
{
    (void)state;
    device_memory_fill();
    is_sound = 1;
    return 0;
}

int device_teardown(void **state)
{
    (void)state;
    device_require(device_memory_is_whole(), "memory beside the stream or the workspace was written to");
    return is_sound ? 0 : 1;
}

int main(void)
{
    board_print("Device tests on ");
    board_print(board_name);
    board_put('\n');
    const int failures = test_arithmetic() + test_memory() + test_ticks();
    board_print_unsigned((uint32_t)failures);
    board_print(failures ? " tests failed\nFAIL\n" : " tests failed\nOK\n");
    return failures ? 1 : 0;
}
