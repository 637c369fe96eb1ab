/*
 * articulation.h - how far the mouth moves (labial_articulation()), from frame to frame.
 */
#ifndef LABIAL_ARTICULATION_H
#define LABIAL_ARTICULATION_H

#include "fixed.h"
#include "labial/labial.h"

/* Percent by which it changes from frame to frame, at most. */
#define LABIAL_ARTICULATION_STEP 10

/* Sets what is wanted; `at_once` when nothing moves yet that could be jolted. */
static inline void labial_articulation_set(labial_articulation_t *articulation, unsigned percent, int at_once)
{
    articulation->wanted = (uint8_t)(percent < LABIAL_ARTICULATION_MAX ? percent : LABIAL_ARTICULATION_MAX);
    if (at_once)
        articulation->present = articulation->wanted;
}

/* Moves on by a frame. */
static inline void labial_articulation_step(labial_articulation_t *articulation)
{
    articulation->present =
        (uint8_t)(articulation->present +
                  labial_clamp((int32_t)articulation->wanted - articulation->present, LABIAL_ARTICULATION_STEP));
}

/* The present one in 1/LABIAL_GAIN_ONE, rounded: times 2.56, which is 5243 / 2^11. */
static inline int32_t labial_articulation_gain(const labial_articulation_t *articulation)
{
    return (int32_t)((articulation->present * 5243u + 1024u) >> 11);
}

#endif
