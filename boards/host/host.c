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
