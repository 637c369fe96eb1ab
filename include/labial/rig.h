/*
 * labial/rig.h - from the 13 FAPs of a frame to what moves a face: servos, blendshapes, features of a drawn mouth.
 *
 *     static const labial_rig_output_t jaw = LABIAL_RIG_JAW(1400, 1900); // microseconds: lips closed, wide open
 *     static const labial_rig_t rig = { &jaw, 1 };
 *     static int32_t values[1];
 *
 *     labial_rig_rest(&rig, values);        // once, before the first frame
 *     labial_rig_apply(&rig, faps, values); // in the frame callback; then values[0] is the servo's pulse
 *
 * `labial rig face.toml -o DIR` writes such tables from a readable description; docs/servos.md leads from there to
 * moving servos. For each output, with f the 13 FAPs:
 *
 *     move   = gain * (weights[0] * f[0] + ... + weights[12] * f[12])    rounded to the nearest, halves up
 *     linear = neutral + move, or neutral - move when inverted
 *     target = curve(linear), or linear without a curve                  within minimum .. maximum
 *     wanted = target + contact * (closed - target), where the output says where it is closed; else the target
 *     value  = wanted, or as near to it as `slew` and `acceleration` let it come; the last one where `deadband` keeps it
 *
 * Contact is 1 where the lips touch, which in p, b, m FAPs say by an opening, -(FAP 51 + FAP 52), of up to
 * LABIAL_RIG_TOUCHING: they follow the outer lips, which are not quite where they rest when the inner ones meet. From
 * there it falls to 0 at LABIAL_RIG_APART. So a mouth of servos that say where they are closed is closed in p, b, m.
 *
 * Values have whatever unit the table's author chose: microseconds of a servo's pulse, quarter microseconds (Maestro),
 * ticks of a PWM chip (PCA9685), counts of a timer, or weights of blendshapes from 0 to LABIAL_RIG_WEIGHT_ONE, which
 * stands for 1.
 *
 * Integers only, no allocation, no state but the caller's `values`, the same bits on every target. A rig is constant,
 * may be used for any number of faces at once, and is linked only when used.
 *
 * Trusted: rigs that labial_rig_check() has accepted, which it does with all that `labial rig` writes. Not trusted: the
 * FAPs, of which every int16 is allowed, and what is in `values`. With a table that was not checked values may be
 * nonsense and beyond the limits, but nothing except `values` is written and no behaviour is undefined.
 */
#ifndef LABIAL_RIG_H
#define LABIAL_RIG_H

#include <stdint.h>

#include "labial/labial.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Version of the tables' meaning. Tables that `labial rig` wrote for another version do not compile. */
#define LABIAL_RIG_FORMAT 2

/* ---- Limits, beyond which labial_rig_check() refuses a table. With them no sum or product overflows. ------------- */

#define LABIAL_RIG_WEIGHT_SUM_MAX 65535 /* of the weights' absolute values in one output, Q12 */
#define LABIAL_RIG_GAIN_MAX 268435455   /* largest absolute gain, Q16: just below 4,096 units per FAP unit */
#define LABIAL_RIG_VALUE_MAX 16777215   /* largest absolute neutral, limit, closed, slew, acceleration, deadband */
#define LABIAL_RIG_SLOPE_MAX 33554432   /* largest absolute slope of a curve, Q20: 32 units per unit */

/* ---- Tables ------------------------------------------------------------------------------------------------------ */

/* A weight of one, Q12. */
#define LABIAL_RIG_ONE 4096

/* What a blendshape's weight of 1 is among the values: `values[i] / (float)LABIAL_RIG_WEIGHT_ONE` is from 0 to 1. */
#define LABIAL_RIG_WEIGHT_ONE 1000

/* The gain by which an output moves `units` when its weighted FAPs add up to `faps`: integers, `faps` not 0. */
#define LABIAL_RIG_GAIN(units, faps) ((int32_t)((int64_t)(units)*65536 / (faps)))

/* FAP units between the outer lips at which the inner ones touch, and from which on they are apart. */
#define LABIAL_RIG_TOUCHING 72
#define LABIAL_RIG_APART 136

/* Segments of a curve at most. */
#define LABIAL_RIG_SEGMENTS 8

/* A straight part of a curve: to + slope * (linear - from). */
typedef struct {
    int32_t from;  /* units: where it begins, above the previous one's; the first one holds below it as well */
    int32_t to;    /* units: its value there */
    int32_t slope; /* Q20: units per unit */
} labial_rig_segment_t;

/* What a linkage needs to move evenly: equal steps of a servo do not open a mouth by equal steps. 100 bytes. */
typedef struct {
    uint16_t count; /* of its segments, 1 .. LABIAL_RIG_SEGMENTS */
    labial_rig_segment_t segments[LABIAL_RIG_SEGMENTS];
} labial_rig_curve_t;

/* One output. 64 bytes where a pointer has 4. */
typedef struct {
    int16_t weights[LABIAL_CHANNELS]; /* Q12, in the order of labial_fap_numbers (labial/faps.h) */
    uint8_t invert;                   /* 1 when the output moves the other way, else 0 */
    uint8_t contact;                  /* 1 when `closed` says where the output is where lips touch, else 0 */
    int32_t gain;                     /* Q16: units per FAP unit; may be negative */
    int32_t neutral;                  /* units: the value of the face at rest; may lie beyond the limits, which then
                                       * apply: so an output stays at one end until the FAPs have gone some way */
    int32_t minimum, maximum;         /* units: no value is ever beyond them, minimum <= maximum */
    int32_t slew;                     /* units per frame that the value changes at most; 0 for no limit */
    int32_t closed;                   /* units: the value where lips touch, minimum <= closed <= maximum; 0 without
                                       * `contact` */
    int32_t deadband;                 /* units: the value stays where it would change by less than this; 0 for none */
    int32_t acceleration;             /* units per frame, per frame: by how much more or less a value changes than in
                                       * the frame before, at most; 0 for no limit. What takes more than LABIAL_RIG_SIGHT
                                       * frames to get up to `slew` stays slower */
    const labial_rig_curve_t *curve;  /* NULL for none */
} labial_rig_output_t;

