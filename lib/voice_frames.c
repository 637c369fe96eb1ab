/*
 * voice_frames.c - the frames of a voice that are due (voice_parts.h).
 */
#include "voice_parts.h"

#include <string.h>

#include "fade.h"
#include "fixed.h"

#define GIVEN_MOST LABIAL_VOICE_GIVEN_

/* How long the face takes to ease to rest, milliseconds; it is there LABIAL_VOICE_REST after the last item. */
#define REST_EASING 300u

/* How much shorter than its items a sound may be that has ended, milliseconds. */
#define SHORTER 100

/* How long a clock that has not stopped may stand, milliseconds: some move in steps. */
#define STEP 80u

/* ---- The stream -------------------------------------------------------------------------------------------------- */

static void on_voice_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    labial_voice_t *const voice = (labial_voice_t *)user;
    memcpy(voice->made, faps, sizeof voice->made);
    voice->moved = 1;
    (void)frame;
}

/* Milliseconds of a segment in 32 bits, 0 without an end. */
static uint32_t length_of(const labial_voice_segment_t *segment, int64_t start)
{
    if (segment->end == INT64_MAX || segment->end - start > UINT32_MAX)
        return 0;
    return (uint32_t)(segment->end - start);
}

/* The end of a noted segment; INT64_MAX without one. */
static int64_t given_end(int64_t start, uint32_t length)
{
    return length > 0u ? (int64_t)((uint64_t)start + length) : INT64_MAX;
}

/* Notes a segment that the stream is given; the oldest is left out where there is no room. */
static void note_given(labial_voice_t *voice, const labial_voice_segment_t *segment)
{
    unsigned at;
    if (voice->given_count == GIVEN_MOST) {
        voice->from = given_end(voice->from, voice->given[voice->given_first]);
        voice->given_first = (uint8_t)((voice->given_first + 1u) % GIVEN_MOST);
        voice->given_count--;
    }
    at = (voice->given_first + voice->given_count++) % GIVEN_MOST;
    voice->given[at] = length_of(segment, segment->start);
    voice->phonemes[at] = segment->phoneme;
}

/* Whether the stream was given what the plan has from `moment` on; then the plan stands behind it. */
static int is_given(labial_voice_t *voice, int64_t moment)
{
    int64_t start = voice->from;
    unsigned i;
    if (start > moment)
        return 0;
    labial_voice_plan_start(voice, moment);
    for (i = 0; i < voice->given_count; i++) {
        const unsigned at = (voice->given_first + i) % GIVEN_MOST;
        const int64_t end = given_end(start, voice->given[at]);
        if (end > moment) {
            labial_voice_segment_t segment;
            labial_voice_plan_next(voice, &segment);
            if (segment.phoneme != voice->phonemes[at] || segment.end != end)
                return 0;
        }
        start = end;
    }
    return 1;
}

/* Gives the stream what it needs next: a segment, or an hour of one; a silence without an end again and again. */
static int give_segment(labial_voice_t *voice)
{
    uint32_t milliseconds = LABIAL_DURATION_MAX;
    if (voice->left == 0u) {
        labial_voice_segment_t segment;
        labial_voice_plan_next(voice, &segment);
        note_given(voice, &segment);
        voice->given_phoneme = segment.phoneme;
        voice->left = segment.end == INT64_MAX ? UINT64_MAX : (uint64_t)(segment.end - segment.start);
        if (segment.end == INT64_MAX)
            voice->tail = segment.start;
    }
    if (voice->left < milliseconds)
        milliseconds = (uint32_t)voice->left;
    if (voice->left != UINT64_MAX)
        voice->left -= milliseconds;
    return labial_push(&voice->stream, voice->given_phoneme, milliseconds);
}

/* What is left of a smooth transition at `step` of `steps`, Q14. */
static int32_t left_at(uint32_t step, uint32_t steps)
{
    const int32_t left = 16384 - labial_ease(step, steps);
    LABIAL_CHECK(left >= 0 && left <= 16384); /* a progress is 0 .. 1 in Q14 */
    /*@ assert 0 <= left <= 16384; */
    return left;
}

