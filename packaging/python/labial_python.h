/*
 * labial_python.h - what the Python package asks of the library, beside the library's own functions.
 *
 * Python allocates one block of labial_python_size() bytes for each stream, aligned to eight, and fills in the first
 * members: the same ones, in the same order, as in export/labial/runtime/library.py. All else is this file's business.
 */
#ifndef LABIAL_PYTHON_H
#define LABIAL_PYTHON_H

#include "labial/blob.h"
#include "labial/labial.h"
#include "labial/laugh.h"
#include "labial/names.h"
#include "labial/rig.h"

/* Version of this interface; the package refuses a library of another one. */
#define LABIAL_PYTHON_INTERFACE 1

/* A phoneme that is to be pushed: its model's place among the stream's models, its number, milliseconds. */
typedef struct {
    uint32_t model, phoneme, milliseconds;
} labial_python_item_t;

/* A stream with its memory. Members up to `number` are Python's to set and to read, between calls. */
typedef struct {
    const labial_python_item_t *items;   /* what is to be pushed */
    const labial_model_t *const *models; /* that the items name */
    int16_t *frames;                     /* capacity x 13 */
    uint32_t count;                      /* of items */
    uint32_t used;                       /* of them, those that were pushed; advanced */
    uint32_t ends;                       /* 1: nothing follows the items */
    uint32_t capacity;                   /* of `frames` */
    uint32_t delivered;                  /* frames that the last run delivered */
    uint32_t number;                     /* of the latest frame, counted since the stream was opened */
    const labial_model_t *model;         /* of the next push */
    labial_t stream;
    uint32_t workspace[LABIAL_WORKSPACE_SIZE(LABIAL_SEARCH_STRIDE_MAX) / 4u];
} labial_python_t;

/* What Python needs to know of a model. */
typedef struct {
    uint32_t frames_per_second, search_stride, phonemes, silence;
} labial_python_model_t;

/* LABIAL_PYTHON_INTERFACE, and the bytes of a stream, of a loaded model and of an output of a rig. */
uint32_t labial_python_interface(void);
uint32_t labial_python_size(void);
uint32_t labial_python_blob_size(void);
uint32_t labial_python_output_size(void);

/* "MAJOR.MINOR.PATCH" of labial/labial.h. */
const char *labial_python_version(void);

/* Initialises the stream, which has all its bytes zero, with the first of its models. Returns as labial_init() does. */
int labial_python_open(labial_python_t *python);

/* Pushes items while there is room for them; after the last, labial_end() where `ends` is set. Returns LABIAL_OK, or
 * what a call refused with; `used` then names the item. */
int labial_python_feed(labial_python_t *python);

/*
 * Feeds and ticks, until `capacity` frames have been delivered, nothing comes before more is pushed, the stream is done,
 * or `ticks` ticks were made; with 0 any number. Frames do not depend on how a stream is fed.
 *
 * Returns what the last tick did, or the error of a push; LABIAL_STARVED where nothing comes, also before the first
 * frame; LABIAL_OK where there was nothing to do.
 */
int labial_python_run(labial_python_t *python, uint32_t ticks);

/* labial_cancel(), labial_restart() and labial_latency() of the stream. */
int labial_python_cancel(labial_python_t *python, uint32_t milliseconds);
int labial_python_restart(labial_python_t *python);
void labial_python_latency(const labial_python_t *python, labial_latency_t *latency);

/* Writes what is asked of a model; LABIAL_OK or LABIAL_ERROR_NULL. */
int labial_python_model(const labial_model_t *model, labial_python_model_t *about);

/* Writes at most `capacity` phonemes of a laugh as items of the model in the place `model`. Returns their number, or as
 * labial_laugh_begin() does. */
int labial_python_laugh(uint32_t milliseconds, uint32_t intensity, uint32_t seed, uint32_t model,
                        labial_python_item_t *items, uint32_t capacity);

/* The label of a phoneme in UTF-8, or null where the names have no such number. */
const char *labial_python_label(const labial_names_t *names, uint32_t phoneme);

#endif
