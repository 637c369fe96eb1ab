/*
 * together.c - the talking stream runs from the first to the last frame; the laughing one is made ready before each
 * laugh and ticked from its first frame on. Every frame is the blend of both.
 *
 * A device does what one turn of the loop in together_play() does in each frame period, once: where the loop asks again
 * at once for a frame that is being computed, a device shows the frame before, which hardly ever happens
 * (labial_tick()).
 */
#include "together.h"

#include <string.h>

#include "labial/blend.h"
#include "labial/labial.h"
#include "labial/laugh.h"
#include "laughter_synthetic.h"
#include "speech_en.h"

/* Milliseconds over which laughter sets in and dies away, and over which it takes the mouth from the words. */
#define RAMP 240u

#define TALK_SIZE LABIAL_LARGER(SPEECH_EN_WORKSPACE_SIZE, LAUGHTER_SYNTHETIC_WORKSPACE_SIZE)

typedef struct {
    const score_t *score;

    labial_t talk;
    uint32_t talk_workspace[(TALK_SIZE + 3u) / 4u];
    int16_t speech[LABIAL_CHANNELS]; /* its latest frame */
    size_t next;                     /* phoneme to be pushed */

    labial_t laugh;
    uint32_t laugh_workspace[(LAUGHTER_SYNTHETIC_WORKSPACE_SIZE + 3u) / 4u];
    int16_t laughing[LABIAL_CHANNELS]; /* its latest frame */
    size_t current;                    /* laugh of the score */
    labial_laugh_t generator;          /* of its phonemes */
    unsigned phoneme;                  /* that comes next, */
    uint32_t milliseconds;             /* or 0 when there is none */
} together_t;

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)frame;
    memcpy(user, faps, sizeof(int16_t) * LABIAL_CHANNELS);
}

/* ---- The stream that talks ------------------------------------------------------------------------------------- */

static int feed_talk(together_t *t)
{
    int result = LABIAL_OK;
    while (result == LABIAL_OK && t->next < t->score->phoneme_count && labial_room(&t->talk) > 0) {
        const score_phoneme_t *phoneme = &t->score->phonemes[t->next];
        result = labial_use(&t->talk, phoneme->model);
        if (result == LABIAL_OK)
            result = labial_push(&t->talk, phoneme->number, phoneme->milliseconds);
        t->next++;
    }
    if (result == LABIAL_OK && t->next == t->score->phoneme_count)
        result = labial_end(&t->talk);
    return result;
}

/* ---- The stream that laughs ------------------------------------------------------------------------------------ */

static void next_of_laugh(together_t *t)
{
    if (labial_laugh_next(&t->generator, &t->phoneme, &t->milliseconds) != LABIAL_OK)
        t->milliseconds = 0;
}

static int feed_laugh(together_t *t)
{
    int result = LABIAL_OK;
    while (result == LABIAL_OK && t->milliseconds > 0 && labial_room(&t->laugh) > 0) {
        result = labial_push(&t->laugh, t->phoneme, t->milliseconds);
        next_of_laugh(t);
    }
    if (result == LABIAL_OK && t->milliseconds == 0)
        result = labial_end(&t->laugh);
    return result;
}

/* Makes the current laugh ready: its first frames are computed, and the first tick will deliver. A device does this
 * while it has time, some frames before the laugh is due. */
static int prepare_laugh(together_t *t)
{
    if (t->current == t->score->laugh_count)
        return LABIAL_OK;
    const score_laugh_t *laugh = &t->score->laughs[t->current];
    int result = labial_laugh_begin(&t->generator, (uint32_t)(laugh->end - laugh->begin), laugh->intensity,
                                    (uint32_t)t->current);
    if (result == LABIAL_OK) {
        next_of_laugh(t);
        result = feed_laugh(t);
    }
    while (result == LABIAL_OK)
        result = labial_work(&t->laugh);
    return result < 0 ? result : LABIAL_OK;
}

/* ---- Both ------------------------------------------------------------------------------------------------------ */

/* How far a ramp has gone that began at `from`, or has to go that ends at `to`, milliseconds: 0 to full. */
static unsigned ramp(uint64_t from, uint64_t to)
{
    if (to <= from)
        return 0;
    return to - from < RAMP ? (unsigned)((to - from) * LABIAL_BLEND_FULL / RAMP) : LABIAL_BLEND_FULL;
}

static unsigned least(unsigned a, unsigned b)
{
    return a < b ? a : b;
}

/* The talk and, where the score has one, the laugh, at `now` (milliseconds), from both streams' latest frames. */
static void blend_at(const together_t *t, uint64_t now, int16_t faps[LABIAL_CHANNELS])
{
    unsigned intensity = 0, words = LABIAL_BLEND_FULL;
    if (t->current < t->score->laugh_count) {
        const score_laugh_t *laugh = &t->score->laughs[t->current];
        intensity = least(ramp(laugh->begin, now), ramp(now, laugh->end));
        words = LABIAL_BLEND_FULL - least(ramp(laugh->alone, now), ramp(now, laugh->words));
    }
    labial_blend(&labial_blend_default, intensity, words, t->speech, t->laughing, faps);
}

/* The next frame of a stream, or why there is none. */
static int take(labial_t *stream)
{
    int result;
    do
        result = labial_tick(stream);
    while (result == LABIAL_BUSY);
    return result;
}

int together_play(const score_t *score, together_sink_t sink, void *user)
{
    static together_t t;
    memset(&t, 0, sizeof t);
    t.score = score;
    int result = labial_init(&t.talk, &speech_en, t.talk_workspace, sizeof t.talk_workspace, on_frame, t.speech);
    if (result == LABIAL_OK)
        result = labial_init(&t.laugh, &laughter_synthetic, t.laugh_workspace, sizeof t.laugh_workspace, on_frame,
                             t.laughing);
    if (result == LABIAL_OK)
        result = prepare_laugh(&t);
    for (uint64_t frame = 0; result == LABIAL_OK; frame++) {
        const uint64_t now = frame * 1000u / speech_en.frames_per_second;
        result = feed_talk(&t);
        if (result == LABIAL_OK)
            result = take(&t.talk);
        if (result == LABIAL_OK && t.current < score->laugh_count && now >= score->laughs[t.current].begin) {
            result = feed_laugh(&t);
            if (result == LABIAL_OK)
                result = take(&t.laugh);
            if (result == LABIAL_DONE) { /* until the next laugh, with intensity 0, its last frame stays */
                t.current++;
                result = labial_restart(&t.laugh);
                if (result == LABIAL_OK)
                    result = prepare_laugh(&t);
            }
        }
        if (result == LABIAL_OK) {
            int16_t faps[LABIAL_CHANNELS];
            blend_at(&t, now, faps);
            sink(user, faps);
        }
    }
    return result == LABIAL_DONE ? LABIAL_OK : result;
}
