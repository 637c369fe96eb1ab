/*
 * labial/rig.h - converts the 13 FAPs of a frame to values for servos, blendshapes, or features of a drawn mouth.
 *
 *     static const labial_rig_output_t jaw = LABIAL_RIG_JAW(1400, 1900); // microseconds: lips closed, wide open
 *     static const labial_rig_t rig = { &jaw, 1 };
 *     static int32_t values[1];
 *
 *     labial_rig_rest(&rig, values);        // once, before the first frame
 *     labial_rig_apply(&rig, faps, values); // in the frame callback; then values[0] is the servo's pulse
 *
 * `labial rig face.toml -o DIR` writes such tables from a readable description; docs/servos.md shows how to use them.
 * For each output, with f the 13 FAPs:
 *
 *     move   = gain * (weights[0] * f[0] + ... + weights[12] * f[12])    rounded to the nearest, halves up
 *     linear = neutral + move, or neutral - move when inverted
 *              + visemes[0] * share[0] + ... + visemes[14] * share[14]   where shares of sounds are known, rounded
 *     target = curve(linear), or linear without a curve                  within minimum .. maximum
 *     wanted = target + contact * (closed - target) for an output with `closed`; else the target
 *     value  = wanted, or as near to it as `slew` and `acceleration` allow; the previous value within `deadband` of it,
 *              unless `wanted` is the value at rest
 *
 * Contact is 1 where the lips touch: up to an opening, -(FAP 51 + FAP 52), of LABIAL_RIG_TOUCHING. FAPs follow the
 * outer lips, which are slightly apart when the inner lips meet. From there contact falls to 0 at LABIAL_RIG_APART. So
 * servos with `closed` close the mouth in p, b, m.
 *
 * Servos need more than this: labial/face.h moves them by such a rig from any source, and always to rest.
 *
 * Values have whatever unit the table's author chose: microseconds of a servo's pulse, quarter microseconds (Maestro),
 * ticks of a PWM chip (PCA9685), counts of a timer, or weights of blendshapes from 0 to LABIAL_RIG_WEIGHT_ONE, which
 * stands for 1.
 *
 * Integers only, no allocation, no state but the caller's `values`, the same bits on every target. A rig is constant,
 * may be used for any number of faces at once, and is linked only when used.
 *
 * Rigs that labial_rig_check() has accepted are trusted; it accepts everything that `labial rig` writes. FAPs may have
 * any int16, and `values` any content. With an unchecked table values may be wrong and beyond the limits, but the
 * library writes only to `values`, and its behaviour is defined.
 */
#ifndef LABIAL_RIG_H
#define LABIAL_RIG_H

#include <stdint.h>

#include "labial/labial.h"
#include "labial/visemes.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Version of this format. Tables that `labial rig` wrote for another version do not compile. */
#define LABIAL_RIG_FORMAT 3

/* A rig: a table of outputs, which is below. */
typedef struct labial_rig labial_rig_t;

/* ---- Calls ------------------------------------------------------------------------------------------------------- */

/*
 * Checks that a table is within the limits below: at least one output, weights, gain, neutral, minimum, maximum,
 * closed, slew, acceleration and deadband within their ranges, minimum <= maximum, slew, acceleration and deadband not
 * below 0, `invert` and `contact` 0 or 1; closed within minimum .. maximum with contact, 0 without; a curve's segments
 * in their number, order and ranges.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_RIG.
 */
int labial_rig_check(const labial_rig_t *rig);

/*
 * Sets each of the rig's `count` values to its output's neutral, or to `closed` if it has that, within its limits: the
 * result of labial_rig_apply() for FAPs that are all 0.
 *
 * Returns LABIAL_OK or LABIAL_ERROR_NULL.
 */
int labial_rig_rest(const labial_rig_t *rig, int32_t *values);

