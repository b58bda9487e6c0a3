/* SPDX-License-Identifier: MIT
 * explore_ctl.c - the operators of CTL over the graph, each in one pass over its arcs, and runs that show why a formula
 * holds or not.
 *
 * Runs are maximal: one that comes to a dead node ends there. So there AX holds of anything and EX of nothing, AF and
 * EG ask for the node itself. All operators are made of three: EX, and
 *
 *     E[a U b]  the least set with b, and with the nodes of a that have a successor in it
 *     A[a U b]  the least set with b, and with the nodes of a that are not dead and have all successors in it
 *
 * Both grow from b backwards; for the second each node counts the successors that are not in it yet.
 *
 * Of a part of the graph some nodes are *cut*: they have successors that are not there, and of which nothing is known.
 * There each item has two sets, of the nodes that are surely in it and of those that may be in it, which are the least
 * and the greatest that it can be, whatever the missing successors are (G. Bruns, P. Godefroid, *Model checking partial
 * state spaces with 3-valued temporal logics*, 1999). The negation of the one is made of the other. For what is sure,
 * a missing successor is in nothing; for what may be, it is in everything.
 */
#include "explore_query.h"

static void complement(const ex_queries_t *queries, uint64_t *set)
{
    const ex_graph_t *const graph = queries->run->graph;
    const uint64_t words = ex_set_words(graph);
    for (uint64_t i = 0U; i < words; i++) {
        set[i] = ~set[i];
    }
    if ((graph->nodes % 64U) != 0U) {
        set[words - 1U] &= ((uint64_t)1U << (graph->nodes % 64U)) - 1U;
    }
}

/* The arcs the other way round, once for all operators. */
static bool turn_arcs(ex_queries_t *queries)
{
    ex_run_t *const run = queries->run;
    const ex_graph_t *const graph = run->graph;
    if (queries->in_source != NULL) {
        return true;
    }
    uint64_t *const row = ex_table(&run->memory, (uint64_t)graph->nodes + 1U, sizeof *row);
    uint32_t *const source = ex_table(&run->memory, graph->arcs, sizeof *source);
    if ((row == NULL) || (source == NULL)) {
        ex_free_table(&run->memory, row, (uint64_t)graph->nodes + 1U, sizeof *row);
        ex_free_table(&run->memory, source, graph->arcs, sizeof *source);
        return false;
    }
    for (uint64_t arc = 0U; arc < graph->arcs; arc++) {
        row[graph->target[arc] + 1U] += 1U;
    }
    for (uint32_t node = 0U; node < graph->nodes; node++) {
        row[node + 1U] += row[node];
    }
    /* From behind, so that row[i + 1] becomes the beginning of node i; then all move down by one. */
    for (uint32_t node = graph->nodes; node > 0U; node--) {
        for (uint64_t arc = graph->row[node]; arc > graph->row[node - 1U]; arc--) {
            uint64_t *const end = &row[graph->target[arc - 1U] + 1U];
            *end -= 1U;
            source[*end] = node - 1U;
        }
    }
    for (uint32_t node = 0U; node < graph->nodes; node++) {
        row[node] = row[node + 1U];
    }
    row[graph->nodes] = graph->arcs;
    queries->in_row = row;
    queries->in_source = source;
    return true;
}

/* The nodes with an arc (of a transition; UINT32_MAX: any) to a node of `a`. */
static void add_before(const ex_queries_t *queries, const uint64_t *a, uint32_t transition, uint64_t *set)
{
    const ex_graph_t *const graph = queries->run->graph;
    for (uint32_t node = 0U; node < graph->nodes; node++) {
        for (uint64_t arc = graph->row[node]; arc < graph->row[node + 1U]; arc++) {
            if ((EX_BIT(a, graph->target[arc]) != 0U)
                && ((transition == UINT32_MAX) || (graph->label[arc] == transition))) {
                EX_SET_BIT(set, node);
                break;
            }
        }
    }
}

static bool is_cut(const ex_graph_t *graph, uint32_t node)
{
    return (graph->cut != NULL) && (EX_BIT(graph->cut, node) != 0U);
}

static bool is_of(const uint64_t *set, uint32_t node)
{
    return (set == NULL) || (EX_BIT(set, node) != 0U);
}

/* What a set is that is worked out: that of `item->may`, or of `item->set`. */
typedef enum side { SURELY, MAYBE } side_t;

static side_t other(side_t side)
{
    return (side == SURELY) ? MAYBE : SURELY;
}

/* Adds the nodes of `a` (NULL: all) that may be in a set because of what their missing successors may be. `left`: those
 * that have no other ones; NULL: all. */
