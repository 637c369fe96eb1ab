/*
 * rig.c - FAPs to servos and blendshapes. Independent of the stream, so that either can be linked without the other.
 */
#include "labial/rig.h"

#include <stddef.h>

#include "fixed.h"
#include "rig_parts.h"

/* Channels of FAP 51 and FAP 52: the opening of the lips is minus their sum. */
#define UPPER_LIP 3
#define LOWER_LIP 4

#define CONTACT_ONE 16777216

/* Beyond every limit of a value, with room for adding a neutral. */
#define MOVE_MAX 1073741824

/* Beyond the distance of any two values of a checked table. */
#define ROOM_MAX 33554432

static int within(int32_t value, int32_t limit)
{
    return value >= -limit && value <= limit;
}

static int closing_is_sound(const labial_rig_output_t *output)
{
    if (output->contact)
        return output->contact == 1 && output->closed >= output->minimum && output->closed <= output->maximum;
    return output->closed == 0;
}

static int curve_is_sound(const labial_rig_curve_t *curve)
{
    unsigned i;
    if (!curve)
        return 1;
    if (curve->count < 1 || curve->count > LABIAL_RIG_SEGMENTS)
        return 0;
    for (i = 0; i < curve->count; i++) {
        const labial_rig_segment_t *segment = &curve->segments[i];
        if (!within(segment->from, LABIAL_RIG_VALUE_MAX) || !within(segment->to, LABIAL_RIG_VALUE_MAX) ||
            !within(segment->slope, LABIAL_RIG_SLOPE_MAX) || (i > 0 && segment->from <= segment[-1].from))
            return 0;
    }
    return 1;
}

static int output_is_sound(const labial_rig_output_t *output)
{
    int32_t sum = 0;
    unsigned i;
    for (i = 0; i < LABIAL_CHANNELS; i++)
        sum += output->weights[i] < 0 ? -output->weights[i] : output->weights[i];
    return sum <= LABIAL_RIG_WEIGHT_SUM_MAX && within(output->gain, LABIAL_RIG_GAIN_MAX) &&
           within(output->neutral, LABIAL_RIG_VALUE_MAX) && within(output->minimum, LABIAL_RIG_VALUE_MAX) &&
           within(output->maximum, LABIAL_RIG_VALUE_MAX) && output->minimum <= output->maximum && output->slew >= 0 &&
           output->slew <= LABIAL_RIG_VALUE_MAX && output->deadband >= 0 && output->deadband <= LABIAL_RIG_VALUE_MAX &&
           output->acceleration >= 0 && output->acceleration <= LABIAL_RIG_VALUE_MAX && output->invert <= 1 &&
           closing_is_sound(output) && curve_is_sound(output->curve);
}

int32_t labial_rig_limited(const labial_rig_output_t *output, int32_t value)
{
    if (value < output->minimum)
        value = output->minimum;
    return value > output->maximum ? output->maximum : value;
}

/* a * b / 2^shift, rounded to the nearest, halves up: by the product's bit below the point. */
static int32_t scaled(int32_t a, int32_t b, unsigned shift)
{
    return labial_add(labial_mulshift(a, b, shift), labial_mulshift(a, b, shift - 1u) & 1);
}

/* How much the lips touch, Q24. */
static int32_t contact(const int16_t faps[LABIAL_CHANNELS])
{
    const int32_t apart = LABIAL_RIG_APART + (int32_t)faps[UPPER_LIP] + faps[LOWER_LIP];
    if (apart <= 0)
        return 0;
    if (apart >= LABIAL_RIG_APART - LABIAL_RIG_TOUCHING)
        return CONTACT_ONE;
    return apart * (CONTACT_ONE / (LABIAL_RIG_APART - LABIAL_RIG_TOUCHING));
}

