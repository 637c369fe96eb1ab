/*
 * words_numbers.c - numbers, sums, dates and times as they are said. export/labial/words/numbers.py is the reference.
 */
#include "labial/words.h"

#include <string.h>

#include "labial/labial.h"
#include "words_parts.h"

/* Spoken for numbers; ordinals that are more than these with -th, and empty texts for those that are not. */
const char labial_words_cardinals[] =
    "zero\0one\0two\0three\0four\0five\0six\0seven\0eight\0nine\0ten\0eleven\0twelve\0"
    "thirteen\0fourteen\0fifteen\0sixteen\0seventeen\0eighteen\0nineteen\0twenty\0thirty\0"
    "forty\0fifty\0sixty\0seventy\0eighty\0ninety\0hundred\0thousand\0million\0billion\0"
    "trillion\0";
static const char ordinals[] = "\0first\0second\0third\0\0fifth\0\0\0eighth\0ninth\0\0\0twelfth\0";

/* Signs of money, the names of whole units, and of their hundredths. */
static const uint8_t currency_signs[] = { '$', SIGN_EURO, SIGN_POUND, SIGN_YEN, SIGN_RUPEE };
static const char currencies[] = "dollar_\0euro_\0pound_\0yen\0rupee_\0";
static const char hundredths[] = "cent_\0cent_\0penny|pence\0\0paisa|paise\0";

/* ---- Whole numbers ---------------------------------------------------------------------------------------------- */

unsigned labial_words_here(const labial_words_reading_t *reading)
{
    return reading->here.characters - 1u;
}

/* Says part of a number, the word `last`, which is said later, before it. */
static void say_part(labial_words_reading_t *reading, unsigned *last, unsigned next, unsigned character)
{
    if (*last < NO_WORD)
        labial_words_say(reading, labial_words_listed(labial_words_cardinals, *last), SAID_PLAIN, character);
    *last = next;
}

/* Up to 999; nothing for 0. */
static void say_hundreds(labial_words_reading_t *reading, unsigned *last, unsigned value, unsigned character)
{
    unsigned rest = value % 100u;
    if (value >= 100u) {
        say_part(reading, last, value / 100u, character);
        say_part(reading, last, HUNDRED, character);
    }
    if (rest >= TWENTY) {
        say_part(reading, last, TWENTY - 2u + rest / TEN, character);
        rest %= TEN;
    }
    if (rest > 0u)
        say_part(reading, last, rest, character);
}

/* Says the last word of a number. */
void labial_words_say_last(labial_words_reading_t *reading, unsigned last, unsigned ending, unsigned character)
{
    const char *word = labial_words_listed(labial_words_cardinals, last);
    if ((ending & SAID_ORDINAL) != 0u && last <= 12u && *labial_words_listed(ordinals, last) != '\0') {
        word = labial_words_listed(ordinals, last);
        ending &= SAID_PLURAL;
    }
    labial_words_say(reading, word, ending, character);
}

/* Says up to 9,999, of which years need no more. */
void labial_words_say_small(labial_words_reading_t *reading, unsigned value, unsigned ending, unsigned character)
{
    unsigned last = NO_WORD;
    if (value >= 1000u) {
        say_hundreds(reading, &last, value / 1000u, character);
        say_part(reading, &last, THOUSAND, character);
    }
    say_hundreds(reading, &last, value % 1000u, character);
    labial_words_say_last(reading, value == 0u ? 0u : last, ending, character);
}

/* Whether digits are said one by one. */
static int is_coded(const labial_words_number_t *number)
{
    return number->count > MOST_DIGITS || (number->count > 1u && number->digits[0] == 0u);
}

/* Says at most MOST_DIGITS digits as one number, three by three. */
static void say_number(labial_words_reading_t *reading, const labial_words_number_t *number, unsigned ending,
                       unsigned character)
{
    unsigned last = NO_WORD, part = 0, i;
    for (i = 0; i < MOST_DIGITS; i++) {
        unsigned behind;
        if (i >= number->count)
            break;
        behind = number->count - 1u - i;
        part = part * TEN + number->digits[i];
        if (behind % 3u != 0u)
            continue;
        say_hundreds(reading, &last, part, character);
        if (part > 0u && behind > 0u)
            say_part(reading, &last, HUNDRED + behind / 3u, character);
        part = 0;
    }
    labial_words_say_last(reading, last == NO_WORD ? 0u : last, ending, character);
}

static void say_digit(labial_words_reading_t *reading, unsigned digit, unsigned character)
{
    labial_words_say(reading, labial_words_listed(labial_words_cardinals, digit), SAID_PLAIN, character);
}

