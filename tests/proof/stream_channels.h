/*
 * stream_channels.h - channels.c as stream.c sees it: any motion, and any place for a frame.
 */
#ifndef STREAM_CHANNELS_H
#define STREAM_CHANNELS_H

#include "channels.h"
#include "prove.h"

labial_frame_t *labial_channels_enter(labial_channels_t *channels, const labial_model_t *const models[LABIAL_MODELS],
                                      unsigned slot)
{
    static labial_frame_t frame;
    /*@ assert slot < LABIAL_MODELS; */
    (void)models;
    FILL(frame);
    channels->entered = any_uint8;
    return &frame;
}

void labial_channels_run_out(labial_channels_t *channels)
{
    channels->entered = any_uint8;
    channels->beyond = any_uint8;
}

int labial_channels_due(const labial_channels_t *channels, const labial_model_t *const models[LABIAL_MODELS],
                        int16_t frame[LABIAL_CHANNELS])
{
    unsigned k;
    (void)models;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        frame[k] = any_int16;
    return channels->entered && any_int;
}

#endif
