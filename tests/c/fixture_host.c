/*
 * fixture_host.c - a program that plays streams, and holds the library to what its header promises on every call.
 */
#include "fixture.h"

#include <stdlib.h>
#include <string.h>

/* Ticks without a new frame and without a new phoneme after which a stream counts as stuck. */
#define STUCK 2000u

/* Remembers what went wrong first. */
static void complain(fixture_host_t *host, const char *what)
{
    if (!host->complaint)
        host->complaint = what;
}

void fixture_record(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    fixture_recorder_t *recorder = (fixture_recorder_t *)user;
    recorder->calls++;
    if (frame != recorder->next)
        recorder->misnumbered++;
    recorder->next = frame + 1;
    if (recorder->count == recorder->capacity) {
        recorder->capacity = recorder->capacity ? recorder->capacity * 2 : 256;
        recorder->frames =
            (int16_t(*)[LABIAL_CHANNELS])realloc(recorder->frames, recorder->capacity * sizeof recorder->frames[0]);
        if (!recorder->frames)
            abort();
    }
    memcpy(recorder->frames[recorder->count++], faps, sizeof recorder->frames[0]);
}

/* Bytes of the workspace, which suits the largest of the models. */
static uint32_t size_of_workspace(const fixture_host_t *host)
{
    uint32_t size = 0;
    for (unsigned i = 0; i < host->model_count; i++) {
        const uint32_t wanted = labial_workspace_size(host->models[i]);
        size = wanted > size ? wanted : size;
    }
    return size;
}

int fixture_open_again(fixture_host_t *host)
{
    host->recorder.count = host->begun = 0;
    host->recorder.next = 0;
    host->ended = host->cancelled = 0;
    host->on_way = host->current = 0;
    const int result = labial_init(host->stream, host->models[0], host->workspace, size_of_workspace(host),
                                   fixture_record, &host->recorder);
    return result == LABIAL_OK ? labial_exact(host->stream, 1) : result;
}

int fixture_open(fixture_host_t *host, const labial_model_t *const *models, unsigned model_count)
{
    memset(host, 0, sizeof *host);
    host->random.state = 0x1234567u;
    host->model_count = model_count;
    for (unsigned i = 0; i < model_count; i++)
        host->models[i] = models[i];
    const uint32_t size = size_of_workspace(host);
    host->stream = (labial_t *)fixture_room(1, sizeof *host->stream);
    host->workspace = (uint32_t *)fixture_room(size, 1);
    memset(host->stream, 0xa5, sizeof *host->stream);
    memset(host->workspace, 0x5a, size);
    return fixture_open_again(host);
}

void fixture_close(fixture_host_t *host)
{
    free(host->stream);
    free(host->workspace);
    free(host->recorder.frames);
    memset(host, 0, sizeof *host);
}

static void move(fixture_host_t *host)
{
    labial_t *place = (labial_t *)fixture_copy(host->stream, sizeof *place);
    memset(host->stream, 0xdd, sizeof *host->stream);
    free(host->stream);
    host->stream = place;
}

void fixture_end(fixture_host_t *host)
{
    if (labial_end(host->stream) != LABIAL_OK)
        complain(host, "the end was refused");
    host->ended = 1;
}

void fixture_cancel(fixture_host_t *host, uint32_t milliseconds)
{
    if (labial_cancel(host->stream, milliseconds) != LABIAL_OK)
        complain(host, "a cancel was refused");
    host->ended = host->cancelled = 1;
}

void fixture_restart(fixture_host_t *host)
{
    if (labial_restart(host->stream) != LABIAL_OK)
        complain(host, "a restart was refused");
    host->ended = host->cancelled = 0;
    host->begun = host->recorder.count;
    host->on_way = 0;
}

/* What a tick may say when it delivers nothing; `room` is that before the tick. */
static void check_silent(fixture_host_t *host, int result, unsigned room)
{
    const int begun = host->recorder.count > host->begun;
    if (result == LABIAL_DONE && !host->ended)
        complain(host, "done before the end");
    if (result != LABIAL_DONE && (result == LABIAL_WAITING) == begun)
        complain(host, "WAITING is for the first frame, STARVED for every other");
    if (result == LABIAL_STARVED && host->ended)
        complain(host, "starves after the end");
    if (result == LABIAL_STARVED && room == 0)
        complain(host, "starves with a full queue");
    if (result == LABIAL_WAITING && (host->ended || room == 0) &&
        ++host->on_way > LABIAL_DELAY((unsigned)host->models[0]->search_stride))
        complain(host, "the first frame takes longer than the delay");
}

