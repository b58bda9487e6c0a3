/* SPDX-License-Identifier: MIT
 * explore_graph.c - the graph of a state space that has been explored: nodes are numbered breadth first, whatever the
 * number of threads, and the successors of each are made once more and looked up.
 *
 * Threads take blocks of nodes and find the slots of all successors (explore_blocks.c); then the slots that are new get
 * numbers, in the order of the nodes and of their arcs.
 */
#include "explore_blocks.h"
#include "../query/explore_query.h"
#include "../search/explore_successors.h"
#include "../sweep/explore_sweep.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "pn/pn_text.h"

#define MOST_LISTED 1000U

/* Some nodes in a row: their blocks. */
typedef struct level {
    ex_graph_t *graph;
    uint32_t first;
    uint32_t end;
    _Atomic uint32_t next; /* block */
    ex_block_t *block;
    uint32_t block_count;
    ex_expander_t *expander[EX_MOST_THREADS];
    _Atomic bool is_failed;
} level_t;

static void expand_blocks(ex_worker_t *worker, void *user)
{
    level_t *const level = user;
    for (;;) {
        const uint32_t index = atomic_fetch_add(&level->next, 1U);
        if ((index >= level->block_count) || atomic_load(&level->is_failed) || ex_is_stopping(worker->run)) {
            break;
        }
        const uint32_t first = level->first + (index * EX_BLOCK_NODES);
        const uint32_t count = ((level->end - first) < EX_BLOCK_NODES) ? (level->end - first) : EX_BLOCK_NODES;
        if (!ex_expand(level->expander[worker->index], &level->block[index], first, count)) {
            atomic_store(&level->is_failed, true);
        }
    }
}

/* Room for as many arcs more. */
static bool reserve_arcs(ex_run_t *run, ex_graph_t *graph, uint64_t more)
{
    if ((graph->arcs + more) <= graph->room) {
        return true;
    }
    uint64_t room = graph->room + (graph->room / 2U) + 1024U;
    room = (room < (graph->arcs + more)) ? (graph->arcs + more) : room;
    uint32_t *const target = ex_alloc(&run->memory, room * sizeof *target);
    uint16_t *const label = ex_alloc(&run->memory, room * sizeof *label);
    if ((target == NULL) || (label == NULL)) {
        ex_free(&run->memory, target, room * sizeof *target);
        ex_free(&run->memory, label, room * sizeof *label);
        return false;
    }
    if (graph->arcs > 0U) {
        (void)memcpy(target, graph->target, graph->arcs * sizeof *target);
        (void)memcpy(label, graph->label, graph->arcs * sizeof *label);
    }
    ex_free(&run->memory, graph->target, graph->room * sizeof *target);
    ex_free(&run->memory, graph->label, graph->room * sizeof *label);
    graph->target = target;
    graph->label = label;
    graph->room = room;
    return true;
}

static void number_block(ex_graph_t *graph, const ex_block_t *block, uint32_t first)
{
    const uint64_t *found = block->arc;
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
        if ((graph->cut != NULL) && (block->is_cut[i] != 0U)) {
            EX_SET_BIT(graph->cut, node);
        }
        if ((graph->open != NULL) && (block->is_open[i] != 0U)) {
            EX_SET_BIT(graph->open, node);
        }
        for (uint32_t k = 0U; k < block->arcs[i]; k++) {
            const uint64_t target = (*found & ~EX_NUMBERED) >> EX_LABEL_BITS;
            uint32_t number = (uint32_t)target;
            if ((*found & EX_NUMBERED) == 0U) {
                if ((graph->number[target] == 0U) && (graph->nodes == graph->node_room)) {
                    found++;
                    EX_SET_BIT(graph->cut, node);
                    continue; /* of a part: there are enough */
                }
                if (graph->number[target] == 0U) {
                    graph->slot[graph->nodes] = target;
                    graph->parent[graph->nodes] = node;
                    graph->nodes += 1U;
                    graph->number[target] = graph->nodes;
                }
                number = graph->number[target];
            }
            graph->target[graph->arcs] = number - 1U;
            graph->label[graph->arcs] = (uint16_t)*found;
            graph->arcs += 1U;
            found++;
        }
        graph->row[node + 1U] = graph->arcs;
    }
}

