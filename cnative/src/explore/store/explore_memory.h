/* SPDX-License-Identifier: MIT
 * explore_memory.h - memory from the system, counted against a limit (explore_memory.c).
 */
#ifndef EXPLORE_MEMORY_H
#define EXPLORE_MEMORY_H

#include <stdbool.h>
#include <stdint.h>

#define EX_CACHE_LINE 128 /* two: they are fetched in pairs */

struct ex_run;

/* Zeroed memory, page-aligned; counted, refused (NULL) beyond the limit of --memory. With --spill it lies in a file.
 * Pages that are never touched cost nothing but count. Large blocks get huge pages. Thread-safe. */
void *ex_alloc(struct ex_run *run, uint64_t size);
/* Room for `count` things and one more, zeroed. */
void *ex_table(struct ex_run *run, uint64_t count, uint64_t size);
void ex_free_table(struct ex_run *run, void *memory, uint64_t count, uint64_t size);
void ex_free(struct ex_run *run, void *memory, uint64_t size);
/* Whether so much could be had now. */
bool ex_has_room(const struct ex_run *run, uint64_t size);
/* Counts memory that is used of a reservation; false beyond the limit. */
bool ex_count(struct ex_run *run, uint64_t size);
void ex_uncount(struct ex_run *run, uint64_t size);
/* As ex_alloc, but the caller has counted it. */
void *ex_map(struct ex_run *run, uint64_t size);
/* Zeroed addresses that cost nothing and do not count until they are used. NULL: not so many. */
void *ex_reserve(uint64_t size);
/* Gives back the pages of a part of a block that is going to be freed; they still count. */
void ex_discard(struct ex_run *run, void *memory, uint64_t size, uint64_t from, uint64_t to);
/* ex_free without counting. */
void ex_unmap(void *memory, uint64_t size);
/* Whether a block of that size lies in a file and does not count. */
bool ex_is_spilled(const struct ex_run *run, uint64_t size);

#endif /* EXPLORE_MEMORY_H */
