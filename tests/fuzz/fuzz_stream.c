/*
 * fuzz_stream.c - any sequence of calls, right and wrong ones: libFuzzer's bytes choose them.
 *
 * The structure and the workspace lie on the heap, exactly as large as they must be, so that AddressSanitizer sees
 * every access beside them. Beyond that: results are those the header lists, frames are numbered without a gap, the
 * callback comes once per LABIAL_OK, errors change nothing that can be asked for, and a stream that ends lasts exactly
 * as long as its phonemes. The first byte chooses between the small models of the suites, which have every kind of
 * table, and the bundled ones; make_seeds.c writes the conformance streams as such bytes.
 */
#include "fixture.h"
#include "fuzz.h"
#include "labial/visemes.h"

/* The bundled models look 18 frames back; a library that is built for less plays the small ones alone. */
#define HAS_BUNDLED (LABIAL_REACH >= 18)
#if HAS_BUNDLED
#include "laughter_synthetic.h"
#include "speech_en.h"
#endif

/* Ticks after which an input takes no long runs of them, so that one input does not take the time of hundreds. */
#define TICKS 1000

static fixture_model_t speech, laugh, plain, slow, other_rate;

typedef struct {
    labial_t *stream;
    uint32_t next;       /* frame number that is due */
    unsigned calls;      /* of the callback, since the last tick began */
    uint64_t ms, frames; /* pushed and delivered since the stream began or was taken up again */
    int ended, cancelled, done, begun;
    int was_cancelled;          /* at any time */
    unsigned resting;           /* ticks in a row that moved the face to rest */
    unsigned on_way;            /* ticks that waited though nothing was lacking */
    unsigned phonemes, silence; /* of the current model */
    unsigned ticks;
    uint32_t room;                   /* bytes of the workspace */
    const labial_model_t *first;     /* the stream's first model */
    const labial_model_t *models[5]; /* that it may be asked to use */
} watch_t;

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    watch_t *watch = (watch_t *)user;
    REQUIRE(frame == watch->next);
    static const uint8_t visemes[LABIAL_PHONEMES_MAX] = { 0, 10, 13, 1, 7, 255, 99 };
    uint8_t shares[LABIAL_VISEMES];
    unsigned sum = 0;
    REQUIRE(labial_visemes(watch->stream, watch->models[0], visemes, shares) == LABIAL_OK);
    for (unsigned v = 0; v < LABIAL_VISEMES; v++)
        sum += shares[v];
    REQUIRE(sum >= LABIAL_VISEME_ONE - 8u && sum <= LABIAL_VISEME_ONE + 8u);
    watch->calls++;
    for (unsigned c = 0; c < LABIAL_CHANNELS; c++)
        REQUIRE(faps[c] >= -2048 && faps[c] <= 2048);
}

static int tick(watch_t *watch)
{
    const unsigned room = labial_room(watch->stream), owed = labial_latency(watch->stream).frames;
    watch->calls = 0;
    watch->ticks++;
    const int result = labial_tick(watch->stream);
    REQUIRE(result >= LABIAL_OK && result <= LABIAL_DONE);
    REQUIRE(watch->calls <= 1u && (watch->calls == 1u || result != LABIAL_OK) &&
            (watch->calls == 0u || result != LABIAL_DONE));
    watch->next += result == LABIAL_OK;
    const unsigned delivered = owed - labial_latency(watch->stream).frames;
    REQUIRE(delivered <= (result == LABIAL_OK ? 1u : 0u));
    watch->frames += delivered;
    watch->resting = delivered > 0 || watch->calls == 0 ? 0 : watch->resting + 1;
    REQUIRE(watch->resting <= (watch->was_cancelled ? 1000u : LABIAL_EASE_FRAMES));
    if (result == LABIAL_DONE) {
        REQUIRE(watch->ended);
        if (!watch->done && !watch->cancelled)
            REQUIRE(fixture_is_exact(watch->frames, watch->ms, FIXTURE_RATE));
        REQUIRE(labial_latency(watch->stream).frames == 0);
        watch->done = 1;
    }
    if (result == LABIAL_OK)
        watch->on_way = 0;
    if (result == LABIAL_STARVED)
        REQUIRE(!watch->ended && room > 0);
    if (result == LABIAL_WAITING) {
        REQUIRE(!watch->begun);
        if (watch->ended || room == 0) /* the first frame is on its way */
            REQUIRE(++watch->on_way <= LABIAL_DELAY((unsigned)watch->first->search_stride));
    }
    watch->begun |= delivered > 0;
    return result;
}

