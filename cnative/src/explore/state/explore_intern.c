/* SPDX-License-Identifier: MIT
 * explore_intern.c - numbers for tuples of words and for strings of bytes.
 *
 * An index of one word for each number: half of it is a part of the hash, so that hardly ever something else is looked
 * at in vain. A thread that has something new takes the next number, writes the thing down and only then, by one
 * compare-and-swap, enters it in the index. When another thread was faster with the same, the number is a hole.
 */
#include "explore_intern.h"

#include <string.h>

enum {
    FIRST_ENTRIES = 1 << 10,
    DOUBLED = 1 << 15,       /* entries up to which an index grows to twice its size; then by a quarter */
    BLOCK = 1 << 20,         /* bytes that are counted at a time */
    SHARED_ENTRIES = 1 << 17 /* of an index that threads move together */
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

static inline uint64_t load_8(const unsigned char *byte)
{
    uint64_t word;
    (void)memcpy(&word, byte, sizeof word);
    return word;
}

static inline uint64_t load_4(const unsigned char *byte)
{
    uint32_t word;
    (void)memcpy(&word, byte, sizeof word);
    return word;
}

static inline uint64_t folded(uint64_t a, uint64_t b)
{
    const ex_wide_t product = (ex_wide_t)a * b;
    return (uint64_t)product ^ (uint64_t)(product >> 64U);
}

/* The words at the beginning and at the end may overlap: the length is part of the hash, too. */
static uint64_t bytes_hash(uint32_t place, const unsigned char *byte, uint32_t length)
{
    uint64_t hash = ((((uint64_t)place << 32U) | length) ^ 0x2545f4914f6cdd1dU) * 0x9e3779b97f4a7c15U;
    uint64_t first = 0U;
    uint64_t last = 0U;
    uint32_t at = 0U;
    for (; (length - at) > 16U; at += 16U) {
        hash = folded(load_8(&byte[at]) ^ 0xa0761d6478bd642fU, load_8(&byte[at + 8U]) ^ hash);
    }
    if (length >= 16U) {
        first = load_8(&byte[length - 16U]);
        last = load_8(&byte[length - 8U]);
    } else if (length >= 8U) {
        first = load_8(byte);
        last = load_8(&byte[length - 8U]);
    } else if (length >= 4U) {
        first = load_4(byte);
        last = load_4(&byte[length - 4U]);
    } else if (length > 0U) {
        first = byte[0];
        last = byte[length / 2U] | ((uint64_t)byte[length - 1U] << 8U);
    } else {
        /* Nothing. */
    }
    hash = folded(first ^ 0xe7037ed1a0b428dbU, last ^ hash);
    return folded(hash ^ 0x8ebc6af09c88c6e3U, 0x589965cc75374cc3U);
}

/* --- the index ---------------------------------------------------------------------------------------------------- */

static bool index_make(ex_index_t *index, ex_memory_t *memory, const ex_team_t *team)
{
    index->memory = memory;
    index->team = team;
    index->entries = (uint64_t)FIRST_ENTRIES;
    index->limit = (index->entries / 4U) * 3U;
    atomic_init(&index->count, 0U);
    index->entry = ex_alloc(memory, index->entries * sizeof *index->entry);
    return index->entry != NULL;
}

/* Enters a number that is not there, while others do the same and nobody looks for one. */
static void index_put(ex_index_t *index, uint64_t hash, uint64_t number)
{
    uint64_t at = home(index, hash);
    uint64_t expected = 0U;
    while (!atomic_compare_exchange_strong_explicit(&index->entry[at], &expected, entry_of(hash, number),
                                                    memory_order_relaxed, memory_order_relaxed)) {
        at = ((at + 1U) < index->entries) ? (at + 1U) : 0U;
        expected = 0U;
    }
}

/* A larger one, without its entries yet; the old ones, to be entered and freed, are in *old. False: there is no memory.
 */
static bool index_enlarge(ex_index_t *index, uint64_t payload, ex_index_t *old)
{
    const uint64_t step = (index->entries < (uint64_t)DOUBLED) ? index->entries : (index->entries / 4U);
    const uint64_t entries = index->entries + step;
    const uint64_t limit = (entries / 4U) * 3U;
    if (limit > index->most) {
        return false;
    }
    _Atomic uint64_t *entry = ex_alloc(index->memory, entries * sizeof *entry);
    if (entry == NULL) {
        return false;
    }
    if (!ex_count(index->memory, (limit - index->limit) * payload)) {
        ex_free(index->memory, entry, entries * sizeof *entry);
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

/* All numbers of an old index are entered into the new one, in parts. */
typedef struct move {
    ex_index_t *index;
    const ex_index_t *old;
    const ex_tuples_t *tuples; /* or */
    const ex_bytes_t *bytes;
    uint32_t parts;
} move_t;

static uint64_t part_first(const move_t *move, uint32_t part)
{
    return (move->old->entries / move->parts) * part;
}

static uint64_t part_end(const move_t *move, uint32_t part)
{
    return ((part + 1U) == move->parts) ? move->old->entries : part_first(move, part + 1U);
}

static void enter_all(move_t *move, void (*part)(void *user, uint32_t part))
{
    ex_memory_t *const memory = move->index->memory;
    const ex_team_t *const team = move->index->team;
    const uint32_t threads = team->threads;
    move->parts = ((threads > 1U) && (move->old->entries >= (uint64_t)SHARED_ENTRIES)) ? (4U * threads) : 1U;
    team->together(team->self, move->parts, part, move);
    ex_free(memory, move->old->entry, move->old->entries * sizeof *move->old->entry);
}

static bool is_crowded(const ex_index_t *index)
{
    return atomic_load_explicit(&index->count, memory_order_relaxed) >= (index->limit - (index->limit / 16U));
}

/* Addresses for as many things as there is memory for, or as can be had. */
static void *reserve(const ex_memory_t *memory, uint64_t size, uint64_t *most)
{
    uint64_t number = memory->limit / size;
    number = (number < (uint64_t)FIRST_ENTRIES) ? (uint64_t)FIRST_ENTRIES : number;
    number = (number > MOST_NUMBERS) ? MOST_NUMBERS : number;
    for (; number >= (uint64_t)FIRST_ENTRIES; number /= 2U) {
        void *block = ex_reserve(number * size);
        if (block != NULL) {
            *most = number;
            return block;
        }
    }
    return NULL;
}

/* --- tuples ------------------------------------------------------------------------------------------------------- */

bool ex_tuples_make(ex_tuples_t *tuples, ex_memory_t *memory, const ex_team_t *team, uint32_t words)
{
    tuples->lanes = (words + 1U) / 2U;
    tuples->lane = reserve(memory, tuples->lanes * sizeof *tuples->lane, &tuples->index.most);
    return (tuples->lane != NULL) && index_make(&tuples->index, memory, team)
           && ex_count(memory, tuples->index.limit * tuples->lanes * sizeof *tuples->lane);
}

void ex_tuples_free(ex_tuples_t *tuples)
{
    ex_index_t *index = &tuples->index;
    const uint64_t size = tuples->lanes * sizeof *tuples->lane;
    ex_unmap(tuples->lane, index->most * size);
    ex_uncount(index->memory, index->limit * size);
    ex_free(index->memory, index->entry, index->entries * sizeof *index->entry);
    *tuples = (ex_tuples_t){ .lane = NULL };
}

static inline bool is_tuple(const ex_tuples_t *tuples, uint64_t number, const uint64_t *lane)
{
    const uint64_t *found = &tuples->lane[number * tuples->lanes];
    uint64_t difference = 0U;
    for (uint32_t i = 0U; i < tuples->lanes; i++) {
        difference |= found[i] ^ lane[i];
    }
    return difference == 0U;
}

uint32_t ex_tuples_number(ex_tuples_t *tuples, const uint64_t lane[EX_TUPLE_LANES], uint64_t hash)
{
    ex_index_t *index = &tuples->index;
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
                } while (!atomic_compare_exchange_weak_explicit(&index->count, &number, number + 1U,
                                                                memory_order_relaxed, memory_order_relaxed));
                for (uint32_t i = 0U; i < tuples->lanes; i++) {
                    tuples->lane[(number * tuples->lanes) + i] = lane[i];
                }
            }
            if (atomic_compare_exchange_strong_explicit(&index->entry[at], &entry, entry_of(hash, number),
                                                        memory_order_acq_rel, memory_order_acquire)) {
                return (uint32_t)number;
            }
        }
        if ((uint32_t)(entry >> 32U) == wanted) {
            const uint32_t found = (uint32_t)entry - 1U;
            if (is_tuple(tuples, found, lane)) {
                return found; /* a number that was taken meanwhile stays a hole */
            }
        }
        at = ((at + 1U) < index->entries) ? (at + 1U) : 0U;
    }
}

