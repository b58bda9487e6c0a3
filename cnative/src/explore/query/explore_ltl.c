/* SPDX-License-Identifier: MIT
 * explore_ltl.c - runs that an automaton accepts: cycles in the product of the graph and the automaton.
 *
 * A run is accepted when it comes infinitely often to an accepting state and is fair: what is assumed of a transition t
 * is
 *
 *     strong   if it is enabled infinitely often, it occurs infinitely often
 *     weak     if it is enabled from some point on, it occurs infinitely often
 *
 * What a run does infinitely often it does in one component of the product. There is an accepted run in a component
 * with an accepting state in which each weak t occurs, or is not enabled somewhere, and each strong t occurs, or is
 * enabled nowhere. Where only the last fails, the states in which t is enabled cannot be visited for ever: without them
 * the component falls into smaller ones, which are looked at in the next round. No transition fails twice in the same
 * place, so there are at most as many rounds as strong transitions, and one.
 */
#include "explore_product.h"

#include <stdlib.h>

/* --- components --------------------------------------------------------------------------------------------------- */

/* What the arcs and nodes of a component have of all that is asked for. Gives whether there is a cycle. */
static bool look_through(ex_product_t *p, const uint32_t *member, uint64_t count)
{
    const ex_automaton_t *const automaton = p->automaton;
    const uint32_t component = p->rank[member[0]];
    bool is_cyclic = count > 1U;
    for (uint32_t k = 0U; k < automaton->fair_count; k++) {
        p->occurs[k] = false;
        p->is_enabled[k] = false;
        p->is_disabled[k] = false;
    }
    for (uint64_t i = 0U; i < count; i++) {
        ex_cursor_t cursor = ex_first_of(p, member[i]);
        uint32_t label = EX_NO_TRANSITION;
        for (uint32_t k = 0U; k < automaton->fair_count; k++) {
            const bool is_enabled = ex_is_in(p->queries, automaton->fair_item[k], member[i] / p->states);
            p->is_enabled[k] = p->is_enabled[k] || is_enabled;
            p->is_disabled[k] = p->is_disabled[k] || !is_enabled;
        }
        if (is_cyclic && (automaton->fair_count == 0U)) {
            break;
        }
        for (uint32_t to = ex_next_of(p, &cursor, &label); to != EX_NO_STATE; to = ex_next_of(p, &cursor, &label)) {
            if ((EX_BIT(p->active, to) == 0U) || (p->rank[to] != component)) {
                continue;
            }
            is_cyclic = true;
            for (uint32_t k = 0U; k < automaton->fair_count; k++) {
                p->occurs[k] = p->occurs[k] || (automaton->fair[k] == label);
            }
        }
    }
    return is_cyclic;
}

static bool has_accepting(const ex_product_t *p, const uint32_t *member, uint64_t count)
{
    for (uint64_t i = 0U; i < count; i++) {
        if (p->automaton->is_accepting[member[i] % p->states]) {
            return true;
        }
    }
    return false;
}

/* Takes out the states of a component in which a fair transition `k` is enabled; EX_NO_STATE: all of them. */
static void take_out(ex_product_t *p, const uint32_t *member, uint64_t count, uint32_t k)
{
    for (uint64_t i = 0U; i < count; i++) {
        const uint32_t state = member[i];
        if ((k == EX_NO_STATE) || ex_is_in(p->queries, p->automaton->fair_item[k], state / p->states)) {
            ex_take_out(p, state);
        }
    }
}

static void judge(ex_product_t *p, const uint32_t *member, uint64_t count)
{
    const ex_automaton_t *const automaton = p->automaton;
    bool is_hopeless = !has_accepting(p, member, count) || !look_through(p, member, count);
    bool is_good = !is_hopeless;
    for (uint32_t k = 0U; !is_hopeless && (k < automaton->fair_count); k++) {
        is_hopeless = !automaton->is_strong[k] && !p->occurs[k] && !p->is_disabled[k];
    }
    if (is_hopeless) {
        take_out(p, member, count, EX_NO_STATE);
        return;
    }
    for (uint32_t k = 0U; k < automaton->fair_count; k++) {
        if (automaton->is_strong[k] && !p->occurs[k] && p->is_enabled[k]) {
            take_out(p, member, count, k);
            p->is_changed = true;
            is_good = false;
        }
    }
    p->is_found = p->is_found || is_good;
}

/* The way of the search; the states on it have a place of their own at the end of the stack. */
typedef struct walk {
    ex_product_t *p;
    ex_cursor_t *at;
    uint64_t depth;
    uint64_t room;
} walk_t;

