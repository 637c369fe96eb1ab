#include "units.h"

#include <string.h>

/* The i-th segment of the queue, the oldest being 0. */
static const labial_segment_t *segment_at(const labial_units_t *units, unsigned i)
{
    i += units->head;
    return &units->segments[i < LABIAL_QUEUE ? i : i - LABIAL_QUEUE];
}

/* The phoneme of a segment as the model in `slot` sees it: another model's phonemes are silence. */
static uint8_t phoneme_in(const labial_segment_t *segment, unsigned slot, uint8_t silence)
{
    return segment->slot == slot ? segment->phoneme : silence;
}

void labial_units_forget(labial_units_t *units)
{
    units->head = units->count = 0;
    units->taken = units->frames = 0;
    units->remainder = 500; /* so that frames are those of the rounded sum */
    units->begins = 1;
}

uint32_t labial_units_push(labial_units_t *units, unsigned phoneme, unsigned slot, uint32_t milliseconds,
                           uint32_t frames_per_second)
{
    const uint32_t thousandths = milliseconds * frames_per_second + units->remainder;
    const uint32_t frames = thousandths / 1000u;
    units->remainder = (uint16_t)(thousandths - frames * 1000u);
    if (frames > 0) {
        const unsigned i = (unsigned)units->head + units->count;
        labial_segment_t *segment = &units->segments[i < LABIAL_QUEUE ? i : i - LABIAL_QUEUE];
        segment->frames = frames;
        segment->ms = (uint16_t)(milliseconds < 65535u ? milliseconds : 65535u);
        segment->phoneme = (uint8_t)phoneme;
        segment->slot = (uint8_t)slot;
        units->count++;
        units->frames += frames;
    }
    return frames;
}

int labial_units_hold(const labial_units_t *units, unsigned slot)
{
    unsigned i;
    for (i = 0; i < units->count; i++)
        if (segment_at(units, i)->slot == slot)
            return 1;
    return 0;
}

/* Frames that the model looks ahead, with its kernels and for short contacts. */
static unsigned look_ahead(const labial_model_t *model)
{
    const unsigned reach =
        model->kernel_taps ? (model->kernel_taps - 1u - model->kernel_behind) * model->kernel_stride : 0u;
    const unsigned contact = model->floor_count ? LABIAL_CONTACT_FRAMES : 0u;
    return reach > contact ? reach : contact;
}

/* The middle of frame `frame` of `frames` from 0 to 1, Q14. */
static uint16_t share_of(uint32_t frame, uint32_t frames)
{
    for (; frames >= 65536u; frames >>= 1)
        frame >>= 1;
    return (uint16_t)(((2u * frame + 1u) << 13) / frames);
}

/* Frames of the first of the two phonemes that a long silence is taken as; 0 for all others. */
static uint32_t head_of(const labial_segment_t *segment, const labial_model_t *model)
{
    const unsigned ahead = look_ahead(model);
    return segment->phoneme == model->silence && ahead > 0 && segment->frames > ahead ? segment->frames - ahead : 0u;
}

int labial_units_at_first(const labial_units_t *units, const labial_model_t *const models[LABIAL_MODELS])
{
    const labial_segment_t *segment = segment_at(units, 0);
    return units->count > 0 &&
           (units->taken == 0 || units->taken == head_of(segment, models[segment->slot]));
}

int labial_units_next(const labial_units_t *units, const labial_model_t *const models[LABIAL_MODELS], int ended,
                      labial_spoken_t *spoken)
{
    const labial_segment_t *segment = segment_at(units, 0);
    const labial_model_t *model;
    uint32_t from = units->taken, head;
    unsigned i = 0, slot;
    if (units->count > 0 && !labial_units_at_first(units, models)) { /* the rest of a silence, or the next segment */
        head = head_of(segment, models[segment->slot]);
        i = from > head;
        from = i ? 0u : head;
    }
    if (i >= units->count)
        return 0;
    segment = segment_at(units, i);
    slot = segment->slot;
    model = models[slot];
    head = head_of(segment, model);
    spoken->slot = (uint8_t)slot;
    spoken->phoneme = segment->phoneme;
    spoken->previous = spoken->next = model->silence;
    spoken->ms = segment->ms;
    if (head > 0) {
        const uint16_t tail = (uint16_t)(look_ahead(model) * 1000u / model->frames_per_second);
        spoken->ms = (uint16_t)(from < head ? segment->ms - tail : tail);
    }
    if (from == 0 && i > 0)
        spoken->previous = phoneme_in(segment_at(units, i - 1u), slot, model->silence);
    else if (from == 0 && !units->begins)
        spoken->previous = units->before;
    if (from >= head && i + 1u < units->count)
        spoken->next = phoneme_in(segment_at(units, i + 1u), slot, model->silence);
    return from < head || i + 1u < units->count || ended;
}

