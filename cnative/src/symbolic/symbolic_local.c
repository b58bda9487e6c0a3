/* SPDX-License-Identifier: MIT
 * symbolic_local.c - whether a formula of branching time holds in the initial marking, looking at no more of the
 * reachable markings than the formula does.
 *
 * A formula is asked in some markings only, those of `care`. Its parts are asked where paths from there can come to:
 * those of EX in the next markings, those of EG p and E[p U q] in what is reached through p. What must hold of p in
 * one marking is known of all markings, and bounds where paths go before p itself is asked. If `care` is one marking,
 * all that is reached is reached from it, and nothing has to be looked for backwards.
 */
#include "symbolic.h"

typedef struct local {
    sy_diagrams_t *d;
    sy_node_t *where; /* number of a formula without time -> the reachable markings with it; SY_ANY: not asked yet */
} local_t;

/* A formula or the opposite. */
typedef struct literal {
    const tb_formula_t *f;
    bool is_not;
} literal_t;

static sy_node_t holds(const local_t *l, const tb_formula_t *f, sy_node_t care);

static sy_node_t everywhere(const local_t *l, const tb_formula_t *f)
{
    if (l->where[f->number] == (sy_node_t)SY_ANY) {
        l->where[f->number] = sy_where(l->d, f);
    }
    return l->where[f->number];
}

static sy_node_t other(const local_t *l, sy_node_t n)
{
    return sy_difference(l->d, l->d->space, n);
}

/* All reachable markings with a literal are among these: what its form says of one marking. */
static sy_node_t bound(const local_t *l, literal_t p)
{
    const tb_formula_t *f = p.f;
    sy_diagrams_t *d = l->d;
    if (!f->is_temporal) {
        return p.is_not ? other(l, everywhere(l, f)) : everywhere(l, f);
    }
    const literal_t first = { f->part[0], (f->op == TB_NOT) ? !p.is_not : p.is_not };
    switch (f->op) {
    case TB_NOT: return bound(l, first);
    case TB_AND:
    case TB_OR: {
        const bool is_and = (f->op == TB_AND) != p.is_not;
        sy_node_t found = is_and ? d->space : (sy_node_t)SY_NONE;
        for (uint32_t i = 0U; i < f->count; i++) {
            const literal_t part = { f->part[i], p.is_not };
            found = is_and ? sy_intersection(d, found, bound(l, part)) : sy_union(d, found, bound(l, part));
        }
        return found;
    }
    case TB_EG:
    case TB_AG: return p.is_not ? d->space : bound(l, first);
    case TB_EF:
    case TB_AF: return p.is_not ? bound(l, first) : d->space;
    case TB_EU:
    case TB_AU: {
        const literal_t second = { f->part[1], p.is_not };
        return p.is_not ? bound(l, second) : sy_union(d, bound(l, first), bound(l, second));
    }
    default: return d->space;
    }
}

static sy_node_t where(const local_t *l, literal_t p, sy_node_t care)
{
    const sy_node_t found = holds(l, p.f, care);
    return p.is_not ? sy_difference(l->d, care, found) : found;
}

static bool is_one(const sy_diagrams_t *d, sy_node_t n)
{
    while ((sy_level(d, n) > 0U) && (sy_count(d, n) == 1U)) {
        n = sy_child(d, n, 0U);
    }
    return n == (sy_node_t)SY_UNIT;
}

static sy_node_t reached(const local_t *l, sy_node_t from, sy_node_t within)
{
    const bool is_all = within == l->d->space;
    return sy_saturated(l->d, &l->d->forwards, from, is_all ? (sy_node_t)SY_ANY : within);
}

/* What is reached through p from some markings, themselves with p. */
static sy_node_t through(const local_t *l, literal_t p, sy_node_t from, sy_node_t limit)
{
    sy_node_t found = reached(l, sy_intersection(l->d, from, limit), limit);
    if (p.f->is_temporal) {
        const sy_node_t with = where(l, p, found);
        found = reached(l, sy_intersection(l->d, from, with), with);
    }
    return found;
}

static sy_node_t may_step(const local_t *l, literal_t p, sy_node_t care)
{
    return sy_before(l->d, where(l, p, sy_after(l->d, care)), care);
}

static sy_node_t exists_finally(const local_t *l, literal_t q, sy_node_t care)
{
    const sy_node_t region = reached(l, care, l->d->space);
    const sy_node_t good = where(l, q, region);
    if ((good == (sy_node_t)SY_NONE) || is_one(l->d, care)) {
        return (good == (sy_node_t)SY_NONE) ? good : care;
    }
    return sy_intersection(l->d, care, sy_saturated(l->d, &l->d->backwards, good, region));
}

