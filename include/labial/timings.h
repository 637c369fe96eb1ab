/*
 * labial/timings.h - phoneme timings as text, as aligners and synthesisers write them. Optional: a program whose
 * phonemes come as numbers links nothing of it.
 *
 *   flite     `flite -psdur`: `pau:0.220 hh:0.295 ...`, where each phoneme *ends*, in seconds. A line is one utterance,
 *             its times start from 0 again and it follows the line before.
 *   lab       `start end label [apex [word]]` per line, seconds. A line that starts with # is a comment. HTK
 *             files also end in .lab; the first label's end time tells them apart.
 *   htk       `start end label ...` per line, whole units of 100 ns, as HTK and HTS write them. Of a label with
 *             context, `a^b-c+d=e@...`, the phoneme is what stands between - and +.
 *   pho       MBROLA: `label milliseconds [position pitch]...` per line. `;` starts a comment, `#` alone is the flush
 *             mark and ignored, `_` is silence, as is eSpeak's `_:`.
 *   mary      MaryTTS's REALISED_DURATIONS: `end number label` per line, seconds, where each phoneme ends; lines that
 *             start with # are comments, and one of # alone comes first.
 *   phseg     CMU Sphinx: the header `SFrm EFrm SegAScr Phone`, rows of that, frames of 10 ms, `Total score: ...`.
 *   textgrid  Praat's TextGrid, long or short, as of the Montreal Forced Aligner. The tier is the one asked for; else
 *             the first called phones, phonemes, segments, one of these without s, or MAU (WebMAUS's), in any case,
 *             also after `speaker - `; else the first interval tier.
 *
 * Laughs are written in two ways. `<laugh SECONDS [INTENSITY]>` on a line of its own, or between flite's phonemes,
 * laughs there and makes all that follows later (not in phseg and textgrid, which are files of aligners). The label
 * `<laugh>` or `<laugh:INTENSITY>` in the place of a phoneme's, in every format, laughs for the time that the row gives
 * it. Intensity is 0 to 1, 0.5 without it.
 *
 * The text is UTF-8 and has no control characters but tab, CR and LF. A line ends with LF; blanks, tabs and CRs
 * separate fields; a number is [-](digits[.[digits]]|.digits)[(e|E)[+|-]digits]. tests/grammar/cases.tsv has examples
 * of it all.
 *
 * The parser holds no more than five fields of a line, so that a line may be as long as it likes and each phoneme is
 * known with the byte that completes it: the blank behind a flite token, the end of a line otherwise. Times are whole
 * nanoseconds. Overlaps and gaps up to a millisecond come from rounding; a larger gap is silence, a larger overlap an
 * error.
 */
#ifndef LABIAL_TIMINGS_H
#define LABIAL_TIMINGS_H

#include <stddef.h>
#include <stdint.h>

#include "labial/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The formats; AUTO looks at the first line that is no comment. Their names, in this order, are
 * labial_timings_format_name()'s. */
typedef enum {
    LABIAL_TIMINGS_AUTO,
    LABIAL_TIMINGS_FLITE,
    LABIAL_TIMINGS_LAB,
    LABIAL_TIMINGS_HTK,
    LABIAL_TIMINGS_PHO,
    LABIAL_TIMINGS_MARY,
    LABIAL_TIMINGS_PHSEG,
    LABIAL_TIMINGS_TEXTGRID
} labial_timings_format_t;

/* A parser; its members are private. Its structure may be moved or copied between calls. */
typedef struct labial_timings labial_timings_t;

/* A phoneme, a silence or a laugh in time, below. */
typedef struct labial_timing labial_timing_t;

/* ---- Calls ------------------------------------------------------------------------------------------------------- */

/* Prepares a parser. Returns LABIAL_OK, LABIAL_ERROR_NULL, or LABIAL_ERROR_RANGE for a format that is none, with a
 * parser for LABIAL_TIMINGS_AUTO. */
int labial_timings_init(labial_timings_t *timings, labial_timings_format_t format);

/*
 * Asks for a tier of a TextGrid, before the first byte: by its name, which must stay where it is, or by its number
 * among the interval tiers, from 1, of which the text must have as many. Null and 0 mean the rule above.
 *
 * Returns LABIAL_OK, or LABIAL_ERROR_NULL for a null parser.
 */
int labial_timings_tier(labial_timings_t *timings, const char *name, uint32_t number);

/*
 * Reads bytes of the text, up to the one that completes a timing: `*used` of the `size` bytes.
 *
 * Returns LABIAL_OK when `timing` holds one, LABIAL_WAITING when it has read all bytes and there is none, and
 * LABIAL_ERROR_TIMINGS, then and ever after, when the text is malformed; LABIAL_ERROR_NULL.
 */
