/* SPDX-License-Identifier: MIT
 * explore_search.c - through all states, breadth first or depth first.
 *
 * Keys of states that are still to be expanded lie in chunks. Breadth first, threads take chunks of this level and fill
 * chunks of the next one; depth first, each has a stack of chunks and gives the lowest one away when others have
 * nothing to do. Successors are put into the store in batches: while the cache line of one is on its way from memory,
 * others are made. Those that this thread has met a short while ago are not even looked up: neighbours have many
 * successors in common.
 */
#define _POSIX_C_SOURCE 200809L

#include "explore_local.h"
#include "explore_counts.h"
#include "explore_instances.h"
#include "explore_successors.h"
#include "../explore_bounds.h"
#include "../query/explore_early.h"
#include "../swarm/explore_swarm.h"
#include "../sweep/explore_sweep.h"
#include "explore_search.h"

#include <math.h>
#include <string.h>
#include <time.h>

enum {
    SHARED_FROM = 32, /* keys in a chunk that is given to idle threads */
    FIRST_KEYS = 1 << 14,
    REPORTED = 1 << 12 /* states after which a thread tells how far it is */
};

/* --- batches ------------------------------------------------------------------------------------------------------ */

/* Whether a state has been seen; for approximations: it seems so. */
static bool is_known(ex_run_t *run, const ex_pending_t *pending)
{
    return run->options.is_bitstate ? ex_bits_hold(&run->bits, pending->hash)
                                    : (ex_store_find(&run->store, &pending->stored, pending->hash) != EX_NO_SLOT);
}

static ex_insertion_t insert(ex_run_t *run, const ex_pending_t *pending)
{
    return run->options.is_bitstate ? ex_bits_insert(&run->bits, pending->hash)
                                    : ex_store_insert(&run->store, &pending->stored, pending->hash, NULL);
}

/* Of hash compaction and bit states: another hash is all that is kept of a key. */
static void shorten(const ex_run_t *run, ex_pending_t *pending)
{
    const ex_key_t turned = { pending->key.high ^ 0x6a09e667f3bcc909U ^ run->turned.low,
                              pending->key.low ^ 0xbb67ae8584caa73bU ^ run->turned.high };
    const uint64_t other = ex_hash(&turned);
    if (run->options.is_bitstate) {
        pending->hash = other ^ (pending->hash * 0x9e3779b97f4a7c15U);
        ex_bits_prefetch(&run->bits, pending->hash);
    } else {
        pending->stored = (ex_key_t){ .low = other, .high = 0U };
        pending->hash = ex_hash(&pending->stored);
        ex_store_prefetch(&run->store, pending->hash);
    }
}

bool ex_is_new(ex_run_t *run, const ex_key_t *key)
{
    ex_pending_t pending = { .key = *key, .stored = *key, .hash = ex_hash(key) };
    shorten(run, &pending);
    return insert(run, &pending) == EX_NEW;
}

bool ex_batch_begin(ex_worker_t *worker)
{
    ex_run_t *run = worker->run;
    const ex_store_t *store = &run->store;
    if (ex_is_pausing(run)) {
        (void)ex_pause(worker);
    }
    /* What other threads are inserting now is not counted yet, but there is room above the limit. */
    return run->options.is_bitstate
           || ((atomic_load_explicit(&store->used, memory_order_relaxed) + (2U * (uint64_t)EX_BATCH)) <= store->limit)
           || ((run->sweep != NULL) && ex_sweep_forget(run)) || ex_pause(worker);
}

static void exchange(ex_search_t *own, uint32_t i, uint32_t k)
{
    const ex_pending_t other = own->batch[i];
    own->batch[i] = own->batch[k];
    own->batch[k] = other;
}

/* Depth first, what is inserted last is expanded first: the other way round, or in an order that chance decides. */
static void shuffle(ex_search_t *own, uint64_t how)
{
    if (how == 1U) {
        for (uint32_t i = 0U; i < (own->pending / 2U); i++) {
            exchange(own, i, own->pending - 1U - i);
        }
        return;
    }
    for (uint32_t i = own->pending; i > 1U; i--) {
        own->random ^= own->random << 13U;
        own->random ^= own->random >> 7U;
        own->random ^= own->random << 17U;
        exchange(own, i - 1U, (uint32_t)(own->random % i));
    }
}

