/* SPDX-License-Identifier: MIT
 * explore_memory.h - memory from the system, counted against a limit (explore_memory.c).
 */
#ifndef EXPLORE_MEMORY_H
#define EXPLORE_MEMORY_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#define EX_CACHE_LINE 128 /* two: they are fetched in pairs */

/* How much there may be, and how much there is. */
typedef struct ex_memory {
    uint64_t limit;          /* bytes */
    const char *folder;      /* of the files for large blocks, which do not count; NULL: none */
    _Atomic uint64_t used;   /* bytes */
    _Atomic int spill_error; /* errno of a file that could not be had; 0: none */
} ex_memory_t;

/* Zeroed memory, page-aligned; counted, refused (NULL) beyond the limit. With a folder it lies in a file.
 * Pages that are never touched cost nothing but count. Large blocks get huge pages. Thread-safe. */
void *ex_alloc(ex_memory_t *memory, uint64_t size);
/* Room for `count` things and one more, zeroed. */
void *ex_table(ex_memory_t *memory, uint64_t count, uint64_t size);
void ex_free_table(ex_memory_t *memory, void *block, uint64_t count, uint64_t size);
void ex_free(ex_memory_t *memory, void *block, uint64_t size);
/* Whether so much could be had now. */
bool ex_has_room(const ex_memory_t *memory, uint64_t size);
/* Counts memory that is used of a reservation; false beyond the limit. */
bool ex_count(ex_memory_t *memory, uint64_t size);
void ex_uncount(ex_memory_t *memory, uint64_t size);
/* As ex_alloc, but the caller has counted it. */
void *ex_map(ex_memory_t *memory, uint64_t size);
/* Zeroed addresses that cost nothing and do not count until they are used. NULL: not so many. */
void *ex_reserve(uint64_t size);
/* Gives back the pages of a part of a block that is going to be freed; they still count. */
void ex_discard(ex_memory_t *memory, void *block, uint64_t size, uint64_t from, uint64_t to);
/* ex_free without counting. */
void ex_unmap(void *block, uint64_t size);
/* Whether a block of that size lies in a file and does not count. */
bool ex_is_spilled(const ex_memory_t *memory, uint64_t size);

#endif /* EXPLORE_MEMORY_H */
