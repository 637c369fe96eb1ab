/*
 * shape.h - phonemes to targets: the shape of each phoneme, and the target of each frame.
 */
#ifndef LABIAL_SHAPE_H
#define LABIAL_SHAPE_H

#include "labial/labial.h"
#include "units.h"

/*
 * Shape selection (equation 2 of docs/method.md, with its context, conditional mean and pairs) of a phoneme between its
 * neighbours, into `selection->shape`, which has the model's channels. Each of two calls with the same arguments does
 * half of it, so that two ticks may share it; `selection->halves` counts them from 0.
 */
void labial_shape_select(const labial_model_t *model, const labial_spoken_t *spoken, labial_selection_t *selection);

/*
 * The target of an accepted frame: its phoneme's shape and what the temporal kernels of its neighbours add, but
 * not below the phoneme's floor, nor below that of a short contact beside it. Returns the channels that are in
 * contact.
 */
unsigned labial_shape_target(const labial_model_t *model, const labial_shape_t *shape, const labial_taken_t *taken,
                             int16_t target[LABIAL_CHANNELS]);

#endif
