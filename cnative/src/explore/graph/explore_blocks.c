/* SPDX-License-Identifier: MIT
 * explore_blocks.c - the arcs of nodes, made from their keys.
 *
 * Successors are gathered until there are enough of them that the lines of the store and of the numbers, which are sent
 * for one by one, have arrived when they are needed.
 */
#include "explore_blocks.h"
#include "../search/explore_successors.h"

#include <stdlib.h>

#include "../search/explore_search.h"
#include "../store/explore_words.h"

enum {
    GATHERED = 256, /* arcs that are looked up together, at least when so many are there */
    AHEAD = 8,      /* nodes whose keys are sent for */
    MADE = 256      /* words */
};

/* A successor, or some arcs to the same one. */
typedef struct found {
    ex_key_t key;
    uint64_t hash; /* later: the slot */
    uint32_t times;
    uint16_t label;
    uint16_t node; /* within the block */
} found_t;

struct ex_expander {
    ex_worker_t *worker;
    const ex_store_t *store;
    const ex_graph_t *graph;
    bool is_partial;
    bool is_fine;
    uint16_t node;
    uint16_t label; /* of the words that are being made */
    uint64_t used;
    uint64_t room;
    uint64_t arcs;
    found_t *found;
    pn_words_t made;
    uint64_t word[MADE];
};

static bool drain(pn_words_t *made);

ex_expander_t *ex_expander_make(ex_worker_t *worker, const ex_graph_t *graph, bool is_partial)
{
    ex_expander_t *const x = calloc(1U, sizeof *x);
    if (x != NULL) {
        x->worker = worker;
        x->store = &worker->run->store;
        x->graph = graph;
        x->is_partial = is_partial;
        x->made = (pn_words_t){ .cx = &worker->cx,
                                .marking = worker->marking,
                                .word = x->word,
                                .room = (uint32_t)MADE,
                                .is_full = drain,
                                .user = x };
    }
    return x;
}

void ex_expander_free(ex_expander_t *x)
{
    if (x != NULL) {
        free(x->found);
        free(x);
    }
}

/* --- gathering ---------------------------------------------------------------------------------------------------- */

static bool make_room(ex_expander_t *x, uint64_t more)
{
    if ((x->used + more) <= x->room) {
        return true;
    }
    const uint64_t room = (2U * (x->used + more)) + (uint64_t)GATHERED;
    found_t *const larger = realloc(x->found, room * sizeof *larger);
    if (larger != NULL) {
        x->found = larger;
        x->room = room;
    }
    return larger != NULL;
}

static inline void add(ex_expander_t *x, const ex_key_t *key, uint64_t hash, uint32_t transition, uint32_t times)
{
    ex_store_prefetch(x->store, hash);
    x->found[x->used] =
        (found_t){ .key = *key, .hash = hash, .times = times, .label = (uint16_t)transition, .node = x->node };
    x->used += 1U;
    x->arcs += times;
}

static bool gather(void *user, uint32_t transition, uint32_t times, const ex_key_t *key)
{
    ex_expander_t *const x = user;
    if (!make_room(x, 1U)) {
        return false;
    }
    add(x, key, ex_hash(key), transition, times);
    return true;
}

static bool drain(pn_words_t *made)
{
    ex_expander_t *const x = made->user;
    x->is_fine = x->is_fine && make_room(x, made->count);
    for (uint32_t i = 0U; x->is_fine && (i < made->count); i++) {
        const ex_key_t key = { made->word[i], 0U };
        add(x, &key, ex_word_hash(key.low), x->label, 1U);
    }
    made->count = 0U;
    return x->is_fine;
}

