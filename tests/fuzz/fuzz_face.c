/*
 * fuzz_face.c - any bytes as a rig, and as calls of a face in any order. Nothing may be written elsewhere; with a rig that
 * labial_rig_check() accepts, every value keeps its limits, and everything rests in time once nothing more comes.
 */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "labial/face.h"

#define OUTPUTS 3u

/* An output's layout is taken up to its curve, which is a pointer. */
typedef struct {
    uint8_t outputs[OUTPUTS][offsetof(labial_rig_output_t, curve)];
    labial_rig_curve_t curve;
    uint8_t curved;      /* which outputs have the curve */
    uint8_t sound;       /* which outputs have their ranges put right, and whether the curve has */
    uint8_t ahead, rate; /* of the face */
} input_t;

typedef struct {
    labial_face_t face;
    labial_rig_output_t outputs[OUTPUTS];
    labial_rig_t rig;
    int32_t *memory, *values; /* on the heap, so that the sanitizer sees their ends */
    int32_t last[OUTPUTS], changes[OUTPUTS];
    int checked;
} fuzz_t;

/* The next `size` bytes of the input, zeros beyond its end. */
static void take(const uint8_t **data, size_t *left, void *to, size_t size)
{
    const size_t some = size < *left ? size : *left;
    memset(to, 0, size);
    memcpy(to, *data, some);
    *data += some;
    *left -= some;
}

/* A tick, in which the outputs move or not. */
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

static void call(fuzz_t *fuzz, const uint8_t **data, size_t *left)
{
    uint8_t kind;
    int16_t faps[LABIAL_CHANNELS];
    int32_t numbers[OUTPUTS];
    take(data, left, &kind, 1);
    switch (kind & 15u) {
    case 0:
        take(data, left, numbers, sizeof numbers);
        REQUIRE(labial_face_values(&fuzz->face, numbers) == LABIAL_OK);
        break;
    case 1:
        REQUIRE(labial_face_cancel(&fuzz->face, kind * 3u) == LABIAL_OK);
        break;
    case 2:
        REQUIRE(labial_face_soft_start(&fuzz->face, kind) == LABIAL_OK);
        break;
    case 3:
        take(data, left, numbers, sizeof numbers);
        REQUIRE(labial_face_place(&fuzz->face, numbers) == LABIAL_OK);
        for (unsigned i = 0; i < OUTPUTS; i++) {
            const labial_rig_output_t *output = &fuzz->outputs[i];
            fuzz->last[i] = numbers[i] < output->minimum ? output->minimum : numbers[i];
            fuzz->last[i] = fuzz->last[i] > output->maximum ? output->maximum : fuzz->last[i];
            fuzz->changes[i] = 0;
        }
        break;
    case 4:
        take(data, left, numbers, sizeof *numbers);
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
        take(data, left, faps, sizeof faps);
        labial_face_frame(&fuzz->face, kind, faps);
        (void)move(fuzz, 1);
    }
    REQUIRE(labial_face_attached(&fuzz->face) <= OUTPUTS);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    input_t input;
    fuzz_t fuzz;
    uint32_t most = 0;
    if (size < sizeof input)
        return 0;
    memcpy(&input, data, sizeof input);
    data += sizeof input;
    size -= sizeof input;
    memset(&fuzz, 0, sizeof fuzz);
    if (input.sound >> OUTPUTS & 1u)
        mend_curve(&input.curve);
    for (unsigned i = 0; i < OUTPUTS; i++) {
        memcpy(&fuzz.outputs[i], input.outputs[i], sizeof input.outputs[i]);
        fuzz.outputs[i].curve = input.curved >> i & 1u ? &input.curve : NULL;
        if (input.sound >> i & 1u)
            mend(&fuzz.outputs[i]);
    }
    fuzz.rig.outputs = fuzz.outputs;
    fuzz.rig.count = OUTPUTS;
    fuzz.checked = labial_rig_check(&fuzz.rig) == LABIAL_OK;
    fuzz.memory = (int32_t *)malloc(LABIAL_FACE_SIZE(OUTPUTS, input.ahead));
    fuzz.values = (int32_t *)malloc(OUTPUTS * sizeof *fuzz.values);
    REQUIRE(fuzz.memory != NULL && fuzz.values != NULL);
    REQUIRE(labial_face_init(&fuzz.face, &fuzz.rig, input.rate + 1u, input.ahead, fuzz.memory,
                             LABIAL_FACE_SIZE(OUTPUTS, input.ahead)) == LABIAL_OK);
    labial_rig_rest(&fuzz.rig, fuzz.last);
    while (size > 0)
        call(&fuzz, &data, &size);
    for (unsigned i = 0; i < OUTPUTS && fuzz.checked; i++) {
        const labial_rig_output_t *output = &fuzz.outputs[i];
        const int64_t travel =
            LABIAL_FACE_TRAVEL((int64_t)output->maximum - output->minimum, output->slew, output->acceleration);
        most = travel > most ? (uint32_t)travel : most;
    }
    most += input.ahead + LABIAL_FACE_HOLD + LABIAL_FACE_EASE + 255u * OUTPUTS;
    while (fuzz.checked && most < 3000u && move(&fuzz, 1) != LABIAL_DONE)
        REQUIRE(most-- > 0);
    free(fuzz.memory);
    free(fuzz.values);
    return 0;
}
