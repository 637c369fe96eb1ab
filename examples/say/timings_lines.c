/*
 * timings_lines.c - what fields and lines mean in each format but TextGrid: flite's at the end of a field, those of the
 * others at the end of a line.
 */
#include <string.h>

#include "timings_private.h"

/* ---- One function per format ----------------------------------------------------------------------------------- */

/* `label:end`. The last colon divides, since X-SAMPA labels may contain one. */
static int flite_token(timings_t *t, char *token)
{
    char *colon = strrchr(token, ':');
    if (!colon || colon == token || colon[1] == '\0')
        return timings_malformed(t, "'%.63s' is not of the form label:seconds", token);
    uint64_t end;
    if (!timings_read_seconds(colon + 1, &end))
        return timings_malformed(t, "'%.63s' does not end with a time from 0 to 1000000 seconds", token);
    end += t->origin;
    if (end > TIMINGS_TIME_MAX)
        return timings_malformed(t, "'%.63s' is later than 1000000 seconds", token);
    if (end < t->end)
        return timings_malformed(t, "'%.63s' ends before the phoneme before it does", token);
    *colon = '\0';
    return timings_emit(t, token, end);
}

static int too_few(timings_t *t, const char *expected)
{
    return timings_malformed(t, "expected `%s`, found %u field%s", expected, t->count, t->count == 1 ? "" : "s");
}

static int lab_line(timings_t *t)
{
    field_t *f = t->fields;
    uint64_t start, end, apex = 0;
    if (t->count < 3)
        return too_few(t, "start end label");
    if (!timings_read_seconds(f[0], &start))
        return timings_malformed(t, "the start '%.63s' is not a time from 0 to 1000000 seconds", f[0]);
    if (!timings_read_seconds(f[1], &end))
        return timings_malformed(t, "the end '%.63s' is not a time from 0 to 1000000 seconds", f[1]);
    if (end < start)
        return timings_malformed(t, "'%.63s' ends at %.20s, before its start at %.20s", f[2], f[1], f[0]);
    if (t->count > 3 && !timings_read_seconds(f[3], &apex))
        return timings_malformed(t, "the apex '%.63s' is not a time from 0 to 1000000 seconds", f[3]);
    if (t->count > 3 && (apex + TIMINGS_TOLERANCE < start || apex > end + TIMINGS_TOLERANCE))
        return timings_malformed(t, "the apex '%.63s' is outside its segment", f[3]);
    return timings_emit_between(t, f[2], start, end);
}

/* The phoneme in a label with context: `a^b-c+d=e...`, `b-c+d`, `c+d` or `b-c`; the label itself when it has none. A
 * label that starts with + is the name of a noise. */
static char *centre_of(char *label)
{
    char *before, *behind;
    if (label[0] == '+' || label[0] == '-' || label[0] == '<')
        return label;
    before = strchr(label, '^');
    before = strchr(before ? before : label, '-');
    if (before && before[1] != '\0')
        label = before + 1;
    behind = strchr(label + 1, '+');
    if (behind)
        *behind = '\0';
    return label;
}

static int htk_line(timings_t *t)
{
    field_t *f = t->fields;
    uint64_t start, end;
    if (t->count < 3)
        return too_few(t, "start end label");
    if (!timings_is_whole(f[0]) || !timings_read_decimal(f[0], 0, TIMINGS_TIME_MAX * 10u, &start))
        return timings_malformed(t, "the start '%.63s' is not a whole number of 100 ns", f[0]);
    if (!timings_is_whole(f[1]) || !timings_read_decimal(f[1], 0, TIMINGS_TIME_MAX * 10u, &end))
        return timings_malformed(t, "the end '%.63s' is not a whole number of 100 ns", f[1]);
    char *label = centre_of(f[2]);
    if (end < start)
        return timings_malformed(t, "'%.63s' ends at %.20s, before its start at %.20s", label, f[1], f[0]);
    return timings_emit_between(t, label, (start + 5u) / 10u, (end + 5u) / 10u);
}

static int pho_line(timings_t *t)
{
    field_t *f = t->fields;
    if (t->count == 1 && strcmp(f[0], "#") == 0)
        return 0;
    if (t->count < 2)
        return timings_malformed(t, "'%.63s' has no duration", f[0]);
    uint64_t duration;
    if (!timings_read_milliseconds(f[1], &duration))
        return timings_malformed(t, "'%.63s' is not a duration from 0 to 1000000000 milliseconds", f[1]);
    if (t->count % 2 != 0)
        return timings_malformed(t, "the last pitch point lacks its frequency");
    if (t->end + duration > TIMINGS_TIME_MAX)
        return timings_malformed(t, "'%.63s' ends later than 1000000 seconds", f[0]);
    return timings_emit(t, strcmp(f[0], "_") == 0 || strcmp(f[0], "_:") == 0 ? NULL : f[0], t->end + duration);
}

