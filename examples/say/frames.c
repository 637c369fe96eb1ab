/*
 * frames.c - the text forms of a frame.
 */
#include "frames.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "livelink.h"

/* FAPs of MPEG-4, each with an entry in the mask of a fap file. */
#define FAP_COUNT 68

static const char *const arkit_outputs[] = ARKIT_OUTPUT_NAMES;
static const char *const vrm_outputs[] = VRM_OUTPUT_NAMES;
static const char *const oculus_outputs[] = OCULUS_OUTPUT_NAMES;
static const frames_face_t face_arkit = { "arkit", &arkit, arkit_outputs };
static const frames_face_t face_vrm = { "vrm", &vrm, vrm_outputs };
static const frames_face_t face_oculus = { "oculus", &oculus, oculus_outputs };

static void write_time(const frames_t *frames)
{
    const uint64_t fps = frames->frames_per_second;
    const uint64_t milliseconds = ((uint64_t)frames->count * 1000u + fps / 2u) / fps;
    fprintf(frames->out, "%" PRIu64 ".%03u", milliseconds / 1000u, (unsigned)(milliseconds % 1000u));
}

static void write_csv_frame(const frames_t *frames, const int16_t faps[LABIAL_CHANNELS])
{
    write_time(frames);
    for (int i = 0; i < LABIAL_CHANNELS; i++)
        fprintf(frames->out, ",%d", faps[i]);
    putc('\n', frames->out);
}

/* A weight in thousandths, as a number from 0 to 1. */
static void write_weight(FILE *out, int32_t weight)
{
    fprintf(out, "%" PRId32 ".%03" PRId32, weight / 1000, weight % 1000);
}

static void write_livelink_frame(frames_t *frames, const int16_t faps[LABIAL_CHANNELS])
{
    const uint32_t seconds = frames->count / frames->frames_per_second;
    labial_rig_apply(&arkit, faps, frames->weights);
    fprintf(frames->out, "%02" PRIu32 ":%02" PRIu32 ":%02" PRIu32 ":%02" PRIu32 ".000,%d", seconds / 3600u,
            seconds / 60u % 60u, seconds % 60u, frames->count % frames->frames_per_second, LIVELINK_COLUMNS);
    for (int i = 0; i < LIVELINK_COLUMNS; i++) {
        const int output = livelink_columns[i].output;
        putc(',', frames->out);
        write_weight(frames->out, output >= 0 ? frames->weights[output] : 0);
    }
    putc('\n', frames->out);
}

static void write_json_frame(frames_t *frames, const int16_t faps[LABIAL_CHANNELS])
{
    const frames_face_t *face = frames->face;
    labial_rig_apply(face->rig, faps, frames->weights);
    fprintf(frames->out, "{\"frame\":%" PRIu32 ",\"time\":", frames->count);
    write_time(frames);
    if (frames->format == FRAMES_JSONL) {
        for (int i = 0; i < LABIAL_CHANNELS; i++)
            fprintf(frames->out, "%s\"fap%d\":%d", i == 0 ? ",\"faps\":{" : ",", labial_fap_numbers[i], faps[i]);
        putc('}', frames->out);
    }
    fprintf(frames->out, ",\"%s\":{", face->name);
    for (unsigned i = 0; i < face->rig->count; i++) {
        fprintf(frames->out, "%s\"%s\":", i == 0 ? "" : ",", face->outputs[i]);
        write_weight(frames->out, frames->weights[i]);
    }
    fputs("}}\n", frames->out);
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
        int16_t(*kept)[LABIAL_CHANNELS] = NULL;
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

int frames_format_of(const char *name)
{
    /* In the order of frames_format_t. */
    static const char *const names[] = { "csv", "fap", "livelink", "jsonl", "arkit", "vrm", "oculus" };
    for (int i = 0; i < (int)(sizeof names / sizeof names[0]); i++)
        if (strcmp(names[i], name) == 0)
            return i;
    return -1;
}

void frames_init(frames_t *frames, FILE *out, frames_format_t format, const char *name, unsigned frames_per_second)
{
    memset(frames, 0, sizeof *frames);
    frames->out = out;
    frames->format = format;
    frames->name = name;
    frames->frames_per_second = frames_per_second;
    frames->face = format == FRAMES_VRM ? &face_vrm : format == FRAMES_OCULUS ? &face_oculus : &face_arkit;
    labial_rig_rest(frames->face->rig, frames->weights);
    if (format == FRAMES_CSV) {
        fputs("time", out);
        for (int i = 0; i < LABIAL_CHANNELS; i++)
            fprintf(out, ",fap%d", labial_fap_numbers[i]);
        putc('\n', out);
    } else if (format == FRAMES_LIVELINK) {
        fputs("Timecode,BlendShapeCount", out);
        for (int i = 0; i < LIVELINK_COLUMNS; i++)
            fprintf(out, ",%s", livelink_columns[i].name);
        putc('\n', out);
    }
}

void frames_put(frames_t *frames, const int16_t faps[LABIAL_CHANNELS])
{
    if (frames->failed)
        return;
    switch (frames->format) {
    case FRAMES_CSV:
        write_csv_frame(frames, faps);
        break;
    case FRAMES_FAP:
        keep_frame(frames, faps);
        break;
    case FRAMES_LIVELINK:
        write_livelink_frame(frames, faps);
        break;
    case FRAMES_JSONL:
    case FRAMES_ARKIT:
    case FRAMES_VRM:
    case FRAMES_OCULUS:
        write_json_frame(frames, faps);
        break;
    }
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
