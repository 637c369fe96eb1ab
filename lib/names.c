/*
 * names.c - phonemes by name (labial/names.h).
 */
#include "labial/names.h"

#include <string.h>

#include "labial/labial.h"

/* Longest label, in bytes, that is compared without its marks; no alias of a phone set is longer. */
#define LABEL_MAX 32

/* A length and the sets of labels share a byte of an entry. */
#define LENGTH_MASK 31u

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static int find_exactly(const labial_names_t *names, unsigned labels, const char *name, size_t length)
{
    const uint8_t *entry = names->entries;
    const uint8_t *const end = entry + names->size;
    size_t i;
    if (labels == LABIAL_LABELS_AUTO && length == 1u && is_digit(name[0]))
        return LABIAL_ERROR_NAME;
    for (; end - entry >= 2; entry += 2u + (entry[1] & LENGTH_MASK)) {
        if ((entry[1] & LENGTH_MASK) != length || (entry[1] & labels & LABIAL_LABELS_AUTO) == 0u)
            continue;
        for (i = 0; i < length && entry[2 + i] == (uint8_t)name[i]; i++)
            ;
        if (i == length)
            return entry[0];
    }
    return LABIAL_ERROR_NAME;
}

/* The phoneme of the first name in a text, and the longest there: in one pass over the table, however long the text. */
static int find_within(const labial_names_t *names, unsigned labels, const char *text, size_t length)
{
    const uint8_t *entry = names->entries;
    const uint8_t *const end = entry + names->size;
    size_t begin = length, longest = 0, start, i;
    int phoneme = LABIAL_ERROR_NAME;
    for (; end - entry >= 2; entry += 2u + (entry[1] & LENGTH_MASK)) {
        const size_t size = entry[1] & LENGTH_MASK;
        if (size == 0u || (entry[1] & labels & LABIAL_LABELS_AUTO) == 0u)
            continue;
        for (start = 0; start + size <= length && start < begin + (size > longest ? 1u : 0u); start++) {
            if (labels == LABIAL_LABELS_AUTO && size == 1u && is_digit(text[start]))
                continue;
            for (i = 0; i < size && entry[2 + i] == (uint8_t)text[start + i]; i++)
                ;
            if (i < size)
                continue;
            begin = start;
            longest = size;
            phoneme = entry[0];
            break;
        }
    }
    return phoneme;
}

/* ---- Marks, the same as in export/labial/corpus/labels.py ------------------------------------------------------ */

static int is_one_of(char c, const char *set)
{
    for (; *set; set++)
        if (*set == c)
            return 1;
    return 0;
}

static int is_blank(char c)
{
    return is_one_of(c, " \t\r\n");
}

