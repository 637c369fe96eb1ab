/*
 * fuzz_rig.c - any bytes as a rig, FAPs and last values. No table may make labial_rig_apply() write elsewhere or behave
 * in an undefined way; with one that labial_rig_check() accepts, every value keeps its limits and its slew.
 */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "labial/rig.h"

#define OUTPUTS 4

typedef struct {
    labial_rig_output_t outputs[OUTPUTS];
    int32_t values[OUTPUTS];
    uint8_t sound; /* which outputs have their ranges put right, so that the checks behind the first are reached */
} input_t;

static int32_t into(int32_t value, int32_t limit)
{
    return (int32_t)((int64_t)value % ((int64_t)limit + 1));
}

/* Brings an output into the ranges of a checked table, its weights by dropping those that are too many. */
static void mend(labial_rig_output_t *output)
{
    int32_t sum = 0, low, high;
    unsigned i;
    for (i = 0; i < LABIAL_CHANNELS; i++) {
        const int32_t weight = output->weights[i] < 0 ? -output->weights[i] : output->weights[i];
        if (sum + weight > LABIAL_RIG_WEIGHT_SUM_MAX)
            output->weights[i] = 0;
        else
            sum += weight;
    }
    output->gain = into(output->gain, LABIAL_RIG_GAIN_MAX);
    output->neutral = into(output->neutral, LABIAL_RIG_VALUE_MAX);
    low = into(output->minimum, LABIAL_RIG_VALUE_MAX);
    high = into(output->maximum, LABIAL_RIG_VALUE_MAX);
    output->minimum = low < high ? low : high;
    output->maximum = low < high ? high : low;
    output->slew = into(output->slew, LABIAL_RIG_VALUE_MAX);
    output->slew = output->slew < 0 ? -output->slew : output->slew;
    output->invert &= 1u;
    output->contact &= 1u;
    output->closed = into(output->closed, LABIAL_RIG_VALUE_MAX);
    output->closed = output->closed < output->minimum ? output->minimum : output->closed;
    output->closed = output->closed > output->maximum ? output->maximum : output->closed;
    output->closed = output->contact ? output->closed : 0;
    output->deadband = into(output->deadband, LABIAL_RIG_VALUE_MAX);
    output->deadband = output->deadband < 0 ? -output->deadband : output->deadband;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    input_t input;
    labial_rig_t rig;
    int checked;
    unsigned i;
    if (size < sizeof input)
        return 0;
    memcpy(&input, data, sizeof input);
    data += sizeof input;
    size -= sizeof input;
    for (i = 0; i < OUTPUTS; i++)
        if (input.sound >> i & 1u)
            mend(&input.outputs[i]);
    rig.outputs = input.outputs;
    rig.count = OUTPUTS;
    checked = labial_rig_check(&rig);
    REQUIRE(checked == LABIAL_OK || checked == LABIAL_ERROR_RIG);
    REQUIRE((input.sound & 15u) != 15u || checked == LABIAL_OK);
    for (; size >= 2u * LABIAL_CHANNELS; data += 2u * LABIAL_CHANNELS, size -= 2u * LABIAL_CHANNELS) {
        int16_t faps[LABIAL_CHANNELS];
        int32_t *values = (int32_t *)malloc(sizeof input.values); /* so that the sanitizer sees its end */
        REQUIRE(values != NULL);
        memcpy(faps, data, sizeof faps);
        memcpy(values, input.values, sizeof input.values);
        REQUIRE(labial_rig_apply(&rig, faps, values) == LABIAL_OK);
        for (i = 0; i < OUTPUTS && checked == LABIAL_OK; i++) {
            const labial_rig_output_t *output = &input.outputs[i];
            const int64_t change = (int64_t)values[i] - input.values[i];
            REQUIRE(values[i] >= output->minimum && values[i] <= output->maximum);
            if (output->slew && input.values[i] >= output->minimum && input.values[i] <= output->maximum)
                REQUIRE(change <= output->slew && change >= -(int64_t)output->slew);
        }
        memcpy(input.values, values, sizeof input.values);
        free(values);
    }
    return 0;
}