/* Inserts what has been collected. False when the run stops. */
static bool flush(ex_worker_t *worker)
{
    ex_run_t *run = worker->run;
    ex_search_t *own = worker->search;
    ex_store_t *store = &run->store;
    uint64_t found = 0U;
    bool goes_on = true;
    if (own->words != NULL) {
        return ex_words_flush(worker);
    }
    if (own->random != 0U) {
        shuffle(own, run->options.shuffle);
    }
    if (!ex_batch_begin(worker)) {
        return false;
    }
    uint64_t before = atomic_load_explicit(&store->used, memory_order_relaxed);
    const bool is_near = ex_is_near_limit(run);
    for (uint32_t i = 0U; goes_on && (i < own->pending); i++) {
        const ex_pending_t *pending = &own->batch[i];
        if (is_near && ((before + found) >= run->options.max_states)) {
            if (!is_known(run, pending)) {
                ex_stop(run, EX_STATES);
                goes_on = false;
            }
            continue;
        }
        ex_insertion_t insertion = insert(run, pending);
        while ((insertion == EX_FULL) && goes_on) {
            /* A number has become too large for its word, or the table is full to the last slot. */
            (void)atomic_fetch_add_explicit(&store->used, found, memory_order_relaxed);
            before += found;
            found = 0U;
            goes_on = ex_pause(worker);
            insertion = insert(run, pending);
        }
        if (insertion == EX_NEW) {
            found++;
            goes_on = ex_add_new(own, &pending->key);
        }
    }
    own->pending = 0U;
    if (found > 0U) {
        (void)atomic_fetch_add_explicit(&store->used, found, memory_order_relaxed);
    }
    return goes_on && !ex_is_stopping(run);
}

bool ex_flush_all(ex_worker_t *worker)
{
    return ((worker->search->flat == NULL) || ex_flat_finish(worker)) && flush(worker);
}

bool ex_take(ex_worker_t *worker, const ex_key_t *found, uint64_t hash)
{
    ex_search_t *own = worker->search;
    const ex_key_t key = { ex_alone(found->low), ex_alone(found->high) };
    ex_key_t *recent = &own->recent[hash % (uint64_t)EX_RECENT];
    ex_pending_t *pending = &own->batch[own->pending];
    const bool is_other = (((recent->low ^ key.low) | (recent->high ^ key.high)) != 0U);
    const bool is_zero = (key.low | key.high) == 0U;
    recent->low = key.low;
    recent->high = key.high;
    pending->key.low = key.low;
    pending->key.high = key.high;
    pending->stored.low = key.low;
    pending->stored.high = key.high;
    pending->hash = hash;
    if (own->is_exact) {
        ex_store_prefetch(&worker->run->store, hash);
    } else {
        shorten(worker->run, pending);
    }
    /* Nobody can foretell it: there is no branch on it. */
    own->pending += (uint32_t)is_other | (uint32_t)is_zero;
    return (own->pending < (uint32_t)EX_BATCH) || flush(worker);
}

static bool on_arc(void *user, uint32_t transition, uint32_t times, const ex_key_t *found)
{
    ex_worker_t *worker = user;
    worker->fired[transition] += times;
    worker->arcs += times;
    const ex_key_t key = { ex_alone(found->low), ex_alone(found->high) };
    return ex_take(worker, &key, ex_hash(&key));
}

/* --- the loop ----------------------------------------------------------------------------------------------------- */

/* For the progress lines. */
static void report(ex_worker_t *worker)
{
    ex_search_t *own = worker->search;
    ex_level_t *search = own->level;
    (void)atomic_fetch_add_explicit(&search->arcs, worker->arcs - own->reported_arcs, memory_order_relaxed);
    (void)atomic_fetch_add_explicit(&search->expanded, worker->states - own->reported_states, memory_order_relaxed);
    own->reported_arcs = worker->arcs;
    own->reported_states = worker->states;
    if (search->run->options.is_depth_first) {
        uint64_t deepest = atomic_load_explicit(&search->deepest, memory_order_relaxed);
        while ((deepest < own->deepest) && !atomic_compare_exchange_weak(&search->deepest, &deepest, own->deepest)) {
        }
    }
}

