/*
 * player.h - plays a conformance stream in one of several ways of feeding it, which must all give the same frames.
 */
#ifndef CONFORMANCE_PLAYER_H
#define CONFORMANCE_PLAYER_H

#include "laughter_synthetic.h"
#include "speech_en.h"
#include "vectors.h"

/* Bytes of workspace, enough for both bundled models. */
#define CONFORMANCE_WORKSPACE LABIAL_LARGER(SPEECH_EN_WORKSPACE_SIZE, LAUGHTER_SYNTHETIC_WORKSPACE_SIZE)

typedef enum {
    CONFORMANCE_FILL,      /* as many phonemes as there is room for before every tick */
    CONFORMANCE_SINGLE,    /* one phoneme before every tick */
    CONFORMANCE_HUNGRY,    /* one phoneme when nothing goes on without it: the stream starves throughout */
    CONFORMANCE_REAL_TIME, /* each phoneme when as many ticks have passed as there are frames before it */
    CONFORMANCE_FEEDS
} conformance_feed_t;

/* Names of the feeds, for reports. */
extern const char *const conformance_feed_names[CONFORMANCE_FEEDS];

/*
 * Plays a stream from labial_init() on; `sink` receives its frames. `workspace` has CONFORMANCE_WORKSPACE bytes.
 *
 * Returns null, or what the library did that it must not do: an error, frames that are misnumbered, more than one per
 * tick, a frame that is late though phonemes were there, a full queue that does not move.
 */
const char *conformance_play(const conformance_stream_t *script, conformance_feed_t feed, labial_t *stream,
                             void *workspace, size_t workspace_size, labial_frame_fn sink, void *user);

/* A labial_frame_fn that counts frames and keeps their CRC-32; `user` points to a conformance_digest_t set to zero. */
typedef struct {
    uint32_t crc;
    uint32_t frames;
} conformance_digest_t;

void conformance_digest(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS]);

#endif
