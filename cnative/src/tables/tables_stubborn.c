/* SPDX-License-Identifier: MIT
 * tables_stubborn.c - of the transitions that are enabled in a marking, those that have to be looked at.
 *
 * A stubborn set for the question whether a formula becomes true somewhere (Schmidt 1999; Bonneland, Jensen, Larsen,
 * Muniz, Srba 2019). It begins with the transitions of which one is on every way to such a marking, and is closed:
 *
 * - with an enabled transition, for each place from which it takes more than it puts: all that need tokens there,
 * - with a disabled one: for one place with too few tokens, all that put more there than they take.
 *
 * The first transition of the set on a way to the formula is then enabled here, and could occur at once: what comes
 * before it needs nothing that it takes. The rest of the way is shorter by one, so nothing is put off for ever.
 */
#include "tables.h"

void tb_stubborn_init(tb_stubborn_t *s, const tb_net_t *net)
{
    s->net = net;
    s->set = 0U;
    s->is_in = tb_new(net->transitions, sizeof *s->is_in);
    s->todo = tb_new(net->transitions, sizeof *s->todo);
    s->todo_count = 0U;
}

void tb_stubborn_free(tb_stubborn_t *s)
{
    tb_free(s->is_in, s->net->transitions, sizeof *s->is_in);
    tb_free(s->todo, s->net->transitions, sizeof *s->todo);
}

static void add(tb_stubborn_t *s, uint32_t t)
{
    if (s->is_in[t] != s->set) {
        s->is_in[t] = s->set;
        s->todo[s->todo_count] = t;
        s->todo_count++;
    }
}

/* All that change a place upwards (or downwards). */
static void add_changers(tb_stubborn_t *s, uint32_t place, bool upwards)
{
    const tb_arcs_t *changers = &s->net->changers;
    for (uint32_t i = changers->first[place]; i < changers->first[place + 1U]; i++) {
        if ((changers->arc[i].weight > 0) == upwards) {
            add(s, changers->arc[i].node);
        }
    }
}

static void add_takers(tb_stubborn_t *s, uint32_t place)
{
    for (uint32_t i = s->net->takers.first[place]; i < s->net->takers.first[place + 1U]; i++) {
        add(s, s->net->takers.arc[i].node);
    }
}

/* What there is to do for a place with too few tokens: transitions that are not yet in the set. */
static uint32_t cost_of(const tb_stubborn_t *s, uint32_t place)
{
    const tb_arcs_t *changers = &s->net->changers;
    uint32_t cost = 0U;
    for (uint32_t i = changers->first[place]; i < changers->first[place + 1U]; i++) {
        const tb_arc_t *change = &changers->arc[i];
        cost += ((change->weight > 0) && (s->is_in[change->node] != s->set)) ? 1U : 0U;
    }
    return cost;
}

/* All that can end one reason for which a transition is disabled. */
static void add_helpers(tb_stubborn_t *s, const tb_cursor_t *c, uint32_t t)
{
    const tb_arcs_t *takes = &s->net->takes;
    uint32_t best = UINT32_MAX;
    uint32_t least = UINT32_MAX;
    for (uint32_t i = takes->first[t]; (i < takes->first[t + 1U]) && (least > 0U); i++) {
        const tb_arc_t *arc = &takes->arc[i];
        if (c->marking[arc->node] < (tb_count_t)arc->weight) {
            const uint32_t cost = cost_of(s, arc->node);
            if (cost < least) {
                least = cost;
                best = arc->node;
            }
        }
    }
    if (best != UINT32_MAX) {
        add_changers(s, best, true);
    }
}

/* All that can take away what an enabled transition needs. */
static void add_thieves(tb_stubborn_t *s, uint32_t t)
{
    for (uint32_t i = s->net->takes.first[t]; i < s->net->takes.first[t + 1U]; i++) {
        add_changers(s, s->net->takes.arc[i].node, false);
    }
}

static void seed(tb_stubborn_t *s, const tb_cursor_t *c, const tb_formula_t *f, bool wanted);

static void seed_sum(tb_stubborn_t *s, const tb_formula_t *f, bool upwards)
{
    for (uint32_t i = 0U; i < f->count; i++) {
        add_changers(s, f->term[i].place, (f->term[i].factor > 0) == upwards);
    }
}

static void seed_enabled(tb_stubborn_t *s, const tb_cursor_t *c, const tb_formula_t *f, bool wanted)
{
    for (uint32_t i = 0U; i < f->count; i++) {
        const uint32_t t = f->transition[i];
        if (wanted) {
            add_helpers(s, c, t);
        } else if (tb_is_enabled(c, t)) {
            add_thieves(s, t); /* this one has to be disabled in any case */
            return;
        } else {
            /* another one is enabled */
        }
    }
}

static void seed_parts(tb_stubborn_t *s, const tb_cursor_t *c, const tb_formula_t *f, bool wanted)
{
    const bool one_suffices = (f->op == TB_AND) == wanted;
    for (uint32_t i = 0U; i < f->count; i++) {
        if (tb_holds(f->part[i], c) != wanted) {
            seed(s, c, f->part[i], wanted);
            if (one_suffices) {
                return;
            }
        }
    }
}

/* A transition of which one is on every way to a marking in which the formula, which is not as wanted, is. */
static void seed(tb_stubborn_t *s, const tb_cursor_t *c, const tb_formula_t *f, bool wanted)
{
    switch (f->op) {
    case TB_NOT: seed(s, c, f->part[0], !wanted); break;
    case TB_AND:
    case TB_OR: seed_parts(s, c, f, wanted); break;
    case TB_SUM: seed_sum(s, f, !wanted); break;
    case TB_ENABLED: seed_enabled(s, c, f, wanted); break;
    case TB_DEAD:
        if (wanted) {
            add_thieves(s, c->enabled[0]);
        }
        break;
    default: break; /* nothing makes `false` true */
    }
}

uint32_t tb_stubborn(tb_stubborn_t *s, const tb_cursor_t *c, const tb_formula_t *f, const tb_formula_t *sum,
                     uint32_t *fire)
{
    s->set++;
    s->todo_count = 0U;
    if (f != NULL) {
        seed(s, c, f, true);
    } else {
        seed_sum(s, sum, true);
    }
    uint32_t found = 0U;
    for (uint32_t i = 0U; i < s->todo_count; i++) {
        const uint32_t t = s->todo[i];
        if (!tb_is_enabled(c, t)) {
            add_helpers(s, c, t);
            continue;
        }
        fire[found] = t;
        found++;
        const tb_arcs_t *changes = &s->net->changes;
        for (uint32_t k = changes->first[t]; k < changes->first[t + 1U]; k++) {
            if (changes->arc[k].weight < 0) {
                add_takers(s, changes->arc[k].node);
            }
        }
    }
    return found;
}