void ex_progress(ex_run_t *run, ex_progress_t *progress)
{
    const bool has_begun = atomic_load(&run->has_begun);
    const ex_level_t *search = has_begun ? run->level : NULL;
    const uint64_t known = has_begun ? atomic_load_explicit(&run->store.used, memory_order_relaxed) : 0U;
    const uint64_t states = (has_begun && (run->sweep != NULL)) ? ex_sweep_states(run) : known;
    *progress = (ex_progress_t){ .states = states }; /* before the search there is nothing else */
    if (search != NULL) {
        const uint64_t expanded = atomic_load_explicit(&search->expanded, memory_order_relaxed);
        progress->arcs = atomic_load_explicit(&search->arcs, memory_order_relaxed);
        progress->depth = atomic_load_explicit(&search->deepest, memory_order_relaxed);
        progress->frontier = (states > expanded) ? (states - expanded) : 0U;
    }
}

/* One of many searches: some successors are not taken, or one is. */
static bool on_last_arc(void *user, uint32_t transition, uint32_t times, const ex_key_t *found)
{
    ex_worker_t *worker = user;
    (void)found;
    worker->fired[transition] += times;
    worker->arcs += times;
    return true;
}

static bool on_walk_arc(void *user, uint32_t transition, uint32_t times, const ex_key_t *found)
{
    (void)on_last_arc(user, transition, times, found);
    return ex_walk_take(user, transition, times, found);
}

static ex_found_t arcs_of_swarm(ex_worker_t *worker, const ex_key_t *key)
{
    if (worker->run->options.is_walk) {
        return ex_arcs(worker, key, on_walk_arc, worker);
    }
    return ex_arcs(worker, key, ex_swarm_is_end(worker->run) ? on_last_arc : on_arc, worker);
}

bool ex_expand_state(ex_worker_t *worker, const ex_key_t *key)
{
    ex_found_t found;
    if ((worker->early != NULL) && ex_early_avoids(worker, key)) {
        atomic_store(&worker->run->has_avoided, true);
        ex_bounds_see(worker);
        return true;
    }
    if (worker->search->words != NULL) {
        found = ex_words_successors(worker, key->low);
    } else if (ex_flat_is_ready(worker)) {
        found = ex_flat_successors(worker, key);
    } else if (worker->run->swarm != NULL) {
        found = arcs_of_swarm(worker, key);
    } else {
        found = ex_arcs(worker, key, on_arc, worker);
    }
    switch (found) {
    case EX_SOME: break;
    case EX_DEAD: worker->dead++; break;
    case EX_STOPPED: ex_bounds_see(worker); return false;
    case EX_FAILED:
    default: return false;
    }
    worker->states++;
    ex_bounds_see(worker);
    if (worker->early != NULL) {
        ex_early_see(worker, key, found);
    }
    if ((worker->run->swarm != NULL) && (found == EX_DEAD)) {
        ex_swarm_dead(worker);
    }
    if ((worker->run->sweep != NULL) && (found == EX_DEAD)) {
        ex_sweep_dead(worker->run);
    }
    if ((worker->states % (uint64_t)REPORTED) == 0U) {
        report(worker);
    }
    return true;
}

/* A level that is one chunk, for several threads. With the gate locked. */
static void split(ex_level_t *search)
{
    ex_chunk_t *chunk = search->now;
    const uint32_t parts = search->run->options.threads;
    while ((search->parts < parts) && (chunk->count >= (2U * (uint32_t)SHARED_FROM))) {
        ex_chunk_t *other = ex_chunk_spare(search);
        other = (other != NULL) ? other : ex_alloc(&search->run->memory, (uint64_t)EX_CHUNK_SIZE);
        if (other == NULL) {
            return;
        }
        const uint32_t given = chunk->count / (parts - search->parts + 1U);
        other->count = given;
        chunk->count -= given;
        (void)memcpy(other->byte, &chunk->byte[(size_t)chunk->count * search->stride], (size_t)given * search->stride);
        other->next = search->now;
        search->now = other;
        search->parts++;
    }
}

/* The keys of this level become other ones. */
static void replace_level(ex_run_t *run, ex_replace_t one, const void *layout)
{
    const ex_level_t *search = run->level;
    for (ex_chunk_t *chunk = search->now; chunk != NULL; chunk = chunk->next) {
        const uint32_t count = chunk->count;
        ex_key_t before = { 0U, 0U };
        for (chunk->count = 0U; chunk->count < count;) {
            /* Writing an entry touches the beginning of the next one. */
            ex_key_t key;
            ex_key_t next = { 0U, 0U };
            if (chunk->count == 0U) {
                (void)ex_chunk_get(search, chunk, 0U, &before);
            }
            key = before;
            if ((chunk->count + 1U) < count) {
                (void)ex_chunk_get(search, chunk, chunk->count + 1U, &next);
            }
            one(layout, &key);
            ex_chunk_put(search, chunk, &key, 0U);
            before = next;
        }
    }
}

