/*
 * fuzz_blob.c - any bytes as a binary model. What labial_model_load() accepts must play without touching memory that is
 * not its own, and must last exactly as long as its phonemes.
 *
 * The first byte chooses: the bytes as they are; the bytes with magic, size and checksum put right, so that the checks
 * behind these are reached; or a sound model, one of the suites' or a bundled one, with some of its bytes replaced, which
 * mostly reaches the stream.
 */
#include "fixture.h"
#include "fuzz.h"
#include "labial/blob.h"
#include "laughter_synthetic.h"
#include "speech_en.h"

#define ROOM 49152
#define SOUND 5 /* models */

/* A short stream on a model that was accepted, on a workspace of exactly the size it asks for. */
static void play(const labial_model_t *model, uint32_t seed)
{
    fixture_phoneme_t input[24];
    fixture_host_t host;
    uint64_t most = (uint64_t)model->frames_per_second * 2u;
    fixture_stream(input, 24, FIXTURE_RANDOM, seed);
    for (unsigned i = 0; i < 24; i++) {
        input[i].phoneme = (uint8_t)((input[i].phoneme + seed) % model->phoneme_count);
        input[i].ms %= model->frames_per_second > 50 ? 60u : 4000u / model->frames_per_second;
    }
    REQUIRE(fixture_run(&host, model, input, 24, seed % 2 ? FIXTURE_FILL : FIXTURE_CHANCE) == 0);
    REQUIRE(fixture_is_exact(host.recorder.count, fixture_duration(input, 24), model->frames_per_second));
    REQUIRE(host.recorder.count <= most + 200);
    fixture_close(&host);
}

/* Replaces bytes of a sound model, made when it is first asked for: two of position, one of value. Returns its size. */
static size_t patch(uint8_t *out, unsigned choice, const uint8_t *data, size_t size)
{
    size_t length;
    static uint8_t made[SOUND][ROOM];
    static size_t lengths[SOUND];
    static fixture_model_t small[3];
    const labial_model_t *const models[SOUND] = { &small[0].model, &small[1].model, &small[2].model, &speech_en,
                                                  &laughter_synthetic };
    if (lengths[0] == 0) {
        fixture_plain(&small[0]);
        fixture_rich(&small[1]);
        fixture_laughter(&small[2]);
        for (unsigned i = 0; i < SOUND; i++) {
            lengths[i] = fixture_serialise(models[i], made[i], ROOM);
            REQUIRE(lengths[i] <= ROOM);
        }
    }
    length = lengths[choice % SOUND];
    memcpy(out, made[choice % SOUND], length);
    for (; size >= 3; data += 3, size -= 3)
        out[12 + (data[0] | (size_t)data[1] << 8) % (length - 12)] = data[2];
    fixture_seal(out, length);
    return length;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    labial_blob_t *blob;
    uint8_t *out, *exact;
    size_t length = size ? size - 1 : 0;
    if (size == 0 || length > ROOM)
        return 0;
    out = (uint8_t *)memory_of(ROOM);
    blob = (labial_blob_t *)memory_of(sizeof *blob);
    memset(blob, 0xee, sizeof *blob);
    if (data[0] % 4 >= 2) {
        length = patch(out, data[0] / 4u, data + 1, length);
    } else {
        memcpy(out, data + 1, length);
        if (data[0] % 4 == 1 && length >= 12) {
            memcpy(out, "LBM1", 4);
            if (length >= 14) {
                out[12] = LABIAL_MODEL_FORMAT;
                out[13] = 0;
            }
            fixture_seal(out, length);
        }
    }
    exact = (uint8_t *)copy_of(out, length);
    const int result = labial_model_load(blob, exact, length);
    REQUIRE(result == LABIAL_OK || result == LABIAL_ERROR_MODEL || result == LABIAL_ERROR_VERSION);
    if (result == LABIAL_OK) {
        REQUIRE(labial_model_check(&blob->model) == LABIAL_OK);
        play(&blob->model, data[0]);
    }
    REQUIRE(memcmp(exact, out, length) == 0);
    free(out);
    free(exact);
    free(blob);
    return 0;
}
