#include "labial/names.h"

#include "labial/labial.h"

/* Compares the `length` bytes at `name` with a terminated string, as strcmp would. */
static int compare(const char *name, size_t length, const char *entry)
{
    size_t i;
    for (i = 0; i < length; i++) {
        const unsigned char a = (unsigned char)name[i], b = (unsigned char)entry[i];
        if (b == 0 || a > b)
            return 1;
        if (a < b)
            return -1;
    }
    return entry[length] ? -1 : 0;
}

static int find_exactly(const labial_names_t *names, const char *name, size_t length)
{
    unsigned low = 0, high = names->count;
    while (low < high) {
        const unsigned middle = low + (high - low) / 2u;
        const int order = compare(name, length, names->entries[middle].name);
        if (order == 0)
            return names->entries[middle].phoneme;
        if (order < 0)
            high = middle;
        else
            low = middle + 1u;
    }
    return LABIAL_ERROR_NAME;
}

/* Whether two bytes are one of the IPA's stress marks, U+02C8 and U+02CC. */
static int is_stress_mark(const char *at)
{
    return at[0] == '\xcb' && (at[1] == '\x88' || at[1] == '\x8c');
}

/* Whether two bytes are one of the IPA's length marks, U+02D0 and U+02D1. */
static int is_length_mark(const char *at)
{
    return at[0] == '\xcb' && (at[1] == '\x90' || at[1] == '\x91');
}

int labial_find(const labial_names_t *names, const char *name, size_t length)
{
    int phoneme;
    if (!names || !name || !names->entries)
        return LABIAL_ERROR_NULL;
    phoneme = find_exactly(names, name, length);
    if (phoneme >= 0)
        return phoneme;
    while (length > 2u && is_stress_mark(name)) {
        name += 2;
        length -= 2u;
    }
    while (length > 2u && is_length_mark(name + length - 2u))
        length -= 2u;
    if (length > 1u && name[length - 1u] >= '0' && name[length - 1u] <= '2')
        length--;
    return find_exactly(names, name, length);
}
