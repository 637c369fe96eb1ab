/*
 * labial-say-espeak - converts text to sound and motion in step, with the espeak-ng library.
 *
 *     labial-say-espeak hello.wav "Hello there." > hello.csv
 */
#include <espeak-ng/speak_lib.h>
#include <stdlib.h>
#include <string.h>

#include "closure.h"
#include "speak.h"

static const char usage[] =
    "usage: labial-say-espeak [--to FORMAT] [--voice NAME] SOUND.wav TEXT > motion\n"
    "\n"
    "Speaks TEXT (UTF-8; `-`: standard input) with espeak-ng into SOUND.wav and writes the motion of lips and jaw in\n"
    "step with it, while it is being spoken: as long as the sound, a frame every 20 ms.\n"
    "\n"
    "  --voice NAME  a voice or language of espeak-ng (en-us)\n"
    "  --to FORMAT   any that `labial-say --help` lists (csv)\n"
    "  --help        print this and exit\n"
    "\n"
    "Exit status: 0 success, 1 failure, 2 wrong usage.\n";

/* Shorter stretches without a label are not pauses but word boundaries, glottal stops or glides, for which espeak-ng
 * has no IPA: they belong to the phoneme before. Milliseconds; pauses last 150. */
#define SHORTEST_PAUSE 65u

typedef char label_t[sizeof(((espeak_EVENT *)0)->id.string) + 1];

/* The state of a run during espeak's callbacks. An event reports where a phoneme starts, so that its end is known only
 * with the next one. */
typedef struct {
    speak_t speak;
    closure_t closure;
    label_t label;       /* of the phoneme that is not yet said; empty in a pause */
    uint64_t start;      /* of it, milliseconds */
    uint64_t unlabelled; /* where a stretch without a label begins behind it; 0 without */
    int failed;
} run_t;

/* Whether a label is a tone's digit or consists of modifier letters (U+02B0 to U+02FF), such as the sign of
 * palatalisation in Russian and Polish, which is a separate event. These are part of the phoneme before. */
static int is_mark(const char *label)
{
    const unsigned char *c = (const unsigned char *)label;
    while ((c[0] >= '0' && c[0] <= '9') || (c[0] == 0xcau && c[1] >= 0xb0u) || (c[0] == 0xcbu && c[1] >= 0x80u))
        c += c[0] >= 0x80u ? 2 : 1;
    return *c == '\0';
}

/* Whether the stretch without a label, if there is one and it lasts up to `end`, is a pause. */
static int is_pause(const run_t *run, uint64_t end)
{
    return run->unlabelled > 0 && end >= run->unlabelled + SHORTEST_PAUSE;
}

/* Passes on the pending phoneme, up to `end`. */
static int say(run_t *run, uint64_t end)
{
    if (is_pause(run, end)) {
        if (speak_phoneme(&run->speak, run->label[0] ? run->label : NULL, run->unlabelled) != 0)
            return -1;
        run->label[0] = '\0';
    }
    run->unlabelled = 0;
    return speak_phoneme(&run->speak, run->label[0] ? run->label : NULL, end);
}

static int on_phoneme(run_t *run, const espeak_EVENT *event)
{
    uint64_t start = event->audio_position > 0 ? (uint64_t)event->audio_position : 0u;
    label_t label;
    memcpy(label, event->id.string, sizeof label - 1); /* it has no NUL when it fills all bytes */
    label[sizeof label - 1] = '\0';
    if (label[0] == '(') /* the name of a language, where words of another one begin */
        return 0;
    if (label[0] == '\0' && run->unlabelled == 0)
        run->unlabelled = start;
    if (is_mark(label))
        return 0;
    if (strcmp(label, "?\?") == 0) /* what espeak-ng 1.51 calls the vowel of German "Uhr", for want of an IPA */
        memcpy(label, "\xca\x8a\xc9\x90", 5);
    if (run->label[0] != '\0' && !is_pause(run, start) && closure_is_stop(label))
        start = closure_begin(&run->closure, run->start, start);
    if (say(run, start) != 0)
        return -1;
    memcpy(run->label, label, sizeof label);
    run->start = start;
    return 0;
}

static int on_sound(short *samples, int count, espeak_EVENT *events)
{
    run_t *run = events->user_data;
    if (!run || run->failed)
        return 1;
    if (samples && count > 0) {
        closure_sound(&run->closure, samples, (size_t)count);
        run->failed = speak_sound(&run->speak, samples, (size_t)count) != 0;
    }
    for (const espeak_EVENT *event = events; !run->failed && event->type != espeakEVENT_LIST_TERMINATED; event++)
        if (event->type == espeakEVENT_PHONEME && on_phoneme(run, event) != 0)
            run->failed = 1;
    return run->failed;
}

/* By name or by language, as en-gb. */
static int select_voice(const char *name)
{
    espeak_VOICE wanted = { 0 };
    if (espeak_SetVoiceByName(name) == EE_OK)
        return 0;
    wanted.languages = name;
    return espeak_SetVoiceByProperties(&wanted) == EE_OK ? 0 : -1;
}

int main(int argc, char **argv)
{
    static run_t run;
    speak_options_t options;
    const int result = speak_options(argc, argv, "labial-say-espeak", usage, &options);
    if (result != 0)
        return result - 1;
    int failed = 1;
    const int rate =
        espeak_Initialize(AUDIO_OUTPUT_SYNCHRONOUS, 0, NULL,
                          espeakINITIALIZE_PHONEME_EVENTS | espeakINITIALIZE_PHONEME_IPA | espeakINITIALIZE_DONT_EXIT);
    const char *voice = options.voice ? options.voice : "en-us";
    if (rate <= 0) {
        fprintf(stderr, "labial-say-espeak: espeak-ng finds no data: install the Debian package espeak-ng-data\n");
    } else if (select_voice(voice) != 0) {
        fprintf(stderr, "labial-say-espeak: espeak-ng has no voice '%s'\n", voice);
    } else if (speak_begin(&run.speak, &options, (unsigned)rate, LABIAL_LABELS_IPA) == 0) {
        closure_init(&run.closure, (unsigned)rate);
        espeak_SetSynthCallback(on_sound);
        if (espeak_Synth(options.text, strlen(options.text) + 1, 0, POS_CHARACTER, 0, espeakCHARS_UTF8, NULL, &run) !=
                EE_OK ||
            espeak_Synchronize() != EE_OK) {
            fprintf(stderr, "labial-say-espeak: espeak-ng could not synthesise this text\n");
            run.failed = 1;
        }
        if (!run.failed)
            run.failed = say(&run, speak_time(&run.speak)) != 0;
        failed = speak_end(&run.speak, !run.failed) != 0;
    }
    (void)espeak_Terminate();
    free(options.text);
    return failed;
}
