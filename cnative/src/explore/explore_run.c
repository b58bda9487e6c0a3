/* SPDX-License-Identifier: MIT
 * explore_run.c - threads, pauses in which tables grow, and why a run ends.
 */
#define _POSIX_C_SOURCE 200809L

#include "explore_run.h"

#include "explore_report.h"
#include "explore_telling.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "pn/pn_num.h"

bool ex_is_listed(const char *list, uint32_t number)
{
    const char *at = list;
    while ((at != NULL) && (*at != '\0')) {
        char *end = NULL;
        if ((strtoul(at, &end, 10) == number) && (end != at)) {
            return true;
        }
        at = (*end == ',') ? (end + 1) : NULL;
    }
    return false;
}

double ex_clock(void)
{
    struct timespec now = { 0, 0 };
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + ((double)now.tv_nsec / 1e9);
}

double ex_cpu_clock(void)
{
    struct timespec now = { 0, 0 };
    (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + ((double)now.tv_nsec / 1e9);
}

void ex_stop(ex_run_t *run, ex_why_t why)
{
    int known = atomic_load(&run->why);
    while ((known < (int)why) && !atomic_compare_exchange_weak(&run->why, &known, (int)why)) {
    }
    atomic_store(&run->is_stopping, true);
}

void ex_phase(ex_run_t *run, const char *phase)
{
    atomic_store(&run->phase, phase);
    if ((run->options.ends_in != NULL) && (strcmp(run->options.ends_in, phase) == 0)) {
        ex_stop(run, EX_SECONDS);
    }
    if ((run->options.late_in != NULL) && (strcmp(run->options.late_in, phase) == 0)) {
        ex_report_late();
    }
}

static bool touches(int64_t transition, uint32_t place)
{
    const pn_transition_t *const t = (transition >= 0) ? &pn_net.transition[transition] : NULL;
    for (uint32_t k = 0U; (t != NULL) && (k < t->touched_count); k++) {
        if (t->touched[k] == place) {
            return true;
        }
    }
    return false;
}

/* The place that is full. Those of several instances of a page have one origin: it is that of the transition's. */
static int64_t place_at(const char *origin, int64_t transition)
{
    int64_t first = -1;
    for (uint32_t i = 0U; i < pn_net.place_count; i++) {
        if (strcmp(pn_net.place[i].multiset->origin, origin) == 0) {
            if (touches(transition, i)) {
                return (int64_t)i;
            }
            first = (first < 0) ? (int64_t)i : first;
        }
    }
    return first;
}

void ex_fail(ex_worker_t *worker, int64_t transition)
{
    ex_run_t *run = worker->run;
    const pn_ctx_t *cx = &worker->cx;
    const bool is_capacity = cx->error == PN_ERR_CAPACITY;
    const bool is_memory = cx->error == PN_ERR_MEMORY;
    worker->failed = true;
    (void)pthread_mutex_lock(&run->error_lock);
    if (run->error.kind == NULL) { /* the first one counts */
        (void)snprintf(run->error.message, sizeof run->error.message, "%s", cx->error_name);
        (void)snprintf(run->error.where, sizeof run->error.where, "%s", cx->error_origin);
        run->error.kind = is_capacity ? "capacity" : (is_memory ? "memory" : "exception");
        run->error.place = is_capacity ? place_at(cx->error_origin, transition) : -1;
        run->error.transition = transition;
    }
    (void)pthread_mutex_unlock(&run->error_lock);
    ex_stop(run, (is_capacity || is_memory) ? EX_CAPACITY : EX_ERROR);
}

/* --- pauses ------------------------------------------------------------------------------------------------------- */

/* With the gate locked: one part of what is done together; false: all have been begun. */
static bool do_part(ex_run_t *run)
{
    if ((run->shared == NULL) || (run->shared_taken == run->shared_parts)) {
        return false;
    }
    void (*const one)(void *user, uint32_t part) = run->shared;
    void *const user = run->shared_user;
    const uint32_t part = run->shared_taken;
    run->shared_taken++;
    (void)pthread_mutex_unlock(&run->gate);
    one(user, part);
    (void)pthread_mutex_lock(&run->gate);
    run->shared_done++;
    if (run->shared_done == run->shared_parts) {
        (void)pthread_cond_broadcast(&run->gate_changed);
    }
    return true;
}

static void together(void *self, uint32_t parts, void (*one)(void *user, uint32_t part), void *user)
{
    ex_run_t *const run = self;
    if (!run->is_growing || (parts == 1U)) { /* nobody waits; the gate may be open */
        for (uint32_t i = 0U; i < parts; i++) {
            one(user, i);
        }
        return;
    }
    run->shared = one;
    run->shared_user = user;
    run->shared_parts = parts;
    run->shared_taken = 0U;
    run->shared_done = 0U;
    (void)pthread_cond_broadcast(&run->gate_changed);
    while (do_part(run)) {
    }
    while (run->shared_done < parts) {
        (void)pthread_cond_wait(&run->gate_changed, &run->gate);
    }
    run->shared = NULL;
}

void ex_equip(ex_run_t *run)
{
    run->memory = (ex_memory_t){ .limit = run->options.memory, .folder = run->options.spill };
    run->team = (ex_team_t){ .threads = run->options.threads, .together = together, .self = run };
}

void ex_wait(ex_run_t *run)
{
    do {
        if (!do_part(run)) {
            (void)pthread_cond_wait(&run->gate_changed, &run->gate);
        }
    } while (run->is_growing);
}

/* Whatever is nearly full grows; the others wait, or help. */
static void grow_all(ex_run_t *run)
{
    ex_codec_t *codec = run->codec;
    uint32_t width[EX_KEY_WORDS];
    run->is_growing = true;
    bool is_fine = ex_bytes_grow(&codec->bytes);
    for (uint32_t i = 0U; i < EX_TABLES; i++) {
        is_fine = is_fine && ((codec->tuple_words[i] == 0U) || ex_tuples_grow(&codec->tuples[i]));
    }
    if (run->options.is_hashed) {
        (void)memcpy(width, run->store.width, sizeof width);
    } else {
        ex_key_widths(run, width);
    }
    /* A graph is made of the slots of the store: in it, what is new is not found, and not inserted either. */
    const bool is_settled = (run->store.bucket == NULL) || (run->graph != NULL);
    is_fine = is_fine && (is_settled || ex_store_grow(&run->store, width));
    if (!is_fine) {
        ex_stop(run, EX_MEMORY);
    } else {
        ex_telling_measure(run);
    }
    run->is_growing = false;
    run->paused = 0U;
    run->pauses++;
    atomic_store(&run->is_pausing, false);
    (void)pthread_cond_broadcast(&run->gate_changed);
}

void ex_check_pause(ex_run_t *run)
{
    if (ex_is_pausing(run) && !run->is_growing && (run->paused > 0U) && (run->paused == run->at_work)) {
        grow_all(run);
    }
}

bool ex_pause(ex_worker_t *worker)
{
    ex_run_t *run = worker->run;
    (void)pthread_mutex_lock(&run->gate);
    const uint64_t pauses = run->pauses;
    atomic_store(&run->is_pausing, true);
    run->paused++;
    ex_check_pause(run);
    while (pauses == run->pauses) {
        ex_wait(run);
    }
    (void)pthread_mutex_unlock(&run->gate);
    return !ex_is_stopping(run);
}

/* --- threads ------------------------------------------------------------------------------------------------------ */

/* As much as pn_stack_init counts on at most, and a little more. Addresses alone cost nothing. */
#define STACK_SIZE ((size_t)100U << 20U)

typedef struct job {
    ex_worker_t *worker;
    void (*work)(ex_worker_t *worker, void *user);
    void *user;
    pthread_t thread;
} job_t;

static void *start(void *user)
{
    job_t *job = user;
    ex_run_t *run = job->worker->run;
    pn_stack_init(&job->worker->cx); /* each thread has a stack of its own */
    job->work(job->worker, job->user);
    (void)pthread_mutex_lock(&run->gate);
    run->at_work--;
    ex_check_pause(run);
    (void)pthread_mutex_unlock(&run->gate);
    return NULL;
}

void ex_parallel(ex_run_t *run, void (*work)(ex_worker_t *worker, void *user), void *user)
{
    job_t job[EX_MOST_THREADS];
    const uint32_t threads = run->options.threads;
    uint32_t started = 1U;
    pthread_attr_t attributes;
    (void)pthread_attr_init(&attributes);
    (void)pthread_attr_setstacksize(&attributes, STACK_SIZE);
    run->at_work = threads;
    for (uint32_t i = 0U; i < threads; i++) {
        job[i] = (job_t){ .worker = &run->worker[i], .work = work, .user = user };
    }
    for (; started < threads; started++) {
        if (pthread_create(&job[started].thread, &attributes, start, &job[started]) != 0) {
            break;
        }
    }
    (void)pthread_mutex_lock(&run->gate);
    run->at_work -= threads - started; /* those that could not be had */
    (void)pthread_mutex_unlock(&run->gate);
    (void)pthread_attr_destroy(&attributes);
    (void)start(&job[0]);
    for (uint32_t i = 1U; i < started; i++) {
        (void)pthread_join(job[i].thread, NULL);
    }
}
