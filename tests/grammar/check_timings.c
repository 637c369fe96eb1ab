/*
 * check_timings.c - labial-say's parser of timings against tests/grammar/cases.tsv, whose first lines say what it holds.
 *
 *   check_timings cases.tsv
 *
 * Prints what differs. Returns 0 when nothing does.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "timings.h"

#define LINE_MAX_BYTES 4096

/* What was read so far, as the last column has it. */
typedef struct {
    char text[LINE_MAX_BYTES];
    size_t length;
    int in_milliseconds; /* without labels */
} found_t;

static int on_phoneme(void *user, const timings_phoneme_t *phoneme)
{
    found_t *found = (found_t *)user;
    const size_t room = sizeof found->text - found->length;
    int written;
    if (found->in_milliseconds)
        written = snprintf(found->text + found->length, room, "%lu", (unsigned long)phoneme->milliseconds);
    else
        written = snprintf(found->text + found->length, room, "%s%s:%lu", found->length ? " " : "",
                           phoneme->label ? phoneme->label : "-", (unsigned long)phoneme->milliseconds);
    if (written < 0 || (size_t)written >= room)
        return 1;
    found->length += (size_t)written;
    return 0;
}

static void read_text(const char *text, size_t length, timings_format_t format, found_t *found)
{
    static timings_t timings;
    int result = 0;
    found->length = 0;
    found->text[0] = '\0';
    timings_init(&timings, format, NULL, on_phoneme, found);
    for (size_t i = 0; i < length && result == 0; i++)
        result = timings_put(&timings, (unsigned char)text[i]);
    if (result == 0)
        result = timings_end(&timings);
    timings_free(&timings);
    if (result != 0)
        strcpy(found->text, "refused");
}

/* Replaces the escapes of a column in place; returns its length. */
static size_t plain(char *text)
{
    char *out = text;
    for (const char *c = text; *c; c++) {
        if (*c != '\\') {
            *out++ = *c;
        } else if (*++c == 'x') {
            const char digits[3] = { c[1], c[2], '\0' };
            *out++ = (char)strtol(digits, NULL, 16);
            c += 2;
        } else {
            *out++ = *c == 'n' ? '\n' : *c == 't' ? '\t' : *c == 'r' ? '\r' : *c;
        }
    }
    *out = '\0';
    return (size_t)(out - text);
}

/* Reads a row's text and compares; returns 1 where it differs. */
static int differs(unsigned long line, const char *text, size_t length, timings_format_t format, const char *expected)
{
    static found_t found;
    found.in_milliseconds = strchr(expected, ':') == NULL;
    read_text(text, length, format, &found);
    if (strcmp(found.text, expected) == 0)
        return 0;
    printf("cases.tsv:%lu: %s, not %s\n", line, found.text, expected);
    return 1;
}

static int number_differs(unsigned long line, const char *number, const char *expected)
{
    static const struct {
        timings_format_t format;
        const char *before, *behind;
    } texts[] = {
        { TIMINGS_LAB, "0 ", " m\n" },
        { TIMINGS_FLITE, "m:", "\n" },
        { TIMINGS_MARY, "#\n", " 1 m\n" },
        { TIMINGS_TEXTGRID,
          "\"ooTextFile\"\n\"TextGrid\"\n0\n1\n<exists>\n1\n\"IntervalTier\"\n\"phones\"\n0\n1\n1\n0\n", "\n\"m\"\n" },
    };
    char text[LINE_MAX_BYTES];
    int differing = 0;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        const int length = snprintf(text, sizeof text, "%s%s%s", texts[i].before, number, texts[i].behind);
        differing += differs(line, text, (size_t)length, texts[i].format, expected);
    }
    return differing;
}

int main(int argc, char **argv)
{
    static char row[LINE_MAX_BYTES];
    unsigned long line = 0, cases = 0;
    int differing = 0;
    FILE *file = argc == 2 ? fopen(argv[1], "rb") : NULL;
    if (!file) {
        fprintf(stderr, "usage: check_timings cases.tsv\n");
        return 2;
    }
    while (fgets(row, sizeof row, file)) {
        char *text = strchr(row, '\t'), *expected = text ? strchr(text + 1, '\t') : NULL;
        unsigned format = 0;
        line++;
        if (row[0] == '#')
            continue;
        row[strcspn(row, "\r\n")] = '\0';
        if (!expected) {
            printf("cases.tsv:%lu: not three columns\n", line);
            return 1;
        }
        *text++ = '\0';
        *expected++ = '\0';
        const size_t length = plain(text);
        (void)plain(expected);
        cases++;
        if (strcmp(row, "number") == 0) {
            differing += number_differs(line, text, expected);
            continue;
        }
        while (timings_format_name(format) && strcmp(timings_format_name(format), row) != 0)
            format++;
        if (!timings_format_name(format)) {
            printf("cases.tsv:%lu: no format is called %s\n", line, row);
            return 1;
        }
        differing += differs(line, text, length, (timings_format_t)format, expected);
    }
    fclose(file);
    printf("%lu cases, %d of them otherwise\n", cases, differing);
    return differing != 0 || cases == 0;
}
