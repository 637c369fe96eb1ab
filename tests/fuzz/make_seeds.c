/*
 * make_seeds.c - what the fuzz targets begin with, as their bytes: the conformance streams, the bundled models, a rig
 * with the frames of a sentence, packets of lips, words, and all labels that are known. The seeds of fuzz_timings are
 * files of seeds/.
 *
 *     make_seeds FOLDER espeak.tsv     writes FOLDER/fuzz_stream/NAME and so on; the folders are there already
 */
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "fixture.h"
#include "fuzz.h"
#include "labial/beside.h"
#include "labial/rig.h"
#include "player.h"

/* The calls of fuzz_stream.c, and its first byte for a stream on the bundled models. */
enum { BUNDLED = 2, PUSH_LONG = 4, PUSH_ANY = 5 | 1 << 4, TICKS = 9, USE = 12, END = 13 | 128, CANCEL = 14 | 224 };
enum { RESTART = 15, ARTICULATION = 14 | 1 << 4 }; /* the articulation in two bytes */

#define RATE 50u          /* frames per second of the bundled models */
#define PLAYED_OUT 160u   /* ticks after which nothing of a part of a stream is left */
#define TICKS_MOST 1000u  /* pauses of an hour are played in part */
#define NAMES_LONGEST 64u /* bytes of a seed: fuzz_names_longest */
#define BLOB_ROOM 45056u  /* fuzz_blob_longest */
#define OUTPUTS 4         /* of the rig */
#define FRAMES 24u        /* that the rig is given */
#define COUNT(array) (sizeof(array) / sizeof *(array))

static const char *folder;

static FILE *create(const char *target, const char *name)
{
    char path[1024];
    const int length = snprintf(path, sizeof path, "%s/%s/%s", folder, target, name);
    FILE *file = length > 0 && (size_t)length < sizeof path ? fopen(path, "wb") : NULL;
    if (!file) {
        perror(path);
        exit(1);
    }
    return file;
}

static void finish(FILE *file)
{
    REQUIRE(!ferror(file) && fclose(file) == 0);
}

static void put(FILE *file, uint32_t value, unsigned bytes)
{
    while (bytes-- > 0)
        putc((int)(value >> 8 * bytes & 0xffu), file);
}

static void put_ticks(FILE *file, uint32_t count)
{
    count = count < TICKS_MOST ? count : TICKS_MOST;
    for (; count > 0; count -= count < 255u ? count : 255u)
        put(file, TICKS << 8 | (count < 255u ? count : 255u), 2);
}

/* A push with as many ticks as it has frames, a cancel with a few, and after the last step of a part all that remain. */
static void put_step(FILE *file, const conformance_step_t *step, int is_last)
{
    if (step->kind == CONFORMANCE_PUSH) {
        const int is_long = step->milliseconds >= 65536u;
        put(file, USE | (uint32_t)step->model << 4, 1);
        put(file, is_long ? PUSH_ANY : PUSH_LONG, 1);
        put(file, step->value, 1);
        put(file, step->milliseconds, is_long ? 4 : 2);
        put_ticks(file, step->milliseconds / (1000u / RATE));
        return;
    }
    if (step->kind != CONFORMANCE_END) {
        put(file, CANCEL, 1);
        put(file, step->milliseconds, 3);
        put_ticks(file, 3);
    }
    if (is_last || step[1].kind != CONFORMANCE_AGAIN) {
        put(file, END, 1);
        put_ticks(file, PLAYED_OUT);
        put(file, RESTART, 1);
    }
}

static void make_streams(void)
{
    for (unsigned i = 0; i < conformance_stream_count; i++) {
        const conformance_stream_t *stream = &conformance_streams[i];
        const conformance_step_t *change = NULL; /* the part's next one of the articulation */
        FILE *file = create("fuzz_stream", stream->name);
        put(file, BUNDLED, 1);
        for (unsigned k = 0; k < stream->step_count; k++) {
            const conformance_step_t *step = &stream->steps[k];
            if (step->kind == CONFORMANCE_ARTICULATION) {
                change = change ? change : step;
                continue;
            }
            if (step->kind != CONFORMANCE_PUSH) {
                change = NULL;
            } else if (change) { /* one before each push, whatever its frame */
                put(file, ARTICULATION << 16 | change->milliseconds, 3);
                change = change[1].kind == CONFORMANCE_ARTICULATION ? change + 1 : NULL;
            }
            put_step(file, step, k + 1u == stream->step_count);
        }
        finish(file);
    }
}