/* Eases the frame to the neutral face after the last item: the silence of a model is the pose of its talkers
 * between sentences, which is close to neutral, but not quite. */
static void rest_behind(labial_voice_t *voice, uint32_t frame)
{
    const int64_t moment = labial_voice_moment(voice, frame) - (LABIAL_VOICE_REST - REST_EASING);
    int32_t left;
    unsigned k;
    if (moment <= voice->tail)
        return;
    left = moment < voice->tail + REST_EASING ? left_at((uint32_t)(moment - voice->tail), REST_EASING) : 0;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        voice->made[k] = (int16_t)((voice->made[k] * left + 8192) >> 14);
}

/* Makes this frame, the next one of the stream, in `made`; that of the neutral face without a stream. */
static void make_frame(labial_voice_t *voice, uint32_t frame)
{
    unsigned ahead = LABIAL_DELAY((unsigned)voice->model->search_stride);
    voice->moved = !voice->streaming;
    if (voice->moved)
        memset(voice->made, 0, sizeof voice->made);
    voice->stream.user = voice; /* which may have been moved */
    while (!voice->moved) {
        const int result = labial_tick(&voice->stream);
        if (voice->moved || (result == LABIAL_WAITING && ahead-- > 0u))
            continue;
        ahead = LABIAL_DELAY((unsigned)voice->model->search_stride);
        if (give_segment(voice) != LABIAL_OK)
            return;
    }
    if (voice->streaming)
        rest_behind(voice, frame);
}

/* A new stream, which is given the plan from a whole second on; the difference from the last frame fades. */
static void renew_stream(labial_voice_t *voice, uint32_t second)
{
    uint32_t frame = second * voice->model->frames_per_second;
    (void)labial_init(&voice->stream, voice->model, voice->workspace, voice->workspace_size, on_voice_frame, voice);
    (void)labial_exact(&voice->stream, 1);
    labial_voice_plan_start(voice, (int64_t)second * 1000);
    voice->streaming = 1;
    voice->left = 0;
    voice->tail = INT64_MAX;
    voice->from = (int64_t)second * 1000;
    voice->given_first = voice->given_count = 0;
    memset(voice->made, 0, sizeof voice->made);
    for (; frame < voice->next; frame++)
        make_frame(voice, frame);
    labial_voice_begin_fade(voice, LABIAL_VOICE_FADE);
    voice->closing = labial_fade_closing(&voice->stream, LABIAL_DELAY((unsigned)voice->model->search_stride) - 1u,
                                         LABIAL_VOICE_FADE, -(voice->shown[3] + voice->shown[4]));
}

/* Looks whether the stream has what it should have, and if not makes a new one. */
static void follow_changes(labial_voice_t *voice, int is_late)
{
    const uint32_t seconds = labial_quotient(voice->next, voice->model->frames_per_second);
    const uint32_t second = seconds > LABIAL_VOICE_HISTORY ? seconds - LABIAL_VOICE_HISTORY : 0u;
    const int is_new = !voice->streaming;
    voice->changed = 0;
    labial_voice_forget(voice, (int64_t)second * 1000);
    if (is_new && (voice->begun || voice->cancelled) && !labial_voice_plan_sounds(voice))
        return; /* the neutral face after a cancel */
    if (is_new || is_late || (voice->stale && !is_given(voice, (int64_t)second * 1000)))
        renew_stream(voice, second);
    voice->stale = 0;
}

/* ---- The frames -------------------------------------------------------------------------------------------------- */

void labial_voice_begin_fade(labial_voice_t *voice, uint32_t steps)
{
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        voice->fade[k] = voice->begun ? voice->shown[k] - voice->made[k] : 0;
    voice->step = 0;
    voice->steps = voice->closing = steps;
}