/* A curve's value; `linear` is limited to the range of checked tables. */
static int32_t bent(const labial_rig_curve_t *curve, int32_t linear)
{
    const labial_rig_segment_t *segment = curve->segments;
    unsigned i;
    linear = labial_clamp(linear, LABIAL_RIG_VALUE_MAX);
    for (i = 1; i < LABIAL_RIG_SEGMENTS && i < curve->count && linear >= curve->segments[i].from; i++)
        segment = &curve->segments[i];
    /* Below 2^25 units times 2^25, Q20: the sum stays below 2^31. */
    return labial_add(segment->to, scaled(labial_sub(linear, segment->from), segment->slope, 20));
}

/* What the shares of a frame's sounds add: below 2^23, since no amount exceeds 2^15 and no share 2^8. */
static int32_t sounding(const int16_t amounts[LABIAL_VISEMES], const uint8_t shares[LABIAL_VISEMES])
{
    int32_t sum = LABIAL_VISEME_ONE / 2;
    unsigned i;
    for (i = 0; i < LABIAL_VISEMES; i++)
        sum += (int32_t)amounts[i] * shares[i];
    return sum >> 7;
}

int32_t labial_rig_target(const labial_rig_output_t *output, const int16_t faps[LABIAL_CHANNELS], const uint8_t *shares)
{
    /* Q12 FAP. The weights' limit keeps it within 65,535 * 2^15, below 2^31; the gain's limit then keeps the product of
     * Q12 and Q16 below 2^59, and the move below 2^31. */
    int32_t mix = 0, move, value;
    unsigned i;
    for (i = 0; i < LABIAL_CHANNELS; i++)
        mix = labial_add(mix, (int32_t)output->weights[i] * faps[i]);
    move = labial_clamp(scaled(mix, output->gain, 28), MOVE_MAX);
    value = labial_add(output->neutral, output->invert ? -move : move);
    if (shares && output->visemes)
        value = labial_add(value, sounding(output->visemes, shares));
    value = labial_rig_limited(output, output->curve ? bent(output->curve, value) : value);
    if (output->contact) /* both values are within the limits, and so is what lies between them */
        value =
            labial_rig_limited(output, labial_add(value, scaled(labial_sub(output->closed, value), contact(faps), 24)));
    return value;
}

int labial_rig_check(const labial_rig_t *rig)
{
    unsigned i;
    if (!rig || !rig->outputs)
        return LABIAL_ERROR_NULL;
    for (i = 0; i < rig->count; i++)
        if (!output_is_sound(&rig->outputs[i]))
            return LABIAL_ERROR_RIG;
    return rig->count > 0 ? LABIAL_OK : LABIAL_ERROR_RIG;
}

int32_t labial_rig_resting(const labial_rig_output_t *output)
{
    return labial_rig_limited(output, output->contact ? output->closed : output->neutral);
}

int labial_rig_rest(const labial_rig_t *rig, int32_t *values)
{
    unsigned i;
    if (!rig || !rig->outputs || !values)
        return LABIAL_ERROR_NULL;
    for (i = 0; i < rig->count; i++)
        values[i] = labial_rig_resting(&rig->outputs[i]);
    return LABIAL_OK;
}

/* `wanted`, limited to a distance of `room` from `closed`: how much the value can change until lips touch. */
static int32_t towards_closed(const labial_rig_output_t *output, int32_t wanted, int32_t room)
{
    const int32_t low = labial_sub(output->closed, room), high = labial_add(output->closed, room);
    if (wanted < low)
        wanted = low;
    return labial_rig_limited(output, wanted > high ? high : wanted);
}

static int is_below(int32_t change, int32_t deadband)
{
    return change < deadband && labial_sub(0, change) < deadband;
}

/* The next value within a limit of speed. What leads to rest is never too little. */
static int32_t moved(const labial_rig_output_t *output, int32_t last, int32_t wanted)
{
    const int32_t change = labial_sub(wanted, last);
    if (is_below(change, output->deadband) && wanted != labial_rig_resting(output))
        return last;
    return output->slew > 0 ? labial_add(last, labial_clamp(change, output->slew)) : wanted;
}

