/*
 * labial/words.h - English words and their times to phonemes and theirs, for voices that tell when each word or each
 * character is spoken, but not its phonemes. Optional: a program that does not call it links nothing of it.
 *
 *     static labial_words_t words;
 *     unsigned phoneme;
 *     uint32_t milliseconds;
 *
 *     labial_words_init(&words, &words_en, NULL, 0);      // the model: lib/words/words_en.h
 *     labial_words_push(&words, "Hello", 5, 120, 480);    // from 120 to 480 ms
 *     while (labial_words_next(&words, &phoneme, &milliseconds) == LABIAL_OK)
 *         labial_push(&stream, phoneme, milliseconds);    // while labial_room() > 0
 *     labial_words_push(&words, "world.", 6, 500, 930);
 *     ...
 *     labial_words_end(&words);                           // that was the last word; then take its phonemes as well
 *
 * Phonemes are numbered as in the bundled speech model: silence, then ARPABET in the order of the alphabet. For a model
 * with other phonemes, look each label (labial_words_label()) up in its names once.
 *
 * The model is that of one language, and these rules are for English: other languages in Latin letters are read as if
 * they were English; where a voice reports phonemes or visemes, use these. The model is trusted, as those of motion
 * are. Texts, times and the order of calls are not trusted.
 *
 * docs/words.md says what is read: letters, spelt words, numbers, dates, times, sums, units, addresses, abbreviations,
 * tags and stage directions. Letters of other scripts are unknown; bytes that are not UTF-8 are nothing.
 *
 * What a word means may depend on those before it: "5" behind "March", "km" behind "5". A stream of words knows them;
 * labial_words_read_next() takes them from a labial_words_context_t.
 */
#ifndef LABIAL_WORDS_H
#define LABIAL_WORDS_H

#include <stddef.h>
#include <stdint.h>

#include "labial/labial.h"
#include "labial/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A gap between two words that is shorter, in milliseconds, belongs to the first one; behind a comma or other
 * punctuation, where voices pause, less is a pause. */
#define LABIAL_WORDS_PAUSE 150u
#define LABIAL_WORDS_COMMA 80u

/* An unknown end of a word: it lasts until the next word begins, or as long as such a word usually does. */
#define LABIAL_WORDS_NO_END 0xffffffffu

/* Words in time on their way to phonemes; the members are private. It may be moved or copied between calls. */
typedef struct labial_words labial_words_t;

/* How words of a language sound, and the caller's own words; both below. */
typedef struct labial_words_model labial_words_model_t;
typedef struct labial_words_own labial_words_own_t;

/* ---- Words in time ----------------------------------------------------------------------------------------------- */

/*
 * Prepares a stream. `offset` milliseconds are added to all times: with a voice that reports its words too early, a
 * positive number; too late, a negative one. What it moves before the beginning is cut off.
 *
 * The model and the caller's own words must stay where they are. Returns LABIAL_OK, LABIAL_ERROR_NULL or
 * LABIAL_ERROR_VERSION.
 */
int labial_words_init(labial_words_t *stream, const labial_words_model_t *model, const labial_words_own_t *own,
                      int32_t offset);

/* Other words of the caller's own, for the words that follow; null for none. Returns LABIAL_OK, LABIAL_ERROR_NULL or
 * LABIAL_ERROR_STATE. */
int labial_words_pronounce(labial_words_t *stream, const labial_words_own_t *own);

/*
 * Takes a word from `start` to `end`, milliseconds from the beginning of the sound; `end` may be LABIAL_WORDS_NO_END. A
 * word that ends where it begins, as of services that tell beginnings alone, has no known end either. How a word ends
 * depends on what follows, so that each word's phonemes come with the next word or with labial_words_end(). A gap under
 * LABIAL_WORDS_PAUSE, or under LABIAL_WORDS_COMMA behind punctuation, belongs to the word before it, a longer one is
 * silence. A word that ends after the next one begins is cut off there. A text that is silent leaves its time to what
 * is beside it.
 *
 * Take all that labial_words_next() has first. Returns LABIAL_OK or, with the stream unchanged, LABIAL_ERROR_NULL,
 * LABIAL_ERROR_STATE (not prepared, or after labial_words_end()), LABIAL_ERROR_FULL (labial_words_next() has more),
 * LABIAL_ERROR_WORD (`end` before `start`, or `start` before that of an earlier word) or LABIAL_ERROR_DURATION (longer
 * than LABIAL_DURATION_MAX).
 */
int labial_words_push(labial_words_t *stream, const char *text, size_t size, uint32_t start, uint32_t end);

