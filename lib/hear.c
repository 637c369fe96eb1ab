/*
 * hear.c - the calls of labial/hear.h: samples in, frames out.
 *
 *     samples --convert--> 16 kHz --features--> two hops --network--> heads --motion--> pose --fade--> callback
 *     any rate             window               a frame   the frame `ahead` frames ago  the one before
 *
 * A callback may initialise its stream anew, which the caller sees by `busy`: then it returns, and touches nothing
 * more.
 */
#include "labial/hear.h"

#include <string.h>

#include "articulation.h"
#include "fade.h"
#include "fixed.h"
#include "hear_parts.h"

#define HEAR_FRAME_MS (1000u / LABIAL_HEAR_FPS)

/* LABIAL_OK for an initialised stream, else the error that every call on it returns. */
static int usable(const labial_hear_t *hear)
{
    return !hear ? LABIAL_ERROR_NULL : hear->magic != LABIAL_HEAR_MAGIC_ || hear->busy ? LABIAL_ERROR_STATE : LABIAL_OK;
}

/* ---- Frames out. These return 0 when a callback has initialised the stream anew. --------------------------------- */

/* Delivers a pose, Q4, or the neutral face, as far as the fade leads there. */
static int tell_frame(labial_hear_t *hear, const int16_t *pose)
{
    int16_t faps[LABIAL_CHANNELS] = { 0 }; /* the neutral face, before the pose */
    labial_fade_to(&hear->fade, pose ? pose : faps);
    labial_fade_faps(&hear->fade, faps);
    hear->busy = 1;
    hear->callback(hear->user, hear->frame++, faps);
    if (!hear->busy)
        return 0;
    hear->busy = 0;
    return 1;
}

/* Delivers the way to rest. */
static int tell_way_to_rest(labial_hear_t *hear, unsigned frames)
{
    labial_fade_begin(&hear->fade, frames, frames, 0);
    if (hear->told != LABIAL_HEAR_NOTHING_)
        hear->told = LABIAL_HEAR_WAY_TO_REST_;
    for (; frames > 0; frames--)
        if (!tell_frame(hear, NULL))
            return 0;
    return 1;
}

/* Tells the class of the frames before the next one, if there are any. */
static int tell_class(labial_hear_t *hear)
{
    const uint32_t first = hear->first;
    hear->first = hear->frame;
    if (!hear->class_callback || hear->frame == first)
        return 1;
    hear->busy = 1;
    hear->class_callback(hear->user, hear->shown, first, hear->frame - first);
    if (!hear->busy)
        return 0;
    hear->busy = 0;
    return 1;
}

/* Delivers the frame before that of these heads, if there is one. */
static int deliver_heads(labial_hear_t *hear, const int16_t *heads)
{
    const uint8_t leader = hear->motion.leader;
    int16_t pose[LABIAL_CHANNELS];
    if (!labial_hear_motion_next(&hear->motion, hear->network.model, heads, pose))
        return 1;
    hear->sounding--;
    if (leader != hear->shown && !tell_class(hear))
        return 0;
    hear->earlier = hear->told == LABIAL_HEAR_NOTHING_ ? leader : hear->shown;
    hear->shown = leader;
    hear->told = LABIAL_HEAR_SOUND_;
    return tell_frame(hear, pose);
}

/* ---- Sound in; the same ------------------------------------------------------------------------------------------ */

/* Hears a sample at 16 kHz. */
static int hear_sample(labial_hear_t *hear, int16_t sample)
{
    const int16_t *heads;
    if (!labial_hear_features_take(&hear->features, sample))
        return 1;
    labial_hear_motion_hear(&hear->motion, hear->features.loud);
    heads = labial_hear_network(&hear->network, hear->features.bands, hear->features.window);
    return !heads || deliver_heads(hear, heads);
}

/* The same for a sample of the sound, not of the silence that follows it. */
static int hear_sound(labial_hear_t *hear, int16_t sample)
{
    hear->sounding += !labial_hear_features_begun(&hear->features);
    return hear_sample(hear, sample);
}

/* Hears a sample at the sound's rate. */
static int hear_at_rate(labial_hear_t *hear, int32_t sample)
{
    int16_t out[LABIAL_HEAR_CONVERTED_MAX];
    unsigned i, count;
    if (hear->convert.reach == 0)
        return hear_sound(hear, (int16_t)sample);
    count = labial_hear_convert(&hear->convert, sample, out);
    for (i = 0; i < count; i++)
        if (!hear_sound(hear, out[i]))
            return 0;
    return 1;
}

/* Hears samples at the sound's rate, of one channel. At 16 kHz most of them only fill a window. */
static void hear_mono(labial_hear_t *hear, const int16_t *samples, size_t count)
{
    size_t i = 0;
    if (hear->convert.reach > 0) {
        while (i < count && hear_at_rate(hear, samples[i]))
            i++;
        return;
    }
    while (i < count) {
        i += labial_hear_features_fill(&hear->features, samples + i, count - i);
        if (i < count && !hear_sound(hear, samples[i++]))
            return;
    }
}

/* Hears what is still to come when the sound is over. The last sample stays: an offset does not end with a step. */
static int hear_rest(labial_hear_t *hear)
{
    const int32_t last = labial_hear_convert_last(&hear->convert);
    int16_t silence;
    unsigned i;
    for (i = hear->convert.reach; i > 0; i--)
        if (!hear_at_rate(hear, last))
            return 0;
    silence = labial_hear_features_last(&hear->features);
    while (hear->sounding > 0) /* silence fills a frame that has begun, and follows it */
        if (!hear_sample(hear, silence))
            return 0;
    return tell_class(hear);
}