/* Blocks that are made before their targets get numbers: few, so that what one needs is still near the processor then.
 */
#define BLOCKS_OF_THREAD 16U

/* Expands the nodes of which the numbers are known, or some of them. */
static bool expand(ex_run_t *run, level_t *level, uint32_t blocks)
{
    ex_graph_t *const graph = level->graph;
    const uint32_t most = blocks * EX_BLOCK_NODES;
    level->end = ((graph->nodes - level->first) < most) ? graph->nodes : (level->first + most);
    level->block_count = ((level->end - level->first) + EX_BLOCK_NODES - 1U) / EX_BLOCK_NODES;
    atomic_store(&level->next, 0U);
    if (level->block_count > 1U) {
        ex_parallel(run, expand_blocks, level);
    } else {
        run->at_work = 1U; /* of a part of the space there are successors without a number: tables may have to grow */
        expand_blocks(&run->worker[0], level);
        run->at_work = 0U;
    }
    if (atomic_load(&level->is_failed) || ex_is_stopping(run)) {
        return false;
    }
    for (uint32_t i = 0U; i < level->block_count; i++) {
        if (!reserve_arcs(run, graph, level->block[i].used)) {
            return false;
        }
        number_block(graph, &level->block[i], level->first + (i * EX_BLOCK_NODES));
    }
    level->first = level->end;
    return true;
}

static bool build(ex_run_t *run, ex_graph_t *graph)
{
    const uint32_t threads = run->options.threads;
    const uint32_t blocks = (threads > 1U) ? (threads * BLOCKS_OF_THREAD) : 1U;
    level_t level = { .graph = graph };
    atomic_init(&level.next, 0U);
    atomic_init(&level.is_failed, false);
    level.block = calloc(blocks, sizeof *level.block);
    const uint64_t slot = ex_store_find(&run->store, &run->initial, ex_hash(&run->initial));
    bool is_fine = (level.block != NULL) && (slot != EX_NO_SLOT);
    for (uint32_t i = 0U; i < threads; i++) {
        level.expander[i] = ex_expander_make(&run->worker[i], graph, !graph->is_whole);
        is_fine = is_fine && (level.expander[i] != NULL);
    }
    if (is_fine) {
        graph->slot[0] = slot;
        graph->number[slot] = 1U;
        graph->nodes = 1U;
    }
    while (is_fine && (level.first < graph->nodes)) {
        is_fine = expand(run, &level, blocks);
    }
    for (uint32_t i = 0U; (level.block != NULL) && (i < blocks); i++) {
        free(level.block[i].arc);
    }
    for (uint32_t i = 0U; i < threads; i++) {
        ex_expander_free(level.expander[i]);
    }
    free(level.block);
    return is_fine;
}

/* Nodes of a graph that is a part. */
#define MOST_OF_PART ((uint64_t)200000U)

