/*
 * labial-say-flite - converts text to sound and motion in step, with the flite library.
 *
 *     labial-say-flite hello.wav "Hello there." > hello.csv
 */
#include <flite/flite.h>
#include <stdlib.h>
#include <string.h>

#include "speak.h"

/* The voice's library has no header for it. */
cst_voice *register_cmu_us_slt(const char *folder);

static const char usage[] =
    "usage: labial-say-flite [--to FORMAT] SOUND.wav TEXT > motion\n"
    "\n"
    "Speaks TEXT (`-`: standard input) with flite's voice slt into SOUND.wav and writes the motion of lips and jaw in\n"
    "step with it: as long as the sound, a frame every 20 ms. Each line of the text is an utterance.\n"
    "\n"
    "  --to FORMAT   any that `labial-say --help` lists (csv)\n"
    "  --help        print this and exit\n"
    "\n"
    "Exit status: 0 success, 1 failure, 2 wrong usage.\n";

/* The phonemes of an utterance that begins `start` milliseconds into the sound and ends at its current end. */
static int say_segments(speak_t *speak, const cst_utterance *utterance, uint64_t start)
{
    const uint64_t stop = speak_time(speak);
    for (const cst_item *item = relation_head(utt_relation(utterance, "Segment")); item; item = item_next(item)) {
        const float seconds = item_feat_float(item, "end"); /* from the start of the utterance */
        uint64_t end = start + (seconds > 0.0f ? (uint64_t)(seconds * 1000.0f + 0.5f) : 0u);
        if (end > stop || !item_next(item))
            end = stop;
        if (speak_phoneme(speak, item_name(item), end) != 0)
            return -1;
    }
    return 0;
}

static int say_line(speak_t *speak, const speak_options_t *options, const char *line, cst_voice *voice, int *begun)
{
    cst_utterance *utterance = flite_synth_text(line, voice);
    const cst_wave *wave = utterance ? utt_wave(utterance) : NULL;
    int result = 0;
    if (!wave || wave->num_samples < 0 || wave->sample_rate <= 0 || wave->num_channels > 1) {
        fprintf(stderr, "labial-say-flite: flite could not synthesise '%.40s'\n", line);
        result = -1;
    }
    if (result == 0 && !*begun) {
        result = speak_begin(speak, options, (unsigned)wave->sample_rate, LABIAL_LABELS_ARPABET);
        *begun = result == 0;
    }
    if (result == 0) {
        const uint64_t start = speak_time(speak);
        result = speak_sound(speak, wave->samples, (size_t)wave->num_samples);
        if (result == 0)
            result = say_segments(speak, utterance, start);
    }
    if (utterance)
        delete_utterance(utterance);
    return result;
}

int main(int argc, char **argv)
{
    static speak_t speak;
    speak_options_t options;
    int result = speak_options(argc, argv, "labial-say-flite", usage, &options);
    if (result != 0)
        return result - 1;
    if (options.voice) {
        fputs("labial-say-flite: there is one voice only, so no --voice; see labial-say-flite --help\n", stderr);
        free(options.text);
        return 2;
    }
    flite_init();
    cst_voice *voice = register_cmu_us_slt(NULL);
    int begun = 0;
    for (char *line = strtok(options.text, "\r\n"); line && result == 0; line = strtok(NULL, "\r\n"))
        if (strspn(line, " \t") < strlen(line))
            result = say_line(&speak, &options, line, voice, &begun);
    if (begun && speak_end(&speak, result == 0) != 0)
        result = -1;
    free(options.text);
    return result == 0 ? 0 : 1;
}