int labial_timings_next(labial_timings_t *timings, const char *text, size_t size, size_t *used,
                        labial_timing_t *timing);

/*
 * Ends the text, whose last line need not end with a line feed. Call it until it returns something other than
 * LABIAL_OK; each LABIAL_OK fills `timing`.
 *
 * Returns LABIAL_DONE at the end; LABIAL_STARVED where the whole text must be given once more, because the first tier
 * of a TextGrid is read only when there is no better one; and errors as labial_timings_next() does.
 */
int labial_timings_end(labial_timings_t *timings, labial_timing_t *timing);

/* The format, which LABIAL_TIMINGS_AUTO becomes when it is known. LABIAL_TIMINGS_AUTO for a null parser. */
labial_timings_format_t labial_timings_format(const labial_timings_t *timings);

/* The line that is being parsed, from 1; after an error the one that is wrong. 0 for a null parser. */
uint32_t labial_timings_line(const labial_timings_t *timings);

/* What is wrong, one line that is valid until the parser is prepared anew; "" before an error. */
const char *labial_timings_message(const labial_timings_t *timings);

/* The name of a format, what there is to say of it in a line, and how the names of its files end, in lower case, where
 * that tells it; null beyond the last. */
const char *labial_timings_format_name(unsigned format);
const char *labial_timings_format_help(unsigned format);
const char *labial_timings_format_suffix(unsigned format);

/* ---- Timings ----------------------------------------------------------------------------------------------------- */

/* Longest field (label with context, number or word) and longest label, in bytes. */
#define LABIAL_TIMINGS_FIELD_MAX 511
#define LABIAL_TIMINGS_LABEL_MAX 63

/* Latest time that is believed: 1,000,000 seconds, in nanoseconds. */
#define LABIAL_TIMINGS_TIME_MAX 1000000000000000u

/* Overlaps and gaps up to this many nanoseconds come from rounding. */
#define LABIAL_TIMINGS_TOLERANCE 1000000u

/* A phoneme, a silence or a laugh in time. Texts end with NUL and are valid until the parser's next call. */
struct labial_timing {
    uint64_t start,
        end;           /* nanoseconds from the text's beginning; a start may be before the end of the one before it, by
                            LABIAL_TIMINGS_TOLERANCE at most, and every end is at the start or behind it */
    uint64_t apex;     /* when the sound is loudest, within start and end but for the tolerance; of lab alone */
    const char *label; /* as written; null for silence and for a laugh between phonemes */
    const char *word;  /* of lab alone, else null */
    uint32_t line;     /* on which it stands, from 1 */
    int16_t laugh;     /* the intensity of a laugh, 0 .. LABIAL_LAUGH_FULL (labial/laugh.h); -1 when it is none */
    uint8_t has_apex;  /* 1 where `apex` was given */
    uint8_t xsampa;    /* 1 where labels are X-SAMPA by the format */
};

/* ---- Private ----------------------------------------------------------------------------------------------------- */

/* What a TextGrid needs beside the fields of a line. */
struct labial_timings_grid {
    uint8_t lexer, expected;   /* states */
    uint8_t wanted;            /* what becomes of the current tier */
    uint8_t cut;               /* the latest text was longer than a field */
    uint8_t found, again;      /* the tier was met; it is the first one, which takes a second reading */
    uint32_t number;           /* of the current interval tier, from 1 */
    uint32_t tiers, intervals; /* still to come */
    uint64_t start, end;       /* of the interval */
};

struct labial_timings {
    uint32_t line;           /* being parsed, from 1; after an error the one that is wrong */
    char message[256];       /* what is wrong, one line; empty before an error */
    const char *tier;        /* the name of the tier that is asked for, or null */
    uint32_t tier_number;    /* or its number, or 0 */
    uint8_t format;          /* labial_timings_format_t */
    uint8_t mark;            /* bytes of a byte order mark that were read */
    uint8_t comment, marker; /* within a comment; between `<laugh` and `>` */
    uint8_t heading;         /* mary: a line of # alone was seen; phseg: 1 the header, 2 the total */
    uint8_t rows;            /* 1 after the first row of lab */
    uint32_t count;          /* fields of the line that are complete */
    uint32_t length;         /* of the field being read */
    uint64_t origin;         /* what the times of the text count from */
    uint64_t end;            /* where the latest phoneme ends */
    labial_timing_t found;
    struct labial_timings_grid grid;
    char fields[5][LABIAL_TIMINGS_FIELD_MAX + 1]; /* the first four of the line, then the latest */
};

#ifdef __cplusplus
}
#endif

#endif
