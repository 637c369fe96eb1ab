/*
 * labial/names.h - finds phonemes by name. The exporter writes each model's names as a separate object (NAME_names), so
 * that a program with fixed phoneme numbers links neither the table nor the look-up.
 */
#ifndef LABIAL_NAMES_H
#define LABIAL_NAMES_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Format of the tables; a NAME_names.c of another format does not compile. */
#define LABIAL_NAMES_FORMAT 2

/*
 * Sets of labels. Some labels mean different sounds in different sets: `y` is the first sound of "yes" in ARPABET and
 * the rounded vowel of German "ue" in the IPA, `th` one fricative in ARPABET and an aspirated stop in the IPA, `N S T D
 * Z V` other sounds in X-SAMPA. A program that knows the set of its labels should name it.
 */
typedef enum {
    LABIAL_LABELS_ARPABET = 0x20, /* also flite's, CMU Sphinx's and TIMIT's */
    LABIAL_LABELS_IPA = 0x40,     /* in UTF-8, as eSpeak NG, the Montreal Forced Aligner and Piper write it */
    LABIAL_LABELS_XSAMPA = 0x80,  /* also MBROLA's and MARY's */
    LABIAL_LABELS_AUTO = 0xe0     /* any of them, in this order; lone digits, vowels in X-SAMPA, are unknown */
} labial_labels_t;

/*
 * The names of one model. Labels and aliases follow each other without pointers, which would take more memory than the
 * names. Each entry has the phoneme's number, a byte with the name's length (1 .. 31) and the sets in which it means
 * this phoneme (the bits of labial_labels_t), and the name in UTF-8. A look-up reads all entries, 3 KB for English,
 * which is fast compared with computing a frame.
 */
typedef struct {
    uint16_t size;             /* of `entries`, bytes */
    uint8_t phoneme_count;     /* of `labels` */
    const uint8_t *entries;    /* labels and aliases; a name of several meanings once for each */
    const char *const *labels; /* the label of each phoneme number */
} labial_names_t;

/*
 * Finds the phoneme that `name`, `length` bytes, means in the set `labels`: the exact name or, if that is unknown, the
 * name without marks that do not change the mouth's shape - blanks around it; stress marks before it (the IPA's, ' " ,
 * %), and a glottal stop; the IPA's signs of length and secondary articulation, its ties and diacritics; Praat's
 * backslash sequences for these; X-SAMPA's marks (`:`, `=`, `~`, `;`, `_h`), Kaldi's places (`_B`) and the signs of
 * eSpeak's variants (`-`, `.`, `^`, `"`) after it; an ARPABET stress digit after two letters. The labels of the model's
 * own phonemes stand in every set that does not use them for another sound.
 *
 * Returns the phoneme's number, LABIAL_ERROR_NULL, or LABIAL_ERROR_NAME: also for an empty name, for marks alone, and
 * for `labels` that is none of the above.
 */
int labial_find_in(const labial_names_t *names, labial_labels_t labels, const char *name, size_t length);

/* The same for labels of an unknown set: LABIAL_LABELS_AUTO. */
int labial_find(const labial_names_t *names, const char *name, size_t length);

/*
 * Finds a phoneme for any label: the result of labial_find_in(); `silence` (the model's) for noises, which are written
 * in brackets or between + * #, and for labels of nothing but marks, digits and ASCII punctuation; else the first known
 * substring, scanning from the left, and the longest there; else the neutral vowel, else `silence`. To detect unknown
 * labels, call labial_find_in() first.
 *
 * Returns the phoneme's number or LABIAL_ERROR_NULL.
 */
int labial_find_nearest(const labial_names_t *names, labial_labels_t labels, const char *name, size_t length,
                        unsigned silence);

#ifdef __cplusplus
}
#endif

#endif
