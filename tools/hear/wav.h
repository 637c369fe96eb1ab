/*
 * wav.h - a WAV file, read from its begin to its end, so that it may also be a pipe: PCM of 8, 16, 24 and 32 bits,
 * floating point of 32 and 64, A-law and mu-law.
 *
 * Files are not trusted. Sizes in them are believed only as far as the file has the bytes.
 */
#ifndef LABIAL_HEAR_WAV_H
#define LABIAL_HEAR_WAV_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* A sample of a file as 16 bits; `wrong` is set where it is no number. */
typedef int16_t (*wav_sample_fn)(const unsigned char *at, int *wrong);

/* Bytes that tell a WAV file. */
#define WAV_HEAD 12u

/* Read `rate`, `channels` and `message`; the rest is private. */
typedef struct {
    uint32_t rate;     /* samples per second, as the file says */
    unsigned channels; /* likewise */
    char message[128]; /* of the latest error */
    FILE *in;
    unsigned char head[WAV_HEAD]; /* the first bytes; those of samples without a header are the first samples */
    unsigned first, last;         /* which of them are still to be read: from `first` on, before `last` */
    unsigned bytes;               /* of a sample of one channel */
    wav_sample_fn sample;
    uint32_t left;        /* bytes of samples that are still to come */
    int endless;          /* they come until the file ends */
    uint32_t size;        /* bytes of samples that the header promises */
    uint32_t cut;         /* those of them that were missing at the file's end */
    uint32_t riff, place; /* bytes of the file, as it says, and before its samples; 0 of samples without a header */
} wav_t;

/* Reads as far as the first sample. `in` stays the caller's. Returns 0, or -1 with `message`. */
int wav_open(wav_t *wav, FILE *in);

/* Reads the file's header or, where it has none, takes `in` for samples, low byte first, to its end; `rate` and
 * `channels` are those of such samples. Returns as wav_open() does. */
int wav_open_or_raw(wav_t *wav, FILE *in, uint32_t rate, unsigned channels);

/*
 * Reads at most `count` samples, of two channels as many pairs. Returns how many it read, fewer only at the end, where
 * a part of a sample is dropped; or -1 with `message` if the file has a sample that is not finite, or cannot be read.
 * A file may end before its samples do: wav_missing(). Samples of more bits are cut to 16, floating point is rounded; 1 is
 * full scale.
 */
long wav_read(wav_t *wav, int16_t *samples, size_t count);

/* Whether the samples came with a header. */
int wav_has_header(const wav_t *wav);

/* After the last sample: seconds of sound that the header promised, and how many of them were not in the file. */
double wav_promised(const wav_t *wav);
double wav_missing(const wav_t *wav);

#endif