/* Adds the digit here to a number. */
static void add_digit(labial_words_number_t *number, const labial_words_place_t *here)
{
    const unsigned digit = here->code - '0';
    if (number->count < MOST_DIGITS)
        number->digits[number->count] = (uint8_t)digit;
    if (number->count < 9u)
        number->value = number->value * TEN + digit;
    number->count++;
    number->is_other |= digit;
    number->last = here->characters - 1u;
}

/* Takes digits. */
labial_words_number_t labial_words_take_digits(labial_words_place_t *here)
{
    labial_words_number_t number;
    memset(&number, 0, sizeof number);
    for (; labial_words_is_decimal(here->code); labial_words_advance(here))
        add_digit(&number, here);
    return number;
}

/* Whether three digits and no fourth one follow. */
static int has_group(const labial_words_place_t *here)
{
    labial_words_place_t next = *here;
    labial_words_advance(&next);
    return labial_words_take_digits(&next).count == 3u;
}

/* Takes a whole number, also with commas. */
static labial_words_number_t take_whole(labial_words_place_t *here)
{
    labial_words_number_t number;
    memset(&number, 0, sizeof number);
    for (; labial_words_is_decimal(here->code) || (number.count > 0u && here->code == ',' && has_group(here));
         labial_words_advance(here))
        if (here->code != ',')
            add_digit(&number, here);
    return number;
}

/* Digits one by one; behind a point without commas. */
void labial_words_say_digits(labial_words_reading_t *reading, int with_commas)
{
    labial_words_place_t *here = &reading->here;
    for (; labial_words_is_decimal(here->code) ||
           (with_commas && here->code == ',' && labial_words_is_decimal(labial_words_following(here)));
         labial_words_advance(here))
        if (here->code != ',')
            say_digit(reading, here->code - '0', labial_words_here(reading));
}

/* Passes over digits, also with commas; returns the character of the last one. */
static unsigned skip_digits(labial_words_place_t *here)
{
    unsigned last = here->characters - 1u;
    for (; labial_words_is_decimal(here->code) ||
           (here->code == ',' && labial_words_is_decimal(labial_words_following(here)));
         labial_words_advance(here))
        last = here->characters - 1u;
    return last;
}

int labial_words_has_fraction(const labial_words_place_t *here)
{
    return here->code == '.' && labial_words_is_decimal(labial_words_following(here));
}

void labial_words_read_fraction(labial_words_reading_t *reading)
{
    labial_words_say(reading, "point", SAID_PLAIN, labial_words_here(reading));
    labial_words_advance(&reading->here);
    labial_words_say_digits(reading, 0);
}

/* Moves from the sign of a range behind a number to its upper end, a number or a sum; whether there is one. */
static int takes_range(labial_words_place_t *here)
{
    labial_words_place_t next = *here;
    if (next.code != '-' && next.code != ':')
        return 0;
    labial_words_advance(&next);
    if (!labial_words_is_decimal(next.code) && !labial_words_is_sum(&next))
        return 0;
    *here = next;
    return 1;
}

/* "to" and another number behind a number. */
int labial_words_read_range(labial_words_reading_t *reading)
{
    labial_words_place_t next = reading->here;
    if (!takes_range(&next))
        return 0;
    labial_words_say(reading, "to", SAID_PLAIN, labial_words_here(reading));
    reading->here = next;
    return 1;
}

/* ---- Numbers of one part ---------------------------------------------------------------------------------------- */

/* st, nd, rd, th behind a number: moves behind it. */
static int takes_ordinal(labial_words_place_t *here)
{
    static const char endings[] = "stndrdth";
    labial_words_place_t next = *here;
    unsigned i, first, second;
    first = labial_words_small_letter(next.code);
    labial_words_advance(&next);
    second = labial_words_small_letter(next.code);
    labial_words_advance(&next);
    if (labial_words_is_inside(next.code))
        return 0;
    for (i = 0; i < 8u; i += 2u)
        if (first == (unsigned char)endings[i] && second == (unsigned char)endings[i + 1u]) {
            *here = next;
            return 1;
        }
    return 0;
}

/* Moves behind an ordinal's ending or a plural's s and returns how the number ends. The s is no second in a word that
 * has letters, and behind three or four digits but round ones: "F-16s", "mp3s", "the 747s". */
static unsigned take_ending(labial_words_reading_t *reading, const labial_words_number_t *number)
{
    labial_words_place_t *here = &reading->here;
    if (takes_ordinal(here))
        return ORDINAL;
    if (here->code != 's' || labial_words_is_inside(labial_words_following(here)) ||
        (reading->has_letters == 0u &&
         (number->count < 3u || number->count > 4u || number->digits[number->count - 1u] == 0u)))
        return CARDINAL;
    labial_words_advance(here);
    return PLURALS;
}

