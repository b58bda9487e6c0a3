/* SPDX-License-Identifier: MIT
 * explore_codec.c - markings as vectors of words, vectors as keys, and back.
 *
 * A vector of at most four words is a key. A longer one is divided into four parts, of which each has a number: that of
 * the root of a tree of words, whose inner nodes have numbers, too. Where it is cut follows the places, as different
 * places often vary independently; so the numbers stay small, and the store keeps no more bits of them than they need.
 *
 * A successor differs in few places from the state it comes from: only the places that its transition touches are
 * encoded again, and only the inner nodes above words that have changed are looked up again.
 */
#define _POSIX_C_SOURCE 200809L

#include "../explore_run.h"
#include "explore_roots.h"
#include "explore_multiset.h"

#include <string.h>

#include "pn/pn_arena.h"

enum {
    UNIT = 8,
    UNIT_BITS = 64,
    DECODED_MOST = 1 << 20 /* bytes of decoded values that are kept; a page cache is faster than more of them */
};

#define NONE UINT32_MAX

bool ex_scratch_make(ex_worker_t *worker)
{
    ex_run_t *run = worker->run;
    const ex_codec_t *codec = run->codec;
    ex_scratch_t *scratch = ex_alloc(&run->memory, sizeof *scratch);
    if (scratch == NULL) {
        return false;
    }
    worker->scratch = scratch;
    if (!ex_roots_make(worker)) {
        return false;
    }
    const uint64_t cells = 2U * ((uint64_t)codec->words + 1U); /* more inner nodes than words there never are */
    scratch->cell = ex_table(&run->memory, cells, sizeof *scratch->cell);
    scratch->dirty = ex_table(&run->memory, (codec->words / 64U) + 1U, sizeof *scratch->dirty);
    scratch->stale = ex_table(&run->memory, (codec->words / 64U) + 1U, sizeof *scratch->stale);
    scratch->undo_cell = ex_table(&run->memory, cells, sizeof *scratch->undo_cell);
    scratch->undo_value = ex_table(&run->memory, cells, sizeof *scratch->undo_value);
    scratch->decoded = ex_table(&run->memory, codec->words - codec->packed_words, sizeof *scratch->decoded);
    scratch->buffer_size = 4096U;
    scratch->buffer = ex_alloc(&run->memory, scratch->buffer_size);
    /* What is never touched of the large ones costs nothing. */
    worker->marking = ex_reserve(pn_net.marking_size + (size_t)UNIT);
    scratch->next = ex_reserve(pn_net.marking_size + (size_t)UNIT);
    scratch->binding = ex_alloc(&run->memory, pn_binding_size(&pn_net));
    void *memory = ex_reserve(run->options.arena);
    if ((scratch->cell == NULL) || (scratch->dirty == NULL) || (scratch->stale == NULL) || (scratch->undo_cell == NULL)
        || (scratch->undo_value == NULL) || (scratch->decoded == NULL) || (scratch->buffer == NULL)
        || (worker->marking == NULL) || (scratch->next == NULL) || (scratch->binding == NULL) || (memory == NULL)) {
        return false;
    }
    pn_arena_init(&scratch->arena, memory, (size_t)run->options.arena);
    pn_arena_seal(&scratch->arena);
    pn_ctx_init(&worker->cx, &scratch->arena, run->options.seed);
    ex_unload(worker);
    return true;
}

/* --- cells -------------------------------------------------------------------------------------------------------- */

static bool intern_place(ex_worker_t *worker, uint32_t place, const void *marking, uint32_t *number)
{
    return ex_number_place(worker, place, place, marking, number);
}

static bool intern_whole(ex_worker_t *worker, const void *marking, uint32_t *number)
{
    ex_scratch_t *scratch = worker->scratch;
    size_t length = pn_marking_encode(&pn_net, marking, scratch->buffer, scratch->buffer_size);
    while (length == 0U) {
        if (!ex_buffer_grow(worker, scratch->buffer_size)) {
            return false;
        }
        length = pn_marking_encode(&pn_net, marking, scratch->buffer, scratch->buffer_size);
    }
    return ex_intern(worker, pn_net.place_count, scratch->buffer, length, number);
}

