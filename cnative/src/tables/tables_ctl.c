/* SPDX-License-Identifier: MIT
 * tables_ctl.c - formulas of computation tree logic, looked at only where the answer depends on it.
 *
 * The value of a formula in a marking is worked out when it is asked for, and kept. Three operators are searches
 * (tables_ctl_exists.c, tables_ctl_always.c); the others are written with them: EF, AF, EG, AG. A path that ends in a
 * dead marking is a path: EX is false there, AX true, and AF p is p.
 *
 * A formula is asked in rounds, each with twice as many steps as the one before it. The steps are shared out: a search
 * gives only a part of its own to a value that it asks for, and goes on without it if that was not enough; so a single
 * hard value does not keep others from deciding. How large the part is, and in which order E[p U q] is searched,
 * changes from round to round. With a value that was not found it is noted how many steps were of no use, so that it is
 * not tried again with as few.
 */
#include "tables_ctl.h"

#include <string.h>

enum {
    ANSWER_BITS = 2,
    FIRST_LEVEL = 7,    /* a round of level n has two to the power of n steps */
    QUICK_LEVELS = 17,  /* all questions are asked up to this level before any is asked further */
    HIGHEST_LEVEL = 62, /* has to fit into the bits beside an answer */
    SHARES = 3
};

static const uint64_t shares[SHARES] = { 16U, 128U, 2U };

static uint8_t *value_at(tb_checker_t *c, uint32_t marking, const tb_formula_t *f)
{
    if (marking >= c->rows) {
        const uint64_t rows = (c->graph.store.records > (2U * c->rows)) ? c->graph.store.records : (2U * c->rows);
        c->value = tb_grown(c->value, c->rows * c->formulas, rows * c->formulas, 1U);
        c->rows = rows;
    }
    return &c->value[((uint64_t)marking * c->formulas) + f->number];
}

tb_answer_t tb_kept(tb_checker_t *c, uint32_t marking, const tb_formula_t *f)
{
    return (tb_answer_t)(*value_at(c, marking, f) & (uint8_t)((1U << (unsigned)ANSWER_BITS) - 1U));
}

void tb_keep(tb_checker_t *c, uint32_t marking, const tb_formula_t *f, tb_answer_t value)
{
    *value_at(c, marking, f) = (uint8_t)value;
}

static uint8_t level_of(uint64_t steps)
{
    uint8_t level = 0U;
    while ((level < (uint8_t)HIGHEST_LEVEL) && ((steps >> level) > 1U)) {
        level++;
    }
    return level;
}

bool tb_step(tb_checker_t *c)
{
    if ((c->fuel == 0U) || tb_is_over()) {
        c->fuel = 0U;
        return false;
    }
    c->fuel--;
    return true;
}

static tb_answer_t turned(tb_answer_t a)
{
    return (a == TB_UNKNOWN) ? TB_UNKNOWN : ((a == TB_YES) ? TB_NO : TB_YES);
}

static tb_answer_t of_parts(tb_checker_t *c, uint32_t marking, const tb_formula_t *f)
{
    const tb_answer_t deciding = (f->op == TB_AND) ? TB_NO : TB_YES;
    tb_answer_t result = turned(deciding);
    for (uint32_t pass = 0U; pass < 2U; pass++) { /* what is cheap first */
        for (uint32_t i = 0U; i < f->count; i++) {
            if (f->part[i]->is_temporal == (pass == 1U)) {
                const tb_answer_t part = tb_value(c, marking, f->part[i], c->fuel / (f->count - i));
                if (part == deciding) {
                    return deciding;
                }
                result = (part == TB_UNKNOWN) ? TB_UNKNOWN : result;
            }
        }
    }
    return result;
}

