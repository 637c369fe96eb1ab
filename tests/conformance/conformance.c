/*
 * conformance.c - an image that plays every stream, in every way of feeding it, and compares the digests of its frames
 * with those of vectors.c.
 */
#include "board.h"
#include "player.h"

static labial_t stream;
static uint32_t workspace[CONFORMANCE_WORKSPACE / 4];

static int passes(const conformance_stream_t *script, conformance_feed_t feed)
{
    conformance_digest_t digest = { 0, 0 };
    const char *complaint =
        conformance_play(script, feed, &stream, workspace, sizeof workspace, conformance_digest, &digest);
    const int same = digest.crc == script->digest && digest.frames == script->frames;
    board_print(script->name);
    board_print(", ");
    board_print(conformance_feed_names[feed]);
    board_print(": ");
    board_print_unsigned(digest.frames);
    board_print(" frames, ");
    board_print_hex(digest.crc);
    if (!same) {
        board_print(", not ");
        board_print_unsigned(script->frames);
        board_print(" frames, ");
        board_print_hex(script->digest);
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
    for (i = 0; i < conformance_stream_count; i++)
        for (feed = 0; feed < CONFORMANCE_FEEDS; feed++)
            failures += !passes(&conformance_streams[i], (conformance_feed_t)feed);
    board_print_unsigned(conformance_stream_count);
    board_print(" streams, ");
    board_print_unsigned(failures);
    board_print(" failures\n");
    return failures || conformance_stream_count == 0 ? 1 : 0;
}