static void add_cut(const ex_queries_t *queries, const uint64_t *a, const uint32_t *left, uint64_t *set)
{
    const ex_graph_t *const graph = queries->run->graph;
    for (uint32_t node = 0U; node < graph->nodes; node++) {
        if (is_cut(graph, node) && is_of(a, node) && ((left == NULL) || (left[node] == 0U))) {
            EX_SET_BIT(set, node);
        }
    }
}

/* Of each node the successors that have to be in a set before it is in it; one that is missing and never is. */
static void count_left(const ex_queries_t *queries, side_t side, uint32_t *left)
{
    const ex_graph_t *const graph = queries->run->graph;
    for (uint32_t node = 0U; node < graph->nodes; node++) {
        const uint32_t missing = ((side == SURELY) && is_cut(graph, node)) ? 1U : 0U;
        left[node] = (uint32_t)(graph->row[node + 1U] - graph->row[node]) + missing;
    }
}

/* Grows `set`, which holds b, to an until; a is NULL where every node will do. `left`: as above; NULL: one successor is
 * enough. */
static bool grow(ex_queries_t *queries, const uint64_t *a, uint64_t *set, uint32_t *left, uint32_t *stack)
{
    const ex_graph_t *const graph = queries->run->graph;
    uint64_t waiting = 0U;
    uint64_t steps = 0U;
    for (uint32_t node = 0U; node < graph->nodes; node++) {
        if (EX_BIT(set, node) != 0U) {
            stack[waiting] = node;
            waiting += 1U;
        }
    }
    while (waiting > 0U) {
        waiting -= 1U;
        steps += 1U;
        if (((steps & 0xffffU) == 0U) && ex_is_stopping(queries->run)) {
            return false;
        }
        const uint32_t node = stack[waiting];
        for (uint64_t i = queries->in_row[node]; i < queries->in_row[node + 1U]; i++) {
            const uint32_t source = queries->in_source[i];
            if (left != NULL) {
                left[source] -= 1U;
                if (left[source] > 0U) {
                    continue;
                }
            }
            if ((EX_BIT(set, source) == 0U) && is_of(a, source)) {
                EX_SET_BIT(set, source);
                stack[waiting] = source;
                waiting += 1U;
            }
        }
    }
    return true;
}

static bool until(ex_queries_t *queries, const uint64_t *a, uint64_t *set, bool is_universal, side_t side)
{
    ex_run_t *const run = queries->run;
    const uint64_t nodes = run->graph->nodes;
    uint32_t *const stack = ex_table(&run->memory, nodes, sizeof *stack);
    uint32_t *const left = is_universal ? ex_table(&run->memory, nodes, sizeof *left) : NULL;
    const bool has_memory = (stack != NULL) && (!is_universal || (left != NULL)) && turn_arcs(queries);
    if (has_memory && is_universal) {
        count_left(queries, side, left);
    }
    if (has_memory && (side == MAYBE)) {
        add_cut(queries, a, left, set);
    }
    const bool is_done = has_memory && grow(queries, a, set, left, stack);
    ex_free_table(&run->memory, stack, nodes, sizeof *stack);
    if (is_universal) {
        ex_free_table(&run->memory, left, nodes, sizeof *left);
    }
    return is_done;
}

uint64_t *ex_set(const ex_queries_t *queries)
{
    return ex_alloc(&queries->run->memory, ex_set_words(queries->run->graph) * sizeof(uint64_t));
}

static void copy(const ex_queries_t *queries, uint64_t *set, const uint64_t *from)
{
    (void)memcpy(set, from, ex_set_words(queries->run->graph) * sizeof *set);
}

static void combine(const ex_queries_t *queries, uint64_t *set, const uint64_t *a, const uint64_t *b, bool is_and)
{
    const uint64_t words = ex_set_words(queries->run->graph);
    for (uint64_t i = 0U; i < words; i++) {
        set[i] = is_and ? (a[i] & b[i]) : (a[i] | b[i]);
    }
}

/* The nodes with a successor (by a transition; UINT32_MAX: any) that is in a set, on one side. */
static void step_before(const ex_queries_t *queries, const uint64_t *a, uint32_t transition, side_t side, uint64_t *set)
{
    add_before(queries, a, transition, set);
    if (side == MAYBE) {
        add_cut(queries, NULL, NULL, set);
    }
}

/* AX, not EX not a; EG and AG, not AF not a, and not EF not a. */
static bool opposite(ex_queries_t *queries, ex_item_kind_t kind, const uint64_t *a, side_t side, uint64_t *set)
{
    bool is_fine = true;
    if (kind == EX_ITEM_AX) {
        uint64_t *const outside = ex_set(queries);
        is_fine = outside != NULL;
        if (is_fine) {
            copy(queries, outside, a);
            complement(queries, outside);
            step_before(queries, outside, UINT32_MAX, other(side), set);
        }
        ex_free(&queries->run->memory, outside, ex_set_words(queries->run->graph) * sizeof *outside);
    } else {
        copy(queries, set, a);
        complement(queries, set);
        is_fine = until(queries, NULL, set, kind == EX_ITEM_EG, other(side));
    }
    complement(queries, set);
    return is_fine;
}

