/*
 * test_stream_steps.c - whole streams, fed by chance, against oracle.h, which takes all of the input at once: units, cut
 * pauses, search, equation 3 in doubles, fades. Of lib/ it uses shape.c alone, which has a suite of its own.
 *
 * Would catch what the suites of single steps cannot see: a neighbour taken from the wrong phoneme, a target or a state of
 * the wrong frame, a channel whose turn comes too early or too late, a way back that begins elsewhere, a part of the
 * workspace laid over another, a fade from the wrong pose.
 */
#include "suite.h"
#include "oracle.h"

#define COUNT 90
#define MAX_FRAMES 6000
#define ARTICULATED 60 /* phonemes of a stream that is */

/* Q4: rounding to whole FAP units and a tenth of one; where it fades, a pose and a pace of that error are held. */
#define TOLERANCE (8.0 + 1.6)
#define FADED_TOLERANCE (TOLERANCE + 6.0)

static fixture_model_t plain, rich, laugh, slow, computed, computed_slow, mirrored, crossed;
#if LABIAL_MODELS > 1
static fixture_model_t narrow;
#endif
static fixture_phoneme_t input[COUNT];
static const labial_model_t *models[2];
static double wanted[MAX_FRAMES][LABIAL_CHANNELS];

SETUP(setup)
{
    fixture_all(&plain, &rich, &laugh, &slow);
    fixture_rich(&computed);
    fixture_narrow(&computed, fixture_computed);
    fixture_slow(&computed_slow);
    fixture_narrow(&computed_slow, fixture_computed);
    fixture_rich(&mirrored);
    fixture_narrow(&mirrored, fixture_mirrored);
    fixture_slow(&crossed);
    fixture_narrow(&crossed, fixture_crossed);
    return 0;
}

static void judge(const fixture_recorder_t *recorder, size_t first, size_t count, double tolerance)
{
    assert_int_equal(recorder->count - first, count);
    for (size_t t = 0; t < count; t++)
        for (unsigned c = 0; c < LABIAL_CHANNELS; c++)
            assert_near(recorder->frames[first + t][c] * 16.0, wanted[t][c], tolerance);
}

static void compare(unsigned model_count, size_t count, unsigned seed)
{
    fixture_host_t host;
    assert_ok(fixture_open(&host, models, model_count));
    host.random.state = seed + 1;
    assert_played(&host, fixture_play(&host, input, count, seed % 2 ? FIXTURE_FILL : FIXTURE_CHANCE));
    judge(&host.recorder, 0, oracle_stream(models, input, count, NULL, NULL, wanted, MAX_FRAMES),
          model_count > 1 ? FADED_TOLERANCE : TOLERANCE);
    fixture_close(&host);
}

TEST(one_model_is_the_sum_of_its_steps)
{
    for (int kind = 0; kind < FIXTURE_MILLI; kind++) {
        for (unsigned seed = 0; seed < FIXTURE_ROUNDS(4); seed++) {
            models[0] = seed == 0 ? &plain.model : seed < 3 ? &rich.model : &slow.model;
            fixture_stream(input, COUNT, (fixture_kind_t)kind, seed);
            for (unsigned i = 0; kind == FIXTURE_PAUSES && i < COUNT; i++)
                input[i].ms %= 2500;
            compare(1, COUNT, seed);
        }
    }
}

/* Every stride there is: would catch a workspace that is laid out for another, a turn that is a tick off. */
TEST(every_stride_is_the_sum_of_its_steps)
{
    for (unsigned stride = 1; stride <= LABIAL_SEARCH_STRIDE_MAX; stride++) {
        fixture_model_t *const f = stride % 2 ? &rich : &slow;
        const uint8_t own = f->model.search_stride;
        f->model.search_stride = (uint8_t)stride;
        models[0] = &f->model;
        fixture_stream(input, COUNT, FIXTURE_RANDOM, stride);
        compare(1, COUNT, stride);
        fixture_stream(input, COUNT, FIXTURE_ONE_FRAME, stride);
        compare(1, COUNT, stride);
        f->model.search_stride = own;
    }
}

