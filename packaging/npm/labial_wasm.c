/*
 * labial_wasm.c - what index.js calls of the library. The memory of streams, of models and of all that is passed is
 * index.js's, which takes it from the heap's base on; nothing here allocates.
 */
#include <string.h>

#include "attribution.h"
#include "faces.h"
#include "labial/blend.h"
#include "labial/blob.h"
#include "labial/labial.h"
#include "labial/laugh.h"
#include "labial/names.h"
#include "labial/rig.h"
#include "laughter_synthetic.h" /* whose names are here; the model comes as a binary one */
#include "speech_en.h"

#define EXPORT(name) __attribute__((export_name(#name)))

/* A stream with all that belongs to it. */
typedef struct {
    labial_t stream;
    int16_t faps[LABIAL_CHANNELS]; /* of the frame delivered last */
    uint32_t workspace[LABIAL_WORKSPACE_SIZE(LABIAL_SEARCH_STRIDE_MAX) / 4u];
} mouth_t;

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)frame;
    memcpy(((mouth_t *)user)->faps, faps, sizeof((mouth_t *)user)->faps);
}

/* ---- Sizes and places of what there is --------------------------------------------------------------------------- */

EXPORT(mouth_size) uint32_t mouth_size(void)
{
    return sizeof(mouth_t);
}

EXPORT(mouth_faps) int16_t *mouth_faps(mouth_t *mouth)
{
    return mouth->faps;
}

EXPORT(blob_size) uint32_t blob_size(void)
{
    return sizeof(labial_blob_t);
}

EXPORT(laugh_size) uint32_t laugh_size(void)
{
    return sizeof(labial_laugh_t);
}

/* What the licence of the speech model's data asks to be said wherever the model goes. */
EXPORT(attribution) const char *attribution(void)
{
    return LABIAL_ATTRIBUTION;
}

EXPORT(speech_model) const labial_model_t *speech_model(void)
{
    return &speech_en;
}

/* The names of phonemes: 0 speech, 1 laughter. */
EXPORT(names_at) const labial_names_t *names_at(unsigned number)
{
    return number ? &laughter_synthetic_names : &speech_en_names;
}

EXPORT(names_phonemes) unsigned names_phonemes(const labial_names_t *names)
{
    return names->phoneme_count;
}

EXPORT(model_phonemes) unsigned model_phonemes(const labial_model_t *model)
{
    return model->phoneme_count;
}

EXPORT(model_silence) unsigned model_silence(const labial_model_t *model)
{
    return model->silence;
}

EXPORT(model_rate) unsigned model_rate(const labial_model_t *model)
{
    return model->frames_per_second;
}

EXPORT(model_stride) unsigned model_stride(const labial_model_t *model)
{
    return model->search_stride;
}

EXPORT(label_at) const char *label_at(const labial_names_t *names, unsigned phoneme)
{
    return phoneme < names->phoneme_count ? names->labels[phoneme] : "";
}

EXPORT(result_text) const char *result_text(int result)
{
    return labial_result_text(result);
}

/* ---- Streams ----------------------------------------------------------------------------------------------------- */

EXPORT(mouth_init) int mouth_init(mouth_t *mouth, const labial_model_t *model)
{
    memset(mouth, 0, sizeof *mouth);
    return labial_init(&mouth->stream, model, mouth->workspace, sizeof mouth->workspace, on_frame, mouth);
}

EXPORT(mouth_use) int mouth_use(mouth_t *mouth, const labial_model_t *model)
{
    return labial_use(&mouth->stream, model);
}

EXPORT(mouth_push) int mouth_push(mouth_t *mouth, unsigned phoneme, uint32_t milliseconds)
{
    return labial_push(&mouth->stream, phoneme, milliseconds);
}

EXPORT(mouth_room) unsigned mouth_room(const mouth_t *mouth)
{
    return labial_room(&mouth->stream);
}

EXPORT(mouth_end) int mouth_end(mouth_t *mouth)
{
    return labial_end(&mouth->stream);
}

EXPORT(mouth_cancel) int mouth_cancel(mouth_t *mouth, uint32_t milliseconds)
{
    return labial_cancel(&mouth->stream, milliseconds);
}

EXPORT(mouth_restart) int mouth_restart(mouth_t *mouth)
{
    return labial_restart(&mouth->stream);
}

EXPORT(mouth_tick) int mouth_tick(mouth_t *mouth)
{
    return labial_tick(&mouth->stream);
}

EXPORT(mouth_held) uint32_t mouth_held(const mouth_t *mouth)
{
    return labial_latency(&mouth->stream).frames;
}

EXPORT(mouth_delay) unsigned mouth_delay(const mouth_t *mouth)
{
    return labial_latency(&mouth->stream).delay;
}

