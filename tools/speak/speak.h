/*
 * speak.h - shared code of the programs with a speech synthesiser: options, the sound file, and motion of the length of
 * the sound.
 *
 * Sound and phonemes may come in any order and in any pieces: sound is appended to a WAV file, a phoneme is given by
 * its end. At the end the shorter of the two is filled up with silence.
 */
#ifndef LABIAL_EXAMPLE_SPEAK_H
#define LABIAL_EXAMPLE_SPEAK_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "mouth.h"

typedef struct {
    const char *program; /* for messages */
    const char *sound;   /* path of the WAV file */
    const char *voice;   /* null when none was asked for */
    char *text;          /* owned: release with free() */
    unsigned to;         /* one of the formats of frames.h */
} speak_options_t;

/* Private. */
typedef struct {
    mouth_t mouth;
    const char *program, *path;
    FILE *sound;
    unsigned rate;
    uint64_t samples; /* of the sound so far */
    uint64_t said;    /* where the latest phoneme ends, milliseconds */
    labial_labels_t labels;
} speak_t;

/* Reads the command line: `[--to FORMAT] [--voice NAME] SOUND.wav TEXT`, where the text `-` is standard input. Returns
 * 0, or the exit status plus 1 after --help or an error, which it prints. `usage` is what --help prints. */
int speak_options(int argc, char **argv, const char *program, const char *usage, speak_options_t *options);

/* Opens the sound file, of one channel and 16 bits, and prepares the mouth for phonemes of the set `labels`. Returns 0,
 * or -1 after the error was printed. */
int speak_begin(speak_t *speak, const speak_options_t *options, unsigned samples_per_second, labial_labels_t labels);

/* Appends sound. Returns like speak_begin(). */
int speak_sound(speak_t *speak, const short *samples, size_t count);

/* The current end of the sound, in milliseconds. */
uint64_t speak_time(const speak_t *speak);

/* Adds a phoneme that ends `end` milliseconds from the beginning of the sound; an end before that of the previous
 * phoneme counts as that. Returns like speak_begin(). */
int speak_phoneme(speak_t *speak, const char *label, uint64_t end);

/* Fills up, writes the remainder and closes; only closes unless `complete`. Returns like speak_begin(). */
int speak_end(speak_t *speak, int complete);

#endif
