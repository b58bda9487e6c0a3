/* SPDX-License-Identifier: MIT
 * symbolic_linear.c - whether a Buechi automaton accepts a run of the net, with sets of markings.
 *
 * For each state of the automaton the markings are found that the product reaches with it, then those from which one
 * can go on for ever within a strongly connected component of the automaton, coming to accepting states again and again
 * (Emerson, Lei 1986): if any are left, a run is accepted. A dead marking follows itself. A move of the automaton from
 * a state to itself is what saturation can do at once, within its guard.
 */
#include "symbolic.h"

#include <string.h>

enum { MOST_STATES = 1000 }; /* of an automaton; components are found in quadratic time */

/* All moves from one state to another one. */
typedef struct way {
    uint32_t source;
    uint32_t target;
    sy_node_t guard; /* the markings in which one of them may be made */
} way_t;

typedef struct product {
    sy_diagrams_t *d;
    const tb_automaton_t *a;
    uint32_t states;
    way_t *way;
    uint32_t ways;
    sy_node_t *self; /* state -> the guard of its way to itself */
    sy_node_t *met;  /* state -> the markings that are reached with it */
    sy_node_t *left; /* state -> those of them that may still be on a run that is accepted */
    sy_node_t *some; /* state -> a set in the making */
    bool *is_in;     /* state -> whether it is in the component that is looked at */
    bool *is_from;   /* state -> whether it is reached from the state that is looked at */
    bool *is_to;     /* state -> whether that state is reached from it */
} product_t;

/* --- ways --------------------------------------------------------------------------------------------------------- */

static sy_node_t guard_of(product_t *p, const tb_move_t *move, const sy_node_t *atom)
{
    sy_node_t found = p->d->space;
    for (uint32_t i = 0U; i < p->a->atoms; i++) {
        if (((move->is_true >> i) & 1U) != 0U) {
            found = sy_intersection(p->d, found, atom[i]);
        }
        if (((move->is_false >> i) & 1U) != 0U) {
            found = sy_difference(p->d, found, atom[i]);
        }
    }
    return found;
}

static void add_way(product_t *p, uint32_t source, uint32_t target, sy_node_t guard, uint32_t first)
{
    if (guard == (sy_node_t)SY_NONE) {
        return;
    }
    if (source == target) {
        p->self[source] = sy_union(p->d, p->self[source], guard);
        return;
    }
    for (uint32_t i = first; i < p->ways; i++) {
        if (p->way[i].target == target) {
            p->way[i].guard = sy_union(p->d, p->way[i].guard, guard);
            return;
        }
    }
    const way_t made = { source, target, guard };
    p->way[p->ways] = made;
    p->ways++;
}

static void find_ways(product_t *p)
{
    sy_node_t *atom = tb_new((size_t)p->a->atoms + 1U, sizeof *atom);
    for (uint32_t i = 0U; i < p->a->atoms; i++) {
        atom[i] = sy_where(p->d, p->a->atom[i]);
    }
    for (uint32_t s = 0U; s < p->states; s++) {
        const uint32_t first = p->ways;
        for (uint32_t m = p->a->first[s]; m < p->a->first[s + 1U]; m++) {
            add_way(p, s, p->a->move[m].target, guard_of(p, &p->a->move[m], atom), first);
        }
    }
    tb_free(atom, (size_t)p->a->atoms + 1U, sizeof *atom);
}

/* --- steps of the product ----------------------------------------------------------------------------------------- */

static sy_node_t after(sy_diagrams_t *d, sy_node_t n)
{
    return sy_union(d, sy_intersection(d, sy_where_dead(d), n), sy_after(d, n));
}

static sy_node_t before(sy_diagrams_t *d, sy_node_t n, sy_node_t within)
{
    if ((n == (sy_node_t)SY_NONE) || (within == (sy_node_t)SY_NONE)) {
        return (sy_node_t)SY_NONE;
    }
    const sy_node_t dead = sy_intersection(d, sy_intersection(d, sy_where_dead(d), n), within);
    return sy_union(d, dead, sy_before(d, n, within));
}

