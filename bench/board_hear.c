/*
 * board_hear.c - what hearing costs on a board: prints names and numbers, one pair a line.
 *
 * BENCH_HEARING is the model's name, BENCH_HEADER its header, BENCH_WORKSPACE the size of its
 * workspace, BENCH_RATE the rate of the sound, BENCH_SECONDS its length. What is counted, in
 * instructions: labial_hear_init() once; every call of labial_hear_push() with 20 ms of sound, and labial_hear_end().
 * The stack is that of all of these, with a callback that sums up the frame.
 *
 * The sound is a buzz whose pitch and formant move, with bursts of noise and pauses: what it costs does not depend on
 * what is said, but that a window of silence has no spectrum.
 */
#include "board.h"

#include BENCH_HEADER

#define BLOCK (BENCH_RATE / 50u)

static labial_hear_t hear;
static uint32_t workspace[BENCH_WORKSPACE / 4];
static int16_t block[BLOCK];
static uint32_t frames, checksum;

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    unsigned k;
    (void)user;
    frames = frame + 1u;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        checksum = checksum * 31u + (uint16_t)faps[k];
}

static void make_sound(uint32_t number)
{
    static uint32_t phase, noise = 1;
    static int32_t low, band;
    const uint32_t pitch = 6000000u + (number * 40503u & 0xfffffu), kind = number / 8u % 5u;
    unsigned i;
    for (i = 0; i < BLOCK; i++) {
        int32_t source = 0;
        const uint32_t before = phase;
        phase += pitch * (48000u / BENCH_RATE);
        noise = noise * 1664525u + 1013904223u;
        if (kind < 3u)
            source = phase < before ? 24000 : 0;
        else if (kind == 3u)
            source = (int32_t)(noise >> 20) - 2048;
        low += band >> 3;
        band += ((source - low) >> (2u + (number >> 4) % 3u)) - (band >> 4);
        block[i] = (int16_t)(band > 20000 ? 20000 : band < -20000 ? -20000 : band);
    }
}

int main(void)
{
    uint32_t number, initial, pushing = 0, worst = 0, ending, deepest;
    board_stack_paint();
    board_count_start();
    if (labial_hear_init(&hear, &BENCH_HEARING, BENCH_RATE, 1, workspace, sizeof workspace, on_frame, NULL) !=
        LABIAL_OK)
        return 1;
    initial = board_count();
    for (number = 0; number < BENCH_SECONDS * 50u; number++) {
        uint32_t taken;
        make_sound(number);
        board_count_start();
        labial_hear_push(&hear, block, BLOCK);
        taken = board_count();
        if (taken == BOARD_COUNT_OVERFLOW)
            return 2;
        pushing += taken;
        worst = taken > worst ? taken : worst;
    }
    board_count_start();
    labial_hear_end(&hear);
    ending = board_count();
    deepest = board_stack_depth();

    board_print_within("frames ", frames, "\n");
    board_print_within("push_instructions ", pushing, "\n");
    board_print_within("push_worst ", worst, "\n");
    board_print_within("init_instructions ", initial, "\n");
    board_print_within("end_instructions ", ending, "\n");
    board_print_within("stack ", deepest, "\n");
    board_print_within("ram ", (uint32_t)sizeof hear + labial_hear_workspace_size(&BENCH_HEARING), "\n");
    board_print_within("checksum ", checksum, "\n");
    return 0;
}
