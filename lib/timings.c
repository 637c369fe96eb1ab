/*
 * timings.c - bytes to fields and lines, and what those mean in each format but TextGrid (labial/timings.h): flite's at
 * the end of a field, those of the others at the end of a line.
 */
#include "labial/timings.h"

#include <string.h>

#include "timings_parts.h"

/* ---- One function per format ----------------------------------------------------------------------------------- */

#define HTK_UNIT 100u /* nanoseconds */
#define PHSEG_FRAME 10000000u

/* A time in seconds, and a whole number of units of so many nanoseconds; `what` it is, is for the message. */
static int row_time(labial_timings_t *t, const char *what, const char *text, uint64_t *time)
{
    if (labial_timings_read(text, LABIAL_SECOND, LABIAL_TIMINGS_TIME_MAX, time))
        return LABIAL_OK;
    return labial_timings_malformed(t, "the % '%' is not a time from 0 to 1000000 seconds", what, text, 0);
}

static int row_whole(labial_timings_t *t, const char *what, const char *text, uint32_t unit, uint64_t *value)
{
    if (labial_timings_is_whole(text) && labial_timings_read(text, 0, LABIAL_TIMINGS_TIME_MAX / unit, value))
        return LABIAL_OK;
    return labial_timings_malformed(t, "the % '%' is not a whole number%", what, text,
                                    unit == HTK_UNIT ? " of 100 ns" : "");
}

/* The end of a phoneme that has no other time, which `shown` is in the message. */
static int row_end(labial_timings_t *t, const char *shown, uint64_t *end)
{
    *end += t->origin;
    if (*end < t->end)
        return labial_timings_malformed(t, "'%' ends before the phoneme before it does", shown, 0, 0);
    return LABIAL_OK;
}

/* A phoneme with both its times, counted from the text's origin; `from` and `to` are how the text has them. */
static int row_between(labial_timings_t *t, char *label, uint64_t start, uint64_t end, const char *from, const char *to)
{
    if (end < start)
        return labial_timings_malformed(t, "'%' ends at %, before its start at %", label, to, from);
    return labial_timings_emit(t, label, start + t->origin, end + t->origin);
}

/* `label:end`. The last colon divides, since X-SAMPA labels may contain one. */
static int flite_field(labial_timings_t *t, char *token)
{
    char *colon = 0, *c;
    uint64_t end;
    int result;
    t->count = 0;
    for (c = token; *c; c++)
        if (*c == ':')
            colon = c;
    if (!colon || colon == token || colon[1] == '\0')
        return labial_timings_malformed(t, "'%' is not of the form label:seconds", token, 0, 0);
    if (!labial_timings_read(colon + 1, LABIAL_SECOND, LABIAL_TIMINGS_TIME_MAX, &end))
        return labial_timings_malformed(t, "'%' does not end with a time from 0 to 1000000 seconds", token, 0, 0);
    result = row_end(t, token, &end);
    *colon = '\0';
    return result != LABIAL_OK ? result : labial_timings_emit(t, token, t->end, end);
}

static int row_too_few(labial_timings_t *t, const char *expected)
{
    char count[21];
    return labial_timings_malformed(t, "expected `%`, found % field%", expected,
                                    labial_timings_decimal(count, t->count), t->count == 1u ? "" : "s");
}

/* Whether the first row of lab is one of HTK's: in seconds it would be longer than any phoneme. */
static int row_is_htk(const labial_timings_t *t)
{
    uint64_t end = LABIAL_TIMINGS_TIME_MAX; /* where it is larger */
    if (t->rows || !labial_timings_is_whole(t->fields[0]) || !labial_timings_is_whole(t->fields[1]))
        return 0;
    (void)labial_timings_read(t->fields[1], 0, LABIAL_TIMINGS_TIME_MAX, &end);
    return end > LABIAL_DURATION_MAX / 1000u;
}

/* A line that starts with # is a comment. */
static int hash_field(labial_timings_t *t, char *field)
{
    if (t->count == 1u && field[0] == '#') {
        t->comment = 1;
        t->count = 0;
    }
    return LABIAL_WAITING;
}

static int lab_field(labial_timings_t *t, char *field)
{
    (void)hash_field(t, field);
    if (t->count == 3u && row_is_htk(t))
        t->format = LABIAL_TIMINGS_HTK;
    if (t->count > 5u)
        return labial_timings_malformed(t, "a line has five fields at most: start, end, label, apex, word", 0, 0, 0);
    return LABIAL_WAITING;
}

