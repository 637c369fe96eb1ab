/*
 * test_units.c - the cutting of phonemes into pieces, worked by hand.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include "fixture.h"
#include "units.h"

static fixture_model_t plain, rich, laugh;
static labial_t stream;
static uint32_t workspace[LABIAL_WORKSPACE_SIZE(LABIAL_STATES_MAX, 1) / 4];

static int setup(void **state)
{
    (void)state;
    fixture_plain(&plain);
    fixture_rich(&rich);
    fixture_laughter(&laugh);
    return 0;
}

static void nothing(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)user;
    (void)frame;
    (void)faps;
}

static void begin(const labial_model_t *model)
{
    assert_int_equal(labial_init(&stream, model, workspace, sizeof workspace, nothing, NULL), LABIAL_OK);
}

/* `frames` frames of a phoneme. */
static void push(unsigned phoneme, uint32_t frames)
{
    assert_int_equal(labial_push(&stream, phoneme, frames * 1000 / FIXTURE_RATE), LABIAL_OK);
}

/* Wants exactly one more piece of this place, or the end when `length` is 0. */
static void expect(uint32_t first, unsigned length, unsigned fade_in, unsigned fade_out)
{
    labial_piece_t piece;
    const int result = labial_units_next(&stream, &piece);
    if (length == 0) {
        assert_int_equal(result, LABIAL_DONE);
        return;
    }
    assert_int_equal(result, LABIAL_OK);
    if (piece.begin != first || piece.length != length || piece.fade_in != fade_in || piece.fade_out != fade_out)
        fail_msg("%u + %u, fades %u and %u, instead of %u + %u, %u and %u", piece.begin, piece.length, piece.fade_in,
                 piece.fade_out, first, length, fade_in, fade_out);
}

/* The figures below are worked for these limits. */
static void the_limits_are_the_usual_ones(void **state)
{
    (void)state;
    assert_int_equal(LABIAL_WINDOW, 40);
    assert_int_equal(LABIAL_PIECE, 16);
    assert_int_equal(LABIAL_OVERLAP, 8);
}

/* V-C-V, and again from the vowel that both share. */
static void vowels_bound_units(void **state)
{
    (void)state;
    begin(&plain.model);
    push(FIXTURE_A, 6), push(FIXTURE_T, 5), push(FIXTURE_O, 7), push(FIXTURE_S, 6), push(FIXTURE_A, 5);
    labial_end(&stream);
    expect(0, 18, 0, 7);  /* a t o */
    expect(11, 18, 7, 0); /* o s a: the stream's last phoneme is a boundary, whatever it is */
    expect(0, 0, 0, 0);
}

static void closures_bound_units(void **state)
{
    (void)state;
    begin(&plain.model);
    push(FIXTURE_S, 12), push(FIXTURE_P, 4), push(FIXTURE_A, 13), push(FIXTURE_S, 2);
    labial_end(&stream);
    expect(0, 16, 0, 4);  /* s p: the stream's first phoneme is a boundary too */
    expect(12, 17, 4, 8); /* p a */
    expect(21, 10, 8, 0); /* a s */
    expect(0, 0, 0, 0);
}

static void consonant_clusters_stay_together(void **state)
{
    (void)state;
    begin(&plain.model);
    push(FIXTURE_A, 15), push(FIXTURE_P, 2), push(FIXTURE_S, 3), push(FIXTURE_T, 3), push(FIXTURE_O, 6);
    labial_end(&stream);
    expect(0, 17, 0, 2);
    expect(15, 14, 2, 0); /* p s t o */
    expect(0, 0, 0, 0);
    begin(&plain.model);
    push(FIXTURE_S, 5), push(FIXTURE_T, 5), push(FIXTURE_S, 15);
    labial_end(&stream);
    expect(0, 25, 0, 0);
    expect(0, 0, 0, 0);
}

/* Units are taken together until a piece has LABIAL_PIECE frames, and no longer: would catch a comparison that is one
 * off, and an overlap with the wrong phoneme. */
