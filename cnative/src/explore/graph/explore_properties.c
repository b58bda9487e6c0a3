/* SPDX-License-Identifier: MIT
 * explore_properties.c - home markings and liveness, from the components of the graph.
 *
 * A component is terminal when no arc leaves it. A marking is home exactly if it lies in the only terminal component; a
 * transition is live exactly if it has an arc in every terminal component.
 */
#include "explore_graph.h"

/* Marks the terminal components; gives their number. */
static uint32_t find_terminal(const ex_graph_t *graph, bool *is_terminal)
{
    uint32_t count = 0U;
    for (uint32_t c = 0U; c < graph->components; c++) {
        is_terminal[c] = true;
    }
    for (uint32_t node = 0U; (graph->components > 1U) && (node < graph->nodes); node++) {
        const uint32_t c = graph->component[node];
        for (uint64_t arc = graph->row[node]; is_terminal[c] && (arc < graph->row[node + 1U]); arc++) {
            is_terminal[c] = graph->component[graph->target[arc]] == c;
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

/* The nodes, those of each component next to each other: component c has member[start[c]] .. member[start[c + 1] - 1].
 */
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

/* Those that have an arc in the only terminal component. */
static void find_live_in_one(ex_graph_t *graph, const bool *is_terminal)
{
    uint32_t left = pn_net.transition_count;
    for (uint32_t node = 0U; (node < graph->nodes) && (left > 0U); node++) {
        const uint64_t end = is_terminal[graph->component[node]] ? graph->row[node + 1U] : 0U;
        for (uint64_t arc = graph->row[node]; arc < end; arc++) {
            const uint16_t t = graph->label[arc];
            left -= graph->is_live[t] ? 0U : 1U;
            graph->is_live[t] = true;
        }
    }
}

/* For each transition the number of terminal components in which it has an arc: `last` is the last one that was
 * counted. */
static void find_live_in_many(ex_graph_t *graph, const bool *is_terminal, uint32_t terminal_count,
                              const uint32_t *member, uint32_t *last, uint32_t *seen)
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

static bool find_live(ex_run_t *run, ex_graph_t *graph, const bool *is_terminal, uint32_t terminal_count)
{
    const uint64_t transitions = pn_net.transition_count;
    if (graph->dead_count > 0U) {
        return true; /* nothing has an arc in a component that is a dead marking */
    }
    if (terminal_count == 1U) {
        find_live_in_one(graph, is_terminal);
        return true;
    }
    uint32_t *const start = ex_table(&run->memory, (uint64_t)graph->components + 1U, sizeof *start);
    uint32_t *const member = ex_table(&run->memory, graph->nodes, sizeof *member);
    uint32_t *const last = ex_table(&run->memory, transitions, sizeof *last);
    uint32_t *const seen = ex_table(&run->memory, transitions, sizeof *seen);
    const bool has_memory = (start != NULL) && (member != NULL) && (last != NULL) && (seen != NULL);
    if (has_memory) {
        sort_by_component(graph, start, member);
        find_live_in_many(graph, is_terminal, terminal_count, member, last, seen);
    }
    ex_free_table(&run->memory, start, (uint64_t)graph->components + 1U, sizeof *start);
    ex_free_table(&run->memory, member, graph->nodes, sizeof *member);
    ex_free_table(&run->memory, last, transitions, sizeof *last);
    ex_free_table(&run->memory, seen, transitions, sizeof *seen);
    return has_memory;
}

bool ex_properties(ex_run_t *run, ex_graph_t *graph)
{
    bool *const is_terminal = ex_table(&run->memory, graph->components, sizeof *is_terminal);
    graph->is_live = ex_table(&run->memory, pn_net.transition_count, sizeof *graph->is_live);
    bool is_fine = (is_terminal != NULL) && (graph->is_live != NULL);
    if (is_fine) {
        const uint32_t terminal_count = find_terminal(graph, is_terminal);
        find_home(graph, is_terminal, terminal_count);
        is_fine = find_live(run, graph, is_terminal, terminal_count);
    }
    ex_free_table(&run->memory, is_terminal, graph->components, sizeof *is_terminal);
    return is_fine;
}