/* Forgets the sound but for its level: there was silence before, and what follows fades in. */
static void reset_sound(labial_hear_t *hear)
{
    labial_fade_begin(&hear->fade, LABIAL_FADE_STEPS, LABIAL_FADE_STEPS, 0);
    hear->sounding = 0;
    hear->told = LABIAL_HEAR_NOTHING_;
    hear->first = hear->frame;
    labial_hear_convert_reset(&hear->convert);
    labial_hear_features_reset(&hear->features);
    labial_hear_network_reset(&hear->network);
    labial_hear_motion_reset(&hear->motion);
}

/* ---- The calls --------------------------------------------------------------------------------------------------- */

int labial_hear_init(labial_hear_t *hear, const labial_hear_model_t *model, uint32_t samples_per_second,
                     unsigned channels, void *workspace, size_t workspace_size, labial_frame_fn callback, void *user)
{
    if (!hear)
        return LABIAL_ERROR_NULL;
    memset(hear, 0, sizeof *hear);
    if (!model || !workspace || !callback)
        return LABIAL_ERROR_NULL;
    if (model->format != LABIAL_HEAR_MODEL_FORMAT)
        return LABIAL_ERROR_VERSION;
    if (channels < 1u || channels > 2u || model->units > LABIAL_HEAR_UNITS_MAX)
        return LABIAL_ERROR_RANGE;
    if (labial_hear_convert_init(&hear->convert, samples_per_second) != LABIAL_OK)
        return LABIAL_ERROR_SAMPLE_RATE;
    if (((uintptr_t)workspace & 3u) || workspace_size < labial_hear_workspace_size(model))
        return LABIAL_ERROR_WORKSPACE;
    hear->channels = (uint8_t)channels;
    hear->callback = callback;
    hear->user = user;
    hear->network.model = model;
    hear->network.rows = (int16_t *)workspace;
    hear->motion.articulation.wanted = 100;
    hear->features.level.level = LABIAL_HEAR_LEVEL_BEGIN * (LABIAL_HEAR_LEVEL_ONE / 256);
    reset_sound(hear);
    hear->magic = LABIAL_HEAR_MAGIC_;
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
        hear_mono(hear, samples, count);
    else
        for (; count > 0 && hear_at_rate(hear, (samples[0] + samples[1]) >> 1); count--)
            samples += 2;
    return LABIAL_OK;
}

int labial_hear_end(labial_hear_t *hear)
{
    const int result = usable(hear);
    if (result != LABIAL_OK || hear->ended || !hear_rest(hear))
        return result;
    hear->ended = 1;
    if (!hear->exact && !labial_fade_rests(&hear->fade))
        (void)tell_way_to_rest(hear, LABIAL_EASE_FRAMES);
    return LABIAL_OK;
}

int labial_hear_exact(labial_hear_t *hear, int exact)
{
    const int result = usable(hear);
    if (result == LABIAL_OK)
        hear->exact = exact != 0;
    return result;
}

int labial_hear_articulation(labial_hear_t *hear, unsigned percent)
{
    const int result = usable(hear);
    if (result == LABIAL_OK)
        labial_articulation_set(&hear->motion.articulation, percent, !hear->motion.held);
    return result;
}

int labial_hear_cancel(labial_hear_t *hear, uint32_t milliseconds)
{
    const int result = usable(hear);
    if (result != LABIAL_OK || !tell_class(hear) ||
        !tell_way_to_rest(hear, labial_fade_frames(milliseconds, LABIAL_HEAR_FPS)))
        return result;
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

int labial_hear_set_level(labial_hear_t *hear, unsigned level)
{
    const int result = usable(hear);
    if (result != LABIAL_OK)
        return result;
    if (hear->sounding > 0)
        return LABIAL_ERROR_STATE;
    if (level < LABIAL_HEAR_LEVEL_MIN || level > LABIAL_HEAR_LEVEL_MAX)
        return LABIAL_ERROR_RANGE;
    hear->features.level.level = (int32_t)level * (LABIAL_HEAR_LEVEL_ONE / 256);
    return LABIAL_OK;
}

unsigned labial_hear_level(const labial_hear_t *hear)
{
    if (!hear || hear->magic != LABIAL_HEAR_MAGIC_)
        return 0;
    return labial_quotient((uint32_t)hear->features.level.level, LABIAL_HEAR_LEVEL_ONE / 256u);
}

labial_latency_t labial_hear_latency(const labial_hear_t *hear)
{
    labial_latency_t latency = { 0, 0, 0, 0, 0 };
    if (hear && hear->magic == LABIAL_HEAR_MAGIC_) {
        const uint32_t stride = hear->convert.spacing * 10u, step = hear->convert.step;
        const uint32_t frame = labial_quotient(2u * LABIAL_HEAR_HOP_ * step, stride); /* samples */
        latency.frames = hear->sounding;
        latency.milliseconds = hear->sounding * HEAR_FRAME_MS;
        latency.delay = hear->network.model->ahead + 2u;
        /* The last converted sample comes one step before the frames' end, and needs `reach` samples after the one on
         * its left. */
        latency.delay_milliseconds =
            latency.delay * HEAR_FRAME_MS +
            labial_quotient((hear->convert.reach + 1u - labial_quotient(step + stride - 1u, stride)) * HEAR_FRAME_MS +
                                frame - 1u,
                            frame);
    }
    return latency;
}
