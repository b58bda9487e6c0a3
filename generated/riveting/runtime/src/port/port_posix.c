/* SPDX-License-Identifier: MIT
 * port_posix.c - pn_port.h on POSIX; the watch on Linux (inotify).
 */
#if defined(__linux__)
#define _GNU_SOURCE /* ppoll, O_NOFOLLOW, flock */
#endif
#define _POSIX_C_SOURCE 200809L
#define _DEFAULT_SOURCE 1

#include "pn/pn_port.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

#if defined(__linux__)
#include <sys/inotify.h>
#endif

static volatile sig_atomic_t s_signal;
static int s_wake[2] = { -1, -1 }; /* a signal that arrives just before poll() must still wake it: self-pipe */

static const uint64_t NS_PER_S = 1000000000U;

uint64_t pn_port_now(void)
{
    static uint64_t latest = 0U;
    struct timespec now = { 0, 0 };
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    const uint64_t found = ((uint64_t)now.tv_sec * NS_PER_S) + (uint64_t)now.tv_nsec;
    if (found > latest) { /* 0 where it cannot be read */
        latest = found;
    }
    return latest;
}

uint32_t pn_port_unique(void)
{
    struct timespec now = { 0, 0 };
    (void)clock_gettime(CLOCK_REALTIME, &now);
    uint64_t mixed = ((uint64_t)now.tv_sec * NS_PER_S) + (uint64_t)now.tv_nsec;
    mixed ^= (uint64_t)getpid() << 32U;
    mixed *= 0x9E3779B97F4A7C15U;
    mixed ^= mixed >> 32U;
    return (uint32_t)(mixed & 0xFFFFFFFFU);
}

uint64_t pn_port_pid(void)
{
    return (uint64_t)getpid();
}

static void on_signal(int number)
{
    const int saved = errno;
    if (s_signal == 0) {
        s_signal = number;
    }
    const char byte = '!';
    const ssize_t ignored = write(s_wake[1], &byte, 1U); /* full pipe: it wakes anyway */
    (void)ignored;
    errno = saved;
}

int pn_port_signals(void)
{
    if (pipe(s_wake) != 0) {
        return errno;
    }
    for (int i = 0; i < 2; i++) {
        if ((fcntl(s_wake[i], F_SETFL, O_NONBLOCK) != 0) || (fcntl(s_wake[i], F_SETFD, FD_CLOEXEC) != 0)) {
            return errno;
        }
    }
    struct sigaction action = { 0 };
    (void)sigemptyset(&action.sa_mask);
    action.sa_handler = on_signal;
    if ((sigaction(SIGINT, &action, NULL) != 0) || (sigaction(SIGTERM, &action, NULL) != 0)) {
        return errno;
    }
    action.sa_handler = SIG_IGN;
    if ((sigaction(SIGPIPE, &action, NULL) != 0) || (sigaction(SIGXFSZ, &action, NULL) != 0)) {
        return errno;
    }
    return 0;
}

int pn_port_stop_signal(void)
{
    return (int)s_signal;
}

bool pn_port_wait(int descriptor, uint64_t timeout_ns)
{
    struct pollfd on[2] = { { s_wake[0], POLLIN, 0 },
                            { descriptor, POLLIN, 0 } }; /* poll() passes over negative descriptors */
    int ready;
#if defined(__linux__)
    struct timespec limit = { (time_t)(timeout_ns / NS_PER_S), (long)(timeout_ns % NS_PER_S) };
    ready = ppoll(on, 2, (timeout_ns == UINT64_MAX) ? NULL : &limit, NULL);
#else
    const uint64_t ms = (timeout_ns / 1000000U) + (((timeout_ns % 1000000U) != 0U) ? 1U : 0U);
    ready = poll(on, 2, (timeout_ns == UINT64_MAX) ? -1 : (int)((ms > 1000000U) ? 1000000U : ms));
#endif
    return (ready > 0) && (on[1].revents != 0);
}

