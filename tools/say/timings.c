/*
 * timings.c - bytes to UTF-8, timings to phonemes.
 */
#include "timings.h"

#include <stdlib.h>
#include <string.h>

#include "common.h"
#include "labial/labial.h"

/* What the first two bytes told. */
enum { ENCODING_UNKNOWN, ENCODING_UTF8, ENCODING_UTF16_LE, ENCODING_UTF16_BE };

#define NO_BYTE 0x100u

static int malformed(timings_t *t, const char *message)
{
    t->line = labial_timings_line(&t->parser);
    t->message = message;
    return -1;
}

/* ---- Timings to phonemes --------------------------------------------------------------------------------------- */

static int hand_on(timings_t *t, const labial_timing_t *timing, const char *label, int laugh, uint64_t end)
{
    const uint64_t milliseconds = (end + 500000u) / 1000000u - (t->end + 500000u) / 1000000u;
    const timings_phoneme_t phoneme = { laugh < 0 ? label : NULL, (uint32_t)milliseconds, laugh, timing->xsampa };
    t->line = timing->line;
    if (milliseconds > LABIAL_DURATION_MAX) {
        (void)snprintf(t->said, sizeof t->said, "'%s' is longer than an hour",
                       label       ? label
                       : laugh < 0 ? "silence"
                                   : "laugh");
        t->message = t->said;
        return -1;
    }
    t->end = end;
    return t->sink(t->user, &phoneme) != 0;
}

static int take(timings_t *t, const labial_timing_t *timing)
{
    int result = 0;
    t->found = 1;
    if (timing->start > t->end + LABIAL_TIMINGS_TOLERANCE)
        result = hand_on(t, timing, NULL, -1, timing->start);
    if (result == 0)
        result = hand_on(t, timing, timing->label, timing->laugh, timing->end > t->end ? timing->end : t->end);
    return result;
}

static int parse(timings_t *t, const char *text, size_t size)
{
    labial_timing_t timing;
    int result = 0;
    while (result == 0 && size > 0) {
        size_t used = 0;
        const int found = labial_timings_next(&t->parser, text, size, &used, &timing);
        text += used;
        size -= used;
        if (found == LABIAL_OK)
            result = take(t, &timing);
        else if (found < 0)
            result = malformed(t, labial_timings_message(&t->parser));
    }
    return result;
}

/* ---- Bytes to UTF-8 -------------------------------------------------------------------------------------------- */

static int put(timings_t *t, unsigned byte)
{
    const char text = (char)byte;
    const labial_timings_format_t format = labial_timings_format(&t->parser);
    if (format == LABIAL_TIMINGS_AUTO || format == LABIAL_TIMINGS_TEXTGRID) {
        char *kept = grow(t->kept, t->size, &t->room, 1);
        if (!kept)
            return malformed(t, "there is not enough memory for the text");
        t->kept = kept;
        kept[t->size++] = text;
    }
    return parse(t, &text, 1);
}

static int not_utf8(timings_t *t)
{
    return malformed(t, "not UTF-8 text");
}

/* Refuses what is no character: bytes of other encodings, longer forms than needed, surrogates, beyond U+10FFFF. */
static int put_utf8(timings_t *t, unsigned byte)
{
    if (t->more > 0 && (byte < t->low || byte > t->high))
        return not_utf8(t);
    if (t->more > 0) {
        t->more--;
        t->low = 0x80u;
        t->high = 0xbfu;
    } else if (byte >= 0x80u) {
        if (byte < 0xc2u || byte > 0xf4u)
            return not_utf8(t);
        t->more = byte < 0xe0u ? 1 : byte < 0xf0u ? 2 : 3;
        t->low = byte == 0xe0u ? 0xa0u : byte == 0xf0u ? 0x90u : 0x80u;
        t->high = byte == 0xedu ? 0x9fu : byte == 0xf4u ? 0x8fu : 0xbfu;
    }
    return put(t, byte);
}

