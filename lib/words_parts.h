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

/* Codes of characters that are not ASCII: the end, letters of other scripts, and what is not said. */
#define TEXT_END 0u
#define FOREIGN 1u
#define NOTHING 2u

/* A place in a text. */
typedef struct {
    const unsigned char *text;
    size_t size;
    size_t at;           /* behind the current character */
    size_t start;        /* of the current character */
    unsigned characters; /* so far, the current one included */
    unsigned code;       /* of the current one: ASCII, TEXT_END, FOREIGN or NOTHING */
} labial_words_place_t;

/* A place in a text, and the word that it becomes. */
typedef struct {
    const labial_words_model_t *model;
    labial_word_t *word;
    labial_words_place_t here;
} labial_words_reading_t;

/* Moves on to the next character, passing over marks. */
void labial_words_advance(labial_words_place_t *here);

/* The code of the character behind the current one. */
unsigned labial_words_following(const labial_words_place_t *here);

/* Whether a code is a capital, a Latin letter, a digit, or any of these or a letter of another script; a capital's
 * small letter, and other codes as they are. */
int labial_words_is_capital(unsigned code);
int labial_words_is_latin(unsigned code);
int labial_words_is_decimal(unsigned code);
int labial_words_is_inside(unsigned code);
unsigned labial_words_small_letter(unsigned code);

/* Says words of small letters, separated by blanks, where the text's `character` is. */
void labial_words_say(labial_words_reading_t *reading, const char *words, unsigned character);

/* The text of this number in a list of texts that end with NUL. */
const char *labial_words_listed(const char *list, unsigned number);

/* Reads the number that begins with the current character, a digit. */
void labial_words_read_digits(labial_words_reading_t *reading);

/* Appends the phonemes of a spoken word of 1 to LABIAL_WORDS_LETTERS letters; those without room are dropped. */
void labial_words_spell(const labial_words_model_t *model, const labial_words_letter_t *letters, unsigned count,
                        labial_word_t *word);

/* Appends a phoneme, unless there is no room. */
void labial_words_append(labial_word_t *word, unsigned phoneme, unsigned character, unsigned first);

/* The weight of a phoneme among those of its word, at most 2^16; `pause` says that a pause follows the last one. */
uint32_t labial_words_weight(const labial_words_model_t *model, const labial_word_t *word, unsigned place,
                             unsigned pause);

#endif
