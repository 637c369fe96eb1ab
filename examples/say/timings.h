/*
 * timings.h - phoneme timings as text, parsed byte by byte as they arrive.
 *
 *   flite  `flite -psdur`: `pau:0.220 hh:0.295 ...`, where each phoneme *ends*, in seconds. A line is one utterance,
 *          its times start from 0 again and it follows the line before.
 *   lab    `start end label [apex [word]]` per line, seconds. A gap is silence, an overlap an error.
 *   pho    MBROLA: `label milliseconds [position pitch]...` per line. `;` starts a comment, `#` alone is the flush mark
 *          and ignored, `_` is silence, as is eSpeak's `_:`.
 *
 * The parser holds no more than four fields of a line, so that a line may be as long as it likes and each phoneme is
 * reported with the byte that completes it: the blank behind a flite token, the end of a line otherwise. Times are
 * integer microseconds; phoneme boundaries, not durations, are rounded to milliseconds, so that sums stay exact.
 */
#ifndef LABIAL_EXAMPLE_TIMINGS_H
#define LABIAL_EXAMPLE_TIMINGS_H

#include <stddef.h>
#include <stdint.h>

/* Longest field (label, number or word), in bytes. */
#define TIMINGS_FIELD_MAX 63

/* Latest time that is believed: 1,000,000 seconds, in microseconds. A file in HTK's unit of 100 ns runs into it. */
#define TIMINGS_TIME_MAX 1000000000000u

/* Longest phoneme or gap that is believed: one hour, in milliseconds. */
#define TIMINGS_DURATION_MAX 3600000u

typedef enum {
    TIMINGS_AUTO, /* decide on the first line */
    TIMINGS_FLITE,
    TIMINGS_LAB,
    TIMINGS_PHO
} timings_format_t;

/* A phoneme whose end is known. */
typedef struct {
    const char *label;     /* as written, ends with NUL, valid during the call; null for a gap or pho's `_`: silence */
    uint32_t milliseconds; /* duration, at most TIMINGS_DURATION_MAX; 0 when it rounds to that */
} timings_phoneme_t;

/* Takes a phoneme. Returns 0, or another value to stop parsing, which timings_put() and timings_end() then return. */
typedef int (*timings_sink_t)(void *user, const timings_phoneme_t *phoneme);

/* What timings_put() and timings_end() return when the text is malformed; `message` says how. Sinks must not use it. */
#define TIMINGS_MALFORMED (-1000)

/* The parser's state. Read `line` and `message`; the rest is private. */
typedef struct {
    unsigned long line; /* being parsed, from 1; after an error the one that is wrong */
    char message[160];

    timings_format_t format;
    timings_sink_t sink;
    void *user;
    char fields[4][TIMINGS_FIELD_MAX + 1]; /* the first three of the line, then the latest */
    size_t length;                         /* of the field being read */
    unsigned count;                        /* fields of the line that are complete */
    int comment;                           /* within a comment, which runs to the end of the line */
    uint64_t line_start;                   /* flite: where the utterance starts, microseconds */
    uint64_t end;                          /* where the latest phoneme ends, microseconds */
} timings_t;

/* Prepares a parser of `format` that hands its phonemes to `sink`. */
void timings_init(timings_t *timings, timings_format_t format, timings_sink_t sink, void *user);

/* Takes the next byte of the text. Returns 0, TIMINGS_MALFORMED or what the sink returned; after either of the latter
 * two the parser must not be used on. */
int timings_put(timings_t *timings, unsigned char byte);

/* Says that the text has ended; its last line need not end with a line feed. Returns as timings_put() does. */
int timings_end(timings_t *timings);

#endif
