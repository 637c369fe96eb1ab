/*
 * test_units.c - the cutting of phonemes into pieces: worked by hand, and held to its rules on random streams.
 */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <string.h>

#include "fixture.h"
#include "units.h"

static fixture_model_t plain, rich, laugh;
static labial_t stream;
static uint32_t workspace[LABIAL_WORKSPACE_SIZE(LABIAL_STATES_MAX) / 4];

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

/* V-C-V, and again from the vowel that both share. */
static void vowels_bound_units(void **state)
{
    (void)state;
    begin(&plain.model);
    push(FIXTURE_A, 5), push(FIXTURE_T, 3), push(FIXTURE_O, 6), push(FIXTURE_S, 4), push(FIXTURE_A, 5);
    labial_end(&stream);
    expect(0, 14, 0, 6); /* a t o */
    expect(8, 15, 6, 0); /* o s a: the stream's last phoneme is a boundary, whatever it is */
    expect(0, 0, 0, 0);
}

static void closures_bound_units(void **state)
{
    (void)state;
    begin(&plain.model);
    push(FIXTURE_S, 3), push(FIXTURE_P, 4), push(FIXTURE_A, 5), push(FIXTURE_S, 2);
    labial_end(&stream);
    expect(0, 7, 0, 4); /* s p: the stream's first phoneme is a boundary too */
    expect(3, 9, 4, 5); /* p a */
    expect(7, 7, 5, 0); /* a s */
    expect(0, 0, 0, 0);
}

static void consonant_clusters_stay_together(void **state)
{
    (void)state;
    begin(&plain.model);
    push(FIXTURE_A, 5), push(FIXTURE_P, 2), push(FIXTURE_S, 3), push(FIXTURE_T, 3), push(FIXTURE_O, 6);
    labial_end(&stream);
    expect(0, 7, 0, 2);
    expect(5, 14, 2, 0); /* p s t o */
    expect(0, 0, 0, 0);
    begin(&plain.model);
    push(FIXTURE_S, 5), push(FIXTURE_T, 5), push(FIXTURE_S, 5);
    labial_end(&stream);
    expect(0, 15, 0, 0);
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
    const unsigned w = LABIAL_WINDOW, cut = LABIAL_CUT_OVERLAP, step = w - cut;
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
    expect(0, 10 + LABIAL_CUT_OVERLAP, 0, LABIAL_CUT_OVERLAP);
    expect(10, 10, LABIAL_CUT_OVERLAP, 0);
    expect(0, 0, 0, 0);
    begin(&plain.model); /* a laugh shorter than the cross-fade: both fades are as long as it is */
    push(FIXTURE_S, 5);
    assert_int_equal(labial_use(&stream, &laugh.model), LABIAL_OK);
    push(FIXTURE_FRICATIVE, 3);
    assert_int_equal(labial_use(&stream, &plain.model), LABIAL_OK);
    push(FIXTURE_S, 20);
    labial_end(&stream);
    expect(0, 8, 0, 3);
    expect(5, 3 + LABIAL_CUT_OVERLAP, 3, LABIAL_CUT_OVERLAP);
    expect(8, 20, LABIAL_CUT_OVERLAP, 0);
    expect(0, 0, 0, 0);
}

/* Would catch a piece that is taken before what follows it, and so its last phoneme's context, is known. */
static void pieces_wait_for_what_they_depend_on(void **state)
{
    labial_piece_t piece;
    unsigned i;
    (void)state;
    begin(&plain.model);
    assert_int_equal(labial_units_next(&stream, &piece), LABIAL_WAITING);
    push(FIXTURE_A, 5), push(FIXTURE_T, 3), push(FIXTURE_O, 6);
    assert_int_equal(labial_units_next(&stream, &piece), LABIAL_WAITING);
    push(FIXTURE_S, 1);
    expect(0, 14, 0, 6);
    assert_int_equal(labial_units_next(&stream, &piece), LABIAL_WAITING);
    labial_end(&stream);
    expect(8, 7, 6, 0);
    expect(0, 0, 0, 0);
    begin(&rich.model); /* kernels that reach (7 - 1 - 4) * 3 frames ahead */
    push(FIXTURE_A, 5), push(FIXTURE_T, 3), push(FIXTURE_O, 6);
    for (i = 0; i < 6; i++) {
        assert_int_equal(labial_units_next(&stream, &piece), LABIAL_WAITING);
        push(FIXTURE_S, 1);
    }
    expect(0, 14, 0, 6);
}

/* Frame by frame, what was pushed. */
static uint8_t all_phonemes[20000], all_slots[20000];
static long all_frames;

static unsigned wanted_label(long frame, unsigned slot)
{
    if (frame < 0 || frame >= all_frames || all_slots[frame] != slot)
        return stream.models[slot]->silence;
    return all_phonemes[frame];
}

