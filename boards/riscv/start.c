/*
 * start.c - RISC-V: reset, what a trap goes to, and minstret, the processor's own counter of instructions. It is 64
 * bits long; 32 suffice for differences, which makes stretches of up to 2^32 - 1 instructions.
 */
#include "target.h"

/* The first instructions of an image. */
__asm__(".pushsection .reset, \"ax\"\n"
        ".globl board_reset\n"
        "board_reset:\n"
        ".option push\n"
        ".option norelax\n" /* what gp is for cannot be used to load it */
        "la gp, __global_pointer$\n"
        ".option pop\n"
        "la sp, board_stack_end\n"
        "la t0, trap\n"
        ".option push\n"
        ".option arch, +zicsr\n"
        "csrw mtvec, t0\n"
        ".option pop\n"
        "j board_start\n"
        ".balign 4\n" /* mtvec's low bits are its mode */
        "trap:\n"
        "j board_fault\n"
        ".popsection");

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
