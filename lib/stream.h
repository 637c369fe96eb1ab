/*
 * stream.h - the steps of a tick, in their order, each in a file of its own, and the rings that they share.
 *
 *     input:   takes a frame from the queue and finds its target
 *     turns:   searches and solves the channels whose turn it is
 *     output:  fades or eases the frame that is due and calls the callback
 */
#ifndef LABIAL_STREAM_H
#define LABIAL_STREAM_H

#include "fixed.h"
#include "labial/labial.h"

/* The place that is `back` places before `place` in a ring of `size`; both below size. */
static inline unsigned labial_ring_back(unsigned place, unsigned back, unsigned size)
{
    return place >= back ? place - back : place + size - back;
}

/* The place after `place` in a ring of `size`. */
static inline uint8_t labial_ring_next(unsigned place, unsigned size)
{
    return (uint8_t)(place + 1u < size ? place + 1u : 0u);
}

/* Selects the shape of the phoneme that begins next, if all is known that it depends on and it is not yet selected. */
void labial_input_select(labial_t *stream);

/*
 * Advances by a tick: puts the target of the next frame into the ring of frames or, after the last one, lets the frames
 * that were taken run out.
 *
 * Returns LABIAL_OK, LABIAL_STARVED when more phonemes must be known, or LABIAL_DONE when nothing is left.
 */
int labial_input_advance(labial_t *stream);

/* Searches and solves the channels whose turn it is, and puts their next `stride` frames into the ring of motion. */
void labial_turns_take(labial_t *stream);

/* Delivers the frame that is due; returns whether one is. */
int labial_output_deliver(labial_t *stream);

/* Delivers the next frame of the way from `pose` to the neutral face. */
void labial_output_ease(labial_t *stream);

/* Makes the frame that was eased last the pose from which another way begins. */
void labial_output_stop_easing(labial_t *stream);

#endif
