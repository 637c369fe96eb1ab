/*
 * test_stream.c - what a stream delivers: the same frames however it is fed and wherever it lies.
 *
 * The host of the fixture checks on every tick that the callback comes once per LABIAL_OK, that frames are numbered
 * without a gap, and that waiting, starving and being done are told apart (fixture_host.c).
 */
#include "suite.h"

#define COUNT 150

static fixture_model_t rich, slow;
static fixture_phoneme_t input[COUNT];

SETUP(setup)
{
    fixture_rich(&rich);
    fixture_slow(&slow);
    return 0;
}

/* Would catch a pointer of the structure into itself. The old place is overwritten and freed. */
TEST(frames_do_not_depend_on_where_the_structure_lies)
{
    fixture_host_t wanted, host;
    const labial_model_t *model = &rich.model;
    fixture_stream(input, COUNT, FIXTURE_RANDOM, 5);
    assert_played(&wanted, fixture_run(&wanted, model, input, COUNT, FIXTURE_CHANCE));
    assert_ok(fixture_open(&host, &model, 1));
    host.moving = 1;
    assert_played(&host, fixture_play(&host, input, COUNT, FIXTURE_CHANCE));
    assert_int_equal(fixture_difference(&wanted.recorder, &host.recorder), -1);
    fixture_close(&wanted);
    fixture_close(&host);
}

/* Would catch memory that is read before it is written: the hosts fill it with other values before labial_init(). */
TEST(frames_do_not_depend_on_what_memory_held)
{
    fixture_host_t wanted, host;
    const uint32_t size = labial_workspace_size(&rich.model);
    fixture_stream(input, 40, FIXTURE_RANDOM, 8);
    assert_played(&wanted, fixture_run(&wanted, &rich.model, input, 40, FIXTURE_FILL));
    assert_played(&host, fixture_run(&host, &rich.model, input, 40,
                                     FIXTURE_FILL)); /* the stream is used, then initialised anew */
    memset(host.workspace, 0xff, size);
    assert_ok(fixture_open_again(&host));
    assert_played(&host, fixture_play(&host, input, 40, FIXTURE_FILL));
    assert_int_equal(fixture_difference(&wanted.recorder, &host.recorder), -1);
    fixture_close(&wanted);
    fixture_close(&host);
}

/* Would catch static variables, and a workspace that is larger inside than outside. */
TEST(two_streams_do_not_disturb_each_other)
{
    static fixture_phoneme_t other[COUNT];
    fixture_host_t alone[2], together[2];
    const labial_model_t *const models[] = { &rich.model, &slow.model };
    const fixture_phoneme_t *const inputs[] = { input, other };
    size_t next[2] = { 0, 0 };
    int done[2] = { 0, 0 };
    unsigned rounds = 0;
    fixture_stream(input, COUNT, FIXTURE_RANDOM, 11);
    fixture_stream(other, COUNT, FIXTURE_PAUSES, 12);
    for (unsigned i = 0; i < 2; i++) {
        assert_played(&alone[i], fixture_run(&alone[i], models[i], inputs[i], COUNT, FIXTURE_FILL));
        assert_ok(fixture_open(&together[i], &models[i], 1));
    }
    while (!done[0] || !done[1]) {
        assert_true(rounds++ < 200000);
        for (unsigned i = 0; i < 2; i++) {
            fixture_host_t *host = &together[i];
            if (next[i] < COUNT && labial_room(host->stream) > 0)
                assert_ok(fixture_push(host, &inputs[i][next[i]++]));
            if (next[i] == COUNT && !host->ended)
                fixture_end(host);
            done[i] = fixture_tick(host) == LABIAL_DONE;
        }
    }
    for (unsigned i = 0; i < 2; i++) {
        assert_played(&together[i], together[i].complaint ? -1 : 0);
        assert_int_equal(fixture_difference(&alone[i].recorder, &together[i].recorder), -1);
        fixture_close(&alone[i]);
        fixture_close(&together[i]);
    }
}

SUITE(setup, NULL)
