/* SPDX-License-Identifier: MIT
 * tables_ltl.h - what the searches for a run that an automaton accepts share: pairs of a marking and one of its states.
 */
#ifndef PN_TABLES_LTL_H
#define PN_TABLES_LTL_H

#include "tables.h"

typedef struct tb_pair {
    uint32_t marking;
    uint32_t state;
    uint32_t index;  /* on the path or in one of its components: when it was met, from 1; 0: left for good */
    uint32_t hunt;   /* the last search for a way back that has met it */
    bool is_entered; /* by the search depth first */
    bool is_awaited; /* or by the hunt */
} tb_pair_t;

typedef struct tb_path_step {
    uint32_t pair;
    uint32_t move; /* of the automaton */
    uint32_t next; /* successor of the marking */
} tb_path_step_t;

typedef struct tb_root {
    uint32_t index;
    bool is_accepting;
} tb_root_t;

typedef struct tb_product {
    tb_graph_t *graph;
    const tb_automaton_t *automaton;
    tb_pair_t *pair;
    uint64_t pairs;
    uint64_t pair_room;
    uint32_t *slot;
    uint64_t slots;
    uint64_t *atoms; /* marking -> bits of the atoms, and the highest bit if they are known */
    uint64_t atom_room;
    tb_path_step_t *path;
    uint64_t steps;
    uint64_t step_room;
    tb_root_t *root;
    uint64_t roots;
    uint64_t root_room;
    uint32_t *active;
    uint64_t actives;
    uint64_t active_room;
} tb_product_t;

/* The number of a pair. */
uint32_t tb_pair_number(tb_product_t *p, uint32_t marking, uint32_t state);

/* The next pair after one whose marking is expanded; `move` and `next` say where to go on, and are moved on. False:
 * there is none. */
bool tb_next_pair(tb_product_t *p, tb_path_step_t *at, uint32_t *marking, uint32_t *state);

/* Whether a run is accepted, if one is found by going to what accepts and back to it, the nearest first
 * (tables_ltl_hunt.c). */
bool tb_hunt(tb_product_t *p);

#endif
