/*
 * test_stream_time.c - exact time: the frames delivered are the rounded sum of the durations, and what the stream says
 * of its latency adds up on the way.
 */
#include "suite.h"

#include "fixture.h"

#define MANY 2000
#define KIND (FIXTURE_ROUNDS(80) + 40) /* phonemes of a stream of one kind */

static fixture_model_t plain, rich;
static fixture_phoneme_t input[MANY];

SETUP(setup)
{
    fixture_plain(&plain);
    fixture_rich(&rich);
    return 0;
}

/* Plays `count` phonemes at `rate` and wants the exact number of frames. */
static void play(fixture_model_t *f, unsigned rate, size_t count, fixture_feed_t feed, const char *what)
{
    fixture_host_t host;
    f->model.frames_per_second = (uint16_t)rate;
    if (fixture_run(&host, &f->model, input, count, feed) != 0)
        fail_msg("%s at %u frames/s: %s", what, rate, host.complaint);
    if (!fixture_is_exact(host.recorder.count, fixture_duration(input, count), rate))
        fail_msg("%s at %u frames/s: %zu frames for %lu ms", what, rate, host.recorder.count,
                 (unsigned long)fixture_duration(input, count));
    fixture_close(&host);
    f->model.frames_per_second = FIXTURE_RATE;
}

/* Would catch rounding per phoneme, dropped or shortened phonemes, frames lost where units are cut or joined. */
TEST(every_kind_of_stream_lasts_exactly_as_long_as_its_phonemes)
{
    static const unsigned rates[] = { 1, 24, 30, 50, 60, 99, 250 };
    for (int kind = 0; kind < FIXTURE_HOUR; kind++) {
        for (unsigned r = 0; r < sizeof rates / sizeof rates[0]; r++) {
            fixture_stream(input, KIND, (fixture_kind_t)kind, r);
            play(&plain, rates[r], KIND, FIXTURE_FILL, "plain");
            play(&rich, rates[r], KIND, FIXTURE_CHANCE, "rich");
        }
    }
}

TEST(two_thousand_phonemes_are_exact)
{
    fixture_stream(input, MANY, FIXTURE_LONG, 9);
    play(&rich, 50, FIXTURE_ROUNDS(MANY), FIXTURE_FILL, "long");
    fixture_stream(input, MANY, FIXTURE_MILLI, 9);
    play(&plain, 30, FIXTURE_ROUNDS(MANY), FIXTURE_SINGLE, "milliseconds");
}

/* Would catch 16-bit counts of frames, and a window that a phoneme of 180,000 frames overflows. */
TEST(one_hour_is_exact)
{
    fixture_stream(input, 3, FIXTURE_HOUR, 4);
    play(&plain, 50, 3, FIXTURE_FILL, "an hour");
    input[0].phoneme = FIXTURE_A;
    play(&plain, 7, 3, FIXTURE_SINGLE, "an hour of a vowel");
}

/* Whether `ms` is the length of `frames` rounded to the nearest; an exact half may go either way. */
static int is_nearest_ms(uint64_t ms, uint64_t frames, unsigned rate)
{
    const uint64_t wanted = 2000u * frames, got = 2u * ms * rate;
    return (wanted > got ? wanted - got : got - wanted) <= rate;
}

/* The same for every number of pushes, not only at the end. */
TEST(every_prefix_is_exact)
{
    static const unsigned rates[] = { 1, 7, 24, 30, 50, 60, 240, 250 };
    for (unsigned r = 0; r < sizeof rates / sizeof rates[0]; r++) {
        for (unsigned round = 0; round < FIXTURE_ROUNDS(8); round++) {
            fixture_host_t host;
            const labial_model_t *model = &plain.model;
            uint64_t ms = 0;
            plain.model.frames_per_second = (uint16_t)rates[r];
            fixture_stream(input, 80, round % 2 ? FIXTURE_RANDOM : FIXTURE_MILLI, round);
            assert_int_equal(fixture_open(&host, &model, 1), LABIAL_OK);
            for (unsigned i = 0; i < 80; i++) {
                while (labial_room(host.stream) == 0)
                    (void)fixture_tick(&host);
                assert_int_equal(fixture_push(&host, &input[i]), LABIAL_OK);
                ms += input[i].ms;
                const labial_latency_t latency = labial_latency(host.stream);
                assert_int_equal(latency.phonemes + labial_room(host.stream), LABIAL_QUEUE);
                if (!fixture_is_exact(latency.frames + host.recorder.count, ms, rates[r]))
                    fail_msg("%u frames/s: %u frames for %lu ms", rates[r], latency.frames, (unsigned long)ms);
                if (!is_nearest_ms(latency.milliseconds, latency.frames, rates[r]))
                    fail_msg("%u frames/s: %u ms for %u frames", rates[r], latency.milliseconds, latency.frames);
            }
            fixture_close(&host);
        }
    }
    plain.model.frames_per_second = FIXTURE_RATE;
}

/* Would catch 32-bit products: a queue full of hours is 900,000 frames times the queue; its milliseconds still fit. */
TEST(a_queue_full_of_hours_is_counted_exactly)
{
    fixture_host_t host;
    const labial_model_t *model = &plain.model;
    uint32_t count = 0;
    plain.model.frames_per_second = 250;
    assert_int_equal(fixture_open(&host, &model, 1), LABIAL_OK);
    for (; labial_room(host.stream) > 0; count++)
        assert_int_equal(labial_push(host.stream, FIXTURE_T, LABIAL_DURATION_MAX), LABIAL_OK);
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

SUITE(setup, NULL)
