/*
 * face.c - a ring of frames between a source and the outputs of a rig (labial/face.h).
 *
 * Frames wait as what they want of each output, in its units: so that those of FAPs and those of values are one kind,
 * and a face of few outputs looks ahead in few bytes. All outputs move in labial_face_tick(), by labial_rig_step()
 * alone.
 */
#include "labial/face.h"

#include <string.h>

#include "fade.h"
#include "fixed.h"
#include "rig_parts.h"

/* Ticks without a frame when the outputs go to rest. */
#define FACE_QUIET_MOST (LABIAL_FACE_HOLD + 1)

#define FACE_TIMES_HALF UINT32_C(0x80000000) /* differences from here on are negative */

/* Places in the memory: rows of one number for each output. */
#define ROW_VALUE 0u
#define ROW_CHANGE 1u
#define ROW_WANTED 2u
#define ROW_FRAMES 3u

static int32_t *face_row(const labial_face_t *face, size_t number)
{
    return face->memory + number * face->rig->count;
}

/* The frame that comes after so many others that wait. */
static int32_t *face_waiting(const labial_face_t *face, unsigned after)
{
    unsigned at = face->first + after;
    if (at > face->ahead)
        at -= face->ahead + 1u;
    return face_row(face, ROW_FRAMES + at);
}

static void face_drop_first(labial_face_t *face)
{
    face->first = (uint16_t)(face->first < face->ahead ? face->first + 1u : 0u);
    face->held--;
}

/* A place for one more frame. */
static int32_t *face_enter(labial_face_t *face)
{
    if (face->held > face->ahead)
        face_drop_first(face);
    return face_waiting(face, face->held++);
}

/* LABIAL_OK for an initialised face, else the error that calls on it return. */
static int face_status(const labial_face_t *face)
{
    return !face ? LABIAL_ERROR_NULL : face->rig ? LABIAL_OK : LABIAL_ERROR_STATE;
}

int labial_face_init(labial_face_t *face, const labial_rig_t *rig, unsigned frames_per_second, unsigned ahead,
                     int32_t *memory, size_t size)
{
    unsigned i;
    if (!face)
        return LABIAL_ERROR_NULL;
    memset(face, 0, sizeof *face);
    if (!rig || !rig->outputs || !memory)
        return LABIAL_ERROR_NULL;
    if (rig->count == 0)
        return LABIAL_ERROR_RIG;
    if (frames_per_second == 0 || frames_per_second > 1000u)
        return LABIAL_ERROR_FRAME_RATE;
    if (ahead > LABIAL_FACE_AHEAD_MAX)
        return LABIAL_ERROR_RANGE;
    if (size < 4u * (uint32_t)rig->count * (ahead + ROW_FRAMES + 1u)) /* below 2^32 */
        return LABIAL_ERROR_WORKSPACE;
    face->rig = rig;
    face->memory = memory;
    face->ahead = (uint16_t)ahead;
    face->frames_per_second = (uint16_t)frames_per_second;
    face->attached = rig->count;
    face->quiet = FACE_QUIET_MOST;
    for (i = 0; i < rig->count; i++) {
        face_row(face, ROW_VALUE)[i] = face_row(face, ROW_WANTED)[i] = labial_rig_resting(&rig->outputs[i]);
        face_row(face, ROW_CHANGE)[i] = 0;
    }
    return LABIAL_OK;
}

void labial_face_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)frame;
    (void)labial_face_visemes((labial_face_t *)user, faps, NULL);
}

int labial_face_visemes(labial_face_t *face, const int16_t faps[LABIAL_CHANNELS], const uint8_t *shares)
{
    const int result = !faps ? LABIAL_ERROR_NULL : face_status(face);
    if (result == LABIAL_OK) {
        int32_t *const to = face_enter(face);
        unsigned i;
        for (i = 0; i < face->rig->count; i++)
            to[i] = labial_rig_target(&face->rig->outputs[i], faps, shares);
    }
    return result;
}

int labial_face_values(labial_face_t *face, const int32_t *wanted)
{
    const int result = !wanted ? LABIAL_ERROR_NULL : face_status(face);
    if (result == LABIAL_OK) {
        int32_t *const to = face_enter(face);
        unsigned i;
        for (i = 0; i < face->rig->count; i++)
            to[i] = labial_rig_limited(&face->rig->outputs[i], wanted[i]);
    }
    return result;
}

int labial_face_due(labial_face_t *face, uint32_t milliseconds)
{
    uint32_t late, period;
    if (face_status(face) != LABIAL_OK)
        return 0;
    period = labial_quotient(1000u + face->part, face->frames_per_second);
    late = milliseconds - face->next;
    if (face->timed && late >= FACE_TIMES_HALF && 0u - late <= period + 1u) /* the last one was longer, if anything */
        return 0;
    if (!face->timed || late > LABIAL_FACE_CATCH_UP) { /* the first call, or a clock that jumped */
        face->timed = 1;
        face->next = milliseconds;
        face->moved = milliseconds - period;
    }
    face->part = (uint16_t)(1000u + face->part - period * face->frames_per_second);
    face->next += period;
    face->passes = milliseconds - face->moved < (period + 1u) / 2u;
    if (!face->passes)
        face->moved = milliseconds;
    return 1;
}

static uint32_t face_distance(int32_t a, int32_t b)
{
    return a < b ? (uint32_t)b - (uint32_t)a : (uint32_t)a - (uint32_t)b;
}

/* One of `left` steps of the way to rest, from what was wanted or from where the output is, whichever is nearer: so
 * that what lags behind neither opens any further nor closes more slowly. */
