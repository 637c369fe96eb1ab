/*
 * test_soak.c - a day in the life of a face: speech and laughter by chance, starving, cancelled, taken up again, without
 * a new labial_init(), and with the frame counter's wrap at noon.
 *
 * Every frame is accounted for: what was delivered and what the stream still holds are the rounded sum of what was
 * pushed, frames are numbered on without a gap, and nothing beside the stream and its workspace is written to. Every
 * hour one sentence must give the frames that it gave a stream that was new.
 */
#include "suite.h"

#include <string.h>

#include "fixture.h"
#include "labial/laugh.h"
#include "laughter_synthetic.h"
#include "speech_en.h"

#define RATE SPEECH_EN_FPS
#define HOUR (3600u * RATE) /* frames */
#define WORKSPACE LABIAL_LARGER(SPEECH_EN_WORKSPACE_SIZE, LAUGHTER_SYNTHETIC_WORKSPACE_SIZE)
#define CANARIES 8
#define FADE 8u       /* frames in which a stream that is taken up again comes from its last pose */
#define SENTENCE 400u /* frames that are kept of it, at most */

typedef struct {
    uint32_t before[CANARIES];
    labial_t stream;
    uint32_t between[CANARIES];
    uint32_t workspace[WORKSPACE / 4];
    uint32_t after[CANARIES];
} memory_t;

typedef struct {
    memory_t memory;
    fixture_random_t random;
    labial_laugh_t laugh;
    unsigned phonemes; /* of speech that are still to be said before something else is chosen */
    int laughing;
    uint32_t next;       /* number of the frame that is due */
    unsigned calls;      /* of the callback, since the last tick began */
    uint64_t day;        /* frames since midnight */
    uint64_t ms, frames; /* pushed and delivered since the stream began or was taken up again */
    unsigned ends, cancels, laughs, starved, wraps;
    int16_t (*kept)[LABIAL_CHANNELS]; /* where frames go, or null */
} day_t;

static day_t day;

static const labial_model_t *const models[] = { &speech_en, &laughter_synthetic };

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    day_t *d = (day_t *)user;
    if (frame != d->next)
        fail_msg("frame %lu came as %lu", (unsigned long)d->next, (unsigned long)frame);
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++)
        if (faps[c] < -1500 || faps[c] > 1500)
            fail_msg("channel %u is at %d", c, faps[c]);
    if (d->kept && d->frames < SENTENCE)
        memcpy(d->kept[d->frames], faps, sizeof d->kept[0]);
    d->next++;
    d->wraps += d->next == 0;
    d->calls++;
    d->frames++;
    d->day++;
}

static void paint(uint32_t *words, int check)
{
    for (uint32_t i = 0; i < CANARIES; i++) {
        if (check && words[i] != (i + 1u) * 0x9e3779b1u)
            fail_msg("memory beside the stream or its workspace was written to");
        words[i] = (i + 1u) * 0x9e3779b1u;
    }
}

static void guard(int check)
{
    paint(day.memory.before, check);
    paint(day.memory.between, check);
    paint(day.memory.after, check);
}

static void begin_day(uint32_t first)
{
    memset(&day, 0, sizeof day);
    guard(0);
    assert_int_equal(labial_init(&day.memory.stream, &speech_en, day.memory.workspace, WORKSPACE, on_frame, &day),
                     LABIAL_OK);
    assert_int_equal(labial_exact(&day.memory.stream, 1), LABIAL_OK);
    day.random.state = 20;
    day.memory.stream.frame = day.next = first; /* no day is long enough to come there otherwise */
}

/* Frames that are pushed and not delivered: the rounded sum of the durations less what came. */
static uint64_t held(void)
{
    return (day.ms * RATE + 500u) / 1000u - day.frames;
}

static int tick(void)
{
    day.calls = 0;
    const int result = labial_tick(&day.memory.stream);
    assert_in_range(result, LABIAL_OK, LABIAL_DONE);
    assert_int_equal(day.calls, result == LABIAL_OK);
    guard(1);
    return result;
}

static void push(unsigned phoneme, uint32_t ms)
{
    assert_int_equal(labial_push(&day.memory.stream, phoneme, ms), LABIAL_OK);
    day.ms += ms;
}

/* Goes on with what is being said or laughed by one phoneme, or begins something new. */
static void feed(void)
{
    unsigned phoneme;
    uint32_t ms;
    if (day.laughing) {
        if (labial_laugh_next(&day.laugh, &phoneme, &ms) == LABIAL_OK)
            push(phoneme, ms);
        else
            day.laughing = 0;
        return;
    }
    if (day.phonemes == 0) {
        day.laughing = fixture_below(&day.random, 3) == 0;
        assert_int_equal(labial_use(&day.memory.stream, models[day.laughing]), LABIAL_OK);
        day.phonemes = day.laughing ? 0 : 1u + fixture_below(&day.random, 60);
        day.laughs += (unsigned)day.laughing;
        if (day.laughing)
            assert_int_equal(labial_laugh_init(&day.laugh, fixture_below(&day.random, 6000),
                                               fixture_below(&day.random, LABIAL_LAUGH_FULL + 1u),
                                               fixture_random(&day.random)),
                             LABIAL_OK);
        return;
    }
    day.phonemes--;
    ms = fixture_below(&day.random, 240);
    phoneme = fixture_below(&day.random, SPEECH_EN_PHONEMES);
    if (fixture_below(&day.random, 20) == 0) {
        phoneme = SPEECH_EN_SIL;
        ms = fixture_below(&day.random, 20000);
    } else if (fixture_below(&day.random, 20) == 0) {
        ms = fixture_below(&day.random, 3);
    }
    push(phoneme, ms);
}