static void enter_tuples(void *user, uint32_t part)
{
    const move_t *move = user;
    const ex_tuples_t *tuples = move->tuples;
    const uint64_t end = part_end(move, part);
    for (uint64_t at = part_first(move, part); at < end; at++) {
        uint64_t number;
        if (old_number(move->old, at, &number)) {
            index_put(move->index, ex_tuple_hash(&tuples->lane[number * tuples->lanes], tuples->lanes), number);
        }
    }
}

bool ex_tuples_grow(ex_tuples_t *tuples)
{
    ex_index_t *index = &tuples->index;
    if (!is_crowded(index)) {
        return true;
    }
    ex_index_t old;
    if (!index_enlarge(index, tuples->lanes * sizeof *tuples->lane, &old)) {
        return false;
    }
    move_t move = { .index = index, .old = &old, .tuples = tuples };
    enter_all(&move, enter_tuples);
    return true;
}

uint64_t ex_tuples_bytes(const ex_tuples_t *tuples)
{
    return (tuples->index.entries * sizeof *tuples->index.entry)
           + (atomic_load(&tuples->index.count) * tuples->lanes * sizeof *tuples->lane);
}

/* --- strings of bytes --------------------------------------------------------------------------------------------- */

bool ex_bytes_make(ex_bytes_t *bytes, ex_memory_t *memory, const ex_team_t *team)
{
    bytes->of = reserve(memory, sizeof *bytes->of, &bytes->index.most);
    bytes->byte = reserve(memory, 1U, &bytes->reserved);
    if (bytes->reserved == MOST_NUMBERS) { /* more than that only if it can be had */
        const uint64_t larger = memory->limit;
        void *block = ex_reserve(larger);
        if (block != NULL) {
            bytes->byte = block;
            bytes->reserved = larger;
        }
    }
    atomic_init(&bytes->used, 0U);
    atomic_init(&bytes->counted, 0U);
    return (bytes->of != NULL) && (bytes->byte != NULL) && index_make(&bytes->index, memory, team)
           && ex_count(memory, bytes->index.limit * sizeof *bytes->of);
}

