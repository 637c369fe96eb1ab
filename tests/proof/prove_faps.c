/* Any two arrays, or null. */
#include "labial/faps.h"

#include "prove.h"

int main(void)
{
    int16_t faps[LABIAL_CHANNELS], expanded[LABIAL_FAPS_EXPANDED];
    FILL(faps);
    labial_expand(OR_NULL(const int16_t *, faps), OR_NULL(int16_t *, expanded));
    return labial_fap_numbers[Frama_C_interval(0, LABIAL_CHANNELS - 1)] +
           labial_fap_numbers_expanded[Frama_C_interval(0, LABIAL_FAPS_EXPANDED - 1)];
}