static bool intern_time(ex_worker_t *worker, const void *marking, uint32_t *number)
{
    const pn_time_t now = pn_now(&pn_net, marking);
    unsigned char bytes[sizeof now];
    (void)memcpy(bytes, &now, sizeof now);
    return ex_intern(worker, pn_net.place_count, bytes, sizeof bytes, number);
}

/* Cell `c` becomes `value`; the old one is remembered. */
static inline void set_cell(ex_worker_t *worker, uint32_t c, uint32_t value)
{
    ex_scratch_t *scratch = worker->scratch;
    const uint32_t old = scratch->cell[c];
    if (old != value) {
        const uint32_t parent = worker->run->codec->parent[c];
        scratch->undo_cell[scratch->undone] = c;
        scratch->undo_value[scratch->undone] = old;
        scratch->undone++;
        scratch->cell[c] = value;
        if (parent != NONE) {
            scratch->dirty[parent / 64U] |= (uint64_t)1U << (parent % 64U);
        }
    }
}

static void undo(ex_scratch_t *scratch)
{
    for (uint32_t i = scratch->undone; i > 0U; i--) {
        scratch->cell[scratch->undo_cell[i - 1U]] = scratch->undo_value[i - 1U];
    }
    scratch->undone = 0U;
}

static inline void lanes_of(const ex_node_t *node, const uint32_t *cell, uint64_t lane[EX_TUPLE_LANES])
{
    for (uint32_t i = 0U; i < EX_TUPLE_LANES; i++) {
        /* Children that there are not are cells that are always 0. */
        lane[i] = cell[node->child[2U * i]] | ((uint64_t)cell[node->child[(2U * i) + 1U]] << 32U);
    }
}

bool ex_number_tuple(ex_worker_t *worker, ex_tuples_t *tuples, const uint64_t lane[EX_TUPLE_LANES], uint64_t hash,
                     uint32_t *number)
{
    for (;;) {
        *number = ex_tuples_number(tuples, lane, hash);
        if (*number != EX_NO_NUMBER) {
            return true;
        }
        if (!ex_pause(worker)) {
            worker->failed = true;
            return false;
        }
    }
}

static bool number_lanes(ex_worker_t *worker, uint32_t table, const uint64_t lane[EX_TUPLE_LANES], uint32_t *number)
{
    ex_tuples_t *tuples = &worker->run->codec->tuples[table];
    return ex_number_tuple(worker, tuples, lane, ex_tuple_hash(lane, tuples->lanes), number);
}

static bool number_node(ex_worker_t *worker, uint32_t n, uint32_t *number)
{
    const ex_node_t *node = &worker->run->codec->node[n];
    uint64_t lane[EX_TUPLE_LANES];
    lanes_of(node, worker->scratch->cell, lane);
    return number_lanes(worker, node->table, lane, number);
}

/* Looks up the nodes above what has changed. Children come before their parents. */
static bool number_dirty(ex_worker_t *worker)
{
    const ex_codec_t *codec = worker->run->codec;
    ex_scratch_t *scratch = worker->scratch;
    for (uint32_t w = 0U; w <= (codec->nodes / 64U); w++) {
        scratch->dirty[w] |= scratch->stale[w];
        while (scratch->dirty[w] != 0U) {
            const uint32_t n = (w * 64U) + (uint32_t)__builtin_ctzll(scratch->dirty[w]);
            uint32_t number;
            scratch->dirty[w] &= scratch->dirty[w] - 1U;
            if (!number_node(worker, n, &number)) {
                return false;
            }
            set_cell(worker, codec->words + n, number);
        }
    }
    return true;
}

/* The words were stored one by one: they are loaded so. */
static inline void join_words(const uint32_t word[EX_KEY_WORDS], ex_key_t *key)
{
    key->low = ex_alone(word[0]) | (ex_alone(word[1]) << 32U);
    key->high = ex_alone(word[2]) | (ex_alone(word[3]) << 32U);
}

/* The key of the cells. */
static inline void root_key(const ex_codec_t *codec, const uint32_t *cell, ex_key_t *key)
{
    uint32_t word[EX_KEY_WORDS] = { 0U, 0U, 0U, 0U };
    for (uint32_t i = 0U; i < codec->roots; i++) {
        word[i] = cell[codec->root[i]];
    }
    join_words(word, key);
}

