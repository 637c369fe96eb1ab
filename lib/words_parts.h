/*
 * words_parts.h - what the files of labial/words.h share.
 */
#ifndef LABIAL_WORDS_PARTS_H
#define LABIAL_WORDS_PARTS_H

#include <stddef.h>
#include <stdint.h>

#include "labial/words.h"

/* A letter of a word: its number, 1 to 27 (a to z, apostrophe), the character of the text that it is, and the phoneme
 * that it has by its accent, 0 for none; ACCENT_LAST beside EH makes it IY at the end of a word. */
typedef struct {
    uint8_t letter, character, sound;
} labial_words_letter_t;

#define ACCENT_LAST 0x80u

/* Phonemes that rules name. */
#define PHONEME_AA 1u
#define PHONEME_EH 11u
#define PHONEME_EY 13u
#define PHONEME_IY 18u
#define PHONEME_OW 25u
#define PHONEME_S 29u
#define PHONEME_UW 34u
#define PHONEME_Z 38u

/* Codes of simple characters that are not printable ASCII: the end, letters of other scripts, what is not said, and
 * signs. The blank is ASCII's. */
enum {
    TEXT_END,
    FOREIGN,
    NO_CHARACTER,
    SIGN_EURO,
    SIGN_POUND,
    SIGN_YEN,
    SIGN_RUPEE,
    SIGN_CENT,
    SIGN_DEGREE,
    SIGN_SQUARE,
    SIGN_TIMES,
    SIGN_MINUS,
    SIGN_DIVIDED,
    SIGN_CUBE,
    SIGN_MOST,
    SIGN_LEAST,
    SIGN_ABOUT,
    SIGN_EITHER
};

/* What was said last, in `after` of labial_words_context_t. */
enum {
    AFTER_NOTHING,
    AFTER_ONE,
    AFTER_NUMBER,
    AFTER_TIME,
    AFTER_SUM,
    AFTER_UNIT,
    AFTER_PER,
    AFTER_MONTH,
    AFTER_WITH,   /* "w" of "w/" */
    AFTER_STREET, /* "St", "Dr", "Ave", "Ln" behind a name */
    AFTER_DRIVE,
    AFTER_AVENUE,
    AFTER_LANE,
    AFTER_MONEY, /* a sign of money before its sum */
    AFTER_CALL,  /* "call", and digits of a telephone */
    AFTER_PHONE,
    AFTER_NO,   /* "No.", "Nos.", "ca.", of which a number makes other words */
    AFTER_DATE, /* "Mon", "Jan", of which a number or a date makes a day or month; it and the next outlast , - / */
    AFTER_DAY,  /* the name of a day */
    AFTER_PLACE /* "seat", "gate": the letter of its number is no unit */
};

/* A place in a text. */
typedef struct {
    const unsigned char *text;
    size_t size;
    size_t at;           /* behind the current character */
    size_t start;        /* of the current character */
    unsigned characters; /* so far, the current one included */
    unsigned code;       /* of the current one: ASCII or one of the above */
    unsigned before;     /* of the one before, a blank at the beginning */
    unsigned accent;     /* of the current one, 0 for none */
    unsigned pending;    /* further characters of a ligature or a fraction, the next one in the low byte */
    unsigned more;       /* further characters of the text that the current one stands for, as of "&amp;" */
} labial_words_place_t;

/* A place in a text, and the word that it becomes. */
typedef struct {
    const labial_words_model_t *model;
    labial_word_t *word;
    labial_words_context_t *context;
    labial_words_place_t here;
    unsigned is_tail_here; /* what the next word may take back is at the end of `word` */
    unsigned is_address;   /* a web address was recognised in this word */
    unsigned has_letters;  /* letters stand in this word, behind them a hyphen or a number at most */
} labial_words_reading_t;

/* ---- Characters ------------------------------------------------------------------------------------------------- */

/* Begins at the character at byte `at` of a text of `size` bytes, as if a blank were before it. */
void labial_words_place(labial_words_place_t *here, const char *text, size_t size, size_t at);

/* Moves on to the next simple character, passing over marks. */
void labial_words_advance(labial_words_place_t *here);

/* The code of the character behind the current one. */
unsigned labial_words_following(const labial_words_place_t *here);

/* The phoneme of the current letter by its accent, as in labial_words_letter_t. */
unsigned labial_words_accented(const labial_words_place_t *here);

/* Whether a code is a capital, a Latin letter, a digit, any of these or a letter of another script, or a blank or the
 * end; a capital's small letter, and other codes as they are. */
int labial_words_is_capital(unsigned code);
int labial_words_is_latin(unsigned code);
int labial_words_is_decimal(unsigned code);
int labial_words_is_inside(unsigned code);
int labial_words_is_blank(unsigned code);
unsigned labial_words_small_letter(unsigned code);

/* ---- What is said ----------------------------------------------------------------------------------------------- */

/* How the last of several words ends. */
enum { SAID_PLAIN, SAID_PLURAL, SAID_ORDINAL };

/* Says words of small letters, separated by blanks, where the text's `character` is. With SAID_ORDINAL the last one
 * gets -th, or -ieth for -y; with SAID_PLURAL, also beside that, an s, or -ies for -y. */
void labial_words_say(labial_words_reading_t *reading, const char *words, unsigned ending, unsigned character);

