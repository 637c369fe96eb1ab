/*
 * protrusion.h - FAP 17 of the corners, in models that have a table of it in the place of a channel.
 *
 * Such a model's tables, its targets and its motion have LABIAL_CHANNELS_SOLVED channels: those of a frame in their
 * order, but the last one, FAP 60, in the place of FAP 17. So channels keep their turns, and every tick has as many.
 */
#ifndef LABIAL_PROTRUSION_H
#define LABIAL_PROTRUSION_H

#include "labial/model.h"

/* How many channels a model's tables have. */
static inline unsigned labial_channel_count(const labial_model_t *model)
{
    return model->protrusion ? LABIAL_CHANNELS_SOLVED : LABIAL_CHANNELS;
}

/* FAP 17 for the sum of both corners, each Q4 FAP of 16 bits; Q4 FAP. */
int16_t labial_protrusion(const labial_protrusion_t *table, int32_t corners);

/* Brings the motion of a model's channels, Q4 FAP, into the order of a frame, and computes FAP 17, where the model has a
 * table of it. */
void labial_protrusion_complete(const labial_model_t *model, int16_t motion[LABIAL_CHANNELS]);

#endif
