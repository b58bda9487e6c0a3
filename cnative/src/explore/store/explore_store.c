/* SPDX-License-Identifier: MIT
 * explore_store.c - the set of keys.
 *
 * Buckets of one cache line: a byte for each slot, then the keys, without padding. The byte is 0 (free), 1 (being
 * written) or a part of the hash; a slot is taken by a compare-and-swap of it. Slots fill from the first to the last,
 * and what does not fit goes to the next bucket, behind the last one to the first; so two threads with the same key
 * meet at the same slot. Where a key is at home is the hash, scaled: in a larger table the order is the same, and
 * growing is one pass from the beginning to the end through both. Keys of one word lie in a simpler way: see
 * explore_words.h.
 */
#include "explore_words.h"

#include <stddef.h>
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
    STEP = 1 << 21,       /* bytes that are given back at a time */
    SHARED_SIZE = 1 << 20 /* bytes of a table that threads move together */
};

#define PARTS 4U /* of such a table, for each thread */

#define SLACK (2U * (uint64_t)STEP) /* bytes of both tables at the same time while one becomes the other */

/* A key without the bits that are always zero, as the two words with which it is compared: its beginning and its end,
 * which may overlap. */
typedef struct probe {
    uint64_t first;
    uint64_t last;
    uint32_t length;
} probe_t;

static inline ex_wide_t pack(const ex_store_t *store, const ex_key_t *key)
{
    const uint64_t low = (uint32_t)key->low | ((key->low >> 32U) << store->width[0]);
    const uint64_t high = (uint32_t)key->high | ((key->high >> 32U) << store->width[2]);
    return ((ex_wide_t)high << (store->width[0] + store->width[1])) | low;
}

static inline uint64_t cut(ex_wide_t wide, uint32_t from, uint32_t width)
{
    return (uint64_t)(wide >> from) & (((uint64_t)1U << width) - 1U);
}

static void unpack(const ex_store_t *store, ex_wide_t wide, ex_key_t *key)
{
    const uint32_t *width = store->width;
    uint32_t at = width[0];
    key->low = cut(wide, 0U, width[0]) | (cut(wide, at, width[1]) << 32U);
    at += width[1];
    key->high = cut(wide, at, width[2]);
    at += width[2];
    key->high |= (width[3] > 0U) ? (cut(wide, at, width[3]) << 32U) : 0U;
}

static bool fits(const ex_store_t *store, const ex_key_t *key)
{
    return ((key->low & ~store->low_mask) | (key->high & ~store->high_mask)) == 0U;
}

