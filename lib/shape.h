/*
 * shape.h - phonemes to targets: which shape a phoneme takes, and where every frame is drawn to.
 */
#ifndef LABIAL_SHAPE_H
#define LABIAL_SHAPE_H

#include "labial/labial.h"
#include "units.h"

/*
 * Shape selection (paper, eq. 2; DESIGN.md for context and soft selection): the shape of `phoneme`
 * lasting `ms` milliseconds between the given neighbours, with what these add to it as a pair.
 */
void labial_shape_select(const labial_model_t *model, unsigned phoneme, uint16_t ms, unsigned previous, unsigned next,
                         labial_shape_t *shape);

/*
 * The target of a frame that was taken: its phoneme's shape and what the temporal kernels of its neighbours add, but
 * not below the phoneme's floor, nor below that of a short contact beside it. Returns the channels that are in
 * contact.
 */
uint16_t labial_shape_target(const labial_model_t *model, const labial_shape_t *shape, const labial_taken_t *taken,
                             int16_t target[LABIAL_CHANNELS]);

#endif
