/* SPDX-License-Identifier: MIT
 * explore_lasso.c - a run that an automaton accepts: a way to an accepting state of a good component of the product,
 * and a cycle there that comes back to it and is fair.
 *
 * The accepting states that are nearest to the start are tried, each with a shortest cycle (with fairness: one made of
 * shortest parts).
 */
#include "explore_product.h"

#include <stdlib.h>

#define MOST_TRIALS 32U

/* Steps of a run: state[0], and for step i from 1 on label[i] and state[i]. */
typedef struct steps {
    uint32_t *state;
    uint32_t *label;
    uint64_t count;
    uint64_t room;
} steps_t;

/* A breadth-first search in the product. */
typedef struct hunt {
    ex_product_t *p;
    uint32_t *parent;
    uint32_t *label; /* of the step from the parent */
    uint32_t *queue;
    uint32_t *seen; /* the number of the search in which a state was last met */
    uint32_t number;
    uint64_t work;
    uint32_t component; /* in which it stays */
} hunt_t;

/* What is looked for. */
typedef enum goal_kind {
    GOAL_STATE,   /* this state, by at least one step */
    GOAL_OCCURS,  /* a step by this transition */
    GOAL_DISABLED /* a state whose node is not in this item */
} goal_kind_t;

typedef struct goal {
    goal_kind_t kind;
    uint32_t number;
} goal_t;

/* --- steps -------------------------------------------------------------------------------------------------------- */

static bool has_room(steps_t *s, uint64_t more)
{
    if ((s->count + more + 1U) <= s->room) {
        return true;
    }
    const uint64_t room = (2U * s->room) + more + 64U;
    uint32_t *const states = realloc(s->state, room * sizeof *states);
    s->state = (states != NULL) ? states : s->state;
    uint32_t *const labels = realloc(s->label, room * sizeof *labels);
    s->label = (labels != NULL) ? labels : s->label;
    s->room = ((states != NULL) && (labels != NULL)) ? room : s->room;
    return (states != NULL) && (labels != NULL);
}

static void forget(steps_t *s)
{
    free(s->state);
    free(s->label);
    *s = (steps_t){ .state = NULL };
}

/* Adds the steps that lead from the end of `s` to `from` by the parents, and one more. */
static bool add_steps(const hunt_t *h, uint32_t from, uint32_t label, uint32_t state, steps_t *s)
{
    const uint32_t start = s->state[s->count];
    uint64_t more = 1U;
    for (uint32_t at = from; at != start; at = h->parent[at]) {
        more += 1U;
    }
    if (!has_room(s, more)) {
        return false;
    }
    s->count += more;
    s->state[s->count] = state;
    s->label[s->count] = label;
    uint64_t i = s->count;
    for (uint32_t at = from; at != start; at = h->parent[at]) {
        i -= 1U;
        s->state[i] = at;
        s->label[i] = h->label[at];
    }
    return true;
}

/* --- searches ----------------------------------------------------------------------------------------------------- */

static void begin(hunt_t *h, uint32_t start)
{
    h->number += 1U;
    h->queue[0] = start;
    h->seen[start] = h->number;
    h->parent[start] = start;
}

/* Whether a state is met for the first time. */
static bool meet(hunt_t *h, uint32_t from, uint32_t label, uint32_t state, uint64_t *used)
{
    h->work += 1U;
    if (h->seen[state] == h->number) {
        return false;
    }
    h->seen[state] = h->number;
    h->parent[state] = from;
    h->label[state] = label;
    h->queue[*used] = state;
    *used += 1U;
    return true;
}

static bool is_candidate(const ex_product_t *p, uint32_t state)
{
    return (EX_BIT(p->active, state) != 0U) && p->automaton->is_accepting[state % p->states];
}

/* The ways to the nearest accepting states of good components; gives their number. */
static uint32_t find_candidates(hunt_t *h, steps_t *found)
{
    const ex_product_t *const p = h->p;
    uint32_t candidate[MOST_TRIALS];
    uint32_t count = 0U;
    uint64_t used = 1U;
    begin(h, p->start);
    if (is_candidate(p, p->start)) {
        candidate[count] = p->start;
        count += 1U;
    }
    for (uint64_t i = 0U; (i < used) && (count < MOST_TRIALS) && !ex_is_stopping(p->queries->run); i++) {
        ex_cursor_t cursor = ex_first_of(p, h->queue[i]);
        uint32_t label = EX_NO_TRANSITION;
        for (uint32_t to = ex_next_of(p, &cursor, &label); to != EX_NO_STATE; to = ex_next_of(p, &cursor, &label)) {
            if (meet(h, h->queue[i], label, to, &used) && is_candidate(p, to) && (count < MOST_TRIALS)) {
                candidate[count] = to;
                count += 1U;
            }
        }
    }
    for (uint32_t k = 0U; k < count; k++) {
        const uint32_t state = candidate[k];
        if (!has_room(&found[k], 1U)) {
            return k;
        }
        found[k].state[0] = p->start;
        if ((state != p->start) && !add_steps(h, h->parent[state], h->label[state], state, &found[k])) {
            return k;
        }
    }
    return count;
}

static bool is_reached(const ex_product_t *p, const goal_t *goal, uint32_t state, uint32_t label)
{
    switch (goal->kind) {
    case GOAL_STATE: return state == goal->number;
    case GOAL_OCCURS: return label == goal->number;
    case GOAL_DISABLED:
    default: return !ex_is_in(p->queries, goal->number, state / p->states);
    }
}

