/*
 * board.c - what a stream costs on a board: prints names and numbers, one pair a line.
 *
 * BENCH_MODEL is SPEECH or LAUGHTER, BENCH_SECONDS how much input is synthesised; with BENCH_TURNS it is both by turns.
 * What is counted, in instructions: labial_init() once; every call of labial_tick() from the first, before anything is
 * ready, to the one that says LABIAL_DONE; the calls of labial_push(), labial_room() and labial_end() between ticks. The
 * stack is that of all of these, with a callback that sums up the frame.
 */
#include "board.h"
#include "inputs.h"

static const bench_input_t input = BENCH_INPUT(BENCH_MODEL);
#ifdef BENCH_TURNS
static const bench_input_t others[2] = { BENCH_SPEECH, BENCH_LAUGHTER };
#endif

static labial_t stream;
static uint32_t workspace[LABIAL_WORKSPACE_SIZE(LABIAL_SEARCH_STRIDE_MAX, LABIAL_CHANNELS) / 4];

int main(void)
{
    uint32_t frames = 0, ticks = 0, sum = 0, pushed = 0;
    uint32_t initial, ticking = 0, worst = 0, pushing = 0, deepest;
    unsigned next = 0;
    int result;

    board_stack_paint();
    board_count_start();
    result = labial_init(&stream, input.model, workspace, sizeof workspace, bench_on_frame, &sum);
    initial = board_count();
    if (result != LABIAL_OK)
        return 1;
    (void)labial_exact(&stream, 1);
    do {
        uint32_t taken;
        board_count_start();
#ifdef BENCH_TURNS
        bench_feed_turns(&stream, others, &next, &pushed, BENCH_SECONDS * 1000u);
#else
        bench_feed(&stream, &input, &next, &pushed, BENCH_SECONDS * 1000u);
#endif
        pushing += board_count();
        board_count_start();
        result = labial_tick(&stream);
        taken = board_count();
        if (taken == BOARD_COUNT_OVERFLOW || ticking > UINT32_MAX - taken)
            return 2;
        ticking += taken;
        worst = taken > worst ? taken : worst;
        ticks++;
        frames += result == LABIAL_OK;
    } while (result >= 0 && result != LABIAL_DONE);
    deepest = board_stack_depth();
    if (result != LABIAL_DONE)
        return 3;

    board_print_within("frames ", frames, "\n");
    board_print_within("ticks ", ticks, "\n");
    board_print_within("tick_instructions ", ticking, "\n");
    board_print_within("tick_worst ", worst, "\n");
    board_print_within("push_instructions ", pushing, "\n");
    board_print_within("init_instructions ", initial, "\n");
    board_print_within("stack ", deepest, "\n");
    board_print_within("checksum ", sum, "\n");
    return 0;
}
