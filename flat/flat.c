/*
 * flat.c - the library without structures (flat.h).
 */
#include "flat.h"

#include <string.h>

#include "models.h"

#ifndef __wasm__
#include "functions.h"
#endif

#ifdef FLAT_FACES
#include "attribution.h"
#include "faces.h"
#endif

#define TEXT(x) #x
#define NUMBER(x) TEXT(x)

FLAT_RETURNS(uint32_t interface(void), FLAT_INTERFACE)
FLAT_RETURNS(const char *version(void),
             NUMBER(LABIAL_VERSION_MAJOR) "." NUMBER(LABIAL_VERSION_MINOR) "." NUMBER(LABIAL_VERSION_PATCH))
FLAT_RETURNS(const char *method(void), LABIAL_PAPER ? "paper" : "labial")
FLAT_RETURNS(const char *result_text(int result), labial_result_text(result))

#ifndef __wasm__
const char *function(unsigned number)
{
    static const char *const rows[] = { FLAT_FUNCTIONS };
    return number < sizeof rows / sizeof *rows ? rows[number] : NULL;
}
#endif

/* What an output of a rig refers to. */
typedef struct {
    labial_rig_curve_t curve;
    int16_t visemes[LABIAL_VISEMES];
} more_t;

/* ---- Sizes ------------------------------------------------------------------------------------------------------- */

FLAT_RETURNS(uint32_t mouth_size(void), sizeof(mouth_t))
FLAT_RETURNS(uint32_t blob_size(void), sizeof(labial_blob_t))
FLAT_RETURNS(uint32_t laugh_size(void), sizeof(labial_laugh_t))
FLAT_RETURNS(uint32_t timings_size(void), sizeof(labial_timings_t))
FLAT_RETURNS(uint32_t rig_output_size(void), sizeof(labial_rig_output_t))
FLAT_RETURNS(uint32_t rig_curve_size(void), sizeof(more_t))

/* ---- Models and names -------------------------------------------------------------------------------------------- */

static const struct {
    const char *name;
    const labial_model_t *model;
    const labial_names_t *names;
} bundled[] = { LABIAL_BUNDLED };
#define BUNDLED (sizeof bundled / sizeof bundled[0])

FLAT_RETURNS(const char *bundled_name(unsigned number), number < BUNDLED ? bundled[number].name : NULL)
FLAT_RETURNS(const labial_model_t *bundled_model(unsigned number), number < BUNDLED ? bundled[number].model : NULL)
FLAT_RETURNS(const labial_names_t *bundled_names(unsigned number), number < BUNDLED ? bundled[number].names : NULL)
FLAT_RETURNS(unsigned model_phonemes(const labial_model_t *model), model->phoneme_count)
FLAT_RETURNS(unsigned model_silence(const labial_model_t *model), model->silence)
FLAT_RETURNS(unsigned model_fps(const labial_model_t *model), model->frames_per_second)
FLAT_RETURNS(unsigned model_stride(const labial_model_t *model), model->search_stride)
FLAT_RETURNS(int model_load(labial_blob_t *blob, const void *data, uint32_t size), labial_model_load(blob, data, size))
FLAT_RETURNS(unsigned names_phonemes(const labial_names_t *names), names->phoneme_count)
FLAT_RETURNS(const char *label_at(const labial_names_t *names, unsigned phoneme),
             phoneme < names->phoneme_count ? names->labels[phoneme] : "")
FLAT_RETURNS(int find(const labial_names_t *names, unsigned labels, const char *name, uint32_t length),
             labial_find_in(names, (labial_labels_t)labels, name, length))
FLAT_RETURNS(int find_nearest(const labial_names_t *names, unsigned labels, const char *name, uint32_t length,
                              unsigned silence),
             labial_find_nearest(names, (labial_labels_t)labels, name, length, silence))

/* ---- Streams ----------------------------------------------------------------------------------------------------- */

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    mouth_t *mouth = (mouth_t *)user;
    memcpy(mouth->faps, faps, sizeof mouth->faps);
    if (labial_visemes(&mouth->stream, mouth->speech, labial_arpabet_visemes, mouth->shares) != LABIAL_OK) {
        memset(mouth->shares, 0, sizeof mouth->shares);
        mouth->shares[LABIAL_VISEME_SIL] = LABIAL_VISEME_ONE;
    }
    mouth->moved = 1;
    (void)frame;
}

/* Models of speech are told by the number of their phonemes. */
static void take_model(mouth_t *mouth, const labial_model_t *model)
{
    if (model->phoneme_count == LABIAL_ARPABET_PHONEMES)
        mouth->speech = model;
}

