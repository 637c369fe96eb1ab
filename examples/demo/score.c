/*
 * score.c - converts files of timings to one list of phonemes and the times of laughs.
 */
#include "demo.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common.h"
#include "timings.h"

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

int score_read(score_t *score, const char *path, const score_voice_t *voice)
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

void score_release(score_t *score)
{
    free(score->phonemes);
    free(score->laughs);
    memset(score, 0, sizeof *score);
}
