/*
 * test_stream_rest.c - a stream begins and ends at rest: what labial.h says of its first frames, of its end, of phonemes
 * that are late, of cancels and restarts on the way, and of labial_exact().
 *
 * A twin that is asked for exact frames plays the same phonemes. What comes beside them, and how they fade in, is
 * foretold in doubles from the twin's frames.
 */
#include "suite.h"
#include "fade.h"

#define COUNT 60
#define MOST 6000
#define FADE 8
#define FRAMES LABIAL_EASE_FRAMES

typedef struct {
    labial_t stream;
    uint32_t workspace[LABIAL_WORKSPACE_SIZE(LABIAL_SEARCH_STRIDE_MAX, LABIAL_CHANNELS) / 4u];
    int16_t faps[MOST][LABIAL_CHANNELS];
    uint32_t numbers[MOST];
    unsigned count;
    unsigned ticks, late; /* and those that brought no frame */
} face_t;

static fixture_model_t rich, laugh;
static fixture_phoneme_t input[COUNT];
static face_t face, twin;

SETUP(setup)
{
    fixture_rich(&rich);
    fixture_laughter(&laugh);
    return 0;
}

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    face_t *to = (face_t *)user;
    assert_true(to->count < MOST);
    memcpy(to->faps[to->count], faps, sizeof to->faps[0]);
    to->numbers[to->count++] = frame;
}

static void open(face_t *to, int exact)
{
    memset(to, 0, sizeof *to);
    assert_ok(labial_init(&to->stream, &rich.model, to->workspace, sizeof to->workspace, on_frame, to));
    if (exact)
        assert_ok(labial_exact(&to->stream, exact));
}

/* A tick; every result but LABIAL_OK leaves the number of the next frame as it was. */
static int tick(face_t *to)
{
    const unsigned before = to->count;
    const int result = labial_tick(&to->stream);
    assert_in_range(result, LABIAL_OK, LABIAL_DONE);
    assert_true(to->count - before <= 1);
    if (result == LABIAL_OK)
        assert_int_equal(to->count, before + 1);
    if (result == LABIAL_DONE)
        assert_int_equal(to->count, before);
    to->ticks++;
    to->late += result == LABIAL_STARVED;
    return result;
}

static void push(face_t *to, const fixture_phoneme_t *phonemes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        while (labial_room(&to->stream) == 0)
            (void)tick(to);
        assert_ok(labial_push(&to->stream, phonemes[i].phoneme, phonemes[i].ms));
    }
}

static void drain(face_t *to)
{
    for (unsigned guard = 0; tick(to) != LABIAL_DONE; guard++)
        assert_true(guard < MOST);
}

static void play(face_t *to, const fixture_phoneme_t *phonemes, size_t count)
{
    push(to, phonemes, count);
    assert_ok(labial_end(&to->stream));
    drain(to);
}

static int farthest(const int16_t *faps)
{
    int most = 0;
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++)
        most = abs(faps[c]) > most ? abs(faps[c]) : most;
    return most;
}

static double smooth(double way)
{
    return way * way * (3 - 2 * way);
}

/* The frames from `first` on lead from `from` to rest in `length` frames, as many of them as there are. */
static void judge_way_to_rest(const face_t *of, unsigned first, unsigned count, const int16_t *from, unsigned length)
{
    for (unsigned j = 1; j <= count; j++)
        for (unsigned c = 0; c < LABIAL_CHANNELS; c++)
            assert_near(of->faps[first + j - 1][c], from[c] * (1 - smooth(j / (double)length)), 1.1);
}

/* The frames from `first` on lead from `from`, which stands still, to the twin's from `twins` on. */
static void judge_fade_in(unsigned first, unsigned twins, const int16_t *from)
{
    for (unsigned j = 1; j <= FADE + 2 && first + j <= face.count; j++)
        for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
            const double share = smooth(j > FADE ? 1.0 : j / (FADE + 1.0));
            const double wanted = from[c] + (twin.faps[twins + j - 1][c] - from[c]) * share;
            assert_near(face.faps[first + j - 1][c], wanted, 1.6);
        }
}

/* ---- The beginning and the end ------------------------------------------------------------------------------------- */

/* Would catch a snap at the beginning, an end that stays open or comes in another time, and frames of the phonemes that
 * an exact stream has and this one has not. */
