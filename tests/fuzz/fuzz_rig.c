/*
 * fuzz_rig.c - any bytes as a rig, FAPs and last values. No table may make labial_rig_apply() write elsewhere or behave
 * in an undefined way; with one that labial_rig_check() accepts, every value keeps its limits and its slew.
 */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"

#define OUTPUTS 4

/* Of the output's layout up to its curve, which is a pointer. */
typedef struct {
    uint8_t outputs[OUTPUTS][offsetof(labial_rig_output_t, curve)];
    labial_rig_curve_t curve;
    int32_t values[OUTPUTS], changes[OUTPUTS];
    int16_t visemes[LABIAL_VISEMES];
    uint8_t shares[LABIAL_VISEMES];
    uint8_t curved; /* which outputs have the curve */
    uint8_t sound;  /* which outputs have their ranges put right, so that the checks behind the first are
                    * reached, and whether the curve has */
} input_t;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    input_t input;
    labial_rig_output_t outputs[OUTPUTS];
    labial_rig_t rig;
    if (size < sizeof input)
        return 0;
    memcpy(&input, data, sizeof input);
    data += sizeof input;
    size -= sizeof input;
    if (input.sound >> OUTPUTS & 1u)
        mend_curve(&input.curve);
    for (unsigned i = 0; i < OUTPUTS; i++) {
        memcpy(&outputs[i], input.outputs[i], sizeof input.outputs[i]);
        outputs[i].curve = input.curved >> i & 1u ? &input.curve : NULL;
        outputs[i].visemes = input.curved >> (i + 1u) & 1u ? input.visemes : NULL;
        if (input.sound >> i & 1u)
            mend(&outputs[i]);
    }
    rig.outputs = outputs;
    rig.count = OUTPUTS;
    const int checked = labial_rig_check(&rig);
    REQUIRE(checked == LABIAL_OK || checked == LABIAL_ERROR_RIG);
    REQUIRE((input.sound & 31u) != 31u || checked == LABIAL_OK);
    while (size >= 2u * LABIAL_CHANNELS) {
        const size_t left = size / (2u * LABIAL_CHANNELS);
        const uint16_t count = (uint16_t)(left < 40u ? left : 40u);
        int16_t *frames = (int16_t *)malloc(2u * LABIAL_CHANNELS * count); /* so that the sanitizer sees their ends */
        int32_t *values = (int32_t *)malloc(sizeof input.values);
        int32_t *changes = (int32_t *)malloc(sizeof input.changes);
        REQUIRE(frames != NULL && values != NULL && changes != NULL);
        memcpy(frames, data, 2u * LABIAL_CHANNELS * count);
        memcpy(values, input.values, sizeof input.values);
        memcpy(changes, input.changes, sizeof input.changes);
        if (input.curved >> OUTPUTS & 1u)
            REQUIRE(labial_rig_apply_visemes(&rig, frames, input.shares, values) == LABIAL_OK);
        else
            REQUIRE(labial_rig_apply_ahead(&rig, frames, count, values, changes) == LABIAL_OK);
        for (unsigned i = 0; i < OUTPUTS && checked == LABIAL_OK; i++) {
            const labial_rig_output_t *output = &outputs[i];
            const int64_t change = (int64_t)values[i] - input.values[i];
            REQUIRE(values[i] >= output->minimum && values[i] <= output->maximum);
            if (output->slew && input.values[i] >= output->minimum && input.values[i] <= output->maximum)
                REQUIRE(change <= output->slew && change >= -(int64_t)output->slew);
        }
        memcpy(input.values, values, sizeof input.values);
        memcpy(input.changes, changes, sizeof input.changes);
        free(frames);
        free(values);
        free(changes);
        data += 2u * LABIAL_CHANNELS;
        size -= 2u * LABIAL_CHANNELS;
    }
    return 0;
}
