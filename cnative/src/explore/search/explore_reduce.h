/* SPDX-License-Identifier: MIT
 * explore_reduce.h - reductions of the state space: which successors of a state are looked at (explore_stubborn.c), and
 * which state stands for those that are the same but for the names of colours (explore_symmetry.c), or but for which of
 * several equal parts of the net is which (explore_instances.c).
 *
 * All but the last rest on a table of the binding elements (explore_elements.c) that comes with the net: counters are
 * the colours of packed places that can be marked, elements say how many of each they take and put. Successors are made
 * by the compiled net as always; the table decides about them, and where the two differ the run ends with an error.
 */
#ifndef EXPLORE_REDUCE_H
#define EXPLORE_REDUCE_H

#include "../explore_run.h"

/* What an element does with a counter. */
typedef struct ex_touch {
    uint32_t other;    /* in the list of an element: the counter; in the list of a counter: the element */
    uint32_t pre;      /* tokens that have to be there, and are taken */
    uint32_t post;     /* tokens that are put */
    bool is_inhibitor; /* there must be none */
    bool is_reset;     /* there is none afterwards */
    bool is_useful;    /* the element is */
} ex_touch_t;

typedef struct ex_element {
    uint32_t transition;
    bool is_useful; /* ways to dead states may have it in them */
    uint64_t first; /* of its touches */
    uint64_t end;
} ex_element_t;

/* A counter in the packed part of the marking. */
typedef struct ex_counter {
    uint32_t word; /* of 64 bits */
    uint32_t shift;
    uint64_t mask;
    uint64_t first; /* of its uses */
    uint64_t end;
} ex_counter_t;

/* A cyclic group of permutations of the counters, or a dihedral one. */
typedef struct ex_rotations {
    uint32_t order;
    uint32_t *rotation;
    uint32_t *reflection; /* NULL: none */
} ex_rotations_t;

/* The product of the symmetric groups of the classes of points. */
typedef struct ex_exchanges {
    uint32_t points; /* 0: none */
    uint32_t *label; /* by point: its class */
    uint32_t *shape; /* by counter */
    uint64_t *first; /* by counter: its points are point[first[i]] .. point[first[i + 1] - 1] */
    uint32_t *point;
    uint32_t *slot;  /* points in the order of their classes */
    uint32_t *table; /* from shape and points to the counter: hashed, counter + 1 */
    uint64_t table_mask;
} ex_exchanges_t;

typedef struct ex_reduction {
    bool is_stubborn;
    bool is_symmetric;
    uint32_t words; /* of 64 bits: the packed part */
    uint32_t counters;
    ex_counter_t *counter;
    uint32_t elements;
    ex_element_t *element;
    ex_touch_t *touch; /* of the elements */
    ex_touch_t *use;   /* of the counters */
    uint32_t rotation_count;
    ex_rotations_t *rotations;
    ex_exchanges_t exchanges;
    struct ex_dependency *dependency; /* of explore_dependency.c; NULL: partial order goes by binding elements */
    struct ex_instances *instances;   /* of explore_instances.c; NULL: symmetry is of colours */
} ex_reduction_t;

/* Reads the table of run->options.elements and makes what the workers need. False: run->error says why; its kind is
 * "reduction" when the table does not fit the compiled net, which can then be explored without. */
bool ex_reduction_make(ex_run_t *run);
/* The part of explore_elements.c, of explore_stubborn.c, of explore_symmetry.c. */
bool ex_elements_read(ex_run_t *run, ex_reduction_t *reduction, const char *path);
/* The way from points to counters. */
bool ex_exchanges_index(ex_run_t *run, ex_reduction_t *reduction);
bool ex_stubborn_make(ex_worker_t *worker, const ex_reduction_t *reduction);
bool ex_symmetry_make(ex_worker_t *worker, const ex_reduction_t *reduction);

static inline uint32_t ex_count_of(const ex_counter_t *counter, const uint64_t *packed)
{
    return (uint32_t)((packed[counter->word] >> counter->shift) & counter->mask);
}

/* --- stubborn sets ------------------------------------------------------------------------------------------------ */

/* Works out which elements are enabled in worker->marking, and which of them are to be looked at: perhaps none, when no
 * dead state can be reached. */
void ex_stubborn_begin(ex_worker_t *worker);
/* Whether this successor of worker->marking is looked at. False with *is_known false: the table lacks it. */
bool ex_stubborn_takes(ex_worker_t *worker, uint32_t transition, const void *next, bool *is_known);
/* Whether all elements of the table that are enabled have come as successors. */
bool ex_stubborn_is_even(const ex_worker_t *worker);

/* --- stubborn sets of transitions --------------------------------------------------------------------------------- */

/* Reads the table of run->options.dependency; false: it is wrong, or there is no memory. */
bool ex_dependency_read(ex_run_t *run, ex_reduction_t *reduction, const char *path);
bool ex_persistent_make(ex_worker_t *worker, const ex_reduction_t *reduction);
/* By transition whether it is enabled in worker->marking: whoever asks for a choice fills this in. */
bool *ex_persistent_enabled(const ex_worker_t *worker);
/* By transition whether it is to be looked at; `priority` is that of what is enabled. It lives until the next call. */
const bool *ex_persistent_choose(ex_worker_t *worker, int32_t priority);

/* --- symmetry ----------------------------------------------------------------------------------------------------- */

/* The marking that stands for all that are symmetric to this one: the same for each of them. It lives until the next
 * call. NULL: the worker has failed. */
const void *ex_canonical(ex_worker_t *worker, const void *marking);

/* Ends the run with an error of a kind that is not an exception. */
void ex_note(ex_run_t *run, const char *kind, const char *message, int64_t transition);
/* Ends the run: the table and the compiled net differ in a state. */
void ex_differs(ex_worker_t *worker, uint32_t transition, const char *how);

#endif /* EXPLORE_REDUCE_H */
