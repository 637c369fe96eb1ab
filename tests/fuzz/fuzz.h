/*
 * fuzz.h - what fuzz targets have: libFuzzer's entry, the condition whose failure is a finding, a label looked up in
 * every set, and rigs of any bytes whose ranges are put right, so that targets reach what lies behind the check.
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

/*
 * Looks `label`, `length` bytes at the very end of their memory, up in every set. What is found is a phoneme of the
 * model, the nearest one is what is found, and blanks around the label change nothing.
 */
static inline void look_up(const labial_names_t *names, const char *label, size_t length)
{
    static const labial_labels_t sets[] = { LABIAL_LABELS_ARPABET, LABIAL_LABELS_IPA, LABIAL_LABELS_XSAMPA,
                                            LABIAL_LABELS_AUTO };
    char *copy = (char *)malloc(length ? length : 1), *padded = (char *)malloc(length + 2);
    int found, nearest;
    REQUIRE(copy && padded);
    memcpy(copy, label, length);
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
    output->acceleration = into(output->acceleration, LABIAL_RIG_VALUE_MAX);
    output->acceleration = output->acceleration < 0 ? -output->acceleration : output->acceleration;
}

#endif
