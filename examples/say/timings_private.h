/*
 * timings_private.h - what the parts of the parser share: numbers, phonemes, and the formats' own functions.
 */
#ifndef LABIAL_EXAMPLE_TIMINGS_PRIVATE_H
#define LABIAL_EXAMPLE_TIMINGS_PRIVATE_H

#include "timings.h"

typedef char field_t[TIMINGS_FIELD_MAX + 1];

/* Sets the message. Returns TIMINGS_MALFORMED. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
int timings_malformed(timings_t *t, const char *format, ...);

/* Overlaps and gaps up to this many microseconds come from rounding. */
#define TIMINGS_TOLERANCE 1000u

/* Each reads all of `text` as a number from 0 on. Return 0 when it is none or too large. */
int timings_read_decimal(const char *text, unsigned places, uint64_t maximum, uint64_t *value);
int timings_read_seconds(const char *text, uint64_t *microseconds);
int timings_read_milliseconds(const char *text, uint64_t *microseconds);
int timings_is_whole(const char *text);

/* Whether a byte is no text: a control character but tab, CR and LF. */
int timings_is_control(unsigned char byte);

/* Any number, whose value does not matter. */
int timings_is_number(const char *text);

/* Hands on a phoneme that runs from where the latest one ended to `end`, microseconds; `label` is null for silence. */
int timings_emit(timings_t *t, const char *label, uint64_t end);

/* Hands on a phoneme with both its times, counted from the text's origin, and the silence of a gap before it. */
int timings_emit_between(timings_t *t, const char *label, uint64_t start, uint64_t end);

/* A complete marker `<laugh SECONDS [INTENSITY]>` in the first `count` fields. */
int timings_marker(timings_t *t);

/* timings_lines.c: whether labels of this format are X-SAMPA. */
int timings_is_sampa(timings_format_t format);

/* timings_lines.c: a field, and a line, of the format that `t` has or, being TIMINGS_AUTO, is told by them. */
int timings_end_field(timings_t *t);
int timings_end_line(timings_t *t);

/* timings_textgrid.c */
int timings_textgrid_put(timings_t *t, unsigned char byte);
int timings_textgrid_end(timings_t *t);

#endif
