/*
 * choice.h - options whose value is one of a list of names.
 */
#ifndef LABIAL_EXAMPLE_CHOICE_H
#define LABIAL_EXAMPLE_CHOICE_H

/* A list: the name of this number, from 0 on; null beyond the last. */
typedef const char *(*choice_names_t)(unsigned number);

/*
 * The number of the name that `value` is. When it is none, prints `PROGRAM: OPTION is A, B or C, not 'VALUE'; see
 * PROGRAM --help` to standard error and returns -1.
 */
int choice_of(const char *program, const char *option, const char *value, choice_names_t names);

#endif
