/*
 * unity_board.c - board.h for a board whose framework brings Unity: text goes where Unity's goes, and nothing is
 * counted. Compiled with boards/text.c and boards/uncounted.c.
 */
#include <unity.h>

#include "board.h"

void board_put(char character)
{
    UNITY_OUTPUT_CHAR(character);
}
