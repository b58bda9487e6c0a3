/* SPDX-License-Identifier: MIT
 * tables_ltl_hunt.c - a run that the automaton accepts, looked for where a search depth first would get lost.
 *
 * Pairs are looked at in the order of a guess how far they are from an accepting state, by the moves that are left and
 * by what is missing for the next one. From each pair with an accepting state a way back to it is looked for, in the
 * order of the tokens in which markings differ from that one. Both are only found or not found: that there is none is
 * never said.
 */
#include "tables_ltl.h"

#include <string.h>

enum {
    FIRST_BUDGET = 256,    /* pairs that a search for a way back may meet */
    LAST_BUDGET = 1 << 18, /* more than these never */
    TRIES = 8,             /* with one budget, before it is doubled */
    SHARE = 4              /* so many pairs may be met on ways back for each one that the hunt has met */
};

static const double A_MOVE = 1000.0; /* as far as so many tokens */

typedef struct hunt {
    tb_product_t *product;
    double *left; /* state -> moves to an accepting one */
    tb_heap_t waiting;
    tb_heap_t back;
    tb_count_t *goal;
    tb_count_t *other;
    uint32_t round;
    uint64_t met;      /* by the hunt */
    uint64_t met_back; /* by searches for ways back */
    uint64_t budget;
    uint32_t tries;
} hunt_t;

/* Moves from each state to an accepting one. */
static void measure(hunt_t *h)
{
    const tb_automaton_t *a = h->product->automaton;
    bool is_changed = true;
    for (uint32_t s = 0U; s < a->states; s++) {
        h->left[s] = a->is_accepting[s] ? 0.0 : 1e9;
    }
    while (is_changed) {
        is_changed = false;
        for (uint32_t s = 0U; s < a->states; s++) {
            for (uint32_t i = a->first[s]; i < a->first[s + 1U]; i++) {
                const double through = h->left[a->move[i].target] + 1.0;
                if (through < h->left[s]) {
                    h->left[s] = through;
                    is_changed = true;
                }
            }
        }
    }
}

/* What is missing in the marking at the cursor for a move. */
static double missing(const hunt_t *h, const tb_move_t *move)
{
    const tb_automaton_t *a = h->product->automaton;
    double sum = 0.0;
    for (uint32_t i = 0U; i < a->atoms; i++) {
        const uint64_t bit = (uint64_t)1 << i;
        if (((move->is_true | move->is_false) & bit) != 0U) {
            sum += tb_distance(a->atom[i], &h->product->graph->cursor, (move->is_true & bit) != 0U);
        }
    }
    return sum;
}

/* How far a pair is from an accepting one, by the best of its moves. */
static double distance_of(const hunt_t *h, const tb_pair_t *pair)
{
    const tb_automaton_t *a = h->product->automaton;
    double best = 1e18;
    tb_visit(h->product->graph, pair->marking);
    for (uint32_t i = a->first[pair->state]; i < a->first[pair->state + 1U]; i++) {
        const double d = missing(h, &a->move[i]) + (A_MOVE * h->left[a->move[i].target]);
        best = (d < best) ? d : best;
    }
    return best;
}

/* The tokens by which a marking differs from that of the goal. */
static double difference(const hunt_t *h, uint32_t marking)
{
    const uint32_t places = h->product->graph->net->places;
    double sum = 0.0;
    tb_store_get(&h->product->graph->store, marking, h->other);
    for (uint32_t p = 0U; p < places; p++) {
        const double d = (double)h->other[p] - (double)h->goal[p];
        sum += (d < 0.0) ? -d : d;
    }
    return sum;
}

/* Whether a way leads from a pair back to it. */
static bool comes_back(hunt_t *h, uint32_t goal)
{
    tb_product_t *p = h->product;
    uint64_t met = 0U;
    h->round++;
    h->back.count = 0U;
    tb_store_get(&p->graph->store, p->pair[goal].marking, h->goal);
    tb_heap_push(&h->back, 0.0, goal);
    while ((h->back.count > 0U) && (met < h->budget) && !tb_is_over()) {
        tb_path_step_t at = { tb_heap_pop(&h->back), 0U, 0U };
        uint32_t marking = 0U;
        uint32_t state = 0U;
        at.move = p->automaton->first[p->pair[at.pair].state];
        if (!tb_expand(p->graph, p->pair[at.pair].marking)) {
            break;
        }
        while (tb_next_pair(p, &at, &marking, &state)) {
            const uint32_t to = tb_pair_number(p, marking, state);
            if (to == goal) {
                return true;
            }
            if (p->pair[to].hunt != h->round) {
                p->pair[to].hunt = h->round;
                tb_heap_push(&h->back, difference(h, marking) + h->left[state], to);
                met++;
            }
        }
    }
    h->met_back += met;
    h->tries++;
    if (((h->tries % (uint32_t)TRIES) == 0U) && (h->budget < (uint64_t)LAST_BUDGET)) {
        h->budget *= 2U;
    }
    return false;
}

static void await(hunt_t *h, uint32_t pair)
{
    tb_pair_t *met = &h->product->pair[pair];
    if (!met->is_awaited) {
        met->is_awaited = true;
        h->met++;
        tb_heap_push(&h->waiting, distance_of(h, met), pair);
    }
}

static bool hunted(hunt_t *h)
{
    tb_product_t *p = h->product;
    await(h, tb_pair_number(p, 0U, 0U));
    while ((h->waiting.count > 0U) && !tb_is_over()) {
        tb_path_step_t at = { tb_heap_pop(&h->waiting), 0U, 0U };
        uint32_t marking = 0U;
        uint32_t state = p->pair[at.pair].state;
        const bool is_affordable = h->met_back <= ((uint64_t)SHARE * h->met);
        if (p->automaton->is_accepting[state] && is_affordable && comes_back(h, at.pair)) {
            return true;
        }
        at.move = p->automaton->first[state];
        if (!tb_expand(p->graph, p->pair[at.pair].marking)) {
            return false;
        }
        while (tb_next_pair(p, &at, &marking, &state)) {
            await(h, tb_pair_number(p, marking, state));
        }
    }
    return false;
}

bool tb_hunt(tb_product_t *p)
{
    const uint32_t places = p->graph->net->places;
    hunt_t h;
    (void)memset(&h, 0, sizeof h);
    h.product = p;
    h.budget = (uint64_t)FIRST_BUDGET;
    h.left = tb_new(p->automaton->states, sizeof *h.left);
    h.goal = tb_new(places, sizeof *h.goal);
    h.other = tb_new(places, sizeof *h.other);
    measure(&h);
    const bool is_found = hunted(&h);
    tb_heap_free(&h.waiting);
    tb_heap_free(&h.back);
    tb_free(h.left, p->automaton->states, sizeof *h.left);
    tb_free(h.goal, places, sizeof *h.goal);
    tb_free(h.other, places, sizeof *h.other);
    return is_found;
}
