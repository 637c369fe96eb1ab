/*
 * input.c - one frame in: from the queue to its target, in the ring of frames.
 */
#include "shape.h"
#include "stream.h"
#include "units.h"

void labial_input_select(labial_t *stream)
{
    labial_spoken_t spoken;
    if (!stream->selected && labial_units_next(&stream->units, stream->models, stream->ended, &spoken)) {
        labial_shape_select(stream->models[spoken.slot], spoken.phoneme, spoken.ms, spoken.previous, spoken.next,
                            &stream->next_shape);
        stream->selected = 1;
    }
}

/* Puts the target of a frame that was taken into the ring. */
static void enter(labial_t *stream, const labial_taken_t *taken)
{
    labial_frame_t *frame = &stream->frames[stream->frame_place];
    if (taken->is_first) {
        stream->shape = stream->next_shape;
        stream->selected = 0;
    }
    frame->contacts = labial_shape_target(stream->models[taken->slot], &stream->shape, taken, frame->target);
    frame->slot = taken->slot;
    frame->marks = taken->marks;
    if ((taken->marks & LABIAL_BEGINS) && (stream->entered || stream->shown))
        stream->begins[0] |= 1u;
}

int labial_input_advance(labial_t *stream)
{
    labial_taken_t taken;
    const unsigned stride = stream->stride;
    int result;
    if (labial_units_at_first(&stream->units, stream->models))
        labial_input_select(stream);
    result = labial_units_take(&stream->units, stream->models, stream->ended, &taken);
    if (result == LABIAL_STARVED || (result == LABIAL_DONE && stream->pending == 0))
        return result;
    stream->phase = labial_ring_next(stream->phase, stride);
    stream->factor_place = labial_ring_next(stream->factor_place, LABIAL_FACTORS_(stride));
    stream->frame_place = labial_ring_next(stream->frame_place, stride + LABIAL_LAG);
    stream->begins[1] = stream->begins[1] << 1 | stream->begins[0] >> 31;
    stream->begins[0] <<= 1;
    if (result == LABIAL_OK)
        enter(stream, &taken);
    else
        stream->beyond++;
    if (stream->entered < 255u)
        stream->entered++;
    return LABIAL_OK;
}
