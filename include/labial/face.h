/*
 * labial/face.h - a face whose servos are always safe: frames from any source in, values for a rig's outputs out.
 *
 *     static labial_face_t face;
 *     static int32_t room[LABIAL_FACE_SIZE(HEAD_OUTPUTS, 0) / 4];
 *     static int32_t pulses[HEAD_OUTPUTS];
 *
 *     labial_face_init(&face, &head, SPEECH_EN_FPS, 0, room, sizeof room);
 *     labial_init(&stream, &speech_en, workspace, sizeof workspace, labial_face_frame, &face);
 *
 *     if (labial_face_due(&face, milliseconds())) {    // once per frame period
 *         labial_tick(&stream);
 *         labial_face_tick(&face, pulses);
 *         set_servos(pulses);
 *     }
 *
 * Any source will do: a stream (labial/labial.h), hearing (labial/hear.h), lips beside the audio (labial/beside.h) and
 * baked motion by labial_face_values(). The source may end, starve, be cancelled, be initialised again or just stop.
 *
 * What holds after any calls in any order, with a rig that labial_rig_check() accepts. In 2, 3 and 4 a tick that only
 * catches up (labial_face_due()), in which no output moves, does not count.
 *
 *   1. Every value is within its output's limits, from the first tick on.
 *   2. From one tick to the next no value changes by more than `slew`.
 *   3. The changes of two successive ticks differ by no more than `acceleration`.
 *   4. When no frame comes any more, every output is at rest, exactly, at most
 *      ahead + LABIAL_FACE_HOLD + LABIAL_FACE_EASE + LABIAL_FACE_TRAVEL(range, slew, acceleration) ticks later, and
 *      labial_face_tick() returns LABIAL_DONE; after a cancel, its own time stands for hold and ease. Where several of
 *      the last frames came between two ticks, it takes up to `ahead` ticks more.
 *   5. Where one frame comes before each tick, none is lost: frame k is what the outputs are on the way to `ahead`
 *      ticks after it came.
 *
 * At power-up nobody knows where a servo is. With its first pulse it goes to that pulse's angle as fast as it can, and
 * no program can prevent that. What a program can do is send the pulse of rest first, to one servo after the other,
 * before anything else moves: labial_face_soft_start(). A servo that was at rest when the power went then does not move
 * at all.
 *
 * Integers only, no allocation, no state but the structure and its memory, the same bits on every target; linked only
 * when used. Calls on one face must not overlap. Neither the order of calls nor FAPs, values and times are trusted; the
 * rig is, as in labial/rig.h: with an unchecked one values may be wrong.
 */
#ifndef LABIAL_FACE_H
#define LABIAL_FACE_H

#include <stddef.h>
#include <stdint.h>

#include "labial/labial.h"
#include "labial/result.h"
#include "labial/rig.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A face; its members are private. */
typedef struct labial_face labial_face_t;

/* Most frames of look-ahead. */
#define LABIAL_FACE_AHEAD_MAX 1000u

/* Bytes of memory of a face of so many outputs that looks `ahead` frames ahead, a constant expression when both are: 4
 * for each output's value, its change, what is wanted of it, and each of ahead + 1 frames. labial_face_t has 40
 * more. */
#define LABIAL_FACE_SIZE(outputs, ahead) ((size_t)4 * (size_t)(outputs) * ((size_t)(ahead) + 4u))

/*
 * Prepares a face at rest. `frames_per_second` is that of the source, 1 .. 1000: for labial_face_due() alone. `ahead`
 * is how many later frames the face waits for before it shows one, 0 .. LABIAL_FACE_AHEAD_MAX: slow servos need it to
 * close in time (labial_rig_apply_ahead()), and so does a source that delivers several frames at a time. The face is
 * late by as many, and the sound must be delayed.
 *
 * `memory` of `size` bytes, at least LABIAL_FACE_SIZE(outputs, ahead), belongs to the face from now on, and the rig
 * must stay where it is.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL, LABIAL_ERROR_RIG (no outputs), LABIAL_ERROR_FRAME_RATE, LABIAL_ERROR_RANGE
 * (`ahead`) or LABIAL_ERROR_WORKSPACE (memory). After an error the other calls return LABIAL_ERROR_STATE.
 */
