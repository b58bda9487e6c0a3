/* SPDX-License-Identifier: MIT
 * explore_telling.h - what telling the bounds will take (explore_telling.c).
 */
#ifndef EXPLORE_TELLING_H
#define EXPLORE_TELLING_H

#include "explore_run.h"

/* Who measures, where there is a limit of time. Without one, or with references, the search ends at its limit. */
void ex_telling_make(ex_run_t *run);
/* While all threads pause: measures what a state and a multi-set take. */
void ex_telling_measure(ex_run_t *run);
/* About how many seconds it would take to tell the bounds of what was seen until now. */
double ex_telling_seconds(ex_run_t *run);

#endif /* EXPLORE_TELLING_H */
