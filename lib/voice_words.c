/*
 * voice_words.c - the words and characters of a voice to phonemes in time (voice_parts.h).
 */
#include "voice_parts.h"

#include <string.h>

/* What an unknown last word lasts, milliseconds: its two phonemes. */
#define UNKNOWN_LASTS 300u

/* ---- Words ------------------------------------------------------------------------------------------------------- */

/* The caller's own words for a text. */
static const labial_words_own_t *own_of(const labial_voice_t *voice, const char *text, size_t size)
{
    return voice->ask ? voice->ask(voice->user, text, size) : voice->own;
}

static void push_word(labial_voice_t *voice, uint32_t at)
{
    const labial_voice_place_t *const item = voice->items + at;
    const char *const text = labial_voice_text(voice, at);
    labial_words_t *const words = &voice->plan.words;
    (void)labial_words_pronounce(words, own_of(voice, text, item->size));
    (void)labial_words_push(words, text, item->size, item->start, item->end); /* in order, and no longer than an hour */
}

static uint32_t last_word_lasts(labial_voice_t *voice, const labial_voice_utterance_t *utterance)
{
    const uint32_t at = labial_voice_limit(utterance) - utterance->tail;
    const char *const text = labial_voice_text(voice, at);
    const size_t size = voice->items[at].size;
    labial_word_t word;
    (void)labial_words_read(voice->words, own_of(voice, text, size), text, size, &word);
    return word.kind == LABIAL_WORDS_UNKNOWN ? UNKNOWN_LASTS : labial_words_length(voice->words, &word);
}

/* ---- Characters -------------------------------------------------------------------------------------------------- */

/* The bytes of the character that begins a text of `left` bytes. */
static unsigned character_bytes(const char *text, unsigned left)
{
    unsigned bytes = 1;
    while (bytes < left && bytes < 4u && ((unsigned char)text[bytes] & 0xc0u) == 0x80u)
        bytes++;
    return bytes;
}

/* Whether a character of so many bytes is a blank: of ASCII, or U+0085, U+00A0, U+1680, U+2000 to U+200A, U+2028,
   U+2029, U+202F,
 * U+205F and U+3000. */
static int is_blank_character(const char *text, unsigned bytes)
{
    static const uint32_t blanks[] = { 0xc285u,   0xc2a0u,   0xe19a80u, 0xe280a8u,
                                       0xe280a9u, 0xe280afu, 0xe2819fu, 0xe38080u };
    uint32_t code = 0;
    unsigned i;
    if (bytes == 1u)
        return (*text >= 0x1c && *text <= ' ') || (*text >= '\t' && *text <= '\r');
    for (i = 0; i < bytes; i++)
        code = code << 8 | (unsigned char)text[i];
    for (i = 0; i < sizeof blanks / sizeof *blanks; i++)
        if (code == blanks[i])
            return 1;
    return code >= 0xe28080u && code <= 0xe2808au;
}

/* Whether a bracket is closed: in this item, or in one of the next. */
static int is_closed(labial_voice_t *voice, const labial_voice_utterance_t *utterance, char closing)
{
    uint32_t at = voice->plan.at;
    unsigned i, k;
    for (i = 0; i <= LABIAL_VOICE_BACK; i++, at = labial_voice_after(voice, at)) {
        labial_voice_look(&voice->plan, at);
        if (at >= labial_voice_limit(utterance))
            return 0;
        for (k = 0; k < voice->items[at].size; k++)
            if (labial_voice_text(voice, at)[k] == closing)
                return 1;
    }
    return 0;
}

/* Gives the word of the characters so far to the stream of words, if there is one; returns whether there was. */
static int finish_word(labial_voice_t *voice)
{
    labial_voice_plan_t *const plan = &voice->plan;
    const unsigned characters = plan->characters, size = plan->size;
    plan->characters = plan->size = 0;
    if (size == 0u)
        return 0;
    (void)labial_words_pronounce(&plan->words, own_of(voice, plan->letters, size));
    /* Where there are bytes, there is a character. */
    /*@ assert characters > 0; */
    LABIAL_CHECK(characters > 0u);
    if (plan->until != plan->ends[characters - 1u] ||
        labial_words_push_characters(&plan->words, plan->letters, size, plan->begin, plan->ends, characters) !=
            LABIAL_OK)
        (void)labial_words_push(&plan->words, plan->letters, size, plan->begin, plan->until);
    return 1;
}

