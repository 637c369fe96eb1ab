/*
 * units.c - phonemes to frames (units.h).
 */
#include "units.h"

#include <string.h>

#include "fixed.h"

const labial_segment_t *labial_units_at(const labial_units_t *units, unsigned i)
{
    i += units->head;
    return &units->segments[i < LABIAL_QUEUE ? i : i - LABIAL_QUEUE];
}

void labial_units_reset(labial_units_t *units)
{
    units->head = units->count = 0;
    units->taken = units->frames = 0;
    units->remainder = 500; /* one half: rounds the sum of the durations */
    units->begins = 1;
}

void labial_units_go_back(labial_units_t *units, uint32_t frames)
{
    if (frames <= LABIAL_REACH)
        memmove(units->labels + frames, units->labels, sizeof units->labels - frames);
}

uint32_t labial_units_push(labial_units_t *units, unsigned phoneme, unsigned slot, uint32_t milliseconds,
                           uint32_t frames_per_second)
{
    const uint32_t thousandths = milliseconds * frames_per_second + units->remainder;
    const uint32_t frames = labial_quotient(thousandths, 1000u);
    units->remainder = (uint16_t)(thousandths - frames * 1000u);
    if (frames > 0) {
        unsigned i = (unsigned)units->head + units->count;
        labial_segment_t *segment = &units->segments[i < LABIAL_QUEUE ? i : i - LABIAL_QUEUE];
        segment->frames = frames;
        segment->ms = (uint16_t)(milliseconds < 65535u ? milliseconds : 65535u);
        segment->phoneme = (uint8_t)phoneme;
        segment->slot = (uint8_t)slot;
        units->count++;
        units->frames += frames;
        for (i = 0; i < LABIAL_MODELS; i++)
            units->since[i] += frames;
        units->since[slot] = 0;
    }
    return frames;
}

unsigned labial_units_ahead(const labial_model_t *model)
{
    const int reach = (model->kernel_taps - 1 - model->kernel_behind) * model->kernel_stride; /* below 0 without taps */
    const int contact = model->floor_count ? LABIAL_CONTACT_FRAMES : 0;
    return (unsigned)(reach > contact ? reach : contact);
}

/* The middle of frame `frame` of `frames` from 0 to 1, Q14. */
static uint16_t share_of(uint32_t frame, uint32_t frames)
{
    /* No phoneme is empty, nor is either part of a long silence. */
    /*@ assert frames > 0; */
    LABIAL_CHECK(frames > 0);
    for (; frames >= 65536u; frames >>= 1)
        frame >>= 1;
    return (uint16_t)labial_quotient((2u * frame + 1u) << 13, frames);
}

/* Frames of the first of the two phonemes that stand for a long silence; 0 for all other phonemes. */
static uint32_t head_of(const labial_segment_t *segment, const labial_model_t *model)
{
    const unsigned ahead = labial_units_ahead(model);
    return segment->phoneme == model->silence && ahead > 0 && segment->frames > ahead ? segment->frames - ahead : 0u;
}

uint32_t labial_units_left(const labial_units_t *units, const labial_model_t *const models[LABIAL_MODELS])
{
    const labial_segment_t *segment = labial_units_at(units, 0);
    uint32_t head;
    if (units->count == 0 || units->taken == 0)
        return 0;
    head = head_of(segment, models[segment->slot]);
    return (units->taken <= head ? head : segment->frames) - units->taken;
}

int labial_units_next(const labial_units_t *units, const labial_model_t *const models[LABIAL_MODELS], int ended,
                      labial_spoken_t *spoken)
{
    const labial_segment_t *segment = labial_units_at(units, 0);
    const unsigned before = segment->slot; /* model of the latest frame, unless a solution begins */
    const labial_model_t *model;
    uint32_t from = units->taken + labial_units_left(units, models), head;
    unsigned i = 0, slot;
    if (from == segment->frames) { /* in the next segment */
        i = 1;
        from = 0;
    }
    if (i >= units->count)
        return 0;
    segment = labial_units_at(units, i);
    slot = segment->slot;
    model = models[slot];
    head = head_of(segment, model);
    spoken->slot = (uint8_t)slot;
    spoken->phoneme = segment->phoneme;
    spoken->previous = spoken->next = model->silence;
    if (!units->begins && before == slot)
        spoken->previous = units->labels[LABIAL_REACH];
    spoken->ms = segment->ms;
    if (head > 0) {
        const uint16_t tail = (uint16_t)labial_quotient((segment->frames - head) * 1000u, model->frames_per_second);
        spoken->ms = (uint16_t)(from == 0 ? segment->ms - tail : tail);
        if (from == 0)
            return 1;
    }
    if (i + 1u >= units->count)
        return ended;
    segment = labial_units_at(units, i + 1u);
    if (segment->slot == slot)
        spoken->next = segment->phoneme;
    return 1;
}