/* As ex_arcs, where states are words (explore_words.c). */
static ex_found_t make_words(ex_expander_t *x, const ex_key_t *key)
{
    ex_worker_t *const worker = x->worker;
    const uint64_t before = x->arcs;
    int32_t priority = 0;
    x->made.count = 0U;
    (void)ex_load(worker, key);
    worker->has_waited = false;
    for (uint32_t k = 0U; k < pn_net.order_count; k++) {
        const uint32_t t = pn_net.order[k];
        const pn_transition_t *const transition = &pn_net.transition[t];
        if ((x->arcs > before) && (transition->priority != priority)) {
            break;
        }
        priority = transition->priority;
        x->label = (uint16_t)t;
        if (!ex_add_words(worker, t, &x->made)) {
            return EX_FAILED;
        }
        if (!drain(&x->made)) {
            return EX_STOPPED;
        }
    }
    return (x->arcs > before) ? EX_SOME : EX_DEAD;
}

/* --- looking up --------------------------------------------------------------------------------------------------- */

static bool reserve(ex_block_t *block, uint64_t more)
{
    if ((block->used + more) <= block->room) {
        return true;
    }
    const uint64_t room = (block->used + more) * 2U;
    uint64_t *const larger = realloc(block->arc, room * sizeof *larger);
    if (larger != NULL) {
        block->arc = larger;
        block->room = room;
    }
    return larger != NULL;
}

/* Appends what was gathered to the block. */
static bool look_up(ex_expander_t *x, ex_block_t *block)
{
    const uint32_t *const number = x->graph->number;
    if (!reserve(block, x->arcs)) {
        return false;
    }
    for (uint64_t i = 0U; i < x->used; i++) {
        found_t *const found = &x->found[i];
        const uint64_t slot = x->store->is_word ? ex_word_find(x->store, found->key.low, found->hash)
                                                : ex_store_find(x->store, &found->key, found->hash);
        if ((slot == EX_NO_SLOT) && !x->is_partial) {
            return false; /* the net does not do the same twice */
        }
        found->hash = slot;
        __builtin_prefetch(&number[(slot != EX_NO_SLOT) ? slot : 0U], 0, 3);
    }
    for (uint64_t i = 0U; i < x->used; i++) {
        const found_t *const found = &x->found[i];
        const uint64_t slot = found->hash;
        if (slot == EX_NO_SLOT) {
            block->is_cut[found->node] = 1U;
        } else {
            const uint64_t target = (number[slot] != 0U) ? (((uint64_t)number[slot] << EX_LABEL_BITS) | EX_NUMBERED)
                                                         : (slot << EX_LABEL_BITS);
            for (uint32_t k = 0U; k < found->times; k++) {
                block->arc[block->used] = target | found->label;
                block->used += 1U;
            }
            block->arcs[found->node] += found->times;
        }
    }
    x->used = 0U;
    x->arcs = 0U;
    return true;
}

bool ex_expand(ex_expander_t *x, ex_block_t *block, uint32_t first, uint32_t count)
{
    const bool is_word = (x->worker->search != NULL) && (x->worker->search->words != NULL);
    const ex_store_t *const store = x->store;
    const uint64_t *const slot = x->graph->slot;
    block->count = count;
    block->used = 0U;
    x->used = 0U;
    x->arcs = 0U;
    x->is_fine = true;
    for (uint32_t i = 0U; i < count; i++) {
        ex_key_t key;
        if ((i + (uint32_t)AHEAD) < count) {
            __builtin_prefetch(&store->bucket[(slot[first + i + (uint32_t)AHEAD] / store->slots) * 64U], 0, 3);
        }
        x->node = (uint16_t)i;
        block->arcs[i] = 0U;
        block->is_cut[i] = 0U;
        block->is_open[i] = 0U;
        const bool is_there = ex_store_fetch(store, slot[first + i], &key);
        const ex_found_t found =
            !is_there ? EX_FAILED : (is_word ? make_words(x, &key) : ex_arcs(x->worker, &key, gather, x));
        block->is_dead[i] = (found == EX_DEAD) ? 1U : 0U;
        block->is_late[i] = x->worker->has_waited ? 1U : 0U;
        if ((found != EX_SOME) && (found != EX_DEAD)) {
            if (!x->is_partial) {
                return false;
            }
            block->is_cut[i] = 1U;
            block->is_open[i] = 1U;
        }
        if (((x->used >= (uint64_t)GATHERED) || ((i + 1U) == count)) && !look_up(x, block)) {
            return false;
        }
    }
    return true;
}
