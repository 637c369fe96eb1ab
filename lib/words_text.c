/*
 * words_text.c - what is said where a text stands: signs, addresses, stage directions, the caller's own words; letters
 * and numbers have files of their own. The rules are those of labial/words.h; export/labial/words/text.py is their
 * reference.
 */
#include "labial/words.h"

#include <string.h>

#include "labial/labial.h"
#include "words_parts.h"

/* Words of a tag or stage direction, at most. */
#define DIRECTION 8u

/* Letters of the longest word that is said, "representative", and of the longest ending. */
#define LONGEST_SAID 18u

/* Signs that are said; a blank separates spoken words. The last ones are SIGN_SQUARE, SIGN_TIMES, SIGN_MINUS,
 * SIGN_DIVIDED, SIGN_CUBE, SIGN_MOST, SIGN_LEAST, SIGN_ABOUT and SIGN_EITHER. Before a number others are said, too. */
static const char signs[] = "&and\0@at\0%percent\0+plus\0=equals\0\11squared\0\12times\0\13minus\0\14divided by\0"
                            "\15cubed\0\16less than or equal to\0\17greater than or equal to\0\20about\0"
                            "\21plus or minus\0";
static const char before_number[] = "#number\0<less than\0>greater than\0~about\0^to the power of\0";

/* Signs that are said within an address. */
static const char joints[] = "/slash\0-dash\0_underscore\0:colon\0";

/* Stage directions: the beginnings of verbs, behind which s, es or ing stands; words that stand alone; and words in -s
 * that are no verbs. */
static const char verbs[] =
    "applaud\0beam\0blink\0blush\0breath\0burp\0chuckl\0clap\0clapp\0clear\0cough\0cri\0cry\0exhal\0frown\0gasp\0"
    "giggl\0glanc\0grin\0grinn\0groan\0gulp\0hum\0humm\0inhal\0laugh\0mumbl\0mutter\0nod\0nodd\0paus\0pout\0scream\0"
    "shout\0shrug\0shrugg\0sigh\0sing\0smil\0smirk\0snap\0snapp\0snicker\0sniff\0snort\0sob\0sobb\0swallow\0wav\0"
    "whisper\0whistl\0wink\0yawn\0yell\0";
static const char alone[] =
    "applause\0beat\0blush\0breath\0chuckle\0clap\0cough\0cry\0gasp\0giggle\0grin\0groan\0gulp\0"
    "hum\0laugh\0laughter\0mumble\0music\0mutter\0nod\0pause\0quietly\0scream\0shout\0shrug\0sigh\0silence\0smile\0"
    "smirk\0sniff\0snort\0sob\0softly\0whisper\0whistle\0wink\0yawn\0yell\0";
static const char not_verbs[] = "always\0perhaps\0sometimes\0things\0this\0does\0yours\0ours\0theirs\0hers\0towards\0"
                                "besides\0";
#define LONGEST_VERB 12u

/* ---- What is said ----------------------------------------------------------------------------------------------- */

/* Says one word of small letters with an ending: -th or -s, before which -y becomes -ie. */
static void say_word(labial_words_reading_t *reading, const char *word, size_t size, unsigned ending,
                     unsigned character)
{
    labial_words_letter_t letters[LONGEST_SAID];
    unsigned count = 0;
    memset(letters, 0, sizeof letters);
    for (; count < LONGEST_SAID - 4u; count++) {
        if (count >= size)
            break;
        letters[count].letter = (uint8_t)(word[count] == '\'' ? 27 : word[count] - 'a' + 1);
    }
    if (ending != SAID_PLAIN && word[count - 1u] == 'y') {
        letters[count - 1u].letter = 'i' - 'a' + 1;
        letters[count++].letter = 'e' - 'a' + 1;
    }
    if ((ending & SAID_ORDINAL) != 0u) {
        letters[count++].letter = 't' - 'a' + 1;
        letters[count++].letter = 'h' - 'a' + 1;
    }
    if ((ending & SAID_PLURAL) != 0u)
        letters[count++].letter = 's' - 'a' + 1;
    for (size = 0; size < count; size++)
        letters[size].character = (uint8_t)character;
    labial_words_spell(reading->model, letters, count, reading->word);
}

