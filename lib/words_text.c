/*
 * words_text.c - what is said where a text stands: letters, digits, abbreviations, signs. The rules are those of
 * labial/words.h; export/labial/words/text.py is their reference.
 */
#include "labial/words.h"

#include <string.h>

#include "labial/labial.h"
#include "words_parts.h"

/* Codes of characters that are not ASCII: the end, letters of other scripts, and what is not said. */
#define TEXT_END 0u
#define FOREIGN 1u
#define NOTHING 2u

/* Letters of U+00C0 to U+017F without their marks; a blank stands for a sign. */
static const char plain_letters[] = "AAAAAAECEEEEIIIIDNOOOOO OUUUUYTsaaaaaaeceeeeiiiidnooooo ouuuuyty"
                                    "AaAaAaCcCcCcCcDdDdEeEeEeEeEeGgGgGgGgHhHhIiIiIiIiIiIiJjKkkLlLlLlL"
                                    "lLlNnNnNnnNnOoOoOoEeRrRrRrSsSsSsSsTtTtTtUuUuUuUuUuUuWwYyYZzZzZzs";

/* Ranges of letters of other scripts; what is between them are signs and private characters. */
static const uint32_t foreign[][2] = { { 0x180u, 0x2ffu },   { 0x370u, 0x1fffu },  { 0x2c00u, 0x2dffu },
                                       { 0x3041u, 0xd7ffu }, { 0xf900u, 0xfaffu }, { 0x20000u, 0x3ffffu } };

/* Spoken for numbers, and the same as ordinals. */
enum { TEN = 10, TWENTY = 20, HUNDRED = 28, THOUSAND, MILLION };
static const char cardinals[] = "zero\0one\0two\0three\0four\0five\0six\0seven\0eight\0nine\0ten\0eleven\0twelve\0"
                                "thirteen\0fourteen\0fifteen\0sixteen\0seventeen\0eighteen\0nineteen\0twenty\0thirty\0"
                                "forty\0fifty\0sixty\0seventy\0eighty\0ninety\0hundred\0thousand\0million\0";
static const char ordinals[] = "zeroth\0first\0second\0third\0fourth\0fifth\0sixth\0seventh\0eighth\0ninth\0tenth\0"
                               "eleventh\0twelfth\0thirteenth\0fourteenth\0fifteenth\0sixteenth\0seventeenth\0"
                               "eighteenth\0nineteenth\0twentieth\0thirtieth\0fortieth\0fiftieth\0sixtieth\0"
                               "seventieth\0eightieth\0ninetieth\0hundredth\0thousandth\0millionth\0";

/* Names of letters, as words that the trees read so. */
static const char letter_names[] = "ay\0bee\0see\0dee\0e\0eff\0gee\0aitch\0eye\0jay\0kay\0ell\0em\0en\0oh\0pee\0cue\0"
                                   "are\0ess\0tee\0you\0vee\0double you\0ex\0why\0zee\0";

/* Letters of the longest word in these lists: "seventeenth". */
#define LONGEST_SAID 11

/* Signs that are said, and abbreviations with what they stand for; a blank separates spoken words. */
static const char signs[] = "&and\0@at\0%percent\0+plus\0=equals\0";
static const char abbreviations[] = "mr\0mister\0mrs\0missiz\0ms\0mizz\0dr\0doctor\0st\0saint\0prof\0professor\0"
                                    "jr\0junior\0sr\0senior\0vs\0versus\0etc\0etcetera\0";

/* Capitals with a vowel that are read letter by letter nevertheless. */
static const char initials[] =
    "AI\0API\0ATM\0CEO\0CPU\0DIY\0EU\0EV\0GPU\0ID\0IOS\0IP\0IQ\0LED\0OK\0PA\0UFO\0UI\0UK\0UN\0"
    "URL\0USA\0USB\0UX\0";

/* A E I O U Y, a bit for each letter's number. */
#define VOWEL_CAPITALS 0x02208222u

/* A place in a text, and the word that it becomes. */
typedef struct {
    const unsigned char *text;
    size_t size;
    size_t at;           /* behind the current character */
    size_t start;        /* of the current character */
    unsigned characters; /* so far, the current one included */
    unsigned code;       /* of the current one: ASCII, TEXT_END, FOREIGN or NOTHING */
} place_t;

typedef struct {
    const labial_words_model_t *model;
    labial_word_t *word;
    place_t here;
} reading_t;