static void check_labels(const labial_piece_t *piece, uint32_t offset)
{
    static uint8_t labels[LABIAL_WINDOW + 2 * LABIAL_REACH + 2];
    const unsigned count = piece->length + 2u * LABIAL_REACH;
    unsigned i;
    memset(labels, 0xee, sizeof labels);
    labial_units_labels(&stream, piece, labels + 1);
    assert_int_equal(labels[0], 0xee);
    assert_int_equal(labels[count + 1], 0xee);
    for (i = 0; i < count; i++) {
        const long frame = (long)(offset + piece->begin + i) - LABIAL_REACH;
        if (labels[i + 1] != wanted_label(frame, piece->slot))
            fail_msg("frame %ld is labelled %u, not %u", frame, labels[i + 1], wanted_label(frame, piece->slot));
    }
}

/* The piece's place within its stream and beside its neighbours. */
static void check_piece(const labial_piece_t *piece, uint32_t at, uint32_t before_end, uint32_t before_fade,
                        uint32_t older_end)
{
    assert_true(piece->length >= 1 && piece->length <= LABIAL_WINDOW);
    assert_true(piece->fade_out < piece->length && piece->fade_out <= LABIAL_OVERLAP);
    assert_int_equal(piece->fade_in, before_fade);
    assert_int_equal(at, before_end - before_fade); /* no gap, no frame beyond the cross-fade shared */
    assert_true(at >= older_end);                   /* no frame in three pieces */
    assert_true(at + piece->length <= (uint32_t)all_frames);
}

/* Feeds random phonemes of two models as room allows and follows every piece that is found. */
static void follow(int kind, uint32_t seed)
{
    fixture_random_t random = {seed + 100};
    fixture_phoneme_t input[300];
    uint32_t offset = 0, before_end = 0, before_fade = 0, older_end = 0;
    unsigned i = 0, idle = 0, current = 0;
    int result = LABIAL_WAITING;
    begin(seed % 3 ? &plain.model : &rich.model);
    all_frames = 0;
    fixture_stream(input, 300, (fixture_kind_t)kind, seed);
    while (result != LABIAL_DONE) {
        labial_piece_t piece;
        for (; i < 300 && labial_room(&stream) > 0; i++) {
            const uint32_t had = labial_latency(&stream).frames;
            uint32_t new_frames;
            if (seed % 2 && fixture_below(&random, 6) == 0) {
                current = !current;
                assert_int_equal(labial_use(&stream, current ? &laugh.model : seed % 3 ? &plain.model : &rich.model),
                                 LABIAL_OK);
            }
            input[i].phoneme = (uint8_t)(input[i].phoneme % (current ? FIXTURE_LAUGH_COUNT : FIXTURE_SPEECH_COUNT));
            assert_int_equal(labial_push(&stream, input[i].phoneme, input[i].ms % 1500), LABIAL_OK);
            for (new_frames = labial_latency(&stream).frames - had; new_frames > 0; new_frames--) {
                assert_true(all_frames < (long)sizeof all_phonemes);
                all_phonemes[all_frames] = input[i].phoneme;
                all_slots[all_frames++] = stream.slot;
            }
        }
        if (i == 300)
            labial_end(&stream);
        result = labial_units_next(&stream, &piece);
        if (result == LABIAL_OK) {
            const uint32_t at = offset + piece.begin, held = stream.queue_frames;
            uint32_t start;
            unsigned first;
            check_piece(&piece, at, before_end, before_fade, older_end);
            assert_int_equal(piece.slot, all_slots[at]);
            first = labial_units_first(&stream, &piece, &start);
            assert_true(start <= piece.begin && piece.begin < start + labial_units_segment(&stream, first)->frames);
            check_labels(&piece, offset);
            older_end = before_end;
            before_end = at + piece.length;
            before_fade = piece.fade_out;
            labial_units_trim(&stream);
            offset += held - stream.queue_frames;
            idle = 0;
        } else if (result == LABIAL_WAITING) {
            assert_int_equal(stream.ended, 0);
            assert_true(idle++ < 2 && labial_room(&stream) > 0); /* a full queue never waits */
        }
    }
    assert_int_equal(before_fade, 0);
    assert_int_equal(before_end, all_frames); /* every frame is in a piece */
}

static void random_streams_are_covered_without_gap_or_triple_overlap(void **state)
{
    int kind;
    uint32_t seed;
    (void)state;
    for (kind = 0; kind < FIXTURE_ZERO; kind++)
        for (seed = 0; seed < 24; seed++)
            follow(kind, seed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vowels_bound_units),
        cmocka_unit_test(closures_bound_units),
        cmocka_unit_test(consonant_clusters_stay_together),
        cmocka_unit_test(overlaps_are_limited),
        cmocka_unit_test(long_pauses_are_cut),
        cmocka_unit_test(models_run_on_into_each_other),
        cmocka_unit_test(pieces_wait_for_what_they_depend_on),
        cmocka_unit_test(random_streams_are_covered_without_gap_or_triple_overlap),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
