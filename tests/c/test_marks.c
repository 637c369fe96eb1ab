/*
 * test_marks.c - which marks do not change a label's sound: every character of the first plane of Unicode and every pair
 * of ASCII's is tried before or behind a label, and held against the lists of labial/names.h, by their code points.
 */
#include "suite.h"

#define ANY LABIAL_LABELS_AUTO
#define B 4     /* the phoneme of "B" */
#define AA 1    /* and of "AA", in ARPABET alone */
#define SCHWA 9 /* of U+0259 */
#define SILENCE 77

static const uint8_t entries[] = { B,        1 | 0xe0, 'B', AA,  2 | 0x20, 'A',      'A',  7,
                                   3 | 0xe0, 'A',      '_', 'Z', SCHWA,    2 | 0x40, 0xc9, 0x99 };
static const labial_names_t names = { sizeof entries, 10, entries, NULL };
static const labial_names_t without_schwa = { sizeof entries - 4, 10, entries, NULL };

static int find(const char *name, size_t length)
{
    return fixture_find(&names, name, length);
}

static int nearest(const char *name, size_t length)
{
    return labial_find_nearest(&names, ANY, name, length, SILENCE);
}

/* Writes a code point of U+0080 .. U+FFFF in UTF-8; returns its bytes. */
static size_t encode(unsigned point, char *out)
{
    if (point < 0x800u) {
        out[0] = (char)(0xc0u | point >> 6);
        out[1] = (char)(0x80u | (point & 63u));
        return 2;
    }
    out[0] = (char)(0xe0u | point >> 12);
    out[1] = (char)(0x80u | (point >> 6 & 63u));
    out[2] = (char)(0x80u | (point & 63u));
    return 3;
}

static int is_one_of(unsigned point, const unsigned *points, size_t count)
{
    for (; count > 0; count--)
        if (points[count - 1] == point)
            return 1;
    return 0;
}

/* Would catch a mark that is forgotten, a range that is too long by one, and half a mark. */
TEST(every_character_is_a_mark_or_none)
{
    static const unsigned signs[] = { 0x2b0, 0x2b2, 0x2b7, 0x2d0, 0x2d1, 0x2e0, 0x2e1, 0x2e4, 0x207f };
    static const unsigned stress[] = { 0x2c8, 0x2cc, 0x294 };
    for (unsigned point = 0x80; point < 0x10000; point++) {
        char text[8] = "B";
        const int is_mark =
            (point >= 0x300 && point <= 0x36f && point != 0x327) || is_one_of(point, signs, COUNT_OF(signs));
        const int leads = is_mark || is_one_of(point, stress, COUNT_OF(stress));
        const size_t bytes = encode(point, text + 1);
        fixture_seed(point);
        assert_int_equal(find(text, 1 + bytes) == B, is_mark);
        assert_int_not_equal(find(text, bytes), B); /* without its last byte */
        encode(point, text);
        text[bytes] = 'B';
        assert_int_equal(find(text, bytes + 1) == B, leads);
    }
}

/* Would catch a mark made of bytes that are no character: every pair of which the first is not ASCII. */
TEST(two_bytes_are_a_mark_where_they_are_a_character)
{
    for (unsigned a = 0x80; a < 0x100; a++)
        for (unsigned b = 0; b < 0x100; b++) {
            const char behind[] = { 'B', (char)a, (char)b }, before[] = { (char)a, (char)b, 'B' };
            const int is_character = a >= 0xc2 && a < 0xe0 && b >= 0x80 && b < 0xc0;
            fixture_seed(a << 8 | b);
            assert_true(is_character || (find(behind, 3) != B && find(before, 3) != B));
        }
}

/* Would catch an ASCII mark that is forgotten, taken at the wrong end, or dropped behind a blank. */
TEST(every_sign_is_a_mark_or_none)
{
    for (unsigned c = 0; c < 0x80; c++) {
        const char one = (char)c;
        const int is_blank = c == ' ' || c == '\t' || c == '\r' || c == '\n';
        const char behind[] = { 'B', one }, before[] = { one, 'B' }, apart[] = { 'B', ' ', one },
                   stressed[] = { 'A', 'A', one };
        const char suffix[] = { 'B', '_', one }, distant[] = { 'B', ' ', '_', one }, third[] = { 'A', 'A', '_', one };
        const int is_behind = c != 0 && strchr(":=~;.^\"-", one) != NULL, is_before = c != 0 && strchr("'\",%?", one);
        const int is_suffix = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                              (c != 0 && strchr("=~^", one) != NULL);
        fixture_seed(c);
        assert_int_equal(find(behind, 2) == B, is_blank || is_behind);
        assert_int_equal(find(before, 2) == B, is_blank || is_before);
        assert_int_equal(find(apart, 3) == B, is_blank);
        assert_int_equal(find(stressed, 3) == AA, is_blank || is_behind || (c >= '0' && c <= '2'));
        assert_int_equal(find(suffix, 3) == B, is_suffix);
        assert_int_not_equal(find(distant, 4), B);
        assert_int_equal(find(third, 4) == AA, is_suffix);
    }
}

