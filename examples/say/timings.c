/*
 * timings.c - bytes to fields, fields to phonemes.
 *
 * timings_put() cuts the text into fields and lines; end_field() and end_line() give them their meaning, flite's at
 * the end of a field, that of the other two formats at the end of a line.
 */
#include "timings.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static int malformed(timings_t *t, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(t->message, sizeof t->message, format, arguments);
    va_end(arguments);
    return TIMINGS_MALFORMED;
}

/* ---- Numbers --------------------------------------------------------------------------------------------------- */

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/*
 * Reads `digits[.digits]` as an integer number of 1/10^places, rounding what lies beyond. Decimal digits are exact
 * where strtod() is not, and know neither signs, exponents nor nan. Returns 0 when `text` is anything else, or the
 * number exceeds `maximum`.
 */
static int read_decimal(const char *text, unsigned places, uint64_t maximum, uint64_t *value)
{
    uint64_t sum = 0;
    unsigned digits = 0;
    for (; is_digit(*text); text++, digits++) {
        sum = sum * 10u + (uint64_t)(*text - '0');
        if (sum > maximum)
            return 0;
    }
    unsigned taken = 0;
    uint64_t carry = 0;
    if (*text == '.') {
        for (text++; is_digit(*text); text++, digits++) {
            if (taken < places) {
                sum = sum * 10u + (uint64_t)(*text - '0');
                taken++;
            } else if (taken == places) {
                carry = *text >= '5';
                taken++;
            }
        }
    }
    if (digits == 0 || *text != '\0')
        return 0;
    for (; taken < places; taken++)
        sum *= 10u;
    *value = sum + carry;
    return *value <= maximum;
}

static int read_seconds(const char *text, uint64_t *microseconds)
{
    return read_decimal(text, 6, TIMINGS_TIME_MAX, microseconds);
}

static int read_milliseconds(const char *text, uint64_t *microseconds)
{
    return read_decimal(text, 3, TIMINGS_TIME_MAX, microseconds);
}

/* A pitch point's position or frequency; they do not matter here beyond being numbers. */
static int is_number(const char *text)
{
    uint64_t ignored;
    return read_seconds(*text == '-' || *text == '+' ? text + 1 : text, &ignored);
}

/* ---- Phonemes -------------------------------------------------------------------------------------------------- */

/* Hands on a phoneme that runs from where the latest ended to `end`, microseconds. */
static int emit(timings_t *t, const char *label, uint64_t end)
{
    const uint64_t milliseconds = (end + 500u) / 1000u - (t->end + 500u) / 1000u;
    if (milliseconds > TIMINGS_DURATION_MAX)
        return malformed(t, "'%s' is longer than an hour", label ? label : "silence");
    t->end = end;
    const timings_phoneme_t phoneme = {label, (uint32_t)milliseconds};
    return t->sink(t->user, &phoneme);
}

/* `label:end`. The last colon divides, since X-SAMPA labels may contain one. */
static int flite_token(timings_t *t, char *token)
{
    char *colon = strrchr(token, ':');
    if (!colon || colon == token || colon[1] == '\0')
        return malformed(t, "'%s' is not of the form label:seconds", token);
    uint64_t end;
    if (!read_seconds(colon + 1, &end))
        return malformed(t, "'%s' does not end with a time from 0 to 1000000 seconds", token);
    end += t->line_start;
    if (end > TIMINGS_TIME_MAX)
        return malformed(t, "'%s' is later than 1000000 seconds", token);
    if (end < t->end)
        return malformed(t, "'%s' ends before the phoneme before it does", token);
    *colon = '\0';
    return emit(t, token, end);
}

static int lab_line(timings_t *t)
{
    char (*f)[TIMINGS_FIELD_MAX + 1] = t->fields;
    uint64_t start, end;
    if (t->count < 3)
        return malformed(t, "expected `start end label`, found %u field%s", t->count, t->count == 1 ? "" : "s");
    if (!read_seconds(f[0], &start))
        return malformed(t, "the start '%s' is not a time from 0 to 1000000 seconds", f[0]);
    if (!read_seconds(f[1], &end))
        return malformed(t, "the end '%s' is not a time from 0 to 1000000 seconds", f[1]);
    if (end < start)
        return malformed(t, "'%s' ends at %s, before its start at %s", f[2], f[1], f[0]);
    if (start < t->end)
        return malformed(t, "'%s' starts at %s, before the phoneme before it ends", f[2], f[0]);
    if (start > t->end) {
        const int result = emit(t, NULL, start);
        if (result != 0)
            return result;
    }
    return emit(t, f[2], end);
}

