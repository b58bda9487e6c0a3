/* SPDX-License-Identifier: MIT
 * explore_intern.c - numbers for groups of four numbers and for strings of bytes.
 *
 * An index of one word for each number: half of it is a part of the hash, so that hardly ever something else is looked at in vain. A
 * thread that has something new takes the next number, writes the thing down and only then, by one compare-and-swap, enters it in the
 * index. When another thread was faster with the same, the number is a hole.
 */
#include "explore_impl.h"

#include <string.h>

enum {
    FIRST_ENTRIES = 1 << 10,
    BLOCK = 1 << 20 /* bytes that are counted at a time */
};

#define MOST_NUMBERS ((uint64_t)UINT32_MAX - 2U)

static uint64_t entry_of(uint64_t hash, uint64_t number)
{
    return (hash << 32U) | (number + 1U);
}

static uint64_t home(const ex_index_t *index, uint64_t hash)
{
    return ex_scaled(hash, index->entries);
}

static uint64_t quad_hash(ex_quad_t quad)
{
    const ex_key_t key = { quad.low, quad.high };
    return ex_hash(&key);
}

static uint64_t load(const unsigned char *byte, uint32_t length)
{
    uint64_t word = 0U;
    (void)memcpy(&word, byte, length);
    return word;
}

static uint64_t bytes_hash(uint32_t place, const unsigned char *byte, uint32_t length)
{
    ex_key_t key = { ((uint64_t)place << 32U) | length, 0x2545f4914f6cdd1dU };
    uint32_t at = 0U;
    for (; (length - at) >= 8U; at += 8U) {
        key.high ^= load(&byte[at], 8U);
        key.low = ex_hash(&key);
        key.high = (key.high << 23U) | (key.high >> 41U);
    }
    key.high ^= load(&byte[at], length - at);
    return ex_hash(&key);
}

/* --- the index ----------------------------------------------------------------------------------------------------- */

static bool index_make(ex_index_t *index, ex_run_t *run)
{
    index->run = run;
    index->entries = (uint64_t)FIRST_ENTRIES;
    index->limit = (index->entries / 4U) * 3U;
    atomic_init(&index->count, 0U);
    index->entry = ex_alloc(run, index->entries * sizeof *index->entry);
    return index->entry != NULL;
}

/* Enters a number while nobody else uses the index. */
static void index_put(ex_index_t *index, uint64_t hash, uint64_t number)
{
    uint64_t at = home(index, hash);
    while (atomic_load_explicit(&index->entry[at], memory_order_relaxed) != 0U) {
        at = ((at + 1U) < index->entries) ? (at + 1U) : 0U;
    }
    atomic_store_explicit(&index->entry[at], entry_of(hash, number), memory_order_relaxed);
}

/* A larger one, without its entries yet; the old ones, to be entered and freed, are in *old. False: there is no memory. */
static bool index_enlarge(ex_index_t *index, uint64_t payload, ex_index_t *old)
{
    const uint64_t step = (index->entries < ((uint64_t)1U << 20U)) ? index->entries : (index->entries / 2U);
    const uint64_t entries = index->entries + step;
    const uint64_t limit = (entries / 4U) * 3U;
    if (limit > index->most) {
        return false;
    }
    _Atomic uint64_t *entry = ex_alloc(index->run, entries * sizeof *entry);
    if (entry == NULL) {
        return false;
    }
    if (!ex_count(index->run, (limit - index->limit) * payload)) {
        ex_free(index->run, entry, entries * sizeof *entry);
        return false;
    }
    old->entry = index->entry;
    old->entries = index->entries;
    index->entry = entry;
    index->entries = entries;
    index->limit = limit;
    return true;
}

/* The number in an entry of the old index; false: none. Only what is entered counts: a hole is not. */
static bool old_number(const ex_index_t *old, uint64_t at, uint64_t *number)
{
    const uint64_t entry = atomic_load_explicit(&old->entry[at], memory_order_relaxed);
    *number = (uint64_t)(uint32_t)entry - 1U;
    return entry != 0U;
}

static bool is_crowded(const ex_index_t *index)
{
    return atomic_load_explicit(&index->count, memory_order_relaxed) >= (index->limit - (index->limit / 16U));
}

