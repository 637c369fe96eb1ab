/*
 * choice.c - options, and values that are one of a list of names.
 */
#include "choice.h"

#include <stdio.h>
#include <string.h>

const char *option_value(const char *name, int argc, char **argv, int *i)
{
    const size_t length = strlen(name);
    if (strncmp(argv[*i], name, length) != 0)
        return NULL;
    if (argv[*i][length] == '=')
        return argv[*i] + length + 1;
    if (argv[*i][length] != '\0')
        return NULL;
    return *i + 1 < argc ? argv[++*i] : "";
}

int option_number(const char *value, unsigned most, unsigned *number)
{
    unsigned read = 0;
    const char *at = value;
    for (; *at >= '0' && *at <= '9' && read <= most; at++)
        read = 10u * read + (unsigned)(*at - '0');
    if (*value == '\0' || *at != '\0' || read > most)
        return -1;
    *number = read;
    return 0;
}

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