long pn_port_receive(int descriptor, char *buffer, size_t capacity)
{
    const ssize_t got = read(descriptor, buffer, capacity);
    return ((got < 0) && (errno != EINTR)) ? 0 : (long)got;
}

int pn_port_dir_open(const char *path, bool create, int *directory)
{
    if (create && (mkdir(path, S_IRWXU) != 0) && (errno != EEXIST)) {
        return errno;
    }
    const int fd = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0) {
        return errno;
    }
    *directory = fd;
    return 0;
}

bool pn_port_dir_exists(int directory)
{
    struct stat now;
    return (fstat(directory, &now) == 0) && (now.st_nlink > 0U);
}

void pn_port_close(int descriptor)
{
    if (descriptor >= 0) {
        (void)close(descriptor);
    }
}

/* Closes after a failed call and gives that call's error. */
static int close_with(int fd, int error)
{
    (void)close(fd);
    return error;
}

int pn_port_load(const char *path, char *buffer, size_t capacity, size_t *length)
{
    *length = 0U;
    const int fd = open(path, O_RDONLY | O_CLOEXEC);
    if (fd < 0) {
        return errno;
    }
    ssize_t got = 1;
    int error = 0;
    while ((got != 0) && (error == 0) && (*length < capacity)) {
        got = read(fd, &buffer[*length], capacity - *length);
        if (got > 0) {
            *length += (size_t)got;
        } else if ((got < 0) && (errno != EINTR)) {
            error = errno;
        } else {
            /* the end, or interrupted: again */
        }
    }
    return close_with(fd, error);
}

int pn_port_read(int directory, const char *name, char *buffer, size_t capacity, size_t *length, int *held)
{
    *length = 0U;
    if (held != NULL) {
        *held = -1;
    }
    const int fd =
        openat(directory, name, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW); /* a FIFO must not hold us up */
    if (fd < 0) {
        return errno;
    }
    /* One read: files this small come whole, and a file is never written in place by a party that keeps I2. */
    ssize_t got = read(fd, buffer, capacity);
    while ((got < 0) && (errno == EINTR)) {
        got = read(fd, buffer, capacity);
    }
    *length = (got > 0) ? (size_t)got : 0U;
    if ((got >= 0) && (held != NULL)) {
        *held = fd;
        return 0;
    }
    return close_with(fd, (got < 0) ? errno : 0);
}

/* Writes all of it. A short write with no error is followed by another, which tells why. */
static int write_all(int fd, const char *data, size_t length)
{
    size_t done = 0U;
    int error = 0;
    while ((done < length) && (error == 0)) {
        const ssize_t put = write(fd, data + done, length - done);
        if (put > 0) {
            done += (size_t)put;
        } else if (put == 0) {
            error = EIO;
        } else if (errno != EINTR) {
            error = errno;
        } else {
            /* interrupted: again */
        }
    }
    return error;
}

int pn_port_prepare(int directory, const char *temporary, const char *data, size_t length, int *file)
{
    const int fd = openat(directory, temporary, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW,
                          S_IRUSR | S_IWUSR | S_IRGRP | S_IROTH);
    if (fd < 0) {
        return errno;
    }
    const int error = write_all(fd, data, length);
    if (error != 0) {
        (void)unlinkat(directory, temporary, 0);
        return close_with(fd, error);
    }
    *file = fd;
    return 0;
}

int pn_port_publish_prepared(int directory, const char *name, const char *temporary, int file, const char *data,
                             size_t length)
{
    int error = write_all(file, data, length);
    if ((error == 0) && (renameat(directory, temporary, directory, name) != 0)) {
        error = errno;
    }
    if (error != 0) {
        (void)unlinkat(directory, temporary, 0);
    }
    return error;
}

