/* SPDX-License-Identifier: MIT
 * explore_successors.h - what occurs in a state, and the states after it (explore_successors.c).
 */
#ifndef EXPLORE_SUCCESSORS_H
#define EXPLORE_SUCCESSORS_H

#include <stdbool.h>
#include <stdint.h>

#include "../state/explore_key.h"

struct ex_worker;

/* Whether the net always does the same in a state: no files. */
bool ex_is_repeatable(void);
/* An arc: the binding, outputs of the code segment included, lives until the call returns. False: stop. */
typedef bool (*ex_arc_sink_t)(void *user, uint32_t transition, const void *binding, const ex_key_t *key);

typedef enum ex_found {
    EX_SOME,    /* at least one successor */
    EX_DEAD,    /* none, now and at any later time */
    EX_STOPPED, /* the sink said so */
    EX_FAILED   /* an inscription raised an exception, or memory is used up: worker->failed */
} ex_found_t;

/* Arcs from a state to one other by the same transition, so many at a time. False: stop. */
typedef bool (*ex_times_sink_t)(void *user, uint32_t transition, uint32_t times, const ex_key_t *key);

/* If the time is reduced: worker->marking, at the time 0, becomes the state that stands for all that are like it. */
void ex_reduce_time(struct ex_worker *worker);
/* All binding elements of the best priority that are enabled in the state, or at the next time at which there are any;
 * in the documented order. worker->marking is then the state at the time of these occurrences (pn_net.now). */
ex_found_t ex_successors(struct ex_worker *worker, const ex_key_t *key, ex_arc_sink_t sink, void *user);

/* The same for those who do not want to know the bindings, and faster (explore_local.c). Afterwards only packed places
 * of worker->marking are worth something; for the others there is ex_load_places. */
ex_found_t ex_arcs(struct ex_worker *worker, const ex_key_t *key, ex_times_sink_t sink, void *user);

/* As ex_arc_sink_t, with the marking that follows. */
typedef bool (*ex_marking_sink_t)(void *user, uint32_t transition, const void *binding, const void *next);
/* As ex_successors, of worker->marking, where nothing is reduced and there is no time. */
ex_found_t ex_next_markings(struct ex_worker *worker, ex_marking_sink_t sink, void *user);
/* All binding elements that are enabled in worker->marking now, whatever the reductions. */
ex_found_t ex_all_successors(struct ex_worker *worker, ex_marking_sink_t sink, void *user);

#endif /* EXPLORE_SUCCESSORS_H */