static bool enter(walk_t *w, uint32_t state)
{
    ex_product_t *const p = w->p;
    if (w->depth == w->room) {
        const uint64_t room = w->room * 2U;
        ex_cursor_t *const larger = ex_table(&p->queries->run->memory, room, sizeof *larger);
        if (larger == NULL) {
            return false;
        }
        (void)memcpy(larger, w->at, w->room * sizeof *larger);
        ex_free_table(&p->queries->run->memory, w->at, w->room, sizeof *larger);
        w->at = larger;
        w->room = room;
    }
    p->rank[state] = p->next;
    p->next += 1U;
    p->is_root[state] = 1U;
    w->at[w->depth] = ex_first_of(p, state);
    w->depth += 1U;
    return true;
}

/* The state at the end of the way has been seen through. */
static void leave(walk_t *w)
{
    ex_product_t *const p = w->p;
    w->depth -= 1U;
    const uint32_t state = w->at[w->depth].state;
    if (p->is_root[state] == 0U) {
        const uint32_t before = w->at[w->depth - 1U].state;
        p->stack[p->waiting] = state;
        p->waiting += 1U;
        if (p->rank[state] < p->rank[before]) {
            p->rank[before] = p->rank[state];
            p->is_root[before] = 0U;
        }
        return;
    }
    uint64_t first = p->waiting;
    p->next -= 1U;
    while ((first > 0U) && (p->rank[p->stack[first - 1U]] >= p->rank[state])) {
        first -= 1U;
        p->next -= 1U;
    }
    p->stack[p->waiting] = state;
    for (uint64_t i = first; i <= p->waiting; i++) {
        p->rank[p->stack[i]] = p->done;
    }
    p->done -= 1U;
    judge(p, &p->stack[first], (p->waiting - first) + 1U);
    p->waiting = first;
}

/* All active states that can be reached from one. False: no memory, or told to stop. */
static bool walk_from(walk_t *w, uint32_t root)
{
    ex_product_t *const p = w->p;
    if (!enter(w, root)) {
        return false;
    }
    while (w->depth > 0U) {
        ex_cursor_t *const at = &w->at[w->depth - 1U];
        uint32_t label = EX_NO_TRANSITION;
        const uint32_t to = ex_next_of(p, at, &label);
        p->steps += 1U;
        if (((p->steps & 0xffffU) == 0U) && ex_is_stopping(p->queries->run)) {
            return false;
        }
        if (to == EX_NO_STATE) {
            leave(w);
        } else if (EX_BIT(p->active, to) == 0U) {
            continue; /* taken out */
        } else if (p->rank[to] == 0U) {
            if (!enter(w, to)) {
                return false;
            }
        } else if (p->rank[to] < p->rank[at->state]) {
            p->rank[at->state] = p->rank[to];
            p->is_root[at->state] = 0U;
        }
    }
    return true;
}

/* One round over the active states. */
static bool walk_round(ex_product_t *p)
{
    walk_t w = { .p = p, .room = 1024U };
    w.at = ex_table(&p->queries->run->memory, w.room, sizeof *w.at);
    bool is_fine = w.at != NULL;
    p->waiting = 0U;
    p->next = 1U;
    p->done = UINT32_MAX;
    p->is_changed = false;
    p->is_found = false;
    (void)memset(p->rank, 0, p->size * sizeof *p->rank);
    for (uint64_t word = 0U; is_fine && (word < ((p->size + 63U) / 64U)); word++) {
        for (uint64_t state = word * 64U; is_fine && (p->active[word] != 0U) && (state < ((word + 1U) * 64U));
             state++) {
            if ((EX_BIT(p->active, state) != 0U) && (p->rank[state] == 0U)) {
                is_fine = walk_from(&w, (uint32_t)state);
            }
        }
    }
    ex_free_table(&p->queries->run->memory, w.at, w.room, sizeof *w.at);
    return is_fine;
}

/* --- which states there are --------------------------------------------------------------------------------------- */

#define MOST_STATES 2048U /* of an automaton, of which all ways are looked at */

/* Marks what can be reached from a state of the automaton by at least one arc. */
static void spread(const ex_automaton_t *automaton, uint32_t from, bool *reached, uint32_t *stack)
{
    uint32_t waiting = 1U;
    stack[0] = from;
    while (waiting > 0U) {
        waiting -= 1U;
        const uint32_t state = stack[waiting];
        for (uint32_t i = automaton->first[state]; i < automaton->first[state + 1U]; i++) {
            const uint32_t to = automaton->edge[i].to;
            if (!reached[to]) {
                reached[to] = true;
                stack[waiting] = to;
                waiting += 1U;
            }
        }
    }
}

/* The states of the automaton that lie on a cycle through an accepting one: no others come back for ever. NULL: no
 * memory. */