static void short_units_are_decoded_together(void **state)
{
    (void)state;
    begin(&plain.model);
    push(FIXTURE_A, 5), push(FIXTURE_T, 3), push(FIXTURE_O, 6), push(FIXTURE_S, 4), push(FIXTURE_A, 5);
    push(FIXTURE_T, 3), push(FIXTURE_O, 4);
    labial_end(&stream);
    expect(0, 23, 0, 5); /* a t o, and o s a */
    expect(18, 12, 5, 0);
    expect(0, 0, 0, 0);
    begin(&plain.model); /* 16 frames are enough */
    push(FIXTURE_A, 6), push(FIXTURE_T, 4), push(FIXTURE_O, 6), push(FIXTURE_A, 3), push(FIXTURE_S, 2);
    labial_end(&stream);
    expect(0, 16, 0, 6);
    expect(10, 11, 6, 0);
    expect(0, 0, 0, 0);
    begin(&plain.model); /* 15 are not */
    push(FIXTURE_A, 5), push(FIXTURE_T, 4), push(FIXTURE_O, 6), push(FIXTURE_A, 3), push(FIXTURE_S, 2);
    labial_end(&stream);
    expect(0, 18, 0, 3);
    expect(15, 5, 3, 0);
    expect(0, 0, 0, 0);
    begin(&plain.model); /* frames shared with the piece before count; a unit does not end where the piece fades in */
    push(FIXTURE_A, 10), push(FIXTURE_O, 12), push(FIXTURE_P, 4), push(FIXTURE_A, 4), push(FIXTURE_P, 4);
    push(FIXTURE_O, 3), push(FIXTURE_S, 2);
    labial_end(&stream);
    expect(0, 22, 0, 8);
    expect(14, 16, 8, 4); /* of o, p, a */
    expect(26, 13, 4, 0); /* a p o, 11 frames, and the stream ends before another unit does */
    expect(0, 0, 0, 0);
}

/* A unit that does not fit the window any more begins a piece of its own. */
static void a_full_window_ends_with_the_last_whole_unit(void **state)
{
    (void)state;
    begin(&plain.model);
    push(FIXTURE_A, 5), push(FIXTURE_T, 3), push(FIXTURE_O, 6), push(FIXTURE_S, 30), push(FIXTURE_A, 3);
    push(FIXTURE_S, 2);
    labial_end(&stream);
    expect(0, 14, 0, 6);
    expect(8, 39, 6, 3); /* o s a */
    expect(44, 5, 3, 0);
    expect(0, 0, 0, 0);
    begin(&plain.model); /* the last of two */
    push(FIXTURE_A, 3), push(FIXTURE_T, 2), push(FIXTURE_O, 3), push(FIXTURE_S, 2), push(FIXTURE_A, 3);
    push(FIXTURE_S, 28), push(FIXTURE_S, 1);
    labial_end(&stream);
    expect(0, 13, 0, 3);
    expect(10, 32, 3, 0);
    expect(0, 0, 0, 0);
    begin(&plain.model); /* a unit that just fits */
    push(FIXTURE_A, 5), push(FIXTURE_T, 3), push(FIXTURE_O, 6), push(FIXTURE_S, 20), push(FIXTURE_A, 6);
    push(FIXTURE_S, 2);
    labial_end(&stream);
    expect(0, 40, 0, 6);
    expect(34, 8, 6, 0);
    expect(0, 0, 0, 0);
    begin(&plain.model); /* one that is a frame too long */
    push(FIXTURE_A, 5), push(FIXTURE_T, 3), push(FIXTURE_O, 6), push(FIXTURE_S, 20), push(FIXTURE_A, 7);
    push(FIXTURE_S, 2);
    labial_end(&stream);
    expect(0, 14, 0, 6);
    expect(8, 33, 6, 7);
    expect(34, 9, 7, 0);
    expect(0, 0, 0, 0);
    begin(&plain.model); /* the window ends with a phoneme that ends no unit */
    push(FIXTURE_A, 5), push(FIXTURE_T, 3), push(FIXTURE_O, 6), push(FIXTURE_S, 26), push(FIXTURE_T, 3);
    labial_end(&stream);
    expect(0, 14, 0, 6);
    expect(8, 35, 6, 0);
    expect(0, 0, 0, 0);
    begin(&plain.model); /* the rest of the stream just fits */
    push(FIXTURE_A, 5), push(FIXTURE_T, 3), push(FIXTURE_O, 6), push(FIXTURE_S, 26);
    labial_end(&stream);
    expect(0, 40, 0, 0);
    expect(0, 0, 0, 0);
}