/* ---- Characters ------------------------------------------------------------------------------------------------- */

/* The next code point, moving `at`; 0 for a byte that begins none. */
static uint32_t code_point(place_t *here)
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
static void advance(place_t *here)
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
static unsigned following(const place_t *here)
{
    place_t next = *here;
    advance(&next);
    return next.code;
}

static int is_capital(unsigned code)
{
    return code >= 'A' && code <= 'Z';
}

static unsigned small(unsigned code)
{
    return is_capital(code) ? code + ('a' - 'A') : code;
}

static int is_latin(unsigned code)
{
    return small(code) >= 'a' && small(code) <= 'z';
}

static int is_decimal(unsigned code)
{
    return code >= '0' && code <= '9';
}

static int is_in_word(unsigned code)
{
    return is_latin(code) || is_decimal(code) || code == FOREIGN;
}

/* ---- Words that the rules say ----------------------------------------------------------------------------------- */

/* Says words of small letters, separated by blanks, where the text's `character` is. */
static void say(reading_t *reading, const char *words, unsigned character)
{
    labial_words_letter_t letters[LONGEST_SAID];
    unsigned count = 0;
    for (;; words++) {
        if (*words > ' ') {
            letters[count].letter = (uint8_t)(*words - 'a' + 1);
            letters[count++].character = (uint8_t)character;
            continue;
        }
        labial_words_spell(reading->model, letters, count, reading->word);
        count = 0;
        if (*words == '\0')
            return;
    }
}

/* The text of this number in a list. */
static const char *listed(const char *list, unsigned number)
{
    for (; number > 0u; list++)
        number -= *list == '\0';
    return list;
}

/* ---- Numbers ---------------------------------------------------------------------------------------------------- */

/* Says part of a number, the word `last`, which is said later, before it. */
static void say_part(reading_t *reading, unsigned *last, unsigned next, unsigned character)
{
    if (*last <= MILLION)
        say(reading, listed(cardinals, *last), character);
    *last = next;
}

/* Up to 999; nothing for 0. */
static void say_hundreds(reading_t *reading, unsigned *last, uint32_t value, unsigned character)
{
    uint32_t rest = value % 100u;
    if (value >= 100u) {
        say_part(reading, last, (unsigned)(value / 100u), character);
        say_part(reading, last, HUNDRED, character);
    }
    if (rest >= TWENTY) {
        say_part(reading, last, (unsigned)(TWENTY - 2u + rest / TEN), character);
        rest %= TEN;
    }
    if (rest > 0u)
        say_part(reading, last, (unsigned)rest, character);
}

/* A whole number up to 999,999,999, or its ordinal. */
static void say_number(reading_t *reading, uint32_t value, int is_ordinal, unsigned character)
{
    unsigned last = MILLION + 1u; /* none */
    if (value >= 1000000u) {
        say_hundreds(reading, &last, value / 1000000u, character);
        say_part(reading, &last, MILLION, character);
    }
    if (value / 1000u % 1000u > 0u) {
        say_hundreds(reading, &last, value / 1000u % 1000u, character);
        say_part(reading, &last, THOUSAND, character);
    }
    say_hundreds(reading, &last, value % 1000u, character);
    if (value == 0u)
        last = 0;
    say(reading, listed(is_ordinal ? ordinals : cardinals, last), character);
}

/* Digits one by one; behind a point without commas. */
static void say_digits(reading_t *reading, int with_commas)
{
    place_t *here = &reading->here;
    for (; is_decimal(here->code) || (with_commas && here->code == ',' && is_decimal(following(here))); advance(here))
        if (here->code != ',')
            say(reading, listed(cardinals, here->code - '0'), here->characters - 1u);
}

/* Whether three digits and no fourth one follow. */
static int has_group(const place_t *here)
{
    place_t next = *here;
    unsigned count = 0;
    for (advance(&next); is_decimal(next.code); advance(&next))
        count++;
    return count == 3u;
}

/* st, nd, rd, th behind a number: moves behind it. */
static int takes_ordinal(place_t *here)
{
    static const char endings[] = "stndrdth";
    place_t next = *here;
    unsigned i, first, second;
    first = small(next.code);
    advance(&next);
    second = small(next.code);
    if (is_in_word(following(&next)))
        return 0;
    for (i = 0; i < 8u; i += 2u)
        if (first == (unsigned char)endings[i] && second == (unsigned char)endings[i + 1u]) {
            advance(&next);
            *here = next;
            return 1;
        }
    return 0;
}

