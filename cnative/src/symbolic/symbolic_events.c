/* SPDX-License-Identifier: MIT
 * symbolic_events.c - transitions as paths down the levels that they look at or change; equal ends are one.
 *
 * Backwards a transition takes what it puts, and puts what it takes.
 */
#include "symbolic.h"

#include <stdlib.h>
#include <string.h>

/* What a transition does with one place. */
typedef struct effect {
    uint32_t level;
    tb_count_t take;
    tb_count_t put;
} effect_t;

typedef struct effects {
    effect_t *of;
    uint32_t count;
    uint32_t *index; /* level -> its index in `of`, where that is one of this level */
} effects_t;

static int by_level(const void *a, const void *b)
{
    const effect_t *left = a;
    const effect_t *right = b;
    return (left->level > right->level) - (left->level < right->level);
}

static effect_t *effect_on(effects_t *e, uint32_t level)
{
    const uint32_t known = e->index[level];
    if ((known < e->count) && (e->of[known].level == level)) {
        return &e->of[known];
    }
    e->index[level] = e->count;
    const effect_t empty = { level, 0U, 0U };
    e->of[e->count] = empty;
    e->count++;
    return &e->of[e->count - 1U];
}

/* By levels, the lowest first. */
static void collect(const sy_diagrams_t *d, uint32_t t, effects_t *e)
{
    const tb_net_t *net = d->net;
    e->count = 0U;
    for (uint32_t i = net->takes.first[t]; i < net->takes.first[t + 1U]; i++) {
        effect_on(e, d->level[net->takes.arc[i].node])->take += (tb_count_t)net->takes.arc[i].weight;
    }
    for (uint32_t i = net->puts.first[t]; i < net->puts.first[t + 1U]; i++) {
        effect_on(e, d->level[net->puts.arc[i].node])->put += (tb_count_t)net->puts.arc[i].weight;
    }
    qsort(e->of, e->count, sizeof *e->of, by_level);
}

/* --- paths -------------------------------------------------------------------------------------------------------- */

typedef struct paths {
    sy_diagrams_t *d;
    sy_path_t *slot;
    uint32_t slots; /* a power of two */
} paths_t;

static uint32_t slot_of(const paths_t *p, const sy_step_t *s)
{
    uint64_t h = ((uint64_t)s->level * 0x9E3779B97F4A7C15U) ^ s->take;
    h = (h * 0x9E3779B97F4A7C15U) ^ s->most;
    h = (h * 0x9E3779B97F4A7C15U) ^ (uint64_t)s->change;
    h = (h * 0x9E3779B97F4A7C15U) ^ s->rest;
    h *= 0x9E3779B97F4A7C15U;
    return (uint32_t)(h >> 32U) & (p->slots - 1U);
}

static sy_path_t step(paths_t *p, sy_step_t s)
{
    sy_diagrams_t *d = p->d;
    uint32_t at = slot_of(p, &s);
    while (p->slot[at] != 0U) {
        const sy_step_t *known = &d->step[p->slot[at]];
        if ((known->level == s.level) && (known->take == s.take) && (known->most == s.most)
            && (known->change == s.change) && (known->rest == s.rest)) {
            return p->slot[at];
        }
        at = (at + 1U) & (p->slots - 1U);
    }
    d->step[d->steps] = s;
    p->slot[at] = d->steps;
    d->steps++;
    return p->slot[at];
}

typedef enum direction { FORWARDS, BACKWARDS, TEST } direction_t;

static sy_path_t path(paths_t *p, const effects_t *e, direction_t direction)
{
    sy_path_t rest = (sy_path_t)SY_END;
    for (uint32_t i = 0U; i < e->count; i++) {
        const effect_t *f = &e->of[i];
        const int64_t change = (direction == TEST) ? 0 : ((int64_t)f->put - (int64_t)f->take);
        const tb_count_t take = (direction == BACKWARDS) ? f->put : f->take;
        if ((take > 0U) || (change != 0)) {
            const tb_count_t most = (sy_exact(p->d, f->level) != NULL) ? take : UINT32_MAX;
            const sy_step_t s = { f->level, take, most, (direction == BACKWARDS) ? -change : change, rest };
            rest = step(p, s);
        }
    }
    return rest;
}

