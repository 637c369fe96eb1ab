/*
 * The items of a voice, its plan and its words: up to four items in one utterance and one in another, of any kind, text
 * and time, all of one place or all of two; with stand-ins for what pronounces words, which gives any of its results.
 */
#include "voice_parts.h"

#include "prove.h"

#define ITEMS_MAX 4u
#define ROOM 16u /* what ITEMS_MAX + 2 items of two places take, and some */

static labial_voice_t voice;
static labial_model_t model;
static labial_words_model_t words;
static labial_words_own_t own;
static labial_voice_place_t places[ROOM + 2];
static uint8_t numbers[LABIAL_ARPABET_PHONEMES];
static unsigned kind, count, each; /* of all items, how many in the first utterance, and the places of one */

static const labial_words_own_t *ask(void *user, const char *text, size_t size)
{
    return user && size > 0u && text[size - 1u] ? &own : (const labial_words_own_t *)0;
}

int labial_words_init(labial_words_t *stream, const labial_words_model_t *any, const labial_words_own_t *of,
                      int32_t offset)
{
    FILL(*stream);
    stream->model = any;
    stream->own = of;
    return offset;
}

int labial_words_pronounce(labial_words_t *stream, const labial_words_own_t *of)
{
    stream->own = of;
    return any_int;
}

int labial_words_push(labial_words_t *stream, const char *text, size_t size, uint32_t start, uint32_t end)
{
    stream->latest = end > start && size > 0u && text[size - 1u] ? any_uint32 : start;
    return any_int;
}

int labial_words_push_characters(labial_words_t *stream, const char *text, size_t size, uint32_t start,
                                 const uint32_t *ends, unsigned characters)
{
    stream->latest = text[size - 1u] && ends[characters - 1u] > start ? any_uint32 : start;
    return any_int;
}

int labial_words_end(labial_words_t *stream)
{
    stream->latest = any_uint32;
    return any_int;
}

int labial_words_next(labial_words_t *stream, unsigned *phoneme, uint32_t *milliseconds)
{
    stream->latest = any_uint32;
    *phoneme = (unsigned)Frama_C_interval(0, LABIAL_ARPABET_PHONEMES - 1);
    *milliseconds = any_uint32;
    return any_int;
}

int labial_words_read(const labial_words_model_t *any, const labial_words_own_t *of, const char *text, size_t size,
                      labial_word_t *word)
{
    word->kind = any && of && size > 0u && text[size - 1u] ? any_uint8 : (uint8_t)LABIAL_WORDS_UNKNOWN;
    return any_int;
}

uint32_t labial_words_length(const labial_words_model_t *any, const labial_word_t *word)
{
    return any && word->kind ? any_uint32 : 0u;
}

static int64_t any_moment(void)
{
    return (int64_t)any_int32 * 256;
}

/* A place that an item of this kind may begin in. */
static void any_item(labial_voice_place_t *item)
{
    item->start = (uint32_t)Frama_C_interval(0, LABIAL_VOICE_LATEST);
    item->end = any_uint32;
    item->back = (uint8_t)each;
    item->size = 0;
    if (kind >= LABIAL_VOICE_WORDS)
        item->size = (uint8_t)(each > 1u ? Frama_C_interval(5, 20) : Frama_C_interval(0, 4));
    else if (kind != LABIAL_VOICE_PHONEMES)
        item->text[0] = (uint8_t)Frama_C_interval(0, kind == LABIAL_VOICE_AZURE ? 21 : 20);
}

/* An utterance of `count` items from place `first` on. */
static void any_utterance(labial_voice_utterance_t *utterance, uint32_t first, unsigned items)
{
    FILL(*utterance);
    utterance->origin = any_moment();
    utterance->limit = (int64_t)any_uint32 << 31 | any_uint32;
    utterance->end = (uint32_t)Frama_C_interval(0, LABIAL_VOICE_LATEST);
    utterance->over = (uint32_t)Frama_C_interval(0, LABIAL_VOICE_LATEST);
    utterance->pause = (uint32_t)Frama_C_interval(0, LABIAL_VOICE_LATEST);
    utterance->first = first;
    utterance->places = items * each;
    utterance->tail = (uint8_t)each;
    utterance->kind = (uint8_t)(items > 0u ? kind : LABIAL_VOICE_NO_KIND);
}