static uint64_t *side_of(const ex_item_t *item, side_t side)
{
    return (side == SURELY) ? item->set : item->may;
}

/* The set of an item on one side; NULL: no memory, or told to stop. */
static uint64_t *work_out(ex_queries_t *queries, const ex_item_t *item, side_t side)
{
    const uint64_t *const a = side_of(&queries->item[item->a], side);
    const uint64_t *const b = side_of(&queries->item[item->b], side);
    uint64_t *const set = ex_set(queries);
    bool is_fine = set != NULL;
    if (!is_fine) {
        return NULL;
    }
    switch (item->kind) {
    case EX_ITEM_NOT:
        copy(queries, set, side_of(&queries->item[item->a], other(side)));
        complement(queries, set);
        break;
    case EX_ITEM_AND:
    case EX_ITEM_OR: combine(queries, set, a, b, item->kind == EX_ITEM_AND); break;
    case EX_ITEM_EX: step_before(queries, a, UINT32_MAX, side, set); break;
    case EX_ITEM_EXA: step_before(queries, a, item->number, side, set); break;
    case EX_ITEM_EF:
    case EX_ITEM_AF:
        copy(queries, set, a);
        is_fine = until(queries, NULL, set, item->kind == EX_ITEM_AF, side);
        break;
    case EX_ITEM_EU:
    case EX_ITEM_AU:
        copy(queries, set, b);
        is_fine = until(queries, a, set, item->kind == EX_ITEM_AU, side);
        break;
    case EX_ITEM_AX:
    case EX_ITEM_EG:
    case EX_ITEM_AG: is_fine = opposite(queries, item->kind, a, side, set); break;
    case EX_ITEM_TRUE:
    case EX_ITEM_DEAD:
    case EX_ITEM_INITIAL:
    case EX_ITEM_PRED:
    case EX_ITEM_ENABLED:
    case EX_ITEM_WITHIN:
    default:
        is_fine = false; /* explore_query.c knows them */
        break;
    }
    return is_fine ? set : NULL;
}

bool ex_ctl(ex_queries_t *queries, ex_item_t *item)
{
    const ex_item_t *const a = &queries->item[item->a];
    const ex_item_t *const b = &queries->item[item->b];
    const bool is_of_nodes = item->kind <= EX_ITEM_OR;
    const bool is_exact = queries->run->graph->is_whole || (is_of_nodes && (a->set == a->may) && (b->set == b->may));
    uint64_t *const set = work_out(queries, item, SURELY);
    uint64_t *const may = (is_exact || (set == NULL)) ? set : work_out(queries, item, MAYBE);
    item->set = (may != NULL) ? set : NULL;
    item->may = may;
    return may != NULL;
}

/* --- runs that show it -------------------------------------------------------------------------------------------- */

/* What comes next in an explanation: whether an item holds at the end of the way. */
typedef struct claim {
    uint32_t item;
    bool holds;
    bool is_shown; /* there is nothing more to say */
} claim_t;

/* The nodes that are surely not in an item, to be freed. */
static uint64_t *without(const ex_queries_t *queries, uint32_t item)
{
    uint64_t *const set = ex_set(queries);
    if (set != NULL) {
        copy(queries, set, queries->item[item].may);
        complement(queries, set);
    }
    return set;
}

/* A way to the nearest node that is (not) in an item. */
static bool show_path(ex_queries_t *queries, const uint64_t *through, claim_t *claim, uint32_t item, bool holds,
                      ex_path_t *path)
{
    uint64_t *const other = holds ? NULL : without(queries, item);
    const uint64_t *const goal = holds ? queries->item[item].set : other;
    const bool is_found = (goal != NULL) && ex_path_search(queries, through, goal, path);
    ex_free(&queries->run->memory, other, (other != NULL) ? (ex_set_words(queries->run->graph) * sizeof *other) : 0U);
    *claim = (claim_t){ .item = item, .holds = holds };
    return is_found;
}

