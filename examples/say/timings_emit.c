/*
 * timings_emit.c - numbers, and phonemes on their way out.
 */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "timings_private.h"

int timings_malformed(timings_t *t, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(t->message, sizeof t->message, format, arguments);
    va_end(arguments);
    for (char *c = t->message; *c; c++) /* texts of a TextGrid may contain line ends; a message is one line */
        if ((unsigned char)*c < 0x20 || *c == 0x7f)
            *c = ' ';
    return TIMINGS_MALFORMED;
}

int timings_is_control(unsigned char byte)
{
    return (byte < 0x20 && byte != '\t' && byte != '\r' && byte != '\n') || byte == 0x7f;
}

/* ---- Numbers --------------------------------------------------------------------------------------------------- */

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Exponents are not told apart beyond this: no field has so many digits. */
#define EXPONENT_MAX 100000

/* The parts of a number: how many digits it has, how many of them stand before the point, and its power of ten. */
typedef struct {
    const char *digits; /* with the point among them */
    long count, before, exponent;
    int negative;
} parts_t;

/* Takes `text` apart by the one grammar of numbers, [-](digits[.[digits]]|.digits)[(e|E)[+|-]digits]; 0 when it is
 * none. */
static int take_apart(const char *text, parts_t *number)
{
    memset(number, 0, sizeof *number);
    number->negative = *text == '-';
    number->digits = text + number->negative;
    for (text = number->digits; is_digit(*text); text++)
        number->before++;
    number->count = number->before;
    if (*text == '.')
        for (text++; is_digit(*text); text++)
            number->count++;
    if (number->count == 0)
        return 0;
    if (*text == 'e' || *text == 'E') {
        const int below = text[1] == '-';
        text += below || text[1] == '+' ? 2 : 1;
        if (!is_digit(*text))
            return 0;
        for (; is_digit(*text); text++)
            if (number->exponent < EXPONENT_MAX)
                number->exponent = number->exponent * 10 + (*text - '0');
        if (below)
            number->exponent = -number->exponent;
    }
    return *text == '\0';
}

/* Reads a number as an integer number of 1/10^places, rounding what lies beyond. Digits are exact where strtod() is
 * not, and know no nan. */
int timings_read_decimal(const char *text, unsigned places, uint64_t maximum, uint64_t *value)
{
    parts_t number;
    uint64_t sum = 0, carry = 0;
    int other_than_zero = 0;
    long i = 0;
    if (!take_apart(text, &number))
        return 0;
    const long taken = number.before + number.exponent + (long)places; /* digits that the result has */
    for (const char *c = number.digits; i < number.count; c++) {
        if (*c == '.')
            continue;
        const unsigned digit = (unsigned)(*c - '0');
        other_than_zero |= digit != 0;
        if (i < taken)
            sum = sum * 10u + digit;
        else if (i == taken)
            carry = digit >= 5;
        if (sum > maximum)
            return 0;
        i++;
    }
    for (; i < taken && sum > 0; i++) {
        sum *= 10u;
        if (sum > maximum)
            return 0;
    }
    *value = sum + carry;
    return *value <= maximum && !(number.negative && other_than_zero);
}

int timings_read_seconds(const char *text, uint64_t *microseconds)
{
    return timings_read_decimal(text, 6, TIMINGS_TIME_MAX, microseconds);
}

int timings_read_milliseconds(const char *text, uint64_t *microseconds)
{
    return timings_read_decimal(text, 3, TIMINGS_TIME_MAX, microseconds);
}

int timings_is_whole(const char *text)
{
    if (*text == '\0')
        return 0;
    while (is_digit(*text))
        text++;
    return *text == '\0';
}

int timings_is_number(const char *text)
{
    parts_t number;
    return take_apart(text, &number);
}

/* ---- Phonemes -------------------------------------------------------------------------------------------------- */

