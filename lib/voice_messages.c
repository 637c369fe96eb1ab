/*
 * voice_messages.c - messages become items of utterances, by the rules of labial/voice.h.
 */
#include "voice_parts.h"

#include <string.h>

/* Microseconds by which rounding may move a message, and the longest time that an item lasts. */
#define MESSAGE_ROUNDING UINT64_C(20000)
#define ITEM_LONGEST (UINT64_C(1000) * LABIAL_DURATION_MAX)

/* FNV-1a. */
#define FNV_START UINT32_C(2166136261)
#define FNV_PRIME UINT32_C(16777619)

/* What the rules need to know of a message. */
typedef struct {
    uint64_t begin, end; /* of all items that make sense, microseconds */
    uint64_t reach;      /* up to which it replaces others: of the end, rounding is left out, or half of its item */
    uint32_t count;      /* of these */
    uint32_t places;     /* that they take */
    uint32_t hash;
} message_summary_t;

/* Bytes of an item's text that are kept, up to a whole character. */
static unsigned kept_bytes(const labial_voice_item_t *item)
{
    unsigned size = item->size;
    if (size > LABIAL_VOICE_TEXT) {
        size = LABIAL_VOICE_TEXT;
        while (size > 0u && ((unsigned char)item->text[size] & 0xc0u) == 0x80u)
            size--;
    }
    return size;
}

/* A key as places keep it: 1 to 65,535. */
static uint16_t key_kept(uint32_t key)
{
    return (uint16_t)(1u + key % 0xffffu);
}

/* The end of an item; the beginning where that is unknown, and of characters that end before. */
static uint64_t item_end(const labial_voice_message_t *message, const labial_voice_item_t *item)
{
    if (item->end == LABIAL_VOICE_NO_END)
        return item->start;
    return message->kind == LABIAL_VOICE_CHARACTERS && item->end < item->start ? item->start : item->end;
}

/* Whether an item makes sense `base` microseconds after the beginning of its utterance. */
static int makes_sense(const labial_voice_t *voice, const labial_voice_message_t *message,
                       const labial_voice_item_t *item, uint64_t base)
{
    const uint64_t latest = UINT64_C(1000) * LABIAL_VOICE_LATEST - base, end = item_end(message, item);
    if (item->start > latest || end > latest || end < item->start || end - item->start > ITEM_LONGEST)
        return 0;
    if (message->kind == LABIAL_VOICE_PHONEMES)
        return item->phoneme < voice->model->phoneme_count;
    if (!item->text)
        return 0;
    return message->kind >= LABIAL_VOICE_WORDS || labial_voice_viseme(message->kind, item->text, item->size) >= 0;
}

static uint32_t hash_bytes(uint32_t hash, const char *bytes, size_t size)
{
    for (; size > 0u; size--, bytes++)
        hash = (hash ^ (unsigned char)*bytes) * FNV_PRIME;
    return hash;
}

static uint32_t hash_number(uint32_t hash, uint64_t number)
{
    for (; number > 0u; number >>= 8)
        hash = (hash ^ (uint32_t)(number & 255u)) * FNV_PRIME;
    return hash * FNV_PRIME;
}

static message_summary_t summarise(const labial_voice_t *voice, const labial_voice_message_t *message, uint64_t base)
{
    message_summary_t found = { UINT64_MAX, 0, 0, 0, 0, FNV_START };
    uint32_t i;
    for (i = 0; i < message->count; i++) {
        const labial_voice_item_t *const item = message->items + i;
        uint64_t end;
        if (!makes_sense(voice, message, item, base))
            continue;
        end = item_end(message, item);
        if (item->start < found.begin)
            found.begin = item->start;
        if (end > found.end)
            found.end = end;
        end -= (end - item->start) / 2u < MESSAGE_ROUNDING ? (end - item->start) / 2u : MESSAGE_ROUNDING;
        if (end < item->start + 1000u)
            end = item->start + 1000u;
        if (end > found.reach)
            found.reach = end;
        found.count++;
        found.places += 1u;
        found.hash = hash_number(hash_number(found.hash, item->start), item_end(message, item)) ^ item->phoneme;
        if (message->kind >= LABIAL_VOICE_WORDS) {
            const unsigned size = kept_bytes(item);
            found.places += labial_voice_places(size) - 1u;
            found.hash = hash_bytes(found.hash, item->text, size);
        }
    }
    return found;
}

