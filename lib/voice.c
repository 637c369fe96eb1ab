/*
 * voice.c - a voice that is followed: the calls of labial/voice.h.
 *
 *     message --rules--> items --plan--> segments --stream--> motion --fade--> frames
 *
 * The stream is given segments when it needs them. Items for the time before may change some that it has: with
 * the next frame they are compared, and if they differ, a new stream is given all from two to three seconds before, and
 * the difference between its motion and the last frame fades.
 */
#include "voice_parts.h"

#include <string.h>

#include "fade.h"

/* Places that are used at most. */
#define PLACES_MAX 0x1000000u

/* ---- Utterances -------------------------------------------------------------------------------------------------- */

/* The utterances before `position` end at `origin` at the latest. */
static void end_before(labial_voice_t *voice, unsigned position, int64_t origin)
{
    unsigned i;
    for (i = 0; i < position; i++)
        if (voice->utterances[i].limit > origin)
            voice->utterances[i].limit = origin;
    voice->changed = voice->stale = 1;
}

/* Appends an utterance, unless there are as many as there may be. One that nothing was told of gives its place up; what
 * is queued behind it is then queued as it was. */
static int append_utterance(labial_voice_t *voice, int64_t origin, uint32_t identity, int is_queued)
{
    labial_voice_utterance_t *utterance;
    if (voice->utterance_count > 0u) {
        utterance = voice->utterances + voice->utterance_count - 1u;
        if (utterance->places == 0u && utterance->identity == 0u) {
            voice->utterance_count--;
            is_queued &= utterance->queued;
        } else if (voice->utterance_count >= LABIAL_VOICE_UTTERANCES) {
            return LABIAL_ERROR_FULL;
        }
    }
    end_before(voice, voice->utterance_count, origin);
    utterance = voice->utterances + voice->utterance_count++;
    memset(utterance, 0, sizeof *utterance);
    utterance->origin = origin;
    utterance->limit = INT64_MAX;
    utterance->identity = identity;
    utterance->first = voice->used;
    utterance->kind = LABIAL_VOICE_NO_KIND;
    utterance->serial = ++voice->serial;
    utterance->queued = (uint8_t)is_queued;
    return LABIAL_OK;
}

/* The position of the utterance of an identity behind 0; -1 without one. */
static int position_of(const labial_voice_t *voice, uint32_t identity)
{
    unsigned i;
    for (i = voice->utterance_count; i > 0u; i--)
        if (voice->utterances[i - 1u].identity == identity)
            return (int)i - 1;
    return -1;
}

/* The next utterance behind all others. */
static int append_behind(labial_voice_t *voice, uint32_t identity)
{
    const int64_t now = labial_voice_now(voice);
    int64_t end = 0;
    int result;
    if (voice->utterance_count > 0u)
        end = labial_voice_end(voice, voice->utterance_count - 1u);
    result = append_utterance(voice, end > now ? end : now, identity, 1);
    if (result == LABIAL_OK)
        voice->finished = voice->cancelled = 0;
    return result;
}

/* Moves the utterances behind one that are queued and begin after `moment`. */
static void requeue_after(labial_voice_t *voice, unsigned position, int64_t moment)
{
    for (; position + 1u < voice->utterance_count; position++) {
        labial_voice_utterance_t *const utterance = voice->utterances + position;
        const int64_t end = labial_voice_end(voice, position);
        if (!utterance[1].queued || utterance[1].origin <= moment || end <= utterance[1].origin ||
            utterance[1].limit <= utterance[1].origin)
            return;
        utterance->limit = utterance[1].origin = end;
        voice->stale = 1;
    }
}

void labial_voice_requeue(labial_voice_t *voice, unsigned position)
{
    requeue_after(voice, position, labial_voice_now(voice));
}

int labial_voice_utterance_of(labial_voice_t *voice, uint32_t identity, uint32_t places)
{
    labial_voice_utterance_t *last = voice->utterances + voice->utterance_count - 1u;
    int result = LABIAL_OK;
    if (identity) {
        const int position = position_of(voice, identity);
        if (position >= 0)
            return position;
        if (labial_voice_is_over(voice, identity))
            return LABIAL_VOICE_IS_OVER;
    }
    if (voice->finished || (identity && last->identity)) {
        if (places == 0u)
            return LABIAL_VOICE_HAS_NONE;
        if (places > labial_voice_free(voice))
            return LABIAL_ERROR_FULL;
        result = append_behind(voice, identity);
        if (result == LABIAL_OK)
            voice->utterances[voice->utterance_count - 1u].early = 1;
    }
    if (result != LABIAL_OK)
        return result;
    last = voice->utterances + voice->utterance_count - 1u;
    if (identity)
        last->identity = identity;
    return (int)voice->utterance_count - 1;
}

/* The sound of an utterance that waited, or whose sound was not heard of yet, begins; those behind it wait. */
static void place_utterance(labial_voice_t *voice, unsigned position, int64_t origin)
{
    labial_voice_utterance_t *const utterance = voice->utterances + position;
    utterance->origin = origin;
    utterance->queued = 0;
    end_before(voice, position, origin);
    requeue_after(voice, position, INT64_MIN);
}

/* The position of the first utterance that was told before labial_voice_begin() said that its sound begins at `at`: it
 * began by itself and is not over, or nothing of it would be heard otherwise; else -1. */
static int told_before(labial_voice_t *voice, uint64_t at)
{
    unsigned i;
    for (i = 0; at != LABIAL_VOICE_BEHIND && i < voice->utterance_count; i++) {
        const labial_voice_utterance_t *const utterance = voice->utterances + i;
        if (!utterance->queued || utterance->places == 0u || utterance->limit <= utterance->origin)
            continue;
        if ((int64_t)at <= utterance->origin ||
            (utterance->early && labial_voice_end(voice, i) > labial_voice_now(voice)))
            return (int)i;
    }
    return -1;
}

