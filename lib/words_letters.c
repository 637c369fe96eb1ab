/*
 * words_letters.c - letters in a text as they are said: words, abbreviations, units, and capitals that are read one by
 * one. export/labial/words/text.py is the reference.
 */
#include "labial/words.h"

#include <string.h>

#include "labial/labial.h"
#include "words_parts.h"

/* Names of letters, as words that the trees read so; with an s where that is more than an added Z. */
static const char letter_names[] = "ay\0bee\0see\0dee\0e\0eff\0jee\0aitch\0eye\0jay\0kay\0ell\0em\0en\0oh\0pee\0cue\0"
                                   "are\0ess\0tee\0you\0vee\0double you\0ex\0why\0zee\0";
static const char plural_names[] = "haitches\0sesses\0xexes\0";

/* Abbreviations, and words that the trees would misread, by their first letter; each with what is said, - if it is
 * read letter by letter, + if it is what is numbered, so that a letter that stands at its number is no unit, or * if the
 * number of a telephone follows. */
static const char *const meanings[] = {
    ("approx\0approximately\0appt\0appointment\0ascii\0askey\0android\0an droid\0anime\0annie may\0"
     "airbnb\0air bee en bee\0abc\0-\0ai\0-\0apartment\0+\0apt\0+\0"),
    "blvd\0boulevard\0btw\0-\0bouquet\0boo kay\0ballet\0bal lay\0bus\0+\0",
    "capt\0captain\0cmos\0sea moss\0cliche\0klee shay\0ctrl\0control\0cpu\0-\0ceo\0-\0cfo\0-\0call\0*\0chapter\0+\0",
    "dr\0doctor\0dept\0department\0debris\0deh bree\0diy\0-\0dial\0*\0",
    "etc\0etcetera\0edu\0ee dee you\0eww\0ee you\0ext\0extension\0eu\0-\0exit\0+\0",
    "fi\0fie\0facade\0fah sod\0ftp\0-\0fyi\0-\0faq\0-\0flat\0+\0fig\0+\0figure\0+\0",
    "govt\0government\0gnu\0new\0gmail\0jee mail\0gee\0jee\0gpu\0-\0gate\0+\0gates\0+\0",
    ("http\0-\0https\0-\0hwy\0highway\0hvac\0aitch vack\0hipaa\0hippa\0hdmi\0-\0hbo\0-\0hall\0+\0"),
    "idk\0-\0id\0-\0imo\0-\0",
    "jr\0junior\0jpeg\0jay peg\0jpg\0jay peg\0json\0jason\0",
    "kubernetes\0cooper netties\0karate\0cah rah tee\0",
    "ltd\0limited\0lt\0lieutenant\0lemme\0lemmy\0lmao\0-\0latte\0lah tay\0locker\0+\0",
    "mr\0mister\0mrs\0missiz\0ms\0mizz\0mt\0mount\0mpeg\0em peg\0mysql\0my sequel\0",
    "nato\0nay toe\0nvidia\0en vidia\0nginx\0engine ex\0nba\0-\0",
    "ok\0-\0omg\0-\0openai\0open ay eye\0",
    ("prof\0professor\0ph\0-\0phd\0-\0pp\0pages\0pls\0please\0plz\0please\0pilates\0pee lah teez\0"
     "platform\0+\0part\0+\0"),
    "qty\0quantity\0",
    "rd\0road\0row\0+\0room\0+\0",
    "st\0saint\0sr\0senior\0sgt\0sergeant\0seat\0+\0seats\0+\0suite\0+\0section\0+\0",
    "tbh\0-\0thx\0thanks\0tba\0-\0ttyl\0-\0track\0+\0terminal\0+\0",
    "ugh\0ug\0uber\0oober\0usb\0-\0url\0-\0usa\0-\0uk\0-\0unit\0+\0",
    "vs\0versus\0vol\0volume\0",
    ("wi\0why\0wifi\0why fie\0www\0-\0whoa\0woe\0wwi\0double you double you one\0"
     "wwii\0double you double you two\0"),
    "xbox\0ex box\0xyz\0-\0",
    "yaml\0yamel\0yuck\0yuk\0youtube\0you tube\0y'all\0yawl\0",
    "",
};

