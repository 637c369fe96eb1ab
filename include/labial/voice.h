/*
 * labial/voice.h - follows a voice whose words or phonemes become known while it is heard: items with their times in,
 * as a speech service sends them; frames out, when they are due by the clock of the sound. Optional: a program that
 * does not call it links nothing of it.
 *
 *     static labial_voice_t voice;
 *     static uint32_t memory[LABIAL_VOICE_SIZE(3, 8, 256) / 4]; // of the model speech_en, and 256 places
 *
 *     labial_voice_init(&voice, &speech_en, memory, sizeof memory);
 *     labial_voice_words(&voice, &words_en, NULL);             // where the service tells words or characters
 *
 *     labial_voice_word(&voice, "Hello,", 6, 120, 480);        // whenever a word becomes known: from 120 to 480 ms
 *     labial_voice_phoneme(&voice, SPEECH_EN_HH, 120, 190);    // or a phoneme
 *
 *     while (labial_voice_next(&voice, heard, &frame, faps) == LABIAL_OK) // often: `heard` milliseconds were heard
 *         show(faps);
 *
 * Frame k is due when k / fps seconds of the sound were heard. What becomes known late, or otherwise than before,
 * changes the frames that are still to come: they fade over LABIAL_VOICE_FADE frames to what they would have been;
 * lips that are apart meet in time for a p, b or m.
 *
 * Items that make no sense are skipped and counted: those that end before they begin, last more than an hour, begin or
 * end more than a day after their utterance's beginning, or name a phoneme or viseme that there is not.
 *
 * The work of a call is linear in the items that it is given; that of a frame is a tick of the stream
 * (labial/labial.h). A change of what is already playing costs the ticks of up to three seconds once.
 *
 * The memory and `voice` are the caller's; the structure may be moved or copied between calls as long as the memory
 * stays where it is and one copy alone is used. Calls must not overlap. Models are trusted, as those of a stream;
 * items, texts, times and the order of calls are not.
 */
#ifndef LABIAL_VOICE_H
#define LABIAL_VOICE_H

#include <stddef.h>
#include <stdint.h>

#include "labial/labial.h"
#include "labial/result.h"
#include "labial/visemes.h"
#include "labial/words.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Frames over which a changed motion fades in. */
#define LABIAL_VOICE_FADE 8u

/* Milliseconds from the end of the last item until the face is at rest. */
#define LABIAL_VOICE_REST 500u

/* An unknown end, for labial_voice_word(). */
#define LABIAL_VOICE_OPEN 0xffffffffu

/* The latest time of the clock, milliseconds: a year. */
#define LABIAL_VOICE_CLOCK UINT64_C(32000000000)

/* For labial_voice_begin(): where the utterance before ends. */
#define LABIAL_VOICE_BEHIND UINT64_MAX

/*
 * Bytes of memory for models of `channels` channels that search a state every `stride` frames (as
 * LABIAL_WORKSPACE_SIZE), and for so many places of items that are not over for a few seconds: a phoneme, viseme or
 * character takes one, a word of n bytes 1 + (n + 11) / 16, a shorter one of up to four bytes one. A constant
 * expression, a multiple of four.
 */
#define LABIAL_VOICE_SIZE(stride, channels, places) (LABIAL_WORKSPACE_SIZE(stride, channels) + 16u * (uint32_t)(places))

/* A voice; the members are private. */
typedef struct labial_voice labial_voice_t;

/* ---- A voice that is followed ------------------------------------------------------------------------------------ */

/*
 * Prepares a voice with frames of `model`. `memory`, aligned to four bytes, is the voice's from then on: `size` bytes,
 * at least LABIAL_VOICE_SIZE(stride, channels, 1) of the model.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL, LABIAL_ERROR_VERSION or LABIAL_ERROR_WORKSPACE.
 */
int labial_voice_init(labial_voice_t *voice, const labial_model_t *model, void *memory, size_t size);

/*
 * How words and characters are pronounced; `own` may be null. Both must stay where they are. Until then, items of these
 * kinds are refused.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL, LABIAL_ERROR_STATE or LABIAL_ERROR_VERSION.
 */