/* Appends a character to the word; one that is too long ends later, and that is all. */
static void append_character(labial_voice_plan_t *plan, const char *text, unsigned bytes, uint32_t begin, uint32_t end)
{
    if (plan->size == 0u)
        plan->begin = plan->until = begin > plan->words.latest ? begin : plan->words.latest;
    if (end > plan->until)
        plan->until = end;
    if (plan->size + bytes > LABIAL_VOICE_TEXT)
        return;
    memcpy(plan->letters + plan->size, text, bytes);
    plan->size = (uint8_t)(plan->size + bytes);
    /* Each character has a byte at least. */
    /*@ assert plan->characters < 255; */
    LABIAL_CHECK(plan->characters < LABIAL_WORDS_CHARACTERS);
    plan->ends[plan->characters++] = plan->until;
}

/* Reads characters up to the end of a word; returns 0 where there is none. The characters of an item share its time. */
static int next_word(labial_voice_t *voice, const labial_voice_utterance_t *utterance)
{
    labial_voice_plan_t *const plan = &voice->plan;
    for (labial_voice_look(plan, plan->at); plan->at < labial_voice_limit(utterance);
         labial_voice_look(plan, plan->at)) {
        const labial_voice_place_t *const item = voice->items + plan->at;
        const char *const text = labial_voice_text(voice, plan->at);
        const uint32_t length = item->end == LABIAL_VOICE_OPEN ? 0u : item->end - item->start;
        unsigned count = 0, i;
        for (i = 0; i < item->size; i += character_bytes(text + i, item->size - i))
            count++;
        while (plan->byte < item->size) {
            /* The item has a byte, and so a character. */
            /*@ assert count > 0; */
            LABIAL_CHECK(count > 0u);
            const unsigned bytes = character_bytes(text + plan->byte, item->size - plan->byte);
            const char *const character = text + plan->byte;
            const uint32_t begin = item->start + (uint32_t)((uint64_t)length * plan->point / count);
            const uint32_t end = item->start + (uint32_t)((uint64_t)length * (plan->point + 1u) / count);
            const char closing = *character == '[' ? ']' : *character == '<' ? '>' : '\0';
            if (!plan->closing && closing && is_closed(voice, utterance, closing))
                plan->closing = (uint8_t)closing;
            plan->byte = (uint8_t)(plan->byte + bytes);
            plan->point++;
            if (!plan->closing && !is_blank_character(character, bytes)) {
                append_character(plan, character, bytes, begin, end);
                continue;
            }
            if (*character == (char)plan->closing)
                plan->closing = 0;
            if (finish_word(voice))
                return 1;
        }
        plan->byte = plan->point = 0;
        plan->at = labial_voice_after(voice, plan->at);
    }
    return finish_word(voice);
}

/* ---- Both -------------------------------------------------------------------------------------------------------- */

/* The next phoneme of an utterance of words or characters; returns whether there is one. */
static int next_spoken(labial_voice_t *voice)
{
    labial_voice_plan_t *const plan = &voice->plan;
    const labial_voice_utterance_t *const utterance = voice->utterances + plan->utterance;
    unsigned phoneme = 0;
    uint32_t milliseconds = 0;
    for (;;) {
        const int result = labial_words_next(&plan->words, &phoneme, &milliseconds);
        if (result == LABIAL_OK) {
            plan->start = plan->time;
            plan->time += milliseconds;
            plan->end = plan->time;
            plan->phoneme = labial_voice_number(voice, phoneme);
            if (phoneme != 0u)
                return 1;
        } else if (plan->ended) {
            return 0;
        } else if (utterance->kind == LABIAL_VOICE_CHARACTERS) {
            if (!next_word(voice, utterance)) {
                plan->ended = 1;
                (void)labial_words_end(&plan->words);
            }
        } else {
            labial_voice_look(plan, plan->at);
            if (plan->at < labial_voice_limit(utterance)) {
                push_word(voice, plan->at);
                plan->at = labial_voice_after(voice, plan->at);
            } else {
                plan->ended = 1;
                (void)labial_words_end(&plan->words);
            }
        }
    }
}

int labial_voice_words(labial_voice_t *voice, const labial_words_model_t *model, const labial_words_own_t *own)
{
    if (!voice || !model)
        return LABIAL_ERROR_NULL;
    if (!voice->model)
        return LABIAL_ERROR_STATE;
    if (model->format != LABIAL_WORDS_FORMAT)
        return LABIAL_ERROR_VERSION;
    voice->words = model;
    voice->own = own;
    voice->speak = next_spoken;
    voice->lasts = last_word_lasts;
    voice->changed = voice->stale = 1;
    return LABIAL_OK;
}

int labial_voice_pronounce(labial_voice_t *voice, labial_voice_own_fn own, void *user)
{
    if (!voice)
        return LABIAL_ERROR_NULL;
    if (!voice->model)
        return LABIAL_ERROR_STATE;
    voice->ask = own;
    voice->user = user;
    voice->changed = voice->stale = 1;
    return LABIAL_OK;
}
