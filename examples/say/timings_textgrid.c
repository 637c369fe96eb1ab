/*
 * timings_textgrid.c - Praat's TextGrid. Both of its forms are one to a reader that does as Praat does: numbers that
 * stand alone, texts in quotes and flags in angle brackets count, whatever else stands between them does not.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "timings_private.h"

/* Where the lexer is. */
enum { BETWEEN, WORD, QUOTED, QUOTE_IN_QUOTED, FLAG, COMMENT };

/* What the grammar expects next. */
enum {
    FILE_TYPE,
    OBJECT_CLASS,
    GRID_START,
    GRID_END,
    TIERS_EXIST,
    TIER_COUNT,
    TIER_CLASS,
    TIER_NAME,
    TIER_START,
    TIER_END,
    INTERVAL_COUNT,
    INTERVAL_START,
    INTERVAL_END,
    INTERVAL_TEXT,
    POINT_TIME,
    POINT_TEXT,
    NOTHING
};

/* What becomes of a tier's intervals. */
enum { SKIPPED, KEPT, WANTED, POINTS };

/* The text of the latest token is the first field, the class of the tier the second one. */
#define TEXT(t) ((t)->fields[0])

/* ---- Tiers ----------------------------------------------------------------------------------------------------- */

/* Whether a tier's name, behind the last " - ", is one of phonemes in any case. */
static int is_phoneme_tier(const char *name)
{
    static const char *const known[] = { "phones", "phonemes", "phone", "phoneme" };
    char word[16];
    size_t length = 0;
    for (const char *dash; (dash = strstr(name, " - ")) != NULL;)
        name = dash + 3;
    while (*name == ' ')
        name++;
    for (; name[length] && name[length] != ' ' && length < sizeof word - 1; length++)
        word[length] = (char)(name[length] >= 'A' && name[length] <= 'Z' ? name[length] - 'A' + 'a' : name[length]);
    word[length] = '\0';
    if (name[length] != '\0' && name[length + strspn(name + length, " ")] != '\0')
        return 0;
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
        if (strcmp(word, known[i]) == 0)
            return 1;
    return 0;
}

/* Chooses by the tier's name. The first interval tier is kept as long as no better one is known. */
static void name_tier(timings_t *t)
{
    timings_textgrid_t *g = &t->grid;
    if (g->wanted == POINTS)
        return;
    g->wanted = SKIPPED;
    if (g->found)
        return;
    if (t->tier ? strcmp(t->tier, TEXT(t)) == 0 : is_phoneme_tier(TEXT(t))) {
        g->wanted = WANTED;
        g->found = 1;
        timings_free(t);
    } else if (!t->tier && !g->kept) {
        g->wanted = KEPT;
    }
}

/* A record: two times, the line and the label with its NUL. */
typedef struct {
    uint64_t start, stop;
    unsigned long line;
} record_t;

static int keep(timings_t *t)
{
    timings_textgrid_t *g = &t->grid;
    const record_t record = { g->start, g->stop, t->line };
    const size_t label = strlen(TEXT(t)) + 1;
    if (g->kept_room - g->kept_size < sizeof record + label) {
        const size_t room = g->kept_room * 2 + 65536;
        char *kept = room > g->kept_room ? realloc(g->kept, room) : NULL;
        if (!kept)
            return timings_malformed(t, "there is not enough memory for the first tier");
        g->kept = kept;
        g->kept_room = room;
    }
    memcpy(g->kept + g->kept_size, &record, sizeof record);
    memcpy(g->kept + g->kept_size + sizeof record, TEXT(t), label);
    g->kept_size += sizeof record + label;
    return 0;
}

static int emit_kept(timings_t *t)
{
    const timings_textgrid_t *g = &t->grid;
    const unsigned long last_line = t->line;
    record_t record;
    for (size_t at = 0; at < g->kept_size;) {
        memcpy(&record, g->kept + at, sizeof record);
        const char *label = g->kept + at + sizeof record;
        at += sizeof record + strlen(label) + 1;
        t->line = record.line;
        const int result = timings_emit_between(t, *label ? label : NULL, record.start, record.stop);
        if (result != 0)
            return result;
    }
    t->line = last_line;
    return 0;
}