/* What may follow a number: a fraction, another one up to which it reaches or by which it is multiplied. */
static void read_behind(labial_words_reading_t *reading)
{
    labial_words_place_t *here = &reading->here;
    const labial_words_place_t first = *here;
    const unsigned code = here->code;
    if (code == '-') {
        labial_words_advance(here);
        if (labial_words_read_share(reading, 1))
            return;
        *here = first;
    }
    if ((code == 'x' || code == SIGN_TIMES) && labial_words_is_decimal(labial_words_following(here))) {
        labial_words_say(reading, "by", SAID_PLAIN, labial_words_here(reading));
        labial_words_advance(here);
    } else {
        (void)labial_words_read_range(reading);
    }
}

static void read_plain(labial_words_reading_t *reading, int is_start)
{
    labial_words_place_t *here = &reading->here;
    const labial_words_place_t first = *here;
    const labial_words_number_t number = take_whole(here);
    const unsigned said = reading->word->count;
    if (is_coded(&number)) {
        *here = first;
        labial_words_say_digits(reading, 1);
        if (is_start && number.count > 2u)
            reading->context->after = AFTER_PHONE;
    } else {
        const unsigned ending = take_ending(reading, &number);
        say_number(reading, &number, ending, first.characters - 1u);
        if (ending != CARDINAL) {
            reading->context->after = AFTER_NOTHING;
            reading->context->named = ending == ORDINAL;
            return;
        }
        if (number.count == 1u && number.value == 1u)
            reading->context->after = AFTER_ONE;
        if (is_start && reading->context->currency == 0u && number.value - 1u < 31u) { /* a month may follow */
            reading->context->currency = (uint8_t)number.value;
            labial_words_keep_tail(reading, said);
        }
    }
    while (labial_words_has_fraction(here)) {
        labial_words_read_fraction(reading);
        reading->context->after = AFTER_NUMBER;
        reading->context->tail = 0;
    }
    if (first.before == '+' && first.characters == 2u && number.count < 4u)
        reading->context->after = AFTER_PHONE;
    if (is_start)
        read_behind(reading);
}

/* Reads a group of a telephone number, behind "call" or another group: digit by digit if it has three or more. */
static int read_group(labial_words_reading_t *reading, unsigned after)
{
    labial_words_place_t next = reading->here;
    const labial_words_number_t number = labial_words_take_digits(&next);
    const unsigned code = next.code, is_short = number.count < 3u;
    if (labial_words_is_inside(code) || code == '%' || code == '\'' || code == '/' || code == ':' || code == '-' ||
        ((code == '.' || code == ',') && labial_words_is_decimal(labial_words_following(&next))))
        return 0;
    if (is_short || (after == AFTER_CALL && number.value % 100u == 0u && !is_coded(&number))) {
        say_number(reading, &number, CARDINAL, labial_words_here(reading));
        reading->here = next;
    } else {
        labial_words_say_digits(reading, 0);
    }
    reading->context->after = (uint8_t)(is_short ? after : (unsigned)AFTER_PHONE);
    return 1;
}

static void read_amounts(labial_words_reading_t *reading, unsigned character);

void labial_words_read_number(labial_words_reading_t *reading)
{
    labial_words_context_t *context = reading->context;
    unsigned after = context->after;
    const int is_start = !labial_words_is_inside(reading->here.before);
    const int is_name = after == AFTER_PLACE || reading->has_letters != 0u;
    if (after == AFTER_NO || after == AFTER_DATE) {
        labial_words_correct(reading, labial_words_here(reading));
        if (context->currency < MONTHS)
            after = AFTER_MONTH;
    }
    context->after = AFTER_NUMBER;
    context->tail = context->named = 0;
    if (is_start && after == AFTER_MONEY) {
        read_amounts(reading, labial_words_here(reading));
        return;
    }
    if (after != AFTER_UNIT)
        context->currency = 0;
    if (is_start && (after == AFTER_CALL || after == AFTER_PHONE) && read_group(reading, after))
        return;
    if (is_start && labial_words_read_special(reading, after))
        return;
    read_plain(reading, is_start);
    if (is_name && labial_words_is_latin(reading->here.code) &&
        !labial_words_is_inside(labial_words_following(&reading->here)))
        context->after = AFTER_PLACE;
}

/* ---- Sums of money ---------------------------------------------------------------------------------------------- */

int labial_words_currency(unsigned code)
{
    int i;
    for (i = 0; i < (int)sizeof currency_signs; i++)
        if (currency_signs[i] == code)
            return i;
    return -1;
}

