/*
 * hear.c - the calls of labial/hear.h: samples in, frames out.
 *
 *     samples --convert--> 16 kHz --features--> two hops --network--> heads --pose--> fade --> callback
 *     any rate             window               a frame   the frame `ahead` frames ago
 *
 * What the network tells of single frames moves faster than lips, so a pose is delivered with a quarter of the one
 * before and of the one after it, which it waits for.
 *
 * Silence is rest, whatever the network makes of it: as the frames after the one that is delivered are known, the face
 * leaves rest so early that it is all there when the sound begins.
 *
 * The window's samples, its spectrum and what layers put out share their memory, since each is done with before the
 * next one begins; only the samples that the next window needs are kept aside.
 */
#include "labial/hear.h"

#include <string.h>

#include "fade.h"
#include "fixed.h"
#include "hear_convert.h"
#include "hear_features.h"
#include "hear_network.h"

#define HEARING 0x48454152u /* "HEAR" */

/* Samples that a window shares with the next one. */
#define SHARED (LABIAL_HEAR_WINDOW_ - LABIAL_HEAR_HOP_)

/* The longest easing of a cancel, milliseconds. */
#define EASING 1000u

/* Sound that stays within this span for a frame is silent. */
#define SILENT_SPAN 32

/* A frame is silent when it, as many before it and all known ones after it are; the face comes to rest, and leaves it, in
 * as many frames as are known after the first of them. */
#define SILENT_BEFORE 2u
#define RESTING 5u

uint32_t labial_hear_workspace_size(const labial_hear_model_t *model)
{
    return model ? LABIAL_HEAR_WORKSPACE_SIZE((uint32_t)model->units, model->rows) : 0;
}

/* LABIAL_OK for an initialised stream, else the error that every call on it returns. */
static int usable(const labial_hear_t *hear)
{
    return !hear ? LABIAL_ERROR_NULL : hear->magic != HEARING || hear->busy ? LABIAL_ERROR_STATE : LABIAL_OK;
}

/* ---- Frames out --------------------------------------------------------------------------------------------------- */

/* Delivers a pose, Q4, or the neutral face, as far as the fade leads there. */
static void tell_frame(labial_hear_t *hear, const int16_t *pose)
{
    int16_t faps[LABIAL_CHANNELS];
    labial_fade_to(&hear->fade, pose);
    labial_fade_faps(&hear->fade, faps);
    hear->busy = 1;
    hear->callback(hear->user, hear->frame++, faps);
    hear->busy = 0;
}

/* Delivers the way to rest. */
static void tell_way_to_rest(labial_hear_t *hear, unsigned frames)
{
    labial_fade_begin(&hear->fade, frames, 0);
    for (; frames > 0; frames--)
        tell_frame(hear, NULL);
}

/* Tells the class of the frames before the next one, if there are any. */
static void tell_class(labial_hear_t *hear)
{
    const uint32_t first = hear->first;
    hear->first = hear->frame;
    if (hear->class_callback && hear->frame != first) {
        hear->busy = 1;
        hear->class_callback(hear->user, hear->shown, first, hear->frame - first);
        hear->busy = 0;
    }
}

/* Delivers the frame before that of these heads, if there is one: it is smoothed with its neighbours. */
static void deliver_heads(labial_hear_t *hear, const int16_t *heads)
{
    const uint8_t leader = hear->leader;
    int16_t next[LABIAL_CHANNELS], pose[LABIAL_CHANNELS];
    int32_t share;
    unsigned k;
    hear->leader = (uint8_t)labial_hear_leader(hear->model, heads);
    labial_hear_pose(hear->model, heads, next);
    if (!hear->held) {
        hear->held = 1;
        memcpy(hear->before, next, sizeof hear->before);
        memcpy(hear->now, next, sizeof hear->now);
        return;
    }
    hear->sounding--;
    if (leader != hear->shown)
        tell_class(hear);
    hear->shown = leader;
    if (hear->silent > SILENT_BEFORE + hear->model->ahead + 1u)
        hear->rest = (uint8_t)(hear->rest < RESTING ? hear->rest + 1u : RESTING);
    else
        hear->rest = (uint8_t)(hear->rest > 0 ? hear->rest - 1u : 0u);
    share = labial_ease(RESTING - hear->rest, RESTING);
    for (k = 0; k < LABIAL_CHANNELS; k++) {
        pose[k] = (int16_t)((hear->before[k] + 2 * (int32_t)hear->now[k] + next[k] + 2) >> 2);
        pose[k] = (int16_t)((pose[k] * share + 8192) >> 14);
        hear->before[k] = hear->now[k];
        hear->now[k] = next[k];
    }
    tell_frame(hear, pose);
}

