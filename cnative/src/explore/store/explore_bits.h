/* SPDX-License-Identifier: MIT
 * explore_bits.h - bit states: three bits of a table stand for a state (explore_bits.c).
 */
#ifndef EXPLORE_BITS_H
#define EXPLORE_BITS_H

#include <pthread.h>
#include <stdatomic.h>

#include "explore_store.h"

/* Three bits of a word for each state. */
typedef struct ex_bits {
    _Atomic uint64_t *word;
    uint64_t words;
    uint64_t bytes;
    _Atomic uint64_t inserted;
    pthread_mutex_t lock; /* of what follows */
    double expected;      /* states that have been missed, as far as estimated */
    double last;          /* probability that the next one is */
} ex_bits_t;

bool ex_bits_make(ex_bits_t *bits, ex_memory_t *memory);
/* `hash` has to be a good one, and is all that counts of a state. */
ex_insertion_t ex_bits_insert(ex_bits_t *bits, uint64_t hash);
bool ex_bits_hold(const ex_bits_t *bits, uint64_t hash);
/* The part of the bits that are set, from a sample. */
double ex_bits_occupancy(const ex_bits_t *bits);
/* The probability that at least one state was missed. */
double ex_bits_omission(ex_bits_t *bits);

static inline void ex_bits_prefetch(const ex_bits_t *bits, uint64_t hash)
{
    __builtin_prefetch(&bits->word[ex_scaled(hash, bits->words)], 1, 3);
}

#endif /* EXPLORE_BITS_H */
