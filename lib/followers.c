/*
 * followers.c - all channels of a frame, from those that are solved (channels.h).
 */
#include "channels.h"

#include "fixed.h"

#define LAST (LABIAL_PROTRUSION_VALUES - 1)

int16_t labial_protrusion(const labial_protrusion_t *table, int32_t corners)
{
    const int32_t above = corners - 2 * table->low;
    const uint32_t place = above > 65535 ? 65535u : above < 0 ? 0u : (uint32_t)above;
    const uint32_t at = place * table->gain >> 12; /* of the values, Q8 */
    const int16_t *values;
    if (at >= LAST * 256u)
        return table->values[LAST];
    values = table->values + (at >> 8);
    return (int16_t)(values[0] + (((values[1] - values[0]) * (int32_t)(at & 255u) + 128) >> 8));
}

void labial_followers_complete(const labial_model_t *model, const int16_t *motion, unsigned spacing,
                               int16_t frame[LABIAL_CHANNELS])
{
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        if (model->sources[k] != LABIAL_FROM_CORNERS)
            frame[k] = motion[model->sources[k] * spacing];
    if (model->sources[LABIAL_FAP_17] == LABIAL_FROM_CORNERS)
        frame[LABIAL_FAP_17] = labial_protrusion(model->protrusion, frame[LABIAL_FAP_53] + frame[LABIAL_FAP_54]);
}
