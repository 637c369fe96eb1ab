/*
 * labial-hear - the sound of speech in, lip motion on standard output, while it arrives.
 *
 *     labial-hear hello.wav > motion.csv
 *     arecord -q -t raw -f S16_LE -r 16000 | labial-hear - --to jsonl
 */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "common.h"
#include "frames.h"
#include "hearing.h"
#include "labial/hear.h"
#include "wav.h"

/* The exit status for what is wrong with the input. */
#define EXIT_INPUT 1

#define DEFAULT_RATE 16000
#define RATE_MAX 1000000

/* Milliseconds of a frame; blocks of sound in a second, and room for a block of the highest rate with two channels. */
#define FRAME_MS (1000 / LABIAL_HEAR_FPS)
#define BLOCKS_PER_SECOND 100
#define BLOCK_MAX (2 * 48000 / BLOCKS_PER_SECOND)

/* Two channels cancel each other where their mean has less than a hundredth of their energy, once they have that of a
 * faint sound: 10 ms of 16 kHz at 80 of 32,768. */
#define CANCELLED 100.0
#define FAINT 1e6

typedef struct {
    const char *name;
    const labial_hear_model_t *model;
    const char *const *classes;
} hear_model_t;

static const hear_model_t models[] = { LABIAL_BUNDLED_HEARING };
#define MODELS ((unsigned)(sizeof models / sizeof models[0]))

/* Numbers are places in the lists of what there is; a rate or channels of 0 are not given. */
typedef struct {
    const char *sound;
    unsigned to, model, rate, channels;
    int to_given, classes, exact;
} options_t;

typedef struct {
    const char *sound; /* for messages */
    const hear_model_t *model;
    labial_hear_t stream;
    uint32_t workspace[LABIAL_HEAR_WORKSPACE_SIZE(LABIAL_HEAR_UNITS_MAX, LABIAL_HEAR_ROWS_MAX) / 4u]; /* for any */
    wav_t wav;
    frames_t frames;
    int classes;
    double each, mean; /* energy of two channels: the mean of theirs, that of their mean */
} hear_t;

static const char usage_begin[] =
    "usage: labial-hear SOUND.wav [--to FORMAT] [--model MODEL] > motion\n"
    "       labial-hear - [--rate RATE] [--channels N] [--to FORMAT] [--model MODEL] < samples > motion\n"
    "\n"
    "Hears speech and writes the motion of lips and jaw, frame by frame, while the sound is still arriving. Frame k\n"
    "shows the lips in the 20 ms that begin at 20 k ms; it is written when the model has heard what follows.\n"
    "\n"
    "  SOUND.wav       PCM, floating point, A-law or mu-law; one or two channels; 8000, 12000, 16000, 22050, 24000,\n"
    "                  32000, 44100 or 48000 samples per second\n"
    "  -               standard input: a WAV file, or samples of 16 bits without a header, low byte first\n"
    "  --rate RATE     of samples without a header: how many a second (16000)\n"
    "  --channels N    of samples without a header: 1, or 2, of which the mean is heard (1)\n"
    "  --exact         exactly the frames of the sound: the face does not come to rest after the last one\n"
    "  --classes       not motion but a .lab file: the phonemes that stand for the lip shapes heard, with their "
    "times\n";

static const char usage_end[] = "  --help          print this and exit\n"
                                "  --version       print the version and exit\n"
                                "\n"
                                "Exit status: 0 success, 1 malformed sound or failure to write, 2 wrong usage.\n";

/* ---- Options --------------------------------------------------------------------------------------------------- */

/* The name for --model, that of the model without hear_. */
static const char *model_name(unsigned number)
{
    return number < MODELS ? strchr(models[number].name, '_') + 1 : NULL;
}

static unsigned default_model(void)
{
    unsigned number = MODELS - 1u;
    while (number > 0 && strcmp(model_name(number), "small") != 0)
        number--;
    return number;
}

static int read_number(const char *problem, const char *value, unsigned most, unsigned *number)
{
    if (option_number(value, most, number) != 0 || *number == 0)
        return options_wrong("labial-hear", problem, value);
    return 0;
}

