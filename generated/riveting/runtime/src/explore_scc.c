/* SPDX-License-Identifier: MIT
 * explore_scc.c - strongly connected components and cycles, by Tarjan's algorithm in Pearce's form (one number for each node), without
 * recursion.
 *
 * rank[v] is 0 before v is seen, then the smallest rank that v reaches on the stack; of a node whose component is complete it is above
 * all others, and tells the component.
 */
#include "explore_graph.h"

typedef struct walk {
    ex_run_t *run;
    const ex_graph_t *graph;
    const ex_part_t *part;
    uint32_t *rank;
    uint32_t *stack;     /* of nodes whose component is not complete; from the other end, the way from the root */
    uint64_t *at;        /* the way: the next arc to look at */
    uint8_t *is_root;    /* bit set */
    uint64_t waiting;    /* on the stack */
    uint64_t depth;      /* of the way */
    uint32_t next;       /* rank */
    uint32_t component;
    uint32_t done;       /* counts down: rank of the next complete component */
    uint64_t steps;
} walk_t;

static bool walk_open(walk_t *w, ex_run_t *run, const ex_graph_t *graph, const ex_part_t *part)
{
    const uint64_t n = graph->nodes;
    *w = (walk_t){ .run = run, .graph = graph, .part = part, .next = 1U, .done = UINT32_MAX };
    w->rank = ex_alloc(run, n * sizeof *w->rank);
    w->stack = ex_alloc(run, n * sizeof *w->stack);
    w->at = ex_alloc(run, n * sizeof *w->at);
    w->is_root = ex_alloc(run, n);
    return (w->rank != NULL) && (w->stack != NULL) && (w->at != NULL) && (w->is_root != NULL);
}

static void walk_close(walk_t *w)
{
    const uint64_t n = w->graph->nodes;
    ex_free(w->run, w->rank, n * sizeof *w->rank);
    ex_free(w->run, w->stack, n * sizeof *w->stack);
    ex_free(w->run, w->at, n * sizeof *w->at);
    ex_free(w->run, w->is_root, n);
}

static inline bool is_inside(const walk_t *w, uint32_t node)
{
    return (w->part->only == NULL) || (EX_BIT(w->part->only, node) != 0U);
}

static inline bool is_followed(const walk_t *w, uint32_t from, uint64_t arc)
{
    const ex_graph_t *const g = w->graph;
    return (g->label[arc] != w->part->without) && is_inside(w, g->target[arc]) &&
           (!w->part->within || (g->component[from] == g->component[g->target[arc]]));
}

/* What a walk does with each component: `member` holds its nodes. False: enough has been seen. */
typedef bool (*component_sink_t)(void *user, const uint32_t *member, uint64_t count, bool is_cyclic);

static inline uint32_t *way(const walk_t *w, uint64_t depth)
{
    return &w->stack[(uint64_t)w->graph->nodes - 1U - depth];
}

static void enter(walk_t *w, uint32_t node)
{
    w->rank[node] = w->next++;
    w->is_root[node] = 1U;
    *way(w, w->depth) = node;
    w->at[w->depth] = w->graph->row[node];
    w->depth += 1U;
}

/* The node at the end of the way has no more arcs. The stack has the nodes of its component above it. */
static bool leave(walk_t *w, component_sink_t sink, void *user)
{
    w->depth -= 1U;
    const uint32_t node = *way(w, w->depth);
    if (w->is_root[node] == 0U) {
        w->stack[w->waiting++] = node;
        if (w->depth > 0U) {
            const uint32_t before = *way(w, w->depth - 1U);
            if (w->rank[node] < w->rank[before]) {
                w->rank[before] = w->rank[node];
                w->is_root[before] = 0U;
            }
        }
        return true;
    }
    uint64_t first = w->waiting;
    w->next -= 1U;
    while ((first > 0U) && (w->rank[w->stack[first - 1U]] >= w->rank[node])) {
        first -= 1U;
        w->next -= 1U;
    }
    for (uint64_t i = first; i < w->waiting; i++) {
        w->rank[w->stack[i]] = w->done;
    }
    w->rank[node] = w->done;
    w->done -= 1U;
    bool is_cyclic = first < w->waiting;
    for (uint64_t arc = w->graph->row[node]; !is_cyclic && (arc < w->graph->row[node + 1U]); arc++) {
        is_cyclic = (w->graph->target[arc] == node) && is_followed(w, node, arc);
    }
    /* There is room for one more: the node has left the way, which shares the array. */
    w->stack[w->waiting] = node;
    const bool goes_on = sink(user, &w->stack[first], (w->waiting - first) + 1U, is_cyclic);
    w->waiting = first;
    return goes_on;
}