static void read_digits(reading_t *reading)
{
    place_t *here = &reading->here;
    const place_t first = *here;
    uint32_t value = 0;
    unsigned count = 0;
    for (; is_decimal(here->code) || (here->code == ',' && has_group(here)); advance(here))
        if (here->code != ',' && ++count <= 9u)
            value = value * 10u + (here->code - '0');
    if (count > 9u || (count > 1u && first.code == '0')) {
        *here = first;
        say_digits(reading, 1);
    } else {
        say_number(reading, value, takes_ordinal(here), first.characters - 1u);
    }
    if (here->code == '.' && is_decimal(following(here))) {
        say(reading, "point", here->characters - 1u);
        advance(here);
        say_digits(reading, 0);
    }
}

/* ---- Letters ---------------------------------------------------------------------------------------------------- */

/* Letters that stand together. */
typedef struct {
    labial_words_letter_t letters[LABIAL_WORDS_LETTERS];
    char capitals[6]; /* the first five, in capitals, as far as they are letters */
    unsigned count;
    unsigned small; /* of them, small letters and apostrophes */
} run_t;

static void say_name(reading_t *reading, labial_words_letter_t letter)
{
    say(reading, listed(letter_names, letter.letter - 1u), letter.character);
}

/* Takes the letters that belong together from a letter on, up to a capital behind a small letter. */
static void take_run(place_t *here, run_t *run)
{
    unsigned before = TEXT_END;
    memset(run, 0, sizeof *run);
    while (run->count < LABIAL_WORDS_LETTERS) {
        const unsigned code = here->code;
        const int is_inner = code == '\'' && is_latin(following(here));
        if (!is_inner && !is_latin(code))
            return;
        if (is_capital(code) && before > 'Z')
            return;
        if (run->count < 5u)
            run->capitals[run->count] = (char)(small(code) - ('a' - 'A'));
        run->letters[run->count].letter = (uint8_t)(is_inner ? 27u : small(code) - 'a' + 1u);
        run->letters[run->count++].character = (uint8_t)(here->characters - 1u);
        run->small += !is_capital(code);
        before = code;
        advance(here);
    }
}

/* Whether a run of at most five letters is in a list, `step` texts of which belong together; which one, or -1. */
static int find_run(const run_t *run, const char *list, unsigned step)
{
    int number;
    for (number = 0; *list != '\0'; number++, list = listed(list, step)) {
        unsigned i;
        for (i = 0; list[i] != '\0' && (char)(list[i] & ~0x20) == run->capitals[i]; i++)
            ;
        if (list[i] == '\0' && i == run->count)
            return number;
    }
    return -1;
}

/* Whether letters are capitals that are read one by one. */
static int is_spelt(const run_t *run)
{
    unsigned i;
    if (run->small > 0u || run->count < 2u || run->count > 5u)
        return 0;
    for (i = 0; i < run->count; i++)
        if ((VOWEL_CAPITALS >> (run->letters[i].letter)) & 1u)
            return find_run(run, initials, 1) >= 0;
    return 1;
}

/* Whether a point and a single letter follow. */
static int has_pointed(const place_t *here)
{
    place_t next = *here;
    if (here->code != '.')
        return 0;
    advance(&next);
    return is_latin(next.code) && !is_in_word(following(&next));
}

/* Letters with points between them, "e.g." and "i.e." among them; `letter` is the first one, and its point is next. */
static void read_pointed(reading_t *reading, labial_words_letter_t letter)
{
    place_t *here = &reading->here;
    const place_t first = *here;
    const char *meaning = NULL;
    advance(here);
    if (letter.letter == 5u && small(here->code) == 'g')
        meaning = "for example";
    else if (letter.letter == 9u && small(here->code) == 'e')
        meaning = "that is";
    if (meaning) {
        say(reading, meaning, letter.character);
        advance(here);
        return;
    }
    *here = first;
    say_name(reading, letter);
    while (has_pointed(here)) {
        advance(here);
        letter.letter = (uint8_t)(small(here->code) - 'a' + 1u);
        letter.character = (uint8_t)(here->characters - 1u);
        say_name(reading, letter);
        advance(here);
    }
}

