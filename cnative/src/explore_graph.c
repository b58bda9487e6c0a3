/* SPDX-License-Identifier: MIT
 * explore_graph.c - the graph of a state space that has been explored: nodes are numbered breadth first, whatever the number of threads,
 * and the successors of each are made once more and looked up.
 *
 * Level by level: threads take blocks of nodes and find the slots of all successors; then the slots that are new get numbers, in the order
 * of the nodes and of their arcs.
 */
#include "explore_graph.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "pn/pn_text.h"

#define BLOCK_NODES 512U
#define MOST_LISTED 1000U

/* An arc before its target has a number. */
typedef struct found_arc {
    uint64_t slot;
    uint32_t label;
    uint32_t node; /* within the block */
} found_arc_t;

/* The nodes first .. first + count - 1 and their arcs. */
typedef struct block {
    uint32_t count;
    uint64_t used;
    uint64_t room;
    found_arc_t *arc;
    uint8_t is_dead[BLOCK_NODES];
    uint8_t is_late[BLOCK_NODES];
} block_t;

/* Successors of one node, gathered so that their lines of the store are on their way when they are looked up. */
typedef struct gathered {
    uint64_t used;
    uint64_t room;
    uint64_t arcs;
    struct {
        ex_key_t key;
        uint64_t hash;
        uint32_t label;
        uint32_t times;
    } *arc;
    const ex_store_t *store;
} gathered_t;

typedef struct level {
    ex_graph_t *graph;
    uint32_t first;
    uint32_t end;
    _Atomic uint32_t next;    /* block */
    block_t *block;
    uint64_t block_count;
    _Atomic bool is_failed;
    bool is_partial;          /* successors that are not in the store are passed over */
} level_t;

static bool gather(void *user, uint32_t transition, uint32_t times, const ex_key_t *key)
{
    gathered_t *const g = user;
    if (g->used == g->room) {
        const uint64_t room = (g->room == 0U) ? 64U : (g->room * 2U);
        void *const larger = realloc(g->arc, room * sizeof *g->arc);
        if (larger == NULL) {
            return false;
        }
        g->arc = larger;
        g->room = room;
    }
    g->arc[g->used].key = *key;
    g->arc[g->used].hash = ex_hash(key);
    g->arc[g->used].label = transition;
    g->arc[g->used].times = times;
    g->arcs += times;
    ex_store_prefetch(g->store, g->arc[g->used].hash);
    g->used += 1U;
    return true;
}

/* Appends what was gathered for a node of the block. */
static bool look_up(const level_t *level, block_t *block, const gathered_t *g, uint32_t node)
{
    if ((block->used + g->arcs) > block->room) {
        const uint64_t room = (block->used + g->arcs) * 2U;
        void *const larger = realloc(block->arc, room * sizeof *block->arc);
        if (larger == NULL) {
            return false;
        }
        block->arc = larger;
        block->room = room;
    }
    for (uint64_t i = 0U; i < g->used; i++) {
        const uint64_t slot = ex_store_find(g->store, &g->arc[i].key, g->arc[i].hash);
        if (slot != EX_NO_SLOT) {
            for (uint32_t k = 0U; k < g->arc[i].times; k++) {
                block->arc[block->used] = (found_arc_t){ .slot = slot, .label = g->arc[i].label, .node = node };
                block->used += 1U;
            }
            __builtin_prefetch(&level->graph->number[slot], 0, 1);
        } else if (!level->is_partial) {
            return false; /* the net does not do the same twice */
        }
    }
    return true;
}