/* EX p (wanted: yes) or AX p (wanted: no): whether a successor has the value wanted. */
static tb_answer_t of_successors(tb_checker_t *c, uint32_t marking, const tb_formula_t *p, tb_answer_t wanted)
{
    if (!tb_expand(&c->graph, marking)) {
        return TB_UNKNOWN;
    }
    const uint32_t count = c->graph.count[marking];
    tb_answer_t result = TB_NO;
    for (uint32_t i = 0U; i < count; i++) {
        if (p->is_temporal && !tb_step(c)) {
            return TB_UNKNOWN;
        }
        const tb_answer_t a = tb_value(c, tb_successor(&c->graph, marking, i), p, c->fuel / (count - i));
        if (a == wanted) {
            return TB_YES;
        }
        result = (a == TB_UNKNOWN) ? TB_UNKNOWN : result;
    }
    return result;
}

tb_first_look_t tb_look(tb_checker_t *c, uint32_t marking, const tb_until_t *u, bool is_existential, uint64_t limit)
{
    const tb_answer_t known = tb_kept(c, marking, u->formula);
    if (known != TB_UNKNOWN) {
        return (known == TB_YES) ? TB_IS : TB_IS_NOT;
    }
    const tb_answer_t of_q = tb_value(c, marking, u->q, limit);
    const tb_answer_t q = u->is_negated ? turned(of_q) : of_q;
    if (q == TB_YES) {
        return TB_IS;
    }
    const tb_answer_t p = (u->p == NULL) ? TB_YES : tb_value(c, marking, u->p, limit);
    if ((p == TB_NO) && (q == TB_NO)) {
        return TB_IS_NOT;
    }
    if ((p == TB_YES) && (q == TB_NO)) {
        return TB_PASSES;
    }
    /* If a successor leads to q, this marking does if p holds in it, whatever q is. If a path from here never comes to
     * q, it does not either without p. */
    return (is_existential ? (p == TB_YES) : (q == TB_NO)) ? TB_MAYBE : TB_DOUBTFUL;
}

static tb_answer_t searched(tb_checker_t *c, uint32_t marking, const tb_until_t *u, bool is_existential)
{
    const tb_first_look_t first = tb_look(c, marking, u, is_existential, c->fuel / 2U);
    if ((first == TB_PASSES) || (first == TB_MAYBE)) {
        const bool is_doubtful = first == TB_MAYBE;
        return is_existential ? tb_exists_until(c, marking, u, is_doubtful)
                              : tb_always_until(c, marking, u, is_doubtful);
    }
    return (first == TB_IS) ? TB_YES : ((first == TB_IS_NOT) ? TB_NO : TB_UNKNOWN);
}

/* EG p is not AF not p, AG p is not EF not p: their table keeps the values of what is searched for. */
static tb_answer_t of_time(tb_checker_t *c, uint32_t marking, const tb_formula_t *f)
{
    const bool is_until = (f->op == TB_EU) || (f->op == TB_AU);
    const bool is_turned = (f->op == TB_EG) || (f->op == TB_AG);
    const bool is_existential = (f->op == TB_EU) || (f->op == TB_EF) || (f->op == TB_AG);
    const tb_until_t u = { f, is_until ? f->part[0] : NULL, is_until ? f->part[1] : f->part[0], is_turned };
    const uint8_t kept = *value_at(c, marking, f);
    const uint8_t level = level_of(c->fuel);
    if ((kept != 0U) && (tb_kept(c, marking, f) == TB_UNKNOWN) && (level <= (kept >> (unsigned)ANSWER_BITS))) {
        return TB_UNKNOWN; /* as few steps were not enough before */
    }
    const tb_answer_t a = searched(c, marking, &u, is_existential);
    if (a != TB_UNKNOWN) {
        tb_keep(c, marking, f, a);
    } else if (tb_kept(c, marking, f) == TB_UNKNOWN) {
        *value_at(c, marking, f) = (uint8_t)(level << (unsigned)ANSWER_BITS);
    } else {
        /* cannot be */
    }
    return is_turned ? turned(a) : a;
}

