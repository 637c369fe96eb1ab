/*
 * lips_render.h - a renderer of Espressif's av_render that hears what it plays (lips.h), LIPS_RENDER_DELAY before.
 *
 * av_render decodes sound when it is to be played, too late for lips. This renderer stands in front of another one and
 * holds the sound back in a buffer, from which a task of its own writes it to the other.
 */
#ifndef LIPS_RENDER_H
#define LIPS_RENDER_H

#include "audio_render.h"

/* Milliseconds that sound is held back, at least the latency of hearing. */
#ifndef LIPS_RENDER_DELAY
#define LIPS_RENDER_DELAY 120
#endif

/* Bytes of sound in a millisecond, at most: openai_demo plays 16 kHz with two channels. Other sound is refused. */
#ifndef LIPS_RENDER_BYTES
#define LIPS_RENDER_BYTES (16 * 2 * 2)
#endif

/* The renderer in front of `to`, which belongs to it from then on; null if that is, or without memory. There is one in
 * a program, since there is one mouth. Sound must have 16 bits, 1 or 2 channels and a rate of labial/hear.h. */
audio_render_handle_t lips_render(audio_render_handle_t to);

/* The work of the task: waits for sound and plays it. */
void lips_render_step(void);

#endif
