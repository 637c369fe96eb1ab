/*
 * protrusion.c - FAP 17 of the corners (protrusion.h).
 */
#include "protrusion.h"

#include <stddef.h>

#include "fixed.h"

enum { FAP_17 = 2, FAP_53 = 5, FAP_54 = 6, FAP_60 = 12 }; /* places in a frame */

#define LAST (LABIAL_PROTRUSION_VALUES - 1)

int16_t labial_protrusion(const labial_protrusion_t *table, int32_t corners)
{
    const int32_t above = corners - 2 * table->low;
    const uint32_t place = above < 0 ? 0u : above > 65535 ? 65535u : (uint32_t)above;
    const uint32_t at = place * table->gain >> 12; /* of the values, Q8 */
    const int16_t *values;
    if (at >= LAST * 256u)
        return table->values[LAST];
    values = table->values + (at >> 8);
    return (int16_t)(values[0] + (((values[1] - values[0]) * (int32_t)(at & 255u) + 128) >> 8));
}

void labial_protrusion_complete(const labial_model_t *model, int16_t motion[LABIAL_CHANNELS])
{
    if (!model->protrusion)
        return;
    motion[FAP_60] = motion[FAP_17];
    motion[FAP_17] = labial_protrusion(model->protrusion, motion[FAP_53] + motion[FAP_54]);
}
