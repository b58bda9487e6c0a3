/* SPDX-License-Identifier: MIT
 * failing.c - preloaded (LD_PRELOAD), makes one call of the operating system fail: FAILING=NAME:N:ERRNO, the N-th
 * call of that name in the program.
 */
#define _GNU_SOURCE

#include <dlfcn.h>
#include <errno.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

struct sigaction;
struct stat;

static bool fails(const char *name)
{
    static long calls;
    const char *const wanted = getenv("FAILING");
    const size_t length = strlen(name);
    if ((wanted == NULL) || (strncmp(wanted, name, length) != 0) || (wanted[length] != ':')) {
        return false;
    }
    char *end = NULL;
    const long number = strtol(&wanted[length + 1U], &end, 10);
    calls++;
    if (calls != number) {
        return false;
    }
    errno = (int)strtol(end + 1, NULL, 10);
    return true;
}

/* A function of the C library, of the type of what stands in its place. */
#define NEXT(function) ((__typeof__(&function))dlsym(RTLD_NEXT, #function))
#define FAILING(type, function, parameters, arguments)                   \
    type function parameters;                                            \
    type function parameters                                             \
    {                                                                    \
        return fails(#function) ? (type)(-1) : NEXT(function) arguments; \
    }

FAILING(int, pipe, (int ends[2]), (ends))
FAILING(int, sigaction, (int number, const struct sigaction *new, struct sigaction *old), (number, new, old))
FAILING(int, mkdir, (const char *path, mode_t mode), (path, mode))
FAILING(int, fstat, (int fd, struct stat *status), (fd, status))
FAILING(int, flock, (int fd, int how), (fd, how))
FAILING(int, ftruncate, (int fd, off_t length), (fd, length))
FAILING(int, renameat, (int from, const char *old, int to, const char *new), (from, old, to, new))
FAILING(int, unlinkat, (int folder, const char *path, int flags), (folder, path, flags))
FAILING(int, inotify_init1, (int flags), (flags))
FAILING(int, inotify_add_watch, (int fd, const char *path, unsigned mask), (fd, path, mask))
FAILING(ssize_t, read, (int fd, void *buffer, size_t length), (fd, buffer, length))
FAILING(ssize_t, write, (int fd, const void *buffer, size_t length), (fd, buffer, length))
FAILING(ssize_t, pwrite, (int fd, const void *buffer, size_t length, off_t at), (fd, buffer, length, at))

int close(int fd);
int close(int fd)
{
    const int result = NEXT(close)(fd); /* it is closed all the same */
    return fails("close") ? -1 : result;
}

int open(const char *path, int flags, ...);
int open(const char *path, int flags, ...)
{
    va_list more;
    va_start(more, flags);
    const mode_t mode = va_arg(more, mode_t);
    va_end(more);
    return fails("open") ? -1 : NEXT(open)(path, flags, mode);
}

int openat(int folder, const char *path, int flags, ...);
int openat(int folder, const char *path, int flags, ...)
{
    va_list more;
    va_start(more, flags);
    const mode_t mode = va_arg(more, mode_t);
    va_end(more);
    return fails("openat") ? -1 : NEXT(openat)(folder, path, flags, mode);
}

int fcntl(int fd, int what, ...);
int fcntl(int fd, int what, ...)
{
    va_list more;
    va_start(more, what);
    const long argument = va_arg(more, long);
    va_end(more);
    return fails("fcntl") ? -1 : NEXT(fcntl)(fd, what, argument);
}
