/* SPDX-License-Identifier: MIT
 * tables_graph.c - the state space as a graph that grows where it is looked at.
 *
 * The initial marking is number 0. A marking in which nothing is enabled has no successors; what that means is the
 * asker's business.
 */
#include "tables.h"

#include <stdlib.h>
#include <string.h>

enum { FIRST_ROOM = 1 << 10, AS_THEY_COME = 2 /* seeds */, FEW = 64 /* successors */ };

/* A number below `count` (Marsaglia 2003). */
static uint32_t drawn(tb_graph_t *g, uint32_t count)
{
    g->random ^= g->random << 13U;
    g->random ^= g->random >> 7U;
    g->random ^= g->random << 17U;
    return (uint32_t)((g->random >> 11U) % count);
}

static void shuffle(tb_graph_t *g, uint32_t *item, uint32_t count)
{
    for (uint32_t i = count; (g->random != 0U) && (i > 1U); i--) {
        const uint32_t other = drawn(g, i);
        const uint32_t t = item[i - 1U];
        item[i - 1U] = item[other];
        item[other] = t;
    }
}

/* The same transitions come first everywhere: a search that goes on in one place comes back to where it was. */
static void rank_all(tb_graph_t *g)
{
    const uint32_t transitions = g->net->transitions;
    g->ranked = tb_new(transitions, sizeof *g->ranked);
    g->rank = tb_new(transitions, sizeof *g->rank);
    for (uint32_t t = 0U; t < transitions; t++) {
        g->ranked[t] = t;
    }
    shuffle(g, g->ranked, transitions);
    for (uint32_t i = 0U; i < transitions; i++) {
        g->rank[g->ranked[i]] = i;
    }
}

void tb_graph_init(tb_graph_t *g, const tb_net_t *net, uint64_t seed)
{
    (void)memset(g, 0, sizeof *g);
    uint32_t number = 0U;
    g->net = net;
    g->random = (seed > (uint64_t)AS_THEY_COME) ? ((seed * 0x9e3779b97f4a7c15U) | 1U) : 0U;
    if ((seed % 2U) == 0U) {
        rank_all(g);
    }
    tb_store_init(&g->store, net, NULL);
    tb_cursor_init(&g->cursor, net);
    (void)tb_store_add(&g->store, g->cursor.marking, &number);
    g->room = (uint64_t)FIRST_ROOM;
    g->first = tb_new(g->room, sizeof *g->first);
    g->count = tb_new(g->room, sizeof *g->count);
    g->successor_room = (uint64_t)FIRST_ROOM;
    g->successor = tb_new(g->successor_room, sizeof *g->successor);
    g->marking = tb_new(net->places, sizeof *g->marking);
    g->fire = tb_new(net->transitions, sizeof *g->fire);
}

void tb_graph_free(tb_graph_t *g)
{
    tb_free(g->first, g->room, sizeof *g->first);
    tb_free(g->count, g->room, sizeof *g->count);
    tb_free(g->successor, g->successor_room, sizeof *g->successor);
    tb_free(g->marking, g->net->places, sizeof *g->marking);
    tb_free(g->fire, g->net->transitions, sizeof *g->fire);
    tb_free(g->rank, g->net->transitions, sizeof *g->rank);
    tb_free(g->ranked, g->net->transitions, sizeof *g->ranked);
    tb_cursor_free(&g->cursor);
    tb_store_free(&g->store);
}

void tb_visit(tb_graph_t *g, uint32_t marking)
{
    if (g->at != marking) {
        tb_store_get(&g->store, marking, g->marking);
        tb_go_to(&g->cursor, g->marking);
        g->at = marking;
    }
}

/* False: there is no room for the entries of all markings and for as many more successors. */
static bool make_room(tb_graph_t *g, uint64_t successors)
{
    const uint64_t records = g->store.records + successors;
    if (records > g->room) {
        const uint64_t room = (2U * g->room > records) ? (2U * g->room) : records;
        if (!tb_has_room((room - g->room) * (sizeof *g->first + sizeof *g->count))) {
            return false;
        }
        g->first = tb_grown(g->first, g->room, room, sizeof *g->first);
        g->count = tb_grown(g->count, g->room, room, sizeof *g->count);
        g->room = room;
    }
    const uint64_t wanted = g->successors + successors;
    if (wanted > g->successor_room) {
        const uint64_t room = (2U * g->successor_room > wanted) ? (2U * g->successor_room) : wanted;
        if (!tb_has_room((room - g->successor_room) * sizeof *g->successor)) {
            return false;
        }
        g->successor = tb_grown(g->successor, g->successor_room, room, sizeof *g->successor);
        g->successor_room = room;
    }
    return true;
}

static int by_number(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a;
    const uint32_t y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* Several transitions may lead to one marking. */
static uint32_t without_repeats(uint32_t *number, uint32_t count)
{
    uint32_t kept = 0U;
    qsort(number, count, sizeof *number, by_number);
    for (uint32_t i = 0U; i < count; i++) {
        if ((kept == 0U) || (number[kept - 1U] != number[i])) {
            number[kept] = number[i];
            kept++;
        }
    }
    return kept;
}

/* The same, and what is left keeps its order. */
static uint32_t first_ones(uint32_t *number, uint32_t count)
{
    uint32_t kept = 0U;
    for (uint32_t i = 0U; i < count; i++) {
        uint32_t k = 0U;
        while ((k < kept) && (number[k] != number[i])) {
            k++;
        }
        if (k == kept) {
            number[kept] = number[i];
            kept++;
        }
    }
    return kept;
}

/* What is found first is looked at first, so that the order decides where a search goes. */
static void put_in_order(tb_graph_t *g, uint32_t count)
{
    if (g->rank == NULL) {
        shuffle(g, g->fire, count);
        return;
    }
    for (uint32_t i = 0U; i < count; i++) {
        g->fire[i] = g->rank[g->fire[i]];
    }
    qsort(g->fire, count, sizeof *g->fire, by_number);
    for (uint32_t i = 0U; i < count; i++) {
        g->fire[i] = g->ranked[g->fire[i]];
    }
}

bool tb_expand(tb_graph_t *g, uint32_t marking)
{
    if (g->first[marking] != 0U) {
        return true;
    }
    tb_visit(g, marking);
    const uint32_t enabled = g->cursor.enabled_count;
    if (g->is_full || tb_is_over() || !make_room(g, enabled)) {
        g->is_full = true;
        return false;
    }
    for (uint32_t i = 0U; i < enabled; i++) {
        g->fire[i] = g->cursor.enabled[i];
    }
    put_in_order(g, enabled);
    uint32_t *found = &g->successor[g->successors];
    for (uint32_t i = 0U; i < enabled; i++) {
        if (tb_is_over() || !tb_move(&g->cursor, g->fire[i])) {
            g->is_full = true;
            return false;
        }
        const tb_added_t added = tb_store_add(&g->store, g->cursor.marking, &found[i]);
        tb_unmove(&g->cursor, g->fire[i]);
        if (added == TB_FULL) {
            g->is_full = true;
            return false;
        }
    }
    const bool is_ranked = (g->rank != NULL) && (enabled <= (uint32_t)FEW);
    g->count[marking] = is_ranked ? first_ones(found, enabled) : without_repeats(found, enabled);
    g->first[marking] = g->successors + 1U;
    g->successors += g->count[marking];
    return true;
}