static int pho_line(timings_t *t)
{
    char (*f)[TIMINGS_FIELD_MAX + 1] = t->fields;
    if (t->count == 1 && strcmp(f[0], "#") == 0)
        return 0;
    if (t->count < 2)
        return malformed(t, "'%s' has no duration", f[0]);
    uint64_t duration;
    if (!read_milliseconds(f[1], &duration))
        return malformed(t, "'%s' is not a duration from 0 to 1000000000 milliseconds", f[1]);
    if (t->count % 2 != 0)
        return malformed(t, "the last pitch point lacks its frequency");
    if (t->end + duration > TIMINGS_TIME_MAX)
        return malformed(t, "'%s' ends later than 1000000 seconds", f[0]);
    return emit(t, strcmp(f[0], "_") == 0 || strcmp(f[0], "_:") == 0 ? NULL : f[0], t->end + duration);
}

/* ---- Fields and lines ------------------------------------------------------------------------------------------ */

/*
 * Tells the format from the fields of the first line so far. A colon within the first field is flite's, a decimal point
 * in a number there is a time of lab. A first field of digits alone may also be an MBROLA phoneme (French has `2` and
 * `9`): then lab is what has a label in the third field. Otherwise it is a phoneme, and the second field must be its
 * duration.
 */
static int tell_format(timings_t *t, int line_ends)
{
    uint64_t ignored;
    const char *colon = strrchr(t->fields[0], ':');
    const int number = read_seconds(t->fields[0], &ignored);
    if (colon && colon != t->fields[0] && colon[1] != '\0')
        t->format = TIMINGS_FLITE;
    else if (number && strchr(t->fields[0], '.'))
        t->format = TIMINGS_LAB;
    else if (t->count == 3 && number)
        t->format = is_number(t->fields[2]) ? TIMINGS_PHO : TIMINGS_LAB;
    else if (t->count >= 2 && !number && read_milliseconds(t->fields[1], &ignored))
        t->format = TIMINGS_PHO;
    else if (t->count >= 2 && !number)
        return malformed(t, "this is not flite's, lab or pho timings");
    else if (line_ends && number)
        t->format = TIMINGS_PHO;
    else if (line_ends && strcmp(t->fields[0], "#") != 0)
        return malformed(t, "this is not flite's, lab or pho timings");
    return 0;
}

static int end_field(timings_t *t)
{
    char *field = t->fields[t->count < 3 ? t->count : 3];
    if (t->length == 0)
        return 0;
    field[t->length] = '\0';
    t->length = 0;
    t->count++;
    if (t->format == TIMINGS_AUTO) {
        const int result = tell_format(t, 0);
        if (result != 0)
            return result;
    }
    uint64_t apex;
    if (t->format == TIMINGS_FLITE) {
        t->count = 0;
        return flite_token(t, field);
    }
    if (t->format == TIMINGS_LAB && t->count == 4 && !read_seconds(field, &apex))
        return malformed(t, "the apex '%s' is not a time from 0 to 1000000 seconds", field);
    if (t->format == TIMINGS_LAB && t->count > 5)
        return malformed(t, "a line has five fields at most: start, end, label, apex, word");
    if (t->format == TIMINGS_PHO && t->count > 2 && !is_number(field))
        return malformed(t, "'%s' is not part of a pitch point", field);
    return 0;
}

static int end_line(timings_t *t)
{
    int result = 0;
    if (t->count > 0 && t->format == TIMINGS_AUTO)
        result = tell_format(t, 1);
    if (result == 0 && t->count > 0 && t->format == TIMINGS_LAB)
        result = lab_line(t);
    if (result == 0 && t->count > 0 && t->format == TIMINGS_PHO)
        result = pho_line(t);
    t->line_start = t->end;
    t->count = 0;
    t->comment = 0;
    return result;
}

/* ---- The parser ------------------------------------------------------------------------------------------------ */

void timings_init(timings_t *timings, timings_format_t format, timings_sink_t sink, void *user)
{
    memset(timings, 0, sizeof *timings);
    timings->line = 1;
    timings->format = format;
    timings->sink = sink;
    timings->user = user;
}

int timings_put(timings_t *t, unsigned char byte)
{
    int result = 0;
    if (byte == '\n') {
        result = end_field(t);
        if (result == 0)
            result = end_line(t);
        if (result == 0)
            t->line++;
        return result;
    }
    if (t->comment && byte != '\0')
        return 0;
    if (byte == ' ' || byte == '\t' || byte == '\r')
        return end_field(t);
    if (byte < 0x20 || byte == 0x7f)
        return malformed(t, "byte 0x%02x is not text", (unsigned)byte);
    if (byte == ';' && t->length == 0 && (t->format == TIMINGS_PHO || (t->format == TIMINGS_AUTO && t->count == 0))) {
        t->format = TIMINGS_PHO;
        t->comment = 1;
        return 0;
    }
    if (t->length == TIMINGS_FIELD_MAX)
        return malformed(t, "a field is longer than %d bytes", TIMINGS_FIELD_MAX);
    t->fields[t->count < 3 ? t->count : 3][t->length++] = (char)byte;
    return 0;
}

int timings_end(timings_t *timings)
{
    const int result = end_field(timings);
    return result != 0 ? result : end_line(timings);
}
