/*
 * test_visemes.c - what labial/visemes.h says of shares: against a computation in double over the whole utterance, at
 * the ends of streams, and for bad input.
 */
#include "suite.h"
#include "labial/visemes.h"

#define FRAMES 4000

/* Visemes of the rich fixture's phonemes; one that is none, and one that neighbours decide. */
static const uint8_t visemes[FIXTURE_PHONEMES] = {
    0, LABIAL_VISEME_AA, LABIAL_VISEME_OH, LABIAL_VISEME_PP, LABIAL_VISEME_SS, LABIAL_VISEME_NONE, 77, LABIAL_VISEME_CH
};
/* Strength, onset and release per millisecond, of those that are in use. */
static const double dominances[LABIAL_VISEMES][3] = {
    [LABIAL_VISEME_SIL] = { 384, 6, 6 },   [LABIAL_VISEME_AA] = { 640, 10, 10 },  [LABIAL_VISEME_OH] = { 896, 9, 11 },
    [LABIAL_VISEME_PP] = { 2048, 51, 51 }, [LABIAL_VISEME_SS] = { 1024, 20, 25 },
};

static fixture_model_t rich, laughter;
static labial_t stream;
static uint32_t workspace[1024];
static uint8_t found[FRAMES][LABIAL_VISEMES];
static uint8_t spoken[FRAMES]; /* phoneme of each frame */
static unsigned frames, known;

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)user;
    (void)faps;
    assert_true(frame < FRAMES);
    memset(found[frame], 99, sizeof found[frame]);
    assert_ok(labial_visemes(&stream, &rich.model, visemes, found[frame]));
    frames = frame + 1u;
}

SETUP(begin)
{
    fixture_rich(&rich);
    fixture_laughter(&laughter);
    assert_ok(labial_init(&stream, &rich.model, workspace, sizeof workspace, on_frame, NULL));
    frames = known = 0;
    return 0;
}

static void run(void)
{
    int result, patience = 12;
    do {
        result = labial_tick(&stream);
    } while (result == LABIAL_OK || (result == LABIAL_WAITING && patience-- > 0));
    assert_true(result >= 0);
}

/* Pushes a phoneme of so many frames; `eager` plays all that it makes known. */
static void say(unsigned phoneme, unsigned count, int eager)
{
    while (labial_room(&stream) == 0)
        run();
    assert_ok(labial_push(&stream, phoneme, count * (1000u / FIXTURE_RATE)));
    for (; count > 0; count--)
        spoken[known++] = (uint8_t)phoneme;
    if (eager)
        run();
}

/* The share of a viseme in a frame, by the formula of the header, with silence around the utterance. */
static double expected(int frame, unsigned viseme)
{
    double own = 0, sum = 0;
    for (unsigned v = 0; v < LABIAL_VISEMES; v++) {
        double most = 0;
        for (int k = -20; k <= 20; k++) {
            const int at = frame + k;
            unsigned seen = at >= 0 && at < (int)known ? visemes[spoken[at]] : LABIAL_VISEME_SIL;
            if (seen != LABIAL_VISEME_NONE && seen >= LABIAL_VISEMES)
                seen = LABIAL_VISEME_SIL;
            const double ms = 20.0 * abs(k);
            if (seen == v && ms < 120)
                most = fmax(most, dominances[v][0] - ms * dominances[v][k > 0 ? 1 : 2]);
        }
        sum += most;
        own = v == viseme ? most : own;
    }
    return sum > 0 ? own / sum : viseme == LABIAL_VISEME_SIL;
}

static void compare(unsigned from, unsigned to)
{
    for (unsigned t = from; t < to; t++)
        for (unsigned v = 0; v < LABIAL_VISEMES; v++)
            assert_near(found[t][v] / (double)LABIAL_VISEME_ONE, expected((int)t, v), 0.51 / LABIAL_VISEME_ONE + 1e-4);
}

/* Would catch shares of another frame than the delivered one, a slope on the wrong side, sounds that are not yet known, and
 * shares that depend on when phonemes come. */
