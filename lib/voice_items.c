/*
 * voice_items.c - the items of a voice's utterances (voice_parts.h).
 *
 * They lie in one array, utterance behind utterance and in the order of their beginnings, so that what is told ahead of
 * the sound is appended, and what is over is left behind at its beginning. An item knows how many places the one before
 * it takes, an utterance how many its last one does.
 */
#include "voice_parts.h"

#include <string.h>

/* What is over is kept for so many milliseconds more. */
#define ITEMS_KEPT 1000

/* Milliseconds by which rounding may move a blank. */
#define ROUNDING 20u

/* Milliseconds of a pause that are kept. */
#define LONGEST_PAUSE 0xffffu

const uint16_t labial_voice_blanks[LABIAL_VOICE_BLANKS][2] = {
    { 0x09, 0x0d },     { 0x1c, 0x20 },     { 0x85, 0x85 },     { 0xa0, 0xa0 },     { 0x1680, 0x1680 },
    { 0x2000, 0x200a }, { 0x2014, 0x2015 }, { 0x2025, 0x2026 }, { 0x2028, 0x2029 }, { 0x202f, 0x202f },
    { 0x205f, 0x205f }, { 0x3000, 0x3002 }, { 0x3008, 0x3011 }, { 0x3014, 0x301b }, { 0x30fb, 0x30fb },
    { 0xff01, 0xff01 }, { 0xff0c, 0xff0c }, { 0xff1a, 0xff1b }, { 0xff1f, 0xff1f }
};

int labial_voice_is_blank_item(const labial_voice_t *voice, uint32_t at)
{
    const char *const text = labial_voice_text(voice, at);
    const unsigned size = voice->items[at].size, bytes = labial_voice_bytes(text, size);
    return bytes == size && labial_voice_is_blank(labial_voice_code(text, bytes));
}

uint32_t labial_voice_behind_blank(labial_voice_t *voice, uint32_t at, uint32_t begin)
{
    labial_voice_place_t *const item = voice->items + at;
    if (!labial_voice_is_blank_item(voice, at) || (item->end != LABIAL_VOICE_OPEN && item->end > begin + ROUNDING))
        return at;
    item->start = begin;
    return labial_voice_after(voice, at);
}

uint32_t labial_voice_before(const labial_voice_t *voice, const labial_voice_utterance_t *utterance, uint32_t at)
{
    return at - (at == labial_voice_limit(utterance) ? utterance->tail : voice->items[at].back);
}

/* The index behind the items that begin before `start`. Most items come in order, so that this looks from the end. */
uint32_t labial_voice_find(const labial_voice_t *voice, const labial_voice_utterance_t *utterance, uint32_t start)
{
    uint32_t at = labial_voice_limit(utterance);
    while (at > utterance->first) {
        const uint32_t before = labial_voice_before(voice, utterance, at);
        if (voice->items[before].start < start)
            break;
        at = before;
    }
    return at;
}

/* Notes that the item at `at` stands behind one of `back` places. */
static void link_back(labial_voice_t *voice, labial_voice_utterance_t *utterance, uint32_t at, uint32_t back)
{
    if (at == labial_voice_limit(utterance))
        utterance->tail = (uint8_t)back;
    else
        voice->items[at].back = (uint8_t)back;
}

/* Moves all places from `from` on to `to`, and with them the utterances behind this one. */
static void move_places(labial_voice_t *voice, labial_voice_utterance_t *utterance, uint32_t from, uint32_t to)
{
    labial_voice_utterance_t *other = voice->utterances + voice->utterance_count;
    memmove(voice->items + to, voice->items + from, (size_t)(voice->used - from) * sizeof *voice->items);
    voice->used = voice->used - from + to;
    utterance->places = utterance->places - from + to;
    while (--other > utterance)
        other->first = other->first - from + to;
}

/* What the plan had looked at from `at` on is otherwise. */
static void touch_plan(labial_voice_t *voice, uint32_t at)
{
    if (at < voice->plan.seen)
        voice->stale = 1;
}

void labial_voice_remove(labial_voice_t *voice, labial_voice_utterance_t *utterance, uint32_t from, uint32_t to)
{
    uint32_t back = 0;
    if (from == to)
        return;
    touch_plan(voice, from);
    if (from > utterance->first)
        back = from - labial_voice_before(voice, utterance, from);
    move_places(voice, utterance, to, from);
    link_back(voice, utterance, from, back);
}

void labial_voice_insert(labial_voice_t *voice, labial_voice_utterance_t *utterance, const labial_voice_place_t *item,
                         const char *text)
{
    const uint32_t places = labial_voice_places(item->size);
    const uint32_t at = labial_voice_find(voice, utterance, item->start + 1u);
    uint32_t back = 0;
    touch_plan(voice, at);
    if (at > utterance->first)
        back = at - labial_voice_before(voice, utterance, at);
    move_places(voice, utterance, at, at + places);
    voice->items[at] = *item;
    if (text && item->size > 0u)
        memcpy((char *)(void *)voice->items + (size_t)at * sizeof *item + offsetof(labial_voice_place_t, text), text,
               item->size);
    voice->items[at].back = (uint8_t)back;
    link_back(voice, utterance, at + places, places);
}

/* How much of the time from `from` to `to` lies between `begin` and `end`. */
static uint32_t shared_time(uint32_t from, uint32_t to, uint32_t begin, uint32_t end)
{
    if (begin < from)
        begin = from;
    if (end > to)
        end = to;
    return end > begin ? end - begin : 0u;
}