/* Removes blanks at both ends of a label; line ends within it become blanks. */
static void trim(char *text)
{
    size_t start = strspn(text, " \t\r\n"), length = strlen(text);
    while (length > start && strchr(" \t\r\n", text[length - 1]))
        length--;
    memmove(text, text + start, length - start);
    text[length - start] = '\0';
    for (; *text; text++)
        if (strchr("\t\r\n", *text))
            *text = ' ';
}

static int end_interval(timings_t *t)
{
    timings_textgrid_t *g = &t->grid;
    if (g->stop < g->start)
        return timings_malformed(t, "the interval '%.63s' ends before its start", TEXT(t));
    if (g->wanted != WANTED && g->wanted != KEPT)
        return 0;
    trim(TEXT(t));
    if (g->truncated || strlen(TEXT(t)) > TIMINGS_LABEL_MAX) {
        if (g->wanted == WANTED)
            return timings_malformed(t, "the label '%.20s...' is longer than %d bytes", TEXT(t), TIMINGS_LABEL_MAX);
        TEXT(t)[TIMINGS_LABEL_MAX + 1] = '\0'; /* of a tier of sentences, say: an error when it comes to be needed */
    }
    if (g->wanted == KEPT)
        return keep(t);
    return timings_emit_between(t, TEXT(t)[0] ? TEXT(t) : NULL, g->start, g->stop);
}

/* ---- The grammar ----------------------------------------------------------------------------------------------- */

/* Behind an interval, a point, or a tier's header. */
static void next_interval(timings_textgrid_t *g)
{
    if (g->intervals > 0) {
        g->intervals--;
        g->expected = g->wanted == POINTS ? POINT_TIME : INTERVAL_START;
    } else if (g->tiers > 0) {
        g->tiers--;
        g->expected = TIER_CLASS;
    } else {
        g->expected = NOTHING;
    }
}

static int unexpected(timings_t *t)
{
    static const char *const names[] = {
        "the file type \"ooTextFile\"",
        "the object class \"TextGrid\"",
        "the start of the grid",
        "the end of the grid",
        "<exists>",
        "the number of tiers",
        "a tier's class",
        "a tier's name",
        "a tier's start",
        "a tier's end",
        "the number of intervals",
        "an interval's start",
        "an interval's end",
        "an interval's text",
        "a point's time",
        "a point's mark",
        "the end of the file",
    };
    return timings_malformed(t, "'%.63s' stands where %s should be", TEXT(t), names[t->grid.expected]);
}

static int text_token(timings_t *t)
{
    timings_textgrid_t *g = &t->grid;
    int result = 0;
    switch (g->expected) {
    case FILE_TYPE:
        if (strncmp(TEXT(t), "ooTextFile", 10) != 0)
            return unexpected(t);
        g->expected = OBJECT_CLASS;
        break;
    case OBJECT_CLASS:
        if (strcmp(TEXT(t), "TextGrid") != 0)
            return unexpected(t);
        g->expected = GRID_START;
        break;
    case TIER_CLASS:
        if (strcmp(TEXT(t), "TextTier") != 0 && strcmp(TEXT(t), "IntervalTier") != 0)
            return unexpected(t);
        g->wanted = strcmp(TEXT(t), "TextTier") == 0 ? POINTS : SKIPPED;
        g->expected = TIER_NAME;
        break;
    case TIER_NAME:
        name_tier(t);
        g->expected = TIER_START;
        break;
    case INTERVAL_TEXT:
        result = end_interval(t);
        next_interval(g);
        break;
    case POINT_TEXT:
        next_interval(g);
        break;
    default:
        return unexpected(t);
    }
    return result;
}

static int read_time(timings_t *t, const char *text, uint64_t *microseconds)
{
    if (!timings_read_seconds(text, microseconds))
        return timings_malformed(t, "'%.63s' is not a time from 0 to 1000000 seconds", text);
    return 0;
}

