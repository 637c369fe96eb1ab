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

const int16_t *labial_channels_due(const labial_channels_t *channels, const labial_model_t *const models[LABIAL_MODELS])
{
    static int16_t motion[LABIAL_CHANNELS];
    FILL(motion);
    return channels->entered && any_int ? motion : (const int16_t *)0;
}

#endif
