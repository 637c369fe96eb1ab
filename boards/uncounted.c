/*
 * uncounted.c - board.h without counts of instructions and stack depth: on the host and in WebAssembly.
 */
#include "board.h"

void board_count_start(void)
{
}

uint32_t board_count(void)
{
    return 0;
}

void board_stack_paint(void)
{
}

uint32_t board_stack_depth(void)
{
    return 0;
}

uint32_t board_stack_left(void)
{
    return UINT32_MAX;
}