int labial_voice_words(labial_voice_t *voice, const labial_words_model_t *model, const labial_words_own_t *own);

/* A message of one word or phoneme of the latest utterance, in milliseconds; a word's end may be LABIAL_VOICE_OPEN.
 * Return as labial_voice_tell(); what makes no sense is skipped. */
int labial_voice_word(labial_voice_t *voice, const char *text, size_t size, uint32_t start, uint32_t end);
int labial_voice_phoneme(labial_voice_t *voice, unsigned phoneme, uint32_t start, uint32_t end);

/*
 * The next utterance, whose sound begins when `at` milliseconds were heard, or LABIAL_VOICE_BEHIND: where the one
 * before ends, as far as is known, or now if that is over. `utterance` is its identity, 0 for that of its first
 * message; that of an utterance that began by itself moves it to `at`. 0 does the same with the first utterance that
 * waits: one that began by itself behind another one, or after a cancel with LABIAL_VOICE_BEHIND, and is not over; or
 * of which nothing would be heard otherwise. After a cancel, items count again from here on.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL, LABIAL_ERROR_STATE, LABIAL_ERROR_RANGE or LABIAL_ERROR_FULL.
 */
int labial_voice_begin(labial_voice_t *voice, uint64_t at, uint32_t utterance);

/* Nothing more follows (labial_voice_done()). A message that comes nevertheless begins the next utterance, unless it
 * has the identity of a known one. Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE. */
int labial_voice_finish(labial_voice_t *voice);

/*
 * Drops all frames that are still to come, and eases to the neutral face over `milliseconds`, rounded up to whole
 * frames, 1 .. LABIAL_CANCEL_MAX. It drops messages until labial_voice_begin(), and afterwards those of the utterances
 * whose identities it knew by then.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_voice_cancel(labial_voice_t *voice, uint32_t milliseconds);

/*
 * The next of the frames that are due when `milliseconds` of the sound were heard; `frame` may be null. Call it until
 * it returns LABIAL_WAITING. A clock that goes back yields none; more than a second after the last frame, the latest
 * one alone is due.
 *
 * Returns LABIAL_OK, LABIAL_WAITING where none is due, LABIAL_ERROR_NULL, LABIAL_ERROR_STATE, or LABIAL_ERROR_RANGE
 * beyond LABIAL_VOICE_CLOCK.
 */
int labial_voice_next(labial_voice_t *voice, uint64_t milliseconds, uint32_t *frame, int16_t faps[LABIAL_CHANNELS]);

/*
 * The next pose on the way to the neutral face, for a clock that stands with the sound: once in each frame's time in
 * which labial_voice_next() gives none. The way begins at once after labial_voice_cancel(); after labial_voice_finish()
 * where the clock stands at the end of what is known or up to 100 ms before it, once it stood for 80 ms. It is no
 * frame of the sound: an item for the time at which the clock stands begins there.
 *
 * Returns LABIAL_OK, LABIAL_WAITING until the clock stood for so long, LABIAL_DONE where there is no such way or at its
 * end, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_voice_ease(labial_voice_t *voice, int16_t faps[LABIAL_CHANNELS]);

/*
 * The shares of the sounds (labial/visemes.h) in the frame that labial_voice_next() gave last. `shares` are those of
 * the frame before, all 0 at first: while a frame fades to what became known, or to rest, each changes by a quarter of
 * LABIAL_VISEME_ONE at most, so that no tongue jumps. For models of the ARPABET; others are silent.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_voice_visemes(const labial_voice_t *voice, uint8_t shares[LABIAL_VISEMES]);

/* Whether nothing more will move: after labial_voice_finish(), LABIAL_VOICE_REST milliseconds after the last item, if
 * there was any, or at the end of labial_voice_ease()'s way; after labial_voice_cancel(), when the face is neutral. 0
 * for a null or uninitialised voice. */
int labial_voice_done(labial_voice_t *voice);

/* What a voice has received. */
typedef struct {
    uint32_t told;    /* items taken */
    uint32_t skipped; /* items that make no sense */
    uint32_t dropped; /* messages of utterances that are over, and repeated ones */
} labial_voice_counts_t;

