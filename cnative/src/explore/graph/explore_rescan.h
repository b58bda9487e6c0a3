/* SPDX-License-Identifier: MIT
 * explore_rescan.h - the states that are known gone through once more in breadth-first order, when the whole graph is
 * not there.
 */
#ifndef EXPLORE_AGAIN_H
#define EXPLORE_AGAIN_H

#include "explore_graph.h"
#include "../search/explore_successors.h"

/* Called for each state when its successors have been made; `found` as ex_successors gives it. False: enough. */
typedef bool (*ex_rescan_t)(void *user, uint32_t node, const ex_key_t *key, ex_found_t found);

/* Goes from the initial state through the states that are in the store, and fills slots and parents of a graph that has
 * nothing else. The first worker does it, and goes on whatever has stopped it before. Gives the node at which `visit`
 * had enough; EX_NO_NODE: none. */
uint32_t ex_rescan(ex_run_t *run, ex_graph_t *graph, ex_rescan_t visit, void *user);
/* Tables of the graph for that; false: no memory. */
bool ex_rescan_make(ex_run_t *run, ex_graph_t *graph);

#endif /* EXPLORE_AGAIN_H */