int labial_rig_apply(const labial_rig_t *rig, const int16_t faps[LABIAL_CHANNELS], int32_t *values)
{
    return labial_rig_apply_visemes(rig, faps, NULL, values);
}

int labial_rig_apply_visemes(const labial_rig_t *rig, const int16_t faps[LABIAL_CHANNELS], const uint8_t *shares,
                             int32_t *values)
{
    unsigned i;
    if (!rig || !rig->outputs || !faps || !values)
        return LABIAL_ERROR_NULL;
    for (i = 0; i < rig->count; i++) {
        const labial_rig_output_t *output = &rig->outputs[i];
        values[i] = moved(output, labial_rig_limited(output, values[i]), labial_rig_target(output, faps, shares));
    }
    return LABIAL_OK;
}

/* ---- Limits of acceleration -------------------------------------------------------------------------------------- */

/* Computes `highest`. Slowing down to a target over k frames covers the same `room` as speeding up over k frames. */
static void look_up(labial_sight_t *sight)
{
    unsigned i, k;
    for (i = 0; i < LABIAL_RIG_SIGHT; i++) {
        int32_t room = 0, step = 0, lowest = INT32_MAX;
        for (k = i; k < sight->count; k++) {
            const int32_t above = sight->wanted[k] > sight->rest ? sight->wanted[k] : sight->rest;
            const int32_t most = labial_add(above, room);
            lowest = most < lowest ? most : lowest;
            step = labial_add(step, sight->acceleration);
            step = step > sight->speed ? sight->speed : step;
            room = labial_add(room, step);
            room = room > ROOM_MAX ? ROOM_MAX : room;
        }
        sight->highest[i] = lowest;
    }
}

/* Whether a value that moves on from `value` by `change`, and brakes from then on, stays below `highest`. */
static int stays_below(const labial_sight_t *sight, int32_t value, int32_t change)
{
    unsigned i;
    for (i = 0;; i++) {
        value = labial_add(value, change);
        if (value > sight->highest[i < sight->count ? i : sight->count - 1u])
            return 0;
        if (i + 1u >= sight->count && change <= 0)
            return 1;
        change = labial_sub(change, sight->acceleration);
        change = change < -sight->speed ? -sight->speed : change;
    }
}

/* The change that is nearest to `change` and stays below `highest`; `least` where none does. */
static int32_t not_above(const labial_sight_t *sight, int32_t value, int32_t change, int32_t least)
{
    int32_t low = least, high = change;
    if (stays_below(sight, value, change) || !stays_below(sight, value, least))
        return stays_below(sight, value, change) ? change : least;
    while (labial_sub(high, low) > 1) {
        const int32_t middle = labial_add(low, labial_sub(high, low) / 2);
        if (stays_below(sight, value, middle))
            low = middle;
        else
            high = middle;
    }
    return low;
}

static void mirror(labial_sight_t *sight)
{
    unsigned i;
    for (i = 0; i < sight->count; i++)
        sight->wanted[i] = labial_sub(0, sight->wanted[i]);
    sight->rest = labial_sub(0, sight->rest);
}

/* The next change of a value that is at `last` and changed by `change`. Not crossing the rest value has priority: where
 * the value cannot be both in time and slow enough, it is late. */
static int32_t steer(labial_sight_t *sight, int32_t last, int32_t change, int32_t deadband)
{
    const int flip = last < sight->rest;
    int32_t least, most, next;
    if (flip) {
        mirror(sight);
        last = labial_sub(0, last);
        change = labial_sub(0, change);
    }
    change = labial_clamp(change, sight->speed);
    least = labial_clamp(labial_sub(change, sight->acceleration), sight->speed);
    most = labial_clamp(labial_add(change, sight->acceleration), sight->speed);
    next = labial_sub(sight->wanted[0], last);
    if (is_below(next, deadband) && sight->wanted[0] != sight->rest)
        next = 0;
    next = next < least ? least : next > most ? most : next;
    look_up(sight);
    next = not_above(sight, last, next, least);
    mirror(sight);
    look_up(sight);
    next = labial_sub(0, not_above(sight, labial_sub(0, last), labial_sub(0, next), labial_sub(0, most)));
    return flip ? labial_sub(0, next) : next;
}