TEST(a_stream_begins_and_ends_at_rest)
{
    unsigned opened = 0;
    for (unsigned seed = 0; seed < FIXTURE_ROUNDS(20); seed++) {
        const size_t count = 1 + seed % 7 * 5;
        fixture_stream(input, count, FIXTURE_VOWELS, seed);
        open(&face, 0);
        play(&face, input, count);
        open(&twin, 1);
        play(&twin, input, count);
        assert_true(fixture_is_exact(twin.count, fixture_duration(input, count), FIXTURE_RATE));
        assert_memory_equal(face.faps, twin.faps, twin.count * sizeof face.faps[0]);
        assert_true(twin.count > 0 && farthest(face.faps[0]) <= 40 + farthest(face.faps[1]) / 2);
        if (farthest(twin.faps[twin.count - 1]) == 0) {
            assert_int_equal(face.count, twin.count);
            continue;
        }
        opened++;
        assert_int_equal(face.count, twin.count + FRAMES);
        judge_way_to_rest(&face, twin.count, FRAMES, twin.faps[twin.count - 1], FRAMES);
        assert_int_equal(farthest(face.faps[face.count - 1]), 0);
        for (unsigned t = 0; t < face.count; t++)
            assert_int_equal(face.numbers[t], t);
        assert_int_equal(labial_tick(&face.stream), LABIAL_DONE);
    }
    assert_true(opened >= FIXTURE_ROUNDS(10));
}

TEST(a_face_that_stays_at_rest_is_done)
{
    fixture_stream(input, 9, FIXTURE_VOWELS, 4);
    open(&face, 0);
    assert_ok(labial_articulation(&face.stream, 0));
    play(&face, input, 9);
    assert_true(fixture_is_exact(face.count, fixture_duration(input, 9), FIXTURE_RATE));
    open(&face, 0);
    assert_ok(labial_end(&face.stream));
    assert_int_equal(tick(&face), LABIAL_DONE);
}

/* ---- Phonemes that are late ---------------------------------------------------------------------------------------- */

/* Pushes the first phonemes, ticks until none of their frames comes, then `starved` times more; then the rest. */
static void pause_after(face_t *to, size_t first, unsigned starved)
{
    int result;
    push(to, input, first);
    do
        result = tick(to);
    while (result == LABIAL_OK || result == LABIAL_WAITING);
    assert_int_equal(result, LABIAL_STARVED);
    for (unsigned i = 1; i < starved; i++)
        assert_int_equal(tick(to), LABIAL_STARVED);
    push(to, input + first, COUNT - first);
    (void)labial_end(&to->stream);
    drain(to);
}

/* Would catch a face that is held for longer or not at all, an ease of another length, callbacks at rest, numbers that go
 * on while a frame is missing, a motion that jumps when it goes on, a frame that is lost or comes twice. */
TEST(a_late_phoneme_finds_the_face_on_its_way_to_rest)
{
    for (unsigned starved = 1; starved <= LABIAL_HOLD_TICKS + FRAMES + 5; starved++) {
        const unsigned eased = starved <= LABIAL_HOLD_TICKS           ? 0
                               : starved < LABIAL_HOLD_TICKS + FRAMES ? starved - LABIAL_HOLD_TICKS
                                                                      : FRAMES;
        unsigned at;
        fixture_stream(input, COUNT, FIXTURE_VOWELS, starved);
        open(&twin, 1);
        pause_after(&twin, 20, starved);
        open(&face, 0);
        pause_after(&face, 20, starved);
        assert_int_equal(face.late, starved);
        if (eased == 0) {
            assert_memory_equal(face.faps, twin.faps, twin.count * sizeof face.faps[0]);
            continue;
        }
        for (at = 0; face.numbers[at] != face.numbers[at + 1]; at++) /* the first that stands in the place of a frame */
            assert_true(at + 2 < face.count);
        assert_true(at > FADE && farthest(twin.faps[at - 1]) > 0);
        assert_memory_equal(face.faps, twin.faps, at * sizeof face.faps[0]);
        judge_way_to_rest(&face, at, eased, twin.faps[at - 1], FRAMES);
        for (unsigned i = 0; i <= eased; i++)
            assert_int_equal(face.numbers[at + i], at);
        judge_fade_in(at + eased, at, face.faps[at + eased - 1]);
        assert_memory_equal(face.faps[at + eased + FADE], twin.faps[at + FADE],
                            (twin.count - at - FADE) * sizeof face.faps[0]);
        assert_int_equal(face.count, twin.count + eased + (farthest(twin.faps[twin.count - 1]) > 0 ? FRAMES : 0));
    }
}

