/*
 * test_timings.c - the parser of timings (labial/timings.h) against tests/grammar/cases.tsv, whose first lines say what
 * it contains. Each text is given whole, and byte by byte.
 */
#include "suite.h"
#include "labial/timings.h"

#define LINE_MAX_BYTES 4096

/* What was read so far, as the last column has it. */
typedef struct {
    char text[LINE_MAX_BYTES];
    size_t length;
    int in_milliseconds; /* without labels */
    uint64_t end;
} found_t;

static void add_phoneme(found_t *found, const char *label, uint64_t end)
{
    const size_t room = sizeof found->text - found->length;
    const unsigned long milliseconds = (unsigned long)((end + 500000u) / 1000000u - (found->end + 500000u) / 1000000u);
    const int written = found->in_milliseconds ? snprintf(found->text + found->length, room, "%lu", milliseconds)
                                               : snprintf(found->text + found->length, room, "%s%s:%lu",
                                                          found->length ? " " : "", label, milliseconds);
    if (written < 0 || (size_t)written >= room)
        abort();
    found->length += (size_t)written;
    found->end = end;
}

static void add_timing(found_t *found, const labial_timing_t *timing)
{
    const char *label = timing->label ? timing->label : timing->laugh >= 0 ? "<laugh>" : "-";
    if (timing->start > found->end + LABIAL_TIMINGS_TOLERANCE)
        add_phoneme(found, "-", timing->start);
    add_phoneme(found, label, timing->end > found->end ? timing->end : found->end);
}

