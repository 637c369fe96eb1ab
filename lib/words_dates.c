/*
 * words_dates.c - years, dates, times of day, telephones, fractions and lengths in a text as they are said.
 * export/labial/words/numbers.py is the reference.
 */
#include "labial/words.h"

#include "labial/labial.h"
#include "words_parts.h"

const char labial_words_dates[] = "january\0february\0march\0april\0may\0june\0july\0august\0september\0october\0"
                                  "november\0december\0monday\0tuesday\0wednesday\0thursday\0friday\0saturday\0"
                                  "sunday\0number\0numbers\0circa\0page\0chapter\0opus\0established\0rupees\0";

/* A year of up to four digits: two by two, except 2000 to 2009 and years below 1100 or above 2099. */
static void say_year(labial_words_reading_t *reading, unsigned value, unsigned ending, unsigned character)
{
    const unsigned century = value / 100u, rest = value % 100u;
    if (century < 11u || century > 20u || (century == 20u && rest < TEN)) {
        labial_words_say_small(reading, value, ending, character);
        return;
    }
    labial_words_say_small(reading, century, CARDINAL, character);
    if (rest == 0u) {
        labial_words_say_last(reading, HUNDRED, ending, character);
        return;
    }
    if (rest < TEN)
        labial_words_say(reading, "oh", SAID_PLAIN, character);
    labial_words_say_small(reading, rest, ending, character);
}

static int read_time(labial_words_reading_t *reading);

/* 2024-03-05, 2024/03/05, 3/5/2024, 3/5/24, 5.3.2024: month first, unless that cannot be or points are between. Behind
 * the year first a time may stand, 2024-03-05T10:30. */
static int read_date(labial_words_reading_t *reading)
{
    labial_words_place_t next = reading->here;
    const unsigned character = labial_words_here(reading);
    labial_words_number_t parts[3];
    unsigned sign = 0, i, year, month, day;
    int is_timed;
    for (i = 0; i < 3u; i++) {
        if (i > 0u) {
            if (next.code != (i == 1u ? next.code : sign) || (next.code != '/' && next.code != '-' && next.code != '.'))
                return 0;
            sign = next.code;
            labial_words_advance(&next);
        }
        parts[i] = labial_words_take_digits(&next);
        if (parts[i].count == 0u || parts[i].count > 4u)
            return 0;
    }
    is_timed = parts[0].count == 4u && next.code == 'T' && labial_words_is_decimal(labial_words_following(&next));
    if ((labial_words_is_inside(next.code) && !is_timed) || parts[1].count > 2u)
        return 0;
    if (parts[0].count == 4u && sign != '.' && parts[2].count <= 2u) {
        year = parts[0].value;
        month = parts[1].value;
        day = parts[2].value;
    } else {
        if (parts[0].count > 2u || (parts[2].count != 4u && (parts[2].count != 2u || sign != '/')))
            return 0;
        year = parts[2].value + (parts[2].count == 2u ? 2000u : 0u);
        month = parts[0].value;
        day = parts[1].value;
        if (sign == '.' || month > 12u) {
            month = parts[1].value;
            day = parts[0].value;
        }
    }
    if (month < 1u || month > 12u || day < 1u || day > 31u)
        return 0;
    labial_words_say(reading, labial_words_listed(labial_words_dates, month - 1u), SAID_PLAIN, character);
    labial_words_say_small(reading, day, ORDINAL, character);
    say_year(reading, year, CARDINAL, character);
    if (is_timed)
        labial_words_advance(&next);
    reading->here = next;
    reading->context->after = AFTER_NOTHING;
    if (is_timed)
        (void)read_time(reading);
    return 1;
}

/* Groups of digits with one separator between two of them, which are given as a list; `sizes` has a hexadecimal digit
 * for each of the last eight groups. */
typedef struct {
    unsigned count, sizes, digits, largest;
    unsigned first, smallest; /* size of the first one, and of the smallest behind it */
} groups_t;

static groups_t take_groups(labial_words_place_t *here, const char *separators)
{
    groups_t groups = { 0, 0, 0, 0, 0, MOST_DIGITS };
    for (;;) {
        const unsigned size = labial_words_take_digits(here).count;
        groups.sizes = groups.sizes << 4 | (size < 15u ? size : 15u);
        groups.digits += size;
        if (size > groups.largest)
            groups.largest = size;
        if (groups.count++ == 0u)
            groups.first = size;
        else if (size < groups.smallest)
            groups.smallest = size;
        if (!labial_words_said_of(separators, here->code) || !labial_words_is_decimal(labial_words_following(here)))
            return groups;
        labial_words_advance(here);
    }
}

