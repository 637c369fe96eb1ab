/*
 * mouth.c - names to phonemes, phonemes to frames.
 */
#include "mouth.h"

#include <string.h>

#include "labial/laugh.h"
#include "models.h"

/* Seconds of motion from which on a warning says why a program takes long. */
#define LONG 3600u
/* Milliseconds. No sound of speech lasts longer, or less; the times of one that does are probably in another unit. */
#define LONG_SOUND 10000u
#define SHORT_SOUND 5u

const mouth_voice_t mouth_voices[] = { LABIAL_BUNDLED };
static const mouth_voice_t laughter = { "laughter_synthetic", &laughter_synthetic, &laughter_synthetic_names };

const char *mouth_voice_name(unsigned number)
{
    return number < sizeof mouth_voices / sizeof mouth_voices[0] ? mouth_voices[number].name : NULL;
}

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    mouth_t *mouth = user;
    if (frame == LONG * mouth->voice->model->frames_per_second)
        fprintf(stderr, "%s: warning: the motion lasts for more than an hour, which takes time and room\n",
                mouth->program);
    uint8_t shares[LABIAL_VISEMES] = { LABIAL_VISEME_ONE };
    if (mouth->voice->model->phoneme_count == LABIAL_ARPABET_PHONEMES)
        (void)labial_visemes(&mouth->stream, mouth->voice->model, labial_arpabet_visemes, shares);
    frames_put(&mouth->frames, faps, shares);
}

static int failed(const mouth_t *mouth, const char *where, const char *why)
{
    fprintf(stderr, "%s: %s%s\n", mouth->program, where, why);
    return -1;
}

/* Takes every frame that what was pushed so far allows; there is no clock to follow here. Before the first frame comes
 * as many ticks as the stream's delay bring none. Returns why there are no more, or an error. */
static int drain(mouth_t *mouth)
{
    unsigned underway = labial_latency(&mouth->stream).delay;
    int result;
    do {
        result = labial_tick(&mouth->stream);
    } while (result == LABIAL_OK || (result == LABIAL_WAITING && underway-- > 0));
    return result;
}

static int use(mouth_t *mouth, const char *where, const mouth_voice_t *voice)
{
    if (mouth->current->model == voice->model)
        return 0;
    const int result = labial_use(&mouth->stream, voice->model);
    if (result < 0)
        return failed(mouth, where, labial_result_text(result));
    mouth->current = voice;
    return 0;
}

static int push(mouth_t *mouth, const char *where, unsigned phoneme, uint32_t milliseconds)
{
    int result = labial_room(&mouth->stream) > 0 ? LABIAL_OK : drain(mouth);
    if (result >= 0)
        result = labial_push(&mouth->stream, phoneme, milliseconds);
    if (result >= 0)
        result = drain(mouth);
    return result < 0 ? failed(mouth, where, labial_result_text(result)) : 0;
}

/* What was written goes on its way: the next phoneme may be long in coming. */
static int flush(mouth_t *mouth)
{
    return frames_flush(&mouth->frames) != 0 ? failed(mouth, "", "cannot write the motion") : 0;
}

/* Says once that `label` is unknown and what is taken for it. */
static void warn(mouth_t *mouth, const char *where, const char *label, unsigned phoneme)
{
    for (unsigned i = 0; i < mouth->unknown_count; i++)
        if (strncmp(mouth->unknown[i], label, MOUTH_LABEL_MAX) == 0)
            return;
    if (mouth->unknown_count == MOUTH_UNKNOWN_MAX)
        return;
    (void)snprintf(mouth->unknown[mouth->unknown_count++], MOUTH_LABEL_MAX + 1, "%s", label);
    fprintf(stderr, "%s: warning: %s%s has no phoneme '%s', which moves as %s%s\n", mouth->program, where,
            mouth->voice->name, label, mouth->voice->names->labels[phoneme],
            mouth->unknown_count == MOUTH_UNKNOWN_MAX ? "; further unknown labels are not named" : "");
}

/* Asks about the first sound that is too long to be speech; remembers whether one is long enough. */
static void check_duration(mouth_t *mouth, const char *where, const char *label, uint32_t milliseconds)
{
    mouth->has_sound = 1;
    if (milliseconds >= SHORT_SOUND)
        mouth->has_speech = 1;
    if (milliseconds > LONG_SOUND && !mouth->long_named) {
        mouth->long_named = 1;
        fprintf(stderr, "%s: warning: %s'%s' lasts %lu s: is the unit of time right?\n", mouth->program, where, label,
                (unsigned long)(milliseconds / 1000u));
    }
}

int mouth_init(mouth_t *mouth, const char *program, const mouth_voice_t *voice, FILE *out, unsigned format)
{
    memset(mouth, 0, sizeof *mouth);
    mouth->program = program;
    mouth->voice = voice;
    mouth->current = voice;
    const int result =
        labial_init(&mouth->stream, voice->model, mouth->workspace, sizeof mouth->workspace, on_frame, mouth);
    if (result < 0)
        return failed(mouth, "", labial_result_text(result));
    frames_init(&mouth->frames, out, format, voice->name, voice->model->frames_per_second);
    return 0;
}

int mouth_say(mouth_t *mouth, const char *where, const char *label, labial_labels_t labels, uint32_t milliseconds)
{
    const mouth_voice_t *voice = mouth->voice;
    int phoneme = voice->model->silence;
    if (label) {
        const size_t length = strlen(label);
        phoneme = labial_find_in(voice->names, labels, label, length);
        if (phoneme < 0) {
            phoneme = labial_find_nearest(voice->names, labels, label, length, voice->model->silence);
            if (phoneme < 0)
                return failed(mouth, where, labial_result_text(phoneme));
            warn(mouth, where, label, (unsigned)phoneme);
        }
        if (phoneme != voice->model->silence)
            check_duration(mouth, where, label, milliseconds);
    }
    if (use(mouth, where, voice) != 0 || push(mouth, where, (unsigned)phoneme, milliseconds) != 0)
        return -1;
    return flush(mouth);
}

int mouth_laugh(mouth_t *mouth, const char *where, uint32_t milliseconds, unsigned intensity)
{
    labial_laugh_t laugh;
    unsigned phoneme;
    uint32_t length;
    if (use(mouth, where, &laughter) != 0)
        return -1;
    const int result = labial_laugh_init(&laugh, milliseconds, intensity, ++mouth->laughs);
    if (result < 0)
        return failed(mouth, where, labial_result_text(result));
    while (labial_laugh_next(&laugh, &phoneme, &length) == LABIAL_OK)
        if (push(mouth, where, phoneme, length) != 0)
            return -1;
    return flush(mouth);
}

int mouth_end(mouth_t *mouth, int complete)
{
    if (!complete) {
        (void)frames_finish(&mouth->frames, 0);
        return -1;
    }
    if (mouth->has_sound && !mouth->has_speech)
        fprintf(stderr, "%s: warning: every sound is shorter than %u ms: is the unit of time right?\n", mouth->program,
                SHORT_SOUND);
    labial_end(&mouth->stream);
    const int result = drain(mouth);
    if (result < 0)
        (void)failed(mouth, "", labial_result_text(result));
    if (frames_finish(&mouth->frames, result >= 0) != 0)
        return failed(mouth, "", "cannot write the motion");
    return result < 0 ? -1 : 0;
}
