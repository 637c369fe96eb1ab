/*
 * test_stream_time.c - exact time: the frames delivered are the rounded sum of the durations, also where speech and
 * laughter meet in one stream and make room for a third; what the stream says of its latency adds up on the way.
 */
#include "suite.h"

#define TURNS 240

static fixture_model_t plain, rich, laugh, slow;
static fixture_phoneme_t input[TURNS];

SETUP(setup)
{
    fixture_plain(&plain);
    fixture_rich(&rich);
    fixture_laughter(&laugh);
    fixture_slow(&slow);
    slow.model.search_stride = FIXTURE_STRIDE;
    return 0;
}

/* Whether `ms` is the length of `frames` rounded to the nearest; an exact half may go either way. */
static int is_nearest_ms(uint64_t ms, uint64_t frames, unsigned rate)
{
    const uint64_t wanted = 2000u * frames, got = 2u * ms * rate;
    return (wanted > got ? wanted - got : got - wanted) <= rate;
}

/* After every push. Would catch rounding per phoneme, dropped or shortened phonemes, frames lost where units are cut or
 * joined. */
TEST(every_prefix_is_exact)
{
    static const unsigned rates[] = { 1, 7, 24, 30, 50, 60, 240, 250 };
    static const fixture_kind_t kinds[] = { FIXTURE_RANDOM, FIXTURE_MILLI, FIXTURE_PAUSES, FIXTURE_ZERO };
    for (unsigned r = 0; r < COUNT_OF(rates); r++) {
        for (unsigned round = 0; round < FIXTURE_ROUNDS(8) + 3; round++) {
            fixture_host_t host;
            fixture_model_t *const f = round % 3 ? &plain : &rich;
            const labial_model_t *model = &f->model;
            uint64_t ms = 0;
            f->model.frames_per_second = (uint16_t)rates[r];
            fixture_stream(input, 80, kinds[round % 4], round);
            assert_ok(fixture_open(&host, &model, 1));
            for (unsigned i = 0; i < 80; i++) {
                while (labial_room(host.stream) == 0)
                    (void)fixture_tick(&host);
                assert_ok(fixture_push(&host, &input[i]));
                ms += input[i].ms;
                const labial_latency_t latency = labial_latency(host.stream);
                assert_int_equal(latency.phonemes + labial_room(host.stream), LABIAL_QUEUE);
                if (!fixture_is_exact(latency.frames + host.recorder.count, ms, rates[r]))
                    fail_msg("%u frames/s: %u frames for %lu ms", rates[r], latency.frames, (unsigned long)ms);
                if (!is_nearest_ms(latency.milliseconds, latency.frames, rates[r]))
                    fail_msg("%u frames/s: %u ms for %u frames", rates[r], latency.milliseconds, latency.frames);
            }
            assert_played(&host, fixture_play(&host, input, 0, FIXTURE_FILL));
            assert_true(fixture_is_exact(host.recorder.count, ms, rates[r]));
            fixture_close(&host);
            f->model.frames_per_second = FIXTURE_RATE;
        }
    }
}

/* Would catch 32-bit products: a queue full of hours is 900,000 frames times the queue; its milliseconds still fit. */
TEST(a_queue_full_of_hours_is_counted_exactly)
{
    fixture_host_t host;
    const labial_model_t *model = &plain.model;
    uint32_t count = 0;
    plain.model.frames_per_second = 250;
    assert_ok(fixture_open(&host, &model, 1));
    for (; labial_room(host.stream) > 0; count++)
        assert_ok(labial_push(host.stream, FIXTURE_T, LABIAL_DURATION_MAX));
    assert_int_equal(count, LABIAL_QUEUE);
    const labial_latency_t latency = labial_latency(host.stream);
    assert_int_equal(latency.frames, count * 900000u);
    assert_int_equal(latency.milliseconds, count * 3600000u);
    assert_int_equal(latency.phonemes, count);
    for (count = 0; count < 200 && host.recorder.count < 100; count++)
        (void)fixture_tick(&host);
    assert_null(host.complaint);
    assert_int_equal(host.recorder.count, 100);
    assert_int_equal(labial_latency(host.stream).frames, latency.frames - 100);
    fixture_close(&host);
    plain.model.frames_per_second = FIXTURE_RATE;
}