/* How many groups belong to the number of a telephone that is here, or 0: +1 555 123 4567; 555-1234, three groups and
 * more with hyphens, the three digits of an area in parentheses; 1-800 before letters; 555.123.4567. */
static unsigned phone_groups(const labial_words_place_t *here)
{
    labial_words_place_t next = *here;
    const int is_area = here->code >= '2';
    groups_t groups;
    if (here->before == '+') {
        groups = take_groups(&next, "-\0 \0");
        if (groups.digits < 8u) {
            next = *here;
            groups = take_groups(&next, ".\0");
            if (groups.count == 2u) /* a number and a fraction */
                groups.digits = 0;
        }
        if (groups.digits >= 8u && groups.digits <= MOST_DIGITS && (groups.count == 1u || groups.first <= 3u) &&
            !labial_words_is_inside(next.code))
            return groups.count;
        next = *here;
    }
    groups = take_groups(&next, "-\0");
    if (groups.largest <= 4u &&
        (groups.smallest >= 2u || (groups.largest == 1u && groups.count > 2u && next.code != '-')) &&
        !labial_words_is_inside(next.code) &&
        (next.code == '-'
             ? groups.count > 1u && groups.first == 1u && labial_words_is_capital(labial_words_following(&next))
             : groups.count > 2u || groups.sizes == 0x34u ||
                   (groups.sizes == 3u && is_area && next.code == ')' && here->before == '(')))
        return groups.count;
    next = *here;
    groups = take_groups(&next, ".\0");
    if (groups.count == 1u) {
        next = *here;
        groups = take_groups(&next, " \0");
    }
    return is_area && groups.sizes == 0x334u && !labial_words_is_inside(next.code) ? 3u : 0u;
}

static int read_phone(labial_words_reading_t *reading)
{
    const unsigned count = phone_groups(&reading->here);
    unsigned group;
    for (group = 0; group < count; group++) {
        if (group > 0u)
            labial_words_advance(&reading->here);
        labial_words_say_digits(reading, 0);
    }
    if (count > 0u)
        reading->context->after = count == 1u ? AFTER_PHONE : AFTER_NOTHING;
    return count > 0u;
}

/* Minutes or seconds, two digits. */
static void say_minutes(labial_words_reading_t *reading, unsigned value, unsigned character)
{
    if (value > 0u && value < TEN)
        labial_words_say(reading, "oh", SAID_PLAIN, character);
    labial_words_say_small(reading, value, CARDINAL, character);
}

/* 3:30, 15:00, 10:30:15. */
static int read_time(labial_words_reading_t *reading)
{
    labial_words_place_t next = reading->here;
    const unsigned character = labial_words_here(reading);
    const labial_words_number_t hours = labial_words_take_digits(&next);
    labial_words_number_t minutes, seconds;
    unsigned minutes_at, seconds_at, first;
    if (hours.count > 2u || next.code != ':')
        return 0;
    labial_words_advance(&next);
    minutes_at = next.characters - 1u;
    minutes = labial_words_take_digits(&next);
    seconds_at = minutes_at;
    seconds.value = 0;
    if (minutes.count != 2u || hours.value > 24u || minutes.value > 59u)
        return 0;
    if (next.code == ':') {
        labial_words_advance(&next);
        seconds_at = next.characters - 1u;
        seconds = labial_words_take_digits(&next);
        if (seconds.count != 2u || next.code == ':')
            return 0;
    }
    reading->context->after = AFTER_TIME;
    labial_words_say_small(reading, hours.value, CARDINAL, character);
    reading->here = next;
    if (minutes.value > 0u || seconds.value > 0u) {
        say_minutes(reading, minutes.value, minutes_at);
    } else if (labial_words_read_range(reading)) {
        return 1;
    } else {
        first = reading->word->count;
        labial_words_say(reading, hours.value >= 1u && hours.value <= 12u ? "o'clock" : "hundred", SAID_PLAIN,
                         character);
        labial_words_keep_tail(reading, first);
    }
    if (seconds.value > 0u)
        say_minutes(reading, seconds.value, seconds_at);
    (void)labial_words_read_range(reading);
    return 1;
}

/* ---- Fractions, lengths, decades -------------------------------------------------------------------------------- */

static int is_denominator(unsigned value)
{
    return (value >= 2u && value <= 10u) || value == 16u || value == 32u || value == 64u || value == 100u;
}

