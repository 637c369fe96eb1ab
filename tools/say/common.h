/*
 * common.h - what the programs share: options, values that are one of a list of names, lists that grow.
 */
#ifndef LABIAL_EXAMPLE_COMMON_H
#define LABIAL_EXAMPLE_COMMON_H

#include <stdint.h>
#include <stdlib.h>

/* The value of option `name` at argv[*i], as `--name value` or `--name=value`; null when it is another option. A
 * missing value is the empty string, which no option accepts. */
const char *option_value(const char *name, int argc, char **argv, int *i);

/* Reads a whole number of digits alone, at most `most`. Returns 0, or -1 and leaves `number` as it is. */
int option_number(const char *value, unsigned most, unsigned *number);

/* A list: the name of this number, from 0 on; null beyond the last. */
typedef const char *(*choice_names_t)(unsigned number);

/* The exit status of wrong usage. */
#define OPTIONS_WRONG 2

/*
 * Sets `chosen` to the number of the name that `value` is, and returns 0. When it is none, prints `PROGRAM: OPTION is A,
 * B or C, not 'VALUE'; see PROGRAM --help` to standard error and returns OPTIONS_WRONG.
 */
int choose(const char *program, const char *option, const char *value, choice_names_t names, unsigned *chosen);

/* Prints `PROGRAM: PROBLEM 'VALUE'; see PROGRAM --help` to standard error; returns OPTIONS_WRONG. */
int options_wrong(const char *program, const char *problem, const char *value);

/* Where `--help` or `--version` is the only argument, prints what was asked for and returns 1, else 0. */
int options_ask(const char *program, int argc, char **argv, void (*print_usage)(void));

/* Makes room for one more of `size` bytes at `items`. Returns the list, moved if need be, or null. */
static inline void *grow(void *items, size_t count, size_t *room, size_t size)
{
    if (count < *room)
        return items;
    const size_t wanted = *room ? *room * 2u : 256u;
    if (wanted > SIZE_MAX / size)
        return NULL;
    void *moved = realloc(items, wanted * size);
    if (moved)
        *room = wanted;
    return moved;
}

#endif
