/* SPDX-License-Identifier: MIT
 * explore_words.c - the search where a state is one word: generated functions make the words of all successors of a
 * state, and the store holds them as they are.
 */
#include "explore_search.h"
#include "explore_successors.h"
#include "../store/explore_words.h"

#include <string.h>

enum {
    FOUND = EX_BATCH,
    RECENT = 1 << 15, /* a power of two: as many as a cache near the processor holds */
    BATCH = EX_BATCH,
    LATE = 24 /* of a batch that stay until the next time: their lines are still on the way */
};

typedef struct late {
    uint64_t word;
    uint64_t hash;
} late_t;

typedef struct ex_words {
    ex_worker_t *worker;
    pn_words_t made;
    uint64_t drained; /* words that were taken out of `made` before */
    bool is_stopped;
    uint32_t pending;
    late_t batch[BATCH + FOUND]; /* as many as a batch, and what was made until that was seen */
    uint64_t word[FOUND];
    uint64_t recent[RECENT]; /* words + 1 that are in the store, or in the batch; 0: none */
} ex_words_t;

static bool drain(pn_words_t *made);

bool ex_words_make(ex_worker_t *worker)
{
    const ex_run_t *run = worker->run;
    bool is_possible = run->codec->is_word && worker->search->is_exact && (run->reduction == NULL) && !pn_net.timed
                       && (run->owner_of == NULL) && (run->programs == NULL) && (run->sweep == NULL);
    for (uint32_t t = 0U; is_possible && (t < pn_net.transition_count); t++) {
        is_possible = pn_net.transition[t].words != NULL;
    }
    if (!is_possible) {
        return true;
    }
    ex_words_t *const own = ex_alloc(&worker->run->memory, sizeof *own);
    if (own == NULL) {
        return false;
    }
    own->worker = worker;
    own->made = (pn_words_t){ .cx = &worker->cx,
                              .marking = worker->marking,
                              .word = own->word,
                              .room = (uint32_t)FOUND,
                              .is_full = drain,
                              .user = own };
    worker->search->words = own;
    return true;
}

/* --- into the store ----------------------------------------------------------------------------------------------- */

/* The first of the batch, one by one: so many states that there may be no more of them soon. */
static bool insert_carefully(ex_worker_t *worker, uint32_t count)
{
    ex_run_t *run = worker->run;
    ex_words_t *const own = worker->search->words;
    ex_store_t *store = &run->store;
    for (uint32_t i = 0U; i < count; i++) {
        const late_t *late = &own->batch[i];
        const ex_key_t key = { late->word, 0U };
        uint64_t slot;
        if (atomic_load_explicit(&store->used, memory_order_relaxed) >= run->options.max_states) {
            if (ex_word_find(store, late->word, late->hash) == EX_NO_SLOT) {
                ex_stop(run, EX_STATES);
                return false;
            }
            continue;
        }
        ex_insertion_t insertion = ex_word_insert(store, late->word, late->hash, &slot);
        while (insertion == EX_FULL) {
            if (!ex_pause(worker)) {
                return false;
            }
            insertion = ex_word_insert(store, late->word, late->hash, &slot);
        }
        if (insertion == EX_NEW) {
            (void)atomic_fetch_add_explicit(&store->used, 1U, memory_order_relaxed);
            if (!ex_add_new(worker->search, &key)) {
                return false;
            }
        }
    }
    return true;
}

/* The first of the batch, with nobody else at it: without a branch on what is new. Gives how many are done: fewer than
 * `count` when a line is full, or the chunk. */
static uint32_t insert_alone(ex_worker_t *worker, uint32_t count, uint64_t *found)
{
    ex_words_t *const own = worker->search->words;
    ex_search_t *const search = worker->search;
    const ex_store_t *const store = &worker->run->store;
    uint64_t *const lines = (uint64_t *)(void *)store->bucket;
    ex_chunk_t *const out = search->out;
    if ((out == NULL) || worker->run->options.is_depth_first) {
        return 0U;
    }
    const uint32_t before = out->count;
    uint32_t room = search->level->capacity - before;
    uint32_t done = 0U;
    for (; (done < count) && (room > 0U); done++) {
        const late_t late = own->batch[done];
        uint64_t *const line = &lines[ex_scaled(late.hash, store->buckets) * EX_LINE_WORDS];
        const ex_line_view_t view = ex_line_look(line, late.word + 1U);
        const uint32_t either = view.same | view.vacant;
        if (either == 0U) {
            break;
        }
        /* Words of a line are taken from the first on: the word itself comes before any that is free. */
        line[(uint32_t)__builtin_ctz(either)] = late.word + 1U;
        const ex_key_t key = { late.word, 0U };
        ex_chunk_put(search->level, out, &key, 0U);
        const uint32_t known = (view.same != 0U) ? 1U : 0U;
        out->count -= known;
        room -= 1U - known;
    }
    *found += out->count - before;
    return done;
}

