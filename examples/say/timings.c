/*
 * timings.c - bytes to characters of UTF-8, characters to fields and lines.
 */
#include "timings.h"

#include <stdlib.h>
#include <string.h>

#include "timings_private.h"

/* What the first bytes told. UTF-16 is how Praat writes labels that are not ASCII. */
enum { ENCODING_UNKNOWN, ENCODING_UTF8, ENCODING_UTF16_LE, ENCODING_UTF16_BE };

void timings_init(timings_t *timings, timings_format_t format, const char *tier, timings_sink_t sink, void *user)
{
    memset(timings, 0, sizeof *timings);
    timings->line = 1;
    timings->format = format;
    timings->tier = tier;
    timings->sink = sink;
    timings->user = user;
}

void timings_free(timings_t *t)
{
    free(t->grid.kept);
    t->grid.kept = NULL;
    t->grid.kept_size = 0;
    t->grid.kept_room = 0;
}

/* ---- Characters to fields and lines ---------------------------------------------------------------------------- */

/* Passes the first field, by which the format was told, and what stood behind it on to the other parser. */
static int continue_as_textgrid(timings_t *t, unsigned char byte)
{
    field_t first;
    int result = 0;
    memcpy(first, t->fields[0], sizeof first);
    t->count = 0;
    for (const char *c = first; result == 0 && *c; c++)
        result = timings_textgrid_put(t, (unsigned char)*c);
    return result == 0 ? timings_textgrid_put(t, byte) : result;
}

static int put_character(timings_t *t, unsigned char byte)
{
    int result = 0;
    if (t->format == TIMINGS_TEXTGRID)
        return timings_textgrid_put(t, byte);
    if (byte == '\n') {
        result = timings_end_field(t);
        if (result == 0 && t->format == TIMINGS_TEXTGRID)
            return continue_as_textgrid(t, byte);
        if (result == 0)
            result = timings_end_line(t);
        if (result == 0)
            t->line++;
        return result;
    }
    if (timings_is_control(byte))
        return timings_malformed(t, "byte 0x%02x is not text", (unsigned)byte);
    if (t->comment)
        return 0;
    if (byte == ' ' || byte == '\t' || byte == '\r') {
        result = timings_end_field(t);
        return result == 0 && t->format == TIMINGS_TEXTGRID ? continue_as_textgrid(t, byte) : result;
    }
    if (byte == ';' && t->length == 0 && (t->format == TIMINGS_PHO || (t->format == TIMINGS_AUTO && t->count == 0))) {
        t->format = TIMINGS_PHO;
        t->comment = 1;
        return 0;
    }
    if (t->length == TIMINGS_FIELD_MAX)
        return timings_malformed(t, "a field is longer than %d bytes", TIMINGS_FIELD_MAX);
    t->fields[t->count < 4 ? t->count : 4][t->length++] = (char)byte;
    return 0;
}

/* ---- Bytes to characters --------------------------------------------------------------------------------------- */

static int put_code_point(timings_t *t, uint32_t c)
{
    unsigned char bytes[4];
    unsigned count;
    if (c < 0x80u) {
        bytes[0] = (unsigned char)c;
        count = 1;
    } else if (c < 0x800u) {
        bytes[0] = (unsigned char)(0xc0u | c >> 6);
        count = 2;
    } else if (c < 0x10000u) {
        bytes[0] = (unsigned char)(0xe0u | c >> 12);
        count = 3;
    } else {
        bytes[0] = (unsigned char)(0xf0u | c >> 18);
        count = 4;
    }
    for (unsigned i = 1; i < count; i++)
        bytes[i] = (unsigned char)(0x80u | (c >> 6 * (count - 1u - i) & 0x3fu));
    int result = 0;
    for (unsigned i = 0; result == 0 && i < count; i++)
        result = put_character(t, bytes[i]);
    return result;
}

/* pending[0]: the first byte of a unit; pending[1]: the first unit of a pair, 0 without. */
static int put_utf16(timings_t *t, unsigned char byte)
{
    if (t->pending_count == 0) {
        t->pending[0] = byte;
        t->pending_count = 1;
        return 0;
    }
    t->pending_count = 0;
    const unsigned first = t->pending[0];
    const unsigned unit = t->encoding == ENCODING_UTF16_LE ? (unsigned)byte << 8 | first : first << 8 | byte;
    const unsigned high = t->pending[1];
    const int is_low = unit >= 0xdc00u && unit <= 0xdfffu;
    if ((high != 0) != is_low)
        return timings_malformed(t, "half a UTF-16 pair");
    if (unit >= 0xd800u && unit <= 0xdbffu) {
        t->pending[1] = unit;
        return 0;
    }
    t->pending[1] = 0;
    return put_code_point(t, high ? 0x10000u + ((high - 0xd800u) << 10) + (unit - 0xdc00u) : unit);
}

/* Passes on the bytes that were held back to see whether they are a byte order mark. */
static int put_pending(timings_t *t)
{
    int result = 0;
    const unsigned count = t->pending_count;
    t->pending_count = 0;
    t->encoding = ENCODING_UTF8;
    for (unsigned i = 0; result == 0 && i < count; i++)
        result = put_character(t, (unsigned char)t->pending[i]);
    return result;
}

int timings_put(timings_t *t, unsigned char byte)
{
    if (t->encoding == ENCODING_UTF8)
        return put_character(t, byte);
    if (t->encoding != ENCODING_UNKNOWN)
        return put_utf16(t, byte);
    t->pending[t->pending_count++] = byte;
    const unsigned a = t->pending[0], b = t->pending[1];
    if (t->pending_count == 1)
        return a == 0xffu || a == 0xfeu || a == 0xefu ? 0 : put_pending(t);
    if (t->pending_count == 2 && a != 0xefu) {
        if ((a ^ b) != 0x01u)
            return put_pending(t);
        t->encoding = a == 0xffu ? ENCODING_UTF16_LE : ENCODING_UTF16_BE;
        t->pending[1] = 0;
        t->pending_count = 0;
        return 0;
    }
    if (t->pending_count == 2)
        return b == 0xbbu ? 0 : put_pending(t);
    if (byte != 0xbfu)
        return put_pending(t);
    t->encoding = ENCODING_UTF8;
    t->pending_count = 0;
    return 0;
}

int timings_end(timings_t *t)
{
    int result = 0;
    if (t->encoding == ENCODING_UNKNOWN)
        result = put_pending(t);
    else if (t->encoding != ENCODING_UTF8 && (t->pending_count != 0 || t->pending[1] != 0))
        return timings_malformed(t, "the text ends within a character of UTF-16");
    if (result == 0 && t->format != TIMINGS_TEXTGRID)
        result = timings_end_field(t);
    if (result == 0 && t->format == TIMINGS_TEXTGRID)
        return t->count > 0 ? timings_malformed(t, "the TextGrid ends within its header") : timings_textgrid_end(t);
    return result != 0 ? result : timings_end_line(t);
}