void labial_words_say(labial_words_reading_t *reading, const char *words, unsigned ending, unsigned character)
{
    while (*words != '\0') {
        size_t size = 0;
        while (words[size] > ' ')
            size++;
        say_word(reading, words, size, words[size] == '\0' ? ending : (unsigned)SAID_PLAIN, character);
        words += size;
        if (*words == ' ')
            words++;
    }
}

void labial_words_say_name(labial_words_reading_t *reading, const char *name, int is_plural, unsigned character)
{
    const char *first = name;
    size_t size;
    for (size = 0; name[size] != '\0'; size++)
        if (name[size] == '|' && is_plural)
            first = name + size + 1;
    while (*first > '\0' && *first != '|') {
        for (size = 0; first[size] >= 'a' && first[size] <= 'z'; size++)
            ;
        say_word(reading, first, size, first[size] == '_' && is_plural ? SAID_PLURAL : SAID_PLAIN, character);
        first += size;
        while (*first == '_' || *first == ' ')
            first++;
    }
}

void labial_words_keep_tail(labial_words_reading_t *reading, unsigned first)
{
    reading->context->tail = (uint8_t)(reading->word->count - first);
    reading->is_tail_here = 1;
}

void labial_words_take_back(labial_words_reading_t *reading)
{
    labial_words_context_t *context = reading->context;
    if (!reading->is_tail_here)
        context->dropped = context->tail;
    else
        reading->word->count = (uint8_t)(reading->word->count - context->tail);
    context->tail = 0;
}

const char *labial_words_listed(const char *list, unsigned number)
{
    for (; number > 0u; list++)
        number -= *list == '\0';
    return list;
}

void labial_words_say_here(labial_words_reading_t *reading, const char *words)
{
    labial_words_say(reading, words, SAID_PLAIN, reading->here.characters - 1u);
}

/* What is said of a sign in a list, or null. */
const char *labial_words_said_of(const char *list, unsigned sign)
{
    for (; *list != '\0'; list = labial_words_listed(list, 1))
        if ((unsigned char)*list == sign)
            return list + 1;
    return NULL;
}

void labial_words_correct(labial_words_reading_t *reading, unsigned character)
{
    labial_words_take_back(reading);
    labial_words_say(reading, labial_words_listed(labial_words_dates, reading->context->currency), SAID_PLAIN,
                     character);
}

/* What was said last matters no more; returns what it was. */
unsigned labial_words_forget(labial_words_reading_t *reading)
{
    const unsigned after = reading->context->after;
    reading->context->after = AFTER_NOTHING;
    return after;
}

/* Whether `count` letters are a text of a list, whose letters may be small. */
static int is_text(const char *letters, unsigned count, const char *text)
{
    unsigned i;
    for (i = 0; i < count; i++)
        if (text[i] != letters[i] && text[i] - ('a' - 'A') != letters[i])
            return 0;
    return text[count] == '\0';
}

/* Which of the texts of a list, `step` of which belong together, letters are; or -1. */
int labial_words_find(const char *letters, unsigned count, const char *list, unsigned step)
{
    int number;
    for (number = 0; *list != '\0'; number++, list = labial_words_listed(list, step))
        if (is_text(letters, count, list))
            return number;
    return -1;
}

