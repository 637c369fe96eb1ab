/*
 * test_names.c - phonemes by name: labels, aliases, and the marks that do not change the mouth's shape; FAP numbers, against
 * MPEG-4's own numbering; the sentences for results, in step with the enumeration.
 */
#include "suite.h"

#include <limits.h>

#include "labial/faps.h"
#include "labial/result.h"

#define ARPABET LABIAL_LABELS_ARPABET
#define IPA LABIAL_LABELS_IPA
#define XSAMPA LABIAL_LABELS_XSAMPA
#define ANY LABIAL_LABELS_AUTO

/* "AA1" is a name of its own here, other than "AA" with a stress digit; "S" is two. */
static const struct {
    const char *name;
    uint8_t phoneme;
    uint8_t sets;
} entries[] = {
    { "2", 5, XSAMPA },     { "A", 9, ANY },           { "AA", 1, ARPABET },    { "AA1", 2, ARPABET },
    { "AE", 3, ARPABET },   { "B", 4, ANY },           { "S", 3, ARPABET },     { "S", 7, XSAMPA },
    { "_:", 8, ANY },       { "a", 5, ARPABET | IPA }, { "a\xca\x8a", 6, IPA }, { "sil", 0, ANY },
    { "\xc9\x91", 1, IPA }, /* a + upsilon; alpha */
    { "\xca\x83", 7, IPA }, /* esh, the last entry */
};

static const char *const labels[] = { "sil", "AA", "AA1", "AE", "B", "a", "a\xca\x8a", "\xca\x83", "_:", "A" };

#define COUNT COUNT_OF(entries)

static labial_names_t names = { 0, COUNT_OF(labels), NULL, labels };

/* Packs the first `count` names at the very end of a heap block. */
static uint8_t *pack(labial_names_t *packed, unsigned count)
{
    uint8_t bytes[300];
    size_t at = 0;
    for (unsigned i = 0; i < count; i++) {
        const size_t length = strlen(entries[i].name);
        bytes[at] = entries[i].phoneme;
        bytes[at + 1] = (uint8_t)(length | entries[i].sets);
        memcpy(bytes + at + 2, entries[i].name, length);
        at += 2 + length;
    }
    uint8_t *const copy = (uint8_t *)fixture_copy(bytes, at);
    packed->entries = copy;
    packed->size = (uint16_t)at;
    return copy;
}

SETUP(set_up)
{
    *state = pack(&names, COUNT);
    return 0;
}

SETUP(tear_down)
{
    free(*state);
    return 0;
}

/* labial_find_in() of a copy of the name. */
static int find_in(int set, const char *name)
{
    char *copy = (char *)fixture_copy(name, strlen(name));
    const int result = labial_find_in(&names, (labial_labels_t)set, copy, strlen(name));
    free(copy);
    return result;
}

/* Would catch a set of labels that is not looked at, the wrong meaning first where none is named, and marks that are not
 * dropped; test_marks.c has each mark alone. Digits are names only where X-SAMPA is asked for. */
TEST(names_have_their_meaning)
{
    static const struct {
        int set;
        const char *name;
        int phoneme;
    } cases[] = {
        { ARPABET, "S", 3 },
        { XSAMPA, "S", 7 },
        { XSAMPA, "'S:", 7 },
        { ANY, "S", 3 },
        { IPA, "sil", 0 },
        { XSAMPA, "2", 5 },
        { XSAMPA, "2:", 5 },
        { IPA, "S", LABIAL_ERROR_NAME },
        { IPA, "AA", LABIAL_ERROR_NAME },
        { IPA, "2", LABIAL_ERROR_NAME },
        { XSAMPA, "a", LABIAL_ERROR_NAME },
        { 0, "B", LABIAL_ERROR_NAME },
        { 1, "B", LABIAL_ERROR_NAME }, /* a bit of lengths */
        { ANY, "AA1", 2 },             /* as it stands */
        { ANY, "_:", 8 },
        { ANY, "%,\"B", 4 },
        { ANY, "AE1_E", 3 },
        { ANY, "\xcb\x88\xc9\x91\xcb\x90", 1 }, /* primary stress, alpha, long */
        { ANY, "a\xcd\xa1\xca\x8a", 6 },        /* tied: a, double breve, upsilon */
        { ANY, "\\'1a\\:f", 5 },
        { ANY, "a\\~^", 5 },
        { ANY, " AA\r", 1 },
    };
    static const char unknown[] = /* with blanks between them; one is of no characters */
        "2 2:  AAA 0 ZZ b AB AAx si sill \xff \xca x1 1AA \xcb\x88 \xcb \x88 \xcb\x90 \xcb\x88\xcb\x90 "
        "\xcb\x88\xcb\x88 "
        "1 00 \x90 \xcb\x88\x31 AA\xcb \xcb\x41\x41 Zzzzzzzzzzzzzzzzzzzzzzzzzzzz ";
    for (unsigned i = 0; i < COUNT_OF(cases); i++)
        assert_int_equal(find_in(cases[i].set, cases[i].name), cases[i].phoneme);
    for (const char *at = unknown; *at; at += strcspn(at, " ") + 1)
        assert_int_equal(fixture_find(&names, at, strcspn(at, " ")), LABIAL_ERROR_NAME);
}

