/* SPDX-License-Identifier: MIT
 * explore_frontier.c - states that have been found and not yet expanded, in chunks.
 */
#define _POSIX_C_SOURCE 200809L

#include "explore_search.h"
#include "../sweep/explore_sweep.h"

#include <string.h>

/* With the gate locked. */
ex_chunk_t *ex_chunk_spare(ex_level_t *level)
{
    ex_chunk_t *chunk = level->spare;
    if (chunk != NULL) {
        level->spare = chunk->next;
        return chunk;
    }
    return NULL;
}

ex_chunk_t *ex_chunk_new(ex_level_t *level)
{
    (void)pthread_mutex_lock(&level->run->gate);
    ex_chunk_t *chunk = ex_chunk_spare(level);
    (void)pthread_mutex_unlock(&level->run->gate);
    if (chunk == NULL) {
        chunk = ex_alloc(&level->run->memory, (uint64_t)EX_CHUNK_SIZE);
    }
    if (chunk == NULL) {
        ex_stop(level->run, EX_MEMORY);
        return NULL;
    }
    chunk->next = NULL;
    chunk->count = 0U;
    chunk->taken = 0U;
    return chunk;
}

void ex_chunk_put(const ex_level_t *level, ex_chunk_t *chunk, const ex_key_t *key, uint64_t depth)
{
    /* What is written too much is overwritten by the next one; behind the last there is room. */
    unsigned char *at = &chunk->byte[(size_t)chunk->count * level->stride];
    (void)memcpy(at, key, sizeof *key);
    if (level->run->options.is_depth_first) {
        const uint32_t shortened = (depth < UINT32_MAX) ? (uint32_t)depth : UINT32_MAX;
        (void)memcpy(&at[level->stride - sizeof shortened], &shortened, sizeof shortened);
    }
    chunk->count++;
}

uint64_t ex_chunk_get(const ex_level_t *level, const ex_chunk_t *chunk, uint32_t i, ex_key_t *key)
{
    const unsigned char *at = &chunk->byte[(size_t)i * level->stride];
    uint32_t depth = 0U;
    (void)memcpy(key, at, sizeof *key);
    key->low &= level->low_mask;
    key->high &= level->high_mask;
    if (level->run->options.is_depth_first) {
        (void)memcpy(&depth, &at[level->stride - sizeof depth], sizeof depth);
    }
    return depth;
}

/* Gives the chunk that is being filled to the next level. With the gate locked. */
void ex_hand_over(ex_search_t *own)
{
    ex_level_t *level = own->level;
    if ((own->out != NULL) && (own->out->count > 0U)) {
        own->out->next = level->next;
        level->next = own->out;
        own->out = NULL;
    }
}

/* Gives the lowest chunk of the stack to threads that have nothing to do. */
static void share_stack(ex_search_t *own)
{
    ex_level_t *level = own->level;
    ex_chunk_t *above = own->out;
    while ((above != NULL) && (above->next != own->bottom)) {
        above = above->next;
    }
    if (above == NULL) {
        return;
    }
    ex_chunk_t *given = own->bottom;
    above->next = NULL;
    own->bottom = above;
    (void)pthread_mutex_lock(&level->run->gate);
    given->next = level->now;
    level->now = given;
    (void)pthread_cond_broadcast(&level->run->gate_changed);
    (void)pthread_mutex_unlock(&level->run->gate);
}

/* A state that has been found for the first time. */
bool ex_add_new(ex_search_t *own, const ex_key_t *key)
{
    ex_level_t *level = own->level;
    const bool is_stack = level->run->options.is_depth_first;
    if (level->run->sweep != NULL) {
        return ex_sweep_found(level->run, key);
    }
    if ((own->out != NULL) && (own->out->count == level->capacity) && !is_stack) {
        (void)pthread_mutex_lock(&level->run->gate);
        ex_hand_over(own);
        (void)pthread_mutex_unlock(&level->run->gate);
    }
    if ((own->out == NULL) || (own->out->count == level->capacity)) {
        ex_chunk_t *chunk = ex_chunk_new(level);
        if (chunk == NULL) {
            return false;
        }
        chunk->next = own->out;
        if (own->out == NULL) {
            own->bottom = chunk;
        }
        own->out = chunk;
    }
    ex_chunk_put(level, own->out, key, own->depth);
    if (is_stack && (own->depth > own->deepest)) {
        own->deepest = own->depth;
    }
    if (is_stack && (own->out != own->bottom) && (atomic_load_explicit(&level->hungry, memory_order_relaxed) > 0U)) {
        share_stack(own);
    }
    return true;
}
