/*
 * Any characters, with any own words; with stand-ins for the other files of words.
 */
#include "any_character.h"

static const labial_words_model_t model = { .format = LABIAL_WORDS_FORMAT, .phoneme_count = 40 };

void labial_words_spell(const labial_words_model_t *any, const labial_words_letter_t *letters, unsigned count,
                        labial_word_t *word)
{
    /*@ assert count <= 32; */
    word->count = (uint8_t)Frama_C_interval(word->count, LABIAL_WORDS_PHONEMES);
}

void labial_words_append(labial_word_t *word, unsigned phoneme, unsigned character, unsigned first)
{
    /*@ assert phoneme < 40; */
    word->count = (uint8_t)Frama_C_interval(word->count, LABIAL_WORDS_PHONEMES);
}

void labial_words_read_digits(labial_words_reading_t *reading)
{
    labial_words_advance(&reading->here);
}

#define BYTES 8

int main(void)
{
    static char text[BYTES], own_text[BYTES];
    static uint8_t phonemes[BYTES];
    labial_words_entry_t entry = { own_text, phonemes, BYTES };
    labial_words_own_t own = { &entry, 1 };
    labial_word_t word;
    FILL(text);
    FILL(own_text);
    own_text[BYTES - 1] = '\0';
    FILL(phonemes);
    entry.count = (uint8_t)Frama_C_interval(0, BYTES);
    own.count = (uint16_t)Frama_C_interval(0, 1);
    labial_words_read(OR_NULL(const labial_words_model_t *, &model), OR_NULL(labial_words_own_t *, &own),
                      OR_NULL(char *, text), BYTES, OR_NULL(labial_word_t *, &word));
    return 0;
}
