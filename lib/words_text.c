/*
 * words_text.c - what is said where a text stands: letters, abbreviations, signs. The rules are those of
 * labial/words.h; export/labial/words/text.py is their reference.
 */
#include "labial/words.h"

#include <string.h>

#include "labial/labial.h"
#include "words_parts.h"

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

/* ---- Words that the rules say ----------------------------------------------------------------------------------- */

/* Says words of small letters, separated by blanks, where the text's `character` is. */
void labial_words_say(labial_words_reading_t *reading, const char *words, unsigned character)
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
const char *labial_words_listed(const char *list, unsigned number)
{
    for (; number > 0u; list++)
        number -= *list == '\0';
    return list;
}

/* ---- Letters ---------------------------------------------------------------------------------------------------- */

/* Letters that stand together. */
typedef struct {
    labial_words_letter_t letters[LABIAL_WORDS_LETTERS];
    char capitals[6]; /* the first five, in capitals, as far as they are letters */
    unsigned count;
    unsigned small; /* of them, small letters and apostrophes */
} run_t;

static void say_name(labial_words_reading_t *reading, labial_words_letter_t letter)
{
    labial_words_say(reading, labial_words_listed(letter_names, letter.letter - 1u), letter.character);
}

/* Takes the letters that belong together from a letter on, up to a capital behind a small letter. */
static void take_run(labial_words_place_t *here, run_t *run)
{
    unsigned before = TEXT_END;
    memset(run, 0, sizeof *run);
    while (run->count < LABIAL_WORDS_LETTERS) {
        const unsigned code = here->code;
        const int is_inner = code == '\'' && labial_words_is_latin(labial_words_following(here));
        if (!is_inner && !labial_words_is_latin(code))
            return;
        if (labial_words_is_capital(code) && before > 'Z')
            return;
        if (run->count < 5u)
            run->capitals[run->count] = (char)(labial_words_small_letter(code) - ('a' - 'A'));
        run->letters[run->count].letter = (uint8_t)(is_inner ? 27u : labial_words_small_letter(code) - 'a' + 1u);
        run->letters[run->count++].character = (uint8_t)(here->characters - 1u);
        run->small += !labial_words_is_capital(code);
        before = code;
        labial_words_advance(here);
    }
}

/* Whether a run of at most five letters is in a list, `step` texts of which belong together; which one, or -1. */
static int find_run(const run_t *run, const char *list, unsigned step)
{
    int number;
    for (number = 0; *list != '\0'; number++, list = labial_words_listed(list, step)) {
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
static int has_pointed(const labial_words_place_t *here)
{
    labial_words_place_t next = *here;
    if (here->code != '.')
        return 0;
    labial_words_advance(&next);
    return labial_words_is_latin(next.code) && !labial_words_is_inside(labial_words_following(&next));
}

/* Letters with points between them, "e.g." and "i.e." among them; `letter` is the first one, and its point is next. */
static void read_pointed(labial_words_reading_t *reading, labial_words_letter_t letter)
{
    labial_words_place_t *here = &reading->here;
    const labial_words_place_t first = *here;
    const char *meaning = NULL;
    labial_words_advance(here);
    if (letter.letter == 5u && labial_words_small_letter(here->code) == 'g')
        meaning = "for example";
    else if (letter.letter == 9u && labial_words_small_letter(here->code) == 'e')
        meaning = "that is";
    if (meaning) {
        labial_words_say(reading, meaning, letter.character);
        labial_words_advance(here);
        return;
    }
    *here = first;
    say_name(reading, letter);
    while (has_pointed(here)) {
        labial_words_advance(here);
        letter.letter = (uint8_t)(labial_words_small_letter(here->code) - 'a' + 1u);
        letter.character = (uint8_t)(here->characters - 1u);
        say_name(reading, letter);
        labial_words_advance(here);
    }
}

static void read_letters(labial_words_reading_t *reading)
{
    labial_words_place_t *here = &reading->here;
    run_t run;
    unsigned i;
    int abbreviation;
    take_run(here, &run);
    abbreviation = find_run(&run, abbreviations, 2);
    if (run.count == 1u && has_pointed(here)) {
        read_pointed(reading, run.letters[0]);
    } else if (abbreviation >= 0) {
        labial_words_say(reading, labial_words_listed(abbreviations, 2u * (unsigned)abbreviation + 1u),
                         run.letters[0].character);
    } else if (is_spelt(&run) || (run.count == 1u && run.capitals[0] != 'A' && run.capitals[0] != 'I')) {
        for (i = 0; i < run.count; i++)
            say_name(reading, run.letters[i]);
    } else {
        labial_words_spell(reading->model, run.letters, run.count, reading->word);
    }
}

/* ---- The caller's own words ------------------------------------------------------------------------------------- */

/* Whether an own word stands here; moves behind it. */
static int takes_own(labial_words_place_t *here, const char *word)
{
    size_t i;
    labial_words_place_t next = *here;
    for (i = 0; word[i] != '\0'; i++)
        if (here->start + i >= here->size ||
            labial_words_small_letter((unsigned char)word[i]) != labial_words_small_letter(here->text[here->start + i]))
            return 0;
    if (i == 0u)
        return 0;
    while (next.code != TEXT_END && next.start < here->start + i)
        labial_words_advance(&next);
    if ((labial_words_is_inside((unsigned char)word[i - 1u]) || (unsigned char)word[i - 1u] >= 0x80u) &&
        (labial_words_is_inside(next.code) ||
         (next.code == '\'' && labial_words_is_latin(labial_words_following(&next)))))
        return 0; /* it goes on */
    *here = next;
    return 1;
}

/* Reads an own word, if there is one. */
static int reads_own(labial_words_reading_t *reading, const labial_words_own_t *own)
{
    const labial_words_place_t first = reading->here;
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
static void skip_tag(labial_words_place_t *here)
{
    const unsigned end = here->code == '[' ? ']' : '>';
    while (here->code != TEXT_END && here->code != end)
        labial_words_advance(here);
}

/* Says a sign. */
static void read_sign(labial_words_reading_t *reading)
{
    unsigned number;
    for (number = 0; number < 5u; number++) {
        const char *const sign = labial_words_listed(signs, number);
        if ((unsigned char)*sign == reading->here.code)
            labial_words_say(reading, sign + 1, reading->here.characters - 1u);
    }
}

int labial_words_read(const labial_words_model_t *model, const labial_words_own_t *own, const char *text, size_t size,
                      labial_word_t *word)
{
    labial_words_reading_t reading;
    labial_words_place_t *const here = &reading.here;
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
    labial_words_advance(here);
    while (here->code != TEXT_END) {
        const unsigned code = here->code;
        is_foreign |= code == FOREIGN;
        if (!labial_words_is_inside(before) && reads_own(&reading, own)) {
            before = NOTHING;
            continue;
        }
        before = code;
        if (labial_words_is_latin(code)) {
            read_letters(&reading);
        } else if (labial_words_is_decimal(code)) {
            labial_words_read_digits(&reading);
        } else {
            if (code == '[' || code == '<')
                skip_tag(here);
            else
                read_sign(&reading);
            labial_words_advance(here);
        }
    }
    word->characters = (uint8_t)here->characters;
    word->kind = word->count > 0u ? LABIAL_WORDS_READ : is_foreign ? LABIAL_WORDS_UNKNOWN : LABIAL_WORDS_SILENT;
    return LABIAL_OK;
}
