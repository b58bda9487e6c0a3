/* SPDX-License-Identifier: MIT
 * explore_scc.c - strongly connected components, and cycles through certain nodes.
 *
 * Most components are found by sweeps, which go through the arcs in the order in which they lie in memory and remember
 * one bit for each node. All nodes can be reached from node 0, so those that reach it, the *core*, are one component:
 * whoever has an arc into the core belongs to it. And a node all of whose targets are in components that are complete
 * is one for itself. The order of the nodes is breadth first: sweeps go up and down in turn, since some ways lead to
 * larger and some to smaller numbers.
 *
 * What sweeps leave over is for Tarjan's algorithm in Pearce's form (one number for each node), without recursion:
 * rank[v] is 0 before v is seen, then the smallest rank that v reaches on the stack; of a node whose component is
 * complete it is above all others. Nodes of the core have the smallest rank: they count as if they had been seen first
 * and still were on the stack.
 */
#include "explore_graph.h"

#define CORE_RANK     1U
#define COMPLETE_RANK UINT32_MAX
#define MOST_FETCHED  32U /* targets of a node that are asked for before they are needed */

typedef struct walk {
    ex_run_t *run;
    const ex_graph_t *graph;
    const ex_part_t *part;
    uint32_t *rank;
    uint32_t *stack;         /* of nodes whose component is not complete; from the other end, the way from the root */
    uint64_t *at;            /* the way: the next arc to look at */
    uint64_t *is_root;       /* bit set */
    uint64_t waiting;        /* on the stack */
    uint64_t depth;          /* of the way */
    const uint64_t *through; /* bit set of nodes; NULL: components are sought, else a cycle through one of these */
    uint32_t *passed; /* the ranks with which those of them that are on the way were entered, and before them 0 */
    uint64_t passes;
    bool is_found;
    uint32_t next; /* rank */
    uint32_t done; /* counts down: rank of the next complete component */
    uint64_t steps;
} walk_t;

static uint64_t root_bytes(uint64_t nodes)
{
    return ((nodes / 64U) + 1U) * sizeof(uint64_t);
}

static bool walk_open(walk_t *w, ex_run_t *run, const ex_graph_t *graph, const ex_part_t *part, const uint64_t *through)
{
    const uint64_t n = graph->nodes;
    *w = (walk_t){
        .run = run, .graph = graph, .part = part, .through = through, .next = CORE_RANK + 1U, .done = COMPLETE_RANK - 1U
    };
    w->rank = ex_alloc(&run->memory, n * sizeof *w->rank);
    w->stack = ex_alloc(&run->memory, n * sizeof *w->stack);
    w->at = ex_alloc(&run->memory, n * sizeof *w->at);
    w->is_root = ex_alloc(&run->memory, root_bytes(n));
    w->passed = ex_alloc(&run->memory, ((through != NULL) ? (n + 1U) : 1U) * sizeof *w->passed);
    return (w->rank != NULL) && (w->stack != NULL) && (w->at != NULL) && (w->is_root != NULL) && (w->passed != NULL);
}

static void walk_close(walk_t *w)
{
    const uint64_t n = w->graph->nodes;
    ex_free(&w->run->memory, w->rank, n * sizeof *w->rank);
    ex_free(&w->run->memory, w->stack, n * sizeof *w->stack);
    ex_free(&w->run->memory, w->at, n * sizeof *w->at);
    ex_free(&w->run->memory, w->is_root, root_bytes(n));
    ex_free(&w->run->memory, w->passed, ((w->through != NULL) ? (n + 1U) : 1U) * sizeof *w->passed);
}

static inline bool is_inside(const walk_t *w, uint32_t node)
{
    return (w->part->only == NULL) || (EX_BIT(w->part->only, node) != 0U);
}

static inline bool is_followed(const walk_t *w, uint64_t arc)
{
    return (w->graph->label[arc] != w->part->without) && is_inside(w, w->graph->target[arc]);
}

/* What a walk does with each component: `member` holds its nodes. False: enough has been seen. */
typedef bool (*component_sink_t)(void *user, const uint32_t *member, uint64_t count, bool is_cyclic);

