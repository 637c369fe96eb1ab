/*
 * page.h - writes motion and its phonemes as a page that plays them.
 */
#ifndef LABIAL_EXAMPLE_PAGE_H
#define LABIAL_EXAMPLE_PAGE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "labial/model.h"

/* Placeholders of the template for the data and the drawing's module, each once and in this order. */
#define PAGE_DATA "@LABIAL_DATA@"
#define PAGE_MOUTH "@LABIAL_MOUTH@"

/* A phoneme's place among the frames. */
typedef struct {
    const char *label; /* static */
    const char *kind;  /* "speech", "laughing" (spoken while laughing), "laughter" or "silence"; static */
    uint32_t start_frame;
    uint32_t frames;
} page_phoneme_t;

/* What a page plays. Zero-initialise, fill with the two functions below, release with page_release(). */
typedef struct {
    const char *title;
    const char *mouth;          /* mouth.js, whole */
    const unsigned char *sound; /* a FLAC file whose time 0 is the first frame, or null */
    size_t sound_size;
    unsigned frames_per_second;
    int16_t (*frames)[LABIAL_CHANNELS];
    size_t frame_count, frame_room;
    page_phoneme_t *phonemes;
    size_t phoneme_count, phoneme_room;
} page_t;

/* Append a copy of a frame or a phoneme. Return 0, or -1 when out of memory. */
int page_add_frame(page_t *page, const int16_t faps[LABIAL_CHANNELS]);
int page_add_phoneme(page_t *page, const page_phoneme_t *phoneme);

/* Writes `template_text` to `out`, with PAGE_DATA replaced by the page's data as JSON and PAGE_MOUTH by the drawing's
 * module. Returns 0, or -1 when either does not occur exactly once or writing fails. */
int page_write(const page_t *page, const char *template_text, FILE *out);

void page_release(page_t *page);

#endif
