/*
 * assumed.h - what the proofs take for granted of the single members of a model that labial_model_check() accepts:
 * X(member, least, most). any_model.h gives each any such value, and tests/c/test_model_assumed.c tries every value of
 * each: none beyond is accepted.
 */
#ifndef ASSUMED_H
#define ASSUMED_H

#include "labial/labial.h"

/* Short contacts are seen from the frames beside them, as far as the library keeps labels. */
#define ASSUMED_FLOORS (LABIAL_REACH >= LABIAL_CONTACT_FRAMES ? 255 : 0)

#define ASSUMED_OF_MODEL(X)                                                                                            \
    X(frames_per_second, 1, 250)                                                                                       \
    X(component_count, 1, 65535)                                                                                       \
    X(phoneme_count, 1, LABIAL_PHONEMES_MAX)                                                                           \
    X(class_count, 1, LABIAL_CLASSES_MAX)                                                                              \
    X(state_count, 1, LABIAL_STATES_MAX)                                                                               \
    X(predecessor_fours, 1, LABIAL_STATES_MAX / 4)                                                                     \
    X(search_stride, 1, LABIAL_SEARCH_STRIDE_MAX)                                                                      \
    X(silence, 0, LABIAL_PHONEMES_MAX - 1)                                                                             \
    X(mixture_mean, 0, 1)                                                                                              \
    X(kernel_taps, 0, LABIAL_KERNEL_TAPS_MAX)                                                                          \
    X(kernel_stride, 0, 255)                                                                                           \
    X(kernel_behind, 0, LABIAL_KERNEL_TAPS_MAX - 1)                                                                    \
    X(floor_count, 0, ASSUMED_FLOORS)                                                                                  \
    X(pair_knots, 1, 2)                                                                                                \
    X(pair_count, 0, 65535)                                                                                            \
    X(channel_count, 1, LABIAL_CHANNELS)

/* The components of a phoneme lie within those of the model. */
#define ASSUMED_OF_PHONEME(X)                                                                                          \
    X(component_count, 1, LABIAL_PHONEME_COMPONENTS_MAX)                                                               \
    X(viseme_class, 0, LABIAL_CLASSES_MAX - 1)                                                                         \
    X(boundary, 0, 1)                                                                                                  \
    X(floor, 0, ASSUMED_FLOORS)

#define ASSUMED_OF_CHANNEL(X)                                                                                          \
    X(centre, -LABIAL_POSITION_MAX, LABIAL_POSITION_MAX)                                                               \
    X(shape_scale, 0, 32767)                                                                                           \
    X(slope_scale, 0, 16383)                                                                                           \
    X(kernel_scale, 0, 65535)                                                                                          \
    X(pair_scale, 0, 65535)                                                                                            \
    X(motion_scale[0], 0, 65535)                                                                                       \
    X(motion_scale[1], 0, 65535)                                                                                       \
    X(contact_weight, 0, 0xaf)

#define ASSUMED_OF_EMISSION(X) X(mean, -LABIAL_POSITION_MAX, LABIAL_POSITION_MAX)

/* Weights of codes beyond 0xaf are above LABIAL_WEIGHT_SUM_MAX, so is six times one beyond 0x85. */
#define ASSUMED_OF_STATE(X)                                                                                            \
    X(mean, -LABIAL_POSITION_MAX, LABIAL_POSITION_MAX)                                                                 \
    X(hold, 8, 0xaf)                                                                                                   \
    X(weight[0], 0, 0x85)                                                                                              \
    X(weight[1], 0, 0x85)

#endif