/* Adds shortest steps from the end of `s` to the goal, within the component. */
static bool hunt_for(hunt_t *h, const goal_t *goal, steps_t *s)
{
    const ex_product_t *const p = h->p;
    uint64_t used = 1U;
    begin(h, s->state[s->count]);
    for (uint64_t i = 0U; (i < used) && !ex_is_stopping(p->queries->run); i++) {
        const uint32_t from = h->queue[i];
        ex_cursor_t cursor = ex_first_of(p, from);
        uint32_t label = EX_NO_TRANSITION;
        for (uint32_t to = ex_next_of(p, &cursor, &label); to != EX_NO_STATE; to = ex_next_of(p, &cursor, &label)) {
            if ((EX_BIT(p->active, to) == 0U) || (p->rank[to] != h->component)) {
                continue;
            }
            if (is_reached(p, goal, to, label)) {
                return add_steps(h, from, label, to, s);
            }
            (void)meet(h, from, label, to, &used);
        }
    }
    return false;
}

/* --- cycles ------------------------------------------------------------------------------------------------------- */

/* Whether the steps after `first` show already that a transition is treated fairly. */
static bool is_treated(const ex_product_t *p, uint32_t k, const steps_t *s, uint64_t first)
{
    const ex_automaton_t *const automaton = p->automaton;
    for (uint64_t i = first; i <= s->count; i++) {
        const bool occurs = (i > first) && (s->label[i] == automaton->fair[k]);
        const bool is_enabled = ex_is_in(p->queries, automaton->fair_item[k], s->state[i] / p->states);
        if (occurs || (!automaton->is_strong[k] && !is_enabled)) {
            return true;
        }
    }
    return false;
}

/* Adds a fair cycle from the end of `s` back to it. */
static bool add_cycle(hunt_t *h, steps_t *s)
{
    const ex_product_t *const p = h->p;
    const ex_automaton_t *const automaton = p->automaton;
    const uint64_t first = s->count;
    const goal_t back = { .kind = GOAL_STATE, .number = s->state[first] };
    h->component = p->rank[back.number];
    for (uint32_t k = 0U; k < automaton->fair_count; k++) {
        const goal_t occurs = { .kind = GOAL_OCCURS, .number = automaton->fair[k] };
        const goal_t disabled = { .kind = GOAL_DISABLED, .number = automaton->fair_item[k] };
        /* In a good component a strong transition that does not occur is enabled nowhere. */
        if (!is_treated(p, k, s, first) && !hunt_for(h, &occurs, s) && !automaton->is_strong[k]
            && !hunt_for(h, &disabled, s)) {
            return false;
        }
    }
    return ((s->count > first) && (s->state[s->count] == back.number)) || hunt_for(h, &back, s);
}

/* The steps as a way through the graph; where they stay at a dead node it ends. */
static void write_down(const ex_product_t *p, const steps_t *s, uint64_t cycle, ex_path_t *path)
{
    for (uint64_t i = 1U; (i <= s->count) && (s->label[i] != EX_NO_TRANSITION); i++) {
        if (i == (cycle + 1U)) {
            path->loop = (int64_t)path->steps;
        }
        ex_path_step(path, (uint16_t)s->label[i], s->state[i] / p->states);
    }
}

static bool find_lasso(hunt_t *h, ex_path_t *path)
{
    const ex_product_t *const p = h->p;
    const uint64_t most_work = 4U * (p->size + p->graph->arcs);
    steps_t trial[MOST_TRIALS];
    uint64_t cycle[MOST_TRIALS];
    uint64_t shortest = UINT64_MAX;
    uint32_t best = MOST_TRIALS;
    for (uint32_t k = 0U; k < MOST_TRIALS; k++) {
        trial[k] = (steps_t){ .state = NULL };
    }
    const uint32_t count = find_candidates(h, trial);
    h->work = 0U;
    for (uint32_t k = 0U; (k < count) && ((best == MOST_TRIALS) || (h->work < most_work)); k++) {
        cycle[k] = trial[k].count;
        if ((trial[k].count < shortest) && add_cycle(h, &trial[k]) && (trial[k].count < shortest)) {
            shortest = trial[k].count;
            best = k;
        }
    }
    if (best < MOST_TRIALS) {
        write_down(p, &trial[best], cycle[best], path);
    }
    for (uint32_t k = 0U; k < MOST_TRIALS; k++) {
        forget(&trial[k]);
    }
    return best < MOST_TRIALS;
}

bool ex_show_lasso(ex_product_t *p, ex_path_t *path)
{
    ex_run_t *const run = p->queries->run;
    hunt_t h = { .p = p };
    h.parent = ex_table(&run->memory, p->size, sizeof *h.parent);
    h.label = ex_table(&run->memory, p->size, sizeof *h.label);
    h.queue = ex_table(&run->memory, p->size, sizeof *h.queue);
    h.seen = ex_table(&run->memory, p->size, sizeof *h.seen);
    const bool has_memory = (h.parent != NULL) && (h.label != NULL) && (h.queue != NULL) && (h.seen != NULL);
    const bool is_found = has_memory && find_lasso(&h, path);
    ex_free_table(&run->memory, h.parent, p->size, sizeof *h.parent);
    ex_free_table(&run->memory, h.label, p->size, sizeof *h.label);
    ex_free_table(&run->memory, h.queue, p->size, sizeof *h.queue);
    ex_free_table(&run->memory, h.seen, p->size, sizeof *h.seen);
    return is_found && !path->is_failed;
}