/* What is new in a state, with all that its way to itself leads to. */
static sy_node_t gone_round(const product_t *p, uint32_t s, sy_node_t n)
{
    sy_diagrams_t *d = p->d;
    if (p->self[s] == d->space) {
        return sy_saturated(d, &d->forwards, n, (sy_node_t)SY_ANY);
    }
    const sy_node_t round = sy_intersection(d, n, p->self[s]);
    if (round == (sy_node_t)SY_NONE) {
        return n;
    }
    const sy_node_t all = sy_saturated(d, &d->forwards, round, p->self[s]);
    return sy_union(d, sy_union(d, n, all), after(d, all));
}

static void go_other_ways(const product_t *p, uint32_t s, sy_node_t n)
{
    sy_diagrams_t *d = p->d;
    for (uint32_t i = 0U; i < p->ways; i++) {
        const way_t *w = &p->way[i];
        if ((w->source == s) && (p->met[w->target] != d->space)) {
            const sy_node_t then = after(d, sy_intersection(d, n, w->guard));
            p->some[w->target] = sy_union(d, p->some[w->target], then);
        }
    }
}

/* Find all markings that are reached with each state: what is new in one of them is closed under its way to itself,
 * then goes the other ways. True: a state is reached that is accepting and never has to be left. */
static bool meet(const product_t *p)
{
    sy_diagrams_t *d = p->d;
    bool is_new = true;
    p->some[0] = sy_one(d, d->net->initial);
    while (is_new) {
        is_new = false;
        for (uint32_t s = 0U; s < p->states; s++) {
            sy_node_t n = sy_difference(d, p->some[s], p->met[s]);
            p->some[s] = (sy_node_t)SY_NONE;
            if (n == (sy_node_t)SY_NONE) {
                continue;
            }
            is_new = true;
            if (p->a->is_accepting[s] && (p->self[s] == d->space)) {
                return true;
            }
            n = sy_difference(d, gone_round(p, s, n), p->met[s]);
            p->met[s] = sy_union(d, p->met[s], n);
            go_other_ways(p, s, n);
        }
    }
    return false;
}

/* --- components --------------------------------------------------------------------------------------------------- */

/* The states that are reached from one, or that reach it, by ways that some marking may take. */
static void mark(const product_t *p, uint32_t from, bool is_backwards, bool *is_there)
{
    (void)memset(is_there, 0, p->states * sizeof *is_there);
    is_there[from] = true;
    bool is_more = true;
    while (is_more) {
        is_more = false;
        for (uint32_t i = 0U; i < p->ways; i++) {
            const uint32_t a = is_backwards ? p->way[i].target : p->way[i].source;
            const uint32_t b = is_backwards ? p->way[i].source : p->way[i].target;
            if (is_there[a] && !is_there[b]) {
                is_there[b] = true;
                is_more = true;
            }
        }
    }
}

/* Put in `some` the markings of what is left from which one step within the component leads to `goal`. */
static void one_step(product_t *p, const sy_node_t *goal)
{
    sy_diagrams_t *d = p->d;
    for (uint32_t s = 0U; s < p->states; s++) {
        p->some[s] = (sy_node_t)SY_NONE;
        if (p->is_in[s]) {
            p->some[s] = before(d, goal[s], sy_intersection(d, p->left[s], p->self[s]));
        }
    }
    for (uint32_t i = 0U; i < p->ways; i++) {
        const way_t *w = &p->way[i];
        if (p->is_in[w->source] && p->is_in[w->target]) {
            const sy_node_t from = sy_intersection(d, p->left[w->source], w->guard);
            p->some[w->source] = sy_union(d, p->some[w->source], before(d, goal[w->target], from));
        }
    }
}

