/*
 * words_letters.c, words_numbers.c, words_dates.c: any text of up to BYTES bytes, from any place in it, after any words;
 * with stand-ins for words.c and words_text.c, where what is found in a list is any text, or none.
 */
#include "labial/words.h"

#include "labial/labial.h"
#include "prove.h"
#include "words_parts.h"

#define BYTES 16

/* Texts of a list. */
static char listed[24];

static void grow(labial_word_t *word)
{
    word->count = (uint8_t)Frama_C_interval(word->count, LABIAL_WORDS_PHONEMES);
}

void labial_words_spell(const labial_words_model_t *model, const labial_words_letter_t *letters, unsigned count,
                        labial_word_t *word)
{
    if (count > 0u) {
        /*@ assert count <= LABIAL_WORDS_LETTERS; */
        any_int = letters[0].letter + letters[count - 1u].character;
    }
    grow(word);
}

void labial_words_append(labial_word_t *word, unsigned phoneme, unsigned character, unsigned first)
{
    grow(word);
}

void labial_words_say(labial_words_reading_t *reading, const char *words, unsigned ending, unsigned character)
{
    any_int = words[0];
    grow(reading->word);
}

void labial_words_say_name(labial_words_reading_t *reading, const char *name, int is_plural, unsigned character)
{
    any_int = name[0];
    grow(reading->word);
}

void labial_words_say_here(labial_words_reading_t *reading, const char *words)
{
    any_int = words[0];
    grow(reading->word);
}

void labial_words_keep_tail(labial_words_reading_t *reading, unsigned first)
{
    reading->context->tail = any_uint8;
    reading->is_tail_here = 1;
}

void labial_words_take_back(labial_words_reading_t *reading)
{
    reading->word->count = (uint8_t)Frama_C_interval(0, reading->word->count);
    reading->context->dropped = any_uint8;
    reading->context->tail = 0;
}

void labial_words_correct(labial_words_reading_t *reading, unsigned character)
{
    labial_words_take_back(reading);
    grow(reading->word);
}

unsigned labial_words_forget(labial_words_reading_t *reading)
{
    const unsigned after = reading->context->after;
    reading->context->after = AFTER_NOTHING;
    return after;
}

const char *labial_words_listed(const char *list, unsigned number)
{
    any_int = list[0];
    return listed + Frama_C_interval(0, 8);
}

const char *labial_words_said_of(const char *list, unsigned sign)
{
    any_int = list[0];
    return OR_NULL(const char *, listed);
}

int labial_words_find(const char *letters, unsigned count, const char *list, unsigned step)
{
    any_int = list[0];
    if (count > 0u)
        any_int = letters[0];
    return Frama_C_interval(-1, 32);
}

int labial_words_is_listed(const char *letters, unsigned count, const char *list)
{
    return labial_words_find(letters, count, list, 1) >= 0;
}

int main(void)
{
    static char text[BYTES];
    static labial_words_model_t model;
    static labial_word_t word;
    static labial_words_context_t context;
    static labial_words_reading_t reading;
    FILL(text);
    FILL(context);
    FILL(listed);
    listed[23] = '\0';
    word.count = (uint8_t)Frama_C_interval(0, LABIAL_WORDS_PHONEMES);
    labial_words_place(&reading.here, text, (size_t)Frama_C_interval(0, BYTES), 0);
    FILL(reading);
    reading.model = &model;
    reading.word = &word;
    reading.context = &context;
    reading.here.text = (const unsigned char *)text;
    reading.here.size = (size_t)Frama_C_interval(0, BYTES);
    switch (Frama_C_interval(0, 3)) {
    case 0: /* a letter stands there */
        reading.here.code = (unsigned)(any_int ? Frama_C_interval('A', 'Z') : Frama_C_interval('a', 'z'));
        labial_words_read_letters(&reading);
        break;
    case 1:
        labial_words_read_number(&reading);
        break;
    case 2:
        labial_words_read_sum(&reading);
        break;
    default:
        any_int = labial_words_read_range(&reading) + labial_words_is_sum(&reading.here) +
                  labial_words_currency(any_unsigned) + labial_words_has_fraction(&reading.here);
        any_int = labial_words_currency_name(any_unsigned)[0];
        labial_words_read_fraction(&reading);
    }
    return 0;
}