/* "counted from the last frame or push": a program that ticks until nothing comes after each push, however short, never
 * sees the face move by itself. */
TEST(a_push_holds_the_face)
{
    fixture_stream(input, COUNT, FIXTURE_VOWELS, 3);
    for (unsigned i = 0; i < COUNT; i++)
        input[i].ms %= 10;
    open(&face, 0);
    open(&twin, 1);
    for (unsigned i = 0; i < COUNT; i++) {
        int result = 0;
        push(&face, &input[i], 1);
        for (unsigned held = 0; held < LABIAL_HOLD_TICKS && result != LABIAL_WAITING;)
            held += (result = tick(&face)) != LABIAL_OK;
    }
    (void)labial_end(&face.stream);
    while (labial_latency(&face.stream).frames > 0)
        (void)tick(&face);
    play(&twin, input, COUNT);
    assert_int_equal(face.count, twin.count);
    assert_memory_equal(face.faps, twin.faps, twin.count * sizeof face.faps[0]);
}

/* Of phonemes and the frames that they lack, a stream that ends has the frames first, and then goes to rest from the last
 * of them; if it lacks none, it goes on where it is. Either way all of them count. */
TEST(an_end_while_the_face_rests)
{
    for (unsigned starved = 0; starved <= LABIAL_HOLD_TICKS + FRAMES + 1; starved++) {
        const fixture_phoneme_t vowel = { 300, FIXTURE_A, 0 };
        unsigned first;
        int result;
        open(&face, 0);
        push(&face, &vowel, 1);
        do
            result = tick(&face);
        while (result != LABIAL_STARVED && face.ticks < 100);
        for (unsigned i = 0; i < starved; i++)
            assert_true(tick(&face) > LABIAL_OK);
        first = face.count;
        (void)labial_end(&face.stream);
        for (unsigned i = 0; i < 100; i++)
            (void)tick(&face);
        assert_int_equal(tick(&face), LABIAL_DONE);
        assert_int_equal(face.numbers[face.count - 1], 15 + FRAMES - 1);
        assert_int_equal(face.numbers[first], first > 0 ? face.numbers[first - 1] + 1 : 0);
        assert_int_equal(farthest(face.faps[face.count - 1]), 0);
    }
}

/* ---- Cancels and restarts on the way --------------------------------------------------------------------------------- */

/* A stream of nine vowels that ended: their last frame was shown, and what leads to rest follows. */
static void show_vowels(uint32_t seed)
{
    fixture_stream(input, 9, FIXTURE_VOWELS, seed);
    open(&face, 0);
    push(&face, input, 9);
    (void)labial_end(&face.stream);
    while (labial_latency(&face.stream).frames > 0)
        (void)tick(&face);
}

/* Would catch a cancel that begins at another pose than the one that is shown, and one that takes another time. */
TEST(a_cancel_begins_at_the_pose_on_the_way)
{
    for (unsigned after = 0; after <= FRAMES; after++) {
        int16_t shown[LABIAL_CHANNELS];
        show_vowels(after);
        for (unsigned i = 0; i < after; i++)
            (void)tick(&face);
        memcpy(shown, face.faps[face.count - 1], sizeof shown);
        assert_ok(labial_cancel(&face.stream, 100));
        const unsigned first = face.count;
        drain(&face);
        assert_int_equal(face.count, first + 5);
        judge_way_to_rest(&face, first, 5, shown, 5);
    }
}

/* "A face that is still on its way to rest goes on while the first frame is missing": also under the number of that
 * frame, and the motion fades in from where it is then. */
