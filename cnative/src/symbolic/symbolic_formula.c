/* SPDX-License-Identifier: MIT
 * symbolic_formula.c - the reachable markings in which a formula holds.
 *
 * A path that ends in a dead marking is a path: EX is false there, and EG p is p. E[p U q] is what saturation backwards
 * from q finds within p; EG: symbolic_always.c.
 */
#include "symbolic.h"

#include <stdlib.h>

/* --- sums --------------------------------------------------------------------------------------------------------- */

typedef struct term {
    uint32_t level;
    int64_t factor;
    int64_t least; /* of this term and those below it */
    int64_t most;
} term_t;

typedef struct sum {
    term_t *term; /* the highest level first; one more at the end, with level 0 */
    uint32_t number;
} sum_t;

static int from_above(const void *a, const void *b)
{
    const term_t *left = a;
    const term_t *right = b;
    return (left->level < right->level) - (left->level > right->level);
}

/* One term for each level; false: the sum is too large for a number. */
static bool order_terms(const sy_diagrams_t *d, const tb_formula_t *f, term_t *term)
{
    uint32_t count = 0U;
    bool is_small = true;
    for (uint32_t i = 0U; i < f->count; i++) {
        const term_t t = { d->level[f->term[i].place], f->term[i].factor, 0, 0 };
        term[i] = t;
    }
    qsort(term, f->count, sizeof *term, from_above);
    for (uint32_t i = 0U; i < f->count; i++) {
        if ((count > 0U) && (term[count - 1U].level == term[i].level)) {
            term[count - 1U].factor += term[i].factor;
        } else {
            term[count] = term[i];
            count++;
        }
    }
    const term_t end = { 0U, 0, 0, 0 };
    term[count] = end;
    for (uint32_t i = count; i > 0U; i--) {
        term_t *t = &term[i - 1U];
        int64_t all;
        is_small = is_small && !__builtin_mul_overflow(t->factor, (int64_t)d->most[t->level], &all)
                   && !__builtin_add_overflow(term[i].least, (all < 0) ? all : 0, &t->least)
                   && !__builtin_add_overflow(term[i].most, (all > 0) ? all : 0, &t->most);
    }
    return is_small;
}

/* The markings below a node in which the sum of the terms from here on is at most `limit`. */
static sy_node_t at_most(sy_diagrams_t *d, const sum_t *s, sy_node_t n, uint32_t which, int64_t limit)
{
    const term_t *t = &s->term[which];
    if ((n == (sy_node_t)SY_NONE) || (limit < t->least)) {
        return (sy_node_t)SY_NONE;
    }
    if (limit >= t->most) {
        return n;
    }
    const uint32_t level = sy_level(d, n);
    if (level < t->level) {
        return at_most(d, s, n, which + 1U, limit);
    }
    if ((limit > INT32_MAX) || (limit < INT32_MIN)) {
        sy_give_up(d);
    }
    sy_node_t found;
    if (sy_find(d, s->number, n, which, (uint32_t)(int32_t)limit, &found)) {
        return found;
    }
    const bool is_here = level == t->level;
    const uint64_t begun = sy_begin(d);
    for (uint32_t i = 0U; i < sy_count(d, n); i++) {
        const int64_t left = is_here ? (limit - (t->factor * (int64_t)sy_tokens(d, n, i))) : limit;
        sy_put(d, sy_tokens(d, n, i), at_most(d, s, sy_child(d, n, i), is_here ? (which + 1U) : which, left));
    }
    found = sy_end(d, begun, level);
    sy_note(d, s->number, n, which, (uint32_t)(int32_t)limit, found);
    return found;
}

sy_node_t sy_where_sum(sy_diagrams_t *d, const tb_formula_t *f, sy_node_t within)
{
    sum_t s = { tb_new((size_t)f->count + 1U, sizeof(term_t)), (uint32_t)SY_SUM + d->sums };
    d->sums++;
    if (!order_terms(d, f, s.term)) {
        sy_give_up(d);
    }
    const sy_node_t found = at_most(d, &s, within, 0U, f->limit);
    tb_free(s.term, (size_t)f->count + 1U, sizeof(term_t));
    return found;
}

/* --- transitions -------------------------------------------------------------------------------------------------- */

static sy_node_t other(sy_diagrams_t *d, sy_node_t n)
{
    return sy_difference(d, d->space, n);
}

static sy_node_t where_enabled(sy_diagrams_t *d, const tb_formula_t *f)
{
    return other(d, sy_where_none(d, f->transition, f->count, d->space));
}