/* What it has received so far; all zero for a null or uninitialised voice. */
labial_voice_counts_t labial_voice_counts(const labial_voice_t *voice);

/* ---- Utterances and messages ------------------------------------------------------------------------------------- */

/* Utterances at a time, 2 .. 255: the one that is heard, and those that wait. Each costs 76 bytes. */
#ifndef LABIAL_VOICE_UTTERANCES
#define LABIAL_VOICE_UTTERANCES 8
#endif
#if LABIAL_VOICE_UTTERANCES < 2 || LABIAL_VOICE_UTTERANCES > 255
#error "LABIAL_VOICE_UTTERANCES must be a number from 2 to 255."
#endif

/* The latest time of an item in its utterance, milliseconds: a day. */
#define LABIAL_VOICE_LATEST 86400000u

/*
 * - Times of items count from the beginning of their utterance. The first one begins with the sound; further ones begin
 *   with labial_voice_begin(), or by themselves where a message has another identity than those before it.
 * - An identity is what the service calls the utterance (a context, a generation), as labial_voice_identity() makes it
 *   of a text. Messages of an utterance that waits go to it, whatever came between. Messages of one that was cancelled
 *   or is over are dropped. An utterance without an identity takes that of the first message that has one.
 * - An utterance that begins by itself is queued: it begins where the one before it ends, as far as is known, until its
 *   own sound is heard or labial_voice_begin() says when that is.
 * - A message replaces earlier items of its time: those that begin between the beginning of its first and the end of
 *   its last one, less 20 ms or half of that item, as ends are rounded; a blank character that ends within the first 20
 *   ms stays. Of an utterance only the items of its first kind (labial_voice_kind_t) count.
 * - Where there is no item there is silence; after the last item the face comes to rest (LABIAL_VOICE_REST). An
 *   utterance ends where the next one begins.
 */

/* Bytes of an item's text that are kept; the rest is passed over. */
#define LABIAL_VOICE_TEXT 255u

/* Characters of the longest word that characters make; what follows is another word. */
#define LABIAL_VOICE_LETTERS 60u

/* An unknown end, in microseconds: a word lasts until the next one then, or as long as it usually does. */
#define LABIAL_VOICE_NO_END UINT64_MAX

/* Kinds of items. Of those that an utterance has, the first of this list counts. */
typedef enum {
    LABIAL_VOICE_PHONEMES,
    LABIAL_VOICE_AZURE,     /* visemes by their names: Azure's, "0" to "21"; each lasts until the next */
    LABIAL_VOICE_POLLY,     /* and Amazon Polly's, such as "p" or "sil" */
    LABIAL_VOICE_WORDS,     /* as they are written, with their punctuation */
    LABIAL_VOICE_CHARACTERS /* of a text; [tags] and <tags> are passed over. Words end at blanks; those of scripts
                             * without blanks at their punctuation, where a word of Japanese or a syllable of Thai
                             * probably begins, and after four kana. */
} labial_voice_kind_t;

/* From when on the times of a message count. */
typedef enum {
    LABIAL_VOICE_ABSOLUTE, /* from the beginning of the utterance */
    LABIAL_VOICE_CHAINED,  /* from the end of the message before */
    LABIAL_VOICE_JOINED    /* from the beginning of the utterance or, if the message begins again, from the end of all
                            * before: if it begins no later than the joined one before it and at least half of its time,
                            * more than 20 ms, has items. Of the last 16 messages none counts twice. */
} labial_voice_times_t;

/* An item of a message. */
typedef struct {
    uint64_t start, end; /* microseconds, so that rounding does not add up; `end` may be LABIAL_VOICE_NO_END */
    const char *text;    /* UTF-8: a word, one or more characters, the name of a viseme; null for a phoneme */
    uint16_t size;       /* bytes of the text */
    uint8_t phoneme;     /* number of a phoneme in the model */
} labial_voice_item_t;

