/*
 * faces.h - the rigs that are formats of output: each description in export/labial/rig, with the table that `labial rig`
 * wrote of it into this folder. CMakeLists.txt finds them; nothing here names one.
 */
#ifndef LABIAL_EXAMPLE_FACES_H
#define LABIAL_EXAMPLE_FACES_H

#include "labial/rig.h"

/* Outputs that a rig has at most. */
#define FACES_OUTPUTS_MAX 64

/* A rig whose outputs are weights, with the names that engines know. */
typedef struct {
    const char *name;
    const labial_rig_t *rig;
    const char *const *outputs; /* the names of its outputs, in their order */
} face_t;

/* Every face, in the order of their names. */
extern const face_t faces[];
extern const unsigned faces_count;

#endif
