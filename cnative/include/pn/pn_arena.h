/* SPDX-License-Identifier: MIT
 * pn_arena.h - where strings, lists and the moves of a firing live: one fixed block of memory, no heap.
 *
 *     | permanent: values of the declarations | half 0 | half 1 |
 *
 * Allocation takes the next bytes of the active half. Between firings pn_net_t.collect copies what the marking refers
 * to into the other half, which becomes the active one; everything else is forgotten. A host gives the memory:
 *
 *     static max_align_t memory[PN_ARENA_DEFAULT_SIZE / sizeof(max_align_t)];
 *     pn_arena_t arena;
 *     pn_ctx_t cx;
 *     pn_arena_init(&arena, memory, sizeof memory);
 *     pn_ctx_init(&cx, &arena, seed);
 */
#ifndef PN_ARENA_H
#define PN_ARENA_H

#include "pn/pn_types.h"

#define PN_ARENA_DEFAULT_SIZE ((size_t)1U << 22)
#define PN_ARENA_ALIGNMENT    sizeof(max_align_t) /* what is allocated takes a multiple of it */

typedef struct pn_arena {
    unsigned char *memory; /* aligned as max_align_t */
    size_t size;           /* bytes of memory */
    size_t permanent;      /* bytes below the halves */
    size_t half;           /* bytes of each half; 0 until pn_arena_seal: everything is permanent so far */
    size_t active;         /* 0 or 1 */
    size_t used;           /* bytes used of the active half */
    size_t peak;           /* largest `used` since it was sealed */
    size_t start;          /* largest `used` until then */
} pn_arena_t;

/* `memory` is aligned as max_align_t and lives as long as the arena; NULL where `size` is 0. */
void pn_arena_init(pn_arena_t *arena, void *memory, size_t size);

/* Forgets everything, also what is permanent. */
void pn_arena_reset(pn_arena_t *arena);

/* A fresh evaluation context: no error, depth 0, model time 0. Any seed will do. */
void pn_ctx_init(pn_ctx_t *cx, pn_arena_t *arena, uint64_t seed);

/* `size` bytes, aligned as max_align_t, or NULL with PN_ERR_MEMORY set. */
void *pn_arena_alloc(pn_ctx_t *cx, size_t size);

/* A copy of a value in the arena; NULL with PN_ERR_MEMORY set. */
const void *pn_arena_copy(pn_ctx_t *cx, const void *value, size_t size);

/* Makes what has been allocated permanent and divides the rest into halves. Once, by pn_net_t.init. */
void pn_arena_seal(pn_arena_t *arena);

/* The mark of now, and going back to it: what was allocated since is forgotten. */
static inline size_t pn_arena_mark(const pn_arena_t *arena)
{
    return arena->used;
}

static inline void pn_arena_release(pn_arena_t *arena, size_t mark)
{
    arena->used = mark;
}

/* Whether enough is used that collecting pays off. */
static inline bool pn_arena_is_crowded(const pn_arena_t *arena)
{
    return arena->used > (arena->half / 2U);
}

/* Makes the other half, emptied, the active one. What lay in the left one stays readable until the next flip. */
void pn_arena_flip(pn_arena_t *arena);

#endif /* PN_ARENA_H */