TEST(length_is_obeyed)
{
    assert_int_equal(labial_find(&names, "AA", 0), LABIAL_ERROR_NAME);
    assert_int_equal(labial_find(&names, "AA1xyz", 3), 2);
    assert_int_equal(labial_find(&names, "AA1xyz", 2), 1);
    assert_int_equal(labial_find(&names, "AA1xyz", 1), 9);
    assert_int_equal(labial_find(&names, "AA\0", 3), LABIAL_ERROR_NAME); /* a NUL is a byte as any other */
    assert_int_equal(labial_find(&names, "si\0l", 4), LABIAL_ERROR_NAME);
}

TEST(null_is_an_error)
{
    static const uint8_t nothing[1] = { 0 };
    labial_names_t none = { 0 };
    assert_int_equal(labial_find_in(NULL, IPA, "B", 1), LABIAL_ERROR_NULL);
    assert_int_equal(labial_find_in(&names, IPA, NULL, 1), LABIAL_ERROR_NULL);
    assert_int_equal(labial_find(NULL, "AA", 2), LABIAL_ERROR_NULL);
    assert_int_equal(labial_find(&names, NULL, 2), LABIAL_ERROR_NULL);
    none.entries = nothing;
    assert_int_equal(labial_find(&none, "AA", 2), LABIAL_ERROR_NAME); /* an empty table */
}

static int find_nearest(const char *name)
{
    return labial_find_nearest(&names, ANY, name, strlen(name), 77);
}

/* Would catch a label that stops the caller, a short beginning taken for a long one, and noise that moves the lips. */
TEST(every_label_has_a_nearest_phoneme)
{
    static const uint8_t empty[] = { 9, ANY, 4, 1 | ANY, 'B' }; /* a name of no characters is none */
    const labial_names_t odd = { sizeof empty, COUNT_OF(labels), empty, labels };
    char longer[300];
    assert_int_equal(find_nearest("AA1"), 2);
    assert_int_equal(find_nearest("AAX"), 1);
    assert_int_equal(find_nearest("Ax"), 9);
    assert_int_equal(find_nearest("?!B"), 4);
    assert_int_equal(find_nearest("<B>"), 77);
    assert_int_equal(find_nearest("[a]"), 77);
    assert_int_equal(find_nearest("+AA+"), 77);
    assert_int_equal(find_nearest("zz"), 77); /* this table has no neutral vowel */
    assert_int_equal(find_nearest(""), 77);
    assert_int_equal(find_nearest("2"), 77);
    assert_int_equal(find_nearest("\xcb\x90"), 77); /* a length mark alone */
    assert_int_equal(find_nearest("5B"), 4);
    assert_int_equal(labial_find_nearest(&names, IPA, "Sa", 2, 77), 5);
    assert_int_equal(labial_find_nearest(&names, XSAMPA, "Sa", 2, 77), 7);
    assert_int_equal(labial_find_nearest(&odd, ANY, "xB", 2, 77), 4);
    memset(longer, 'B', sizeof longer);
    assert_int_equal(labial_find_nearest(&names, ANY, longer, sizeof longer, 77), 4);
    assert_int_equal(labial_find_nearest(NULL, ANY, "B", 1, 77), LABIAL_ERROR_NULL);
}

/* Would catch a search that only works at one size of the table, and a set of labels that is not looked at. */
TEST(tables_of_every_size)
{
    labial_names_t part = names;
    for (unsigned count = 1; count <= COUNT; count++) {
        uint8_t *bytes = pack(&part, count);
        for (unsigned i = 0; i < COUNT; i++)
            for (unsigned set = ARPABET; set <= XSAMPA; set *= 2) {
                const int got = labial_find_in(&part, (labial_labels_t)set, entries[i].name, strlen(entries[i].name));
                if (!(entries[i].sets & set))
                    continue;
                const int beyond = i == 3 && count == 3 ? 1 : LABIAL_ERROR_NAME; /* without its entry, "AA1" is "AA" */
                assert_int_equal(got, i < count ? entries[i].phoneme : beyond);
            }
        free(bytes);
    }
}

/* ---- FAPs --------------------------------------------------------------------------------------------------------- */

/* Would catch a channel out of order: every model trained with the right order would move the wrong point. */
TEST(channels_have_their_numbers)
{
    static const uint8_t numbers[LABIAL_CHANNELS] = { 3, 16, 17, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60 };
    assert_memory_equal(labial_fap_numbers, numbers, sizeof numbers);
}

