/* SPDX-License-Identifier: MIT
 * tables_cursor.c - a marking, and what is enabled in it.
 *
 * For each transition the input places with too few tokens are counted. When a place changes, only the transitions that
 * need tokens there are looked at; so a step costs what it changes, however large the net is.
 */
#include "tables.h"

#include <string.h>

static void enable(tb_cursor_t *c, uint32_t t)
{
    c->position[t] = c->enabled_count;
    c->enabled[c->enabled_count] = t;
    c->enabled_count++;
}

static void disable(tb_cursor_t *c, uint32_t t)
{
    const uint32_t at = c->position[t];
    c->enabled_count--;
    const uint32_t last = c->enabled[c->enabled_count];
    c->enabled[at] = last;
    c->position[last] = at;
    c->position[t] = UINT32_MAX;
}

void tb_cursor_init(tb_cursor_t *c, const tb_net_t *net)
{
    c->net = net;
    c->marking = tb_new(net->places, sizeof *c->marking);
    c->missing = tb_new(net->transitions, sizeof *c->missing);
    c->enabled = tb_new(net->transitions, sizeof *c->enabled);
    c->position = tb_new(net->transitions, sizeof *c->position);
    c->enabled_count = 0U;
    for (uint32_t t = 0U; t < net->transitions; t++) {
        c->missing[t] = net->takes.first[t + 1U] - net->takes.first[t];
        c->position[t] = UINT32_MAX;
        if (c->missing[t] == 0U) {
            enable(c, t);
        }
    }
    tb_go_to(c, net->initial);
}

void tb_cursor_free(tb_cursor_t *c)
{
    tb_free(c->marking, c->net->places, sizeof *c->marking);
    tb_free(c->missing, c->net->transitions, sizeof *c->missing);
    tb_free(c->enabled, c->net->transitions, sizeof *c->enabled);
    tb_free(c->position, c->net->transitions, sizeof *c->position);
}

void tb_set(tb_cursor_t *c, uint32_t place, tb_count_t tokens)
{
    const tb_arcs_t *takers = &c->net->takers;
    const tb_count_t before = c->marking[place];
    c->marking[place] = tokens;
    for (uint32_t i = takers->first[place]; i < takers->first[place + 1U]; i++) {
        const tb_arc_t *arc = &takers->arc[i];
        const bool was = before >= (tb_count_t)arc->weight;
        const bool is = tokens >= (tb_count_t)arc->weight;
        if (was && !is) {
            if (c->missing[arc->node] == 0U) {
                disable(c, arc->node);
            }
            c->missing[arc->node]++;
        } else if (!was && is) {
            c->missing[arc->node]--;
            if (c->missing[arc->node] == 0U) {
                enable(c, arc->node);
            }
        }
    }
}

void tb_go_to(tb_cursor_t *c, const tb_count_t *marking)
{
    for (uint32_t p = 0U; p < c->net->places; p++) {
        if (c->marking[p] != marking[p]) {
            tb_set(c, p, marking[p]);
        }
    }
}

/* Whether no place gets more tokens than there may be. */
static bool fits(const tb_cursor_t *c, uint32_t transition)
{
    const tb_arcs_t *changes = &c->net->changes;
    for (uint32_t i = changes->first[transition]; i < changes->first[transition + 1U]; i++) {
        const tb_arc_t *change = &changes->arc[i];
        if (((int64_t)c->marking[change->node] + change->weight) > (int64_t)TB_MOST_TOKENS) {
            return false;
        }
    }
    return true;
}

static void add_changes(tb_cursor_t *c, uint32_t transition, int64_t sign)
{
    const tb_arcs_t *changes = &c->net->changes;
    for (uint32_t i = changes->first[transition]; i < changes->first[transition + 1U]; i++) {
        const tb_arc_t *change = &changes->arc[i];
        c->marking[change->node] = (tb_count_t)((int64_t)c->marking[change->node] + (sign * change->weight));
    }
}

bool tb_move(tb_cursor_t *c, uint32_t transition)
{
    if (!fits(c, transition)) {
        return false;
    }
    add_changes(c, transition, 1);
    return true;
}

void tb_unmove(tb_cursor_t *c, uint32_t transition)
{
    add_changes(c, transition, -1);
}

bool tb_fire(tb_cursor_t *c, uint32_t transition)
{
    const tb_arcs_t *changes = &c->net->changes;
    if (!fits(c, transition)) {
        return false;
    }
    for (uint32_t i = changes->first[transition]; i < changes->first[transition + 1U]; i++) {
        const tb_arc_t *change = &changes->arc[i];
        tb_set(c, change->node, (tb_count_t)((int64_t)c->marking[change->node] + change->weight));
    }
    return true;
}

void tb_unfire(tb_cursor_t *c, uint32_t transition)
{
    const tb_arcs_t *changes = &c->net->changes;
    for (uint32_t i = changes->first[transition]; i < changes->first[transition + 1U]; i++) {
        const tb_arc_t *change = &changes->arc[i];
        tb_set(c, change->node, (tb_count_t)((int64_t)c->marking[change->node] - change->weight));
    }
}

int64_t tb_sum(const tb_formula_t *sum, const tb_count_t *marking)
{
    int64_t total = 0;
    for (uint32_t i = 0U; i < sum->count; i++) {
        total += sum->term[i].factor * (int64_t)marking[sum->term[i].place];
    }
    return total;
}

/* A transition of a coloured net may have very many bindings; what is enabled may be the shorter list. */
static bool one_is_enabled(const tb_formula_t *f, const tb_cursor_t *c)
{
    if ((f->is_one != NULL) && (c->enabled_count < f->count)) {
        for (uint32_t i = 0U; i < c->enabled_count; i++) {
            const uint32_t t = c->enabled[i];
            if (((f->is_one[t / 64U] >> (t % 64U)) & 1U) != 0U) {
                return true;
            }
        }
        return false;
    }
    for (uint32_t i = 0U; i < f->count; i++) {
        if (tb_is_enabled(c, f->transition[i])) {
            return true;
        }
    }
    return false;
}

bool tb_holds(const tb_formula_t *f, const tb_cursor_t *c)
{
    switch (f->op) {
    case TB_TRUE: return true;
    case TB_NOT: return !tb_holds(f->part[0], c);
    case TB_AND:
        for (uint32_t i = 0U; i < f->count; i++) {
            if (!tb_holds(f->part[i], c)) {
                return false;
            }
        }
        return true;
    case TB_OR:
        for (uint32_t i = 0U; i < f->count; i++) {
            if (tb_holds(f->part[i], c)) {
                return true;
            }
        }
        return false;
    case TB_SUM: return tb_sum(f, c->marking) <= f->limit;
    case TB_ENABLED: return one_is_enabled(f, c);
    case TB_DEAD: return c->enabled_count == 0U;
    default: return false;
    }
}
