/*
 * frames.c - the text formats of a frame.
 */
#include "frames.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "arkit.h"
#include "common.h"

/* FAPs of MPEG-4, each with an entry in the mask of a fap file. */
#define FAP_COUNT 68
#define FAP_TONGUE 43 /* the first of the tongue's */

static const char *const arkit_outputs[] = ARKIT_OUTPUT_NAMES;
static const face_t face_arkit = { "arkit", &arkit, arkit_outputs };

/* What a format does; null where that is nothing. */
struct frames_format {
    const char *name;
    const char *help;                /* what --help says of it */
    const face_t *face;              /* whose weights it writes */
    void (*begin)(frames_t *frames); /* what precedes the first frame */
    void (*put)(frames_t *frames, const int16_t faps[LABIAL_CHANNELS], const uint8_t *shares); /* a frame */
    void (*end)(frames_t *frames); /* what was kept until the last frame */
};

static void write_time(const frames_t *frames)
{
    const uint64_t fps = frames->frames_per_second;
    const uint64_t milliseconds = ((uint64_t)frames->count * 1000u + fps / 2u) / fps;
    fprintf(frames->out, "%" PRIu64 ".%03u", milliseconds / 1000u, (unsigned)(milliseconds % 1000u));
}

static void begin_csv(frames_t *frames)
{
    fputs("time", frames->out);
    for (int i = 0; i < LABIAL_CHANNELS; i++)
        fprintf(frames->out, ",fap%d", labial_fap_numbers[i]);
    putc('\n', frames->out);
}

static void put_csv(frames_t *frames, const int16_t faps[LABIAL_CHANNELS], const uint8_t *shares)
{
    (void)shares;
    write_time(frames);
    for (int i = 0; i < LABIAL_CHANNELS; i++)
        fprintf(frames->out, ",%d", faps[i]);
    putc('\n', frames->out);
}

/* A weight of a rig, as a number from 0 to 1. */
static void write_weight(FILE *out, int32_t weight)
{
    fprintf(out, "%" PRId32 ".%03" PRId32, weight / LABIAL_RIG_WEIGHT_ONE, weight % LABIAL_RIG_WEIGHT_ONE);
}

/* Columns of a Live Link Face recording behind Timecode and BlendShapeCount: ARKit's 52 blendshapes, whose own names
 * begin with a small letter, and 9 rotations. */
/* clang-format off */
static const char *const livelink_columns[] = {
    "EyeBlinkLeft", "EyeLookDownLeft", "EyeLookInLeft", "EyeLookOutLeft", "EyeLookUpLeft", "EyeSquintLeft",
    "EyeWideLeft", "EyeBlinkRight", "EyeLookDownRight", "EyeLookInRight", "EyeLookOutRight", "EyeLookUpRight",
    "EyeSquintRight", "EyeWideRight", "JawForward", "JawRight", "JawLeft", "JawOpen", "MouthClose", "MouthFunnel",
    "MouthPucker", "MouthRight", "MouthLeft", "MouthSmileLeft", "MouthSmileRight", "MouthFrownLeft",
    "MouthFrownRight", "MouthDimpleLeft", "MouthDimpleRight", "MouthStretchLeft", "MouthStretchRight",
    "MouthRollLower", "MouthRollUpper", "MouthShrugLower", "MouthShrugUpper", "MouthPressLeft", "MouthPressRight",
    "MouthLowerDownLeft", "MouthLowerDownRight", "MouthUpperUpLeft", "MouthUpperUpRight", "BrowDownLeft",
    "BrowDownRight", "BrowInnerUp", "BrowOuterUpLeft", "BrowOuterUpRight", "CheekPuff", "CheekSquintLeft",
    "CheekSquintRight", "NoseSneerLeft", "NoseSneerRight", "TongueOut", "HeadYaw", "HeadPitch", "HeadRoll",
    "LeftEyeYaw", "LeftEyePitch", "LeftEyeRoll", "RightEyeYaw", "RightEyePitch", "RightEyeRoll",
};
/* clang-format on */
#define LIVELINK_COLUMNS ((int)(sizeof livelink_columns / sizeof *livelink_columns))