/* Would catch a Praat sequence that is forgotten, or a backslash that takes what follows with it. */
TEST(every_backslash_sequence_is_a_mark_or_none)
{
    for (unsigned a = 1; a < 0x80; a++)
        for (unsigned b = 1; b < 0x80; b++) {
            const char behind[] = { 'B', '\\', (char)a, (char)b }, before[] = { '\\', (char)a, (char)b, 'B' };
            const int is_mark = (strchr("|0OT-+:~NUDn3cv'`^", (int)a) && strchr("v^()", (int)b)) ||
                                ((a == ':' || a == '.') && b == 'f') || (a == '\'' && (b == '1' || b == '2'));
            fixture_seed(a << 8 | b);
            assert_int_equal(find(behind, 4) == B, is_mark);
            assert_int_equal(find(before, 4) == B, is_mark);
            assert_int_not_equal(find(behind, 3), B);
        }
}

/* Would catch marks that are looked for beyond what is left of a label, and lengths that are off by one. */
TEST(what_is_left_decides)
{
    char text[70];
    assert_int_equal(find("_h", 2), LABIAL_ERROR_NAME);
    assert_int_equal(find("B::::", 5), B);
    assert_int_equal(find("B_h_h:", 6), B);
    assert_int_equal(find("''B", 3), B);
    assert_int_equal(find("A_Z", 3), 7); /* as it stands, before _Z is taken for a mark */
    assert_int_equal(find("AA9", 3), LABIAL_ERROR_NAME);
    assert_int_equal(find("1A1", 3), LABIAL_ERROR_NAME);
    assert_int_equal(find("AA11", 4), LABIAL_ERROR_NAME);
    assert_int_equal(find("1B1", 3), LABIAL_ERROR_NAME);
    assert_int_equal(find("B'", 2), LABIAL_ERROR_NAME);
    assert_int_equal(find("B\xcb\x88", 3), LABIAL_ERROR_NAME); /* stress is a mark before a label */
    assert_int_equal(find("B\xe2\x81", 3), LABIAL_ERROR_NAME);
    for (size_t length = 1; length < sizeof text;
         length++) { /* marks do not count, whatever is in front of the label */
        memset(text, ':', sizeof text);
        text[0] = 'B';
        assert_int_equal(find(text, length), length <= 32 ? B : LABIAL_ERROR_NAME);
        memset(text, '\'', sizeof text);
        text[length - 1] = 'B';
        assert_int_equal(find(text, length), B);
    }
}

/* Would catch brackets that need not match, letters beyond ASCII that count for none, and a vowel that stands for noise. */
TEST(what_is_no_sound_is_silence)
{
    static const char open[] = "<[({+*#", close[] = ">])}+*#";
    char text[40];
    for (unsigned i = 0; i < 7; i++)
        for (unsigned k = 0; k < 7; k++) {
            text[0] = open[i];
            text[1] = 'B';
            text[2] = close[k];
            assert_int_equal(nearest(text, 3), i == k ? SILENCE : B);
            assert_int_equal(nearest(text, 2), B);
            assert_int_equal(nearest(text + 1, 2), B);
        }
    assert_int_equal(nearest("[]", 2), SILENCE);
    assert_int_equal(nearest("+", 1), SILENCE); /* not the one and the other sign of a pair */
    assert_int_equal(labial_find_nearest(&names, ANY, "+", 1, 5), 5);
    for (unsigned c = 1; c < 0x80; c++) { /* of a lone sign only letters may be sounds */
        const char one = (char)c;
        const int is_letter = (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
        assert_int_equal(nearest(&one, 1), one == 'B' ? B : is_letter ? SCHWA : SILENCE);
    }
    assert_int_equal(nearest("\xd0\xb6", 2), SCHWA); /* a letter of another alphabet */
    assert_int_equal(labial_find_nearest(&without_schwa, ANY, "z", 1, SILENCE), SILENCE);
    assert_int_equal(nearest("\xc9\x99", 2), SCHWA);
    memset(text, 'z', sizeof text); /* what is looked at ends after 32 bytes */
    text[31] = 'B';
    assert_int_equal(nearest(text, sizeof text), B);
    text[31] = 'z';
    text[32] = 'B';
    assert_int_equal(nearest(text, sizeof text), SCHWA);
}

/* Would catch the shortest beginning taken for the longest, and letters that are skipped though a label begins there. */
TEST(the_longest_beginning_comes_first)
{
    assert_int_equal(nearest("AAB", 3), AA);
    assert_int_equal(nearest("BAA", 3), B);
    assert_int_equal(nearest("zAAB", 4), AA);
    assert_int_equal(nearest("xAzB", 4), B);
    assert_int_equal(labial_find_nearest(&names, LABIAL_LABELS_IPA, "AAB", 3, SILENCE), B);
}

TEST(null_is_an_error)
{
    labial_names_t none = names;
    uint8_t *byte = (uint8_t *)malloc(1);
    assert_non_null(byte);
    none.entries = NULL;
    assert_int_equal(labial_find_in(&none, ANY, "B", 1), LABIAL_ERROR_NULL);
    assert_int_equal(labial_find_nearest(&none, ANY, "B", 1, 0), LABIAL_ERROR_NULL);
    assert_int_equal(labial_find_nearest(&names, ANY, NULL, 1, 0), LABIAL_ERROR_NULL);
    none.entries = (const uint8_t *)memset(byte, B, 1);
    none.size = 1; /* half an entry is none */
    assert_int_equal(labial_find_in(&none, ANY, "B", 1), LABIAL_ERROR_NAME);
    free(byte);
}

SUITE(NULL, NULL)
