/*
 * page.c - lists of frames and phonemes, and their JSON with the sound.
 */
#include "demo.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "grow.h"
#include "labial/faps.h"

int page_add_frame(page_t *page, const int16_t faps[LABIAL_CHANNELS])
{
    int16_t(*frames)[LABIAL_CHANNELS] = grow(page->frames, page->frame_count, &page->frame_room, sizeof *page->frames);
    if (!frames)
        return -1;
    page->frames = frames;
    memcpy(page->frames[page->frame_count++], faps, sizeof *page->frames);
    return 0;
}

int page_add_phoneme(page_t *page, const page_phoneme_t *phoneme)
{
    page_phoneme_t *phonemes = grow(page->phonemes, page->phoneme_count, &page->phoneme_room, sizeof *page->phonemes);
    if (!phonemes)
        return -1;
    page->phonemes = phonemes;
    page->phonemes[page->phoneme_count++] = *phoneme;
    return 0;
}

void page_release(page_t *page)
{
    free(page->frames);
    free(page->phonemes);
    memset(page, 0, sizeof *page);
}

/* A JSON string that is also safe within a script element, where `</` and `<!--` have a meaning. */
static void write_string(const char *text, FILE *out)
{
    putc('"', out);
    for (; *text != '\0'; text++) {
        const unsigned char byte = (unsigned char)*text;
        if (byte < 0x20 || byte == '"' || byte == '\\' || byte == '<' || byte == '>' || byte == '&')
            fprintf(out, "\\u%04x", (unsigned)byte);
        else
            putc(byte, out);
    }
    putc('"', out);
}

/* RFC 4648, section 4. */
static void write_base64(const unsigned char *bytes, size_t size, FILE *out)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        const size_t count = size - i < 3 ? size - i : 3;
        uint32_t group = 0;
        for (size_t k = 0; k < 3; k++)
            group = group << 8 | (k < count ? bytes[i + k] : 0u);
        for (size_t k = 0; k < 4; k++)
            putc(k <= count ? digits[group >> (18 - 6 * k) & 63u] : '=', out);
    }
}

static void write_data(const page_t *page, FILE *out)
{
    fputs("{\"title\":", out);
    write_string(page->title, out);
    fprintf(out, ",\"fps\":%u,\n\"channels\":[", page->frames_per_second);
    for (int i = 0; i < LABIAL_CHANNELS; i++)
        fprintf(out, "%s\"fap%d\"", i ? "," : "", labial_fap_numbers[i]);
    fputs("],\n\"phonemes\":[", out);
    for (size_t i = 0; i < page->phoneme_count; i++) {
        const page_phoneme_t *p = &page->phonemes[i];
        fputs(i ? ",\n{\"label\":" : "\n{\"label\":", out);
        write_string(p->label, out);
        fprintf(out, ",\"start_frame\":%" PRIu32 ",\"frames\":%" PRIu32 ",\"kind\":", p->start_frame, p->frames);
        write_string(p->kind, out);
        putc('}', out);
    }
    fputs("],\n\"frames\":[", out);
    for (size_t i = 0; i < page->frame_count; i++) {
        fputs(i ? ",\n[" : "\n[", out);
        for (int c = 0; c < LABIAL_CHANNELS; c++)
            fprintf(out, "%s%d", c ? "," : "", page->frames[i][c]);
        putc(']', out);
    }
    putc(']', out);
    if (page->sound) {
        fputs(",\n\"audio\":\"data:audio/flac;base64,", out);
        write_base64(page->sound, page->sound_size, out);
        putc('"', out);
    }
    putc('}', out);
}

/* The place of `part` in `text`, null unless it occurs exactly once. */
static const char *only(const char *text, const char *part)
{
    const char *place = strstr(text, part);
    return place && !strstr(place + strlen(part), part) ? place : NULL;
}

int page_write(const page_t *page, const char *template_text, FILE *out)
{
    const char *data = only(template_text, PAGE_DATA), *mouth = only(template_text, PAGE_MOUTH);
    if (!data || !mouth || mouth < data)
        return -1;
    fwrite(template_text, 1, (size_t)(data - template_text), out);
    write_data(page, out);
    data += strlen(PAGE_DATA);
    fwrite(data, 1, (size_t)(mouth - data), out);
    fputs(page->mouth, out);
    fputs(mouth + strlen(PAGE_MOUTH), out);
    return fflush(out) == 0 && !ferror(out) ? 0 : -1;
}
