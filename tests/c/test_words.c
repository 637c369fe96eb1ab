/*
 * test_words.c - texts to phonemes (labial/words.h) against the exporter's reference, and texts that are no text.
 */
#include "suite.h"
#include "labial/words.h"
#include "words_cases.h"
#include "words_en.h"

/* labial_words_read() of a copy that ends where its block does, so that a sanitizer sees what is read beyond it. */
static int read_text(const labial_words_own_t *own, const char *text, size_t size, labial_word_t *word)
{
    char *copy = (char *)fixture_copy(text, size);
    const int result = labial_words_read(&words_en, own, copy, size, word);
    free(copy);
    return result;
}

/* What a word sounds like, as words_cases.h writes it. */
static const char *shown(const labial_word_t *word)
{
    static char text[2048];
    size_t at = 0;
    if (word->kind != LABIAL_WORDS_READ)
        return word->kind == LABIAL_WORDS_SILENT ? "silent" : word->kind == LABIAL_WORDS_UNKNOWN ? "unknown" : "?";
    text[0] = '\0';
    for (unsigned i = 0; i < word->count; i++)
        at += (size_t)snprintf(text + at, sizeof text - at, "%s%s%s:%u", i > 0 ? " " : "",
                               word->phonemes[i].first ? "_" : "",
                               labial_words_label(&words_en, word->phonemes[i].phoneme), word->phonemes[i].character);
    return text;
}

static void expect(const labial_words_own_t *own, const char *text, size_t size, const char *reading)
{
    labial_word_t word;
    assert_ok(read_text(own, text, size, &word));
    assert_string_equal(shown(&word), reading);
}

TEST(texts_are_read_as_by_the_reference)
{
    for (unsigned i = 0; i < COUNT_OF(readings); i++)
        expect(NULL, readings[i].text, strlen(readings[i].text), readings[i].reading);
}

/* Would catch a sequence that is decoded though it is no UTF-8, or a byte read beyond the end. */
TEST(bytes_that_are_no_text_are_passed_over)
{
    static const char *const cases[] = {
        "\x80", /* a continuation alone */
        "\xc3",
        "\xe4\xb8",
        "\xf0\x9f\x98",     /* cut off, behind the second byte, the third */
        "\xf5\x80\x80\x80", /* beyond Unicode */
        "\xc1\x81",
        "\xe0\x81\x81",
        "\xf0\x80\x81\x81", /* longer than need be: A */
        "\xc3(",            /* a letter where a continuation must be */
        "\xed\xa0\x80",     /* half a surrogate */
        "\xff\xfe\x7f\x01\x1b",
        "",
    };
    for (unsigned i = 0; i < COUNT_OF(cases); i++)
        expect(NULL, cases[i], strlen(cases[i]), "silent");
    expect(NULL, "no\xffon", 5, "_N:0 OW:1 _AA:3 N:4");
    expect(NULL, "\0go\0", 4, "_G:1 OW:2");
}

/* Would catch characters that are counted in bytes, marks that are not counted, and a count that overflows. */
TEST(characters_are_counted)
{
    char longer[600];
    labial_word_t word;
    assert_ok(read_text(NULL, "e\xcc\x81t\xc3\xa9", 6, &word));
    assert_int_equal(word.characters, 4);
    assert_ok(read_text(NULL, "a\xff\xff", 3, &word));
    assert_int_equal(word.characters, 3);
    assert_ok(read_text(NULL, "", 0, &word));
    assert_int_equal(word.characters, 0);
    memset(longer, '1', sizeof longer);
    assert_ok(read_text(NULL, longer, sizeof longer, &word));
    assert_int_equal(word.characters, LABIAL_WORDS_CHARACTERS);
    assert_int_equal(word.count, LABIAL_WORDS_PHONEMES);
}

/* Would catch a phoneme that the tables do not have or a character beyond the text, whatever the bytes are. */
TEST(any_bytes_are_read)
{
    static const char alphabet[] = "aeiouybcdt'SXRU0139.,-[<>@& \xc3\xa9\xe2\x80\x99\xd0\x9f\xff\xf0\x9f\x98\x80";
    fixture_random_t random = { 1 };
    for (unsigned round = 0; round < FIXTURE_ROUNDS(20000); round++) {
        char text[300];
        const size_t size = fixture_below(&random, round % 50u ? 12u : (uint32_t)sizeof text);
        labial_word_t word;
        for (unsigned i = 0; i < size; i++)
            text[i] = alphabet[fixture_below(&random, sizeof alphabet)];
        assert_ok(read_text(NULL, text, size, &word));
        assert_true(word.characters <= size && (word.kind == LABIAL_WORDS_READ) == (word.count > 0));
        for (unsigned i = 0; i < word.count; i++) {
            assert_in_range(word.phonemes[i].phoneme, 1, words_en.phoneme_count - 1);
            assert_in_range(word.phonemes[i].character, i > 0 ? word.phonemes[i - 1].character : 0,
                            word.characters - 1u);
        }
        assert_true(word.count == 0 || word.phonemes[0].first == 1);
    }
}