/* The bundled models as they are, and each sound model of fuzz_blob.c without a change. */
static void make_blobs(void)
{
    static const labial_model_t *const models[] = { &speech_en, &laughter_synthetic };
    static uint8_t blob[BLOB_ROOM];
    char name[16];
    for (unsigned i = 0; i < COUNT(models) + 5u; i++) {
        FILE *file;
        snprintf(name, sizeof name, "model_%u", i);
        file = create("fuzz_blob", name);
        if (i < COUNT(models)) {
            const size_t size = fixture_serialise(models[i], blob, sizeof blob);
            REQUIRE(size < sizeof blob);
            put(file, 0, 1);
            fwrite(blob, 1, size, file);
        } else {
            put(file, 2u + 4u * (i - (unsigned)COUNT(models)), 1);
        }
        finish(file);
    }
}

static void put_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    if (frame < FRAMES)
        fwrite(faps, sizeof *faps, LABIAL_CHANNELS, (FILE *)user);
}

/* An output that is within its ranges: every second one has a slew limit, the last one a deadband; the last two say where
 * they are closed, and have a limit of acceleration. */
static void put_output(FILE *file, int i)
{
    labial_rig_output_t output = { 0 };
    output.weights[i] = 4096;
    output.invert = (uint8_t)(i % 2);
    output.contact = (uint8_t)(i / 2);
    output.gain = 13430;
    output.neutral = 300;
    output.minimum = 260;
    output.maximum = 380;
    output.slew = 25 * (i % 2);
    output.closed = 320 * (i / 2);
    output.deadband = i == 3 ? 3 : 0;
    output.acceleration = i > 1 ? 8 : 0;
    fwrite(&output, offsetof(labial_rig_output_t, curve), 1, file);
}

static const labial_rig_curve_t curve = { 2, { { 260, 260, 1 << 19 }, { 320, 290, 3 << 19 } } };

/* The frames of the first stream, a sentence, as `put_one` writes them; the file ends with them. */
static void put_sentence(FILE *file, labial_frame_fn put_one)
{
    static uint32_t workspace[CONFORMANCE_WORKSPACE / 4u];
    static labial_t stream;
    REQUIRE(!conformance_play(&conformance_streams[0], CONFORMANCE_FILL, &stream, workspace, sizeof workspace, put_one,
                              file));
    finish(file);
}

static void put_face_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    put((FILE *)user, frame % 7u == 6u ? 1 + frame % 6u : 15, 1);
    put_frame(user, frame, faps);
}

/* A face of three of these outputs, the frames of the first stream, and another call after each six of them. */
static void make_face(void)
{
    static const uint8_t curved_sound_ahead_rate[] = { 4, 15, 5, 49 };
    FILE *file = create("fuzz_face", "sentence");
    for (int i = 1; i < OUTPUTS; i++)
        put_output(file, i);
    fwrite(&curve, sizeof curve, 1, file);
    fwrite(curved_sound_ahead_rate, sizeof curved_sound_ahead_rate, 1, file);
    put_sentence(file, put_face_frame);
}

/* Outputs that are within their ranges, two with a slew limit, one with a deadband, two that say where they are closed,
 * two with a limit of acceleration, a curve for two; then the frames of the first stream, a sentence. */
static void make_rig(void)
{
    static const int32_t values[OUTPUTS] = { 300, 300, 300, 300 }, changes[OUTPUTS] = { 0, 0, 0, 0 };
    static const int16_t visemes[LABIAL_VISEMES] = { 0, 40, -40, 300 };
    static const uint8_t shares[LABIAL_VISEMES] = { 20, 0, 8, 100 };
    static const uint8_t curved_and_sound[] = { 6, 31, 0 };
    FILE *file = create("fuzz_rig", "sentence");
    for (int i = 0; i < OUTPUTS; i++)
        put_output(file, i);
    fwrite(&curve, sizeof curve, 1, file);
    fwrite(values, sizeof values, 1, file);
    fwrite(changes, sizeof changes, 1, file);
    fwrite(visemes, sizeof visemes, 1, file);
    fwrite(shares, sizeof shares, 1, file);
    fwrite(curved_and_sound, sizeof curved_and_sound, 1, file);
    put_sentence(file, put_frame);
}

/* Adds a label, ended by a byte that no UTF-8 has, to the present seed, or to the next one where that is full. */
static void add_label(FILE **file, const char *label, size_t length)
{
    static size_t size = NAMES_LONGEST;
    static unsigned count;
    char name[16];
    if (size + length + 1u > NAMES_LONGEST) {
        if (*file)
            finish(*file);
        snprintf(name, sizeof name, "labels_%02u", count++);
        *file = create("fuzz_names", name);
        size = 0;
    }
    fwrite(label, 1, length, *file);
    putc(0xff, *file);
    size += length + 1u;
}