int labial_face_init(labial_face_t *face, const labial_rig_t *rig, unsigned frames_per_second, unsigned ahead,
                     int32_t *memory, size_t size);

/*
 * Takes a frame: the callback of a stream or of hearing, with the face as its `user`. The frame's number does not
 * matter. Frames wait for their ticks, one each; of more than `ahead` + 1 the oldest are passed over, so that the face
 * is never later than that. A face that is not initialised takes none. Outputs with `visemes` need
 * labial_face_visemes(), which takes sounds, too.
 */
void labial_face_frame(void *face, uint32_t frame, const int16_t faps[LABIAL_CHANNELS]);

/*
 * The same for a frame with the sounds that it shows, which outputs with `visemes` follow: `shares` are LABIAL_VISEMES
 * of them, as labial_visemes() gives them, or NULL for unknown sounds. For a callback of the
 * program's own:
 *
 *     static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
 *     {
 *         uint8_t shares[LABIAL_VISEMES];
 *         labial_visemes(&stream, &speech_en, labial_arpabet_visemes, shares);
 *         labial_face_visemes(&face, faps, shares);
 *     }
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_face_visemes(labial_face_t *face, const int16_t faps[LABIAL_CHANNELS], const uint8_t *shares);

/*
 * Takes a frame as values of the outputs: `wanted` has one for each, in the rig's units, as labial_beside_value()
 * and labial_player_value() compute them. They go through the same limits. Values beyond an output's limits count as
 * those.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_face_values(labial_face_t *face, const int32_t *wanted);

/*
 * Whether a tick is due by a clock of milliseconds that counts modulo 2^32, such as Arduino's millis(): 1 once per
 * frame period, in the first call and from then on, else 0. Call it as often as you like, and when it returns 1, let
 * the source deliver a frame and call labial_face_tick(). Without a clock, call these two once per frame period.
 *
 * After a delay of up to LABIAL_FACE_CATCH_UP milliseconds it returns 1 in each call until the source has caught up;
 * outputs move in none of these ticks that comes less than half a period after they last moved, since their limits are
 * those of real time. A clock that jumps further, or back, begins anew: one tick is due.
 */
int labial_face_due(labial_face_t *face, uint32_t milliseconds);

/*
 * Moves the outputs by one tick and writes the `values` of all of them.
 *
 * Without a frame they stay on the way to the last one for LABIAL_FACE_HOLD ticks and go to rest in the next
 * LABIAL_FACE_EASE. A frame that comes later waits until `ahead` more have come, or as many ticks have passed.
 *
 * Returns LABIAL_OK with the values of a frame; LABIAL_WAITING when frames wait for those that follow; LABIAL_STARVED
 * when there is none and the outputs hold or go to rest; LABIAL_DONE when there is none and all of them have come to
 * rest; or with nothing written LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_face_tick(labial_face_t *face, int32_t *values);

/*
 * Shows the frames that wait from the next tick on, without waiting for those that follow: for a program that has all
 * frames of a short motion at once.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_face_play(labial_face_t *face);

/*
 * Passes over the next `count` frames, or as many as wait, whose time went by without a tick: for programs whose clock
 * is not that of labial_face_due(). Frames that wait for those that follow are not passed over.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_face_skip(labial_face_t *face, unsigned count);

/*
 * Drops the frames that wait; the outputs go to rest over `milliseconds`, rounded up to whole frames, 1 ..
 * LABIAL_CANCEL_MAX, or longer where their limits need it. Call it with labial_cancel() where the sound stops at once.
 * Frames of a source that eases to rest itself count like any others.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_face_cancel(labial_face_t *face, uint32_t milliseconds);

/*
 * Begins a soft start: outputs are attached one after the other, `ticks` ticks apart, which is the time that one is
 * given to get to rest; at least 1, at most 255. Output k is attached in tick k * ticks, stays at rest, and follows
 * frames from tick (k + 1) * ticks on. Call it after labial_face_init(); 25 ticks are 500 ms.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_face_soft_start(labial_face_t *face, unsigned ticks);

/*
 * How many outputs may be attached, the first ones: all of them, unless a soft start has not reached the last one. Set
 * an output's value first, then attach it: let its pulses begin. 0 for a null or uninitialised face.
 */