static void overlaps_are_limited(void **state)
{
    (void)state;
    begin(&plain.model);
    push(FIXTURE_T, 3), push(FIXTURE_A, 30), push(FIXTURE_S, 3), push(FIXTURE_O, 4);
    labial_end(&stream);
    expect(0, 33, 0, LABIAL_OVERLAP);
    expect(33 - LABIAL_OVERLAP, 7 + LABIAL_OVERLAP, LABIAL_OVERLAP, 0);
    expect(0, 0, 0, 0);
}

static void long_pauses_are_cut(void **state)
{
    const unsigned w = LABIAL_WINDOW, cut = LABIAL_OVERLAP, step = w - cut;
    (void)state;
    begin(&plain.model);
    push(FIXTURE_SIL, 3 * w - 2 * cut - 4);
    labial_end(&stream);
    expect(0, w, 0, cut);
    expect(step, w, cut, cut);
    expect(2 * step, w - 4, cut, 0);
    expect(0, 0, 0, 0);
    begin(&plain.model); /* exactly a window is not cut */
    push(FIXTURE_SIL, w);
    labial_end(&stream);
    expect(0, w, 0, 0);
    expect(0, 0, 0, 0);
    begin(&plain.model); /* one frame more is */
    push(FIXTURE_SIL, w + 1);
    labial_end(&stream);
    expect(0, w, 0, cut);
    expect(step, cut + 1, cut, 0);
    expect(0, 0, 0, 0);
}

static void models_run_on_into_each_other(void **state)
{
    (void)state;
    begin(&plain.model);
    push(FIXTURE_S, 5), push(FIXTURE_T, 5);
    assert_int_equal(labial_use(&stream, &laugh.model), LABIAL_OK);
    push(FIXTURE_FRICATIVE, 10);
    labial_end(&stream);
    expect(0, 10 + LABIAL_OVERLAP, 0, LABIAL_OVERLAP);
    expect(10, 10, LABIAL_OVERLAP, 0);
    expect(0, 0, 0, 0);
    begin(&plain.model); /* a laugh shorter than the cross-fade: both fades are as long as it is, but half at most */
    push(FIXTURE_S, 5);
    assert_int_equal(labial_use(&stream, &laugh.model), LABIAL_OK);
    push(FIXTURE_FRICATIVE, 3);
    assert_int_equal(labial_use(&stream, &plain.model), LABIAL_OK);
    push(FIXTURE_S, 20);
    labial_end(&stream);
    expect(0, 8, 0, 3);
    expect(5, 6, 3, 3);
    expect(8, 20, 3, 0);
    expect(0, 0, 0, 0);
}

/* Would catch a short unit that ends its piece where the model changes, or one that does not where the window is
 * full. */
