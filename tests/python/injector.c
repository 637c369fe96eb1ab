/*
 * injector.c - a disk that is full, a signal or a kill at a chosen write, for test_outputs.py
 *
 * Preloaded into a process, it counts the calls that change files: writes to regular files beyond standard error, and
 * what makes, renames, synchronises or cuts files. inject() says what happens from one of them on.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

enum { NOTHING, FULL, KILL, TERM };

static long left;
static int mode;
static long calls;

long inject(long after, int what);

/* The calls so far; `what` happens at the one that follows `after` others, and FULL at all behind it, too. */
long inject(long after, int what)
{
    const long before = calls;

    calls = 0;
    left = after;
    mode = what;
    return before;
}

/* Whether the call that is about to be made fails. */
static int fails(void)
{
    ++calls;
    if (mode == NOTHING || left-- > 0)
        return 0;
    if (mode == KILL)
        kill(getpid(), SIGKILL);
    if (mode == TERM) {
        mode = NOTHING;
        raise(SIGTERM);
        return 0;
    }
    errno = ENOSPC;
    return 1;
}

#define REAL(type, name, ...) ((type(*)(__VA_ARGS__))dlsym(RTLD_NEXT, #name))

ssize_t write(int file, const void *bytes, size_t count)
{
    struct stat about;

    if (file > 2 && !fstat(file, &about) && S_ISREG(about.st_mode)) {
        if (mode == KILL && left == 0) /* half of it is written */
            REAL(ssize_t, write, int, const void *, size_t)(file, bytes, count / 2);
        if (fails())
            return -1;
    }
    return REAL(ssize_t, write, int, const void *, size_t)(file, bytes, count);
}

#define OPEN(name)                                                                                                     \
    int name(const char *path, int flags, ...)                                                                         \
    {                                                                                                                  \
        va_list arguments;                                                                                             \
        mode_t permissions;                                                                                            \
                                                                                                                       \
        va_start(arguments, flags);                                                                                    \
        permissions = va_arg(arguments, mode_t);                                                                       \
        va_end(arguments);                                                                                             \
        if ((flags & (O_CREAT | O_TRUNC)) && fails())                                                                  \
            return -1;                                                                                                 \
        return REAL(int, name, const char *, int, ...)(path, flags, permissions);                                      \
    }

OPEN(open)
OPEN(open64)

int rename(const char *from, const char *to)
{
    return fails() ? -1 : REAL(int, rename, const char *, const char *)(from, to);
}

int mkdir(const char *path, mode_t permissions)
{
    return fails() ? -1 : REAL(int, mkdir, const char *, mode_t)(path, permissions);
}

int fsync(int file)
{
    return fails() ? -1 : REAL(int, fsync, int)(file);
}