TEST(a_restart_on_the_way_goes_on)
{
    const unsigned delay = LABIAL_DELAY(FIXTURE_STRIDE);
    for (unsigned cancelled = 0; cancelled < 2; cancelled++)
        for (unsigned after = 0; after <= FRAMES; after++) {
            unsigned first, waited, length = cancelled ? 40u : FRAMES;
            int16_t from[LABIAL_CHANNELS];
            show_vowels(7);
            memcpy(from, face.faps[face.count - 1], sizeof from);
            assert_true(farthest(from) > 0);
            if (cancelled)
                assert_ok(labial_cancel(&face.stream, 800));
            const unsigned way = face.count;
            for (unsigned i = 0; i < after; i++)
                assert_ok(tick(&face));
            first = face.count;
            assert_ok(labial_restart(&face.stream));
            push(&face, input, 9);
            (void)labial_end(&face.stream);
            for (waited = 0; tick(&face) == LABIAL_WAITING; waited++)
                ;
            assert_int_equal(waited, delay);
            if (after > 0 || cancelled) { /* else it is held first */
                const unsigned moved = after + waited < length ? waited : length - after;
                assert_int_equal(face.count - 1, first + moved);
                judge_way_to_rest(&face, way, after + moved, from, length);
                for (unsigned i = 0; i <= moved; i++)
                    assert_int_equal(face.numbers[first + i], first);
            }
            drain(&face);
            open(&twin, 1);
            play(&twin, input, 9);
            first = face.count - FRAMES - twin.count;
            assert_memory_equal(face.faps[first + FADE], twin.faps[FADE], (twin.count - FADE) * sizeof twin.faps[0]);
        }
}

/* ---- Exact streams --------------------------------------------------------------------------------------------------- */

/* "exactly the frames of its phonemes": done after the last of them, and nothing while they are late. */
TEST(an_exact_stream_has_the_frames_of_its_phonemes)
{
    fixture_stream(input, COUNT, FIXTURE_VOWELS, 11);
    open(&face, 7);
    pause_after(&face, 30, 100);
    assert_true(fixture_is_exact(face.count, fixture_duration(input, COUNT), FIXTURE_RATE));
    for (unsigned t = 0; t < face.count; t++)
        assert_int_equal(face.numbers[t], t);
    assert_true(farthest(face.faps[face.count - 1]) > 0);

    assert_ok(labial_restart(&face.stream)); /* which keeps it, and moves nothing */
    const unsigned before = face.count;
    for (unsigned i = 0; i < 50; i++)
        assert_int_equal(tick(&face), LABIAL_WAITING);
    assert_int_equal(face.count, before);
    assert_ok(labial_exact(&face.stream, 0)); /* from the next tick on */
    for (unsigned i = 0; i < LABIAL_HOLD_TICKS; i++)
        assert_int_equal(tick(&face), LABIAL_WAITING);
    assert_int_equal(face.count, before);
    for (unsigned i = 0; i < FRAMES; i++)
        assert_int_equal(tick(&face), LABIAL_WAITING);
    assert_int_equal(face.count, before + FRAMES);
    assert_int_equal(farthest(face.faps[face.count - 1]), 0);
    assert_int_equal(tick(&face), LABIAL_WAITING);
    assert_int_equal(face.count, before + FRAMES);
}

/* A cancel eases in an exact stream, too. A restart then holds the face where it was on the way. */
TEST(an_exact_stream_can_be_cancelled)
{
    fixture_stream(input, 9, FIXTURE_VOWELS, 12);
    open(&face, 1);
    push(&face, input, 9);
    while (face.count < 12)
        (void)tick(&face);
    assert_ok(labial_cancel(&face.stream, 200));
    for (unsigned i = 0; i < 4; i++)
        assert_ok(tick(&face));
    assert_ok(labial_restart(&face.stream));
    for (unsigned i = 0; i < 30; i++)
        assert_int_equal(tick(&face), LABIAL_WAITING);
    assert_int_equal(face.count, 16);
    play(&face, input, 9);
    open(&twin, 1);
    play(&twin, input, 9);
    assert_int_equal(face.count, 16 + twin.count);
    assert_memory_equal(face.faps[16 + FADE], twin.faps[FADE], (twin.count - FADE) * sizeof twin.faps[0]);
    assert_int_equal(labial_exact(NULL, 1), LABIAL_ERROR_NULL);
    face.stream.magic = 0;
    assert_int_equal(labial_exact(&face.stream, 1), LABIAL_ERROR_STATE);
}

/* ---- Anything, at random --------------------------------------------------------------------------------------------- */

/* Any order of calls. Would catch a frame that is lost or comes twice, a number that skips, a face that is not at rest in
 * the stated time once nothing more comes, and a step between frames that no speech has: they are at most as large as
 * those of the twin, which has no way to rest, and of a way from the farthest pose. */
