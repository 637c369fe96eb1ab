/*
 * labels.h - a label looked up in every set, for the targets that meet labels.
 */
#ifndef LABIAL_TEST_FUZZ_LABELS_H
#define LABIAL_TEST_FUZZ_LABELS_H

#include <string.h>

#include "fuzz.h"
#include "labial/labial.h"
#include "labial/names.h"

/*
 * Looks `label`, `length` bytes at the very end of their memory, up in every set. What is found is a phoneme of the
 * model, the nearest one is what is found, and blanks around the label change nothing.
 */
static void look_up(const labial_names_t *names, const char *label, size_t length)
{
    static const labial_labels_t sets[] = { LABIAL_LABELS_ARPABET, LABIAL_LABELS_IPA, LABIAL_LABELS_XSAMPA,
                                            LABIAL_LABELS_AUTO };
    char *copy = (char *)malloc(length ? length : 1), *padded = (char *)malloc(length + 2);
    int found, nearest;
    REQUIRE(copy && padded);
    memcpy(copy, label, length);
    memcpy(padded + 1, label, length);
    padded[0] = '\t';
    padded[length + 1] = ' ';
    for (size_t i = 0; i < sizeof sets / sizeof sets[0]; i++) {
        found = labial_find_in(names, sets[i], copy, length);
        REQUIRE(found == LABIAL_ERROR_NAME || (found >= 0 && found < names->phoneme_count));
        REQUIRE(labial_find_in(names, sets[i], padded, length + 2) == found);
        nearest = labial_find_nearest(names, sets[i], copy, length, 0);
        REQUIRE(nearest >= 0 && nearest < names->phoneme_count && (found < 0 || nearest == found));
    }
    REQUIRE(labial_find(names, copy, length) == labial_find_in(names, LABIAL_LABELS_AUTO, copy, length));
    free(copy);
    free(padded);
}

#endif