/* Room for some bytes; UINT64_MAX when there is none. */
static uint64_t take_bytes(ex_bytes_t *bytes, uint32_t length)
{
    uint64_t used = atomic_load_explicit(&bytes->used, memory_order_relaxed);
    do {
        uint64_t counted = atomic_load_explicit(&bytes->counted, memory_order_relaxed);
        while ((used + length) > counted) {
            const uint64_t block = ((uint64_t)length / (uint64_t)BLOCK + 1U) * (uint64_t)BLOCK;
            if (((counted + block) > bytes->reserved) || !ex_count(bytes->index.memory, block)) {
                return UINT64_MAX;
            }
            counted = atomic_fetch_add(&bytes->counted, block) + block;
        }
    } while (!atomic_compare_exchange_weak_explicit(&bytes->used, &used, used + length, memory_order_relaxed,
                                                    memory_order_relaxed));
    return used;
}

static bool is_same(const ex_bytes_t *bytes, uint32_t number, uint32_t place, const unsigned char *byte,
                    uint32_t length)
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
                } while (!atomic_compare_exchange_weak_explicit(&index->count, &number, number + 1U,
                                                                memory_order_relaxed, memory_order_relaxed));
                (void)memcpy(&bytes->byte[offset], byte, length);
                bytes->of[number] = (ex_bytes_entry_t){ .offset = offset, .length = length, .place = place };
            }
            if (atomic_compare_exchange_strong_explicit(&index->entry[at], &entry, entry_of(hash, number),
                                                        memory_order_acq_rel, memory_order_acquire)) {
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

static void enter_bytes(void *user, uint32_t part)
{
    const move_t *move = user;
    const ex_bytes_t *bytes = move->bytes;
    const uint64_t end = part_end(move, part);
    for (uint64_t at = part_first(move, part); at < end; at++) {
        uint64_t number;
        if (old_number(move->old, at, &number)) {
            const ex_bytes_entry_t *of = &bytes->of[number];
            index_put(move->index, bytes_hash(of->place, &bytes->byte[of->offset], of->length), number);
        }
    }
}

bool ex_bytes_grow(ex_bytes_t *bytes)
{
    ex_index_t *index = &bytes->index;
    const uint64_t free_bytes = atomic_load(&bytes->counted) - atomic_load(&bytes->used);
    if (!is_crowded(index)) {
        /* Perhaps it was the bytes themselves that could not be had. */
        return (free_bytes > 0U) || ex_has_room(index->memory, (uint64_t)BLOCK);
    }
    ex_index_t old;
    if (!index_enlarge(index, sizeof *bytes->of, &old)) {
        return false;
    }
    move_t move = { .index = index, .old = &old, .bytes = bytes };
    enter_all(&move, enter_bytes);
    return true;
}

uint64_t ex_bytes_bytes(const ex_bytes_t *bytes)
{
    return (bytes->index.entries * sizeof *bytes->index.entry) + (atomic_load(&bytes->index.count) * sizeof *bytes->of)
           + atomic_load(&bytes->used);
}