static void expand_blocks(ex_worker_t *worker, void *user)
{
    level_t *const level = user;
    ex_graph_t *const graph = level->graph;
    gathered_t gathered = { .store = &worker->run->store };
    for (;;) {
        const uint32_t index = atomic_fetch_add(&level->next, 1U);
        if ((index >= level->block_count) || atomic_load(&level->is_failed) || ex_is_stopping(worker->run)) {
            break;
        }
        block_t *const block = &level->block[index];
        const uint32_t first = level->first + (index * BLOCK_NODES);
        block->count = ((level->end - first) < BLOCK_NODES) ? (level->end - first) : BLOCK_NODES;
        block->used = 0U;
        for (uint32_t i = 0U; i < block->count; i++) {
            ex_key_t key;
            gathered.used = 0U;
            gathered.arcs = 0U;
            const bool is_there = ex_store_fetch(gathered.store, graph->slot[first + i], &key);
            const ex_found_t found = is_there ? ex_arcs(worker, &key, gather, &gathered) : EX_FAILED;
            block->is_dead[i] = (found == EX_DEAD) ? 1U : 0U;
            block->is_late[i] = worker->has_waited ? 1U : 0U;
            const bool is_known = (found == EX_SOME) || (found == EX_DEAD) || level->is_partial;
            if (!is_known || !look_up(level, block, &gathered, i)) {
                atomic_store(&level->is_failed, true);
                break;
            }
        }
    }
    free(gathered.arc);
}

/* Room for as many arcs more. */
static bool reserve_arcs(ex_run_t *run, ex_graph_t *graph, uint64_t more)
{
    if ((graph->arcs + more) <= graph->room) {
        return true;
    }
    uint64_t room = graph->room + (graph->room / 2U) + 1024U;
    room = (room < (graph->arcs + more)) ? (graph->arcs + more) : room;
    uint32_t *const target = ex_alloc(run, room * sizeof *target);
    uint16_t *const label = ex_alloc(run, room * sizeof *label);
    if ((target == NULL) || (label == NULL)) {
        ex_free(run, target, room * sizeof *target);
        ex_free(run, label, room * sizeof *label);
        return false;
    }
    if (graph->arcs > 0U) {
        (void)memcpy(target, graph->target, graph->arcs * sizeof *target);
        (void)memcpy(label, graph->label, graph->arcs * sizeof *label);
    }
    ex_free(run, graph->target, graph->room * sizeof *target);
    ex_free(run, graph->label, graph->room * sizeof *label);
    graph->target = target;
    graph->label = label;
    graph->room = room;
    return true;
}

static void number_block(ex_graph_t *graph, const block_t *block, uint32_t first)
{
    uint64_t at = 0U;
    for (uint32_t i = 0U; i < block->count; i++) {
        const uint32_t node = first + i;
        graph->row[node] = graph->arcs;
        graph->dead_count += block->is_dead[i];
        if (block->is_dead[i] != 0U) {
            EX_SET_BIT(graph->dead, node);
        }
        if ((graph->late != NULL) && (block->is_late[i] != 0U)) {
            EX_SET_BIT(graph->late, node);
        }
        for (; (at < block->used) && (block->arc[at].node == i); at++) {
            const uint64_t slot = block->arc[at].slot;
            if (graph->number[slot] == 0U) {
                graph->slot[graph->nodes] = slot;
                graph->parent[graph->nodes] = node;
                graph->nodes += 1U;
                graph->number[slot] = graph->nodes;
            }
            graph->target[graph->arcs] = graph->number[slot] - 1U;
            graph->label[graph->arcs] = (uint16_t)block->arc[at].label;
            graph->arcs += 1U;
        }
        graph->row[node + 1U] = graph->arcs;
    }
}

#define LEVEL_BLOCKS 256U

/* Expands the nodes first .. end - 1, some blocks at a time. */
static bool expand(ex_run_t *run, level_t *level, uint32_t end)
{
    while (level->first < end) {
        const uint32_t most = LEVEL_BLOCKS * BLOCK_NODES;
        level->end = ((end - level->first) < most) ? end : (level->first + most);
        level->block_count = ((uint64_t)(level->end - level->first) + BLOCK_NODES - 1U) / BLOCK_NODES;
        atomic_store(&level->next, 0U);
        if (level->block_count > 1U) {
            ex_parallel(run, expand_blocks, level);
        } else {
            expand_blocks(&run->worker[0], level);
        }
        if (atomic_load(&level->is_failed) || ex_is_stopping(run)) {
            return false;
        }
        for (uint64_t i = 0U; i < level->block_count; i++) {
            if (!reserve_arcs(run, level->graph, level->block[i].used)) {
                return false;
            }
            number_block(level->graph, &level->block[i], level->first + (uint32_t)(i * BLOCK_NODES));
        }
        level->first = level->end;
    }
    return true;
}