TEST_AFTER(begin, shares_follow_the_formula_however_phonemes_come)
{
    for (uint32_t seed = 1; seed <= (uint32_t)FIXTURE_ROUNDS(40); seed++) {
        begin(state);
        draw_from(seed);
        labial_exact(&stream, 1);
        for (unsigned i = 0; i < 60; i++) {
            const unsigned phoneme = below(FIXTURE_SPEECH_COUNT);
            const unsigned length = below(5) == 0 ? 1u + below(40) : 1u + below(6);
            say(phoneme, length, seed % 3u == 0 || (seed % 3u == 1u && below(4) == 0));
        }
        labial_end(&stream);
        run();
        assert_int_equal(frames, known);
        compare(0, known);
    }
}

/* After the last phoneme, and after a cancel, shares pass to silence in step with the face, and stay there. */
TEST_AFTER(begin, a_face_at_rest_shows_silence)
{
    unsigned last;
    say(FIXTURE_A, 30, 1);
    labial_end(&stream);
    run();
    assert_true(frames == known + LABIAL_EASE_FRAMES);
    last = found[known - 1u][LABIAL_VISEME_AA];
    assert_true(last > 80);
    for (unsigned t = known; t < frames; t++) {
        assert_true(found[t][LABIAL_VISEME_AA] <= last);
        assert_int_equal(found[t][LABIAL_VISEME_AA] + found[t][LABIAL_VISEME_SIL], LABIAL_VISEME_ONE);
        last = found[t][LABIAL_VISEME_AA];
    }
    assert_int_equal(last, 0);
    assert_ok(labial_restart(&stream));
    for (unsigned i = 0; i < 20; i++)
        say(FIXTURE_A, 3, 1);
    assert_true(found[frames - 1u][LABIAL_VISEME_AA] == LABIAL_VISEME_ONE);
    assert_ok(labial_cancel(&stream, 100));
    run();
    assert_int_equal(found[frames - 1u][LABIAL_VISEME_SIL], LABIAL_VISEME_ONE);
    assert_true(found[frames - 4u][LABIAL_VISEME_AA] > 30);
}

/* A cancel shows nothing of the sounds that were about to come: its fade begins where the face is. */
TEST_AFTER(begin, a_cancel_goes_on_from_what_was_shown)
{
    uint8_t shares[LABIAL_VISEMES];
    for (unsigned silent = 0; silent < 12; silent++) {
        for (unsigned i = 0; i < 10; i++)
            say(i % 2u ? FIXTURE_P : FIXTURE_A, 5, 1);
        say(FIXTURE_SIL, 1u + silent, 1);
        say(FIXTURE_O, 20, 1);
        memcpy(shares, found[frames - 1u], sizeof shares);
        assert_ok(labial_cancel(&stream, 200));
        on_frame(NULL, frames, NULL);
        for (unsigned i = LABIAL_VISEME_SIL + 1u; i < LABIAL_VISEMES; i++)
            assert_in_range(found[frames - 1u][i], shares[i] * 3u / 4u, shares[i]);
        run();
        assert_int_equal(found[frames - 1u][LABIAL_VISEME_SIL], LABIAL_VISEME_ONE);
        assert_ok(labial_restart(&stream));
    }
}

/* Before the first frame, and in the frames of another model, all is silence, but at most what follows. */
TEST_AFTER(begin, another_model_is_silence)
{
    uint8_t shares[LABIAL_VISEMES + 1];
    memset(shares, 7, sizeof shares);
    for (int exact = 0; exact < 2; exact++) {
        labial_exact(&stream, exact);
        assert_ok(labial_visemes(&stream, &rich.model, visemes, shares));
        assert_int_equal(shares[LABIAL_VISEME_SIL], LABIAL_VISEME_ONE);
        assert_int_equal(shares[LABIAL_VISEMES], 7);
    }
    for (unsigned turn = 0; turn < 3; turn++) {
        assert_ok(labial_use(&stream, turn % 2u ? &laughter.model : &rich.model));
        say(FIXTURE_A, 40, 0);
    }
    labial_end(&stream);
    run();
    assert_int_equal(frames, known);
    assert_int_equal(found[20][LABIAL_VISEME_AA], LABIAL_VISEME_ONE);
    for (unsigned t = 50; t < 70; t++)
        assert_int_equal(found[t][LABIAL_VISEME_SIL], LABIAL_VISEME_ONE);
    assert_int_equal(found[100][LABIAL_VISEME_AA], LABIAL_VISEME_ONE);
    assert_ok(labial_restart(&stream));
    assert_ok(labial_visemes(&stream, &laughter.model, visemes, shares));
    assert_int_equal(shares[LABIAL_VISEME_SIL], LABIAL_VISEME_ONE);
}

