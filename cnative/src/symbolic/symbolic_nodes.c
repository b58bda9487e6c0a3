/* SPDX-License-Identifier: MIT
 * symbolic_nodes.c - nodes, each of which there is once, and results that are remembered as long as there is room.
 */
#include "symbolic.h"

#include <string.h>

enum { HEADER = 2, FIRST_NODE = 4, FIRST_SLOTS = 1 << 12, FIRST_RESULTS = 1 << 14, MOST_RESULTS = 1 << 25 };

_Noreturn void sy_give_up(sy_diagrams_t *d)
{
    longjmp(d->given_up, 1);
}

void sy_init(sy_diagrams_t *d, const tb_net_t *net, const uint32_t *order)
{
    d->net = net;
    d->levels = net->places;
    d->place = tb_new((size_t)net->places + 2U, sizeof *d->place);
    d->level = tb_new((size_t)net->places + 1U, sizeof *d->level);
    for (uint32_t i = 0U; i < net->places; i++) {
        const uint32_t place = (order != NULL) ? order[i] : i;
        d->place[net->places - i] = place;
        d->level[place] = net->places - i;
    }
    d->room = 1U << 16U;
    d->pool = tb_new(d->room, sizeof *d->pool); /* the constants look like nodes at level 0 */
    d->words = (uint64_t)FIRST_NODE;
    d->slots = (uint64_t)FIRST_SLOTS;
    d->slot = tb_new(d->slots, sizeof *d->slot);
    d->results = (uint64_t)FIRST_RESULTS;
    d->result = tb_new(d->results, sizeof *d->result);
    d->edge_room = 1U << 12U;
    d->edges = tb_new(d->edge_room, sizeof *d->edges);
    d->dead = (sy_node_t)SY_ANY;
    d->idle = (sy_node_t)SY_ANY;
}

/* --- looking at nodes --------------------------------------------------------------------------------------------- */

sy_node_t sy_below(const sy_diagrams_t *d, sy_node_t n, uint32_t level, tb_count_t tokens)
{
    if ((n == (sy_node_t)SY_ANY) || (n == (sy_node_t)SY_NONE)) {
        return n;
    }
    if (sy_level(d, n) < level) {
        return (tokens == 0U) ? n : (sy_node_t)SY_NONE;
    }
    uint32_t low = 0U;
    uint32_t high = sy_count(d, n);
    while (low < high) {
        const uint32_t middle = low + ((high - low) / 2U);
        if (sy_tokens(d, n, middle) < tokens) {
            low = middle + 1U;
        } else {
            high = middle;
        }
    }
    return ((low < sy_count(d, n)) && (sy_tokens(d, n, low) == tokens)) ? sy_child(d, n, low) : (sy_node_t)SY_NONE;
}

sy_node_t sy_down_to(const sy_diagrams_t *d, sy_node_t n, uint32_t level)
{
    while (sy_level(d, n) > level) {
        n = (sy_tokens(d, n, 0U) == 0U) ? sy_child(d, n, 0U) : (sy_node_t)SY_NONE;
    }
    return n;
}

/* --- making nodes ------------------------------------------------------------------------------------------------- */

uint64_t sy_begin(const sy_diagrams_t *d)
{
    return d->edge_words;
}

void sy_make_room(sy_diagrams_t *d)
{
    if ((d->edge_words + (uint64_t)SY_MAKING) > d->edge_room) {
        d->edges = tb_grown(d->edges, d->edge_room, 2U * d->edge_room, sizeof *d->edges);
        d->edge_room *= 2U;
    }
}

void sy_put(sy_diagrams_t *d, tb_count_t tokens, sy_node_t child)
{
    if (child != (sy_node_t)SY_NONE) {
        sy_make_room(d);
        d->edges[d->edge_words] = tokens;
        d->edges[d->edge_words + 1U] = child;
        d->edges[d->edge_words + 2U] = 1U;
        d->edge_words += (uint64_t)SY_MAKING;
    }
}

static uint64_t mixed(uint64_t hash, uint32_t word)
{
    const uint64_t h = (hash ^ word) * 0x9E3779B97F4A7C15U;
    return h ^ (h >> 29U);
}

static uint64_t hash_of(const uint32_t *node)
{
    uint64_t hash = node[0];
    for (uint32_t i = 0U; i < (node[1] * (uint32_t)SY_EDGE); i++) {
        hash = mixed(hash, node[(uint32_t)HEADER + i]);
    }
    return mixed(hash, node[1]);
}

