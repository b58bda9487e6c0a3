/* SPDX-License-Identifier: MIT
 * tables_graph.c - the state space as a graph that grows where it is looked at.
 *
 * The initial marking is number 0. A marking in which nothing is enabled has no successors; what that means is the
 * asker's business.
 */
#include "tables.h"

#include <stdlib.h>
#include <string.h>

enum { FIRST_ROOM = 1 << 10, AS_THEY_COME = 2 /* seeds */ };

void tb_graph_init(tb_graph_t *g, const tb_net_t *net, uint64_t seed)
{
    (void)memset(g, 0, sizeof *g);
    uint32_t number = 0U;
    g->net = net;
    g->random = (seed > (uint64_t)AS_THEY_COME) ? ((seed * 0x9e3779b97f4a7c15U) | 1U) : 0U;
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

/* A number below `count` (Marsaglia 2003). */
static uint32_t drawn(tb_graph_t *g, uint32_t count)
{
    g->random ^= g->random << 13U;
    g->random ^= g->random >> 7U;
    g->random ^= g->random << 17U;
    return (uint32_t)((g->random >> 11U) % count);
}

/* What is found first is looked at first, so that the order decides where a search goes. */
static void shuffle(tb_graph_t *g, uint32_t count)
{
    for (uint32_t i = count; (g->random != 0U) && (i > 1U); i--) {
        const uint32_t other = drawn(g, i);
        const uint32_t t = g->fire[i - 1U];
        g->fire[i - 1U] = g->fire[other];
        g->fire[other] = t;
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
    shuffle(g, enabled);
    uint32_t *found = &g->successor[g->successors];
    for (uint32_t i = 0U; i < enabled; i++) {
        if (!tb_fire(&g->cursor, g->fire[i])) {
            g->is_full = true;
            return false;
        }
        const tb_added_t added = tb_store_add(&g->store, g->cursor.marking, &found[i]);
        tb_unfire(&g->cursor, g->fire[i]);
        if (added == TB_FULL) {
            g->is_full = true;
            return false;
        }
    }
    g->count[marking] = without_repeats(found, enabled);
    g->first[marking] = g->successors + 1U;
    g->successors += g->count[marking];
    return true;
}
