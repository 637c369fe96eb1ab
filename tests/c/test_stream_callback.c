/*
 * test_stream_callback.c - every call on a stream from its own callback, as labial.h says: what is allowed has its
 * effect, what is refused gives the error that it gives from anywhere else, and the frames are those of a stream whose
 * program makes the same calls between ticks.
 */
#include "suite.h"

#define FRAMES 200
#define WORKSPACE (LABIAL_WORKSPACE_SIZE(FIXTURE_STRIDE, LABIAL_CHANNELS) / 4)

static fixture_model_t rich, laugh, other_rate;
static int exact; /* of the streams that are opened */

typedef struct actor actor_t;

/* What is done at a frame. */
typedef void (*act_fn)(actor_t *actor);

struct actor {
    labial_t stream;
    uint32_t workspace[WORKSPACE];
    act_fn act;
    uint32_t at;      /* the frame with which `act` is done */
    int between;      /* not in the callback, but after the tick */
    int is_due, done; /* whether it is time, and how often it was done */
    size_t count;
    uint32_t numbers[FRAMES];
    int16_t faps[FRAMES][LABIAL_CHANNELS];
};

static void do_act(actor_t *actor)
{
    actor->is_due = 0;
    actor->done++;
    actor->act(actor);
}

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    actor_t *actor = (actor_t *)user;
    const size_t i = actor->count++;
    assert_true(i < FRAMES);
    actor->numbers[i] = frame;
    memcpy(actor->faps[i], faps, sizeof actor->faps[i]);
    if (frame != actor->at || actor->done)
        return;
    actor->is_due = 1;
    if (!actor->between)
        do_act(actor);
}

static void push_some(labial_t *stream)
{
    assert_ok(labial_push(stream, FIXTURE_A, 200));
    assert_ok(labial_push(stream, FIXTURE_P, 60));
    assert_ok(labial_push(stream, FIXTURE_O, 300));
}

static void open(actor_t *actor)
{
    assert_ok(labial_init(&actor->stream, &rich.model, actor->workspace, sizeof actor->workspace, on_frame, actor));
    assert_ok(labial_exact(&actor->stream, exact));
}

/* Plays some phonemes, and ends the stream when a tick says that more must be known. */
static void play(actor_t *actor, act_fn act, uint32_t at, int between)
{
    int result;
    memset(actor, 0, sizeof *actor);
    actor->act = act;
    actor->at = at;
    actor->between = between;
    open(actor);
    push_some(&actor->stream);
    do {
        result = labial_tick(&actor->stream);
        assert_true(result >= 0);
        if (actor->is_due)
            do_act(actor);
        if (result == LABIAL_STARVED)
            (void)labial_end(&actor->stream);
    } while (result != LABIAL_DONE);
    assert_int_equal(actor->done, 1);
}

/* The same frames from within as from without. */
static actor_t *compare(act_fn act, uint32_t at)
{
    static actor_t within, without;
    play(&within, act, at, 0);
    play(&without, act, at, 1);
    assert_int_equal(within.count, without.count);
    assert_memory_equal(within.numbers, without.numbers, sizeof within.numbers);
    assert_memory_equal(within.faps, without.faps, sizeof within.faps);
    return &within;
}

#define PUSHED 28 /* frames of what is pushed at first */

/* Each act is what its name says; what it returns is what labial.h says. */
static void look(actor_t *actor)
{
    const labial_latency_t latency = labial_latency(&actor->stream);
    assert_int_equal(latency.frames, PUSHED - 1 - actor->at); /* without the one that is being delivered */
    assert_int_equal(latency.delay, LABIAL_DELAY(FIXTURE_STRIDE));
    assert_in_range(labial_room(&actor->stream), LABIAL_QUEUE - 3, LABIAL_QUEUE);
}

static void push(actor_t *actor)
{
    push_some(&actor->stream);
    assert_int_equal(labial_push(&actor->stream, FIXTURE_SPEECH_COUNT, 100), LABIAL_ERROR_PHONEME);
    assert_int_equal(labial_push(&actor->stream, 0, LABIAL_DURATION_MAX + 1u), LABIAL_ERROR_DURATION);
    for (unsigned i = labial_room(&actor->stream); i > 0; i--)
        assert_ok(labial_push(&actor->stream, i % 2u ? FIXTURE_S : FIXTURE_A, 40));
    assert_int_equal(labial_push(&actor->stream, 0, 100), LABIAL_ERROR_FULL);
    assert_int_equal(labial_push(NULL, 0, 100), LABIAL_ERROR_NULL);
}

static void use(actor_t *actor)
{
    assert_int_equal(labial_use(&actor->stream, NULL), LABIAL_ERROR_NULL);
    assert_int_equal(labial_use(&actor->stream, &other_rate.model), LABIAL_ERROR_FRAME_RATE);
#if LABIAL_MODELS > 1
    assert_ok(labial_use(&actor->stream, &laugh.model));
    assert_ok(labial_push(&actor->stream, FIXTURE_HA, 300));
    assert_int_equal(labial_push(&actor->stream, FIXTURE_LAUGH_COUNT, 300), LABIAL_ERROR_PHONEME);
#endif
}

