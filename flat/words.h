/*
 * words.h - words to phonemes for languages that call C (flat.h), with the tables words_en. A part of its own: in npm
 * it is a module of the package labial-words.
 */
#ifndef LABIAL_FLAT_WORDS_H
#define LABIAL_FLAT_WORDS_H

#include "flat.h"
#include "labial/words.h"

/* Bytes of a stream of words, of what goes from word to word, and of `count` words of the caller's own. */
FLAT(words_size) uint32_t words_size(void);
FLAT(words_context_size) uint32_t words_context_size(void);
FLAT(words_own_size) uint32_t words_own_size(unsigned count);

/* Words of the caller's own from `packed`, which must stay where it is: of each the text, NUL, the number of its
 * phonemes and these. Returns what the functions below take as `own`, at `memory`. */
FLAT(words_own) const labial_words_own_t *words_own(void *memory, unsigned count, const char *packed);

/* The label of a phoneme, "" beyond the last. */
FLAT(words_label) const char *words_label(unsigned phoneme);

/* Reads the next word of a text; `context` is all zero at its beginning. `out` has 3 + 3 * LABIAL_WORDS_PHONEMES bytes:
 * the number of phonemes, that of the word's characters, how many phonemes the word before loses at its end; then of each
 * phoneme its number, its character and whether a spoken word begins. Returns the word's kind. */
FLAT(words_read)
int words_read(const labial_words_own_t *own, labial_words_context_t *context, const char *text, uint32_t size,
               uint8_t *out);

/* A stream of words; words_next() writes a phoneme and its milliseconds. */
FLAT(words_init) int words_init(labial_words_t *stream, const labial_words_own_t *own, int32_t offset);
/* Other words of the caller's own, for the words that follow. */
FLAT(words_pronounce) void words_pronounce(labial_words_t *stream, const labial_words_own_t *own);
FLAT(words_push)
int words_push(labial_words_t *stream, const char *text, uint32_t size, uint32_t start, uint32_t end);
FLAT(words_push_characters)
int words_push_characters(labial_words_t *stream, const char *text, uint32_t size, uint32_t start, const uint32_t *ends,
                          unsigned count);
FLAT(words_end) int words_end(labial_words_t *stream);
FLAT(words_restart) int words_restart(labial_words_t *stream);
FLAT(words_next) int words_next(labial_words_t *stream, uint32_t *out);

#endif