static int read_options(int argc, char **argv, options_t *options)
{
    for (int i = 1; i < argc; i++) {
        const char *value;
        int result = 0;
        if ((value = option_value("--to", argc, argv, &i)) != NULL) {
            result = choose("labial-hear", "--to", value, frames_format_name, &options->to);
            options->to_given = 1;
        } else if ((value = option_value("--model", argc, argv, &i)) != NULL) {
            result = choose("labial-hear", "--model", value, model_name, &options->model);
        } else if ((value = option_value("--rate", argc, argv, &i)) != NULL) {
            result =
                read_number("--rate is a whole number of samples per second, not", value, RATE_MAX, &options->rate);
        } else if ((value = option_value("--channels", argc, argv, &i)) != NULL) {
            result = read_number("--channels is 1 or 2, not", value, 2, &options->channels);
        } else if (strcmp(argv[i], "--classes") == 0) {
            options->classes = 1;
        } else if (strcmp(argv[i], "--exact") == 0) {
            options->exact = 1;
        } else if (argv[i][0] == '-' && argv[i][1] != '\0') {
            result = options_wrong("labial-hear", "unknown option", argv[i]);
        } else if (options->sound) {
            result = options_wrong("labial-hear", "one argument too many:", argv[i]);
        } else {
            options->sound = argv[i];
        }
        if (result != 0)
            return result;
    }
    if (!options->sound)
        return options_wrong("labial-hear", "the sound is missing: a WAV file or", "-");
    if ((options->rate || options->channels) && strcmp(options->sound, "-") != 0)
        return options_wrong("labial-hear", "--rate and --channels go with -, not with", options->sound);
    if (options->classes && options->to_given)
        return options_wrong("labial-hear", "--to selects a format of motion and does not go with", "--classes");
    if (!options->rate)
        options->rate = DEFAULT_RATE;
    if (!options->channels)
        options->channels = 1;
    return 0;
}

static void print_usage(void)
{
    fputs(usage_begin, stdout);
    frames_help(stdout);
    for (unsigned i = 0; i < MODELS; i++)
        printf("%s%s%s", i == 0 ? "  --model MODEL   " : ", ", model_name(i), i == default_model() ? " (default)" : "");
    putchar('\n');
    fputs(usage_end, stdout);
}

/* ---- The pipe -------------------------------------------------------------------------------------------------- */

static int failed(const hear_t *hear, const char *why)
{
    fprintf(stderr, "labial-hear: %s: %s\n", hear->sound, why);
    return EXIT_INPUT;
}

static void warning(const hear_t *hear, const char *what)
{
    fprintf(stderr, "labial-hear: warning: %s: %s\n", hear->sound, what);
}

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    hear_t *hear = user;
    (void)frame;
    if (!hear->classes)
        frames_put(&hear->frames, faps, NULL);
}

static void write_time(uint32_t frame)
{
    const uint64_t milliseconds = (uint64_t)frame * FRAME_MS;
    printf("%" PRIu64 ".%03u ", milliseconds / 1000u, (unsigned)(milliseconds % 1000u));
}

static void on_class(void *user, unsigned shown, uint32_t frame, uint32_t frames)
{
    const hear_t *hear = user;
    write_time(frame);
    write_time(frame + frames);
    printf("%s\n", hear->model->classes[shown]);
}

/* What was written goes on its way. */
static int flush(hear_t *hear)
{
    const int result = hear->classes ? fflush(stdout) != 0 || ferror(stdout) : frames_flush(&hear->frames) != 0;
    return result ? failed(hear, "cannot write what was heard") : 0;
}

static int cancelled(const hear_t *hear)
{
    return hear->each >= FAINT && hear->mean * CANCELLED < hear->each;
}

/* Reads as wav_read() does. Where two channels cancel each other, their mean would be silence: the second one becomes the
 * first. */
static long read_block(hear_t *hear, int16_t *samples, size_t count)
{
    const long read = wav_read(&hear->wav, samples, count);
    if (hear->wav.channels != 2)
        return read;
    for (long i = 0; i < read; i++) {
        const double a = samples[2 * i], b = samples[2 * i + 1];
        hear->each += (a * a + b * b) / 2.0;
        hear->mean += (a + b) * (a + b) / 4.0;
    }
    for (long i = 0; i < read && cancelled(hear); i++)
        samples[2 * i + 1] = samples[2 * i];
    return read;
}