/* Addresses for as many things as there is memory for, or as can be had. */
static void *reserve(ex_run_t *run, uint64_t size, uint64_t *most)
{
    uint64_t number = run->options.memory / size;
    number = (number < (uint64_t)FIRST_ENTRIES) ? (uint64_t)FIRST_ENTRIES : number;
    number = (number > MOST_NUMBERS) ? MOST_NUMBERS : number;
    for (; number >= (uint64_t)FIRST_ENTRIES; number /= 2U) {
        void *memory = ex_reserve(number * size);
        if (memory != NULL) {
            *most = number;
            return memory;
        }
    }
    return NULL;
}

/* --- groups of four ------------------------------------------------------------------------------------------------- */

bool ex_quads_make(ex_quads_t *quads, ex_run_t *run)
{
    quads->quad = reserve(run, sizeof *quads->quad, &quads->index.most);
    return (quads->quad != NULL) && index_make(&quads->index, run) && ex_count(run, quads->index.limit * sizeof *quads->quad);
}

void ex_quads_free(ex_quads_t *quads)
{
    ex_index_t *index = &quads->index;
    ex_unmap(quads->quad, index->most * sizeof *quads->quad);
    ex_uncount(index->run, index->limit * sizeof *quads->quad);
    ex_free(index->run, index->entry, index->entries * sizeof *index->entry);
    *quads = (ex_quads_t){ .quad = NULL };
}

uint32_t ex_quads_number(ex_quads_t *quads, ex_quad_t quad)
{
    ex_index_t *index = &quads->index;
    const uint64_t hash = quad_hash(quad);
    const uint32_t wanted = (uint32_t)hash;
    uint64_t number = UINT64_MAX;
    uint64_t at = home(index, hash);
    for (;;) {
        uint64_t entry = atomic_load_explicit(&index->entry[at], memory_order_acquire);
        if (entry == 0U) {
            if (number == UINT64_MAX) {
                number = atomic_load_explicit(&index->count, memory_order_relaxed);
                do {
                    if (number >= index->limit) {
                        return EX_NO_NUMBER;
                    }
                } while (!atomic_compare_exchange_weak_explicit(&index->count, &number, number + 1U, memory_order_relaxed,
                                                                memory_order_relaxed));
                quads->quad[number] = quad;
            }
            if (atomic_compare_exchange_strong_explicit(&index->entry[at], &entry, entry_of(hash, number), memory_order_acq_rel,
                                                        memory_order_acquire)) {
                return (uint32_t)number;
            }
        }
        if ((uint32_t)(entry >> 32U) == wanted) {
            const uint32_t found = (uint32_t)entry - 1U;
            if ((quads->quad[found].low == quad.low) && (quads->quad[found].high == quad.high)) {
                return found; /* a number that was taken meanwhile stays a hole */
            }
        }
        at = ((at + 1U) < index->entries) ? (at + 1U) : 0U;
    }
}

bool ex_quads_grow(ex_quads_t *quads)
{
    ex_index_t *index = &quads->index;
    if (!is_crowded(index)) {
        return true;
    }
    ex_index_t old;
    if (!index_enlarge(index, sizeof *quads->quad, &old)) {
        return false;
    }
    for (uint64_t at = 0U; at < old.entries; at++) {
        uint64_t number;
        if (old_number(&old, at, &number)) {
            index_put(index, quad_hash(quads->quad[number]), number);
        }
    }
    ex_free(index->run, old.entry, old.entries * sizeof *old.entry);
    return true;
}

uint64_t ex_quads_bytes(const ex_quads_t *quads)
{
    return (quads->index.entries * sizeof *quads->index.entry) + (atomic_load(&quads->index.count) * sizeof *quads->quad);
}

/* --- strings of bytes ------------------------------------------------------------------------------------------------ */

bool ex_bytes_make(ex_bytes_t *bytes, ex_run_t *run)
{
    bytes->of = reserve(run, sizeof *bytes->of, &bytes->index.most);
    bytes->byte = reserve(run, 1U, &bytes->reserved);
    if (bytes->reserved == MOST_NUMBERS) { /* more than that only if it can be had */
        const uint64_t larger = run->options.memory;
        void *memory = ex_reserve(larger);
        if (memory != NULL) {
            bytes->byte = memory;
            bytes->reserved = larger;
        }
    }
    atomic_init(&bytes->used, 0U);
    atomic_init(&bytes->counted, 0U);
    return (bytes->of != NULL) && (bytes->byte != NULL) && index_make(&bytes->index, run)
           && ex_count(run, bytes->index.limit * sizeof *bytes->of);
}

