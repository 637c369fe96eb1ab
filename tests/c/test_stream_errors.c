/*
 * test_stream_errors.c - misuse: every wrong call says what is wrong and leaves the stream as it was.
 */
#include "suite.h"

#define COUNT 60

static fixture_model_t plain, rich, slow, laugh, other_rate, older, third, fourth;
static fixture_phoneme_t input[COUNT];

SETUP(setup)
{
    fixture_all(&plain, &rich, &laugh, &slow);
    fixture_laughter(&third);
    fixture_laughter(&fourth);
    fixture_plain(&other_rate);
    other_rate.model.frames_per_second = 25;
    fixture_plain(&older);
    older.model.format = LABIAL_MODEL_FORMAT - 1;
    fixture_stream(input, COUNT, FIXTURE_RANDOM, 2);
    return 0;
}

/* Every wrong call there is at this moment. */
static void commit_errors(labial_t *stream, int ended)
{
    assert_int_equal(labial_push(NULL, 0, 10), LABIAL_ERROR_NULL);
    assert_int_equal(labial_tick(NULL), LABIAL_ERROR_NULL);
    assert_int_equal(labial_use(stream, NULL), LABIAL_ERROR_NULL);
    if (ended) {
        assert_int_equal(labial_push(stream, FIXTURE_A, 100), LABIAL_ERROR_STATE);
        assert_int_equal(labial_use(stream, &laugh.model), LABIAL_ERROR_STATE);
        assert_int_equal(labial_room(stream), 0);
        assert_ok(labial_end(stream)); /* "also when called again" */
        return;
    }
    assert_int_equal(labial_use(stream, &other_rate.model), LABIAL_ERROR_FRAME_RATE);
    assert_int_equal(labial_use(stream, &slow.model), LABIAL_ERROR_FRAME_RATE); /* of another stride */
    assert_int_equal(labial_use(stream, &older.model), LABIAL_ERROR_VERSION);
    if (labial_room(stream) > 0) {
        assert_int_equal(labial_push(stream, FIXTURE_SPEECH_COUNT, 100), LABIAL_ERROR_PHONEME);
        assert_int_equal(labial_push(stream, 255, 100), LABIAL_ERROR_PHONEME);
        assert_int_equal(labial_push(stream, 256 + FIXTURE_A, 100), LABIAL_ERROR_PHONEME); /* 1 in the low byte */
        assert_int_equal(labial_push(stream, UINT32_MAX, 100), LABIAL_ERROR_PHONEME);
        assert_int_equal(labial_push(stream, FIXTURE_A, LABIAL_DURATION_MAX + 1), LABIAL_ERROR_DURATION);
        assert_int_equal(labial_push(stream, FIXTURE_A, UINT32_MAX), LABIAL_ERROR_DURATION);
    } else {
        assert_int_equal(labial_push(stream, FIXTURE_A, 100), LABIAL_ERROR_FULL);
    }
}

/* Would catch an error that is found after something was changed already. */
TEST(errors_leave_the_stream_unchanged)
{
    fixture_host_t calm, host;
    const labial_model_t *model = &rich.model;
    size_t i = 0;
    unsigned rounds = 0;
    int result = LABIAL_WAITING;
    assert_played(&calm, fixture_run(&calm, model, input, COUNT, FIXTURE_FILL));
    assert_ok(fixture_open(&host, &model, 1));
    while (result != LABIAL_DONE) {
        labial_latency_t before = labial_latency(host.stream);
        assert_true(rounds++ < 10000);
        commit_errors(host.stream, host.ended);
        if (result == LABIAL_OK && before.frames > 0)
            assert_int_equal(labial_restart(host.stream), LABIAL_ERROR_STATE); /* frames are still to come */
        const labial_latency_t after = labial_latency(host.stream);
        assert_true(before.frames == after.frames && before.phonemes == after.phonemes);
        if (i < COUNT && labial_room(host.stream) > 0)
            assert_ok(fixture_push(&host, &input[i++]));
        commit_errors(host.stream, host.ended);
        if (i == COUNT && !host.ended)
            fixture_end(&host);
        result = fixture_tick(&host);
    }
    assert_null(host.complaint);
    assert_int_equal(fixture_difference(&calm.recorder, &host.recorder), -1);
    fixture_close(&calm);
    fixture_close(&host);
}

