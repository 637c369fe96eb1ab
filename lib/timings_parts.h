/*
 * timings_parts.h - what the parts of the parser of timings share. Functions that read on return LABIAL_OK when a
 * timing is complete, in `found`, LABIAL_WAITING when none is, and LABIAL_ERROR_TIMINGS.
 */
#ifndef LABIAL_TIMINGS_PARTS_H
#define LABIAL_TIMINGS_PARTS_H

#include "labial/labial.h"
#include "labial/timings.h"

#define LABIAL_SECOND 9u      /* decimal places of a second, of which there are nanoseconds */
#define LABIAL_MILLISECOND 6u /* and of a millisecond */

/* Sets the message, in which each % stands for the next of the texts, or for 63 bytes of it. Returns
 * LABIAL_ERROR_TIMINGS. */
int labial_timings_malformed(labial_timings_t *t, const char *pattern, const char *a, const char *b, const char *c);

/* The message for a byte that is no text: a control character but tab, CR and LF. */
int labial_timings_is_control(unsigned char byte);
int labial_timings_not_text(labial_timings_t *t, unsigned char byte);

/* Writes a number; returns `text`. */
const char *labial_timings_decimal(char text[21], uint64_t value);

/* Whether `text` is `word`; in any case, where `word` is in lower case. */
int labial_timings_is(const char *text, const char *word);
int labial_timings_is_word(const char *text, const char *word);
uint32_t labial_timings_length(const char *text);

/* Reads all of `text` as a number from 0 on, in units of 1/10^places. Returns 0 when it is none or too large. */
int labial_timings_read(const char *text, unsigned places, uint64_t maximum, uint64_t *value);

/* Whether all of `text`, which is not empty, is digits; or a number, whose value does not matter. */
int labial_timings_is_whole(const char *text);
int labial_timings_is_number(const char *text);

/* A phoneme from `start` to `end`, counted from the beginning of the text; `label` is null for silence. */
int labial_timings_emit(labial_timings_t *t, char *label, uint64_t start, uint64_t end);

/* A complete marker `<laugh SECONDS [INTENSITY]>` in the first fields. */
int labial_timings_emit_marker(labial_timings_t *t);

/* timings_textgrid.c */
int labial_timings_grid_put(labial_timings_t *t, unsigned char byte);
int labial_timings_grid_end(labial_timings_t *t);

#endif