static tb_answer_t evaluated(tb_checker_t *c, uint32_t marking, const tb_formula_t *f)
{
    if (f->op >= TB_EF) {
        return of_time(c, marking, f);
    }
    const tb_answer_t known = tb_kept(c, marking, f);
    if (known != TB_UNKNOWN) {
        return known;
    }
    tb_answer_t a = TB_UNKNOWN;
    if (!f->is_temporal) {
        tb_visit(&c->graph, marking);
        a = tb_holds(f, &c->graph.cursor) ? TB_YES : TB_NO;
    } else if (f->op == TB_NOT) {
        a = turned(tb_value(c, marking, f->part[0], c->fuel));
    } else if ((f->op == TB_AND) || (f->op == TB_OR)) {
        a = of_parts(c, marking, f);
    } else if (f->op == TB_EX) {
        a = of_successors(c, marking, f->part[0], TB_YES);
    } else {
        a = turned(of_successors(c, marking, f->part[0], TB_NO));
    }
    if (a != TB_UNKNOWN) {
        tb_keep(c, marking, f, a);
    }
    return a;
}

tb_answer_t tb_value(tb_checker_t *c, uint32_t marking, const tb_formula_t *f, uint64_t limit)
{
    const uint64_t all = c->fuel;
    const uint64_t given = (limit < all) ? limit : all;
    c->fuel = given;
    const tb_answer_t a = evaluated(c, marking, f);
    c->fuel = all - (given - c->fuel);
    return a;
}

/* --- a question --------------------------------------------------------------------------------------------------- */

static void begin(tb_checker_t *c, const tb_question_t *q)
{
    c->formulas = q->formulas;
    c->rows = 1024U;
    c->value = tb_new(c->rows * c->formulas, 1U);
    c->search = tb_new(c->formulas, sizeof *c->search);
    c->graph.is_full = false;
}

static void end(tb_checker_t *c)
{
    for (uint32_t i = 0U; i < c->formulas; i++) {
        tb_search_free(&c->search[i]);
    }
    tb_free(c->search, c->formulas, sizeof *c->search);
    tb_free(c->value, c->rows * c->formulas, 1U);
}

/* In rounds of these levels, until it is answered, the time is over, or there is no more memory. */
static void answer(tb_checker_t *c, tb_question_t *q, uint32_t first, uint32_t last)
{
    begin(c, q);
    tb_answer_t a = TB_UNKNOWN;
    for (uint32_t level = first; (level <= last) && (a == TB_UNKNOWN) && !c->graph.is_full && !tb_is_over(); level++) {
        c->fuel = (uint64_t)1 << level;
        c->share = shares[level % (uint32_t)SHARES];
        c->is_nearest = (level % 2U) == 1U;
        a = tb_value(c, 0U, q->formula, c->fuel);
    }
    if (a != TB_UNKNOWN) {
        tb_say(q, a, "EXPLICIT");
    }
    end(c);
}

void tb_ctl(tb_job_t *job, uint64_t seed, double seconds)
{
    tb_checker_t c;
    (void)memset(&c, 0, sizeof c);
    tb_graph_init(&c.graph, &job->net, seed);
    for (uint32_t pass = 0U; pass < 2U; pass++) {
        uint32_t open = 0U;
        for (uint32_t i = 0U; i < job->questions; i++) {
            const tb_question_t *q = &job->question[i];
            open += ((q->kind == TB_CTL) && (q->answer == TB_UNKNOWN)) ? 1U : 0U;
        }
        const double until = (pass == 0U) ? (seconds / 2.0) : seconds;
        for (uint32_t i = 0U; i < job->questions; i++) {
            tb_question_t *q = &job->question[i];
            if ((q->kind == TB_CTL) && (q->answer == TB_UNKNOWN)) {
                const double now = tb_elapsed();
                tb_limit_time(now + ((until - now) / (double)open)); /* what one leaves over the others get */
                open--;
                answer(&c, q, (pass == 0U) ? (uint32_t)FIRST_LEVEL : ((uint32_t)QUICK_LEVELS + 1U),
                       (pass == 0U) ? (uint32_t)QUICK_LEVELS : (uint32_t)HIGHEST_LEVEL);
            }
        }
    }
    tb_graph_free(&c.graph);
}