/* The label of the frame behind those that have one, the last of which is `before`; silence after the end of the
 * solution. */
static uint8_t next_label(labial_units_t *units, unsigned slot, uint8_t silence, uint8_t before)
{
    const labial_segment_t *segment;
    if (units->unlabelled > 0) {
        units->unlabelled--;
        return before;
    }
    if (units->labelled >= units->count)
        return silence;
    segment = labial_units_at(units, units->labelled);
    if (segment->slot != slot)
        return silence;
    units->labelled++;
    units->unlabelled = segment->frames - 1u;
    return segment->phoneme;
}

/* Moves the labels by a frame, to those of the frame itself and of the `ahead` frames after it. */
static void relabel(labial_units_t *units, unsigned slot, uint8_t silence, unsigned ahead)
{
    uint8_t *const last = units->labels + LABIAL_REACH + ahead;
    uint8_t *label = last, before = *last;
    if (units->begins) {
        memset(units->labels, silence, sizeof units->labels);
        units->labelled = 0;
        units->unlabelled = 0;
        label = units->labels + LABIAL_REACH;
    } else {
        memmove(units->labels, units->labels + 1, LABIAL_REACH + ahead);
    }
    for (; label <= last; label++)
        *label = before = next_label(units, slot, silence, before);
}

/* Whether frame `frame` of a phoneme of `frames` lies outside of its contact, which the middle half of its frames make,
 * but LABIAL_CONTACT_FRAMES of them at least, and all but LABIAL_CONTACT_OPEN. */
static int lies_open(uint32_t frame, uint32_t frames)
{
    int32_t open = LABIAL_CONTACT_OPEN; /* frames; below 0 as many as are borrowed */
    if (frames < 2u * LABIAL_CONTACT_FRAMES)
        open = (int32_t)frames - LABIAL_CONTACT_FRAMES;
    else if (frames < 2u * LABIAL_CONTACT_OPEN)
        open = (int32_t)frames / 2;
    return frame - (uint32_t)(open >> 1) >= frames - (uint32_t)open;
}

/* Progress to rest in a pause, before its last frames, which lead to the next phoneme. */
static uint8_t rest_of(labial_units_t *units)
{
    if (units->taken == 0)
        units->rested = units->begins; /* a stream that begins with a pause begins at rest */
    return (uint8_t)(units->taken < LABIAL_REST_FRAMES && !units->rested ? units->taken + 1u : LABIAL_REST_FRAMES);
}

/* Advances to the next frame, of the next segment where this one ends; returns the marks of the accepted frame. */
static unsigned go_on(labial_units_t *units, const labial_segment_t *segment, unsigned boundary, int is_last)
{
    unsigned marks = units->begins * (unsigned)LABIAL_BEGINS;
    units->begins = 0;
    units->taken++;
    units->frames--;
    if (units->taken < segment->frames)
        return marks;
    marks |= is_last ? LABIAL_ENDS | LABIAL_UNIT_ENDS : boundary * (unsigned)LABIAL_UNIT_ENDS;
    units->begins = (uint8_t)is_last;
    units->taken = 0;
    units->head = (uint8_t)(units->head + 1u < LABIAL_QUEUE ? units->head + 1u : 0u);
    units->count--;
    units->labelled--; /* it had labels: this frame's */
    return marks;
}

int labial_units_take(labial_units_t *units, const labial_model_t *const models[LABIAL_MODELS], int ended,
                      labial_taken_t *taken)
{
    const labial_segment_t *segment = labial_units_at(units, 0);
    const labial_model_t *model;
    uint32_t head, frames, at = units->taken; /* its place in its phoneme, which has so many */
    unsigned ahead;
    int is_last; /* of its solution */

    if (units->count == 0)
        return ended ? LABIAL_DONE : LABIAL_STARVED;
    model = models[segment->slot];
    ahead = labial_units_ahead(model);
    head = head_of(segment, model);
    if (!ended && at >= head && (units->count == 1u || units->frames <= ahead))
        return LABIAL_STARVED;

    relabel(units, segment->slot, model->silence, ahead);
    taken->labels = units->labels + LABIAL_REACH;
    taken->slot = segment->slot;
    is_last = units->count == 1u || labial_units_at(units, 1)->slot != segment->slot;
    frames = head;
    if (at >= head) {
        at -= head;
        frames = segment->frames - head;
    }
    taken->is_first = at == 0;
    taken->share = share_of(at, frames);
    taken->is_open = (uint8_t)lies_open(at, frames);
    taken->rest = 0;
    if (units->taken < head || (head > 0 && is_last))
        taken->rest = rest_of(units);
    taken->marks = (uint8_t)go_on(units, segment, model->phonemes[segment->phoneme].boundary, is_last);
#if LABIAL_PAPER
    taken->marks = (uint8_t)(taken->marks | (taken->is_first ? LABIAL_PHONEME_BEGINS : 0));
#endif
    return LABIAL_OK;
}