/*
 * Moves the rig's `count` values by one frame. `values` is the caller's, one array per face. On entry it contains the
 * previous frame's values, from which outputs with a slew limit continue; on return, this frame's. A program that
 * converts values must store the converted ones elsewhere. A value beyond its output's limits counts as the limit.
 *
 * Call it once per frame, since the slew limit is per frame. No sum saturates within the limits of a checked table; a
 * move beyond +-2^30 counts as +-2^30, which every limit is far below. It ignores limits of acceleration, which need
 * the speed of an output (labial_rig_apply_ahead()).
 *
 * Returns LABIAL_OK or LABIAL_ERROR_NULL.
 */
int labial_rig_apply(const labial_rig_t *rig, const int16_t faps[LABIAL_CHANNELS], int32_t *values);

/*
 * The same for a frame with the sounds that it shows: `shares` are LABIAL_VISEMES of them, as
 * labial_visemes() gives them; with NULL it is labial_rig_apply(). Outputs with `visemes` show more of a sound than the
 * FAPs of lips and jaw tell: a tongue, teeth, lips that are pressed. Limits and contact apply to the sum.
 *
 * Returns LABIAL_OK or LABIAL_ERROR_NULL.
 */
int labial_rig_apply_visemes(const labial_rig_t *rig, const int16_t faps[LABIAL_CHANNELS], const uint8_t *shares,
                             int32_t *values);

/*
 * The same for a program that knows the frames that follow: `frames` are `count` frames of LABIAL_CHANNELS values, this
 * one first. `changes` are the caller's, one for each output: the change of its value in the last frame, 0 before the
 * first; NULL to ignore limits of acceleration.
 *
 * An output with `closed` and a limit of speed starts early enough to be closed when the lips touch, which the limit
 * alone would prevent: the first of the given frames in which they touch determines how far the value may be from
 * `closed`. An output that also has a limit of acceleration starts early enough to come to rest there: it keeps close
 * enough to `closed` (or to neutral, without `closed`) to stop in time for each of the given frames, and overshoots
 * none of them. With too few frames it does the same and is late.
 *
 * A face (labial/face.h) keeps the frames of a stream for this, and is late by as many as it looks ahead. `labial bake`
 * knows all frames.
 *
 * Returns LABIAL_OK or LABIAL_ERROR_NULL, also for a count of 0.
 */
int labial_rig_apply_ahead(const labial_rig_t *rig, const int16_t *frames, uint16_t count, int32_t *values,
                           int32_t *changes);

/*
 * The same with the sounds of these frames: `shares` are LABIAL_VISEMES for each of them, as labial_visemes() gives
 * them, 0 for a frame of unknown sounds; with NULL it is labial_rig_apply_ahead().
 *
 * Returns LABIAL_OK or LABIAL_ERROR_NULL, also for a count of 0.
 */
int labial_rig_apply_visemes_ahead(const labial_rig_t *rig, const int16_t *frames, const uint8_t *shares,
                                   uint16_t count, int32_t *values, int32_t *changes);

/* ---- Limits, beyond which labial_rig_check() refuses a table. With them no sum or product overflows. ------------- */

#define LABIAL_RIG_WEIGHT_SUM_MAX 65535 /* of the weights' absolute values in one output, Q12 */
#define LABIAL_RIG_GAIN_MAX 268435455   /* largest absolute gain, Q16: just below 4,096 units per FAP unit */
#define LABIAL_RIG_VALUE_MAX 16777215   /* largest absolute neutral, limit, closed, slew, acceleration, deadband */
#define LABIAL_RIG_SLOPE_MAX 33554432   /* largest absolute slope of a curve, Q20: 32 units per unit */

/* ---- Tables ------------------------------------------------------------------------------------------------------ */

/* A weight of one, Q12. */
#define LABIAL_RIG_ONE 4096

/* The value of a blendshape's weight of 1: `values[i] / (float)LABIAL_RIG_WEIGHT_ONE` is from 0 to 1. */
#define LABIAL_RIG_WEIGHT_ONE 1000

/* The gain by which an output moves `units` when its weighted FAPs add up to `faps`: integers, `faps` not 0. */
#define LABIAL_RIG_GAIN(units, faps) ((int32_t)((int64_t)(units)*65536 / (faps)))

