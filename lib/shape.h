/*
 * shape.h - phonemes to targets: which shape a phoneme takes, and where every frame is drawn to.
 */
#ifndef LABIAL_SHAPE_H
#define LABIAL_SHAPE_H

#include "labial/model.h"

/*
 * Shape selection (paper, eq. 2; section 2 of the method for context and soft selection): the positions of `phoneme`
 * lasting `ms` milliseconds between the given neighbours, with what these add to it as a pair.
 */
void labial_shape_select(const labial_model_t *model, unsigned phoneme, uint16_t ms, unsigned previous, unsigned next,
                         int16_t shape[LABIAL_CHANNELS]);

/*
 * The target of one frame: the phoneme's shape and what the temporal kernels of its neighbours add, but not below the
 * phoneme's floor. `labels` points to the frame's phoneme in an array that reaches as far to both sides as the kernels
 * do.
 */
void labial_shape_target(const labial_model_t *model, const int16_t shape[LABIAL_CHANNELS], const uint8_t *labels,
                         int16_t target[LABIAL_CHANNELS]);

#endif