/* One step to a node that is (not) in an item. */
static bool show_step(ex_queries_t *queries, claim_t *claim, const ex_item_t *item, bool holds, ex_path_t *path)
{
    const ex_graph_t *const graph = queries->run->graph;
    const uint32_t node = ex_path_end(path);
    const uint32_t a = item->a;
    for (uint64_t arc = graph->row[node]; arc < graph->row[node + 1U]; arc++) {
        const bool is_of_it = (item->kind != EX_ITEM_EXA) || (graph->label[arc] == item->number);
        if (is_of_it && ex_is_known(queries, a, graph->target[arc], holds)) {
            ex_path_step(path, graph->label[arc], graph->target[arc]);
            *claim = (claim_t){ .item = a, .holds = holds };
            return !path->is_failed;
        }
    }
    return false;
}

/* A run that stays in the item (or out of it) for ever, or until it ends. */
static bool show_for_ever(ex_queries_t *queries, claim_t *claim, uint32_t item, bool holds, ex_path_t *path)
{
    bool is_accepting = true;
    uint32_t first[] = { 0U, 1U };
    ex_literal_t literal = { .item = item, .is_positive = holds };
    ex_edge_t edge = { .literals = 1U, .literal = &literal };
    const ex_automaton_t automaton = {
        .states = 1U, .is_accepting = &is_accepting, .edges = 1U, .edge = &edge, .first = first
    };
    claim->is_shown = true;
    return ex_lasso(queries, &automaton, ex_path_end(path), path) == EX_YES;
}

/* A[a U b] does not hold: b never comes, or something comes before it that is in neither. */
static bool show_no_until(ex_queries_t *queries, claim_t *claim, const ex_item_t *item, ex_path_t *path)
{
    uint64_t *const before = without(queries, item->b);
    uint64_t *const neither = ex_set(queries);
    bool is_found = false;
    if ((before != NULL) && (neither != NULL)) {
        copy(queries, neither, queries->item[item->a].may);
        complement(queries, neither);
        combine(queries, neither, neither, before, true);
        is_found = ex_path_search(queries, before, neither, path);
        claim->is_shown = true;
    }
    ex_free(&queries->run->memory, before, ex_set_words(queries->run->graph) * sizeof *before);
    ex_free(&queries->run->memory, neither, ex_set_words(queries->run->graph) * sizeof *neither);
    return is_found || show_for_ever(queries, claim, item->b, false, path);
}

/* One operator; false: no run shows it. */
static bool show(ex_queries_t *queries, claim_t *claim, ex_path_t *path)
{
    const ex_item_t *const item = &queries->item[claim->item];
    const bool holds = claim->holds;
    const uint32_t node = ex_path_end(path);
    switch (item->kind) {
    case EX_ITEM_NOT: *claim = (claim_t){ .item = item->a, .holds = !holds }; return true;
    case EX_ITEM_AND:
    case EX_ITEM_OR: /* the operand that decides; if both have to be shown, the second is the one that says more as a
                        rule */
        if (holds == (item->kind == EX_ITEM_AND)) {
            *claim = (claim_t){ .item = item->b, .holds = holds };
        } else {
            *claim =
                (claim_t){ .item = ex_is_known(queries, item->a, node, holds) ? item->a : item->b, .holds = holds };
        }
        return true;
    case EX_ITEM_EX:
    case EX_ITEM_EXA: return holds && show_step(queries, claim, item, true, path);
    case EX_ITEM_AX: return !holds && show_step(queries, claim, item, false, path);
    case EX_ITEM_EF: return holds && show_path(queries, NULL, claim, item->a, true, path);
    case EX_ITEM_AG: return !holds && show_path(queries, NULL, claim, item->a, false, path);
    case EX_ITEM_EU: return holds && show_path(queries, queries->item[item->a].set, claim, item->b, true, path);
    case EX_ITEM_EG: return holds && show_for_ever(queries, claim, item->a, true, path);
    case EX_ITEM_AF: return !holds && show_for_ever(queries, claim, item->a, false, path);
    case EX_ITEM_AU: return !holds && show_no_until(queries, claim, item, path);
    case EX_ITEM_TRUE:
    case EX_ITEM_DEAD:
    case EX_ITEM_INITIAL:
    case EX_ITEM_PRED:
    case EX_ITEM_ENABLED:
    case EX_ITEM_WITHIN:
    default: return false;
    }
}

bool ex_ctl_explain(ex_queries_t *queries, uint32_t item, bool holds, ex_path_t *path)
{
    claim_t claim = { .item = item, .holds = holds };
    bool is_shown = false;
    /* Operands have smaller numbers, so that this ends. */
    while (!claim.is_shown && !path->is_failed) {
        const ex_item_kind_t kind = queries->item[claim.item].kind;
        if (!show(queries, &claim, path)) {
            break;
        }
        is_shown = is_shown || ((kind != EX_ITEM_NOT) && (kind != EX_ITEM_AND) && (kind != EX_ITEM_OR));
    }
    return is_shown && !path->is_failed;
}
