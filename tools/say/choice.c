/*
 * choice.c - options whose value is one of a list of names.
 */
#include "choice.h"

#include <stdio.h>
#include <string.h>

int choice_of(const char *program, const char *option, const char *value, choice_names_t names)
{
    for (unsigned i = 0; names(i); i++)
        if (strcmp(names(i), value) == 0)
            return (int)i;
    fprintf(stderr, "%s: %s is ", program, option);
    for (unsigned i = 0; names(i); i++)
        fprintf(stderr, "%s%s", i == 0 ? "" : names(i + 1) ? ", " : " or ", names(i));
    fprintf(stderr, ", not '%s'; see %s --help\n", value, program);
    return -1;
}