/* Would catch an own word that comes behind the rules, is found within another one, or takes more than it has. */
TEST(own_words_come_first)
{
    static const uint8_t google[] = { 15, 34, 15, 3, 21 }, wrong[] = { 200, 39, 40 }, many[255] = { 1 };
    static const labial_words_entry_t entries[] = {
        { "google", google, 5 },   { "C++", wrong, 3 },      { "", google, 5 },      { "many", many, 255 },
        { "\xd0\x9f", google, 1 }, { "nothing", google, 0 }, { "don't", google, 2 },
    };
    static const labial_words_entry_t five = { "5", google, 1 };
    static const labial_words_own_t own = { entries, COUNT_OF(entries) }, none = { NULL, 0 }, sums = { &five, 1 };
    labial_word_t word;
    expect(NULL, "Google", 6, "_G:0 UW:1 G:3 AH:4 L:4");
    expect(&own, "Google", 6, "_G:0 UW:1 G:2 AH:3 L:4");
    expect(&own, "(gOOgLe!)", 9, "_G:1 UW:2 G:3 AH:4 L:5");
    expect(&own, "googler", 7, "_G:0 UW:1 G:3 L:4 ER:6");
    expect(&own, "goog", 4, "_G:0 UW:1 G:3");
    expect(&own, "google2", 7, "_G:0 UW:1 G:3 AH:4 L:4 _T:6 UW:6");
    expect(&own, "c++", 3, "_SIL:0 ZH:1 SIL:2");
    expect(&own, "c++a", 4, "_SIL:0 ZH:1 SIL:2 _AH:3");
    expect(&own, "\xd0\x9f", 2, "_G:0");
    expect(&own, "\xd0\x9f\xd0\x9f", 4, "unknown");
    expect(&own, "google's", 8, "_G:0 UW:1 G:3 AH:4 L:4 Z:7");
    expect(&own, "google'", 7, "_G:0 UW:1 G:2 AH:3 L:4");
    expect(&own, "nothing", 7, "silent");
    expect(&own, "don't", 5, "_G:0 UW:2");
    expect(&none, "go", 2, "_G:0 OW:1");
    expect(&sums, "$5", 2, "_G:1");
    expect(&sums, "$6", 2, "_S:0 IH:0 K:0 S:0 _D:1 AA:1 L:1 ER:1 Z:1");
    assert_ok(read_text(&own, "many", 4, &word));
    assert_int_equal(word.count, LABIAL_WORDS_PHONEMES);
}

/* Letters a to z and the apostrophe by number, from text; the answers of one question about each place of a word, where
 * yes is B and no is D, except that e is silent, x is K S and o is OW. */
static const char *answers(unsigned question, const char *text)
{
    enum { SILENT, YES, NO, PAIR, VOWEL };
    static const uint8_t labels[] = { 0, 0, 7, 0, 9, 0, 20, 29, 25, 0x80 }, leaves[] = { YES, NO, SILENT, PAIR, VOWEL };
    static const uint8_t patches[1] = { 0 };
    static uint16_t roots[27], bases[27], buckets[257];
    static uint8_t trees[] = { 0, 0, 1, 0, 0, 0 };
    static labial_word_t word;
    labial_words_model_t tables = words_en;
    roots['e' - 'a'] = roots['x' - 'a'] = roots['o' - 'a'] = 3; /* always the leaf 0 */
    bases['e' - 'a'] = 2;
    bases['x' - 'a'] = 3;
    bases['o' - 'a'] = 4;
    trees[0] = (uint8_t)(question >> 1);
    trees[1] = (uint8_t)(question << 7);
    tables.labels = labels;
    tables.leaves = leaves;
    tables.trees = trees;
    tables.roots = roots;
    tables.bases = bases;
    tables.buckets = buckets;
    tables.patches = patches;
    assert_ok(labial_words_read(&tables, NULL, text, strlen(text), &word));
    return shown(&word);
}

