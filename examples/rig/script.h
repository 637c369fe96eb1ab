/*
 * script.h - the input of the examples: a sentence and a laugh, pushed to a stream while it has room. One script at a
 * time, since its workspace is static.
 */
#ifndef EXAMPLE_SCRIPT_H
#define EXAMPLE_SCRIPT_H

#include "labial/labial.h"

typedef struct {
    labial_t stream;
    unsigned next; /* line that is pushed next */
} script_t;

/* Starts again; frames go to `on_frame`. Returns the result of labial_init(). */
int script_begin(script_t *script, labial_frame_fn on_frame, void *user);

/* Pushes phonemes while there is room and ticks once: call it once per frame period. Returns labial_tick()'s result. */
int script_tick(script_t *script);

#endif
