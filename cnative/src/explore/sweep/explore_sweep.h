/* SPDX-License-Identifier: MIT
 * explore_sweep.h - the search that forgets what lies behind it (explore_sweep.c).
 */
#ifndef EXPLORE_SWEEP_H
#define EXPLORE_SWEEP_H

#include "../query/explore_query.h"
#include "explore_sweep_log.h"

typedef struct ex_sweep ex_sweep_t;

/* Reads the table of `--sweep`: lines of a place and what a token of it counts, or (with `=`, or the label of a
 * component) the number in it; `time`. False: what is wrong has been said. */
bool ex_sweep_read(ex_run_t *run);
/* Behind the initial state, which is in the store. False: no memory. */
bool ex_sweep_begin(ex_run_t *run);
/* A state that is new to the store: it waits, as soon as the one at hand has been expanded. False: no memory. */
bool ex_sweep_found(ex_run_t *run, const ex_key_t *key);
/* The store is full: whether there is room again, since keys have left it that nobody comes back to. */
bool ex_sweep_forget(ex_run_t *run);
/* Takes what waits, in the order of the measure, until nothing is left or the run stops. */
void ex_sweep_work(ex_worker_t *worker, void *user);
/* For the progress and the report. */
uint64_t ex_sweep_states(const ex_run_t *run);
/* What waits when the search has ended early belongs to the bounds, too. False: there is no time for it. */
bool ex_sweep_see_rest(ex_run_t *run);

/* The state at hand is dead, or decides a question. */
void ex_sweep_dead(ex_run_t *run);
void ex_sweep_decided(const ex_run_t *run, uint32_t question);
/* The key of the state at hand; and a run to it as a trace: its steps, -1: there is none. */
ex_key_t ex_sweep_at(const ex_run_t *run);
int64_t ex_sweep_write(ex_run_t *run, const char *path, const char *why);
/* Writes the runs to what has decided questions. */
void ex_sweep_answer(ex_run_t *run);
/* Members of the report: the traces to dead states; ,"sweep": {...} */
void ex_sweep_traces_json(ex_run_t *run, FILE *out);
void ex_sweep_json(const ex_run_t *run, FILE *out);

#endif /* EXPLORE_SWEEP_H */