/* Abbreviations only with a point, with what is said; from SHORT_PLACES on what is numbered. */
#define SHORT_PLACES 6
static const char shorts[] = "gen\0general\0gov\0governor\0sen\0senator\0rep\0representative\0rev\0reverend\0ft\0fort\0"
                             "apt\0apartment\0fig\0figure\0";

/* What abbreviations mean behind a name; the first two unless another name follows. */
static const char streets[] = "st\0street\0dr\0drive\0ave\0avenue\0ln\0lane\0";

/* Words that are no names although they have a capital at a sentence's beginning: "Dr" behind them is no drive, and "St"
 * before them no saint. */
static const char no_names[] =
    "the\0my\0our\0your\0his\0her\0their\0he\0she\0it\0they\0we\0this\0that\0there\0what\0when\0where\0if\0in\0"
    "on\0at\0to\0from\0by\0near\0and\0but\0so\0for\0with\0is\0are\0no\0yes\0hi\0hello\0thanks\0dear\0ask\0call\0"
    "see\0st\0dr\0then\0you\0you'll\0turn\0go\0take\0walk\0continue\0keep\0follow\0after\0cross\0please\0now\0head\0"
    "look\0visit\0apt\0suite\0";

/* Units behind a number; behind a blank only the second list. Behind those that are first in their lists a number
 * goes on: M, bn, sq, fl. */
static const char attached_units[] = "M\0million\0bn\0billion\0in\0inch|inches\0A\0amp_\0C\0degree_ celsius\0"
                                     "F\0degree_ fahrenheit\0";
static const char units[] =
    "sq\0square\0fl\0fluid\0m\0meter_\0km\0kilometer_\0cm\0centimeter_\0mm\0millimeter_\0nm\0nanometer_\0"
    "um\0micrometer_\0"
    "kg\0kilogram_\0g\0gram_\0mg\0milligram_\0ug\0microgram_\0lb\0pound_\0lbs\0pound_\0oz\0ounce_\0ft\0foot|feet\0"
    "yd\0yard_\0mi\0mile_\0mph\0mile_ per hour\0kph\0kilometer_ per hour\0L\0liter_\0l\0liter_\0ml\0milliliter_\0"
    "mL\0milliliter_\0cl\0centiliter_\0dl\0deciliter_\0dL\0deciliter_\0gal\0gallon_\0s\0second_\0sec\0second_"
    "\0secs\0second_\0"
    "ms\0millisecond_\0us\0microsecond_\0ns\0nanosecond_\0min\0minute_\0mins\0minute_\0h\0hour_\0hr\0hour_\0"
    "hrs\0hour_\0Hz\0hertz\0kHz\0kilohertz\0MHz\0megahertz\0GHz\0gigahertz\0kB\0kilobyte_\0KB\0kilobyte_\0"
    "MB\0megabyte_\0GB\0gigabyte_\0TB\0terabyte_\0kbps\0kilobit_ per second\0Mbps\0megabit_ per second\0"
    "Gbps\0gigabit_ per second\0W\0watt_\0kW\0kilowatt_\0MW\0megawatt_\0GW\0gigawatt_\0Wh\0watt hour_\0"
    "kWh\0kilowatt hour_\0V\0volt_\0mV\0millivolt_\0kV\0kilovolt_\0mA\0milliamp_\0mAh\0milliamp hour_\0dB\0decibel_\0"
    "px\0pixel_\0cal\0calorie_\0kcal\0kilocalorie_\0rpm\0are pee em\0bpm\0bee pee em\0fps\0eff pee ess\0"
    "mpg\0mile_ per gallon\0EUR\0euro_\0GBP\0pound_\0USD\0you ess dollar_\0CAD\0canadian dollar_\0"
    "AUD\0australian dollar_\0CHF\0swiss franc_\0JPY\0yen\0INR\0rupee_\0yr\0year_\0yrs\0year_\0tbsp\0tablespoon_\0"
    "tsp\0teaspoon_\0";

/* What a letter stands before that it begins with; as a list of units. */
static const char lettered[] = "test\0\0tests\0\0day\0\0boy\0\0shaped\0\0";

/* Capitals that are read letter by letter although a word could look so, words of two letters, of three that begin with
 * a vowel and others that do not look like words, and words unless the word before is not in capitals. */
