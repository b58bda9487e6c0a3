/* SPDX-License-Identifier: MIT
 * latency.c - how fast the supervisor answers, beside what two bare processes need.
 *
 *   latency DIR SUPERVISOR ROUNDS [INPUT_DIR]
 *
 * 1. bare: two processes in DIR, each renames a file and waits by inotify for the other's: time of a round trip.
 * 2. cell: SUPERVISOR (the net of hand_net.c with HAND_DELAY 0) is started on DIR; this program plays its robot and
 *    measures, for each command, from the call of rename that makes the answer file appear
 *      - to the moment the next command's flag is there, seen by looking without pause: "published";
 *      - to the moment this program is woken by inotify for it: "round trip".
 *    Odd rounds are measured one way, even rounds the other.
 *
 * The two processes are kept on different cores where there are two: otherwise the one that looks without pause would
 * keep the supervisor from running.
 *
 * Prints microseconds: name, number, p50, p90, p99, largest.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define ROUNDS_MAX 100000

static int s_directory;
static double s_sample[3][ROUNDS_MAX];
static int s_count[3];

static double now_us(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return ((double)t.tv_sec * 1e6) + ((double)t.tv_nsec * 1e-3);
}

static void give_up(const char *what)
{
    (void)fprintf(stderr, "latency: %s: %s\n", what, strerror(errno));
    exit(1);
}

static void use_core(int core)
{
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET((size_t)core, &set);
    (void)sched_setaffinity(0, sizeof set,
                            &set); /* fails where there is one core only: then there is nothing to choose */
}

