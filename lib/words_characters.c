/*
 * words_characters.c - the characters of a text: UTF-8, marks, letters with and without accents.
 * export/labial/words/text.py has the reference.
 */
#include "labial/words.h"

#include "labial/labial.h"
#include "words_parts.h"

/* Letters of U+00C0 to U+017F without their marks; a blank stands for a sign. */
static const char plain_letters[] = "AAAAAAECEEEEIIIIDNOOOOO OUUUUYTsaaaaaaeceeeeiiiidnooooo ouuuuyty"
                                    "AaAaAaCcCcCcCcDdDdEeEeEeEeEeGgGgGgGgHhHhIiIiIiIiIiIiJjKkkLlLlLlL"
                                    "lLlNnNnNnnNnOoOoOoEeRrRrRrSsSsSsSsTtTtTtUuUuUuUuUuUuWwYyYZzZzZzs";

/* Ranges of letters of other scripts; what is between them are signs and private characters. */
static const uint32_t foreign[][2] = { { 0x180u, 0x2ffu },   { 0x370u, 0x1fffu },  { 0x2c00u, 0x2dffu },
                                       { 0x3041u, 0xd7ffu }, { 0xf900u, 0xfaffu }, { 0x20000u, 0x3ffffu } };

/* The next code point, moving `at`; 0 for a byte that begins none. */
static uint32_t code_point(labial_words_place_t *here)
{
    static const uint32_t least[] = { 0, 0x80u, 0x800u, 0x10000u };
    const unsigned char lead = here->text[here->at++];
    const unsigned more = lead < 0xc0u ? 0u : lead < 0xe0u ? 1u : lead < 0xf0u ? 2u : 3u;
    uint32_t code = lead;
    unsigned i;
    if (lead < 0x80u)
        return code;
    if (more == 0u || lead > 0xf4u || here->size - here->at < more)
        return 0;
    code &= 0x3fu >> more;
    for (i = 0; i < more; i++) {
        const unsigned char byte = here->text[here->at + i];
        if ((byte & 0xc0u) != 0x80u)
            return 0;
        code = code << 6 | (byte & 0x3fu);
    }
    if (code < least[more])
        return 0;
    here->at += more;
    return code;
}

/* Whether a character changes the one before it or takes no room at all: combining marks, soft hyphen, joiners. */
static int is_mark(uint32_t code)
{
    return (code >= 0x300u && code < 0x370u) || code == 0xadu || (code >= 0x200bu && code <= 0x200du) ||
           (code >= 0xfe00u && code <= 0xfe0fu) || code == 0xfeffu;
}

static unsigned simplified(uint32_t code)
{
    unsigned i;
    if (code >= 0xff01u && code <= 0xff5eu) /* as wide as ideographs */
        code -= 0xfee0u;
    if (code < 0x80u)
        return code > ' ' && code < 0x7fu ? (unsigned)code : NOTHING;
    if (code >= 0xc0u && code < 0x180u)
        return plain_letters[code - 0xc0u] == ' ' ? NOTHING : (unsigned char)plain_letters[code - 0xc0u];
    if (code == 0x2019u || code == 0x2bcu)
        return '\'';
    for (i = 0; i < sizeof foreign / sizeof foreign[0]; i++)
        if (code >= foreign[i][0] && code <= foreign[i][1])
            return FOREIGN;
    return NOTHING;
}

/* Moves on to the next character, passing over marks. */
void labial_words_advance(labial_words_place_t *here)
{
    uint32_t code;
    do {
        here->start = here->at;
        here->code = TEXT_END;
        if (here->at >= here->size || here->characters >= LABIAL_WORDS_CHARACTERS)
            return;
        code = code_point(here);
        here->characters++;
    } while (is_mark(code));
    here->code = simplified(code);
}

/* The code of the character behind the current one. */
unsigned labial_words_following(const labial_words_place_t *here)
{
    labial_words_place_t next = *here;
    labial_words_advance(&next);
    return next.code;
}

int labial_words_is_capital(unsigned code)
{
    return code >= 'A' && code <= 'Z';
}

unsigned labial_words_small_letter(unsigned code)
{
    return labial_words_is_capital(code) ? code + ('a' - 'A') : code;
}

int labial_words_is_latin(unsigned code)
{
    return labial_words_small_letter(code) >= 'a' && labial_words_small_letter(code) <= 'z';
}

int labial_words_is_decimal(unsigned code)
{
    return code >= '0' && code <= '9';
}

int labial_words_is_inside(unsigned code)
{
    return labial_words_is_latin(code) || labial_words_is_decimal(code) || code == FOREIGN;
}
