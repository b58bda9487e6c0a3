/* SPDX-License-Identifier: MIT
 * explore_rescan.c - the states that are known, once more in breadth-first order. With breadth-first exploration the
 * first ones in which something holds are the same ones whatever the number of threads: all states that are not deeper
 * are known.
 */
#include "explore_rescan.h"
#include "../search/explore_successors.h"

#include <string.h>

enum { BATCH = 64 };

/* Successors whose lines of the store are on their way. */
typedef struct search {
    ex_run_t *run;
    ex_graph_t *graph; /* slots, parents and which are dead alone */
    uint64_t *seen;    /* a bit for each slot */
    uint32_t node;     /* being expanded */
    uint32_t pending;
    ex_key_t key[BATCH];
    uint64_t hash[BATCH];
} search_t;

static void look_up(search_t *search)
{
    ex_graph_t *const graph = search->graph;
    for (uint32_t i = 0U; i < search->pending; i++) {
        const uint64_t slot = ex_store_find(&search->run->store, &search->key[i], search->hash[i]);
        if ((slot != EX_NO_SLOT) && (EX_BIT(search->seen, slot) == 0U) && (graph->nodes < graph->node_room)) {
            EX_SET_BIT(search->seen, slot);
            graph->slot[graph->nodes] = slot;
            graph->parent[graph->nodes] = search->node;
            graph->nodes += 1U;
        }
    }
    search->pending = 0U;
}

static bool gather(void *user, uint32_t transition, const void *binding, const ex_key_t *key)
{
    search_t *const search = user;
    (void)binding;
    search->run->worker[0].fired[transition]++;
    search->key[search->pending] = *key;
    search->hash[search->pending] = ex_hash(key);
    ex_store_prefetch(&search->run->store, search->hash[search->pending]);
    search->pending += 1U;
    if (search->pending == (uint32_t)BATCH) {
        look_up(search);
    }
    return true;
}

/* The first worker can go on after an error. */
static void revive(ex_run_t *run)
{
    ex_worker_t *const worker = &run->worker[0];
    worker->cx.error = PN_OK;
    worker->failed = false;
    ex_unload(worker);
    run->at_work = 1U;
    atomic_store(&run->is_stopping, false);
}

static uint32_t walk(search_t *search, ex_rescan_t visit, void *user)
{
    ex_run_t *const run = search->run;
    ex_graph_t *const graph = search->graph;
    const uint64_t slot = ex_store_find(&run->store, &run->initial, ex_hash(&run->initial));
    if (slot == EX_NO_SLOT) {
        return EX_NO_NODE;
    }
    (void)memset(search->seen, 0, ((ex_store_slots(&run->store) / 64U) + 1U) * sizeof *search->seen);
    EX_SET_BIT(search->seen, slot);
    graph->slot[0] = slot;
    graph->parent[0] = 0U;
    graph->nodes = 1U;
    for (uint32_t node = 0U; (node < graph->nodes) && !ex_is_stopping(run); node++) {
        ex_key_t key;
        search->node = node;
        search->pending = 0U;
        if (!ex_store_fetch(&run->store, graph->slot[node], &key)) {
            return EX_NO_NODE;
        }
        const ex_found_t found = ex_successors(&run->worker[0], &key, gather, search);
        look_up(search);
        if (found == EX_DEAD) {
            EX_SET_BIT(graph->dead, node);
        }
        if (!visit(user, node, &key, found)) {
            return node;
        }
        if (found == EX_FAILED) {
            return EX_NO_NODE;
        }
    }
    return EX_NO_NODE;
}

uint32_t ex_rescan(ex_run_t *run, ex_graph_t *graph, ex_rescan_t visit, void *user)
{
    search_t *const search = ex_alloc(&run->memory, sizeof *search);
    uint32_t node = EX_NO_NODE;
    bool is_moved = search != NULL;
    while (is_moved) { /* a table that has to grow moves the slots */
        const uint64_t pauses = run->pauses;
        const uint64_t words = (ex_store_slots(&run->store) / 64U) + 1U;
        search->run = run;
        search->graph = graph;
        search->seen = ex_alloc(&run->memory, words * sizeof *search->seen);
        if (search->seen == NULL) {
            break;
        }
        revive(run);
        node = walk(search, visit, user);
        ex_free(&run->memory, search->seen, words * sizeof *search->seen);
        is_moved = pauses != run->pauses;
    }
    ex_free(&run->memory, search, sizeof *search);
    return node;
}

bool ex_rescan_make(ex_run_t *run, ex_graph_t *graph)
{
    *graph = (ex_graph_t){ .node_room = run->nodes };
    if ((run->nodes == 0U) || (run->nodes >= (uint64_t)EX_NO_NODE)) {
        return false;
    }
    graph->slot = ex_alloc(&run->memory, run->nodes * sizeof *graph->slot);
    graph->parent = ex_alloc(&run->memory, run->nodes * sizeof *graph->parent);
    graph->dead = ex_alloc(&run->memory, ((run->nodes / 64U) + 1U) * sizeof *graph->dead);
    return (graph->slot != NULL) && (graph->parent != NULL) && (graph->dead != NULL);
}
