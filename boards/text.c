/*
 * text.c - numbers as text, the same on every board.
 */
#include "board.h"

const char board_name[] = BOARD_NAME;

void board_print(const char *text)
{
    while (*text)
        board_put(*text++);
}

void board_print_unsigned(uint32_t number)
{
    char digits[11];
    char *first = digits + sizeof digits - 1;
    *first = '\0';
    do {
        *--first = (char)('0' + number % 10u);
        number /= 10u;
    } while (number > 0);
    board_print(first);
}

void board_print_signed(int32_t number)
{
    if (number < 0)
        board_put('-');
    board_print_unsigned(number < 0 ? 0u - (uint32_t)number : (uint32_t)number);
}

void board_print_within(const char *before, uint32_t number, const char *behind)
{
    board_print(before);
    board_print_unsigned(number);
    board_print(behind);
}

void board_print_hex(uint32_t number)
{
    for (int shift = 28; shift >= 0; shift -= 4)
        board_put("0123456789abcdef"[number >> shift & 15u]);
}