/*
 * The same with the ends of the text's `count` characters (code points); the first one begins at
 * `start` and the word ends with the last. The boundaries between phonemes are then half way between those of their
 * characters and those of labial_words_push(); where all characters last equally long, as of voices that only share out
 * the time of a word, they are those of labial_words_push().
 *
 * Returns as labial_words_push(): LABIAL_ERROR_WORD also where `count` is 0, more than LABIAL_WORDS_CHARACTERS or not
 * the text's number of characters, and where a character ends before the one before it.
 */
int labial_words_push_characters(labial_words_t *stream, const char *text, size_t size, uint32_t start,
                                 const uint32_t *ends, unsigned count);

/*
 * No more words will come: the last one ends where it said.
 *
 * Returns LABIAL_OK (also when called again), LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_words_end(labial_words_t *stream);

/*
 * The next phoneme and its duration, silences included; as labial_push() takes them, and without gaps from 0 on.
 *
 * Returns LABIAL_OK, LABIAL_WAITING where there is none until the next word or labial_words_end(), LABIAL_DONE after
 * it when all words are through, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_words_next(labial_words_t *stream, unsigned *phoneme, uint32_t *milliseconds);

/*
 * Drops the phonemes that labial_words_next() has not returned; no more words will come. The face comes to rest by
 * labial_cancel().
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_words_cancel(labial_words_t *stream);

/*
 * Continues after labial_words_end() or labial_words_cancel(): words of the same sound may follow, whose phonemes begin
 * where the last one that labial_words_next() returned ended. For another sound, whose times begin with 0,
 * labial_words_init() it is.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE (unless words have ended, and while there are phonemes to
 * be taken).
 */
int labial_words_restart(labial_words_t *stream);

/* What was pushed and not yet taken: milliseconds and phonemes. `frames` are 0, and so is the delay: how long a word
 * waits depends on when the next one comes. All zero for a null or unprepared stream. */
labial_latency_t labial_words_latency(const labial_words_t *stream);

/* ---- Words without times ----------------------------------------------------------------------------------------- */

/* Letters that are read together; longer words are read in parts. */
#define LABIAL_WORDS_LETTERS 32

/* Characters of a text that are read, and the phonemes that they become at most; what follows is passed over. */
#define LABIAL_WORDS_CHARACTERS 255
#define LABIAL_WORDS_PHONEMES 96

typedef enum {
    LABIAL_WORDS_SILENT, /* nothing to be said */
    LABIAL_WORDS_READ,
    LABIAL_WORDS_UNKNOWN /* letters of other scripts alone: no phonemes */
} labial_words_kind_t;

/* A phoneme of a word. */
typedef struct {
    uint8_t phoneme;
    uint8_t character; /* of the text, from 0, that it belongs to */
    uint8_t first;     /* 1 where a spoken word begins: "21" is two */
} labial_words_phoneme_t;

/* What a text sounds like. */
typedef struct {
    uint8_t kind;       /* labial_words_kind_t */
    uint8_t count;      /* of `phonemes` */
    uint8_t characters; /* of the text, LABIAL_WORDS_CHARACTERS at most */
    labial_words_phoneme_t phonemes[LABIAL_WORDS_PHONEMES];
} labial_word_t;

/* What the words so far mean for the next one: all zero at the beginning of a text. The other members are private. */
typedef struct {
    /* Phonemes at the end of the word before that are not said there: those of "dollars" in "$5 million", which
     * labial_words_read_next() found only when it read "million"; all of "5" before "March", which makes it "fifth". */
    uint8_t dropped;
    uint8_t after;    /* what was said last */
    uint8_t currency; /* of a sum; or the number that a month may follow, or the unit that a smaller one may follow */
    uint8_t tail;     /* phonemes that the next word may drop */
    uint8_t shouting; /* the word before is in capitals and not spelt */
    uint8_t named;    /* the word before may be the name of a street */
    uint8_t closing;  /* what ends the tag or stage direction that the text is in */
    uint8_t left;     /* words that it may still have */
    uint8_t quoted;   /* a quotation has begun */
} labial_words_context_t;

/*
 * Reads a text of `size` bytes of UTF-8: one word or several. `own` may be null.
 *
 * Returns LABIAL_OK with `word` filled, whatever the text; LABIAL_ERROR_NULL, or LABIAL_ERROR_VERSION for a model of
 * another format.
 */
int labial_words_read(const labial_words_model_t *model, const labial_words_own_t *own, const char *text, size_t size,
                      labial_word_t *word);

