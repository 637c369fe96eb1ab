/*
 * labial-demo - a spoken sentence, a laugh, and a sentence that breaks into laughter: prints frames and phonemes as JSON,
 * which page.py writes as a page.
 *
 *     labial-demo sentence.flite laugh.lab laughing.flite > demo.json
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common.h"
#include "demo.h"
#include "labial/names.h"
#include "laughter_synthetic.h"
#include "speech_en.h"
#include "timings.h"

/* ---- Files of timings to one score ------------------------------------------------------------------------------ */

/* Time before and after the laugh in which words are spoken laughing, milliseconds. */
#define SCORE_LEAD 2000u
#define SCORE_TRAIL 900u

/* The voice of a file's phonemes. */
typedef struct {
    const labial_model_t *model;
    const labial_names_t *names;
    const char *kind; /* of the phonemes, for the page; static */
} score_voice_t;

typedef struct {
    score_t *score;
    const score_voice_t *voice;
    const char *path;
    uint64_t begin; /* of the file, milliseconds */
    timings_t timings;
} reader_t;

static int failed(const reader_t *reader, const char *why, const char *what)
{
    fprintf(stderr, "labial-demo: %s: line %lu: %s%s\n", reader->path, reader->timings.line, why, what);
    return -1;
}

/* The words pause during the laugh. It begins before the pause and fades after it, within the file. */
static int add_laugh(reader_t *reader, const timings_phoneme_t *phoneme)
{
    score_t *score = reader->score;
    score_laugh_t *laughs = grow(score->laughs, score->laugh_count, &score->laugh_room, sizeof *laughs);
    if (!laughs)
        return failed(reader, "out of memory", "");
    score->laughs = laughs;
    uint64_t earliest = reader->begin;
    if (score->laugh_count > 0 && laughs[score->laugh_count - 1].end > score->end)
        laughs[score->laugh_count - 1].end = score->end; /* the next laugh takes over at once */
    if (score->laugh_count > 0 && laughs[score->laugh_count - 1].end > earliest)
        earliest = laughs[score->laugh_count - 1].end;
    score_laugh_t *laugh = &laughs[score->laugh_count++];
    laugh->alone = score->end;
    laugh->begin = laugh->alone - earliest > SCORE_LEAD ? laugh->alone - SCORE_LEAD : earliest;
    laugh->words = laugh->alone + phoneme->milliseconds;
    laugh->end = laugh->words + SCORE_TRAIL;
    laugh->intensity = (unsigned)phoneme->laugh;
    return 0;
}

static int on_phoneme(void *user, const timings_phoneme_t *phoneme)
{
    reader_t *reader = user;
    score_t *score = reader->score;
    const score_voice_t *voice = reader->voice;
    const int speech = strcmp(voice->kind, "speech") == 0;
    int number = voice->model->silence;
    if (phoneme->laugh >= 0 && !speech)
        return failed(reader, "this file is a laugh, phoneme by phoneme, and has no others in it", "");
    if (phoneme->label)
        number = labial_find(voice->names, phoneme->label, strlen(phoneme->label));
    if (number < 0)
        return failed(reader, "unknown phoneme ", phoneme->label);
    if (phoneme->laugh >= 0 && add_laugh(reader, phoneme) != 0)
        return -1;

    score_phoneme_t *phonemes = grow(score->phonemes, score->phoneme_count, &score->phoneme_room, sizeof *phonemes);
    if (!phonemes)
        return failed(reader, "out of memory", "");
    score->phonemes = phonemes;
    score_phoneme_t *added = &phonemes[score->phoneme_count++];
    added->model = voice->model;
    added->number = (uint8_t)number;
    added->label = phoneme->laugh >= 0 ? "laugh" : voice->names->labels[number];
    added->kind = phoneme->laugh >= 0 ? "laughter" : number == voice->model->silence ? "silence" : voice->kind;
    added->begin = score->end;
    added->milliseconds = phoneme->milliseconds;
    score->end += phoneme->milliseconds;
    return 0;
}