int mouth_init(mouth_t *mouth, const labial_model_t *model)
{
    memset(mouth, 0, sizeof *mouth);
    take_model(mouth, model);
    return labial_init(&mouth->stream, model, mouth->workspace, sizeof mouth->workspace, on_frame, mouth);
}

int mouth_use(mouth_t *mouth, const labial_model_t *model)
{
    const int result = labial_use(&mouth->stream, model);
    if (result == LABIAL_OK)
        take_model(mouth, model);
    return result;
}

FLAT_RETURNS(int mouth_push(mouth_t *mouth, unsigned phoneme, uint32_t milliseconds),
             labial_push(&mouth->stream, phoneme, milliseconds))
FLAT_RETURNS(unsigned mouth_room(const mouth_t *mouth), labial_room(&mouth->stream))

int mouth_end(mouth_t *mouth)
{
    mouth->ended = 1;
    return labial_end(&mouth->stream);
}

int mouth_cancel(mouth_t *mouth, uint32_t milliseconds)
{
    mouth->ended = 1;
    return labial_cancel(&mouth->stream, milliseconds);
}

int mouth_restart(mouth_t *mouth)
{
    const int result = labial_restart(&mouth->stream);
    if (result == LABIAL_OK)
        mouth->ended = 0;
    return result;
}

FLAT_RETURNS(int mouth_articulation(mouth_t *mouth, unsigned percent), labial_articulation(&mouth->stream, percent))

int mouth_exact(mouth_t *mouth, unsigned exact)
{
    mouth->exact = exact != 0;
    return labial_exact(&mouth->stream, mouth->exact);
}

int mouth_tick(mouth_t *mouth)
{
    mouth->moved = 0;
    mouth->state = labial_tick(&mouth->stream);
    return mouth->state;
}

FLAT_RETURNS(unsigned mouth_moved(const mouth_t *mouth), mouth->moved)
FLAT_RETURNS(const int16_t *mouth_faps(const mouth_t *mouth), mouth->faps)
FLAT_RETURNS(const uint8_t *mouth_visemes(const mouth_t *mouth), mouth->shares)
FLAT_RETURNS(int mouth_state(const mouth_t *mouth), mouth->state)
FLAT_RETURNS(uint32_t mouth_held(const mouth_t *mouth), labial_latency(&mouth->stream).frames)
FLAT_RETURNS(uint32_t mouth_milliseconds(const mouth_t *mouth), labial_latency(&mouth->stream).milliseconds)
FLAT_RETURNS(unsigned mouth_waiting(const mouth_t *mouth), labial_latency(&mouth->stream).phonemes)
FLAT_RETURNS(unsigned mouth_delay(const mouth_t *mouth), labial_latency(&mouth->stream).delay)

int mouth_run(mouth_t *mouth, int16_t *out, uint8_t *shares, unsigned count)
{
    unsigned underway = labial_latency(&mouth->stream).delay, frames = 0;
    int result = labial_exact(&mouth->stream, mouth->exact || !mouth->ended);
    while (result >= 0 && frames < count) {
        result = mouth_tick(mouth);
        if (result == LABIAL_OK) {
            if (shares)
                memcpy(&shares[LABIAL_VISEMES * frames], mouth->shares, sizeof mouth->shares);
            memcpy(&out[LABIAL_CHANNELS * frames++], mouth->faps, sizeof mouth->faps);
        } else if (result != LABIAL_WAITING || underway-- == 0)
            break;
    }
    (void)labial_exact(&mouth->stream, mouth->exact);
    return result < 0 ? result : (int)frames;
}

/* ---- Laughs ------------------------------------------------------------------------------------------------------ */

FLAT_RETURNS(int laugh_init(labial_laugh_t *laugh, uint32_t milliseconds, unsigned intensity, uint32_t seed),
             labial_laugh_init(laugh, milliseconds, intensity, seed))

int laugh_next(labial_laugh_t *laugh, uint32_t *out)
{
    unsigned phoneme = 0;
    const int result = labial_laugh_next(laugh, &phoneme, &out[1]);
    out[0] = phoneme;
    return result;
}

FLAT_RETURNS(int blend(unsigned intensity, unsigned words, const int16_t *speech, const int16_t *laugh, int16_t *out),
             labial_blend(&labial_blend_default, intensity, words, speech, laugh, out))

/* ---- Rigs -------------------------------------------------------------------------------------------------------- */