static int lab_line(labial_timings_t *t)
{
    uint64_t start, end, apex = 0;
    int result;
    t->rows = 1;
    if (t->count < 3u)
        return row_too_few(t, "start end label");
    result = row_time(t, "start", t->fields[0], &start);
    if (result == LABIAL_OK)
        result = row_time(t, "end", t->fields[1], &end);
    if (result == LABIAL_OK && t->count > 3u)
        result = row_time(t, "apex", t->fields[3], &apex);
    if (result == LABIAL_OK)
        result = row_between(t, t->fields[2], start, end, t->fields[0], t->fields[1]);
    if (result != LABIAL_OK || t->count == 3u)
        return result;
    if (apex + LABIAL_TIMINGS_TOLERANCE < start || apex > end + LABIAL_TIMINGS_TOLERANCE)
        return labial_timings_malformed(t, "the apex '%' is outside its segment", t->fields[3], 0, 0);
    t->found.apex = apex + t->origin;
    t->found.has_apex = 1;
    t->found.word = t->count > 4u ? t->fields[4] : 0;
    return LABIAL_OK;
}

/* The phoneme in a label with context: `a^b-c+d=e...`, `b-c+d`, `c+d` or `b-c`; the label itself when it has none. A
 * label that starts with + is the name of a noise. */
static char *row_centre(char *label)
{
    char *c, *before = 0;
    if (label[0] == '+' || label[0] == '-' || label[0] == '<')
        return label;
    for (c = label; *c && *c != '^'; c++)
        ;
    for (c = *c ? c : label; *c && !before; c++)
        if (*c == '-')
            before = c;
    if (before && before[1] != '\0')
        label = before + 1;
    for (c = label + 1; *c && *c != '+'; c++)
        ;
    *c = '\0';
    return label;
}

static int htk_line(labial_timings_t *t)
{
    uint64_t start, end;
    int result;
    if (t->count < 3u)
        return row_too_few(t, "start end label");
    result = row_whole(t, "start", t->fields[0], HTK_UNIT, &start);
    if (result == LABIAL_OK)
        result = row_whole(t, "end", t->fields[1], HTK_UNIT, &end);
    if (result != LABIAL_OK)
        return result;
    return row_between(t, row_centre(t->fields[2]), HTK_UNIT * start, HTK_UNIT * end, t->fields[0], t->fields[1]);
}

static int pho_field(labial_timings_t *t, char *field)
{
    if (t->count > 2u && !labial_timings_is_number(field))
        return labial_timings_malformed(t, "'%' is not part of a pitch point", field, 0, 0);
    return LABIAL_WAITING;
}

static int pho_line(labial_timings_t *t)
{
    char *label = t->fields[0];
    uint64_t duration;
    if (t->count == 1u && labial_timings_is(label, "#"))
        return LABIAL_WAITING;
    if (t->count < 2u)
        return labial_timings_malformed(t, "'%' has no duration", label, 0, 0);
    if (!labial_timings_read(t->fields[1], LABIAL_MILLISECOND, LABIAL_TIMINGS_TIME_MAX, &duration))
        return labial_timings_malformed(t, "'%' is not a duration from 0 to 1000000000 milliseconds", t->fields[1], 0,
                                        0);
    if (t->count % 2u != 0u)
        return labial_timings_malformed(t, "the last pitch point lacks its frequency", 0, 0, 0);
    if (labial_timings_is(label, "_") || labial_timings_is(label, "_:"))
        label = 0;
    return labial_timings_emit(t, label, t->end, t->end + duration);
}

static int mary_line(labial_timings_t *t)
{
    uint64_t end;
    int result;
    if (t->count != 3u)
        return row_too_few(t, "end number label");
    result = row_time(t, "end", t->fields[0], &end);
    if (result != LABIAL_OK)
        return result;
    if (!labial_timings_is_number(t->fields[1]))
        return labial_timings_malformed(t, "the second field, '%', is not a number", t->fields[1], 0, 0);
    result = row_end(t, t->fields[2], &end);
    return result != LABIAL_OK ? result : labial_timings_emit(t, t->fields[2], t->end, end);
}

#define PHSEG_HEADER "SFrm EFrm SegAScr Phone"

