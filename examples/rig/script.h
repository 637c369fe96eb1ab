/*
 * script.h - what the examples say: a sentence and a laugh, pushed to a stream as it has room. One script at a time,
 * since its workspace is static.
 */
#ifndef EXAMPLE_SCRIPT_H
#define EXAMPLE_SCRIPT_H

#include "labial/labial.h"

typedef struct {
    labial_t stream;
    unsigned next; /* line that is pushed next */
} script_t;

/* Begins anew; frames go to `on_frame`. Returns LABIAL_OK or what labial_init() answers. */
int script_begin(script_t *script, labial_frame_fn on_frame, void *user);

/* Pushes what there is room for and ticks once: call it once per frame period. Returns what labial_tick() answers. */
int script_tick(script_t *script);

#endif
