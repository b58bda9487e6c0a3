/* SPDX-License-Identifier: MIT
 * tables_distance.c - how far a marking is from one in which a formula is true: a guess that leads a search.
 *
 * Of a comparison it is what is missing to the limit, of `enabled` the tokens that are missing; of a conjunction the
 * sum; of an operator of time it is the distance from what it speaks of, or is to come to.
 */
#include "tables.h"

static double missing_tokens(const tb_cursor_t *c, uint32_t t)
{
    double sum = 0.0;
    for (uint32_t i = c->net->takes.first[t]; i < c->net->takes.first[t + 1U]; i++) {
        const tb_arc_t *arc = &c->net->takes.arc[i];
        const int64_t lacking = (int64_t)arc->weight - (int64_t)c->marking[arc->node];
        sum += (lacking > 0) ? (double)lacking : 0.0;
    }
    return sum;
}

/* Of very many transitions only some, evenly spread: the guess is worse, but costs no more than a step. */
static double enabled_distance(const tb_formula_t *f, const tb_cursor_t *c, bool wanted)
{
    double best = wanted ? 1e18 : 0.0;
    const uint32_t stride = (f->count > (uint32_t)TB_FEW) ? (f->count / (uint32_t)TB_FEW) : 1U;
    for (uint32_t i = 0U; i < f->count; i += stride) {
        const double d = missing_tokens(c, f->transition[i]);
        if (wanted) {
            best = (d < best) ? d : best;
        } else {
            best += (d > 0.0) ? 0.0 : 1.0;
        }
    }
    return best;
}

static double sum_distance(const tb_formula_t *f, const tb_cursor_t *c, bool wanted)
{
    const int64_t over = tb_sum(f, c->marking) - f->limit;
    if (wanted) {
        return (over > 0) ? (double)over : 0.0;
    }
    return (over > 0) ? 0.0 : (double)(1 - over);
}

static double parts_distance(const tb_formula_t *f, const tb_cursor_t *c, bool wanted)
{
    const bool all = (f->op == TB_AND) == wanted;
    double total = all ? 0.0 : 1e18;
    for (uint32_t i = 0U; i < f->count; i++) {
        const double d = tb_distance(f->part[i], c, wanted);
        total = all ? (total + d) : ((d < total) ? d : total);
    }
    return total;
}

bool tb_counts_enabled(const tb_formula_t *f)
{
    if (f->op == TB_DEAD) {
        return true;
    }
    const bool has_parts = (f->op != TB_SUM) && (f->op != TB_ENABLED) && (f->op != TB_TRUE) && (f->op != TB_FALSE);
    for (uint32_t i = 0U; has_parts && (i < f->count); i++) {
        if (tb_counts_enabled(f->part[i])) {
            return true;
        }
    }
    return false;
}

double tb_distance(const tb_formula_t *f, const tb_cursor_t *c, bool wanted)
{
    switch (f->op) {
    case TB_NOT: return tb_distance(f->part[0], c, !wanted);
    case TB_AND:
    case TB_OR: return parts_distance(f, c, wanted);
    case TB_SUM: return sum_distance(f, c, wanted);
    case TB_ENABLED: return enabled_distance(f, c, wanted);
    case TB_DEAD: return wanted ? (double)c->enabled_count : ((c->enabled_count == 0U) ? 1.0 : 0.0);
    case TB_TRUE: return wanted ? 0.0 : 1e18;
    case TB_FALSE: return wanted ? 1e18 : 0.0;
    default: return tb_distance(f->part[f->count - 1U], c, wanted);
    }
}
