/*
 * oracle_shape.c - floors, contact and rest, phoneme by phoneme over the whole of a stream (labial/model.h).
 */
#include "oracle.h"

#include <string.h>

#include "shape.h"
#include "units.h"

/* The rules' numbers, as written down for the model's authors. */
enum { SHORT = 3, LONG = 15, CLOSED = 8, RESTING = 16 };

static const labial_model_t *model_of(const labial_model_t *const *models, const oracle_frame_t *frame)
{
    return models[frame->model];
}

/* The row of `floors` of a phoneme, or null. */
static const int16_t *floor_of(const labial_model_t *model, unsigned phoneme)
{
    const unsigned floor = model->floor_count ? model->phonemes[phoneme].floor : 0;
    return floor ? model->floors + (floor - 1) * LABIAL_CHANNELS : NULL;
}

static unsigned contacts_of(const labial_model_t *model, unsigned phoneme)
{
    return floor_of(model, phoneme) ? model->contacts[model->phonemes[phoneme].floor - 1] : 0;
}

void oracle_shape(const labial_model_t *model, unsigned phoneme, unsigned ms, unsigned previous, unsigned next,
                  labial_shape_t *shape)
{
    labial_selection_t selection;
    memset(&selection, 0x5a, sizeof selection);
    for (selection.halves = 0; selection.halves < 2;)
        labial_shape_select(model, phoneme, (uint16_t)ms, previous, next, &selection);
    *shape = selection.shape;
}

/* What the frame's target is without floors. */
static void aim(const labial_model_t *const *models, const oracle_frame_t *frames, size_t count, size_t at,
                int16_t target[LABIAL_CHANNELS])
{
    const oracle_frame_t *frame = &frames[at];
    labial_model_t bare = *model_of(models, frame);
    uint8_t labels[2 * LABIAL_REACH + 1];
    labial_shape_t shape;
    labial_taken_t taken = { 0, 0, 0, 0, 0, 0, 0 };
    int k;
    bare.floor_count = 0;
    for (k = -LABIAL_REACH; k <= LABIAL_REACH; k++)
        labels[LABIAL_REACH + k] = (uint8_t)oracle_label(models, frames, count, at, k);
    taken.labels = labels + LABIAL_REACH;
    taken.share = (uint16_t)(16384.0 * ((double)frame->number + 0.5) / (double)frame->whole);
    oracle_shape(&bare, frame->phoneme, frame->ms, frame->previous, frame->next, &shape);
    (void)labial_shape_target(&bare, &shape, &taken, target);
}

/* The floors of the frame's own phoneme; returns where these are contact. */
static unsigned keep_floors(const labial_model_t *model, const oracle_frame_t *frame, int16_t target[LABIAL_CHANNELS])
{
    const int16_t *floor = floor_of(model, frame->phoneme);
    const unsigned contacts = contacts_of(model, frame->phoneme);
    const int is_silent = frame->phoneme == model->silence;
    const int is_closed = !is_silent && (frame->whole < LONG || frame->whole - frame->number <= CLOSED);
    unsigned k;
    for (k = 0; floor && k < LABIAL_CHANNELS; k++) {
        const int is_contact = contacts >> k & 1;
        if (is_contact && is_silent)
            target[k] = (int16_t)(target[k] + (floor[k] - target[k]) * (int)frame->rest / RESTING);
        else if ((!is_contact || is_closed) && target[k] < floor[k])
            target[k] = floor[k];
    }
    return is_closed ? contacts : 0;
}

/* A frame that the phoneme beside it borrows; returns where it is in contact with it. */
static unsigned borrow(const labial_model_t *model, unsigned phoneme, int16_t target[LABIAL_CHANNELS])
{
    const int16_t *floor = floor_of(model, phoneme);
    const unsigned contacts = contacts_of(model, phoneme);
    unsigned k;
    for (k = 0; floor && k < LABIAL_CHANNELS; k++)
        if ((contacts >> k & 1) && target[k] < floor[k])
            target[k] = floor[k];
    return contacts;
}

void oracle_targets(const labial_model_t *const *models, const oracle_frame_t *frames, size_t count,
                    int16_t (*targets)[LABIAL_CHANNELS], uint16_t *contacts)
{
    size_t t, end;
    for (t = 0; t < count; t++) {
        aim(models, frames, count, t, targets[t]);
        contacts[t] = (uint16_t)keep_floors(model_of(models, &frames[t]), &frames[t], targets[t]);
    }
    for (t = 0; t < count; t = end) { /* frames t .. end - 1 are alike and of one solution */
        const labial_model_t *model = model_of(models, &frames[t]);
        const unsigned phoneme = frames[t].phoneme;
        for (end = t + 1; end < count && !frames[end].begins && frames[end].phoneme == phoneme;)
            end++;
        if (phoneme == model->silence)
            continue;
        if (end - t < SHORT && !frames[t].begins)
            contacts[t - 1] |= (uint16_t)borrow(model, phoneme, targets[t - 1]);
        if (end - t == 1 && end < count && !frames[end].begins)
            contacts[end] |= (uint16_t)borrow(model, phoneme, targets[end]);
    }
}
