/*
 * rig.c - FAPs to servos and blendshapes. Uses nothing of the stream, so that either can be linked without the other.
 */
#include "labial/rig.h"

#include "fixed.h"

/* Beyond every limit a value may have, with room for a neutral on top. */
#define MOVE_MAX 1073741824

static int within(int32_t value, int32_t limit)
{
    return value >= -limit && value <= limit;
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
           output->slew <= LABIAL_RIG_VALUE_MAX && output->invert <= 1 && output->reserved == 0;
}

/* value within the output's limits; the maximum where a table that was not checked has them crossed. */
static int32_t limited(const labial_rig_output_t *output, int32_t value)
{
    if (value < output->minimum)
        value = output->minimum;
    return value > output->maximum ? output->maximum : value;
}

static int32_t target(const labial_rig_output_t *output, const int16_t faps[LABIAL_CHANNELS])
{
    /* Q12 FAP. The weights' limit keeps it within 65,535 * 2^15, below 2^31; the gain's limit then keeps the product of
     * Q12 and Q16 below 2^59, and the move below 2^31. */
    int32_t mix = 0, move;
    unsigned i;
    for (i = 0; i < LABIAL_CHANNELS; i++)
        mix = labial_add(mix, (int32_t)output->weights[i] * faps[i]);
    /* The product's bit below the point rounds it to the nearest, halves up. */
    move = labial_add(labial_mulshift(mix, output->gain, 28), labial_mulshift(mix, output->gain, 27) & 1);
    move = labial_clamp(move, MOVE_MAX);
    return limited(output, labial_add(output->neutral, output->invert ? -move : move));
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
        values[i] = limited(&rig->outputs[i], rig->outputs[i].neutral);
    return LABIAL_OK;
}

int labial_rig_apply(const labial_rig_t *rig, const int16_t faps[LABIAL_CHANNELS], int32_t *values)
{
    unsigned i;
    if (!rig || !rig->outputs || !faps || !values)
        return LABIAL_ERROR_NULL;
    for (i = 0; i < rig->count; i++) {
        const labial_rig_output_t *output = &rig->outputs[i];
        const int32_t last = limited(output, values[i]), wanted = target(output, faps);
        const int32_t change = labial_sub(wanted, last);
        if (output->slew > 0 && change > output->slew)
            values[i] = labial_add(last, output->slew);
        else if (output->slew > 0 && change < -output->slew)
            values[i] = labial_sub(last, output->slew);
        else
            values[i] = wanted;
    }
    return LABIAL_OK;
}
