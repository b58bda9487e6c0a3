/* SPDX-License-Identifier: MIT
 * explore_trap.c - whether a cell has come to where it can no longer reach its end (`? ends`).
 *
 * A walk that is as long as it may be has perhaps not come to an end because there is none any more. So now and then,
 * where it stands, all that can follow is looked at, as long as it is little: if none of it is an end, the cell is
 * trapped. The states of a trap lead into the trap alone, so the first one on the way that is in it is found by
 * halving.
 */
#include "explore_swarm.h"
#include "../search/explore_search.h"

#include <string.h>

enum { MOST = 1 << 12, PLACES = 2 * MOST };

typedef struct ex_trap {
    ex_worker_t *worker;
    ex_key_t state[MOST];
    uint32_t from[MOST];
    uint32_t place[PLACES]; /* the number of a state, + 1, by its hash; 0: free */
    uint32_t count;
    uint32_t number; /* of the state at hand */
} ex_trap_t;

uint64_t ex_trap_room(void)
{
    return (uint64_t)MOST;
}

/* False: there are too many. */
static bool add(ex_trap_t *trap, const ex_key_t *key)
{
    uint64_t at = ex_hash(key) % (uint64_t)PLACES;
    while (trap->place[at] != 0U) {
        const ex_key_t *const other = &trap->state[trap->place[at] - 1U];
        if ((other->low == key->low) && (other->high == key->high)) {
            return true;
        }
        at = (at + 1U) % (uint64_t)PLACES;
    }
    if (trap->count == (uint32_t)MOST) {
        return false;
    }
    trap->state[trap->count] = *key;
    trap->from[trap->count] = trap->number;
    trap->count++;
    trap->place[at] = trap->count;
    return true;
}

static bool take(void *user, uint32_t transition, uint32_t times, const ex_key_t *key)
{
    (void)transition;
    (void)times;
    return add(user, key);
}

/* The way to a state in which an exception was raised leads on from `depth`. */
static void follow(const ex_trap_t *trap, uint64_t depth)
{
    ex_swarm_t *const swarm = trap->worker->run->swarm;
    uint64_t steps = 0U;
    for (uint32_t i = trap->number; i != 0U; i = trap->from[i]) {
        steps++;
    }
    swarm->depth = depth + steps;
    for (uint32_t i = trap->number; i != 0U; i = trap->from[i]) {
        swarm->way[depth + steps] = trap->state[i];
        steps--;
    }
}

/* Whether all that follows a state of the way is little, and no end. */
static bool is_closed(ex_trap_t *trap, uint64_t depth, const ex_item_t *end)
{
    ex_worker_t *const worker = trap->worker;
    const ex_key_t begin = worker->run->swarm->way[depth];
    bool is_so = true;
    (void)memset(trap->place, 0, sizeof trap->place);
    trap->count = 0U;
    trap->number = 0U;
    (void)add(trap, &begin);
    for (uint32_t i = 0U; is_so && (i < trap->count); i++) {
        const ex_key_t key = trap->state[i];
        uint64_t tokens = 0U;
        bool is_raised = false;
        trap->number = i;
        is_so = ex_batch_begin(worker) && ex_load(worker, &key) && !ex_leaf_holds(worker, end, &tokens, &is_raised)
                && !is_raised;
        if (is_so) {
            const ex_found_t found = ex_arcs(worker, &key, take, trap);
            is_so = (found == EX_SOME) || (found == EX_DEAD);
            if (found == EX_FAILED) {
                follow(trap, depth);
            }
        }
        worker->run->swarm->trapped++;
        is_so = is_so && !ex_is_stopping(worker->run);
    }
    return is_so;
}

/* Of the way the first state that is in the trap; its last one is. */
static uint64_t first_closed(ex_trap_t *trap, const ex_item_t *end)
{
    uint64_t high = trap->worker->run->swarm->depth;
    uint64_t low = 0U; /* the initial state is the last that is taken to be in no trap */
    if (is_closed(trap, 0U, end)) {
        return 0U;
    }
    while (((high - low) > 1U) && !trap->worker->failed) {
        const uint64_t middle = low + ((high - low) / 2U);
        if (is_closed(trap, middle, end)) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return high;
}

void ex_trap_look(ex_worker_t *worker)
{
    ex_run_t *const run = worker->run;
    ex_swarm_t *const swarm = run->swarm;
    ex_queries_t *const queries = run->queries;
    for (uint32_t i = 0U; (queries != NULL) && (i < queries->questions); i++) {
        ex_question_t *const question = &queries->question[i];
        if ((question->kind != EX_ASK_ENDS) || !question->has_item || atomic_load(&question->is_decided)) {
            continue;
        }
        const ex_item_t *const end = &queries->item[queries->item[question->a].a];
        /* It takes no more time than walking. */
        if ((end->kind != EX_ITEM_WITHIN) || ((swarm->trapped + (uint64_t)MOST) > worker->states)) {
            continue;
        }
        if (swarm->trap == NULL) {
            swarm->trap = ex_alloc(&run->memory, sizeof *swarm->trap);
        }
        if (swarm->trap == NULL) {
            return;
        }
        swarm->trap->worker = worker;
        if (!is_closed(swarm->trap, swarm->depth, end)) {
            continue;
        }
        const uint64_t first = first_closed(swarm->trap, end);
        if (worker->failed || ex_is_stopping(run)) {
            return;
        }
        swarm->depth = first;
        atomic_store(&question->is_decided, true);
        ex_swarm_decided(worker, question, i, EX_SOME);
    }
}
