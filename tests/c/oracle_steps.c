/*
 * oracle_steps.c - phonemes to frames, frames to targets, and targets to states, each from the whole of its input.
 */
#include "oracle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "shape.h"
#include "units.h"

/* ---- Units: phonemes to frames ----------------------------------------------------------------------------------- */

typedef struct {
    size_t input; /* the phoneme's number */
    uint64_t begin, end;
} span_t;

static unsigned ahead_of(const labial_model_t *model)
{
    const unsigned kernels =
        model->kernel_taps ? (unsigned)(model->kernel_taps - 1 - model->kernel_behind) * model->kernel_stride : 0;
    const unsigned stops = model->floor_count ? 3 : 0; /* to see whether a phoneme is shorter than that */
    return kernels > stops ? kernels : stops;
}

/* Where every phoneme lies that has a frame: frames are those of the rounded sum of all durations up to it. */
static size_t lay(const labial_model_t *const *models, const fixture_phoneme_t *input, size_t count, span_t *spans)
{
    const uint64_t rate = models[0]->frames_per_second;
    uint64_t ms = 0, end = 0;
    size_t n = 0;
    for (size_t i = 0; i < count; i++) {
        const uint64_t begin = end;
        ms += input[i].ms;
        end = (ms * rate * 2 + 1000) / 2000;
        if (end > begin) {
            spans[n].input = i;
            spans[n].begin = begin;
            spans[n++].end = end;
        }
    }
    return n;
}

/* The phonemes that must be pushed before a frame of span `s` can be taken that needs to see frame `last`. */
static size_t needs(const span_t *spans, size_t n, size_t s, uint64_t last)
{
    size_t i = s + 1;
    while (i < n && spans[i].end <= last)
        i++;
    return i < n ? spans[i].input + 1 : SIZE_MAX;
}

size_t oracle_units(const labial_model_t *const *models, const fixture_phoneme_t *input, size_t count,
                    oracle_frame_t *frames, size_t room)
{
    span_t *spans = (span_t *)fixture_room(count, sizeof *spans);
    size_t total = 0;
    const size_t n = lay(models, input, count, spans);
    for (size_t s = 0; s < n; s++) {
        const fixture_phoneme_t *own = &input[spans[s].input];
        const fixture_phoneme_t *before = s > 0 ? &input[spans[s - 1].input] : NULL;
        const fixture_phoneme_t *behind = s + 1 < n ? &input[spans[s + 1].input] : NULL;
        const labial_model_t *model = models[own->model];
        const unsigned ahead = ahead_of(model), all_ms = own->ms < 65535 ? own->ms : 65535;
        const uint64_t length = spans[s].end - spans[s].begin;
        const uint64_t cut = own->phoneme == model->silence && ahead > 0 && length > ahead ? length - ahead : 0;
        const int begins = !before || before->model != own->model, ends = !behind || behind->model != own->model;
        for (uint64_t i = 0; i < length; i++) {
            oracle_frame_t *frame = &frames[total];
            if (total++ == room)
                abort();
            frame->phoneme = own->phoneme;
            frame->model = own->model;
            frame->previous = begins ? model->silence : before->phoneme;
            frame->next = ends ? model->silence : behind->phoneme;
            frame->ms = all_ms;
            frame->needs = needs(spans, n, s, spans[s].begin + i + ahead);
            if (i < cut) {
                frame->ms = all_ms - ahead * 1000 / model->frames_per_second;
                frame->next = model->silence;
                frame->needs = spans[s].input + 1;
            } else if (cut > 0) {
                frame->ms = ahead * 1000 / model->frames_per_second;
                frame->previous = model->silence;
            }
            frame->is_first = i == 0 || i == cut;
            frame->rest = cut == 0 || (i >= cut && !ends) ? 0 : i < 15 && !begins ? (unsigned)i + 1 : 16;
            frame->number = i < cut ? i : i - cut;
            frame->whole = i < cut ? cut : length - cut;
            frame->begins = begins && i == 0;
            frame->ends = ends && i + 1 == length;
            frame->unit_ends = i + 1 == length && (ends || model->phonemes[own->phoneme].boundary);
        }
    }
    free(spans);
    return total;
}

unsigned oracle_label(const labial_model_t *const *models, const oracle_frame_t *frames, size_t count, size_t at,
                      int offset)
{
    const labial_model_t *model = models[frames[at].model];
    for (; offset > 0; offset--, at++)
        if (frames[at].ends || at + 1 == count)
            return model->silence;
    for (; offset < 0; offset++, at--)
        if (frames[at].begins)
            return model->silence;
    return frames[at].phoneme;
}

/* ---- Floors, contact and rest, phoneme by phoneme over the whole of a stream (labial/model.h) -------------------- */

/* The rules' numbers, as written down for the model's authors. */
enum { SHORT = 3, OPEN = 7, RESTING = 16 };

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

int oracle_is_made(uint64_t number, uint64_t whole)
{
    uint64_t outside = 0; /* frames */
    while (outside < OPEN && whole - outside > SHORT && 2 * (outside + 1) <= whole)
        outside++;
    return number >= outside / 2 && whole - number > outside - outside / 2;
}

