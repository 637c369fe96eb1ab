/*
 * together.c - two streams run side by side from the first to the last frame: one talks, the other one laughs and rests
 * between laughs. Every frame is the blend of both.
 *
 * A device makes one iteration of the loop in together_play() in each frame period.
 */
#include "demo.h"

#include <string.h>

#include "labial/blend.h"
#include "labial/labial.h"
#include "labial/laugh.h"
#include "laughter_synthetic.h"
#include "speech_en.h"

/* Milliseconds over which laughter begins and fades, and over which it takes the mouth from the words. */
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
    labial_laugh_t generator;          /* of the phonemes of the laugh that is being pushed */
    size_t next_laugh;                 /* to be pushed */
    uint64_t laughed;                  /* time up to which laughs and rests were made, milliseconds */

    size_t current; /* laugh of the score that is heard now, or the next one */
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

/* The next phoneme of this stream: of a laugh, or the silence up to the next one. Returns LABIAL_OK, LABIAL_DONE after
 * the last laugh, or an error. */
static int next_to_laugh(together_t *t, unsigned *phoneme, uint32_t *milliseconds)
{
    int result = labial_laugh_next(&t->generator, phoneme, milliseconds);
    while (result == LABIAL_DONE && t->next_laugh < t->score->laugh_count) {
        const score_laugh_t *laugh = &t->score->laughs[t->next_laugh];
        const uint64_t rest = laugh->begin - t->laughed;
        if (rest > 0) {
            *phoneme = laughter_synthetic.silence;
            *milliseconds = rest < LABIAL_DURATION_MAX ? (uint32_t)rest : LABIAL_DURATION_MAX;
            t->laughed += *milliseconds;
            return LABIAL_OK;
        }
        result = labial_laugh_init(&t->generator, (uint32_t)(laugh->end - laugh->begin), laugh->intensity,
                                   (uint32_t)t->next_laugh);
        t->laughed = laugh->end;
        t->next_laugh++;
        if (result == LABIAL_OK)
            result = labial_laugh_next(&t->generator, phoneme, milliseconds);
    }
    return result;
}

static int feed_laugh(together_t *t)
{
    int result = LABIAL_OK;
    while (result == LABIAL_OK && labial_room(&t->laugh) > 0) {
        unsigned phoneme;
        uint32_t milliseconds;
        result = next_to_laugh(t, &phoneme, &milliseconds);
        if (result == LABIAL_OK)
            result = labial_push(&t->laugh, phoneme, milliseconds);
    }
    return result == LABIAL_DONE ? labial_end(&t->laugh) : result;
}

/* ---- Both ------------------------------------------------------------------------------------------------------ */

/* The value, 0 to full, of a ramp that rises from `from` on and falls until `to`, milliseconds. */
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

/* The blend of the talk and, if the score has one, the laugh, at `now` (milliseconds), from the latest frames. */
static void blend_at(together_t *t, uint64_t now, int16_t faps[LABIAL_CHANNELS])
{
    unsigned intensity = 0, words = LABIAL_BLEND_FULL;
    while (t->current < t->score->laugh_count && now >= t->score->laughs[t->current].end)
        t->current++;
    if (t->current < t->score->laugh_count) {
        const score_laugh_t *laugh = &t->score->laughs[t->current];
        intensity = least(ramp(laugh->begin, now), ramp(now, laugh->end));
        words = LABIAL_BLEND_FULL - least(ramp(laugh->alone, now), ramp(now, laugh->words));
    }
    labial_blend(&labial_blend_default, intensity, words, t->speech, t->laughing, faps);
}

/* One frame period of both streams. The laughing one ends with its last laugh, and its last frame stays. */
static int tick(together_t *t)
{
    int result = feed_talk(t);
    if (result == LABIAL_OK)
        result = feed_laugh(t);
    if (result == LABIAL_OK)
        result = labial_tick(&t->laugh);
    return result >= LABIAL_OK ? labial_tick(&t->talk) : result;
}

int together_play(const score_t *score, together_sink_t sink, void *user)
{
    static together_t t;
    uint64_t frame = 0;
    memset(&t, 0, sizeof t);
    t.score = score;
    int result = labial_init(&t.talk, &speech_en, t.talk_workspace, sizeof t.talk_workspace, on_frame, t.speech);
    if (result == LABIAL_OK)
        result = labial_init(&t.laugh, &laughter_synthetic, t.laugh_workspace, sizeof t.laugh_workspace, on_frame,
                             t.laughing);
    while (result >= LABIAL_OK && result != LABIAL_DONE) {
        result = tick(&t);
        if (result == LABIAL_OK) { /* and not LABIAL_WAITING: both streams have the same delay */
            int16_t faps[LABIAL_CHANNELS];
            blend_at(&t, frame * 1000u / speech_en.frames_per_second, faps);
            sink(user, faps);
            frame++;
        }
    }
    return result == LABIAL_DONE ? LABIAL_OK : result;
}