static bool changes_something(const sy_diagrams_t *d, sy_path_t path)
{
    bool found = false;
    for (sy_path_t p = path; p != (sy_path_t)SY_END; p = d->step[p].rest) {
        found = found || (d->step[p].change != 0);
    }
    return found;
}

/* --- events by level ---------------------------------------------------------------------------------------------- */

static void sort_events(sy_diagrams_t *d, sy_events_t *e, sy_op_t op)
{
    const uint32_t transitions = d->net->transitions;
    bool *is_known = tb_new(d->steps, sizeof *is_known);
    e->op = op;
    e->event = tb_new((size_t)transitions + 1U, sizeof *e->event);
    e->first = tb_new((size_t)d->levels + 3U, sizeof *e->first);
    e->creating = tb_new((size_t)d->levels + 3U, sizeof *e->creating);
    for (uint32_t pass = 0U; pass < 2U; pass++) { /* how many at each level; then which */
        (void)memset(is_known, 0, d->steps * sizeof *is_known);
        for (uint32_t t = 0U; t < transitions; t++) {
            const sy_path_t p = e->path[t];
            if (!is_known[p] && changes_something(d, p)) {
                is_known[p] = true;
                const uint32_t level = d->step[p].level;
                if (pass == 0U) {
                    e->first[level + 2U]++;
                } else {
                    e->event[e->first[level + 1U]] = p;
                    e->first[level + 1U]++;
                }
            }
        }
        for (uint32_t level = 0U; (pass == 0U) && (level <= d->levels); level++) {
            e->first[level + 2U] += e->first[level + 1U];
        }
    }
    tb_free(is_known, d->steps, sizeof *is_known);
    e->creating[d->levels + 1U] = d->levels + 1U;
    for (uint32_t level = d->levels; level > 0U; level--) {
        e->creating[level] = e->creating[level + 1U];
        for (uint32_t i = e->first[level]; i < e->first[level + 1U]; i++) {
            e->creating[level] = (d->step[e->event[i]].take == 0U) ? level : e->creating[level];
        }
    }
}

void sy_make_events(sy_diagrams_t *d)
{
    const tb_net_t *net = d->net;
    const size_t arcs = (size_t)net->takes.first[net->transitions] + net->puts.first[net->transitions];
    effects_t e = { tb_new((size_t)net->places + 1U, sizeof(effect_t)), 0U,
                    tb_new((size_t)net->places + 1U, sizeof(uint32_t)) };
    paths_t p = { d, NULL, 16U };
    while (p.slots < (6U * arcs)) {
        p.slots *= 2U;
    }
    p.slot = tb_new(p.slots, sizeof *p.slot);
    d->step = tb_new((3U * arcs) + 1U, sizeof *d->step);
    d->steps = 1U;
    d->test = tb_new((size_t)net->transitions + 1U, sizeof *d->test);
    d->forwards.path = tb_new((size_t)net->transitions + 1U, sizeof(sy_path_t));
    d->backwards.path = tb_new((size_t)net->transitions + 1U, sizeof(sy_path_t));
    for (uint32_t t = 0U; t < net->transitions; t++) {
        collect(d, t, &e);
        d->test[t] = path(&p, &e, TEST);
        d->forwards.path[t] = path(&p, &e, FORWARDS);
        d->backwards.path[t] = path(&p, &e, BACKWARDS);
    }
    tb_free(p.slot, p.slots, sizeof *p.slot);
    tb_free(e.of, (size_t)net->places + 1U, sizeof(effect_t));
    tb_free(e.index, (size_t)net->places + 1U, sizeof(uint32_t));
    sort_events(d, &d->forwards, SY_SATURATION);
    sort_events(d, &d->backwards, (sy_op_t)((uint32_t)SY_SATURATION + 4U));
}