static void any_state(unsigned least_kind)
{
    unsigned i;
    kind = (unsigned)Frama_C_interval((int)least_kind, LABIAL_VOICE_CHARACTERS);
    count = (unsigned)Frama_C_interval(0, ITEMS_MAX);
    /*@ split kind; */
    /*@ split count; */
    each = kind < LABIAL_VOICE_WORDS ? 1u : (unsigned)Frama_C_interval(1, 2);
    /*@ split each; */
    FILL(model);
    FILL(numbers);
    FILL(places);
    FILL(voice);
    voice.model = &model;
    voice.words = &words;
    voice.own = &own;
    voice.numbers = 0;
    voice.offset = (int32_t)Frama_C_interval(-(int)LABIAL_VOICE_LATEST, LABIAL_VOICE_LATEST);
    voice.items = places;
    voice.room = ROOM;
    voice.over = (uint8_t)Frama_C_interval(0, LABIAL_VOICE_UTTERANCES - 1);
    voice.utterance_count = 2;
    any_utterance(voice.utterances, 1, count);
    any_utterance(voice.utterances + 1, 1 + count * each, 1);
    voice.used = 1 + (count + 1) * each;
    for (i = 2; i < LABIAL_VOICE_UTTERANCES; i++)
        any_utterance(voice.utterances + i, voice.used, 0);
    for (i = 0; i < ROOM / each; i++)
        any_item(places + 1 + i * each);
}

static int speak(labial_voice_t *any)
{
    labial_voice_plan_t *const plan = &any->plan;
    const labial_voice_utterance_t *const utterance = any->utterances + plan->utterance;
    plan->at = utterance->first + utterance->places;
    plan->start = any_uint32;
    plan->end = any_uint32;
    plan->phoneme = any_uint8;
    return (int)Frama_C_interval(0, 1);
}

static uint32_t lasts(labial_voice_t *any, const labial_voice_utterance_t *utterance)
{
    return any->used + utterance->first + any_uint32;
}

/* voice_items.c and voice_plan.c */
int main(void)
{
    labial_voice_utterance_t *const utterance = voice.utterances;
    labial_voice_place_t item;
    labial_voice_segment_t segment;
    static char text[20];
    any_state(LABIAL_VOICE_PHONEMES);
    FILL(text);
    FILL(item);
    voice.numbers = OR_NULL(uint8_t *, numbers);
    voice.speak = speak;
    voice.lasts = lasts;
    switch (Frama_C_interval_split(0, 13)) {
    case 0:
        labial_voice_find(&voice, utterance, any_uint32);
        break;
    case 1:
        labial_voice_told(&voice, utterance, any_uint32, any_uint32);
        break;
    case 2:
        if (utterance->places > 0u)
            labial_voice_remove(&voice, utterance, utterance->first, utterance->first + each);
        break;
    case 3:
        labial_voice_remove_key(&voice, utterance, any_uint16);
        break;
    case 4:
        item.size = (uint8_t)Frama_C_interval(each > 1u ? 5 : 0, each > 1u ? 20 : 4);
        labial_voice_insert(&voice, utterance, &item, OR_NULL(char *, text));
        break;
    case 5:
        labial_voice_note_over(&voice, any_uint32);
        break;
    case 6:
        labial_voice_remove_utterance(&voice, (unsigned)Frama_C_interval_split(0, 1));
        labial_voice_remove_utterance(&voice, 0);
        break;
    case 7:
        labial_voice_forget(&voice, any_moment());
        break;
    case 8:
        labial_voice_free(&voice);
        labial_voice_pack(&voice);
        break;
    case 9:
        labial_voice_viseme((unsigned)Frama_C_interval(LABIAL_VOICE_AZURE, LABIAL_VOICE_POLLY), text,
                            (size_t)Frama_C_interval(0, sizeof text));
        break;
    case 10:
        labial_voice_end(&voice, 0);
        break;
    case 11:
        labial_voice_plan_sounds(&voice);
        break;
    case 12:
        if (utterance->places > 0u)
            labial_voice_behind_blank(&voice, utterance->first, any_uint32);
        break;
    default:
        labial_voice_plan_start(&voice, any_moment());
        labial_voice_plan_next(&voice, &segment);
        labial_voice_plan_next(&voice, &segment);
    }
    return 0;
}

/* voice_words.c, at any point of an utterance. */
void prove_voice_words(void)
{
    labial_voice_plan_t *const plan = &voice.plan;
    static labial_voice_t unprepared;
    words.format = any_uint16;
    labial_voice_words(OR_NULL(labial_voice_t *, &unprepared), OR_NULL(labial_words_model_t *, &words), &own);
    labial_voice_pronounce(OR_NULL(labial_voice_t *, &unprepared), ask, &own);
    words.format = LABIAL_WORDS_FORMAT;
    any_state(LABIAL_VOICE_WORDS);
    labial_voice_words(&voice, &words, &own);
    labial_voice_pronounce(&voice, any_int ? ask : (labial_voice_own_fn)0, OR_NULL(void *, &own));
    plan->utterance = 0;
    plan->at = voice.utterances[0].first;
    plan->byte = plan->point = 0;
    if (voice.utterances[0].places > 0u)
        voice.lasts(&voice, voice.utterances);
    voice.speak(&voice);
}
