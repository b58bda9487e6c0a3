/* SPDX-License-Identifier: MIT
 * tables_ltl.c - whether a Buechi automaton accepts a run of the net.
 *
 * Pairs of a marking and a state of the automaton are searched depth first (Couvreur 1999): the strongly connected
 * components of the path so far are kept as its roots, with a mark where one has an accepting state. As soon as an arc
 * closes a component with a mark, a run is found; so a yes seldom needs much of the state space. A dead marking follows
 * itself.
 */
#include "tables_ltl.h"

#include <string.h>

enum { FIRST_SLOTS = 1 << 12, DEPTH_FIRST = 4 /* seeds with which the hunt comes later */ };

/* Of the time of a question, until the search goes over to a hunt, and back. */
static const double FIRST_PART = 0.3;
static const double SECOND_PART = 0.7;

#define KNOWN ((uint64_t)1 << 63U)

static uint64_t room_for(uint64_t room)
{
    return (room > 0U) ? (2U * room) : 1024U;
}

#define GROW(array, count, room)                                                        \
    do {                                                                                \
        if ((count) == (room)) {                                                        \
            const uint64_t more = room_for(room);                                       \
            (array) = tb_grown((array), (size_t)(room), (size_t)more, sizeof *(array)); \
            (room) = more;                                                              \
        }                                                                               \
    } while (false)

static uint64_t hash_of(uint32_t marking, uint32_t state)
{
    uint64_t h = ((((uint64_t)marking) << 20U) ^ state) * 0x9e3779b97f4a7c15U;
    return h ^ (h >> 32U);
}

static uint64_t slot_of(const tb_product_t *p, uint32_t marking, uint32_t state)
{
    uint64_t at = hash_of(marking, state) & (p->slots - 1U);
    while (p->slot[at] != 0U) {
        const tb_pair_t *found = &p->pair[p->slot[at] - 1U];
        if ((found->marking == marking) && (found->state == state)) {
            break;
        }
        at = (at + 1U) & (p->slots - 1U);
    }
    return at;
}

uint32_t tb_pair_number(tb_product_t *p, uint32_t marking, uint32_t state)
{
    uint64_t at = slot_of(p, marking, state);
    if (p->slot[at] != 0U) {
        return p->slot[at] - 1U;
    }
    GROW(p->pair, p->pairs, p->pair_room);
    const tb_pair_t made = { marking, state, 0U, 0U, false, false };
    p->pair[p->pairs] = made;
    p->pairs++;
    p->slot[at] = (uint32_t)p->pairs;
    if ((2U * p->pairs) > p->slots) {
        tb_free(p->slot, p->slots, sizeof *p->slot);
        p->slots *= 4U;
        p->slot = tb_new(p->slots, sizeof *p->slot);
        for (uint64_t i = 0U; i < p->pairs; i++) {
            p->slot[slot_of(p, p->pair[i].marking, p->pair[i].state)] = (uint32_t)(i + 1U);
        }
    }
    return (uint32_t)(p->pairs - 1U);
}

static uint64_t atoms_of(tb_product_t *p, uint32_t marking)
{
    while (marking >= p->atom_room) {
        GROW(p->atoms, p->atom_room, p->atom_room);
    }
    if ((p->atoms[marking] & KNOWN) == 0U) {
        uint64_t bits = KNOWN;
        tb_visit(p->graph, marking);
        for (uint32_t i = 0U; i < p->automaton->atoms; i++) {
            bits |= tb_holds(p->automaton->atom[i], &p->graph->cursor) ? ((uint64_t)1 << i) : 0U;
        }
        p->atoms[marking] = bits;
    }
    return p->atoms[marking];
}

static void enter(tb_product_t *p, uint32_t pair)
{
    GROW(p->path, p->steps, p->step_room);
    GROW(p->root, p->roots, p->root_room);
    GROW(p->active, p->actives, p->active_room);
    const tb_path_step_t step = { pair, p->automaton->first[p->pair[pair].state], 0U };
    p->path[p->steps] = step;
    p->steps++;
    p->active[p->actives] = pair;
    p->actives++;
    p->pair[pair].index = (uint32_t)p->actives;
    p->pair[pair].is_entered = true;
    const tb_root_t root = { (uint32_t)p->actives, p->automaton->is_accepting[p->pair[pair].state] };
    p->root[p->roots] = root;
    p->roots++;
}

/* An arc leads back: what lies between is one component. True: it has an accepting state. */
static bool closes(tb_product_t *p, uint32_t index)
{
    bool is_accepting = false;
    while (p->root[p->roots - 1U].index > index) {
        is_accepting = is_accepting || p->root[p->roots - 1U].is_accepting;
        p->roots--;
    }
    tb_root_t *root = &p->root[p->roots - 1U];
    root->is_accepting = root->is_accepting || is_accepting;
    return root->is_accepting;
}

