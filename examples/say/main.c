/*
 * labial-say - phoneme timings on standard input, lip motion on standard output, while it arrives.
 *
 *     flite -t "My baby may be happy." -psdur -o none | labial-say > motion.csv
 */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "frames.h"
#include "labial/labial.h"
#include "labial/names.h"
#include "laughter_synthetic.h"
#include "speech_en.h"
#include "timings.h"

/* Exit statuses. */
#define EXIT_INPUT 1
#define EXIT_USAGE 2

#define WORKSPACE_SIZE                                                                                      \
    (SPEECH_EN_WORKSPACE_SIZE > LAUGHTER_SYNTHETIC_WORKSPACE_SIZE ? SPEECH_EN_WORKSPACE_SIZE                \
                                                                  : LAUGHTER_SYNTHETIC_WORKSPACE_SIZE)

typedef struct {
    const char *name;
    const labial_model_t *model;
    const labial_names_t *names;
} voice_t;

static const voice_t voices[] = {
    {"speech_en", &speech_en, &speech_en_names},
    {"laughter_synthetic", &laughter_synthetic, &laughter_synthetic_names},
};

typedef struct {
    timings_format_t from;
    frames_format_t to;
    const voice_t *voice;
} options_t;

/* What runs between the two ends of the pipe. The stream is the caller's memory, as the library never allocates. */
typedef struct {
    const voice_t *voice;
    labial_t stream;
    uint32_t workspace[(WORKSPACE_SIZE + 3u) / 4u];
    timings_t timings;
    frames_t frames;
} say_t;

static const char usage_text[] =
    "usage: labial-say [--from FORMAT] [--to FORMAT] [--model MODEL] < timings > motion\n"
    "\n"
    "Reads phonemes with their timings and writes the motion of lips and jaw, frame by frame, while the input is\n"
    "still arriving.\n"
    "\n"
    "  --from flite    `flite -psdur`: label:end ..., seconds; every line starts again from 0\n"
    "         lab      start end label [apex [word]], a line each, seconds; gaps are silence\n"
    "         pho      MBROLA: label milliseconds [position pitch]..., a line each; ; comment, _ silence\n"
    "                  (default: told from the first line)\n"
    "  --to csv        time,fap3,fap16,...: seconds and 13 FAPs per frame (default)\n"
    "       fap        MPEG-4 text, 23 FAPs; its header holds the number of frames, so it is written at the end\n"
    "  --model MODEL   speech_en (default) or laughter_synthetic\n"
    "  --help          print this and exit\n"
    "  --version       print the version and exit\n"
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

static int read_options(int argc, char **argv, options_t *options)
{
    for (int i = 1; i < argc; i++) {
        const char *value;
        if ((value = option_value("--from", argc, argv, &i)) != NULL) {
            if (strcmp(value, "flite") == 0)
                options->from = TIMINGS_FLITE;
            else if (strcmp(value, "lab") == 0)
                options->from = TIMINGS_LAB;
            else if (strcmp(value, "pho") == 0)
                options->from = TIMINGS_PHO;
            else
                return wrong_usage("--from is flite, lab or pho, not", value);
        } else if ((value = option_value("--to", argc, argv, &i)) != NULL) {
            if (strcmp(value, "csv") == 0)
                options->to = FRAMES_CSV;
            else if (strcmp(value, "fap") == 0)
                options->to = FRAMES_FAP;
            else
                return wrong_usage("--to is csv or fap, not", value);
        } else if ((value = option_value("--model", argc, argv, &i)) != NULL) {
            options->voice = NULL;
            for (size_t v = 0; v < sizeof voices / sizeof voices[0]; v++)
                if (strcmp(value, voices[v].name) == 0)
                    options->voice = &voices[v];
            if (!options->voice)
                return wrong_usage("--model is speech_en or laughter_synthetic, not", value);
        } else {
            return wrong_usage("unknown argument", argv[i]);
        }
    }
    return 0;
}

/* ---- The pipe -------------------------------------------------------------------------------------------------- */

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    say_t *say = user;
    (void)frame;
    frames_put(&say->frames, faps);
}

/* Takes every frame that what was pushed so far allows. There is no clock to follow here, so a frame that is still
 * being computed is asked for again at once. Returns why there are no more, or an error. */
static int drain(say_t *say)
{
    int result;
    do {
        result = labial_tick(&say->stream);
    } while (result == LABIAL_OK || result == LABIAL_BUSY);
    return result;
}

/* Passes a phoneme from the text to the stream, and what frames it completes on to the output: the next byte may be
 * long in coming. */
static int on_phoneme(void *user, const timings_phoneme_t *phoneme)
{
    say_t *say = user;
    int number = say->voice->model->silence;
    if (phoneme->label)
        number = labial_find(say->voice->names, phoneme->label, strlen(phoneme->label));
    if (number < 0) {
        fprintf(stderr, "labial-say: line %lu: %s has no phoneme '%s'\n", say->timings.line, say->voice->name,
                phoneme->label);
        return -1;
    }
    int result = labial_room(&say->stream) > 0 ? LABIAL_OK : drain(say);
    if (result >= 0)
        result = labial_push(&say->stream, (unsigned)number, phoneme->milliseconds);
    if (result >= 0)
        result = drain(say);
    if (result < 0) {
        fprintf(stderr, "labial-say: line %lu: %s\n", say->timings.line, labial_result_text(result));
        return -1;
    }
    if (frames_flush(&say->frames) != 0) {
        fprintf(stderr, "labial-say: cannot write the motion\n");
        return -1;
    }
    return 0;
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
    say->voice = options->voice;
    int result = labial_init(&say->stream, options->voice->model, say->workspace, sizeof say->workspace, on_frame, say);
    if (result < 0) {
        fprintf(stderr, "labial-say: %s: %s\n", options->voice->name, labial_result_text(result));
        return EXIT_INPUT;
    }
    timings_init(&say->timings, options->from, on_phoneme, say);
    frames_init(&say->frames, stdout, options->to, options->voice->name, options->voice->model->frames_per_second);

    const int complete = read_timings(say) == 0;
    if (complete) {
        labial_end(&say->stream);
        result = drain(say);
        if (result < 0)
            fprintf(stderr, "labial-say: %s\n", labial_result_text(result));
    }
    if (frames_finish(&say->frames, complete) != 0) {
        if (complete)
            fprintf(stderr, "labial-say: cannot write the motion\n");
        return EXIT_INPUT;
    }
    return complete && result >= 0 ? 0 : EXIT_INPUT;
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
    options_t options = {TIMINGS_AUTO, FRAMES_CSV, &voices[0]};
    const int result = read_options(argc, argv, &options);
    if (result != 0)
        return result;
    static say_t say;
    return run(&say, &options);
}
