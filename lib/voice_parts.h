/*
 * voice_parts.h - what the files of labial/voice.h share.
 *
 *     voice.c          calls, and the queue of utterances
 *     voice_messages.c messages to items of utterances
 *     voice_frames.c   the frames that are due
 *     voice_items.c    the items of all utterances, in one array
 *     voice_plan.c     items to phonemes in time, without gaps
 *     voice_words.c    words and characters to phonemes; linked by labial_voice_words() alone
 */
#ifndef LABIAL_VOICE_PARTS_H
#define LABIAL_VOICE_PARTS_H

#include "labial/voice.h"

#include "fixed.h"

typedef struct labial_voice_place labial_voice_place_t;
typedef struct labial_voice_utterance labial_voice_utterance_t;
typedef struct labial_voice_segment labial_voice_segment_t;
typedef struct labial_voice_plan labial_voice_plan_t;

/* Seconds before the next frame, besides the part of a second, that a new stream is given. */
#define LABIAL_VOICE_HISTORY 2u

/* Items of an utterance before a time that are made to segments as well, since those behind them depend on them:
 * characters, among which a [tag] may begin, and others. */
#define LABIAL_VOICE_BACK 100u
#define LABIAL_VOICE_BACK_FEW 2u

/* When a frame is due, milliseconds of the sound. */
static inline int64_t labial_voice_moment(const labial_voice_t *voice, uint32_t frame)
{
    const uint32_t rate = voice->model->frames_per_second, seconds = labial_quotient(frame, rate);
    return (int64_t)seconds * 1000 + labial_quotient((frame - seconds * rate) * 1000u, rate);
}

/* No kind of items. */
#define LABIAL_VOICE_NO_KIND 0xffu

/* LABIAL_OK for a voice that was initialised, else the error that every call on it returns. */
static inline int labial_voice_status(const labial_voice_t *voice)
{
    return !voice ? LABIAL_ERROR_NULL : voice->model ? LABIAL_OK : LABIAL_ERROR_STATE;
}

/* When the next frame is due, milliseconds. */
static inline int64_t labial_voice_now(const labial_voice_t *voice)
{
    return labial_voice_moment(voice, voice->next);
}

/* ---- Utterances -------------------------------------------------------------------------------------------------- */

/* Moves the utterances that are queued behind one that has grown. */
void labial_voice_requeue(labial_voice_t *voice, unsigned position);

/* The end of all items, milliseconds without the offset; -1 without items. */
int64_t labial_voice_latest(labial_voice_t *voice);

/* Of an utterance that a message belongs to: it is over; or there is none yet, and the message has nothing for it. */
#define LABIAL_VOICE_IS_OVER (-1000)
#define LABIAL_VOICE_HAS_NONE (-1001)

/* The position of the utterance that a message of this identity belongs to, which may be a new one, where there are so
 * many places for it; or one of these, or LABIAL_ERROR_FULL with nothing changed. */
int labial_voice_utterance_of(labial_voice_t *voice, uint32_t identity, uint32_t places);

/* ---- Items: a place is told by its index; those of an utterance lie one after the other -------------------------- */

/* Places of an item whose text has `size` bytes. */
static inline uint32_t labial_voice_places(uint32_t size)
{
    return size > 4u ? 1u + (size + 11u) / 16u : 1u;
}

/* The index behind the item at `at`. */
static inline uint32_t labial_voice_after(const labial_voice_t *voice, uint32_t at)
{
    return at + labial_voice_places(voice->items[at].size);
}

/* The text of an item, which goes on in the places behind it. */
static inline const char *labial_voice_text(const labial_voice_t *voice, uint32_t at)
{
    return (const char *)(const void *)voice->items + (size_t)at * sizeof(labial_voice_place_t) +
           offsetof(labial_voice_place_t, text);
}

/* The bytes of the character that begins a text of `left` bytes. */
static inline unsigned labial_voice_bytes(const char *text, unsigned left)
{
    unsigned bytes = 1;
    while (bytes < left && bytes < 4u && ((unsigned char)text[bytes] & 0xc0u) == 0x80u)
        bytes++;
    return bytes;
}

/* The number of a character, which its bytes of UTF-8 are; any number of what is none. */
static inline uint32_t labial_voice_code(const char *text, unsigned bytes)
{
    uint32_t code = (unsigned char)*text & (bytes > 1u ? 0x3fu >> (bytes - 1u) : 0xffu);
    unsigned i;
    for (i = 1; i < bytes; i++)
        code = code << 6 | ((unsigned char)text[i] & 0x3fu);
    return code;
}

