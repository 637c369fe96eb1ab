/*
 * labial-say-espeak - text in, sound and motion in step out, through the espeak-ng library.
 *
 *     labial-say-espeak hello.wav "Hello there." > hello.csv
 */
#include <espeak-ng/speak_lib.h>
#include <stdlib.h>
#include <string.h>

#include "speak.h"

static const char usage[] =
    "usage: labial-say-espeak [--to FORMAT] [--voice NAME] SOUND.wav TEXT > motion\n"
    "\n"
    "Speaks TEXT (UTF-8; `-`: standard input) with espeak-ng into SOUND.wav and writes the motion of lips and jaw in\n"
    "step with it, while it is being spoken: as long as the sound, a frame every 20 ms.\n"
    "\n"
    "  --voice NAME  a voice or language of espeak-ng (en-us)\n"
    "  --to FORMAT   csv (default), fap, livelink or jsonl, as of labial-say\n"
    "  --help        print this and exit\n"
    "\n"
    "Exit status: 0 success, 1 failure, 2 wrong usage.\n";

/* What a run needs while espeak calls back. An event tells where a phoneme starts, so that its end is known with the
 * next one only. */
typedef struct {
    speak_t speak;
    char label[sizeof(((espeak_EVENT *)0)->id.string) + 1];
    int failed;
} run_t;

static int on_phoneme(run_t *run, const espeak_EVENT *event)
{
    const uint64_t start = event->audio_position > 0 ? (uint64_t)event->audio_position : 0u;
    if (event->id.string[0] == '(') /* the name of a language, where words of another one begin */
        return 0;
    if (speak_phoneme(&run->speak, run->label[0] ? run->label : NULL, start) != 0)
        return -1;
    memcpy(run->label, event->id.string, sizeof run->label - 1); /* it has no NUL when it fills all bytes */
    run->label[sizeof run->label - 1] = '\0';
    return 0;
}

static int on_sound(short *samples, int count, espeak_EVENT *events)
{
    run_t *run = events->user_data;
    if (!run || run->failed)
        return 1;
    if (samples && count > 0 && speak_sound(&run->speak, samples, (size_t)count) != 0)
        run->failed = 1;
    for (const espeak_EVENT *event = events; !run->failed && event->type != espeakEVENT_LIST_TERMINATED; event++)
        if (event->type == espeakEVENT_PHONEME && on_phoneme(run, event) != 0)
            run->failed = 1;
    return run->failed;
}

/* By name or by language, as en-gb. */
static int select_voice(const char *name)
{
    espeak_VOICE wanted;
    if (espeak_SetVoiceByName(name) == EE_OK)
        return 0;
    memset(&wanted, 0, sizeof wanted);
    wanted.languages = name;
    return espeak_SetVoiceByProperties(&wanted) == EE_OK ? 0 : -1;
}

int main(int argc, char **argv)
{
    static run_t run;
    speak_options_t options;
    int result = speak_options(argc, argv, "labial-say-espeak", usage, &options);
    if (result != 0)
        return result - 1;
    const int rate = espeak_Initialize(AUDIO_OUTPUT_SYNCHRONOUS, 0, NULL,
                                       espeakINITIALIZE_PHONEME_EVENTS | espeakINITIALIZE_PHONEME_IPA |
                                           espeakINITIALIZE_DONT_EXIT);
    const char *voice = options.voice ? options.voice : "en-us";
    if (rate <= 0) {
        fprintf(stderr, "labial-say-espeak: espeak-ng finds no data: install the Debian package espeak-ng-data\n");
        result = -1;
    } else if (select_voice(voice) != 0) {
        fprintf(stderr, "labial-say-espeak: espeak-ng has no voice '%s'\n", voice);
        result = -1;
    } else if (speak_begin(&run.speak, &options, (unsigned)rate, LABIAL_LABELS_IPA) != 0) {
        result = -1;
    } else {
        espeak_SetSynthCallback(on_sound);
        if (espeak_Synth(options.text, strlen(options.text) + 1, 0, POS_CHARACTER, 0, espeakCHARS_UTF8, NULL, &run) !=
                EE_OK ||
            espeak_Synchronize() != EE_OK) {
            fprintf(stderr, "labial-say-espeak: espeak-ng does not speak this text\n");
            result = -1;
        }
        if (result == 0 && !run.failed && run.label[0])
            run.failed = speak_phoneme(&run.speak, run.label, speak_time(&run.speak)) != 0;
        if (speak_end(&run.speak, result == 0 && !run.failed) != 0)
            result = -1;
    }
    (void)espeak_Terminate();
    free(options.text);
    return result == 0 ? 0 : 1;
}
