/*
 * threads.c - two threads on one stream: one pushes, asks and changes the articulation, the other ticks. The mutex does
 * not nest and reports it; the frames are those of the same phonemes in one thread. ThreadSanitizer finds any access
 * without the lock: gcc -fsanitize=thread.
 */
#define _POSIX_C_SOURCE 200809L
#include <pthread.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>

#include "labial/labial.h"
#include "speech_en.h"

#define ROUNDS 8u
#define PHONEMES 600u

static pthread_mutex_t mutex;
static labial_t stream;
static uint32_t workspace[SPEECH_EN_WORKSPACE_SIZE / 4];
static uint32_t frames, sum;
static int push_failed, tick_failed;

static void require(int condition, const char *what)
{
    if (condition)
        return;
    fprintf(stderr, "%s\n", what);
    exit(1);
}

void labial_lock(const labial_t *locked)
{
    (void)locked;
    require(pthread_mutex_lock(&mutex) == 0, "the lock nests");
}

void labial_unlock(const labial_t *locked)
{
    (void)locked;
    require(pthread_mutex_unlock(&mutex) == 0, "the lock is not held");
}

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    unsigned k;
    (void)user;
    tick_failed |= frame != frames++;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        sum = sum * 31u + (uint16_t)faps[k];
}

static void *tick(void *unused)
{
    int result;
    do
        result = labial_tick(&stream);
    while (result >= 0 && result != LABIAL_DONE);
    tick_failed |= result < 0;
    return unused;
}

static void push_all(int ticks_too)
{
    uint32_t i;
    for (i = 0; i < PHONEMES; i++) {
        while (labial_room(&stream) == 0)
            if (ticks_too)
                labial_tick(&stream);
            else
                sched_yield();
        push_failed |= labial_push(&stream, i * 7u % speech_en.phoneme_count, 10u + i % 40u) != LABIAL_OK;
        push_failed |=
            labial_articulation(&stream, 100) != LABIAL_OK || labial_latency(&stream).phonemes > LABIAL_QUEUE;
    }
    push_failed |= labial_end(&stream) != LABIAL_OK;
}

int main(void)
{
    pthread_mutexattr_t kind;
    pthread_t ticking;
    uint32_t round, expected = 0, expected_sum = 0;
    require(pthread_mutexattr_init(&kind) == 0 && pthread_mutexattr_settype(&kind, PTHREAD_MUTEX_ERRORCHECK) == 0 &&
                pthread_mutex_init(&mutex, &kind) == 0,
            "no mutex");
    for (round = 0; round <= ROUNDS; round++) {
        frames = sum = 0;
        require(labial_init(&stream, &speech_en, workspace, sizeof workspace, on_frame, NULL) == LABIAL_OK,
                "no stream");
        require(labial_exact(&stream, 1) == LABIAL_OK, "no exact frames"); /* how often it starves is chance */
        if (round > 0)
            require(pthread_create(&ticking, NULL, tick, NULL) == 0, "no thread");
        push_all(round == 0);
        if (round > 0) {
            require(pthread_join(ticking, NULL) == 0, "no thread");
            require(frames == expected, "frames are missing or too many");
            require(sum == expected_sum, "frames differ");
        } else {
            tick(NULL);
            expected = frames;
            expected_sum = sum;
        }
        require(!push_failed && !tick_failed, "a call failed");
    }
    printf("%u times %u frames\n", (unsigned)ROUNDS, (unsigned)expected);
    return 0;
}