static int mary_line(timings_t *t)
{
    field_t *f = t->fields;
    uint64_t end;
    if (t->count != 3)
        return too_few(t, "end number label");
    if (!timings_read_seconds(f[0], &end))
        return timings_malformed(t, "the end '%.63s' is not a time from 0 to 1000000 seconds", f[0]);
    if (!timings_is_number(f[1]))
        return timings_malformed(t, "the second field, '%.63s', is not a number", f[1]);
    end += t->origin;
    if (end > TIMINGS_TIME_MAX)
        return timings_malformed(t, "'%.63s' ends later than 1000000 seconds", f[2]);
    if (end < t->end)
        return timings_malformed(t, "'%.63s' ends before the phoneme before it does", f[2]);
    return timings_emit(t, f[2], end);
}

/* Whether `text` is `word`, which is in lower case, in any case. */
static int is_word(const char *text, const char *word)
{
    for (; *word; text++, word++)
        if (*text != *word && !(*text >= 'A' && *text <= 'Z' && *text - 'A' + 'a' == *word))
            return 0;
    return *text == '\0';
}

static int phseg_line(timings_t *t)
{
    field_t *f = t->fields;
    uint64_t first, last;
    if (t->heading == 2)
        return timings_malformed(t, "the total score is not the last line");
    if (t->heading == 0) {
        if (t->count < 4 || !is_word(f[0], "sfrm") || !is_word(f[1], "efrm") || !is_word(f[2], "segascr") ||
            !is_word(f[3], "phone"))
            return timings_malformed(t, "expected the header `SFrm EFrm SegAScr Phone`");
        t->heading = 1;
        return 0;
    }
    if (is_word(f[0], "total")) {
        t->heading = 2;
        return 0;
    }
    if (t->count < 4)
        return too_few(t, "SFrm EFrm SegAScr Phone");
    if (!timings_is_whole(f[0]) || !timings_read_decimal(f[0], 0, TIMINGS_TIME_MAX / 10000u, &first))
        return timings_malformed(t, "the first frame '%.63s' is not a whole number", f[0]);
    if (!timings_is_whole(f[1]) || !timings_read_decimal(f[1], 0, TIMINGS_TIME_MAX / 10000u, &last))
        return timings_malformed(t, "the last frame '%.63s' is not a whole number", f[1]);
    if (last < first)
        return timings_malformed(t, "'%.63s' ends in frame %.20s, before its first frame %.20s", f[3], f[1], f[0]);
    return timings_emit_between(t, f[3], first * 10000u, (last + 1u) * 10000u);
}

/* ---- Fields that mean something before their line ends --------------------------------------------------------- */

static int flite_field(timings_t *t, char *field)
{
    t->count = 0;
    return flite_token(t, field);
}

/* A line that starts with # is a comment. */
static int hash_field(timings_t *t, char *field)
{
    if (t->count == 1 && field[0] == '#') {
        t->comment = 1;
        t->count = 0;
    }
    return 0;
}

static int lab_field(timings_t *t, char *field)
{
    hash_field(t, field);
    return t->count <= 5 ? 0 : timings_malformed(t, "a line has five fields at most: start, end, label, apex, word");
}

static int pho_field(timings_t *t, char *field)
{
    if (t->count > 2 && !timings_is_number(field))
        return timings_malformed(t, "'%.63s' is not part of a pitch point", field);
    return 0;
}

/* ---- The list of formats --------------------------------------------------------------------------------------- */

static const struct {
    const char *name;
    const char *help;                        /* what --help says of it */
    int (*field)(timings_t *t, char *field); /* takes a field that has ended; null where all wait for the line's end */
    int (*line)(timings_t *t);               /* takes a line that has ended and is not empty; null where none does */
    int sampa;                               /* labels are X-SAMPA */
} formats[] = {
    [TIMINGS_AUTO] = { "auto", "told from the first line (default)", NULL, NULL, 0 },
    [TIMINGS_FLITE] = { "flite", "`flite -psdur`: label:end ..., seconds; every line starts again from 0", flite_field,
                        NULL, 0 },
    [TIMINGS_LAB] = { "lab", "start end label [apex [word]], a line each, seconds; gaps are silence; # comment",
                      lab_field, lab_line, 0 },
    [TIMINGS_HTK] = { "htk", "start end label, a line each, units of 100 ns; also HTS's labels with context, a^b-c+d=e",
                      NULL, htk_line, 0 },
    [TIMINGS_PHO] = { "pho", "MBROLA: label milliseconds [position pitch]..., a line each; ; comment, _ silence",
                      pho_field, pho_line, 1 },
    [TIMINGS_MARY] = { "mary", "MaryTTS REALISED_DURATIONS: a line of #, then end number label, a line each, seconds",
                       hash_field, mary_line, 1 },
    [TIMINGS_PHSEG] = { "phseg", "CMU Sphinx: SFrm EFrm SegAScr Phone, frames of 10 ms", NULL, phseg_line, 0 },
    [TIMINGS_TEXTGRID] = { "textgrid", "Praat or Montreal Forced Aligner; the tier of phones is found by its name",
                           NULL, NULL, 0 }, /* timings_textgrid.c reads it */
};
#define FORMATS (sizeof formats / sizeof formats[0])

