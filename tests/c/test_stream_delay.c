/*
 * test_stream_delay.c - what each tick does, foretold: a frame is taken as soon as all that it needs was pushed, and
 * delivered LABIAL_DELAY() ticks of taking later, whatever the feeding.
 */
#include "suite.h"
#include "oracle.h"

#define COUNT 200
#define MANY 20000

static fixture_model_t plain, rich, laugh, slow;
static fixture_phoneme_t input[COUNT];
static oracle_frame_t frames[MANY];
static unsigned long starved, waited;

SETUP(setup)
{
    fixture_all(&plain, &rich, &laugh, &slow);
    return 0;
}

/* Plays the input in random bursts with pauses of up to `longest` ticks, and foretells every tick. */
static void foretell(const labial_model_t *const *models, unsigned model_count, uint32_t longest, uint32_t seed)
{
    const size_t count = oracle_units(models, input, COUNT, frames, MANY);
    const unsigned delay = LABIAL_DELAY((unsigned)models[0]->search_stride);
    fixture_random_t random = { seed + 1 };
    fixture_host_t host;
    size_t pushed = 0, taken = 0, moved = 0; /* ticks that took a frame or, after the end, let them run out */
    uint32_t quiet = 0;
    int wanted = LABIAL_OK, got;
    assert_ok(fixture_open(&host, models, model_count));
    while (wanted != LABIAL_DONE) {
        uint32_t burst = quiet > 0 ? 0 : 1 + fixture_below(&random, 6);
        int is_moving;
        for (; burst > 0 && pushed < COUNT && labial_room(host.stream) > 0; burst--, pushed++)
            if (fixture_push(&host, &input[pushed]) != LABIAL_OK)
                break;
        quiet = quiet > 0 ? quiet - 1 : fixture_below(&random, longest + 1);
        if (pushed == COUNT && !host.ended)
            fixture_end(&host);
        is_moving =
            taken < count ? host.ended || pushed >= frames[taken].needs : host.ended && host.recorder.count < count;
        taken += is_moving && taken < count;
        moved += (size_t)is_moving;
        if (is_moving && moved > delay)
            wanted = LABIAL_OK;
        else if (host.ended && !is_moving)
            wanted = LABIAL_DONE;
        else
            wanted = moved > delay ? LABIAL_STARVED : LABIAL_WAITING;
        got = fixture_tick(&host);
        assert_int_equal(got, wanted);
        starved += got == LABIAL_STARVED;
        waited += got == LABIAL_WAITING;
    }
    assert_int_equal(host.recorder.count, count);
    assert_played(&host, host.complaint ? -1 : 0);
    fixture_close(&host);
}

/* Would catch a delay that depends on the past, a frame that is held back, a tick that fails while input is there, a
 * shortage that is called the end or the beginning. */
TEST(every_tick_is_foretold)
{
    fixture_model_t *const all[] = { &plain, &rich, &slow };
    for (int kind = 0; kind < FIXTURE_HOUR; kind++)
        for (uint32_t seed = 0; seed<24; seed += LABIAL_TEST_SHARE> 1 ? 5 : 1) {
            fixture_model_t *const f = all[seed % 3];
            const labial_model_t *const model = &f->model;
            const uint8_t own = f->model.search_stride;
            f->model.search_stride = (uint8_t)(1 + seed / 3);
            fixture_stream(input, COUNT, (fixture_kind_t)kind, seed);
            for (size_t i = 0; i < COUNT; i++)
                input[i].ms %= 1500;
            foretell(&model, 1, seed % 4 * 10, seed);
            f->model.search_stride = own;
        }
    assert_true(starved > FIXTURE_ROUNDS(1000) && waited > FIXTURE_ROUNDS(100));
}

/* The same where models change: their slots are free in time, for no frame may be late. */
TEST(changes_of_model_delay_nothing)
{
#if LABIAL_MODELS > 1
    const labial_model_t *const models[] = { &rich.model, &laugh.model };
    for (uint32_t seed = 0; seed < FIXTURE_ROUNDS(40); seed++) {
        fixture_random_t random = { seed + 99 };
        fixture_stream(input, COUNT, seed % 2 ? FIXTURE_RANDOM : FIXTURE_ONE_FRAME, seed);
        for (size_t i = 1; i < COUNT; i++) {
            input[i].model = fixture_below(&random, 1 + seed / 4) == 0 ? !input[i - 1].model : input[i - 1].model;
            input[i].phoneme = (uint8_t)(input[i].phoneme % FIXTURE_LAUGH_COUNT);
        }
        foretell(models, 2, seed % 4 * 10, seed);
    }
#else
    (void)laugh;
#endif
}

/* An hour of silence holds up neither what comes before it nor what comes after. */
TEST(an_hour_of_silence_is_played_as_it_comes)
{
    const labial_model_t *const model = &rich.model;
    const size_t hour = LABIAL_DURATION_MAX / 1000 * FIXTURE_RATE;
    fixture_host_t host;
    assert_int_equal(LABIAL_DELAY(FIXTURE_STRIDE), LABIAL_WINDOW + LABIAL_LAG + FIXTURE_STRIDE);
    assert_ok(fixture_open(&host, &model, 1));
    assert_ok(labial_push(host.stream, FIXTURE_A, 100)); /* 5 frames */
    assert_ok(labial_push(host.stream, FIXTURE_SIL, LABIAL_DURATION_MAX));
    for (size_t i = 0; i < LABIAL_DELAY(FIXTURE_STRIDE); i++)
        assert_int_equal(fixture_tick(&host), LABIAL_WAITING);
#if LABIAL_REACH >= 4
    for (size_t i = 0; i < hour - 100; i++)
        assert_ok(fixture_tick(&host));
#endif
    fixture_end(&host);
    while (fixture_tick(&host) != LABIAL_DONE)
        assert_true(host.recorder.count <= hour + 5);
    assert_int_equal(host.recorder.count, hour + 5);
    assert_played(&host, host.complaint ? -1 : 0);
    fixture_close(&host);
}

SUITE(setup, NULL)