/* The place of a column's blendshape among the values of the rig arkit, or -1 where neither lips nor jaw move it. */
static int livelink_output(const char *column)
{
    for (int i = 0; i < ARKIT_OUTPUTS; i++)
        if (arkit_outputs[i][0] == column[0] - 'A' + 'a' && strcmp(arkit_outputs[i] + 1, column + 1) == 0)
            return i;
    return -1;
}

static void begin_livelink(frames_t *frames)
{
    fputs("Timecode,BlendShapeCount", frames->out);
    for (int i = 0; i < LIVELINK_COLUMNS; i++)
        fprintf(frames->out, ",%s", livelink_columns[i]);
    putc('\n', frames->out);
}

static void put_livelink(frames_t *frames, const int16_t faps[LABIAL_CHANNELS], const uint8_t *shares)
{
    const uint32_t seconds = frames->count / frames->frames_per_second;
    labial_rig_apply_visemes(&arkit, faps, shares, frames->weights);
    fprintf(frames->out, "%02" PRIu32 ":%02" PRIu32 ":%02" PRIu32 ":%02" PRIu32 ".000,%d", seconds / 3600u,
            seconds / 60u % 60u, seconds % 60u, frames->count % frames->frames_per_second, LIVELINK_COLUMNS);
    for (int i = 0; i < LIVELINK_COLUMNS; i++) {
        const int output = livelink_output(livelink_columns[i]);
        putc(',', frames->out);
        write_weight(frames->out, output >= 0 ? frames->weights[output] : 0);
    }
    putc('\n', frames->out);
}

static void begin_json(const frames_t *frames)
{
    fprintf(frames->out, "{\"frame\":%" PRIu32 ",\"time\":", frames->count);
    write_time(frames);
}

/* Ends the line with the weights of the frame. */
static void put_weights(frames_t *frames, const int16_t faps[LABIAL_CHANNELS], const uint8_t *shares)
{
    const face_t *face = frames->face;
    labial_rig_apply_visemes(face->rig, faps, shares, frames->weights);
    fprintf(frames->out, ",\"%s\":{", face->name);
    for (unsigned i = 0; i < face->rig->count; i++) {
        fprintf(frames->out, "%s\"%s\":", i == 0 ? "" : ",", face->outputs[i]);
        write_weight(frames->out, frames->weights[i]);
    }
    fputs("}}\n", frames->out);
}

static void put_jsonl(frames_t *frames, const int16_t faps[LABIAL_CHANNELS], const uint8_t *shares)
{
    begin_json(frames);
    for (int i = 0; i < LABIAL_CHANNELS; i++)
        fprintf(frames->out, "%s\"fap%d\":%d", i == 0 ? ",\"faps\":{" : ",", labial_fap_numbers[i], faps[i]);
    putc('}', frames->out);
    put_weights(frames, faps, shares);
}

static void put_face(frames_t *frames, const int16_t faps[LABIAL_CHANNELS], const uint8_t *shares)
{
    begin_json(frames);
    put_weights(frames, faps, shares);
}

static void write_fap_frame(FILE *out, uint32_t number, const frames_kept_t *frame)
{
    int16_t expanded[LABIAL_FAPS_EXPANDED], values[LABIAL_FAPS_EXPANDED + LABIAL_TONGUE_FAPS];
    int count = 0;
    labial_expand(frame->faps, expanded);
    for (int fap = 1, next = 0; fap <= FAP_COUNT; fap++) {
        const int tongue = frame->has_tongue && fap >= FAP_TONGUE && fap < FAP_TONGUE + LABIAL_TONGUE_FAPS;
        const int set = next < LABIAL_FAPS_EXPANDED && labial_fap_numbers_expanded[next] == fap;
        if (tongue || set)
            values[count++] = tongue ? frame->tongue[fap - FAP_TONGUE] : expanded[next];
        next += set;
        fprintf(out, fap == 1 ? "%d" : " %d", tongue || set);
    }
    fprintf(out, "\n%" PRIu32, number);
    for (int i = 0; i < count; i++)
        fprintf(out, " %d", values[i]);
    putc('\n', out);
}