static int phseg_line(labial_timings_t *t)
{
    static const char *const header[] = { "sfrm", "efrm", "segascr", "phone" };
    uint64_t first, last;
    unsigned i;
    int result;
    if (t->heading == 2u)
        return labial_timings_malformed(t, "the total score is not the last line", 0, 0, 0);
    if (t->heading == 0u) {
        for (i = 0; i < 4u && i < t->count && labial_timings_is_word(t->fields[i], header[i]); i++)
            ;
        if (i < 4u)
            return labial_timings_malformed(t, "expected the header `%`", PHSEG_HEADER, 0, 0);
        t->heading = 1;
        return LABIAL_WAITING;
    }
    if (labial_timings_is_word(t->fields[0], "total")) {
        t->heading = 2;
        return LABIAL_WAITING;
    }
    if (t->count < 4u)
        return row_too_few(t, PHSEG_HEADER);
    result = row_whole(t, "first frame", t->fields[0], PHSEG_FRAME, &first);
    if (result == LABIAL_OK)
        result = row_whole(t, "last frame", t->fields[1], PHSEG_FRAME, &last);
    if (result != LABIAL_OK)
        return result;
    if (last < first)
        return labial_timings_malformed(t, "'%' ends in frame %, before its first frame %", t->fields[3], t->fields[1],
                                        t->fields[0]);
    return labial_timings_emit(t, t->fields[3], first * PHSEG_FRAME + t->origin, (last + 1u) * PHSEG_FRAME + t->origin);
}

/* ---- The list of formats --------------------------------------------------------------------------------------- */

/* X(name, suffix, help, field, line): `field` takes a field that has ended, null where all wait for the line; `line`
 * takes a line that has ended and is not empty, null where none does. */
#define LABIAL_FORMATS(X)                                                                                              \
    X("auto", "", "told from the first line that is no comment (default)", 0, 0)                                       \
    X("flite", ".psdur", "`flite -psdur`: label:end ..., seconds; every line starts again from 0", flite_field, 0)     \
    X("lab", ".lab", "start end label [apex [word]], a line each, seconds; gaps are silence; # comment", lab_field,    \
      lab_line)                                                                                                        \
    X("htk", "", "start end label, a line each, units of 100 ns; also HTS's labels with context, a^b-c+d=e", 0,        \
      htk_line)                                                                                                        \
    X("pho", ".pho", "MBROLA: label milliseconds [position pitch]..., a line each; ; comment, _ silence", pho_field,   \
      pho_line)                                                                                                        \
    X("mary", ".realised_durations",                                                                                   \
      "MaryTTS REALISED_DURATIONS: a line of #, then end number label, a line each, seconds", hash_field, mary_line)   \
    X("phseg", ".phseg", "CMU Sphinx: SFrm EFrm SegAScr Phone, frames of 10 ms", 0, phseg_line)                        \
    X("textgrid", ".textgrid", "Praat or Montreal Forced Aligner; the tier of phones is found by its name", 0, 0)

typedef int (*field_fn)(labial_timings_t *t, char *field);
typedef int (*line_fn)(labial_timings_t *t);

#define FORMAT_NAME(name, suffix, help, field, line) name,
#define FORMAT_SUFFIX(name, suffix, help, field, line) suffix,
#define FORMAT_HELP(name, suffix, help, field, line) help,
#define FORMAT_FIELD(name, suffix, help, field, line) field,
#define FORMAT_LINE(name, suffix, help, field, line) line,
static const char *const format_names[] = { LABIAL_FORMATS(FORMAT_NAME) };
static const char *const format_suffixes[] = { LABIAL_FORMATS(FORMAT_SUFFIX) };
static const char *const format_helps[] = { LABIAL_FORMATS(FORMAT_HELP) };
static const field_fn format_fields[] = { LABIAL_FORMATS(FORMAT_FIELD) };
static const line_fn format_lines[] = { LABIAL_FORMATS(FORMAT_LINE) };

#define FORMAT_COUNT ((unsigned)(sizeof format_names / sizeof format_names[0]))

const char *labial_timings_format_name(unsigned format)
{
    return format < FORMAT_COUNT ? format_names[format] : 0;
}

const char *labial_timings_format_help(unsigned format)
{
    return format < FORMAT_COUNT ? format_helps[format] : 0;
}

const char *labial_timings_format_suffix(unsigned format)
{
    return format < FORMAT_COUNT ? format_suffixes[format] : 0;
}

/* ---- Which format it is ---------------------------------------------------------------------------------------- */

/* Whether the first row of numbers is mary's, which has a phoneme's end and a whole number below a line of # alone, or
 * lab's, below a comment: a start, mostly 0, and an end. */
static int row_is_mary(const labial_timings_t *t)
{
    uint64_t end = 1; /* where it is too large */
    if (!t->heading || t->count < 2u || !labial_timings_is_whole(t->fields[1]))
        return 0;
    (void)labial_timings_read(t->fields[0], LABIAL_SECOND, LABIAL_TIMINGS_TIME_MAX, &end);
    return end > 0u;
}

/* A first line that starts with a number: all its fields are needed to tell. Times of lab have decimal points. A first
 * field of digits alone may also be an MBROLA phoneme (French has `2` and `9`), with a duration and pitch points behind
 * it; two numbers alone are a line that lacks its label. */
