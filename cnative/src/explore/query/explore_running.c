/* SPDX-License-Identifier: MIT
 * explore_running.c - whether a cell comes to its end, in the graph of the cell as it runs: each node is a state of all
 * its programs.
 *
 * Three answers. *No*: there is a node from which no end can be reached. *Yes*: wherever the cell is, it comes to an
 * end, whoever is slow. *Unknown*, for the reason "speeds": from each node an end can be reached, but somebody's being
 * slow or quick can keep the cell from it.
 *
 * Who goes next is not decided by the programs, but by how long they take: it is an adversary that decides it, with one
 * obligation: nobody is left waiting for ever who could go on. What a step comes to, of several arcs of one transition,
 * is decided by the world (what a sensor says): each of the outcomes comes to pass now and then. So the cell can be
 * kept from its end for ever exactly in a set of nodes
 *
 *   - in which the adversary can stay: of each node some steps are chosen, with all their outcomes in the set, and by
 *     these each node of the set can be reached from each other one (an *end component*);
 *   - in which each owner takes one of these steps somewhere, or has no step at all somewhere.
 *
 * The largest end components are found by taking away steps that leave their component until none does.
 */
#include "explore_query.h"

#include <stdlib.h>

#define OWNER_WORDS (EX_MOST_OWNERS / 64U)

typedef struct owners {
    uint64_t word[OWNER_WORDS];
} owners_t;

typedef struct running {
    ex_queries_t *queries;
    const ex_graph_t *graph;
    const uint64_t *goal; /* a set of nodes */
    uint64_t *is_left;    /* nodes that may be in an end component */
    uint64_t *is_out;     /* arcs that are no step of one */
    uint32_t *component;  /* by node that is left */
    uint32_t components;
    uint32_t *number; /* of the walk; 0: not seen */
    uint32_t *low;
    uint32_t *stack;
    uint32_t *path;
    uint64_t *at;
} running_t;

static bool is_followed(const running_t *r, uint64_t arc)
{
    return (EX_BIT(r->is_out, arc) == 0U) && (EX_BIT(r->is_left, r->graph->target[arc]) != 0U);
}

/* The component of a node is complete: it is what lies above it on the stack. */
static void close_component(running_t *r, uint32_t node, uint64_t *used)
{
    uint32_t member;
    do {
        *used -= 1U;
        member = r->stack[*used];
        r->component[member] = r->components;
        r->low[member] = UINT32_MAX; /* it counts no more */
    } while (member != node);
    r->components += 1U;
}

/* Tarjan's algorithm over what is left. False: told to stop. */
static bool find_components(running_t *r)
{
    const ex_graph_t *const g = r->graph;
    uint64_t used = 0U;
    uint32_t next = 1U;
    r->components = 0U;
    (void)memset(r->number, 0, g->nodes * sizeof *r->number);
    for (uint32_t root = 0U; root < g->nodes; root++) {
        uint64_t depth = 0U;
        if ((EX_BIT(r->is_left, root) == 0U) || (r->number[root] != 0U)) {
            continue;
        }
        r->path[0] = root;
        r->at[0] = g->row[root];
        r->number[root] = next;
        r->low[root] = next;
        next += 1U;
        r->stack[used++] = root;
        depth = 1U;
        while (depth > 0U) {
            const uint32_t node = r->path[depth - 1U];
            const uint64_t arc = r->at[depth - 1U];
            if (arc == g->row[node + 1U]) {
                depth -= 1U;
                const uint32_t low = r->low[node];
                if (low == r->number[node]) {
                    close_component(r, node, &used);
                } else if (low < r->low[r->path[depth - 1U]]) {
                    r->low[r->path[depth - 1U]] = low;
                } else {
                    /* it is known already */
                }
                continue;
            }
            r->at[depth - 1U] = arc + 1U;
            const uint32_t target = g->target[arc];
            if (!is_followed(r, arc)) {
                continue;
            }
            if (r->number[target] == 0U) {
                r->path[depth] = target;
                r->at[depth] = g->row[target];
                r->number[target] = next;
                r->low[target] = next;
                next += 1U;
                r->stack[used++] = target;
                depth += 1U;
            } else if ((r->low[target] != UINT32_MAX) && (r->number[target] < r->low[node])) {
                r->low[node] = r->number[target];
            } else {
                /* its component is complete */
            }
        }
        if (ex_is_stopping(r->queries->run)) {
            return false;
        }
    }
    return true;
}

