/*
 * test_stream_cancel.c - what a program may ask of a stream on its way: cancelling eases to the neutral face, a stream
 * that is over goes on after a restart, and the articulation is what labial.h says of labial_articulation(). What is then
 * delivered, test_stream_steps.c has.
 */
#include "suite.h"

#include <limits.h>

static fixture_model_t rich;
static fixture_phoneme_t input[80];

SETUP(setup)
{
    fixture_rich(&rich);
    return 0;
}

/* A stream that has delivered `frames` frames and holds more. */
static void begin(fixture_host_t *host, unsigned rate, size_t frames)
{
    const labial_model_t *model = &rich.model;
    unsigned guard = 0;
    rich.model.frames_per_second = (uint16_t)rate;
    assert_ok(fixture_open(host, &model, 1));
    fixture_stream(input, 80, FIXTURE_VOWELS, 23);
    for (unsigned i = 0; i < 80 && labial_room(host->stream) > 0; i++)
        assert_ok(fixture_push(host, &input[i]));
    while (host->recorder.count < frames) {
        assert_true(guard++ < 1000);
        (void)fixture_tick(host);
    }
}

/* Ticks until done; every tick must deliver. Returns the frames delivered. */
static size_t drain(fixture_host_t *host)
{
    const size_t before = host->recorder.count;
    int result;
    for (;;) {
        result = fixture_tick(host);
        if (result == LABIAL_DONE)
            break;
        assert_ok(result);
        assert_true(host->recorder.count - before <= 1000);
    }
    assert_played(host, host->complaint ? -1 : 0);
    assert_int_equal(fixture_tick(host), LABIAL_DONE);
    return host->recorder.count - before;
}

static int is_neutral(const int16_t *frame)
{
    static const int16_t neutral[LABIAL_CHANNELS] = { 0 };
    return memcmp(frame, neutral, sizeof neutral) == 0;
}

/* Would catch rounding down, a length of zero, an overflow of milliseconds times frames per second. */
TEST(easing_takes_the_time_asked_for_rounded_up)
{
    static const struct {
        unsigned rate;
        uint32_t ms;
        size_t frames;
    } cases[] = { { 50, 0, 1 },           { 50, 1, 1 },
                  { 50, 21, 2 },          { 50, 200, 10 },
                  { 30, 101, 4 },         { 50, 20001, 1000 },
                  { 50, 3600000, 1000 },  { 250, 17179870, 1000 },
                  { 50, 85899346, 1000 }, { 250, UINT32_MAX, 1000 },
                  { 10, 2001, 21 },       { 250, 3997, 1000 },
                  { 250, 3996, 999 } };
    for (unsigned i = 0; i < COUNT_OF(cases); i++) {
        fixture_host_t host;
        begin(&host, cases[i].rate, 30);
        fixture_cancel(&host, cases[i].ms);
        assert_int_equal(drain(&host), cases[i].frames);
        assert_true(is_neutral(host.recorder.frames[host.recorder.count - 1]));
        fixture_close(&host);
    }
}

/* Would catch an ease from a pose that never was: all there is to ease is the neutral face. */
TEST(cancel_before_the_first_frame_stays_neutral)
{
    for (unsigned ticks = 0; ticks < 4; ticks++) {
        fixture_host_t host;
        begin(&host, FIXTURE_RATE, 0);
        for (unsigned i = 0; i < ticks; i++)
            assert_int_equal(fixture_tick(&host), LABIAL_WAITING);
        fixture_cancel(&host, 200);
        assert_in_range(drain(&host), 1, 10);
        for (size_t t = 0; t < host.recorder.count; t++)
            assert_true(is_neutral(host.recorder.frames[t]));
        fixture_close(&host);
    }
}

/* ---- Articulation ------------------------------------------------------------------------------------------------ */

#define COUNT 60

static const labial_model_t *models[1];