/* Ticks until `count` frames lie at `out` or no more can be had; they are as many as it returns, unless it is an error.
 * Ticks that bring nothing before the first frame are made, too. */
EXPORT(mouth_run) int mouth_run(mouth_t *mouth, int16_t *out, unsigned count)
{
    unsigned underway = labial_latency(&mouth->stream).delay, frames = 0;
    while (frames < count) {
        const int result = labial_tick(&mouth->stream);
        if (result < 0)
            return result;
        if (result == LABIAL_OK)
            memcpy(&out[LABIAL_CHANNELS * frames++], mouth->faps, sizeof mouth->faps);
        else if (result != LABIAL_WAITING || underway-- == 0)
            break;
    }
    return (int)frames;
}

/* ---- Labels, laughs, faces, models ------------------------------------------------------------------------------- */

EXPORT(find) int find(const labial_names_t *names, unsigned labels, const char *name, uint32_t length)
{
    return labial_find_in(names, (labial_labels_t)labels, name, length);
}

EXPORT(find_nearest)
int find_nearest(const labial_names_t *names, unsigned labels, const char *name, uint32_t length, unsigned silence)
{
    return labial_find_nearest(names, (labial_labels_t)labels, name, length, silence);
}

EXPORT(laugh_begin)
int laugh_begin(labial_laugh_t *laugh, uint32_t milliseconds, unsigned intensity, uint32_t seed)
{
    return labial_laugh_begin(laugh, milliseconds, intensity, seed);
}

/* The next phoneme and its milliseconds in two words at `out`. */
EXPORT(laugh_next) int laugh_next(labial_laugh_t *laugh, uint32_t *out)
{
    unsigned phoneme = 0;
    const int result = labial_laugh_next(laugh, &phoneme, &out[1]);
    out[0] = phoneme;
    return result;
}

EXPORT(blend)
int blend(unsigned intensity, unsigned words, const int16_t *speech, const int16_t *laugh, int16_t *out)
{
    return labial_blend(&labial_blend_default, intensity, words, speech, laugh, out);
}

/* The name of the face of this number, and of one of its weights; null beyond the last. */
EXPORT(face_name) const char *face_name(unsigned face)
{
    return face < faces_count ? faces[face].name : NULL;
}

EXPORT(weight_name) const char *weight_name(unsigned face, unsigned weight)
{
    return weight < faces[face].rig->count ? faces[face].outputs[weight] : NULL;
}

/* Thousandths of the face's weights at `out`. */
EXPORT(weigh) void weigh(unsigned face, const int16_t *faps, int32_t *out)
{
    labial_rig_rest(faces[face].rig, out);
    labial_rig_apply(faces[face].rig, faps, out);
}

EXPORT(rig_output_size) uint32_t rig_output_size(void)
{
    return sizeof(labial_rig_output_t);
}

EXPORT(rig_curve_size) uint32_t rig_curve_size(void)
{
    return sizeof(labial_rig_curve_t);
}

/* An output of a rig from its numbers: weights, then gain, neutral, minimum, maximum, invert, contact and closed; and at
 * `curve`, if it has one, the number of its segments and three numbers of each. */
EXPORT(rig_output) void rig_output(labial_rig_output_t *output, labial_rig_curve_t *curve, const int32_t *numbers)
{
    const int32_t *const rest = &numbers[LABIAL_CHANNELS];
    memset(output, 0, sizeof *output);
    for (unsigned i = 0; i < LABIAL_CHANNELS; i++)
        output->weights[i] = (int16_t)numbers[i];
    output->gain = rest[0];
    output->neutral = rest[1];
    output->minimum = rest[2];
    output->maximum = rest[3];
    output->invert = (uint8_t)rest[4];
    output->contact = (uint8_t)rest[5];
    output->closed = rest[6];
    if (rest[7] == 0)
        return;
    memset(curve, 0, sizeof *curve);
    curve->count = (uint16_t)rest[7];
    memcpy(curve->segments, &rest[8], sizeof curve->segments);
    output->curve = curve;
}

EXPORT(rig_check) int rig_check(const labial_rig_output_t *outputs, unsigned count)
{
    const labial_rig_t rig = { outputs, (uint16_t)count };
    return labial_rig_check(&rig);
}

/* The same as weigh() for a rig of one's own. */
EXPORT(rig_weigh)
void rig_weigh(const labial_rig_output_t *outputs, unsigned count, const int16_t *faps, int32_t *out)
{
    const labial_rig_t rig = { outputs, (uint16_t)count };
    labial_rig_rest(&rig, out);
    labial_rig_apply(&rig, faps, out);
}

EXPORT(model_load) int model_load(labial_blob_t *blob, const void *data, uint32_t size)
{
    return labial_model_load(blob, data, size);
}
