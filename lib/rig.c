/*
 * rig.c - FAPs to servos and blendshapes. Uses nothing of the stream, so that either can be linked without the other.
 */
#include "labial/rig.h"

#include <stddef.h>

#include "fixed.h"

/* Channels of FAP 51 and FAP 52, whose sum is below 0 by as much as the lips are open. */
#define UPPER_LIP 3
#define LOWER_LIP 4

#define CONTACT_ONE 16777216

/* Beyond every limit a value may have, with room for a neutral on top. */
#define MOVE_MAX 1073741824

/* No two values of a checked table are as far apart. */
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
           output->invert <= 1 && closing_is_sound(output);
}

/* value within the output's limits; the maximum where a table that was not checked has them crossed. */
static int32_t limited(const labial_rig_output_t *output, int32_t value)
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

static int32_t target(const labial_rig_output_t *output, const int16_t faps[LABIAL_CHANNELS])
{
    /* Q12 FAP. The weights' limit keeps it within 65,535 * 2^15, below 2^31; the gain's limit then keeps the product of
     * Q12 and Q16 below 2^59, and the move below 2^31. */
    int32_t mix = 0, move, value;
    unsigned i;
    for (i = 0; i < LABIAL_CHANNELS; i++)
        mix = labial_add(mix, (int32_t)output->weights[i] * faps[i]);
    move = labial_clamp(scaled(mix, output->gain, 28), MOVE_MAX);
    value = limited(output, labial_add(output->neutral, output->invert ? -move : move));
    if (output->contact) /* both values are within the limits, and so is what lies between them */
        value = limited(output, labial_add(value, scaled(labial_sub(output->closed, value), contact(faps), 24)));
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

int labial_rig_rest(const labial_rig_t *rig, int32_t *values)
{
    unsigned i;
    if (!rig || !rig->outputs || !values)
        return LABIAL_ERROR_NULL;
    for (i = 0; i < rig->count; i++)
        values[i] =
            limited(&rig->outputs[i], rig->outputs[i].contact ? rig->outputs[i].closed : rig->outputs[i].neutral);
    return LABIAL_OK;
}

/* `wanted`, or as near to it as the output's `closed` is far: `room` is how much it may change until lips touch. */
static int32_t towards_closed(const labial_rig_output_t *output, int32_t wanted, int32_t room)
{
    const int32_t low = labial_sub(output->closed, room), high = labial_add(output->closed, room);
    if (wanted < low)
        wanted = low;
    return limited(output, wanted > high ? high : wanted);
}

static int32_t moved(const labial_rig_output_t *output, int32_t last, int32_t wanted)
{
    const int32_t change = labial_sub(wanted, last);
    if (change < output->deadband && labial_sub(0, change) < output->deadband)
        return last;
    if (output->slew > 0 && change > output->slew)
        return labial_add(last, output->slew);
    if (output->slew > 0 && change < -output->slew)
        return labial_sub(last, output->slew);
    return wanted;
}

int labial_rig_apply_ahead(const labial_rig_t *rig, const int16_t *frames, uint16_t count, int32_t *values)
{
    unsigned i, until = 0, k;
    if (!rig || !rig->outputs || !frames || !values || count == 0)
        return LABIAL_ERROR_NULL;
    while (until < count && contact(frames + (size_t)LABIAL_CHANNELS * until) < CONTACT_ONE)
        until++;
    for (i = 0; i < rig->count; i++) {
        const labial_rig_output_t *output = &rig->outputs[i];
        int32_t wanted = target(output, frames), room = 0;
        if (output->contact && output->slew > 0 && until < count) {
            for (k = 0; k < until && room < ROOM_MAX; k++)
                room = labial_add(room, output->slew);
            wanted = towards_closed(output, wanted, room);
        }
        values[i] = moved(output, limited(output, values[i]), wanted);
    }
    return LABIAL_OK;
}

int labial_rig_apply(const labial_rig_t *rig, const int16_t faps[LABIAL_CHANNELS], int32_t *values)
{
    return labial_rig_apply_ahead(rig, faps, 1, values);
}
