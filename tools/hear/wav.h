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

/* Bytes that tell a WAV file. */
#define WAV_HEAD 12u

/* What is read stands first; the rest is private. */
typedef struct {
    uint32_t rate;     /* samples per second, as the file says */
    unsigned channels; /* likewise */
    char message[128]; /* of the latest error */
    uint32_t place;    /* bytes of the file before its samples; 0 where they came without a header */
    uint32_t size;     /* bytes of samples that the header promises, */
    uint32_t cut;      /* and those of them that were missing at the file's end */
    FILE *in;
    unsigned char head[WAV_HEAD]; /* the first bytes; those of samples without a header are the first samples */
    unsigned first, last;         /* which of them are still to be read: from `first` on, before `last` */
    unsigned encoding, bytes;     /* of a sample of one channel */
    uint32_t left;                /* bytes of samples that are still to come */
    int endless;                  /* they come until the file ends */
    uint32_t riff;                /* bytes of the file, as it says */
} wav_t;

/* Reads as far as the first sample. `in` stays the caller's; where it has no header it is taken for samples, low byte
 * first, to its end, of `rate` and `channels`, unless `rate` is 0. Returns 0, or -1 with `message`. */
int wav_open(wav_t *wav, FILE *in, uint32_t rate, unsigned channels);

/*
 * Reads at most `count` samples, of two channels as many pairs. Returns how many it read, fewer only at the end, where
 * a part of a sample is dropped; or -1 with `message` if the file has a sample that is not finite, or cannot be read.
 * A file may end before its samples do: `cut`. Samples of more bits are cut to 16, floating point is rounded; 1 is
 * full scale.
 */
long wav_read(wav_t *wav, int16_t *samples, size_t count);

/* Seconds of so many bytes of samples. */
double wav_seconds(const wav_t *wav, uint32_t bytes);

#endif
