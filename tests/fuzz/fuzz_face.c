/*
 * fuzz_face.c - any bytes as a rig, and as calls of a face in any order. Nothing may be written elsewhere; with a rig that
 * labial_rig_check() accepts, every value keeps its limits, and everything rests in time once nothing more comes.
 */
#include "fuzz.h"
#include "labial/face.h"

#define OUTPUTS 3u

typedef struct {
    uint8_t outputs[OUTPUTS][OUTPUT_BYTES];
    labial_rig_curve_t curve;
    uint8_t curved, sound; /* of the outputs */
    uint8_t ahead, rate;   /* of the face */
} head_t;

typedef struct {
    labial_face_t face;
    labial_rig_output_t outputs[OUTPUTS];
    labial_rig_t rig;
    int32_t *memory, *values;
    int32_t last[OUTPUTS], changes[OUTPUTS];
    int checked;
} fuzz_t;

static int move(fuzz_t *fuzz, int moves)
{
    const int result = labial_face_tick(&fuzz->face, fuzz->values);
    REQUIRE(result >= 0);
    for (unsigned i = 0; i < OUTPUTS && fuzz->checked; i++) {
        const labial_rig_output_t *output = &fuzz->outputs[i];
        const int32_t change = fuzz->values[i] - fuzz->last[i];
        REQUIRE(fuzz->values[i] >= output->minimum && fuzz->values[i] <= output->maximum);
        REQUIRE(!output->slew || (change <= output->slew && change >= -output->slew));
        REQUIRE(
            !moves || !output->acceleration ||
            (change - fuzz->changes[i] <= output->acceleration && fuzz->changes[i] - change <= output->acceleration));
        fuzz->last[i] = fuzz->values[i];
        if (moves)
            fuzz->changes[i] = change;
        else
            REQUIRE(change == 0);
    }
    return result;
}

static void call(fuzz_t *fuzz, input_t *input)
{
    const uint8_t kind = (uint8_t)number(input, 1);
    int16_t faps[LABIAL_CHANNELS];
    int32_t numbers[OUTPUTS];
    switch (kind & 15u) {
    case 0:
        take(input, numbers, sizeof numbers);
        REQUIRE(labial_face_values(&fuzz->face, numbers) == LABIAL_OK);
        break;
    case 1:
        REQUIRE(labial_face_cancel(&fuzz->face, kind * 3u) == LABIAL_OK);
        break;
    case 2:
        REQUIRE(labial_face_soft_start(&fuzz->face, kind) == LABIAL_OK);
        break;
    case 3:
        take(input, numbers, sizeof numbers);
        REQUIRE(labial_face_place(&fuzz->face, numbers) == LABIAL_OK);
        for (unsigned i = 0; i < OUTPUTS; i++) {
            const labial_rig_output_t *output = &fuzz->outputs[i];
            fuzz->last[i] = within(numbers[i], output->minimum, output->maximum);
            fuzz->changes[i] = 0;
        }
        break;
    case 4:
        take(input, numbers, sizeof *numbers);
        if (labial_face_due(&fuzz->face, (uint32_t)numbers[0]))
            (void)move(fuzz, !fuzz->face.passes);
        break;
    case 5:
        REQUIRE(labial_face_skip(&fuzz->face, kind >> 4) == LABIAL_OK);
        break;
    case 6:
        REQUIRE(labial_face_play(&fuzz->face) == LABIAL_OK);
        break;
    case 7:
    case 8:
    case 9:
        (void)move(fuzz, 1);
        break;
    default:
        take(input, faps, sizeof faps);
        labial_face_frame(&fuzz->face, kind, faps);
        (void)move(fuzz, 1);
    }
    REQUIRE(labial_face_attached(&fuzz->face) <= OUTPUTS);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    input_t input = { data, size };
    head_t head;
    fuzz_t fuzz;
    uint32_t most = 0;
    if (size < sizeof head)
        return 0;
    take(&input, &head, sizeof head);
    memset(&fuzz, 0, sizeof fuzz);
    make_outputs(fuzz.outputs, head.outputs, OUTPUTS, &head.curve, head.curved, head.sound);
    fuzz.rig.outputs = fuzz.outputs;
    fuzz.rig.count = OUTPUTS;
    fuzz.checked = labial_rig_check(&fuzz.rig) == LABIAL_OK;
    fuzz.memory = (int32_t *)memory_of(LABIAL_FACE_SIZE(OUTPUTS, head.ahead));
    fuzz.values = (int32_t *)memory_of(OUTPUTS * sizeof *fuzz.values);
    REQUIRE(labial_face_init(&fuzz.face, &fuzz.rig, head.rate + 1u, head.ahead, fuzz.memory,
                             LABIAL_FACE_SIZE(OUTPUTS, head.ahead)) == LABIAL_OK);
    labial_rig_rest(&fuzz.rig, fuzz.last);
    while (input.left > 0)
        call(&fuzz, &input);
    for (unsigned i = 0; i < OUTPUTS && fuzz.checked; i++) {
        const labial_rig_output_t *output = &fuzz.outputs[i];
        const int64_t travel =
            LABIAL_FACE_TRAVEL((int64_t)output->maximum - output->minimum, output->slew, output->acceleration);
        most = travel > most ? (uint32_t)travel : most;
    }
    most += head.ahead + LABIAL_FACE_HOLD + LABIAL_FACE_EASE + 255u * OUTPUTS;
    while (fuzz.checked && most < 3000u && move(&fuzz, 1) != LABIAL_DONE)
        REQUIRE(most-- > 0);
    free(fuzz.memory);
    free(fuzz.values);
    return 0;
}
