/* SPDX-License-Identifier: MIT
 * explore_bounds.h - the bounds of places (explore_bounds.c).
 */
#ifndef EXPLORE_BOUNDS_H
#define EXPLORE_BOUNDS_H

#include "explore_run.h"

typedef struct ex_bounds ex_bounds_t;
bool ex_bounds_make(ex_worker_t *worker);
/* Called once for each state, with worker->marking that of the state. */
void ex_bounds_see(ex_worker_t *worker);
/* After the exploration: puts together what was seen, once. */
void ex_bounds_find(ex_run_t *run);
/* One multi-set that a place which is not packed has held, by its number, is seen by the worker. The buffer has
 * EX_TEXT_SIZE bytes. */
#define EX_TEXT_SIZE ((size_t)1U << 22)
bool ex_bounds_see_number(ex_worker_t *worker, uint64_t number, char *buffer);
bool ex_bounds_are_found(const ex_run_t *run);
/* The same if it has not been done, and then: ,"bounds": [...] as a member of the report. */
void ex_bounds_json(ex_run_t *run, FILE *out);

#endif /* EXPLORE_BOUNDS_H */