/* Streams of one frame, of two, ... up to more than the delay: would catch a block, a ring or a way back that needs more
 * frames than there are. */
TEST(short_streams_are_the_sum_of_their_steps)
{
    models[0] = &rich.model;
    for (unsigned stride = 1; stride <= LABIAL_SEARCH_STRIDE_MAX; stride++) {
        rich.model.search_stride = (uint8_t)stride;
        for (size_t count = 0; count <= 40; count++) {
            fixture_stream(input, count, FIXTURE_ONE_FRAME, stride + (unsigned)count);
            compare(1, count, stride);
        }
    }
    rich.model.search_stride = FIXTURE_STRIDE;
}

/* Would catch tables whose rows are read with the width of others, a turn that no channel has, corners of another frame, a
 * side that follows another channel than its own, lips that part in another channel. */
TEST(channels_follow_those_of_the_same_frame)
{
    static const fixture_kind_t kinds[] = { FIXTURE_ONE_FRAME, FIXTURE_CONTACTS, FIXTURE_RANDOM };
    fixture_model_t *const followed[] = { &computed, &computed_slow, &mirrored, &crossed };
    for (unsigned i = 0; i < 2 * LABIAL_SEARCH_STRIDE_MAX; i++) {
        const unsigned stride = 1 + i / 2;
        fixture_model_t *const f = followed[stride % 2 + i % 2 * 2];
        const uint8_t own = f->model.search_stride;
        f->model.search_stride = (uint8_t)stride;
        models[0] = &f->model;
        for (unsigned k = 0; k < COUNT_OF(kinds); k++) {
            fixture_stream(input, COUNT, kinds[k], stride);
            compare(1, COUNT, stride);
        }
        f->model.search_stride = own;
    }
}

/* Runs of two models in turn, from single frames to seconds; of twelve, eight or thirteen channels the first, of thirteen or
 * eight the other, so that channels of both kinds begin and rest in the midst of the stream. */
TEST(two_models_are_the_sum_of_their_steps)
{
    static const fixture_kind_t kinds[] = { FIXTURE_ONE_FRAME, FIXTURE_RANDOM, FIXTURE_VOWELS };
    fixture_random_t random = { 41 };
#if LABIAL_MODELS > 1
    fixture_model_t *const firsts[] = { &computed, &mirrored, &rich, &slow };
    fixture_laughter(&narrow);
    fixture_narrow(&narrow, fixture_crossed);
    for (unsigned seed = 0; seed < FIXTURE_ROUNDS(60); seed++) {
        fixture_model_t *const f = firsts[seed % 4], *const other = seed % 8 < 6 ? &laugh : &narrow;
        models[1] = &other->model;
        uint8_t model = 0;
        const uint8_t own = f->model.search_stride;
        f->model.search_stride = other->model.search_stride = (uint8_t)(1 + seed / 3 % LABIAL_SEARCH_STRIDE_MAX);
        models[0] = &f->model;
        fixture_stream(input, COUNT, kinds[seed % 3], seed);
        for (unsigned i = 0; i < COUNT; i++) {
            if (fixture_below(&random, 1 + seed / 6) == 0)
                model = !model;
            input[i].model = i == 0 ? 0 : model;
            input[i].phoneme = (uint8_t)(input[i].phoneme % (model ? FIXTURE_LAUGH_COUNT : FIXTURE_SPEECH_COUNT));
        }
        compare(2, COUNT, seed);
        f->model.search_stride = own;
        other->model.search_stride = FIXTURE_STRIDE;
    }
#else
    (void)random;
    (void)kinds;
#endif
}

/* Round after round in one stream, each fading in from the pose that the one before left. */
TEST(rounds_are_the_sum_of_their_steps)
{
    fixture_host_t host;
    double held[LABIAL_CHANNELS];
    models[0] = &rich.model;
    assert_ok(fixture_open(&host, models, 1));
    for (unsigned round = 0; round < FIXTURE_ROUNDS(40); round++) {
        const size_t first = host.recorder.count, count = round % 7 * 4 + 1;
        fixture_stream(input, count, round % 2 ? FIXTURE_RANDOM : FIXTURE_ONE_FRAME, round);
        if (round > 0)
            fixture_restart(&host);
        assert_played(&host, fixture_play(&host, input, count, FIXTURE_FILL));
        judge(&host.recorder, first,
              oracle_stream(models, input, count, first > 0 ? held : NULL, NULL, wanted, MAX_FRAMES), FADED_TOLERANCE);
        for (unsigned c = 0; c < LABIAL_CHANNELS; c++) /* unrounded, for it tells what is near rest */
            held[c] = host.stream->fade.pose[c];
    }
    fixture_close(&host);
}