/* E[p U q and also] */
static sy_node_t exists_until(const local_t *l, literal_t p, literal_t q, const literal_t *also, sy_node_t care)
{
    sy_diagrams_t *d = l->d;
    sy_node_t found = where(l, q, care);
    found = (also == NULL) ? found : where(l, *also, found);
    const sy_node_t rest = sy_difference(d, care, found);
    sy_node_t limit = bound(l, p);
    if (!q.f->is_temporal && (also == NULL)) {
        limit = sy_difference(d, limit, bound(l, q)); /* paths end where q holds */
    }
    const sy_node_t region = through(l, p, rest, limit);
    sy_node_t good = where(l, q, sy_after(d, region));
    good = (also == NULL) ? good : where(l, *also, good);
    if (good == (sy_node_t)SY_NONE) {
        return found;
    }
    if (is_one(d, rest)) {
        return care;
    }
    const sy_node_t back = sy_saturated(d, &d->backwards, sy_before(d, good, region), region);
    return sy_union(d, found, sy_intersection(d, rest, back));
}

static sy_node_t exists_always(const local_t *l, literal_t p, sy_node_t care)
{
    const sy_node_t region = through(l, p, care, bound(l, p));
    if (is_one(l->d, care)) {
        return (sy_always(l->d, region, true) == (sy_node_t)SY_NONE) ? (sy_node_t)SY_NONE : care;
    }
    return sy_intersection(l->d, care, sy_always(l->d, region, false));
}

/* Not A[p U q]: a path without q comes to neither p nor q, or never ends. */
static sy_node_t not_always_until(const local_t *l, const tb_formula_t *f, sy_node_t care)
{
    const literal_t not_p = { f->part[0], true };
    const literal_t not_q = { f->part[1], true };
    const sy_node_t found = exists_until(l, not_q, not_p, &not_q, care);
    return sy_union(l->d, found, exists_always(l, not_q, sy_difference(l->d, care, found)));
}

static sy_node_t temporal(const local_t *l, const tb_formula_t *f, sy_node_t care)
{
    const literal_t p = { f->part[0], false };
    const literal_t not_p = { f->part[0], true };
    const literal_t q = { f->part[(f->op == TB_EU) ? 1U : 0U], false };
    switch (f->op) {
    case TB_EX: return may_step(l, p, care);
    case TB_AX: return sy_difference(l->d, care, may_step(l, not_p, care));
    case TB_EF: return exists_finally(l, p, care);
    case TB_AG: return sy_difference(l->d, care, exists_finally(l, not_p, care));
    case TB_EG: return exists_always(l, p, care);
    case TB_AF: return sy_difference(l->d, care, exists_always(l, not_p, care));
    case TB_EU: return exists_until(l, p, q, NULL, care);
    case TB_AU: return sy_difference(l->d, care, not_always_until(l, f, care));
    default: tb_fail(TB_EXIT_WRONG, "operator %d is none of time", (int)f->op);
    }
}

static sy_node_t parts(const local_t *l, const tb_formula_t *f, sy_node_t care)
{
    sy_node_t left = care; /* where the parts so far do not decide */
    for (uint32_t i = 0U; (i < f->count) && (left != (sy_node_t)SY_NONE); i++) {
        const literal_t part = { f->part[i], f->op == TB_OR };
        left = where(l, part, left);
    }
    return (f->op == TB_AND) ? left : sy_difference(l->d, care, left);
}

static sy_node_t holds(const local_t *l, const tb_formula_t *f, sy_node_t care)
{
    sy_diagrams_t *d = l->d;
    if ((care == (sy_node_t)SY_NONE) || (care == d->space)) {
        return (care == d->space) ? sy_where(d, f) : care;
    }
    switch (f->op) {
    case TB_TRUE: return care;
    case TB_FALSE: return (sy_node_t)SY_NONE;
    case TB_NOT: return sy_difference(d, care, holds(l, f->part[0], care));
    case TB_AND:
    case TB_OR: return parts(l, f, care);
    case TB_SUM: return sy_where_sum(d, f, care);
    case TB_ENABLED: return sy_difference(d, care, sy_where_none(d, f->transition, f->count, care));
    case TB_DEAD: return sy_intersection(d, care, sy_where_dead(d));
    default: return temporal(l, f, care);
    }
}

bool sy_holds_at_first(sy_diagrams_t *d, const tb_formula_t *f, sy_node_t *known)
{
    const local_t l = { d, known };
    return holds(&l, f, sy_one(d, d->net->initial)) != (sy_node_t)SY_NONE;
}
