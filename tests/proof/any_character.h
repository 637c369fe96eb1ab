/*
 * any_character.h - a stand-in for words_characters.c: a text of any characters, of which nothing is known but that a
 * digit is one, and that there are no more than a word can have.
 */
#ifndef ANY_CHARACTER_H
#define ANY_CHARACTER_H

#include "prove.h"
#include "words_parts.h"

void labial_words_advance(labial_words_place_t *here)
{
    here->at = any_size;
    here->start = any_size;
    here->characters = (unsigned)Frama_C_interval(0, LABIAL_WORDS_CHARACTERS);
    here->code = any_unsigned;
}

unsigned labial_words_following(const labial_words_place_t *here)
{
    return any_unsigned;
}

int labial_words_is_capital(unsigned code)
{
    return code >= 'A' && code <= 'Z';
}

int labial_words_is_latin(unsigned code)
{
    return (code >= 'A' && code <= 'Z') || (code >= 'a' && code <= 'z');
}

int labial_words_is_decimal(unsigned code)
{
    return code >= '0' && code <= '9';
}

int labial_words_is_inside(unsigned code)
{
    return any_int;
}

unsigned labial_words_small_letter(unsigned code)
{
    return code >= 'A' && code <= 'Z' ? code + 32u : code;
}

#endif
