#include "units.h"

#include <string.h>

const labial_segment_t *labial_units_segment(const labial_t *stream, unsigned i)
{
    i += stream->queue_head;
    return &stream->queue[i < LABIAL_QUEUE ? i : i - LABIAL_QUEUE];
}

unsigned labial_units_phoneme(const labial_t *stream, const labial_segment_t *segment, unsigned slot)
{
    return segment->slot == slot ? segment->phoneme : stream->models[slot]->silence;
}

void labial_units_push(labial_t *stream, const labial_segment_t *segment)
{
    unsigned i = (unsigned)stream->queue_head + stream->queue_count;
    stream->queue[i < LABIAL_QUEUE ? i : i - LABIAL_QUEUE] = *segment;
    stream->queue_count++;
    stream->queue_frames += segment->frames;
}

static uint32_t least(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* Frames from segment `i` on that belong to one model, as far as they are known and not more than `most`. */
static uint32_t run_of_model(const labial_t *stream, unsigned i, uint32_t most)
{
    const unsigned slot = labial_units_segment(stream, i)->slot;
    uint32_t frames = 0;
    for (; i < stream->queue_count && frames < most; i++) {
        const labial_segment_t *segment = labial_units_segment(stream, i);
        if (segment->slot != slot)
            return frames;
        frames += segment->frames;
    }
    return least(frames, most);
}

/* Whether everything is known that a piece depends on which ends at `end`: the phonemes within its model's reach, and
 * the neighbour of the phoneme it ends in, which itself ends at `last_end`. */
static int is_known(const labial_t *stream, unsigned slot, uint32_t end, uint32_t last_end)
{
    const labial_model_t *model = stream->models[slot];
    uint32_t ahead = 0;
    if (stream->ended)
        return 1;
    if (model->kernel_taps)
        ahead = ((uint32_t)model->kernel_taps - 1u - model->kernel_behind) * model->kernel_stride;
    return stream->queue_frames >= end + ahead && stream->queue_frames > last_end;
}

unsigned labial_units_first(const labial_t *stream, const labial_piece_t *piece, uint32_t *begin)
{
    unsigned i = 0;
    uint32_t start = 0;
    while (start + labial_units_segment(stream, i)->frames <= piece->begin)
        start += labial_units_segment(stream, i++)->frames;
    *begin = start;
    return i;
}

int labial_units_next(labial_t *stream, labial_piece_t *piece)
{
    const uint32_t begin = stream->next_begin, limit = begin + LABIAL_WINDOW;
    uint32_t start, end = 0, next = 0, last_end = 0;
    unsigned first, i, slot;

    if (begin == stream->queue_frames)
        return stream->ended ? LABIAL_DONE : LABIAL_WAITING;
    piece->begin = begin;
    first = labial_units_first(stream, piece, &start);
    slot = labial_units_segment(stream, first)->slot;

    for (i = first;; i++) {
        const labial_segment_t *segment;
        uint32_t stop;
        if (i == stream->queue_count) { /* the stream's last phoneme ends the last unit */
            if (!stream->ended)
                return LABIAL_WAITING;
            end = next = last_end = start;
            break;
        }
        segment = labial_units_segment(stream, i);
        stop = start + segment->frames;
        if (start == limit || (segment->slot == slot && stop > limit)) { /* the window is full */
            if (end == 0) { /* with a unit that is longer: cut */
                last_end = start == limit ? start : stop;
                end = limit;
                next = end - LABIAL_OVERLAP;
            }
            break;
        }
        if (segment->slot != slot) { /* the model changes: run on into the other's phonemes */
            const uint32_t most = least(least(limit - start, start - begin), LABIAL_OVERLAP);
            end = start + run_of_model(stream, i, most); /* shorter while not all is pushed: then not known either */
            next = start;
            for (last_end = stop; last_end < end;)
                last_end += labial_units_segment(stream, ++i)->frames;
            break;
        }
        if (i > first && stream->models[slot]->phonemes[segment->phoneme].boundary &&
            start >= begin + stream->next_fade_in && i + 1u < stream->queue_count) { /* the end of a unit */
            end = last_end = stop;
            next = end - least(least(segment->frames, (end - begin) / 2u), LABIAL_OVERLAP);
            if (end - begin >= LABIAL_PIECE)
                break;
        }
        start = stop;
    }
    if (!is_known(stream, slot, end, last_end))
        return LABIAL_WAITING;

    piece->length = (uint16_t)(end - begin);
    piece->fade_in = stream->next_fade_in;
    piece->fade_out = (uint16_t)(end - next);
    piece->slot = (uint8_t)slot;
    stream->next_begin = next;
    stream->next_fade_in = piece->fade_out;
    return LABIAL_OK;
}

void labial_units_labels(const labial_t *stream, const labial_piece_t *piece, uint8_t *labels)
{
    const unsigned count = (unsigned)piece->length + 2u * LABIAL_REACH;
    const uint8_t silence = stream->models[piece->slot]->silence;
    uint32_t start = LABIAL_REACH; /* of a segment, counted from the first label, plus piece->begin */
    unsigned i;

    memset(labels, silence, count);
    for (i = 0; i < stream->queue_count && start < piece->begin + count; i++) {
        const labial_segment_t *segment = labial_units_segment(stream, i);
        const uint32_t end = start + segment->frames;
        if (end > piece->begin) {
            const uint32_t from = start > piece->begin ? start - piece->begin : 0;
            const uint32_t to = end - piece->begin < count ? end - piece->begin : count;
            memset(labels + from, (int)labial_units_phoneme(stream, segment, piece->slot), to - from);
        }
        start = end;
    }
}

void labial_units_trim(labial_t *stream)
{
    while (stream->queue_count > 1u) {
        const uint32_t frames = labial_units_segment(stream, 0)->frames;
        if (frames + LABIAL_REACH > stream->next_begin ||
            frames + labial_units_segment(stream, 1)->frames > stream->next_begin)
            return;
        stream->queue_head = (uint16_t)(stream->queue_head + 1u < LABIAL_QUEUE ? stream->queue_head + 1u : 0u);
        stream->queue_count--;
        stream->queue_frames -= frames;
        stream->next_begin -= frames;
    }
}
