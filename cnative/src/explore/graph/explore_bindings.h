/* SPDX-License-Identifier: MIT
 * explore_bindings.h - with which values some transitions occur in a graph that is whole: each binding once.
 */
#ifndef EXPLORE_BINDINGS_H
#define EXPLORE_BINDINGS_H

#include <stdio.h>

#include "explore_graph.h"

/* Goes through the graph once more for the transitions of `options.bindings`. It tells of none where the graph is large
 * or has been reduced, where there are too many bindings, and when the time is over. */
void ex_bindings(ex_run_t *run);
/* A member of the report: `{"3": [{"p": 1}, ..], ..}` by transition, or null. */
void ex_bindings_json(const ex_run_t *run, FILE *out);

#endif /* EXPLORE_BINDINGS_H */
