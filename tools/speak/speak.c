/*
 * speak.c - writes the sound file, and converts ends of phonemes to durations (speak.h).
 */
#include "speak.h"

#include <stdlib.h>
#include <string.h>

#include "common.h"

/* Bytes of a WAV header without extensions, and the most bytes of sound that its size fields can hold. */
#define HEADER_BYTES 44u
#define SOUND_MAX (0xffffffffu - HEADER_BYTES)

/* Most bytes of text. */
#define TEXT_MAX 1000000u

/* ---- Options --------------------------------------------------------------------------------------------------- */

static char *read_text(FILE *in)
{
    char *text = malloc(TEXT_MAX + 1);
    if (!text)
        return NULL;
    const size_t length = fread(text, 1, TEXT_MAX, in);
    text[length] = '\0';
    if (ferror(in) || length == TEXT_MAX || strlen(text) != length) {
        free(text);
        return NULL;
    }
    return text;
}

int speak_options(int argc, char **argv, const char *program, const char *usage, speak_options_t *options)
{
    const char *text = NULL;
    memset(options, 0, sizeof *options);
    options->program = program;
    for (int i = 1; i < argc; i++) {
        const char *value = i + 1 < argc ? argv[i + 1] : "";
        if (strcmp(argv[i], "--help") == 0) {
            fputs(usage, stdout);
            return 1;
        }
        if (strcmp(argv[i], "--to") == 0) {
            if (choose(program, "--to", value, frames_format_name, &options->to) != 0)
                return OPTIONS_WRONG + 1;
            i++;
        } else if (strcmp(argv[i], "--voice") == 0) {
            options->voice = value;
            i++;
        } else if (argv[i][0] == '-' && argv[i][1] != '\0') {
            return options_wrong(program, "unknown option", argv[i]) + 1;
        } else if (!options->sound) {
            options->sound = argv[i];
        } else if (!text) {
            text = argv[i];
        } else {
            return options_wrong(program, "one argument too many:", argv[i]) + 1;
        }
    }
    if (!text)
        return options_wrong(program, "the sound file and the text are needed, not only",
                             options->sound ? options->sound : "") +
               1;
    if (strcmp(text, "-") == 0)
        options->text = read_text(stdin);
    else if ((options->text = malloc(strlen(text) + 1)) != NULL)
        strcpy(options->text, text);
    if (!options->text) {
        fprintf(stderr, "%s: out of memory, or standard input cannot be read, is not text, or exceeds %u bytes\n",
                program, TEXT_MAX);
        return 1 + 1;
    }
    if (options->text[strspn(options->text, " \t\r\n")] == '\0') {
        fprintf(stderr, "%s: there is no text to speak\n", program);
        free(options->text);
        return 1 + 1;
    }
    return 0;
}

/* ---- The sound file -------------------------------------------------------------------------------------------- */

static int sound_failed(const speak_t *speak, const char *why)
{
    fprintf(stderr, "%s: %s: %s\n", speak->program, speak->path, why);
    return -1;
}

static void put_little_endian(unsigned char *at, uint32_t value, unsigned bytes)
{
    for (unsigned i = 0; i < bytes; i++)
        at[i] = (unsigned char)(value >> 8 * i & 0xffu);
}

static int write_header(speak_t *speak)
{
    unsigned char header[HEADER_BYTES];
    const uint32_t bytes = (uint32_t)(speak->samples * 2u);
    memcpy(header, "RIFF....WAVEfmt ", 16);
    put_little_endian(header + 4, HEADER_BYTES - 8u + bytes, 4);
    put_little_endian(header + 16, 16, 4); /* bytes of the format */
    put_little_endian(header + 20, 1, 2);  /* PCM */
    put_little_endian(header + 22, 1, 2);  /* channels */
    put_little_endian(header + 24, speak->rate, 4);
    put_little_endian(header + 28, speak->rate * 2u, 4); /* bytes per second */
    put_little_endian(header + 32, 2, 2);                /* bytes per sample */
    put_little_endian(header + 34, 16, 2);               /* bits per sample */
    memcpy(header + 36, "data", 4);
    put_little_endian(header + 40, bytes, 4);
    return fwrite(header, 1, sizeof header, speak->sound) == sizeof header ? 0 : sound_failed(speak, "cannot write");
}

int speak_begin(speak_t *speak, const speak_options_t *options, unsigned samples_per_second, labial_labels_t labels)
{
    memset(speak, 0, sizeof *speak);
    speak->program = options->program;
    speak->path = options->sound;
    speak->rate = samples_per_second;
    speak->labels = labels;
    speak->sound = fopen(options->sound, "wb");
    if (!speak->sound)
        return sound_failed(speak, "cannot open");
    if (write_header(speak) != 0 ||
        mouth_init(&speak->mouth, options->program, &mouth_voices[0], stdout, options->to) != 0) {
        fclose(speak->sound);
        return -1;
    }
    return 0;
}

int speak_sound(speak_t *speak, const short *samples, size_t count)
{
    if (count > SOUND_MAX / 2u - speak->samples)
        return sound_failed(speak, "the sound is too long for a WAV file");
    for (size_t i = 0; i < count; i++) {
        unsigned char bytes[2];
        put_little_endian(bytes, (uint16_t)samples[i], 2);
        if (fwrite(bytes, 1, 2, speak->sound) != 2)
            return sound_failed(speak, "cannot write");
    }
    speak->samples += count;
    return 0;
}

uint64_t speak_time(const speak_t *speak)
{
    return (speak->samples * 1000u + speak->rate / 2u) / speak->rate;
}

/* ---- Phonemes -------------------------------------------------------------------------------------------------- */

int speak_phoneme(speak_t *speak, const char *label, uint64_t end)
{
    while (end > speak->said) {
        const uint64_t left = end - speak->said;
        const uint32_t milliseconds = left < LABIAL_DURATION_MAX ? (uint32_t)left : LABIAL_DURATION_MAX;
        if (mouth_say(&speak->mouth, "", label, speak->labels, milliseconds) != 0)
            return -1;
        speak->said += milliseconds;
    }
    return 0;
}

int speak_end(speak_t *speak, int complete)
{
    static const short silence[256];
    int result = complete ? speak_phoneme(speak, NULL, speak_time(speak)) : -1;
    while (result == 0 && speak_time(speak) < speak->said)
        result = speak_sound(speak, silence, sizeof silence / sizeof silence[0]);
    if (result == 0)
        result = speak_phoneme(speak, NULL, speak_time(speak));
    result = mouth_end(&speak->mouth, result == 0);
    if (result == 0)
        result = fseek(speak->sound, 0, SEEK_SET) == 0 ? write_header(speak) : sound_failed(speak, "cannot seek");
    if (fclose(speak->sound) != 0 && result == 0)
        result = sound_failed(speak, "cannot write");
    return result;
}