static int32_t face_step(int32_t rest, int32_t wanted, int32_t value, uint32_t left)
{
    uint32_t far = face_distance(rest, wanted);
    const uint32_t near = face_distance(rest, value);
    if (near < far) {
        wanted = value;
        far = near;
    }
    far = labial_quotient(far, left);
    return wanted < rest ? labial_add(wanted, (int32_t)far) : labial_sub(wanted, (int32_t)far);
}

/* Takes the next frame for what is wanted of each output; without one, goes a step of the way to rest. */
static int face_look(labial_face_t *face)
{
    int32_t *const wanted = face_row(face, ROW_WANTED);
    unsigned i;
    if (face->held > 0 && (face->plays || face->held > face->ahead || face->waited >= face->ahead)) {
        const int32_t *const frame = face_waiting(face, 0);
        for (i = 0; i < face->rig->count; i++)
            wanted[i] = frame[i];
        face_drop_first(face);
        face->plays = 1;
        face->quiet = 0;
        face->easing = LABIAL_FACE_EASE;
        face->waited = 0;
        return LABIAL_OK;
    }
    face->plays = 0;
    if (face->quiet < FACE_QUIET_MOST)
        face->quiet++;
    if (face->quiet == FACE_QUIET_MOST && face->easing > 0) {
        for (i = 0; i < face->rig->count; i++)
            wanted[i] = face_step(labial_rig_resting(&face->rig->outputs[i]), wanted[i], face_row(face, ROW_VALUE)[i],
                                  face->easing);
        face->easing--;
    }
    if (face->held > 0) {
        face->waited++;
        return LABIAL_WAITING;
    }
    face->waited = 0;
    return LABIAL_DONE;
}

/* What is in sight of an output: `now`, and behind it `count` frames that wait. Returns the number of the frame in
 * which it is closed next. */
static uint32_t face_see(const labial_face_t *face, unsigned output, int32_t now, unsigned count, labial_sight_t *sight)
{
    const int32_t closed = face->rig->outputs[output].closed;
    uint32_t touch = LABIAL_RIG_NEVER;
    unsigned k;
    for (k = 0; k < LABIAL_RIG_SIGHT; k++)
        sight->wanted[k] = 0;
    for (k = count; k > 0; k--) {
        const int32_t wanted = face_waiting(face, k - 1u)[output];
        if (k < LABIAL_RIG_SIGHT)
            sight->wanted[k] = wanted;
        if (wanted == closed)
            touch = k;
    }
    sight->wanted[0] = now;
    sight->count = count < LABIAL_RIG_SIGHT ? count + 1u : LABIAL_RIG_SIGHT;
    return now == closed ? 0 : touch;
}

int labial_face_tick(labial_face_t *face, int32_t *values)
{
    int result = !values ? LABIAL_ERROR_NULL : face_status(face);
    labial_sight_t sight;
    unsigned i;
    if (result != LABIAL_OK)
        return result;
    result = face_look(face);
    for (i = 0; i < face->rig->count; i++) {
        const labial_rig_output_t *const output = &face->rig->outputs[i];
        int32_t *const value = face_row(face, ROW_VALUE) + i, *const change = face_row(face, ROW_CHANGE) + i;
        const int32_t rest = labial_rig_resting(output);
        const int rests = face->easing == 0 || i >= face->attached;
        if (!face->passes) {
            const int32_t last = *value;
            const uint32_t touch = face_see(face, i, rests ? rest : face_row(face, ROW_WANTED)[i],
                                            rests || !face->plays ? 0u : face->held, &sight);
            *value = labial_rig_step(output, &sight, touch, last, *change);
            *change = labial_sub(*value, last);
        }
        values[i] = *value;
        if (result == LABIAL_DONE && (face->easing > 0 || *value != rest || *change != 0))
            result = LABIAL_STARVED;
    }
    face->passes = 0;
    if (face->attached < face->rig->count && --face->left == 0) {
        face->attached++;
        face->left = face->apart;
    }
    return result;
}

int labial_face_play(labial_face_t *face)
{
    const int result = face_status(face);
    if (result == LABIAL_OK && face->held > 0)
        face->plays = 1;
    return result;
}

int labial_face_skip(labial_face_t *face, unsigned count)
{
    const int result = face_status(face);
    if (result == LABIAL_OK)
        for (; count > 0 && face->plays && face->held > 0; count--)
            face_drop_first(face);
    return result;
}

int labial_face_cancel(labial_face_t *face, uint32_t milliseconds)
{
    const int result = face_status(face);
    if (result == LABIAL_OK) {
        face->held = face->waited = 0;
        if (face->quiet < LABIAL_FACE_HOLD)
            face->quiet = LABIAL_FACE_HOLD;
        if (face->easing > 0)
            face->easing = (uint16_t)labial_fade_frames(milliseconds, face->frames_per_second);
    }
    return result;
}

int labial_face_soft_start(labial_face_t *face, unsigned ticks)
{
    const int result = face_status(face);
    if (result == LABIAL_OK) {
        face->attached = 0;
        face->apart = face->left = (uint8_t)(ticks < 1u ? 1u : ticks < 255u ? ticks : 255u);
    }
    return result;
}

unsigned labial_face_attached(const labial_face_t *face)
{
    if (face_status(face) != LABIAL_OK)
        return 0;
    return face->attached < face->rig->count ? face->attached + 1u : face->attached;
}

int labial_face_place(labial_face_t *face, const int32_t *values)
{
    const int result = !values ? LABIAL_ERROR_NULL : face_status(face);
    if (result == LABIAL_OK) {
        unsigned i;
        for (i = 0; i < face->rig->count; i++) {
            face_row(face, ROW_VALUE)[i] = labial_rig_limited(&face->rig->outputs[i], values[i]);
            face_row(face, ROW_CHANGE)[i] = 0;
        }
        face->attached = face->rig->count;
    }
    return result;
}