/* Gives the text in pieces of so many bytes. */
static void read_text(const char *text, size_t length, labial_timings_format_t format, size_t piece, found_t *found)
{
    static labial_timings_t timings;
    labial_timing_t timing;
    size_t used;
    int result = LABIAL_STARVED;
    labial_timings_init(&timings, format);
    while (result == LABIAL_STARVED) {
        found->length = 0;
        found->end = 0;
        found->text[0] = '\0';
        result = LABIAL_WAITING;
        for (size_t at = 0; at < length && result >= 0; at += used) {
            result =
                labial_timings_next(&timings, text + at, length - at < piece ? length - at : piece, &used, &timing);
            if (result == LABIAL_OK)
                add_timing(found, &timing);
        }
        while (result >= 0 && (result = labial_timings_end(&timings, &timing)) == LABIAL_OK)
            add_timing(found, &timing);
    }
    if (result < 0)
        (void)snprintf(found->text, sizeof found->text, "refused: %lu: %s",
                       (unsigned long)labial_timings_line(&timings), labial_timings_message(&timings));
    if (result < 0 && (labial_timings_next(&timings, "0", 1, &used, &timing) != result ||
                       labial_timings_end(&timings, &timing) != result))
        (void)snprintf(found->text, sizeof found->text, "read on after an error");
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
static int differs(unsigned long line, const char *text, size_t length, labial_timings_format_t format,
                   const char *expected)
{
    static found_t found;
    for (size_t piece = 1; piece <= LINE_MAX_BYTES; piece += LINE_MAX_BYTES - 1) {
        found.in_milliseconds = strchr(expected, ':') == NULL;
        read_text(text, length, format, piece, &found);
        if (strncmp(found.text, "refused", strlen("refused")) == 0 && strcmp(expected, "refused") == 0)
            continue;
        if (strcmp(found.text, expected) != 0) {
            printf("cases.tsv:%lu: %s, not %s\n", line, found.text, expected);
            return 1;
        }
    }
    return 0;
}

static int number_differs(unsigned long line, const char *number, const char *expected)
{
    static const struct {
        labial_timings_format_t format;
        const char *before, *behind;
    } texts[] = {
        { LABIAL_TIMINGS_LAB, "0 ", " m\n" },
        { LABIAL_TIMINGS_FLITE, "m:", "\n" },
        { LABIAL_TIMINGS_MARY, "#\n", " 1 m\n" },
        { LABIAL_TIMINGS_TEXTGRID,
          "\"ooTextFile\"\n\"TextGrid\"\n0\n1\n<exists>\n1\n\"IntervalTier\"\n\"phones\"\n0\n1\n1\n0\n", "\n\"m\"\n" },
    };
    char text[LINE_MAX_BYTES];
    int differing = 0;
    for (size_t i = 0; i < COUNT_OF(texts); i++) {
        const int length = snprintf(text, sizeof text, "%s%s%s", texts[i].before, number, texts[i].behind);
        differing += differs(line, text, (size_t)length, texts[i].format, expected);
    }
    return differing;
}

/* Would catch what cannot be written as a case: null pointers, tiers by name and place, the rest of a timing. */
TEST(calls_do_as_the_header_says)
{
    static labial_timings_t timings;
    static const char grid[] = "\"ooTextFile\" \"TextGrid\" 0 1 <exists> 2 \"IntervalTier\" \"a\" 0 1 1 0 1 \"m\" "
                               "\"IntervalTier\" \"b\" 0 1 1 0 1 \"n\" ";
    static const char *const names[] = { "a", "b", "c", NULL, NULL, NULL };
    static const uint32_t numbers[] = { 0, 0, 0, 1, 2, 3 };
    static const char expected[] = "mn-mn-";
    labial_timing_t timing;
    size_t used;
    int wrong = labial_timings_init(NULL, LABIAL_TIMINGS_AUTO) != LABIAL_ERROR_NULL;
    assert_ok(labial_timings_init(&timings, LABIAL_TIMINGS_AUTO));
    assert_int_equal(labial_timings_next(&timings, ";", 1, &used, &timing), LABIAL_WAITING); /* a comment of .pho */
    assert_ok(labial_timings_init(&timings, LABIAL_TIMINGS_AUTO));
    wrong |=
        labial_timings_init(&timings, (labial_timings_format_t)(LABIAL_TIMINGS_TEXTGRID + 1)) != LABIAL_ERROR_RANGE;
    wrong |= labial_timings_format(&timings) != LABIAL_TIMINGS_AUTO;
    wrong |= labial_timings_next(NULL, "", 0, &used, &timing) != LABIAL_ERROR_NULL;
    wrong |= labial_timings_next(&timings, NULL, 0, &used, &timing) != LABIAL_ERROR_NULL;
    wrong |= labial_timings_next(&timings, "", 0, NULL, &timing) != LABIAL_ERROR_NULL;
    wrong |= labial_timings_next(&timings, "", 0, &used, NULL) != LABIAL_ERROR_NULL;
    wrong |= labial_timings_end(NULL, &timing) != LABIAL_ERROR_NULL;
    wrong |= labial_timings_end(&timings, NULL) != LABIAL_ERROR_NULL;
    wrong |= labial_timings_end(&timings, &timing) != LABIAL_DONE;
    wrong |= labial_timings_tier(NULL, "a", 1) != LABIAL_ERROR_NULL;
    wrong |= labial_timings_format(NULL) != LABIAL_TIMINGS_AUTO || labial_timings_line(NULL) != 0;
    wrong |= labial_timings_message(NULL)[0] != '\0';
    wrong |= labial_timings_format_name(LABIAL_TIMINGS_TEXTGRID + 1) != NULL;
    wrong |= labial_timings_format_help(LABIAL_TIMINGS_TEXTGRID + 1) != NULL;
    wrong |= labial_timings_format_suffix(LABIAL_TIMINGS_TEXTGRID + 1) != NULL;
    wrong |= strcmp(labial_timings_format_name(LABIAL_TIMINGS_TEXTGRID), "textgrid") != 0;
    wrong |= strcmp(labial_timings_format_suffix(LABIAL_TIMINGS_LAB), ".lab") != 0;
    wrong |= strncmp(labial_timings_format_help(LABIAL_TIMINGS_PHO), "MBROLA", 6) != 0;
    for (size_t i = 0; i < COUNT_OF(numbers); i++) {
        char label = '-';
        labial_timings_init(&timings, LABIAL_TIMINGS_TEXTGRID);
        assert_ok(labial_timings_tier(&timings, names[i], numbers[i]));
        assert_int_equal(labial_timings_format(&timings), LABIAL_TIMINGS_TEXTGRID);
        const char *text = grid;
        for (size_t left = strlen(grid); left > 0; left -= used, text += used)
            if (labial_timings_next(&timings, text, left, &used, &timing) == LABIAL_OK)
                label = timing.label[0];
        if (labial_timings_end(&timings, &timing) != (i == 2 ? LABIAL_ERROR_TIMINGS : LABIAL_DONE) ||
            label != expected[i])
            wrong = 1;
    }
    /* The rest of a row of lab; a laugh's intensity; X-SAMPA by the format. */
    labial_timings_init(&timings, LABIAL_TIMINGS_LAB);
    static const char row[] = "1 2 m 1.5 word\n";
    wrong |= labial_timings_next(&timings, row, strlen(row), &used, &timing) != LABIAL_OK || used != strlen(row);
    wrong |= timing.start != 1000000000u || timing.end != 2000000000u || timing.apex != 1500000000u || !timing.has_apex;
    wrong |= strcmp(timing.word, "word") != 0 || timing.line != 1 || timing.laugh != -1 || timing.xsampa;
    labial_timings_init(&timings, LABIAL_TIMINGS_PHO);
    static const char laughs[] = "<laugh:0.7> 100\n<laugh 1>\n";
    wrong |= labial_timings_next(&timings, laughs, strlen(laughs), &used, &timing) != LABIAL_OK;
    wrong |= timing.laugh != 179 || strcmp(timing.label, "<laugh:0.7>") != 0 || !timing.xsampa || timing.has_apex;
    wrong |= labial_timings_next(&timings, laughs + used, strlen(laughs) - used, &used, &timing) != LABIAL_OK;
    wrong |= timing.laugh != 128 || timing.label || timing.end != 1100000000u || timing.line != 2;
    /* An apex may be a millisecond outside its segment. */
    static const struct {
        const char *row;
        int result;
    } apexes[] = { { "1 2 m 0.999 w\n", LABIAL_OK },
                   { "1 2 m 0.9989 w\n", LABIAL_ERROR_TIMINGS },
                   { "1 2 m 2.001 w\n", LABIAL_OK },
                   { "1 2 m 2.0011 w\n", LABIAL_ERROR_TIMINGS } };
    for (size_t i = 0; i < COUNT_OF(apexes); i++) {
        labial_timings_init(&timings, LABIAL_TIMINGS_LAB);
        assert_int_equal(labial_timings_next(&timings, apexes[i].row, strlen(apexes[i].row), &used, &timing),
                         apexes[i].result);
    }
    labial_timings_init(&timings, LABIAL_TIMINGS_LAB);
    assert_ok(labial_timings_next(&timings, "0 1 <laugh>\n", 12, &used, &timing));
    assert_int_equal(timing.laugh, 128);
    static const char usual[] = "flite:0.1 <laugh 1> m:0.2\n";
    labial_timings_init(&timings, LABIAL_TIMINGS_FLITE);
    wrong |= labial_timings_next(&timings, usual, strlen(usual), &used, &timing) != LABIAL_OK;
    wrong |= labial_timings_next(&timings, usual + used, strlen(usual) - used, &used, &timing) != LABIAL_OK;
    assert_int_equal(timing.laugh, 128);
    assert_int_equal(wrong, 0);
}

/* Would catch a text that is read otherwise, a wrong line, and a message that does not say what is wrong. */
TEST(texts_are_read_as_the_cases_say)
{
    static const char cases[] = "/../grammar/cases.tsv";
    static char row[LINE_MAX_BYTES], path[1024] = __FILE__;
    unsigned long line = 0;
    int differing = 0;
    char *folder = strrchr(path, '/');
    FILE *file;
    assert_true(folder && (size_t)(folder - path) < sizeof path - sizeof cases);
    memcpy(folder, cases, sizeof cases);
    file = fopen(path, "rb");
    assert_non_null(file);
    while (fgets(row, sizeof row, file)) {
        char *text = strchr(row, '\t'), *expected = text ? strchr(text + 1, '\t') : NULL;
        unsigned format = 0;
        line++;
        if (row[0] == '#')
            continue;
        row[strcspn(row, "\r\n")] = '\0';
        assert_non_null(expected);
        *text++ = '\0';
        *expected++ = '\0';
        const size_t length = plain(text);
        (void)plain(expected);
        if (strcmp(row, "number") == 0) {
            differing += number_differs(line, text, expected);
            continue;
        }
        while (labial_timings_format_name(format) && strcmp(labial_timings_format_name(format), row) != 0)
            format++;
        assert_non_null(labial_timings_format_name(format));
        differing += differs(line, text, length, (labial_timings_format_t)format, expected);
    }
    fclose(file);
    assert_int_equal(differing, 0);
    assert_true(line > 300);
}

SUITE(NULL, NULL)
