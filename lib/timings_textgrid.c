/*
 * timings_textgrid.c - Praat's TextGrid (labial/timings.h). Both of its forms are one to a reader that does as Praat
 * does: numbers that stand alone, texts in quotes and flags in angle brackets count, whatever else stands between them
 * does not.
 */
#include "timings_parts.h"

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
enum { SKIPPED, WANTED, POINTS };

/* The text of the latest token is the first field. */
#define TEXT(t) ((t)->fields[0])

/* ---- Tiers ----------------------------------------------------------------------------------------------------- */

/* Whether a tier's name, behind the last " - " and without the blanks around it, is one of phonemes in any case;
 * WebMAUS's is MAU. */
static int is_phoneme_tier(const char *name)
{
    static const char *const known[] = { "phones", "phonemes", "segments", "phone", "phoneme", "segment", "mau" };
    char word[9]; /* as long as the longest */
    const char *c;
    uint32_t length = 0, i;
    for (c = name; *c; c++)
        if (c[0] == ' ' && c[1] == '-' && c[2] == ' ')
            name = c + 3;
    while (*name == ' ')
        name++;
    for (; *name && *name != ' ' && length < sizeof word - 1u; length++)
        word[length] = *name++;
    word[length] = '\0';
    while (*name == ' ')
        name++;
    for (i = 0; i < sizeof known / sizeof known[0]; i++)
        if (*name == '\0' && labial_timings_is_word(word, known[i]))
            return 1;
    return 0;
}

/* Chooses an interval tier by its name or place. */
static int is_wanted(const labial_timings_t *t)
{
    if (t->grid.again || t->tier_number > 0u)
        return t->grid.number == (t->grid.again ? 1u : t->tier_number);
    return t->tier ? labial_timings_is(TEXT(t), t->tier) : is_phoneme_tier(TEXT(t));
}

/* Removes blanks at both ends of a label; line ends within it become blanks. */
static void trim_text(char *text)
{
    uint32_t start = 0, length = labial_timings_length(text), i;
    while (length > 0u && (unsigned char)text[length - 1u] <= ' ')
        length--;
    while (start < length && (unsigned char)text[start] <= ' ')
        start++;
    for (i = start; i < length; i++)
        text[i - start] = (unsigned char)text[i] < ' ' ? ' ' : text[i];
    text[length - start] = '\0';
}

static int end_interval(labial_timings_t *t)
{
    struct labial_timings_grid *g = &t->grid;
    if (g->end < g->start)
        return labial_timings_malformed(t, "the interval '%' ends before its start", TEXT(t), 0, 0);
    if (g->wanted != WANTED)
        return LABIAL_WAITING;
    trim_text(TEXT(t));
    if (g->cut)
        return labial_timings_malformed(t, "the label '%...' is longer than 63 bytes", TEXT(t), 0, 0);
    return labial_timings_emit(t, TEXT(t)[0] ? TEXT(t) : 0, g->start, g->end);
}

/* ---- The grammar ----------------------------------------------------------------------------------------------- */

/* Behind an interval, a point, or a tier's header. */
static void next_interval(struct labial_timings_grid *g)
{
    if (g->intervals > 0u) {
        g->intervals--;
        g->expected = g->wanted == POINTS ? POINT_TIME : INTERVAL_START;
    } else if (g->tiers > 0u) {
        g->tiers--;
        g->expected = TIER_CLASS;
    } else {
        g->expected = NOTHING;
    }
}

static int unexpected(labial_timings_t *t)
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
    return labial_timings_malformed(t, "'%' stands where % should be", TEXT(t), names[t->grid.expected], 0);
}

