/*
 * words_text.c - what is said where a text stands: letters, abbreviations, signs, addresses, stage directions. The rules
 * are those of labial/words.h; export/labial/words/text.py is their reference.
 */
#include "labial/words.h"

#include <string.h>

#include "labial/labial.h"
#include "words_parts.h"

/* Words of a tag or stage direction, at most. */
#define DIRECTION 8u

/* Names of letters, as words that the trees read so; with an s where that is more than an added Z. */
static const char letter_names[] = "ay\0bee\0see\0dee\0e\0eff\0gee\0aitch\0eye\0jay\0kay\0ell\0em\0en\0oh\0pee\0cue\0"
                                   "are\0ess\0tee\0you\0vee\0double you\0ex\0why\0zee\0";
static const char plural_names[] = "h\0aitches\0s\0esses\0x\0exes\0";

/* Letters of the longest word that is said: "approximately". */
#define LONGEST_SAID 16u

/* Signs that are said; a blank separates spoken words. */
static const char signs[] = "&and\0@at\0%percent\0+plus\0=equals\0";

/* Signs that are said within an address. */
static const char joints[] = "/slash\0-dash\0_underscore\0:colon\0";

/* Abbreviations by their first letter, each with what it stands for. */
static const char *const meanings[] = {
    "approx\0approximately\0ave\0avenue\0ascii\0askey\0",
    "blvd\0boulevard\0",
    "capt\0captain\0cmos\0sea moss\0",
    "dr\0doctor\0dept\0department\0",
    "etc\0etcetera\0edu\0ee dee you\0",
    "fi\0fie\0ftp\0eff tee pee\0",
    "govt\0government\0gnu\0new\0",
    "http\0aitch tee tee pee\0https\0aitch tee tee pee ess\0hvac\0aitch vack\0hipaa\0hippa\0",
    "",
    "jr\0junior\0jpeg\0jay peg\0jpg\0jay peg\0json\0jason\0",
    "",
    "ltd\0limited\0lt\0lieutenant\0",
    "mr\0mister\0mrs\0missiz\0ms\0mizz\0mt\0mount\0mpeg\0em peg\0",
    "",
    "",
    "prof\0professor\0ph\0pee aitch\0phd\0pee aitch dee\0",
    "",
    "rd\0road\0",
    "st\0saint\0sr\0senior\0sgt\0sergeant\0",
    "",
    "",
    "vs\0versus\0",
    "wi\0why\0wifi\0why fie\0www\0double you double you double you\0",
    "",
    "yaml\0yamel\0",
    "",
};

/* Months and days in short, and what they stand for; the first DATE_MONTHS are months. */
#define DATE_MONTHS 12
static const char dates[] =
    "jan\0january\0feb\0february\0mar\0march\0apr\0april\0jun\0june\0jul\0july\0aug\0august\0sep\0september\0"
    "sept\0september\0oct\0october\0nov\0november\0dec\0december\0mon\0monday\0tue\0tuesday\0tues\0tuesday\0"
    "wed\0wednesday\0thu\0thursday\0thur\0thursday\0thurs\0thursday\0fri\0friday\0";

static const char scales[] = "hundred\0thousand\0million\0billion\0trillion\0";

/* Units behind a number; behind a blank only the second list. */
static const char attached_units[] = "M\0million\0bn\0billion\0in\0inch|inches\0A\0amp_\0C\0degree_ celsius\0"
                                     "F\0degree_ fahrenheit\0";
