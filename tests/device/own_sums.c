/*
 * own_sums.c - labial_hear_sums() as a program defines it, from the order of weights that labial/hear_model.h states;
 * with OWN_SUMS_WRONG from another order, which hearing_works.c must notice.
 */
#include "labial/hear_model.h"

#ifdef OWN_SUMS_WRONG
#define WEIGHT(row, column) (4u * (column) + (row))
#else
#define WEIGHT(row, column) (8u * ((column) / 2u) + 4u * ((row) / 2u) + 2u * ((column) % 2u) + (row) % 2u)
#endif

void labial_hear_sums(const int8_t *weights, const int16_t *x, unsigned columns, int32_t sums[4])
{
    unsigned row, column;
    for (row = 0; row < 4u; row++) {
        sums[row] = 0;
        for (column = 0; column < columns; column++)
            sums[row] += weights[WEIGHT(row, column)] * x[column];
    }
}
