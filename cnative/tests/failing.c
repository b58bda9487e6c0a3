/* SPDX-License-Identifier: MIT
 * failing.c - preloaded (LD_PRELOAD), makes calls of the operating system fail, or something happen at them:
 *
 *     FAILING=RULE[,RULE...]      RULE: NAME[@PART]:FIRST[-[LAST]]:WHAT
 *
 * The calls FIRST to LAST (FIRST alone: that one; `FIRST-`: all from there) of the function NAME whose file has PART in
 * its path. WHAT happens at each of them:
 *
 *     ERRNO      it fails
 *     =NUMBER    it does nothing, and gives this result
 *     !SIGNAL    the program gets this signal; then the call is made
 *     +SECONDS   of clock_gettime: the monotonic clock shows so many more (or fewer), from then on
 *
 * FAILING_REACHED=FILE           is made when something happens: without it no rule has come to its call
 *
 * From the end of `main` on all calls are made as they are, and files may have any length (RLIMIT_FSIZE, as
 * far as it can be raised): what counts branches writes its files then.
 */
#define _GNU_SOURCE

#include <dlfcn.h>
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

struct stat;

#define MOST 16

static long s_calls[MOST]; /* that a rule is about */
static bool s_is_over;
static long s_seconds; /* that the clock is ahead */

static void end(void)
{
    struct rlimit files;
    s_is_over = true;
    if (getrlimit(RLIMIT_FSIZE, &files) == 0) {
        files.rlim_cur = files.rlim_max;
        (void)setrlimit(RLIMIT_FSIZE, &files);
    }
}

/* What follows `main` (the C library's end, and what counts branches) is no part of the program. */
static int (*s_main)(int count, char **argument, char **environment);

static int main_and_end(int count, char **argument, char **environment)
{
    const int code = s_main(count, argument, environment);
    end();
    return code;
}

int __libc_start_main(int (*main)(int, char **, char **), int count, char **argument, void (*init)(void),
                      void (*fini)(void), void (*rtld_fini)(void), void *stack_end);
int __libc_start_main(int (*main)(int, char **, char **), int count, char **argument, void (*init)(void),
                      void (*fini)(void), void (*rtld_fini)(void), void *stack_end)
{
    s_main = main;
    return ((__typeof__(&__libc_start_main))dlsym(RTLD_NEXT, "__libc_start_main"))(main_and_end, count, argument, init,
                                                                                   fini, rtld_fini, stack_end);
}

/* Whether a rule is about this call: of that function, on that path, at that count. */
static bool is_meant(const char *rule, int number, const char *name, const char *path)
{
    const char *const colon = strchr(rule, ':');
    const char *const at = memchr(rule, '@', (size_t)(colon - rule));
    const size_t length = (size_t)((at != NULL) ? (at - rule) : (colon - rule));
    if ((strlen(name) != length) || (strncmp(rule, name, length) != 0)) {
        return false;
    }
    if (at != NULL) {
        char part[256] = "";
        (void)memcpy(part, at + 1, (size_t)(colon - at) - 1U);
        if (strstr(path, part) == NULL) {
            return false;
        }
    }
    char *rest = NULL;
    const long first = strtol(colon + 1, &rest, 10);
    const long last = (*rest != '-') ? first : ((rest[1] == ':') ? 1000000000L : strtol(rest + 1, &rest, 10));
    s_calls[number]++;
    return (s_calls[number] >= first) && (s_calls[number] <= last);
}

/* Tells whoever asks that a rule has come to its call: by a call that no rule is about. */
static void tell(void)
{
    const char *const file = getenv("FAILING_REACHED");
    if (file != NULL) {
        const int saved = errno;
        (void)syscall(SYS_mknodat, -100 /* from the current directory */, file, 0100600 /* a file */, 0);
        errno = saved;
    }
}

/* Whether the call is not to be made; *result is its result then. */
static bool fails(const char *name, const char *path, long *result)
{
    const char *rule = s_is_over ? NULL : getenv("FAILING");
    bool is_done = false;
    for (int number = 0; (rule != NULL) && (*rule != '\0') && (number < MOST); number++) {
        if (is_meant(rule, number, name, path)) {
            const char *const what = strchr(strchr(rule, ':') + 1, ':') + 1;
            tell();
            const long value = strtol((strchr("=!", *what) != NULL) ? what + 1 : what, NULL, 10);
            if (*what == '!') {
                (void)raise((int)value);
            } else if (strcmp(name, "clock_gettime") == 0 && ((*what == '+') || (*what == '-'))) {
                s_seconds = value;
            } else {
                is_done = true;
                *result = (*what == '=') ? value : -1;
                errno = (*what == '=') ? errno : (int)value;
            }
        }
        rule = strchr(rule, ',');
        rule = (rule != NULL) ? rule + 1 : NULL;
    }
    return is_done;
}

