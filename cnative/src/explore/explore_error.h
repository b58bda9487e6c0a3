/* SPDX-License-Identifier: MIT
 * explore_error.h - the way to an exception that an inscription raises.
 */
#ifndef EXPLORE_ERROR_H
#define EXPLORE_ERROR_H

#include "graph/explore_graph.h"

/* Where an exception is raised. */
typedef struct ex_raised {
    uint64_t node; /* from 1, in breadth-first order of what is known; 0: states have no numbers */
    int64_t steps; /* of the trace there; -1: there is no trace */
    char *binding; /* JSON: the binding element whose occurrence raises it; NULL: a guard or an input arc does */
    char path[EX_PATH_SIZE]; /* of the trace */
} ex_raised_t;

/* After an exploration that has ended with an exception and with an exact store: fills run->raised, and run->error anew
 * with the exception of that node. Nothing is changed when the way cannot be found (no memory, interrupted). */
void ex_follow_error(ex_run_t *run);
/* The same of one of many searches, which stores no states: after the way to the state at hand. */
void ex_follow_way_error(ex_run_t *run);
/* Members of the error in the report: , "node": ..., "binding": ..., "trace": ... */
void ex_raised_json(const ex_run_t *run, FILE *out);

#endif /* EXPLORE_ERROR_H */
