/*
 * labial_python.c - runs of the stream, so that Python calls once for many frames. No allocation, no state: all memory
 * is what the caller gives.
 */
#include "labial_python.h"

#define TEXT(x) #x
#define NUMBER(x) TEXT(x)

uint32_t labial_python_interface(void)
{
    return LABIAL_PYTHON_INTERFACE;
}

uint32_t labial_python_size(void)
{
    return (uint32_t)sizeof(labial_python_t);
}

uint32_t labial_python_blob_size(void)
{
    return (uint32_t)sizeof(labial_blob_t);
}

uint32_t labial_python_output_size(void)
{
    return (uint32_t)sizeof(labial_rig_output_t);
}

const char *labial_python_version(void)
{
    return NUMBER(LABIAL_VERSION_MAJOR) "." NUMBER(LABIAL_VERSION_MINOR) "." NUMBER(LABIAL_VERSION_PATCH);
}

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    labial_python_t *python = (labial_python_t *)user;
    int16_t *to = python->frames + (size_t)python->delivered * LABIAL_CHANNELS;
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        to[k] = faps[k];
    python->delivered++;
    python->number = frame;
}

int labial_python_open(labial_python_t *python)
{
    python->model = python->models[0];
    return labial_init(&python->stream, python->model, python->workspace, sizeof python->workspace, on_frame, python);
}

int labial_python_feed(labial_python_t *python)
{
    int result = LABIAL_OK;
    while (result == LABIAL_OK && python->used < python->count && labial_room(&python->stream) > 0) {
        const labial_python_item_t *item = &python->items[python->used];
        const labial_model_t *model = python->models[item->model];
        if (model != python->model)
            result = labial_use(&python->stream, model);
        if (result == LABIAL_OK) {
            python->model = model;
            result = labial_push(&python->stream, item->phoneme, item->milliseconds);
        }
        if (result == LABIAL_OK)
            python->used++;
    }
    if (result == LABIAL_OK && python->ends && python->used == python->count)
        result = labial_end(&python->stream);
    return result;
}

int labial_python_run(labial_python_t *python, uint32_t ticks)
{
    const unsigned delay = labial_latency(&python->stream).delay;
    unsigned idle = 0; /* ticks since the last frame or push: one more than the delay, and nothing comes by itself */
    uint32_t made = 0;
    int result = LABIAL_OK;
    python->delivered = 0;
    while (python->delivered < python->capacity && (ticks == 0 || made < ticks)) {
        const uint32_t used = python->used;
        result = labial_python_feed(python);
        if (result < 0)
            break;
        result = labial_tick(&python->stream);
        made++;
        if (result < 0 || result == LABIAL_DONE)
            break;
        idle = result == LABIAL_OK || python->used != used ? 0 : idle + 1u;
        if (ticks == 0 && (idle > delay || (result == LABIAL_STARVED && idle > 0))) {
            result = LABIAL_STARVED;
            break;
        }
    }
    return result;
}

int labial_python_cancel(labial_python_t *python, uint32_t milliseconds)
{
    return labial_cancel(&python->stream, milliseconds);
}

int labial_python_restart(labial_python_t *python)
{
    return labial_restart(&python->stream);
}

void labial_python_latency(const labial_python_t *python, labial_latency_t *latency)
{
    *latency = labial_latency(&python->stream);
}

int labial_python_model(const labial_model_t *model, labial_python_model_t *about)
{
    if (!model || !about)
        return LABIAL_ERROR_NULL;
    about->frames_per_second = model->frames_per_second;
    about->search_stride = model->search_stride;
    about->phonemes = model->phoneme_count;
    about->silence = model->silence;
    return LABIAL_OK;
}

int labial_python_laugh(uint32_t milliseconds, uint32_t intensity, uint32_t seed, uint32_t model,
                        labial_python_item_t *items, uint32_t capacity)
{
    labial_laugh_t laugh;
    unsigned phoneme;
    uint32_t length;
    int count = 0;
    const int result = labial_laugh_begin(&laugh, milliseconds, intensity, seed);
    if (result != LABIAL_OK)
        return result;
    while ((uint32_t)count < capacity && labial_laugh_next(&laugh, &phoneme, &length) == LABIAL_OK) {
        items[count].model = model;
        items[count].phoneme = phoneme;
        items[count].milliseconds = length;
        count++;
    }
    return count;
}

const char *labial_python_label(const labial_names_t *names, uint32_t phoneme)
{
    return phoneme < names->phoneme_count ? names->labels[phoneme] : NULL;
}
