/*
 * test_stream_switch.c - speech and laughter in one stream: exact time, room made for a third.
 */
#include "suite.h"

#include <string.h>

#include "fixture.h"

#define COUNT 240

static fixture_model_t speech, laugh, slow;
static fixture_phoneme_t input[COUNT];

SETUP(setup)
{
    fixture_rich(&speech);
    fixture_laughter(&laugh);
    fixture_slow(&slow);
    slow.model.search_stride = FIXTURE_STRIDE;
    return 0;
}

/* Runs of 1 .. `longest` phonemes of the host's models in turn. */
static void alternate(unsigned models, uint32_t longest, uint32_t shortest_ms, uint32_t range_ms, uint32_t seed)
{
    fixture_random_t random;
    unsigned i = 0, model = 0;
    random.state = seed + 1;
    while (i < COUNT) {
        uint32_t run = 1 + fixture_below(&random, longest);
        for (; run > 0 && i < COUNT; run--, i++) {
            input[i].model = (uint8_t)model;
            input[i].phoneme = (uint8_t)fixture_below(&random, model == 1 ? (uint32_t)FIXTURE_LAUGH_COUNT
                                                                          : (uint32_t)FIXTURE_SPEECH_COUNT);
            input[i].ms = shortest_ms + fixture_below(&random, range_ms);
        }
        model = (model + 1) % models;
    }
}

static void play(fixture_host_t *host, unsigned model_count, size_t count, fixture_feed_t feed, const char *what)
{
    const labial_model_t *models[3];
    models[0] = &speech.model;
    models[1] = &laugh.model;
    models[2] = &slow.model;
    assert_int_equal(fixture_open(host, models, model_count), LABIAL_OK);
    if (fixture_play(host, input, count, feed) != 0)
        fail_msg("%s, feed %d: %s (frame %zu)", what, (int)feed, host->complaint, host->recorder.count);
    if (!fixture_is_exact(host->recorder.count, fixture_duration(input, count), FIXTURE_RATE))
        fail_msg("%s: %zu frames for %lu ms", what, host->recorder.count,
                 (unsigned long)fixture_duration(input, count));
}

/* Would catch frames lost or doubled where models meet, whatever the length of the runs: many are shorter than the
 * cross-fade, some one frame, some none. The frames must not depend on the feeding here either. */
TEST(switching_keeps_time_and_does_not_depend_on_feeding)
{
    static const struct {
        uint32_t longest, shortest_ms, range_ms;
        const char *what;
    } cases[] = {
        { 12, 40, 200, "words" },    { 1, 0, 60, "single short phonemes" }, { 1, 20, 1, "single frames" },
        { 3, 0, 400, "short runs" }, { 4, 0, 3, "less than a frame" },      { 2, 600, 3000, "pauses" },
    };
    for (unsigned i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        for (unsigned seed = 0; seed < FIXTURE_ROUNDS(4); seed++) {
            fixture_host_t wanted;
            alternate(2, cases[i].longest, cases[i].shortest_ms, cases[i].range_ms, seed);
            play(&wanted, 2, COUNT, FIXTURE_FILL, cases[i].what);
            for (int feed = FIXTURE_SINGLE; feed < FIXTURE_FEEDS; feed++) {
                fixture_host_t host;
                play(&host, 2, COUNT, (fixture_feed_t)feed, cases[i].what);
                const long at = fixture_difference(&wanted.recorder, &host.recorder);
                if (at >= 0)
                    fail_msg("%s, feed %d: frame %ld differs", cases[i].what, feed, at);
                fixture_close(&host);
            }
            fixture_close(&wanted);
        }
    }
}

/* A model makes room for another when its phonemes have been taken up and their frames are no longer needed: so it
 * must, in turn after turn, where the phonemes between them are many. */
TEST(three_models_in_turn_make_room)
{
    for (unsigned seed = 0; seed < FIXTURE_ROUNDS(4); seed++) {
        fixture_host_t host;
        alternate(3, 1, 150, 200, seed);
        for (unsigned i = 0; i < COUNT; i++) {
            input[i].model = (uint8_t)(i / 14 % 3);
            input[i].phoneme = (uint8_t)(input[i].phoneme % FIXTURE_LAUGH_COUNT);
        }
        play(&host, 3, COUNT, seed % 2 ? FIXTURE_CHANCE : FIXTURE_FILL, "three models");
        fixture_close(&host);
    }
}