TEST(expanded_numbers_ascend)
{
    unsigned i = 0;
    for (unsigned fap = 3; fap <= 60; fap++)
        if (fap <= 13 || fap == 16 || fap == 17 || fap >= 51)
            assert_int_equal(labial_fap_numbers_expanded[i++], fap);
    assert_int_equal(i, LABIAL_FAPS_EXPANDED);
}

/* Value of one FAP in a frame whose FAP n is `1000 + n`, inner lips as the outer ones (4 as 51 .. 13 as 60). */
static int wanted(unsigned fap)
{
    return 1000 + (int)(fap >= 4 && fap <= 13 ? fap - 4 + 51 : fap);
}

TEST(inner_lip_moves_as_the_outer)
{
    struct {
        int16_t before, faps[LABIAL_FAPS_EXPANDED], after;
    } out = { -77, { 0 }, -78 };
    int16_t in[LABIAL_CHANNELS];
    for (unsigned i = 0; i < LABIAL_CHANNELS; i++)
        in[i] = (int16_t)(1000 + labial_fap_numbers[i]);
    labial_expand(in, out.faps);
    for (unsigned i = 0; i < LABIAL_FAPS_EXPANDED; i++)
        assert_int_equal(out.faps[i], wanted(labial_fap_numbers_expanded[i]));
    assert_int_equal(out.before, -77);
    assert_int_equal(out.after, -78);
}

TEST(null_does_nothing)
{
    const int16_t in[LABIAL_CHANNELS] = { 1 };
    int16_t out[LABIAL_FAPS_EXPANDED], kept[LABIAL_FAPS_EXPANDED];
    memset(out, 0x33, sizeof out);
    memcpy(kept, out, sizeof out);
    labial_expand(NULL, out);
    labial_expand(in, NULL);
    labial_expand(NULL, NULL);
    assert_memory_equal(out, kept, sizeof out);
}

/* ---- Results ------------------------------------------------------------------------------------------------------ */

#define UNKNOWN "unknown result"

static const int codes[] = {
    LABIAL_OK,           LABIAL_WAITING,       LABIAL_STARVED,        LABIAL_DONE,          LABIAL_CANCELLED,
    LABIAL_NEW_SESSION,  LABIAL_ERROR_NULL,    LABIAL_ERROR_VERSION,  LABIAL_ERROR_MODEL,   LABIAL_ERROR_WORKSPACE,
    LABIAL_ERROR_STATE,  LABIAL_ERROR_PHONEME, LABIAL_ERROR_DURATION, LABIAL_ERROR_FULL,    LABIAL_ERROR_FRAME_RATE,
    LABIAL_ERROR_MODELS, LABIAL_ERROR_NAME,    LABIAL_ERROR_RIG,      LABIAL_ERROR_TIMINGS, LABIAL_ERROR_SAMPLE_RATE,
    LABIAL_ERROR_WORD,   LABIAL_ERROR_RANGE,   LABIAL_ERROR_PACKET
};

#define CODES COUNT_OF(codes)

/* Would catch a renumbering, which breaks programs linked against an older library. */
TEST(zero_is_success_and_errors_are_negative)
{
    assert_int_equal(LABIAL_OK, 0);
    for (unsigned i = 1; i < 6; i++)
        assert_int_equal(codes[i], (int)i);
    for (unsigned i = 6; i < CODES; i++)
        assert_int_equal(codes[i], 5 - (int)i);
    assert_int_equal(LABIAL_RESULT_LAST_, codes[CODES - 1]);
}

/* Would catch a text of the wrong row, and two codes with one text. */
TEST(every_code_has_its_own_text)
{
    for (unsigned i = 0; i < CODES; i++) {
        const char *text = labial_result_text(codes[i]);
        assert_non_null(text);
        assert_true(strlen(text) > 0);
        assert_string_not_equal(text, UNKNOWN);
        for (unsigned k = 0; k < i; k++)
            assert_string_not_equal(text, labial_result_text(codes[k]));
    }
    assert_string_equal(labial_result_text(LABIAL_OK), "success");
    assert_string_equal(labial_result_text(LABIAL_DONE), "the stream has ended and every frame was delivered");
    assert_string_equal(labial_result_text(LABIAL_ERROR_NAME), "no phoneme of this name is known");
}

TEST(other_numbers_are_unknown)
{
    static const int others[] = { 6, 7, 8, 255, -18, -19, 1000, -1000, INT_MAX, INT_MIN, INT_MIN + 1 };
    for (unsigned i = 0; i < COUNT_OF(others); i++)
        assert_string_equal(labial_result_text(others[i]), UNKNOWN);
}

SUITE(set_up, tear_down)
