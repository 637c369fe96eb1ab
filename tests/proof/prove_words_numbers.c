/*
 * Any characters behind a digit. What is listed is found by a stand-in, which accepts only numbers of the lists.
 */
#include "any_character.h"

/* words_text.c's: the lists have 31 texts, zero to million. */
const char *labial_words_listed(const char *list, unsigned number)
{
    /*@ assert number <= 30; */
    return list;
}

void labial_words_say(labial_words_reading_t *reading, const char *words, unsigned character)
{
    any_int = words[0];
}

int main(void)
{
    labial_words_reading_t reading;
    FILL(reading);
    reading.here.code = (unsigned)Frama_C_interval('0', '9');
    labial_words_read_digits(&reading);
    return 0;
}
