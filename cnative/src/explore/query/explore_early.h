/* SPDX-License-Identifier: MIT
 * explore_early.h - questions that single states decide (explore_query_early.c).
 */
#ifndef EXPLORE_EARLY_H
#define EXPLORE_EARLY_H

#include "../explore_run.h"
#include "../search/explore_successors.h"

/* Where questions are asked: a state has been expanded. */
void ex_early_see(ex_worker_t *worker, const ex_key_t *key, ex_found_t found);
/* Whether a state, which is not expanded yet, is one of those that are not to be. */
bool ex_early_avoids(ex_worker_t *worker, const ex_key_t *key);

#endif /* EXPLORE_EARLY_H */
