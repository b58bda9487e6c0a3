/* SPDX-License-Identifier: MIT
 * tables_ctl_always.c - A[p U q]: a path is looked for that avoids q for ever, or meets neither p nor q before it.
 *
 * It ends in such a marking, in a dead one, or in a marking that the search has not left yet. Then all on the path are
 * false; what the search leaves without one is true, if everything that it led to is known.
 */
#include "tables_ctl.h"

/* All on the path. */
static tb_answer_t avoided(tb_checker_t *c, const tb_search_t *s, const tb_until_t *u)
{
    for (uint32_t i = 0U; i < s->path_count; i++) {
        tb_keep(c, s->path[i].marking, u->formula, TB_NO);
    }
    return TB_NO;
}

static void leave(tb_checker_t *c, tb_search_t *s, const tb_until_t *u)
{
    s->path_count--;
    s->open_count--;
    const tb_frame_t left = s->path[s->path_count];
    *tb_met(c, s, left.marking) = TB_LEFT;
    if (!left.is_doubtful) {
        tb_keep(c, left.marking, u->formula, TB_YES);
    } else if (s->path_count > 0U) {
        s->path[s->path_count - 1U].is_doubtful = true;
    } else {
        /* it was the first one */
    }
}

static tb_answer_t searched(tb_checker_t *c, tb_search_t *s, uint32_t from, const tb_until_t *u, bool is_doubtful)
{
    const uint64_t limit = c->fuel / c->share;
    tb_enter(c, s, from, is_doubtful);
    while (s->path_count > 0U) {
        tb_frame_t *f = &s->path[s->path_count - 1U];
        if (!tb_expand(&c->graph, f->marking)) {
            return TB_UNKNOWN;
        }
        const uint32_t count = c->graph.count[f->marking];
        if (count == 0U) { /* it ends here, without q */
            return avoided(c, s, u);
        }
        if (f->next == count) {
            leave(c, s, u);
            continue;
        }
        if (!tb_step(c)) {
            return TB_UNKNOWN;
        }
        const uint32_t to = tb_successor(&c->graph, f->marking, f->next);
        f->next++;
        const uint32_t met = *tb_met(c, s, to);
        if ((met != 0U) && (met != TB_LEFT)) { /* it is on the path */
            return avoided(c, s, u);
        }
        const bool is_lost = (met == TB_LEFT) && (tb_kept(c, to, u->formula) == TB_UNKNOWN);
        const tb_first_look_t first = is_lost ? TB_DOUBTFUL : tb_look(c, to, u, false, limit);
        if (first == TB_IS_NOT) {
            return avoided(c, s, u);
        }
        f->is_doubtful = f->is_doubtful || (first == TB_DOUBTFUL);
        if ((first == TB_PASSES) || (first == TB_MAYBE)) {
            tb_enter(c, s, to, first == TB_MAYBE); /* `f` may have moved */
        }
    }
    return (tb_kept(c, from, u->formula) == TB_YES) ? TB_YES : TB_UNKNOWN;
}

tb_answer_t tb_always_until(tb_checker_t *c, uint32_t from, const tb_until_t *u, bool is_doubtful)
{
    tb_search_t *s = &c->search[u->formula->number];
    const tb_answer_t a = searched(c, s, from, u, is_doubtful);
    tb_search_end(s);
    return a;
}
