/* SPDX-License-Identifier: MIT
 * symbolic_always.c - the markings from which a path stays in a set for ever, or to its end: EG.
 *
 * Whatever leads within the set to a dead marking, or to a cycle, is such a marking, and saturation finds all of
 * them at once. Of the rest those are lost, again and again, from which no transition leads to another one of the
 * rest. Between, after one, two, four and so on of these steps, a cycle is looked for in the rest: from a marking on
 * to what cannot come back to it, until all that is reached can (a terminal strongly connected component of the rest).
 */
#include "symbolic.h"

enum { MOST_MOVES = 12 }; /* from one component to the next one */

/* One marking of a set, the one with the fewest tokens further up. */
static sy_node_t one_of(sy_diagrams_t *d, sy_node_t n)
{
    const uint32_t level = sy_level(d, n);
    if (level == 0U) {
        return n;
    }
    const sy_node_t child = one_of(d, sy_child(d, n, 0U));
    const uint64_t begun = sy_begin(d);
    sy_put(d, sy_tokens(d, n, 0U), child);
    return sy_end(d, begun, level);
}

/* Markings of a set on cycles within it; SY_NONE: none were found. */
static sy_node_t some_cycle(sy_diagrams_t *d, sy_node_t within)
{
    sy_node_t from = one_of(d, within);
    for (uint32_t i = 0U; i < (uint32_t)MOST_MOVES; i++) {
        const sy_node_t reached = sy_saturated(d, &d->forwards, from, within);
        const sy_node_t back = sy_saturated(d, &d->backwards, from, reached);
        const sy_node_t gone = sy_difference(d, reached, back);
        if (sy_before(d, back, back) != (sy_node_t)SY_NONE) {
            return back; /* one component, with a step within it */
        }
        if (gone == (sy_node_t)SY_NONE) {
            break;
        }
        from = one_of(d, gone);
    }
    return (sy_node_t)SY_NONE;
}

sy_node_t sy_always(sy_diagrams_t *d, sy_node_t p, bool is_any)
{
    if (p == d->space) {
        return p; /* wherever a path goes */
    }
    const sy_node_t dead = sy_intersection(d, sy_where_dead(d), p);
    if (is_any && (dead != (sy_node_t)SY_NONE)) {
        return dead;
    }
    sy_node_t found = sy_saturated(d, &d->backwards, dead, p);
    sy_node_t rest = sy_difference(d, p, found);
    uint32_t steps = 1U;
    while (rest != (sy_node_t)SY_NONE) {
        for (uint32_t i = 0U; i < steps; i++) {
            const sy_node_t kept = sy_before(d, rest, rest);
            if (kept == rest) {
                return sy_union(d, found, rest);
            }
            rest = kept;
        }
        steps = (steps < (1U << 20U)) ? (2U * steps) : steps;
        if (rest != (sy_node_t)SY_NONE) {
            const sy_node_t cycle = some_cycle(d, rest);
            if (is_any && (cycle != (sy_node_t)SY_NONE)) {
                return cycle;
            }
            const sy_node_t to_cycle = sy_saturated(d, &d->backwards, cycle, rest);
            found = sy_union(d, found, to_cycle);
            rest = sy_difference(d, rest, to_cycle);
        }
    }
    return found;
}
