/*
 * mouth.h - phonemes by name in, written frames out: what labial-say and the programs with a speech synthesiser share.
 *
 * A label that the model does not know never stops the mouth: it moves as the nearest phoneme does, and each such label
 * is named once on standard error. So is the first sound that is too long to be speech, and whether every sound is too
 * short.
 */
#ifndef LABIAL_EXAMPLE_MOUTH_H
#define LABIAL_EXAMPLE_MOUTH_H

#include "frames.h"
#include "labial/labial.h"
#include "labial/names.h"

/* Unknown labels that are remembered as named; further ones pass unnamed. */
#define MOUTH_UNKNOWN_MAX 64
#define MOUTH_LABEL_MAX 63

typedef struct {
    const char *name;
    const labial_model_t *model;
    const labial_names_t *names;
} mouth_voice_t;

/* Every bundled model, speech first, and the name of each by its number; null beyond the last. */
extern const mouth_voice_t mouth_voices[];
const char *mouth_voice_name(unsigned number);

/* The stream is a part of it, as the library never allocates. Private. */
typedef struct {
    const char *program;        /* for messages */
    const mouth_voice_t *voice; /* whose phonemes labels name */
    const mouth_voice_t *current;
    labial_t stream;
    uint32_t workspace[LABIAL_WORKSPACE_SIZE(LABIAL_SEARCH_STRIDE_MAX, LABIAL_CHANNELS) / 4u]; /* for any model */
    frames_t frames;
    uint32_t laughs; /* so far: each has its own number as seed */
    int long_named;  /* whether a sound that is too long to be speech was named */
    int has_sound;   /* whether there was a sound, of any length */
    int has_speech;  /* and one that is long enough to be speech */
    unsigned unknown_count;
    char unknown[MOUTH_UNKNOWN_MAX][MOUTH_LABEL_MAX + 1];
} mouth_t;

/* Prepares a mouth whose frames go to `out` in one of the formats of frames.h. Returns 0, or -1 after the error was
 * printed. mouth_end() releases what it owns. */
int mouth_init(mouth_t *mouth, const char *program, const mouth_voice_t *voice, FILE *out, unsigned format);

/*
 * Adds a phoneme, `milliseconds` long, and writes every frame that is thereby known. `label` is null for silence;
 * `labels` says what set it is of. `where` begins messages, as "line 3: "; it may be empty.
 *
 * Returns 0, or -1 after the error was printed.
 */
int mouth_say(mouth_t *mouth, const char *where, const char *label, labial_labels_t labels, uint32_t milliseconds);

/* Adds a laugh of `intensity`, 0 to LABIAL_LAUGH_FULL. Returns as mouth_say() does. */
int mouth_laugh(mouth_t *mouth, const char *where, uint32_t milliseconds, unsigned intensity);

/* Writes the remaining frames and ends. Returns 0, or -1 after the error was printed. Unless `complete`, after an error,
 * it ends without what is not yet written, and returns -1. */
int mouth_end(mouth_t *mouth, int complete);

#endif
