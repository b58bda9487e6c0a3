/* SPDX-License-Identifier: MIT
 * explore_bits.c - bit states: of each state three bits of one word are all that is kept.
 *
 * A state whose bits are all set already is taken for known. How probable that is for a new state is measured now and
 * then: in a sample of words, the part of all triples of bits that are set.
 */
#include "explore_bits.h"

#include <math.h>

enum {
    MEASURED = 1 << 14, /* insertions between two measurements */
    SAMPLE = 1 << 11
};

static uint64_t mask_of(uint64_t hash)
{
    /* The upper bits of the hash have chosen the word. Three different bits of 64. */
    uint64_t mask = 0U;
    for (uint64_t rest = hash * 0xd6e8feb86659fd93U; __builtin_popcountll(mask) < 3;
         rest = (rest >> 6U) | (rest << 58U)) {
        mask |= (uint64_t)1U << (rest >> 58U);
        rest += 0x9e3779b97f4a7c15U;
    }
    return mask;
}

bool ex_bits_make(ex_bits_t *bits, ex_memory_t *memory)
{
    const uint64_t used = atomic_load(&memory->used);
    const uint64_t left = (memory->limit > used) ? (memory->limit - used) : 0U;
    bits->bytes = (left / 4U) * 3U; /* the rest is for the frontier */
    bits->words = bits->bytes / sizeof(uint64_t);
    atomic_init(&bits->inserted, 0U);
    (void)pthread_mutex_init(&bits->lock, NULL);
    bits->word = (bits->words > 0U) ? ex_alloc(memory, bits->bytes) : NULL;
    return bits->word != NULL;
}

/* Bits that are set in word `i` of the sample. */
static int set_in(const ex_bits_t *bits, uint64_t i)
{
    const ex_key_t key = { i, atomic_load_explicit(&bits->inserted, memory_order_relaxed) };
    const uint64_t word =
        atomic_load_explicit(&bits->word[ex_scaled(ex_hash(&key), bits->words)], memory_order_relaxed);
    return __builtin_popcountll(word);
}

double ex_bits_occupancy(const ex_bits_t *bits)
{
    uint64_t sum = 0U;
    for (uint64_t i = 0U; i < (uint64_t)SAMPLE; i++) {
        sum += (uint64_t)set_in(bits, i);
    }
    return (double)sum / (64.0 * (double)SAMPLE);
}

/* The probability that three bits of a word are set. */
static double measured(const ex_bits_t *bits)
{
    double sum = 0.0;
    for (uint64_t i = 0U; i < (uint64_t)SAMPLE; i++) {
        const double set = (double)set_in(bits, i);
        sum += (set * (set - 1.0) * (set - 2.0)) / (64.0 * 63.0 * 62.0);
    }
    return sum / (double)SAMPLE;
}

static void measure(ex_bits_t *bits, uint64_t states)
{
    (void)pthread_mutex_lock(&bits->lock);
    const double now = measured(bits);
    bits->expected += (double)states * ((now > bits->last) ? now : bits->last);
    bits->last = now;
    (void)pthread_mutex_unlock(&bits->lock);
}

ex_insertion_t ex_bits_insert(ex_bits_t *bits, uint64_t hash)
{
    const uint64_t mask = mask_of(hash);
    const uint64_t old =
        atomic_fetch_or_explicit(&bits->word[ex_scaled(hash, bits->words)], mask, memory_order_relaxed);
    if ((old & mask) == mask) {
        return EX_KNOWN;
    }
    const uint64_t inserted = atomic_fetch_add_explicit(&bits->inserted, 1U, memory_order_relaxed) + 1U;
    if ((inserted % (uint64_t)MEASURED) == 0U) {
        measure(bits, (uint64_t)MEASURED);
    }
    return EX_NEW;
}

bool ex_bits_hold(const ex_bits_t *bits, uint64_t hash)
{
    const uint64_t mask = mask_of(hash);
    return (atomic_load_explicit(&bits->word[ex_scaled(hash, bits->words)], memory_order_relaxed) & mask) == mask;
}

double ex_bits_omission(ex_bits_t *bits)
{
    measure(bits, atomic_load(&bits->inserted) % (uint64_t)MEASURED);
    return -expm1(-bits->expected);
}
