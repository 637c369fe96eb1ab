/*
 * servos.h - faces (labial/face.h) for languages that call C, like flat.h: pointers and numbers. All memory is the
 * caller's, aligned to eight bytes.
 */
#ifndef LABIAL_FLAT_SERVOS_H
#define LABIAL_FLAT_SERVOS_H

#include "flat.h"
#include "labial/face.h"

/* A face with its rig; its memory follows. */
typedef struct {
    labial_face_t face;
    labial_rig_t rig;
} servos_t;

/* Bytes of a face of so many outputs, 1 .. 65535, that looks `ahead` frames ahead, up to LABIAL_FACE_AHEAD_MAX. */
FLAT(servos_size) uint32_t servos_size(unsigned outputs, unsigned ahead);

/* The outputs must stay where they are, and so must the face. */
FLAT(servos_init)
int servos_init(servos_t *servos, const labial_rig_output_t *outputs, unsigned count, unsigned ahead);
FLAT(servos_frame) int servos_frame(servos_t *servos, const int16_t *faps, const uint8_t *shares);
FLAT(servos_values) int servos_values(servos_t *servos, const int32_t *wanted);
FLAT(servos_tick) int servos_tick(servos_t *servos, int32_t *values);
FLAT(servos_play) int servos_play(servos_t *servos);
FLAT(servos_skip) int servos_skip(servos_t *servos, unsigned count);
FLAT(servos_cancel) int servos_cancel(servos_t *servos, uint32_t milliseconds);
FLAT(servos_soft_start) int servos_soft_start(servos_t *servos, unsigned ticks);
FLAT(servos_attached) unsigned servos_attached(const servos_t *servos);
FLAT(servos_place) int servos_place(servos_t *servos, const int32_t *values);

#endif
