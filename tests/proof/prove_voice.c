/*
 * Calls on a voice in any state, and any messages; with stand-ins for the files of its items, its plan and its frames,
 * which give any of their results.
 */
#include "voice_parts.h"

#include "prove.h"

#define MEMORY 4096u
#define TEXT 65535u /* the largest size of an item */

static labial_voice_t voice;
static labial_model_t model;
static labial_words_model_t words;
static uint32_t memory[MEMORY / 4u];
static uint8_t numbers[LABIAL_ARPABET_PHONEMES];
static char text[TEXT];
static labial_voice_item_t items[2];
static labial_voice_message_t message;

uint32_t labial_workspace_size(const labial_model_t *any)
{
    return (uint32_t)any->search_stride * 4u + any->channel_count;
}

static int64_t any_moment(void)
{
    return (int64_t)any_int32 * 256;
}

int64_t labial_voice_end(labial_voice_t *any, unsigned position)
{
    any->plan.seen = any->utterances[position].first;
    return any_moment();
}

uint32_t labial_quotient(uint32_t a, uint32_t b)
{
    /*@ assert b > 0; */
    return a / b;
}

unsigned labial_fade_frames(uint32_t milliseconds, uint32_t frames_per_second)
{
    return milliseconds < frames_per_second ? 1u : any_unsigned;
}

void labial_voice_begin_fade(labial_voice_t *any, uint32_t steps)
{
    any->steps = steps;
}

int labial_voice_viseme(unsigned kind, const char *name, size_t size)
{
    /*@ assert size <= 65535; */
    return size > 0u && name[size - 1u] == (char)kind ? any_uint8 : -1;
}

uint32_t labial_voice_find(const labial_voice_t *any, const labial_voice_utterance_t *utterance, uint32_t start)
{
    return any->used + utterance->first + start;
}

void labial_voice_remove(labial_voice_t *any, labial_voice_utterance_t *utterance, uint32_t from, uint32_t to)
{
    any->used = any_uint32;
    utterance->places = to - from;
}

void labial_voice_remove_key(labial_voice_t *any, labial_voice_utterance_t *utterance, uint16_t key)
{
    any->used = key;
    utterance->places = any_uint32;
}

void labial_voice_insert(labial_voice_t *any, labial_voice_utterance_t *utterance, const labial_voice_place_t *item,
                         const char *of)
{
    any->used = item->start;
    utterance->places = any_uint32;
    if (of && item->size > 0u)
        utterance->tail = (uint8_t)of[item->size - 1u];
}

uint32_t labial_voice_behind_blank(labial_voice_t *any, uint32_t at, uint32_t begin)
{
    return any->used + at + begin;
}

uint32_t labial_voice_told(const labial_voice_t *any, const labial_voice_utterance_t *utterance, uint32_t from,
                           uint32_t to)
{
    return any->used + utterance->over + from + to;
}

int labial_voice_is_over(const labial_voice_t *any, uint32_t identity)
{
    return any->over == identity;
}

void labial_voice_note_over(labial_voice_t *any, uint32_t identity)
{
    any->gone[0] = identity;
}

void labial_voice_remove_utterance(labial_voice_t *any, unsigned position)
{
    any->utterances[position].places = 0;
    any->utterance_count--;
}

void labial_voice_forget(labial_voice_t *any, int64_t moment)
{
    any->stale = moment > 0;
    any->utterance_count = (uint8_t)Frama_C_interval(any->cancelled ? 0 : 1, LABIAL_VOICE_UTTERANCES);
}

uint32_t labial_voice_free(const labial_voice_t *any)
{
    return any->room;
}

void labial_voice_pack(labial_voice_t *any)
{
    any->used = any_uint32;
}

/* Any state that calls leave behind: only after a cancel there is no utterance. */
static labial_voice_t *any_voice(void)
{
    unsigned i;
    FILL(model);
    model.frames_per_second = (uint16_t)Frama_C_interval(1, 250);
    FILL(voice);
    voice.model = OR_NULL(labial_model_t *, &model);
    voice.words = OR_NULL(labial_words_model_t *, &words);
    voice.cancelled = (uint8_t)Frama_C_interval(0, 1);
    voice.utterance_count = (uint8_t)Frama_C_interval(voice.cancelled ? 0 : 1, LABIAL_VOICE_UTTERANCES);
    voice.message = (uint8_t)Frama_C_interval(0, LABIAL_VOICE_MESSAGES_ - 1);
    for (i = 0; i < LABIAL_VOICE_UTTERANCES; i++) {
        voice.utterances[i].origin = any_moment();
        voice.utterances[i].limit = any_int ? INT64_MAX : any_moment();
    }
    return OR_NULL(labial_voice_t *, &voice);
}

static const labial_voice_message_t *any_message(void)
{
    FILL(text);
    FILL(items);
    items[0].text = items[1].text = OR_NULL(char *, text);
    FILL(message);
    message.items = OR_NULL(labial_voice_item_t *, items);
    message.count = (uint32_t)Frama_C_interval(0, 2);
    message.kind = (uint8_t)Frama_C_interval_split(0, LABIAL_VOICE_CHARACTERS + 1);
    return OR_NULL(labial_voice_message_t *, &message);
}

int main(void)
{
    labial_voice_t *any = any_voice();
    FILL(numbers);
    switch (Frama_C_interval(0, 11)) {
    case 0:
        labial_voice_init(any, OR_NULL(labial_model_t *, &model),
                          OR_NULL(void *, (char *)memory + Frama_C_interval(0, 3)),
                          (size_t)Frama_C_interval(0, MEMORY - 3u));
        break;
    case 1:
        labial_voice_numbers(any, OR_NULL(uint8_t *, numbers));
        break;
    case 2:
        labial_voice_offset(any, any_int32);
        break;
    case 3:
        labial_voice_begin(any, (uint64_t)any_uint32 << 32 | any_uint32, any_uint32);
        break;
    case 4:
        labial_voice_finish(any);
        break;
    case 5:
        labial_voice_cancel(any, any_uint32);
        break;
    case 6:
        labial_voice_done(any);
        break;
    case 7:
        labial_voice_counts(any);
        break;
    case 8:
        labial_voice_identity(OR_NULL(char *, text), (size_t)Frama_C_interval(0, LABIAL_VOICE_TEXT));
        break;
    case 9:
        labial_voice_word(any, OR_NULL(char *, text), (size_t)Frama_C_interval(0, TEXT), any_uint32, any_uint32);
        break;
    case 10:
        labial_voice_phoneme(any, any_unsigned, any_uint32, any_uint32);
        break;
    default:
        labial_voice_tell(any, any_message());
    }
    return 0;
}