/* Whether a joined message came before; notes it. */
static int was_told(labial_voice_t *voice, uint32_t hash)
{
    unsigned i;
    for (i = 0; i < LABIAL_VOICE_MESSAGES_; i++)
        if (voice->messages[i] == hash)
            return 1;
    voice->messages[voice->message] = hash;
    voice->message = (uint8_t)((voice->message + 1u) % LABIAL_VOICE_MESSAGES_);
    return 0;
}

static uint32_t milliseconds_of(uint64_t microseconds)
{
    return (uint32_t)((microseconds + 500u) / 1000u);
}

/* Whether a joined message begins again. */
static int begins_again(const labial_voice_t *voice, const labial_voice_utterance_t *utterance,
                        const message_summary_t *message)
{
    const uint64_t begin = utterance->base + message->begin, end = utterance->base + message->end;
    uint64_t told, shorter = utterance->told - utterance->base;
    if (!utterance->joined || begin + MESSAGE_ROUNDING >= utterance->told)
        return 0;
    if (message->end - message->begin < shorter)
        shorter = message->end - message->begin;
    told = UINT64_C(1000) * labial_voice_told(voice, utterance, milliseconds_of(begin), milliseconds_of(end));
    return told > MESSAGE_ROUNDING && told >= shorter / 2u;
}

/* Inserts the items of a message, `base` microseconds later. */
static void insert_items(labial_voice_t *voice, labial_voice_utterance_t *utterance,
                         const labial_voice_message_t *message, uint64_t base)
{
    uint32_t i;
    for (i = 0; i < message->count; i++) {
        const labial_voice_item_t *const item = message->items + i;
        labial_voice_place_t place;
        uint32_t end;
        if (!makes_sense(voice, message, item, base)) {
            voice->counts.skipped++;
            continue;
        }
        memset(&place, 0, sizeof place);
        place.start = milliseconds_of(base + item->start);
        place.end = end = milliseconds_of(base + item_end(message, item));
        if (item->end == LABIAL_VOICE_NO_END)
            place.end = LABIAL_VOICE_OPEN;
        if (message->key)
            place.key = key_kept(message->key);
        if (message->kind == LABIAL_VOICE_PHONEMES) {
            const uint16_t gap = message->gap > 0u ? message->gap : 1u;
            place.text[0] = item->phoneme;
            place.text[2] = (uint8_t)gap;
            place.text[3] = (uint8_t)(gap >> 8);
        } else if (message->kind < LABIAL_VOICE_WORDS) {
            place.text[0] = (uint8_t)labial_voice_viseme(message->kind, item->text, item->size);
        } else {
            place.size = (uint8_t)kept_bytes(item);
        }
        labial_voice_insert(voice, utterance, &place, message->kind >= LABIAL_VOICE_WORDS ? item->text : NULL);
        if (end > utterance->end)
            utterance->end = end;
        voice->counts.told++;
    }
}

/* Adds a message to an utterance whose kind it is of, or becomes. */
static int add_message(labial_voice_t *voice, labial_voice_utterance_t *utterance,
                       const labial_voice_message_t *message, message_summary_t found)
{
    uint64_t base = 0;
    uint32_t from, to;
    if (message->kind == utterance->kind) {
        if (message->times == LABIAL_VOICE_CHAINED)
            base = utterance->told;
        else if (message->times == LABIAL_VOICE_JOINED)
            base = begins_again(voice, utterance, &found) ? utterance->told : utterance->base;
    }
    if (base > 0u)
        found = summarise(voice, message, base);
    from = to = utterance->first;
    if (message->kind != utterance->kind) {
        to = labial_voice_limit(utterance);
    } else if (found.count > 0u) {
        const uint32_t begin = milliseconds_of(base + found.begin);
        from = labial_voice_find(voice, utterance, begin);
        to = labial_voice_find(voice, utterance, milliseconds_of(base + found.reach));
        if (message->kind == LABIAL_VOICE_CHARACTERS && from < to)
            from = labial_voice_behind_blank(voice, from, begin);
    }
    if (found.places > labial_voice_free(voice) + (to - from))
        return LABIAL_ERROR_FULL;
    if (message->times == LABIAL_VOICE_JOINED && was_told(voice, hash_number(found.hash, utterance->serial))) {
        voice->counts.dropped++;
        return LABIAL_OK;
    }
    labial_voice_remove(voice, utterance, from, to);
    if (message->kind != utterance->kind) {
        utterance->kind = message->kind;
        utterance->told = 0;
        utterance->joined = 0;
        utterance->over = utterance->pause = utterance->highest = 0;
        utterance->paused = 0;
        voice->stale = 1;
    }
    utterance->base = base;
    if (message->key > utterance->highest) /* nothing has a key that counts up */
        utterance->highest = message->key;
    else if (message->key)
        labial_voice_remove_key(voice, utterance, key_kept(message->key));
    if (voice->room - voice->used < found.places)
        labial_voice_pack(voice);
    if (found.count > 0u) {
        utterance->joined = message->times == LABIAL_VOICE_JOINED;
        if (base + found.end > utterance->told)
            utterance->told = base + found.end;
    }
    insert_items(voice, utterance, message, base);
    return LABIAL_OK;
}

