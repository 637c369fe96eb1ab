/*
 * output.c - one frame out: faded where something began anew, or eased to the neutral face, and to the callback.
 */
#include <string.h>

#include "stream.h"

/* Frames over which a solution that begins anew fades in. */
#define FADE 8u

/* Q4 to whole FAP units. */
static void call_back(labial_t *stream, const int16_t motion[LABIAL_CHANNELS])
{
    int16_t faps[LABIAL_CHANNELS];
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        faps[k] = (int16_t)((motion[k] + 8) >> 4);
    stream->callback(stream->user, stream->frame, faps);
    stream->frame++;
    stream->shown = 1;
}

/* Begins to fade from the pose that was delivered last, which moves on as far as the last frame moved it, half as far
 * with each frame. */
static void begin_fade(labial_t *stream)
{
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++) {
        stream->earlier[k] = (int16_t)(stream->fade_step == 0 ? stream->pose[k] - stream->earlier[k] : 0);
        stream->faded[k] = stream->pose[k];
    }
    stream->fade_step = 1;
}

int labial_output_deliver(labial_t *stream)
{
    const unsigned delay = LABIAL_DELAY(stream->stride);
    const int16_t *motion = stream->motion + stream->phase * LABIAL_CHANNELS;
    unsigned k;
    if (stream->entered <= delay)
        return 0;
    if (stream->begins[delay / 32u] >> (delay % 32u) & 1u)
        begin_fade(stream);
    for (k = 0; k < LABIAL_CHANNELS; k++) {
        int32_t value = motion[k];
        if (stream->fade_step) {
            const int32_t from = stream->faded[k] + stream->earlier[k] - (stream->earlier[k] >> stream->fade_step);
            value = from + (((value - from) * labial_ease(stream->fade_step, FADE + 1u) + 8192) >> 14);
        } else {
            stream->earlier[k] = stream->begun ? stream->pose[k] : (int16_t)value; /* nothing moved to a first frame */
        }
        stream->pose[k] = (int16_t)labial_clamp(value, INT16_MAX);
    }
    if (stream->fade_step && ++stream->fade_step > FADE) {
        stream->fade_step = 0;
        memcpy(stream->earlier, stream->pose, sizeof stream->earlier);
    }
    stream->pending--;
    stream->begun = 1;
    call_back(stream, stream->pose);
    return 1;
}

/* The face at the present step of the way from `pose` to the neutral one. */
static void eased(const labial_t *stream, int16_t motion[LABIAL_CHANNELS])
{
    const int32_t left = 16384 - labial_ease(stream->ease_step, stream->ease_length);
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        motion[k] = (int16_t)((stream->pose[k] * left + 8192) >> 14);
}

void labial_output_ease(labial_t *stream)
{
    int16_t motion[LABIAL_CHANNELS];
    stream->ease_step++;
    eased(stream, motion);
    if (stream->ease_step == stream->ease_length) {
        stream->ease_length = 0;
        memset(stream->pose, 0, sizeof stream->pose);
    }
    call_back(stream, motion);
}

void labial_output_stop_easing(labial_t *stream)
{
    if (stream->ease_length)
        eased(stream, stream->pose);
}