static const char spelt_words[] =
    "VIP\0MIT\0SOS\0POW\0SAP\0SAT\0GED\0RIP\0SEC\0GOP\0DOD\0LAX\0LED\0DEA\0NEA\0GRE\0SLA\0COO\0NIH\0ASAP\0UCLA\0USDA\0"
    "USAF\0USPS\0NYSE\0IMHO\0AFAIK\0MOU\0SME\0STI\0TWA\0CLI\0COD\0DOB\0GIS\0VOD\0LIDL\0NES\0CIS\0UTEP\0HBCU\0ICAO\0";
static const char short_words[] =
    "AN\0AS\0AT\0BE\0BY\0DO\0GO\0HE\0HI\0IF\0IN\0IS\0ME\0MY\0NO\0OF\0OH\0ON\0OR\0OX\0SO\0TO\0UP\0WE\0YO\0HA\0AH\0UH\0"
    "UM\0EH\0ACE\0ACT\0ADD\0AGE\0AGO\0AHA\0AID\0AIM\0AIR\0ALL\0AND\0ANT\0ANY\0APP\0ARC\0ARE\0ARM\0ART\0ASH\0ASK\0ATE\0"
    "AXE\0EAR\0EAT\0EGG\0END\0EVE\0EYE\0ICE\0ILL\0INK\0INN\0ITS\0OAK\0ODD\0OFF\0OIL\0OLD\0ONE\0OUR\0OUT\0OWE\0OWN\0"
    "UGH\0USE\0GYM\0VIA\0AMY\0AVA\0BYE\0EVA\0IAN\0MIA\0LYNX\0MYTH\0NYMPH\0QUEUE\0";
static const char shouted_words[] = "AM\0IT\0US\0WHO\0";

/* Letters without a vowel, not all of them capitals, that are not read one by one: sounds and parts of words. */
static const char small_sounds[] = "hm\0hmm\0mm\0mhm\0grr\0brr\0pfft\0pff\0pst\0psst\0sh\0shh\0ssh\0tsk\0tss\0tch\0"
                                   "hmph\0nth\0zz\0bzz\0ll\0nt\0th\0nd\0mc\0ng\0";

/* How words begin and end, and vowels that stand together in them; at the end of three letters the second list. */
static const char word_onsets[] =
    "BL\0BR\0CH\0CL\0CR\0DR\0DW\0FL\0FR\0GH\0GL\0GR\0KN\0PH\0PL\0PR\0SC\0SH\0SK\0SL\0SM\0SN\0SP\0"
    "ST\0SQ\0SW\0TH\0TR\0TW\0WH\0WR\0SCR\0SHR\0SPL\0SPR\0STR\0THR\0";
static const char codas[] =
    "B\0C\0D\0F\0G\0H\0K\0L\0M\0N\0P\0R\0S\0T\0W\0X\0Z\0BB\0BT\0CH\0CK\0CT\0DD\0FF\0FT\0GG\0GH\0GN\0LD\0LF\0LK\0LL\0"
    "LM\0LP\0LT\0MB\0MN\0MP\0NG\0NK\0NN\0NT\0ND\0PH\0PT\0RB\0RC\0RD\0RF\0RK\0RL\0RM\0RN\0RP\0RT\0SH\0SK\0SM\0SP\0SS\0"
    "ST\0TH\0TT\0WD\0WL\0WN\0XT\0DTH\0FTH\0GHT\0LDT\0LTH\0NCH\0NTH\0PTH\0RCH\0RLD\0RNT\0RSH\0RST\0RTH\0TCH\0XTH\0DST\0"
    "HN\0PP\0RR\0SC\0";
static const char vowel_runs[] = "AI\0AU\0AY\0EA\0EE\0EI\0EU\0EY\0IA\0IE\0IO\0OA\0OE\0OI\0OO\0OU\0OY\0UA\0UE\0UI\0UO\0"
                                 "UY\0YE\0YI\0EO\0AO\0UIE\0UEE\0EYE\0OYA\0AYE\0IOU\0AYO\0YA\0";
static const char last_runs[] = "AY\0EA\0EE\0EY\0IE\0OE\0OO\0OU\0OY\0UE\0UY\0";

/* Letters that stand together. */
typedef struct {
    labial_words_letter_t letters[LABIAL_WORDS_LETTERS];
    char capitals[12]; /* the first eleven, in capitals, the apostrophe too */
    unsigned count;
    uint32_t small;  /* a bit for each that is a small letter or an apostrophe */
    unsigned before; /* the character before it */
    int is_title;    /* a capital, and none behind it */
    int is_small;    /* no capital */
} run_t;

