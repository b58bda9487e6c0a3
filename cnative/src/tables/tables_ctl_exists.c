/* SPDX-License-Identifier: MIT
 * tables_ctl_exists.c - E[p U q]: a marking with q is looked for through markings with p.
 *
 * Depth first: markings whose strongly connected component was left in vain are false (Tarjan 1972), if nothing that is
 * not known was met on the way; when q is found, all that are still open are true, since each leads to the marking at
 * which the search is. Nearest first: when q is found, the way to it is true; if all was seen, and all was known,
 * everything met is false.
 */
#include "tables_ctl.h"

/* The topmost component is complete: false, or not known. */
static void close_component(tb_checker_t *c, tb_search_t *s, const tb_frame_t *left, const tb_until_t *u)
{
    uint32_t marking;
    do {
        s->open_count--;
        marking = s->open[s->open_count];
        if (left->is_doubtful) {
            *tb_met(c, s, marking) = TB_LEFT;
        } else {
            tb_keep(c, marking, u->formula, TB_NO);
        }
    } while (marking != left->marking);
}

static void leave(tb_checker_t *c, tb_search_t *s, const tb_until_t *u)
{
    s->path_count--;
    const tb_frame_t left = s->path[s->path_count];
    if (left.low == left.index) {
        close_component(c, s, &left, u);
    }
    if (s->path_count > 0U) {
        tb_frame_t *above = &s->path[s->path_count - 1U];
        above->low = (left.low < above->low) ? left.low : above->low;
        above->is_doubtful = above->is_doubtful || left.is_doubtful;
    }
}

static tb_answer_t depth_first(tb_checker_t *c, tb_search_t *s, uint32_t from, const tb_until_t *u, bool is_doubtful)
{
    const uint64_t limit = c->fuel / c->share;
    tb_enter(c, s, from, is_doubtful);
    while (s->path_count > 0U) {
        tb_frame_t *f = &s->path[s->path_count - 1U];
        if (!tb_expand(&c->graph, f->marking)) {
            return TB_UNKNOWN;
        }
        if (f->next == c->graph.count[f->marking]) {
            leave(c, s, u);
            continue;
        }
        if (!tb_step(c)) {
            return TB_UNKNOWN;
        }
        const uint32_t to = tb_successor(&c->graph, f->marking, f->next);
        f->next++;
        const uint32_t met = *tb_met(c, s, to);
        if (met == TB_LEFT) {
            f->is_doubtful = true;
        } else if (met != 0U) {
            const bool is_open = tb_kept(c, to, u->formula) == TB_UNKNOWN;
            f->low = (is_open && (met < f->low)) ? met : f->low;
        } else {
            const tb_first_look_t first = tb_look(c, to, u, true, limit);
            if (first == TB_IS) {
                for (uint32_t i = 0U; i < s->open_count; i++) {
                    tb_keep(c, s->open[i], u->formula, TB_YES);
                }
                return TB_YES;
            }
            f->is_doubtful = f->is_doubtful || (first == TB_DOUBTFUL);
            if ((first == TB_PASSES) || (first == TB_MAYBE)) {
                tb_enter(c, s, to, first == TB_MAYBE); /* `f` may have moved */
            }
        }
    }
    return (tb_kept(c, from, u->formula) == TB_NO) ? TB_NO : TB_UNKNOWN;
}

static void wait_for(tb_checker_t *c, tb_search_t *s, uint32_t marking, uint32_t from, const tb_until_t *u)
{
    tb_visit(&c->graph, marking);
    const double distance = tb_distance(u->q, &c->graph.cursor, !u->is_negated);
    tb_heap_push(&s->heap, distance, tb_meet(c, s, marking, from) - 1U);
}

static tb_answer_t nearest_first(tb_checker_t *c, tb_search_t *s, uint32_t from, const tb_until_t *u, bool is_doubtful)
{
    const uint64_t limit = c->fuel / c->share;
    wait_for(c, s, from, 0U, u);
    while (s->heap.count > 0U) {
        const uint32_t number = tb_heap_pop(&s->heap);
        const uint32_t marking = s->all[number].marking;
        if (!tb_expand(&c->graph, marking)) {
            return TB_UNKNOWN;
        }
        const uint32_t count = c->graph.count[marking];
        for (uint32_t i = 0U; i < count; i++) {
            const uint32_t to = tb_successor(&c->graph, marking, i);
            if (!tb_step(c)) {
                return TB_UNKNOWN;
            }
            if (*tb_met(c, s, to) != 0U) {
                continue;
            }
            const tb_first_look_t first = tb_look(c, to, u, true, limit);
            if (first == TB_IS) {
                for (uint32_t at = number; at > 0U; at = s->all[at].from) {
                    tb_keep(c, s->all[at].marking, u->formula, TB_YES);
                }
                return TB_YES;
            }
            if ((first == TB_PASSES) || (first == TB_MAYBE)) {
                wait_for(c, s, to, number, u);
            }
            is_doubtful = is_doubtful || (first == TB_MAYBE) || (first == TB_DOUBTFUL);
        }
    }
    for (uint32_t i = 0U; !is_doubtful && (i < s->all_count); i++) {
        tb_keep(c, s->all[i].marking, u->formula, TB_NO);
    }
    return is_doubtful ? TB_UNKNOWN : TB_NO;
}

tb_answer_t tb_exists_until(tb_checker_t *c, uint32_t from, const tb_until_t *u, bool is_doubtful)
{
    tb_search_t *s = &c->search[u->formula->number];
    const tb_answer_t a =
        c->is_nearest ? nearest_first(c, s, from, u, is_doubtful) : depth_first(c, s, from, u, is_doubtful);
    tb_search_end(s);
    return a;
}
