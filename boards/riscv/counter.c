/*
 * counter.c - RISC-V: minstret, the processor's own counter of instructions. It is 64 bits long; 32 suffice for
 * differences, which makes stretches of up to 2^32 - 1 instructions.
 */
#include "target.h"

static uint32_t begin, calibration;

static inline uint32_t instructions(void)
{
    uint32_t low;
    __asm__ volatile(".option push\n\t.option arch, +zicsr\n\tcsrr %0, minstret\n\t.option pop" : "=r"(low));
    return low;
}

__attribute__((noinline)) void board_count_start(void)
{
    begin = instructions();
}

__attribute__((noinline)) uint32_t board_count(void)
{
    return instructions() - begin - calibration;
}

void board_count_calibrate(void)
{
    calibration = 0;
    board_count_start();
    calibration = board_count();
}