static int is_same(labial_latency_t a, labial_latency_t b)
{
    return a.frames == b.frames && a.milliseconds == b.milliseconds && a.phonemes == b.phonemes && a.delay == b.delay;
}

static void push(watch_t *watch, unsigned phoneme, uint32_t ms)
{
    const labial_latency_t before = labial_latency(watch->stream);
    const unsigned room = labial_room(watch->stream);
    const int result = labial_push(watch->stream, phoneme, ms);
    if (result == LABIAL_OK) {
        REQUIRE(!watch->ended && room > 0 && phoneme < watch->phonemes && ms <= LABIAL_DURATION_MAX);
        watch->ms += ms;
        return;
    }
    REQUIRE(is_same(before, labial_latency(watch->stream)) && room == labial_room(watch->stream));
    if (watch->ended)
        REQUIRE(result == LABIAL_ERROR_STATE);
    else
        REQUIRE((result == LABIAL_ERROR_FULL && room == 0) ||
                (result == LABIAL_ERROR_PHONEME && phoneme >= watch->phonemes) ||
                (result == LABIAL_ERROR_DURATION && ms > LABIAL_DURATION_MAX));
}

static void choose(watch_t *watch, const labial_model_t *model)
{
    watch->phonemes = model->phoneme_count;
    watch->silence = model->silence;
}

static void use(watch_t *watch, unsigned choice)
{
    const labial_model_t *model = choice < 5 ? watch->models[choice] : NULL;
    const labial_latency_t before = labial_latency(watch->stream);
    const int result = labial_use(watch->stream, model);
    REQUIRE(is_same(before, labial_latency(watch->stream)));
    if (!model)
        REQUIRE(result == LABIAL_ERROR_NULL);
    else if (watch->ended)
        REQUIRE(result == LABIAL_ERROR_STATE);
    else if (model->search_stride != watch->first->search_stride ||
             model->frames_per_second != watch->first->frames_per_second)
        REQUIRE(result == LABIAL_ERROR_FRAME_RATE);
    else if (labial_workspace_size(model) > watch->room)
        REQUIRE(result == LABIAL_ERROR_WORKSPACE);
    else
        REQUIRE(result == LABIAL_OK || result == LABIAL_ERROR_MODELS);
    if (result == LABIAL_OK)
        choose(watch, model);
}

static void restart(watch_t *watch)
{
    const int result = labial_restart(watch->stream);
    REQUIRE(result == LABIAL_OK || result == LABIAL_ERROR_STATE);
    REQUIRE((result == LABIAL_OK) == (watch->ended && labial_latency(watch->stream).frames == 0));
    if (result == LABIAL_OK) {
        REQUIRE(watch->ended);
        watch->ms = watch->frames = 0;
        watch->ended = watch->cancelled = watch->done = watch->begun = 0;
        watch->on_way = 0;
    }
}

/* The structure may lie elsewhere after every call. */
static void move(watch_t *watch)
{
    labial_t *place = (labial_t *)copy_of(watch->stream, sizeof *place);
    free(watch->stream);
    watch->stream = place;
}

static void one_call(watch_t *watch, input_t *bytes)
{
    const unsigned call = number(bytes, 1);
    unsigned i;
    switch (call % 16) {
    case 0:
    case 1:
    case 2:
    case 3: /* an ordinary phoneme */
        push(watch, ((call >> 4) + call % 4 * 16) % watch->phonemes, number(bytes, 1) * 2);
        break;
    case 4: /* a long one */
        i = number(bytes, 1);
        push(watch, i % watch->phonemes, number(bytes, 2));
        break;
    case 5: /* any numbers */
        i = number(bytes, (call >> 4) % 5);
        push(watch, i, number(bytes, 4));
        break;
    case 6: /* many short ones */
        for (i = call >> 2; i > 0; i--)
            push(watch, i % watch->phonemes, call >> 4);
        break;
    case 7:
    case 8:
        (void)tick(watch);
        break;
    case 9:
        for (i = number(bytes, 1); i > 0 && watch->ticks < TICKS; i--)
            (void)tick(watch);
        break;
    case 10: /* a pause */
        push(watch, watch->silence, number(bytes, 2));
        break;
    case 11: /* phonemes of one frame, of both models in turn */
        for (i = call >> 4; i > 0; i--) {
            use(watch, i % 2);
            push(watch, i % watch->phonemes, 1000 / FIXTURE_RATE);
        }
        break;
    case 12:
        use(watch, call >> 4);
        break;
    case 13:
        if (call & 128) {
            REQUIRE(labial_end(watch->stream) == LABIAL_OK);
            watch->ended = 1;
        } else if (call & 64) {
            REQUIRE(labial_exact(watch->stream, call >> 4 & 3) == LABIAL_OK);
        } else {
            move(watch);
        }
        break;
    case 14:
        if (call & 128) {
            REQUIRE(labial_cancel(watch->stream, number(bytes, (call >> 4) % 8 / 2)) == LABIAL_OK);
            watch->ended = watch->cancelled = watch->was_cancelled = 1;
            watch->resting = 0;
            watch->done = 0;
        } else {
            REQUIRE(labial_articulation(watch->stream, number(bytes, 1 + (call >> 4) % 4)) == LABIAL_OK);
        }
        break;
    default:
        restart(watch);
        break;
    }
}

