/* SPDX-License-Identifier: MIT
 * symbolic_fire.c - what transitions make of sets: once, or again and again by saturation.
 *
 * Saturation (Ciardo, Luettgen, Siminiceanu 2001): a node is closed under all transitions that begin at its level or
 * below before its parents are looked at; a new node is closed at once. Each transition is fired only from the level
 * at which it begins. With a limit, only what lies within it is added (Zhao, Ciardo 2009).
 *
 * A node of level k that is closed stands for a set that is closed at k and below. Where an edge leaves out levels, the
 * transitions that begin there and need no token have to be fired as well: `lifted`.
 */
#include "symbolic.h"

/* Offsets to sy_events_t.op: what has been done. */
enum { CLOSED = 0, FIRED = 1, LIFTED = 2, ONCE = 3 };

static sy_node_t lifted(sy_diagrams_t *d, const sy_events_t *e, sy_node_t n, sy_node_t within, uint32_t below);

/* --- nodes in the making ------------------------------------------------------------------------------------------ */

/* The edge with so many tokens, or the place where it belongs. */
static uint64_t edge_at(const sy_diagrams_t *d, uint64_t begun, tb_count_t tokens)
{
    uint64_t low = 0U;
    uint64_t high = (d->edge_words - begun) / (uint64_t)SY_MAKING;
    while (low < high) {
        const uint64_t middle = low + ((high - low) / 2U);
        if (d->edges[begun + ((uint64_t)SY_MAKING * middle)] < tokens) {
            low = middle + 1U;
        } else {
            high = middle;
        }
    }
    return begun + ((uint64_t)SY_MAKING * low);
}

/* Add a set below the node that is made last. */
static void add(sy_diagrams_t *d, uint64_t begun, tb_count_t tokens, sy_node_t child)
{
    if (child == (sy_node_t)SY_NONE) {
        return;
    }
    const uint64_t at = edge_at(d, begun, tokens);
    if ((at < d->edge_words) && (d->edges[at] == tokens)) {
        const sy_node_t both = sy_union(d, d->edges[at + 1U], child);
        if (both != d->edges[at + 1U]) {
            d->edges[at + 1U] = both;
            d->edges[at + 2U] = 1U;
        }
        return;
    }
    sy_make_room(d);
    for (uint64_t i = d->edge_words; i > at; i--) {
        d->edges[i + (uint64_t)SY_MAKING - 1U] = d->edges[i - 1U];
    }
    d->edges[at] = tokens;
    d->edges[at + 1U] = child;
    d->edges[at + 2U] = 1U;
    d->edge_words += (uint64_t)SY_MAKING;
}

/* How many tokens there are after a step; a place that is too full ends everything. */
static tb_count_t after(const sy_step_t *s, tb_count_t tokens)
{
    const int64_t sum = (int64_t)tokens + s->change;
    if (sum > (int64_t)TB_MOST_TOKENS) {
        tb_fail(TB_EXIT_MEMORY, "a place holds too many tokens");
    }
    return (tb_count_t)sum;
}

/* --- firing ------------------------------------------------------------------------------------------------------- */

static void close_here(sy_diagrams_t *d, const sy_events_t *e, uint64_t begun, uint32_t level, sy_node_t within);
static sy_node_t closed(sy_diagrams_t *d, const sy_events_t *e, sy_node_t n, sy_node_t within);

/* Whether no marking of a node has the tokens for a step, as far as that can be seen at once. */
static bool lacks_tokens(const sy_diagrams_t *d, sy_node_t n, const sy_step_t *s)
{
    const uint32_t level = sy_level(d, n);
    const bool is_here = level == s->level;
    const tb_count_t most = is_here ? sy_tokens(d, n, sy_count(d, n) - 1U) : 0U;
    return (is_here || (level < s->level)) && (most < s->take);
}

/* With `e` the result is closed under its events up to its level; NULL: they are not fired. */
static sy_node_t fired(sy_diagrams_t *d, const sy_events_t *e, sy_node_t n, sy_node_t within, sy_path_t path);

