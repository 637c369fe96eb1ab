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

/* Characters of a word before another one of kana begins another word, where a syllable does. */
#define KANA_MOST 4u

/* Whether a character is one of Chinese, or a kanji. */
static int is_han(uint32_t code)
{
    static const uint32_t ranges[][2] = { { 0x2e80, 0x2fdf }, { 0x3005, 0x3007 }, { 0x3400, 0x4dbf },
                                          { 0x4e00, 0x9fff }, { 0xf900, 0xfaff }, { 0x20000, 0x3ffff } };
    unsigned i;
    for (i = 0; i < sizeof ranges / sizeof *ranges; i++)
        if (code >= ranges[i][0] && code <= ranges[i][1])
            return 1;
    return 0;
}

static int is_kana(uint32_t code)
{
    return code >= 0x3041u && code <= 0x30ffu;
}

/* Whether a word of kana goes on with a character: small ones, n, marks of length, of voice and of repetition, and su,
 * the end of desu and masu. */
static int goes_on(uint32_t code)
{
    static const uint8_t small[] = { 0x41, 0x43, 0x45, 0x47, 0x49, 0x59, 0x63, 0x83, 0x85, 0x87, 0x8e, 0x93 };
    const uint32_t plain = code > 0x30a0u ? code - 0x60u : code; /* as hiragana */
    unsigned i;
    for (i = 0; i < sizeof small; i++)
        if (plain == 0x3000u + small[i])
            return 1;
    return plain >= 0x3099u && plain <= 0x309fu;
}

/* Whether a script has no blanks between words: Thai and Lao, kana, Han. */
static int is_unspaced(uint32_t code)
{
    return (code >= 0xe01u && code <= 0xeffu) || is_kana(code) || is_han(code);
}

/* Whether a word ends at a character, which belongs to none: a blank, or behind a script without blanks a mark of
 * punctuation. */
static int ends_word(const labial_voice_plan_t *plan, uint32_t code)
{
    return labial_voice_is_blank(code) ||
           (plan->size > 0u && is_unspaced(plan->last) &&
            (code == ',' || code == '.' || code == '!' || code == '?' || code == ':' || code == ';'));
}

/* Whether a character begins another word, though no blank stands before it: where a word of Japanese probably ends,
 * before Han or katakana behind hiragana; where kana go on for long; before the vowels of Thai and Lao that are written
 * first in their syllable; and where the word is too long. */
static int begins_word(const labial_voice_plan_t *plan, uint32_t code)
{
    const uint32_t last = plan->last;
    if (plan->characters >= LABIAL_VOICE_LETTERS)
        return 1;
    if (plan->size == 0u)
        return 0;
    if ((code & 0xffff7fu) >= 0xe40u && (code & 0xffff7fu) <= 0xe44u)
        return 1;
    if (!is_kana(last) || goes_on(code))
        return 0;
    if (last < 0x30a0u && (is_han(code) || (is_kana(code) && code > 0x30a0u)))
        return 1;
    return plan->characters >= KANA_MOST && is_kana(code);
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

/* 0 if the square bracket at the current character is not that of a link, [text](address) or [text][1]; 2 if there are
 * letters in it, so that it is read; else 1. */
static unsigned is_link(labial_voice_t *voice, const labial_voice_utterance_t *utterance)
{
    uint32_t at = voice->plan.at;
    unsigned i, k = voice->plan.byte + 1u, found = 1, before = 0;
    for (i = 0; i <= LABIAL_VOICE_BACK; i++, at = labial_voice_after(voice, at), k = 0) {
        labial_voice_look(&voice->plan, at);
        if (at >= labial_voice_limit(utterance))
            return 0;
        for (; k < voice->items[at].size; k++) {
            const unsigned code = (unsigned char)labial_voice_text(voice, at)[k];
            if (before == '[')
                return code == ']' || (code >= '0' && code <= '9') ? found : 0u;
            if (before == ']' && code == '(')
                return found;
            if ((code == '[') != (before == ']'))
                return 0;
            if ((code | 0x20u) - 'a' < 26u || code >= 0x80u)
                found = 2;
            before = code == '[' || code == ']' ? code : 0u;
        }
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
    if (labial_words_push_characters(&plan->words, plan->letters, size, plan->begin, plan->ends, characters) !=
        LABIAL_OK)
        (void)labial_words_push(&plan->words, plan->letters, size, plan->begin, plan->until);
    return 1;
}

/* Appends a character to the word, which has room for it. */
static void append_character(labial_voice_plan_t *plan, const char *text, unsigned bytes, uint32_t begin, uint32_t end)
{
    if (plan->size == 0u)
        plan->begin = plan->until = begin > plan->words.latest ? begin : plan->words.latest;
    if (end > plan->until)
        plan->until = end;
    /* Each character has four bytes at most. */
    /*@ assert plan->characters < 60 && plan->size <= 236; */
    LABIAL_CHECK(plan->characters < LABIAL_VOICE_LETTERS && plan->size + bytes <= 4u * LABIAL_VOICE_LETTERS);
    memcpy(plan->letters + plan->size, text, bytes);
    plan->size = (uint8_t)(plan->size + bytes);
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
        int is_read;
        for (i = 0; i < item->size; i += labial_voice_bytes(text + i, item->size - i))
            count++;
        while (plan->byte < item->size) {
            /* The item has a byte, and so a character. */
            /*@ assert count > 0; */
            LABIAL_CHECK(count > 0u);
            const unsigned bytes = labial_voice_bytes(text + plan->byte, item->size - plan->byte);
            const char *const character = text + plan->byte;
            const uint32_t begin = item->start + (uint32_t)((uint64_t)length * plan->point / count);
            const uint32_t end = item->start + (uint32_t)((uint64_t)length * (plan->point + 1u) / count);
            const uint32_t code = labial_voice_code(character, bytes);
            const char closing = *character == '[' ? ']' : *character == '<' ? '>' : '\0';
            const unsigned link = !plan->closing && closing == ']' ? is_link(voice, utterance) : 0u;
            if (!plan->closing && closing && link == 0u && is_closed(voice, utterance, closing))
                plan->closing = (uint8_t)closing;
            is_read = !plan->closing && link < 2u && !ends_word(plan, code);
            if (is_read && begins_word(plan, code)) {
                (void)finish_word(voice);
                return 1;
            }
            plan->byte = (uint8_t)(plan->byte + bytes);
            plan->point++;
            if (is_read) {
                append_character(plan, character, bytes, begin, end);
                plan->last = code;
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