/* Whether a step of a node has an outcome outside of its component. */
static bool leaves(const running_t *r, uint32_t node, uint16_t label)
{
    for (uint64_t arc = r->graph->row[node]; arc < r->graph->row[node + 1U]; arc++) {
        const uint32_t target = r->graph->target[arc];
        if ((r->graph->label[arc] == label)
            && ((EX_BIT(r->is_left, target) == 0U) || (r->component[target] != r->component[node]))) {
            return true;
        }
    }
    return false;
}

/* Takes away what leads out. Whether anything was taken away. */
static bool take_away(running_t *r)
{
    const ex_graph_t *const g = r->graph;
    bool is_changed = false;
    for (uint32_t node = 0U; node < g->nodes; node++) {
        bool has_step = false;
        if (EX_BIT(r->is_left, node) == 0U) {
            continue;
        }
        for (uint64_t arc = g->row[node]; arc < g->row[node + 1U]; arc++) {
            if (EX_BIT(r->is_out, arc) != 0U) {
                continue;
            }
            if (leaves(r, node, g->label[arc])) {
                EX_SET_BIT(r->is_out, arc);
                is_changed = true;
            } else {
                has_step = true;
            }
        }
        if (!has_step) {
            r->is_left[node / 64U] &= ~((uint64_t)1U << (node % 64U));
            is_changed = true;
        }
    }
    return is_changed;
}

/* A node of an end component in which nobody is left waiting; EX_NO_NODE: there is none. EX_NO_NODE - 1: no memory. */
static uint32_t first_fair(const running_t *r)
{
    const ex_graph_t *const g = r->graph;
    const uint32_t *const owner = r->queries->owner;
    owners_t *const served = calloc((size_t)r->components + 1U, sizeof *served);
    uint32_t found = EX_NO_NODE;
    if (served == NULL) {
        return EX_NO_NODE - 1U;
    }
    for (uint32_t node = 0U; node < g->nodes; node++) {
        owners_t able = { { 0U } };
        owners_t doing = { { 0U } };
        if (EX_BIT(r->is_left, node) == 0U) {
            continue;
        }
        for (uint64_t arc = g->row[node]; arc < g->row[node + 1U]; arc++) {
            const uint32_t whose = owner[g->label[arc]];
            EX_SET_BIT(able.word, whose);
            if (EX_BIT(r->is_out, arc) == 0U) {
                EX_SET_BIT(doing.word, whose);
            }
        }
        for (uint32_t i = 0U; i < OWNER_WORDS; i++) {
            served[r->component[node]].word[i] |= doing.word[i] | ~able.word[i];
        }
    }
    for (uint32_t node = 0U; (found == EX_NO_NODE) && (node < g->nodes); node++) {
        bool is_fair = EX_BIT(r->is_left, node) != 0U;
        for (uint32_t i = 0U; is_fair && (i < OWNER_WORDS); i++) {
            is_fair = served[r->component[node]].word[i] == UINT64_MAX;
        }
        found = is_fair ? node : EX_NO_NODE;
    }
    free(served);
    return found;
}

/* Where the cell can be kept from its end; as first_fair. */
static uint32_t find_trap(running_t *r)
{
    const ex_graph_t *const g = r->graph;
    for (uint32_t node = 0U; node < g->nodes; node++) {
        if (EX_BIT(r->goal, node) == 0U) {
            EX_SET_BIT(r->is_left, node);
        }
    }
    bool is_changed = true;
    while (is_changed) {
        if (!find_components(r)) {
            return EX_NO_NODE - 1U;
        }
        is_changed = take_away(r);
    }
    return first_fair(r);
}