/* A rig: `count` outputs, 1 or more. */
typedef struct {
    const labial_rig_output_t *outputs;
    uint16_t count;
} labial_rig_t;

/* FAP units between the lips, -(FAP 51 + FAP 52), that LABIAL_RIG_JAW() takes for wide open. */
#define LABIAL_RIG_OPENING 600

/*
 * An output for a face whose jaw is all that moves: it follows the opening of the lips and not FAP 3, since the jaw of
 * a talker is often open while the lips are closed (p, b, m). `closed` and `open` are integer constants in units of the
 * output, either may be the larger.
 */
#define LABIAL_RIG_JAW(closed, open)                                                                                   \
    {                                                                                                                  \
        { 0, 0, 0, -LABIAL_RIG_ONE, -LABIAL_RIG_ONE, 0, 0, 0, 0, 0, 0, 0, 0 }, 0, 1,                                   \
            LABIAL_RIG_GAIN((open) - (closed), LABIAL_RIG_OPENING), (closed), (closed) < (open) ? (closed) : (open),   \
            (closed) < (open) ? (open) : (closed), 0, (closed), 0, 0, 0                                                \
    }

/* ---- Calls ------------------------------------------------------------------------------------------------------- */

/*
 * Checks that a table is within the limits above: at least one output, weights, gain, neutral, minimum, maximum,
 * closed, slew, acceleration and deadband within their ranges, minimum <= maximum, slew, acceleration and deadband not
 * below 0, `invert` and `contact` 0 or 1; closed within minimum .. maximum with contact, 0 without; a curve's segments
 * in their number, order and ranges.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_RIG.
 */
int labial_rig_check(const labial_rig_t *rig);

/*
 * Sets each of the rig's `count` values to its output's neutral, or to where it is closed if it says that, within its
 * limits: what labial_rig_apply() makes of FAPs that are all 0.
 *
 * Returns LABIAL_OK or LABIAL_ERROR_NULL.
 */
int labial_rig_rest(const labial_rig_t *rig, int32_t *values);

/*
 * Moves the rig's `count` values by one frame. `values` is the caller's, one array per face. On entry it contains the
 * previous frame's values, from which outputs with a slew limit continue; on return this frame's. A program that
 * converts values stores the converted ones elsewhere. A value beyond its output's limits counts as the limit.
 *
 * Call it once per frame, for the slew limit counts in frames. Sums saturate nowhere within the limits of a checked
 * table; a move beyond +-2^30 counts as +-2^30, which every limit is far below. A limit of acceleration is not kept: it
 * needs to know how fast an output moves (labial_rig_apply_ahead()).
 *
 * Returns LABIAL_OK or LABIAL_ERROR_NULL.
 */
int labial_rig_apply(const labial_rig_t *rig, const int16_t faps[LABIAL_CHANNELS], int32_t *values);

/* Frames that are looked at where an output has a limit of acceleration, this one included. */
#define LABIAL_RIG_SIGHT 32

/*
 * The same for a program that knows the frames that follow: `frames` are `count` frames of LABIAL_CHANNELS values, this
 * one first. `changes` are the caller's, one for each output: by how much its value changed in the last frame, 0 before
 * the first; NULL where limits of acceleration need not be kept.
 *
 * An output that says where it is closed and has a limit of speed sets out early enough to be closed where the lips
 * touch, which a limit alone does not: of the frames in sight the first in which they touch decides how far off the
 * value may still be. An output that has a limit of acceleration, too, sets out so early that it also comes to rest
 * there: it is never further from where it is closed (or from neutral, where it does not say that) than it is to be in
 * any of the frames that it can still stop for, and so goes beyond none of them. It does so however few frames are in
 * sight, and is late then.
 *
 * A program that plays a stream shows frames as many frames late as it looks ahead (labial_rig_delayed()).
 * `labial bake` looks ahead without an end.
 *
 * Returns LABIAL_OK or LABIAL_ERROR_NULL, also for a count of 0.
 */
int labial_rig_apply_ahead(const labial_rig_t *rig, const int16_t *frames, uint16_t count, int32_t *values,
                           int32_t *changes);

/* Frames of a stream that wait to be shown. */
typedef struct {
    int16_t *frames; /* the caller's, LABIAL_CHANNELS * (ahead + 1) of them */
    uint16_t ahead;  /* how many frames are looked ahead: by as many the face is late, and the sound is to be delayed */
    uint16_t held;   /* 0 at first */
} labial_rig_delay_t;

/*
 * labial_rig_apply_ahead() for a stream, in its frame callback: takes in a frame that was delivered, and moves `values`
 * on by the frame that is `ahead` frames older. At the end `faps` is NULL, once for each frame that is still to be
 * shown.
 *
 * It takes 26 bytes for each of ahead + 1 frames, and 4 for each of the changes; 10 frames are 200 ms and 286 bytes.
 *
 * Returns LABIAL_OK when `values` are those of a frame, LABIAL_WAITING when the first frames are still being taken in,
 * LABIAL_DONE when all have been shown, or LABIAL_ERROR_NULL.
 */
int labial_rig_delayed(const labial_rig_t *rig, labial_rig_delay_t *delay, const int16_t *faps, int32_t *values,
                       int32_t *changes);

#ifdef __cplusplus
}
#endif

#endif