static void make_models(void)
{
    /* Models of 13, 10 and 9 channels: of some pairs the right side follows the left one. */
    static const uint8_t ten[LABIAL_CHANNELS] = { 0, 1, 2, 3, 4, 5, 5, 7, 7, 9, 9, 11, 12 };
    static const uint8_t nine[LABIAL_CHANNELS] = { 0, 1, 2, 3, 4, 5, 5, 7, 7, 9, 9, 11, 11 };
    fixture_rich(&speech);
    fixture_laughter(&laugh);
    fixture_narrow(&laugh, ten);
    fixture_plain(&plain);
    fixture_narrow(&plain, nine);
    plain.model.search_stride = FIXTURE_STRIDE;
    fixture_slow(&slow);
    fixture_plain(&other_rate);
    other_rate.model.search_stride = FIXTURE_STRIDE;
    other_rate.model.frames_per_second = 30;
}

/* The models of a stream, the first of which it begins with. */
static void choose_models(watch_t *watch, unsigned choice)
{
    const labial_model_t *const small[] = { &speech.model, &laugh.model, &plain.model, &slow.model, &other_rate.model };
#if HAS_BUNDLED
    const labial_model_t *const bundled[] = { &speech_en, &laughter_synthetic, &slow.model, &laugh.model,
                                              &speech.model };
#else
    const labial_model_t *const *const bundled = small;
#endif
    memcpy(watch->models, choice % 4 < 2 ? small : bundled, sizeof watch->models);
    watch->first = watch->models[choice % 2 * 2];
    watch->room = choice & 4 ? labial_workspace_size(watch->first)
                             : LABIAL_WORKSPACE_SIZE((uint32_t)watch->first->search_stride, LABIAL_CHANNELS);
    choose(watch, watch->first);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    input_t bytes = { data, size };
    watch_t watch = { 0 };
    void *workspace;
    if (speech.model.format == 0)
        make_models();
    choose_models(&watch, number(&bytes, 1));
    workspace = memory_of(watch.room);
    watch.stream = (labial_t *)memory_of(sizeof *watch.stream);
    REQUIRE(labial_init(watch.stream, watch.first, workspace, watch.room, on_frame, &watch) == LABIAL_OK);
    move(&watch);
    for (unsigned calls = 0; bytes.left > 0 && calls < 2000; calls++)
        one_call(&watch, &bytes);

    /* The rest is played, unless it lasts long. */
    REQUIRE(labial_end(watch.stream) == LABIAL_OK);
    watch.ended = 1;
    if (labial_latency(watch.stream).frames < 2 * TICKS)
        for (unsigned i = 0; tick(&watch) != LABIAL_DONE; i++)
            REQUIRE(i < 100000);
    free(workspace);
    free(watch.stream);
    return 0;
}

#ifdef FUZZ_BY_CHANCE
/* Bytes by chance, for builds that have no fuzzer (tests/limits): the same ones on every machine. What is wrong ends the
 * program. */
#define INPUTS 600
#define LONGEST 600 /* bytes */

int main(void)
{
    fixture_random_t random = { 1 };
    for (unsigned i = 0; i < INPUTS; i++) {
        const size_t size = 1u + fixture_below(&random, LONGEST);
        uint8_t *const bytes = (uint8_t *)memory_of(size);
        for (size_t at = 0; at < size; at++)
            bytes[at] = (uint8_t)fixture_random(&random);
        REQUIRE(LLVMFuzzerTestOneInput(bytes, size) == 0);
        free(bytes);
    }
    return 0;
}
#endif
