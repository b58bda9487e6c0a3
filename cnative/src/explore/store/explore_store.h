/* SPDX-License-Identifier: MIT
 * explore_store.h - the set of keys (explore_store.c). Its slots are numbered; a key stays in its slot unless the
 * store grows, which happens during the exploration only (explore_search.c).
 */
#ifndef EXPLORE_STORE_H
#define EXPLORE_STORE_H

#include <stdatomic.h>
#include <stdbool.h>

#include "../state/explore_key.h"
#include "explore_memory.h"
#include "explore_team.h"

#define EX_NO_SLOT    UINT64_MAX
#define EX_SPARE_KEYS 1024U /* a store grows when less room than for so many is left below its limit */

typedef struct ex_store {
    ex_memory_t *memory;
    const ex_team_t *team; /* help when a large table grows */
    bool is_word;          /* of keys of one word: see explore_words.h */
    unsigned char *bucket; /* lines of 64 bytes */
    uint64_t buckets;
    uint64_t limit;               /* keys from which on it ought to grow */
    uint32_t slots;               /* of a bucket */
    uint32_t length;              /* bytes of a key */
    uint32_t width[EX_KEY_WORDS]; /* bits of each word of a key that are kept */
    uint64_t low_mask;            /* the same as masks of ex_key_t */
    uint64_t high_mask;
    /* Written by all threads, in a cache line of its own: the rest is read with each insertion. */
    _Alignas(EX_CACHE_LINE) _Atomic uint64_t used; /* keys; exact while nobody inserts */
} ex_store_t;

typedef enum ex_insertion {
    EX_NEW,
    EX_KNOWN,
    EX_FULL /* nothing was done: it has to grow first (ex_pause) */
} ex_insertion_t;

/* `is_word`: all keys are one word, of at most EX_MOST_WORD. `width`: bits of each word of a key. */
bool ex_store_make(ex_store_t *store, ex_memory_t *memory, const ex_team_t *team, bool is_word,
                   const uint32_t width[EX_KEY_WORDS], uint64_t keys);
void ex_store_free(ex_store_t *store);
/* Nothing is in it any more, and there is as much room as before. Nobody else uses it. */
void ex_store_empty(ex_store_t *store);
/* Makes room, and words of keys as wide as they have to be; does nothing when all is well. False when there is no
 * memory (the store stays as it was, or has lost keys: the run ends). Nobody else uses it. */
bool ex_store_grow(ex_store_t *store, const uint32_t width[EX_KEY_WORDS]);
/* Another table takes the place of the store's, whose number of keys stays: others may read it at any time, to tell how
 * far the exploration is. Nobody else uses the rest. */
void ex_store_replace(ex_store_t *store, const ex_store_t *new);
uint64_t ex_store_bytes(const ex_store_t *store);

static inline void ex_store_prefetch(const ex_store_t *store, uint64_t hash)
{
    __builtin_prefetch(&store->bucket[ex_scaled(hash, store->buckets) * 64U], 1, 3);
}

/* `hash` is ex_hash of the key. Threads may insert at the same time. `slot`: where it is, NULL if that is of no
 * interest. */
ex_insertion_t ex_store_insert(ex_store_t *store, const ex_key_t *key, uint64_t hash, uint64_t *slot);
/* The slot of a key, EX_NO_SLOT when it is not there. */
uint64_t ex_store_find(const ex_store_t *store, const ex_key_t *key, uint64_t hash);
/* Slots are 0 .. ex_store_slots - 1. */
uint64_t ex_store_slots(const ex_store_t *store);
/* The key in a slot; false when the slot is empty. */
bool ex_store_fetch(const ex_store_t *store, uint64_t slot, ex_key_t *key);

#endif /* EXPLORE_STORE_H */