static void keep_fap(frames_t *frames, const int16_t faps[LABIAL_CHANNELS], const uint8_t *shares)
{
    frames_kept_t *kept = grow(frames->kept, frames->count, &frames->room, sizeof *kept);
    if (!kept) {
        frames->failed = 1;
        return;
    }
    frames->kept = kept;
    kept += frames->count;
    memcpy(kept->faps, faps, sizeof kept->faps);
    labial_tongue(shares, kept->tongue);
    kept->has_tongue = shares != NULL;
}

static void end_fap(frames_t *frames)
{
    fprintf(frames->out, "2.1 %s %u %" PRIu32 "\n", frames->name, frames->frames_per_second, frames->count);
    for (uint32_t i = 0; i < frames->count; i++)
        write_fap_frame(frames->out, i, &frames->kept[i]);
}

/* ---- The list of formats --------------------------------------------------------------------------------------- */

/* By number; those of the faces follow. */
static const frames_format_t formats[] = {
    { "csv", "time,fap3,fap16,...: seconds and 13 FAPs per frame (default)", NULL, begin_csv, put_csv, NULL },
    { "fap", "MPEG-4 text, 28 FAPs; its header holds the number of frames, so it is written at the end", NULL, NULL,
      keep_fap, end_fap },
    { "livelink", "Live Link Face CSV: ARKit's blendshapes, 0 to 1", &face_arkit, begin_livelink, put_livelink, NULL },
    { "jsonl", "a JSON object per frame: FAPs and ARKit's blendshapes of the mouth", &face_arkit, NULL, put_jsonl,
      NULL },
};
#define FORMATS ((unsigned)(sizeof formats / sizeof formats[0]))

static const frames_format_t format_of_faces = {
    NULL, "a JSON object per frame: the weights, 0 to 1, of a face of that kind", NULL, NULL, put_face, NULL
};

const char *frames_format_name(unsigned format)
{
    if (format < FORMATS)
        return formats[format].name;
    return format - FORMATS < faces_count ? faces[format - FORMATS].name : NULL;
}

void frames_help(FILE *out)
{
    for (unsigned i = 0; i < FORMATS; i++)
        fprintf(out, "  %-4s %-10s %s\n", i == 0 ? "--to" : "", formats[i].name, formats[i].help);
    for (unsigned i = 0; i < faces_count; i++)
        fprintf(out, "%s%s", i == 0 ? "       " : ", ", faces[i].name);
    fprintf(out, "\n%18s%s\n", "", format_of_faces.help);
}

void frames_init(frames_t *frames, FILE *out, unsigned format, const char *name, unsigned frames_per_second)
{
    memset(frames, 0, sizeof *frames);
    frames->out = out;
    frames->format = format < FORMATS ? &formats[format] : &format_of_faces;
    frames->face = format < FORMATS ? formats[format].face : &faces[format - FORMATS];
    frames->name = name;
    frames->frames_per_second = frames_per_second;
    if (frames->face)
        labial_rig_rest(frames->face->rig, frames->weights);
    if (frames->format->begin)
        frames->format->begin(frames);
}

void frames_put(frames_t *frames, const int16_t faps[LABIAL_CHANNELS], const uint8_t *shares)
{
    if (frames->failed)
        return;
    frames->format->put(frames, faps, shares);
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
    if (frames->format->end && complete && !frames->failed)
        frames->format->end(frames);
    free(frames->kept);
    frames->kept = NULL;
    return frames_flush(frames);
}
