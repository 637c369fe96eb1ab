/*
 * bounded_names.c - what walks through a name or the entries of names.c, for all names and entries of up to so many
 * bytes, by bounded model checking: where a name ends depends on where it begins, which EVA does not follow. CBMC looks
 * for an access outside a buffer that ends with the last byte, an overflow, or a result that another function may not
 * have. More bytes than a buffer of names.c has room for (LABEL_MAX) bring nothing that fewer do not.
 */
#include "names.c"

#define ENTRIES 16 /* bytes; room for five */

size_t nondet_size(void);
unsigned nondet_unsigned(void);

static char name_bytes[LONGEST];
static uint8_t entry_bytes[ENTRIES];

/* Any name of this length, at the end of its buffer. */
static const char *any_name(size_t length)
{
    __CPROVER_assume(length <= LONGEST);
    __CPROVER_havoc_object(name_bytes);
    return name_bytes + (LONGEST - length);
}

/* What is left is a part of the name. */
void check_trim(void)
{
    size_t length = nondet_size();
    const char *const name = any_name(length), *const end = name + length;
    const char *const rest = trim(name, &length);
    __CPROVER_assert(rest >= name && length <= (size_t)(end - rest), "a part of the name");
}

/* What is left has room, whatever comes before it. */
void check_without_marks(void)
{
    char text[LABEL_MAX];
    const size_t length = nondet_size();
    __CPROVER_assert(without_marks(any_name(length), length, text) <= LABEL_MAX, "room for what is left");
}

/* Any entries of any size up to ENTRIES. */
static void any_entries(labial_names_t *names)
{
    const size_t size = nondet_size();
    __CPROVER_assume(size <= ENTRIES);
    __CPROVER_havoc_object(entry_bytes);
    names->size = (uint16_t)size;
    names->entries = entry_bytes + (ENTRIES - size);
}

/* Entries are whole, as the exporter writes them. */
void check_find_exactly(void)
{
    labial_names_t names;
    const size_t length = nondet_size();
    size_t at = 0;
    int found;
    any_entries(&names);
    while (at < names.size) {
        __CPROVER_assume(names.size - at >= 2u);
        at += 2u + (names.entries[at + 1u] & LENGTH_MASK);
    }
    __CPROVER_assume(at == names.size);
    found = find_exactly(&names, nondet_unsigned(), any_name(length), length);
    __CPROVER_assert(found >= 0 || found == LABIAL_ERROR_NAME, "a phoneme or none");
}

/* That faults are found: the last entry may be cut short. */
void check_faults(void)
{
    labial_names_t names;
    const size_t length = nondet_size();
    any_entries(&names);
    find_exactly(&names, nondet_unsigned(), any_name(length), length);
}