/* The edges of the result at a level, which is that of the node or of the path. */
static void fire_edges(sy_diagrams_t *d, const sy_events_t *e, sy_node_t n, sy_node_t within, sy_path_t path,
                       uint64_t begun, uint32_t level)
{
    const sy_step_t s = d->step[path];
    const sy_step_t skip = { level, 0U, UINT32_MAX, 0, path };
    const sy_step_t *here = (s.level == level) ? &s : &skip;
    const bool is_node = sy_level(d, n) == level;
    const uint32_t count = is_node ? sy_count(d, n) : 1U;
    for (uint32_t i = 0U; i < count; i++) {
        const tb_count_t tokens = is_node ? sy_tokens(d, n, i) : 0U;
        if (!sy_permits(here, tokens)) {
            continue;
        }
        const tb_count_t then = after(here, tokens);
        const sy_node_t limit = sy_below(d, within, level, then);
        sy_node_t child = fired(d, e, is_node ? sy_child(d, n, i) : n, limit, here->rest);
        if (e != NULL) {
            child = lifted(d, e, child, limit, level);
        }
        add(d, begun, then, child);
    }
}

static sy_node_t fired(sy_diagrams_t *d, const sy_events_t *e, sy_node_t n, sy_node_t within, sy_path_t path)
{
    if (n == (sy_node_t)SY_NONE) {
        return n;
    }
    if (path == (sy_path_t)SY_END) {
        const sy_node_t rest = sy_intersection(d, n, within);
        return ((e == NULL) || (within == (sy_node_t)SY_ANY)) ? rest : closed(d, e, rest, within);
    }
    if (lacks_tokens(d, n, &d->step[path])) {
        return (sy_node_t)SY_NONE;
    }
    const uint32_t of_path = d->step[path].level;
    const uint32_t level = (sy_level(d, n) > of_path) ? sy_level(d, n) : of_path;
    within = sy_down_to(d, within, level);
    if (within == (sy_node_t)SY_NONE) {
        return within;
    }
    const uint32_t op = (e == NULL) ? (uint32_t)SY_PLAIN : ((uint32_t)e->op + (uint32_t)FIRED);
    sy_node_t found;
    if (sy_find(d, op, n, within, path, &found)) {
        return found;
    }
    const uint64_t begun = sy_begin(d);
    fire_edges(d, e, n, within, path, begun, level);
    if (e != NULL) {
        close_here(d, e, begun, level, within);
    }
    found = sy_end(d, begun, level);
    sy_note(d, op, n, within, path, found);
    return found;
}

sy_node_t sy_fire(sy_diagrams_t *d, sy_node_t n, sy_node_t within, sy_path_t path)
{
    return fired(d, NULL, n, within, path);
}

/* --- one step of all ---------------------------------------------------------------------------------------------- */

/* Add what the events of a level make of one edge of a node at that level. */
static void step_from(sy_diagrams_t *d, const sy_events_t *e, uint64_t begun, uint32_t level, sy_node_t within,
                      tb_count_t tokens, sy_node_t child)
{
    add(d, begun, tokens, sy_step_of_all(d, e, child, sy_below(d, within, level, tokens)));
    for (uint32_t i = e->first[level]; i < e->first[level + 1U]; i++) {
        const sy_step_t s = d->step[e->event[i]];
        if (sy_permits(&s, tokens)) {
            const tb_count_t then = after(&s, tokens);
            add(d, begun, then, sy_fire(d, child, sy_below(d, within, level, then), s.rest));
        }
    }
}

/* Events that begin further down leave the tokens at this level as they are: what is above is walked through once for
 * all of them. Where a set leaves out a level, only what lies in `within` may have tokens there afterwards. */
sy_node_t sy_step_of_all(sy_diagrams_t *d, const sy_events_t *e, sy_node_t n, sy_node_t within)
{
    const uint32_t level = (sy_level(d, n) > sy_level(d, within)) ? sy_level(d, n) : sy_level(d, within);
    if ((n == (sy_node_t)SY_NONE) || (within == (sy_node_t)SY_NONE) || (level == 0U)) {
        return (sy_node_t)SY_NONE;
    }
    sy_node_t found;
    if (sy_find(d, (uint32_t)e->op + (uint32_t)ONCE, n, within, 0U, &found)) {
        return found;
    }
    const uint64_t begun = sy_begin(d);
    if (sy_level(d, n) < level) {
        step_from(d, e, begun, level, within, 0U, n);
    } else {
        for (uint32_t i = 0U; i < sy_count(d, n); i++) {
            step_from(d, e, begun, level, within, sy_tokens(d, n, i), sy_child(d, n, i));
        }
    }
    found = sy_end(d, begun, level);
    sy_note(d, (uint32_t)e->op + (uint32_t)ONCE, n, within, 0U, found);
    return found;
}

