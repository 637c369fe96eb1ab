/*
 * test_locks.c - which calls take the lock of a stream: each but labial_init() takes it once and gives it back, whatever
 * its result; labial_tick() with LABIAL_LOCKS 2 alone, and never while the callback runs. A program whose lock does not
 * nest would stand still at the first fault.
 */
#include "suite.h"

#include "labial/labial.h"
#include "labial/visemes.h"
#include "speech_en.h"

static labial_t stream;
static uint32_t workspace[SPEECH_EN_WORKSPACE_SIZE / 4];
static const labial_t *holder;
static unsigned depth, taken, frames;

void labial_lock(const labial_t *locked)
{
    assert_int_equal(depth, 0);
    holder = locked;
    depth++;
    taken++;
}

void labial_unlock(const labial_t *locked)
{
    assert_int_equal(depth, 1);
    assert_ptr_equal(locked, holder);
    depth--;
}

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    uint8_t shares[LABIAL_VISEMES];
    (void)user;
    (void)frame;
    (void)faps;
    frames++;
    assert_int_equal(depth, 0);
    if (labial_room(&stream) > 0 && frames < 40) /* as from anywhere else */
        assert_int_equal(labial_push(&stream, frames % speech_en.phoneme_count, 20), LABIAL_OK);
    assert_int_equal(labial_visemes(&stream, &speech_en, labial_arpabet_visemes, shares), LABIAL_OK);
    assert_int_equal(depth, 0);
}

/* That a call took the lock `count` times and gave it back. */
static void assert_taken(unsigned count)
{
    assert_int_equal(taken, count);
    assert_int_equal(depth, 0);
    taken = 0;
}

static void begin(void)
{
    taken = frames = 0;
    assert_int_equal(labial_init(&stream, &speech_en, workspace, sizeof workspace, on_frame, NULL), LABIAL_OK);
    assert_taken(0);
}

/* The result of a call that takes the lock. */
static void assert_takes_it(int64_t result, int64_t wanted)
{
    assert_int_equal(result, wanted);
    assert_taken(1);
}

TEST(each_call_takes_the_lock_once)
{
    uint8_t shares[LABIAL_VISEMES];
    begin();
    assert_takes_it(labial_room(&stream), LABIAL_QUEUE);
    assert_takes_it(labial_push(&stream, 1, 100), LABIAL_OK);
    assert_takes_it(labial_push(&stream, 255, 100), LABIAL_ERROR_PHONEME);
    assert_takes_it(labial_use(&stream, &speech_en), LABIAL_OK);
    assert_takes_it(labial_articulation(&stream, 130), LABIAL_OK);
    assert_takes_it(labial_latency(&stream).frames, 5);
    assert_takes_it(labial_uses(&stream, &speech_en), 1);
    assert_takes_it(labial_exact(&stream, 0), LABIAL_OK);
    assert_takes_it(labial_visemes(&stream, &speech_en, labial_arpabet_visemes, shares), LABIAL_OK);
    assert_takes_it(labial_restart(&stream), LABIAL_ERROR_STATE);
    assert_takes_it(labial_end(&stream), LABIAL_OK);
    assert_takes_it(labial_cancel(&stream, 40), LABIAL_OK);
    assert_takes_it(labial_end(NULL), LABIAL_ERROR_NULL);
}

TEST(a_tick_calls_the_callback_without_the_lock)
{
    int result;
    begin();
    assert_int_equal(labial_push(&stream, 3, 200), LABIAL_OK);
    assert_int_equal(labial_push(&stream, 7, 600), LABIAL_OK);
    do {
        unsigned before = frames;
        taken = 0;
        result = labial_tick(&stream);
        assert_true(result >= 0);
        if (frames == before) /* no callback, which takes it, too */
            assert_taken(LABIAL_LOCKS > 1 ? 1 : 0);
        if (frames > 20)
            labial_end(&stream);
    } while (result != LABIAL_DONE);
    assert_true(frames > 40);
}

TEST(easing_to_rest_does_so_too)
{
    begin();
    assert_int_equal(labial_push(&stream, 3, 200), LABIAL_OK);
    assert_int_equal(labial_cancel(&stream, 60), LABIAL_OK);
    while (labial_tick(&stream) == LABIAL_OK)
        assert_int_equal(depth, 0);
    assert_int_equal(frames, 3);
    taken = 0;
    assert_int_equal(labial_tick(&stream), LABIAL_DONE);
    assert_taken(LABIAL_LOCKS > 1 ? 1 : 0);
    assert_int_equal(labial_tick(NULL), LABIAL_ERROR_NULL);
    assert_taken(LABIAL_LOCKS > 1 ? 1 : 0);
}

SUITE(NULL, NULL)