static int put_code_point(timings_t *t, unsigned c)
{
    const unsigned more = c < 0x80u ? 0 : c < 0x800u ? 1 : c < 0x10000u ? 2 : 3;
    int result = put(t, more == 0 ? c : (0xff00u >> (more + 1u) & 0xffu) | c >> 6u * more);
    for (unsigned i = more; result == 0 && i > 0; i--)
        result = put(t, 0x80u | (c >> 6u * (i - 1u) & 0x3fu));
    return result;
}

/* `first` is the first byte of a unit; `pair` the first unit of a pair, 0 without. */
static int put_utf16(timings_t *t, unsigned byte)
{
    if (t->first == NO_BYTE) {
        t->first = byte;
        return 0;
    }
    const unsigned unit = t->encoding == ENCODING_UTF16_LE ? byte << 8 | t->first : t->first << 8 | byte;
    const unsigned high = t->pair;
    t->first = NO_BYTE;
    t->pair = 0;
    if ((high != 0) != (unit >= 0xdc00u && unit <= 0xdfffu))
        return malformed(t, "half a UTF-16 pair");
    if (unit >= 0xd800u && unit <= 0xdbffu) {
        t->pair = unit;
        return 0;
    }
    return put_code_point(t, high ? 0x10000u + ((high - 0xd800u) << 10) + (unit - 0xdc00u) : unit);
}

static int put_byte(timings_t *t, unsigned byte)
{
    if (t->encoding == ENCODING_UTF8)
        return put_utf8(t, byte);
    if (t->encoding != ENCODING_UNKNOWN)
        return put_utf16(t, byte);
    if (t->first == NO_BYTE && (byte == 0xffu || byte == 0xfeu)) {
        t->first = byte;
        return 0;
    }
    const unsigned first = t->first;
    t->first = NO_BYTE;
    t->encoding = first == NO_BYTE || (first ^ byte) != 1u ? ENCODING_UTF8
                  : first == 0xffu                         ? ENCODING_UTF16_LE
                                                           : ENCODING_UTF16_BE;
    if (t->encoding != ENCODING_UTF8)
        return 0;
    return first == NO_BYTE ? put_utf8(t, byte) : not_utf8(t); /* no text begins with 0xfe or 0xff */
}

/* ---- The whole text -------------------------------------------------------------------------------------------- */

static int finish(timings_t *t)
{
    labial_timing_t timing;
    int found = LABIAL_STARVED, result = 0;
    if ((t->encoding == ENCODING_UNKNOWN && t->first != NO_BYTE) || t->more != 0)
        return not_utf8(t);
    if (t->first != NO_BYTE || t->pair != 0)
        return malformed(t, "the text ends within a character of UTF-16");
    while (result == 0 && (found = labial_timings_end(&t->parser, &timing)) != LABIAL_DONE) {
        if (found == LABIAL_OK)
            result = take(t, &timing);
        else
            result = found < 0 ? malformed(t, labial_timings_message(&t->parser)) : parse(t, t->kept, t->size);
    }
    if (result != 0 || t->found)
        return result;
    t->line = 0;
    t->message = "no segments";
    return -1;
}

int timings_read(timings_t *t, FILE *in, labial_timings_format_t format, const char *tier, timings_sink_t sink,
                 void *user)
{
    int byte, result = 0;
    memset(t, 0, sizeof *t);
    t->line = 1;
    t->sink = sink;
    t->user = user;
    t->first = NO_BYTE;
    labial_timings_init(&t->parser, format);
    (void)labial_timings_tier(&t->parser, tier, 0);
    while (result == 0 && (byte = getc(in)) != EOF)
        result = put_byte(t, (unsigned)byte);
    if (result == 0)
        result = ferror(in) ? malformed(t, "cannot read the timings") : finish(t);
    free(t->kept);
    return result;
}
