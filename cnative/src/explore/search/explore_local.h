/* SPDX-License-Identifier: MIT
 * explore_local.h - what transitions do, remembered by the places that they look at.
 */
#ifndef EXPLORE_LOCAL_H
#define EXPLORE_LOCAL_H

#include "../explore_run.h"
#include "explore_successors.h"

typedef struct ex_local ex_local_t;
typedef struct ex_wake ex_wake_t;

typedef enum ex_local_found {
    EX_LOCAL_UNKNOWN, /* nothing has been done: the transition has to be asked itself */
    EX_LOCAL_NONE,    /* it is not enabled */
    EX_LOCAL_SOME,
    EX_LOCAL_STOPPED, /* by the sink */
    EX_LOCAL_FAILED   /* worker->failed */
} ex_local_found_t;

/* Where it is possible: worker->local. False: no memory. */
bool ex_local_make(ex_worker_t *worker);
/* The successors of the opened state (ex_open) by a transition at the time of worker->marking. Only that time and the
 * packed places of worker->marking are worth something afterwards. */
ex_local_found_t ex_local_successors(ex_worker_t *worker, uint32_t t, ex_times_sink_t sink, void *user);

/* Some transitions that are asked next: what is known of them is on its way then. To be called for all of them. */
#define EX_AHEAD 8U
void ex_local_ahead(ex_worker_t *worker, const uint32_t *t, uint32_t count);

/* --- explore_wake.c --- */

/* Where it is possible: worker->wake. False: no memory. */
bool ex_wakes_make(ex_worker_t *worker);
/* The earliest time after that of worker->marking at which a token of the opened state becomes available. False: there
 * is none, or an error. */
bool ex_next_time(ex_worker_t *worker, pn_time_t *next);

#endif /* EXPLORE_LOCAL_H */
