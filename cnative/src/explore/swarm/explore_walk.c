/* SPDX-License-Identifier: MIT
 * explore_walk.c - from the initial state on at random, to a dead state or as far as a way may be, again and again.
 *
 * With an even seed all arcs are as probable; with an odd one some transitions are preferred, others in each search: so
 * walks come to places that others hardly ever come to.
 */
#include "explore_swarm.h"
#include "../search/explore_search.h"

/* The next random number. */
static uint64_t drawn(ex_swarm_t *swarm)
{
    swarm->random ^= swarm->random << 13U;
    swarm->random ^= swarm->random >> 7U;
    swarm->random ^= swarm->random << 17U;
    return swarm->random * 0x2545f4914f6cdd1dU;
}

static uint64_t weight_of(const ex_run_t *run, uint32_t transition)
{
    if ((run->options.swarm % 2U) == 0U) {
        return 1U;
    }
    const ex_key_t key = { run->options.swarm, (uint64_t)transition + 1U };
    return (uint64_t)1U << (2U * (ex_hash(&key) >> 62U)); /* 1, 4, 16 or 64 */
}

bool ex_walk_take(ex_worker_t *worker, uint32_t transition, uint32_t times, const ex_key_t *key)
{
    ex_swarm_t *const swarm = worker->run->swarm;
    const uint64_t weight = weight_of(worker->run, transition) * times;
    swarm->weight += weight;
    if (ex_scaled(drawn(swarm), swarm->weight) < weight) {
        swarm->next = *key;
    }
    return true;
}

/* One state further. False when the walk is over, or the run stops. */
static bool step(ex_worker_t *worker, ex_key_t *key, uint64_t depth)
{
    ex_run_t *const run = worker->run;
    ex_swarm_t *const swarm = run->swarm;
    if (worker->states >= run->options.max_states) {
        ex_stop(run, EX_STATES);
        return false;
    }
    swarm->weight = 0U;
    if (!ex_swarm_at(worker, key, depth) || !ex_batch_begin(worker) || !ex_expand_state(worker, key)) {
        return false;
    }
    if ((depth > 0U) && ex_is_new(run, key)) {
        (void)atomic_fetch_add_explicit(&run->store.used, 1U, memory_order_relaxed);
    }
    worker->search->deepest = (depth > worker->search->deepest) ? depth : worker->search->deepest;
    if (ex_is_stopping(run) || (swarm->weight == 0U)) {
        return false;
    }
    *key = swarm->next;
    return true;
}

void ex_walk(ex_worker_t *worker, void *user)
{
    ex_run_t *const run = worker->run;
    (void)user;
    while (!ex_is_stopping(run) && !worker->failed) {
        ex_key_t key = run->initial;
        for (uint64_t depth = 0U; (depth <= run->options.max_depth) && step(worker, &key, depth); depth++) {
        }
        if (run->swarm->depth == 0U) {
            return; /* nothing occurs at all */
        }
        if ((run->swarm->depth == run->options.max_depth) && !ex_is_stopping(run) && !worker->failed) {
            ex_trap_look(worker);
        }
    }
}