/* A word of the vector from the packed part. */
static inline uint32_t slice_of(const ex_codec_t *codec, const void *marking, uint32_t w)
{
    const uint32_t bit = codec->slice_bit[w];
    uint64_t unit;
    (void)memcpy(&unit, (const unsigned char *)marking + ((bit / (uint32_t)UNIT_BITS) * sizeof unit), sizeof unit);
    return (uint32_t)((unit >> (bit % (uint32_t)UNIT_BITS)) & (((uint64_t)1U << codec->slice_width[w]) - 1U));
}

uint32_t ex_packed_word(const ex_codec_t *codec, const void *marking, uint32_t w)
{
    return slice_of(codec, marking, w);
}

/* The other way round: the bits are 0 before. */
static inline void put_slice(const ex_codec_t *codec, void *marking, uint32_t w, uint32_t value)
{
    const uint32_t bit = codec->slice_bit[w];
    unsigned char *at = (unsigned char *)marking + ((bit / (uint32_t)UNIT_BITS) * sizeof(uint64_t));
    uint64_t unit;
    (void)memcpy(&unit, at, sizeof unit);
    unit |= (uint64_t)value << (bit % (uint32_t)UNIT_BITS);
    (void)memcpy(at, &unit, sizeof unit);
}

static void clear_stale(ex_worker_t *worker)
{
    for (uint32_t w = 0U; w <= (worker->run->codec->nodes / 64U); w++) {
        worker->scratch->stale[w] = 0U;
    }
}

static inline bool is_stale(const ex_scratch_t *scratch, uint32_t n)
{
    return ((scratch->stale[n / 64U] >> (n % 64U)) & 1U) != 0U;
}

/* --- encoding ----------------------------------------------------------------------------------------------------- */

bool ex_encode(ex_worker_t *worker, const void *marking, ex_key_t *key)
{
    const ex_codec_t *codec = worker->run->codec;
    ex_scratch_t *scratch = worker->scratch;
    uint32_t *cell = scratch->cell;
    bool is_fine = true;
    ex_unload(worker);
    clear_stale(worker);
    if (codec->is_whole) {
        is_fine = intern_whole(worker, marking, &cell[0]);
    }
    for (uint32_t w = 0U; w < codec->packed_words; w++) {
        cell[w] = slice_of(codec, marking, w);
    }
    for (uint32_t i = 0U; is_fine && (i < pn_net.place_count); i++) {
        is_fine = (codec->word_of[i] == NONE) || intern_place(worker, i, marking, &cell[codec->word_of[i]]);
    }
    if (is_fine && (codec->time_word != NONE)) {
        is_fine = intern_time(worker, marking, &cell[codec->time_word]);
    }
    if (is_fine && (codec->root_word != NONE)) {
        is_fine = ex_roots_number(worker, &cell[codec->root_word]);
    }
    for (uint32_t n = 0U; is_fine && (n < codec->nodes); n++) {
        is_fine = number_node(worker, n, &cell[codec->words + n]);
    }
    root_key(codec, cell, key);
    return is_fine;
}

bool ex_encode_time(ex_worker_t *worker)
{
    const ex_codec_t *codec = worker->run->codec;
    ex_scratch_t *scratch = worker->scratch;
    const bool is_reduced = worker->run->options.is_time_reduced;
    uint32_t number;
    for (uint32_t i = 0U; is_reduced && (i < pn_net.place_count); i++) {
        if (pn_net.place[i].multiset->is_timed && (codec->word_of[i] != NONE)) {
            if (!intern_place(worker, i, worker->marking, &number)) {
                return false;
            }
            set_cell(worker, codec->word_of[i], number);
            scratch->decoded[codec->word_of[i] - codec->packed_words] = number;
        }
    }
    if (!is_reduced && (codec->time_word != NONE)) {
        if (!intern_time(worker, worker->marking, &number)) {
            return false;
        }
        set_cell(worker, codec->time_word, number);
        scratch->decoded[codec->time_word - codec->packed_words] = number;
    }
    /* The words stay. What is above them is looked up for each successor: only with what that changes is it part of a
     * state. */
    for (uint32_t w = 0U; w <= (codec->nodes / 64U); w++) {
        scratch->stale[w] |= scratch->dirty[w];
        scratch->dirty[w] = 0U;
    }
    scratch->undone = 0U;
    return true;
}