int fixture_tick(fixture_host_t *host)
{
    if (host->moving)
        move(host);
    const labial_latency_t before = labial_latency(host->stream);
    const unsigned room = labial_room(host->stream);
    host->recorder.calls = 0;
    const int result = labial_tick(host->stream);
    const labial_latency_t after = labial_latency(host->stream);
    if (result < LABIAL_OK || result > LABIAL_DONE) {
        complain(host, "a tick returned an error or an unknown result");
        return result;
    }
    host->seen[result]++;
    if (host->recorder.calls != (result == LABIAL_OK ? 1u : 0u))
        complain(host, "the callback was not called exactly once per LABIAL_OK");
    if (host->recorder.misnumbered)
        complain(host, "frame numbers are not consecutive");
    if (after.frames != before.frames - (result == LABIAL_OK && !host->cancelled ? 1u : 0u))
        complain(host, "the latency is not what was pushed and not delivered");
    if (after.delay != LABIAL_DELAY((unsigned)host->models[0]->search_stride))
        complain(host, "the delay is not that of the stride");
    if ((result == LABIAL_DONE) != (host->ended && before.frames == 0) && !host->cancelled)
        complain(host, "done before the last frame, or not after it");
    if (result != LABIAL_OK)
        check_silent(host, result, room);
    return result;
}

int fixture_push(fixture_host_t *host, const fixture_phoneme_t *phoneme)
{
    const unsigned room = labial_room(host->stream);
    int result;
    if (phoneme->model != host->current) {
        result = labial_use(host->stream, host->models[phoneme->model]);
        if (result != LABIAL_OK)
            return result;
        host->current = phoneme->model;
    }
    result = labial_push(host->stream, phoneme->phoneme, phoneme->ms);
    if (result == LABIAL_ERROR_FULL && room > 0)
        complain(host, "the queue is full although labial_room() saw room");
    return result;
}

/* Pushes what may be pushed now; returns how many. */
static size_t feed_some(fixture_host_t *host, const fixture_phoneme_t *input, size_t count, fixture_feed_t feed,
                        int last)
{
    size_t most = count, pushed = 0;
    if (feed == FIXTURE_SINGLE)
        most = 1;
    else if (feed == FIXTURE_HUNGRY)
        most = last == LABIAL_WAITING || last == LABIAL_STARVED ? 1 : 0;
    else if (feed == FIXTURE_CHANCE)
        most = fixture_below(&host->random, 3) ? 0 : fixture_below(&host->random, LABIAL_QUEUE + 1);
    while (pushed < count && pushed < most && labial_room(host->stream) > 0) {
        const int result = fixture_push(host, &input[pushed]);
        if (result == LABIAL_ERROR_MODELS)
            break;
        if (result != LABIAL_OK) {
            complain(host, "a proper push was refused");
            break;
        }
        pushed++;
    }
    return pushed;
}

int fixture_play(fixture_host_t *host, const fixture_phoneme_t *input, size_t count, fixture_feed_t feed)
{
    size_t i = 0;
    unsigned stuck = 0;
    int result = LABIAL_WAITING;
    while (!host->complaint) {
        const size_t pushed = feed_some(host, input + i, count - i, feed, result);
        i += pushed;
        if (i == count && !host->ended)
            fixture_end(host);
        result = fixture_tick(host);
        if (result == LABIAL_DONE)
            break;
        stuck = pushed || result == LABIAL_OK ? 0 : stuck + 1;
        if (stuck > STUCK)
            complain(host, "no progress");
    }
    if (host->complaint)
        return -1;
    const labial_latency_t left = labial_latency(host->stream);
    if (left.frames || left.milliseconds || left.phonemes)
        complain(host, "latency is not zero when the stream is done");
    if (fixture_tick(host) != LABIAL_DONE)
        complain(host, "done is not for good");
    return host->complaint ? -1 : 0;
}

int fixture_play_told(fixture_host_t *host, const fixture_phoneme_t *input, size_t count, const uint8_t *told,
                      size_t room)
{
    size_t next = 0;
    for (size_t t = 0; t < room; t++) {
        while (next < count && labial_room(host->stream) > 0 && fixture_push(host, &input[next]) == LABIAL_OK)
            next++;
        if (next == count && !host->ended)
            fixture_end(host);
        if ((t == 0 || told[t] != told[t - 1] || t % 7 == 0) && labial_articulation(host->stream, told[t]) != LABIAL_OK)
            complain(host, "an articulation is refused");
        const int result = fixture_tick(host);
        if (result == LABIAL_STARVED)
            complain(host, "a full queue starves");
        if (result == LABIAL_DONE || host->complaint)
            return host->complaint ? -1 : 0;
    }
    complain(host, "there are more frames than were told of");
    return -1;
}

int fixture_run(fixture_host_t *host, const labial_model_t *model, const fixture_phoneme_t *input, size_t count,
                fixture_feed_t feed)
{
    if (fixture_open(host, &model, 1) != LABIAL_OK) {
        complain(host, "labial_init() refused the model");
        return -1;
    }
    return fixture_play(host, input, count, feed);
}

long fixture_difference(const fixture_recorder_t *a, const fixture_recorder_t *b)
{
    size_t i;
    for (i = 0; i < a->count && i < b->count; i++)
        if (memcmp(a->frames[i], b->frames[i], sizeof a->frames[i]) != 0)
            return (long)i;
    return a->count == b->count ? -1 : (long)i;
}
