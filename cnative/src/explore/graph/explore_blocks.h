/* SPDX-License-Identifier: MIT
 * explore_blocks.h - the nodes of a graph some hundreds at a time: their arcs, in order, before all targets have
 * numbers.
 */
#ifndef EXPLORE_BLOCKS_H
#define EXPLORE_BLOCKS_H

#include "explore_graph.h"

#define EX_BLOCK_NODES 512U

/* An arc: its transition, in the lower 16 bits; above them the slot of its target, or, with EX_NUMBERED, its number
 * (from 1). */
#define EX_NUMBERED   ((uint64_t)1U << 63U)
#define EX_LABEL_BITS 16U

/* The nodes first .. first + count - 1. */
typedef struct ex_block {
    uint32_t count;
    uint64_t used; /* arcs */
    uint64_t room;
    uint64_t *arc;
    uint32_t arcs[EX_BLOCK_NODES]; /* of each node */
    uint8_t is_dead[EX_BLOCK_NODES];
    uint8_t is_late[EX_BLOCK_NODES];
    uint8_t is_cut[EX_BLOCK_NODES];  /* it has arcs that are not there */
    uint8_t is_open[EX_BLOCK_NODES]; /* it was not found out whether it has any */
} ex_block_t;

/* What a thread makes blocks with. */
typedef struct ex_expander ex_expander_t;

/* `is_partial`: successors that are not in the store are passed over. NULL: no memory. */
ex_expander_t *ex_expander_make(ex_worker_t *worker, const ex_graph_t *graph, bool is_partial);
void ex_expander_free(ex_expander_t *expander);
/* Fills `count` of the block and all that follows. While it is at work no node gets a number. False: no memory, an
 * exception, or the net does not do the same twice. */
bool ex_expand(ex_expander_t *expander, ex_block_t *block, uint32_t first, uint32_t count);

#endif /* EXPLORE_BLOCKS_H */
