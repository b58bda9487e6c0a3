/* SPDX-License-Identifier: MIT
 * explore_intern.h - numbers for tuples of words and for strings of bytes.
 */
#ifndef EXPLORE_INTERN_H
#define EXPLORE_INTERN_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "../store/explore_memory.h"
#include "../store/explore_team.h"
#include "explore_key.h"

#define EX_NO_NUMBER UINT32_MAX

/* Gives equal things equal numbers, from 0 on nearly without holes. Threads may do it at the same time; it never moves
 * what it has, but has to grow now and then, while nobody uses it. */
typedef struct ex_index {
    ex_memory_t *memory;
    const ex_team_t *team;   /* help when a large table grows */
    _Atomic uint64_t *entry; /* low half: number + 1, 0: free; high half: of the hash */
    uint64_t entries;
    uint64_t limit;         /* numbers from which on it has to grow */
    uint64_t most;          /* numbers for which addresses are reserved */
    _Atomic uint64_t count; /* numbers given */
} ex_index_t;

/* Up to eight words as one number: the inner nodes of trees. Words lie two and two in a lane, the first one in the
 * lower half. */
#define EX_TUPLE_WORDS 8U
#define EX_TUPLE_LANES 4U

typedef struct ex_tuples {
    ex_index_t index;
    uint64_t *lane; /* `lanes` of each number */
    uint32_t lanes;
} ex_tuples_t;

/* Strings of bytes, each with the place to which it belongs. */
typedef struct ex_bytes_entry {
    uint64_t offset;
    uint32_t length;
    uint32_t place; /* UINT32_MAX: a hole */
} ex_bytes_entry_t;

typedef struct ex_bytes {
    ex_index_t index;
    ex_bytes_entry_t *of;
    unsigned char *byte;
    uint64_t reserved;
    _Atomic uint64_t used; /* bytes */
    _Atomic uint64_t counted;
} ex_bytes_t;

bool ex_tuples_make(ex_tuples_t *tuples, ex_memory_t *memory, const ex_team_t *team, uint32_t words);
void ex_tuples_free(ex_tuples_t *tuples);
bool ex_bytes_make(ex_bytes_t *bytes, ex_memory_t *memory, const ex_team_t *team);
/* The number; EX_NO_NUMBER: it has to grow first. What is behind the last word is 0. `hash`: ex_tuple_hash. */
uint32_t ex_tuples_number(ex_tuples_t *tuples, const uint64_t lane[EX_TUPLE_LANES], uint64_t hash);
uint32_t ex_bytes_number(ex_bytes_t *bytes, uint32_t place, const unsigned char *byte, uint32_t length);
/* Makes room if need be; false when there is no memory. */
bool ex_tuples_grow(ex_tuples_t *tuples);
bool ex_bytes_grow(ex_bytes_t *bytes);
uint64_t ex_tuples_bytes(const ex_tuples_t *tuples);
uint64_t ex_bytes_bytes(const ex_bytes_t *bytes);

/* Of a tuple of `lanes` lanes. */
static inline uint64_t ex_tuple_hash(const uint64_t *lane, uint32_t lanes)
{
    ex_key_t key = { lane[0], (lanes > 1U) ? lane[1] : 0U };
    if (lanes > 2U) {
        const uint64_t last = (lanes > 3U) ? lane[3] : 0U;
        const ex_wide_t more = (ex_wide_t)(lane[2] ^ 0x8ebc6af09c88c6e3U) * (last ^ 0x589965cc75374cc3U);
        key.low ^= (uint64_t)more;
        key.high += (uint64_t)(more >> 64U) ^ lane[2];
    }
    return ex_hash(&key);
}

/* For ex_tuples_number: its entry in the index is sent for; then, if it seems to be one, the tuple itself. */
static inline void ex_tuples_prefetch(const ex_tuples_t *tuples, uint64_t hash)
{
    __builtin_prefetch(&tuples->index.entry[ex_scaled(hash, tuples->index.entries)], 0, 3);
}

static inline void ex_tuples_send(const ex_tuples_t *tuples, uint64_t hash)
{
    const ex_index_t *const index = &tuples->index;
    const uint64_t entry = atomic_load_explicit(&index->entry[ex_scaled(hash, index->entries)], memory_order_relaxed);
    if ((uint32_t)(entry >> 32U) == (uint32_t)hash) {
        __builtin_prefetch(&tuples->lane[((uint64_t)(uint32_t)entry - 1U) * tuples->lanes], 0, 3);
    }
}

#endif /* EXPLORE_INTERN_H */