/* A part of the key of a successor: a node over words that can be read as they lie there. */
static inline bool encode_direct(ex_worker_t *worker, const ex_node_t *node, const void *next, uint32_t *number)
{
    const uint64_t *const unit = next;
    const uint64_t *const old = worker->marking;
    uint64_t lane[EX_TUPLE_LANES];
    uint64_t difference = 0U;
    for (uint32_t i = 0U; i < EX_TUPLE_LANES; i++) {
        lane[i] = unit[node->unit[i]] & node->mask[i];
        difference |= (unit[node->unit[i]] ^ old[node->unit[i]]) & node->mask[i];
    }
    return (difference == 0U) || number_lanes(worker, node->table, lane, number);
}

/* A part of the key of a successor: a node over words, of which those of multisets are in the cells already. */
static inline bool encode_part(ex_worker_t *worker, const ex_node_t *node, const void *next, bool is_different,
                               uint32_t *number)
{
    const ex_codec_t *codec = worker->run->codec;
    const uint32_t *cell = worker->scratch->cell;
    uint64_t lane[EX_TUPLE_LANES] = { 0U, 0U, 0U, 0U };
    uint32_t difference = is_different ? 1U : 0U;
    for (uint32_t i = 0U; i < node->count; i++) {
        const uint32_t c = node->child[i];
        const uint32_t word = (c < codec->packed_words) ? slice_of(codec, next, c) : cell[c];
        difference |= word ^ cell[c];
        lane[i / 2U] |= (uint64_t)word << (32U * (i % 2U));
    }
    return (difference == 0U) || number_lanes(worker, node->table, lane, number);
}

/* The key of a successor where all nodes are parts of the key: only those that the transition touches are looked at. */
static EX_APART bool encode_flat(ex_worker_t *worker, uint32_t transition, const void *next, ex_key_t *key)
{
    const ex_codec_t *codec = worker->run->codec;
    ex_scratch_t *scratch = worker->scratch;
    uint32_t *cell = scratch->cell;
    uint32_t word[EX_KEY_WORDS] = { 0U, 0U, 0U, 0U };
    bool is_fine = true;
    for (uint32_t k = 0U; is_fine && (k < codec->touched_multiset_count[transition]); k++) {
        const uint32_t place = codec->touched_multisets[transition][k];
        const uint32_t c = codec->word_of[place];
        uint32_t number;
        is_fine = intern_place(worker, place, next, &number);
        if (is_fine && (number != cell[c])) {
            scratch->undo_cell[scratch->undone] = c;
            scratch->undo_value[scratch->undone] = cell[c];
            scratch->undone++;
            cell[c] = number;
        }
    }
    for (uint32_t i = 0U; i < codec->roots; i++) {
        const uint32_t c = codec->root[i];
        const bool is_late = (c >= codec->words) && is_stale(scratch, c - codec->words);
        word[i] = cell[c];
        if (!is_fine || (!is_late && (((codec->touched_parts[transition] >> i) & 1U) == 0U))) {
            continue;
        }
        if (c < codec->packed_words) {
            word[i] = slice_of(codec, next, c);
        } else if (c >= codec->words) {
            const ex_node_t *node = &codec->node[c - codec->words];
            is_fine = node->is_direct ? encode_direct(worker, node, next, &word[i])
                                      : encode_part(worker, node, next, is_late || (scratch->undone > 0U), &word[i]);
        }
    }
    join_words(word, key);
    undo(scratch);
    return is_fine;
}