/* Would catch a question that looks at another letter, another label or the wrong side. Worked by hand. */
TEST(questions_are_those_of_the_format)
{
    static const struct {
        unsigned question;
        const char *text, *answers;
    } cases[] = {
        /* With a vowel, or three of one letter in a row: others would be spelt. */
        { 0 * 32 + 20, "ttppa", "_D:0 B:1 B:2 D:3 D:4" }, /* t is just before it */
        { 3 * 32 + 20, "tpppp", "_D:0 D:1 D:2 D:3 B:4" }, /* four before */
        { 4 * 32 + 20, "ptta", "_B:0 B:1 D:2 D:3" },      /* just behind */
        { 7 * 32 + 20, "pppptt", "_B:0 B:1 D:2 D:3 D:4 D:5" },
        { 0 * 32, "pta", "_B:0 D:1 D:2" }, /* nothing before it */
        { 7 * 32, "pptttt", "_D:0 D:1 B:2 B:3 B:4 B:5" },
        { 0 * 32 + 28, "apytbp", "_D:0 B:1 D:2 B:3 D:4 D:5" }, /* a vowel before */
        { 0 * 32 + 29, "apytip", "_D:0 D:1 D:2 B:3 D:4 B:5" }, /* e, i, y */
        { 0 * 32 + 30, "lpwpmpap", "_D:0 B:1 D:2 B:3 D:4 B:5 D:6 D:7" },
        { 0 * 32 + 31, "zpybap", "_D:0 B:1 B:2 D:3 B:4 D:5" }, /* a consonant before */
        { 0 * 32 + 27, "p't", "_D:0 D:1 B:2" },                /* an apostrophe */
        { 256 + 4, "pot", "_B:0 OW:1 D:2" },                   /* the next label is OW */
        { 320 + 4, "ppot", "_B:0 D:1 OW:2 D:3" },              /* the one after that */
        { 256 + 60, "pott", "_B:0 OW:1 D:2 D:3" },             /* it ends in a vowel */
        { 256 + 61, "pxot", "_B:0 K:1 S:1 OW:2 D:3" },         /* it is a pair */
        { 256 + 62, "petot", "_B:0 D:2 OW:3 B:4" },            /* it is silent, or outside */
        { 256 + 63, "petot", "_D:0 D:2 OW:3 B:4" },            /* outside alone */
        { 320 + 63, "ptta", "_D:0 D:1 B:2 B:3" },
        { 384 + 0, "pooptaptt", "_D:0 OW:1 OW:2 D:3 D:4 B:5 B:6 B:7 B:8" }, /* no vowels to the right */
        { 384 + 1, "paptapt", "_D:0 B:1 B:2 B:3 B:4 B:5 B:6" },
        { 392 + 0, "ptaaptat", "_B:0 B:1 B:2 D:3 D:4 D:5 D:6 D:7" }, /* to the left */
        { 392 + 1, "taaptaap", "_B:0 B:1 B:2 B:3 B:4 B:5 D:6 D:7" },
        { 384 + 7, "tatatatatatatatatat",
          "_B:0 B:1 B:2 B:3 B:4 B:5 B:6 B:7 B:8 B:9 B:10 B:11 B:12 B:13 B:14 B:15 B:16 "
          "B:17 B:18" },
    };
    for (unsigned i = 0; i < COUNT_OF(cases); i++)
        assert_string_equal(answers(cases[i].question, cases[i].text), cases[i].answers);
    assert_string_equal(answers(20, "\xc3\xa9t"), "_D:1"); /* tables without a label for the accent */
}

/* Would catch a hash of more letters than the word has, a word that is no exception but has the hash of one, and an
 * exception that is read beyond its end. */
TEST(patches_stay_within_the_word)
{
    static uint16_t buckets[257];
    static uint8_t patches[6];
    labial_words_model_t tables = words_en;
    labial_word_t word;
    uint32_t hash = ((2166136261u ^ 7u) * 16777619u ^ 15u) * 16777619u * words_en.multiplier; /* of "go" */
    for (unsigned i = 0; i < 257; i++)
        buckets[i] = i > hash >> 24 ? 6 : 0;
    patches[0] = (uint8_t)(hash >> 16);
    patches[1] = (uint8_t)(hash >> 8);
    patches[3] = 1; /* the second letter is silent, and more follow */
    patches[4] = 0x80;
    patches[5] = 31; /* so is the last of 32 */
    tables.buckets = buckets;
    tables.patches = patches;
    assert_ok(labial_words_read(&tables, NULL, "go", 2, &word));
    assert_string_equal(shown(&word), "_G:0");
    patches[1] ^= 1;
    assert_ok(labial_words_read(&tables, NULL, "go", 2, &word));
    assert_string_equal(shown(&word), "_G:0 OW:1");
    patches[1] ^= 1;
    patches[2] = 0x80; /* the first letter is silent, and nothing follows */
    patches[3] = 0;
    patches[5] = 1;
    for (unsigned i = 0; i < 257; i++)
        buckets[i] = i > hash >> 24 ? 4 : 0;
    assert_ok(labial_words_read(&tables, NULL, "go", 2, &word));
    assert_string_equal(shown(&word), "_OW:1");
}