/* Where they are few, the third model may never be taken. The stream must say so and come to a proper end. */
TEST(a_model_that_is_refused_does_no_harm)
{
    const labial_model_t *models[3];
    unsigned refused = 0;
    models[0] = &speech.model;
    models[1] = &laugh.model;
    models[2] = &slow.model;
    for (unsigned seed = 0; seed < FIXTURE_ROUNDS(6); seed++) {
        fixture_host_t host;
        unsigned i = 0, ticks = 0;
        int result;
        assert_int_equal(fixture_open(&host, models, 3), LABIAL_OK);
        alternate(3, 1 + seed, 20, 300, seed);
        while (i < COUNT && ticks < 300) {
            result = labial_room(host.stream) > 0 ? fixture_push(&host, &input[i]) : LABIAL_ERROR_FULL;
            if (result == LABIAL_OK) {
                i++;
                ticks = 0;
                continue;
            }
            assert_true(result == LABIAL_ERROR_MODELS || result == LABIAL_ERROR_FULL);
            refused += result == LABIAL_ERROR_MODELS;
            (void)fixture_tick(&host);
            ticks++;
        }
        if (fixture_play(&host, input, 0, FIXTURE_FILL) != 0)
            fail_msg("seed %u: %s", seed, host.complaint);
        assert_true(i > 1 && fixture_is_exact(host.recorder.count, fixture_duration(input, i), FIXTURE_RATE));
        fixture_close(&host);
    }
    assert_true(refused > 0);
}

static void collect(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    int16_t *frames = (int16_t *)user;
    assert_true(frame < 200);
    memcpy(frames + (size_t)LABIAL_CHANNELS * frame, faps, LABIAL_CHANNELS * sizeof *faps);
}

/* A model that the stream says it no longer uses may be overwritten, and one that it uses is not yet let go. */
TEST(an_unused_model_may_be_overwritten)
{
    static int16_t wanted[200 * LABIAL_CHANNELS], found[200 * LABIAL_CHANNELS];
    static labial_t stream;
    static uint32_t workspace[1024];
    assert_int_equal(labial_uses(NULL, &speech.model), 0);
    for (unsigned round = 0; round < 2; round++) {
        unsigned ticks = 0, used = 0;
        memset(&stream, 0, sizeof stream);
        assert_int_equal(labial_uses(&stream, &speech.model), 0);
        fixture_rich(&speech);
        assert_int_equal(
            labial_init(&stream, &speech.model, workspace, sizeof workspace, collect, round ? found : wanted),
            LABIAL_OK);
        assert_int_equal(labial_uses(&stream, &speech.model), 1);
        assert_int_equal(labial_uses(&stream, &laugh.model), 0);
        assert_int_equal(labial_uses(&stream, NULL), 0);
        for (unsigned i = 0; i < 8; i++)
            labial_push(&stream, i % FIXTURE_SPEECH_COUNT, 70 + 30 * i);
        labial_use(&stream, &laugh.model);
        assert_int_equal(labial_uses(&stream, &laugh.model), 1);
        for (unsigned i = 0; i < 8; i++)
            labial_push(&stream, i % FIXTURE_LAUGH_COUNT, 120);
        labial_end(&stream);
        for (int result = LABIAL_OK; result != LABIAL_DONE; ticks++) {
            const int uses = labial_uses(&stream, &speech.model);
            used += (unsigned)uses;
            if (round == 1 && !uses)
                memset(&speech, 0xff, sizeof speech); /* its pointers, too */
            result = labial_tick(&stream);
            assert_true(result >= 0 && ticks < 300);
        }
        assert_in_range(used, 60, 90); /* 1,400 ms are 70 frames, and there is the delay */
        assert_int_equal(labial_uses(&stream, &laugh.model), 1);
    }
    assert_memory_equal(wanted, found, sizeof wanted);
    fixture_rich(&speech);
}

SUITE(setup, NULL)
