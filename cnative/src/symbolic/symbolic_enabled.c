/* SPDX-License-Identifier: MIT
 * symbolic_enabled.c - the reachable markings in which none of some transitions is enabled.
 *
 * Each transition is looked at only from the level of the highest place in which it needs tokens, as in saturation:
 * what lies further up is walked through once for all of them, not once for each.
 */
#include "symbolic.h"

/* The markings of a node in which the places of a path do not all hold what it needs. */
static sy_node_t without(sy_diagrams_t *d, sy_node_t n, sy_path_t path)
{
    if ((path == (sy_path_t)SY_END) || (n == (sy_node_t)SY_NONE)) {
        return (sy_node_t)SY_NONE;
    }
    const sy_step_t s = d->step[path];
    const uint32_t level = sy_level(d, n);
    if (level < s.level) {
        return n; /* no tokens there */
    }
    sy_node_t found;
    if (sy_find(d, (uint32_t)SY_WITHOUT, n, path, 0U, &found)) {
        return found;
    }
    const uint64_t begun = sy_begin(d);
    for (uint32_t i = 0U; i < sy_count(d, n); i++) {
        const sy_node_t child = sy_child(d, n, i);
        const tb_count_t tokens = sy_tokens(d, n, i);
        if (level > s.level) {
            sy_put(d, tokens, without(d, child, path));
        } else {
            sy_put(d, tokens, (tokens >= s.take) ? without(d, child, s.rest) : child);
        }
    }
    found = sy_end(d, begun, level);
    sy_note(d, (uint32_t)SY_WITHOUT, n, path, 0U, found);
    return found;
}

typedef struct tests {
    sy_path_t *path; /* of the transitions, by the level at which they begin */
    uint32_t *first; /* level -> the first of them; one level more */
    uint32_t number; /* of the operation */
} tests_t;

static sy_node_t without_all(sy_diagrams_t *d, const tests_t *e, sy_node_t n)
{
    const uint32_t level = sy_level(d, n);
    sy_node_t found;
    if (level == 0U) {
        return n;
    }
    if (sy_find(d, e->number, n, 0U, 0U, &found)) {
        return found;
    }
    const uint64_t begun = sy_begin(d);
    for (uint32_t i = 0U; i < sy_count(d, n); i++) {
        const tb_count_t tokens = sy_tokens(d, n, i);
        sy_node_t child = without_all(d, e, sy_child(d, n, i));
        for (uint32_t k = e->first[level]; k < e->first[level + 1U]; k++) {
            const sy_step_t s = d->step[e->path[k]];
            child = (tokens >= s.take) ? without(d, child, s.rest) : child;
        }
        sy_put(d, tokens, child);
    }
    found = sy_end(d, begun, level);
    sy_note(d, e->number, n, 0U, 0U, found);
    return found;
}

sy_node_t sy_where_none(sy_diagrams_t *d, const uint32_t *transition, uint32_t count, sy_node_t within)
{
    const size_t levels = (size_t)d->levels + 3U;
    tests_t e = { tb_new((size_t)count + 1U, sizeof *e.path), tb_new(levels, sizeof *e.first),
                  (uint32_t)SY_SUM + d->sums };
    sy_node_t found = within;
    d->sums++;
    for (uint32_t i = 0U; i < count; i++) {
        const sy_path_t path = d->test[transition[i]];
        if (path == (sy_path_t)SY_END) {
            found = (sy_node_t)SY_NONE; /* it is always enabled */
        } else {
            e.first[d->step[path].level + 2U]++;
        }
    }
    for (uint32_t level = 0U; level <= d->levels; level++) {
        e.first[level + 2U] += e.first[level + 1U];
    }
    for (uint32_t i = 0U; i < count; i++) {
        const sy_path_t path = d->test[transition[i]];
        if (path != (sy_path_t)SY_END) {
            const uint32_t level = d->step[path].level;
            e.path[e.first[level + 1U]] = path;
            e.first[level + 1U]++;
        }
    }
    if (found != (sy_node_t)SY_NONE) {
        found = without_all(d, &e, found);
    }
    tb_free(e.path, (size_t)count + 1U, sizeof *e.path);
    tb_free(e.first, levels, sizeof *e.first);
    return found;
}
