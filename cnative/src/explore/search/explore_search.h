/* SPDX-License-Identifier: MIT
 * explore_search.h - what is shared by the parts of the search: the loop (explore_search.c), states that are still to
 * be expanded (explore_frontier.c), states of one word (explore_words.c).
 */
#ifndef EXPLORE_SEARCH_H
#define EXPLORE_SEARCH_H

#include "../explore_run.h"
#include "explore_successors.h"
#include "pn/pn_arena.h"

enum {
    EX_CHUNK_SIZE = 1 << 14,
    EX_BATCH = 64,
    EX_RECENT = 1 << 13 /* a power of two: as many as a cache near the processor holds */
};

/* Keys behind one another; in depth-first search each with its depth. */
typedef struct ex_chunk {
    struct ex_chunk *next;
    uint32_t count;
    uint32_t taken; /* from the beginning; of a chunk that is being expanded */
    unsigned char byte[];
} ex_chunk_t;

typedef struct ex_level {
    ex_run_t *run;
    uint32_t stride;   /* bytes of an entry */
    uint32_t capacity; /* entries of a chunk */
    uint64_t low_mask; /* of ex_key_t: which bytes are part of a key */
    uint64_t high_mask;
    ex_chunk_t *now;  /* of this level, or given away */
    ex_chunk_t *next; /* of the next level */
    ex_chunk_t *spare;
    uint64_t depth;
    uint32_t parts;
    _Atomic uint32_t hungry;   /* threads without work */
    _Atomic uint64_t expanded; /* for the progress: as of the last chunks */
    _Atomic uint64_t arcs;
    _Atomic uint64_t deepest;
    bool is_finished;
} ex_level_t;

typedef struct ex_pending {
    ex_key_t key;
    ex_key_t stored; /* what stands for it in the store */
    uint64_t hash;
} ex_pending_t;

typedef struct ex_search {
    ex_level_t *level;
    ex_chunk_t *out;            /* being filled; depth first: the top of the stack */
    ex_chunk_t *expanding;      /* breadth first */
    ex_chunk_t *bottom;         /* depth first: the lowest chunk of the stack (`next` leads downwards) */
    ex_key_t recent[EX_RECENT]; /* keys that are in the store, or in the batch; zero: none, or the key that is zero */
    ex_pending_t batch[EX_BATCH];
    uint32_t pending;
    uint64_t random; /* decides the order of successors; 0: nothing does */
    bool is_exact;
    struct ex_words *words; /* of explore_words.c; NULL: states are not made that way */
    struct ex_flat *flat;   /* of explore_flat.c; the same */
    uint64_t depth;         /* of the successors */
    uint64_t deepest;
    uint64_t reported_arcs;
    uint64_t reported_states;
} ex_search_t;

/* --- explore_frontier.c ------------------------------------------------------------------------------------------- */

/* NULL: no memory, the run stops. */
ex_chunk_t *ex_chunk_new(ex_level_t *level);
/* One that is not used any more; NULL: there is none. With the gate locked. */
ex_chunk_t *ex_chunk_spare(ex_level_t *level);
void ex_chunk_put(const ex_level_t *level, ex_chunk_t *chunk, const ex_key_t *key, uint64_t depth);
/* The depth. */
uint64_t ex_chunk_get(const ex_level_t *level, const ex_chunk_t *chunk, uint32_t i, ex_key_t *key);
/* Gives the chunk that is being filled to the next level. With the gate locked. */
void ex_hand_over(ex_search_t *own);
/* A state that has been found for the first time. False: no memory. */
bool ex_add_new(ex_search_t *own, const ex_key_t *key);

/* --- explore_search.c --------------------------------------------------------------------------------------------- */

/* Before a batch is inserted: lets the store grow if need be. False when the run stops. */
bool ex_batch_begin(ex_worker_t *worker);
/* All that is done with a state. False when the run stops. */
bool ex_expand_state(ex_worker_t *worker, const ex_key_t *key);
/* Of bit states: whether a state seems not to have been seen; from now on it has been. */
bool ex_is_new(ex_run_t *run, const ex_key_t *key);
/* Whether it may be that there are as many states as there may be before the batch is inserted. */
static inline bool ex_is_near_limit(const ex_run_t *run)
{
    const uint64_t used = atomic_load_explicit(&run->store.used, memory_order_relaxed);
    const uint64_t most = run->options.max_states;
    /* Threads that insert at the same moment may go beyond it. */
    return (used >= most) || ((most - used) <= (2U * (uint64_t)EX_BATCH * run->options.threads));
}

/* A key that has been found, into the batch. False when the run stops. */
bool ex_take(ex_worker_t *worker, const ex_key_t *key, uint64_t hash);
/* Inserts all that has been found. False when the run stops. */
bool ex_flush_all(ex_worker_t *worker);
/* A little before ex_take. */
static inline void ex_take_soon(const ex_search_t *own, uint64_t hash)
{
    __builtin_prefetch(&own->recent[hash % (uint64_t)EX_RECENT], 1, 3);
}

/* --- explore_flat.c ----------------------------------------------------------------------------------------------- */

/* Where it is possible. False: no memory. */
bool ex_flat_make(ex_worker_t *worker);
/* When the codec has other parts of keys than before. */
void ex_flat_lay(ex_worker_t *worker);
/* Whether keys are such that states are made that way. */
bool ex_flat_is_ready(const ex_worker_t *worker);
/* As ex_successors, with the search for a sink; some successors stay until ex_flat_finish. */
ex_found_t ex_flat_successors(ex_worker_t *worker, const ex_key_t *key);
/* Gives the search all that has stayed. False when the run stops. */
bool ex_flat_finish(ex_worker_t *worker);

/* --- explore_words.c ---------------------------------------------------------------------------------------------- */

/* Where it is possible. False: no memory. */
bool ex_words_make(ex_worker_t *worker);
/* As ex_successors, with the search for a sink; `word`: `low` of the key. */
ex_found_t ex_words_successors(ex_worker_t *worker, uint64_t word);
/* Inserts all that has been collected. False when the run stops. */
bool ex_words_flush(ex_worker_t *worker);

/* Adds the words of all successors by a transition, of the loaded state. False after an error. */
static inline bool ex_add_words(ex_worker_t *worker, uint32_t t, pn_words_t *made)
{
    const size_t mark = ex_arena_begin(worker);
    (void)pn_net.transition[t].words(made, t);
    ex_arena_end(worker, mark);
    if (worker->cx.error != PN_OK) {
        ex_fail(worker, (int64_t)t);
        return false;
    }
    return true;
}

#endif /* EXPLORE_SEARCH_H */