const char *labial_words_currency_name(unsigned currency)
{
    return labial_words_listed(currencies, currency);
}

int labial_words_is_sum(const labial_words_place_t *here)
{
    labial_words_place_t next = *here;
    if (labial_words_currency(here->code) < 0)
        return 0;
    labial_words_advance(&next);
    if (next.code == '.')
        labial_words_advance(&next);
    return labial_words_is_decimal(next.code);
}

/* k, M, bn and others behind a sum: THOUSAND and so on, moving behind it, or NO_WORD. */
static unsigned take_scale(labial_words_place_t *here)
{
    static const char suffixes[] = "kmbt";
    labial_words_place_t next = *here;
    const unsigned letter = labial_words_small_letter(next.code);
    unsigned i;
    for (i = 0; i < 4u; i++)
        if (letter == (unsigned char)suffixes[i])
            break;
    if (i == 4u)
        return NO_WORD;
    labial_words_advance(&next);
    if (i > 0u && labial_words_small_letter(next.code) == 'n')
        labial_words_advance(&next);
    if (labial_words_is_inside(next.code))
        return NO_WORD;
    *here = next;
    return THOUSAND + i;
}

/* Reads an amount of the context's currency, said at `character`; `is_upper` behind "to". Returns whether the upper end
 * of a range follows without a sign of its own, as 10 does in "$5-10". */
static int read_amount(labial_words_reading_t *reading, unsigned character, int is_upper)
{
    labial_words_context_t *context = reading->context;
    labial_words_place_t *here = &reading->here, behind, dot, next;
    const char *const name = labial_words_listed(currencies, context->currency);
    const char *const part = labial_words_listed(hundredths, context->currency);
    labial_words_number_t whole, cents;
    unsigned scale, point, last, first;
    int has_point, has_cents, is_plural, is_lower;
    behind = *here;
    whole = take_whole(&behind);
    last = whole.last;
    if (is_coded(&whole)) {
        behind = *here;
        last = skip_digits(&behind);
    }
    dot = behind;
    point = behind.characters - 1u;
    has_point = labial_words_has_fraction(&behind);
    memset(&cents, 0, sizeof cents);
    if (has_point) {
        labial_words_advance(&behind);
        cents = labial_words_take_digits(&behind);
    }
    last = has_point ? cents.last : last;
    scale = take_scale(&behind);
    has_cents = has_point && cents.count == 2u && scale == NO_WORD && *part != '\0';
    is_plural = is_upper || whole.count != 1u || whole.value != 1u || (has_point && !has_cents);
    next = behind;
    is_lower = takes_range(&next) && labial_words_is_decimal(next.code);
    context->after = AFTER_SUM;
    context->tail = 0;
    if (!has_cents || whole.is_other || cents.value == 0u) {
        if (is_coded(&whole))
            labial_words_say_digits(reading, 1);
        else
            say_number(reading, &whole, CARDINAL, character);
    }
    if (has_cents) {
        if (whole.is_other || cents.value == 0u)
            labial_words_say_name(reading, name, is_plural, point);
        if (whole.is_other && cents.value > 0u)
            labial_words_say(reading, "and", SAID_PLAIN, point);
        if (cents.value > 0u) {
            labial_words_say_small(reading, cents.value, CARDINAL, point);
            labial_words_say_name(reading, part, cents.value != 1u, point);
        }
    } else {
        if (has_point) {
            labial_words_say(reading, "point", SAID_PLAIN, point);
            *here = dot;
            labial_words_advance(here);
            labial_words_say_digits(reading, 0);
        }
        first = reading->word->count;
        if (scale != NO_WORD)
            labial_words_say(reading, labial_words_listed(labial_words_cardinals, scale), SAID_PLAIN, last);
        if (scale != NO_WORD || !is_lower)
            labial_words_say_name(reading, name, is_plural || scale != NO_WORD, last);
        if (scale == NO_WORD)
            labial_words_keep_tail(reading, first);
    }
    *here = behind;
    (void)labial_words_read_range(reading);
    return is_lower;
}

static void read_amounts(labial_words_reading_t *reading, unsigned character)
{
    int is_upper = 0;
    while (read_amount(reading, character, is_upper)) {
        is_upper = 1;
        character = labial_words_here(reading);
    }
}

void labial_words_read_sum(labial_words_reading_t *reading)
{
    const unsigned character = labial_words_here(reading);
    reading->context->named = 0;
    reading->context->currency = (uint8_t)((unsigned)labial_words_currency(reading->here.code) & 7u);
    labial_words_advance(&reading->here);
    read_amounts(reading, character);
}