static int hear_all(hear_t *hear)
{
    int16_t samples[BLOCK_MAX];
    const size_t count = hear->wav.rate / BLOCKS_PER_SECOND; /* a rate that the stream accepted */
    int warned = 0;
    uint64_t all = 0;
    long read;
    do {
        read = read_block(hear, samples, count);
        if (read < 0)
            return failed(hear, hear->wav.message);
        all += (uint64_t)read;
        if (cancelled(hear) && !warned) {
            warned = 1;
            warning(hear, "its two channels cancel each other, so the first one is heard alone");
        }
        (void)labial_hear_push(&hear->stream, samples, (size_t)read);
        if (flush(hear) != 0)
            return EXIT_INPUT;
    } while ((size_t)read == count);
    if (all == 0 && hear->wav.place > 0)
        return failed(hear, "the sound is empty: it has no samples");
    if (hear->wav.cut > 0) {
        const double promised = wav_seconds(&hear->wav, hear->wav.size);
        char what[80];
        (void)snprintf(what, sizeof what, "the file is cut off: %.2f of %.2f s are there",
                       promised - wav_seconds(&hear->wav, hear->wav.cut), promised);
        warning(hear, what);
    }
    (void)labial_hear_end(&hear->stream);
    return 0;
}

/* Begins the stream. */
static int begin(hear_t *hear, labial_frame_fn callback)
{
    const int result = labial_hear_init(&hear->stream, hear->model->model, hear->wav.rate, hear->wav.channels,
                                        hear->workspace, sizeof hear->workspace, callback, hear);
    if (result < 0) {
        char why[160];
        (void)snprintf(why, sizeof why, "%" PRIu32 " samples per second, channels: %u: %s", hear->wav.rate,
                       hear->wav.channels, labial_result_text(result));
        return failed(hear, why);
    }
    return 0;
}

static void ignore_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)user;
    (void)frame;
    (void)faps;
}

/* Hears the file to find the level of its voice, the largest there is, and goes back to the first sample. Leaves it at 0,
 * unknown, for what cannot be read twice, such as a pipe. What is wrong with the file is told when it is heard. */
static int measure(hear_t *hear, unsigned *level)
{
    int16_t samples[BLOCK_MAX];
    const wav_t first = hear->wav;
    FILE *const in = hear->wav.in;
    const long place = ftell(in);
    const size_t count = hear->wav.rate / BLOCKS_PER_SECOND;
    long read;
    *level = 0;
    if (place < 0 || fseek(in, place, SEEK_SET) != 0)
        return 0;
    if (begin(hear, ignore_frame) != 0)
        return EXIT_INPUT;
    *level = LABIAL_HEAR_LEVEL_MIN;
    (void)labial_hear_set_level(&hear->stream, *level);
    do {
        read = read_block(hear, samples, count);
        if (read > 0)
            (void)labial_hear_push(&hear->stream, samples, (size_t)read);
        if (labial_hear_level(&hear->stream) > *level)
            *level = labial_hear_level(&hear->stream);
    } while (read >= 0 && (size_t)read == count);
    hear->wav = first;
    clearerr(in);
    return fseek(in, place, SEEK_SET) == 0 ? 0 : failed(hear, "cannot be read a second time");
}

/* The sound is open, and how it is to be read is known. */
static int run(hear_t *hear, const options_t *options)
{
    unsigned level = 0;
    hear->model = &models[options->model];
    if (hear->wav.in != stdin && measure(hear, &level) != 0)
        return EXIT_INPUT;
    if (begin(hear, on_frame) != 0)
        return EXIT_INPUT;
    if (level > 0)
        (void)labial_hear_set_level(&hear->stream, level);
    (void)labial_hear_exact(&hear->stream, options->exact);
    hear->classes = options->classes;
    if (hear->classes) {
        (void)labial_hear_classes(&hear->stream, on_class);
        const int status = hear_all(hear);
        return status == 0 ? flush(hear) : status;
    }
    frames_init(&hear->frames, stdout, options->to, hear->model->name, LABIAL_HEAR_FPS);
    const int status = hear_all(hear);
    if (frames_finish(&hear->frames, status == 0) != 0 && status == 0)
        return failed(hear, "cannot write what was heard");
    return status;
}

static int open_and_run(hear_t *hear, const options_t *options)
{
    const int piped = strcmp(options->sound, "-") == 0;
    FILE *const in = piped ? stdin : fopen(options->sound, "rb");
    hear->sound = piped ? "standard input" : options->sound;
    if (!in)
        return failed(hear, "cannot open");
    const int opened = wav_open(&hear->wav, in, piped ? options->rate : 0, options->channels);
    const int status = opened == 0 ? run(hear, options) : failed(hear, hear->wav.message);
    if (!piped)
        fclose(in);
    return status;
}

int main(int argc, char **argv)
{
    if (options_ask("labial-hear", argc, argv, print_usage))
        return 0;
    options_t options = { NULL, 0, default_model(), 0, 0, 0, 0, 0 };
    const int result = read_options(argc, argv, &options);
    if (result != 0)
        return result;
    static hear_t hear;
    return open_and_run(&hear, &options);
}