static const char units[] =
    "km\0kilometer_\0m\0meter_\0cm\0centimeter_\0mm\0millimeter_\0nm\0nanometer_\0um\0micrometer_\0kg\0kilogram_\0"
    "g\0gram_\0mg\0milligram_\0ug\0microgram_\0lb\0pound_\0lbs\0pound_\0oz\0ounce_\0ft\0foot|feet\0yd\0yard_\0"
    "mi\0mile_\0mph\0mile_ per hour\0kph\0kilometer_ per hour\0L\0liter_\0l\0liter_\0ml\0milliliter_\0"
    "mL\0milliliter_\0cl\0centiliter_\0dl\0deciliter_\0gal\0gallon_\0s\0second_\0sec\0second_\0secs\0second_\0"
    "ms\0millisecond_\0us\0microsecond_\0ns\0nanosecond_\0min\0minute_\0mins\0minute_\0h\0hour_\0hr\0hour_\0"
    "hrs\0hour_\0Hz\0hertz\0kHz\0kilohertz\0MHz\0megahertz\0GHz\0gigahertz\0kB\0kilobyte_\0KB\0kilobyte_\0"
    "MB\0megabyte_\0GB\0gigabyte_\0TB\0terabyte_\0kbps\0kilobit_ per second\0Mbps\0megabit_ per second\0"
    "Gbps\0gigabit_ per second\0W\0watt_\0kW\0kilowatt_\0MW\0megawatt_\0GW\0gigawatt_\0Wh\0watt hour_\0"
    "kWh\0kilowatt hour_\0V\0volt_\0mV\0millivolt_\0kV\0kilovolt_\0mA\0milliamp_\0mAh\0milliamp hour_\0dB\0decibel_\0"
    "px\0pixel_\0cal\0calorie_\0kcal\0kilocalorie_\0rpm\0are pee em\0bpm\0bee pee em\0fps\0eff pee ess\0"
    "mpg\0mile_ per gallon\0EUR\0euro_\0GBP\0pound_\0USD\0you ess dollar_\0";

/* Capitals that are read letter by letter although a word could look so, words of two letters, of three that begin with
 * a vowel and others that do not look like words, and words unless the word before is not in capitals. */
static const char spelt_words[] =
    "VIP\0MIT\0SOS\0POW\0SAP\0SAT\0GED\0RIP\0SEC\0GOP\0DOD\0LAX\0LED\0DEA\0NEA\0GRE\0SLA\0COO\0NIH\0ASAP\0UCLA\0USDA\0"
    "USAF\0USPS\0NYSE\0IMHO\0AFAIK\0MOU\0SME\0STI\0TWA\0CLI\0COD\0DOB\0GIS\0VOD\0LIDL\0NES\0CIS\0UTEP\0HBCU\0ICAO\0";
static const char short_words[] =
    "AN\0AS\0AT\0BE\0BY\0DO\0GO\0HE\0HI\0IF\0IN\0IS\0ME\0MY\0NO\0OF\0OH\0ON\0OR\0OX\0SO\0TO\0UP\0WE\0YO\0HA\0AH\0UH\0"
    "UM\0EH\0ACE\0ACT\0ADD\0AGE\0AGO\0AHA\0AID\0AIM\0AIR\0ALL\0AND\0ANT\0ANY\0APP\0ARC\0ARE\0ARM\0ART\0ASH\0ASK\0ATE\0"
    "AXE\0EAR\0EAT\0EGG\0END\0EVE\0EYE\0ICE\0ILL\0INK\0INN\0ITS\0OAK\0ODD\0OFF\0OIL\0OLD\0ONE\0OUR\0OUT\0OWE\0OWN\0"
    "UGH\0USE\0GYM\0VIA\0";
static const char shouted_words[] = "AM\0IT\0US\0WHO\0";

/* How words begin and end, and vowels that stand together in them; at the end of three letters the second list. */
static const char onsets[] =
    "BL\0BR\0CH\0CL\0CR\0DR\0DW\0FL\0FR\0GH\0GL\0GR\0KN\0PH\0PL\0PR\0SC\0SH\0SK\0SL\0SM\0SN\0SP\0"
    "ST\0SQ\0SW\0TH\0TR\0TW\0WH\0WR\0SCR\0SHR\0SPL\0SPR\0STR\0THR\0";