static void follow(walk_t *w)
{
    const ex_graph_t *const g = w->graph;
    const uint32_t node = *way(w, w->depth - 1U);
    const uint64_t end = g->row[node + 1U];
    uint64_t arc = w->at[w->depth - 1U];
    while (arc < end) {
        const uint32_t target = g->target[arc];
        if (!is_followed(w, node, arc)) {
            arc += 1U;
        } else if (w->rank[target] == 0U) {
            w->at[w->depth - 1U] = arc + 1U;
            enter(w, target);
            return;
        } else {
            if (w->rank[target] < w->rank[node]) {
                w->rank[node] = w->rank[target];
                w->is_root[node] = 0U;
            }
            arc += 1U;
        }
    }
    w->at[w->depth - 1U] = end;
}

/* Goes through the part. False: the sink has seen enough, or told to stop. */
static bool walk_all(walk_t *w, component_sink_t sink, void *user)
{
    for (uint32_t root = 0U; root < w->graph->nodes; root++) {
        if ((w->rank[root] != 0U) || !is_inside(w, root)) {
            continue;
        }
        enter(w, root);
        while (w->depth > 0U) {
            w->steps += 1U;
            if (((w->steps & 0xfffU) == 0U) && ex_is_stopping(w->run)) {
                return false;
            }
            const uint32_t node = *way(w, w->depth - 1U);
            if (w->at[w->depth - 1U] < w->graph->row[node + 1U]) {
                follow(w);
            } else if (!leave(w, sink, user)) {
                return false;
            }
        }
    }
    return true;
}

/* --- components ---------------------------------------------------------------------------------------------------- */

static bool number_component(void *user, const uint32_t *member, uint64_t count, bool is_cyclic)
{
    ex_graph_t *const g = user;
    for (uint64_t i = 0U; i < count; i++) {
        g->component[member[i]] = g->components;
    }
    g->components += 1U;
    g->is_acyclic = g->is_acyclic && !is_cyclic;
    return true;
}

bool ex_components(ex_run_t *run, ex_graph_t *graph)
{
    const ex_part_t everything = { .without = EX_NO_NODE };
    walk_t w;
    graph->component = ex_alloc(run, (uint64_t)graph->nodes * sizeof *graph->component);
    bool is_fine = (graph->component != NULL);
    graph->components = 0U;
    graph->is_acyclic = true;
    is_fine = walk_open(&w, run, graph, &everything) && is_fine && walk_all(&w, number_component, graph);
    walk_close(&w);
    if (!is_fine) {
        return false;
    }
    graph->component_arcs = 0U;
    for (uint32_t node = 0U; node < graph->nodes; node++) {
        for (uint64_t arc = graph->row[node]; arc < graph->row[node + 1U]; arc++) {
            graph->component_arcs += (graph->component[node] != graph->component[graph->target[arc]]) ? 1U : 0U;
        }
    }
    return true;
}

/* --- cycles -------------------------------------------------------------------------------------------------------- */

typedef struct cycle_search {
    const uint64_t *through;
    bool is_found;
} cycle_search_t;

static bool look_at_component(void *user, const uint32_t *member, uint64_t count, bool is_cyclic)
{
    cycle_search_t *const search = user;
    for (uint64_t i = 0U; is_cyclic && !search->is_found && (i < count); i++) {
        search->is_found = (search->through == NULL) || (EX_BIT(search->through, member[i]) != 0U);
    }
    return !search->is_found;
}

ex_cycle_t ex_has_cycle(ex_run_t *run, const ex_graph_t *graph, const ex_part_t *part, const uint64_t *through)
{
    cycle_search_t search = { .through = through };
    walk_t w;
    const bool has_memory = walk_open(&w, run, graph, part);
    const bool is_done = has_memory && walk_all(&w, look_at_component, &search);
    walk_close(&w);
    if (search.is_found) {
        return EX_CYCLE;
    }
    return is_done ? EX_NO_CYCLE : EX_CYCLE_UNKNOWN;
}
