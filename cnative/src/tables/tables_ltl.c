/* SPDX-License-Identifier: MIT
 * tables_ltl.c - whether a Buechi automaton accepts a run of the net.
 *
 * Pairs of a marking and a state of the automaton are searched depth first (Couvreur 1999): the strongly connected
 * components of the path so far are kept as its roots, with a mark where one has an accepting state. As soon as an arc
 * closes a component with a mark, a run is found; so a yes seldom needs much of the state space. A dead marking follows
 * itself.
 */
#include "tables.h"

#include <string.h>

enum { FIRST_SLOTS = 1 << 12 };

typedef struct pair {
    uint32_t marking;
    uint32_t state;
    uint32_t index; /* on the path or in one of its components: when it was met, from 1; 0: left for good */
} pair_t;

typedef struct step {
    uint32_t pair;
    uint32_t move; /* of the automaton */
    uint32_t next; /* successor of the marking */
} step_t;

typedef struct root {
    uint32_t index;
    bool is_accepting;
} root_t;

typedef struct product {
    tb_graph_t *graph;
    const tb_automaton_t *automaton;
    tb_question_t *question;
    pair_t *pair;
    uint64_t pairs;
    uint64_t pair_room;
    uint32_t *slot;
    uint64_t slots;
    uint64_t *atoms; /* marking -> bits of the atoms, and the highest bit if they are known */
    uint64_t atom_room;
    step_t *path;
    uint64_t steps;
    uint64_t step_room;
    root_t *root;
    uint64_t roots;
    uint64_t root_room;
    uint32_t *active;
    uint64_t actives;
    uint64_t active_room;
} product_t;

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

static uint64_t slot_of(const product_t *p, uint32_t marking, uint32_t state)
{
    uint64_t at = hash_of(marking, state) & (p->slots - 1U);
    while (p->slot[at] != 0U) {
        const pair_t *found = &p->pair[p->slot[at] - 1U];
        if ((found->marking == marking) && (found->state == state)) {
            break;
        }
        at = (at + 1U) & (p->slots - 1U);
    }
    return at;
}

/* The number of a pair; *is_new: it was not known. */
static uint32_t number_of(product_t *p, uint32_t marking, uint32_t state, bool *is_new)
{
    uint64_t at = slot_of(p, marking, state);
    *is_new = p->slot[at] == 0U;
    if (!*is_new) {
        return p->slot[at] - 1U;
    }
    GROW(p->pair, p->pairs, p->pair_room);
    const pair_t made = { marking, state, 0U };
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

static uint64_t atoms_of(product_t *p, uint32_t marking)
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

static void enter(product_t *p, uint32_t pair)
{
    GROW(p->path, p->steps, p->step_room);
    GROW(p->root, p->roots, p->root_room);
    GROW(p->active, p->actives, p->active_room);
    const step_t step = { pair, p->automaton->first[p->pair[pair].state], 0U };
    p->path[p->steps] = step;
    p->steps++;
    p->active[p->actives] = pair;
    p->actives++;
    p->pair[pair].index = (uint32_t)p->actives;
    const root_t root = { (uint32_t)p->actives, p->automaton->is_accepting[p->pair[pair].state] };
    p->root[p->roots] = root;
    p->roots++;
}

/* An arc leads back: what lies between is one component. True: it has an accepting state. */
static bool closes(product_t *p, uint32_t index)
{
    bool is_accepting = false;
    while (p->root[p->roots - 1U].index > index) {
        is_accepting = is_accepting || p->root[p->roots - 1U].is_accepting;
        p->roots--;
    }
    root_t *root = &p->root[p->roots - 1U];
    root->is_accepting = root->is_accepting || is_accepting;
    return root->is_accepting;
}

static void leave(product_t *p)
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

/* The next pair after the one at the end of the path; false: there is none. */
static bool next_pair(product_t *p, uint32_t *marking, uint32_t *state)
{
    step_t *s = &p->path[p->steps - 1U];
    const pair_t at = p->pair[s->pair];
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

static tb_answer_t accepted(product_t *p)
{
    bool is_new = false;
    enter(p, number_of(p, 0U, 0U, &is_new));
    while (p->steps > 0U) {
        if (!tb_expand(p->graph, p->pair[p->path[p->steps - 1U].pair].marking)) {
            return TB_UNKNOWN;
        }
        uint32_t marking = 0U;
        uint32_t state = 0U;
        if (!next_pair(p, &marking, &state)) {
            leave(p);
            continue;
        }
        const uint32_t pair = number_of(p, marking, state, &is_new);
        if (is_new) {
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

static void answer(tb_graph_t *graph, tb_question_t *q)
{
    product_t p;
    (void)memset(&p, 0, sizeof p);
    p.graph = graph;
    p.automaton = &q->automaton;
    p.question = q;
    p.slots = (uint64_t)FIRST_SLOTS;
    p.slot = tb_new(p.slots, sizeof *p.slot);
    const tb_answer_t a = accepted(&p);
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
            tb_limit_time(tb_elapsed()
                          + ((seconds - tb_elapsed()) / (double)open)); /* what one leaves over the others get */
            open--;
            graph.is_full = false;
            answer(&graph, q);
        }
    }
    tb_graph_free(&graph);
}