/* The next value within limits of speed and acceleration. */
static int32_t steered(const labial_rig_output_t *output, labial_sight_t *sight, int32_t last, int32_t change)
{
    sight->rest = labial_rig_resting(output);
    sight->acceleration = labial_clamp(output->acceleration, LABIAL_RIG_VALUE_MAX);
    sight->speed =
        labial_clamp(output->slew > 0 ? output->slew : LABIAL_RIG_VALUE_MAX, LABIAL_RIG_SIGHT * sight->acceleration);
    return labial_rig_limited(output, labial_add(last, steer(sight, last, change, output->deadband)));
}

/* The next value within a limit of speed, on the way to `wanted`; lips touch in the frame `touch`. */
static int32_t slewed(const labial_rig_output_t *output, int32_t wanted, uint32_t touch, int32_t last)
{
    if (output->contact && output->slew > 0 && touch != LABIAL_RIG_NEVER) {
        int32_t room = 0;
        for (; touch > 0 && room < ROOM_MAX; touch--)
            room = labial_add(room, output->slew);
        wanted = towards_closed(output, wanted, room);
    }
    return moved(output, last, wanted);
}

int32_t labial_rig_step(const labial_rig_output_t *output, labial_sight_t *sight, uint32_t touch, int32_t last,
                        int32_t change)
{
    return output->acceleration > 0 ? steered(output, sight, last, change)
                                    : slewed(output, sight->wanted[0], touch, last);
}

/* The shares of the sounds of frame number k, null if there are none. */
static const uint8_t *shares_of(const uint8_t *shares, unsigned k)
{
    return shares ? shares + (size_t)LABIAL_VISEMES * k : NULL;
}

int labial_rig_apply_ahead(const labial_rig_t *rig, const int16_t *frames, uint16_t count, int32_t *values,
                           int32_t *changes)
{
    return labial_rig_apply_visemes_ahead(rig, frames, NULL, count, values, changes);
}

int labial_rig_apply_visemes_ahead(const labial_rig_t *rig, const int16_t *frames, const uint8_t *shares,
                                   uint16_t count, int32_t *values, int32_t *changes)
{
    unsigned i, k;
    uint32_t touch = 0;
    labial_sight_t sight;
    if (!rig || !rig->outputs || !frames || !values || count == 0)
        return LABIAL_ERROR_NULL;
    while (touch < count && contact(frames + (size_t)LABIAL_CHANNELS * touch) < CONTACT_ONE)
        touch++;
    if (touch == count)
        touch = LABIAL_RIG_NEVER;
    for (i = 0; i < rig->count; i++) {
        const labial_rig_output_t *output = &rig->outputs[i];
        const int32_t last = labial_rig_limited(output, values[i]);
        if (changes && output->acceleration > 0) {
            sight.count = count < LABIAL_RIG_SIGHT ? count : LABIAL_RIG_SIGHT;
            for (k = 0; k < LABIAL_RIG_SIGHT; k++)
                sight.wanted[k] = k < sight.count ? labial_rig_target(output, frames + (size_t)LABIAL_CHANNELS * k,
                                                                      shares_of(shares, k))
                                                  : 0;
            values[i] = steered(output, &sight, last, changes[i]);
        } else {
            values[i] = slewed(output, labial_rig_target(output, frames, shares), touch, last);
        }
        if (changes)
            changes[i] = labial_sub(values[i], last);
    }
    return LABIAL_OK;
}