const char *timings_format_name(unsigned format)
{
    return format < FORMATS ? formats[format].name : NULL;
}

void timings_help(FILE *out)
{
    for (size_t f = 0; f < FORMATS; f++)
        fprintf(out, "  %-6s %-8s %s\n", f == 0 ? "--from" : "", formats[f].name, formats[f].help);
}

int timings_is_sampa(timings_format_t format)
{
    return formats[format].sampa;
}

/* ---- Which format it is ---------------------------------------------------------------------------------------- */

static int unknown_format(timings_t *t)
{
    char names[128] = "";
    size_t length = 0;
    for (size_t f = TIMINGS_AUTO + 1; f < FORMATS && length < sizeof names; f++) {
        const char *before = f == TIMINGS_AUTO + 1 ? "" : f + 1 < FORMATS ? ", " : " or ";
        length += (size_t)snprintf(names + length, sizeof names - length, "%s%s", before, formats[f].name);
    }
    return timings_malformed(t, "this is not timings of %s", names);
}

/* A first line that starts with a number: all its fields are needed to tell. Times of lab have decimal points; where
 * they have none, an end beyond TIMINGS_DURATION_MAX is not in seconds. A first field of digits alone may also be an
 * MBROLA phoneme (French has `2` and `9`), with a duration and pitch points behind it; two numbers alone are a line
 * that lacks its label. */
static int tell_numbers(timings_t *t, int line_ends)
{
    uint64_t end;
    if (t->count == 1 && strchr(t->fields[0], '.'))
        t->format = t->heading ? TIMINGS_MARY : TIMINGS_LAB;
    else if (t->count >= 3 && timings_is_number(t->fields[2]))
        t->format = TIMINGS_PHO;
    else if (!t->heading && t->count >= 3 && timings_is_whole(t->fields[0]) && timings_is_whole(t->fields[1]) &&
             timings_read_decimal(t->fields[1], 0, UINT64_MAX / 16u, &end) && end > TIMINGS_DURATION_MAX / 1000u)
        t->format = TIMINGS_HTK;
    else if (t->count >= 3 || line_ends)
        t->format = t->heading ? TIMINGS_MARY : TIMINGS_LAB;
    return 0;
}

/* Tells the format from the fields of the first line so far. A colon within the first field is flite's; otherwise what
 * is no number is MBROLA's phoneme, and the second field must be its duration. */
static int tell_format(timings_t *t, int line_ends)
{
    const char *first = t->fields[0];
    uint64_t ignored;
    if (timings_is_number(first))
        return tell_numbers(t, line_ends);
    const char *colon = strrchr(first, ':');
    if (colon && colon != first && timings_is_number(colon + 1))
        t->format = TIMINGS_FLITE;
    else if (is_word(first, "sfrm"))
        t->format = TIMINGS_PHSEG;
    else if (is_word(first, "file") || first[0] == '"')
        t->format = TIMINGS_TEXTGRID;
    else if (t->count >= 2 && timings_read_milliseconds(t->fields[1], &ignored))
        t->format = TIMINGS_PHO;
    else if (strcmp(first, "#") == 0 && t->count == 1)
        t->heading = 1; /* mary's, or pho's flush mark */
    else if (t->count >= 2 || line_ends)
        return unknown_format(t);
    return 0;
}

/* ---- Fields and lines ------------------------------------------------------------------------------------------ */

int timings_end_field(timings_t *t)
{
    char *field = t->fields[t->count < 4 ? t->count : 4];
    if (t->length == 0)
        return 0;
    field[t->length] = '\0';
    const size_t length = t->length;
    t->length = 0;
    t->count++;
    if (t->count == 1 && strcmp(field, "<laugh") == 0 && t->format != TIMINGS_PHSEG) {
        t->marker = 1;
        return 0;
    }
    if (t->marker) {
        if (field[length - 1] != '>')
            return t->count <= 3 ? 0 : timings_malformed(t, "expected `<laugh SECONDS [INTENSITY]>`");
        const int result = timings_marker(t);
        t->marker = 0;
        t->count = 0;
        return result;
    }
    if (t->format == TIMINGS_AUTO) {
        const int result = tell_format(t, 0);
        if (result != 0)
            return result;
    }
    return formats[t->format].field ? formats[t->format].field(t, field) : 0;
}

int timings_end_line(timings_t *t)
{
    int result = 0;
    if (t->marker)
        return timings_malformed(t, "a laugh is not closed by '>'");
    if (t->count > 0 && t->format == TIMINGS_AUTO)
        result = tell_format(t, 1);
    if (result == 0 && t->count > 0 && formats[t->format].line)
        result = formats[t->format].line(t);
    if (t->format == TIMINGS_FLITE)
        t->origin = t->end;
    t->count = 0;
    t->comment = 0;
    return result;
}