/* Moves the labels by a frame and writes those of the frame itself and of the `ahead` behind it; silence from where the
 * solution ends. */
static void relabel(labial_units_t *units, unsigned slot, uint8_t silence, unsigned ahead)
{
    uint8_t *label = units->labels + LABIAL_REACH;
    uint32_t left = segment_at(units, 0)->frames - units->taken;
    unsigned i = 0;
    if (units->begins)
        memset(units->labels, silence, sizeof units->labels);
    else
        memmove(units->labels, units->labels + 1, LABIAL_REACH);
    for (ahead++; ahead > 0 && i < units->count; i++) {
        const labial_segment_t *segment = segment_at(units, i);
        if (segment->slot != slot)
            break;
        if (i > 0)
            left = segment->frames;
        for (; left > 0 && ahead > 0; left--, ahead--)
            *label++ = segment->phoneme;
    }
    for (; ahead > 0; ahead--)
        *label++ = silence;
}

/* Leaves the oldest segment, all of whose frames were taken. */
static void drop(labial_units_t *units, const labial_segment_t *segment)
{
    units->before = segment->phoneme;
    units->taken = 0;
    units->head = (uint8_t)(units->head + 1u < LABIAL_QUEUE ? units->head + 1u : 0u);
    units->count--;
}

int labial_units_take(labial_units_t *units, const labial_model_t *const models[LABIAL_MODELS], int ended,
                      labial_taken_t *taken)
{
    const labial_segment_t *segment = segment_at(units, 0), *next = NULL;
    const labial_model_t *model;
    uint32_t head, begin, frames;
    unsigned ahead;

    if (units->count == 0)
        return ended ? LABIAL_DONE : LABIAL_STARVED;
    model = models[segment->slot];
    ahead = look_ahead(model);
    head = head_of(segment, model);
    if (units->count > 1u)
        next = segment_at(units, 1);
    if (!ended && units->taken >= head && (!next || units->frames <= ahead))
        return LABIAL_STARVED;

    relabel(units, segment->slot, model->silence, ahead);
    taken->labels = units->labels + LABIAL_REACH;
    taken->slot = segment->slot;
    taken->is_first = units->taken == 0 || units->taken == head;
    begin = units->taken < head ? 0u : head;
    frames = (units->taken < head ? head : segment->frames) - begin;
    taken->share = share_of(units->taken - begin, frames);
    if (units->taken == 0)
        units->rested = units->begins; /* nothing leads to where it rests */
    taken->rest = 0;
    if (head > 0 && (units->taken < head || !next || next->slot != segment->slot))
        taken->rest = (uint8_t)(units->taken < LABIAL_REST_FRAMES && !units->rested ? units->taken + 1u
                                                                                    : LABIAL_REST_FRAMES);
    taken->is_open = frames >= LABIAL_CONTACT_LONG && segment->frames - units->taken > LABIAL_CONTACT_LAST;
    taken->marks = (uint8_t)(units->begins ? LABIAL_BEGINS : 0);
    units->begins = 0;
    units->taken++;
    units->frames--;
    if (units->taken == segment->frames) {
        if (!next || next->slot != segment->slot) {
            taken->marks |= LABIAL_ENDS | LABIAL_UNIT_ENDS;
            units->begins = 1;
        } else if (model->phonemes[segment->phoneme].boundary) {
            taken->marks |= LABIAL_UNIT_ENDS;
        }
        drop(units, segment);
    }
    return LABIAL_OK;
}
