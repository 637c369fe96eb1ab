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

/* A label or alias, UTF-8, and the phoneme it means. */
typedef struct {
    const char *name;
    uint8_t phoneme;
} labial_name_t;

/* The names of one model. */
typedef struct {
    uint16_t count;               /* of `entries` */
    uint8_t phoneme_count;        /* of `labels` */
    const labial_name_t *entries; /* labels and aliases, ascending by the bytes of their names, without duplicates */
    const char *const *labels;    /* the label of each phoneme number */
} labial_names_t;

/*
 * The phoneme that `name`, `length` bytes, means: the name as it stands or, if that is unknown, without what does not
 * change the mouth's shape - IPA stress marks before it, IPA length marks and ARPABET stress digits behind it.
 *
 * Returns the phoneme's number, LABIAL_ERROR_NULL or LABIAL_ERROR_NAME.
 */
int labial_find(const labial_names_t *names, const char *name, size_t length);

#ifdef __cplusplus
}
#endif

#endif