/* "labial_room(): phonemes that can be pushed before the queue is full". */
TEST(the_queue_takes_as_many_as_it_says)
{
    fixture_host_t host;
    const labial_model_t *model = &rich.model;
    assert_ok(fixture_open(&host, &model, 1));
    const unsigned room = labial_room(host.stream);
    assert_int_equal(room, LABIAL_QUEUE);
    for (unsigned i = 0; i < room; i++) {
        assert_int_equal(labial_room(host.stream), room - i);
        assert_ok(labial_push(host.stream, i % FIXTURE_SPEECH_COUNT, 20));
    }
    assert_int_equal(labial_room(host.stream), 0);
    commit_errors(host.stream, 0); /* LABIAL_ERROR_FULL among them */
    assert_int_equal(labial_latency(host.stream).frames, room);
    assert_played(&host, fixture_play(&host, input, 0, FIXTURE_FILL));
    assert_int_equal(host.recorder.count, room);
    fixture_close(&host);
}

static void check_refuses(labial_t *stream, int result)
{
    const labial_latency_t latency = labial_latency(stream);
    assert_int_equal(labial_push(stream, 0, 100), result);
    assert_int_equal(labial_use(stream, &plain.model), result);
    assert_int_equal(labial_end(stream), result);
    assert_int_equal(labial_tick(stream), result);
    assert_int_equal(labial_cancel(stream, 100), result);
    assert_int_equal(labial_restart(stream), result);
    assert_int_equal(labial_articulation(stream, 100), result);
    assert_int_equal(labial_room(stream), 0);
    assert_true(latency.frames == 0 && latency.milliseconds == 0 && latency.phonemes == 0);
}

/* Would catch the use of pointers that were never set. */
TEST(nothing_works_before_init)
{
    static const int fills[] = { 0x00, 0xff, 0x01, 0xa5, 0x7f };
    labial_t *stream = (labial_t *)fixture_room(1, sizeof *stream);
    for (unsigned i = 0; i < COUNT_OF(fills); i++) {
        memset(stream, fills[i], sizeof *stream);
        check_refuses(stream, LABIAL_ERROR_STATE);
    }
    for (unsigned i = 0; i < 20; i++) {
        fixture_random_t random = { i + 1 };
        for (unsigned k = 0; k < sizeof *stream; k++)
            ((uint8_t *)stream)[k] = (uint8_t)fixture_random(&random);
        check_refuses(stream, LABIAL_ERROR_STATE);
    }
    free(stream);
}

TEST(null_streams_are_refused)
{
    check_refuses(NULL, LABIAL_ERROR_NULL);
}

/* Would catch a failed labial_init() that leaves an earlier stream half alive. */
TEST(a_failed_init_makes_the_stream_unusable)
{
    const uint32_t size = labial_workspace_size(&plain.model);
    uint32_t *workspace = (uint32_t *)fixture_room(size + 4u, 1); /* room enough for the misaligned ones */
    labial_t *stream = (labial_t *)fixture_room(1, sizeof *stream);
    uint8_t *bytes = (uint8_t *)workspace;
    fixture_recorder_t recorder = { 0 };
    const struct {
        const labial_model_t *model;
        void *workspace;
        uint32_t size;
        labial_frame_fn callback;
        int wanted;
    } calls[] = {
        { NULL, workspace, size, fixture_record, LABIAL_ERROR_NULL },
        { &plain.model, NULL, size, fixture_record, LABIAL_ERROR_NULL },
        { &plain.model, workspace, size, NULL, LABIAL_ERROR_NULL },
        { &plain.model, workspace, size - 1, fixture_record, LABIAL_ERROR_WORKSPACE }, /* one byte short */
        { &plain.model, workspace, 0, fixture_record, LABIAL_ERROR_WORKSPACE },
        { &rich.model, workspace, size, fixture_record, LABIAL_ERROR_WORKSPACE },  /* enough for a stride of one, */
        { &slow.model, workspace, size, fixture_record, LABIAL_ERROR_WORKSPACE },  /* not of two or three */
        { &plain.model, bytes + 1, size, fixture_record, LABIAL_ERROR_WORKSPACE }, /* misaligned */
        { &plain.model, bytes + 2, size, fixture_record, LABIAL_ERROR_WORKSPACE },
        { &older.model, workspace, size, fixture_record, LABIAL_ERROR_VERSION },
    };
    for (unsigned i = 0; i < COUNT_OF(calls); i++) {
        assert_ok(labial_init(stream, &plain.model, workspace, size, fixture_record, &recorder));
        assert_ok(labial_push(stream, FIXTURE_A, 100));
        assert_int_equal(
            labial_init(stream, calls[i].model, calls[i].workspace, calls[i].size, calls[i].callback, &recorder),
            calls[i].wanted);
        check_refuses(stream, LABIAL_ERROR_STATE);
    }
    assert_int_equal(labial_init(NULL, &plain.model, workspace, size, fixture_record, &recorder), LABIAL_ERROR_NULL);
    assert_int_equal(recorder.count, 0);
    free(workspace);
    free(stream);
}