static EX_APART bool encode_cells(ex_worker_t *worker, uint32_t transition, const void *next, ex_key_t *key)
{
    const ex_codec_t *codec = worker->run->codec;
    ex_scratch_t *scratch = worker->scratch;
    bool is_fine = true;
    uint32_t number;
    if (codec->is_whole) {
        is_fine = intern_whole(worker, next, &number);
        if (is_fine) {
            set_cell(worker, 0U, number);
        }
    }
    for (uint32_t k = 0U; is_fine && (k < codec->touched_multiset_count[transition]); k++) {
        const uint32_t place = codec->touched_multisets[transition][k];
        is_fine = intern_place(worker, place, next, &number);
        if (is_fine) {
            set_cell(worker, codec->word_of[place], number);
        }
    }
    if (is_fine && (codec->root_word != NONE) && pn_net.transition[transition].assigns) {
        is_fine = ex_roots_number(worker, &number);
        if (is_fine) {
            set_cell(worker, codec->root_word, number);
        }
    }
    for (uint32_t k = 0U; k < codec->touched_count[transition]; k++) {
        const uint32_t w = codec->touched_words[transition][k];
        set_cell(worker, w, slice_of(codec, next, w));
    }
    is_fine = is_fine && number_dirty(worker);
    root_key(codec, scratch->cell, key);
    undo(scratch);
    return is_fine;
}

bool ex_encode_changes(ex_worker_t *worker, const ex_change_t *change, uint32_t count, ex_key_t *key)
{
    for (uint32_t i = 0U; i < count; i++) {
        set_cell(worker, change[i].cell, change[i].value);
    }
    const bool is_fine = number_dirty(worker);
    root_key(worker->run->codec, worker->scratch->cell, key);
    undo(worker->scratch);
    return is_fine;
}

bool ex_encode_next(ex_worker_t *worker, uint32_t transition, const void *next, ex_key_t *key)
{
    const ex_codec_t *codec = worker->run->codec;
    if (codec->is_plain) {
        ex_plain_key(codec, next, key);
        return true;
    }
    return codec->is_flat ? encode_flat(worker, transition, next, key) : encode_cells(worker, transition, next, key);
}

/* --- decoding ----------------------------------------------------------------------------------------------------- */

/* The cells below a node. */
static void open_tree(const ex_codec_t *codec, uint32_t *cell)
{
    for (uint32_t n = codec->nodes; n > 0U; n--) {
        const ex_node_t *node = &codec->node[n - 1U];
        const ex_tuples_t *tuples = &codec->tuples[node->table];
        const uint64_t *lane = &tuples->lane[(uint64_t)cell[codec->words + n - 1U] * tuples->lanes];
        for (uint32_t i = 0U; i < node->count; i++) {
            cell[node->child[i]] = (uint32_t)(lane[i / 2U] >> (32U * (i % 2U)));
        }
    }
}

void ex_key_cells(const ex_codec_t *codec, const ex_key_t *key, uint32_t *cell)
{
    const uint32_t word[EX_KEY_WORDS] = { (uint32_t)key->low, (uint32_t)(key->low >> 32U), (uint32_t)key->high,
                                          (uint32_t)(key->high >> 32U) };
    for (uint32_t i = 0U; i < codec->roots; i++) {
        cell[codec->root[i]] = word[i];
    }
    open_tree(codec, cell);
}

bool ex_cells_key(ex_codec_t *codec, uint32_t *cell, ex_key_t *key)
{
    for (uint32_t n = 0U; n < codec->nodes; n++) {
        ex_tuples_t *tuples = &codec->tuples[codec->node[n].table];
        uint64_t lane[EX_TUPLE_LANES];
        lanes_of(&codec->node[n], cell, lane);
        const uint64_t hash = ex_tuple_hash(lane, tuples->lanes);
        uint32_t number = ex_tuples_number(tuples, lane, hash);
        while (number == EX_NO_NUMBER) {
            if (!ex_tuples_grow(tuples)) {
                return false;
            }
            number = ex_tuples_number(tuples, lane, hash);
        }
        cell[codec->words + n] = number;
    }
    root_key(codec, cell, key);
    return true;
}

void ex_unload(ex_worker_t *worker)
{
    const ex_codec_t *codec = worker->run->codec;
    for (uint32_t i = 0U; i < (codec->words - codec->packed_words); i++) {
        worker->scratch->decoded[i] = EX_NO_NUMBER;
    }
}

