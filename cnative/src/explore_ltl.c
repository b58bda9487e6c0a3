/* SPDX-License-Identifier: MIT
 * explore_ltl.c - runs that an automaton accepts: cycles in the product of the graph and the automaton.
 *
 * A run is accepted when it comes infinitely often to an accepting state and is fair: what is assumed of a transition t is
 *
 *     strong   if it is enabled infinitely often, it occurs infinitely often
 *     weak     if it is enabled from some point on, it occurs infinitely often
 *
 * What a run does infinitely often it does in one component of the product. There is an accepted run in a component with an accepting
 * state in which each weak t occurs, or is not enabled somewhere, and each strong t occurs, or is enabled nowhere. Where only the last
 * fails, the states in which t is enabled cannot be visited for ever: without them the component falls into smaller ones, which are looked
 * at in the next round. No transition fails twice in the same place, so there are at most as many rounds as strong transitions, and one.
 */
#include "explore_product.h"

#include <stdlib.h>

/* --- components ------------------------------------------------------------------------------------------------------ */

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
        ex_cursor_t *const larger = ex_table(p->queries->run, room, sizeof *larger);
        if (larger == NULL) {
            return false;
        }
        (void)memcpy(larger, w->at, w->room * sizeof *larger);
        ex_free_table(p->queries->run, w->at, w->room, sizeof *larger);
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

/* All that can be reached from a state. False: no memory, or told to stop. */
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

/* One round over the active states; in the first one those that can be reached from the start become active. */
static bool walk_round(ex_product_t *p, bool is_first)
{
    walk_t w = { .p = p, .room = 1024U };
    bool is_fine = true;
    w.at = ex_table(p->queries->run, w.room, sizeof *w.at);
    p->waiting = 0U;
    p->next = 1U;
    p->done = UINT32_MAX;
    p->is_changed = false;
    p->is_found = false;
    (void)memset(p->rank, 0, p->size * sizeof *p->rank);
    is_fine = w.at != NULL;
    if (is_first) {
        is_fine = is_fine && walk_from(&w, p->start);
    } else {
        for (uint64_t state = 0U; is_fine && (state < p->size); state++) {
            if ((EX_BIT(p->active, state) != 0U) && (p->rank[state] == 0U)) {
                is_fine = walk_from(&w, (uint32_t)state);
            }
        }
    }
    ex_free_table(p->queries->run, w.at, w.room, sizeof *w.at);
    return is_fine;
}

/* What cannot be reached is not active. */
static void forget_unreached(ex_product_t *p)
{
    for (uint64_t state = 0U; state < p->size; state++) {
        if (p->rank[state] == 0U) {
            ex_take_out(p, state);
        }
    }
}

static ex_answer_t find_components(ex_product_t *p)
{
    bool is_first = true;
    do {
        if (!walk_round(p, is_first)) {
            return EX_UNKNOWN;
        }
        if (is_first) {
            forget_unreached(p);
        }
        is_first = false;
    } while (p->is_changed);
    return p->is_found ? EX_YES : EX_NO;
}

/* --- the whole ------------------------------------------------------------------------------------------------------- */

ex_answer_t ex_lasso(ex_queries_t *queries, const ex_automaton_t *automaton, uint32_t start, ex_way_t *way)
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
    p.active = ex_alloc(run, words * sizeof *p.active);
    p.rank = ex_table(run, p.size, sizeof *p.rank);
    p.stack = ex_table(run, p.size, sizeof *p.stack);
    p.is_root = ex_table(run, p.size, sizeof *p.is_root);
    p.occurs = calloc((size_t)automaton->fair_count + 1U, sizeof *p.occurs);
    p.is_enabled = calloc((size_t)automaton->fair_count + 1U, sizeof *p.is_enabled);
    p.is_disabled = calloc((size_t)automaton->fair_count + 1U, sizeof *p.is_disabled);
    if ((p.active != NULL) && (p.rank != NULL) && (p.stack != NULL) && (p.is_root != NULL) && (p.occurs != NULL) && (p.is_enabled != NULL) &&
        (p.is_disabled != NULL)) {
        (void)memset(p.active, 0xff, words * sizeof *p.active);
        answer = find_components(&p);
    }
    ex_free_table(run, p.stack, p.size, sizeof *p.stack);
    ex_free_table(run, p.is_root, p.size, sizeof *p.is_root);
    if (answer == EX_YES) {
        way->is_failed = !ex_show_lasso(&p, way) || way->is_failed;
    }
    ex_free(run, p.active, words * sizeof *p.active);
    ex_free_table(run, p.rank, p.size, sizeof *p.rank);
    free(p.occurs);
    free(p.is_enabled);
    free(p.is_disabled);
    return answer;
}