/* What a service tells in one piece. The structure and what it points to are needed during the call alone. */
typedef struct {
    const labial_voice_item_t *items;
    uint32_t count;
    uint32_t utterance; /* its identity; 0 for none: the latest utterance */
    uint32_t key;       /* not 0: a later message of the utterance with this key, modulo 65,535, replaces it */
    uint16_t gap;       /* milliseconds: a gap behind a phoneme that is no longer belongs to it, 1 at least */
    uint8_t kind;       /* labial_voice_kind_t */
    uint8_t times;      /* labial_voice_times_t */
} labial_voice_message_t;

/* The identity of a text of `size` bytes, never 0: FNV-1a of 32 bits. */
uint32_t labial_voice_identity(const char *text, size_t size);

/*
 * Takes a message.
 *
 * Returns LABIAL_OK, also where nothing of it counts, LABIAL_CANCELLED where its utterance is over and it was dropped,
 * or with nothing changed LABIAL_ERROR_NULL, LABIAL_ERROR_STATE (not initialised; words without labial_voice_words()),
 * LABIAL_ERROR_RANGE (kind or times) or LABIAL_ERROR_FULL (no place for all of its items, or for another utterance).
 */
int labial_voice_tell(labial_voice_t *voice, const labial_voice_message_t *message);

/* ---- Pronunciation and times ------------------------------------------------------------------------------------- */

/*
 * Says how a word is pronounced that is about to be read: the caller's own words for it, or null. They must stay where
 * they are until it is called again. It is called in labial_voice_next(), labial_voice_tell() and labial_voice_done(),
 * for the same word again and again, and must not call the voice.
 */
typedef const labial_words_own_t *(*labial_voice_own_fn)(void *user, const char *text, size_t size);

/* Asks `own` for each word, in place of the words of labial_voice_words(), as for languages that the library does not
 * read; null for those again. Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE. */
int labial_voice_pronounce(labial_voice_t *voice, labial_voice_own_fn own, void *user);

/*
 * The model's number of each of the 40 phonemes of labial/words.h, silence first: of a model that numbers them
 * otherwise than the bundled ones. The numbers must stay where they are; null for the bundled ones' order.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL, LABIAL_ERROR_STATE or LABIAL_ERROR_PHONEME.
 */
int labial_voice_numbers(labial_voice_t *voice, const uint8_t numbers[LABIAL_ARPABET_PHONEMES]);

/* Adds so many milliseconds to all times: with a service that reports them too early, a positive number.
 * Returns LABIAL_OK, LABIAL_ERROR_NULL, LABIAL_ERROR_STATE, or LABIAL_ERROR_RANGE beyond a day. */
int labial_voice_offset(labial_voice_t *voice, int32_t milliseconds);

/* ---- Private ----------------------------------------------------------------------------------------------------- */

/* Segments that the stream was given last: all of three seconds, unless phonemes are shorter than 25 ms. */
#define LABIAL_VOICE_GIVEN_ 128u

/* Messages that are recognised when they come again. */
#define LABIAL_VOICE_MESSAGES_ 16u

/* An item, or the first 4 bytes of its text; the rest lies in the places behind it. */
struct labial_voice_place {
    uint32_t start, end; /* milliseconds from the beginning of the utterance; `end` may be LABIAL_VOICE_OPEN */
    uint16_t key;        /* 0 for none */
    uint8_t size;        /* of the text */
    uint8_t back;        /* places of the item before it */
    uint8_t text[4];     /* of a phoneme: its number, 0, and its gap; of a viseme: its number */
};

struct labial_voice_utterance {
    int64_t origin;    /* milliseconds of the sound, from which its times count */
    int64_t limit;     /* where it ends at the latest */
    uint64_t base;     /* microseconds, from which times of joined messages count */
    uint64_t told;     /* microseconds, the end of all messages */
    uint32_t identity; /* 0 while there is none */
    uint32_t first;    /* of its places */
    uint32_t places;   /* that its items take */
    uint32_t end;      /* of its items, milliseconds from the origin */
    uint32_t over;     /* up to which items were forgotten */
    uint32_t pause;    /* where the longest time without items before `over` begins, */
    uint32_t highest;  /* key */
    uint32_t serial;   /* its number */
    uint16_t paused;   /* and its milliseconds */
    uint8_t kind;      /* that counts */
    uint8_t tail;      /* places of the last item */
    uint8_t queued;    /* it began by itself: behind the one before it */
    uint8_t early;     /* it began by itself, or after a cancel: its sound was not heard of yet */
    uint8_t joined;    /* its last message was */
};