static void restart(void)
{
    assert_int_equal(labial_restart(&day.memory.stream), LABIAL_OK);
    day.ms = day.frames = 0;
    day.phonemes = 0;
    day.laughing = 0;
}

/* Plays what is held to its last frame. */
static void end(void)
{
    uint64_t ticks = held() + labial_latency(&day.memory.stream).delay;
    assert_int_equal(labial_end(&day.memory.stream), LABIAL_OK);
    while (tick() != LABIAL_DONE)
        assert_true(ticks-- > 0);
    assert_true(held() == 0);
    day.ends++;
    restart();
}

static uint64_t ease_frames(uint32_t ms)
{
    const uint64_t frames = ((uint64_t)ms * RATE + 999u) / 1000u;
    return frames < 1u ? 1u : frames < 1000u ? frames : 1000u;
}

/* Cancels, sometimes twice, and eases to the neutral face. */
static void cancel(void)
{
    uint32_t ms = fixture_below(&day.random, 600);
    uint64_t left = ease_frames(ms);
    assert_int_equal(labial_cancel(&day.memory.stream, ms), LABIAL_OK);
    if (fixture_below(&day.random, 3) == 0) {
        assert_int_equal(tick(), LABIAL_OK);
        ms = fixture_below(&day.random, 600);
        left = ease_frames(ms);
        assert_int_equal(labial_cancel(&day.memory.stream, ms), LABIAL_OK);
    }
    for (; left > 0; left--)
        assert_int_equal(tick(), LABIAL_OK);
    assert_int_equal(tick(), LABIAL_DONE);
    day.cancels++;
    restart();
}

/* A sentence and a laugh, after everything else has ended; returns the frames. */
static size_t speak(int16_t kept[SENTENCE][LABIAL_CHANNELS])
{
    day.kept = kept;
    assert_int_equal(labial_use(&day.memory.stream, &speech_en), LABIAL_OK);
    for (unsigned i = 0; i < 20; i++)
        push((i * 7u + 3u) % SPEECH_EN_PHONEMES, 60u + i % 5u * 20u);
    assert_int_equal(labial_use(&day.memory.stream, &laughter_synthetic), LABIAL_OK);
    for (unsigned i = 0; i < 10; i++)
        push(i % LABIAL_LAUGH_PHONEMES, 110);
    assert_int_equal(labial_end(&day.memory.stream), LABIAL_OK);
    while (tick() != LABIAL_DONE) {
    }
    const size_t frames = (size_t)day.frames;
    day.kept = NULL;
    restart();
    return frames;
}

/* Would catch a frame lost or doubled in any of what a day brings, state that decays, and any write beside the memory. */
TEST(a_day_is_exact_to_the_frame)
{
    static int16_t first[SENTENCE][LABIAL_CHANNELS], again[SENTENCE][LABIAL_CHANNELS];
    const uint64_t length = (uint64_t)FIXTURE_ROUNDS(24 * 60) * (HOUR / 60u);
    unsigned sentences = 0;
    begin_day(0u - (uint32_t)(length / 2u));
    const size_t frames = speak(first);
    assert_in_range(frames, FADE + 1u, SENTENCE);
    while (day.day < length) {
        const uint32_t chance = fixture_below(&day.random, 4096);
        unsigned burst = fixture_below(&day.random, 8) == 0 ? fixture_below(&day.random, 40) : 0;
        if (day.day / HOUR > sentences || (chance == 0 && day.day < HOUR)) {
            sentences += chance != 0;
            end();
            assert_int_equal(speak(again), frames);
            assert_memory_equal(again[FADE], first[FADE], (frames - FADE) * sizeof first[0]);
        } else if (chance < 4) {
            end();
        } else if (chance < 8) {
            cancel();
        }
        for (; burst > 0 && labial_room(&day.memory.stream) > 0; burst--)
            feed();
        const int result = tick();
        assert_int_not_equal(result, LABIAL_DONE);
        day.starved += result == LABIAL_STARVED;
        assert_true(labial_latency(&day.memory.stream).frames == held());
    }
    end();
    assert_int_equal(day.wraps, 1);
    assert_true(day.ends > length / 4096u && day.cancels > length / 4096u / 2u);
    assert_true(day.laughs > length / 4096u && day.starved > 0);
}

/* Would catch a frame number that is taken for the count of frames: restarted at number 0, a face that is not neutral
 * would jump. */
TEST(a_restart_at_the_wrap_does_not_jump)
{
    static int16_t before[SENTENCE][LABIAL_CHANNELS], after[SENTENCE][LABIAL_CHANNELS];
    unsigned frames = 10;
    int moved = 0;
    begin_day(0u - frames);
    day.kept = before;
    push(SPEECH_EN_AA, frames * 1000u / RATE);
    end();
    assert_int_equal(day.next, 0);
    day.kept = after;
    push(SPEECH_EN_UW, 1000);
    end();
    assert_int_equal(day.next, RATE);
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
        const int step = after[0][c] - before[frames - 1u][c], whole = after[FADE][c] - before[frames - 1u][c];
        moved |= whole > 40 || whole < -40;
        assert_true(step * 4 <= (whole < 0 ? -whole : whole) + 40 && -step * 4 <= (whole < 0 ? -whole : whole) + 40);
    }
    assert_true(moved);
}

SUITE(NULL, NULL)
