/*
 * conformance.c - an image that plays every stream, in every way of feeding it, and compares the digests of its frames
 * with those of vectors.c. CONFORMANCE_FRAMES names a file of the frames themselves, if there is room for them: then
 * the image says which frame is the first that differs.
 */
#include "board.h"
#include "player.h"

static labial_t stream;
static uint32_t workspace[CONFORMANCE_WORKSPACE / 4];

/* Frames that are alike, and how many. */
typedef struct {
    uint32_t count;
    int16_t faps[LABIAL_CHANNELS];
} run_t;

#ifdef CONFORMANCE_FRAMES
static const run_t runs[] = {
#include CONFORMANCE_FRAMES
};
#else
static const run_t runs[1] = { { 0, { 0 } } };
#endif

/* The frames of all streams, one after the other: the run of the next one, and how many of it were there before. */
typedef struct {
    unsigned run;
    uint32_t before;
} place_t;

typedef struct {
    conformance_digest_t digest;
    place_t place;
    uint32_t limit; /* frames that the stream has */
    int differs;    /* the members below are those of the first difference */
    uint32_t frame;
    unsigned channel;
    int found, wanted;
} comparison_t;

/* The frame at a place, which moves on. */
static const int16_t *next(place_t *place)
{
    const run_t *run = &runs[place->run];
    if (++place->before == run->count) {
        place->run++;
        place->before = 0;
    }
    return run->faps;
}

static void compare(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    comparison_t *to = (comparison_t *)user;
    int16_t found[LABIAL_CHANNELS];
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        found[k] = faps[k];
#ifdef CONFORMANCE_SPOILED /* as if the library erred in one number */
    found[3] = (int16_t)(found[3] + (frame == 5u));
#endif
    conformance_digest(&to->digest, frame, found);
    if (sizeof runs > sizeof runs[0] && to->digest.frames <= to->limit) {
        const int16_t *wanted = next(&to->place);
        for (k = 0; k < LABIAL_CHANNELS && !to->differs; k++) {
            if (found[k] == wanted[k])
                continue;
            to->differs = 1;
            to->frame = frame;
            to->channel = k;
            to->found = found[k];
            to->wanted = wanted[k];
        }
    }
}

static int passes(const conformance_stream_t *script, conformance_feed_t feed, place_t place)
{
    comparison_t comparison = { { 0, 0 }, place, script->frames, 0, 0, 0, 0, 0 };
    const char *complaint = conformance_play(script, feed, &stream, workspace, sizeof workspace, compare, &comparison);
    const conformance_digest_t digest = comparison.digest;
    const int same = digest.crc == script->digest && digest.frames == script->frames;
    board_print(script->name);
    board_print(", ");
    board_print(conformance_feed_names[feed]);
    board_print_within(": ", digest.frames, " frames, ");
    board_print_hex(digest.crc);
    if (!same) {
        board_print_within(", not ", script->frames, " frames, ");
        board_print_hex(script->digest);
    }
    if (comparison.differs) {
        board_print_within(", frame ", comparison.frame, "");
        board_print_within(", channel ", comparison.channel, " is ");
        board_print_signed(comparison.found);
        board_print(", not ");
        board_print_signed(comparison.wanted);
    }
    if (complaint) {
        board_print(", ");
        board_print(complaint);
    }
    board_print(same && !complaint ? "\n" : " FAILED\n");
    return same && !complaint;
}

int main(void)
{
    unsigned i, feed, failures = 0;
    uint32_t frame;
    place_t place = { 0, 0 };
    for (i = 0; i < conformance_stream_count; i++) {
        for (feed = 0; feed < CONFORMANCE_FEEDS; feed++)
            failures += !passes(&conformance_streams[i], (conformance_feed_t)feed, place);
        for (frame = 0; sizeof runs > sizeof runs[0] && frame < conformance_streams[i].frames; frame++)
            (void)next(&place);
    }
    board_print_within("", conformance_stream_count, " streams, ");
    board_print_within("", failures, " failures\n");
    return failures || conformance_stream_count == 0 ? 1 : 0;
}
