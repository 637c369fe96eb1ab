/*
 * lips.c - a ring of frames that waits for the loudspeaker's clock.
 */
#include "lips.h"

#include <stdatomic.h>
#include <string.h>

#include "hear_small.h"
#include "labial/clock.h"

/* What threads share is guarded by a lock that is held for the copy of a frame, never while hearing. Who hears holds a
 * flag, for which others wait by sleeping. */
#ifdef ESP_PLATFORM
#include <freertos/FreeRTOS.h>
#include <freertos/task.h>
#define SLEEP() vTaskDelay(1)
static portMUX_TYPE guard = portMUX_INITIALIZER_UNLOCKED;
#define LOCK() portENTER_CRITICAL(&guard)
#define UNLOCK() portEXIT_CRITICAL(&guard)
#else
#define SLEEP() ((void)0)
static atomic_flag guard = ATOMIC_FLAG_INIT;
#define LOCK()                                                                                                         \
    while (atomic_flag_test_and_set(&guard)) {                                                                         \
    }
#define UNLOCK() atomic_flag_clear(&guard)
#endif

#define MS 1000 /* microseconds */
#define BLOCK 80

/* Who hears: the thread that feeds, and at the end of a sound the one that shows. */
static atomic_flag hears = ATOMIC_FLAG_INIT;
static labial_hear_t hear;
static uint32_t workspace[HEAR_SMALL_WORKSPACE_SIZE / 4];

/* Shared. Hearing is ended where the sound is, and begins again with the next: from sample `base` on, frames are
 * counted from `base_frame`; those of the sound before end there. */
static struct {
    uint32_t samples_per_second; /* 0 before lips_begin() */
    uint32_t begins;             /* calls of that */
    unsigned channels;
    int64_t fed;         /* samples so far */
    uint32_t lasts;      /* the latest that were fed at once */
    uint32_t known;      /* frames so far */
    int64_t base;        /* a sample */
    uint32_t base_frame; /* and the frame that begins with it */
    int64_t before;      /* and the sample that the sound before began with, */
    uint32_t before_frame;
    labial_clock_t clock;
    int16_t frames[LIPS_FRAMES][LABIAL_CHANNELS];
} shared;

/* The thread that shows. */
static int16_t pose[LABIAL_CHANNELS]; /* the latest */
static int16_t from[LABIAL_CHANNELS]; /* and that from which it eases */
static int speaking;
static int64_t turned;             /* when that began */
static uint32_t seen;              /* begins */
static int64_t seen_fed, still_at; /* samples that were fed, and since when they are as many, */
static int is_still;               /* if they are */

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)user;
    LOCK();
    memcpy(shared.frames[frame % LIPS_FRAMES], faps, sizeof shared.frames[0]);
    shared.known = frame + 1;
    UNLOCK();
}

static void begin_hearing(void)
{
    while (atomic_flag_test_and_set(&hears))
        SLEEP();
}

int lips_begin(uint32_t samples_per_second, unsigned channels)
{
    begin_hearing();
    LOCK();
    const uint32_t begins = shared.begins;
    memset(&shared, 0, sizeof shared);
    shared.begins = begins + 1;
    UNLOCK();
    const int result =
        labial_hear_init(&hear, &hear_small, samples_per_second, channels, workspace, sizeof workspace, on_frame, NULL);
    if (result == LABIAL_OK) {
        (void)labial_hear_exact(&hear, 1); /* a frame for each 20 ms of the sound, and none that has no sound */
        LOCK();
        shared.samples_per_second = samples_per_second;
        shared.channels = channels;
        (void)labial_clock_init(&shared.clock, samples_per_second);
        UNLOCK();
    }
    atomic_flag_clear(&hears);
    return result;
}

uint64_t lips_feed(const void *samples, size_t count)
{
    const char *at = samples;
    int16_t block[2 * BLOCK];
    begin_hearing();
    LOCK();
    const unsigned channels = shared.channels;
    const int64_t first = shared.fed;
    shared.fed += channels > 0 ? (int64_t)count : 0;
    shared.lasts = (uint32_t)count;
    UNLOCK();
    while (channels > 0 && count > 0) {
        const size_t part = count < BLOCK ? count : BLOCK;
        memcpy(block, at, part * channels * sizeof *block);
        (void)labial_hear_push(&hear, block, part);
        at += part * channels * sizeof *block;
        count -= part;
    }
    atomic_flag_clear(&hears);
    return (uint64_t)first;
}

void lips_playing(uint64_t first, size_t count, int64_t now)
{
    LOCK();
    labial_clock_play(&shared.clock, (int64_t)first, (uint32_t)count, now);
    UNLOCK();
}

void lips_cancel(void)
{
    LOCK();
    labial_clock_stop(&shared.clock);
    UNLOCK();
}

/* With the lock held: the number of the frame that is heard at a time, -1 if nothing is. */
static int64_t due(int64_t now)
{
    int64_t sample;
    const int64_t lead = LIPS_LEAD * MS, silence = labial_clock_at(&shared.clock, now + lead, &sample);
    const int64_t per_frame = shared.samples_per_second / LABIAL_HEAR_FPS;
    if (silence < 0 || silence - lead > LIPS_GRACE * MS)
        return -1;
    if (sample >= shared.base)
        return shared.base_frame + (sample - shared.base) / per_frame;
    const int64_t frame = shared.before_frame + (sample > shared.before ? sample - shared.before : 0) / per_frame;
    return frame < shared.base_frame ? frame : (int64_t)shared.base_frame - 1;
}

/* With the lock held: the known frame that comes nearest to a number, or null if nothing is heard. */
static const int16_t *heard(int64_t frame)
{
    if (frame < 0 || shared.known == 0)
        return NULL;
    const int64_t newest = (int64_t)shared.known - 1, oldest = newest < LIPS_FRAMES ? 0 : newest - (LIPS_FRAMES - 1);
    return shared.frames[(uint32_t)(frame > newest ? newest : frame < oldest ? oldest : frame) % LIPS_FRAMES];
}

/* Ends hearing where the sound has ended, so that its last frames are known when they are due. */
static void end_sound(int64_t now)
{
    LOCK();
    const int64_t fed = shared.fed, per_second = shared.samples_per_second > 0 ? shared.samples_per_second : 1;
    const int64_t patience = (int64_t)shared.lasts * 1000000 / per_second;
    const int waits = fed > shared.base && due(now) >= (int64_t)shared.known;
    UNLOCK();
    if (fed != seen_fed || !is_still) { /* `now` may be older than the sound; from the next call on it is not */
        is_still = fed == seen_fed;
        seen_fed = fed;
        still_at = now;
    }
    if (!waits || now - still_at < patience + LIPS_DRY * MS || atomic_flag_test_and_set(&hears))
        return; /* or more comes just now */
    if (labial_hear_end(&hear) == LABIAL_OK && labial_hear_restart(&hear) == LABIAL_OK) {
        LOCK();
        shared.before = shared.base;
        shared.before_frame = shared.base_frame;
        shared.base = shared.fed;
        shared.base_frame = shared.known;
        UNLOCK();
    }
    atomic_flag_clear(&hears);
}

int lips_frame(int64_t now, int16_t faps[LABIAL_CHANNELS])
{
    int16_t target[LABIAL_CHANNELS] = { 0 };
    end_sound(now);
    LOCK();
    const int16_t *const frame = heard(due(now));
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
