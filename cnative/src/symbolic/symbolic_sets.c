/* SPDX-License-Identifier: MIT
 * symbolic_sets.c - sets of markings: union, intersection, difference.
 */
#include "symbolic.h"

/* The edges of a node as they are at a level that is not below it: a node that is lower has one, without tokens. */
typedef struct edges {
    sy_node_t node;
    bool is_here;
    uint32_t count;
    uint32_t next;
} edges_t;

static edges_t edges_at(const sy_diagrams_t *d, sy_node_t n, uint32_t level)
{
    const bool is_here = sy_level(d, n) == level;
    const edges_t e = { n, is_here, is_here ? sy_count(d, n) : 1U, 0U };
    return e;
}

/* UINT64_MAX: there is no edge left. */
static uint64_t next_tokens(const sy_diagrams_t *d, const edges_t *e)
{
    if (e->next == e->count) {
        return UINT64_MAX;
    }
    return e->is_here ? sy_tokens(d, e->node, e->next) : 0U;
}

static sy_node_t next_child(const sy_diagrams_t *d, edges_t *e)
{
    const sy_node_t child = e->is_here ? sy_child(d, e->node, e->next) : e->node;
    e->next++;
    return child;
}

static sy_node_t combined(sy_diagrams_t *d, sy_op_t op, sy_node_t a, sy_node_t b);

static sy_node_t by_edges(sy_diagrams_t *d, sy_op_t op, sy_node_t a, sy_node_t b)
{
    const uint32_t level = (sy_level(d, a) > sy_level(d, b)) ? sy_level(d, a) : sy_level(d, b);
    edges_t left = edges_at(d, a, level);
    edges_t right = edges_at(d, b, level);
    const uint64_t begun = sy_begin(d);
    for (;;) {
        const uint64_t l = next_tokens(d, &left);
        const uint64_t r = next_tokens(d, &right);
        const uint64_t tokens = (l < r) ? l : r;
        if (tokens == UINT64_MAX) {
            break;
        }
        const sy_node_t of_left = (l == tokens) ? next_child(d, &left) : (sy_node_t)SY_NONE;
        const sy_node_t of_right = (r == tokens) ? next_child(d, &right) : (sy_node_t)SY_NONE;
        sy_put(d, (tb_count_t)tokens, combined(d, op, of_left, of_right));
    }
    return sy_end(d, begun, level);
}

static sy_node_t combined(sy_diagrams_t *d, sy_op_t op, sy_node_t a, sy_node_t b)
{
    const bool is_union = op == SY_UNION;
    if (a == b) {
        return (op == SY_DIFFERENCE) ? (sy_node_t)SY_NONE : a;
    }
    if (a == (sy_node_t)SY_NONE) {
        return is_union ? b : (sy_node_t)SY_NONE;
    }
    if (b == (sy_node_t)SY_NONE) {
        return (op == SY_INTERSECTION) ? (sy_node_t)SY_NONE : a;
    }
    if ((op != SY_DIFFERENCE) && (a > b)) {
        const sy_node_t c = a;
        a = b;
        b = c;
    }
    sy_node_t found;
    if (sy_find(d, (uint32_t)op, a, b, 0U, &found)) {
        return found;
    }
    found = by_edges(d, op, a, b);
    sy_note(d, (uint32_t)op, a, b, 0U, found);
    return found;
}

sy_node_t sy_union(sy_diagrams_t *d, sy_node_t a, sy_node_t b)
{
    return combined(d, SY_UNION, a, b);
}

sy_node_t sy_intersection(sy_diagrams_t *d, sy_node_t a, sy_node_t b)
{
    return (b == (sy_node_t)SY_ANY) ? a : combined(d, SY_INTERSECTION, a, b);
}

sy_node_t sy_difference(sy_diagrams_t *d, sy_node_t a, sy_node_t b)
{
    return combined(d, SY_DIFFERENCE, a, b);
}

sy_node_t sy_one(sy_diagrams_t *d, const tb_count_t *marking)
{
    sy_node_t n = (sy_node_t)SY_UNIT;
    for (uint32_t level = 1U; level <= d->levels; level++) {
        const uint64_t begun = sy_begin(d);
        sy_put(d, marking[d->place[level]], n);
        n = sy_end(d, begun, level);
    }
    return n;
}

bool sy_contains(const sy_diagrams_t *d, sy_node_t n, const tb_count_t *marking)
{
    for (uint32_t level = d->levels; (level > 0U) && (n != (sy_node_t)SY_NONE); level--) {
        n = sy_below(d, n, level, marking[d->place[level]]);
    }
    return n == (sy_node_t)SY_UNIT;
}
