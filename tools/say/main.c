/*
 * labial-say - phoneme timings on standard input, lip motion on standard output, while it arrives.
 *
 *     flite -t "My baby may be happy." -psdur -o none | labial-say > motion.csv
 */
#include <stdio.h>
#include <string.h>

#include "common.h"
#include "mouth.h"
#include "timings.h"

/* The exit status for what is wrong with the input. */
#define EXIT_INPUT 1

/* Numbers are places in the lists of what there is. */
typedef struct {
    unsigned from, to, labels, model;
    unsigned articulation; /* percent */
    int exact;
    const char *tier;
} options_t;

typedef struct {
    mouth_t mouth;
    timings_t timings;
    labial_labels_t labels;
} say_t;

static const char usage_begin[] =
    "usage: labial-say [--from FORMAT] [--to FORMAT] [--model MODEL] < timings > motion\n"
    "\n"
    "Reads phonemes with their timings and writes the motion of lips and jaw, frame by frame, while the input is\n"
    "still arriving.\n"
    "\n";

static const char usage_middle[] =
    "  --tier NAME     the tier of a TextGrid\n"
    "  --labels SET    arpabet (also flite's), ipa (also espeak's and Montreal Forced Aligner's) or xsampa (also\n"
    "                  MBROLA's and MARY's): what labels mean. auto takes any, and where they differ X-SAMPA in pho\n"
    "                  and mary, elsewhere ARPABET (default). Unknown ones move as the nearest, with one warning "
    "each\n"
    "  --articulation PERCENT\n"
    "                  how far the mouth moves, 0 to 200: 50 is a mumble, 130 a shout (100)\n"
    "  --exact         exactly the frames of the phonemes: the face does not come to rest after the last one\n";

static const char usage_end[] =
    "  --help          print this and exit\n"
    "  --version       print the version and exit\n"
    "\n"
    "Laughs: `<laugh SECONDS [INTENSITY]>` on a line of its own, or between flite's phonemes, is laughed there, and\n"
    "what follows comes later by as much. The label `<laugh>` or `<laugh:INTENSITY>` in the place of a phoneme's is\n"
    "laughed for the time that the row gives it. Intensity is 0 to 1; it is 0.5 when left out.\n"
    "\n"
    "Exit status: 0 success, 1 malformed input or failure to write, 2 wrong usage.\n";

/* ---- Options --------------------------------------------------------------------------------------------------- */

static const struct {
    const char *name;
    labial_labels_t labels;
} label_sets[] = {
    { "auto", LABIAL_LABELS_AUTO },
    { "arpabet", LABIAL_LABELS_ARPABET },
    { "ipa", LABIAL_LABELS_IPA },
    { "xsampa", LABIAL_LABELS_XSAMPA },
};

static const char *label_set_name(unsigned number)
{
    return number < sizeof label_sets / sizeof label_sets[0] ? label_sets[number].name : NULL;
}

static int read_options(int argc, char **argv, options_t *options)
{
    for (int i = 1; i < argc; i++) {
        const char *value;
        int result = 0;
        if ((value = option_value("--from", argc, argv, &i)) != NULL) {
            result = choose("labial-say", "--from", value, labial_timings_format_name, &options->from);
        } else if ((value = option_value("--to", argc, argv, &i)) != NULL) {
            result = choose("labial-say", "--to", value, frames_format_name, &options->to);
        } else if ((value = option_value("--tier", argc, argv, &i)) != NULL) {
            options->tier = value;
            if (*value == '\0')
                result = options_wrong("labial-say", "--tier is the name of a tier, not", value);
        } else if ((value = option_value("--labels", argc, argv, &i)) != NULL) {
            result = choose("labial-say", "--labels", value, label_set_name, &options->labels);
        } else if ((value = option_value("--articulation", argc, argv, &i)) != NULL) {
            if (option_number(value, LABIAL_ARTICULATION_MAX, &options->articulation) != 0)
                result = options_wrong("labial-say", "--articulation is a whole number from 0 to 200, not", value);
        } else if (strcmp(argv[i], "--exact") == 0) {
            options->exact = 1;
        } else if ((value = option_value("--model", argc, argv, &i)) != NULL) {
            result = choose("labial-say", "--model", value, mouth_voice_name, &options->model);
        } else {
            result = options_wrong("labial-say", "unknown argument", argv[i]);
        }
        if (result != 0)
            return result;
    }
    return 0;
}

static void print_usage(void)
{
    fputs(usage_begin, stdout);
    for (unsigned i = 0; labial_timings_format_name(i); i++)
        printf("  %-6s %-8s %s\n", i == 0 ? "--from" : "", labial_timings_format_name(i),
               labial_timings_format_help(i));
    fputs(usage_middle, stdout);
    frames_help(stdout);
    for (unsigned i = 0; mouth_voice_name(i); i++)
        printf("%s%s%s", i == 0 ? "  --model MODEL   " : ", ", mouth_voice_name(i), i == 0 ? " (default)" : "");
    putchar('\n');
    fputs(usage_end, stdout);
}

/* ---- The pipe -------------------------------------------------------------------------------------------------- */

/* What was asked for; where that is nothing, labels of a format that has X-SAMPA are that first. */
static labial_labels_t labels_of(const say_t *say, const timings_phoneme_t *phoneme)
{
    const char *label = phoneme->label;
    if (say->labels == LABIAL_LABELS_AUTO && phoneme->xsampa && label &&
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
static int read_timings(say_t *say, const options_t *options)
{
    timings_t *timings = &say->timings;
    const int result =
        timings_read(timings, stdin, (labial_timings_format_t)options->from, options->tier, on_phoneme, say);
    if (result < 0 && timings->line > 0)
        fprintf(stderr, "labial-say: line %lu: %s\n", timings->line, timings->message);
    else if (result < 0)
        fprintf(stderr, "labial-say: %s\n", timings->message);
    return result == 0 ? 0 : -1;
}

static int run(say_t *say, const options_t *options)
{
    if (mouth_init(&say->mouth, "labial-say", &mouth_voices[options->model], stdout, options->to) != 0)
        return EXIT_INPUT;
    (void)labial_articulation(&say->mouth.stream, options->articulation);
    (void)labial_exact(&say->mouth.stream, options->exact);
    say->labels = label_sets[options->labels].labels;
    return mouth_end(&say->mouth, read_timings(say, options) == 0) == 0 ? 0 : EXIT_INPUT;
}

int main(int argc, char **argv)
{
    if (options_ask("labial-say", argc, argv, print_usage))
        return 0;
    options_t options = { 0, 0, 0, 0, 100, 0, NULL };
    const int result = read_options(argc, argv, &options);
    if (result != 0)
        return result;
    static say_t say;
    return run(&say, &options);
}