int labial_voice_tell(labial_voice_t *voice, const labial_voice_message_t *message)
{
    message_summary_t found;
    int result = labial_voice_status(voice), position = LABIAL_VOICE_IS_OVER;
    if (result == LABIAL_OK && (!message || (!message->items && message->count > 0u)))
        result = LABIAL_ERROR_NULL;
    if (result != LABIAL_OK)
        return result;
    if (message->kind > LABIAL_VOICE_CHARACTERS || message->times > LABIAL_VOICE_JOINED)
        return LABIAL_ERROR_RANGE;
    if (message->kind >= LABIAL_VOICE_WORDS && !voice->words)
        return LABIAL_ERROR_STATE;
    labial_voice_forget(voice, labial_voice_now(voice) - (int64_t)LABIAL_VOICE_HISTORY * 1000);
    found = summarise(voice, message, 0);
    if (voice->cancelled)
        labial_voice_note_over(voice, message->utterance);
    else
        position = labial_voice_utterance_of(voice, message->utterance, found.places);
    if (position == LABIAL_ERROR_FULL)
        return LABIAL_ERROR_FULL;
    if (position == LABIAL_VOICE_IS_OVER) {
        voice->counts.dropped++;
        return LABIAL_CANCELLED;
    }
    if (position >= 0 && message->kind > voice->utterances[position].kind)
        return LABIAL_OK;
    if (position < 0 || (found.count == 0u && !message->key)) {
        voice->counts.skipped += message->count;
        return LABIAL_OK;
    }
    voice->changed = 1;
    result = add_message(voice, voice->utterances + position, message, found);
    if (result == LABIAL_OK)
        labial_voice_requeue(voice, (unsigned)position);
    return result;
}

int labial_voice_word(labial_voice_t *voice, const char *text, size_t size, uint32_t start, uint32_t end)
{
    labial_voice_item_t item = { 0, LABIAL_VOICE_NO_END, NULL, 0, 0 };
    labial_voice_message_t message = { NULL, 1, 0, 0, 0, LABIAL_VOICE_WORDS, LABIAL_VOICE_ABSOLUTE };
    if (!text)
        return LABIAL_ERROR_NULL;
    item.start = UINT64_C(1000) * start;
    if (end != LABIAL_VOICE_OPEN)
        item.end = UINT64_C(1000) * end;
    item.text = text;
    item.size = (uint16_t)(size < UINT16_MAX ? size : UINT16_MAX);
    message.items = &item;
    return labial_voice_tell(voice, &message);
}

int labial_voice_phoneme(labial_voice_t *voice, unsigned phoneme, uint32_t start, uint32_t end)
{
    labial_voice_item_t item = { 0, 0, NULL, 0, 0 };
    labial_voice_message_t message = { NULL, 1, 0, 0, 0, LABIAL_VOICE_PHONEMES, LABIAL_VOICE_ABSOLUTE };
    item.start = UINT64_C(1000) * start;
    item.end = UINT64_C(1000) * end;
    item.phoneme = (uint8_t)(phoneme < UINT8_MAX ? phoneme : UINT8_MAX);
    message.items = &item;
    return labial_voice_tell(voice, &message);
}

uint32_t labial_voice_identity(const char *text, size_t size)
{
    const uint32_t hash = hash_bytes(FNV_START, text, text ? size : 0u);
    return hash ? hash : 1u;
}