/* Makes what a number stands for that which the marking holds for a word. */
static bool decode_word(ex_worker_t *worker, uint32_t w, uint32_t number)
{
    const ex_codec_t *codec = worker->run->codec;
    uint32_t *decoded = &worker->scratch->decoded[w - codec->packed_words];
    if (*decoded == number) {
        return true;
    }
    const ex_bytes_entry_t *of = &codec->bytes.of[number];
    bool is_fine = false;
    if (w == codec->root_word) {
        is_fine = ex_roots_load(worker, number);
    } else if (codec->is_whole) {
        const unsigned char *byte = &codec->bytes.byte[of->offset];
        is_fine = pn_marking_decode(&pn_net, &worker->cx, worker->marking, byte, of->length);
    } else if (w == codec->time_word) {
        pn_time_t now;
        (void)memcpy(&now, &codec->bytes.byte[of->offset], sizeof now);
        pn_set_now(&pn_net, worker->marking, now);
        is_fine = true;
    } else {
        const uint32_t place = codec->place_of[w - codec->packed_words];
        size_t length = 0U;
        const unsigned char *byte = ex_multiset_bytes(worker, number, &length);
        is_fine = (byte != NULL)
                  && (pn_multiset_decode(&worker->cx, pn_net.place[place].multiset, worker->marking, byte, length)
                      != SIZE_MAX);
    }
    *decoded = is_fine ? number : EX_NO_NUMBER;
    if (!is_fine) {
        ex_fail(worker, -1);
    }
    return is_fine;
}

/* Whether there is still enough room behind what was decoded. */
static void tidy_arena(ex_worker_t *worker)
{
    pn_arena_t *arena = &worker->scratch->arena;
    const size_t most = arena->half / 4U;
    if (arena->used > ((most < (size_t)DECODED_MOST) ? most : (size_t)DECODED_MOST)) {
        pn_arena_release(arena, 0U);
        ex_unload(worker);
    }
}

bool ex_open(ex_worker_t *worker, const ex_key_t *key)
{
    const ex_codec_t *codec = worker->run->codec;
    unsigned char *packed = worker->marking;
    if (codec->is_plain) {
        const uint64_t plain[2] = { key->low, key->high };
        if (codec->derived_count == 0U) {
            (void)memcpy(packed, plain, pn_net.packed_size);
        } else {
            (void)memset(packed, 0, pn_net.packed_size);
            (void)memcpy(packed, plain, (pn_net.packed_size < sizeof plain) ? pn_net.packed_size : sizeof plain);
            ex_derive(codec, packed);
        }
        return true;
    }
    uint32_t *cell = worker->scratch->cell;
    tidy_arena(worker);
    ex_key_cells(codec, key, cell);
    clear_stale(worker);
    (void)memset(packed, 0, pn_net.packed_size);
    for (uint32_t w = 0U; w < codec->packed_words; w++) {
        put_slice(codec, packed, w, cell[w]);
    }
    ex_derive(codec, packed);
    return (codec->time_word == NONE) || decode_word(worker, codec->time_word, cell[codec->time_word]);
}

bool ex_load_places(ex_worker_t *worker)
{
    const ex_codec_t *codec = worker->run->codec;
    bool is_fine = true;
    for (uint32_t w = codec->packed_words; is_fine && (w < codec->words); w++) {
        is_fine = decode_word(worker, w, worker->scratch->cell[w]);
    }
    return is_fine;
}

bool ex_load_place(ex_worker_t *worker, uint32_t place, uint32_t number)
{
    return decode_word(worker, worker->run->codec->word_of[place], number);
}

void ex_clear_place(ex_worker_t *worker, uint32_t place)
{
    const ex_codec_t *codec = worker->run->codec;
    pn_multiset_clear(pn_net.place[place].multiset, worker->marking);
    worker->scratch->decoded[codec->word_of[place] - codec->packed_words] = EX_NO_NUMBER;
}

bool ex_load(ex_worker_t *worker, const ex_key_t *key)
{
    return ex_open(worker, key) && (worker->run->codec->is_plain || ex_load_places(worker));
}

const ex_bytes_t *ex_interned(const ex_run_t *run)
{
    return run->codec->has_cells ? &run->codec->bytes : NULL;
}
