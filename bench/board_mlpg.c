/*
 * board_mlpg.c - equation 3 alone: prints the instructions that a unit of each channel takes together, as a stream
 * solves it, and the frames.
 */
#include "board.h"
#include "speech_en.h"
#include "unit.h"

static bench_unit_t unit;
static int16_t motion[BENCH_HOLD];

int main(void)
{
    uint32_t instructions = 0;
    for (unsigned k = 0; k < BENCH_CHANNELS; k++) {
        bench_unit_fill(&unit, &speech_en, k);
        board_count_start();
        bench_unit_solve(&unit, &speech_en, k, motion);
        instructions += board_count();
    }
    board_print_within("instructions ", instructions, "\n");
    board_print_within("frames ", BENCH_CHANNELS * BENCH_UNIT, "\n");
    return 0;
}