int pn_port_publish(int directory, const char *name, const char *temporary, const char *data, size_t length)
{
    int fd = -1;
    int error = pn_port_prepare(directory, temporary, data, length, &fd);
    if (error != 0) {
        return error;
    }
    if (close(fd) != 0) {
        error = errno; /* some file systems say "full" only here */
        (void)unlinkat(directory, temporary, 0);
        return error;
    }
    return pn_port_publish_prepared(directory, name, temporary, -1, NULL, 0U);
}

void pn_port_remove(int directory, const char *name)
{
    (void)unlinkat(directory, name, 0);
}

int pn_port_lock(int directory, const char *name, int *file)
{
    const int fd =
        openat(directory, name, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, S_IRUSR | S_IWUSR | S_IRGRP | S_IROTH);
    if (fd < 0) {
        return errno;
    }
    /* Emptied under a shared lock, which whoever holds the exclusive one denies us: those who probe never find the lock
     * held while the file still says what its last owner said (I7). */
    if ((flock(fd, LOCK_SH | LOCK_NB) != 0) || (ftruncate(fd, 0) != 0) || (flock(fd, LOCK_EX | LOCK_NB) != 0)) {
        return close_with(fd, errno);
    }
    *file = fd;
    return 0;
}

int pn_port_rewrite(int file, const char *data, size_t length)
{
    const ssize_t put = pwrite(file, data, length, 0);
    if (put < 0) {
        return errno;
    }
    if ((size_t)put != length) {
        return ENOSPC;
    }
    return (ftruncate(file, (off_t)length) != 0) ? errno : 0;
}

int pn_port_probe(int directory, const char *name, bool *exists, bool *locked)
{
    *exists = false;
    *locked = false;
    const int fd = openat(directory, name, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW);
    if (fd < 0) {
        return (errno == ENOENT) ? 0 : errno;
    }
    *exists = true;
    /* Shared, so that two who look at the same moment do not take each other for the owner. */
    if (flock(fd, LOCK_SH | LOCK_NB) != 0) {
        *locked = (errno == EWOULDBLOCK);
        return close_with(fd, *locked ? 0 : errno);
    }
    return close_with(fd, 0);
}

#if defined(__linux__)

int pn_port_watch(const char *path, int *watch)
{
    *watch = -1;
    const int fd = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    if (fd < 0) {
        return errno;
    }
    if (inotify_add_watch(fd, path,
                          IN_MOVED_TO | IN_CLOSE_WRITE | IN_DELETE | IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR)
        < 0) {
        return close_with(fd, errno);
    }
    *watch = fd;
    return 0;
}

bool pn_port_changes(int watch, pn_port_change_t change, void *user)
{
    _Alignas(struct inotify_event) char buffer[4096];
    bool there = true;
    ssize_t got = read(watch, buffer, sizeof buffer);
    while (got > 0) {
        ssize_t at = 0;
        while (at < got) {
            const struct inotify_event *event = (const struct inotify_event *)(const void *)(buffer + at);
            if ((event->mask & (uint32_t)(IN_DELETE_SELF | IN_MOVE_SELF | IN_IGNORED | IN_UNMOUNT)) != 0U) {
                there = false;
            } else if ((event->mask & (uint32_t)IN_Q_OVERFLOW) != 0U) {
                change(user, NULL);
            } else if (event->len > 0U) {
                change(user, event->name);
            } else {
                /* about the directory itself */
            }
            at += (ssize_t)(sizeof *event + event->len);
        }
        /* A read that left room has emptied the queue: no second call on the fast path. */
        got = ((size_t)got + 512U > sizeof buffer) ? read(watch, buffer, sizeof buffer) : 0;
    }
    return there;
}

#else

int pn_port_watch(const char *path, int *watch)
{
    (void)path;
    *watch = -1;
    return 0;
}

bool pn_port_changes(int watch, pn_port_change_t change, void *user)
{
    (void)watch;
    change(user, NULL);
    return true;
}

#endif
