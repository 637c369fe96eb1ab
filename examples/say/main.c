/*
 * labial-say - phoneme timings on standard input, lip motion on standard output, while it arrives.
 *
 *     flite -t "My baby may be happy." -psdur -o none | labial-say > motion.csv
 */
#include <stdio.h>
#include <string.h>

#include "mouth.h"
#include "timings.h"

/* Exit statuses. */
#define EXIT_INPUT 1
#define EXIT_USAGE 2

typedef struct {
    timings_format_t from;
    frames_format_t to;
    const mouth_voice_t *voice;
    const char *tier;
    labial_labels_t labels;
} options_t;

typedef struct {
    mouth_t mouth;
    timings_t timings;
    labial_labels_t labels;
} say_t;

/* In the order of timings_format_t. */
static const char *const format_names[] = { "auto", "flite", "lab", "htk", "pho", "mary", "phseg", "textgrid" };

static const char usage_text[] =
    "usage: labial-say [--from FORMAT] [--to FORMAT] [--model MODEL] < timings > motion\n"
    "\n"
    "Reads phonemes with their timings and writes the motion of lips and jaw, frame by frame, while the input is\n"
    "still arriving.\n"
    "\n"
    "  --from flite    `flite -psdur`: label:end ..., seconds; every line starts again from 0\n"
    "         lab      start end label [apex [word]], a line each, seconds; gaps are silence\n"
    "         htk      start end label, a line each, units of 100 ns; also HTS's labels with context, a^b-c+d=e\n"
    "         pho      MBROLA: label milliseconds [position pitch]..., a line each; ; comment, _ silence\n"
    "         mary     MaryTTS REALISED_DURATIONS: a line of #, then end number label, a line each, seconds\n"
    "         phseg    CMU Sphinx: SFrm EFrm SegAScr Phone, frames of 10 ms\n"
    "         textgrid Praat or Montreal Forced Aligner; the tier of phones is found by its name\n"
    "                  (default: told from the first line)\n"
    "  --tier NAME     the tier of a TextGrid\n"
    "  --labels SET    arpabet (also flite's), ipa (also espeak's and Montreal Forced Aligner's) or xsampa (also\n"
    "                  MBROLA's and MARY's): what labels mean. auto takes any, and where they differ X-SAMPA in pho\n"
    "                  and mary, elsewhere ARPABET (default). Unknown ones move as the nearest, with one warning each\n"
    "  --to csv        time,fap3,fap16,...: seconds and 13 FAPs per frame (default)\n"
    "       fap        MPEG-4 text, 23 FAPs; its header holds the number of frames, so it is written at the end\n"
    "       livelink   Live Link Face CSV: ARKit's blendshapes, 0 to 1\n"
    "       jsonl      a JSON object per frame: FAPs and ARKit's blendshapes of the mouth\n"
    "       arkit      a JSON object per frame: weights, 0 to 1, of ARKit's blendshapes of the mouth,\n"
    "       vrm        of VRM's aa, ih, ou, ee, oh,\n"
    "       oculus     of the 15 visemes of Oculus LipSync\n"
    "  --model MODEL   speech_en (default) or laughter_synthetic\n"
    "  --help          print this and exit\n"
    "  --version       print the version and exit\n"
    "\n"
    "Laughs: `<laugh SECONDS [INTENSITY]>` on a line of its own, or between flite's phonemes, is laughed there, and\n"
    "what follows comes later by as much. The label `<laugh>` or `<laugh:INTENSITY>` in the place of a phoneme's is\n"
    "laughed for the time that the row gives it. Intensity is 0 to 1; it is 0.5 when left out.\n"
    "\n"
    "Exit status: 0 success, 1 malformed input or failure to write, 2 wrong usage.\n";

/* ---- Options --------------------------------------------------------------------------------------------------- */

/* The value of option `name` at argv[*i], as `--name value` or `--name=value`; null when it is another option. A
 * missing value is the empty string, which no option accepts. */
static const char *option_value(const char *name, int argc, char **argv, int *i)
{
    const size_t length = strlen(name);
    if (strncmp(argv[*i], name, length) != 0)
        return NULL;
    if (argv[*i][length] == '=')
        return argv[*i] + length + 1;
    if (argv[*i][length] != '\0')
        return NULL;
    return *i + 1 < argc ? argv[++*i] : "";
}

static int wrong_usage(const char *problem, const char *value)
{
    fprintf(stderr, "labial-say: %s '%s'; see labial-say --help\n", problem, value);
    return EXIT_USAGE;
}

static int read_from(options_t *options, const char *value)
{
    for (size_t f = 0; f < sizeof format_names / sizeof format_names[0]; f++)
        if (strcmp(value, format_names[f]) == 0) {
            options->from = (timings_format_t)f;
            return 0;
        }
    return wrong_usage("--from is flite, lab, htk, pho, mary, phseg or textgrid, not", value);
}