/* Room for some bytes; UINT64_MAX when there is none. */
static uint64_t take_bytes(ex_bytes_t *bytes, uint32_t length)
{
    uint64_t used = atomic_load_explicit(&bytes->used, memory_order_relaxed);
    do {
        uint64_t counted = atomic_load_explicit(&bytes->counted, memory_order_relaxed);
        while ((used + length) > counted) {
            const uint64_t block = ((uint64_t)length / (uint64_t)BLOCK + 1U) * (uint64_t)BLOCK;
            if (((counted + block) > bytes->reserved) || !ex_count(bytes->index.run, block)) {
                return UINT64_MAX;
            }
            counted = atomic_fetch_add(&bytes->counted, block) + block;
        }
    } while (!atomic_compare_exchange_weak_explicit(&bytes->used, &used, used + length, memory_order_relaxed,
                                                    memory_order_relaxed));
    return used;
}

static bool is_same(const ex_bytes_t *bytes, uint32_t number, uint32_t place, const unsigned char *byte, uint32_t length)
{
    const ex_bytes_entry_t *of = &bytes->of[number];
    return (of->place == place) && (of->length == length) && (memcmp(&bytes->byte[of->offset], byte, length) == 0);
}

uint32_t ex_bytes_number(ex_bytes_t *bytes, uint32_t place, const unsigned char *byte, uint32_t length)
{
    ex_index_t *index = &bytes->index;
    const uint64_t hash = bytes_hash(place, byte, length);
    const uint32_t wanted = (uint32_t)hash;
    uint64_t number = UINT64_MAX;
    uint64_t at = home(index, hash);
    for (;;) {
        uint64_t entry = atomic_load_explicit(&index->entry[at], memory_order_acquire);
        if (entry == 0U) {
            if (number == UINT64_MAX) {
                const uint64_t offset = take_bytes(bytes, length);
                if (offset == UINT64_MAX) {
                    return EX_NO_NUMBER;
                }
                number = atomic_load_explicit(&index->count, memory_order_relaxed);
                do {
                    if (number >= index->limit) {
                        return EX_NO_NUMBER;
                    }
                } while (!atomic_compare_exchange_weak_explicit(&index->count, &number, number + 1U, memory_order_relaxed,
                                                                memory_order_relaxed));
                (void)memcpy(&bytes->byte[offset], byte, length);
                bytes->of[number] = (ex_bytes_entry_t){ .offset = offset, .length = length, .place = place };
            }
            if (atomic_compare_exchange_strong_explicit(&index->entry[at], &entry, entry_of(hash, number), memory_order_acq_rel,
                                                        memory_order_acquire)) {
                return (uint32_t)number;
            }
        }
        if ((uint32_t)(entry >> 32U) == wanted) {
            const uint32_t found = (uint32_t)entry - 1U;
            if (is_same(bytes, found, place, byte, length)) {
                if (number != UINT64_MAX) {
                    bytes->of[number].place = UINT32_MAX;
                }
                return found;
            }
        }
        at = ((at + 1U) < index->entries) ? (at + 1U) : 0U;
    }
}

bool ex_bytes_grow(ex_bytes_t *bytes)
{
    ex_index_t *index = &bytes->index;
    const uint64_t free_bytes = atomic_load(&bytes->counted) - atomic_load(&bytes->used);
    if (!is_crowded(index)) {
        /* Perhaps it was the bytes themselves that could not be had. */
        return (free_bytes > 0U) || ex_has_room(index->run, (uint64_t)BLOCK);
    }
    ex_index_t old;
    if (!index_enlarge(index, sizeof *bytes->of, &old)) {
        return false;
    }
    for (uint64_t at = 0U; at < old.entries; at++) {
        uint64_t number;
        if (old_number(&old, at, &number)) {
            const ex_bytes_entry_t *of = &bytes->of[number];
            index_put(index, bytes_hash(of->place, &bytes->byte[of->offset], of->length), number);
        }
    }
    ex_free(index->run, old.entry, old.entries * sizeof *old.entry);
    return true;
}

uint64_t ex_bytes_bytes(const ex_bytes_t *bytes)
{
    return (bytes->index.entries * sizeof *bytes->index.entry) + (atomic_load(&bytes->index.count) * sizeof *bytes->of)
           + atomic_load(&bytes->used);
}
