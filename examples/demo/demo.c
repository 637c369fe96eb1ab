/*
 * labial-demo - a spoken sentence and a laugh, synthesised as one stream of two models and written as a page.
 *
 *     labial-demo OUTPUT.html player.html sentence.flite laugh.lab [TITLE]
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "labial/labial.h"
#include "labial/names.h"
#include "laughter_synthetic.h"
#include "page.h"
#include "speech_en.h"
#include "timings.h"

#define WORKSPACE_SIZE                                                                                      \
    (SPEECH_EN_WORKSPACE_SIZE > LAUGHTER_SYNTHETIC_WORKSPACE_SIZE ? SPEECH_EN_WORKSPACE_SIZE                \
                                                                  : LAUGHTER_SYNTHETIC_WORKSPACE_SIZE)

typedef struct {
    labial_t stream;
    uint32_t workspace[(WORKSPACE_SIZE + 3u) / 4u];
    page_t page;

    /* the file being read */
    const char *path;
    timings_t timings;
    const labial_model_t *model;
    const labial_names_t *names;
    const char *kind;

    uint64_t milliseconds; /* pushed so far, of both files */
    int failed;            /* memory was short when a frame came */
} demo_t;

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    demo_t *demo = user;
    (void)frame;
    if (page_add_frame(&demo->page, faps) != 0)
        demo->failed = 1;
}

static int out_of_memory(void)
{
    fprintf(stderr, "labial-demo: out of memory\n");
    return -1;
}

/* Takes frames until the stream waits for phonemes or is done. */
static int drain(demo_t *demo)
{
    int result;
    do {
        result = labial_tick(&demo->stream);
    } while (!demo->failed && (result == LABIAL_OK || result == LABIAL_BUSY));
    return result;
}

/* The number of the frame at the present end of the input, rounded as the stream rounds it. */
static uint32_t frame_at_end(const demo_t *demo)
{
    return (uint32_t)((demo->milliseconds * demo->page.frames_per_second + 500u) / 1000u);
}

static int on_phoneme(void *user, const timings_phoneme_t *phoneme)
{
    demo_t *demo = user;
    int number = demo->model->silence;
    if (phoneme->laugh >= 0) {
        fprintf(stderr, "labial-demo: %s: line %lu: a laugh is a file of its own here\n", demo->path, demo->timings.line);
        return -1;
    }
    if (phoneme->label)
        number = labial_find(demo->names, phoneme->label, strlen(phoneme->label));
    if (number < 0) {
        fprintf(stderr, "labial-demo: %s: line %lu: unknown phoneme '%s'\n", demo->path, demo->timings.line,
                phoneme->label);
        return -1;
    }
    int result = labial_room(&demo->stream) > 0 ? LABIAL_OK : drain(demo);
    if (result >= 0)
        result = labial_push(&demo->stream, (unsigned)number, phoneme->milliseconds);
    if (result >= 0)
        result = drain(demo);
    if (result < 0) {
        fprintf(stderr, "labial-demo: %s: line %lu: %s\n", demo->path, demo->timings.line, labial_result_text(result));
        return -1;
    }

    page_phoneme_t shown;
    shown.label = demo->names->labels[number];
    shown.kind = number == demo->model->silence ? "silence" : demo->kind;
    shown.start_frame = frame_at_end(demo);
    demo->milliseconds += phoneme->milliseconds;
    shown.frames = frame_at_end(demo) - shown.start_frame;
    /* A phoneme too short for a frame of its own is not on the page either. */
    if (demo->failed || (shown.frames > 0 && page_add_phoneme(&demo->page, &shown) != 0))
        return out_of_memory();
    return 0;
}