static int number_token(timings_t *t)
{
    timings_textgrid_t *g = &t->grid;
    uint64_t time;
    switch (g->expected) {
    case TIER_COUNT:
    case INTERVAL_COUNT:
        if (!timings_is_whole(TEXT(t)) ||
            !timings_read_decimal(TEXT(t), 0, 1000000000u, g->expected == TIER_COUNT ? &g->tiers : &g->intervals))
            return timings_malformed(t, "'%.63s' is not a number of tiers or intervals", TEXT(t));
        next_interval(g);
        return 0;
    case GRID_START:
    case GRID_END:
    case TIER_START:
    case TIER_END:
        g->expected++;
        return read_time(t, TEXT(t), &time);
    case POINT_TIME:
        g->expected = POINT_TEXT;
        return read_time(t, TEXT(t), &time);
    case INTERVAL_START:
        g->expected = INTERVAL_END;
        return read_time(t, TEXT(t), &g->start);
    case INTERVAL_END:
        g->expected = INTERVAL_TEXT;
        return read_time(t, TEXT(t), &g->stop);
    default:
        return unexpected(t);
    }
}

static int flag_token(timings_t *t)
{
    if (t->grid.expected != TIERS_EXIST)
        return unexpected(t);
    t->grid.expected = strcmp(TEXT(t), "exists") == 0 ? TIER_COUNT : NOTHING;
    return 0;
}

/* A number must be one; anything else that stands outside quotes is for human readers. */
static int word_token(timings_t *t)
{
    const char *c = TEXT(t);
    if (*c == '-' || *c == '+')
        c++;
    return (*c >= '0' && *c <= '9') || *c == '.' || c != TEXT(t) ? number_token(t) : 0;
}

/* ---- The lexer ------------------------------------------------------------------------------------------------- */

static void add(timings_t *t, unsigned char byte)
{
    if (t->length < TIMINGS_FIELD_MAX)
        TEXT(t)[t->length++] = (char)byte;
    else
        t->grid.truncated = 1;
}

static int end_token(timings_t *t, int (*token)(timings_t *))
{
    TEXT(t)[t->length] = '\0';
    t->length = 0;
    t->grid.lexer = BETWEEN;
    const int result = token(t);
    t->grid.truncated = 0;
    return result;
}

int timings_textgrid_put(timings_t *t, unsigned char byte)
{
    timings_textgrid_t *g = &t->grid;
    const int blank = byte == ' ' || byte == '\t' || byte == '\r' || byte == '\n';
    int result = 0;
    if (timings_is_control(byte))
        return timings_malformed(t, "byte 0x%02x is not text", (unsigned)byte);
    if (g->lexer == QUOTE_IN_QUOTED) {
        if (byte == '"') { /* doubled: it belongs to the text */
            add(t, byte);
            g->lexer = QUOTED;
            return 0;
        }
        result = end_token(t, text_token);
    }
    switch (g->lexer) {
    case BETWEEN:
        if (byte == '"')
            g->lexer = QUOTED;
        else if (byte == '<')
            g->lexer = FLAG;
        else if (byte == '!')
            g->lexer = COMMENT;
        else if (!blank) {
            add(t, byte);
            g->lexer = WORD;
        }
        break;
    case WORD:
        if (!blank)
            add(t, byte);
        else if (result == 0)
            result = end_token(t, word_token);
        break;
    case QUOTED:
        if (byte == '"')
            g->lexer = QUOTE_IN_QUOTED;
        else
            add(t, byte);
        break;
    case FLAG:
        if (byte == '>')
            result = end_token(t, flag_token);
        else
            add(t, byte);
        break;
    default:
        if (byte == '\n')
            g->lexer = BETWEEN;
        break;
    }
    if (byte == '\n' && result == 0)
        t->line++;
    return result;
}

int timings_textgrid_end(timings_t *t)
{
    int result = 0;
    if (t->grid.lexer == QUOTED || t->grid.lexer == FLAG)
        return timings_malformed(t, "the TextGrid ends within a text or flag");
    if (t->grid.lexer == QUOTE_IN_QUOTED)
        result = end_token(t, text_token);
    else if (t->grid.lexer == WORD)
        result = end_token(t, word_token);
    if (result == 0 && t->grid.expected == FILE_TYPE)
        return 0; /* an empty file is no motion */
    if (result == 0 && t->grid.expected != NOTHING)
        return timings_malformed(t, "the TextGrid ends before its last tier does");
    if (result == 0 && !t->grid.found && t->tier)
        return timings_malformed(t, "there is no interval tier '%.63s'", t->tier);
    if (result == 0 && !t->grid.found && !t->grid.kept)
        return timings_malformed(t, "there is no interval tier");
    return result != 0 || t->grid.found ? result : emit_kept(t);
}