static int is_letter(char c)
{
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

/* Bytes of the mark at `at`, where `left` bytes are left: Praat's backslash sequences, combining marks except the
 * cedilla, signs of length and of secondary articulation. 0 when there is none. */
static size_t mark_length(const char *at, size_t left)
{
    if (at[0] == '\\' && left > 2u) {
        if (is_one_of(at[1], "|0OT-+:~NUDn3cv'`^") && is_one_of(at[2], "v^()"))
            return 3;
        if (is_one_of(at[1], ":.") && at[2] == 'f')
            return 3;
        if (at[1] == '\'' && is_one_of(at[2], "12"))
            return 3;
    }
    if (left > 1u) {
        const unsigned a = (unsigned char)at[0], b = (unsigned char)at[1];
        if (a == 0xccu && b >= 0x80u && b <= 0xbfu && b != 0xa7u) /* U+0300 .. U+033F, U+0327 is the cedilla */
            return 2;
        if (a == 0xcdu && b >= 0x80u && b <= 0xafu) /* U+0340 .. U+036F */
            return 2;
        if (a == 0xcbu && is_one_of(at[1], "\x90\x91\xa0\xa1\xa4")) /* U+02D0 U+02D1 U+02E0 U+02E1 U+02E4 */
            return 2;
        if (a == 0xcau && is_one_of(at[1], "\xb0\xb2\xb7")) /* U+02B0 U+02B2 U+02B7 */
            return 2;
        if (left > 2u && a == 0xe2u && b == 0x81u && at[2] == '\xbf') /* U+207F */
            return 3;
    }
    return 0;
}

/* Bytes of the mark before a symbol at `at`: U+02C8, U+02CC, ASCII's stress marks, the glottal stop (U+0294 or ?). */
static size_t leading_length(const char *at, size_t left)
{
    if (left > 1u && at[0] == '\xcb' && is_one_of(at[1], "\x88\x8c"))
        return 2;
    if (left > 1u && at[0] == '\xca' && at[1] == '\x94')
        return 2;
    return is_one_of(at[0], "'\",%?") ? 1u : 0u;
}

/* Bytes of X-SAMPA's, Kaldi's and eSpeak's marks at the end of `length` bytes; the remainder is not empty. */
static size_t trailing_length(const char *text, size_t length)
{
    char last;
    if (length < 2u)
        return 0;
    last = text[length - 1u];
    if (length > 2u && text[length - 2u] == '_' && text[length - 3u] != ' ' &&
        (is_letter(last) || is_digit(last) || is_one_of(last, "=~^")))
        return 2;
    return is_one_of(last, ":=~;.^\"-") && text[length - 2u] != ' ' ? 1u : 0u;
}

/* `name` without the blanks around it; `length` becomes the remaining length. */
static const char *trim(const char *name, size_t *length)
{
    for (; *length > 0u && is_blank(name[0]); (*length)--)
        name++;
    while (*length > 0u && is_blank(name[*length - 1u]))
        (*length)--;
    return name;
}

/* Writes `name` without its marks to `text`. Returns the length: 0 when `name` is empty, only marks or too long. */
static size_t without_marks(const char *name, size_t length, char text[LABEL_MAX])
{
    size_t count = 0, skip, i;
    for (i = 0; i < length;) {
        skip = mark_length(name + i, length - i);
        if (skip == 0u && count == 0u)
            skip = leading_length(name + i, length - i);
        if (skip == 0u) {
            if (count == LABEL_MAX)
                return 0;
            text[count++] = name[i];
            skip = 1;
        }
        i += skip;
    }
    while ((skip = trailing_length(text, count)) != 0u)
        count -= skip;
    if (count > 2u && text[count - 1u] >= '0' && text[count - 1u] <= '2' && is_letter(text[count - 2u]) &&
        is_letter(text[count - 3u]))
        count--;
    return count;
}

/* ---- Looking up ------------------------------------------------------------------------------------------------ */

int labial_find_in(const labial_names_t *names, labial_labels_t labels, const char *name, size_t length)
{
    char text[LABEL_MAX];
    int phoneme;
    if (!names || !name || !names->entries)
        return LABIAL_ERROR_NULL;
    name = trim(name, &length);
    phoneme = find_exactly(names, labels, name, length);
    if (phoneme < 0) {
        length = without_marks(name, length, text);
        phoneme = length > 0u ? find_exactly(names, labels, text, length) : LABIAL_ERROR_NAME;
    }
    return phoneme;
}

int labial_find(const labial_names_t *names, const char *name, size_t length)
{
    return labial_find_in(names, LABIAL_LABELS_AUTO, name, length);
}

/* Whether a label is set in brackets or between signs, as noises are. */
static int is_bracketed(const char *text, size_t length)
{
    static const char pairs[][2] = { { '<', '>' }, { '[', ']' }, { '(', ')' }, { '{', '}' },
                                     { '+', '+' }, { '*', '*' }, { '#', '#' } };
    unsigned i;
    for (i = 0; i < sizeof pairs / sizeof pairs[0]; i++)
        if (length > 1u && text[0] == pairs[i][0] && text[length - 1u] == pairs[i][1])
            return 1;
    return 0;
}

/* Whether there is a letter of any alphabet, or another character that is not ASCII. */
static int has_letter(const char *text, size_t length)
{
    for (; length > 0u; length--, text++)
        if (is_letter(*text) || (unsigned char)*text >= 0x80u)
            return 1;
    return 0;
}

int labial_find_nearest(const labial_names_t *names, labial_labels_t labels, const char *name, size_t length,
                        unsigned silence)
{
    char text[LABEL_MAX];
    int phoneme = labial_find_in(names, labels, name, length);
    if (phoneme >= 0 || phoneme == LABIAL_ERROR_NULL)
        return phoneme;
    name = trim(name, &length);
    if (is_bracketed(name, length))
        return (int)silence;
    length = without_marks(name, length < LABEL_MAX ? length : LABEL_MAX, text);
    if (!has_letter(text, length))
        return (int)silence;
    phoneme = find_within(names, labels, text, length);
    if (phoneme < 0)
        phoneme = find_exactly(names, LABIAL_LABELS_AUTO, "\xc9\x99", 2); /* schwa */
    return phoneme >= 0 ? phoneme : (int)silence;
}
