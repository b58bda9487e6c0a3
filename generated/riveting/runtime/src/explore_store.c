/* SPDX-License-Identifier: MIT
 * explore_store.c - the set of keys.
 *
 * Buckets of one cache line: a byte for each slot, then the keys, without padding. The byte is 0 (free), 1 (being written) or a part of
 * the hash; a slot is taken by a compare-and-swap of it. Slots fill from the first to the last, and what does not fit goes to the next
 * bucket, behind the last one to the first; so two threads with the same key meet at the same slot. Where a key is at home is the hash, scaled: in a larger table the
 * order is the same, and growing is one pass from the beginning to the end through both.
 */
#include "explore_impl.h"

#include <string.h>

#if defined(__SSE2__) && !defined(__SANITIZE_THREAD__)
#define EX_VECTOR 1
#include <emmintrin.h>
#endif

enum {
    LINE = 64,
    FREE = 0,
    BUSY = 1,
    FIRST_TAG = 2,
    LEAST_LENGTH = 4,
    MOST_SLOTS = 12,
    STEP = 1 << 21 /* bytes that are given back at a time */
};

/* A key as the two words with which it is compared: its beginning and its end, which may overlap. */
typedef struct probe {
    uint64_t first;
    uint64_t last;
    uint32_t length;
} probe_t;

static probe_t probe_of(const ex_store_t *store, const ex_key_t *key)
{
    probe_t probe = { .first = key->low, .last = key->low, .length = store->length };
    const uint32_t length = store->length;
    if (length > 8U) {
        const uint32_t cut = (length - 8U) * 8U; /* bits of the beginning that the end does not repeat */
        probe.last = (cut == 64U) ? key->high : ((key->low >> cut) | (key->high << (64U - cut)));
    } else if (length < 8U) {
        probe.last = (uint32_t)(key->low >> ((length - 4U) * 8U));
        probe.first = (uint32_t)key->low;
    }
    return probe;
}

static bool is_equal(const unsigned char *at, const probe_t *probe)
{
    if (probe->length >= 8U) {
        uint64_t first;
        uint64_t last;
        (void)memcpy(&first, at, 8U);
        (void)memcpy(&last, &at[probe->length - 8U], 8U);
        return ((first ^ probe->first) | (last ^ probe->last)) == 0U;
    }
    uint32_t first;
    uint32_t last;
    (void)memcpy(&first, at, 4U);
    (void)memcpy(&last, &at[probe->length - 4U], 4U);
    return (first == (uint32_t)probe->first) && (last == (uint32_t)probe->last);
}

static void write_key(unsigned char *at, const probe_t *probe)
{
    if (probe->length >= 8U) {
        (void)memcpy(at, &probe->first, 8U);
        (void)memcpy(&at[probe->length - 8U], &probe->last, 8U);
    } else {
        const uint32_t first = (uint32_t)probe->first;
        const uint32_t last = (uint32_t)probe->last;
        (void)memcpy(at, &first, 4U);
        (void)memcpy(&at[probe->length - 4U], &last, 4U);
    }
}

static unsigned char tag_of(uint64_t hash)
{
    const unsigned char tag = (unsigned char)hash;
    return (tag < (unsigned char)FIRST_TAG) ? (unsigned char)(tag + 0x55U) : tag;
}

/* Which slots of a bucket hold the tag, are free, are being written: one bit each. */
typedef struct view {
    uint32_t same;
    uint32_t vacant;
    uint32_t busy;
} view_t;

static inline view_t look(const unsigned char *bucket, unsigned char tag, uint32_t slots)
{
    view_t view = { 0U, 0U, 0U };
#ifdef EX_VECTOR
    const uint32_t all = (1U << slots) - 1U;
    const __m128i tags = _mm_load_si128((const __m128i *)(const void *)bucket);
    view.same = (uint32_t)_mm_movemask_epi8(_mm_cmpeq_epi8(tags, _mm_set1_epi8((char)tag))) & all;
    view.vacant = (uint32_t)_mm_movemask_epi8(_mm_cmpeq_epi8(tags, _mm_setzero_si128())) & all;
    view.busy = (uint32_t)_mm_movemask_epi8(_mm_cmpeq_epi8(tags, _mm_set1_epi8((char)BUSY))) & all;
    /* Of this processor: loads are not done before earlier ones. */
    atomic_signal_fence(memory_order_acquire);
#else
    for (uint32_t i = 0U; i < slots; i++) {
        const unsigned char there = __atomic_load_n(&bucket[i], __ATOMIC_ACQUIRE);
        view.same |= (there == tag) ? (1U << i) : 0U;
        view.vacant |= (there == (unsigned char)FREE) ? (1U << i) : 0U;
        view.busy |= (there == (unsigned char)BUSY) ? (1U << i) : 0U;
    }
#endif
    return view;
}

/* --- life ------------------------------------------------------------------------------------------------------------ */

static uint64_t limit_of(const ex_store_t *store)
{
    return ((store->buckets * store->slots) / 10U) * 9U;
}