/* Between two levels, when there are enough states to see which words of their vectors depend on each other. With the
 * gate locked, and nobody else at work. */
static void lay_again(ex_run_t *run)
{
    ex_level_t *search = run->level;
    run->is_laid_again = true;
    if (!ex_layout_again(run, replace_level)) {
        search->now = NULL; /* neither keys of the one kind nor of the other */
        ex_stop(run, EX_MEMORY);
    }
    for (uint32_t i = 0U; i < run->options.threads; i++) {
        ex_unload(&run->worker[i]);
        ex_flat_lay(&run->worker[i]);
        (void)memset(run->worker[i].search->recent, 0, sizeof run->worker[i].search->recent);
    }
}

/* A chunk to expand; NULL when there is none and never will be. `used` was expanded and is free again. */
static ex_chunk_t *take_chunk(ex_worker_t *worker, ex_chunk_t *used)
{
    ex_run_t *run = worker->run;
    ex_search_t *own = worker->search;
    ex_level_t *search = own->level;
    ex_chunk_t *chunk = NULL;
    report(worker);
    (void)pthread_mutex_lock(&run->gate);
    if (used != NULL) {
        used->next = search->spare;
        search->spare = used;
    }
    while (!search->is_finished && !ex_is_stopping(run)) {
        if (search->now != NULL) {
            chunk = search->now;
            search->now = chunk->next;
            break;
        }
        if (!run->options.is_depth_first) {
            ex_hand_over(own);
        }
        if (run->at_work > 1U) {
            /* Others are still at it. */
            run->at_work--;
            (void)atomic_fetch_add_explicit(&search->hungry, 1U, memory_order_relaxed);
            ex_check_pause(run);
            ex_wait(run);
            (void)atomic_fetch_sub_explicit(&search->hungry, 1U, memory_order_relaxed);
            run->at_work++;
            continue;
        }
        search->now = search->next;
        search->next = NULL;
        if (search->now == NULL) {
            search->is_finished = true;
        } else {
            search->depth++;
            search->parts = 1U;
            if (own->is_exact && !run->is_laid_again && (atomic_load(&run->store.used) >= run->options.lay_again)) {
                lay_again(run);
            }
            if ((search->now != NULL) && (search->now->next == NULL) && (run->options.threads > 1U)) {
                split(search);
            }
            atomic_store_explicit(&search->deepest, search->depth, memory_order_relaxed);
        }
        if ((search->now == NULL) || (search->now->next != NULL)) {
            (void)pthread_cond_broadcast(&run->gate_changed);
        }
    }
    if (chunk == NULL) {
        (void)pthread_cond_broadcast(&run->gate_changed);
    }
    (void)pthread_mutex_unlock(&run->gate);
    return chunk;
}

/* Breadth first: everything in a chunk, from the first to the last. */
static bool expand_chunk(ex_worker_t *worker, ex_chunk_t *chunk)
{
    ex_search_t *own = worker->search;
    bool goes_on = true;
    own->expanding = chunk;
    for (chunk->taken = 0U; goes_on && (chunk->taken < chunk->count); chunk->taken++) {
        ex_key_t key;
        (void)ex_chunk_get(own->level, chunk, chunk->taken, &key);
        goes_on = ex_expand_state(worker, &key);
    }
    if (goes_on) {
        own->expanding = NULL;
    }
    return goes_on && ex_flush_all(worker);
}

/* Depth first: the top of the stack, until it is empty. */
static bool expand_stack(ex_worker_t *worker)
{
    ex_search_t *own = worker->search;
    ex_level_t *search = own->level;
    while (own->out != NULL) {
        ex_key_t key;
        if (own->out->count == 0U) {
            ex_chunk_t *empty = own->out;
            own->out = empty->next;
            (void)pthread_mutex_lock(&search->run->gate);
            empty->next = search->spare;
            search->spare = empty;
            (void)pthread_mutex_unlock(&search->run->gate);
            continue;
        }
        own->out->count--;
        own->depth = ex_chunk_get(search, own->out, own->out->count, &key) + 1U;
        if ((search->run->swarm != NULL) && !ex_swarm_at(worker, &key, own->depth - 1U)) {
            return false;
        }
        if (!ex_expand_state(worker, &key) || !ex_flush_all(worker)) {
            return false;
        }
    }
    return true;
}

