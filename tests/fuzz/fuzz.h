/*
 * fuzz.h - what fuzz targets have: libFuzzer's entry and its bytes, the condition whose failure is a finding, a label
 * looked up in every set, and rigs of any bytes whose ranges are put right, so that targets reach what lies behind the
 * check.
 */
#ifndef LABIAL_TEST_FUZZ_H
#define LABIAL_TEST_FUZZ_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "labial/labial.h"
#include "labial/names.h"
#include "labial/rig.h"

#define REQUIRE(condition)                                                                                             \
    do {                                                                                                               \
        if (!(condition))                                                                                              \
            abort();                                                                                                   \
    } while (0)

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* The bytes of an input that are still to be read. */
typedef struct {
    const uint8_t *at;
    size_t left;
} input_t;

/* The next bytes, zeros beyond the end. */
static inline void take(input_t *input, void *to, size_t size)
{
    const size_t some = size < input->left ? size : input->left;
    memset(to, 0, size);
    memcpy(to, input->at, some);
    input->at += some;
    input->left -= some;
}

/* The number that the next bytes are, the first one highest. */
static inline uint32_t number(input_t *input, unsigned bytes)
{
    uint32_t value = 0;
    for (; bytes > 0 && input->left > 0; bytes--, input->left--)
        value = value << 8 | *input->at++;
    return value;
}

/* Memory of just this size, so that the sanitizer sees its ends. */
static inline void *memory_of(size_t size)
{
    void *const memory = malloc(size ? size : 1);
    REQUIRE(memory);
    return memory;
}

static inline void *copy_of(const void *from, size_t size)
{
    return memcpy(memory_of(size), from, size);
}

/*
 * Looks `label`, `length` bytes at the very end of their memory, up in every set. What is found is a phoneme of the
 * model, the nearest one is what is found, and blanks around the label change nothing.
 */
static inline void look_up(const labial_names_t *names, const char *label, size_t length)
{
    static const labial_labels_t sets[] = { LABIAL_LABELS_ARPABET, LABIAL_LABELS_IPA, LABIAL_LABELS_XSAMPA,
                                            LABIAL_LABELS_AUTO };
    char *copy = (char *)copy_of(label, length), *padded = (char *)memory_of(length + 2);
    int found, nearest;
    memcpy(padded + 1, label, length);
    padded[0] = '\t';
    padded[length + 1] = ' ';
    for (size_t i = 0; i < sizeof sets / sizeof sets[0]; i++) {
        found = labial_find_in(names, sets[i], copy, length);
        REQUIRE(found == LABIAL_ERROR_NAME || (found >= 0 && found < names->phoneme_count));
        REQUIRE(labial_find_in(names, sets[i], padded, length + 2) == found);
        nearest = labial_find_nearest(names, sets[i], copy, length, 0);
        REQUIRE(nearest >= 0 && nearest < names->phoneme_count && (found < 0 || nearest == found));
    }
    REQUIRE(labial_find(names, copy, length) == labial_find_in(names, LABIAL_LABELS_AUTO, copy, length));
    free(copy);
    free(padded);
}

static inline int32_t into(int32_t value, int32_t limit)
{
    return (int32_t)((int64_t)value % ((int64_t)limit + 1));
}

static inline int32_t size_into(int32_t value, int32_t limit)
{
    const int32_t kept = into(value, limit);
    return kept < 0 ? -kept : kept;
}

static inline int32_t within(int32_t value, int32_t low, int32_t high)
{
    return value < low ? low : value > high ? high : value;
}

static inline void mend_curve(labial_rig_curve_t *curve)
{
    curve->count = (uint16_t)(1u + curve->count % LABIAL_RIG_SEGMENTS);
    for (unsigned i = 0; i < LABIAL_RIG_SEGMENTS; i++) {
        labial_rig_segment_t *segment = &curve->segments[i];
        segment->from = into(segment->from, LABIAL_RIG_VALUE_MAX / LABIAL_RIG_SEGMENTS);
        segment->from = i ? segment[-1].from + 1 + (segment->from < 0 ? -segment->from : segment->from) : segment->from;
        segment->to = into(segment->to, LABIAL_RIG_VALUE_MAX);
        segment->slope = into(segment->slope, LABIAL_RIG_SLOPE_MAX);
        if (segment->from > LABIAL_RIG_VALUE_MAX)
            segment->from = LABIAL_RIG_VALUE_MAX, curve->count = (uint16_t)(i < curve->count ? i : curve->count);
    }
}

/* Brings an output into the ranges of a checked table, its weights by dropping those that are too many. */
static inline void mend(labial_rig_output_t *output)
{
    int32_t sum = 0;
    for (unsigned i = 0; i < LABIAL_CHANNELS; i++) {
        const int32_t weight = output->weights[i] < 0 ? -output->weights[i] : output->weights[i];
        if (sum + weight > LABIAL_RIG_WEIGHT_SUM_MAX)
            output->weights[i] = 0;
        else
            sum += weight;
    }
    output->gain = into(output->gain, LABIAL_RIG_GAIN_MAX);
    output->neutral = into(output->neutral, LABIAL_RIG_VALUE_MAX);
    const int32_t low = into(output->minimum, LABIAL_RIG_VALUE_MAX);
    const int32_t high = into(output->maximum, LABIAL_RIG_VALUE_MAX);
    output->minimum = low < high ? low : high;
    output->maximum = low < high ? high : low;
    output->slew = size_into(output->slew, LABIAL_RIG_VALUE_MAX);
    output->invert &= 1u;
    output->contact &= 1u;
    output->closed = within(into(output->closed, LABIAL_RIG_VALUE_MAX), output->minimum, output->maximum);
    output->closed = output->contact ? output->closed : 0;
    output->deadband = size_into(output->deadband, LABIAL_RIG_VALUE_MAX);
    output->acceleration = size_into(output->acceleration, LABIAL_RIG_VALUE_MAX);
}

/* An output's layout is taken up to its curve, which is a pointer. */
#define OUTPUT_BYTES offsetof(labial_rig_output_t, curve)

/* Outputs of these bytes. The bits of `curved` say which of them have the curve, those of `sound` which have their ranges
 * put right, and the one behind whether the curve has. */
static inline void make_outputs(labial_rig_output_t *outputs, const uint8_t (*bytes)[OUTPUT_BYTES], unsigned count,
                                labial_rig_curve_t *curve, unsigned curved, unsigned sound)
{
    if (sound >> count & 1u)
        mend_curve(curve);
    for (unsigned i = 0; i < count; i++) {
        memset(&outputs[i], 0, sizeof outputs[i]);
        memcpy(&outputs[i], bytes[i], OUTPUT_BYTES);
        outputs[i].curve = curved >> i & 1u ? curve : NULL;
        if (sound >> i & 1u)
            mend(&outputs[i]);
    }
}

#endif
