/*
 * test_units_random.c - the cutting of phonemes into pieces on random streams, against the rules of units.h applied to
 * the whole of a stream at once.
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

#define COUNT 300
#define MANY 20000

typedef struct {
    uint32_t start, stop;
    uint8_t phoneme, model;
} span_t;

static span_t spans[COUNT];
static unsigned span_count;
static uint32_t all_frames;
static const labial_model_t *two[2];

/* The first span that reaches beyond `frame`. */
static unsigned span_at(uint32_t frame)
{
    unsigned i = 0;
    while (spans[i].stop <= frame)
        i++;
    return i;
}

static uint32_t least(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* The piece that begins at frame `first` and shares `fade_in` frames with that before it. */
static labial_piece_t wanted_piece(uint32_t first, unsigned fade_in)
{
    const unsigned own = spans[span_at(first)].model;
    const uint32_t limit = first + LABIAL_WINDOW;
    uint32_t change, end = 0, overlap = LABIAL_OVERLAP, run;
    labial_piece_t piece;
    unsigned i;
    for (i = span_at(first); i < span_count && spans[i].model == own; i++)
        ;
    change = i < span_count ? spans[i].start : all_frames;
    for (i = 0; i + 1 < span_count && spans[i].stop <= least(limit, change); i++) {
        const span_t *s = &spans[i];
        if (s->start > first && s->start >= first + fade_in && two[own]->phonemes[s->phoneme].boundary &&
            (end == 0 || end - first < LABIAL_PIECE)) {
            end = s->stop;
            overlap = least(least(s->stop - s->start, (s->stop - first) / 2), LABIAL_OVERLAP);
        }
    }
    if (end == 0 || end - first < LABIAL_PIECE) { /* no unit is long enough, nor are several */
        if (change < least(limit, all_frames)) {
            for (run = change; run < all_frames && spans[span_at(run)].model != own; run++)
                ;
            overlap = least(least(least(LABIAL_OVERLAP, limit - change), run - change), change - first);
            end = change + overlap;
        } else if (change == all_frames && all_frames <= limit) {
            end = all_frames;
            overlap = 0;
        } else if (end == 0) {
            end = limit;
        }
    }
    piece.begin = first;
    piece.length = (uint16_t)(end - first);
    piece.fade_in = (uint16_t)fade_in;
    piece.fade_out = (uint16_t)overlap;
    piece.slot = (uint8_t)(stream.models[1] == two[own]);
    return piece;
}

/* What `pushed` frames of the stream say; silence is what lies beyond them and what is another model's. */
static void check_labels(const labial_piece_t *piece, uint32_t offset, uint32_t pushed)
{
    static uint8_t labels[LABIAL_WINDOW + 2 * LABIAL_REACH + 2];
    const labial_model_t *model = stream.models[piece->slot];
    const unsigned count = piece->length + 2u * LABIAL_REACH;
    unsigned i;
    memset(labels, 0xee, sizeof labels);
    labial_units_labels(&stream, piece, labels + 1);
    assert_int_equal(labels[0], 0xee);
    assert_int_equal(labels[count + 1], 0xee);
    for (i = 0; i < count; i++) {
        const long frame = (long)(offset + piece->begin + i) - LABIAL_REACH;
        unsigned wanted = model->silence;
        if (frame >= 0 && frame < (long)pushed && two[spans[span_at((uint32_t)frame)].model] == model)
            wanted = spans[span_at((uint32_t)frame)].phoneme;
        if (labels[i + 1] != wanted)
            fail_msg("frame %ld is labelled %u, not %u", frame, labels[i + 1], wanted);
    }
}

/* Everything that the piece depends on was pushed: what its kernels reach, and the successor of its last phoneme. */
static void check_known(const labial_piece_t *piece, uint32_t at, uint32_t pushed)
{
    const labial_model_t *model = stream.models[piece->slot];
    const uint32_t end = at + piece->length;
    const uint32_t ahead =
        model->kernel_taps ? (model->kernel_taps - 1u - model->kernel_behind) * (uint32_t)model->kernel_stride : 0;
    assert_true(pushed >= least(end + ahead, all_frames));
    assert_true(pushed == all_frames || pushed > spans[span_at(end - 1)].stop);
}

/* The piece's place within its stream and beside its neighbours. */
static void check_piece(const labial_piece_t *piece, uint32_t at, uint32_t before_end, uint32_t before_fade,
                        uint32_t older_end)
{
    const labial_piece_t wanted = wanted_piece(at, before_fade);
    if (piece->length != wanted.length || piece->fade_in != wanted.fade_in || piece->fade_out != wanted.fade_out ||
        piece->slot != wanted.slot)
        fail_msg("at %u: %u frames, fades %u and %u, model %u, not %u frames, %u, %u, %u", at, piece->length,
                 piece->fade_in, piece->fade_out, piece->slot, wanted.length, wanted.fade_in, wanted.fade_out,
                 wanted.slot);
    assert_true(piece->length >= 1 && piece->length <= LABIAL_WINDOW);
    assert_true(2 * piece->fade_out <= piece->length && piece->fade_out <= LABIAL_OVERLAP);
    assert_int_equal(at, before_end - before_fade); /* no gap, no frame beyond the cross-fade shared */
    assert_true(at >= older_end);                   /* no frame in three pieces */
    assert_true(at + piece->length <= all_frames);
}

/* Random phonemes of one or two models, and where they lie. */
static void compose(fixture_phoneme_t *input, int kind, uint32_t seed)
{
    fixture_random_t random = {seed + 100};
    uint64_t ms = 0;
    uint32_t end = 0;
    uint8_t current = 0;
    unsigned i;
    fixture_stream(input, COUNT, (fixture_kind_t)kind, seed);
    two[0] = seed % 3 ? &plain.model : &rich.model;
    two[1] = &laugh.model;
    span_count = 0;
    for (i = 0; i < COUNT; i++) {
        const uint32_t start = end;
        if (seed % 2 && fixture_below(&random, 6) == 0)
            current = !current;
        input[i].model = current;
        input[i].phoneme = (uint8_t)(input[i].phoneme % (current ? FIXTURE_LAUGH_COUNT : FIXTURE_SPEECH_COUNT));
        input[i].ms %= 1500;
        if (seed % 5 == 4) /* many short units */
            input[i].ms %= 100;
        ms += input[i].ms;
        end = (uint32_t)((ms * FIXTURE_RATE + 500) / 1000);
        if (end > start) {
            span_t *s = &spans[span_count++];
            s->start = start;
            s->stop = end;
            s->phoneme = input[i].phoneme;
            s->model = current;
        }
    }
    all_frames = end;
    assert_true(all_frames < MANY);
}

static unsigned long full_windows, merged, changes;

/* Feeds phonemes, as many as there is room for or one at a time, and follows every piece that is found. */
static void follow(int kind, uint32_t seed, int one_by_one)
{
    fixture_phoneme_t input[COUNT];
    uint32_t offset = 0, before_end = 0, before_fade = 0, older_end = 0;
    unsigned i = 0, idle = 0, current = 0;
    int result = LABIAL_WAITING;
    compose(input, kind, seed);
    begin(two[0]);
    while (result != LABIAL_DONE) {
        labial_piece_t piece;
        unsigned more = one_by_one ? result == LABIAL_WAITING : COUNT;
        for (; i < COUNT && more > 0 && labial_room(&stream) > 0; i++, more--) {
            if (input[i].model != current)
                assert_int_equal(labial_use(&stream, two[current = input[i].model]), LABIAL_OK);
            assert_int_equal(labial_push(&stream, input[i].phoneme, input[i].ms), LABIAL_OK);
        }
        if (i == COUNT && (!one_by_one || result == LABIAL_WAITING))
            labial_end(&stream);
        result = labial_units_next(&stream, &piece);
        if (result == LABIAL_OK) {
            const uint32_t at = offset + piece.begin, held = stream.queue_frames, pushed = offset + held;
            uint32_t start;
            unsigned first;
            check_piece(&piece, at, before_end, before_fade, older_end);
            check_known(&piece, at, stream.ended ? all_frames : pushed);
            first = labial_units_first(&stream, &piece, &start);
            assert_true(start <= piece.begin && piece.begin < start + labial_units_segment(&stream, first)->frames);
            check_labels(&piece, offset, pushed);
            full_windows += piece.length < LABIAL_PIECE && at + LABIAL_WINDOW < all_frames;
            merged += piece.length >= LABIAL_PIECE && piece.length < LABIAL_WINDOW;
            changes += two[spans[span_at(at + piece.length - 1)].model] != stream.models[piece.slot];
            older_end = before_end;
            before_end = at + piece.length;
            before_fade = piece.fade_out;
            labial_units_trim(&stream);
            offset += held - stream.queue_frames;
            idle = 0;
        } else if (result == LABIAL_WAITING) {
            assert_int_equal(stream.ended, 0);
            assert_true(idle++ < (one_by_one ? COUNT : 2u) && labial_room(&stream) > 0); /* a full queue never waits */
        }
    }
    assert_int_equal(before_fade, 0);
    assert_int_equal(before_end, all_frames); /* every frame is in a piece */
}

/* Whatever the feeding: would catch a piece that depends on what happens to be in the queue. */
static void random_streams_are_cut_by_the_rules(void **state)
{
    int kind;
    uint32_t seed;
    (void)state;
    for (kind = 0; kind < FIXTURE_ZERO; kind++) {
        for (seed = 0; seed < 30; seed++) {
            follow(kind, seed, 0);
            follow(kind, seed, 1);
        }
    }
    assert_true(full_windows > 100 && merged > 1000 && changes > 1000); /* all of them were met */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_streams_are_cut_by_the_rules),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