/* ---- Changes of the model ---------------------------------------------------------------------------------------- */

/* Runs of 1 .. `longest` phonemes of the host's models in turn. */
static void alternate(unsigned models, uint32_t longest, uint32_t shortest_ms, uint32_t range_ms, uint32_t seed)
{
    fixture_random_t random = { seed + 1 };
    unsigned i = 0, model = 0;
    while (i < TURNS) {
        uint32_t run = 1 + fixture_below(&random, longest);
        for (; run > 0 && i < TURNS; run--, i++) {
            input[i].model = (uint8_t)model;
            input[i].phoneme = (uint8_t)fixture_below(&random, model == 1 ? (uint32_t)FIXTURE_LAUGH_COUNT
                                                                          : (uint32_t)FIXTURE_SPEECH_COUNT);
            input[i].ms = shortest_ms + fixture_below(&random, range_ms);
        }
        model = (model + 1) % models;
    }
}

/* A model makes room for another when its phonemes have been taken up and their frames are no longer needed. Where the
 * phonemes between them are few, the third model may never be taken: the stream must say so and come to a proper end. */
TEST(a_model_that_is_refused_does_no_harm)
{
    const labial_model_t *const models[] = { &rich.model, &laugh.model, &slow.model };
    unsigned refused = 0, all = 0;
    for (unsigned seed = 0; seed < FIXTURE_ROUNDS(6) + 2; seed++) {
        fixture_host_t host;
        unsigned i = 0, ticks = 0;
        assert_ok(fixture_open(&host, models, 3));
        alternate(3, 1 + seed, 20, 300, seed);
        for (unsigned k = 0; seed % 4 == 3 && k < TURNS; k++) { /* many between them */
            input[k].model = (uint8_t)(k / 14 % 3);
            input[k].phoneme = (uint8_t)(input[k].phoneme % FIXTURE_LAUGH_COUNT);
        }
        while (i < TURNS && ticks < 300) {
            const int result = labial_room(host.stream) > 0 ? fixture_push(&host, &input[i]) : LABIAL_ERROR_FULL;
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
        all += i == TURNS;
        assert_played(&host, fixture_play(&host, input, 0, FIXTURE_FILL));
        assert_true(i > 1 && fixture_is_exact(host.recorder.count, fixture_duration(input, i), FIXTURE_RATE));
        fixture_close(&host);
    }
    assert_true(refused > 0 && (all > 0 || LABIAL_TEST_SHARE > 3));
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
    assert_int_equal(labial_uses(NULL, &rich.model), 0);
    for (unsigned round = 0; round < 2; round++) {
        unsigned ticks = 0, used = 0;
        memset(&stream, 0, sizeof stream);
        assert_int_equal(labial_uses(&stream, &rich.model), 0);
        fixture_rich(&rich);
        assert_ok(labial_init(&stream, &rich.model, workspace, sizeof workspace, collect, round ? found : wanted));
        assert_int_equal(labial_uses(&stream, &rich.model), 1);
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
            const int uses = labial_uses(&stream, &rich.model);
            used += (unsigned)uses;
            if (round == 1 && !uses)
                memset(&rich, 0xff, sizeof rich); /* its pointers, too */
            result = labial_tick(&stream);
            assert_true(result >= 0 && ticks < 300);
        }
        assert_in_range(used, 60, 90); /* 1,400 ms are 70 frames, and there is the delay */
        assert_int_equal(labial_uses(&stream, &laugh.model), 1);
    }
    assert_memory_equal(wanted, found, sizeof wanted);
    fixture_rich(&rich);
}

SUITE(setup, NULL)