/* Returns the time at which rename was called. */
static double publish(const char *name, const char *text)
{
    double begin = 0.0;
    char temporary[64];
    (void)snprintf(temporary, sizeof temporary, ".%s.robot1.tmp", name);
    const int fd = openat(s_directory, temporary, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if ((fd < 0) || (write(fd, text, strlen(text)) < 0) || (close(fd) != 0)) {
        give_up(temporary);
    }
    begin = now_us();
    if (renameat(s_directory, temporary, s_directory, name) != 0) {
        give_up(name);
    }
    return begin;
}

/* First byte of a file, 0 when there is none. */
static char first_byte(const char *name)
{
    char byte = 0;
    const int fd = openat(s_directory, name, O_RDONLY | O_CLOEXEC);
    if (fd >= 0) {
        if (read(fd, &byte, 1U) < 0) {
            byte = 0;
        }
        (void)close(fd);
    }
    return byte;
}

static int watch_directory(const char *path)
{
    const int fd = inotify_init1(IN_CLOEXEC | IN_NONBLOCK);
    if ((fd < 0) || (inotify_add_watch(fd, path, IN_MOVED_TO) < 0)) {
        give_up("inotify");
    }
    return fd;
}

/* Waits until something is renamed to `name`. */
static void await_rename(int watch, const char *name)
{
    _Alignas(struct inotify_event) char buffer[4096];
    bool found = false;
    while (!found) {
        struct pollfd on = { watch, POLLIN, 0 };
        (void)poll(&on, 1, 5000);
        if (on.revents == 0) {
            errno = ETIMEDOUT;
            give_up(name);
        }
        const ssize_t got = read(watch, buffer, sizeof buffer);
        for (ssize_t at = 0; at < got;) {
            const struct inotify_event *event = (const struct inotify_event *)(const void *)(buffer + at);
            found = found || ((event->len > 0U) && (strcmp(event->name, name) == 0));
            at += (ssize_t)(sizeof *event + event->len);
        }
    }
}

static void bare(const char *path, int rounds)
{
    const pid_t child = fork();
    if (child == 0) {
        use_core(1);
        const int watch = watch_directory(path);
        (void)publish("ready", "1\n");
        for (int i = 0; i < rounds; i++) {
            await_rename(watch, "ping");
            (void)publish("pong", "1\n");
        }
        _exit(0);
    }
    const int watch = watch_directory(path);
    while (first_byte("ready") == 0) {
        (void)usleep(1000);
    }
    for (int i = 0; i < rounds; i++) {
        const double begin = publish("ping", "1\n");
        await_rename(watch, "pong");
        s_sample[0][s_count[0]++] = now_us() - begin;
        (void)usleep(200);
    }
    (void)waitpid(child, NULL, 0);
    (void)close(watch);
    (void)unlinkat(s_directory, "ready", 0);
    (void)unlinkat(s_directory, "ping", 0);
    (void)unlinkat(s_directory, "pong", 0);
}

static void join_session(void)
{
    char text[256] = "";
    char session[32] = "";
    for (int tries = 0; (tries < 3000) && (session[0] == '\0'); tries++) {
        const int fd = openat(s_directory, "supervisor.status", O_RDONLY | O_CLOEXEC);
        if (fd >= 0) {
            const ssize_t got = read(fd, text, sizeof text - 1U);
            text[(got > 0) ? got : 0] = '\0';
            (void)close(fd);
            if (sscanf(text, "running %31s", session) != 1) {
                session[0] = '\0';
            }
        }
        (void)usleep(1000);
    }
    if (session[0] == '\0') {
        errno = ETIMEDOUT;
        give_up("the supervisor does not announce itself");
    }
    const int status = openat(s_directory, "robot1.status", O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    const int length = snprintf(text, sizeof text, "running\n%s %d\n\n", session, (int)getpid());
    if ((status < 0) || (flock(status, LOCK_EX) != 0) || (pwrite(status, text, (size_t)length, 0) < 0)) {
        give_up("robot1.status");
    }
}

static void cell(const char *path, const char *program, const char *input, int rounds)
{
    const pid_t child = fork();
    if (child == 0) {
        use_core(1);
        (void)execl(program, program, "--dir", path, "--input", input, "-q", (char *)NULL);
        _exit(127);
    }
    join_session();
    const int watch = watch_directory(path);
    while (first_byte("command.robcad") != '1') {
        (void)usleep(1000);
    }
    for (int i = 0; i < rounds; i++) {
        const bool look = ((i % 2) == 0);
        char buffer[4096];
        (void)publish("pose1.robcad", "0\n");
        (void)publish("command.robcad", "0\n");
        (void)usleep(300); /* the robot moves; the supervisor sleeps again */
        while (read(watch, buffer, sizeof buffer) > 0) {
            /* forget the notices of our own renames */
        }
        const double begin = publish("answer.robcad", "1\n");
        if (look) {
            while (first_byte("command.robcad") != '1') {
                /* no pause */
            }
            s_sample[1][s_count[1]++] = now_us() - begin;
        } else {
            await_rename(watch, "command.robcad");
            s_sample[2][s_count[2]++] = now_us() - begin;
        }
    }
    (void)kill(child, SIGTERM);
    (void)waitpid(child, NULL, 0);
    (void)close(watch);
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

static void report(const char *name, int which)
{
    double *const sample = s_sample[which];
    const int n = s_count[which];
    qsort(sample, (size_t)n, sizeof *sample, compare);
    (void)printf("%-42s %6d  p50 %7.1f  p90 %7.1f  p99 %7.1f  max %8.1f\n", name, n, sample[n / 2],
                 sample[(n * 9) / 10], sample[(n * 99) / 100], sample[n - 1]);
}

int main(int argc, char **argv)
{
    if (argc < 4) {
        (void)fprintf(stderr, "usage: %s DIR SUPERVISOR ROUNDS [INPUT_DIR]\n", argv[0]);
        return 2;
    }
    const int rounds = atoi(argv[3]);
    s_directory = open(argv[1], O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if ((s_directory < 0) || (rounds < 2) || (rounds > ROUNDS_MAX)) {
        give_up(argv[1]);
    }
    use_core(0);
    bare(argv[1], rounds);
    cell(argv[1], argv[2], (argc > 4) ? argv[4] : ".", rounds);
    (void)puts("microseconds");
    report("bare: rename, inotify, rename, inotify", 0);
    report("cell: answer there -> command published", 1);
    report("cell: answer there -> robot woken", 2);
    return 0;
}