static int text_token(labial_timings_t *t)
{
    struct labial_timings_grid *g = &t->grid;
    int result = LABIAL_WAITING;
    switch (g->expected) {
    case FILE_TYPE:
        TEXT(t)[10] = '\0'; /* some programs write more behind it */
        if (!labial_timings_is(TEXT(t), "ooTextFile"))
            return unexpected(t);
        g->expected = OBJECT_CLASS;
        break;
    case OBJECT_CLASS:
        if (!labial_timings_is(TEXT(t), "TextGrid"))
            return unexpected(t);
        g->expected = GRID_START;
        break;
    case TIER_CLASS:
        if (!labial_timings_is(TEXT(t), "TextTier") && !labial_timings_is(TEXT(t), "IntervalTier"))
            return unexpected(t);
        g->wanted = TEXT(t)[0] == 'T' ? POINTS : SKIPPED;
        g->expected = TIER_NAME;
        break;
    case TIER_NAME:
        if (g->wanted != POINTS) {
            g->number++;
            if (!g->found && is_wanted(t)) {
                g->wanted = WANTED;
                g->found = 1;
            }
        }
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

static int grid_time(labial_timings_t *t, uint64_t *time)
{
    if (!labial_timings_read(TEXT(t), LABIAL_SECOND, LABIAL_TIMINGS_TIME_MAX, time))
        return labial_timings_malformed(t, "'%' is not a time from 0 to 1000000 seconds", TEXT(t), 0, 0);
    return LABIAL_WAITING;
}

static int number_token(labial_timings_t *t)
{
    struct labial_timings_grid *g = &t->grid;
    uint64_t number;
    switch (g->expected) {
    case TIER_COUNT:
    case INTERVAL_COUNT:
        if (!labial_timings_is_whole(TEXT(t)) || !labial_timings_read(TEXT(t), 0, 1000000000u, &number))
            return labial_timings_malformed(t, "'%' is not a number of tiers or intervals", TEXT(t), 0, 0);
        if (g->expected == TIER_COUNT)
            g->tiers = (uint32_t)number;
        else
            g->intervals = (uint32_t)number;
        next_interval(g);
        return LABIAL_WAITING;
    case GRID_START:
    case GRID_END:
    case TIER_START:
    case TIER_END:
    case POINT_TIME:
        g->expected++;
        return grid_time(t, &number);
    case INTERVAL_START:
        g->expected = INTERVAL_END;
        return grid_time(t, &g->start);
    case INTERVAL_END:
        g->expected = INTERVAL_TEXT;
        return grid_time(t, &g->end);
    default:
        return unexpected(t);
    }
}

static int flag_token(labial_timings_t *t)
{
    if (t->grid.expected != TIERS_EXIST)
        return unexpected(t);
    t->grid.expected = labial_timings_is(TEXT(t), "exists") ? TIER_COUNT : NOTHING;
    return LABIAL_WAITING;
}

/* A number must be one; anything else that stands outside quotes is for human readers. */
static int word_token(labial_timings_t *t)
{
    const char c = TEXT(t)[0];
    return c == '-' || c == '+' || c == '.' || (c >= '0' && c <= '9') ? number_token(t) : LABIAL_WAITING;
}

/* ---- The lexer ------------------------------------------------------------------------------------------------- */

static void add_byte(labial_timings_t *t, unsigned char byte)
{
    if (t->length < LABIAL_TIMINGS_FIELD_MAX)
        TEXT(t)[t->length++] = (char)byte;
    else
        t->grid.cut = 1;
}

static int end_token(labial_timings_t *t, int (*token)(labial_timings_t *))
{
    int result;
    TEXT(t)[t->length] = '\0';
    t->length = 0;
    t->grid.lexer = BETWEEN;
    result = token(t);
    t->grid.cut = 0;
    return result;
}

int labial_timings_grid_put(labial_timings_t *t, unsigned char byte)
{
    struct labial_timings_grid *g = &t->grid;
    const int blank = byte == ' ' || byte == '\t' || byte == '\r' || byte == '\n';
    int result = LABIAL_WAITING;
    if (g->lexer == QUOTE_IN_QUOTED) {
        if (byte == '"') { /* doubled: it belongs to the text */
            add_byte(t, byte);
            g->lexer = QUOTED;
            return LABIAL_WAITING;
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
            add_byte(t, byte);
            g->lexer = WORD;
        }
        break;
    case WORD:
        if (!blank)
            add_byte(t, byte);
        else
            result = end_token(t, word_token);
        break;
    case QUOTED:
        if (byte == '"')
            g->lexer = QUOTE_IN_QUOTED;
        else
            add_byte(t, byte);
        break;
    case FLAG:
        if (byte == '>')
            result = end_token(t, flag_token);
        else
            add_byte(t, byte);
        break;
    default:
        if (byte == '\n')
            g->lexer = BETWEEN;
        break;
    }
    t->line += byte == '\n' && result != LABIAL_ERROR_TIMINGS;
    return result;
}

/* The text is to be given again, for the first tier. */
static int grid_again(labial_timings_t *t)
{
    const struct labial_timings_grid none = { 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0 };
    t->grid = none;
    t->line = 1;
    t->mark = 0;
    return LABIAL_STARVED;
}

int labial_timings_grid_end(labial_timings_t *t)
{
    const struct labial_timings_grid *g = &t->grid;
    int result = LABIAL_WAITING;
    if (g->lexer == QUOTED || g->lexer == FLAG)
        return labial_timings_malformed(t, "the TextGrid ends within a text or flag", 0, 0, 0);
    if (g->lexer == QUOTE_IN_QUOTED)
        result = end_token(t, text_token);
    else if (g->lexer == WORD)
        result = end_token(t, word_token);
    if (result != LABIAL_WAITING || g->expected == FILE_TYPE) /* an empty file is no motion */
        return result;
    if (g->expected != NOTHING)
        return labial_timings_malformed(t, "the TextGrid ends before its last tier does", 0, 0, 0);
    if (g->found || t->tier_number > 0u)
        return LABIAL_WAITING;
    if (t->tier)
        return labial_timings_malformed(t, "there is no interval tier '%'", t->tier, 0, 0);
    if (g->number == 0u)
        return labial_timings_malformed(t, "there is no interval tier", 0, 0, 0);
    return grid_again(t);
}