TEST(random_calls_end_at_rest_and_lose_no_frame)
{
    fixture_random_t random = { 99 };
    for (unsigned round = 0; round < FIXTURE_ROUNDS(400); round++) {
        uint64_t ms = 0, counted = 0; /* since the stream began or was taken up again */
        uint32_t next = 0;
        int ended = 0, cut = 0, exact = 0, begun = 0, was_cut = 0;
        unsigned model = 0, pushed = 0;
        open(&face, 0);
        for (unsigned call = 0; call < 120; call++) {
            const uint32_t what = fixture_below(&random, 24);
            if (what < 6 && !ended && labial_room(&face.stream) > 0) {
                const uint32_t length = fixture_below(&random, 300);
                assert_ok(labial_push(&face.stream, fixture_below(&random, FIXTURE_LAUGH_COUNT), length));
                ms += length;
                pushed++;
            } else if (what == 6 && LABIAL_MODELS > 1 && !ended) {
                if (labial_use(&face.stream, model ? &rich.model : &laugh.model) == LABIAL_OK)
                    model = !model;
            } else if (what == 7 && fixture_below(&random, 3) == 0) {
                assert_ok(labial_end(&face.stream));
                ended = 1;
            } else if (what == 8 && fixture_below(&random, 3) == 0) {
                assert_ok(labial_cancel(&face.stream, fixture_below(&random, 3) ? fixture_below(&random, 600)
                                                                                : fixture_random(&random)));
                ended = cut = was_cut = 1;
            } else if (what == 9) {
                const unsigned left = labial_latency(&face.stream).frames;
                assert_int_equal(labial_restart(&face.stream), ended && left == 0 ? LABIAL_OK : LABIAL_ERROR_STATE);
                if (ended && left == 0) {
                    if (!cut)
                        assert_true(fixture_is_exact(counted, ms, FIXTURE_RATE));
                    ms = counted = 0;
                    ended = cut = begun = 0;
                }
            } else if (what == 10) {
                exact = (int)fixture_below(&random, 2);
                assert_ok(labial_exact(&face.stream, exact));
            } else if (what == 11) {
                assert_ok(labial_articulation(&face.stream, fixture_below(&random, 201)));
            } else {
                for (uint32_t left = fixture_below(&random, 24); left > 0; left--) {
                    const unsigned before = face.count, due = labial_latency(&face.stream).frames;
                    const int result = tick(&face), is_new = face.count > before;
                    const unsigned owed = labial_latency(&face.stream).frames;
                    assert_true(owed == due || (owed + 1 == due && result == LABIAL_OK));
                    counted += owed < due;
                    begun |= owed < due;
                    if (is_new)
                        assert_int_equal(face.numbers[before], next);
                    next += result == LABIAL_OK;
                    if (result == LABIAL_STARVED || result == LABIAL_WAITING)
                        assert_int_equal(result, begun ? LABIAL_STARVED : LABIAL_WAITING);
                    if (result == LABIAL_DONE)
                        assert_true(ended && due == 0);
                }
            }
        }
        assert_true(exact >= 0 && pushed <= 120);
        /* Nothing more comes: after the frames that are known, 1,000 at most for a cancel of any length. */
        assert_ok(labial_exact(&face.stream, 0));
        for (unsigned i = labial_latency(&face.stream).frames + 2u * LABIAL_DELAY(FIXTURE_STRIDE); i > 0; i--)
            (void)tick(&face);
        for (unsigned i = was_cut ? 1000 : LABIAL_HOLD_TICKS + FRAMES; i > 0; i--)
            (void)tick(&face);
        assert_int_equal(face.count > 0 ? farthest(face.faps[face.count - 1]) : 0, 0);
        const unsigned before = face.count;
        for (unsigned i = 0; i < 20; i++)
            assert_true(tick(&face) != LABIAL_OK);
        assert_int_equal(face.count, before);
    }
}

/* A pose that rounds to the neutral face is at rest, to either side, on every channel. */
TEST(rest_is_what_rounds_to_it)
{
    labial_fade_t fade;
    memset(&fade, 0, sizeof fade);
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++) {
        static const int16_t poses[] = { 7, 8, -8, -9, 0 };
        for (unsigned i = 0; i < COUNT_OF(poses); i++) {
            fade.pose[c] = poses[i];
            assert_int_equal(labial_fade_rests(&fade), i % 2 == 0);
        }
    }
}

SUITE(setup, NULL)