/* Reads an intensity from 0 to 1 that ends with `>`, and nothing behind it. */
static int read_intensity(timings_t *t, const char *text, int *intensity)
{
    char number[16];
    const size_t length = strlen(text);
    uint64_t millionths;
    if (length < 2 || length > sizeof number || text[length - 1] != '>')
        return timings_malformed(t, "'%s' is not an intensity from 0 to 1 and '>'", text);
    memcpy(number, text, length - 1);
    number[length - 1] = '\0';
    if (!timings_read_decimal(number, 6, 1000000u, &millionths))
        return timings_malformed(t, "the intensity '%s' of a laugh is not from 0 to 1", number);
    *intensity = (int)((millionths * TIMINGS_LAUGH_FULL + 500000u) / 1000000u);
    return 0;
}

static int hand_on(timings_t *t, const char *label, int laugh, uint64_t end)
{
    const uint64_t milliseconds = (end + 500u) / 1000u - (t->end + 500u) / 1000u;
    if (milliseconds > TIMINGS_DURATION_MAX)
        return timings_malformed(t, "'%s' is longer than an hour", label ? label : laugh < 0 ? "silence" : "laugh");
    t->end = end;
    const timings_phoneme_t phoneme = { label, (uint32_t)milliseconds, laugh, timings_is_sampa(t->format) };
    return t->sink(t->user, &phoneme);
}

int timings_emit(timings_t *t, const char *label, uint64_t end)
{
    static const char laugh[] = "<laugh";
    if (label && strncmp(label, laugh, sizeof laugh - 1) == 0) {
        const char *rest = label + sizeof laugh - 1;
        int intensity = TIMINGS_LAUGH_FULL / 2;
        if (*rest == ':' || *rest == ' ') {
            const int result = read_intensity(t, rest + 1, &intensity);
            if (result != 0)
                return result;
            return hand_on(t, NULL, intensity, end);
        }
        if (strcmp(rest, ">") == 0)
            return hand_on(t, NULL, intensity, end);
    }
    if (label && strlen(label) > TIMINGS_LABEL_MAX)
        return timings_malformed(t, "the label '%.20s...' is longer than %d bytes", label, TIMINGS_LABEL_MAX);
    return hand_on(t, label, -1, end);
}

int timings_emit_between(timings_t *t, const char *label, uint64_t start, uint64_t end)
{
    start += t->origin;
    end += t->origin;
    if (start + TIMINGS_TOLERANCE < t->end)
        return timings_malformed(t, "'%.63s' starts at %llu.%06llu s, before the phoneme before it ends",
                                 label ? label : "", (unsigned long long)(start / 1000000u),
                                 (unsigned long long)(start % 1000000u));
    if (end > TIMINGS_TIME_MAX)
        return timings_malformed(t, "'%.63s' ends later than 1000000 seconds", label ? label : "");
    if (start > t->end + TIMINGS_TOLERANCE) {
        const int result = hand_on(t, NULL, -1, start);
        if (result != 0)
            return result;
    }
    return timings_emit(t, label, end > t->end ? end : t->end);
}

int timings_marker(timings_t *t)
{
    char *last = t->fields[t->count - 1];
    uint64_t duration;
    int intensity = TIMINGS_LAUGH_FULL / 2;
    if (t->count < 2 || t->count > 3)
        return timings_malformed(t, "expected `<laugh SECONDS [INTENSITY]>`");
    if (t->count == 3) {
        const int result = read_intensity(t, last, &intensity);
        if (result != 0)
            return result;
    } else {
        last[strlen(last) - 1] = '\0';
    }
    if (!timings_read_seconds(t->fields[1], &duration))
        return timings_malformed(t, "'%.63s' is not the duration of a laugh in seconds", t->fields[1]);
    if (t->end + duration > TIMINGS_TIME_MAX)
        return timings_malformed(t, "the laugh ends later than 1000000 seconds");
    t->origin += duration;
    return hand_on(t, NULL, intensity, t->end + duration);
}