/* Marks the phonemes from `first` on that are spoken during laughter. */
static void mark_laughing(score_t *score, size_t first)
{
    size_t l = 0;
    for (size_t i = first; i < score->phoneme_count; i++) {
        score_phoneme_t *phoneme = &score->phonemes[i];
        while (l < score->laugh_count && score->laughs[l].end <= phoneme->begin)
            l++;
        if (l < score->laugh_count && score->laughs[l].begin <= phoneme->begin && strcmp(phoneme->kind, "speech") == 0)
            phoneme->kind = "laughing";
    }
}

/* Appends the timings of a file (say/timings.h) in a voice. A laugh in a file of speech is a pause in the words, and
 * begins SCORE_LEAD before it. Returns 0, or -1 after printing the error. */
static int score_read(score_t *score, const char *path, const score_voice_t *voice)
{
    const size_t first = score->phoneme_count;
    reader_t reader = { .score = score, .voice = voice, .path = path, .begin = score->end };
    FILE *in = fopen(path, "r");
    if (!in) {
        fprintf(stderr, "labial-demo: %s: cannot open\n", path);
        return -1;
    }
    const int result = timings_read(&reader.timings, in, LABIAL_TIMINGS_AUTO, NULL, on_phoneme, &reader);
    if (result < 0)
        failed(&reader, reader.timings.message, "");
    fclose(in);
    if (result != 0)
        return -1;
    if (score->laugh_count > 0 && score->laughs[score->laugh_count - 1].end > score->end)
        score->laughs[score->laugh_count - 1].end = score->end;
    mark_laughing(score, first);
    return 0;
}

/* ---- The performance as JSON ------------------------------------------------------------------------------------- */

static void on_frame(void *user, const int16_t faps[LABIAL_CHANNELS])
{
    unsigned *count = user;
    printf((*count)++ ? ",\n[" : "[");
    for (int c = 0; c < LABIAL_CHANNELS; c++)
        printf(c ? ",%d" : "%d", faps[c]);
    putchar(']');
}

/* The number of the frame at a time in milliseconds, rounded as a stream rounds it. */
static uint32_t frame_at(uint64_t milliseconds)
{
    return (uint32_t)((milliseconds * speech_en.frames_per_second + 500u) / 1000u);
}

/* A phoneme without a frame is not on the page. Labels are those of names, which JSON has as they are. */
static void print_phonemes(const score_t *score)
{
    const char *before = "";
    for (size_t i = 0; i < score->phoneme_count; i++) {
        const score_phoneme_t *phoneme = &score->phonemes[i];
        const uint32_t start = frame_at(phoneme->begin), end = frame_at(phoneme->begin + phoneme->milliseconds);
        if (end == start)
            continue;
        printf("%s{\"label\":\"%s\",\"start_frame\":%" PRIu32 ",\"frames\":%" PRIu32 ",\"kind\":\"%s\"}", before,
               phoneme->label, start, end - start, phoneme->kind);
        before = ",\n";
    }
}

static int perform(const score_t *score)
{
    unsigned count = 0;
    printf("{\"fps\":%u,\n\"frames\":[", speech_en.frames_per_second);
    const int result = together_play(score, on_frame, &count);
    printf("],\n\"phonemes\":[");
    print_phonemes(score);
    printf("]}\n");
    if (result != LABIAL_OK)
        fprintf(stderr, "labial-demo: %s\n", labial_result_text(result));
    else if (fflush(stdout) != 0 || ferror(stdout))
        fprintf(stderr, "labial-demo: cannot write the motion\n");
    else
        return 0;
    return -1;
}

int main(int argc, char **argv)
{
    static const score_voice_t speech = { &speech_en, &speech_en_names, "speech" };
    static const score_voice_t laughter = { &laughter_synthetic, &laughter_synthetic_names, "laughter" };
    score_t score = { 0 };
    if (argc != 4) {
        fputs("usage: labial-demo sentence.flite laugh.lab laughing.flite\n", stderr);
        return 2;
    }
    const int result = score_read(&score, argv[1], &speech) != 0 || score_read(&score, argv[2], &laughter) != 0 ||
                       score_read(&score, argv[3], &speech) != 0 || perform(&score) != 0;
    free(score.phonemes);
    free(score.laughs);
    return result;
}
