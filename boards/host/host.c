/*
 * host.c - board.h on the host, so that what runs on a board can be run and debugged without one.
 */
#include <stdio.h>
#include <stdlib.h>

#include "board.h"

void board_put(char character)
{
    putchar(character);
}

void board_exit(int status)
{
    exit(status);
}

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
