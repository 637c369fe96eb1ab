/*
 * words_numbers.c - numbers in a text as they are said. export/labial/words/text.py has the reference.
 */
#include "labial/words.h"

#include "labial/labial.h"
#include "words_parts.h"

/* Spoken for numbers, and the same as ordinals. */
enum { TEN = 10, TWENTY = 20, HUNDRED = 28, THOUSAND, MILLION };
static const char cardinals[] = "zero\0one\0two\0three\0four\0five\0six\0seven\0eight\0nine\0ten\0eleven\0twelve\0"
                                "thirteen\0fourteen\0fifteen\0sixteen\0seventeen\0eighteen\0nineteen\0twenty\0thirty\0"
                                "forty\0fifty\0sixty\0seventy\0eighty\0ninety\0hundred\0thousand\0million\0";
static const char ordinals[] = "zeroth\0first\0second\0third\0fourth\0fifth\0sixth\0seventh\0eighth\0ninth\0tenth\0"
                               "eleventh\0twelfth\0thirteenth\0fourteenth\0fifteenth\0sixteenth\0seventeenth\0"
                               "eighteenth\0nineteenth\0twentieth\0thirtieth\0fortieth\0fiftieth\0sixtieth\0"
                               "seventieth\0eightieth\0ninetieth\0hundredth\0thousandth\0millionth\0";

/* Says part of a number, the word `last`, which is said later, before it. */
static void say_part(labial_words_reading_t *reading, unsigned *last, unsigned next, unsigned character)
{
    if (*last <= MILLION)
        labial_words_say(reading, labial_words_listed(cardinals, *last), character);
    *last = next;
}

/* Up to 999; nothing for 0. */
static void say_hundreds(labial_words_reading_t *reading, unsigned *last, uint32_t value, unsigned character)
{
    uint32_t rest = value % 100u;
    if (value >= 100u) {
        say_part(reading, last, (unsigned)(value / 100u), character);
        say_part(reading, last, HUNDRED, character);
    }
    if (rest >= TWENTY) {
        say_part(reading, last, (unsigned)(TWENTY - 2u + rest / TEN), character);
        rest %= TEN;
    }
    if (rest > 0u)
        say_part(reading, last, (unsigned)rest, character);
}

/* A whole number up to 999,999,999, or its ordinal. */
static void say_number(labial_words_reading_t *reading, uint32_t value, int is_ordinal, unsigned character)
{
    unsigned last = MILLION + 1u; /* none */
    if (value >= 1000000u) {
        say_hundreds(reading, &last, value / 1000000u, character);
        say_part(reading, &last, MILLION, character);
    }
    if (value / 1000u % 1000u > 0u) {
        say_hundreds(reading, &last, value / 1000u % 1000u, character);
        say_part(reading, &last, THOUSAND, character);
    }
    say_hundreds(reading, &last, value % 1000u, character);
    if (value == 0u)
        last = 0;
    labial_words_say(reading, labial_words_listed(is_ordinal ? ordinals : cardinals, last), character);
}

/* Digits one by one; behind a point without commas. */
static void say_digits(labial_words_reading_t *reading, int with_commas)
{
    labial_words_place_t *here = &reading->here;
    for (; labial_words_is_decimal(here->code) ||
           (with_commas && here->code == ',' && labial_words_is_decimal(labial_words_following(here)));
         labial_words_advance(here))
        if (here->code != ',')
            labial_words_say(reading, labial_words_listed(cardinals, here->code - '0'), here->characters - 1u);
}

/* Whether three digits and no fourth one follow. */
static int has_group(const labial_words_place_t *here)
{
    labial_words_place_t next = *here;
    unsigned count = 0;
    for (labial_words_advance(&next); labial_words_is_decimal(next.code); labial_words_advance(&next))
        count++;
    return count == 3u;
}

/* st, nd, rd, th behind a number: moves behind it. */
static int takes_ordinal(labial_words_place_t *here)
{
    static const char endings[] = "stndrdth";
    labial_words_place_t next = *here;
    unsigned i, first, second;
    first = labial_words_small_letter(next.code);
    labial_words_advance(&next);
    second = labial_words_small_letter(next.code);
    if (labial_words_is_inside(labial_words_following(&next)))
        return 0;
    for (i = 0; i < 8u; i += 2u)
        if (first == (unsigned char)endings[i] && second == (unsigned char)endings[i + 1u]) {
            labial_words_advance(&next);
            *here = next;
            return 1;
        }
    return 0;
}

void labial_words_read_digits(labial_words_reading_t *reading)
{
    labial_words_place_t *here = &reading->here;
    const labial_words_place_t first = *here;
    uint32_t value = 0;
    unsigned count = 0;
    for (; labial_words_is_decimal(here->code) || (here->code == ',' && has_group(here)); labial_words_advance(here))
        if (here->code != ',' && ++count <= 9u)
            value = value * 10u + (here->code - '0');
    if (count > 9u || (count > 1u && first.code == '0')) {
        *here = first;
        say_digits(reading, 1);
    } else {
        say_number(reading, value, takes_ordinal(here), first.characters - 1u);
    }
    if (here->code == '.' && labial_words_is_decimal(labial_words_following(here))) {
        labial_words_say(reading, "point", here->characters - 1u);
        labial_words_advance(here);
        say_digits(reading, 0);
    }
}