static void say_letter(labial_words_reading_t *reading, labial_words_letter_t letter)
{
    labial_words_say(reading, labial_words_listed(letter_names, letter.letter - 1u), SAID_PLAIN, letter.character);
}

/* Vowels and y, a bit for each by its number. */
#define VOWELS_AND_Y 0x02208222ul

/* Reads one of a letter that is drawn out, as in "sooo", which is the last one of a run and before `here`; of e and o
 * two within a word, as in "goood". What begins with I, V or X may be a number. */
static void shorten(labial_words_place_t *here, run_t *run, unsigned code)
{
    const labial_words_letter_t *const letters = run->letters;
    unsigned i, last, vowel_count = 0;
    int goes_on;
    if (run->count < 3u)
        return;
    last = letters[run->count - 1u].letter;
    if (letters[run->count - 2u].letter != last || letters[run->count - 3u].letter != last)
        return;
    for (i = 0; i < run->count; i++)
        vowel_count += (unsigned)(VOWELS_AND_Y >> (letters[i].letter & 31u)) & 1u;
    if (vowel_count == 0u || letters[0].letter == 9u || letters[0].letter == 22u || letters[0].letter == 24u)
        return;
    while (here->code == code)
        labial_words_advance(here);
    goes_on = labial_words_is_latin(here->code);
    if (run->count == 3u && !goes_on)
        return;
    run->count -= goes_on && (last == 5u || last == 15u) ? 1u : 2u;
    run->small &= ((uint32_t)1 << run->count) - 1u;
}

/* Takes the letters that belong together from a letter on, up to a capital behind a small letter. */
static void take_run(labial_words_place_t *here, run_t *run)
{
    unsigned before = TEXT_END;
    memset(run, 0, sizeof *run);
    run->before = here->before;
    run->is_small = 1;
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
        if (labial_words_is_capital(code))
            run->is_small = 0;
        else
            run->small |= (uint32_t)1 << run->count;
        run->count++;
        before = code;
        labial_words_advance(here);
        shorten(here, run, code);
    }
    run->is_title = run->count > 1u && run->small == (0xffffffffu >> (LABIAL_WORDS_LETTERS - run->count) & ~1u);
}

static int find_run(const run_t *run, const char *list, unsigned step)
{
    return run->count < sizeof run->capitals ? labial_words_find(run->capitals, run->count, list, step) : -1;
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
    if (count < 3u || first == count || (count == 3u && first == 0u) ||
        (first > 1u && !labial_words_is_listed(letters, first, word_onsets)))
        return 0;
    if (last < count && !labial_words_is_listed(letters + last, count - last, codas) &&
        !(count - last > 1u && letters[count - 1u] == 'S' &&
          labial_words_is_listed(letters + last, count - last - 1u, codas)))
        return 0;
    for (i = 0; i < count; i++) {
        is_other |= is_vowel(letters, i) && letters[i] != 'Y';
        if (i > 0u && is_vowel(letters, i) && !is_vowel(letters, i - 1u))
            begin = i;
        if (is_vowel(letters, i) && (i + 1u == count || !is_vowel(letters, i + 1u)) && i > begin &&
            !labial_words_is_listed(letters + begin, i + 1u - begin, count == 3u ? last_runs : vowel_runs))
            return 0;
    }
    return is_other || last == count;
}

/* How many letters of a run stand before an 's: all where there is none. */
static unsigned owner_length(const run_t *run)
{
    const unsigned count = run->count;
    return count > 2u && run->letters[count - 1u].letter == 19u && run->letters[count - 2u].letter == 27u ? count - 2u
                                                                                                          : count;
}

/* How many letters of a run with small ones are read one by one: two to five without a vowel, none of them three times
 * in a row; behind them there is nothing or 's. */
static unsigned spelt_small_letters(const run_t *run)
{
    const char *const letters = run->capitals;
    const unsigned count = owner_length(run);
    unsigned i;
    if (count - 2u > 3u)
        return 0;
    for (i = 0; i < count; i++)
        if (is_vowel(letters, i) || letters[i] == 'Y' || letters[i] == '\'' ||
            (i > 1u && letters[i] == letters[i - 1u] && letters[i] == letters[i - 2u]))
            return 0;
    return labial_words_is_listed(letters, count, small_sounds) ? 0u : count;
}