/* Inserts all of the batch but the last `kept` ones. */
static EX_APART bool insert(ex_worker_t *worker, uint32_t kept)
{
    ex_words_t *const own = worker->search->words;
    if (!ex_batch_begin(worker)) {
        return false;
    }
    ex_store_t *store = &worker->run->store;
    const uint32_t count = own->pending - kept;
    uint32_t done = 0U;
    uint64_t found = 0U;
    bool goes_on = true;
    if (!ex_is_near_limit(worker->run)) {
        if (worker->run->options.threads == 1U) {
            done = insert_alone(worker, count, &found);
        }
        for (; goes_on && (done < count); done++) {
            const late_t *late = &own->batch[done];
            const ex_key_t key = { late->word, 0U };
            uint64_t slot;
            const ex_insertion_t insertion = ex_word_insert(store, late->word, late->hash, &slot);
            if (insertion == EX_NEW) {
                found++;
                goes_on = ex_add_new(worker->search, &key);
            } else if (insertion == EX_FULL) {
                break;
            }
        }
        (void)atomic_fetch_add_explicit(&store->used, found, memory_order_relaxed);
    }
    own->pending -= done;
    (void)memmove(own->batch, &own->batch[done], own->pending * sizeof own->batch[0]);
    if (goes_on && (done < count)) {
        goes_on = insert_carefully(worker, count - done);
        own->pending -= count - done;
        (void)memmove(own->batch, &own->batch[count - done], own->pending * sizeof own->batch[0]);
    }
    return goes_on && !ex_is_stopping(worker->run);
}

bool ex_words_flush(ex_worker_t *worker)
{
    return insert(worker, 0U);
}

/* Takes the words that have been made: those that were met a short while ago are passed over (whether that is so nobody
 * can foretell: there is no branch on it), of the others the lines of the store are sent for. */
static bool drain(pn_words_t *made)
{
    ex_words_t *const own = made->user;
    const ex_store_t *store = &own->worker->run->store;
    const uint32_t before = own->pending;
    uint32_t pending = before;
    uint64_t hashes[FOUND];
    for (uint32_t i = 0U; i < made->count; i++) {
        hashes[i] = ex_word_hash(made->word[i]);
        __builtin_prefetch(&own->recent[hashes[i] % (uint64_t)RECENT], 1, 3);
    }
    for (uint32_t i = 0U; i < made->count; i++) {
        const uint64_t word = made->word[i];
        const uint64_t hash = hashes[i];
        uint64_t *const recent = &own->recent[hash % (uint64_t)RECENT];
        own->batch[pending] = (late_t){ .word = word, .hash = hash };
        pending += (*recent != (word + 1U)) ? 1U : 0U;
        *recent = word + 1U;
    }
    for (uint32_t i = before; i < pending; i++) {
        ex_store_prefetch(store, own->batch[i].hash);
    }
    own->pending = pending;
    own->drained += made->count;
    made->count = 0U;
    if ((pending >= (uint32_t)BATCH) && !insert(own->worker, (uint32_t)LATE)) {
        own->is_stopped = true;
        return false;
    }
    return true;
}

/* --- successors --------------------------------------------------------------------------------------------------- */

ex_found_t ex_words_successors(ex_worker_t *worker, uint64_t word)
{
    ex_words_t *const own = worker->search->words;
    const ex_key_t key = { word, 0U };
    int32_t priority = 0;
    own->drained = 0U;
    own->made.count = 0U;
    (void)ex_load(worker, &key);
    for (uint32_t k = 0U; k < pn_net.order_count; k++) {
        const uint32_t t = pn_net.order[k];
        const pn_transition_t *transition = &pn_net.transition[t];
        const uint64_t before = own->drained + own->made.count;
        if ((before > 0U) && (transition->priority != priority)) {
            break;
        }
        priority = transition->priority;
        const bool is_fine = ex_add_words(worker, t, &own->made);
        worker->fired[t] += (own->drained + own->made.count) - before;
        if (!is_fine) {
            return EX_FAILED;
        }
        if (own->is_stopped) {
            return EX_STOPPED;
        }
    }
    const uint64_t arcs = own->drained + own->made.count;
    worker->arcs += arcs;
    if (!drain(&own->made)) {
        return EX_STOPPED;
    }
    return (arcs > 0U) ? EX_SOME : EX_DEAD;
}