static int read_labels(options_t *options, const char *value)
{
    static const struct {
        const char *name;
        labial_labels_t labels;
    } sets[] = { { "auto", LABIAL_LABELS_AUTO },
                 { "arpabet", LABIAL_LABELS_ARPABET },
                 { "ipa", LABIAL_LABELS_IPA },
                 { "xsampa", LABIAL_LABELS_XSAMPA } };
    for (size_t s = 0; s < sizeof sets / sizeof sets[0]; s++)
        if (strcmp(value, sets[s].name) == 0) {
            options->labels = sets[s].labels;
            return 0;
        }
    return wrong_usage("--labels is arpabet, ipa, xsampa or auto, not", value);
}

static int read_options(int argc, char **argv, options_t *options)
{
    for (int i = 1; i < argc; i++) {
        const char *value;
        int result = 0;
        if ((value = option_value("--from", argc, argv, &i)) != NULL) {
            result = read_from(options, value);
        } else if ((value = option_value("--to", argc, argv, &i)) != NULL) {
            const int format = frames_format_of(value);
            if (format < 0)
                result = wrong_usage("--to is " FRAMES_FORMATS ", not", value);
            else
                options->to = (frames_format_t)format;
        } else if ((value = option_value("--tier", argc, argv, &i)) != NULL) {
            options->tier = value;
            if (*value == '\0')
                result = wrong_usage("--tier is the name of a tier, not", value);
        } else if ((value = option_value("--labels", argc, argv, &i)) != NULL) {
            result = read_labels(options, value);
        } else if ((value = option_value("--model", argc, argv, &i)) != NULL) {
            options->voice = strcmp(value, mouth_speech.name) == 0 ? &mouth_speech : &mouth_laughter;
            if (options->voice == &mouth_laughter && strcmp(value, mouth_laughter.name) != 0)
                result = wrong_usage("--model is speech_en or laughter_synthetic, not", value);
        } else {
            result = wrong_usage("unknown argument", argv[i]);
        }
        if (result != 0)
            return result;
    }
    return 0;
}

/* ---- The pipe -------------------------------------------------------------------------------------------------- */

/* What was asked for; where that is nothing, labels of a format that has X-SAMPA are that first. */
static labial_labels_t labels_of(const say_t *say, const timings_phoneme_t *phoneme)
{
    const char *label = phoneme->label;
    if (say->labels == LABIAL_LABELS_AUTO && phoneme->sampa && label &&
        labial_find_in(say->mouth.voice->names, LABIAL_LABELS_XSAMPA, label, strlen(label)) >= 0)
        return LABIAL_LABELS_XSAMPA;
    return say->labels;
}

static int on_phoneme(void *user, const timings_phoneme_t *phoneme)
{
    say_t *say = user;
    char where[48];
    (void)snprintf(where, sizeof where, "line %lu: ", say->timings.line);
    if (phoneme->laugh >= 0)
        return mouth_laugh(&say->mouth, where, phoneme->milliseconds, (unsigned)phoneme->laugh);
    return mouth_say(&say->mouth, where, phoneme->label, labels_of(say, phoneme), phoneme->milliseconds);
}

/* Reads standard input to its end. Returns 0, or -1 after the error was printed. */
static int read_timings(say_t *say)
{
    int result = 0;
    int byte;
    while (result == 0 && (byte = getchar()) != EOF)
        result = timings_put(&say->timings, (unsigned char)byte);
    if (result == 0 && ferror(stdin)) {
        fprintf(stderr, "labial-say: line %lu: cannot read the timings\n", say->timings.line);
        return -1;
    }
    if (result == 0)
        result = timings_end(&say->timings);
    if (result == TIMINGS_MALFORMED)
        fprintf(stderr, "labial-say: line %lu: %s\n", say->timings.line, say->timings.message);
    return result == 0 ? 0 : -1;
}

static int run(say_t *say, const options_t *options)
{
    if (mouth_init(&say->mouth, "labial-say", options->voice, stdout, options->to) != 0)
        return EXIT_INPUT;
    say->labels = options->labels;
    timings_init(&say->timings, options->from, options->tier, on_phoneme, say);
    const int complete = read_timings(say) == 0;
    timings_free(&say->timings);
    if (complete)
        return mouth_end(&say->mouth) == 0 ? 0 : EXIT_INPUT;
    mouth_drop(&say->mouth);
    return EXIT_INPUT;
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "--help") == 0) {
        fputs(usage_text, stdout);
        return 0;
    }
    if (argc == 2 && strcmp(argv[1], "--version") == 0) {
        printf("labial-say %d.%d.%d\n", LABIAL_VERSION_MAJOR, LABIAL_VERSION_MINOR, LABIAL_VERSION_PATCH);
        return 0;
    }
    options_t options = { TIMINGS_AUTO, FRAMES_CSV, &mouth_speech, NULL, LABIAL_LABELS_AUTO };
    const int result = read_options(argc, argv, &options);
    if (result != 0)
        return result;
    static say_t say;
    return run(&say, &options);
}