/* Add to `some` the markings of what is left from which it is reached within the component. */
static void close_backwards(product_t *p)
{
    sy_diagrams_t *d = p->d;
    bool is_more = true;
    while (is_more) {
        is_more = false;
        for (uint32_t s = 0U; s < p->states; s++) {
            const sy_node_t within = sy_intersection(d, p->left[s], p->self[s]);
            if (p->is_in[s] && (p->some[s] != (sy_node_t)SY_NONE) && (within != (sy_node_t)SY_NONE)) {
                p->some[s] = sy_saturated(d, &d->backwards, p->some[s], within);
            }
        }
        for (uint32_t i = 0U; i < p->ways; i++) {
            const way_t *w = &p->way[i];
            if (p->is_in[w->source] && p->is_in[w->target]) {
                const sy_node_t from = sy_intersection(d, p->left[w->source], w->guard);
                const sy_node_t all = sy_union(d, p->some[w->source], before(d, p->some[w->target], from));
                is_more = is_more || (all != p->some[w->source]);
                p->some[w->source] = all;
            }
        }
    }
}

/* Whether a run is accepted that stays within the component. */
static bool is_accepted_within(product_t *p)
{
    sy_node_t *goal = tb_new(p->states, sizeof *goal);
    bool is_weak = true; /* all states are accepting: it is enough to stay */
    for (uint32_t s = 0U; s < p->states; s++) {
        is_weak = is_weak && (!p->is_in[s] || p->a->is_accepting[s]);
        p->left[s] = p->is_in[s] ? p->met[s] : (sy_node_t)SY_NONE;
    }
    bool is_found = false;
    bool is_smaller = true;
    while (is_smaller) {
        is_smaller = false;
        is_found = false;
        for (uint32_t s = 0U; s < p->states; s++) {
            goal[s] = p->a->is_accepting[s] ? p->left[s] : (sy_node_t)SY_NONE;
        }
        one_step(p, goal);
        if (!is_weak) {
            close_backwards(p);
        }
        for (uint32_t s = 0U; s < p->states; s++) {
            is_smaller = is_smaller || (p->some[s] != p->left[s]);
            is_found = is_found || (p->some[s] != (sy_node_t)SY_NONE);
            p->left[s] = p->some[s];
        }
        is_smaller = is_smaller && is_found;
    }
    tb_free(goal, p->states, sizeof *goal);
    return is_found;
}

/* Whether the component of an accepting state has a run; each component is looked at once. */
static bool is_accepted(product_t *p)
{
    bool *is_done = tb_new(p->states, sizeof *is_done);
    bool is_found = false;
    for (uint32_t s = 0U; !is_found && (s < p->states); s++) {
        if (!p->a->is_accepting[s] || is_done[s] || (p->met[s] == (sy_node_t)SY_NONE)) {
            continue;
        }
        mark(p, s, false, p->is_from);
        mark(p, s, true, p->is_to);
        for (uint32_t t = 0U; t < p->states; t++) {
            p->is_in[t] = p->is_from[t] && p->is_to[t];
            is_done[t] = is_done[t] || p->is_in[t];
        }
        is_found = is_accepted_within(p);
    }
    tb_free(is_done, p->states, sizeof *is_done);
    return is_found;
}

bool sy_accepts(sy_diagrams_t *d, const tb_automaton_t *a)
{
    if (a->states > (uint32_t)MOST_STATES) {
        sy_give_up(d);
    }
    const uint32_t n = a->states;
    const size_t moves = (size_t)a->first[n] + 1U;
    product_t p = { d,
                    a,
                    n,
                    tb_new(moves, sizeof(way_t)),
                    0U,
                    tb_new(n, sizeof(sy_node_t)),
                    tb_new(n, sizeof(sy_node_t)),
                    tb_new(n, sizeof(sy_node_t)),
                    tb_new(n, sizeof(sy_node_t)),
                    tb_new(n, sizeof(bool)),
                    tb_new(n, sizeof(bool)),
                    tb_new(n, sizeof(bool)) };
    find_ways(&p);
    const bool found = meet(&p) || is_accepted(&p);
    tb_free(p.way, moves, sizeof(way_t));
    tb_free(p.self, n, sizeof(sy_node_t));
    tb_free(p.met, n, sizeof(sy_node_t));
    tb_free(p.left, n, sizeof(sy_node_t));
    tb_free(p.some, n, sizeof(sy_node_t));
    tb_free(p.is_in, n, sizeof(bool));
    tb_free(p.is_from, n, sizeof(bool));
    tb_free(p.is_to, n, sizeof(bool));
    return found;
}