static void tell_numbers(labial_timings_t *t, int line_ends)
{
    const char *c = t->fields[0];
    while (*c && *c != '.')
        c++;
    if (t->count >= 3u && labial_timings_is_number(t->fields[2]))
        t->format = LABIAL_TIMINGS_PHO;
    else if ((*c && !t->heading) || t->count >= 3u || line_ends)
        t->format = row_is_mary(t) ? LABIAL_TIMINGS_MARY : LABIAL_TIMINGS_LAB;
}

/* A line that starts with #: a comment of lab or mary, or # alone, which is mary's heading or pho's flush mark. */
static void tell_hash(labial_timings_t *t, int line_ends)
{
    if (t->count > 1u || !labial_timings_is(t->fields[0], "#"))
        t->comment = 1;
    else if (line_ends)
        t->heading = 1;
}

/* Tells the format from the fields so far of the first line that is no comment. A colon within the first field is
 * flite's; otherwise what is no number is MBROLA's phoneme, and the second field must be its duration. */
static int tell_format(labial_timings_t *t, int line_ends)
{
    const char *first = t->fields[0], *colon = 0, *c;
    uint64_t ignored;
    for (c = first; *c; c++)
        if (*c == ':')
            colon = c;
    if (labial_timings_is_number(first))
        tell_numbers(t, line_ends);
    else if (colon && colon != first && labial_timings_is_number(colon + 1))
        t->format = LABIAL_TIMINGS_FLITE;
    else if (first[0] == '#')
        tell_hash(t, line_ends);
    else if (labial_timings_is_word(first, "sfrm")) {
        t->format = LABIAL_TIMINGS_PHSEG;
        t->heading = 0;
    } else if (labial_timings_is_word(first, "file") || first[0] == '"')
        t->format = LABIAL_TIMINGS_TEXTGRID;
    else if (t->count >= 2u && labial_timings_read(t->fields[1], LABIAL_MILLISECOND, LABIAL_TIMINGS_TIME_MAX, &ignored))
        t->format = LABIAL_TIMINGS_PHO;
    else if (t->count >= 2u || line_ends)
        return labial_timings_malformed(t, "this is not timings of flite, lab, htk, pho, mary, phseg or textgrid", 0, 0,
                                        0);
    return LABIAL_WAITING;
}

/* ---- Fields and lines ------------------------------------------------------------------------------------------ */

static int field_end(labial_timings_t *t)
{
    char *field = t->fields[t->count < 4u ? t->count : 4u];
    const uint32_t length = t->length;
    int result = LABIAL_WAITING;
    if (length == 0u)
        return LABIAL_WAITING;
    field[length] = '\0';
    t->length = 0;
    t->count++;
    if (t->count == 1u && labial_timings_is(field, "<laugh") && t->format != LABIAL_TIMINGS_PHSEG) {
        t->marker = 1;
        return LABIAL_WAITING;
    }
    if (t->marker) {
        if (t->count > 3u)
            return labial_timings_malformed(t, "expected `<laugh SECONDS [INTENSITY]>`", 0, 0, 0);
        if (field[length - 1u] != '>')
            return LABIAL_WAITING;
        result = labial_timings_emit_marker(t);
        t->marker = 0;
        t->count = 0;
        return result;
    }
    if (t->format == LABIAL_TIMINGS_AUTO)
        result = tell_format(t, 0);
    if (result == LABIAL_WAITING && format_fields[t->format])
        result = format_fields[t->format](t, field);
    return result;
}

static int line_end(labial_timings_t *t)
{
    int result = LABIAL_WAITING;
    if (t->marker)
        return labial_timings_malformed(t, "a laugh is not closed by '>'", 0, 0, 0);
    if (t->count > 0u && t->format == LABIAL_TIMINGS_AUTO)
        result = tell_format(t, 1);
    if (result == LABIAL_WAITING && t->count > 0u && format_lines[t->format])
        result = format_lines[t->format](t);
    if (t->format == LABIAL_TIMINGS_FLITE)
        t->origin = t->end;
    t->count = 0;
    t->comment = 0;
    return result;
}

/* ---- Bytes ----------------------------------------------------------------------------------------------------- */