/* 3/4, 2/3; "and" before it behind a number. */
int labial_words_read_share(labial_words_reading_t *reading, int is_counted)
{
    labial_words_place_t next = reading->here;
    const unsigned character = labial_words_here(reading);
    const labial_words_number_t count = labial_words_take_digits(&next);
    labial_words_number_t parts;
    unsigned ending;
    if (count.count > 2u || next.code != '/')
        return 0;
    labial_words_advance(&next);
    parts = labial_words_take_digits(&next);
    if (parts.count == 0u || parts.count > 3u || labial_words_is_inside(next.code) || next.code == '/' ||
        !is_denominator(parts.value) || count.value == 0u || count.value >= parts.value)
        return 0;
    ending = count.value > 1u ? SAID_PLURAL : SAID_PLAIN;
    if (is_counted)
        labial_words_say(reading, "and", SAID_PLAIN, character);
    if (is_counted && count.value == 1u && (parts.value == 2u || parts.value == 4u))
        labial_words_say(reading, "a", SAID_PLAIN, character);
    else
        labial_words_say_small(reading, count.value, CARDINAL, character);
    if (parts.value == 2u || parts.value == 4u)
        labial_words_say(reading, parts.value == 2u ? "half" : "quarter", ending, character);
    else
        labial_words_say_small(reading, parts.value, ending == SAID_PLURAL ? ORDINALS : ORDINAL, character);
    reading->here = next;
    return 1;
}

/* 5'10. */
static int read_feet(labial_words_reading_t *reading)
{
    labial_words_place_t next = reading->here;
    const unsigned character = labial_words_here(reading);
    const labial_words_number_t feet = labial_words_take_digits(&next);
    labial_words_number_t inches;
    if (feet.count > 2u || next.code != '\'')
        return 0;
    labial_words_advance(&next);
    inches = labial_words_take_digits(&next);
    if (inches.count == 0u || inches.count > 2u || labial_words_is_inside(next.code))
        return 0;
    if (next.code == '"')
        labial_words_advance(&next);
    labial_words_say_small(reading, feet.value, CARDINAL, character);
    labial_words_say(reading, "foot", SAID_PLAIN, character);
    labial_words_say_small(reading, inches.value, CARDINAL, character);
    reading->here = next;
    return 1;
}

/* 1990s, 80s, 80's. */
static int read_decade(labial_words_reading_t *reading)
{
    labial_words_place_t next = reading->here;
    const unsigned character = labial_words_here(reading);
    const labial_words_number_t number = labial_words_take_digits(&next);
    if (number.count == 4u ? number.value < 1100u || number.value > 2099u : number.count != 2u || number.value < TWENTY)
        return 0;
    if (number.value % TEN != 0u)
        return 0;
    if (next.code == '\'')
        labial_words_advance(&next);
    if (next.code != 's' || labial_words_is_inside(labial_words_following(&next)))
        return 0;
    labial_words_advance(&next);
    if (number.count == 4u)
        say_year(reading, number.value, PLURALS, character);
    else
        labial_words_say_small(reading, number.value, PLURALS, character);
    reading->here = next;
    reading->context->after = AFTER_NOTHING;
    (void)labial_words_read_range(reading);
    return 1;
}

/* The day of a month that was named. */
static int read_day(labial_words_reading_t *reading)
{
    labial_words_place_t next = reading->here;
    const unsigned character = labial_words_here(reading);
    const labial_words_number_t day = labial_words_take_digits(&next);
    if (day.count > 2u || day.value < 1u || day.value > 31u || labial_words_is_inside(next.code) || next.code == ':' ||
        next.code == '/' ||
        ((next.code == '.' || next.code == ',') && labial_words_is_decimal(labial_words_following(&next))))
        return 0;
    labial_words_say_small(reading, day.value, ORDINAL, character);
    reading->here = next;
    reading->context->after = labial_words_read_range(reading) ? AFTER_MONTH : AFTER_NOTHING;
    return 1;
}

/* 1100 to 1999, 2010 to 2099. */
static int read_year(labial_words_reading_t *reading)
{
    labial_words_place_t next = reading->here;
    const unsigned character = labial_words_here(reading);
    const labial_words_number_t year = labial_words_take_digits(&next);
    if (year.count != 4u || year.value < 1100u || year.value > 2099u || year.value / TEN == 200u ||
        labial_words_is_inside(next.code) || next.code == '%' || labial_words_has_fraction(&next))
        return 0;
    say_year(reading, year.value, CARDINAL, character);
    reading->here = next;
    (void)labial_words_read_range(reading);
    return 1;
}

/* Whatever is more than a number. */
int labial_words_read_special(labial_words_reading_t *reading, unsigned after)
{
    return read_date(reading) || read_phone(reading) || read_time(reading) ||
           labial_words_read_share(reading, after == AFTER_ONE || after == AFTER_NUMBER) || read_feet(reading) ||
           read_decade(reading) || (after == AFTER_MONTH && read_day(reading)) || read_year(reading);
}