bool ex_store_make(ex_store_t *store, ex_run_t *run, uint32_t length, uint64_t keys)
{
    store->run = run;
    store->length = (length < (uint32_t)LEAST_LENGTH) ? (uint32_t)LEAST_LENGTH : length;
    const uint32_t slots = (uint32_t)LINE / (1U + store->length);
    store->slots = (slots > (uint32_t)MOST_SLOTS) ? (uint32_t)MOST_SLOTS : slots;
    store->low_mask = (store->length >= 8U) ? UINT64_MAX : ((((uint64_t)1U) << (store->length * 8U)) - 1U);
    store->high_mask = (store->length >= 16U) ? UINT64_MAX : ((store->length <= 8U) ? 0U
                       : ((((uint64_t)1U) << ((store->length - 8U) * 8U)) - 1U));
    store->buckets = (keys / store->slots) + 1U;
    store->limit = limit_of(store);
    atomic_init(&store->used, 0U);
    store->bucket = ex_alloc(run, store->buckets * (uint64_t)LINE);
    return store->bucket != NULL;
}

void ex_store_free(ex_store_t *store)
{
    ex_free(store->run, store->bucket, ex_store_bytes(store));
    store->bucket = NULL;
}

uint64_t ex_store_bytes(const ex_store_t *store)
{
    return store->buckets * (uint64_t)LINE;
}

uint64_t ex_store_slots(const ex_store_t *store)
{
    return store->buckets * store->slots;
}

static uint64_t after(const ex_store_t *store, uint64_t b)
{
    return ((b + 1U) < store->buckets) ? (b + 1U) : 0U;
}

/* --- keys ------------------------------------------------------------------------------------------------------------- */

static void read_key(const ex_store_t *store, const unsigned char *at, ex_key_t *key)
{
    key->low = 0U;
    key->high = 0U;
    (void)memcpy(&key->low, at, (store->length < 8U) ? store->length : 8U);
    if (store->length > 8U) {
        (void)memcpy(&key->high, &at[8], store->length - 8U);
    }
}

bool ex_store_fetch(const ex_store_t *store, uint64_t slot, ex_key_t *key)
{
    const unsigned char *bucket = &store->bucket[(slot / store->slots) * (uint64_t)LINE];
    const uint32_t i = (uint32_t)(slot % store->slots);
    if (__atomic_load_n(&bucket[i], __ATOMIC_ACQUIRE) < (unsigned char)FIRST_TAG) {
        return false;
    }
    read_key(store, &bucket[store->slots + (i * store->length)], key);
    return true;
}

uint64_t ex_store_find(const ex_store_t *store, const ex_key_t *key, uint64_t hash)
{
    const probe_t probe = probe_of(store, key);
    const unsigned char tag = tag_of(hash);
    uint64_t b = ex_scaled(hash, store->buckets);
    for (uint64_t probes = 0U; probes < store->buckets; probes++) {
        const unsigned char *bucket = &store->bucket[b * (uint64_t)LINE];
        view_t view = look(bucket, tag, store->slots);
        while (view.same != 0U) {
            const uint32_t i = (uint32_t)__builtin_ctz(view.same);
            if (is_equal(&bucket[store->slots + (i * store->length)], &probe)) {
                return (b * store->slots) + i;
            }
            view.same &= view.same - 1U;
        }
        if (view.vacant != 0U) {
            break;
        }
        b = after(store, b);
    }
    return EX_NO_SLOT;
}

ex_insertion_t ex_store_insert(ex_store_t *store, const ex_key_t *key, uint64_t hash, uint64_t *slot)
{
    const probe_t probe = probe_of(store, key);
    const unsigned char tag = tag_of(hash);
    uint64_t b = ex_scaled(hash, store->buckets);
    uint64_t probes = 0U;
    while (probes < store->buckets) {
        unsigned char *bucket = &store->bucket[b * (uint64_t)LINE];
        view_t view = look(bucket, tag, store->slots);
        while (view.same != 0U) {
            const uint32_t i = (uint32_t)__builtin_ctz(view.same);
            if (is_equal(&bucket[store->slots + (i * store->length)], &probe)) {
                if (slot != NULL) {
                    *slot = (b * store->slots) + i;
                }
                return EX_KNOWN;
            }
            view.same &= view.same - 1U;
        }
        if (view.busy != 0U) {
            continue; /* it may be the same key */
        }
        if (view.vacant == 0U) {
            b = after(store, b);
            probes++;
            continue;
        }
        const uint32_t i = (uint32_t)__builtin_ctz(view.vacant);
        unsigned char expected = (unsigned char)FREE;
        if (__atomic_compare_exchange_n(&bucket[i], &expected, (unsigned char)BUSY, false, __ATOMIC_ACQUIRE,
                                        __ATOMIC_ACQUIRE)) {
            write_key(&bucket[store->slots + (i * store->length)], &probe);
            __atomic_store_n(&bucket[i], tag, __ATOMIC_RELEASE);
            if (slot != NULL) {
                *slot = (b * store->slots) + i;
            }
            return EX_NEW;
        }
    }
    return EX_FULL;
}