static void grow_slots(sy_diagrams_t *d)
{
    sy_node_t *slot = tb_new(2U * d->slots, sizeof *slot);
    tb_free(d->slot, d->slots, sizeof *d->slot);
    d->slot = slot;
    d->slots *= 2U;
    uint64_t n = (uint64_t)FIRST_NODE;
    while (n < d->words) {
        uint64_t at = hash_of(&d->pool[n]) & (d->slots - 1U);
        while (slot[at] != 0U) {
            at = (at + 1U) & (d->slots - 1U);
        }
        slot[at] = (sy_node_t)n;
        n += (uint64_t)HEADER + ((uint64_t)SY_EDGE * d->pool[n + 1U]);
    }
}

static void grow_pool(sy_diagrams_t *d, uint64_t words)
{
    if (words > d->room) {
        uint64_t room = d->room + (d->room / 2U);
        room = (room < words) ? words : room;
        if (room > UINT32_MAX) {
            tb_fail(TB_EXIT_MEMORY, "there are too many nodes");
        }
        d->pool = tb_grown(d->pool, d->room, room, sizeof *d->pool);
        d->room = room;
    }
}

/* The node that stands at the end of the pool, or the one that is equal to it. */
static sy_node_t only_one(sy_diagrams_t *d, uint64_t words)
{
    const uint32_t *made = &d->pool[d->words];
    uint64_t at = hash_of(made) & (d->slots - 1U);
    while (d->slot[at] != 0U) {
        if (memcmp(&d->pool[d->slot[at]], made, words * sizeof *made) == 0) {
            return d->slot[at];
        }
        at = (at + 1U) & (d->slots - 1U);
    }
    const sy_node_t n = (sy_node_t)d->words;
    d->slot[at] = n;
    d->words += words;
    d->nodes++;
    if ((2U * d->nodes) > d->slots) {
        grow_slots(d);
    }
    return n;
}

sy_node_t sy_end(sy_diagrams_t *d, uint64_t begun, uint32_t level)
{
    const uint64_t count = (d->edge_words - begun) / (uint64_t)SY_MAKING;
    d->edge_words = begun;
    if (tb_is_over()) {
        sy_give_up(d);
    }
    if (count == 0U) {
        return (sy_node_t)SY_NONE;
    }
    if ((count == 1U) && (d->edges[begun] == 0U)) {
        return d->edges[begun + 1U];
    }
    /* memcmp may read as many words of another node as this one has */
    const uint64_t words = (uint64_t)HEADER + ((uint64_t)SY_EDGE * count);
    grow_pool(d, d->words + words);
    uint32_t *made = &d->pool[d->words];
    made[0] = level;
    made[1] = (uint32_t)count;
    for (uint64_t i = 0U; i < count; i++) {
        made[(uint64_t)HEADER + ((uint64_t)SY_EDGE * i)] = d->edges[begun + ((uint64_t)SY_MAKING * i)];
        made[(uint64_t)HEADER + ((uint64_t)SY_EDGE * i) + 1U] = d->edges[begun + ((uint64_t)SY_MAKING * i) + 1U];
    }
    return only_one(d, words);
}

/* --- results ------------------------------------------------------------------------------------------------------ */

static uint64_t result_at(const sy_diagrams_t *d, uint32_t op, uint32_t a, uint32_t b, uint32_t c)
{
    return mixed(mixed(mixed(mixed(0U, op), a), b), c) & (d->results - 1U);
}

bool sy_find(const sy_diagrams_t *d, uint32_t op, uint32_t a, uint32_t b, uint32_t c, sy_node_t *found)
{
    const sy_result_t *r = &d->result[result_at(d, op, a, b, c)];
    *found = r->node;
    return (r->op == op) && (r->key[0] == a) && (r->key[1] == b) && (r->key[2] == c);
}

static void grow_results(sy_diagrams_t *d)
{
    sy_result_t *old = d->result;
    const uint64_t count = d->results;
    d->result = tb_new(2U * count, sizeof *d->result);
    d->results = 2U * count;
    for (uint64_t i = 0U; i < count; i++) {
        const sy_result_t *r = &old[i];
        if (r->op != 0U) {
            d->result[result_at(d, r->op, r->key[0], r->key[1], r->key[2])] = *r;
        }
    }
    tb_free(old, count, sizeof *old);
    d->noted = 0U;
}

void sy_note(sy_diagrams_t *d, uint32_t op, uint32_t a, uint32_t b, uint32_t c, sy_node_t node)
{
    d->noted++;
    if (((2U * d->noted) > d->results) && (d->results < (uint64_t)MOST_RESULTS)
        && tb_has_room(8U * d->results * sizeof *d->result)) {
        grow_results(d);
    }
    const sy_result_t r = { op, { a, b, c }, node };
    d->result[result_at(d, op, a, b, c)] = r;
}