static const char codas[] =
    "B\0C\0D\0F\0G\0H\0K\0L\0M\0N\0P\0R\0S\0T\0W\0X\0Z\0BB\0BT\0CH\0CK\0CT\0DD\0FF\0FT\0GG\0GH\0GN\0LD\0LF\0LK\0LL\0"
    "LM\0LP\0LT\0MB\0MN\0MP\0NG\0NK\0NN\0NT\0ND\0PH\0PT\0RB\0RC\0RD\0RF\0RK\0RL\0RM\0RN\0RP\0RT\0SH\0SK\0SM\0SP\0SS\0"
    "ST\0TH\0TT\0WD\0WL\0WN\0XT\0DTH\0FTH\0GHT\0LDT\0LTH\0NCH\0NTH\0PTH\0RCH\0RLD\0RNT\0RSH\0RST\0RTH\0TCH\0XTH\0DST\0"
    "HN\0PP\0RR\0SC\0";
static const char vowel_runs[] = "AI\0AU\0AY\0EA\0EE\0EI\0EU\0EY\0IA\0IE\0IO\0OA\0OE\0OI\0OO\0OU\0OY\0UA\0UE\0UI\0UO\0"
                                 "UY\0YE\0YI\0EO\0AO\0UIE\0UEE\0EYE\0OYA\0AYE\0IOU\0";
static const char last_runs[] = "AY\0EA\0EE\0EY\0IE\0OE\0OO\0OU\0OY\0UE\0UY\0";

/* Stage directions: the beginnings of verbs, behind which s, es or ing stands; words that stand alone; and words in -s
 * that are no verbs. */
static const char verbs[] =
    "applaud\0beam\0blink\0blush\0breath\0burp\0chuckl\0clap\0clear\0cough\0cr\0cri\0exhal\0frown\0gasp\0giggl\0glanc\0"
    "grin\0groan\0gulp\0hum\0inhal\0laugh\0mumbl\0mutter\0nod\0nodd\0paus\0pout\0scream\0shout\0shrug\0sigh\0sing\0"
    "smil\0smirk\0snap\0snapp\0snicker\0sniff\0snort\0sob\0sobb\0swallow\0wav\0whisper\0whistl\0wink\0yawn\0yell\0";
static const char alone[] =
    "applause\0beat\0blush\0breath\0chuckle\0clap\0cough\0cry\0gasp\0giggle\0grin\0groan\0gulp\0"
    "hum\0laugh\0laughter\0mumble\0music\0mutter\0nod\0pause\0quietly\0scream\0shout\0shrug\0sigh\0silence\0smile\0"
    "smirk\0sniff\0snort\0sob\0softly\0whisper\0whistle\0wink\0yawn\0yell\0";
static const char not_verbs[] = "always\0perhaps\0sometimes\0things\0this\0does\0yours\0ours\0theirs\0hers\0towards\0"
                                "besides\0";
#define LONGEST_VERB 12u

/* ---- What is said ----------------------------------------------------------------------------------------------- */

/* Says one word of small letters; with SAID_PLURAL an s behind it, or -ies for -y. */
static void say_word(labial_words_reading_t *reading, const char *word, size_t size, unsigned ending,
                     unsigned character)
{
    labial_words_letter_t letters[LONGEST_SAID];
    unsigned count = 0;
    memset(letters, 0, sizeof letters);
    for (; count < size && count < LONGEST_SAID - 3u; count++)
        letters[count].letter = (uint8_t)(word[count] == '\'' ? 27 : word[count] - 'a' + 1);
    if (ending == SAID_PLURAL && count > 0u) {
        if (word[count - 1u] == 'y') {
            letters[count - 1u].letter = 'i' - 'a' + 1;
            letters[count++].letter = 'e' - 'a' + 1;
        }
        letters[count++].letter = 's' - 'a' + 1;
    }
    for (size = 0; size < count; size++)
        letters[size].character = (uint8_t)character;
    if (count > 0u)
        labial_words_spell(reading->model, letters, count, reading->word);
}