/* --- closing ------------------------------------------------------------------------------------------------------ */

/* Fire all events of a level from one edge, whose tokens and child these are. */
static void fire_from(sy_diagrams_t *d, const sy_events_t *e, uint64_t begun, uint32_t level, sy_node_t within,
                      tb_count_t tokens)
{
    for (uint32_t i = e->first[level]; i < e->first[level + 1U]; i++) {
        const sy_step_t s = d->step[e->event[i]];
        if (!sy_permits(&s, tokens)) {
            continue;
        }
        const tb_count_t then = after(&s, tokens);
        const sy_node_t limit = sy_below(d, within, level, then);
        const sy_node_t child = d->edges[edge_at(d, begun, tokens) + 1U];
        add(d, begun, then, lifted(d, e, fired(d, e, child, limit, s.rest), limit, level));
    }
}

/* Close the node that is made last; its children are closed. */
static void close_here(sy_diagrams_t *d, const sy_events_t *e, uint64_t begun, uint32_t level, sy_node_t within)
{
    if (e->first[level] == e->first[level + 1U]) {
        return;
    }
    bool is_closed = false;
    while (!is_closed) {
        is_closed = true;
        for (uint64_t at = begun; at < d->edge_words; at += (uint64_t)SY_MAKING) {
            if (d->edges[at + 2U] != 0U) {
                d->edges[at + 2U] = 0U;
                is_closed = false;
                fire_from(d, e, begun, level, within, d->edges[at]);
            }
        }
    }
}

/* A closed node below a level, closed under the events of all levels between the two. */
static sy_node_t lifted(sy_diagrams_t *d, const sy_events_t *e, sy_node_t n, sy_node_t within, uint32_t below)
{
    if (n == (sy_node_t)SY_NONE) {
        return n;
    }
    uint32_t level = e->creating[sy_level(d, n) + 1U];
    while (level < below) {
        const sy_node_t limit = sy_down_to(d, within, level);
        sy_node_t found;
        if (limit == (sy_node_t)SY_NONE) { /* further up there may be one, where tokens are put */
            level = e->creating[level + 1U];
            continue;
        }
        if (!sy_find(d, (uint32_t)e->op + (uint32_t)LIFTED, n, limit, level, &found)) {
            const uint64_t begun = sy_begin(d);
            sy_put(d, 0U, n);
            close_here(d, e, begun, level, limit);
            found = sy_end(d, begun, level);
            sy_note(d, (uint32_t)e->op + (uint32_t)LIFTED, n, limit, level, found);
        }
        n = found;
        level = e->creating[level + 1U];
    }
    return n;
}

static sy_node_t closed(sy_diagrams_t *d, const sy_events_t *e, sy_node_t n, sy_node_t within)
{
    const uint32_t level = sy_level(d, n);
    within = sy_down_to(d, within, level);
    if ((level == 0U) || (within == (sy_node_t)SY_NONE)) {
        return n;
    }
    sy_node_t found;
    if (sy_find(d, (uint32_t)e->op + (uint32_t)CLOSED, n, within, 0U, &found)) {
        return found;
    }
    const uint64_t begun = sy_begin(d);
    for (uint32_t i = 0U; i < sy_count(d, n); i++) {
        const sy_node_t limit = sy_below(d, within, level, sy_tokens(d, n, i));
        const sy_node_t child = closed(d, e, sy_child(d, n, i), limit);
        sy_put(d, sy_tokens(d, n, i), lifted(d, e, child, limit, level));
    }
    close_here(d, e, begun, level, within);
    found = sy_end(d, begun, level);
    sy_note(d, (uint32_t)e->op + (uint32_t)CLOSED, n, within, 0U, found);
    return found;
}

sy_node_t sy_saturated(sy_diagrams_t *d, const sy_events_t *e, sy_node_t n, sy_node_t within)
{
    const sy_node_t found = closed(d, e, n, within);
    return lifted(d, e, found, within, d->levels + 1U);
}