static bool build(ex_run_t *run, ex_graph_t *graph)
{
    level_t level = { .graph = graph, .is_partial = !graph->is_whole };
    atomic_init(&level.next, 0U);
    atomic_init(&level.is_failed, false);
    level.block = calloc(LEVEL_BLOCKS, sizeof *level.block);
    const uint64_t slot = ex_store_find(&run->store, &run->initial, ex_hash(&run->initial));
    bool is_fine = (level.block != NULL) && (slot != EX_NO_SLOT);
    if (is_fine) {
        graph->slot[0] = slot;
        graph->number[slot] = 1U;
        graph->nodes = 1U;
    }
    while (is_fine && (level.first < graph->nodes)) {
        is_fine = expand(run, &level, graph->nodes);
    }
    for (uint32_t i = 0U; (level.block != NULL) && (i < LEVEL_BLOCKS); i++) {
        free(level.block[i].arc);
    }
    free(level.block);
    return is_fine;
}

/* Whether the net may do something else the second time. */
static bool looks(void)
{
    bool is_fickle = pn_net.has_references;
    for (uint32_t t = 0U; t < pn_net.transition_count; t++) {
        is_fickle = is_fickle || pn_net.transition[t].looks;
    }
    return is_fickle;
}

bool ex_graph(ex_run_t *run)
{
    const double began = ex_clock();
    const uint64_t nodes = run->nodes;
    const bool is_whole = (atomic_load(&run->why) == EX_COMPLETE);
    if ((nodes == 0U) || (nodes >= (uint64_t)EX_NO_NODE) || (pn_net.transition_count > (uint32_t)UINT16_MAX)) {
        ex_stop(run, EX_MEMORY); /* so large a graph cannot be held */
        return false;
    }
    ex_graph_t *const graph = ex_alloc(run, sizeof *graph);
    if (graph == NULL) {
        ex_stop(run, EX_MEMORY);
        return false;
    }
    run->graph = graph;
    graph->is_whole = is_whole;
    graph->node_room = nodes;
    graph->home_component = EX_NO_NODE;
    graph->slot = ex_alloc(run, nodes * sizeof *graph->slot);
    graph->number = ex_alloc(run, ex_store_slots(&run->store) * sizeof *graph->number);
    graph->parent = ex_alloc(run, nodes * sizeof *graph->parent);
    graph->row = ex_alloc(run, (nodes + 1U) * sizeof *graph->row);
    graph->dead = ex_alloc(run, ((nodes / 64U) + 1U) * sizeof *graph->dead);
    graph->late = pn_net.timed ? ex_alloc(run, ((nodes / 64U) + 1U) * sizeof *graph->late) : NULL;
    bool is_fine = (graph->slot != NULL) && (graph->number != NULL) && (graph->parent != NULL) && (graph->row != NULL) && (graph->dead != NULL) &&
                   ((graph->late != NULL) || !pn_net.timed) && reserve_arcs(run, graph, run->arcs);
    atomic_store(&run->phase, "graph");
    is_fine = is_fine && build(run, graph) && (!is_whole || (graph->nodes == nodes));
    graph->is_reduced = run->reduction != NULL;
    if (is_fine && is_whole && !graph->is_reduced) {
        atomic_store(&run->phase, "components");
        is_fine = ex_components(run, graph);
        atomic_store(&run->phase, "properties");
        is_fine = is_fine && ex_properties(run, graph) && (graph->is_acyclic || ex_fairness(run, graph));
    }
    graph->seconds = ex_clock() - began;
    if (!is_fine) {
        run->graph = NULL; /* the process is about to end: its memory goes with it */
        if (!looks() && !ex_is_stopping(run)) {
            ex_stop(run, EX_MEMORY); /* nothing else was in the way */
        }
    }
    return is_fine;
}

/* --- the report ---------------------------------------------------------------------------------------------------- */

static bool is_dead(const ex_graph_t *graph, uint32_t node)
{
    return EX_BIT(graph->dead, node) != 0U;
}

