/* SPDX-License-Identifier: MIT
 * explore_path.c - ways through the graph, which prove the answer to a question.
 */
#include "../query/explore_query.h"

#include <stdlib.h>

bool ex_path_begin(ex_path_t *path, uint32_t node)
{
    *path = (ex_path_t){ .room = 64U, .loop = -1 };
    path->node = malloc(path->room * sizeof *path->node);
    path->label = malloc(path->room * sizeof *path->label);
    path->is_failed = (path->node == NULL) || (path->label == NULL);
    if (!path->is_failed) {
        path->node[0] = node;
        path->label[0] = 0U;
    }
    return !path->is_failed;
}

void ex_path_step(ex_path_t *path, uint16_t label, uint32_t node)
{
    if (!path->is_failed && ((path->steps + 1U) == path->room)) {
        const uint64_t room = path->room * 2U;
        uint32_t *const nodes = realloc(path->node, room * sizeof *nodes);
        path->node = (nodes != NULL) ? nodes : path->node;
        uint16_t *const labels = realloc(path->label, room * sizeof *labels);
        path->label = (labels != NULL) ? labels : path->label;
        path->is_failed = (nodes == NULL) || (labels == NULL);
        path->room = path->is_failed ? path->room : room;
    }
    if (!path->is_failed) {
        path->steps += 1U;
        path->node[path->steps] = node;
        path->label[path->steps] = label;
    }
}

bool ex_path_arc(const ex_graph_t *graph, uint32_t label, uint32_t node, ex_path_t *path)
{
    const uint32_t from = ex_path_end(path);
    for (uint64_t arc = graph->row[from]; arc < graph->row[from + 1U]; arc++) {
        if ((graph->target[arc] == node) && ((label == UINT32_MAX) || (graph->label[arc] == label))) {
            ex_path_step(path, graph->label[arc], node);
            return !path->is_failed;
        }
    }
    return false;
}

/* Adds the nodes that lead to `node` by `parent`, which ends at the end of the way. */
static bool follow_parents(const ex_graph_t *graph, const uint32_t *parent, uint32_t node, ex_path_t *path)
{
    const uint32_t from = ex_path_end(path);
    uint64_t count = 0U;
    for (uint32_t at = node; at != from; at = parent[at]) {
        count += 1U;
    }
    uint32_t *const list = malloc((count + 1U) * sizeof *list);
    if (list == NULL) {
        path->is_failed = true;
        return false;
    }
    uint64_t i = count;
    for (uint32_t at = node; at != from; at = parent[at]) {
        i -= 1U;
        list[i] = at;
    }
    bool is_fine = true;
    for (i = 0U; is_fine && (i < count); i++) {
        is_fine = ex_path_arc(graph, UINT32_MAX, list[i], path);
    }
    free(list);
    return is_fine;
}

void ex_path_from_start(const ex_graph_t *graph, uint32_t node, ex_path_t *path)
{
    (void)follow_parents(graph, graph->parent, node, path);
}

static bool is_in(const uint64_t *set, uint32_t node)
{
    return (set == NULL) || (EX_BIT(set, node) != 0U);
}

/* Breadth first; `parent` is EX_NO_NODE where nothing has been. Gives the node of the goal that was found, EX_NO_NODE:
 * none. */
static uint32_t search(const ex_queries_t *queries, const uint64_t *through, const uint64_t *goal, uint32_t from,
                       uint32_t *parent, uint32_t *queue)
{
    const ex_graph_t *const graph = queries->run->graph;
    uint64_t used = 1U;
    queue[0] = from;
    parent[from] = from;
    if (is_in(goal, from)) {
        return from;
    }
    for (uint64_t i = 0U; (i < used) && !ex_is_stopping(queries->run); i++) {
        const uint32_t node = queue[i];
        if (!is_in(through, node)) {
            continue;
        }
        for (uint64_t arc = graph->row[node]; arc < graph->row[node + 1U]; arc++) {
            const uint32_t target = graph->target[arc];
            if (parent[target] == EX_NO_NODE) {
                parent[target] = node;
                queue[used] = target;
                used += 1U;
                if (is_in(goal, target)) {
                    return target;
                }
            }
        }
    }
    return EX_NO_NODE;
}

bool ex_path_search(ex_queries_t *queries, const uint64_t *through, const uint64_t *goal, ex_path_t *path)
{
    ex_run_t *const run = queries->run;
    const uint64_t nodes = run->graph->nodes;
    uint32_t *const parent = ex_table(&run->memory, nodes, sizeof *parent);
    uint32_t *const queue = ex_table(&run->memory, nodes, sizeof *queue);
    bool is_found = false;
    if ((parent != NULL) && (queue != NULL) && !path->is_failed) {
        (void)memset(parent, 0xff, nodes * sizeof *parent);
        const uint32_t node = search(queries, through, goal, ex_path_end(path), parent, queue);
        is_found = (node != EX_NO_NODE) && follow_parents(run->graph, parent, node, path);
    }
    ex_free_table(&run->memory, parent, nodes, sizeof *parent);
    ex_free_table(&run->memory, queue, nodes, sizeof *queue);
    return is_found;
}
