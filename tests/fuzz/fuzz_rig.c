/*
 * fuzz_rig.c - any bytes as a rig, FAPs and last values. No table may make labial_rig_apply() write elsewhere or behave
 * in an undefined way; with one that labial_rig_check() accepts, every value keeps its limits and its slew.
 */
#include "fuzz.h"

#define OUTPUTS 4

typedef struct {
    uint8_t outputs[OUTPUTS][OUTPUT_BYTES];
    labial_rig_curve_t curve;
    int32_t values[OUTPUTS], changes[OUTPUTS];
    int16_t visemes[LABIAL_VISEMES];
    uint8_t shares[LABIAL_VISEMES];
    uint8_t curved, sound; /* of the outputs */
} head_t;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    head_t input;
    labial_rig_output_t outputs[OUTPUTS];
    labial_rig_t rig;
    if (size < sizeof input)
        return 0;
    memcpy(&input, data, sizeof input);
    data += sizeof input;
    size -= sizeof input;
    make_outputs(outputs, input.outputs, OUTPUTS, &input.curve, input.curved, input.sound);
    for (unsigned i = 0; i < OUTPUTS; i++)
        outputs[i].visemes = input.curved >> (i + 1u) & 1u ? input.visemes : NULL;
    rig.outputs = outputs;
    rig.count = OUTPUTS;
    const int checked = labial_rig_check(&rig);
    REQUIRE(checked == LABIAL_OK || checked == LABIAL_ERROR_RIG);
    REQUIRE((input.sound & 31u) != 31u || checked == LABIAL_OK);
    while (size >= 2u * LABIAL_CHANNELS) {
        const size_t left = size / (2u * LABIAL_CHANNELS);
        const uint16_t count = (uint16_t)(left < 40u ? left : 40u);
        int16_t *frames = (int16_t *)copy_of(data, 2u * LABIAL_CHANNELS * count);
        int32_t *values = (int32_t *)copy_of(input.values, sizeof input.values);
        int32_t *changes = (int32_t *)copy_of(input.changes, sizeof input.changes);
        if (input.curved >> OUTPUTS & 1u)
            REQUIRE(labial_rig_apply_visemes(&rig, frames, input.shares, values) == LABIAL_OK);
        else
            REQUIRE(labial_rig_apply_visemes_ahead(&rig, frames, count == 1 ? input.shares : NULL, count, values,
                                                   changes) == LABIAL_OK);
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
