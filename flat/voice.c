/*
 * voice.c - a voice that is followed, without structures (flat.h).
 */
#include "flat.h"

#include <string.h>

#include "words_en.h"

/* Times that are beyond every limit, seconds. */
#define FAR 1e9

/* The voice's memory lies behind it. */
#define VOICE_BYTES ((uint32_t)(sizeof(labial_voice_t) + 7u) / 8u * 8u)

static uint32_t memory_size(const labial_model_t *model, uint32_t places)
{
    return labial_workspace_size(model) + (uint32_t)sizeof(struct labial_voice_place) * places;
}

FLAT_RETURNS(uint32_t voice_size(const labial_model_t *model, uint32_t places),
             VOICE_BYTES + memory_size(model, places))
FLAT_RETURNS(uint32_t voice_items_size(uint32_t count), (uint32_t)sizeof(labial_voice_item_t) * count)

int voice_init(labial_voice_t *voice, const labial_model_t *model, uint32_t places, const uint8_t *numbers,
               int32_t offset)
{
    int result = labial_voice_init(voice, model, (char *)voice + VOICE_BYTES, memory_size(model, places));
    if (result == LABIAL_OK)
        result = labial_voice_words(voice, &words_en, NULL);
    if (result == LABIAL_OK)
        result = labial_voice_numbers(voice, numbers);
    return result == LABIAL_OK ? labial_voice_offset(voice, offset) : result;
}

FLAT_RETURNS(int voice_words(labial_voice_t *voice, const labial_words_own_t *own),
             labial_voice_words(voice, &words_en, own))
FLAT_RETURNS(int voice_pronounce(labial_voice_t *voice, labial_voice_own_fn own),
             labial_voice_pronounce(voice, own, NULL))

/* Microseconds of seconds; UINT64_MAX - 1 for what is no time. */
static uint64_t microseconds(double seconds)
{
    return seconds >= 0.0 && seconds < FAR ? (uint64_t)(seconds * 1e6 + 0.5) : UINT64_MAX - 1u;
}

int voice_tell(labial_voice_t *voice, void *memory, uint32_t count, const double *times, const uint16_t *sizes,
               const char *texts, uint32_t utterance, uint32_t key, uint32_t gap, unsigned kind, unsigned counted)
{
    labial_voice_item_t *const items = (labial_voice_item_t *)memory;
    labial_voice_message_t message;
    for (uint32_t i = 0; i < count; i++) {
        labial_voice_item_t *const item = items + i;
        memset(item, 0, sizeof *item);
        item->start = microseconds(times[2 * i]);
        item->end = times[2 * i + 1] < 0.0 ? LABIAL_VOICE_NO_END : microseconds(times[2 * i + 1]);
        if (kind == LABIAL_VOICE_PHONEMES) {
            item->phoneme = (uint8_t)texts[i];
            continue;
        }
        item->text = texts;
        item->size = sizes[i];
        texts += item->size;
    }
    memset(&message, 0, sizeof message);
    message.items = items;
    message.count = count;
    message.utterance = utterance;
    message.key = key;
    message.gap = (uint16_t)gap;
    message.kind = (uint8_t)kind;
    message.times = (uint8_t)counted;
    return labial_voice_tell(voice, &message);
}

FLAT_RETURNS(uint32_t voice_identity(const char *text, uint32_t size), labial_voice_identity(text, size))
FLAT_RETURNS(int voice_begin(labial_voice_t *voice, double at, uint32_t utterance),
             labial_voice_begin(voice, at < 0.0 ? LABIAL_VOICE_BEHIND : (uint64_t)(at * 1e3 + 0.5), utterance))
FLAT_RETURNS(int voice_finish(labial_voice_t *voice), labial_voice_finish(voice))
FLAT_RETURNS(int voice_cancel(labial_voice_t *voice, uint32_t milliseconds), labial_voice_cancel(voice, milliseconds))

int voice_frame(labial_voice_t *voice, uint32_t due, int16_t *faps)
{
    const uint32_t rate = voice->model->frames_per_second;
    return labial_voice_next(voice, ((uint64_t)due * 1000u + rate - 1u) / rate, NULL, faps);
}

FLAT_RETURNS(int voice_visemes(const labial_voice_t *voice, uint8_t *shares), labial_voice_visemes(voice, shares))
FLAT_RETURNS(uint32_t voice_next(const labial_voice_t *voice), voice->next)
FLAT_RETURNS(int voice_done(labial_voice_t *voice), labial_voice_done(voice))
FLAT_RETURNS(int voice_finished(const labial_voice_t *voice), voice->finished)
FLAT_RETURNS(int voice_cancelled(const labial_voice_t *voice), voice->cancelled)
FLAT_RETURNS(int voice_ease(labial_voice_t *voice, int16_t *faps), labial_voice_ease(voice, faps))

void voice_counts(const labial_voice_t *voice, uint32_t *out)
{
    const labial_voice_counts_t counts = labial_voice_counts(voice);
    out[0] = counts.told;
    out[1] = counts.skipped;
    out[2] = counts.dropped;
}

/* Moves `count` addresses that lie one behind the other; null ones stay. */
static void move_addresses(void *addresses, unsigned count, size_t further)
{
    for (unsigned i = 0; i < count; i++) {
        uintptr_t address;
        char *const at = (char *)addresses + i * sizeof address;
        memcpy(&address, at, sizeof address);
        if (address)
            address += further;
        memcpy(at, &address, sizeof address);
    }
}

void voice_move(labial_model_t *model, size_t further)
{
    const size_t first = offsetof(labial_model_t, phonemes), last = offsetof(labial_model_t, channels);
    move_addresses((char *)model + first, (unsigned)((last - first) / sizeof(void *)) + 1u, further);
    for (unsigned k = 0; k < model->channel_count; k++) {
        labial_channel_t channel;
        memcpy(&channel, model->channels + k, sizeof channel);
        move_addresses((char *)&channel + offsetof(labial_channel_t, emissions), 4, further);
        memcpy((void *)(uintptr_t)(model->channels + k), &channel, sizeof channel);
    }
}