bool ex_graph(ex_run_t *run)
{
    const double began = ex_clock();
    const bool is_whole = (atomic_load(&run->why) == EX_COMPLETE);
    const uint64_t nodes = (is_whole || (run->nodes < MOST_OF_PART)) ? run->nodes : MOST_OF_PART;
    if ((nodes == 0U) || (nodes >= (uint64_t)EX_NO_NODE) || (pn_net.transition_count > (uint32_t)UINT16_MAX)) {
        ex_stop(run, EX_MEMORY); /* so large a graph cannot be held */
        return false;
    }
    ex_graph_t *const graph = ex_alloc(&run->memory, sizeof *graph);
    if (graph == NULL) {
        ex_stop(run, EX_MEMORY);
        return false;
    }
    run->graph = graph;
    graph->is_whole = is_whole;
    graph->node_room = nodes;
    graph->home_component = EX_NO_NODE;
    graph->slot = ex_alloc(&run->memory, nodes * sizeof *graph->slot);
    graph->number = ex_alloc(&run->memory, ex_store_slots(&run->store) * sizeof *graph->number);
    graph->parent = ex_alloc(&run->memory, nodes * sizeof *graph->parent);
    graph->row = ex_alloc(&run->memory, (nodes + 1U) * sizeof *graph->row);
    graph->dead = ex_alloc(&run->memory, ((nodes / 64U) + 1U) * sizeof *graph->dead);
    graph->cut = is_whole ? NULL : ex_alloc(&run->memory, ((nodes / 64U) + 1U) * sizeof *graph->cut);
    graph->open = is_whole ? NULL : ex_alloc(&run->memory, ((nodes / 64U) + 1U) * sizeof *graph->open);
    graph->late = pn_net.timed ? ex_alloc(&run->memory, ((nodes / 64U) + 1U) * sizeof *graph->late) : NULL;
    bool is_fine = (graph->slot != NULL) && (graph->number != NULL) && (graph->parent != NULL) && (graph->row != NULL)
                   && (graph->dead != NULL) && (is_whole || ((graph->cut != NULL) && (graph->open != NULL)))
                   && ((graph->late != NULL) || !pn_net.timed)
                   && reserve_arcs(run, graph, is_whole ? run->arcs : nodes);
    ex_phase(run, "graph");
    run->seeks_choice = is_whole && (run->queries != NULL) && run->queries->asks_orders && (run->owner_of != NULL)
                        && (run->programs != NULL) && (pn_net.root_count == 0U);
    is_fine = is_fine && build(run, graph) && (!is_whole || (graph->nodes == nodes));
    run->is_choiceless = is_fine && run->seeks_choice && !atomic_load(&run->has_choice);
    run->seeks_choice = false;
    if (run->options.write_graph == NULL) {
        ex_free(&run->memory, graph->number, ex_store_slots(&run->store) * sizeof *graph->number);
        graph->number = NULL;
    }
    graph->is_reduced = run->reduction != NULL;
    run->has_arcs = is_fine && is_whole;
    if (run->has_arcs && !graph->is_reduced) {
        ex_phase(run, "components");
        is_fine = ex_components(run, graph);
        ex_phase(run, "properties");
        is_fine = is_fine && ex_properties(run, graph) && (graph->is_acyclic || ex_fairness(run, graph));
        run->has_components = is_fine;
    }
    graph->seconds = ex_clock() - began;
    if (!is_fine) {
        run->graph = NULL; /* the process is about to end: its memory goes with it */
        if (ex_is_repeatable() && !ex_is_stopping(run)) {
            ex_stop(run, EX_MEMORY); /* nothing else was in the way */
        }
    }
    return is_fine;
}

/* --- the report --------------------------------------------------------------------------------------------------- */

static bool is_dead(const ex_graph_t *graph, uint32_t node)
{
    return EX_BIT(graph->dead, node) != 0U;
}

static void dead_json(const ex_run_t *run, FILE *out)
{
    const ex_graph_t *const graph = run->graph;
    uint64_t listed = 0U;
    (void)fprintf(out, "\"dead\": [");
    for (uint32_t node = 0U;
         (graph != NULL) && graph->is_whole && (node < graph->nodes) && (listed < run->options.dead_limit); node++) {
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
            (void)fprintf(out, "%s{\"node\": %" PRIu32 ", \"file\": %s, \"steps\": %" PRId64 "}",
                          (written > 0U) ? ", " : "", node + 1U, quoted, steps);
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
    if (run->sweep != NULL) {
        ex_sweep_traces_json(run, out);
        return;
    }
    traces_json(run, out);
}

void ex_graph_write(ex_run_t *run)
{
    if ((run->options.write_graph != NULL) && (run->graph->is_whole || run->options.writes_part)
        && (run->graph->nodes <= run->options.write_limit)
        && !ex_write_graph(run, run->graph, run->options.write_graph)) {
        (void)fprintf(stderr, "explore: cannot write `%s`\n", run->options.write_graph);
    }
}
