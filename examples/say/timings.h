/*
 * timings.h - phoneme timings as text, parsed byte by byte as they arrive.
 *
 *   flite     `flite -psdur`: `pau:0.220 hh:0.295 ...`, where each phoneme *ends*, in seconds. A line is one utterance,
 *             its times start from 0 again and it follows the line before.
 *   lab       `start end label [apex [word]]` per line, seconds. A gap is silence, an overlap an error.
 *   htk       `start end label ...` per line, whole units of 100 ns, as HTK and HTS write them. Of a label with
 *             context, `a^b-c+d=e@...`, the phoneme is what stands between - and +.
 *   pho       MBROLA: `label milliseconds [position pitch]...` per line. `;` starts a comment, `#` alone is the flush
 *             mark and ignored, `_` is silence, as is eSpeak's `_:`.
 *   mary      MaryTTS's REALISED_DURATIONS: `end number label` per line, seconds, where each phoneme ends; lines that
 *             start with # are comments, and one of them comes first.
 *   phseg     CMU Sphinx: the header `SFrm EFrm SegAScr Phone`, rows of that, frames of 10 ms, `Total score: ...`.
 *   textgrid  Praat's TextGrid, long or short, UTF-8 or UTF-16, as of the Montreal Forced Aligner. The tier is the one
 *             asked for; else the first called phones, phonemes, phone or phoneme, also after `speaker - `; else the
 *             first interval tier, which is kept until the end of the file to know that there is no better one.
 *
 * Laughs are written in two ways. `<laugh SECONDS [INTENSITY]>` on a line of its own, or between flite's phonemes,
 * laughs there and makes all that follows later (not in phseg and textgrid, which are files of aligners). The label
 * `<laugh>` or `<laugh:INTENSITY>` in the place of a phoneme's, in every format, laughs for the time that the row gives
 * it. Intensity is 0 to 1, 0.5 without it.
 *
 * Numbers, fields and lines have one grammar, that of export/labial/grammar.py; tests/grammar holds both to the same
 * cases. A line ends with LF; blanks, tabs and CRs separate fields; a number is
 * [-](digits[.[digits]]|.digits)[(e|E)[+|-]digits].
 *
 * The parser of the line formats holds no more than five fields of a line, so that a line may be as long as it likes
 * and each phoneme is reported with the byte that completes it: the blank behind a flite token, the end of a line
 * otherwise. Times are integer microseconds; phoneme boundaries, not durations, are rounded to milliseconds, so that
 * sums stay exact. Gaps and overlaps up to a millisecond come from rounding and are closed.
 */
#ifndef LABIAL_EXAMPLE_TIMINGS_H
#define LABIAL_EXAMPLE_TIMINGS_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Longest field (label with context, number or word) and longest label, in bytes. */
#define TIMINGS_FIELD_MAX 511
#define TIMINGS_LABEL_MAX 63

/* Latest time that is believed: 1,000,000 seconds, in microseconds. */
#define TIMINGS_TIME_MAX 1000000000000u

/* Longest phoneme or gap that is believed: one hour, in milliseconds. */
#define TIMINGS_DURATION_MAX 3600000u

/* The highest intensity of a laugh. */
#define TIMINGS_LAUGH_FULL 256

typedef enum {
    TIMINGS_AUTO, /* decide on the first line */
    TIMINGS_FLITE,
    TIMINGS_LAB,
    TIMINGS_HTK,
    TIMINGS_PHO,
    TIMINGS_MARY,
    TIMINGS_PHSEG,
    TIMINGS_TEXTGRID
} timings_format_t;

/* The name of a format, by its number in timings_format_t; null beyond the last. */
const char *timings_format_name(unsigned format);

/* Writes what --help says of every format. */
void timings_help(FILE *out);

/* A phoneme whose end is known. */
typedef struct {
    const char *label;     /* as written, ends with NUL, valid during the call; null for silence and for a laugh */
    uint32_t milliseconds; /* duration, at most TIMINGS_DURATION_MAX; 0 when it rounds to that */
    int laugh;             /* the intensity of a laugh, 0 .. TIMINGS_LAUGH_FULL; -1 when it is none */
    int sampa;             /* 1 where labels are X-SAMPA by the format */
} timings_phoneme_t;

/* Takes a phoneme. Returns 0, or another value to stop parsing, which timings_put() and timings_end() then return. */
typedef int (*timings_sink_t)(void *user, const timings_phoneme_t *phoneme);

/* What timings_put() and timings_end() return when the text is malformed; `message` says how. Sinks must not use it. */
#define TIMINGS_MALFORMED (-1000)

/* What a TextGrid needs beside the fields of a line. Private. */
typedef struct {
    int lexer, expected;       /* states, of timings_textgrid.c */
    int wanted;                /* what becomes of the current tier */
    int found;                 /* the tier of phonemes was met */
    int truncated;             /* the text was longer than a field and is not whole */
    uint64_t tiers, intervals; /* still to come */
    uint64_t start, stop;      /* of the interval, microseconds */
    char *kept;                /* intervals of the first tier: records of their times, line and label; owned */
    size_t kept_size, kept_room;
} timings_textgrid_t;

/* The parser's state. Read `line` and `message`; the rest is private. */
typedef struct {
    unsigned long line; /* being parsed, from 1; after an error the one that is wrong */
    char message[200];

    timings_format_t format;
    timings_sink_t sink;
    void *user;
    const char *tier;                      /* of a TextGrid; null for the rule above */
    char fields[5][TIMINGS_FIELD_MAX + 1]; /* the first four of the line, then the latest */
    size_t length;                         /* of the field being read */
    unsigned count;                        /* fields of the line that are complete */
    int comment;                           /* within a comment, which runs to the end of the line */
    int marker;                            /* between `<laugh` and `>` */
    int heading;                           /* mary: a line of # was seen; phseg: 1 the header, 2 the total */
    int encoding;                          /* of timings.c */
    unsigned pending[3];                   /* bytes and units whose meaning depends on the next ones */
    unsigned pending_count;
    uint64_t origin; /* what the times of the text count from, microseconds */
    uint64_t end;    /* where the latest phoneme ends, microseconds */
    timings_textgrid_t grid;
} timings_t;

/* Prepares a parser of `format` that hands its phonemes to `sink`. `tier` names the tier of a TextGrid and stays the
 * caller's; null without. timings_free() releases what the parser comes to own. */
void timings_init(timings_t *timings, timings_format_t format, const char *tier, timings_sink_t sink, void *user);

/* Takes the next byte of the text. Returns 0, TIMINGS_MALFORMED or what the sink returned; after either of the latter
 * two the parser must not be used on. */
int timings_put(timings_t *timings, unsigned char byte);

/* Says that the text has ended; its last line need not end with a line feed. Returns as timings_put() does. */
int timings_end(timings_t *timings);

/* Releases memory, whether the text has ended or not. */
void timings_free(timings_t *timings);

#endif
