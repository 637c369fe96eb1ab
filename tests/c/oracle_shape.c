/*
 * oracle_shape.c - floors, contact and rest, phoneme by phoneme over the whole of a stream (labial/model.h).
 */
#include "oracle.h"

#include <string.h>

#include "shape.h"
#include "units.h"

/* The rules' numbers, as written down for the model's authors. */
enum { SHORT = 3, LONG = 15, CLOSED = 8, RESTING = 16 };

/* FAP units that the lips part by: those of FAPs 51, 52, 55 to 58. */
static const int PARTED[LABIAL_CHANNELS] = { 0, 0, 0, 28, 100, 0, 0, 25, 25, 86, 86, 0, 0 };

static const labial_model_t *model_of(const labial_model_t *const *models, const oracle_frame_t *frame)
{
    return models[frame->model];
}

/* The row of `floors` of a phoneme, or null. */
static const int16_t *floor_of(const labial_model_t *model, unsigned phoneme)
{
    const unsigned floor = model->floor_count ? model->phonemes[phoneme].floor : 0;
    return floor ? model->floors + (floor - 1) * model->channel_count : NULL;
}

static unsigned contacts_of(const labial_model_t *model, unsigned phoneme)
{
    return floor_of(model, phoneme) ? model->contacts[model->phonemes[phoneme].floor - 1] : 0;
}

void oracle_shape(const labial_model_t *model, unsigned phoneme, unsigned ms, unsigned previous, unsigned next,
                  labial_shape_t *shape)
{
    const labial_spoken_t spoken = { 0, (uint8_t)phoneme, (uint8_t)previous, (uint8_t)next, (uint16_t)ms };
    labial_selection_t selection;
    memset(&selection, 0x5a, sizeof selection);
    selection.shape = shape;
    for (selection.halves = 0; selection.halves < 2;)
        labial_shape_select(model, &spoken, &selection);
}

/* What the frame's target is without floors. */
static void aim(const labial_model_t *const *models, const oracle_frame_t *frames, size_t count, size_t at,
                int16_t target[LABIAL_CHANNELS])
{
    const oracle_frame_t *frame = &frames[at];
    labial_model_t bare = *model_of(models, frame);
    uint8_t labels[2 * LABIAL_REACH + 1];
    labial_shape_t shape[LABIAL_CHANNELS];
    labial_taken_t taken = { 0, 0, 0, 0, 0, 0, 0 };
    bare.floor_count = 0;
    for (int k = -LABIAL_REACH; k <= LABIAL_REACH; k++)
        labels[LABIAL_REACH + k] = (uint8_t)oracle_label(models, frames, count, at, k);
    taken.labels = labels + LABIAL_REACH;
    taken.share = (uint16_t)(16384.0 * ((double)frame->number + 0.5) / (double)frame->whole);
    oracle_shape(&bare, frame->phoneme, frame->ms, frame->previous, frame->next, shape);
    (void)labial_shape_target(&bare, shape, &taken, target);
}

/* Whether a contact of `whole` frames is made in frame `number`: in as many in the middle as half of them, rounded up, or
 * three; an odd frame is left at the end. Of those of a long one the last alone. */
static int is_made(uint64_t number, uint64_t whole)
{
    uint64_t outside = 0; /* frames */
    if (whole >= LONG)
        return whole - number <= CLOSED;
    while (whole - outside > SHORT && 2 * (outside + 1) <= whole)
        outside++;
    return number >= outside / 2 && whole - number > outside - outside / 2;
}

/* The floors of the frame's own phoneme; returns where these are contact. */
static unsigned keep_floors(const labial_model_t *model, const oracle_frame_t *frame, int16_t target[LABIAL_CHANNELS])
{
    const int16_t *floor = floor_of(model, frame->phoneme);
    const unsigned contacts = contacts_of(model, frame->phoneme);
    const int is_silent = frame->phoneme == model->silence;
    const int is_closed = !is_silent && is_made(frame->number, frame->whole);
    for (unsigned k = 0; floor && k < model->channel_count; k++) {
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
    for (unsigned k = 0; floor && k < model->channel_count; k++)
        if ((contacts >> k & 1) && target[k] < floor[k])
            target[k] = floor[k];
    return contacts;
}

/* Parts the lips in frames `from` to `to`, between two phonemes that make contact, where no contact borrows them. */
static void part(const labial_model_t *model, unsigned last, unsigned next, size_t from, size_t to,
                 int16_t (*targets)[LABIAL_CHANNELS], const uint16_t *contacts)
{
    const int16_t *one = floor_of(model, last), *other = floor_of(model, next);
    const unsigned both = contacts_of(model, last) & contacts_of(model, next);
    for (size_t t = from; t < to; t++) {
        if (contacts[t])
            continue;
        for (unsigned fap = 0; fap < LABIAL_CHANNELS; fap++) {
            const unsigned k = model->sources[fap];
            if (PARTED[fap] == 0 || !(both >> k & 1) || one[k] == -16384 || other[k] == -16384)
                continue;
            int most = (one[k] < other[k] ? one[k] : other[k]) - 16 * PARTED[fap];
            most = most < -LABIAL_POSITION_MAX ? -LABIAL_POSITION_MAX : most;
            if (targets[t][k] > most)
                targets[t][k] = (int16_t)most;
        }
    }
}

/* Looks through a solution for contacts that are close to one another. */
static void part_close_contacts(const labial_model_t *const *models, const oracle_frame_t *frames, size_t count,
                                int16_t (*targets)[LABIAL_CHANNELS], const uint16_t *contacts)
{
    size_t t, last = 0; /* the latest frame of a phoneme that makes contact, which `seen` says there is */
    int seen = 0;
    for (t = 0; t < count; t++) {
        const labial_model_t *model = model_of(models, &frames[t]);
        seen = seen && !frames[t].begins && frames[t].phoneme != model->silence;
        if (frames[t].phoneme == model->silence || !contacts_of(model, frames[t].phoneme))
            continue;
        if (seen && t - last <= SHORT + 1)
            part(model, frames[last].phoneme, frames[t].phoneme, last + 1, t, targets, contacts);
        last = t;
        seen = 1;
    }
}

void oracle_targets(const labial_model_t *const *models, const oracle_frame_t *frames, size_t count,
                    int16_t (*targets)[LABIAL_CHANNELS], uint16_t *contacts)
{
    size_t end;
    for (size_t t = 0; t < count; t++) {
        aim(models, frames, count, t, targets[t]);
        contacts[t] = (uint16_t)keep_floors(model_of(models, &frames[t]), &frames[t], targets[t]);
    }
    for (size_t t = 0; t < count; t = end) { /* frames t .. end - 1 are alike and of one solution */
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
    part_close_contacts(models, frames, count, targets, contacts);
}
