/* SPDX-License-Identifier: MIT
 * explore_words.h - the store where keys are one word: lines of eight words, each a key + 1, or 0 where there is none.
 * Words of a line are taken from the first to the last, by a compare-and-swap; what does not fit goes to the next line.
 */
#ifndef EXPLORE_WORDS_H
#define EXPLORE_WORDS_H

#include "explore_store.h"

#if defined(__AVX2__) && !defined(__SANITIZE_THREAD__)
#define EX_LINE_VECTOR 1
#include <immintrin.h>
#endif

#define EX_LINE_WORDS 8U

/* Which words of a line are the one that is looked for, or free: one bit each. */
typedef struct ex_line_view {
    uint32_t same;
    uint32_t vacant;
} ex_line_view_t;

static inline ex_line_view_t ex_line_look(const uint64_t *line, uint64_t wanted)
{
    ex_line_view_t view = { 0U, 0U };
#ifdef EX_LINE_VECTOR
    /* Each word is read as a whole, and only once, which `volatile` demands: if a compiler read the line once for what
     * is the same and once for what is free, a word that another thread enters in between would be neither, and would
     * be entered again behind itself. */
    const __m256i first = *(const volatile __m256i *)(const volatile void *)line;
    const __m256i last = *(const volatile __m256i *)(const volatile void *)&line[4];
    const __m256i all = _mm256_set1_epi64x((long long)wanted);
    const __m256i zero = _mm256_setzero_si256();
    view.same = (uint32_t)_mm256_movemask_pd(_mm256_castsi256_pd(_mm256_cmpeq_epi64(first, all)))
                | ((uint32_t)_mm256_movemask_pd(_mm256_castsi256_pd(_mm256_cmpeq_epi64(last, all))) << 4U);
    view.vacant = (uint32_t)_mm256_movemask_pd(_mm256_castsi256_pd(_mm256_cmpeq_epi64(first, zero)))
                  | ((uint32_t)_mm256_movemask_pd(_mm256_castsi256_pd(_mm256_cmpeq_epi64(last, zero))) << 4U);
#else
    for (uint32_t i = 0U; i < EX_LINE_WORDS; i++) {
        const uint64_t there = __atomic_load_n(&line[i], __ATOMIC_RELAXED);
        view.same |= (there == wanted) ? (1U << i) : 0U;
        view.vacant |= (there == 0U) ? (1U << i) : 0U;
    }
#endif
    return view;
}

/* Where a key is: its slot; EX_NO_SLOT: nowhere. */
static inline uint64_t ex_word_find(const ex_store_t *store, uint64_t low, uint64_t hash)
{
    const uint64_t *const word = (const uint64_t *)(const void *)store->bucket;
    uint64_t b = ex_scaled(hash, store->buckets);
    for (uint64_t probes = 0U; probes < store->buckets; probes++) {
        const ex_line_view_t view = ex_line_look(&word[b * EX_LINE_WORDS], low + 1U);
        if (view.same != 0U) {
            return (b * EX_LINE_WORDS) + (uint32_t)__builtin_ctz(view.same);
        }
        if (view.vacant != 0U) {
            break;
        }
        b = ((b + 1U) < store->buckets) ? (b + 1U) : 0U;
    }
    return EX_NO_SLOT;
}

static inline ex_insertion_t ex_word_insert(const ex_store_t *store, uint64_t low, uint64_t hash, uint64_t *slot)
{
    uint64_t *const word = (uint64_t *)(void *)store->bucket;
    uint64_t b = ex_scaled(hash, store->buckets);
    for (uint64_t probes = 0U; probes < store->buckets;) {
        uint64_t *const line = &word[b * EX_LINE_WORDS];
        const ex_line_view_t view = ex_line_look(line, low + 1U);
        if (view.same != 0U) {
            *slot = (b * EX_LINE_WORDS) + (uint32_t)__builtin_ctz(view.same);
            return EX_KNOWN;
        }
        if (view.vacant == 0U) {
            b = ((b + 1U) < store->buckets) ? (b + 1U) : 0U;
            probes++;
            continue;
        }
        const uint32_t i = (uint32_t)__builtin_ctz(view.vacant);
        uint64_t expected = 0U;
        if (__atomic_compare_exchange_n(&line[i], &expected, low + 1U, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
            *slot = (b * EX_LINE_WORDS) + i;
            return EX_NEW;
        }
    }
    return EX_FULL;
}

#endif /* EXPLORE_WORDS_H */