static int put_byte(labial_timings_t *t, unsigned char byte)
{
    const int newline = byte == '\n';
    int result = LABIAL_WAITING, ended;
    if (labial_timings_is_control(byte))
        return labial_timings_not_text(t, byte);
    if (t->format == LABIAL_TIMINGS_TEXTGRID)
        return labial_timings_grid_put(t, byte);
    if (newline || (!t->comment && (byte == ' ' || byte == '\t' || byte == '\r'))) {
        result = field_end(t);
        if (t->format == LABIAL_TIMINGS_TEXTGRID) { /* the first field told: it is read again, as a token */
            const char *c;
            t->count = 0;
            memcpy(t->fields[1], t->fields[0], sizeof t->fields[0]);
            for (c = t->fields[1]; *c && result == LABIAL_WAITING; c++)
                result = labial_timings_grid_put(t, (unsigned char)*c);
            return result == LABIAL_WAITING ? labial_timings_grid_put(t, byte) : result;
        }
        if (newline && (result == LABIAL_OK || result == LABIAL_WAITING)) {
            ended = line_end(t); /* which completes no timing where the field did */
            result = result == LABIAL_OK ? result : ended;
            t->line += result != LABIAL_ERROR_TIMINGS;
        }
        return result;
    }
    if (t->comment)
        return LABIAL_WAITING;
    if (byte == ';' && t->length == 0u &&
        (t->format == LABIAL_TIMINGS_PHO || (t->format == LABIAL_TIMINGS_AUTO && t->count == 0u))) {
        t->format = LABIAL_TIMINGS_PHO;
        t->comment = 1;
        return LABIAL_WAITING;
    }
    if (t->length == LABIAL_TIMINGS_FIELD_MAX)
        return labial_timings_malformed(t, "a field is longer than 511 bytes", 0, 0, 0);
    t->fields[t->count < 4u ? t->count : 4u][t->length++] = (char)byte;
    return LABIAL_WAITING;
}

/* A byte order mark, which may begin the text; bytes that turn out to be none belong to it. */
static const unsigned char order_mark[] = { 0xefu, 0xbbu, 0xbfu };
#define MARK_READ 3u

static void mark_end(labial_timings_t *t)
{
    unsigned i;
    const unsigned held = t->mark;
    t->mark = MARK_READ;
    for (i = 0; i < held && held < MARK_READ; i++)
        (void)put_byte(t, order_mark[i]); /* which begins the first field */
}

int labial_timings_init(labial_timings_t *timings, labial_timings_format_t format)
{
    if (!timings)
        return LABIAL_ERROR_NULL;
    memset(timings, 0, sizeof *timings);
    timings->line = 1;
    if ((unsigned)format >= FORMAT_COUNT)
        return LABIAL_ERROR_RANGE;
    timings->format = (uint8_t)format;
    return LABIAL_OK;
}

int labial_timings_next(labial_timings_t *timings, const char *text, size_t size, size_t *used, labial_timing_t *timing)
{
    int result = LABIAL_WAITING;
    size_t i;
    if (!timings || !text || !used || !timing)
        return LABIAL_ERROR_NULL;
    if (timings->message[0])
        return LABIAL_ERROR_TIMINGS;
    for (i = 0; i < size && result == LABIAL_WAITING; i++) {
        const unsigned char byte = (unsigned char)text[i];
        if (timings->mark < MARK_READ && byte == order_mark[timings->mark]) {
            timings->mark++;
            continue;
        }
        mark_end(timings);
        result = put_byte(timings, byte);
    }
    *used = i;
    if (result == LABIAL_OK)
        *timing = timings->found;
    return result;
}

int labial_timings_end(labial_timings_t *timings, labial_timing_t *timing)
{
    int result;
    if (!timings || !timing)
        return LABIAL_ERROR_NULL;
    if (timings->message[0])
        return LABIAL_ERROR_TIMINGS;
    mark_end(timings);
    result = timings->format == LABIAL_TIMINGS_TEXTGRID ? LABIAL_WAITING : put_byte(timings, ' ');
    if (result == LABIAL_WAITING)
        result =
            timings->format == LABIAL_TIMINGS_TEXTGRID ? labial_timings_grid_end(timings) : put_byte(timings, '\n');
    if (result == LABIAL_OK)
        *timing = timings->found;
    return result == LABIAL_WAITING ? LABIAL_DONE : result;
}

int labial_timings_tier(labial_timings_t *t, const char *name, uint32_t number)
{
    if (!t)
        return LABIAL_ERROR_NULL;
    t->tier = name;
    t->tier_number = number;
    return LABIAL_OK;
}

labial_timings_format_t labial_timings_format(const labial_timings_t *t)
{
    return t ? (labial_timings_format_t)t->format : LABIAL_TIMINGS_AUTO;
}

uint32_t labial_timings_line(const labial_timings_t *t)
{
    return t ? t->line : 0u;
}

const char *labial_timings_message(const labial_timings_t *t)
{
    return t ? t->message : "";
}