/* --- growth ----------------------------------------------------------------------------------------------------------- */

/* Puts a key that is not there, while nobody else uses the table. */
static bool put(ex_store_t *store, const ex_key_t *key)
{
    const uint64_t hash = ex_hash(key);
    const probe_t probe = probe_of(store, key);
    uint64_t b = ex_scaled(hash, store->buckets);
    for (uint64_t probes = 0U; probes < store->buckets; probes++) {
        unsigned char *bucket = &store->bucket[b * (uint64_t)LINE];
        for (uint32_t i = 0U; i < store->slots; i++) {
            if (bucket[i] == (unsigned char)FREE) {
                write_key(&bucket[store->slots + (i * store->length)], &probe);
                bucket[i] = tag_of(hash);
                return true;
            }
        }
        b = after(store, b);
    }
    return false;
}

/* The number of homes of the next table: twice as many while it is small, a quarter more when it is large. */
static uint64_t larger(const ex_store_t *store)
{
    const uint64_t bytes = store->buckets * (uint64_t)LINE;
    if (bytes < ((uint64_t)1U << 20U)) {
        return store->buckets * 2U;
    }
    return store->buckets + ((bytes < ((uint64_t)1U << 24U)) ? (store->buckets / 2U) : (store->buckets / 4U));
}

/* The pass through both tables. What has been read is given back while the new table fills, so that not much more than one of them
 * takes room. */
static bool move_all(const ex_store_t *old, ex_store_t *new)
{
    uint64_t done = 0U;
    for (uint64_t b = 0U; b < old->buckets; b++) {
        const unsigned char *bucket = &old->bucket[b * (uint64_t)LINE];
        for (uint32_t i = 0U; (i < old->slots) && (bucket[i] != (unsigned char)FREE); i++) {
            ex_key_t key;
            read_key(old, &bucket[old->slots + (i * old->length)], &key);
            if (!put(new, &key)) {
                return false;
            }
        }
        const uint64_t at = b * (uint64_t)LINE;
        if ((at - done) >= (uint64_t)STEP) {
            ex_discard(old->run, old->bucket, ex_store_bytes(old), done, at);
            done = at & ~((uint64_t)STEP - 1U);
        }
    }
    return true;
}

/* Counts what the new table takes more than the old one, for which there must be room; false: there is none. */
static bool count_growth(const ex_store_t *old, const ex_store_t *new)
{
    const uint64_t slack = 2U * (uint64_t)STEP;
    const uint64_t more = ex_is_spilled(new->run, ex_store_bytes(new)) ? 0U : ex_store_bytes(new);
    const uint64_t less = ex_is_spilled(old->run, ex_store_bytes(old)) ? 0U : ex_store_bytes(old);
    if (ex_store_bytes(old) < slack) {
        return ex_count(new->run, more); /* both at the same time */
    }
    if (more <= less) {
        return true;
    }
    return ex_has_room(new->run, (more - less) + slack) && ex_count(new->run, more - less);
}

/* With a table of so many homes. */
static bool grow_to(ex_store_t *store, uint64_t homes)
{
    ex_store_t new = *store;
    new.buckets = homes;
    new.limit = limit_of(&new);
    if (!count_growth(store, &new)) {
        return false;
    }
    new.bucket = ex_map(store->run, ex_store_bytes(&new));
    if (new.bucket == NULL) {
        return false; /* what was counted stays so: the run ends */
    }
    const bool is_whole = move_all(store, &new);
    ex_unmap(store->bucket, ex_store_bytes(store));
    if ((ex_store_bytes(store) < (2U * (uint64_t)STEP)) && !ex_is_spilled(store->run, ex_store_bytes(store))) {
        ex_uncount(store->run, ex_store_bytes(store));
    }
    store->bucket = new.bucket;
    store->buckets = new.buckets;
    store->buckets = new.buckets;
    store->limit = new.limit;
    return is_whole;
}

bool ex_store_grow(ex_store_t *store)
{
    const uint64_t wanted = larger(store) - store->buckets;
    for (uint64_t part = 1U; part <= 4U; part *= 2U) {
        ex_store_t new = *store;
        new.buckets += wanted / part;
        const uint64_t slack = 2U * (uint64_t)STEP;
        const uint64_t bytes = (ex_store_bytes(store) < slack) ? ex_store_bytes(&new) : ((wanted / part) * (uint64_t)LINE) + slack;
        if (ex_is_spilled(store->run, ex_store_bytes(&new)) || ex_has_room(store->run, bytes)) {
            return grow_to(store, store->buckets + (wanted / part));
        }
    }
    /* No room for a larger one: this one can become a little fuller. */
    const uint64_t most = ((store->buckets * store->slots) / 100U) * 97U;
    const bool is_possible = store->limit < most;
    store->limit = most;
    return is_possible;
}
