/*
 * The stream: pushes fill the queue (units), work turns it into frames one small step at a time, ticks share the steps
 * out and play the frames.
 *
 * Why ticks of equal work suffice: a piece delivers at least half of the frames that it decodes (what it shares with
 * its successor, it does not share with its predecessor), so the work of two of its frames per tick keeps up; and half
 * a window of ready frames bridges the time in which the longest piece is decoded. Most pieces deliver more, and their
 * work is spread over as many ticks as leave half a window ready.
 */
#include <string.h>

#include "fixed.h"
#include "units.h"
#include "work.h"

#define MAGIC 0x4c41424cu /* "LABL" */

typedef char labial_limits_are_sound[LABIAL_WINDOW >= 4 && LABIAL_WINDOW <= 1000 &&
                                             LABIAL_OVERLAP >= 1 &&
                                             2 * LABIAL_OVERLAP <= LABIAL_WINDOW && LABIAL_PIECE >= 1 &&
                                             LABIAL_PIECE <= LABIAL_WINDOW && LABIAL_REACH >= 0 &&
                                             LABIAL_REACH <= 250 && 2 * LABIAL_READY >= LABIAL_WINDOW &&
                                             LABIAL_PREROLL >= 1 && LABIAL_PREROLL <= LABIAL_READY &&
                                             LABIAL_MODELS >= 1 && LABIAL_MODELS <= 255
                                         ? 1
                                         : -1];

uint32_t labial_workspace_size(const labial_model_t *model)
{
    return model ? LABIAL_WORKSPACE_SIZE(model->state_count, model->search_stride) : 0;
}

/* LABIAL_OK for an initialised stream, else the error that every call on it returns. */
static int status(const labial_t *stream)
{
    return !stream ? LABIAL_ERROR_NULL : stream->magic != MAGIC ? LABIAL_ERROR_STATE : LABIAL_OK;
}

/* ---- Input ------------------------------------------------------------------------------------------------------- */

static void forget_input(labial_t *stream)
{
    stream->queue_frames = stream->next_begin = stream->pending = 0;
    stream->queue_head = stream->queue_count = stream->next_fade_in = 0;
    stream->remainder = 500; /* so that frames are those of the rounded sum */
    stream->stage = LABIAL_STAGE_FIND;
    stream->ready_head = stream->ready_count = stream->held_count = 0;
    stream->pace = 1; /* so that the first piece is looked for */
    stream->overspent = 0;
    stream->begun = stream->rolling = 0;
    stream->ended = 0;
    stream->resumed = 0;
    stream->ease_length = stream->ease_step = 0;
}

int labial_init(labial_t *stream, const labial_model_t *model, void *workspace, size_t size, labial_frame_fn callback,
                void *user)
{
    if (!stream)
        return LABIAL_ERROR_NULL;
    stream->magic = 0;
    if (!model || !workspace || !callback)
        return LABIAL_ERROR_NULL;
    if (model->format != LABIAL_MODEL_FORMAT)
        return LABIAL_ERROR_VERSION;
    if (((uintptr_t)workspace & 3u) || size < labial_workspace_size(model))
        return LABIAL_ERROR_WORKSPACE;
    memset(stream, 0, sizeof *stream);
    stream->models[0] = model;
    stream->callback = callback;
    stream->user = user;
    stream->workspace = (uint8_t *)workspace;
    stream->workspace_size = size < UINT32_MAX ? (uint32_t)size & ~(uint32_t)3 : UINT32_MAX - 3u;
    stream->magic = MAGIC;
    forget_input(stream);
    return LABIAL_OK;
}

/* Whether phonemes of the model in `slot` are still held, or it is being decoded. */
static int is_waited_for(const labial_t *stream, unsigned slot)
{
    unsigned i;
    for (i = 0; i < stream->queue_count; i++)
        if (labial_units_segment(stream, i)->slot == slot)
            return 1;
    return stream->stage != LABIAL_STAGE_FIND && stream->piece.slot == slot;
}

int labial_use(labial_t *stream, const labial_model_t *model)
{
    unsigned slot, chosen = LABIAL_MODELS;
    const int result = status(stream);
    if (result != LABIAL_OK)
        return result;
    if (!model)
        return LABIAL_ERROR_NULL;
    if (stream->ended)
        return LABIAL_ERROR_STATE;
    if (model->format != LABIAL_MODEL_FORMAT)
        return LABIAL_ERROR_VERSION;
    if (model->frames_per_second != stream->models[stream->slot]->frames_per_second)
        return LABIAL_ERROR_RATE;
    if (stream->workspace_size < labial_workspace_size(model))
        return LABIAL_ERROR_WORKSPACE;
    for (slot = LABIAL_MODELS; slot-- > 0;) {
        if (stream->models[slot] == model) {
            chosen = slot;
            break;
        }
        if (!stream->models[slot] || !is_waited_for(stream, slot))
            chosen = slot;
    }
    if (chosen == LABIAL_MODELS)
        return LABIAL_ERROR_MODELS;
    stream->models[chosen] = model;
    stream->slot = (uint8_t)chosen;
    return LABIAL_OK;
}

