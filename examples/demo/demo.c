/*
 * labial-demo - a spoken sentence, a laugh, and a sentence that breaks into laughter, written as a page.
 *
 *     labial-demo OUTPUT.html player.html sentence.flite laugh.lab laughing.flite [TITLE]
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "labial/labial.h"
#include "laughter_synthetic.h"
#include "page.h"
#include "score.h"
#include "speech_en.h"
#include "together.h"

static const score_voice_t speech = {&speech_en, &speech_en_names, "speech"};
static const score_voice_t laughter = {&laughter_synthetic, &laughter_synthetic_names, "laughter"};

static int out_of_memory(void)
{
    fprintf(stderr, "labial-demo: out of memory\n");
    return -1;
}

typedef struct {
    page_t page;
    score_t score;
    int failed; /* memory was short when a frame came */
} demo_t;

static void on_frame(void *user, const int16_t faps[LABIAL_CHANNELS])
{
    demo_t *demo = user;
    if (page_add_frame(&demo->page, faps) != 0)
        demo->failed = 1;
}

/* The number of the frame at a time in milliseconds, rounded as a stream rounds it. */
static uint32_t frame_at(uint64_t milliseconds)
{
    return (uint32_t)((milliseconds * speech_en.frames_per_second + 500u) / 1000u);
}

/* A phoneme too short for a frame of its own is not on the page. */
static int show_phonemes(page_t *page, const score_t *score)
{
    for (size_t i = 0; i < score->phoneme_count; i++) {
        const score_phoneme_t *phoneme = &score->phonemes[i];
        page_phoneme_t shown = {.label = phoneme->label, .kind = phoneme->kind};
        shown.start_frame = frame_at(phoneme->begin);
        shown.frames = frame_at(phoneme->begin + phoneme->milliseconds) - shown.start_frame;
        if (shown.frames > 0 && page_add_phoneme(page, &shown) != 0)
            return out_of_memory();
    }
    return 0;
}

static int synthesise(demo_t *demo, char **paths)
{
    score_t *score = &demo->score;
    if (score_read(score, paths[0], &speech) != 0 || score_read(score, paths[1], &laughter) != 0 ||
        score_read(score, paths[2], &speech) != 0)
        return -1;
    demo->page.frames_per_second = speech_en.frames_per_second;
    const int result = together_play(score, on_frame, demo);
    if (result != LABIAL_OK) {
        fprintf(stderr, "labial-demo: %s\n", labial_result_text(result));
        return -1;
    }
    return demo->failed ? out_of_memory() : show_phonemes(&demo->page, score);
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
    if (argc != 6 && argc != 7) {
        fprintf(stderr, "usage: labial-demo OUTPUT.html player.html sentence.flite laugh.lab laughing.flite [TITLE]\n");
        return 2;
    }
    demo_t demo = {.page.title = argc == 7 ? argv[6] : "Labial: a sentence, a laugh, and both at once"};
    int result = synthesise(&demo, argv + 3);
    if (result == 0)
        result = write_page(&demo.page, argv[2], argv[1]);
    page_release(&demo.page);
    score_release(&demo.score);
    return result == 0 ? 0 : 1;
}
