/* SPDX-License-Identifier: MIT
 * explore_memory.c - block from the system in whole blocks, counted against --block; in files of a folder with
 * --spill.
 */
#define _GNU_SOURCE 1 /* MAP_ANONYMOUS, madvise, mkstemp */

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "explore_memory.h"

enum {
    PAGE = 4096,
    HUGE_PAGE = 1 << 21,
    SPILLED = 1 << 16 /* smaller blocks stay in memory */
};

static uint64_t rounded(uint64_t size)
{
    const uint64_t least = (size > 0U) ? size : 1U;
    return (least + (uint64_t)PAGE - 1U) & ~((uint64_t)PAGE - 1U);
}

bool ex_is_spilled(const ex_memory_t *memory, uint64_t size)
{
    return (memory->folder != NULL) && (size >= (uint64_t)SPILLED);
}

bool ex_has_room(const ex_memory_t *memory, uint64_t size)
{
    const uint64_t used = atomic_load_explicit(&memory->used, memory_order_relaxed);
    return ex_is_spilled(memory, size) || ((used <= memory->limit) && (size <= (memory->limit - used)));
}

bool ex_count(ex_memory_t *memory, uint64_t size)
{
    uint64_t used = atomic_load_explicit(&memory->used, memory_order_relaxed);
    do {
        if ((used > memory->limit) || (size > (memory->limit - used))) {
            return false;
        }
    } while (!atomic_compare_exchange_weak(&memory->used, &used, used + size));
    return true;
}

void ex_uncount(ex_memory_t *memory, uint64_t size)
{
    (void)atomic_fetch_sub(&memory->used, size);
}

void *ex_reserve(uint64_t size)
{
    void *block =
        mmap(NULL, (size_t)rounded(size), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    return (block == MAP_FAILED) ? NULL : block;
}

/* A mapping that begins at a boundary of huge pages. */
static void *map_huge(uint64_t size)
{
    unsigned char *block = ex_reserve(size + (uint64_t)HUGE_PAGE);
    if (block == NULL) {
        return NULL;
    }
    const uint64_t skipped =
        ((uint64_t)HUGE_PAGE - ((uint64_t)(uintptr_t)block % (uint64_t)HUGE_PAGE)) % (uint64_t)HUGE_PAGE;
    if (skipped > 0U) {
        (void)munmap(block, (size_t)skipped);
    }
    if (skipped < (uint64_t)HUGE_PAGE) {
        (void)munmap(&block[skipped + size], (size_t)((uint64_t)HUGE_PAGE - skipped));
    }
    (void)madvise(&block[skipped], (size_t)size, MADV_HUGEPAGE);
    return &block[skipped];
}

/* A file without a name, as long as it is mapped. */
static void *map_file(ex_memory_t *memory, uint64_t size)
{
    char path[4096];
    const int length = snprintf(path, sizeof path, "%s/explore-XXXXXX", memory->folder);
    if ((length < 0) || ((size_t)length >= sizeof path)) {
        atomic_store(&memory->spill_error, ENAMETOOLONG);
        return NULL;
    }
    const int file = mkstemp(path);
    if (file < 0) {
        atomic_store(&memory->spill_error, errno);
        return NULL;
    }
    (void)unlink(path);
    void *block = MAP_FAILED;
    int problem = posix_fallocate(file, 0, (off_t)size); /* what is not there now would be missed when it is written */
    if (problem == 0) {
        block = mmap(NULL, (size_t)size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
        problem = (block == MAP_FAILED) ? errno : 0;
    }
    (void)close(file);
    if (problem != 0) {
        atomic_store(&memory->spill_error, problem);
        return NULL;
    }
    return block;
}

void *ex_map(ex_memory_t *memory, uint64_t wanted)
{
    const uint64_t size = rounded(wanted);
    if (ex_is_spilled(memory, size)) {
        return map_file(memory, size);
    }
    return (size >= (2U * (uint64_t)HUGE_PAGE)) ? map_huge(size) : ex_reserve(size);
}

void *ex_alloc(ex_memory_t *memory, uint64_t wanted)
{
    const uint64_t size = rounded(wanted);
    const bool counts = !ex_is_spilled(memory, size);
    if (counts && !ex_count(memory, size)) {
        return NULL;
    }
    void *block = ex_map(memory, size);
    if ((block == NULL) && counts) {
        ex_uncount(memory, size);
    }
    return block;
}

void *ex_table(ex_memory_t *memory, uint64_t count, uint64_t size)
{
    return ex_alloc(memory, (count + 1U) * size);
}

void ex_unmap(void *block, uint64_t size)
{
    (void)munmap(block, (size_t)rounded(size));
}

void ex_free(ex_memory_t *memory, void *block, uint64_t size)
{
    if (block != NULL) {
        ex_unmap(block, size);
        if (!ex_is_spilled(memory, size)) {
            ex_uncount(memory, rounded(size));
        }
    }
}

void ex_free_table(ex_memory_t *memory, void *block, uint64_t count, uint64_t size)
{
    ex_free(memory, block, (count + 1U) * size);
}

void ex_discard(ex_memory_t *memory, void *block, uint64_t size, uint64_t from, uint64_t to)
{
    unsigned char *bytes = block;
    const uint64_t first = (from + (uint64_t)HUGE_PAGE - 1U) & ~((uint64_t)HUGE_PAGE - 1U);
    const uint64_t last = to & ~((uint64_t)HUGE_PAGE - 1U);
    if (!ex_is_spilled(memory, size) && (first < last)) {
        (void)madvise(&bytes[first], (size_t)(last - first), MADV_DONTNEED);
    }
}