/*
 * The same for the next word of a text, or the next part of it: `context` goes from word to word. Where it says
 * `dropped` afterwards, remove so many phonemes from the end of the word before.
 *
 * Returns as labial_words_read().
 */
int labial_words_read_next(const labial_words_model_t *model, const labial_words_own_t *own,
                           labial_words_context_t *context, const char *text, size_t size, labial_word_t *word);

/* The label of a phoneme in ARPABET, "" for numbers beyond the last and a null model. */
const char *labial_words_label(const labial_words_model_t *model, unsigned phoneme);

/* What a word usually lasts, in milliseconds; 0 for silence, null and unknown words. */
uint32_t labial_words_length(const labial_words_model_t *model, const labial_word_t *word);

/* ---- Tables ------------------------------------------------------------------------------------------------------ */

/* A word of the caller's own and its phonemes; numbers beyond the model's count as silence. The word is compared with
 * each stretch of a text between blanks and punctuation other than apostrophes, small and capital letters of ASCII
 * being the same. */
typedef struct {
    const char *word;        /* UTF-8, ends with NUL */
    const uint8_t *phonemes; /* in their order */
    uint8_t count;
} labial_words_entry_t;

/* The caller's own words; they come before all rules. */
struct labial_words_own {
    const labial_words_entry_t *entries;
    uint16_t count;
};

/* Format of a model; a file of another format does not compile. */
#define LABIAL_WORDS_FORMAT 2

/* How words of a language sound, as `labial export` writes it. Places and numbers are checked there.
 *
 * A node of a tree has two bytes, the higher first: question << 7 | kind << 5 | five. Of kind 0, both answers lead to a
 * leaf: `five` for yes, the next byte for no. Of kind 1, yes leads to the leaf `five`, and the node for no follows; of
 * kind 2, no leads to it and the node for yes follows. Of kind 3, `five` and the next byte are the length of the part
 * for yes, which follows, and behind it that for no. A leaf is a place in its letter's part of `leaves`. The questions
 * are those of export/labial/words/trees.py.
 *
 * An exception has the second and third byte of its word's hash, and then two bytes for each label to be changed, the
 * higher first: last << 15 | label << 5 | letter. The first byte of the hash is its bucket. */
struct labial_words_model {
    uint16_t format;         /* LABIAL_WORDS_FORMAT */
    uint8_t phoneme_count;   /* silence included */
    uint32_t multiplier;     /* of the hash */
    const uint16_t *roots;   /* 27 places in `trees` */
    const uint16_t *bases;   /* 27 places in `leaves` */
    const uint8_t *leaves;   /* labels of each letter */
    const uint8_t *labels;   /* two bytes each: phonemes, 0 for none; the second has 0x80 where it ends in a vowel */
    const uint8_t *trees;    /* nodes */
    const uint16_t *buckets; /* 257 places in `patches` */
    const uint8_t *patches;  /* exceptions */
    const char *phonemes;    /* their labels, each ending with NUL */
    const uint8_t *milliseconds; /* their mean durations */
    const uint8_t *classes;      /* 1 for vowels, 2 for voiceless consonants, 0 for others */
    uint8_t filler[2];           /* phonemes that alternate in unknown words */
};

/* ---- Private ----------------------------------------------------------------------------------------------------- */

/* A word with its time. */
struct labial_words_span {
    labial_word_t word;
    uint32_t start, end;                   /* milliseconds */
    uint8_t open;                          /* its end is unknown */
    uint8_t stops;                         /* punctuation ends the word */
    uint8_t spelt;                         /* `reach` holds */
    uint16_t reach[LABIAL_WORDS_PHONEMES]; /* where a phoneme's characters end, milliseconds from the start */
};

struct labial_words {
    const labial_words_model_t *model;
    const labial_words_own_t *own;
    int32_t offset;            /* milliseconds, added to all times */
    uint32_t latest;           /* beginning of the word that came last */
    uint32_t time;             /* up to which there are phonemes */
    uint32_t start, until;     /* of the word being spoken */
    uint32_t weight, reached;  /* of all its phonemes, and of those before the next one */
    uint8_t place;             /* its next phoneme */
    uint8_t speaking, holding; /* whether there is a word being spoken, and one that waits for the next */
    uint8_t held;              /* which of `spans` waits; the other one is being spoken */
    uint8_t paused;            /* behind the word being spoken there is a pause */
    uint8_t ended;             /* no word follows */
    labial_words_context_t context;
    struct labial_words_span spans[2];
};

#ifdef __cplusplus
}
#endif

#endif
