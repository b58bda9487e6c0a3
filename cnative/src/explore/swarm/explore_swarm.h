/* SPDX-License-Identifier: MIT
 * explore_swarm.h - one of many searches (explore_swarm.c).
 */
#ifndef EXPLORE_SWARM_H
#define EXPLORE_SWARM_H

#include "../explore_run.h"
#include "../graph/explore_graph.h"
#include "../query/explore_query.h"
#include "../search/explore_successors.h"
#include "explore_sketch.h"

typedef struct ex_swarm {
    ex_key_t *way;  /* the states from the initial one to the one at hand */
    uint64_t depth; /* of the one at hand */
    uint64_t random;
    ex_sketch_t sketch;
    /* Of walks: which successor is next. */
    ex_key_t next;
    uint64_t weight;      /* of all that there are, so far */
    struct ex_trap *trap; /* of walks, where it is looked for one; NULL: it was not yet */
    uint64_t trapped;     /* states that were looked at for that */
    /* The first dead state. */
    int64_t dead_steps; /* of its trace; -1: there is none */
    char dead_path[EX_PATH_SIZE];
} ex_swarm_t;

/* False: no memory. */
bool ex_swarm_make(ex_run_t *run);
/* The state at hand, which is about to be expanded, is another one. False after an error. */
bool ex_swarm_at(ex_worker_t *worker, const ex_key_t *key, uint64_t depth);
/* Whether its successors are not taken, since the way would become too long. */
bool ex_swarm_is_end(const ex_run_t *run);
/* It is dead, or decides a question. */
void ex_swarm_dead(ex_worker_t *worker);
void ex_swarm_decided(ex_worker_t *worker, ex_question_t *question, uint32_t number, ex_found_t found);
/* The run to the state at hand as a trace; its steps, -1: it could not be written. */
int64_t ex_swarm_write(ex_run_t *run, const char *path, const char *why);
/* The member of the report. */
void ex_swarm_json(ex_run_t *run, FILE *out);

/* explore_walk.c: a successor of the state at hand; and from the initial state on at random, again and again. */
bool ex_walk_take(ex_worker_t *worker, uint32_t transition, uint32_t times, const ex_key_t *key);
void ex_walk(ex_worker_t *worker, void *user);

/* explore_trap.c: whether the end can no longer be reached from the state at hand, of which that is asked; and how much
 * longer a way may become meanwhile. */
void ex_trap_look(ex_worker_t *worker);
uint64_t ex_trap_room(void);

#endif /* EXPLORE_SWARM_H */
