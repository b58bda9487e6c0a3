/* SPDX-License-Identifier: MIT
 * tables_ctl.c - formulas of computation tree logic, looked at only where the answer depends on it.
 *
 * The value of a formula in a marking is worked out when it is asked for, and kept. Three operators are searches, depth
 * first; the others are written with them: EF, AF, EG, AG. A path that ends in a dead marking is a path: EX is false
 * there, AX true, and AF p is p.
 *
 * E[p U q]  a marking with q is looked for through markings with p. Those whose strongly connected component was left
 * in vain are false (Tarjan 1972); when q is found, all that are still open are true, since each leads to the marking
 * at which the search is. A[p U q]  a path is looked for that avoids q for ever, or meets neither p nor q before it: it
 * ends in such a marking, in a dead one, or in a marking that the search has not left yet. Then all on the path are
 * false; what the search leaves without one is true.
 *
 * If successors are missing, since memory or time has come to its end, the value is not known, and nothing is kept that
 * depends on it.
 */
#include "tables.h"

#include <string.h>

typedef struct frame {
    uint32_t marking;
    uint32_t next; /* successor */
    uint32_t low;  /* the lowest index that it leads to */
    uint32_t index;
} frame_t;

typedef struct checker {
    tb_graph_t graph;
    uint32_t formulas;
    uint8_t *value; /* marking * formulas + formula -> tb_answer_t */
    uint64_t rows;
} checker_t;

/* Frames, or numbers of markings. */
typedef struct stack {
    void *item;
    size_t size;
    uint64_t count;
    uint64_t room;
} stack_t;

static void *pushed(stack_t *s)
{
    if (s->count == s->room) {
        const uint64_t room = (s->room > 0U) ? (2U * s->room) : 256U;
        s->item = tb_grown(s->item, s->room, room, s->size);
        s->room = room;
    }
    s->count++;
    return (char *)s->item + ((s->count - 1U) * s->size);
}

static void release(stack_t *s)
{
    tb_free(s->item, s->room, s->size);
}

static uint8_t *value_of(checker_t *c, uint32_t marking, const tb_formula_t *f)
{
    if (marking >= c->rows) {
        const uint64_t rows = (c->graph.store.records > (2U * c->rows)) ? c->graph.store.records : (2U * c->rows);
        c->value = tb_grown(c->value, c->rows * c->formulas, rows * c->formulas, 1U);
        c->rows = rows;
    }
    return &c->value[((uint64_t)marking * c->formulas) + f->number];
}

static tb_answer_t evaluate(checker_t *c, uint32_t marking, const tb_formula_t *f);

static tb_answer_t turned(tb_answer_t a)
{
    return (a == TB_UNKNOWN) ? TB_UNKNOWN : ((a == TB_YES) ? TB_NO : TB_YES);
}

