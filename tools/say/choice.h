/*
 * choice.h - options, and values that are one of a list of names.
 */
#ifndef LABIAL_EXAMPLE_CHOICE_H
#define LABIAL_EXAMPLE_CHOICE_H

/* The value of option `name` at argv[*i], as `--name value` or `--name=value`; null when it is another option. A
 * missing value is the empty string, which no option accepts. */
const char *option_value(const char *name, int argc, char **argv, int *i);

/* Reads a whole number of digits alone, at most `most`. Returns 0, or -1 and leaves `number` as it is. */
int option_number(const char *value, unsigned most, unsigned *number);

/* A list: the name of this number, from 0 on; null beyond the last. */
typedef const char *(*choice_names_t)(unsigned number);

/*
 * The number of the name that `value` is. When it is none, prints `PROGRAM: OPTION is A, B or C, not 'VALUE'; see
 * PROGRAM --help` to standard error and returns -1.
 */
int choice_of(const char *program, const char *option, const char *value, choice_names_t names);

#endif
