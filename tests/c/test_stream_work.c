/*
 * test_stream_work.c - the even share of ticks: which channels a tick searches and solves, and when it selects a shape.
 * What is delivered does not tell, but a tick that does the work of several is late on a small processor.
 */
#include "suite.h"

#include <string.h>

#include "fixture.h"
#include "speech_en.h"

static fixture_model_t rich, slow;

SETUP(setup)
{
    fixture_rich(&rich);
    fixture_slow(&slow);
    return 0;
}

static void ignore(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)user;
    (void)frame;
    (void)faps;
}

typedef struct {
    labial_t stream;
    uint32_t workspace[LABIAL_WORKSPACE_SIZE(LABIAL_SEARCH_STRIDE_MAX, LABIAL_CHANNELS) / 4];
} place_t;

static place_t place;

static void begin(const labial_model_t *model)
{
    assert_int_equal(labial_init(&place.stream, model, place.workspace, sizeof place.workspace, ignore, NULL),
                     LABIAL_OK);
}

/* Fills the queue with phonemes of three frames and more; ends the stream once `left` is 0. */
static void feed(unsigned phonemes, unsigned *left)
{
    while (*left > 0 && labial_room(&place.stream) > 0) {
        assert_int_equal(labial_push(&place.stream, *left * 7u % phonemes, 60u + *left % 5u * 20u), LABIAL_OK);
        --*left;
    }
    if (*left == 0)
        assert_int_equal(labial_end(&place.stream), LABIAL_OK);
}

/* Would catch a channel whose turn comes in another's tick, twice or never: ticks that do more than their share. */
static void channels_take_turns(const labial_model_t *model)
{
    labial_progress_t before[LABIAL_CHANNELS];
    const unsigned stride = model->search_stride;
    unsigned left = 60, moved = 0, turns = 0;
    begin(model);
    for (unsigned tick = 0;; tick++) {
        feed(model->phoneme_count, &left);
        memcpy(before, place.stream.channels.progress, sizeof before);
        if (labial_tick(&place.stream) == LABIAL_DONE)
            break;
        for (unsigned c = 0; c < model->channel_count; c++) {
            const int changed = memcmp(&before[c], &place.stream.channels.progress[c], sizeof before[c]) != 0;
            if (c % stride != tick % stride && changed)
                fail_msg("tick %u works on channel %u", tick, c);
            turns += c % stride == tick % stride;
            moved += (unsigned)changed;
        }
    }
    assert_true(turns > 400 && moved * 10 > turns * 8);
}

TEST(channels_take_turns_in_every_stride)
{
    channels_take_turns(&rich.model);
    channels_take_turns(&slow.model);
    channels_take_turns(&speech_en);
}

/* Halves of a selection that a tick makes. */
typedef struct {
    unsigned tick, halves, begun; /* `begun`: a phoneme, with the shape that was selected */
} work_t;

/* The work of the next tick of a stream of phonemes that last `ms`, or three frames and more by turns where that is 0;
 * false at the end. */
static int next_work(unsigned ms, unsigned *left, work_t *work)
{
    const uint8_t was = place.stream.next.halves;
    const labial_shape_t *const spoken = place.stream.shape;
    for (; *left > 0 && labial_room(&place.stream) > 0; --*left)
        assert_int_equal(labial_push(&place.stream, *left * 7u % SPEECH_EN_PHONEMES, ms ? ms : 60u + *left % 5u * 20u),
                         LABIAL_OK);
    if (*left == 0)
        assert_int_equal(labial_end(&place.stream), LABIAL_OK);
    if (labial_tick(&place.stream) == LABIAL_DONE)
        return 0;
    work->begun = place.stream.shape != spoken;
    work->halves = place.stream.next.halves + (work->begun ? 2u : 0u) - was;
    work->tick++;
    return 1;
}

/* Would catch a shape that is selected in a tick that has enough to do: where phonemes are known and last as many frames
 * as channels have turns, it is selected in the ticks with the fewest channels. */
TEST(shapes_are_selected_in_the_lightest_ticks)
{
    work_t work = { 0, 0, 0 };
    unsigned left = 120, begun = 0, halves = 0;
    begin(&speech_en);
    while (next_work(0, &left, &work)) {
        if (work.tick > 1 && work.tick % speech_en.search_stride != 0)
            assert_int_equal(work.halves, 0);
        halves += work.halves;
        begun += work.begun;
    }
    assert_in_range(begun, 100, 130);
    assert_in_range(halves, 200, 260);
}

/* Phonemes of one and of two frames leave no such tick between some of them. Would catch a tick that selects more than
 * one shape, and one that selects a whole one though the tick before or after could have shared it. */
TEST(short_phonemes_share_the_selection)
{
    for (unsigned frames = 1; frames <= 2; frames++) {
        work_t work = { 0, 0, 0 };
        unsigned left = 120, begun = 0, whole = 0;
        begin(&speech_en);
        while (next_work(20u * frames, &left, &work)) {
            assert_true(work.halves <= 2);
            whole += work.halves == 2 && work.tick % speech_en.search_stride != 0;
            begun += work.begun;
        }
        assert_in_range(begun, 100, 130);
        assert_true(frames == 1 || whole <= 45);
    }
}

SUITE(setup, NULL)
