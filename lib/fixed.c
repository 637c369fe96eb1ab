/*
 * fixed.c - the one division (fixed.h).
 */
#include "fixed.h"

uint32_t labial_quotient(uint32_t a, uint32_t b)
{
    return a / b;
}