/* ---- Beginning and end ------------------------------------------------------------------------------------------- */

int labial_voice_init(labial_voice_t *voice, const labial_model_t *model, void *memory, size_t size)
{
    uint32_t workspace;
    if (!voice)
        return LABIAL_ERROR_NULL;
    memset(voice, 0, sizeof *voice);
    if (!model || !memory)
        return LABIAL_ERROR_NULL;
    if (model->format != LABIAL_MODEL_FORMAT)
        return LABIAL_ERROR_VERSION;
    workspace = labial_workspace_size(model);
    if (((uintptr_t)memory & 3u) || size < workspace + sizeof *voice->items)
        return LABIAL_ERROR_WORKSPACE;
    size = (size - workspace) / sizeof *voice->items;
    voice->model = model;
    voice->workspace = (uint32_t *)memory;
    voice->workspace_size = workspace;
    voice->items = (labial_voice_place_t *)(void *)((char *)memory + workspace);
    voice->room = (uint32_t)(size < PLACES_MAX ? size : PLACES_MAX);
    return append_utterance(voice, 0, 0, 1);
}

int labial_voice_numbers(labial_voice_t *voice, const uint8_t numbers[LABIAL_ARPABET_PHONEMES])
{
    unsigned i;
    const int result = labial_voice_status(voice);
    if (result != LABIAL_OK)
        return result;
    for (i = 0; numbers && i < LABIAL_ARPABET_PHONEMES; i++)
        if (numbers[i] >= voice->model->phoneme_count)
            return LABIAL_ERROR_PHONEME;
    voice->numbers = numbers;
    voice->changed = voice->stale = 1;
    return LABIAL_OK;
}

int labial_voice_offset(labial_voice_t *voice, int32_t milliseconds)
{
    const int result = labial_voice_status(voice);
    if (result != LABIAL_OK)
        return result;
    if (milliseconds > (int32_t)LABIAL_VOICE_LATEST || milliseconds < -(int32_t)LABIAL_VOICE_LATEST)
        return LABIAL_ERROR_RANGE;
    voice->offset = milliseconds;
    voice->changed = voice->stale = 1;
    return LABIAL_OK;
}

int labial_voice_begin(labial_voice_t *voice, uint64_t at, uint32_t utterance)
{
    unsigned i;
    int position, was_cancelled, result = labial_voice_status(voice);
    if (result != LABIAL_OK)
        return result;
    was_cancelled = voice->cancelled;
    if (at != LABIAL_VOICE_BEHIND && at > LABIAL_VOICE_CLOCK)
        return LABIAL_ERROR_RANGE;
    position = utterance ? position_of(voice, utterance) : told_before(voice, at);
    if (position >= 0 && voice->utterances[position].queued) {
        if (at != LABIAL_VOICE_BEHIND)
            place_utterance(voice, (unsigned)position, (int64_t)at);
        return LABIAL_OK;
    }
    labial_voice_forget(voice, labial_voice_now(voice) - (int64_t)LABIAL_VOICE_HISTORY * 1000);
    if (at == LABIAL_VOICE_BEHIND)
        result = append_behind(voice, utterance);
    else
        result = append_utterance(voice, (int64_t)at, utterance, 0);
    if (result != LABIAL_OK)
        return result;
    voice->utterances[voice->utterance_count - 1u].early = was_cancelled && at == LABIAL_VOICE_BEHIND;
    voice->finished = voice->cancelled = 0;
    for (i = 0; i < LABIAL_VOICE_UTTERANCES; i++)
        if (voice->gone[i] == utterance)
            voice->gone[i] = 0;
    return LABIAL_OK;
}

int labial_voice_finish(labial_voice_t *voice)
{
    const int result = labial_voice_status(voice);
    if (result == LABIAL_OK)
        voice->finished = 1;
    return result;
}

int labial_voice_cancel(labial_voice_t *voice, uint32_t milliseconds)
{
    const int result = labial_voice_status(voice);
    if (result != LABIAL_OK)
        return result;
    while (voice->utterance_count > 0u)
        labial_voice_remove_utterance(voice, voice->utterance_count - 1u);
    voice->cancelled = voice->changed = 1;
    voice->streaming = 0;
    memset(voice->made, 0, sizeof voice->made);
    labial_voice_begin_fade(voice, labial_fade_frames(milliseconds, voice->model->frames_per_second));
    return LABIAL_OK;
}

int64_t labial_voice_latest(labial_voice_t *voice)
{
    unsigned i;
    int64_t latest = -1;
    for (i = 0; i < voice->utterance_count; i++) {
        const int64_t limit = voice->utterances[i].limit;
        int64_t end;
        if (voice->utterances[i].places == 0u)
            continue;
        end = labial_voice_end(voice, i);
        if (end > limit)
            end = limit;
        if (end > latest)
            latest = end;
    }
    return latest;
}

int labial_voice_done(labial_voice_t *voice)
{
    int64_t latest;
    if (labial_voice_status(voice) != LABIAL_OK || voice->step != voice->steps)
        return 0;
    latest = labial_voice_latest(voice);
    if (latest < 0)
        return voice->finished || voice->cancelled;
    if (voice->eased && !voice->changed)
        return voice->finished;
    latest += voice->offset + (int64_t)LABIAL_VOICE_REST;
    return voice->finished && (int64_t)voice->next * 1000 >= latest * voice->model->frames_per_second;
}

labial_voice_counts_t labial_voice_counts(const labial_voice_t *voice)
{
    static const labial_voice_counts_t none = { 0, 0, 0 };
    return labial_voice_status(voice) == LABIAL_OK ? voice->counts : none;
}