void rig_output(labial_rig_output_t *output, void *more, const int32_t *numbers)
{
    const int32_t *const rest = &numbers[LABIAL_CHANNELS], *const amounts = &rest[11 + 3 * LABIAL_RIG_SEGMENTS];
    more_t *own = (more_t *)more;
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
    output->slew = rest[7];
    output->deadband = rest[8];
    output->acceleration = rest[9];
    memset(own, 0, sizeof *own);
    if (rest[10] != 0) {
        own->curve.count = (uint16_t)rest[10];
        memcpy(own->curve.segments, &rest[11], sizeof own->curve.segments);
        output->curve = &own->curve;
    }
    if (amounts[0] != 0) {
        for (unsigned i = 0; i < LABIAL_VISEMES; i++)
            own->visemes[i] = (int16_t)amounts[1 + i];
        output->visemes = own->visemes;
    }
}

int rig_check(const labial_rig_output_t *outputs, unsigned count)
{
    const labial_rig_t rig = { outputs, (uint16_t)count };
    return labial_rig_check(&rig);
}

int rig_rest(const labial_rig_output_t *outputs, unsigned count, int32_t *values)
{
    const labial_rig_t rig = { outputs, (uint16_t)count };
    return labial_rig_rest(&rig, values);
}

int rig_apply(const labial_rig_output_t *outputs, unsigned count, const int16_t *faps, const uint8_t *shares,
              unsigned frames, int32_t *values, int32_t *changes)
{
    const labial_rig_t rig = { outputs, (uint16_t)count };
    return labial_rig_apply_visemes_ahead(&rig, faps, shares, (uint16_t)frames, values, changes);
}

void rig_weigh(const labial_rig_output_t *outputs, unsigned count, const int16_t *faps, const uint8_t *shares,
               int32_t *values)
{
    const labial_rig_t rig = { outputs, (uint16_t)count };
    labial_rig_rest(&rig, values);
    labial_rig_apply_visemes(&rig, faps, shares, values);
}

/* ---- Timings ----------------------------------------------------------------------------------------------------- */

FLAT_RETURNS(const char *timings_name(unsigned format), labial_timings_format_name(format))
FLAT_RETURNS(const char *timings_suffix(unsigned format), labial_timings_format_suffix(format))

int timings_init(labial_timings_t *timings, unsigned format, const char *tier, unsigned tier_number)
{
    const int result = labial_timings_init(timings, (labial_timings_format_t)format);
    (void)labial_timings_tier(timings, tier, tier_number);
    return result;
}

static int told(const labial_timing_t *timing, int result, double *times, int32_t *numbers)
{
    if (result == LABIAL_OK) {
        times[0] = (double)timing->start / 1e9;
        times[1] = (double)timing->end / 1e9;
        times[2] = timing->has_apex ? (double)timing->apex / 1e9 : -1.0;
        numbers[1] = (int32_t)timing->line;
        numbers[2] = timing->laugh;
        numbers[3] = timing->xsampa;
    }
    return result;
}

int timings_next(labial_timings_t *timings, const char *text, uint32_t size, double *times, int32_t *numbers)
{
    labial_timing_t timing;
    size_t used = 0;
    const int result = labial_timings_next(timings, text, size, &used, &timing);
    numbers[0] = (int32_t)used;
    return told(&timing, result, times, numbers);
}

int timings_end(labial_timings_t *timings, double *times, int32_t *numbers)
{
    labial_timing_t timing;
    return told(&timing, labial_timings_end(timings, &timing), times, numbers);
}

FLAT_RETURNS(const char *timings_label(const labial_timings_t *timings), timings->found.label)
FLAT_RETURNS(const char *timings_word(const labial_timings_t *timings), timings->found.word)
FLAT_RETURNS(const char *timings_message(const labial_timings_t *timings), labial_timings_message(timings))
FLAT_RETURNS(uint32_t timings_line(const labial_timings_t *timings), labial_timings_line(timings))

/* ---- Faces ------------------------------------------------------------------------------------------------------- */

#ifdef FLAT_FACES

FLAT_RETURNS(const char *face_name(unsigned face), face < faces_count ? faces[face].name : NULL)
FLAT_RETURNS(const char *weight_name(unsigned face, unsigned weight),
             weight < faces[face].rig->count ? faces[face].outputs[weight] : NULL)

void weigh(unsigned face, const int16_t *faps, const uint8_t *shares, int32_t *out)
{
    labial_rig_rest(faces[face].rig, out);
    labial_rig_apply_visemes(faces[face].rig, faps, shares, out);
}

FLAT_RETURNS(const char *attribution(void), LABIAL_ATTRIBUTION)

#endif