static inline probe_t probe_of(const ex_store_t *store, const ex_key_t *key)
{
    const uint32_t length = store->length;
    const ex_wide_t wide = pack(store, key);
    const uint64_t low = (uint64_t)wide;
    if (length >= 8U) {
        return (probe_t){ .first = low, .last = (uint64_t)(wide >> ((length - 8U) * 8U)), .length = length };
    }
    return (probe_t){ .first = (uint32_t)low, .last = (uint32_t)(low >> ((length - 4U) * 8U)), .length = length };
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
    /* Read only once, which `volatile` demands: as in explore_words.h. */
    const __m128i tags = *(const volatile __m128i *)(const volatile void *)bucket;
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

/* --- life --------------------------------------------------------------------------------------------------------- */

static uint64_t limit_of(const ex_store_t *store)
{
    return ((store->buckets * store->slots) / 10U) * (store->is_word ? 8U : 9U);
}

/* The layout for keys of such widths. */
static void lay(ex_store_t *store, const uint32_t width[EX_KEY_WORDS])
{
    uint64_t mask[EX_KEY_WORDS];
    uint32_t bits = 0U;
    for (uint32_t i = 0U; i < EX_KEY_WORDS; i++) {
        store->width[i] = width[i];
        bits += width[i];
        mask[i] = ((uint64_t)1U << width[i]) - 1U;
    }
    store->low_mask = mask[0] | (mask[1] << 32U);
    store->high_mask = mask[2] | (mask[3] << 32U);
    const uint32_t length = (bits + 7U) / 8U;
    store->length = (length < (uint32_t)LEAST_LENGTH) ? (uint32_t)LEAST_LENGTH : length;
    const uint32_t slots = (uint32_t)LINE / (1U + store->length);
    store->slots = (slots > (uint32_t)MOST_SLOTS) ? (uint32_t)MOST_SLOTS : slots;
    if (store->is_word) {
        store->length = (uint32_t)sizeof(uint64_t);
        store->slots = EX_LINE_WORDS;
    }
}

/* Whole pages, as memory is counted. */
static uint64_t buckets_for(const ex_store_t *store, uint64_t keys)
{
    const uint64_t page = 64U;
    return (((keys / store->slots) + page) / page) * page;
}

bool ex_store_make(ex_store_t *store, ex_memory_t *memory, const ex_team_t *team, bool is_word,
                   const uint32_t width[EX_KEY_WORDS], uint64_t keys)
{
    store->memory = memory;
    store->team = team;
    store->is_word = is_word;
    lay(store, width);
    store->buckets = buckets_for(store, keys);
    store->limit = limit_of(store);
    atomic_init(&store->used, 0U);
    store->bucket = ex_alloc(memory, store->buckets * (uint64_t)LINE);
    return store->bucket != NULL;
}

void ex_store_free(ex_store_t *store)
{
    ex_free(store->memory, store->bucket, ex_store_bytes(store));
    store->bucket = NULL;
}

void ex_store_empty(ex_store_t *store)
{
    (void)memset(store->bucket, 0, ex_store_bytes(store));
    atomic_store(&store->used, 0U);
}

void ex_store_replace(ex_store_t *store, const ex_store_t *new)
{
    (void)memcpy(store, new, offsetof(ex_store_t, used));
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

/* --- keys --------------------------------------------------------------------------------------------------------- */

static void read_key(const ex_store_t *store, const unsigned char *at, ex_key_t *key)
{
    if (store->length >= 8U) {
        uint64_t first;
        uint64_t last;
        (void)memcpy(&first, at, sizeof first);
        (void)memcpy(&last, &at[store->length - sizeof last], sizeof last);
        unpack(store, ((ex_wide_t)last << ((store->length - sizeof last) * 8U)) | first, key);
    } else {
        uint32_t first;
        uint32_t last;
        (void)memcpy(&first, at, sizeof first);
        (void)memcpy(&last, &at[store->length - sizeof last], sizeof last);
        unpack(store, ((uint64_t)last << ((store->length - sizeof last) * 8U)) | first, key);
    }
}

bool ex_store_fetch(const ex_store_t *store, uint64_t slot, ex_key_t *key)
{
    if (store->is_word) {
        const uint64_t word = __atomic_load_n(&((const uint64_t *)(const void *)store->bucket)[slot], __ATOMIC_RELAXED);
        *key = (ex_key_t){ word - 1U, 0U };
        return word != 0U;
    }
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
    if (!fits(store, key)) {
        return EX_NO_SLOT;
    }
    if (store->is_word) {
        return ex_word_find(store, key->low, hash);
    }
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
    if (!fits(store, key)) {
        return EX_FULL;
    }
    if (store->is_word) {
        uint64_t where;
        return ex_word_insert(store, key->low, hash, (slot != NULL) ? slot : &where);
    }
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

/* --- growth ------------------------------------------------------------------------------------------------------- */

/* Puts a key that is not there, while nobody else uses the table. */
static bool put(ex_store_t *store, const ex_key_t *key)
{
    const uint64_t hash = ex_hash(key);
    const probe_t probe = probe_of(store, key);
    uint64_t b = ex_scaled(hash, store->buckets);
    for (uint64_t probes = 0U; probes < store->buckets; probes++) {
        unsigned char *bucket = &store->bucket[b * (uint64_t)LINE];
        const uint32_t vacant = look(bucket, 0U, store->slots).vacant;
        if (vacant != 0U) {
            const uint32_t i = (uint32_t)__builtin_ctz(vacant);
            write_key(&bucket[store->slots + (i * store->length)], &probe);
            bucket[i] = tag_of(hash);
            return true;
        }
        b = after(store, b);
    }
    return false;
}

/* The same with the words of a line. */
static bool move_line(const uint64_t *line, ex_store_t *new)
{
    for (uint32_t i = 0U; (i < EX_LINE_WORDS) && (line[i] != 0U); i++) {
        uint64_t slot;
        if (ex_word_insert(new, line[i] - 1U, ex_word_hash(line[i] - 1U), &slot) != EX_NEW) {
            return false;
        }
    }
    return true;
}

static bool move_bucket(const ex_store_t *old, const unsigned char *bucket, ex_store_t *new)
{
    for (uint32_t i = 0U; (i < old->slots) && (bucket[i] != (unsigned char)FREE); i++) {
        ex_key_t key;
        read_key(old, &bucket[old->slots + (i * old->length)], &key);
        if (!put(new, &key)) {
            return false;
        }
    }
    return true;
}

/* The same while others do so, too. */
static bool share_bucket(const ex_store_t *old, const unsigned char *bucket, ex_store_t *new)
{
    for (uint32_t i = 0U; (i < old->slots) && (bucket[i] != (unsigned char)FREE); i++) {
        ex_key_t key;
        read_key(old, &bucket[old->slots + (i * old->length)], &key);
        if (ex_store_insert(new, &key, ex_hash(&key), NULL) != EX_NEW) {
            return false;
        }
    }
    return true;
}

/* The pass through both tables, in parts that threads take. What has been read is given back while the new table fills,
 * so that not much more than one of them takes room. */
typedef struct move {
    const ex_store_t *old;
    ex_store_t *new;
    uint32_t parts;
    _Atomic bool has_failed;
} move_t;

static void move_part(void *user, uint32_t part)
{
    move_t *const move = user;
    const ex_store_t *old = move->old;
    const uint64_t each = (old->buckets / move->parts) + 1U;
    const uint64_t first = (each * part < old->buckets) ? (each * part) : old->buckets;
    const uint64_t end = ((old->buckets - first) < each) ? old->buckets : (first + each);
    uint64_t done = first * (uint64_t)LINE;
    for (uint64_t b = first; b < end; b++) {
        const unsigned char *bucket = &old->bucket[b * (uint64_t)LINE];
        bool is_fine;
        if (old->is_word) {
            is_fine = move_line((const uint64_t *)(const void *)bucket, move->new);
        } else {
            is_fine = (move->parts > 1U) ? share_bucket(old, bucket, move->new) : move_bucket(old, bucket, move->new);
        }
        if (!is_fine) {
            atomic_store(&move->has_failed, true);
            return;
        }
        const uint64_t at = b * (uint64_t)LINE;
        if ((at - done) >= (uint64_t)STEP) {
            ex_discard(old->memory, old->bucket, ex_store_bytes(old), done, at);
            done = at & ~((uint64_t)STEP - 1U);
        }
    }
}

static bool move_all(const ex_store_t *old, ex_store_t *new)
{
    const bool is_shared = (old->team->threads > 1U) && (ex_store_bytes(old) >= (uint64_t)SHARED_SIZE);
    move_t move = { .old = old, .new = new, .parts = is_shared ? (PARTS * old->team->threads) : 1U };
    atomic_init(&move.has_failed, false);
    old->team->together(old->team->self, move.parts, move_part, &move);
    return !atomic_load(&move.has_failed);
}

/* Counts what the new table takes more than the old one, for which there must be room; false: there is none. */
static bool count_growth(const ex_store_t *old, const ex_store_t *new)
{
    const uint64_t more = ex_is_spilled(new->memory, ex_store_bytes(new)) ? 0U : ex_store_bytes(new);
    const uint64_t less = ex_is_spilled(old->memory, ex_store_bytes(old)) ? 0U : ex_store_bytes(old);
    if (ex_store_bytes(old) < SLACK) {
        return ex_count(new->memory, more); /* both at the same time */
    }
    if (more <= less) {
        return true;
    }
    return ex_has_room(new->memory, (more - less) + SLACK) && ex_count(new->memory, more - less);
}

/* With a table of so many buckets and keys of such widths. */
static bool grow_to(ex_store_t *store, uint64_t buckets, const uint32_t width[EX_KEY_WORDS])
{
    ex_store_t new = *store;
    lay(&new, width);
    new.buckets = buckets;
    new.limit = limit_of(&new);
    if (!count_growth(store, &new)) {
        return false;
    }
    new.bucket = ex_map(store->memory, ex_store_bytes(&new));
    if (new.bucket == NULL) {
        return false; /* what was counted stays so: the run ends */
    }
    const bool is_whole = move_all(store, &new);
    ex_unmap(store->bucket, ex_store_bytes(store));
    if (!ex_is_spilled(store->memory, ex_store_bytes(store))) {
        if (ex_store_bytes(store) < SLACK) {
            ex_uncount(store->memory, ex_store_bytes(store));
        } else if (ex_store_bytes(&new) < ex_store_bytes(store)) {
            ex_uncount(store->memory, ex_store_bytes(store) - ex_store_bytes(&new));
        }
    }
    ex_store_replace(store, &new);
    return is_whole;
}

/* Twice as much while it is little, then a quarter more; half as much where time is worth more. */
static uint64_t larger(const ex_store_t *store)
{
    const uint64_t keys = ex_store_slots(store);
    const uint64_t bytes = ex_store_bytes(store);
    if (bytes < ((uint64_t)1U << 20U)) {
        return keys * 2U;
    }
    return keys + (store->is_word ? (keys / 2U) : (keys / 4U));
}

bool ex_store_grow(ex_store_t *store, const uint32_t width[EX_KEY_WORDS])
{
    const uint64_t used = atomic_load(&store->used);
    const bool is_full = (used + EX_SPARE_KEYS) >= store->limit;
    ex_store_t new = *store;
    uint32_t wider[EX_KEY_WORDS];
    bool is_narrow = false;
    for (uint32_t i = 0U; i < EX_KEY_WORDS; i++) {
        wider[i] = (width[i] > store->width[i]) ? width[i] : store->width[i];
        is_narrow = is_narrow || (width[i] > store->width[i]);
    }
    if (!is_full && !is_narrow) {
        return true;
    }
    lay(&new, wider);
    const uint64_t room = store->buckets * store->slots; /* keys */
    const uint64_t wanted = is_full ? larger(store) : room;
    for (uint64_t part = 1U; part <= 4U; part *= 2U) {
        const uint64_t keys = is_full ? (room + ((wanted - room) / part)) : room;
        new.buckets = buckets_for(&new, keys);
        const uint64_t bytes = ex_store_bytes(&new);
        const uint64_t old = ex_store_bytes(store);
        const uint64_t more = (old < SLACK) ? bytes : (((bytes > old) ? (bytes - old) : 0U) + SLACK);
        if (ex_is_spilled(store->memory, bytes) || ex_has_room(store->memory, more)) {
            return grow_to(store, new.buckets, wider);
        }
    }
    /* No room for a larger one: this one can become a little fuller. */
    const uint64_t most = (room / 100U) * 97U;
    const bool is_possible = !is_narrow && (store->limit < most);
    store->limit = is_possible ? most : store->limit;
    return is_possible;
}