static void read_letters(reading_t *reading)
{
    place_t *here = &reading->here;
    run_t run;
    unsigned i;
    int abbreviation;
    take_run(here, &run);
    abbreviation = find_run(&run, abbreviations, 2);
    if (run.count == 1u && has_pointed(here)) {
        read_pointed(reading, run.letters[0]);
    } else if (abbreviation >= 0) {
        say(reading, listed(abbreviations, 2u * (unsigned)abbreviation + 1u), run.letters[0].character);
    } else if (is_spelt(&run) || (run.count == 1u && run.capitals[0] != 'A' && run.capitals[0] != 'I')) {
        for (i = 0; i < run.count; i++)
            say_name(reading, run.letters[i]);
    } else {
        labial_words_spell(reading->model, run.letters, run.count, reading->word);
    }
}

/* ---- The caller's own words ------------------------------------------------------------------------------------- */

/* Whether an own word stands here; moves behind it. */
static int takes_own(place_t *here, const char *word)
{
    size_t i;
    place_t next = *here;
    for (i = 0; word[i] != '\0'; i++)
        if (here->start + i >= here->size || small((unsigned char)word[i]) != small(here->text[here->start + i]))
            return 0;
    if (i == 0u)
        return 0;
    while (next.code != TEXT_END && next.start < here->start + i)
        advance(&next);
    if ((is_in_word((unsigned char)word[i - 1u]) || (unsigned char)word[i - 1u] >= 0x80u) &&
        (is_in_word(next.code) || (next.code == '\'' && is_latin(following(&next)))))
        return 0; /* it goes on */
    *here = next;
    return 1;
}

/* Reads an own word, if there is one. */
static int reads_own(reading_t *reading, const labial_words_own_t *own)
{
    const place_t first = reading->here;
    unsigned i, k;
    for (i = 0; own && i < own->count; i++) {
        const labial_words_entry_t *const entry = &own->entries[i];
        unsigned length;
        if (!takes_own(&reading->here, entry->word))
            continue;
        length = reading->here.characters - first.characters + (reading->here.code == TEXT_END);
        for (k = 0; k < entry->count; k++)
            labial_words_append(reading->word,
                                entry->phonemes[k] < reading->model->phoneme_count ? entry->phonemes[k] : 0u,
                                first.characters - 1u + k * length / entry->count, k == 0u);
        return 1;
    }
    return 0;
}

/* ---- The whole -------------------------------------------------------------------------------------------------- */

/* Passes over a tag. */
static void skip_tag(place_t *here)
{
    const unsigned end = here->code == '[' ? ']' : '>';
    while (here->code != TEXT_END && here->code != end)
        advance(here);
}

/* Says a sign. */
static void read_sign(reading_t *reading)
{
    unsigned number;
    for (number = 0; number < 5u; number++) {
        const char *const sign = listed(signs, number);
        if ((unsigned char)*sign == reading->here.code)
            say(reading, sign + 1, reading->here.characters - 1u);
    }
}

int labial_words_read(const labial_words_model_t *model, const labial_words_own_t *own, const char *text, size_t size,
                      labial_word_t *word)
{
    reading_t reading;
    place_t *const here = &reading.here;
    unsigned before = NOTHING, is_foreign = 0;
    if (!model || !text || !word)
        return LABIAL_ERROR_NULL;
    if (model->format != LABIAL_WORDS_FORMAT)
        return LABIAL_ERROR_VERSION;
    memset(&reading, 0, sizeof reading);
    memset(word, 0, sizeof *word);
    reading.model = model;
    reading.word = word;
    here->text = (const unsigned char *)text;
    here->size = size;
    advance(here);
    while (here->code != TEXT_END) {
        const unsigned code = here->code;
        is_foreign |= code == FOREIGN;
        if (!is_in_word(before) && reads_own(&reading, own)) {
            before = NOTHING;
            continue;
        }
        before = code;
        if (is_latin(code)) {
            read_letters(&reading);
        } else if (is_decimal(code)) {
            read_digits(&reading);
        } else {
            if (code == '[' || code == '<')
                skip_tag(here);
            else
                read_sign(&reading);
            advance(here);
        }
    }
    word->characters = (uint8_t)here->characters;
    word->kind = word->count > 0u ? LABIAL_WORDS_READ : is_foreign ? LABIAL_WORDS_UNKNOWN : LABIAL_WORDS_SILENT;
    return LABIAL_OK;
}
