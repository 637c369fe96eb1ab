/*
 * start.S - RISC-V: the first instructions of an image, and what a trap goes to.
 */
    .section .reset, "ax"
    .globl board_reset
board_reset:
    .option push
    .option norelax /* what gp is for cannot be used to load it */
    la gp, __global_pointer$
    .option pop
    la sp, board_stack_end
    la t0, trap
    .option push
    .option arch, +zicsr
    csrw mtvec, t0
    .option pop
    j board_start

    .balign 4 /* mtvec's low bits are its mode */
trap:
    j board_fault