static void short_units_run_on_into_another_model(void **state)
{
    (void)state;
    begin(&plain.model);
    push(FIXTURE_A, 5), push(FIXTURE_T, 3), push(FIXTURE_O, 6), push(FIXTURE_S, 4);
    assert_int_equal(labial_use(&stream, &laugh.model), LABIAL_OK);
    push(FIXTURE_HA, 20);
    labial_end(&stream);
    expect(0, 26, 0, 8);
    expect(18, 20, 8, 0);
    expect(0, 0, 0, 0);
    begin(&plain.model); /* the unit's own end is where the model changes */
    push(FIXTURE_A, 5), push(FIXTURE_T, 3), push(FIXTURE_O, 6);
    assert_int_equal(labial_use(&stream, &laugh.model), LABIAL_OK);
    push(FIXTURE_HA, 20);
    labial_end(&stream);
    expect(0, 22, 0, 8);
    expect(14, 20, 8, 0);
    expect(0, 0, 0, 0);
    begin(&plain.model); /* it is long enough for a piece */
    push(FIXTURE_A, 5), push(FIXTURE_T, 5), push(FIXTURE_O, 6);
    assert_int_equal(labial_use(&stream, &laugh.model), LABIAL_OK);
    push(FIXTURE_HA, 20);
    labial_end(&stream);
    expect(0, 16, 0, 6);
    expect(10, 12, 6, 6);
    expect(16, 20, 6, 0);
    expect(0, 0, 0, 0);
    begin(&plain.model); /* the window has room for five frames of the laugh */
    push(FIXTURE_A, 5), push(FIXTURE_T, 3), push(FIXTURE_O, 6), push(FIXTURE_S, 21);
    assert_int_equal(labial_use(&stream, &laugh.model), LABIAL_OK);
    push(FIXTURE_HA, 20);
    labial_end(&stream);
    expect(0, 40, 0, 5);
    expect(35, 20, 5, 0);
    expect(0, 0, 0, 0);
    begin(&plain.model); /* it has none: the last whole unit is the piece */
    push(FIXTURE_A, 5), push(FIXTURE_T, 3), push(FIXTURE_O, 6), push(FIXTURE_S, 26);
    assert_int_equal(labial_use(&stream, &laugh.model), LABIAL_OK);
    push(FIXTURE_HA, 20);
    labial_end(&stream);
    expect(0, 14, 0, 6);
    expect(8, 40, 6, 8);
    expect(40, 20, 8, 0);
    expect(0, 0, 0, 0);
}

/* Would catch a piece that is taken before what follows it, and so its last phoneme's context, is known; or a short one
 * before it is known that no further unit belongs to it. */
static void pieces_wait_for_what_they_depend_on(void **state)
{
    labial_piece_t piece;
    unsigned i;
    (void)state;
    begin(&plain.model);
    assert_int_equal(labial_units_next(&stream, &piece), LABIAL_WAITING);
    push(FIXTURE_A, 6), push(FIXTURE_T, 5), push(FIXTURE_O, 6);
    assert_int_equal(labial_units_next(&stream, &piece), LABIAL_WAITING);
    push(FIXTURE_S, 1);
    expect(0, 17, 0, 6);
    assert_int_equal(labial_units_next(&stream, &piece), LABIAL_WAITING);
    labial_end(&stream);
    expect(11, 7, 6, 0);
    expect(0, 0, 0, 0);
    begin(&rich.model); /* kernels that reach (7 - 1 - 4) * 3 frames ahead */
    push(FIXTURE_A, 6), push(FIXTURE_T, 5), push(FIXTURE_O, 6);
    for (i = 0; i < 6; i++) {
        assert_int_equal(labial_units_next(&stream, &piece), LABIAL_WAITING);
        push(FIXTURE_S, 1);
    }
    expect(0, 17, 0, 6);
    begin(&plain.model); /* a unit of 14 frames: until the window is full */
    push(FIXTURE_A, 5), push(FIXTURE_T, 3), push(FIXTURE_O, 6);
    for (i = 14; i < 40; i++) {
        push(FIXTURE_S, 1);
        assert_int_equal(labial_units_next(&stream, &piece), LABIAL_WAITING);
    }
    push(FIXTURE_S, 1);
    expect(0, 14, 0, 6);
    begin(&plain.model); /* until the next unit is whole, and what follows it known */
    push(FIXTURE_A, 5), push(FIXTURE_T, 3), push(FIXTURE_O, 6), push(FIXTURE_A, 3);
    assert_int_equal(labial_units_next(&stream, &piece), LABIAL_WAITING);
    push(FIXTURE_S, 1);
    expect(0, 17, 0, 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_limits_are_the_usual_ones),
        cmocka_unit_test(vowels_bound_units),
        cmocka_unit_test(closures_bound_units),
        cmocka_unit_test(consonant_clusters_stay_together),
        cmocka_unit_test(short_units_are_decoded_together),
        cmocka_unit_test(a_full_window_ends_with_the_last_whole_unit),
        cmocka_unit_test(overlaps_are_limited),
        cmocka_unit_test(long_pauses_are_cut),
        cmocka_unit_test(models_run_on_into_each_other),
        cmocka_unit_test(short_units_run_on_into_another_model),
        cmocka_unit_test(pieces_wait_for_what_they_depend_on),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
