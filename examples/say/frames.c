/*
 * frames.c - the two text forms of a frame.
 */
#include "frames.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* FAPs of MPEG-4, each with an entry in the mask of a fap file. */
#define FAP_COUNT 68

static void write_csv_frame(frames_t *frames, const int16_t faps[LABIAL_CHANNELS])
{
    const uint64_t fps = frames->frames_per_second;
    const uint64_t milliseconds = ((uint64_t)frames->count * 1000u + fps / 2u) / fps;
    fprintf(frames->out, "%" PRIu64 ".%03u", milliseconds / 1000u, (unsigned)(milliseconds % 1000u));
    for (int i = 0; i < LABIAL_CHANNELS; i++)
        fprintf(frames->out, ",%d", faps[i]);
    putc('\n', frames->out);
}

static void write_fap_frame(FILE *out, uint32_t number, const int16_t faps[LABIAL_CHANNELS])
{
    int16_t expanded[LABIAL_FAPS_EXPANDED];
    labial_expand(faps, expanded);
    for (int fap = 1, next = 0; fap <= FAP_COUNT; fap++) {
        const int set = next < LABIAL_FAPS_EXPANDED && labial_fap_numbers_expanded[next] == fap;
        next += set;
        fprintf(out, fap == 1 ? "%d" : " %d", set);
    }
    fprintf(out, "\n%" PRIu32, number);
    for (int i = 0; i < LABIAL_FAPS_EXPANDED; i++)
        fprintf(out, " %d", expanded[i]);
    putc('\n', out);
}

static void keep_frame(frames_t *frames, const int16_t faps[LABIAL_CHANNELS])
{
    if (frames->count >= frames->room) {
        const size_t room = frames->room ? frames->room * 2u : 1024u;
        int16_t (*kept)[LABIAL_CHANNELS] = NULL;
        if (room <= SIZE_MAX / sizeof *kept)
            kept = realloc(frames->kept, room * sizeof *kept);
        if (!kept) {
            frames->failed = 1;
            return;
        }
        frames->kept = kept;
        frames->room = room;
    }
    memcpy(frames->kept[frames->count], faps, sizeof *frames->kept);
}

void frames_init(frames_t *frames, FILE *out, frames_format_t format, const char *name, unsigned frames_per_second)
{
    memset(frames, 0, sizeof *frames);
    frames->out = out;
    frames->format = format;
    frames->name = name;
    frames->frames_per_second = frames_per_second;
    if (format == FRAMES_CSV) {
        fputs("time", out);
        for (int i = 0; i < LABIAL_CHANNELS; i++)
            fprintf(out, ",fap%d", labial_fap_numbers[i]);
        putc('\n', out);
    }
}

void frames_put(frames_t *frames, const int16_t faps[LABIAL_CHANNELS])
{
    if (frames->failed)
        return;
    if (frames->format == FRAMES_CSV)
        write_csv_frame(frames, faps);
    else
        keep_frame(frames, faps);
    if (!frames->failed)
        frames->count++;
}

int frames_flush(frames_t *frames)
{
    if (fflush(frames->out) != 0 || ferror(frames->out))
        frames->failed = 1;
    return frames->failed ? -1 : 0;
}

int frames_finish(frames_t *frames, int complete)
{
    if (frames->format == FRAMES_FAP && complete && !frames->failed) {
        fprintf(frames->out, "2.1 %s %u %" PRIu32 "\n", frames->name, frames->frames_per_second, frames->count);
        for (uint32_t i = 0; i < frames->count; i++)
            write_fap_frame(frames->out, i, frames->kept[i]);
    }
    free(frames->kept);
    frames->kept = NULL;
    return frames_flush(frames);
}
