/* SPDX-License-Identifier: MIT
 * explore_counts.h - numbers of tokens that are counted up to a limit only (explore_counts.c).
 */
#ifndef EXPLORE_COUNTS_H
#define EXPLORE_COUNTS_H

#include "../explore_run.h"

/* Gets a successor of the opened state; false: no more are wanted. */
typedef bool (*ex_counts_sink_t)(void *user, const void *next);

/* Reads the table of run->options.counts and makes what the workers need; false: run->error says why. */
bool ex_counts_make(ex_run_t *run);
/* Makes a marking the one that stands for it. */
void ex_counts_begin(const ex_run_t *run, void *marking);
/* All that a successor of worker->marking by a transition may be, as the numbers there are not known beyond the limits.
 * `next` is as it was afterwards. False: the sink wants no more. */
bool ex_counts_each(const ex_worker_t *worker, uint32_t transition, void *next, ex_counts_sink_t sink, void *user);

#endif /* EXPLORE_COUNTS_H */