int labial_push(labial_t *stream, unsigned phoneme, uint32_t milliseconds)
{
    labial_segment_t segment;
    uint32_t thousandths;
    const int result = status(stream);
    if (result != LABIAL_OK)
        return result;
    if (stream->ended)
        return LABIAL_ERROR_STATE;
    if (phoneme >= stream->models[stream->slot]->phoneme_count)
        return LABIAL_ERROR_PHONEME;
    if (milliseconds > LABIAL_DURATION_MAX)
        return LABIAL_ERROR_DURATION;
    if (stream->queue_count == LABIAL_QUEUE)
        return LABIAL_ERROR_FULL;
    thousandths = milliseconds * stream->models[stream->slot]->frames_per_second + stream->remainder;
    stream->remainder = (uint16_t)(thousandths % 1000u);
    segment.frames = thousandths / 1000u;
    segment.ms = (uint16_t)(milliseconds < 65535u ? milliseconds : 65535u);
    segment.phoneme = (uint8_t)phoneme;
    segment.slot = stream->slot;
    if (segment.frames > 0)
        labial_units_push(stream, &segment);
    stream->pending += segment.frames;
    return LABIAL_OK;
}

unsigned labial_room(const labial_t *stream)
{
    return status(stream) == LABIAL_OK && !stream->ended ? LABIAL_QUEUE - (unsigned)stream->queue_count : 0;
}

int labial_end(labial_t *stream)
{
    const int result = status(stream);
    if (result == LABIAL_OK)
        stream->ended = 1;
    return result;
}

int labial_work(labial_t *stream)
{
    unsigned spent = 0;
    int result = status(stream);
    if (result != LABIAL_OK)
        return result;
    if (stream->ease_length)
        return LABIAL_WAITING;
    result = labial_work_step(stream, &spent);
    return result == LABIAL_DONE && stream->ready_count ? LABIAL_WAITING : result;
}

/* ---- Playing ----------------------------------------------------------------------------------------------------- */

static void deliver(labial_t *stream, const int16_t faps[LABIAL_CHANNELS])
{
    stream->callback(stream->user, stream->frame, faps);
    stream->frame++;
}

static void deliver_ready(labial_t *stream)
{
    const int16_t *frame = labial_work_frame(stream, 0);
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        stream->pose[k] = (int16_t)((frame[k] + 8) >> 4);
    stream->ready_head = (uint16_t)(stream->ready_head + 1u < LABIAL_READY + LABIAL_OVERLAP ? stream->ready_head + 1u
                                                                                           : 0u);
    stream->ready_count--;
    stream->pending--;
    stream->begun = 1;
    deliver(stream, stream->pose);
}

/* The face at the present step of the way from `pose` to the neutral one. */
static void eased(const labial_t *stream, int16_t faps[LABIAL_CHANNELS])
{
    const int32_t left = 16384 - labial_ease(stream->ease_step, stream->ease_length);
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        faps[k] = (int16_t)((stream->pose[k] * left + 8192) >> 14);
}

static void deliver_eased(labial_t *stream)
{
    int16_t faps[LABIAL_CHANNELS];
    stream->ease_step++;
    eased(stream, faps);
    if (stream->ease_step == stream->ease_length) {
        stream->ease_length = 0;
        memset(stream->pose, 0, sizeof stream->pose);
    }
    deliver(stream, faps);
}

int labial_tick(labial_t *stream)
{
    unsigned spent;
    int result = status(stream);
    if (result != LABIAL_OK)
        return result;
    if (stream->ease_length) {
        deliver_eased(stream);
        return LABIAL_OK;
    }
    for (spent = stream->overspent; spent < stream->pace && result == LABIAL_OK;)
        result = labial_work_step(stream, &spent);
    stream->overspent = (uint16_t)(result == LABIAL_OK && spent > stream->pace ? spent - stream->pace : 0u);

    if (stream->ready_count >= LABIAL_PREROLL || (stream->ready_count && result != LABIAL_OK))
        stream->rolling = 1;
    if (stream->rolling && stream->ready_count) {
        deliver_ready(stream);
        return LABIAL_OK;
    }
    stream->rolling = 0;
    if (result == LABIAL_OK)
        return LABIAL_BUSY;
    if (result == LABIAL_WAITING && stream->begun)
        return LABIAL_STARVED;
    return result;
}

int labial_cancel(labial_t *stream, uint32_t milliseconds)
{
    uint32_t frames;
    const int result = status(stream);
    if (result != LABIAL_OK)
        return result;
    if (milliseconds > LABIAL_DURATION_MAX)
        milliseconds = LABIAL_DURATION_MAX;
    frames = (milliseconds * stream->models[stream->slot]->frames_per_second + 999u) / 1000u;
    if (stream->ease_length) /* cancelled again on the way */
        eased(stream, stream->pose);
    forget_input(stream);
    stream->ended = 1;
    stream->ease_length = (uint16_t)(frames < 1u ? 1u : frames < 1000u ? frames : 1000u);
    return LABIAL_OK;
}

int labial_restart(labial_t *stream)
{
    const int result = status(stream);
    if (result != LABIAL_OK)
        return result;
    if (!stream->ended || stream->pending || stream->ease_length)
        return LABIAL_ERROR_STATE;
    forget_input(stream);
    stream->resumed = stream->frame > 0;
    return LABIAL_OK;
}

labial_latency_t labial_latency(const labial_t *stream)
{
    labial_latency_t latency = { 0, 0, 0, 0 };
    if (status(stream) == LABIAL_OK) {
        const uint32_t rate = stream->models[stream->slot]->frames_per_second;
        latency.frames = stream->pending;
        latency.milliseconds = stream->pending / rate * 1000u + (stream->pending % rate * 1000u + rate / 2u) / rate;
        latency.phonemes = stream->queue_count;
        latency.ready = stream->ready_count;
    }
    return latency;
}
