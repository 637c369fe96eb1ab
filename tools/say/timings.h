/*
 * timings.h - a stream of timings (labial/timings.h) as phonemes that follow each other, as it arrives. The text may
 * also be UTF-16 with a byte order mark, which is how Praat writes labels that are not ASCII.
 */
#ifndef LABIAL_TIMINGS_STREAM_H
#define LABIAL_TIMINGS_STREAM_H

#include <stdio.h>

#include "labial/timings.h"

/* A phoneme whose end is known. Boundaries, not durations, are rounded to milliseconds, so that sums stay exact. */
typedef struct {
    const char *label;     /* as written, valid during the call; null for silence and for a laugh */
    uint32_t milliseconds; /* at most LABIAL_DURATION_MAX; 0 when it rounds to that */
    int laugh;             /* the intensity of a laugh, 0 .. LABIAL_LAUGH_FULL; -1 when it is none */
    int xsampa;            /* 1 where labels are X-SAMPA by the format */
} timings_phoneme_t;

/* Takes a phoneme. Returns 0, or another value, which ends the reading, after it printed why. */
typedef int (*timings_sink_t)(void *user, const timings_phoneme_t *phoneme);

/* Read `line` and `message`; the rest is private. */
typedef struct {
    unsigned long line; /* of the phoneme, or that is wrong; 0 where that is the whole text */
    const char *message;
    char said[LABIAL_TIMINGS_LABEL_MAX + 32]; /* the message where it is not the parser's */
    labial_timings_t parser;
    timings_sink_t sink;
    void *user;
    uint64_t end; /* of the latest phoneme, nanoseconds */
    unsigned encoding, first, pair;
    unsigned more, low, high; /* bytes that a character of UTF-8 still has, and within what the next one is */
    int found;                /* whether there was a phoneme or a laugh */
    char *kept;               /* the text as UTF-8, as long as it may have to be read again */
    size_t size, room;
} timings_t;

/*
 * Reads all of `in` and hands its phonemes to `sink`. `tier` names the tier of a TextGrid; null without.
 *
 * Returns 0; -1 where the text is malformed, has no timings or cannot be read, which `message` says; 1 where `sink` ended the reading.
 */
int timings_read(timings_t *timings, FILE *in, labial_timings_format_t format, const char *tier, timings_sink_t sink,
                 void *user);

#endif