/* Plays `count` phonemes on a stream that is told `percent` before them. */
static void play_at(fixture_host_t *host, unsigned percent, size_t count)
{
    assert_ok(labial_articulation(host->stream, percent));
    assert_played(host, fixture_play(host, input, count, FIXTURE_FILL));
}

static void open_at(fixture_host_t *host, unsigned percent, size_t count)
{
    models[0] = &rich.model;
    assert_ok(fixture_open(host, models, 1));
    play_at(host, percent, count);
}

/* "100 as labial_init() leaves it", also of a stream that had another one; "0 a mouth that stays shut". */
TEST(the_first_is_100_and_none_is_0)
{
    fixture_host_t silent, calm, told_so;
    fixture_stream(input, COUNT, FIXTURE_CONTACTS, 3);
    models[0] = &rich.model;
    assert_played(&calm, fixture_run(&calm, models[0], input, COUNT, FIXTURE_FILL));
    open_at(&told_so, 100, COUNT);
    assert_int_equal(fixture_difference(&calm.recorder, &told_so.recorder), -1);
    open_at(&silent, 0, COUNT);
    assert_int_equal(silent.recorder.count, calm.recorder.count);
    for (size_t t = 0; t < silent.recorder.count; t++)
        for (unsigned c = 0; c < LABIAL_CHANNELS; c++)
            assert_int_equal(silent.recorder.frames[t][c], 0);
    assert_ok(fixture_open_again(&silent));
    assert_played(&silent, fixture_play(&silent, input, COUNT, FIXTURE_FILL));
    assert_int_equal(fixture_difference(&calm.recorder, &silent.recorder), -1);
    fixture_close(&silent);
    fixture_close(&calm);
    fixture_close(&told_so);
}

/* "more than LABIAL_ARTICULATION_MAX counts as that": would catch one that is cut to 8 bits, or a limit that is none. */
TEST(more_than_the_most_is_the_most)
{
    static const unsigned more[] = { 201, 255, 256, 300, 356, 65536, 65636, UINT_MAX };
    fixture_host_t most, host;
    fixture_stream(input, COUNT, FIXTURE_RANDOM, 4);
    open_at(&most, LABIAL_ARTICULATION_MAX, COUNT);
    for (unsigned i = 0; i < COUNT_OF(more); i++) {
        open_at(&host, more[i], COUNT);
        assert_int_equal(fixture_difference(&most.recorder, &host.recorder), -1);
        fixture_close(&host);
    }
    open_at(&host, 199, COUNT);
    assert_int_not_equal(fixture_difference(&most.recorder, &host.recorder), -1);
    fixture_close(&host);
    fixture_close(&most);
}

/* "a cancel or a restart keeps it", and what is told then holds "at once": the first frames after it are those of a
 * stream that never had another. */
TEST(cancel_and_restart_keep_it)
{
    fixture_host_t ever, host;
    fixture_stream(input, COUNT, FIXTURE_VOWELS, 5);
    open_at(&ever, 60, 0);
    fixture_cancel(&ever, 0);
    while (fixture_tick(&ever) != LABIAL_DONE)
        ;
    fixture_restart(&ever);
    play_at(&ever, 60, COUNT);
    for (unsigned way = 0; way < 4; way++) { /* told before, while it eases, when it is done, after the restart */
        open_at(&host, way == 0 ? 60 : 170, 0);
        fixture_cancel(&host, 20);
        if (way == 1)
            assert_ok(labial_articulation(host.stream, 60));
        while (fixture_tick(&host) != LABIAL_DONE)
            ;
        if (way == 2)
            assert_ok(labial_articulation(host.stream, 60));
        fixture_restart(&host);
        if (way == 3)
            assert_ok(labial_articulation(host.stream, 60));
        assert_played(&host, fixture_play(&host, input, COUNT, FIXTURE_FILL));
        assert_int_equal(fixture_difference(&ever.recorder, &host.recorder), -1);
        fixture_close(&host);
    }
    fixture_close(&ever);
}

SUITE(setup, NULL)
