/* SPDX-License-Identifier: MIT
 * explore_key.h - what stands for a state, and hashes of it.
 */
#ifndef EXPLORE_KEY_H
#define EXPLORE_KEY_H

#include <stdint.h>

__extension__ typedef unsigned __int128 ex_wide_t;

/* What is rare is kept out of what is frequent. */
#if defined(__GNUC__)
#define EX_APART __attribute__((noinline))
#else
#define EX_APART
#endif

/* The same number, in a register of its own: two words that were stored one by one are not to be loaded as one. */
static inline uint64_t ex_alone(uint64_t x)
{
#if defined(__GNUC__)
    __asm__("" : "+r"(x));
#endif
    return x;
}

/* What stands for a state: up to four words, the lower half of `low` first; the rest zero. */
typedef struct ex_key {
    uint64_t low;
    uint64_t high;
} ex_key_t;

#define EX_KEY_WORDS 4U

/* The largest `low` of keys that are kept as one word. */
#define EX_MOST_WORD (UINT64_MAX >> 1U)

/* Of a key of one word. */
static inline uint64_t ex_word_hash(uint64_t low)
{
    const ex_wide_t product = (ex_wide_t)(low ^ 0x9e3779b97f4a7c15U) * 0xe7037ed1a0b428dbU;
    return (uint64_t)product ^ (uint64_t)(product >> 64U);
}

static inline uint64_t ex_hash(const ex_key_t *key)
{
    if (key->high == 0U) {
        return ex_word_hash(key->low);
    }
    /* Product of 128 bits, folded, twice. */
    const ex_wide_t first = (ex_wide_t)(key->low ^ 0x9e3779b97f4a7c15U) * (key->high ^ 0xd6e8feb86659fd93U);
    const uint64_t folded = (uint64_t)first ^ (uint64_t)(first >> 64U) ^ key->low;
    const ex_wide_t second = (ex_wide_t)(folded ^ 0xa0761d6478bd642fU) * 0xe7037ed1a0b428dbU;
    return (uint64_t)second ^ (uint64_t)(second >> 64U);
}

/* A hash, scaled to 0 .. count - 1; in the same order. */
static inline uint64_t ex_scaled(uint64_t hash, uint64_t count)
{
    return (uint64_t)(((ex_wide_t)hash * count) >> 64U);
}

#endif /* EXPLORE_KEY_H */