/* Would catch a formula that differs between macro and function; the tests' workspaces are exactly this large. Only the
 * stride and the number of channels matter. */
TEST(workspace_sizes_agree)
{
    static uint32_t constant[LABIAL_WORKSPACE_SIZE(1, LABIAL_CHANNELS) / 4];
    assert_int_equal(sizeof constant, labial_workspace_size(&plain.model));
    for (unsigned stride = 1; stride <= LABIAL_SEARCH_STRIDE_MAX; stride++) {
        slow.model.search_stride = (uint8_t)stride;
        for (unsigned count = 1; count <= LABIAL_CHANNELS; count++) {
            slow.model.channel_count = (uint8_t)count;
            assert_int_equal(labial_workspace_size(&slow.model), LABIAL_WORKSPACE_SIZE(stride, count));
            assert_int_equal(labial_workspace_size(&slow.model) % 4, 0);
            assert_true(stride == 1 || LABIAL_WORKSPACE_SIZE(stride, count) > LABIAL_WORKSPACE_SIZE(stride - 1, count));
            assert_true(count == 1 || LABIAL_WORKSPACE_SIZE(stride, count) > LABIAL_WORKSPACE_SIZE(stride, count - 1));
        }
    }
    assert_int_equal(LABIAL_WORKSPACE_SIZE(1 + 1, 4 + 4), LABIAL_WORKSPACE_SIZE(2, 8)); /* expressions are one value */
    assert_int_equal(LABIAL_DELAY(1 + 1), LABIAL_DELAY(2));
    assert_int_equal(LABIAL_LARGER(LABIAL_WORKSPACE_SIZE(1, 8), LABIAL_WORKSPACE_SIZE(3, 8)),
                     LABIAL_WORKSPACE_SIZE(3, 8));
    fixture_slow(&slow);
    assert_int_equal(labial_workspace_size(NULL), 0);
}

/* Would catch a workspace that a wider model's channels run out of, and one that has room for them and is not used. */
TEST(a_model_of_more_channels_needs_room)
{
    static uint32_t memory[LABIAL_WORKSPACE_SIZE(FIXTURE_STRIDE, LABIAL_CHANNELS) / 4];
    static const uint32_t wide = sizeof memory;
    fixture_recorder_t recorder = { 0 };
    fixture_model_t narrow;
    labial_t stream;
    fixture_rich(&narrow);
    fixture_narrow(&narrow, fixture_mirrored);
    const uint32_t size = labial_workspace_size(&narrow.model);
    assert_true(size + 5 * sizeof(labial_progress_t) < wide);
    assert_int_equal(labial_init(&stream, &rich.model, memory, wide - 4, fixture_record, &recorder),
                     LABIAL_ERROR_WORKSPACE);
    assert_int_equal(labial_init(&stream, &narrow.model, memory, size - 4, fixture_record, &recorder),
                     LABIAL_ERROR_WORKSPACE);
    assert_ok(labial_init(&stream, &narrow.model, memory, size, fixture_record, &recorder));
    assert_int_equal(labial_use(&stream, &rich.model), LABIAL_ERROR_WORKSPACE);
    assert_ok(labial_push(&stream, FIXTURE_A, 100)); /* unchanged, of the first model */
    assert_ok(labial_init(&stream, &narrow.model, memory, wide - 1, fixture_record, &recorder));
    assert_int_equal(labial_use(&stream, &rich.model), LABIAL_ERROR_WORKSPACE);
    assert_ok(labial_init(&stream, &narrow.model, memory, wide, fixture_record, &recorder));
    assert_ok(labial_use(&stream, &rich.model));
    assert_ok(labial_init(&stream, &rich.model, memory, wide, fixture_record, &recorder));
    assert_ok(labial_use(&stream, &narrow.model));
}