/* How many letters at the beginning of a run are read one by one, all of them capitals or without a vowel; behind them
 * there is nothing, an s or 's. */
static unsigned spelt_letters(const run_t *run, unsigned follows, unsigned shouting)
{
    const char *const letters = run->capitals;
    unsigned count = run->count;
    if (count == 1u)
        return (letters[0] != 'A' && letters[0] != 'I') ||
               (letters[0] == 'A' && run->small == 0u &&
                (labial_words_is_decimal(run->before) || run->before == '&' || run->before == '+' ||
                 run->before == '/' || !labial_words_is_blank(follows)));
    if (run->small != 0u) {
        const unsigned owner = owner_length(run);
        if (run->letters[count - 1u].letter != 19u || run->small >> (count - 1u) == 0u) /* no small s */
            return spelt_small_letters(run);
        count = owner < count ? owner : count - 1u;
        if ((run->small & (((uint32_t)1 << count) - 1u)) != 0u)
            return spelt_small_letters(run);
    }
    if (count == 1u)
        return run->before == '&' || labial_words_is_latin(run->before);
    if (count > 5u)
        return 0;
    if ((run->before == '&' || follows == '&') && count == run->count)
        return count;
    if (labial_words_is_listed(letters, count, shouted_words))
        return shouting ? 0u : count;
    return labial_words_is_listed(letters, count, spelt_words) ||
                   !(labial_words_is_listed(letters, count, short_words) || is_pronounceable(letters, count))
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
            i + 1u == count && count < run->count ? labial_words_said_of(plural_names, letter.letter + 'a' - 1u) : NULL;
        if (plural) {
            labial_words_say(reading, plural, SAID_PLAIN, letter.character);
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
    unsigned second, is_hour;
    const char *meaning = NULL;
    labial_words_advance(&next);
    labial_words_advance(&next);
    second = labial_words_small_letter(next.code);
    if (first == 'e' && second == 'g')
        meaning = "for example";
    else if (first == 'i' && second == 'e')
        meaning = "that is";
    if (meaning) {
        labial_words_say_here(reading, meaning);
        labial_words_advance(&next);
        *here = next;
        return;
    }
    labial_words_advance(&next);
    is_hour = (first == 'a' || first == 'p') && second == 'm' && !has_pointed(&next) &&
              (after == AFTER_ONE || after == AFTER_NUMBER || after == AFTER_TIME);
    if (is_hour && after == AFTER_TIME)
        labial_words_take_back(reading);
    for (;;) {
        labial_words_say_here(reading, labial_words_listed(letter_names, labial_words_small_letter(here->code) - 'a'));
        labial_words_advance(here);
        if (!has_pointed(here))
            break;
        labial_words_advance(here);
    }
    next = *here;
    if (is_hour && here->code == '.') {
        labial_words_advance(here);
        if (!labial_words_read_range(reading))
            *here = next;
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

/* Reads a unit behind a number, if there is one. A foot's and an hour's names tell the context which smaller units may
 * follow: "6 ft 2 in", "1h 30m". */
int labial_words_read_unit(labial_words_reading_t *reading, unsigned after, int is_apart)
{
    labial_words_place_t *here = &reading->here;
    labial_words_context_t *const context = reading->context;
    const unsigned larger = context->currency;
    const unsigned character = here->characters - 1u;
    const char *name = takes_unit(here, units);
    context->after = AFTER_UNIT;
    if (!name) {
        labial_words_place_t next = *here;
        name = takes_unit(&next, attached_units);
        if (is_apart && larger != 'f' &&
            (next.code != '.' || name != attached_units + sizeof "M\0million\0bn\0billion\0in"))
            name = NULL; /* after a blank, "in." alone is one */
        if (name)
            *here = next;
    }
    if (!name) {
        context->after = AFTER_NOTHING;
        return 0;
    }
    if (name == units + sizeof "sq" || name == units + sizeof "sq\0square\0fl" || name == attached_units + sizeof "M" ||
        name == attached_units + sizeof "M\0million\0bn")
        context->after = AFTER_NUMBER;
    if (larger == 'h' && name == units + sizeof "sq\0square\0fl\0fluid\0m")
        name = "minute_";
    context->tail = 0;
    context->currency = name[1] == 'o' && name[0] != 'p' ? (uint8_t)name[0] : 0u;
    if (here->code == SIGN_SQUARE || here->code == SIGN_CUBE) {
        labial_words_say(reading, here->code == SIGN_CUBE ? "cubic" : "square", SAID_PLAIN, character);
        labial_words_advance(here);
    }
    labial_words_say_name(reading, name, after == AFTER_NUMBER || after == AFTER_PHONE, character);
    if (context->currency == 'f' && here->code == '.')
        labial_words_advance(here);
    else
        (void)labial_words_read_range(reading);
    return 1;
}

/* Whether a part of an address is read letter by letter: a country, or what has no vowel. */
static int is_spelt_in_address(const run_t *run)
{
    unsigned i, vowel_count = 0;
    for (i = 0; i < run->count; i++) {
        if (run->letters[i].letter == 27u)
            return 0;
        vowel_count += (unsigned)(VOWELS_AND_Y >> run->letters[i].letter) & 1u;
    }
    return run->count == 2u ? !labial_words_is_listed(run->capitals, 2, "co\0go\0me\0")
                            : run->count <= 4u && vowel_count == 0u;
}

/* What a month leaves behind: it makes the number before it an ordinal, or waits for its day. */
static unsigned after_month(labial_words_reading_t *reading, unsigned after, unsigned character)
{
    if ((after != AFTER_ONE && after != AFTER_NUMBER) || reading->context->tail == 0u)
        return AFTER_MONTH;
    labial_words_take_back(reading);
    labial_words_say_small(reading, reading->context->currency, ORDINAL, character);
    return AFTER_NOTHING;
}

/* Says what a run means in a list of two texts each; returns its number there, or -1. */
static int say_meaning(labial_words_reading_t *reading, const run_t *run, const char *list)
{
    const int found = find_run(run, list, 2);
    if (found >= 0)
        labial_words_say(reading, labial_words_listed(list, 2u * (unsigned)found + 1u), SAID_PLAIN,
                         run->letters[0].character);
    return found;
}

/* Reads "St" and "Dr" behind a name, which mean street and drive unless another name follows: that takes them back. */
static int read_street(labial_words_reading_t *reading, const run_t *run)
{
    const unsigned first = reading->word->count;
    const int found = say_meaning(reading, run, streets);
    if (found < 0)
        return 0;
    labial_words_keep_tail(reading, first);
    reading->context->after = (uint8_t)(AFTER_STREET + found);
    if (reading->here.code == '.')
        labial_words_advance(&reading->here);
    return 1;
}

/* The number of Roman numerals up to 29, without an 's behind them, or 0. They are three letters or more, II, or two
 * capitals behind a name or what is numbered. */
static unsigned roman(const run_t *run, int is_named)
{
    const unsigned count = owner_length(run);
    unsigned tens = 0;
    int ones;
    if (count < 2u || count > 6u || (run->capitals[0] != 'I' && run->capitals[0] != 'V' && run->capitals[0] != 'X'))
        return 0;
    while (tens < 2u && run->capitals[tens] == 'X')
        tens++;
    ones = labial_words_find(run->capitals + tens, count - tens, "i\0ii\0iii\0iv\0v\0vi\0vii\0viii\0ix\0", 1);
    if (ones < 0 || (count == 2u && ones != 1 && (!is_named || (run->small & 3u) != 0u)))
        return 0;
    return tens * TEN + (unsigned)ones + 1u;
}

/* The number of a month or a day whose name a run is or begins, with three letters or from s on with up to five; or -1.
 * Notes the character of the name that is behind the run. */
static int date_of(const run_t *run, char *rest)
{
    const char *name = labial_words_dates;
    int number;
    if (!run->is_title || run->count >= sizeof run->capitals)
        return -1;
    for (number = 0; number < DATES; number++, name = labial_words_listed(name, 1)) {
        unsigned i;
        for (i = 0; i < run->count && name[i] - ('a' - 'A') == run->capitals[i]; i++)
            ;
        *rest = name[i];
        if (i == run->count && (*rest == '\0' || (i > 2u && i < (*name >= 's' ? 6u : 4u))))
            return number;
    }
    return -1;
}

/* Short names of dates that are words otherwise, as a bit each: Jan, Mar, Mon, Sat, Sun. */
#define DOUBTFUL 0x61005ul

/* Reads a month or a day in short, and notes one in full; returns whether it was said. Names that are words otherwise
 * are dates behind the number of a day, next to another date and, but for Sat and Sun, with a point; if none of this
 * holds, what follows may correct them. */
static int read_date_name(labial_words_reading_t *reading, const run_t *run, unsigned after)
{
    labial_words_context_t *const context = reading->context;
    const unsigned character = run->letters[0].character;
    char rest = 0;
    const int found = date_of(run, &rest);
    int is_sure;
    if (found < 0)
        return 0;
    if (after == AFTER_DATE)
        labial_words_correct(reading, character);
    is_sure = (DOUBTFUL >> found & 1u) == 0u || after == AFTER_DATE || after == AFTER_DAY;
    context->after = (uint8_t)(found < MONTHS ? after_month(reading, after, character) : (unsigned)AFTER_DAY);
    if (rest == '\0')
        return 0;
    if (reading->here.code == '.') {
        labial_words_advance(&reading->here);
        is_sure |= found <= MONDAY;
    }
    if (!is_sure && context->after != AFTER_NOTHING) { /* nothing: the month of a day */
        context->after = AFTER_DATE;
        context->currency = (uint8_t)found;
        return 0;
    }
    labial_words_say(reading, labial_words_listed(labial_words_dates, (unsigned)found), SAID_PLAIN, character);
    return 1;
}

/* Reads a word in short with a point behind it; returns whether it was said. Of "No." and others a number makes other
 * words. */
static int read_short(labial_words_reading_t *reading, const run_t *run)
{
    int found;
    if (reading->here.code != '.' || reading->is_address)
        return 0;
    found = run->is_title || run->is_small ? find_run(run, "no\0nos\0ca\0p\0ch\0op\0est\0rs\0", 1) : -1;
    if (found >= 0) {
        reading->context->after = AFTER_NO;
        reading->context->currency = (uint8_t)(DATES + found);
        labial_words_advance(&reading->here);
        return 0;
    }
    found = run->is_small ? -1 : say_meaning(reading, run, shorts);
    if (found < 0)
        return 0;
    if (found >= SHORT_PLACES)
        reading->context->after = AFTER_PLACE;
    labial_words_advance(&reading->here);
    return 1;
}

/* Reads laughter, two syllables or more: "haha", "hehehe". */
static int read_laugh(labial_words_reading_t *reading, const run_t *run)
{
    const char *const syllable = labial_words_said_of("ahah\0ehee\0ihee\0ohoe\0", run->letters[1].letter + 'a' - 1u);
    unsigned i;
    if (run->count < 4u || !syllable)
        return 0;
    for (i = 0; i < run->count; i++)
        if (run->letters[i].letter != (i % 2u == 0u ? 8u : run->letters[1].letter))
            return 0;
    for (i = 0; i + 1u < run->count; i += 2u)
        labial_words_say(reading, syllable, SAID_PLAIN, run->letters[i].character);
    return 1;
}

/* Reads a run that rules say otherwise than by its letters. */
static int read_rule(labial_words_reading_t *reading, const run_t *run, unsigned after, unsigned shouting)
{
    const unsigned character = run->letters[0].character;
    const unsigned follows = reading->here.code;
    const char *list;
    unsigned count;
    int found;
    if (run->count == 2u && (run->small == 0u || run->small == 3u) &&
        labial_words_is_listed(run->capitals, 2, "am\0pm\0") &&
        (after == AFTER_ONE || after == AFTER_NUMBER || after == AFTER_TIME)) {
        if (after == AFTER_TIME)
            labial_words_take_back(reading);
        say_letters(reading, run, 2);
        (void)labial_words_read_range(reading);
        return 1;
    }
    if (after == AFTER_TIME && find_run(run, "o'clock\0", 1) >= 0) {
        labial_words_take_back(reading);
        labial_words_spell(reading->model, run->letters, run->count, reading->word);
        return 1;
    }
    found = after == AFTER_SUM ? find_run(run, labial_words_listed(labial_words_cardinals, HUNDRED), 1) : -1;
    if (found >= 0) {
        labial_words_take_back(reading);
        labial_words_say_last(reading, (unsigned)found + HUNDRED, CARDINAL, character);
        labial_words_say_name(reading, labial_words_currency_name(reading->context->currency), 1, character);
        return 1;
    }
    if (read_date_name(reading, run, after) || read_short(reading, run))
        return 1;
    if (run->count == 1u && run->small != 0u && run->capitals[0] == 'X' && run->before == ' ' &&
        labial_words_is_blank(follows) && (after == AFTER_ONE || after == AFTER_NUMBER || after == AFTER_UNIT)) {
        labial_words_say(reading, "by", SAID_PLAIN, character);
        return 1;
    }
    if (read_laugh(reading, run))
        return 1;
    if (run->count == 1u && run->small != 0u && follows == '/' && run->capitals[0] == 'W') {
        labial_words_say(reading, "with", SAID_PLAIN, character);
        reading->context->after = AFTER_WITH;
        labial_words_advance(&reading->here);
        return 1;
    }
    if (after == AFTER_WITH && run->count == 1u && run->capitals[0] == 'O') {
        labial_words_say(reading, "out", SAID_PLAIN, character);
        return 1;
    }
    list = meanings[(run->letters[0].letter - 1u) % 26u];
    found = run->before == ';' || run->before == '&' ? -1 : find_run(run, list, 2);
    if (found >= 0) {
        list = labial_words_listed(list, 2u * (unsigned)found + 1u);
        if (*list == '+' || *list == '*') {
            reading->context->after = *list == '+' ? AFTER_PLACE : AFTER_CALL;
            return 0;
        }
        if (*list == '-')
            say_letters(reading, run, run->count);
        else
            labial_words_say(reading, list, SAID_PLAIN, character);
        return 1;
    }
    count = reading->is_address && run->before == '.' && is_spelt_in_address(run)
                ? run->count
                : spelt_letters(run, follows, shouting);
    say_letters(reading, run, count);
    return count > 0u;
}

/* Moves from a letter to the word behind a hyphen that begins with it, "w-what", but for names such as "t-test". */
static void pass_stutter(labial_words_place_t *here)
{
    for (;;) {
        labial_words_place_t next = *here, word;
        labial_words_advance(&next);
        if (next.code != '-' || labial_words_is_inside(here->before))
            return;
        labial_words_advance(&next);
        word = next;
        if (next.code != labial_words_small_letter(here->code) || takes_unit(&word, lettered))
            return;
        *here = next;
    }
}

void labial_words_read_letters(labial_words_reading_t *reading)
{
    labial_words_context_t *const context = reading->context;
    labial_words_place_t next;
    const unsigned after = labial_words_forget(reading), shouting = context->shouting, named = context->named;
    unsigned number, first;
    int is_read;
    run_t run;
    context->named = 0;
    pass_stutter(&reading->here);
    next = reading->here;
    labial_words_advance(&next);
    if (has_pointed(&next)) {
        read_pointed(reading, after);
        return;
    }
    if ((after == AFTER_ONE || after == AFTER_NUMBER || after == AFTER_PER || after == AFTER_PHONE) &&
        labial_words_read_unit(reading, after, reading->here.before == ' '))
        return;
    take_run(&reading->here, &run);
    reading->has_letters = 1;
    context->named = run.count > 1u && (run.small & 1u) == 0u && find_run(&run, no_names, 1) < 0;
    if (context->named && (after == AFTER_STREET || after == AFTER_DRIVE)) {
        labial_words_take_back(reading);
        labial_words_say(reading, after == AFTER_STREET ? "saint" : "doctor", SAID_PLAIN, run.letters[0].character);
    }
    first = reading->word->count;
    context->shouting = 0;
    if (after == AFTER_PLACE && (run.count == 1u || find_run(&run, "and\0or\0to\0", 1) >= 0))
        context->after = AFTER_PLACE;
    if (after == AFTER_CALL && find_run(&run, "us\0me\0at\0on\0now\0", 1) >= 0)
        context->after = AFTER_CALL;
    number = roman(&run, named != 0u || after == AFTER_PLACE);
    if (number != 0u) {
        labial_words_say_small(reading, number, CARDINAL, run.letters[0].character);
        if (owner_length(&run) < run.count)
            labial_words_append(reading->word, PHONEME_Z, run.letters[owner_length(&run) - 1u].character, 0);
        return;
    }
    if (named && read_street(reading, &run))
        return;
    is_read = read_rule(reading, &run, after, shouting);
    if (!is_read)
        labial_words_spell(reading->model, run.letters, run.count, reading->word);
    if (context->after == AFTER_DATE || context->after == AFTER_NO)
        labial_words_keep_tail(reading, first);
    context->shouting = !is_read && run.small == 0u && (run.count > 1u || run.capitals[0] == 'I');
}
