/*
 * words.c - words to phonemes without structures (flat.h).
 */
#include "flat.h"

#include <string.h>

#include "words_en.h"

FLAT_RETURNS(uint32_t words_size(void), sizeof(labial_words_t))
FLAT_RETURNS(uint32_t words_context_size(void), sizeof(labial_words_context_t))
FLAT_RETURNS(uint32_t words_own_size(unsigned count),
             (uint32_t)(sizeof(labial_words_own_t) + count * sizeof(labial_words_entry_t)))

const labial_words_own_t *words_own(void *memory, unsigned count, const char *packed)
{
    labial_words_own_t *const own = (labial_words_own_t *)memory;
    labial_words_entry_t *const entries = (labial_words_entry_t *)(own + 1);
    own->entries = entries;
    own->count = (uint16_t)count;
    for (unsigned i = 0; i < count; i++) {
        entries[i].word = packed;
        packed += strlen(packed) + 1u;
        entries[i].count = (uint8_t)*packed++;
        entries[i].phonemes = (const uint8_t *)packed;
        packed += entries[i].count;
    }
    return own;
}

FLAT_RETURNS(const char *words_label(unsigned phoneme), labial_words_label(&words_en, phoneme))

int words_read(const labial_words_own_t *own, labial_words_context_t *context, const char *text, uint32_t size,
               uint8_t *out)
{
    labial_word_t word;
    const int result = labial_words_read_next(&words_en, own, context, text, size, &word);
    if (result != LABIAL_OK)
        return result;
    *out++ = word.count;
    *out++ = word.characters;
    *out++ = context->dropped;
    for (unsigned i = 0; i < word.count; i++) {
        *out++ = word.phonemes[i].phoneme;
        *out++ = word.phonemes[i].character;
        *out++ = word.phonemes[i].first;
    }
    return word.kind;
}

FLAT_RETURNS(int words_init(labial_words_t *stream, const labial_words_own_t *own, int32_t offset),
             labial_words_init(stream, &words_en, own, offset))

void words_pronounce(labial_words_t *stream, const labial_words_own_t *own)
{
    (void)labial_words_pronounce(stream, own);
}

FLAT_RETURNS(int words_push(labial_words_t *stream, const char *text, uint32_t size, uint32_t start, uint32_t end),
             labial_words_push(stream, text, size, start, end))
FLAT_RETURNS(int words_push_characters(labial_words_t *stream, const char *text, uint32_t size, uint32_t start,
                                       const uint32_t *ends, unsigned count),
             labial_words_push_characters(stream, text, size, start, ends, count))
FLAT_RETURNS(int words_end(labial_words_t *stream), labial_words_end(stream))
FLAT_RETURNS(int words_restart(labial_words_t *stream), labial_words_restart(stream))

int words_next(labial_words_t *stream, uint32_t *out)
{
    unsigned phoneme = 0;
    const int result = labial_words_next(stream, &phoneme, &out[1]);
    out[0] = phoneme;
    return result;
}
