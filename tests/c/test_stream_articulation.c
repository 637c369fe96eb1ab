/*
 * test_stream_articulation.c - what labial.h says of labial_articulation(); test_stream_steps.c has the numbers.
 */
#include "suite.h"

#include <limits.h>

#include "fixture.h"

#define COUNT 60

static fixture_model_t rich;
static fixture_phoneme_t input[COUNT];
static const labial_model_t *models[1];

SETUP(setup)
{
    fixture_rich(&rich);
    return 0;
}

/* Plays `count` phonemes on a stream that is told `percent` before them. */
static void play_at(fixture_host_t *host, unsigned percent, size_t count)
{
    assert_int_equal(labial_articulation(host->stream, percent), LABIAL_OK);
    assert_played(host, fixture_play(host, input, count, FIXTURE_FILL));
}

static void open_at(fixture_host_t *host, unsigned percent, size_t count)
{
    models[0] = &rich.model;
    assert_int_equal(fixture_open(host, models, 1), LABIAL_OK);
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
    assert_int_equal(labial_init(silent.stream, models[0], silent.workspace, labial_workspace_size(models[0]),
                                 fixture_record, &silent.recorder),
                     LABIAL_OK);
    assert_int_equal(labial_exact(silent.stream, 1), LABIAL_OK);
    silent.ended = 0;
    silent.recorder.next = 0;
    silent.recorder.count = silent.begun = 0;
    silent.on_way = 0;
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
    for (unsigned i = 0; i < sizeof more / sizeof more[0]; i++) {
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
            assert_int_equal(labial_articulation(host.stream, 60), LABIAL_OK);
        while (fixture_tick(&host) != LABIAL_DONE)
            ;
        if (way == 2)
            assert_int_equal(labial_articulation(host.stream, 60), LABIAL_OK);
        fixture_restart(&host);
        if (way == 3)
            assert_int_equal(labial_articulation(host.stream, 60), LABIAL_OK);
        assert_played(&host, fixture_play(&host, input, COUNT, FIXTURE_FILL));
        assert_int_equal(fixture_difference(&ever.recorder, &host.recorder), -1);
        fixture_close(&host);
    }
    fixture_close(&ever);
}

SUITE(setup, NULL)