/* Says a name in singular or plural: "foot|feet", or with _ where an s goes. */
void labial_words_say_name(labial_words_reading_t *reading, const char *name, int is_plural, unsigned character);

/* Says words where the current character is. */
void labial_words_say_here(labial_words_reading_t *reading, const char *words);

/* Notes that the next word may take back the phonemes from `first` on; takes such phonemes back. */
void labial_words_keep_tail(labial_words_reading_t *reading, unsigned first);
void labial_words_take_back(labial_words_reading_t *reading);

/* What was said last matters no more; returns what it was. */
unsigned labial_words_forget(labial_words_reading_t *reading);

/* Takes back what was said in short, and says in full what the context has noted for that. */
void labial_words_correct(labial_words_reading_t *reading, unsigned character);

/* Lists are texts that end with NUL, and an empty one. The text of a number in a list. */
const char *labial_words_listed(const char *list, unsigned number);

/* What is said of a sign in a list, whose texts begin with it; or null. */
const char *labial_words_said_of(const char *list, unsigned sign);

/* Which of the texts of a list, `step` of which belong together, `count` capitals are, or -1; whether they are one. The
 * letters of the list may be small. */
int labial_words_find(const char *letters, unsigned count, const char *list, unsigned step);
int labial_words_is_listed(const char *letters, unsigned count, const char *list);

/* Reads a unit behind a number, if there is one; whether there is. `is_apart` is for a blank between them. */
int labial_words_read_unit(labial_words_reading_t *reading, unsigned after, int is_apart);

/* Reads letters from the current one on. */
void labial_words_read_letters(labial_words_reading_t *reading);

/* ---- Numbers ---------------------------------------------------------------------------------------------------- */

/* Digits of a number that is said as one, at most: 999 trillion. */
#define MOST_DIGITS 15u

/* Numbers of words that are said: those up to TWENTY themselves, then tens. */
enum { TEN = 10, TWENTY = 20, HUNDRED = 28, THOUSAND, MILLION, BILLION, TRILLION, NO_WORD };

/* Words of numbers, by these numbers. */
extern const char labial_words_cardinals[];

/* How a number ends. */
enum { CARDINAL = SAID_PLAIN, PLURALS = SAID_PLURAL, ORDINAL = SAID_ORDINAL, ORDINALS = SAID_PLURAL + SAID_ORDINAL };

/* Digits as they stand in a text. */
typedef struct {
    uint8_t digits[MOST_DIGITS]; /* the first ones */
    unsigned count;
    uint32_t value;    /* of at most nine */
    unsigned is_other; /* it is not 0 */
    unsigned last;     /* character of the last digit */
} labial_words_number_t;

/* The character that is here, from 0. */
unsigned labial_words_here(const labial_words_reading_t *reading);

/* Takes digits; says digits one by one, also with commas. */
labial_words_number_t labial_words_take_digits(labial_words_place_t *here);
void labial_words_say_digits(labial_words_reading_t *reading, int with_commas);

/* Whether a point and a digit are at a place. */
int labial_words_has_fraction(const labial_words_place_t *here);

/* Reads a point and the digits behind it. */
void labial_words_read_fraction(labial_words_reading_t *reading);

/* Says a number up to 9,999; the last word of a number. */
void labial_words_say_small(labial_words_reading_t *reading, unsigned value, unsigned ending, unsigned character);
void labial_words_say_last(labial_words_reading_t *reading, unsigned last, unsigned ending, unsigned character);

/* Reads "to" behind a number, its unit or time of day where another number follows; whether it does. */
int labial_words_read_range(labial_words_reading_t *reading);

/* Reads a fraction such as 3/4, with "and" before it behind a number; whether there is one. */
int labial_words_read_share(labial_words_reading_t *reading, int is_counted);

/* Reads dates, times and whatever is more than a number, `after` what was said before; whether there is any. */
int labial_words_read_special(labial_words_reading_t *reading, unsigned after);

/* Names of months, and behind them those of days; then what "No." and others mean before a number. */
enum { MONTHS = 12, MONDAY = 12, DATES = 19 };
extern const char labial_words_dates[];

/* The number of a sign of money, or -1; its name. */
int labial_words_currency(unsigned code);
const char *labial_words_currency_name(unsigned currency);

/* Whether a sign of money and its number are at a place. */
int labial_words_is_sum(const labial_words_place_t *here);

/* Reads the number that begins with the current character, a digit or a sign of money. */
void labial_words_read_number(labial_words_reading_t *reading);
void labial_words_read_sum(labial_words_reading_t *reading);

/* ---- Letters and time ------------------------------------------------------------------------------------------- */

/* Appends the phonemes of a spoken word of 1 to LABIAL_WORDS_LETTERS letters; those without room are dropped. */
void labial_words_spell(const labial_words_model_t *model, const labial_words_letter_t *letters, unsigned count,
                        labial_word_t *word);

/* Appends a phoneme, unless there is no room. */
void labial_words_append(labial_word_t *word, unsigned phoneme, unsigned character, unsigned first);

/* The weight of a phoneme among those of its word, at most 2^16; `pause` says that a pause follows the last one. */
uint32_t labial_words_weight(const labial_words_model_t *model, const labial_word_t *word, unsigned place,
                             unsigned pause);

#endif