uint32_t labial_voice_told(const labial_voice_t *voice, const labial_voice_utterance_t *utterance, uint32_t from,
                           uint32_t to)
{
    const uint32_t limit = labial_voice_limit(utterance);
    uint32_t at = labial_voice_find(voice, utterance, from);
    uint32_t sum = shared_time(from, to, 0, utterance->pause) +
                   shared_time(from, to, utterance->pause + utterance->paused, utterance->over);
    if (at > utterance->first)
        at = labial_voice_before(voice, utterance, at);
    for (; at < limit && voice->items[at].start < to; at = labial_voice_after(voice, at)) {
        const labial_voice_place_t *const item = voice->items + at;
        const uint32_t after = labial_voice_after(voice, at);
        uint32_t until = item->end;
        if (after < limit && voice->items[after].start < until)
            until = voice->items[after].start;
        sum += shared_time(from, to, item->start, until);
    }
    return sum;
}

void labial_voice_remove_key(labial_voice_t *voice, labial_voice_utterance_t *utterance, uint16_t key)
{
    uint32_t at = labial_voice_limit(utterance);
    while (at > utterance->first) {
        const uint32_t before = labial_voice_before(voice, utterance, at);
        if (voice->items[before].key == key)
            labial_voice_remove(voice, utterance, before, at);
        at = before;
    }
}

int labial_voice_is_over(const labial_voice_t *voice, uint32_t identity)
{
    unsigned i;
    for (i = 0; i < LABIAL_VOICE_UTTERANCES; i++)
        if (voice->gone[i] == identity)
            return 1;
    return 0;
}

void labial_voice_note_over(labial_voice_t *voice, uint32_t identity)
{
    if (identity == 0u || labial_voice_is_over(voice, identity))
        return;
    voice->gone[voice->over] = identity;
    voice->over = (uint8_t)((voice->over + 1u) % LABIAL_VOICE_UTTERANCES);
}

void labial_voice_remove_utterance(labial_voice_t *voice, unsigned position)
{
    labial_voice_utterance_t *const utterance = voice->utterances + position;
    const unsigned behind = voice->utterance_count - position - 1u;
    voice->stale = 1;
    labial_voice_note_over(voice, utterance->identity);
    if (position > 0u)
        labial_voice_remove(voice, utterance, utterance->first, labial_voice_limit(utterance));
    memmove(utterance, utterance + 1, behind * sizeof *utterance);
    voice->utterance_count--;
    if (voice->utterance_count == 0u)
        voice->used = 0;
}

/* Notes that an utterance was told from `begin` to `end`, which is forgotten: what lies between such times counts as
 * told, but for the longest pause, until something is told in it or before it. */
static void note_told(labial_voice_utterance_t *utterance, uint32_t begin, uint32_t end)
{
    if (begin < utterance->pause + utterance->paused) {
        utterance->pause = utterance->paused = 0;
    } else if (begin > utterance->over && begin - utterance->over > utterance->paused) {
        const uint32_t paused = begin - utterance->over;
        utterance->pause = utterance->over;
        utterance->paused = (uint16_t)(paused < LONGEST_PAUSE ? paused : LONGEST_PAUSE);
    }
    if (end > utterance->over)
        utterance->over = end;
}

/* Forgets the first items of the first utterance, up to a blank where they are characters. */
static void forget_items(labial_voice_t *voice, labial_voice_utterance_t *utterance, int64_t limit)
{
    const uint32_t last = labial_voice_limit(utterance);
    uint32_t at = utterance->first;
    while (at < last) {
        const uint32_t after = labial_voice_after(voice, at);
        const labial_voice_place_t *const item = voice->items + at;
        const uint32_t follows = after < last ? voice->items[after].start : UINT32_MAX;
        const uint32_t end = item->end == LABIAL_VOICE_OPEN ? follows : item->end;
        if (after == last || end >= limit || follows >= limit)
            return;
        if (utterance->kind != LABIAL_VOICE_CHARACTERS || labial_voice_is_blank_item(voice, at)) {
            note_told(utterance, voice->items[utterance->first].start, end);
            utterance->places -= after - utterance->first;
            utterance->first = after;
        }
        at = after;
    }
}

void labial_voice_forget(labial_voice_t *voice, int64_t moment)
{
    const int64_t limit = moment - ITEMS_KEPT - voice->offset;
    while (voice->utterance_count > 1u) {
        const labial_voice_utterance_t *const first = voice->utterances;
        if (first->origin + first->end >= limit || first[1].origin >= limit)
            break;
        labial_voice_remove_utterance(voice, 0);
    }
    if (voice->utterance_count > 0u)
        forget_items(voice, voice->utterances, limit - voice->utterances[0].origin);
}

uint32_t labial_voice_free(const labial_voice_t *voice)
{
    return voice->room - voice->used + voice->utterances[0].first;
}

void labial_voice_pack(labial_voice_t *voice)
{
    labial_voice_utterance_t *const first = voice->utterances;
    const uint32_t front = first->first;
    unsigned i;
    memmove(voice->items, voice->items + front, (size_t)(voice->used - front) * sizeof *voice->items);
    voice->used -= front;
    for (i = 0; i < voice->utterance_count; i++)
        first[i].first -= front;
    voice->stale = 1;
}
