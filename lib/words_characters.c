/*
 * words_characters.c - the characters of a text as the rules see them: UTF-8, marks, accents, ligatures, signs.
 * export/labial/words/characters.py is the reference.
 */
#include "labial/words.h"

#include "labial/labial.h"
#include "words_parts.h"

/* Accents that tell a sound. */
enum { GRAVE = 1, ACUTE, CIRCUMFLEX, TILDE, DIAERESIS, CEDILLA };

/* Letters of U+00C0 to U+017F without their marks; a blank stands for a sign, which is among the others. */
static const char plain_letters[] = "AAAAAAACEEEEIIIIDNOOOOO OUUUUYTsaaaaaaaceeeeiiiidnooooo ouuuuyty"
                                    "AaAaAaCcCcCcCcDdDdEeEeEeEeEeGgGgGgGgHhHhIiIiIiIiIiIiJjKkkLlLlLlL"
                                    "lLlNnNnNnnNnOoOoOoOoRrRrRrSsSsSsSsTtTtTtUuUuUuUuUuUuWwYyYZzZzZzs";

/* The accents of U+00C0 to U+00DF, as of the small letters 32 behind. */
static const char accents[] = "\1\2\3\4\5\0\0\6\1\2\3\5\1\2\3\5\0\4\1\2\3\4\5\0\0\1\2\3\5\2\0";

/* Characters that are other ones, or ligatures: the second letter is in the second byte, the third in the third. */
static const struct {
    uint16_t character;
    uint8_t code, more, most;
} others[] = { { 0xa2u, SIGN_CENT, 0, 0 },    { 0xa3u, SIGN_POUND, 0, 0 },      { 0xa5u, SIGN_YEN, 0, 0 },
               { 0xb0u, SIGN_DEGREE, 0, 0 },  { 0xb2u, SIGN_SQUARE, 0, 0 },     { 0xb3u, SIGN_CUBE, 0, 0 },
               { 0xb5u, 'u', 0, 0 },          { 0xc6u, 'A', 'E', 0 },           { 0xd7u, SIGN_TIMES, 0, 0 },
               { 0xe6u, 'a', 'e', 0 },        { 0xf7u, SIGN_DIVIDED, 0, 0 },    { 0x152u, 'O', 'E', 0 },
               { 0x153u, 'o', 'e', 0 },       { 0x2bcu, '\'', 0, 0 },           { 0x3bcu, 'u', 0, 0 },
               { 0x2032u, '\'', 0, 0 },       { 0x2033u, '"', 0, 0 },           { 0x2248u, SIGN_ABOUT, 0, 0 },
               { 0x2264u, SIGN_MOST, 0, 0 },  { 0x2265u, SIGN_LEAST, 0, 0 },    { 0xb1u, SIGN_EITHER, 0, 0 },
               { 0x2018u, '\'', 0, 0 },       { 0x2019u, '\'', 0, 0 },          { 0x20acu, SIGN_EURO, 0, 0 },
               { 0x20b9u, SIGN_RUPEE, 0, 0 }, { 0x2103u, SIGN_DEGREE, 'C', 0 }, { 0x2109u, SIGN_DEGREE, 'F', 0 },
               { 0x2212u, SIGN_MINUS, 0, 0 }, { 0xfb00u, 'f', 'f', 0 },         { 0xfb01u, 'f', 'i', 0 },
               { 0xfb02u, 'f', 'l', 0 },      { 0xfb03u, 'f', 'f', 'i' },       { 0xfb04u, 'f', 'f', 'l' },
               { 0xfb05u, 's', 't', 0 },      { 0xfb06u, 's', 't', 0 } };

/* Punctuation of Greek, Armenian, Hebrew, Arabic, Urdu, the scripts of India, Burmese, Ethiopic and Khmer; and as what
 * it is read. */
static const uint16_t foreign_stops[] = { 0x37e, 0x589, 0x5be,  0x5c3,  0x60c,  0x61b,  0x61f,  0x6d4,
                                          0x964, 0x965, 0x104a, 0x104b, 0x1362, 0x1363, 0x17d4, 0x17d5 };