/* The floors of the frame's own phoneme; returns where these are contact. */
static unsigned keep_floors(const labial_model_t *model, const oracle_frame_t *frame, int16_t target[LABIAL_CHANNELS])
{
    const int16_t *floor = floor_of(model, frame->phoneme);
    const unsigned contacts = contacts_of(model, frame->phoneme);
    const int is_silent = frame->phoneme == model->silence;
    const int is_closed = !is_silent && oracle_is_made(frame->number, frame->whole);
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

/* ---- The search over a whole solution, with costs that are never cut off ----------------------------------------- */

/* A transition that is dearer than this, or is not in the table, costs as much: it can be leapt. */
#define LEAP 255.0

double oracle_emission(const labial_emission_t *state, int32_t position)
{
    /* A Gaussian's exponent and log sigma. Costs are whole numbers, rounded down, and end where z does, at 1023 / 64. */
    double z = floor(fabs((double)position - state->mean) * fixture_gain_value(state->gain) / 4096.0);
    z = z < 1023.0 ? z : 1023.0;
    return floor(z * z / 128.0) + state->cost;
}

/* Whether state a is the nearer one: of two that are as near the lower mean is, and of equal means the one that is next
 * to the position in order. */
static int is_nearer(const labial_emission_t *emissions, unsigned a, unsigned b, int32_t position)
{
    const double from_a = fabs((double)position - emissions[a].mean),
                 from_b = fabs((double)position - emissions[b].mean);
    if (from_a != from_b)
        return from_a < from_b;
    if (emissions[a].mean != emissions[b].mean)
        return emissions[a].mean < emissions[b].mean;
    return emissions[a].mean < position ? a > b : a < b;
}

unsigned oracle_window(const labial_model_t *model, const labial_channel_t *channel, int32_t position)
{
    const int states = model->state_count, width = states < LABIAL_SEARCHED ? states : LABIAL_SEARCHED;
    unsigned nearest = 0;
    for (unsigned q = 1; q < model->state_count; q++)
        if (is_nearer(channel->emissions, q, nearest, position))
            nearest = q;
    const int first = (int)nearest - width / 2;
    return (unsigned)(first < 0 ? 0 : first > states - width ? states - width : first);
}

/* Cost of the way from state p of a step into state q, ORACLE_NONE when there is none. */
static double through(const labial_model_t *model, const labial_channel_t *channel, const oracle_step_t *before,
                      unsigned p, unsigned q)
{
    double cost = LEAP;
    if (before->cost[p] >= ORACLE_NONE || (before->ends_unit && p != before->best))
        return ORACLE_NONE;
    for (unsigned i = 0; i < 4u * model->predecessor_fours; i++) {
        const labial_transition_t *const transition = &channel->transitions[q * 4u * model->predecessor_fours + i];
        if (transition->predecessor == p && transition->cost < cost)
            cost = transition->cost;
    }
    return before->cost[p] + cost;
}

void oracle_step(const labial_model_t *model, const labial_channel_t *channel, int32_t position,
                 const oracle_step_t *before, oracle_step_t *step)
{
    step->first = oracle_window(model, channel, position);
    step->ends_unit = 0;
    step->best = step->first;
    for (unsigned q = 0; q < model->state_count; q++) {
        step->cost[q] = ORACLE_NONE;
        if (q < step->first || q >= step->first + LABIAL_SEARCHED)
            continue;
        if (!before) {
            step->cost[q] = channel->initials[q];
        } else { /* of ways that cost the same a leap from the best is taken, or that from the lower state */
            step->cost[q] = before->cost[before->best] + LEAP;
            step->from[q] = before->best;
            for (unsigned p = 0; p < model->state_count; p++) {
                const double cost = through(model, channel, before, p, q);
                if (cost < step->cost[q]) {
                    step->cost[q] = cost;
                    step->from[q] = p;
                }
            }
        }
        step->cost[q] += oracle_emission(&channel->emissions[q], position);
        if (step->cost[q] < step->cost[step->best])
            step->best = q;
    }
}

unsigned oracle_traced(const oracle_step_t *steps, size_t from, size_t at)
{
    unsigned state = steps[from].best;
    for (; from > at; from--)
        state = steps[from].from[state];
    return state;
}

/* Whether a channel has its turn with a frame of a stream. */
static int is_turn(const labial_model_t *model, unsigned channel, size_t frame)
{
    return frame % model->search_stride == channel % model->search_stride;
}

void oracle_search(const labial_model_t *model, unsigned channel, const oracle_frame_t *frames,
                   const int16_t (*targets)[LABIAL_CHANNELS], size_t first, size_t count, uint8_t *path)
{
    const size_t stride = model->search_stride;
    oracle_step_t *steps = (oracle_step_t *)fixture_room(count, sizeof *steps);
    size_t *block = (size_t *)fixture_room(count, sizeof *block); /* of each frame */
    size_t begin = 0, blocks = 0;
    for (size_t t = 0; t < count; t++) {
        block[t] = blocks;
        if (is_turn(model, channel, first + t) || t + 1 == count) {
            size_t turn = first + t; /* of the whole block */
            while (!is_turn(model, channel, turn))
                turn++;
            size_t seen =
                turn + 1 + stride / 2 < first + begin + stride ? begin : turn + 1 + stride / 2 - stride - first;
            seen = seen > t ? t : seen;
            oracle_step(model, &model->channels[channel], targets[seen][channel], blocks ? &steps[blocks - 1] : NULL,
                        &steps[blocks]);
            for (size_t i = begin; i <= t; i++)
                steps[blocks].ends_unit |= frames[i].unit_ends;
            blocks++;
            begin = t + 1;
        }
    }
    for (size_t t = 0; t < count; t++) {
        size_t end = block[t], known = t + LABIAL_LAG;
        while (known < count && !is_turn(model, channel, first + known))
            known++;
        known = known < count ? block[known] : blocks - 1;
        while (end < known && !steps[end].ends_unit)
            end++;
        path[t] = (uint8_t)oracle_traced(steps, end, block[t]);
    }
    free(steps);
    free(block);
}