TEST_AFTER(begin, phonemes_beyond_the_model_say_nothing)
{
    labial_exact(&stream, 1);
    say(FIXTURE_A, 20, 0);
    labial_end(&stream);
    run();
    on_frame(NULL, 1, NULL);
    assert_true(found[1][LABIAL_VISEME_AA] > 0);
    rich.model.phoneme_count = 1;
    on_frame(NULL, 1, NULL);
    assert_int_equal(found[1][LABIAL_VISEME_SIL], LABIAL_VISEME_ONE);
}

/* At 250 frames per second sounds last for more frames than a stream keeps. */
TEST_AFTER(begin, shares_at_the_highest_rate)
{
    rich.model.frames_per_second = 250;
    assert_ok(labial_init(&stream, &rich.model, workspace, sizeof workspace, on_frame, NULL));
    labial_exact(&stream, 1);
    assert_ok(labial_push(&stream, FIXTURE_A, 400));
    labial_end(&stream);
    run();
    assert_int_equal(frames, 100);
    for (unsigned t = 0; t < frames; t++)
        assert_int_equal(found[t][LABIAL_VISEME_AA] + found[t][LABIAL_VISEME_SIL], LABIAL_VISEME_ONE);
    assert_true(found[50][LABIAL_VISEME_AA] > 100); /* what follows further on is not yet known */
}

TEST_AFTER(begin, bad_arguments_are_errors)
{
    static labial_t other;
    uint8_t shares[LABIAL_VISEMES];
    assert_int_equal(labial_visemes(NULL, &rich.model, visemes, shares), LABIAL_ERROR_NULL);
    assert_int_equal(labial_visemes(&stream, NULL, visemes, shares), LABIAL_ERROR_NULL);
    assert_int_equal(labial_visemes(&stream, &rich.model, NULL, shares), LABIAL_ERROR_NULL);
    assert_int_equal(labial_visemes(&stream, &rich.model, visemes, NULL), LABIAL_ERROR_NULL);
    assert_int_equal(labial_visemes(&other, &rich.model, visemes, shares), LABIAL_ERROR_STATE);
}

/* FAPs 43 and 47 stay 0; thin thrusts the tongue, all others less; half a share is half as far. */
TEST_AFTER(begin, the_tongue_follows_the_shares)
{
    uint8_t shares[LABIAL_VISEMES] = { 0 };
    int16_t thin[LABIAL_TONGUE_FAPS], tongue[LABIAL_TONGUE_FAPS] = { 1, 2, 3, 4, 5 };
    shares[LABIAL_VISEME_TH] = LABIAL_VISEME_ONE;
    labial_tongue(shares, thin);
    assert_true(thin[0] == 0 && thin[1] == 160 && thin[2] == 240 && thin[3] == 40 && thin[4] == 0);
    for (unsigned v = 0; v < LABIAL_VISEMES; v++) {
        memset(shares, 0, sizeof shares);
        shares[v] = LABIAL_VISEME_ONE;
        labial_tongue(shares, tongue);
        assert_true(tongue[0] == 0 && tongue[4] == 0 && (v == LABIAL_VISEME_TH || tongue[2] < thin[2]));
    }
    memset(shares, 0, sizeof shares);
    shares[LABIAL_VISEME_TH] = shares[LABIAL_VISEME_SIL] = LABIAL_VISEME_ONE / 2;
    labial_tongue(shares, tongue);
    assert_int_equal(tongue[2], 120);
    labial_tongue(NULL, tongue);
    labial_tongue(shares, NULL);
    assert_int_equal(tongue[2], 120);
    memset(shares, 255, sizeof shares); /* any bytes: no overflow */
    labial_tongue(shares, tongue);
    assert_int_equal(tongue[1], (255 * (160 + 400 - 120 + 300 + 260 + 400 + 300 - 80 + 40 + 60 - 60 - 40) + 64) / 128);
}

SUITE(NULL, NULL)
