/* Any bytes as entries, as a name and as its length; any set of labels. The name's array ends with the name. */
#include "labial/names.h"

#include "prove.h"

#define NAME_MAX 64 /* beyond all lengths that names.c tells apart: a label is 32 bytes at most without its marks */

static uint8_t entries[65535];
static char text[NAME_MAX];

int main(void)
{
    labial_names_t names;
    labial_labels_t labels = (labial_labels_t)any_unsigned;
    const size_t length = Frama_C_size_t_interval(0, NAME_MAX);
    const char *name;
    FILL(entries);
    FILL(text);
    names.size = any_uint16;
    names.phoneme_count = any_uint8;
    names.entries = OR_NULL(const uint8_t *, entries + sizeof entries - names.size);
    names.labels = 0;
    name = OR_NULL(const char *, text + NAME_MAX - length);
    labial_find_in(OR_NULL(const labial_names_t *, &names), labels, name, length);
    labial_find(OR_NULL(const labial_names_t *, &names), name, length);
    return labial_find_nearest(OR_NULL(const labial_names_t *, &names), labels, name, length, any_unsigned);
}
