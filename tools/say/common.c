/*
 * common.c - options, and values that are one of a list of names.
 */
#include "common.h"

#include <stdio.h>
#include <string.h>

#include "labial/labial.h"

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

int choose(const char *program, const char *option, const char *value, choice_names_t names, unsigned *chosen)
{
    for (unsigned i = 0; names(i); i++)
        if (strcmp(names(i), value) == 0) {
            *chosen = i;
            return 0;
        }
    fprintf(stderr, "%s: %s is ", program, option);
    for (unsigned i = 0; names(i); i++)
        fprintf(stderr, "%s%s", i == 0 ? "" : names(i + 1) ? ", " : " or ", names(i));
    fprintf(stderr, ", not '%s'; see %s --help\n", value, program);
    return OPTIONS_WRONG;
}

int options_wrong(const char *program, const char *problem, const char *value)
{
    fprintf(stderr, "%s: %s '%s'; see %s --help\n", program, problem, value, program);
    return OPTIONS_WRONG;
}

int options_ask(const char *program, int argc, char **argv, void (*print_usage)(void))
{
    if (argc != 2)
        return 0;
    if (strcmp(argv[1], "--help") == 0)
        print_usage();
    else if (strcmp(argv[1], "--version") == 0)
        printf("%s %d.%d.%d\n", program, LABIAL_VERSION_MAJOR, LABIAL_VERSION_MINOR, LABIAL_VERSION_PATCH);
    else
        return 0;
    return 1;
}