static void end(actor_t *actor)
{
    assert_ok(labial_end(&actor->stream));
    assert_ok(labial_end(&actor->stream));
    assert_int_equal(labial_push(&actor->stream, FIXTURE_A, 100), LABIAL_ERROR_STATE);
    assert_int_equal(labial_use(&actor->stream, &rich.model), LABIAL_ERROR_STATE);
    assert_int_equal(labial_room(&actor->stream), 0);
    if (actor->at + 1 < PUSHED)
        assert_int_equal(labial_restart(&actor->stream), LABIAL_ERROR_STATE); /* frames are still to come */
}

static void articulate(actor_t *actor)
{
    assert_ok(labial_articulation(&actor->stream, 40));
    assert_int_equal(labial_articulation(NULL, 40), LABIAL_ERROR_NULL);
}

static void cancel(actor_t *actor)
{
    assert_int_equal(labial_restart(&actor->stream), LABIAL_ERROR_STATE); /* the stream has not ended */
    assert_ok(labial_cancel(&actor->stream, 100));
    assert_int_equal(labial_push(&actor->stream, FIXTURE_A, 100), LABIAL_ERROR_STATE);
    assert_int_equal(labial_use(&actor->stream, &rich.model), LABIAL_ERROR_STATE);
    assert_int_equal(labial_room(&actor->stream), 0);
}

static void cancel_twice(actor_t *actor)
{
    assert_ok(labial_cancel(&actor->stream, 1000));
    assert_ok(labial_cancel(&actor->stream, 100));
}

static void restart(actor_t *actor) /* with the last frame of all */
{
    assert_ok(labial_restart(&actor->stream));
    push_some(&actor->stream);
}

static void begin_anew(actor_t *actor)
{
    open(actor);
    push_some(&actor->stream);
}

static void tick(actor_t *actor)
{
    assert_ok(labial_tick(&actor->stream));
}

TEST(each_call_does_the_same_within_and_without)
{
    const actor_t *actor;
    exact = 1;
    assert_int_equal(compare(look, 5)->count, PUSHED);
    assert_true(compare(push, 5)->count > 2 * PUSHED);
    assert_int_equal(compare(use, 5)->count, PUSHED + (LABIAL_MODELS > 1 ? 15 : 0));
    assert_int_equal(compare(end, 5)->count, PUSHED);
    assert_int_equal(compare(end, PUSHED - 1)->count, PUSHED); /* which has long ended */
    assert_int_equal(compare(articulate, 5)->count, PUSHED);
    assert_int_equal(compare(cancel, 5)->count, 6 + 5);
    assert_int_equal(compare(cancel_twice, 5)->count, 6 + 5);
    actor = compare(restart, PUSHED - 1);
    assert_int_equal(actor->count, 2 * PUSHED);
    assert_int_equal(actor->numbers[2 * PUSHED - 1], 2 * PUSHED - 1);
    actor = compare(begin_anew, 5); /* frames are numbered from 0 again */
    assert_int_equal(actor->count, 6 + PUSHED);
    assert_int_equal(actor->numbers[6], 0);
    assert_int_equal(compare(tick, 5)->count, PUSHED);
}

static void cancel_on_the_way(actor_t *actor)
{
    assert_ok(labial_cancel(&actor->stream, 100));
}

/* Likewise while the face comes to rest, where all of that is past. */
TEST(calls_on_the_way_to_rest_do_the_same_within_and_without)
{
    const uint32_t at = PUSHED + 3; /* of the frames of the way, the fourth */
    exact = 0;
    assert_int_equal(compare(end, at)->count, PUSHED + LABIAL_EASE_FRAMES);
    assert_int_equal(compare(articulate, at)->count, PUSHED + LABIAL_EASE_FRAMES);
    assert_int_equal(compare(tick, at)->count, PUSHED + LABIAL_EASE_FRAMES);
    assert_int_equal(compare(cancel_on_the_way, at)->count, PUSHED + 4 + 5);
    assert_int_equal(compare(begin_anew, at)->count, 2 * PUSHED + 4 + LABIAL_EASE_FRAMES);
    assert_int_equal(compare(restart, at)->count,
                     2 * PUSHED + 4 + LABIAL_DELAY(FIXTURE_STRIDE) + LABIAL_EASE_FRAMES); /* goes on first */
}

/* A tick in the callback of every frame: one inside the other, the frames in order. */
static void tick_on(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    actor_t *actor = (actor_t *)user;
    assert_int_equal(frame, actor->count);
    memcpy(actor->faps[actor->count++], faps, sizeof actor->faps[0]);
    (void)labial_tick(&actor->stream);
}

TEST(ticks_within_ticks_deliver_in_order)
{
    static actor_t nested, straight;
    int result;
    exact = 1;
    play(&straight, look, 5, 0);
    memset(&nested, 0, sizeof nested);
    assert_ok(labial_init(&nested.stream, &rich.model, nested.workspace, sizeof nested.workspace, tick_on, &nested));
    assert_ok(labial_exact(&nested.stream, exact));
    push_some(&nested.stream);
    assert_ok(labial_end(&nested.stream));
    do
        result = labial_tick(&nested.stream);
    while (result == LABIAL_WAITING);
    assert_ok(result); /* of the first frame, after which all others were delivered */
    assert_int_equal(nested.count, PUSHED);
    assert_int_equal(labial_tick(&nested.stream), LABIAL_DONE);
    assert_memory_equal(nested.faps, straight.faps, PUSHED * sizeof nested.faps[0]);
}

SETUP(setup)
{
    fixture_rich(&rich);
    fixture_laughter(&laugh);
    fixture_rich(&other_rate);
    other_rate.model.frames_per_second++;
    return 0;
}

SUITE(setup, NULL)