static void dead_json(const ex_run_t *run, FILE *out)
{
    const ex_graph_t *const graph = run->graph;
    uint64_t listed = 0U;
    (void)fprintf(out, "\"dead\": [");
    for (uint32_t node = 0U; (graph != NULL) && graph->is_whole && (node < graph->nodes) && (listed < run->options.dead_limit); node++) {
        if (is_dead(graph, node)) {
            (void)fprintf(out, "%s%" PRIu32, (listed > 0U) ? ", " : "", node + 1U);
            listed += 1U;
        }
    }
    (void)fprintf(out, "]");
}

static const char *const s_fairness[] = { "impartial", "fair", "just", "none" };

static void members_json(const ex_graph_t *graph, FILE *out)
{
    const uint32_t transitions = pn_net.transition_count;
    uint32_t listed = 0U;
    (void)fprintf(out,
                  "{\"seconds\": %.6f, \"scc_nodes\": %" PRIu32 ", \"scc_arcs\": %" PRIu64 ", \"home_count\": %" PRIu64
                  ", \"initial_is_home\": %s, \"home\": [",
                  graph->seconds, graph->components, graph->component_arcs, graph->home_count,
                  (graph->component[0] == graph->home_component) ? "true" : "false");
    for (uint32_t node = 0U; (node < graph->nodes) && (listed < MOST_LISTED) && (graph->home_count > 0U); node++) {
        if (graph->component[node] == graph->home_component) {
            (void)fprintf(out, "%s%" PRIu32, (listed > 0U) ? ", " : "", node + 1U);
            listed += 1U;
        }
    }
    (void)fprintf(out, "], \"live\": [");
    for (uint32_t t = 0U; t < transitions; t++) {
        (void)fprintf(out, "%s%s", (t > 0U) ? ", " : "", graph->is_live[t] ? "true" : "false");
    }
    (void)fprintf(out, "], \"fairness\": %s", graph->is_acyclic ? "null" : "[");
    for (uint32_t t = 0U; !graph->is_acyclic && (t < transitions); t++) {
        (void)fprintf(out, "%s\"%s\"", (t > 0U) ? ", " : "", s_fairness[graph->fairness[t]]);
    }
    (void)fprintf(out, "%s}", graph->is_acyclic ? "" : "]");
}

/* Traces to the first dead markings. */
static void traces_json(ex_run_t *run, FILE *out)
{
    const ex_graph_t *const graph = run->graph;
    uint64_t written = 0U;
    (void)fprintf(out, "\"traces\": [");
    const bool is_wanted = (graph != NULL) && graph->is_whole && (run->options.trace_to != NULL);
    for (uint32_t node = 0U; is_wanted && (node < graph->nodes) && (written < run->options.traces); node++) {
        char path[4096];
        if (!is_dead(graph, node)) {
            continue;
        }
        (void)snprintf(path, sizeof path, "%s%" PRIu32 ".trace.jsonl", run->options.trace_to, node + 1U);
        const int64_t steps = ex_write_trace(run, graph, node, path);
        if (steps >= 0) {
            pn_text_t text;
            char quoted[2U * sizeof path];
            pn_text_init(&text, quoted, sizeof quoted);
            pn_text_json_str(&text, path);
            (void)fprintf(out, "%s{\"node\": %" PRIu32 ", \"file\": %s, \"steps\": %" PRId64 "}", (written > 0U) ? ", " : "", node + 1U,
                          quoted, steps);
        }
        written += 1U;
    }
    (void)fprintf(out, "]");
}

void ex_graph_json(ex_run_t *run, FILE *out)
{
    dead_json(run, out);
    (void)fprintf(out, ", \"graph\": ");
    if ((run->graph != NULL) && run->graph->is_whole && !run->graph->is_reduced) {
        members_json(run->graph, out);
    } else {
        (void)fprintf(out, "null");
    }
    (void)fprintf(out, ", ");
    traces_json(run, out);
    if ((run->graph != NULL) && (run->options.write_graph != NULL) && (run->graph->nodes <= run->options.write_limit)
        && !ex_write_graph(run, run->graph, run->options.write_graph)) {
        (void)fprintf(stderr, "explore: cannot write `%s`\n", run->options.write_graph);
    }
}