/* Shows what the stream made, on the way there. */
static void show_frame(labial_voice_t *voice)
{
    int32_t left = 0, lips = 0; /* what is left of the fade, and of that of jaw and lips */
    unsigned k;
    if (voice->step < voice->steps) {
        voice->step++;
        left = left_at(voice->step, voice->steps);
        lips = voice->step < voice->closing ? left_at(voice->step, voice->closing) : 0;
    }
    for (k = 0; k < LABIAL_CHANNELS; k++) {
        const int32_t own = LABIAL_FADE_CLOSING >> k & 1u ? lips : left;
        voice->shown[k] = (int16_t)labial_clamp(voice->made[k] + ((voice->fade[k] * own + 8192) >> 14), INT16_MAX);
    }
    voice->begun = 1;
}

int labial_voice_visemes(const labial_voice_t *voice, uint8_t shares[LABIAL_VISEMES])
{
    const int most = LABIAL_VISEME_ONE / 4;
    uint8_t wanted[LABIAL_VISEMES] = { LABIAL_VISEME_ONE };
    unsigned i;
    if (!voice || !shares)
        return LABIAL_ERROR_NULL;
    if (!voice->model)
        return LABIAL_ERROR_STATE;
    if (voice->streaming && voice->model->phoneme_count == LABIAL_ARPABET_PHONEMES)
        (void)labial_visemes(&voice->stream, voice->model, labial_arpabet_visemes, wanted);
    for (i = 0; i < LABIAL_VISEMES; i++) {
        const int change = (int)wanted[i] - (int)shares[i];
        if (voice->step < voice->steps && change > most)
            wanted[i] = (uint8_t)(shares[i] + most);
        else if (voice->step < voice->steps && change < -most)
            wanted[i] = (uint8_t)(shares[i] - most);
        shares[i] = wanted[i];
    }
    return LABIAL_OK;
}

int labial_voice_next(labial_voice_t *voice, uint64_t milliseconds, uint32_t *frame, int16_t faps[LABIAL_CHANNELS])
{
    uint32_t rate, due;
    int is_late;
    if (!voice || !faps)
        return LABIAL_ERROR_NULL;
    if (!voice->model)
        return LABIAL_ERROR_STATE;
    if (milliseconds > LABIAL_VOICE_CLOCK)
        return LABIAL_ERROR_RANGE;
    rate = voice->model->frames_per_second;
    due = (uint32_t)(milliseconds / 1000u) * rate + (uint32_t)(milliseconds % 1000u) * rate / 1000u;
    if (due < voice->next)
        return LABIAL_WAITING;
    is_late = due - voice->next >= rate;
    if (is_late)
        voice->next = due;
    if (voice->changed || is_late || voice->eased)
        follow_changes(voice, is_late);
    voice->eased = 0;
    voice->still = 0;
    make_frame(voice, voice->next);
    show_frame(voice);
    if (frame)
        *frame = voice->next;
    voice->next++;
    memcpy(faps, voice->shown, sizeof voice->shown);
    return LABIAL_OK;
}

/* Whether the sound has ended, by the items so far. */
static int is_at_end(labial_voice_t *voice)
{
    const int64_t latest = labial_voice_latest(voice);
    return voice->finished && latest >= 0 && labial_voice_now(voice) + SHORTER >= latest + voice->offset;
}

/* Frames of so many milliseconds. */
static uint32_t frames_of(const labial_voice_t *voice, uint32_t milliseconds)
{
    return milliseconds * voice->model->frames_per_second / 1000u;
}

int labial_voice_ease(labial_voice_t *voice, int16_t faps[LABIAL_CHANNELS])
{
    if (!voice || !faps)
        return LABIAL_ERROR_NULL;
    if (!voice->model)
        return LABIAL_ERROR_STATE;
    if (voice->streaming) {
        if (!is_at_end(voice))
            return LABIAL_DONE;
        if (voice->still < frames_of(voice, STEP)) {
            voice->still++;
            return LABIAL_WAITING;
        }
        voice->streaming = 0;
        voice->eased = 1;
        memset(voice->made, 0, sizeof voice->made);
        labial_voice_begin_fade(voice, labial_fade_frames(REST_EASING, voice->model->frames_per_second));
    }
    if (voice->step == voice->steps)
        return LABIAL_DONE;
    show_frame(voice);
    memcpy(faps, voice->shown, sizeof voice->shown);
    return LABIAL_OK;
}