/* Would catch a word that does not know those before it: a sum, a month, a stage direction. */
TEST(words_know_those_before)
{
    static const struct {
        const char *text, *reading;
        unsigned dropped;
    } cases[] = { { "$5", "_F:0 AY:0 V:0 _D:1 AA:1 L:1 ER:1 Z:1", 0 },
                  { "million", "_M:0 IH:0 L:0 Y:0 AH:0 N:0 _D:0 AA:0 L:0 ER:0 Z:0", 5 },
                  { "May", "_M:0 EY:1", 0 },
                  { "5", "_F:0 IH:0 F:0 TH:0", 0 },
                  { "*leans", "silent", 0 },
                  { "in*", "silent", 0 },
                  { "in", "_IH:0 N:1", 0 },
                  { "9:00", "_N:0 AY:0 N:0 _AH:0 K:0 L:0 AA:0 K:0", 0 },
                  { "a.m.", "_EY:0 _EH:2 M:2", 5 },
                  { "21", "_T:0 W:0 EH:0 N:0 T:0 IY:0 _W:0 AH:0 N:0", 0 },
                  { "Mar.", "_T:0 W:0 EH:0 N:0 T:0 IY:0 _F:0 ER:0 S:0 T:0 _M:0 AA:0 R:0 CH:0", 9 },
                  { "No.", "_N:0 OW:1", 0 },
                  { "5", "_N:0 AH:0 M:0 B:0 ER:0 _F:0 AY:0 V:0", 2 },
                  { "6ft", "_S:0 IH:0 K:0 S:0 _F:1 IY:1 T:1", 0 },
                  { "2", "_T:0 UW:0", 0 },
                  { "in", "_IH:0 N:0 CH:0 IH:0 Z:0", 0 },
                  { "Elm", "_EH:0 L:1 M:2", 0 },
                  { "St.", "_S:0 T:0 R:0 IY:0 T:0", 0 },
                  { "Louis", "_S:0 EY:0 N:0 T:0 _L:0 UW:2 IH:3 S:4", 5 },
                  { "Mon,", "_M:0 AA:1 N:2", 0 },
                  { "Mar", "_M:0 AH:0 N:0 D:0 EY:0 _M:0 AA:0 R:0 CH:0", 3 },
                  { "5", "_F:0 IH:0 F:0 TH:0", 0 },
                  { "Mar", "_M:0 AA:1 R:2", 0 },
                  { "5", "_M:0 AA:0 R:0 CH:0 _F:0 IH:0 F:0 TH:0", 3 },
                  { "seat", "_S:0 IY:1 T:3", 0 },
                  { "5C", "_F:0 AY:0 V:0 _S:1 IY:1", 0 },
                  { "or", "_AO:0 R:1", 0 },
                  { "6C", "_S:0 IH:0 K:0 S:0 _S:1 IY:1", 0 } };
    labial_words_context_t context;
    labial_word_t word;
    memset(&context, 0, sizeof context);
    for (unsigned i = 0; i < COUNT_OF(cases); i++) {
        assert_ok(labial_words_read_next(&words_en, NULL, &context, cases[i].text, strlen(cases[i].text), &word));
        assert_string_equal(shown(&word), cases[i].reading);
        assert_int_equal(context.dropped, cases[i].dropped);
    }
}

TEST(misuse_is_an_error)
{
    labial_words_model_t other = words_en;
    labial_word_t word;
    assert_int_equal(labial_words_read(NULL, NULL, "a", 1, &word), LABIAL_ERROR_NULL);
    assert_int_equal(labial_words_read(&words_en, NULL, NULL, 1, &word), LABIAL_ERROR_NULL);
    assert_int_equal(labial_words_read(&words_en, NULL, "a", 1, NULL), LABIAL_ERROR_NULL);
    assert_int_equal(labial_words_read_next(&words_en, NULL, NULL, "a", 1, &word), LABIAL_ERROR_NULL);
    other.format++;
    assert_int_equal(labial_words_read(&other, NULL, "a", 1, &word), LABIAL_ERROR_VERSION);
    assert_string_equal(labial_words_label(&words_en, 39), "ZH");
    assert_string_equal(labial_words_label(&words_en, 40), "");
    assert_string_equal(labial_words_label(NULL, 0), "");
}

SUITE(NULL, NULL)
