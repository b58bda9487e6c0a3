/* SPDX-License-Identifier: MIT */
#include "pn/pn_arena.h"

#include <string.h>

#include "pn/pn_num.h"
#include "pn/pn_random.h"

static size_t aligned_up(size_t size)
{
    return (size + (PN_ARENA_ALIGNMENT - 1U)) / PN_ARENA_ALIGNMENT * PN_ARENA_ALIGNMENT;
}

void pn_arena_init(pn_arena_t *arena, void *memory, size_t size)
{
    arena->memory = memory;
    arena->size = size / PN_ARENA_ALIGNMENT * PN_ARENA_ALIGNMENT;
    pn_arena_reset(arena);
}

void pn_arena_reset(pn_arena_t *arena)
{
    arena->permanent = 0U;
    arena->half = 0U;
    arena->active = 0U;
    arena->used = 0U;
    arena->peak = 0U;
    arena->start = 0U;
}

void pn_ctx_init(pn_ctx_t *cx, pn_arena_t *arena, uint64_t seed)
{
    (void)memset(cx, 0, sizeof *cx);
    cx->arena = arena;
    cx->error = PN_OK;
    cx->error_name = "";
    cx->error_origin = "";
    cx->origin = "";
    cx->seed = seed;
    pn_stack_init(cx);
    pn_random_start(cx, PN_RANDOM_START);
}

void *pn_arena_alloc(pn_ctx_t *cx, size_t size)
{
    pn_arena_t *arena = cx->arena;
    const bool is_sealed = arena->half > 0U;
    const size_t limit = is_sealed ? arena->half : arena->size;
    if (size > (limit - arena->used)) {
        pn_raise(cx, PN_ERR_MEMORY, NULL);
        return NULL;
    }
    const size_t start = is_sealed ? (arena->permanent + (arena->active * arena->half)) : 0U;
    void *at = &arena->memory[start + arena->used];
    const size_t used = arena->used + aligned_up(size);
    arena->used = (used < limit) ? used : limit;
    if (arena->used > arena->peak) {
        arena->peak = arena->used;
    }
    return at;
}

const void *pn_arena_copy(pn_ctx_t *cx, const void *value, size_t size)
{
    void *copy = pn_arena_alloc(cx, size);
    if (copy != NULL) {
        (void)memcpy(copy, value, size);
    }
    return copy;
}

void pn_arena_seal(pn_arena_t *arena)
{
    arena->permanent = arena->used;
    arena->start = arena->peak;
    arena->half = (arena->size - arena->permanent) / 2U / PN_ARENA_ALIGNMENT * PN_ARENA_ALIGNMENT;
    arena->active = 0U;
    arena->used = 0U;
    arena->peak = 0U;
}

void pn_arena_flip(pn_arena_t *arena)
{
    arena->active = 1U - arena->active;
    arena->used = 0U;
}