/* None of all transitions is enabled, or none of those that change nothing. */
static sy_node_t where_none_of(sy_diagrams_t *d, bool is_of_idle)
{
    const size_t room = (size_t)d->net->transitions + 1U;
    uint32_t *chosen = tb_new(room, sizeof *chosen);
    uint32_t count = 0U;
    for (uint32_t t = 0U; t < d->net->transitions; t++) {
        if (!is_of_idle || (d->net->changes.first[t] == d->net->changes.first[t + 1U])) {
            chosen[count] = t;
            count++;
        }
    }
    const sy_node_t found = sy_where_none(d, chosen, count, d->space);
    tb_free(chosen, room, sizeof *chosen);
    return found;
}

sy_node_t sy_where_dead(sy_diagrams_t *d)
{
    if (d->dead == (sy_node_t)SY_ANY) {
        d->dead = where_none_of(d, false);
    }
    return d->dead;
}

static sy_node_t where_idle(sy_diagrams_t *d)
{
    if (d->idle == (sy_node_t)SY_ANY) {
        d->idle = other(d, where_none_of(d, true));
    }
    return d->idle;
}

sy_node_t sy_before(sy_diagrams_t *d, sy_node_t n, sy_node_t within)
{
    const sy_node_t stays = sy_intersection(d, sy_intersection(d, n, within), where_idle(d));
    return sy_union(d, stays, sy_step_of_all(d, &d->backwards, n, within));
}

sy_node_t sy_after(sy_diagrams_t *d, sy_node_t n)
{
    return sy_union(d, sy_intersection(d, n, where_idle(d)), sy_step_of_all(d, &d->forwards, n, d->space));
}

/* --- time --------------------------------------------------------------------------------------------------------- */

static sy_node_t exists_until(sy_diagrams_t *d, sy_node_t p, sy_node_t q)
{
    return sy_saturated(d, &d->backwards, q, p);
}

/* If the initial marking is a home marking, each marking leads to all others. It is tried once: should time be over
 * meanwhile, it is as if it were not so. */
static bool is_home(sy_diagrams_t *d)
{
    if (d->home == SY_NOT_TRIED) {
        d->home = SY_NOT_HOME;
        const sy_node_t start = sy_one(d, d->net->initial);
        d->home = (exists_until(d, d->space, start) == d->space) ? SY_HOME : SY_NOT_HOME;
    }
    return d->home == SY_HOME;
}

/* The markings from which one of a set is reachable. */
static sy_node_t leads_to(sy_diagrams_t *d, sy_node_t n)
{
    if ((n == (sy_node_t)SY_NONE) || (n == d->space)) {
        return n;
    }
    return is_home(d) ? d->space : exists_until(d, d->space, n);
}

static sy_node_t always_until(sy_diagrams_t *d, sy_node_t p, sy_node_t q)
{
    const sy_node_t not_q = other(d, q);
    const sy_node_t neither = sy_difference(d, not_q, p);
    return other(d, sy_union(d, exists_until(d, not_q, neither), sy_always(d, not_q, false)));
}

static sy_node_t where_temporal(sy_diagrams_t *d, const tb_formula_t *f)
{
    const sy_node_t p = sy_where(d, f->part[0]);
    switch (f->op) {
    case TB_EX: return sy_before(d, p, d->space);
    case TB_AX: return other(d, sy_before(d, other(d, p), d->space));
    case TB_EF: return leads_to(d, p);
    case TB_AF: return other(d, sy_always(d, other(d, p), false));
    case TB_EG: return sy_always(d, p, false);
    case TB_AG: return other(d, leads_to(d, other(d, p)));
    case TB_EU: return exists_until(d, p, sy_where(d, f->part[1]));
    case TB_AU: return always_until(d, p, sy_where(d, f->part[1]));
    default: tb_fail(TB_EXIT_WRONG, "operator %d is none of time", (int)f->op);
    }
}

static sy_node_t where_parts(sy_diagrams_t *d, const tb_formula_t *f)
{
    sy_node_t found = (f->op == TB_AND) ? d->space : (sy_node_t)SY_NONE;
    for (uint32_t i = 0U; i < f->count; i++) {
        const sy_node_t part = sy_where(d, f->part[i]);
        found = (f->op == TB_AND) ? sy_intersection(d, found, part) : sy_union(d, found, part);
    }
    return found;
}

sy_node_t sy_where(sy_diagrams_t *d, const tb_formula_t *f)
{
    switch (f->op) {
    case TB_TRUE: return d->space;
    case TB_FALSE: return (sy_node_t)SY_NONE;
    case TB_NOT: return other(d, sy_where(d, f->part[0]));
    case TB_AND:
    case TB_OR: return where_parts(d, f);
    case TB_SUM: return sy_where_sum(d, f, d->space);
    case TB_ENABLED: return where_enabled(d, f);
    case TB_DEAD: return sy_where_dead(d);
    default: return where_temporal(d, f);
    }
}
