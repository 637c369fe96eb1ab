/*
 * fixed.c - the one division (fixed.h).
 */
#include "fixed.h"

#include "labial/model.h"

uint32_t labial_quotient(uint32_t a, uint32_t b)
{
    return a / b;
}
