/*
 * lips.c - a ring of frames that waits for the loudspeaker's clock.
 */
#include "lips.h"

#include <string.h>

#include "hear_small.h"

/* What threads share is guarded by a lock that is held for the copy of a frame, never while hearing. */
#ifdef ESP_PLATFORM
#include <freertos/FreeRTOS.h>
static portMUX_TYPE guard = portMUX_INITIALIZER_UNLOCKED;
#define LOCK() portENTER_CRITICAL(&guard)
#define UNLOCK() portEXIT_CRITICAL(&guard)
#else
#include <stdatomic.h>
static atomic_flag guard = ATOMIC_FLAG_INIT;
#define LOCK()                                                                                                         \
    while (atomic_flag_test_and_set(&guard)) {                                                                         \
    }
#define UNLOCK() atomic_flag_clear(&guard)
#endif

#define MS 1000 /* microseconds */
#define BLOCK 80

/* The thread that feeds. */
static labial_hear_t hear;
static uint32_t workspace[HEAR_SMALL_WORKSPACE_SIZE / 4];
static uint64_t fed; /* samples so far */

/* Shared. */
static struct {
    uint32_t rate;   /* 0 before lips_begin() */
    uint32_t begins; /* calls of that */
    unsigned channels;
    uint32_t known; /* frames so far */
    int playing;
    uint64_t first, end; /* the latest that were given without a gap between their numbers */
    int64_t silent;      /* when they will all have been heard */
    int16_t frames[LIPS_FRAMES][LABIAL_CHANNELS];
} shared;

/* The thread that shows. */
static int16_t pose[LABIAL_CHANNELS]; /* the latest */
static int16_t from[LABIAL_CHANNELS]; /* and that from which it eases */
static int speaking;
static int64_t turned; /* when that began */
static uint32_t seen;  /* begins */

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)user;
    LOCK();
    memcpy(shared.frames[frame % LIPS_FRAMES], faps, sizeof shared.frames[0]);
    shared.known = frame + 1;
    UNLOCK();
}

int lips_begin(uint32_t rate, unsigned channels)
{
    LOCK();
    const uint32_t begins = shared.begins;
    memset(&shared, 0, sizeof shared);
    shared.begins = begins + 1;
    UNLOCK();
    fed = 0;
    const int result =
        labial_hear_init(&hear, &hear_small, rate, channels, workspace, sizeof workspace, on_frame, NULL);
    if (result == LABIAL_OK) {
        LOCK();
        shared.rate = rate;
        shared.channels = channels;
        UNLOCK();
    }
    return result;
}

uint64_t lips_feed(const void *samples, size_t count)
{
    const uint64_t first = fed;
    const char *at = samples;
    int16_t block[2 * BLOCK];
    LOCK();
    const unsigned channels = shared.channels;
    UNLOCK();
    while (channels > 0 && count > 0) {
        const size_t part = count < BLOCK ? count : BLOCK;
        memcpy(block, at, part * channels * sizeof *block);
        (void)labial_hear_push(&hear, block, part);
        at += part * channels * sizeof *block;
        count -= part;
        fed += part;
    }
    return first;
}

void lips_playing(uint64_t first, size_t count, int64_t now)
{
    LOCK();
    if (shared.rate > 0 && count > 0) {
        if (first != shared.end || !shared.playing)
            shared.first = first;
        if (!shared.playing || shared.silent < now)
            shared.silent = now;
        shared.silent += (int64_t)count * 1000000 / shared.rate;
        shared.end = first + count;
        shared.playing = 1;
    }
    UNLOCK();
}

void lips_cancel(void)
{
    LOCK();
    shared.playing = 0;
    UNLOCK();
}

/* With the lock held: the known frame that comes nearest to what is heard at a time, or null if nothing is. */
static const int16_t *heard(int64_t now)
{
    if (!shared.playing || shared.known == 0 || now - shared.silent > LIPS_GRACE * MS)
        return NULL;
    const int64_t left = shared.silent - now - LIPS_LEAD * MS;
    const uint64_t samples = left > 0 ? (uint64_t)left * shared.rate / 1000000 : 0;
    uint64_t at = shared.end - shared.first > samples ? shared.end - samples : shared.first;
    at -= at == shared.end; /* and shows the last one until it rests */
    const uint64_t frame = at / (shared.rate / LABIAL_HEAR_RATE);
    const uint32_t newest = shared.known - 1, oldest = newest < LIPS_FRAMES ? 0 : newest - (LIPS_FRAMES - 1);
    return shared.frames[(frame > newest ? newest : frame < oldest ? oldest : (uint32_t)frame) % LIPS_FRAMES];
}

int lips_frame(int64_t now, int16_t faps[LABIAL_CHANNELS])
{
    int16_t target[LABIAL_CHANNELS] = { 0 };
    LOCK();
    const int16_t *const frame = heard(now);
    if (frame)
        memcpy(target, frame, sizeof target);
    const uint32_t begins = shared.begins;
    UNLOCK();
    if (begins != seen) { /* from the neutral face, at any time */
        seen = begins;
        speaking = 0;
        turned = now - LIPS_EASE * MS;
        memset(pose, 0, sizeof pose);
    }
    if ((frame != NULL) != speaking) {
        speaking = frame != NULL;
        turned = now;
        memcpy(from, pose, sizeof from);
    }
    const int64_t done = (now - turned) / MS;
    for (unsigned i = 0; i < LABIAL_CHANNELS; i++) {
        pose[i] = target[i];
        if (done < LIPS_EASE)
            pose[i] = (int16_t)(from[i] + (target[i] - from[i]) * (int32_t)done / LIPS_EASE);
        faps[i] = pose[i];
    }
    return speaking;
}