static bool open_tables(running_t *r)
{
    ex_run_t *const run = r->queries->run;
    const uint64_t nodes = r->graph->nodes;
    r->is_left = ex_set(r->queries);
    r->is_out = ex_alloc(&run->memory, ((r->graph->arcs / 64U) + 1U) * sizeof *r->is_out);
    r->component = ex_table(&run->memory, nodes, sizeof *r->component);
    r->number = ex_table(&run->memory, nodes, sizeof *r->number);
    r->low = ex_table(&run->memory, nodes, sizeof *r->low);
    r->stack = ex_table(&run->memory, nodes, sizeof *r->stack);
    r->path = ex_table(&run->memory, nodes, sizeof *r->path);
    r->at = ex_table(&run->memory, nodes, sizeof *r->at);
    return (r->is_left != NULL) && (r->is_out != NULL) && (r->component != NULL) && (r->number != NULL)
           && (r->low != NULL) && (r->stack != NULL) && (r->path != NULL) && (r->at != NULL);
}

static void close_tables(const running_t *r)
{
    ex_run_t *const run = r->queries->run;
    const uint64_t nodes = r->graph->nodes;
    ex_free(&run->memory, r->is_left, ex_set_words(r->graph) * sizeof *r->is_left);
    ex_free(&run->memory, r->is_out, ((r->graph->arcs / 64U) + 1U) * sizeof *r->is_out);
    ex_free_table(&run->memory, r->component, nodes, sizeof *r->component);
    ex_free_table(&run->memory, r->number, nodes, sizeof *r->number);
    ex_free_table(&run->memory, r->low, nodes, sizeof *r->low);
    ex_free_table(&run->memory, r->stack, nodes, sizeof *r->stack);
    ex_free_table(&run->memory, r->path, nodes, sizeof *r->path);
    ex_free_table(&run->memory, r->at, nodes, sizeof *r->at);
}

/* Of the nodes from which no end can be reached (without ends: of the dead ones) the first dead one, or the first. */
static uint32_t first_bad(const ex_queries_t *queries, const ex_question_t *question, bool *is_dead)
{
    const ex_graph_t *const g = queries->run->graph;
    uint32_t bad = EX_NO_NODE;
    *is_dead = false;
    for (uint32_t node = 0U; (node < g->nodes) && !*is_dead; node++) {
        const bool is_end = EX_BIT(g->dead, node) != 0U;
        const bool is_bad = question->has_item ? !ex_is_in(queries, question->a, node) : is_end;
        if (is_bad && ((bad == EX_NO_NODE) || is_end)) {
            bad = node;
            *is_dead = is_end;
        }
    }
    return bad;
}

/* `a` is the item `ef` of the ends. */
bool ex_running(ex_queries_t *queries, ex_question_t *question)
{
    bool is_dead = false;
    const uint32_t bad = first_bad(queries, question, &is_dead);
    question->value_kind = EX_INTEGER;
    question->value = (double)queries->run->graph->nodes;
    question->node = bad;
    question->answer = (bad == EX_NO_NODE) ? EX_YES : EX_NO;
    if (bad != EX_NO_NODE) {
        question->why = is_dead ? "deadlock" : "endless";
        return true;
    }
    if (!question->has_item) {
        return true;
    }
    running_t r = { .queries = queries,
                    .graph = queries->run->graph,
                    .goal = queries->item[queries->item[question->a].a].set };
    const uint32_t trap = open_tables(&r) ? find_trap(&r) : (EX_NO_NODE - 1U);
    close_tables(&r);
    if (trap == (EX_NO_NODE - 1U)) {
        return false;
    }
    if (trap != EX_NO_NODE) {
        question->answer = EX_UNKNOWN;
        question->why = "speeds";
        question->node = trap;
    }
    return true;
}
