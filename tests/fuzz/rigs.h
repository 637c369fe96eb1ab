/*
 * rigs.h - rigs of any bytes whose ranges are put right, so that targets reach what lies behind the check.
 */
#ifndef LABIAL_TEST_FUZZ_RIGS_H
#define LABIAL_TEST_FUZZ_RIGS_H

#include "labial/rig.h"

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