/* Pushes the phonemes of a file, as `model`'s, to the stream. */
static int say_file(demo_t *demo, const char *path, const labial_model_t *model, const labial_names_t *names,
                    const char *kind)
{
    FILE *in = fopen(path, "r");
    if (!in) {
        fprintf(stderr, "labial-demo: %s: cannot open\n", path);
        return -1;
    }
    demo->path = path;
    demo->model = model;
    demo->names = names;
    demo->kind = kind;
    int result = labial_use(&demo->stream, model);
    if (result < 0) {
        fprintf(stderr, "labial-demo: %s: %s\n", path, labial_result_text(result));
    } else {
        int byte;
        timings_init(&demo->timings, TIMINGS_AUTO, NULL, on_phoneme, demo);
        while (result == 0 && (byte = getc(in)) != EOF)
            result = timings_put(&demo->timings, (unsigned char)byte);
        if (result == 0)
            result = timings_end(&demo->timings);
        if (result == TIMINGS_MALFORMED)
            fprintf(stderr, "labial-demo: %s: line %lu: %s\n", path, demo->timings.line, demo->timings.message);
        timings_free(&demo->timings);
    }
    if (ferror(in)) {
        fprintf(stderr, "labial-demo: %s: cannot read\n", path);
        result = -1;
    }
    fclose(in);
    return result < 0 ? -1 : 0;
}

static int synthesise(demo_t *demo, const char *sentence, const char *laugh)
{
    int result = labial_init(&demo->stream, &speech_en, demo->workspace, sizeof demo->workspace, on_frame, demo);
    if (result < 0) {
        fprintf(stderr, "labial-demo: %s\n", labial_result_text(result));
        return -1;
    }
    demo->page.frames_per_second = speech_en.frames_per_second;
    if (say_file(demo, sentence, &speech_en, &speech_en_names, "speech") != 0 ||
        say_file(demo, laugh, &laughter_synthetic, &laughter_synthetic_names, "laughter") != 0)
        return -1;
    labial_end(&demo->stream);
    result = drain(demo);
    if (result < 0) {
        fprintf(stderr, "labial-demo: %s\n", labial_result_text(result));
        return -1;
    }
    return demo->failed ? out_of_memory() : 0;
}

/* The whole of a text file, to be freed; null when it cannot be read. */
static char *read_text(const char *path)
{
    FILE *in = fopen(path, "r");
    if (!in)
        return NULL;
    size_t length = 0, room = 1u << 16;
    char *text = malloc(room);
    while (text) {
        length += fread(text + length, 1, room - length - 1u, in);
        if (length < room - 1u)
            break;
        room *= 2u;
        char *moved = realloc(text, room);
        if (!moved)
            free(text);
        text = moved;
    }
    if (text && ferror(in)) {
        free(text);
        text = NULL;
    }
    if (text)
        text[length] = '\0';
    fclose(in);
    return text;
}

static int write_page(const page_t *page, const char *template_path, const char *path)
{
    char *text = read_text(template_path);
    if (!text) {
        fprintf(stderr, "labial-demo: %s: cannot read\n", template_path);
        return -1;
    }
    int result = -1;
    FILE *out = fopen(path, "w");
    if (!out) {
        fprintf(stderr, "labial-demo: %s: cannot write\n", path);
    } else {
        result = page_write(page, text, out);
        if (fclose(out) != 0)
            result = -1;
        if (result != 0)
            fprintf(stderr, "labial-demo: %s: cannot write, or %s does not hold %s once\n", path, template_path,
                    PAGE_PLACEHOLDER);
    }
    free(text);
    return result;
}

int main(int argc, char **argv)
{
    static demo_t demo;
    if (argc != 5 && argc != 6) {
        fprintf(stderr, "usage: labial-demo OUTPUT.html player.html sentence.flite laugh.lab [TITLE]\n");
        return 2;
    }
    demo.page.title = argc == 6 ? argv[5] : "Labial: a sentence and a laugh";
    int result = synthesise(&demo, argv[3], argv[4]);
    if (result == 0)
        result = write_page(&demo.page, argv[2], argv[1]);
    page_release(&demo.page);
    return result == 0 ? 0 : 1;
}