static tb_answer_t of_parts(checker_t *c, uint32_t marking, const tb_formula_t *f)
{
    const tb_answer_t deciding = (f->op == TB_AND) ? TB_NO : TB_YES;
    tb_answer_t result = turned(deciding);
    for (uint32_t pass = 0U; pass < 2U; pass++) { /* what is cheap first */
        for (uint32_t i = 0U; i < f->count; i++) {
            if (f->part[i]->is_temporal == (pass == 1U)) {
                const tb_answer_t part = evaluate(c, marking, f->part[i]);
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
static tb_answer_t of_successors(checker_t *c, uint32_t marking, const tb_formula_t *p, tb_answer_t wanted)
{
    bool is_known = tb_expand(&c->graph, marking);
    for (uint32_t i = 0U; is_known && (i < c->graph.count[marking]); i++) {
        const tb_answer_t a = evaluate(c, tb_successor(&c->graph, marking, i), p);
        if (a == wanted) {
            return TB_YES;
        }
        is_known = a != TB_UNKNOWN;
    }
    return is_known ? TB_NO : TB_UNKNOWN;
}

/* --- E[p U q] ----------------------------------------------------------------------------------------------------- */

typedef struct until {
    const tb_formula_t *formula;
    const tb_formula_t *p; /* NULL: true */
    const tb_formula_t *q;
    bool is_negated; /* q is wanted to be false */
} until_t;

static tb_answer_t of_q(checker_t *c, uint32_t marking, const until_t *u)
{
    const tb_answer_t a = evaluate(c, marking, u->q);
    return u->is_negated ? turned(a) : a;
}

/* What is known of a marking before its successors are looked at: TB_UNKNOWN with *is_lost false: they decide. */
static tb_answer_t at_once(checker_t *c, uint32_t marking, const until_t *u, bool *is_lost)
{
    const tb_answer_t known = (tb_answer_t)*value_of(c, marking, u->formula);
    if (known != TB_UNKNOWN) {
        return known;
    }
    const tb_answer_t q = of_q(c, marking, u);
    if (q == TB_YES) {
        return TB_YES;
    }
    const tb_answer_t p = (u->p == NULL) ? TB_YES : evaluate(c, marking, u->p);
    if ((p == TB_NO) && (q == TB_NO)) {
        return TB_NO;
    }
    *is_lost = (p == TB_UNKNOWN) || (q == TB_UNKNOWN);
    return TB_UNKNOWN;
}

/* Indices of markings that the search has met; they are kept in a table beside the values, and cleared with it. */
typedef struct met {
    uint32_t *index; /* marking -> index + 1 */
    uint64_t room;
    stack_t all; /* the markings met */
} met_t;

static uint32_t *index_of(met_t *m, const checker_t *c, uint32_t marking)
{
    if (marking >= m->room) {
        const uint64_t room = (c->graph.store.records > (2U * m->room)) ? c->graph.store.records : (2U * m->room);
        m->index = tb_grown(m->index, m->room, room, sizeof *m->index);
        m->room = room;
    }
    return &m->index[marking];
}

static void enter(checker_t *c, met_t *m, stack_t *path, stack_t *open, uint32_t marking)
{
    frame_t *f = pushed(path);
    *(uint32_t *)pushed(&m->all) = marking;
    *(uint32_t *)pushed(open) = marking;
    f->marking = marking;
    f->next = 0U;
    f->index = (uint32_t)m->all.count;
    f->low = f->index;
    *index_of(m, c, marking) = f->index;
}

static void set_all(checker_t *c, const stack_t *markings, uint64_t from, const tb_formula_t *f, tb_answer_t value)
{
    for (uint64_t i = from; i < markings->count; i++) {
        *value_of(c, ((const uint32_t *)markings->item)[i], f) = (uint8_t)value;
    }
}

/* The search for q through p. */
static tb_answer_t exists_until(checker_t *c, uint32_t from, const until_t *u)
{
    met_t met = { NULL, 0U, { NULL, sizeof(uint32_t), 0U, 0U } };
    stack_t path = { NULL, sizeof(frame_t), 0U, 0U };
    stack_t open = { NULL, sizeof(uint32_t), 0U, 0U };
    bool is_lost = false;
    bool is_found = false;
    enter(c, &met, &path, &open, from);
    while ((path.count > 0U) && !is_lost && !is_found) {
        frame_t *f = &((frame_t *)path.item)[path.count - 1U];
        is_lost = !tb_expand(&c->graph, f->marking);
        if (is_lost) {
            break;
        }
        if (f->next < c->graph.count[f->marking]) {
            const uint32_t to = tb_successor(&c->graph, f->marking, f->next);
            f->next++;
            const uint32_t index = *index_of(&met, c, to);
            if (index != 0U) {
                const bool is_open = (tb_answer_t)*value_of(c, to, u->formula) == TB_UNKNOWN;
                f->low = (is_open && (index < f->low)) ? index : f->low;
                continue;
            }
            const tb_answer_t known = at_once(c, to, u, &is_lost);
            is_found = known == TB_YES;
            if ((known == TB_UNKNOWN) && !is_lost) {
                enter(c, &met, &path, &open, to);
            }
        } else {
            const frame_t left = *f;
            path.count--;
            if (left.low == left.index) { /* a component, left in vain */
                uint64_t bottom = open.count;
                do {
                    bottom--;
                } while (((const uint32_t *)open.item)[bottom] != left.marking);
                set_all(c, &open, bottom, u->formula, TB_NO);
                open.count = bottom;
            }
            if (path.count > 0U) {
                frame_t *above = &((frame_t *)path.item)[path.count - 1U];
                above->low = (left.low < above->low) ? left.low : above->low;
            }
        }
    }
    if (is_found) {
        set_all(c, &open, 0U, u->formula, TB_YES);
    }
    tb_free(met.index, met.room, sizeof *met.index);
    release(&met.all);
    release(&path);
    release(&open);
    return is_lost ? TB_UNKNOWN : (is_found ? TB_YES : TB_NO);
}

/* --- A[p U q] ----------------------------------------------------------------------------------------------------- */

/* The search for a path that never comes to q through p. */
static tb_answer_t always_until(checker_t *c, uint32_t from, const until_t *u)
{
    met_t met = { NULL, 0U, { NULL, sizeof(uint32_t), 0U, 0U } };
    stack_t path = { NULL, sizeof(frame_t), 0U, 0U };
    stack_t on_path = { NULL, sizeof(uint32_t), 0U, 0U };
    bool is_lost = false;
    bool is_avoided = false;
    enter(c, &met, &path, &on_path, from);
    while ((path.count > 0U) && !is_lost && !is_avoided) {
        frame_t *f = &((frame_t *)path.item)[path.count - 1U];
        is_lost = !tb_expand(&c->graph, f->marking);
        if (is_lost) {
            break;
        }
        is_avoided = c->graph.count[f->marking] == 0U; /* it ends here, without q */
        if (!is_avoided && (f->next < c->graph.count[f->marking])) {
            const uint32_t to = tb_successor(&c->graph, f->marking, f->next);
            f->next++;
            const tb_answer_t known = at_once(c, to, u, &is_lost);
            if ((known == TB_UNKNOWN) && !is_lost) {
                if (*index_of(&met, c, to) != 0U) {
                    is_avoided = true; /* it is on the path: what was left is known */
                } else {
                    enter(c, &met, &path, &on_path, to);
                }
            }
            is_avoided = is_avoided || (known == TB_NO);
        } else if (!is_avoided) {
            *value_of(c, f->marking, u->formula) = (uint8_t)TB_YES;
            path.count--;
            on_path.count--;
        } else {
            /* the path is complete */
        }
    }
    if (is_avoided) {
        set_all(c, &on_path, 0U, u->formula, TB_NO);
    }
    tb_free(met.index, met.room, sizeof *met.index);
    release(&met.all);
    release(&path);
    release(&on_path);
    return is_lost ? TB_UNKNOWN : (is_avoided ? TB_NO : TB_YES);
}

/* --- all operators ------------------------------------------------------------------------------------------------ */

static tb_answer_t searched(checker_t *c, uint32_t marking, const until_t *u, bool is_existential)
{
    bool is_lost = false;
    const tb_answer_t known = at_once(c, marking, u, &is_lost);
    if ((known != TB_UNKNOWN) || is_lost) {
        return known;
    }
    return is_existential ? exists_until(c, marking, u) : always_until(c, marking, u);
}

/* EG p is not AF not p, AG p is not EF not p: their table keeps the values of what is searched for. */
static tb_answer_t of_time(checker_t *c, uint32_t marking, const tb_formula_t *f)
{
    const bool is_until = (f->op == TB_EU) || (f->op == TB_AU);
    const bool is_turned = (f->op == TB_EG) || (f->op == TB_AG);
    const bool is_existential = (f->op == TB_EU) || (f->op == TB_EF) || (f->op == TB_AG);
    const until_t u = { f, is_until ? f->part[0] : NULL, is_until ? f->part[1] : f->part[0], is_turned };
    const tb_answer_t a = searched(c, marking, &u, is_existential);
    if (a != TB_UNKNOWN) {
        *value_of(c, marking, f) = (uint8_t)a;
    }
    return is_turned ? turned(a) : a;
}

static tb_answer_t evaluate(checker_t *c, uint32_t marking, const tb_formula_t *f)
{
    if (f->op >= TB_EF) {
        return of_time(c, marking, f);
    }
    const tb_answer_t known = (tb_answer_t)*value_of(c, marking, f);
    if (known != TB_UNKNOWN) {
        return known;
    }
    tb_answer_t a = TB_UNKNOWN;
    if (!f->is_temporal) {
        tb_visit(&c->graph, marking);
        a = tb_holds(f, &c->graph.cursor) ? TB_YES : TB_NO;
    } else if (f->op == TB_NOT) {
        a = turned(evaluate(c, marking, f->part[0]));
    } else if ((f->op == TB_AND) || (f->op == TB_OR)) {
        a = of_parts(c, marking, f);
    } else if (f->op == TB_EX) {
        a = of_successors(c, marking, f->part[0], TB_YES);
    } else {
        a = turned(of_successors(c, marking, f->part[0], TB_NO));
    }
    *value_of(c, marking, f) = (uint8_t)a;
    return a;
}

void tb_ctl(tb_job_t *job, uint64_t seed, double seconds)
{
    uint32_t open = 0U;
    for (uint32_t i = 0U; i < job->questions; i++) {
        open += (job->question[i].kind == TB_CTL) ? 1U : 0U;
    }
    checker_t c;
    (void)memset(&c, 0, sizeof c);
    tb_graph_init(&c.graph, &job->net, seed);
    for (uint32_t i = 0U; i < job->questions; i++) {
        tb_question_t *q = &job->question[i];
        if (q->kind != TB_CTL) {
            continue;
        }
        tb_limit_time(tb_elapsed()
                      + ((seconds - tb_elapsed()) / (double)open)); /* what one leaves over the others get */
        open--;
        c.formulas = q->formulas;
        c.rows = 1024U;
        c.value = tb_new(c.rows * c.formulas, 1U);
        c.graph.is_full = false;
        const tb_answer_t a = evaluate(&c, 0U, q->formula);
        if (a != TB_UNKNOWN) {
            tb_say(q, a, "EXPLICIT");
        }
        tb_free(c.value, c.rows * c.formulas, 1U);
    }
    tb_graph_free(&c.graph);
}