unsigned labial_face_attached(const labial_face_t *face);

/*
 * Says where all outputs stand still, in place of a soft start: in servos that report their position, or as a program
 * has stored it. The outputs move on from there within their limits. Values beyond an output's limits count as those.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL or LABIAL_ERROR_STATE.
 */
int labial_face_place(labial_face_t *face, const int32_t *values);

/* ---- Times ------------------------------------------------------------------------------------------------------- */

/* Ticks for which the last frame stays when no other comes, 1 .. 120: 100 ms at 50 frames per second. */
#ifndef LABIAL_FACE_HOLD
#define LABIAL_FACE_HOLD 5
#endif

/* Ticks in which the outputs then go to rest, 1 .. 120, or more where their limits need it: 120 ms. */
#ifndef LABIAL_FACE_EASE
#define LABIAL_FACE_EASE 6
#endif

#if LABIAL_FACE_HOLD < 1 || LABIAL_FACE_HOLD > 120
#error "LABIAL_FACE_HOLD must be a number from 1 to 120."
#endif
#if LABIAL_FACE_EASE < 1 || LABIAL_FACE_EASE > 120
#error "LABIAL_FACE_EASE must be a number from 1 to 120."
#endif

/* Milliseconds that a clock may jump forward for labial_face_due() to catch up; of more it takes no account. */
#define LABIAL_FACE_CATCH_UP 1000u

/*
 * Ticks in which an output with these limits, 0 for none, comes to rest from anywhere within its `range`, maximum less
 * minimum, however it moves: it brakes, travels and stops.
 */
#define LABIAL_FACE_TRAVEL(range, slew, acceleration)                                                                  \
    ((acceleration) > 0 ? (range) / LABIAL_FACE_SPEED_(slew, acceleration) +                                           \
                              3 * (LABIAL_FACE_SPEED_(slew, acceleration) / (acceleration)) + 8                        \
     : (slew) > 0 ? (range) / (slew) + 2                                                                               \
                  : 2)

/* ---- Private ----------------------------------------------------------------------------------------------------- */

/* 40 bytes where a pointer has 4. */
struct labial_face {
    const labial_rig_t *rig; /* null until the face is initialised */
    int32_t *memory;         /* of each output: value, change, wanted; then the frames that wait, a ring */
    uint16_t ahead;          /* the ring has room for one frame more */
    uint16_t first, held;    /* the frames in it */
    uint16_t waited;         /* ticks that the first of them has waited */
    uint16_t frames_per_second;
    uint16_t attached;     /* outputs that follow frames */
    uint8_t plays;         /* frames are shown, one each tick */
    uint8_t quiet;         /* ticks without a frame, up to LABIAL_FACE_HOLD + 1 */
    uint16_t easing;       /* ticks in which the outputs then come to rest, 0 when none are left */
    uint8_t apart, left;   /* ticks from one output of a soft start to the next, and until that */
    uint8_t timed, passes; /* the clock runs; the next tick comes too soon for outputs to move */
    uint16_t part;         /* of a millisecond by which `next` is too early, in 1/frames_per_second */
    uint32_t next, moved;  /* milliseconds: when a tick is due, and when outputs moved last */
};

/* The speed that an output reaches (labial_rig_output_t): by its acceleration it has LABIAL_RIG_SIGHT frames. */
#define LABIAL_FACE_SPEED_(slew, acceleration)                                                                         \
    ((slew) > 0 && (slew) < LABIAL_RIG_SIGHT * (acceleration) ? (slew) : LABIAL_RIG_SIGHT * (acceleration))

#ifdef __cplusplus
}
#endif

#endif
