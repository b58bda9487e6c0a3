/* SPDX-License-Identifier: MIT
 * explore_properties.c - home markings, liveness and fairness, from the components of the graph.
 *
 * A component is terminal when no arc leaves it. A marking is home exactly if it lies in the only terminal component; a transition is
 * live exactly if it has an arc in every terminal component.
 *
 * Fairness of a transition t, over all infinite occurrence sequences (in a finite graph each is in the end a walk in one component):
 *   impartial  t occurs infinitely often in each                        no cycle without t
 *   fair       ... in each in which it is enabled infinitely often      no cycle without t through a node at which t is enabled
 *   just       ... in each in which it is enabled from some point on    no cycle without t among the nodes at which t is enabled
 */
#include "explore_graph.h"

static void find_home_and_live(ex_graph_t *graph, uint8_t *is_terminal, uint32_t *seen)
{
    const uint32_t transitions = pn_net.transition_count;
    uint32_t terminal_count = 0U;
    for (uint32_t node = 0U; node < graph->nodes; node++) {
        for (uint64_t arc = graph->row[node]; arc < graph->row[node + 1U]; arc++) {
            if (graph->component[graph->target[arc]] != graph->component[node]) {
                is_terminal[graph->component[node]] = 0U;
            }
        }
    }
    for (uint32_t c = 0U; c < graph->components; c++) {
        terminal_count += is_terminal[c];
        if (is_terminal[c] != 0U) {
            graph->home_component = c;
        }
    }
    if (terminal_count != 1U) {
        graph->home_component = EX_NO_NODE;
    }
    /* seen[t]: in how many terminal components t has an arc. Nodes of a component need not be neighbours: one transition at a time,
     * marking components in is_terminal by 2. */
    for (uint32_t t = 0U; t < transitions; t++) {
        for (uint32_t node = 0U; node < graph->nodes; node++) {
            uint8_t *const mark = &is_terminal[graph->component[node]];
            if (*mark != 1U) {
                continue;
            }
            for (uint64_t arc = graph->row[node]; (*mark == 1U) && (arc < graph->row[node + 1U]); arc++) {
                if (graph->label[arc] == t) {
                    *mark = 2U;
                    seen[t] += 1U;
                }
            }
        }
        for (uint32_t c = 0U; c < graph->components; c++) {
            is_terminal[c] = (is_terminal[c] != 0U) ? 1U : 0U;
        }
        graph->is_live[t] = (seen[t] == terminal_count);
    }
    for (uint32_t node = 0U; node < graph->nodes; node++) {
        graph->home_count += (graph->component[node] == graph->home_component) ? 1U : 0U;
    }
}

/* What is worked out transition by transition, by all threads. */
typedef struct fairness_work {
    ex_graph_t *graph;
    _Atomic uint32_t next;
    _Atomic bool is_unknown;
} fairness_work_t;

static ex_cycle_t is_violated(ex_run_t *run, const ex_graph_t *graph, uint32_t t, const uint64_t *enabled, ex_fairness_t which)
{
    const ex_part_t part = { .without = t, .only = (which == EX_JUST) ? enabled : NULL, .within = true };
    return ex_has_cycle(run, graph, &part, (which == EX_FAIR) ? enabled : NULL);
}

/* The weakest is asked first: where it is violated, so are the others, and a violation is usually found at once. */
static bool find_fairness(ex_run_t *run, ex_graph_t *graph, uint32_t t)
{
    static const ex_fairness_t order[] = { EX_JUST, EX_FAIR, EX_IMPARTIAL };
    static const ex_fairness_t weaker[] = { EX_UNFAIR, EX_JUST, EX_FAIR };
    const uint64_t words = ((uint64_t)graph->nodes + 63U) / 64U;
    uint64_t *const enabled = ex_alloc(run, words * sizeof *enabled);
    if (enabled == NULL) {
        return false;
    }
    for (uint32_t node = 0U; node < graph->nodes; node++) {
        for (uint64_t arc = graph->row[node]; arc < graph->row[node + 1U]; arc++) {
            if (graph->label[arc] == t) {
                EX_SET_BIT(enabled, node);
                break;
            }
        }
    }
    ex_cycle_t found = EX_NO_CYCLE;
    graph->fairness[t] = EX_IMPARTIAL;
    for (size_t i = 0U; (i < (sizeof order / sizeof order[0])) && (found == EX_NO_CYCLE); i++) {
        found = is_violated(run, graph, t, enabled, order[i]);
        if (found == EX_CYCLE) {
            graph->fairness[t] = (uint8_t)weaker[i];
        }
    }
    ex_free(run, enabled, words * sizeof *enabled);
    return found != EX_CYCLE_UNKNOWN;
}

static void find_some_fairness(ex_worker_t *worker, void *user)
{
    fairness_work_t *const work = user;
    for (;;) {
        const uint32_t t = atomic_fetch_add(&work->next, 1U);
        if ((t >= pn_net.transition_count) || atomic_load(&work->is_unknown)) {
            return;
        }
        if (!find_fairness(worker->run, work->graph, t)) {
            atomic_store(&work->is_unknown, true);
        }
    }
}

bool ex_properties(ex_run_t *run, ex_graph_t *graph)
{
    const uint32_t transitions = pn_net.transition_count;
    uint8_t *const is_terminal = ex_alloc(run, graph->components);
    uint32_t *const seen = ex_alloc(run, (uint64_t)transitions * sizeof *seen);
    graph->is_live = ex_alloc(run, (uint64_t)transitions * sizeof *graph->is_live);
    graph->fairness = ex_alloc(run, transitions);
    const bool has_memory = (is_terminal != NULL) && ((transitions == 0U) || ((seen != NULL) && (graph->is_live != NULL) &&
                                                                              (graph->fairness != NULL)));
    if (has_memory) {
        for (uint32_t c = 0U; c < graph->components; c++) {
            is_terminal[c] = 1U;
        }
        find_home_and_live(graph, is_terminal, seen);
    }
    ex_free(run, is_terminal, graph->components);
    ex_free(run, seen, (uint64_t)transitions * sizeof *seen);
    if (!has_memory || graph->is_acyclic) {
        return has_memory;
    }
    fairness_work_t work = { .graph = graph };
    atomic_init(&work.next, 0U);
    atomic_init(&work.is_unknown, false);
    ex_parallel(run, find_some_fairness, &work);
    return !atomic_load(&work.is_unknown);
}
