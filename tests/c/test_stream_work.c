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
    uint32_t workspace[LABIAL_WORKSPACE_SIZE(LABIAL_SEARCH_STRIDE_MAX) / 4];
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
        for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
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

/* Would catch a shape that is selected when its phoneme begins, in a tick that has enough to do: where phonemes are known
 * and last as many frames as channels have turns, it is selected before, half of it in each of the ticks with fewer
 * channels. */
TEST(shapes_are_selected_ahead)
{
    unsigned left = 120, begun = 0, halves = 0;
    begin(&speech_en);
    for (unsigned tick = 0;; tick++) {
        const uint8_t was = place.stream.next.halves;
        const labial_shape_t spoken = place.stream.shape;
        feed(SPEECH_EN_PHONEMES, &left);
        if (labial_tick(&place.stream) == LABIAL_DONE)
            break;
        const int has_begun = memcmp(&spoken, &place.stream.shape, sizeof spoken) != 0;
        if (has_begun && tick > 0 && was < 2)
            fail_msg("tick %u selects the shape that it uses", tick);
        if (place.stream.next.halves != (has_begun ? 0 : was) && tick > 0) {
            assert_int_equal(place.stream.next.halves, (has_begun ? 0 : was) + 1);
            halves++;
            if (tick % speech_en.search_stride == 0)
                fail_msg("tick %u selects though it has most channels", tick);
        }
        begun += (unsigned)has_begun;
    }
    assert_in_range(begun, 100, 130);
    assert_in_range(halves, 200, 260);
}

/* A phoneme of one frame leaves no tick between its own and the next one's. Would catch a shape that is selected in a
 * tick with most channels, though the tick before could have done it. */
TEST(the_fullest_ticks_select_no_shape)
{
    unsigned left = 120, begun = 0;
    begin(&speech_en);
    for (unsigned tick = 0; left > 0; tick++) {
        const uint8_t was = place.stream.next.halves;
        const labial_shape_t spoken = place.stream.shape;
        for (; left > 0 && labial_room(&place.stream) > 0; left--)
            assert_int_equal(labial_push(&place.stream, left * 7u % SPEECH_EN_PHONEMES, left % 2u ? 20 : 60),
                             LABIAL_OK);
        assert_true(labial_tick(&place.stream) >= 0);
        if (tick > 0 && tick % speech_en.search_stride == 0) {
            const int has_begun = memcmp(&spoken, &place.stream.shape, sizeof spoken) != 0;
            begun += (unsigned)has_begun;
            assert_true((was == 2 && place.stream.next.halves == 0) || (!has_begun && place.stream.next.halves == was));
        }
    }
    assert_in_range(begun, 20, 80);
}

SUITE(setup, NULL)
