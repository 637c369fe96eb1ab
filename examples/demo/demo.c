/*
 * labial-demo - a spoken sentence, a laugh, and a sentence that breaks into laughter, written as a page.
 *
 *     labial-demo OUTPUT.html player.html mouth.js sentence.flite laugh.lab laughing.flite
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common.h"
#include "demo.h"
#include "labial/faps.h"
#include "labial/labial.h"
#include "laughter_synthetic.h"
#include "speech_en.h"

/* ---- Motion and its phonemes as a page that plays them --------------------------------------------------- */

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

/* What a page plays. Zero-initialise. */
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
static int page_add_frame(page_t *page, const int16_t faps[LABIAL_CHANNELS])
{
    int16_t(*frames)[LABIAL_CHANNELS] = grow(page->frames, page->frame_count, &page->frame_room, sizeof *page->frames);
    if (!frames)
        return -1;
    page->frames = frames;
    memcpy(page->frames[page->frame_count++], faps, sizeof *page->frames);
    return 0;
}

static int page_add_phoneme(page_t *page, const page_phoneme_t *phoneme)
{
    page_phoneme_t *phonemes = grow(page->phonemes, page->phoneme_count, &page->phoneme_room, sizeof *page->phonemes);
    if (!phonemes)
        return -1;
    page->phonemes = phonemes;
    page->phonemes[page->phoneme_count++] = *phoneme;
    return 0;
}

static void page_release(page_t *page)
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

/* Writes the player with PAGE_DATA replaced by the page's data as JSON and PAGE_MOUTH by the drawing's module. Returns
 * 0, or -1 when either does not occur exactly once or writing fails. */
static int page_write(const page_t *page, const char *template_text, FILE *out)
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

/* ---- The performance -------------------------------------------------------------------------------------------- */

static const score_voice_t speech = { &speech_en, &speech_en_names, "speech" };
static const score_voice_t laughter = { &laughter_synthetic, &laughter_synthetic_names, "laughter" };

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

/* A phoneme without a frame is not on the page. */
static int show_phonemes(page_t *page, const score_t *score)
{
    for (size_t i = 0; i < score->phoneme_count; i++) {
        const score_phoneme_t *phoneme = &score->phonemes[i];
        page_phoneme_t shown = { .label = phoneme->label, .kind = phoneme->kind };
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

/* The content of a file with a null character after it, to be freed; null, with a message, when it cannot be read. */
static char *read_file(const char *path, size_t *size)
{
    FILE *in = fopen(path, "rb");
    if (!in) {
        fprintf(stderr, "labial-demo: %s: cannot open\n", path);
        return NULL;
    }
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
    if (!text || ferror(in)) {
        fprintf(stderr, "labial-demo: %s: %s\n", path, text ? "cannot read" : "out of memory");
        free(text);
        text = NULL;
    }
    if (text)
        text[length] = '\0';
    *size = length;
    fclose(in);
    return text;
}

/* The parts of the page besides the motion; the caller frees them. */
typedef struct {
    char *player, *mouth, *sound;
    size_t player_size, mouth_size, sound_size;
} parts_t;

static int read_parts(parts_t *parts, const char *player, const char *mouth, const char *sound)
{
    parts->player = read_file(player, &parts->player_size);
    parts->mouth = read_file(mouth, &parts->mouth_size);
    if (sound)
        parts->sound = read_file(sound, &parts->sound_size);
    if (!parts->player || !parts->mouth || (sound && !parts->sound))
        return -1;
    if (sound && strncmp(parts->sound, "fLaC", 4) != 0) {
        fprintf(stderr, "labial-demo: %s: not a FLAC file\n", sound);
        return -1;
    }
    return 0;
}

static void release_parts(parts_t *parts)
{
    free(parts->player);
    free(parts->mouth);
    free(parts->sound);
}

static int write_page(page_t *page, const parts_t *parts, const char *path)
{
    page->mouth = parts->mouth;
    page->sound = (const unsigned char *)parts->sound;
    page->sound_size = parts->sound_size;
    FILE *out = fopen(path, "w");
    if (!out) {
        fprintf(stderr, "labial-demo: %s: cannot write\n", path);
        return -1;
    }
    int result = page_write(page, parts->player, out);
    if (fclose(out) != 0)
        result = -1;
    if (result != 0)
        fprintf(stderr, "labial-demo: %s: cannot write, or the player does not hold %s and %s once\n", path, PAGE_DATA,
                PAGE_MOUTH);
    return result;
}

static const char usage[] =
    "usage: labial-demo OUTPUT.html player.html mouth.js sentence.flite laugh.lab laughing.flite [OPTION]...\n"
    "\n"
    "  --sound FILE.flac   sound of the whole, in step with the timings\n"
    "  --title TITLE       title of the page\n";

int main(int argc, char **argv)
{
    demo_t demo = { .page.title = "Labial: a sentence, a laugh, and both at once" };
    parts_t parts = { NULL, NULL, NULL, 0, 0, 0 };
    const char *sound = NULL;
    int wrong = argc < 7 || argc % 2 == 0;
    for (int i = 7; !wrong && i < argc; i += 2) {
        if (strcmp(argv[i], "--sound") == 0)
            sound = argv[i + 1];
        else if (strcmp(argv[i], "--title") == 0)
            demo.page.title = argv[i + 1];
        else
            wrong = 1;
    }
    if (wrong) {
        fputs(usage, stderr);
        return 2;
    }
    int result = read_parts(&parts, argv[2], argv[3], sound);
    if (result == 0)
        result = synthesise(&demo, argv + 4);
    if (result == 0)
        result = write_page(&demo.page, &parts, argv[1]);
    page_release(&demo.page);
    score_release(&demo.score);
    release_parts(&parts);
    return result == 0 ? 0 : 1;
}