static void leave(tb_product_t *p)
{
    const uint32_t index = p->pair[p->path[p->steps - 1U].pair].index;
    p->steps--;
    if (p->root[p->roots - 1U].index == index) {
        p->roots--;
        while (p->actives >= index) {
            p->actives--;
            p->pair[p->active[p->actives]].index = 0U;
        }
    }
}

bool tb_next_pair(tb_product_t *p, tb_path_step_t *s, uint32_t *marking, uint32_t *state)
{
    const tb_pair_t at = p->pair[s->pair];
    const uint64_t bits = atoms_of(p, at.marking);
    const uint32_t count = p->graph->count[at.marking];
    const uint32_t ways = (count > 0U) ? count : 1U;
    for (; s->move < p->automaton->first[at.state + 1U]; s->move++) {
        const tb_move_t *move = &p->automaton->move[s->move];
        if (((bits & move->is_true) == move->is_true) && ((bits & move->is_false) == 0U) && (s->next < ways)) {
            *marking = (count > 0U) ? tb_successor(p->graph, at.marking, s->next) : at.marking;
            *state = move->target;
            s->next++;
            return true;
        }
        s->next = 0U;
    }
    return false;
}

/* Depth first, until it is known or the time is over; then it may go on later. */
static tb_answer_t accepted(tb_product_t *p)
{
    while (p->steps > 0U) {
        if (!tb_expand(p->graph, p->pair[p->path[p->steps - 1U].pair].marking)) {
            return TB_UNKNOWN;
        }
        uint32_t marking = 0U;
        uint32_t state = 0U;
        if (!tb_next_pair(p, &p->path[p->steps - 1U], &marking, &state)) {
            leave(p);
            continue;
        }
        const uint32_t pair = tb_pair_number(p, marking, state);
        if (!p->pair[pair].is_entered) {
            enter(p, pair);
        } else if ((p->pair[pair].index != 0U) && closes(p, p->pair[pair].index)) {
            return TB_YES;
        } else {
            /* it was left in vain, or closes nothing that accepts */
        }
        if (tb_is_over()) {
            return TB_UNKNOWN;
        }
    }
    return TB_NO;
}

static tb_answer_t depth_first(tb_product_t *p, double until)
{
    p->graph->is_full = false;
    tb_limit_time(until);
    return accepted(p);
}

static tb_answer_t hunted(tb_product_t *p, double until)
{
    p->graph->is_full = false;
    tb_limit_time(until);
    return tb_hunt(p) ? TB_YES : TB_UNKNOWN;
}

/* Depth first for a part of the time, then by a hunt for another one, then depth first again; or the hunt first. */
static tb_answer_t found(tb_product_t *p, bool is_hunted_first, double until)
{
    const double now = tb_elapsed();
    const double left = until - now;
    tb_answer_t a = TB_UNKNOWN;
    enter(p, tb_pair_number(p, 0U, 0U));
    if (!is_hunted_first) {
        a = depth_first(p, now + (FIRST_PART * left));
    }
    if (a == TB_UNKNOWN) {
        a = hunted(p, now + ((is_hunted_first ? (1.0 - SECOND_PART) : SECOND_PART) * left));
    }
    return (a == TB_UNKNOWN) ? depth_first(p, until) : a;
}

static void answer(tb_graph_t *graph, tb_question_t *q, bool is_hunted_first, double until)
{
    tb_product_t p;
    (void)memset(&p, 0, sizeof p);
    p.graph = graph;
    p.automaton = &q->automaton;
    p.slots = (uint64_t)FIRST_SLOTS;
    p.slot = tb_new(p.slots, sizeof *p.slot);
    const tb_answer_t a = found(&p, is_hunted_first, until);
    if (a != TB_UNKNOWN) {
        tb_say(q, a, "EXPLICIT");
    }
    tb_free(p.slot, p.slots, sizeof *p.slot);
    tb_free(p.pair, p.pair_room, sizeof *p.pair);
    tb_free(p.atoms, p.atom_room, sizeof *p.atoms);
    tb_free(p.path, p.step_room, sizeof *p.path);
    tb_free(p.root, p.root_room, sizeof *p.root);
    tb_free(p.active, p.active_room, sizeof *p.active);
}

void tb_ltl(tb_job_t *job, uint64_t seed, double seconds)
{
    uint32_t open = 0U;
    for (uint32_t i = 0U; i < job->questions; i++) {
        open += (job->question[i].kind == TB_LTL) ? 1U : 0U;
    }
    tb_graph_t graph;
    tb_graph_init(&graph, &job->net, seed);
    for (uint32_t i = 0U; i < job->questions; i++) {
        tb_question_t *q = &job->question[i];
        if (q->kind == TB_LTL) {
            const double now = tb_elapsed();
            const double until = now + ((seconds - now) / (double)open); /* what one leaves over the others get */
            open--;
            answer(&graph, q, seed > (uint64_t)DEPTH_FIRST, until);
        }
    }
    tb_graph_free(&graph);
}