#define MAX_TOLD 1400

static uint8_t told[MAX_TOLD]; /* percent, when each frame is taken in */

/* Percents that stay, jump from end to end, or go on a little. */
static void tell_by_chance(uint32_t seed)
{
    fixture_random_t random = { seed };
    const uint32_t often = 1 + fixture_below(&random, 60);
    for (size_t t = 0; t < MAX_TOLD; t++) {
        const unsigned kind = fixture_below(&random, 3);
        if (t > 0 && fixture_below(&random, often) > 0)
            told[t] = told[t - 1];
        else if (kind == 0 || t == 0)
            told[t] = (uint8_t)fixture_below(&random, LABIAL_ARTICULATION_MAX + 1);
        else
            told[t] = kind == 1 ? told[t - 1] > 100 ? 0 : LABIAL_ARTICULATION_MAX : told[t - 1] / 2u + 51u;
    }
}

/* With twice the error of equation 3, as at the largest articulation. */
static void compare_told(unsigned model_count, double tolerance, unsigned seed)
{
    fixture_host_t host;
    assert_ok(fixture_open(&host, models, model_count));
    tell_by_chance(seed + 1);
    assert_played(&host, fixture_play_told(&host, input, ARTICULATED, told, MAX_TOLD));
    judge(&host.recorder, 0, oracle_stream(models, input, ARTICULATED, NULL, told, wanted, MAX_FRAMES),
          tolerance + 1.6);
    fixture_close(&host);
}

/* Would catch an articulation that comes a frame too early or too late, or by another step; a part of what holds or moves
 * a channel that is not articulated; contact that is. */
TEST(articulated_streams_are_the_sum_of_their_steps)
{
    static const fixture_kind_t kinds[] = { FIXTURE_ONE_FRAME, FIXTURE_VOWELS, FIXTURE_CONTACTS };
    for (unsigned seed = 0; seed < FIXTURE_ROUNDS(60); seed++) {
        fixture_model_t *const f = seed % 5 == 0 ? &plain : seed % 2 ? &rich : &slow;
        const uint8_t own = f->model.search_stride;
        models[0] = &f->model;
        f->model.search_stride = (uint8_t)(1 + seed % LABIAL_SEARCH_STRIDE_MAX);
        fixture_stream(input, ARTICULATED, kinds[seed % 3], seed);
        for (unsigned i = 0; i < ARTICULATED; i++)
            input[i].ms %= 400;
        compare_told(1, TOLERANCE, seed);
        f->model.search_stride = own;
    }
}

TEST(two_articulated_models_are_the_sum_of_their_steps)
{
    fixture_random_t random = { 43 };
#if LABIAL_MODELS > 1
    models[0] = &rich.model;
    models[1] = &laugh.model;
    for (unsigned seed = 0; seed < FIXTURE_ROUNDS(20); seed++) {
        uint8_t model = 0;
        fixture_stream(input, ARTICULATED, FIXTURE_VOWELS, seed);
        for (unsigned i = 0; i < ARTICULATED; i++) {
            if (fixture_below(&random, 4 + seed) == 0)
                model = !model;
            input[i].model = i == 0 ? 0 : model;
            input[i].ms = 20 + input[i].ms % 300; /* a frame each, so that the queue is never starved */
            input[i].phoneme = (uint8_t)(input[i].phoneme % (model ? FIXTURE_LAUGH_COUNT : FIXTURE_SPEECH_COUNT));
        }
        compare_told(2, FADED_TOLERANCE, seed);
    }
#else
    (void)random;
#endif
}

SUITE(setup, NULL)
