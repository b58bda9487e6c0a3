/* SPDX-License-Identifier: MIT
 * explore_instances.h - parts of the net that can be exchanged: one state for all that differ only in which of them is
 * which (explore_instances.c).
 */
#ifndef EXPLORE_INSTANCES_H
#define EXPLORE_INSTANCES_H

#include "explore_reduce.h"

/* Reads the table of run->options.instances, and makes what the workers need. False: it is wrong, or there is no
 * memory. */
bool ex_instances_make(ex_run_t *run, ex_reduction_t *reduction);
/* As ex_canonical. NULL: a place has too little room, or memory is used up; the worker has failed. */
const void *ex_instances_canonical(ex_worker_t *worker, const void *marking);
/* Whether all parts of each family hold the same, as in the initial marking. */
bool ex_instances_are_even(ex_worker_t *worker, const void *marking);

/* A run goes through states that are exchanged, while the states of the way are representatives. Before it: nothing is
 * exchanged yet. After each step: what has been exchanged for the last marking that ex_instances_canonical was given.
 */
void ex_instances_start(ex_worker_t *worker);
void ex_instances_follow(ex_worker_t *worker);
/* The transition of the run that occurs when one does on the way. */
uint32_t ex_instances_real(const ex_worker_t *worker, uint32_t transition);
/* Makes worker->marking, which is on the way, that of the run. False: as for ex_instances_canonical. */
bool ex_instances_restore(ex_worker_t *worker);

#endif /* EXPLORE_INSTANCES_H */