static const char read_stops[] = "?.-.,;?...,..,..";

/* Fractions of U+00BC to U+00BE and of U+2153 to U+215E: 16 times the denominator, plus the numerator. */
static const uint8_t fractions[] = { 0x41, 0x21, 0x43, 0x31, 0x32, 0x51, 0x52, 0x53,
                                     0x54, 0x61, 0x65, 0x81, 0x83, 0x85, 0x87 };

/* Ranges of letters of other scripts; what is between them are signs and private characters. */
static const uint32_t foreign[][2] = { { 0x180u, 0x2ffu },   { 0x370u, 0x1fffu },  { 0x2c00u, 0x2dffu },
                                       { 0x3041u, 0xd7ffu }, { 0xf900u, 0xfaffu }, { 0x20000u, 0x3ffffu } };

/* What accented letters sound like. */
static const struct {
    char letter;
    uint8_t accent, sound;
} sounds[] = { { 'a', GRAVE, PHONEME_AA },      { 'a', ACUTE, PHONEME_AA },
               { 'a', CIRCUMFLEX, PHONEME_AA }, { 'c', CEDILLA, PHONEME_S },
               { 'e', GRAVE, PHONEME_EH },      { 'e', ACUTE, PHONEME_EY },
               { 'e', CIRCUMFLEX, PHONEME_EH }, { 'e', DIAERESIS, PHONEME_EH | ACCENT_LAST },
               { 'i', ACUTE, PHONEME_IY },      { 'i', CIRCUMFLEX, PHONEME_IY },
               { 'i', DIAERESIS, PHONEME_IY },  { 'o', ACUTE, PHONEME_OW },
               { 'o', CIRCUMFLEX, PHONEME_OW }, { 'u', ACUTE, PHONEME_UW },
               { 'u', CIRCUMFLEX, PHONEME_UW } };

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
    if (more == 0u || lead > 0xf4u)
        return 0;
    code &= 0x3fu >> more;
    for (i = 0; i < more; i++) {
        const size_t next = here->at + i;
        if (next >= here->size || (here->text[next] & 0xc0u) != 0x80u)
            return 0;
        code = code << 6 | (here->text[next] & 0x3fu);
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

static int is_white_space(uint32_t code)
{
    return (code >= 9u && code <= 13u) || code == ' ' || code == 0x85u || code == 0xa0u ||
           (code >= 0x2000u && code <= 0x200au) || code == 0x2028u || code == 0x2029u || code == 0x202fu ||
           code == 0x205fu || code == 0x3000u;
}

/* Simplifies a character that is no mark; what a ligature or a fraction has more goes to `pending`. */
static unsigned simplified(uint32_t code, unsigned *pending)
{
    unsigned i;
    if (is_white_space(code))
        return ' ';
    if (code >= 0xff01u && code <= 0xff5eu) /* as wide as ideographs */
        code -= 0xfee0u;
    if (code == '`')
        return '\'';
    if (code == 0x2044u) /* of fractions */
        return '/';
    if (code < 0x80u)
        return code > ' ' && code < 0x7fu ? (unsigned)code : (unsigned)NO_CHARACTER;
    if (code >= 0x2010u && code <= 0x2013u) /* hyphens and the en dash */
        return '-';
    if (code >= 0x2080u && code <= 0x2089u) /* subscripts */
        return (unsigned)code - 0x2080u + '0';
    i = (unsigned)code - (code > 0xffu ? 0x2153u - 3u : 0xbcu);
    if (i < sizeof fractions && (i < 3u) == (code <= 0xffu)) {
        *pending = 0x20302f30u + (fractions[i] & 15u) + ((unsigned)(fractions[i] >> 4) << 16); /* "0/0 " */
        return ' ';
    }
    for (i = 0; i < sizeof others / sizeof others[0]; i++)
        if (others[i].character == code) {
            *pending = others[i].more | (unsigned)others[i].most << 8;
            return others[i].code;
        }
    for (i = 0; i < sizeof foreign_stops / sizeof foreign_stops[0]; i++)
        if (foreign_stops[i] == code)
            return (unsigned char)read_stops[i];
    if (code >= 0xc0u && code < 0x180u)
        return (unsigned char)plain_letters[code - 0xc0u];
    for (i = 0; i < sizeof foreign / sizeof foreign[0]; i++)
        if (code >= foreign[i][0] && code <= foreign[i][1])
            return FOREIGN;
    return NO_CHARACTER;
}

/* Reads an entity of HTML or SSML such as "&amp;", whose ampersand was read. Returns the code of its character, or that
 * of "&" where there is no entity. */
static unsigned entity(labial_words_place_t *here)
{
    static const struct {
        char name[8];
        uint8_t size, code;
    } entities[] = { { "amp;", 4, '&' },
                     { "lt;", 3, NO_CHARACTER },
                     { "gt;", 3, NO_CHARACTER },
                     { "quot;", 5, '"' },
                     { "apos;", 5, '\'' },
                     { "nbsp;", 5, ' ' },
                     { "#39;", 4, '\'' },
                     { "rsquo;", 6, '\'' },
                     { "mdash;", 6, NO_CHARACTER },
                     { "ldquo;", 6, NO_CHARACTER },
                     { "rdquo;", 6, NO_CHARACTER },
                     { "hellip;", 7, NO_CHARACTER } };
    unsigned number, i;
    for (number = 0; number < sizeof entities / sizeof entities[0]; number++) {
        const unsigned size = entities[number].size;
        for (i = 0; i < size; i++) {
            const size_t next = here->at + i;
            if (next >= here->size || entities[number].name[i] != (char)here->text[next])
                break;
        }
        if (i < size || here->characters + size > LABIAL_WORDS_CHARACTERS)
            continue;
        here->more = size;
        here->at += size;
        return entities[number].code;
    }
    return '&';
}

/* The accent of a letter, which may be a mark behind it. */
static unsigned accent_of(const labial_words_place_t *here, uint32_t code)
{
    static const uint16_t marks[] = { 0x300u, 0x301u, 0x302u, 0x303u, 0x308u, 0x327u };
    labial_words_place_t next = *here;
    unsigned i;
    if (code >= 0xc0u && code < 0x100u && accents[(code - 0xc0u) & 31u] != 0)
        return (unsigned char)accents[(code - 0xc0u) & 31u];
    if (next.at >= next.size || next.characters >= LABIAL_WORDS_CHARACTERS)
        return 0;
    code = code_point(&next);
    for (i = 0; i < sizeof marks / sizeof marks[0]; i++)
        if (marks[i] == code)
            return i + 1u;
    return 0;
}

void labial_words_place(labial_words_place_t *here, const char *text, size_t size, size_t at)
{
    here->text = (const unsigned char *)text;
    here->size = size;
    here->at = at;
    here->characters = here->accent = here->pending = here->more = 0;
    here->code = ' ';
    labial_words_advance(here);
}

void labial_words_advance(labial_words_place_t *here)
{
    uint32_t code;
    here->before = here->code;
    if (here->pending != 0u) {
        here->code = here->pending & 0xffu;
        here->pending >>= 8;
        return;
    }
    here->characters += here->more;
    here->more = 0;
    do {
        here->start = here->at;
        here->code = TEXT_END;
        if (here->at >= here->size || here->characters >= LABIAL_WORDS_CHARACTERS)
            return;
        code = code_point(here);
        here->characters++;
    } while (is_mark(code));
    here->code = code == '&' ? entity(here) : simplified(code, &here->pending);
    here->accent = labial_words_is_latin(here->code) ? accent_of(here, code) : 0u;
}

unsigned labial_words_following(const labial_words_place_t *here)
{
    labial_words_place_t next = *here;
    labial_words_advance(&next);
    return next.code;
}

unsigned labial_words_accented(const labial_words_place_t *here)
{
    unsigned i;
    if (here->accent != 0u)
        for (i = 0; i < sizeof sounds / sizeof sounds[0]; i++)
            if (sounds[i].accent == here->accent &&
                (unsigned char)sounds[i].letter == labial_words_small_letter(here->code))
                return sounds[i].sound;
    return 0;
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

int labial_words_is_blank(unsigned code)
{
    return code == ' ' || code == TEXT_END;
}