/* Opening of the outer lips, FAP units, up to which the inner lips touch, and from which on they are apart. */
#define LABIAL_RIG_TOUCHING 72
#define LABIAL_RIG_APART 136

/* Segments of a curve at most. */
#define LABIAL_RIG_SEGMENTS 8

/* A straight part of a curve: to + slope * (linear - from). */
typedef struct {
    int32_t from;  /* units: where it begins, above the previous one's; the first one also applies below it */
    int32_t to;    /* units: its value there */
    int32_t slope; /* Q20: units per unit */
} labial_rig_segment_t;

/* Corrects a linkage in which equal steps of a servo do not open a mouth by equal steps. 100 bytes. */
typedef struct {
    uint16_t count; /* of its segments, 1 .. LABIAL_RIG_SEGMENTS */
    labial_rig_segment_t segments[LABIAL_RIG_SEGMENTS];
} labial_rig_curve_t;

/* The largest look-ahead of an output with a limit of acceleration, in frames, this one included. */
#define LABIAL_RIG_SIGHT 32

/* One output. 68 bytes where a pointer has 4. */
typedef struct {
    int16_t weights[LABIAL_CHANNELS]; /* Q12, in the order of labial_fap_numbers (labial/faps.h) */
    uint8_t invert;                   /* 1 when the output moves the other way, else 0 */
    uint8_t contact;                  /* 1 when the output has a `closed` position, else 0 */
    int32_t gain;                     /* Q16: units per FAP unit; may be negative */
    int32_t neutral;                  /* units: the value of the face at rest; may lie beyond the limits, which then
                                       * apply, so that the output moves only beyond some amount of the FAPs */
    int32_t minimum, maximum;         /* units: no value is ever beyond them, minimum <= maximum */
    int32_t slew;                     /* units per frame: largest change of the value; 0 for no limit */
    int32_t closed;                   /* units: the value where lips touch, minimum <= closed <= maximum; 0 without
                                       * `contact` */
    int32_t deadband;                 /* units: changes smaller than this are skipped, but for one to the value at rest;
                                       * 0 for none */
    int32_t acceleration;             /* units per frame, per frame: largest difference between the changes of two
                                       * successive frames; 0 for no limit. An output that would take more than
                                       * LABIAL_RIG_SIGHT frames to reach `slew` stays slower */
    const labial_rig_curve_t *curve;  /* NULL for none */
    const int16_t *visemes;           /* LABIAL_VISEMES amounts, units at a share of one (labial/visemes.h); NULL for an
                                       * output that follows FAPs alone */
} labial_rig_output_t;

/* `count` outputs, 1 or more. */
struct labial_rig {
    const labial_rig_output_t *outputs;
    uint16_t count;
};

/* FAP units between the lips, -(FAP 51 + FAP 52), that LABIAL_RIG_JAW() and LABIAL_RIG_SERVO() take for wide open. */
#define LABIAL_RIG_OPENING 600

/*
 * An output for a face that moves only its jaw: it follows the opening of the lips, not FAP 3, since the jaw of a
 * talker is often open while the lips are closed (p, b, m). `closed` and `open` are integer constants in units of the
 * output; either may be the larger.
 */
#define LABIAL_RIG_JAW(closed, open) LABIAL_RIG_SERVO(closed, open, 0)

/* The same for a servo whose value changes by at most `slew` units per frame; 0 for no limit. */
#define LABIAL_RIG_SERVO(closed, open, slew)                                                                           \
    {                                                                                                                  \
        { 0, 0, 0, -LABIAL_RIG_ONE, -LABIAL_RIG_ONE, 0, 0, 0, 0, 0, 0, 0, 0 }, 0, 1,                                   \
            LABIAL_RIG_GAIN((open) - (closed), LABIAL_RIG_OPENING), (closed), (closed) < (open) ? (closed) : (open),   \
            (closed) < (open) ? (open) : (closed), (slew), (closed), 0, 0, 0, 0                                        \
    }

#ifdef __cplusplus
}
#endif

#endif