static void work(ex_worker_t *worker, void *user)
{
    ex_search_t *own = worker->search;
    ex_chunk_t *used = NULL;
    bool goes_on = true;
    (void)user;
    while (goes_on) {
        ex_chunk_t *chunk = take_chunk(worker, used);
        if (chunk == NULL) {
            break;
        }
        used = NULL;
        if (worker->run->options.is_depth_first) {
            chunk->next = NULL;
            own->out = chunk;
            own->bottom = chunk;
            goes_on = expand_stack(worker);
        } else {
            goes_on = expand_chunk(worker, chunk);
            used = chunk;
        }
    }
    if (!goes_on) {
        (void)pthread_mutex_lock(&worker->run->gate);
        (void)pthread_cond_broadcast(&worker->run->gate_changed);
        (void)pthread_mutex_unlock(&worker->run->gate);
    }
}

/* --- the run ------------------------------------------------------------------------------------------------------ */

static uint64_t mask_of(uint32_t bytes)
{
    return (bytes < 8U) ? ((((uint64_t)1U) << (bytes * 8U)) - 1U) : UINT64_MAX;
}

/* The initial state. */
static bool begin(ex_run_t *run, ex_level_t *search)
{
    ex_worker_t *first = &run->worker[0];
    run->at_work = 1U; /* tables may grow already */
    if (!pn_marking_init(&pn_net, &first->cx, first->marking)) {
        ex_fail(first, -1);
        return false;
    }
    ex_derived_start(run, first->marking);
    ex_reduce_time(first);
    if (!ex_layout(run) || !pn_marking_init(&pn_net, &first->cx, first->marking)) {
        ex_stop(run, EX_MEMORY);
        return false;
    }
    ex_reduce_time(first);
    if (run->counts != NULL) {
        ex_counts_begin(run, first->marking);
    }
    if ((first->exchange != NULL) && !ex_instances_are_even(first, first->marking)) {
        ex_note(run, "reduction", "the parts that are exchanged do not hold the same at first", -1);
        return false;
    }
    if (!ex_encode(first, first->marking, &run->initial)) {
        return false;
    }
    for (uint32_t i = 0U; i < run->options.threads; i++) {
        ex_flat_lay(&run->worker[i]);
    }
    uint32_t width[EX_KEY_WORDS] = { 32U, 32U, 0U, 0U };
    const uint32_t length = run->codec->roots * (uint32_t)sizeof(uint32_t);
    if (!run->options.is_hashed) {
        ex_key_widths(run, width);
    }
    if (run->options.is_bitstate
            ? !ex_bits_make(&run->bits, &run->memory)
            : !ex_store_make(&run->store, &run->memory, &run->team, ex_has_words(run), width, (uint64_t)FIRST_KEYS)) {
        ex_stop(run, EX_MEMORY);
        return false;
    }
    search->stride = length + (run->options.is_depth_first ? (uint32_t)sizeof(uint32_t) : 0U);
    search->capacity = (uint32_t)(((size_t)EX_CHUNK_SIZE - sizeof(ex_chunk_t) - sizeof(ex_key_t)) / search->stride);
    search->low_mask = mask_of(length);
    search->high_mask = (length > 8U) ? mask_of(length - 8U) : 0U;
    ex_pending_t pending = { .key = run->initial, .stored = run->initial, .hash = ex_hash(&run->initial) };
    if (run->options.is_bitstate || run->options.is_hashed) {
        shorten(run, &pending);
    }
    (void)insert(run, &pending);
    atomic_store(&run->store.used, 1U);
    ex_chunk_t *chunk = ex_chunk_new(search);
    if (chunk == NULL) {
        return false;
    }
    ex_chunk_put(search, chunk, &run->initial, 0U);
    search->now = chunk;
    return (run->sweep == NULL) || ex_sweep_begin(run);
}

/* States that have been found and not expanded belong to the bounds, too. */
static bool see_chunks(ex_run_t *run, const ex_chunk_t *chunk, uint32_t from, bool is_list)
{
    ex_worker_t *worker = &run->worker[0];
    for (; chunk != NULL; chunk = is_list ? chunk->next : NULL) {
        if (ex_is_late(run)) {
            return false;
        }
        for (uint32_t i = from; i < chunk->count; i++) {
            ex_key_t key;
            (void)ex_chunk_get(run->level, chunk, i, &key);
            if (ex_load(worker, &key)) {
                ex_bounds_see(worker);
            }
        }
    }
    return true;
}