/* More models than LABIAL_MODELS: refused while phonemes of all others are held, accepted once ticks have taken up those
 * of one, and at the latest when its last frame is delivered. Would catch a slot that is given away too early,
 * and one that is never free again. */
TEST(too_many_models_are_refused_until_ticks_make_room)
{
    const labial_model_t *const models[FIXTURE_MODELS] = { &rich.model, &laugh.model, &third.model, &fourth.model };
    const unsigned frames = 100, still_needed = LABIAL_DELAY(FIXTURE_STRIDE);
    fixture_host_t host;
    unsigned ticks = 0;
    assert_ok(fixture_open(&host, models, FIXTURE_MODELS));
    assert_in_range(LABIAL_MODELS, 1, FIXTURE_MODELS - 1); /* what this test is written for */
    if (LABIAL_QUEUE <= LABIAL_MODELS) {                   /* too short to hold phonemes of so many */
        fixture_close(&host);
        return;
    }
    for (unsigned i = 0; i < LABIAL_MODELS; i++) {
        assert_ok(labial_use(host.stream, models[i]));
        assert_ok(labial_push(host.stream, 1, frames * 1000 / FIXTURE_RATE));
    }
    for (unsigned i = 0; i < LABIAL_MODELS; i++)
        assert_ok(labial_use(host.stream, models[i])); /* known already */
#if LABIAL_MODELS > 1
    assert_ok(labial_push(host.stream, 1, frames * 1000 / FIXTURE_RATE)); /* so that the last begins */
#endif
    while (labial_use(host.stream, models[LABIAL_MODELS]) == LABIAL_ERROR_MODELS && ticks < 400) {
        (void)fixture_tick(&host);
        ticks++;
    }
#if LABIAL_MODELS > 1
    assert_int_equal(ticks, frames + still_needed);
    assert_ok(labial_push(host.stream, FIXTURE_HA, 1000));
    assert_played(&host, fixture_play(&host, input, 0, FIXTURE_FILL));
    assert_int_equal(host.recorder.count, (LABIAL_MODELS + 1) * frames + 1000 * FIXTURE_RATE / 1000);
#else
    assert_int_equal(ticks, 400); /* what follows the only phoneme is not known: it is never taken up but at the end */
    assert_played(&host, fixture_play(&host, input, 0, FIXTURE_FILL));
    fixture_restart(&host);
    assert_ok(labial_use(host.stream, models[1]));
    assert_in_range(still_needed, 1, 100);
#endif
    fixture_close(&host);
}

#if LABIAL_MODELS == 2 && LABIAL_QUEUE >= 4
/* A model that was chosen and not used makes room at once, and so does one whose phonemes never came. Would catch a place
 * that is kept for no phoneme, and a frame that was never taken counted as the first model's. */
TEST(models_that_nothing_was_pushed_of_make_room)
{
    fixture_host_t host;
    const labial_model_t *const models[FIXTURE_MODELS] = { &rich.model, &laugh.model, &third.model, &fourth.model };
    for (int entered = 0; entered < 6; entered++) {
        const unsigned first = entered < 3 ? 1 : 2, next = 3 - first;
        assert_ok(fixture_open(&host, models, FIXTURE_MODELS));
        assert_ok(labial_use(host.stream, models[1])); /* nothing was pushed of the first, */
        assert_ok(labial_use(host.stream, models[first]));
        assert_ok(labial_push(host.stream, 1, 1000));
        assert_ok(labial_push(host.stream, 1, 1000));
        for (int ticks = 0; ticks < entered % 3; ticks++)
            (void)fixture_tick(&host);
        assert_ok(labial_use(host.stream, models[next])); /* and no frame was ever its */
        if (first == 2)
            assert_ok(labial_use(host.stream, models[3]));
        assert_ok(labial_push(host.stream, 1, 100));
        assert_int_equal(labial_use(host.stream, models[0]), LABIAL_ERROR_MODELS);
        fixture_close(&host);
    }
}
#endif

SUITE(setup, NULL)