/* ---- Sound in ---------------------------------------------------------------------------------------------------- */

/* Whether the samples that a window has beyond the one before it are silent. */
static int is_silent(const labial_hear_t *hear)
{
    int32_t least = hear->window[SHARED], most = least;
    unsigned i;
    for (i = SHARED + 1u; i < LABIAL_HEAR_WINDOW_; i++) {
        least = hear->window[i] < least ? hear->window[i] : least;
        most = hear->window[i] > most ? hear->window[i] : most;
    }
    return most - least <= SILENT_SPAN;
}

/* Hears a window that is complete. */
static void hear_window(labial_hear_t *hear)
{
    const int16_t *heads = NULL;
    if (!is_silent(hear))
        hear->loud = 1;
    memcpy(hear->tail, hear->window + LABIAL_HEAR_HOP_, sizeof hear->tail);
    labial_hear_features(hear->window, &hear->level, hear->features + hear->hop * LABIAL_HEAR_BANDS);
    hear->hop ^= 1u;
    if (hear->hop == 0) {
        hear->silent = (uint8_t)(hear->loud ? 0u : hear->silent < UINT8_MAX ? hear->silent + 1u : UINT8_MAX);
        hear->loud = 0;
        heads = labial_hear_network(hear);
    }
    if (heads)
        deliver_heads(hear, heads);
    memcpy(hear->window, hear->tail, sizeof hear->tail);
    hear->filled = SHARED;
}

/* Hears a sample at 16 kHz. */
static void hear_sample(labial_hear_t *hear, int16_t sample)
{
    if (hear->filled == SHARED && hear->hop == 0)
        hear->sounding++;
    hear->window[hear->filled++] = sample;
    if (hear->filled == LABIAL_HEAR_WINDOW_)
        hear_window(hear);
}

/* Hears a sample at the stream's rate. */
static void hear_at_rate(labial_hear_t *hear, int32_t sample)
{
    int16_t out[LABIAL_HEAR_CONVERTED_MAX];
    unsigned i, count;
    if (hear->convert.reach == 0) {
        hear_sample(hear, (int16_t)sample);
        return;
    }
    count = labial_hear_convert(&hear->convert, sample, out);
    for (i = 0; i < count; i++)
        hear_sample(hear, out[i]);
}

/* Forgets the sound: there was silence before, and what follows fades in. */
static void reset_sound(labial_hear_t *hear)
{
    hear->hop = hear->held = hear->loud = 0;
    hear->silent = UINT8_MAX;
    hear->rest = RESTING;
    labial_fade_begin(&hear->fade, LABIAL_FADE_STEPS, 0);
    hear->filled = SHARED;
    hear->sounding = 0;
    hear->first = hear->frame;
    hear->level = LABIAL_HEAR_LEVEL_LEAST;
    memset(hear->window, 0, sizeof hear->window);
    labial_hear_convert_reset(&hear->convert);
    labial_hear_network_reset(hear);
}

/* ---- The calls --------------------------------------------------------------------------------------------------- */