/* Blanks, and punctuation of Chinese and Japanese, behind which no blank is written: the first and the last one. */
#define LABIAL_VOICE_BLANKS 19u
extern const uint16_t labial_voice_blanks[LABIAL_VOICE_BLANKS][2];

static inline int labial_voice_is_blank(uint32_t code)
{
    unsigned i;
    for (i = 0; i < LABIAL_VOICE_BLANKS; i++)
        if (code >= labial_voice_blanks[i][0] && code <= labial_voice_blanks[i][1])
            return 1;
    return 0;
}

/* Whether the item at `at` is such a character. */
int labial_voice_is_blank_item(const labial_voice_t *voice, uint32_t at);

/* The index of the first item that a message of characters from `begin` on replaces, `at` or the one behind it: a blank
 * that ended the message before still ends its last word, though rounding moved it. */
uint32_t labial_voice_behind_blank(labial_voice_t *voice, uint32_t at, uint32_t begin);

/* The end of an utterance's places. */
static inline uint32_t labial_voice_limit(const labial_voice_utterance_t *utterance)
{
    return utterance->first + utterance->places;
}

/* The item before the one at `at`, which is not the utterance's first; or the last one, of its end. */
uint32_t labial_voice_before(const labial_voice_t *voice, const labial_voice_utterance_t *utterance, uint32_t at);

/* The index of the first item that begins at `start` or later. */
uint32_t labial_voice_find(const labial_voice_t *voice, const labial_voice_utterance_t *utterance, uint32_t start);

/* Removes the items from `from` to before `to`. */
void labial_voice_remove(labial_voice_t *voice, labial_voice_utterance_t *utterance, uint32_t from, uint32_t to);

/* Inserts an item with its text behind those that begin no later. There must be room. */
void labial_voice_insert(labial_voice_t *voice, labial_voice_utterance_t *utterance, const labial_voice_place_t *item,
                         const char *text);

/* Milliseconds from `from` to `to` that have items, or had some that were forgotten. */
uint32_t labial_voice_told(const labial_voice_t *voice, const labial_voice_utterance_t *utterance, uint32_t from,
                           uint32_t to);

/* Removes all items of a key, as places keep it. */
void labial_voice_remove_key(labial_voice_t *voice, labial_voice_utterance_t *utterance, uint16_t key);

/* Whether an identity is one of an utterance that is over; notes that it is, unless it is 0. */
int labial_voice_is_over(const labial_voice_t *voice, uint32_t identity);
void labial_voice_note_over(labial_voice_t *voice, uint32_t identity);

/* Removes the utterance at this position of `utterances`, and its items; it is over. */
void labial_voice_remove_utterance(labial_voice_t *voice, unsigned position);

/* Forgets what ended a while before `moment`, but the last item of an utterance. */
void labial_voice_forget(labial_voice_t *voice, int64_t moment);

/* Places that are free, while there is an utterance; after labial_voice_pack() they lie behind those that are used. */
uint32_t labial_voice_free(const labial_voice_t *voice);
void labial_voice_pack(labial_voice_t *voice);

/* ---- The plan ---------------------------------------------------------------------------------------------------- */

/* The number of a viseme of Azure or Polly by its name, or -1. */
int labial_voice_viseme(unsigned kind, const char *text, size_t size);

/* The plan begins at a time, milliseconds of the sound, a second or more before all that matters. */
void labial_voice_plan_start(labial_voice_t *voice, int64_t moment);

/* The next segment. The segments have no gaps, and silences that adjoin are one; the last one has no end, and is made
 * again and again. */
void labial_voice_plan_next(labial_voice_t *voice, labial_voice_segment_t *segment);

/* Whether there is anything but silence. */
int labial_voice_plan_sounds(labial_voice_t *voice);

/* When the utterance at this position ends, milliseconds of the sound. */
int64_t labial_voice_end(labial_voice_t *voice, unsigned position);

/* The plan looks at the place `at` of an utterance, or at its end. */
static inline void labial_voice_look(labial_voice_plan_t *plan, uint32_t at)
{
    if (at >= plan->seen)
        plan->seen = at + 1u;
}

/* ---- Frames ------------------------------------------------------------------------------------------------------ */

/* Begins to fade from the last frame, where the stream is at `made`. */
void labial_voice_begin_fade(labial_voice_t *voice, uint32_t steps);

/* Model's number of a phoneme of labial/words.h. */
static inline uint8_t labial_voice_number(const labial_voice_t *voice, unsigned phoneme)
{
    return voice->numbers ? voice->numbers[phoneme] : (uint8_t)phoneme;
}

#endif