static inline uint32_t *path_at(const walk_t *w, uint64_t depth)
{
    return &w->stack[(uint64_t)w->graph->nodes - 1U - depth];
}

static void enter(walk_t *w, uint32_t node)
{
    const uint64_t first = w->graph->row[node];
    const uint64_t end = w->graph->row[node + 1U];
    if ((w->through != NULL) && (EX_BIT(w->through, node) != 0U)) {
        w->passes += 1U;
        w->passed[w->passes] = w->next;
    }
    w->rank[node] = w->next++;
    EX_SET_BIT(w->is_root, node);
    *path_at(w, w->depth) = node;
    w->at[w->depth] = first;
    w->depth += 1U;
    for (uint64_t arc = first; (arc < end) && (arc < (first + MOST_FETCHED)); arc++) {
        __builtin_prefetch(&w->rank[w->graph->target[arc]], 0, 3);
    }
}

static inline void no_root(walk_t *w, uint32_t node)
{
    w->is_root[node >> 6U] &= ~((uint64_t)1U << (node & 63U));
}

/* The node at the end of the way has no more arcs. The stack has the nodes of its component above it. */
static bool leave(walk_t *w, component_sink_t sink, void *user)
{
    w->depth -= 1U;
    const uint32_t node = *path_at(w, w->depth);
    if ((w->through != NULL) && (EX_BIT(w->through, node) != 0U)) {
        w->passes -= 1U;
    }
    if (EX_BIT(w->is_root, node) == 0U) {
        w->stack[w->waiting++] = node;
        if (w->depth > 0U) {
            const uint32_t before = *path_at(w, w->depth - 1U);
            if (w->rank[node] < w->rank[before]) {
                w->rank[before] = w->rank[node];
                no_root(w, before);
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
        is_cyclic = (w->graph->target[arc] == node) && is_followed(w, arc);
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
    const uint32_t node = *path_at(w, w->depth - 1U);
    const uint64_t end = g->row[node + 1U];
    uint64_t arc = w->at[w->depth - 1U];
    while (arc < end) {
        const uint32_t target = g->target[arc];
        if (!is_followed(w, arc)) {
            arc += 1U;
        } else if (w->rank[target] == 0U) {
            w->at[w->depth - 1U] = arc + 1U;
            enter(w, target);
            return;
        } else {
            /* The target reaches the node that was entered with its rank, or one before that on the way. */
            w->is_found = w->is_found || (w->passed[w->passes] >= w->rank[target]);
            if (w->rank[target] < w->rank[node]) {
                w->rank[node] = w->rank[target];
                no_root(w, node);
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
            const uint32_t node = *path_at(w, w->depth - 1U);
            if (w->is_found) {
                return false;
            }
            if (w->at[w->depth - 1U] < w->graph->row[node + 1U]) {
                follow(w);
            } else if (!leave(w, sink, user)) {
                return false;
            }
        }
    }
    return true;
}

/* --- components by sweeps ----------------------------------------------------------------------------------------- */

#define BLOCK_WORDS (EX_SWEEP_BLOCK / 64U)

typedef struct sweep {
    ex_graph_t *graph;
    uint64_t *core; /* bit set of nodes */
    uint64_t *done; /* bit set of nodes that are a complete component each */
    bool is_upward;
    _Atomic uint32_t next;  /* block */
    _Atomic uint32_t count; /* complete components */
    _Atomic uint64_t found; /* nodes, in this sweep */
    _Atomic bool has_loop;  /* an arc from a complete component to itself */
} sweep_t;

static inline uint64_t load_word(const uint64_t *word)
{
    return __atomic_load_n(word, __ATOMIC_ACQUIRE);
}

static inline bool has_bit(const uint64_t *set, uint32_t i)
{
    return ((load_word(&set[i >> 6U]) >> (i & 63U)) & 1U) != 0U;
}

/* Words of the sets have one writer: who has the block. */
static inline void set_bit(uint64_t *set, uint32_t i)
{
    __atomic_store_n(&set[i >> 6U], __atomic_load_n(&set[i >> 6U], __ATOMIC_RELAXED) | ((uint64_t)1U << (i & 63U)),
                     __ATOMIC_RELEASE);
}

/* Whether something has been found out about the node. */
static inline bool look_at_node(sweep_t *sweep, uint32_t node)
{
    const ex_graph_t *const g = sweep->graph;
    bool is_last = true;
    bool has_loop = false;
    for (uint64_t arc = g->row[node]; arc < g->row[node + 1U]; arc++) {
        const uint32_t target = g->target[arc];
        if (has_bit(sweep->core, target)) {
            set_bit(sweep->core, node);
            return true;
        }
        has_loop = has_loop || (target == node);
        is_last = is_last && ((target == node) || has_bit(sweep->done, target));
    }
    if (is_last) {
        if (has_loop) {
            atomic_store(&sweep->has_loop, true);
        }
        g->component[node] = atomic_fetch_add(&sweep->count, 1U);
        set_bit(sweep->done, node); /* only now do others take larger numbers */
    }
    return is_last;
}

static uint64_t sweep_block(sweep_t *sweep, uint32_t block)
{
    const uint32_t words = (sweep->graph->nodes / 64U) + 1U;
    const uint32_t first = block * BLOCK_WORDS;
    const uint32_t count = ((words - first) < BLOCK_WORDS) ? (words - first) : BLOCK_WORDS;
    uint64_t found = 0U;
    for (uint32_t k = 0U; k < count; k++) {
        const uint32_t w = sweep->is_upward ? (first + k) : (first + (count - 1U - k));
        uint64_t open = ~(sweep->core[w] | sweep->done[w]);
        if ((w + 1U) == words) {
            open &= ((uint64_t)1U << (sweep->graph->nodes & 63U)) - 1U;
        }
        while (open != 0U) {
            const uint32_t bit =
                sweep->is_upward ? (uint32_t)__builtin_ctzll(open) : (63U - (uint32_t)__builtin_clzll(open));
            open &= ~((uint64_t)1U << bit);
            found += look_at_node(sweep, (w * 64U) + bit) ? 1U : 0U;
        }
    }
    return found;
}

static void sweep_blocks(ex_worker_t *worker, void *user)
{
    sweep_t *const sweep = user;
    const uint32_t blocks = (sweep->graph->nodes / 64U / BLOCK_WORDS) + 1U;
    uint64_t found = 0U;
    while (!ex_is_stopping(worker->run)) {
        const uint32_t index = atomic_fetch_add(&sweep->next, 1U);
        if (index >= blocks) {
            break;
        }
        found += sweep_block(sweep, sweep->is_upward ? index : (blocks - 1U - index));
    }
    (void)atomic_fetch_add(&sweep->found, found);
}

/* Sweeps until that is not worth it any more; gives the number of nodes that are left over. */
static uint32_t sweep_all(ex_run_t *run, sweep_t *sweep)
{
    uint64_t left = (uint64_t)sweep->graph->nodes - 1U;
    uint64_t found = 1U;
    set_bit(sweep->core, 0U);
    for (uint32_t i = 0U; (left > 0U) && (found > 0U) && !ex_is_stopping(run) && (i < EX_MOST_SWEEPS); i++) {
        sweep->is_upward = (i % 2U) != 0U;
        atomic_store(&sweep->next, 0U);
        atomic_store(&sweep->found, 0U);
        if (sweep->graph->nodes > EX_SWEEP_BLOCK) {
            ex_parallel(run, sweep_blocks, sweep);
        } else {
            sweep_blocks(&run->worker[0], sweep);
        }
        const uint64_t before = found;
        found = atomic_load(&sweep->found);
        left -= found;
        if ((i >= EX_LEAST_SWEEPS) && (((found + before) * 16U) < left)) {
            break;
        }
    }
    return (uint32_t)left;
}

/* --- components --------------------------------------------------------------------------------------------------- */

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

/* What the sweeps have left over. */
static bool walk_rest(ex_run_t *run, sweep_t *sweep)
{
    const ex_part_t everything = { .without = EX_NO_NODE };
    ex_graph_t *const g = sweep->graph;
    walk_t w;
    bool is_fine = walk_open(&w, run, g, &everything, NULL);
    for (uint32_t node = 0U; is_fine && (node < g->nodes); node++) {
        if (EX_BIT(sweep->core, node) != 0U) {
            w.rank[node] = CORE_RANK;
        } else if (EX_BIT(sweep->done, node) != 0U) {
            w.rank[node] = COMPLETE_RANK;
        }
    }
    is_fine = is_fine && walk_all(&w, number_component, g);
    for (uint64_t i = 0U; is_fine && (i < w.waiting); i++) { /* they reach the core */
        EX_SET_BIT(sweep->core, w.stack[i]);
    }
    walk_close(&w);
    return is_fine;
}

/* The core is the last component. */
static void number_core(ex_graph_t *g, const uint64_t *core)
{
    uint32_t members = 0U;
    for (uint32_t node = 0U; node < g->nodes; node++) {
        if (EX_BIT(core, node) != 0U) {
            g->component[node] = g->components;
            members += 1U;
        }
    }
    g->components += 1U;
    bool is_cyclic = members > 1U;
    for (uint64_t arc = g->row[0]; !is_cyclic && (arc < g->row[1]); arc++) {
        is_cyclic = g->target[arc] == 0U;
    }
    g->is_acyclic = g->is_acyclic && !is_cyclic;
}

static void count_arcs(ex_graph_t *g, const uint64_t *core)
{
    g->component_arcs = 0U;
    for (uint32_t node = 0U; (g->components > 1U) && (node < g->nodes); node++) {
        const bool is_core = EX_BIT(core, node) != 0U;
        for (uint64_t arc = g->row[node]; arc < g->row[node + 1U]; arc++) {
            const uint32_t target = g->target[arc];
            const bool leaves = is_core ? (EX_BIT(core, target) == 0U) : (g->component[node] != g->component[target]);
            g->component_arcs += leaves ? 1U : 0U;
        }
    }
}

bool ex_components(ex_run_t *run, ex_graph_t *graph)
{
    const uint64_t bytes = root_bytes(graph->nodes);
    sweep_t sweep = { .graph = graph, .core = ex_alloc(&run->memory, bytes), .done = ex_alloc(&run->memory, bytes) };
    atomic_init(&sweep.next, 0U);
    atomic_init(&sweep.count, 0U);
    atomic_init(&sweep.found, 0U);
    atomic_init(&sweep.has_loop, false);
    graph->component = ex_alloc(&run->memory, (uint64_t)graph->nodes * sizeof *graph->component);
    bool is_fine = (sweep.core != NULL) && (sweep.done != NULL) && (graph->component != NULL);
    if (is_fine) {
        const uint32_t left = sweep_all(run, &sweep);
        graph->components = atomic_load(&sweep.count);
        graph->is_acyclic = !atomic_load(&sweep.has_loop);
        is_fine = !ex_is_stopping(run) && ((left == 0U) || walk_rest(run, &sweep));
    }
    if (is_fine) {
        number_core(graph, sweep.core);
        count_arcs(graph, sweep.core);
    }
    ex_free(&run->memory, sweep.core, bytes);
    ex_free(&run->memory, sweep.done, bytes);
    return is_fine;
}

/* --- cycles ------------------------------------------------------------------------------------------------------- */

static bool pass_over(void *user, const uint32_t *member, uint64_t count, bool is_cyclic)
{
    (void)user;
    (void)member;
    (void)count;
    (void)is_cyclic;
    return true;
}

ex_cycle_t ex_has_cycle(ex_run_t *run, const ex_graph_t *graph, const ex_part_t *part, const uint64_t *through)
{
    walk_t w;
    const bool has_memory = walk_open(&w, run, graph, part, through);
    const bool is_done = has_memory && walk_all(&w, pass_over, NULL);
    walk_close(&w);
    if (w.is_found) {
        return EX_CYCLE;
    }
    return is_done ? EX_NO_CYCLE : EX_CYCLE_UNKNOWN;
}
