/*
 * words_parts.h - what the files of labial/words.h share.
 */
#ifndef LABIAL_WORDS_PARTS_H
#define LABIAL_WORDS_PARTS_H

#include <stddef.h>
#include <stdint.h>

#include "labial/words.h"

/* A letter of a word: its number, 1 to 27 (a to z, apostrophe), and the character of the text that it is. */
typedef struct {
    uint8_t letter, character;
} labial_words_letter_t;

/* Appends the phonemes of a spoken word of 1 to LABIAL_WORDS_LETTERS letters; those without room are dropped. */
void labial_words_spell(const labial_words_model_t *model, const labial_words_letter_t *letters, unsigned count,
                        labial_word_t *word);

/* Appends a phoneme, unless there is no room. */
void labial_words_append(labial_word_t *word, unsigned phoneme, unsigned character, unsigned first);

/* The weight of a phoneme among those of its word, at most 2^16; `pause` says that a pause follows the last one. */
uint32_t labial_words_weight(const labial_words_model_t *model, const labial_word_t *word, unsigned place,
                             unsigned pause);

#endif