/* The path of what a descriptor is of. */
static const char *path_of(int fd)
{
    static char path[4096];
    char link[64];
    (void)snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    const int saved = errno;
    const ssize_t length = readlink(link, path, sizeof path - 1U);
    errno = saved;
    path[(length > 0) ? length : 0] = '\0';
    return path;
}

/* A function of the C library, of the type of what stands in its place. */
#define NEXT(function) ((__typeof__(&function))dlsym(RTLD_NEXT, #function))
#define FAILING(type, function, path, parameters, arguments)                              \
    type function parameters;                                                             \
    type function parameters                                                              \
    {                                                                                     \
        long result = -1;                                                                 \
        return fails(#function, path, &result) ? (type)result : NEXT(function) arguments; \
    }

FAILING(int, pipe, "", (int ends[2]), (ends))
FAILING(int, sigaction, "", (int number, const struct sigaction *new, struct sigaction *old), (number, new, old))
FAILING(int, mkdir, path, (const char *path, mode_t mode), (path, mode))
FAILING(int, fstat, path_of(fd), (int fd, struct stat *status), (fd, status))
FAILING(int, flock, path_of(fd), (int fd, int how), (fd, how))
FAILING(int, ftruncate, path_of(fd), (int fd, off_t length), (fd, length))
FAILING(int, renameat, new, (int from, const char *old, int to, const char *new), (from, old, to, new))
FAILING(int, unlinkat, path, (int folder, const char *path, int flags), (folder, path, flags))
FAILING(int, inotify_init1, "", (int flags), (flags))
FAILING(int, inotify_add_watch, path, (int fd, const char *path, unsigned mask), (fd, path, mask))
FAILING(ssize_t, read, path_of(fd), (int fd, void *buffer, size_t length), (fd, buffer, length))
FAILING(ssize_t, write, path_of(fd), (int fd, const void *buffer, size_t length), (fd, buffer, length))
FAILING(ssize_t, pwrite, path_of(fd), (int fd, const void *buffer, size_t length, off_t at), (fd, buffer, length, at))
FAILING(int, ppoll, "", (struct pollfd * on, nfds_t count, const struct timespec *limit, const sigset_t *mask),
        (on, count, limit, mask))

int clock_gettime(clockid_t clock, struct timespec *now)
{
    long result = -1;
    if ((clock == CLOCK_MONOTONIC) && fails("clock_gettime", "", &result)) {
        return (int)result;
    }
    const int found = NEXT(clock_gettime)(clock, now);
    now->tv_sec += (clock == CLOCK_MONOTONIC) ? s_seconds : 0;
    return found;
}

int close(int fd);
int close(int fd)
{
    long result = -1;
    const bool is_failing = fails("close", path_of(fd), &result);
    const int found = NEXT(close)(fd); /* it is closed all the same */
    return is_failing ? (int)result : found;
}

int open(const char *path, int flags, ...);
int open(const char *path, int flags, ...)
{
    long result = -1;
    va_list more;
    va_start(more, flags);
    const mode_t mode = va_arg(more, mode_t);
    va_end(more);
    return fails("open", path, &result) ? (int)result : NEXT(open)(path, flags, mode);
}

int openat(int folder, const char *path, int flags, ...);
int openat(int folder, const char *path, int flags, ...)
{
    long result = -1;
    va_list more;
    va_start(more, flags);
    const mode_t mode = va_arg(more, mode_t);
    va_end(more);
    return fails("openat", path, &result) ? (int)result : NEXT(openat)(folder, path, flags, mode);
}

int fcntl(int fd, int what, ...);
int fcntl(int fd, int what, ...)
{
    long result = -1;
    va_list more;
    va_start(more, what);
    const long argument = va_arg(more, long);
    va_end(more);
    return fails("fcntl", "", &result) ? (int)result : NEXT(fcntl)(fd, what, argument);
}
