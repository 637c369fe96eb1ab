/*
 * ears.h - hearing for languages that call C, like flat.h: pointers, numbers and texts. All memory is the caller's,
 * aligned to eight bytes.
 */
#ifndef LABIAL_FLAT_EARS_H
#define LABIAL_FLAT_EARS_H

#include "flat.h"
#include "labial/hear.h"

/* A stream of sound with all that belongs to it. */
typedef struct {
    labial_hear_t hear;
    /* Where the frames of the present call go, their sounds, and the stretches of one class; null: nowhere. */
    int16_t *faps;
    uint8_t *visemes;
    uint32_t *stretches;
    uint32_t room;        /* for each */
    uint32_t frame_count; /* how many there were in the last call */
    uint32_t stretch_count;
    uint32_t workspace[LABIAL_HEAR_WORKSPACE_SIZE(LABIAL_HEAR_UNITS_MAX, 255) / 4u];
} ears_t;

FLAT(ears_size) uint32_t ears_size(void);

/* The bundled models of hearing by number: name and tables, null beyond the last. */
FLAT(hearing_name) const char *hearing_name(unsigned number);
FLAT(hearing_model) const labial_hear_model_t *hearing_model(unsigned number);

/* Of a bundled model: how many classes it has, and the name of each, null beyond the last. */
FLAT(hearing_classes) unsigned hearing_classes(unsigned number);
FLAT(hearing_class) const char *hearing_class(unsigned number, unsigned shown);

FLAT(ears_init)
int ears_init(ears_t *ears, const labial_hear_model_t *model, uint32_t samples_per_second, unsigned channels);

/* Milliseconds from the begin of a frame until it is known. */
FLAT(ears_latency) uint32_t ears_latency(const ears_t *ears);

/* These write the frames that they deliver to `faps`, 13 numbers each, the shares of their sounds to `visemes`, 15 each,
 * and the stretches of one class to `stretches`, class, first frame and number of frames, up to `room` of each. They
 * return how many frames there were, or an error; ears_stretches() is how many stretches. */
FLAT(ears_push)
int ears_push(ears_t *ears, const int16_t *samples, uint32_t count, int16_t *faps, uint8_t *visemes,
              uint32_t *stretches, uint32_t room);
FLAT(ears_end) int ears_end(ears_t *ears, int16_t *faps, uint8_t *visemes, uint32_t *stretches, uint32_t room);
FLAT(ears_cancel)
int ears_cancel(ears_t *ears, uint32_t milliseconds, int16_t *faps, uint8_t *visemes, uint32_t *stretches,
                uint32_t room);
FLAT(ears_stretches) uint32_t ears_stretches(const ears_t *ears);
FLAT(ears_exact) int ears_exact(ears_t *ears, unsigned exact);
FLAT(ears_level) unsigned ears_level(const ears_t *ears);
FLAT(ears_set_level) int ears_set_level(ears_t *ears, unsigned level);
FLAT(ears_articulation) int ears_articulation(ears_t *ears, unsigned percent);
FLAT(ears_restart) int ears_restart(ears_t *ears);

#endif