static bool *find_recurring(const ex_automaton_t *automaton)
{
    const size_t states = automaton->states;
    const bool is_small = states <= MOST_STATES;
    bool *const recurring = calloc(states, sizeof *recurring);
    bool *const reached = is_small ? calloc(states * states, sizeof *reached) : NULL;
    uint32_t *const stack = calloc(states + 1U, sizeof *stack);
    const bool has_memory = (recurring != NULL) && (stack != NULL) && (!is_small || (reached != NULL));
    for (uint32_t s = 0U; has_memory && is_small && (s < states); s++) {
        spread(automaton, s, &reached[s * states], stack);
    }
    for (uint32_t s = 0U; has_memory && (s < states); s++) {
        recurring[s] = !is_small;
        for (uint32_t k = 0U; is_small && (k < states); k++) {
            recurring[s] =
                recurring[s] || (automaton->is_accepting[k] && reached[(s * states) + k] && reached[(k * states) + s]);
        }
    }
    free(reached);
    free(stack);
    if (!has_memory) {
        free(recurring);
        return NULL;
    }
    return recurring;
}

static inline void reach(ex_product_t *p, uint32_t state, uint64_t *used)
{
    if (EX_BIT(p->active, state) == 0U) {
        EX_SET_BIT(p->active, state);
        p->stack[*used] = state;
        *used += 1U;
    }
}

/* Makes the states active that can be reached from the start. */
static bool find_reached(ex_product_t *p)
{
    const ex_graph_t *const graph = p->graph;
    uint64_t used = 0U;
    reach(p, p->start, &used);
    for (uint64_t at = 0U; at < used;
         at++) { /* breadth first, as the nodes are numbered, so that neighbours come after each other */
        const uint32_t node = p->stack[at] / p->states;
        const uint32_t state = p->stack[at] % p->states;
        const uint64_t end = graph->row[node + 1U];
        for (uint32_t i = p->automaton->first[state]; i < p->automaton->first[state + 1U]; i++) {
            const ex_edge_t *const edge = &p->automaton->edge[i];
            if (!ex_is_readable(p, edge, node)) {
                continue;
            }
            if (ex_ends_at(graph, node) && ex_is_allowed(edge, EX_NO_TRANSITION)) {
                reach(p, (node * p->states) + edge->to, &used);
            }
            for (uint64_t arc = graph->row[node]; arc < end; arc++) {
                if (ex_is_allowed(edge, graph->label[arc])) {
                    reach(p, (graph->target[arc] * p->states) + edge->to, &used);
                }
            }
        }
        if (((at & 0xffffU) == 0U) && ex_is_stopping(p->queries->run)) {
            return false;
        }
    }
    return true;
}

static ex_answer_t find_components(ex_product_t *p)
{
    bool *const recurring = find_recurring(p->automaton);
    bool is_fine = (recurring != NULL) && find_reached(p);
    for (uint64_t state = 0U; is_fine && (state < p->size); state++) {
        if (!recurring[state % p->states]) {
            ex_take_out(p, state);
        }
    }
    free(recurring);
    do {
        is_fine = is_fine && walk_round(p);
    } while (is_fine && p->is_changed);
    if (!is_fine) {
        return EX_UNKNOWN;
    }
    return p->is_found ? EX_YES : EX_NO;
}

/* --- the whole ---------------------------------------------------------------------------------------------------- */

ex_answer_t ex_lasso(ex_queries_t *queries, const ex_automaton_t *automaton, uint32_t start, ex_path_t *path)
{
    ex_run_t *const run = queries->run;
    ex_product_t p = { .queries = queries, .graph = run->graph, .automaton = automaton, .states = automaton->states };
    ex_answer_t answer = EX_UNKNOWN;
    p.size = (uint64_t)run->graph->nodes * automaton->states;
    if (p.size >= (uint64_t)EX_AT_BEGINNING) {
        return EX_UNKNOWN;
    }
    const uint64_t words = (p.size / 64U) + 1U;
    p.start = (start * automaton->states) + automaton->initial;
    p.active = ex_alloc(&run->memory, words * sizeof *p.active);
    p.rank = ex_table(&run->memory, p.size, sizeof *p.rank);
    p.stack = ex_table(&run->memory, p.size, sizeof *p.stack);
    p.is_root = ex_table(&run->memory, p.size, sizeof *p.is_root);
    p.occurs = calloc((size_t)automaton->fair_count + 1U, sizeof *p.occurs);
    p.is_enabled = calloc((size_t)automaton->fair_count + 1U, sizeof *p.is_enabled);
    p.is_disabled = calloc((size_t)automaton->fair_count + 1U, sizeof *p.is_disabled);
    if ((p.active != NULL) && (p.rank != NULL) && (p.stack != NULL) && (p.is_root != NULL) && (p.occurs != NULL)
        && (p.is_enabled != NULL) && (p.is_disabled != NULL)) {
        answer = find_components(&p);
    }
    ex_free_table(&run->memory, p.stack, p.size, sizeof *p.stack);
    ex_free_table(&run->memory, p.is_root, p.size, sizeof *p.is_root);
    if (answer == EX_YES) {
        path->is_failed = !ex_show_lasso(&p, path) || path->is_failed;
    }
    ex_free(&run->memory, p.active, words * sizeof *p.active);
    ex_free_table(&run->memory, p.rank, p.size, sizeof *p.rank);
    free(p.occurs);
    free(p.is_enabled);
    free(p.is_disabled);
    return answer;
}
