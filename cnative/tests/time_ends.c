/* SPDX-License-Identifier: MIT
 * time_ends.c - a clock for tests (LD_PRELOAD): a thousand seconds pass when the program's first thread looks at the clock for
 * the nth time (TIME_ENDS_AT), and it goes on only when the thread that watches the time has seen that.
 *
 * The first look says when the run began, before there is a watch, so n is 2 at least. Thus time ends at a moment that is the
 * same on every machine.
 */
#include <dlfcn.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

typedef int (*look_t)(clockid_t clock, struct timespec *now);
typedef int (*wait_t)(pthread_cond_t *condition, pthread_mutex_t *mutex, const struct timespec *until);

static atomic_bool s_is_over;
static atomic_bool s_is_seen;    /* it has looked since time is over */
static atomic_int s_looks;
static _Thread_local bool s_has_looked;

int clock_gettime(clockid_t clock, struct timespec *now)
{
    static look_t look;
    if (look == NULL) {
        look = (look_t)dlsym(RTLD_NEXT, "clock_gettime");
    }
    const int done = look(clock, now);
    if (clock != CLOCK_MONOTONIC) {
        return done;
    }
    const char *at = getenv("TIME_ENDS_AT");
    const bool is_first_thread = gettid() == getpid();
    if (is_first_thread && (at != NULL) && (atomic_fetch_add(&s_looks, 1) + 1 == atoi(at))) {
        atomic_store(&s_is_over, true);
        while (!atomic_load(&s_is_seen)) {
            (void)usleep(100);
        }
    }
    if (atomic_load(&s_is_over)) {
        now->tv_sec += 1000;
        s_has_looked = true;
    }
    return done;
}

/* The watch waits for a moment that is far away: it is woken all the time. */
int pthread_cond_timedwait(pthread_cond_t *condition, pthread_mutex_t *mutex, const struct timespec *until)
{
    static wait_t wait;
    (void)until;
    if (wait == NULL) {
        wait = (wait_t)dlsym(RTLD_NEXT, "pthread_cond_timedwait");
    }
    if (s_has_looked) {
        atomic_store(&s_is_seen, true);
    }
    struct timespec soon;
    (void)clock_gettime(CLOCK_REALTIME, &soon);
    soon.tv_nsec += 1000000L;
    if (soon.tv_nsec >= 1000000000L) {
        soon.tv_sec++;
        soon.tv_nsec -= 1000000000L;
    }
    return wait(condition, mutex, &soon);
}