/* A phoneme from `start` to `end`. */
struct labial_voice_segment {
    int64_t start, end; /* milliseconds; INT64_MAX without an end */
    uint8_t phoneme;
};

/* Turns items into segments, one after the other (voice_plan.c). */
struct labial_voice_plan {
    int64_t moment;      /* up to which segments were made */
    uint32_t seen;       /* places before this one were looked at */
    uint32_t at;         /* the next item */
    uint32_t start, end; /* of the phoneme that comes next, milliseconds from the origin */
    uint32_t previous;   /* end of the one before */
    uint8_t phoneme;
    uint8_t has;        /* one that comes next */
    uint8_t joins;      /* `previous` holds */
    uint8_t utterance;  /* that `at` is in */
    uint8_t byte;       /* characters: of the item's text, */
    uint8_t point;      /* and its number as a character */
    uint8_t closing;    /* the bracket that ends a tag, or 0 */
    uint8_t ended;      /* the words' last one was pushed */
    uint8_t characters; /* of the word that they make, */
    uint8_t size;       /* and its bytes */
    uint32_t time;      /* up to which words have phonemes */
    uint32_t begin, until;
    uint32_t last; /* of them: its number */
    uint32_t ends[LABIAL_VOICE_LETTERS];
    char letters[4u * LABIAL_VOICE_LETTERS];
    labial_words_t words;
};

struct labial_voice {
    const labial_model_t *model;
    const labial_words_model_t *words;
    const labial_words_own_t *own;
    labial_voice_own_fn ask;
    void *user; /* of `ask` */
    const uint8_t *numbers;
    int (*speak)(labial_voice_t *voice); /* voice_words.c, once it is needed */
    uint32_t (*lasts)(labial_voice_t *voice, const struct labial_voice_utterance *); /* and what a last word does */
    struct labial_voice_place *items;
    uint32_t room;                       /* places */
    uint32_t used;                       /* up to this place */
    uint32_t next;                       /* the frame that comes next */
    uint32_t step, steps, closing;       /* of a fade, which jaw and lips end with step `closing` */
    int32_t offset;                      /* milliseconds */
    uint64_t left;                       /* milliseconds of the last segment that the stream was not given yet */
    int64_t tail;                        /* when the silence without an end begins; INT64_MAX before it is given */
    int64_t from;                        /* when the first segment of `given` begins */
    uint32_t given[LABIAL_VOICE_GIVEN_]; /* that the stream has, a ring: milliseconds, 0 without an end */
    uint8_t phonemes[LABIAL_VOICE_GIVEN_];
    uint32_t messages[LABIAL_VOICE_MESSAGES_]; /* hashes of joined ones, a ring */
    uint32_t gone[LABIAL_VOICE_UTTERANCES];    /* identities of utterances that are over, a ring */
    labial_voice_counts_t counts;
    uint32_t serial;                                 /* of the utterance that began last */
    uint8_t given_first, given_count, message, over; /* places in rings */
    uint8_t utterance_count;
    uint8_t finished, cancelled;
    uint8_t changed;   /* a message came since the last frame, */
    uint8_t stale;     /* of what the plan had looked at */
    uint8_t streaming; /* the stream makes the frames; else the face is neutral */
    uint8_t begun;     /* `shown` holds */
    uint8_t moved;     /* the stream made a frame */
    uint8_t still;     /* frames' times since the last one, before the face eases to rest; */
    uint8_t eased;     /* it does or did since then */
    uint8_t given_phoneme;
    int16_t shown[LABIAL_CHANNELS], made[LABIAL_CHANNELS];
    int32_t fade[LABIAL_CHANNELS]; /* is added to the stream's frames, less with each step */
    struct labial_voice_utterance utterances[LABIAL_VOICE_UTTERANCES];
    struct labial_voice_plan plan;
    uint32_t *workspace;
    uint32_t workspace_size;
    labial_t stream;
};

#ifdef __cplusplus
}
#endif

#endif