int labial_hear_init(labial_hear_t *hear, const labial_hear_model_t *model, uint32_t rate, unsigned channels,
                     void *workspace, size_t workspace_size, labial_frame_fn callback, void *user)
{
    if (!hear)
        return LABIAL_ERROR_NULL;
    memset(hear, 0, sizeof *hear);
    if (!model || !workspace || !callback)
        return LABIAL_ERROR_NULL;
    if (model->format != LABIAL_HEAR_MODEL_FORMAT)
        return LABIAL_ERROR_VERSION;
    if (channels < 1u || channels > 2u || labial_hear_convert_init(&hear->convert, rate) != LABIAL_OK)
        return LABIAL_ERROR_SOUND;
    if (((uintptr_t)workspace & 3u) || workspace_size < labial_hear_workspace_size(model))
        return LABIAL_ERROR_WORKSPACE;
    hear->channels = (uint8_t)channels;
    hear->model = model;
    hear->rows = (int16_t *)workspace;
    hear->callback = callback;
    hear->user = user;
    reset_sound(hear);
    hear->magic = HEARING;
    return LABIAL_OK;
}

int labial_hear_classes(labial_hear_t *hear, labial_hear_class_fn callback)
{
    const int result = usable(hear);
    if (result == LABIAL_OK)
        hear->class_callback = callback;
    return result;
}

int labial_hear_push(labial_hear_t *hear, const int16_t *samples, size_t count)
{
    const int result = usable(hear);
    if (result != LABIAL_OK)
        return result;
    if (!samples)
        return LABIAL_ERROR_NULL;
    if (hear->ended)
        return LABIAL_ERROR_STATE;
    if (hear->channels == 1u)
        for (; count > 0; count--, samples++)
            hear_at_rate(hear, samples[0]);
    else
        for (; count > 0; count--, samples += 2)
            hear_at_rate(hear, (samples[0] + samples[1]) >> 1);
    return LABIAL_OK;
}

int labial_hear_end(labial_hear_t *hear)
{
    const int result = usable(hear);
    unsigned i;
    if (result != LABIAL_OK || hear->ended)
        return result;
    for (i = hear->convert.reach; i > 0; i--)
        hear_at_rate(hear, 0);
    while (hear->filled > SHARED || hear->hop > 0) /* silence fills a frame that has begun */
        hear_sample(hear, 0);
    while (hear->sounding > 0) {
        memset(hear->window + SHARED, 0, LABIAL_HEAR_HOP_ * sizeof *hear->window);
        hear_window(hear);
    }
    tell_class(hear);
    hear->ended = 1;
    if (!hear->exact && !labial_fade_rests(&hear->fade))
        tell_way_to_rest(hear, LABIAL_EASE_FRAMES);
    return LABIAL_OK;
}

int labial_hear_exact(labial_hear_t *hear, int exact)
{
    const int result = usable(hear);
    if (result == LABIAL_OK)
        hear->exact = exact != 0;
    return result;
}

int labial_hear_cancel(labial_hear_t *hear, uint32_t milliseconds)
{
    const int result = usable(hear);
    if (result != LABIAL_OK)
        return result;
    tell_class(hear);
    tell_way_to_rest(hear, labial_fade_frames(milliseconds < EASING ? milliseconds : EASING, LABIAL_HEAR_RATE));
    reset_sound(hear);
    hear->ended = 1;
    return LABIAL_OK;
}

int labial_hear_restart(labial_hear_t *hear)
{
    const int result = usable(hear);
    if (result != LABIAL_OK)
        return result;
    if (!hear->ended)
        return LABIAL_ERROR_STATE;
    reset_sound(hear);
    hear->ended = 0;
    return LABIAL_OK;
}

uint32_t labial_hear_latency(const labial_hear_t *hear)
{
    uint32_t stride, step, frame;
    if (!hear || hear->magic != HEARING)
        return 0;
    stride = hear->convert.spacing * 10u;
    step = hear->convert.step;
    frame = labial_quotient(2u * LABIAL_HEAR_HOP_ * step, stride);
    /* The last converted sample comes one step before the frames' end, and needs `reach` samples after the one on its
     * left. */
    return (hear->model->ahead + 2u) * frame + hear->convert.reach + 1u - labial_quotient(step + stride - 1u, stride);
}