int labial_words_is_listed(const char *letters, unsigned count, const char *list)
{
    return labial_words_find(letters, count, list, 1) >= 0;
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

/* Whether an own word stands behind the current character: the number of a sum, in another language. */
static int has_own_behind(const labial_words_place_t *here, const labial_words_own_t *own)
{
    labial_words_place_t next = *here;
    unsigned i;
    labial_words_advance(&next);
    for (i = 0; own && i < own->count; i++)
        if (takes_own(&next, own->entries[i].word))
            return 1;
    return 0;
}

/* ---- Signs ------------------------------------------------------------------------------------------------------ */

/* Whether a stage direction stands in the brackets or asterisks that begin here. In square ones other words may follow
 * it. */
static int is_direction(const labial_words_place_t *here, unsigned closing)
{
    labial_words_place_t next = *here;
    char word[LONGEST_VERB + 1u];
    unsigned count = 0, capitals = 0;
    const char *verb;
    labial_words_advance(&next);
    for (; labial_words_is_latin(next.code); labial_words_advance(&next)) {
        if (count >= LONGEST_VERB)
            return 0;
        capitals += (unsigned)labial_words_is_capital(next.code);
        word[count++] = (char)(labial_words_small_letter(next.code) - ('a' - 'A'));
    }
    word[count] = '\0';
    if (count == 0u || labial_words_is_inside(next.code))
        return 0;
    if ((next.code == closing || closing == ']') && labial_words_is_listed(word, count, alone))
        return 1;
    for (verb = verbs; *verb != '\0'; verb = labial_words_listed(verb, 1)) {
        unsigned i;
        for (i = 0; i < count && verb[i] != '\0' && verb[i] - ('a' - 'A') == word[i]; i++)
            ;
        if (verb[i] == '\0' && i < count && labial_words_is_listed(word + i, count - i, "s\0es\0ing\0"))
            return 1;
    }
    return closing == '*' && labial_words_is_blank(next.code) && capitals == 0u && count > 3u &&
           word[count - 1u] == 'S' && word[count - 2u] != 'S' && !labial_words_is_listed(word, count, not_verbs);
}

/* Whether what a square bracket begins is silent: all but the text of a link, behind which an address or the number of
 * one stands. Where the end is not in sight, since words come one by one, a first word with a capital and small letters
 * is the text of a link, unless it is a stage direction. */
static int is_tag(const labial_words_place_t *here)
{
    labial_words_place_t next = *here, word;
    int has_letters = 0;
    labial_words_advance(&next);
    word = next;
    if (labial_words_is_blank(next.code))
        return 0;
    for (; next.code != ']' && next.code != TEXT_END; labial_words_advance(&next)) {
        if (next.code == '[')
            return 0;
        has_letters |= labial_words_is_inside(next.code) && !labial_words_is_decimal(next.code);
    }
    labial_words_advance(&next);
    if (next.code == '(' || (next.code == '[' && (labial_words_following(&next) == ']' ||
                                                  labial_words_is_decimal(labial_words_following(&next)))))
        return !has_letters;
    if (!labial_words_is_capital(word.code))
        return 1;
    do
        labial_words_advance(&word);
    while (word.code >= 'a' && word.code <= 'z');
    return !labial_words_is_blank(word.code) || is_direction(here, ']');
}

/* The character that ends the tag or stage direction that begins here, or the address of a link; 0 if none does. */
static unsigned tag_closing(const labial_words_place_t *here)
{
    const unsigned code = here->code, follows = labial_words_following(here);
    if (code == '[')
        return is_tag(here) ? ']' : 0u;
    if (code == ']')
        return follows == '(' ? ')' : 0u;
    if (code == '<')
        return labial_words_is_latin(follows) || follows == '/' || follows == '!' || follows == '?' ? '>' : 0u;
    if ((code == '(' || code == '*') && here->before != '*' && is_direction(here, code == '(' ? ')' : '*'))
        return code == '(' ? ')' : '*';
    return 0;
}

static void open_tag(labial_words_reading_t *reading, unsigned closing)
{
    (void)labial_words_forget(reading);
    reading->context->closing = (uint8_t)closing;
    reading->context->left = DIRECTION;
    labial_words_advance(&reading->here);
}

static void read_degrees(labial_words_reading_t *reading, unsigned after)
{
    labial_words_place_t next = reading->here;
    labial_words_say_here(reading, after == AFTER_ONE ? "degree" : "degrees");
    labial_words_advance(&next);
    if ((next.code == 'C' || next.code == 'F') && !labial_words_is_inside(labial_words_following(&next))) {
        reading->here = next;
        labial_words_say_here(reading, next.code == 'C' ? "celsius" : "fahrenheit");
    }
}

/* Reads a point, slash, hyphen, underscore or colon: a part of an address, or a minus. */
static void read_joint(labial_words_reading_t *reading)
{
    labial_words_place_t *here = &reading->here, next = *here, third;
    const unsigned before = here->before;
    labial_words_advance(&next);
    third = next;
    labial_words_advance(&third);
    if (here->code == '.' && (before == ' ' ? labial_words_is_latin(next.code)
                                            : labial_words_is_inside(before) && next.code >= 'a' && next.code <= 'z')) {
        labial_words_say_here(reading, "dot");
        reading->is_address = 1;
    } else if (here->code == ':' && labial_words_is_inside(before) && next.code == '/' && third.code == '/') {
        labial_words_say_here(reading, "colon slash slash");
        reading->is_address = 1;
        *here = third;
    } else if (here->code == '-' && (labial_words_is_decimal(next.code) || labial_words_is_sum(&next)) &&
               (before == ' ' || before == '(')) {
        labial_words_say_here(reading, "minus");
    } else if (reading->is_address && labial_words_is_inside(next.code) && here->code != '.') {
        labial_words_say_here(reading, labial_words_said_of(joints, here->code));
    }
}

/* Reads a double quotation mark: inches behind a number, unless a quotation has begun with one. */
static void read_quotation(labial_words_reading_t *reading)
{
    labial_words_context_t *const context = reading->context;
    const labial_words_place_t *const here = &reading->here;
    const int begins = !labial_words_is_blank(labial_words_following(here)) && !labial_words_is_inside(here->before);
    if (labial_words_is_decimal(here->before) && context->quoted == 0u) {
        labial_words_say_here(reading, "inch");
        context->after = AFTER_UNIT;
    }
    context->quoted = (uint8_t)begins;
}

/* Says a sign as it is read behind what came `after`; stays on it, or on its last character. */
static void say_sign(labial_words_reading_t *reading, unsigned after)
{
    labial_words_place_t *here = &reading->here;
    const unsigned code = here->code, follows = labial_words_following(here);
    const char *const said = labial_words_said_of(signs, code);
    const char *const number = labial_words_is_decimal(follows) ? labial_words_said_of(before_number, code) : NULL;
    const int currency = labial_words_currency(code), is_counted = after == AFTER_ONE || after == AFTER_NUMBER;
    if (code == SIGN_DEGREE) {
        read_degrees(reading, after);
    } else if (code == '/' && (after == AFTER_UNIT || after == AFTER_SUM) && labial_words_is_latin(follows)) {
        labial_words_say_here(reading, "per");
        reading->context->after = AFTER_PER;
    } else if (code == '.' || code == '/' || code == '-' || code == '_' || code == ':') {
        read_joint(reading);
    } else if (code == SIGN_CENT && is_counted) {
        labial_words_say_here(reading, after == AFTER_NUMBER ? "cents" : "cent");
    } else if (currency >= 0 && is_counted) {
        labial_words_say_name(reading, labial_words_currency_name((unsigned)currency), after == AFTER_NUMBER,
                              here->characters - 1u);
    } else if (currency >= 0 && labial_words_is_blank(follows)) {
        reading->context->after = AFTER_MONEY;
        reading->context->currency = (uint8_t)currency;
    } else if (number) {
        labial_words_say_here(reading, number);
    } else if (code == '#' && labial_words_is_latin(here->before) && !labial_words_is_inside(follows)) {
        labial_words_say_here(reading, "sharp");
    } else if (code == '"') {
        read_quotation(reading);
    } else if (said) {
        labial_words_say_here(reading, said);
    }
}

/* Reads the hyphen and the unit of "a 5-km run"; whether there are any. */
static int reads_unit(labial_words_reading_t *reading)
{
    const labial_words_place_t first = reading->here;
    labial_words_advance(&reading->here);
    if (labial_words_is_latin(reading->here.code) && labial_words_is_latin(labial_words_following(&reading->here)) &&
        labial_words_read_unit(reading, AFTER_ONE, 1))
        return 1;
    reading->here = first;
    return 0;
}

/* Reads what is no letter and no digit. */
static void read_sign(labial_words_reading_t *reading)
{
    labial_words_place_t *here = &reading->here;
    const unsigned code = here->code, closing = tag_closing(here);
    unsigned after;
    if (closing != 0u) {
        open_tag(reading, closing);
        return;
    }
    if (reading->context->after >= AFTER_DATE && !reading->is_address && here->before != ' ' &&
        (code == ',' || code == '-' || code == '/')) {
        reading->context->named = 0;
        labial_words_advance(here);
        return;
    }
    after = labial_words_forget(reading);
    reading->context->tail = reading->context->named = 0;
    if ((after == AFTER_CALL || after == AFTER_PHONE) && (code == '(' || code == '+' || code == ')' || code == ':'))
        reading->context->after = (uint8_t)after;
    if (code != '-')
        reading->has_letters = 0;
    else if ((after == AFTER_ONE || after == AFTER_NUMBER) && reads_unit(reading))
        return;
    if (labial_words_has_fraction(here) && !labial_words_is_inside(here->before)) {
        reading->context->after = AFTER_NUMBER;
        labial_words_read_fraction(reading);
        return;
    }
    say_sign(reading, after);
    labial_words_advance(here);
    if (code == '%')
        (void)labial_words_read_range(reading);
}

/* ---- The whole -------------------------------------------------------------------------------------------------- */

/* A blank, or the end of the text. */
static void end_word(labial_words_reading_t *reading)
{
    labial_words_context_t *const context = reading->context;
    reading->is_address = reading->has_letters = 0;
    if (context->closing != 0u && --context->left == 0u)
        context->closing = 0;
}

/* Reads what is at the current place, and moves behind it. */
static void read_next(labial_words_reading_t *reading, const labial_words_own_t *own)
{
    labial_words_place_t *const here = &reading->here;
    labial_words_context_t *const context = reading->context;
    if (context->closing != 0u || here->code == ' ') {
        if (here->code == ' ')
            end_word(reading);
        else if (here->code == context->closing)
            context->closing = here->code == ']' && labial_words_following(here) == '(' ? ')' : 0;
        labial_words_advance(here);
    } else if (!labial_words_is_inside(here->before) && reads_own(reading, own)) {
        (void)labial_words_forget(reading);
        context->named = 0;
        here->before = NO_CHARACTER;
    } else if (labial_words_is_latin(here->code)) {
        labial_words_read_letters(reading);
    } else if (labial_words_is_decimal(here->code)) {
        labial_words_read_number(reading);
    } else if (labial_words_is_sum(here) && !has_own_behind(here, own)) {
        labial_words_read_sum(reading);
    } else {
        read_sign(reading);
    }
}

int labial_words_read_next(const labial_words_model_t *model, const labial_words_own_t *own,
                           labial_words_context_t *context, const char *text, size_t size, labial_word_t *word)
{
    labial_words_reading_t reading;
    labial_words_place_t *const here = &reading.here;
    unsigned is_foreign = 0;
    if (!model || !context || !text || !word)
        return LABIAL_ERROR_NULL;
    if (model->format != LABIAL_WORDS_FORMAT)
        return LABIAL_ERROR_VERSION;
    memset(&reading, 0, sizeof reading);
    memset(word, 0, sizeof *word);
    context->dropped = 0;
    reading.model = model;
    reading.word = word;
    reading.context = context;
    labial_words_place(here, text, size, 0);
    while (here->code != TEXT_END) {
        is_foreign |= here->code == FOREIGN;
        read_next(&reading, own);
    }
    end_word(&reading);
    word->characters = (uint8_t)here->characters;
    word->kind = word->count > 0u ? LABIAL_WORDS_READ : is_foreign ? LABIAL_WORDS_UNKNOWN : LABIAL_WORDS_SILENT;
    return LABIAL_OK;
}

int labial_words_read(const labial_words_model_t *model, const labial_words_own_t *own, const char *text, size_t size,
                      labial_word_t *word)
{
    labial_words_context_t context;
    memset(&context, 0, sizeof context);
    return labial_words_read_next(model, own, &context, text, size, word);
}
