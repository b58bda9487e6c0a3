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

/* Marks the terminal components; gives their number. */
static uint32_t find_terminal(const ex_graph_t *graph, bool *is_terminal)
{
    uint32_t count = 0U;
    for (uint32_t c = 0U; c < graph->components; c++) {
        is_terminal[c] = true;
    }
    for (uint32_t node = 0U; node < graph->nodes; node++) {
        for (uint64_t arc = graph->row[node]; arc < graph->row[node + 1U]; arc++) {
            if (graph->component[graph->target[arc]] != graph->component[node]) {
                is_terminal[graph->component[node]] = false;
            }
        }
    }
    for (uint32_t c = 0U; c < graph->components; c++) {
        count += is_terminal[c] ? 1U : 0U;
    }
    return count;
}

static void find_home(ex_graph_t *graph, const bool *is_terminal, uint32_t terminal_count)
{
    for (uint32_t c = 0U; (terminal_count == 1U) && (c < graph->components); c++) {
        if (is_terminal[c]) {
            graph->home_component = c;
        }
    }
    for (uint32_t node = 0U; node < graph->nodes; node++) {
        graph->home_count += (graph->component[node] == graph->home_component) ? 1U : 0U;
    }
}

/* The nodes, those of each component next to each other: component c has member[start[c]] .. member[start[c + 1] - 1]. */
static void sort_by_component(const ex_graph_t *graph, uint32_t *start, uint32_t *member)
{
    for (uint32_t node = 0U; node < graph->nodes; node++) {
        start[graph->component[node] + 1U] += 1U;
    }
    for (uint32_t c = 0U; c < graph->components; c++) {
        start[c + 1U] += start[c];
    }
    for (uint32_t node = graph->nodes; node > 0U; node--) {
        /* From behind: each component fills from its end, and start[c + 1] becomes its beginning. */
        const uint32_t c = graph->component[node - 1U];
        start[c + 1U] -= 1U;
        member[start[c + 1U]] = node - 1U;
    }
}

/* For each transition the number of terminal components in which it has an arc: `last` is the last one that was counted. */
static void find_live(ex_graph_t *graph, const bool *is_terminal, uint32_t terminal_count, const uint32_t *member,
                      uint32_t *last, uint32_t *seen)
{
    for (uint32_t i = 0U; i < graph->nodes; i++) {
        const uint32_t node = member[i];
        const uint32_t c = graph->component[node];
        for (uint64_t arc = graph->row[node]; is_terminal[c] && (arc < graph->row[node + 1U]); arc++) {
            const uint16_t t = graph->label[arc];
            seen[t] += (last[t] != (c + 1U)) ? 1U : 0U;
            last[t] = c + 1U;
        }
    }
    for (uint32_t t = 0U; t < pn_net.transition_count; t++) {
        graph->is_live[t] = (seen[t] == terminal_count);
    }
}

static bool find_home_and_live(ex_run_t *run, ex_graph_t *graph)
{
    const uint64_t transitions = pn_net.transition_count;
    bool *const is_terminal = ex_table(run, graph->components, sizeof *is_terminal);
    uint32_t *const start = ex_table(run, (uint64_t)graph->components + 1U, sizeof *start);
    uint32_t *const member = ex_table(run, graph->nodes, sizeof *member);
    uint32_t *const last = ex_table(run, transitions, sizeof *last);
    uint32_t *const seen = ex_table(run, transitions, sizeof *seen);
    const bool has_memory = (is_terminal != NULL) && (start != NULL) && (member != NULL) && (last != NULL) && (seen != NULL);
    if (has_memory) {
        const uint32_t terminal_count = find_terminal(graph, is_terminal);
        find_home(graph, is_terminal, terminal_count);
        sort_by_component(graph, start, member);
        find_live(graph, is_terminal, terminal_count, member, last, seen);
    }
    ex_free_table(run, is_terminal, graph->components, sizeof *is_terminal);
    ex_free_table(run, start, (uint64_t)graph->components + 1U, sizeof *start);
    ex_free_table(run, member, graph->nodes, sizeof *member);
    ex_free_table(run, last, transitions, sizeof *last);
    ex_free_table(run, seen, transitions, sizeof *seen);
    return has_memory;
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
    const uint64_t transitions = pn_net.transition_count;
    graph->is_live = ex_table(run, transitions, sizeof *graph->is_live);
    graph->fairness = ex_table(run, transitions, sizeof *graph->fairness);
    if ((graph->is_live == NULL) || (graph->fairness == NULL) || !find_home_and_live(run, graph)) {
        return false;
    }
    if (graph->is_acyclic) {
        return true;
    }
    fairness_work_t work = { .graph = graph };
    atomic_init(&work.next, 0U);
    atomic_init(&work.is_unknown, false);
    ex_parallel(run, find_some_fairness, &work);
    return !atomic_load(&work.is_unknown);
}