void labial_words_say(labial_words_reading_t *reading, const char *words, unsigned ending, unsigned character)
{
    while (*words != '\0') {
        size_t size = 0;
        while (words[size] > ' ')
            size++;
        say_word(reading, words, size, words[size] == '\0' ? ending : SAID_PLAIN, character);
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
        for (size = 0; (first[size] >= 'a' && first[size] <= 'z') || first[size] == '\''; size++)
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
    else if (context->tail <= reading->word->count)
        reading->word->count = (uint8_t)(reading->word->count - context->tail);
    context->tail = 0;
}

const char *labial_words_listed(const char *list, unsigned number)
{
    for (; number > 0u; list++)
        number -= *list == '\0';
    return list;
}

static void say(labial_words_reading_t *reading, const char *words)
{
    labial_words_say(reading, words, SAID_PLAIN, reading->here.characters - 1u);
}

/* What is said of a sign in a list, or null. */
static const char *said_of(const char *list, unsigned sign)
{
    for (; *list != '\0'; list = labial_words_listed(list, 1))
        if ((unsigned char)*list == sign)
            return list + 1;
    return NULL;
}

/* What was said last matters no more; returns what it was. */
static unsigned forget(labial_words_reading_t *reading)
{
    const unsigned after = reading->context->after;
    reading->context->after = AFTER_NOTHING;
    return after;
}

/* ---- Letters ---------------------------------------------------------------------------------------------------- */

/* Letters that stand together. */
typedef struct {
    labial_words_letter_t letters[LABIAL_WORDS_LETTERS];
    char capitals[12]; /* the first eleven, in capitals, the apostrophe too */
    unsigned count;
    unsigned small;  /* of them, small letters and apostrophes */
    unsigned before; /* the character before it */
    int is_title;    /* a capital, and small letters behind it */
} run_t;

static void say_letter(labial_words_reading_t *reading, labial_words_letter_t letter)
{
    labial_words_say(reading, labial_words_listed(letter_names, letter.letter - 1u), SAID_PLAIN, letter.character);
}

/* Takes the letters that belong together from a letter on, up to a capital behind a small letter. */
static void take_run(labial_words_place_t *here, run_t *run)
{
    unsigned before = TEXT_END;
    memset(run, 0, sizeof *run);
    run->before = here->before;
    while (run->count < LABIAL_WORDS_LETTERS) {
        const unsigned code = here->code;
        const int is_inner = code == '\'' && labial_words_is_latin(labial_words_following(here));
        if (!is_inner && !labial_words_is_latin(code))
            break;
        if (labial_words_is_capital(code) && before > 'Z')
            break;
        if (run->count < sizeof run->capitals - 1u)
            run->capitals[run->count] = (char)(is_inner ? code : labial_words_small_letter(code) - ('a' - 'A'));
        run->letters[run->count].letter = (uint8_t)(is_inner ? 27u : labial_words_small_letter(code) - 'a' + 1u);
        run->letters[run->count].sound = (uint8_t)(is_inner ? 0u : labial_words_accented(here));
        run->letters[run->count].character = (uint8_t)(here->characters - 1u);
        run->small += !labial_words_is_capital(code);
        run->is_title = run->count == 0u ? labial_words_is_capital(code) : run->is_title && run->small == run->count;
        run->count++;
        before = code;
        labial_words_advance(here);
    }
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
static int find_text(const char *letters, unsigned count, const char *list, unsigned step)
{
    int number;
    for (number = 0; *list != '\0'; number++, list = labial_words_listed(list, step))
        if (is_text(letters, count, list))
            return number;
    return -1;
}

static int find_run(const run_t *run, const char *list, unsigned step)
{
    return run->count < sizeof run->capitals ? find_text(run->capitals, run->count, list, step) : -1;
}

static int is_in(const char *letters, unsigned count, const char *list)
{
    return find_text(letters, count, list, 1) >= 0;
}

/* ---- Capitals --------------------------------------------------------------------------------------------------- */

static int is_vowel(const char *letters, unsigned place)
{
    const char letter = letters[place];
    return letter == 'A' || letter == 'E' || letter == 'I' || letter == 'O' || letter == 'U' ||
           (letter == 'Y' && place > 0u);
}

/* Whether three to five capitals look like a word: as words of English begin and end, with vowels that stand together in
 * them. */
static int is_pronounceable(const char *letters, unsigned count)
{
    unsigned first = 0, last = count, begin = 0, i, is_other = 0;
    while (first < count && !is_vowel(letters, first))
        first++;
    while (last > 0u && !is_vowel(letters, last - 1u))
        last--;
    if (count < 3u || first == count || (count == 3u && first == 0u) || (first > 1u && !is_in(letters, first, onsets)))
        return 0;
    if (last < count && !is_in(letters + last, count - last, codas) &&
        !(count - last > 1u && letters[count - 1u] == 'S' && is_in(letters + last, count - last - 1u, codas)))
        return 0;
    for (i = 0; i < count; i++) {
        is_other |= is_vowel(letters, i) && letters[i] != 'Y';
        if (i > 0u && is_vowel(letters, i) && !is_vowel(letters, i - 1u))
            begin = i;
        if (is_vowel(letters, i) && (i + 1u == count || !is_vowel(letters, i + 1u)) && i > begin &&
            !is_in(letters + begin, i + 1u - begin, count == 3u ? last_runs : vowel_runs))
            return 0;
    }
    return is_other || last == count;
}

/* How many letters at the beginning of a run are capitals that are read one by one; behind them there is nothing, an s
 * or 's. */
static unsigned spelt_letters(const run_t *run, unsigned follows, unsigned shouting)
{
    const char *const letters = run->capitals;
    unsigned count = run->count;
    if (count == 1u)
        return (letters[0] != 'A' && letters[0] != 'I') ||
               (letters[0] == 'A' && run->small == 0u &&
                (labial_words_is_decimal(run->before) || run->before == '&' || run->before == '+' ||
                 labial_words_is_decimal(follows) || follows == '&' || follows == '+' || follows == '-'));
    if (run->small > 0u && run->letters[count - 1u].letter == 19u) /* s */
        count -= run->small;
    else if (run->small > 0u)
        return 0;
    if (run->count - count > 2u || (run->count - count == 2u && run->letters[count].letter != 27u) || count < 2u ||
        count > 5u)
        return 0;
    if ((run->before == '&' || follows == '&') && count == run->count)
        return count;
    if (is_in(letters, count, shouted_words))
        return shouting ? 0u : count;
    return is_in(letters, count, spelt_words) ||
                   !(is_in(letters, count, short_words) || is_pronounceable(letters, count))
               ? count
               : 0u;
}

/* Says the names of the first letters of a run; an s if there are more. */
static void say_letters(labial_words_reading_t *reading, const run_t *run, unsigned count)
{
    unsigned i;
    for (i = 0; i < count; i++) {
        const labial_words_letter_t letter = run->letters[i];
        const char *const plural =
            i + 1u == count && count < run->count ? said_of(plural_names, letter.letter + 'a' - 1u) : NULL;
        if (plural) {
            labial_words_say(reading, labial_words_listed(plural, 1), SAID_PLAIN, letter.character);
            return;
        }
        say_letter(reading, letter);
    }
    if (count > 0u && count < run->count)
        labial_words_append(reading->word, PHONEME_Z, run->letters[count - 1u].character, 0);
}

/* ---- Runs of letters -------------------------------------------------------------------------------------------- */

/* Whether a point and a single letter follow. */
static int has_pointed(const labial_words_place_t *here)
{
    labial_words_place_t next = *here;
    if (here->code != '.')
        return 0;
    labial_words_advance(&next);
    return labial_words_is_latin(next.code) && !labial_words_is_inside(labial_words_following(&next));
}

/* Letters with points between them, "e.g." and "i.e." among them, from the first one on. */
static void read_pointed(labial_words_reading_t *reading, unsigned after)
{
    labial_words_place_t *here = &reading->here, next = *here;
    const unsigned first = labial_words_small_letter(here->code);
    unsigned second;
    const char *meaning = NULL;
    labial_words_advance(&next);
    labial_words_advance(&next);
    second = labial_words_small_letter(next.code);
    if (first == 'e' && second == 'g')
        meaning = "for example";
    else if (first == 'i' && second == 'e')
        meaning = "that is";
    if (meaning) {
        say(reading, meaning);
        labial_words_advance(&next);
        *here = next;
        return;
    }
    labial_words_advance(&next);
    if ((first == 'a' || first == 'p') && second == 'm' && after == AFTER_TIME && !has_pointed(&next))
        labial_words_take_back(reading);
    for (;;) {
        say(reading, labial_words_listed(letter_names, labial_words_small_letter(here->code) - 'a'));
        labial_words_advance(here);
        if (!has_pointed(here))
            return;
        labial_words_advance(here);
    }
}

/* The name of a unit in a list; moves behind it. */
static const char *takes_unit(labial_words_place_t *here, const char *list)
{
    for (; *list != '\0'; list = labial_words_listed(list, 2)) {
        labial_words_place_t next = *here;
        size_t i;
        for (i = 0; list[i] != '\0' && (unsigned char)list[i] == next.code; i++)
            labial_words_advance(&next);
        if (list[i] == '\0' && !labial_words_is_inside(next.code) &&
            !(next.code == '\'' && labial_words_is_latin(labial_words_following(&next)))) {
            *here = next;
            return labial_words_listed(list, 1);
        }
    }
    return NULL;
}

/* Reads a unit behind a number, if there is one. */
static int read_unit(labial_words_reading_t *reading, unsigned after)
{
    labial_words_place_t *here = &reading->here;
    const int is_apart = here->before == ' ';
    const unsigned character = here->characters - 1u;
    const char *name = takes_unit(here, units);
    reading->context->after = AFTER_UNIT;
    if (!name && !is_apart) {
        name = takes_unit(here, attached_units);
        if (name == labial_words_listed(attached_units, 1) || name == labial_words_listed(attached_units, 3))
            reading->context->after = AFTER_NUMBER; /* M, bn */
    }
    if (!name) {
        reading->context->after = AFTER_NOTHING;
        return 0;
    }
    if (here->code == SIGN_SQUARE) {
        labial_words_say(reading, "square", SAID_PLAIN, character);
        labial_words_advance(here);
    }
    labial_words_say_name(reading, name, after == AFTER_NUMBER, character);
    return 1;
}

/* Whether a part of an address is read letter by letter: a country, or what has no vowel. */
static int is_spelt_in_address(const run_t *run)
{
    unsigned i, vowels = 0;
    for (i = 0; i < run->count; i++) {
        if (run->letters[i].letter == 27u)
            return 0;
        vowels += (0x02208222u >> run->letters[i].letter) & 1u; /* a e i o u y */
    }
    return run->count == 2u ? !is_in(run->capitals, 2, "co\0go\0me\0") : run->count <= 4u && vowels == 0u;
}

/* Reads a run that rules say otherwise than by its letters. */
static int read_rule(labial_words_reading_t *reading, const run_t *run, unsigned after, unsigned shouting)
{
    const unsigned character = run->letters[0].character;
    const unsigned follows = reading->here.code;
    unsigned count;
    int found;
    if (run->count == 2u && (run->small == 0u || run->small == 2u) && is_in(run->capitals, 2, "am\0pm\0") &&
        (after == AFTER_ONE || after == AFTER_NUMBER || after == AFTER_TIME)) {
        if (after == AFTER_TIME)
            labial_words_take_back(reading);
        say_letters(reading, run, 2);
        return 1;
    }
    if (after == AFTER_TIME && find_run(run, "o'clock\0", 1) >= 0) {
        labial_words_take_back(reading);
        labial_words_spell(reading->model, run->letters, run->count, reading->word);
        return 1;
    }
    found = after == AFTER_SUM ? find_run(run, scales, 1) : -1;
    if (found >= 0) {
        labial_words_take_back(reading);
        labial_words_say(reading, labial_words_listed(scales, (unsigned)found), SAID_PLAIN, character);
        labial_words_say_name(reading, labial_words_currency_name(reading->context->currency), 1, character);
        return 1;
    }
    found = run->is_title ? find_run(run, dates, 2) : -1;
    if (found >= 0) {
        labial_words_say(reading, labial_words_listed(dates, 2u * (unsigned)found + 1u), SAID_PLAIN, character);
        if (found < DATE_MONTHS)
            reading->context->after = AFTER_MONTH;
        if (follows == '.')
            labial_words_advance(&reading->here);
        return 1;
    }
    if (run->letters[0].letter <= 26u) {
        const char *const list = meanings[run->letters[0].letter - 1u];
        found = find_run(run, list, 2);
        if (found >= 0) {
            labial_words_say(reading, labial_words_listed(list, 2u * (unsigned)found + 1u), SAID_PLAIN, character);
            return 1;
        }
    }
    count = reading->is_address && run->before == '.' && is_spelt_in_address(run)
                ? run->count
                : spelt_letters(run, follows, shouting);
    say_letters(reading, run, count);
    return count > 0u;
}

static void read_letters(labial_words_reading_t *reading)
{
    labial_words_context_t *const context = reading->context;
    labial_words_place_t next = reading->here;
    const unsigned after = forget(reading), shouting = context->shouting;
    run_t run;
    labial_words_advance(&next);
    if (has_pointed(&next)) {
        read_pointed(reading, after);
        return;
    }
    if ((after == AFTER_ONE || after == AFTER_NUMBER || after == AFTER_PER) && read_unit(reading, after))
        return;
    take_run(&reading->here, &run);
    context->shouting = 0;
    if (read_rule(reading, &run, after, shouting))
        return;
    labial_words_spell(reading->model, run.letters, run.count, reading->word);
    context->shouting = run.small == 0u && (run.count > 1u || run.capitals[0] == 'I');
    if (run.is_title && find_run(&run, labial_words_months, 1) >= 0)
        context->after = AFTER_MONTH;
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

/* ---- Signs ------------------------------------------------------------------------------------------------------ */

/* Whether a word in brackets or asterisks is a stage direction; the bracket is here. */
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
    if (next.code == closing && is_in(word, count, alone))
        return 1;
    for (verb = verbs; *verb != '\0'; verb = labial_words_listed(verb, 1)) {
        unsigned i;
        for (i = 0; i < count && verb[i] != '\0' && verb[i] - ('a' - 'A') == word[i]; i++)
            ;
        if (verb[i] == '\0' && i < count && is_in(word + i, count - i, "s\0es\0ing\0"))
            return 1;
    }
    return closing == '*' && labial_words_is_blank(next.code) && capitals == 0u && count > 3u &&
           word[count - 1u] == 'S' && word[count - 2u] != 'S' && !is_in(word, count, not_verbs);
}

static void open_tag(labial_words_reading_t *reading, unsigned closing)
{
    (void)forget(reading);
    reading->context->closing = (uint8_t)closing;
    reading->context->left = DIRECTION;
    labial_words_advance(&reading->here);
}

static void read_degrees(labial_words_reading_t *reading, unsigned after)
{
    labial_words_place_t next = reading->here;
    say(reading, after == AFTER_ONE ? "degree" : "degrees");
    labial_words_advance(&next);
    if ((next.code == 'C' || next.code == 'F') && !labial_words_is_inside(labial_words_following(&next))) {
        reading->here = next;
        say(reading, next.code == 'C' ? "celsius" : "fahrenheit");
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
    if (here->code == '.' && next.code >= 'a' && next.code <= 'z' &&
        (labial_words_is_inside(before) || before == ' ')) {
        say(reading, "dot");
        reading->is_address = 1;
    } else if (here->code == ':' && labial_words_is_inside(before) && next.code == '/' && third.code == '/') {
        say(reading, "colon slash slash");
        reading->is_address = 1;
        *here = third;
    } else if (here->code == '-' && (labial_words_is_decimal(next.code) || labial_words_is_sum(&next)) &&
               (before == ' ' || before == '(')) {
        say(reading, "minus");
    } else if (reading->is_address && labial_words_is_inside(next.code) && here->code != '.') {
        say(reading, said_of(joints, here->code));
    }
}

/* Reads what is no letter and no digit. */
static void read_sign(labial_words_reading_t *reading)
{
    labial_words_place_t *here = &reading->here;
    const unsigned code = here->code, follows = labial_words_following(here);
    const unsigned closing = code == '(' ? ')' : '*';
    const char *const said = said_of(signs, code);
    const int currency = labial_words_currency(code);
    unsigned after;
    int is_counted;
    if (code == '[' ||
        (code == '<' && (labial_words_is_latin(follows) || follows == '/' || follows == '!' || follows == '?'))) {
        open_tag(reading, code == '[' ? ']' : '>');
        return;
    }
    if ((code == '(' || code == '*') && here->before != '*' && is_direction(here, closing)) {
        open_tag(reading, closing);
        return;
    }
    after = forget(reading);
    is_counted = after == AFTER_ONE || after == AFTER_NUMBER;
    if (code == SIGN_DEGREE) {
        read_degrees(reading, after);
    } else if (code == '/' && (after == AFTER_UNIT || after == AFTER_SUM) && labial_words_is_latin(follows)) {
        say(reading, "per");
        reading->context->after = AFTER_PER;
    } else if (code == '.' || code == '/' || code == '-' || code == '_' || code == ':') {
        read_joint(reading);
    } else if (code == SIGN_HALF || code == SIGN_QUARTER || code == SIGN_QUARTERS) {
        say(reading, code == SIGN_HALF ? "one half" : code == SIGN_QUARTER ? "one quarter" : "three quarters");
        reading->context->after = AFTER_NUMBER;
    } else if (code == SIGN_MINUS) {
        say(reading, "minus");
    } else if (code == SIGN_TIMES) {
        say(reading, "times");
    } else if (code == SIGN_CENT && is_counted) {
        say(reading, after == AFTER_NUMBER ? "cents" : "cent");
    } else if (currency >= 0 && is_counted) {
        labial_words_say_name(reading, labial_words_currency_name((unsigned)currency), after == AFTER_NUMBER,
                              here->characters - 1u);
    } else if (code == '#' && labial_words_is_decimal(follows)) {
        say(reading, "number");
    } else if (code == '<' && labial_words_is_decimal(follows)) {
        say(reading, "less than");
    } else if (said) {
        say(reading, said);
    }
    labial_words_advance(here);
}

/* ---- The whole -------------------------------------------------------------------------------------------------- */

/* A blank, or the end of the text. */
static void end_word(labial_words_reading_t *reading)
{
    labial_words_context_t *const context = reading->context;
    reading->is_address = 0;
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
            context->closing = 0;
        labial_words_advance(here);
    } else if (!labial_words_is_inside(here->before) && reads_own(reading, own)) {
        (void)forget(reading);
        here->before = NOTHING;
    } else if (labial_words_is_latin(here->code)) {
        read_letters(reading);
    } else if (labial_words_is_decimal(here->code)) {
        labial_words_read_number(reading);
    } else if (labial_words_is_sum(here)) {
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
    here->text = (const unsigned char *)text;
    here->size = size;
    here->code = ' ';
    labial_words_advance(here);
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