bool ex_see_rest(ex_run_t *run)
{
    const ex_level_t *search = run->level;
    if ((search == NULL) || run->is_searched) {
        return true;
    }
    run->worker[0].cx.error = PN_OK; /* has been noted */
    if (run->sweep != NULL) {
        return ex_sweep_see_rest(run);
    }
    bool is_seen = see_chunks(run, search->now, 0U, true) && see_chunks(run, search->next, 0U, true);
    for (uint32_t i = 0U; is_seen && (i < run->options.threads); i++) {
        const ex_search_t *own = run->worker[i].search;
        is_seen = (own == NULL)
                  || (see_chunks(run, own->out, 0U, run->options.is_depth_first)
                      && ((own->expanding == NULL) || see_chunks(run, own->expanding, own->expanding->taken, false)));
    }
    return is_seen;
}

double ex_rest_measure(ex_worker_t *teller, uint32_t most)
{
    const ex_level_t *const level = teller->run->level;
    const ex_chunk_t *const chunk = (level->now != NULL) ? level->now : level->next;
    const uint32_t count = (chunk == NULL) ? 0U : ((chunk->count < most) ? chunk->count : most);
    const double began = ex_clock();
    for (uint32_t i = 0U; i < count; i++) {
        ex_key_t key;
        (void)ex_chunk_get(level, chunk, i, &key);
        if (ex_load(teller, &key)) {
            ex_bounds_see(teller);
        }
    }
    return (count > 0U) ? ((ex_clock() - began) / (double)count) : 0.0;
}

static void sum_up(ex_run_t *run, const ex_level_t *search)
{
    run->nodes = (run->sweep != NULL) ? ex_sweep_states(run) : atomic_load(&run->store.used);
    run->depth = search->depth;
    for (uint32_t i = 0U; i < run->options.threads; i++) {
        const ex_worker_t *worker = &run->worker[i];
        run->expanded += worker->states;
        run->arcs += worker->arcs;
        run->dead_count += worker->dead;
        if (run->options.is_depth_first && (worker->search->deepest > run->depth)) {
            run->depth = worker->search->deepest;
        }
        for (uint32_t t = 0U; t < pn_net.transition_count; t++) {
            run->fired[t] += worker->fired[t];
        }
    }
}

bool ex_explore(ex_run_t *run)
{
    ex_level_t *search = ex_alloc(&run->memory, sizeof *search);
    if (search == NULL) {
        ex_stop(run, EX_MEMORY);
        return false;
    }
    search->run = run;
    run->level = search;
    for (uint32_t i = 0U; i < run->options.threads; i++) {
        run->worker[i].search = ex_alloc(&run->memory, sizeof *run->worker[i].search);
        if (run->worker[i].search == NULL) {
            ex_stop(run, EX_MEMORY);
            return false;
        }
        run->worker[i].search->level = search;
        run->worker[i].search->is_exact = ex_is_exact(run);
        /* Numbers that are near each other make very different ones. */
        run->worker[i].search->random = run->options.is_depth_first ? (run->options.shuffle * 0x9e3779b97f4a7c15U) : 0U;
        if (!ex_words_make(&run->worker[i]) || !ex_local_make(&run->worker[i]) || !ex_flat_make(&run->worker[i])) {
            ex_stop(run, EX_MEMORY);
            return false;
        }
    }
    const double started = ex_clock();
    const double cpu_started = ex_cpu_clock();
    if (begin(run, search)) {
        atomic_store(&run->has_begun, true);
        ex_parallel(run, (run->sweep != NULL) ? ex_sweep_work : (run->options.is_walk ? ex_walk : work), NULL);
    }
    sum_up(run, search);
    if (run->options.is_bitstate) {
        run->omission_probability = ex_bits_omission(&run->bits);
        run->approximate_bytes = run->bits.bytes;
    } else if (run->options.is_hashed) {
        const double nodes = (double)run->nodes;
        run->omission_probability = -expm1(-(nodes * nodes) / 36893488147419103232.0); /* pairs that share 64 bits */
    }
    if (atomic_load(&run->has_avoided) && (atomic_load(&run->why) == (int)EX_COMPLETE)) {
        ex_stop(run, EX_STATES); /* what comes after them was not seen */
    }
    run->seconds = ex_clock() - started;
    run->cpu_seconds = ex_cpu_clock() - cpu_started;
    run->is_searched = atomic_load(&run->why) == (int)EX_COMPLETE;
    return true;
}
