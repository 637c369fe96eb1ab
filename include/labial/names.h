/*
 * labial/names.h - phonemes by name. The exporter writes each model's names as an object of its own (NAME_names), so
 * that a program with fixed phoneme numbers links neither the table nor the look-up.
 */
#ifndef LABIAL_NAMES_H
#define LABIAL_NAMES_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/*
 * The names of one model. Labels and aliases stand one behind the other, without pointers, which would take more room
 * than they do: for each the phoneme's number, the bytes of the name, and the name in UTF-8. A look-up reads them all,
 * 2 KB for English, which is little beside the work of one frame.
 */
typedef struct {
    uint16_t size;             /* of `entries`, bytes */
    uint8_t phoneme_count;     /* of `labels` */
    const uint8_t *entries;    /* labels and aliases, no name twice */
    const char *const *labels; /* the label of each phoneme number */
} labial_names_t;

/*
 * The phoneme that `name`, `length` bytes, means: the name as it stands or, if that is unknown, without what does not
 * change the mouth's shape - blanks around it; stress marks before it (the IPA's, ' " , %); the IPA's signs of length
 * and secondary articulation, its ties and diacritics; Praat's backslash sequences for these; X-SAMPA's marks (`:`,
 * `=`, `~`, `;`, `_h`) and Kaldi's places (`_B`) behind it; an ARPABET stress digit behind two letters.
 *
 * Returns the phoneme's number, LABIAL_ERROR_NULL or LABIAL_ERROR_NAME.
 */
int labial_find(const labial_names_t *names, const char *name, size_t length);

/*
 * The same for a label of X-SAMPA, as MBROLA, MARY and eSpeak write them: N S T D Z V H Y y are what X-SAMPA means by
 * them, where labial_find() takes them for ARPABET.
 */
int labial_find_sampa(const labial_names_t *names, const char *name, size_t length);

/*
 * A phoneme for any label: the one that labial_find() finds; `silence` (the model's) for what is in brackets or between
 * + * #, as noises are written; else the longest known beginning of the label, its first letters being passed over
 * while there is none; else the neutral vowel, else `silence`.
 *
 * Returns the phoneme's number or LABIAL_ERROR_NULL.
 */
int labial_find_nearest(const labial_names_t *names, const char *name, size_t length, unsigned silence);

#ifdef __cplusplus
}
#endif

#endif