/* A sound at each rate of fuzz_hear.c: a wave with noise, pushed in blocks, some of them again, ended and restarted. */
static void make_sounds(void)
{
    char name[16];
    for (unsigned rate = 0; rate < 8u; rate++) {
        uint32_t state = rate;
        FILE *file;
        snprintf(name, sizeof name, "sound_%u", rate);
        file = create("fuzz_hear", name);
        put(file, rate | (rate & 1u) << 3, 1);
        for (unsigned block = 0; block < 12u; block++) {
            put(file, block << 3, 1);
            put(file, 160, 1);
            for (unsigned i = 0; i < 80u; i++) {
                state = state * 1664525u + 1013904223u;
                put(file, (i * (block + 1u) * 900u + (state >> 20)) & 0xffffu, 2);
            }
            if (block % 4u == 3u) {
                put(file, block == 7u ? 6 : 5, 1);
                put(file, 20, 1);
                put(file, 7, 2);
            }
        }
        finish(file);
    }
}

/* Words as fuzz_words.c reads them: a sentence, numbers and what is read like them, the ends of characters. */
static void make_words(void)
{
    static const struct {
        const char *name, *bytes;
        size_t size;
    } seeds[] = {
#define SEED(name, bytes) { name, bytes, sizeof bytes - 1u }
        SEED("sentence", "\000\006\012(\001Hello,\006<2\001world!\010<2\000[laughs]\002Z\036\000go"),
        SEED("numbers", "\360\014\000Z\0011,234,567.89\004Z\036\00022nd\005\036\036\000U.S.A\004\036\036\002e.g."
                        "\011\036\036\000iPhone&TV\003\036\310\001007"),
        SEED("characters", "\020\011\012<\002strengths\006<2\005na\303\257ve\014<2\001"
                           "\320\237\321\200\320\270\320\262\320\265\321\202"),
    };
    for (unsigned i = 0; i < COUNT(seeds); i++) {
        FILE *file = create("fuzz_words", seeds[i].name);
        fwrite(seeds[i].bytes, 1, seeds[i].size, file);
        finish(file);
    }
}

/* The labels of espeak-ng's voices, which are the first column of a table, and all that the bundled models know. */
static void make_labels(const char *table)
{
    static const labial_names_t *const names[] = { &speech_en_names, &laughter_synthetic_names };
    FILE *labels = fopen(table, "rb"), *file = NULL;
    char line[256];
    REQUIRE(labels && fgets(line, sizeof line, labels));
    while (fgets(line, sizeof line, labels))
        add_label(&file, line, strcspn(line, "\t"));
    REQUIRE(!ferror(labels) && fclose(labels) == 0);
    for (unsigned i = 0; i < COUNT(names); i++)
        for (unsigned k = 0; k < names[i]->size; k += 2u + names[i]->entries[k + 1] % 32u)
            add_label(&file, (const char *)&names[i]->entries[k + 2], names[i]->entries[k + 1] % 32u);
    finish(file);
}

/* Packets of ten frames each of a player with two outputs and 64 frames, and the samples that are heard meanwhile; the
 * last packet cancels. */
static void make_packets(void)
{
    FILE *file = create("fuzz_beside", "sentence");
    put(file, 2u << 16 | 64u << 8 | 24u, 3); /* 24,217 samples per second */
    for (uint32_t frame = 0; frame < 60; frame += 10) {
        put(file, 0x012000u, 3); /* mended, of 32 bytes */
        put(file, (uint32_t)LABIAL_BESIDE_FORMAT << 24 | (frame == 50u ? 1u << 16 : 0u) | 2u << 8 | 10u, 4);
        put(file, frame << 24, 4); /* low byte first */
        put(file, frame < 40u ? 1u : 2u, 2);
        for (uint32_t i = 0; i < 22; i++)
            put(file, frame * i, 1);
        for (uint32_t i = 0; i < 10; i++) {
            const uint32_t sample = (frame + i) * 485u;
            putc(2, file);
            (void)fwrite(&sample, sizeof sample, 1, file);
        }
    }
    finish(file);
}

/* Words of a voice, in messages of each way to count times, and the clock. */
static void make_messages(void)
{
    FILE *file = create("fuzz_voice", "words");
    put(file, 40, 1);
    for (uint32_t k = 0; k < 12; k++) {
        put(file, 4u << 16 | (3u + 6u * (k % 3u)) << 8 | 1u, 3); /* a message of a word */
        put(file, 5u << 16 | k / 3u << 8 | 7u * k, 3);           /* of five letters, and when it begins */
        put(file, 1u << 8 | 100u, 2);                            /* 300 ms long */
        put(file, (uint32_t)('h' << 16 | 'e' << 8 | 'l'), 3);
        put(file, (uint32_t)('l' << 8 | 'o'), 2);
        put(file, 20, 2); /* 200 ms are heard */
    }
    finish(file);
}

int main(int argc, char **argv)
{
    REQUIRE(argc == 3);
    folder = argv[1];
    make_streams();
    make_blobs();
    make_rig();
    make_face();
    make_packets();
    make_messages();
    make_sounds();
    make_words();
    make_labels(argv[2]);
    return 0;
}
