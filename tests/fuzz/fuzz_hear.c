/*
 * fuzz_hear.c - any bytes as sound at any rate, and as calls between blocks in any order: nothing may be written beside
 * the stream or the workspace, frames are numbered without gaps, and as many as the sound has, whatever its blocks.
 */
#include "fuzz.h"
#include "hear_fixture.h"
#include "labial/hear.h"

/* Numbers of frames, and where the next stretch of a class begins. */
typedef struct {
    uint32_t frames, stretch;
} told_t;

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    told_t *told = (told_t *)user;
    (void)faps;
    REQUIRE(frame == told->frames++);
}

static void on_class(void *user, unsigned shown, uint32_t frame, uint32_t frames)
{
    told_t *told = (told_t *)user;
    REQUIRE(shown < HEAR_FIXTURE_CLASSES && frames > 0 && frame >= told->stretch && frame + frames <= told->frames);
    told->stretch = frame + frames;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const uint32_t rates[] = { 8000, 12000, 16000, 22050, 24000, 32000, 44100, 48000 };
    told_t told = { 0, 0 };
    labial_hear_t *hear = (labial_hear_t *)memory_of(sizeof *hear);
    void *workspace = memory_of(HEAR_FIXTURE_WORKSPACE_SIZE);
    input_t input = { data, size };
    const unsigned head = number(&input, 1);
    const uint32_t rate = rates[head & 7u], channels = 1u + (head >> 3 & 1u);
    const int exact = (head & 16u) != 0;
    uint32_t heard = 0, before = 0;
    int result, ended = 0;
    memset(hear, 0xa5, sizeof *hear);
    memset(workspace, 0x5a, HEAR_FIXTURE_WORKSPACE_SIZE);
    result =
        labial_hear_init(hear, &hear_fixture, rate, channels, workspace, HEAR_FIXTURE_WORKSPACE_SIZE, on_frame, &told);
    REQUIRE(result == LABIAL_OK && labial_hear_classes(hear, on_class) == LABIAL_OK);
    REQUIRE(labial_hear_exact(hear, exact) == LABIAL_OK);
    while (input.left >= 2) {
        /* A call, and for a push how many bytes: they are heard as often as the call's upper bits say. */
        const unsigned first = number(&input, 1), call = first & 7u, again = first >> 3;
        size_t bytes = number(&input, 1);
        if (call == 5u) {
            const uint32_t frames = (uint32_t)(((uint64_t)heard * 50u + rate - 1u) / rate);
            const uint32_t left = labial_hear_latency(hear).frames;
            REQUIRE(ended || told.frames - before + left <= frames);
            REQUIRE(labial_hear_end(hear) == LABIAL_OK && labial_hear_latency(hear).frames == 0);
            /* Frames of 20 ms, also in part, none lost; and the way to rest. */
            REQUIRE(ended || told.frames - before == frames ||
                    (!exact && told.frames - before == frames + LABIAL_EASE_FRAMES));
            REQUIRE(labial_hear_articulation(hear, (unsigned)bytes) == LABIAL_OK);
            ended = 1;
        } else if (call == 6u) {
            REQUIRE(labial_hear_cancel(hear, (uint32_t)bytes * 5u) == LABIAL_OK);
            ended = 1;
        } else if (call == 7u) {
            REQUIRE(labial_hear_restart(hear) == (ended ? LABIAL_OK : LABIAL_ERROR_STATE));
            if (ended && labial_hear_set_level(hear, (unsigned)bytes * 64u) == LABIAL_OK)
                REQUIRE(labial_hear_level(hear) == bytes * 64u);
            REQUIRE(labial_hear_level(hear) >= LABIAL_HEAR_LEVEL_MIN &&
                    labial_hear_level(hear) <= LABIAL_HEAR_LEVEL_MAX);
            heard = ended ? 0 : heard;
            before = ended ? told.frames : before;
            ended = 0;
        } else {
            int16_t *samples;
            const size_t pair = 2u * channels;
            bytes = (bytes < input.left ? bytes : input.left) / pair * pair;
            samples = (int16_t *)copy_of(input.at, bytes);
            for (unsigned i = 0; i <= again; i++) {
                REQUIRE(labial_hear_push(hear, samples, bytes / pair) == (ended ? LABIAL_ERROR_STATE : LABIAL_OK));
                heard += ended ? 0 : (uint32_t)(bytes / pair);
            }
            free(samples);
            input.at += bytes;
            input.left -= bytes;
        }
    }
    free(workspace);
    free(hear);
    return 0;
}
