/* SPDX-License-Identifier: MIT
 * explore_codec.c - markings as vectors of words, vectors as keys, and back.
 *
 * A vector of at most four words is a key. A longer one is divided into four parts, of which each has a number: that of the root of a
 * tree of words, whose inner nodes have numbers, too. Where it is cut follows the places, as different places often vary independently;
 * so the numbers stay small, and the store keeps no more bits of them than they need.
 *
 * A successor differs in few places from the state it comes from: only the places that its transition touches are encoded again, and
 * only the inner nodes above words that have changed are looked up again.
 */
#define _POSIX_C_SOURCE 200809L

#include "explore_impl.h"

#include <stdlib.h>
#include <string.h>

#include "pn/pn_arena.h"

enum {
    UNIT = 8,
    WORD_BITS = 32,
    UNIT_BITS = 64,
    DECODED_MOST = 1 << 20 /* bytes of decoded values that are kept; a page cache is faster than more of them */
};

#define NONE UINT32_MAX

static uint32_t rounded_up(uint32_t bits, uint32_t unit)
{
    return (bits + unit - 1U) / unit;
}

/* --- the shape --------------------------------------------------------------------------------------------------------- */

static bool has_places(void)
{
    for (uint32_t i = 0U; i < pn_net.place_count; i++) {
        if ((pn_net.place[i].encode == NULL) || (pn_net.place[i].decode == NULL)) {
            return false;
        }
    }
    return pn_net.place_count > 0U;
}

static void *table(ex_run_t *run, uint64_t count, uint64_t size)
{
    return ex_alloc(run, (count + 1U) * size);
}

static uint32_t bits_in(const pn_place_t *place)
{
    return place->is_packed ? (place->colours * place->width) : 0U;
}

static int by_bit(const void *a, const void *b)
{
    const pn_place_t *first = &pn_net.place[*(const uint32_t *)a];
    const pn_place_t *second = &pn_net.place[*(const uint32_t *)b];
    return (first->bit > second->bit) - (first->bit < second->bit);
}

static void add_slice(ex_codec_t *codec, uint32_t bit, uint32_t width)
{
    codec->slice_bit[codec->packed_words] = bit;
    codec->slice_width[codec->packed_words] = width;
    codec->packed_words++;
}

/* Whether a place goes into a slice: slices lie within one of the units in which generated code handles the packed part. */
static bool is_short(const pn_place_t *place)
{
    const uint32_t last = place->bit + bits_in(place) - 1U;
    return (bits_in(place) <= (uint32_t)WORD_BITS) && ((place->bit / (uint32_t)UNIT_BITS) == (last / (uint32_t)UNIT_BITS));
}

/* Slices of the packed part: first those of short places, as many in one as possible, then those of long ones. `order` has room for the
 * indices of all places. */
static void lay_slices(ex_codec_t *codec, uint32_t *order)
{
    uint32_t count = 0U;
    for (uint32_t i = 0U; i < pn_net.place_count; i++) {
        if (bits_in(&pn_net.place[i]) > 0U) {
            order[count++] = i;
        }
    }
    qsort(order, count, sizeof *order, by_bit);
    for (uint32_t k = 0U; k < count; k++) {
        const pn_place_t *place = &pn_net.place[order[k]];
        const uint32_t end = place->bit + bits_in(place);
        const uint32_t last = codec->packed_words - 1U;
        if (!is_short(place)) {
            continue;
        }
        if ((codec->packed_words > 0U) && ((end - codec->slice_bit[last]) <= (uint32_t)WORD_BITS)
            && (((end - 1U) / (uint32_t)UNIT_BITS) == (codec->slice_bit[last] / (uint32_t)UNIT_BITS))) {
            codec->slice_width[last] = end - codec->slice_bit[last]; /* what lies between, if anything, belongs to nobody else */
        } else {
            add_slice(codec, place->bit, bits_in(place));
        }
    }
    for (uint32_t k = 0U; k < count; k++) {
        const pn_place_t *place = &pn_net.place[order[k]];
        const uint32_t end = place->bit + bits_in(place);
        for (uint32_t at = place->bit; !is_short(place) && (at < end);) {
            const uint32_t next = ((at / (uint32_t)WORD_BITS) + 1U) * (uint32_t)WORD_BITS;
            codec->is_joined[codec->packed_words] = at > place->bit;
            add_slice(codec, at, ((end < next) ? end : next) - at);
            at = next;
        }
    }
}

/* The words of a short packed part as they lie in the marking, if there is nothing else. */
static void lay_plain(ex_codec_t *codec, uint32_t words)
{
    for (uint32_t w = 0U; w < words; w++) {
        add_slice(codec, w * (uint32_t)WORD_BITS, 0U);
    }
    for (uint32_t i = 0U; i < pn_net.place_count; i++) {
        const pn_place_t *place = &pn_net.place[i];
        for (uint32_t k = place->bit; k < (place->bit + bits_in(place)); k++) {
            uint32_t *width = &codec->slice_width[k / (uint32_t)WORD_BITS];
            const uint32_t needed = (k % (uint32_t)WORD_BITS) + 1U;
            *width = (needed > *width) ? needed : *width;
        }
    }
}

/* The words behind the packed part. */
static void lay_words(ex_codec_t *codec)
{
    uint32_t word = codec->packed_words;
    codec->time_word = NONE;
    for (uint32_t i = 0U; i < pn_net.place_count; i++) {
        codec->word_of[i] = NONE;
        if (!codec->is_whole && !pn_net.place[i].is_packed) {
            codec->place_of[word - codec->packed_words] = i;
            codec->word_of[i] = word++;
        }
    }
    if (codec->is_whole) {
        word++;
    } else if (pn_net.timed) {
        codec->time_word = word++;
    }
    codec->words = word;
    codec->has_cells = word > codec->packed_words;
    codec->zero_cell = (2U * word) + 1U; /* behind all nodes */
}

/* A node over some cells; a lone cell stands for itself. */
static uint32_t add_node(ex_codec_t *codec, const uint32_t *cell, uint32_t count)
{
    if (count == 1U) {
        return cell[0];
    }
    ex_node_t *node = &codec->node[codec->nodes];
    node->count = count;
    node->parent = NONE;
    node->table = EX_KEY_WORDS;
    for (uint32_t i = 0U; i < EX_TUPLE_WORDS; i++) {
        node->child[i] = codec->zero_cell;
    }
    for (uint32_t i = 0U; i < count; i++) {
        node->child[i] = cell[i];
        codec->parent[cell[i]] = codec->nodes;
    }
    codec->nodes++;
    return codec->words + codec->nodes - 1U;
}

/* The tree of a part of the key; `cell` holds its words and is overwritten. */
static void lay_part(ex_codec_t *codec, uint32_t *cell, uint32_t count)
{
    while (count > 1U) {
        const uint32_t groups = rounded_up(count, EX_TUPLE_WORDS);
        uint32_t from = 0U;
        for (uint32_t g = 0U; g < groups; g++) {
            const uint32_t to = (uint32_t)(((uint64_t)count * (g + 1U)) / groups);
            cell[g] = add_node(codec, &cell[from], to - from);
            from = to;
        }
        count = groups;
    }
    if (cell[0] >= codec->words) {
        codec->node[cell[0] - codec->words].table = codec->roots;
    }
    codec->root[codec->roots] = cell[0];
    codec->roots++;
}

/* The parts of the key that transitions touch. */
static void find_parts(ex_codec_t *codec)
{
    for (uint32_t t = 0U; !codec->is_whole && (t < pn_net.transition_count); t++) {
        uint32_t parts = 0U;
        for (uint32_t k = 0U; k < codec->touched_count[t]; k++) {
            parts |= 1U << codec->part_of[codec->touched_words[t][k]];
        }
        for (uint32_t k = 0U; k < codec->touched_bag_count[t]; k++) {
            parts |= 1U << codec->part_of[codec->word_of[codec->touched_bags[t][k]]];
        }
        codec->touched_parts[t] = (uint8_t)parts;
    }
}

void ex_codec_group(ex_codec_t *codec, uint32_t *word, const uint32_t end[EX_KEY_WORDS], uint32_t parts)
{
    uint32_t from = 0U;
    codec->nodes = 0U;
    codec->roots = 0U;
    (void)memset(codec->tuple_words, 0, sizeof codec->tuple_words);
    for (uint32_t i = 0U; i < (2U * codec->words); i++) {
        codec->parent[i] = NONE;
    }
    for (uint32_t part = 0U; part < parts; part++) {
        for (uint32_t i = from; i < end[part]; i++) {
            codec->part_of[word[i]] = part;
        }
        lay_part(codec, &word[from], end[part] - from);
        from = end[part];
    }
    find_parts(codec);
    codec->is_flat = !codec->is_whole;
    for (uint32_t n = 0U; n < codec->nodes; n++) {
        codec->is_flat = codec->is_flat && (codec->node[n].table < EX_KEY_WORDS);
        codec->node[n].parent = codec->parent[codec->words + n];
        codec->tuple_words[codec->node[n].table] =
            (codec->node[n].table < EX_KEY_WORDS) ? codec->node[n].count : EX_TUPLE_WORDS;
    }
}

/* Divides the words into parts of about the same length, for a start. */
static void lay_tree(ex_codec_t *codec, uint32_t *word)
{
    uint32_t end[EX_KEY_WORDS];
    const uint32_t parts = (codec->words < EX_KEY_WORDS) ? codec->words : EX_KEY_WORDS;
    for (uint32_t i = 0U; i < codec->words; i++) {
        word[i] = i;
    }
    for (uint32_t part = 0U; part < parts; part++) {
        end[part] = (uint32_t)(((uint64_t)codec->words * (part + 1U)) / parts);
    }
    ex_codec_group(codec, word, end, parts);
}

/* What a transition may change. */
static bool lay_touched(ex_run_t *run, ex_codec_t *codec, uint32_t t)
{
    const pn_transition_t *transition = &pn_net.transition[t];
    codec->touched_words[t] = table(run, codec->packed_words, sizeof(uint32_t));
    codec->touched_bags[t] = table(run, transition->touched_count, sizeof(uint32_t));
    if ((codec->touched_words[t] == NULL) || (codec->touched_bags[t] == NULL)) {
        return false;
    }
    for (uint32_t k = 0U; k < transition->touched_count; k++) {
        const uint32_t p = transition->touched[k];
        if (!pn_net.place[p].is_packed) {
            codec->touched_bags[t][codec->touched_bag_count[t]++] = p;
        }
    }
    for (uint32_t w = 0U; w < codec->packed_words; w++) {
        bool is_touched = false;
        for (uint32_t k = 0U; !is_touched && (k < transition->touched_count); k++) {
            const pn_place_t *place = &pn_net.place[transition->touched[k]];
            is_touched = (place->bit < (codec->slice_bit[w] + codec->slice_width[w]))
                         && (codec->slice_bit[w] < (place->bit + bits_in(place)));
        }
        if (is_touched) {
            codec->touched_words[t][codec->touched_count[t]++] = w;
        }
    }
    return true;
}

bool ex_codec_make(ex_run_t *run)
{
    ex_codec_t *codec = ex_alloc(run, sizeof *codec);
    if (codec == NULL) {
        return false;
    }
    run->codec = codec;
    codec->is_whole = !has_places();
    const uint32_t packed = codec->is_whole ? 0U : (uint32_t)pn_net.packed_size;
    const uint32_t packed_words = rounded_up(packed, 4U);
    const uint64_t most = (2U * (uint64_t)packed_words) + (2U * (uint64_t)pn_net.place_count) + 2U;
    codec->slice_bit = table(run, most, sizeof(uint32_t));
    codec->slice_width = table(run, most, sizeof(uint32_t));
    codec->word_of = table(run, pn_net.place_count, sizeof(uint32_t));
    codec->place_of = table(run, most, sizeof(uint32_t));
    codec->touched_words = table(run, pn_net.transition_count, sizeof(uint32_t *));
    codec->touched_count = table(run, pn_net.transition_count, sizeof(uint32_t));
    codec->touched_bags = table(run, pn_net.transition_count, sizeof(uint32_t *));
    codec->touched_bag_count = table(run, pn_net.transition_count, sizeof(uint32_t));
    codec->touched_parts = table(run, pn_net.transition_count, sizeof(uint8_t));
    codec->part_of = table(run, most, sizeof(uint32_t));
    codec->node = table(run, most, sizeof *codec->node);
    codec->parent = table(run, 2U * most, sizeof(uint32_t));
    uint32_t *cell = table(run, most, sizeof *cell);
    codec->is_joined = table(run, most, sizeof(bool));
    if ((codec->slice_bit == NULL) || (codec->slice_width == NULL) || (codec->is_joined == NULL) || (codec->word_of == NULL)
        || (codec->place_of == NULL) || (codec->touched_words == NULL) || (codec->touched_parts == NULL) || (codec->part_of == NULL) || (codec->touched_count == NULL)
        || (codec->touched_bags == NULL) || (codec->touched_bag_count == NULL) || (codec->node == NULL)
        || (codec->parent == NULL) || (cell == NULL)) {
        return false;
    }
    codec->is_plain = !codec->is_whole && !pn_net.timed && (pn_net.bag_count == 0U) && (packed_words <= EX_KEY_WORDS);
    if (codec->is_plain) {
        lay_plain(codec, packed_words);
    } else if (!codec->is_whole) {
        lay_slices(codec, cell);
    }
    lay_words(codec);
    for (uint32_t t = 0U; !codec->is_whole && (t < pn_net.transition_count); t++) {
        if (!lay_touched(run, codec, t)) {
            return false;
        }
    }
    lay_tree(codec, cell);
    if (codec->is_plain) {
        unsigned char mask[2U * sizeof(uint64_t)] = { 0U };
        (void)memset(mask, 0xff, packed);
        (void)memcpy(&codec->plain_low, mask, sizeof codec->plain_low);
        (void)memcpy(&codec->plain_high, &mask[sizeof codec->plain_low], sizeof codec->plain_high);
    }
    ex_free(run, cell, (most + 1U) * sizeof *cell);
    return ex_bytes_make(&codec->bytes, run) && ex_codec_number(run);
}

bool ex_codec_number(ex_run_t *run)
{
    ex_codec_t *codec = run->codec;
    for (uint32_t i = 0U; i < EX_TABLES; i++) {
        if (codec->tuples[i].lane != NULL) {
            ex_tuples_free(&codec->tuples[i]);
        }
        if ((codec->tuple_words[i] > 0U) && !ex_tuples_make(&codec->tuples[i], run, codec->tuple_words[i])) {
            return false;
        }
    }
    return true;
}

uint64_t ex_codec_bytes(const ex_run_t *run)
{
    const ex_codec_t *codec = run->codec;
    uint64_t bytes = codec->has_cells ? ex_bytes_bytes(&codec->bytes) : 0U;
    for (uint32_t i = 0U; i < EX_TABLES; i++) {
        bytes += (codec->tuple_words[i] > 0U) ? ex_tuples_bytes(&codec->tuples[i]) : 0U;
    }
    return bytes;
}

static uint32_t bits_of(uint64_t count)
{
    const uint32_t bits = 64U - (uint32_t)__builtin_clzll(count | 1U);
    return (bits < (uint32_t)WORD_BITS) ? bits : (uint32_t)WORD_BITS;
}

void ex_key_widths(const ex_run_t *run, uint32_t width[EX_KEY_WORDS])
{
    const ex_codec_t *codec = run->codec;
    for (uint32_t i = 0U; i < EX_KEY_WORDS; i++) {
        width[i] = 0U;
        if (i >= codec->roots) {
            continue;
        }
        const uint32_t cell = codec->root[i];
        if (cell < codec->packed_words) {
            width[i] = codec->slice_width[cell];
        } else {
            const ex_index_t *index = (cell < codec->words) ? &codec->bytes.index
                                                            : &codec->tuples[codec->node[cell - codec->words].table].index;
            const uint64_t count = atomic_load(&index->count);
            width[i] = bits_of(count + (count / 4U) + 64U);
        }
    }
}

bool ex_scratch_make(ex_worker_t *worker)
{
    ex_run_t *run = worker->run;
    const ex_codec_t *codec = run->codec;
    ex_scratch_t *scratch = ex_alloc(run, sizeof *scratch);
    if (scratch == NULL) {
        return false;
    }
    worker->scratch = scratch;
    const uint64_t cells = 2U * ((uint64_t)codec->words + 1U); /* more inner nodes than words there never are */
    scratch->cell = table(run, cells, sizeof *scratch->cell);
    scratch->dirty = table(run, (codec->words / 64U) + 1U, sizeof *scratch->dirty);
    scratch->undo_cell = table(run, cells, sizeof *scratch->undo_cell);
    scratch->undo_value = table(run, cells, sizeof *scratch->undo_value);
    scratch->buffer_size = 4096U;
    scratch->buffer = ex_alloc(run, scratch->buffer_size);
    /* What is never touched of the large ones costs nothing. */
    worker->marking = ex_reserve(pn_net.marking_size + (size_t)UNIT);
    scratch->next = ex_reserve(pn_net.marking_size + (size_t)UNIT);
    scratch->binding = ex_alloc(run, pn_net.binding_size);
    void *memory = ex_reserve(run->options.arena);
    if ((scratch->cell == NULL) || (scratch->dirty == NULL) || (scratch->undo_cell == NULL) || (scratch->undo_value == NULL)
        || (scratch->buffer == NULL) || (worker->marking == NULL) || (scratch->next == NULL) || (scratch->binding == NULL)
        || (memory == NULL)) {
        return false;
    }
    pn_arena_init(&scratch->arena, memory, (size_t)run->options.arena);
    pn_arena_seal(&scratch->arena);
    pn_ctx_init(&worker->cx, &scratch->arena, run->options.seed);
    return true;
}

/* --- cells --------------------------------------------------------------------------------------------------------------- */

static bool grow_buffer(ex_worker_t *worker, size_t size)
{
    ex_scratch_t *scratch = worker->scratch;
    unsigned char *larger = ex_alloc(worker->run, size * 2U);
    if (larger == NULL) {
        ex_stop(worker->run, EX_MEMORY);
        worker->failed = true;
        return false;
    }
    ex_free(worker->run, scratch->buffer, scratch->buffer_size);
    scratch->buffer = larger;
    scratch->buffer_size = size * 2U;
    return true;
}

/* The number of what is in the buffer. */
static bool intern(ex_worker_t *worker, uint32_t place, size_t length, uint32_t *number)
{
    ex_bytes_t *bytes = &worker->run->codec->bytes;
    for (;;) {
        *number = ex_bytes_number(bytes, place, worker->scratch->buffer, (uint32_t)length);
        if (*number != EX_NO_NUMBER) {
            return true;
        }
        if (!ex_pause(worker)) {
            worker->failed = true;
            return false;
        }
    }
}

static bool intern_place(ex_worker_t *worker, uint32_t place, const void *marking, uint32_t *number)
{
    ex_scratch_t *scratch = worker->scratch;
    size_t length = pn_net.place[place].encode(marking, scratch->buffer, scratch->buffer_size);
    while (length > scratch->buffer_size) {
        if (!grow_buffer(worker, length)) {
            return false;
        }
        length = pn_net.place[place].encode(marking, scratch->buffer, scratch->buffer_size);
    }
    return intern(worker, place, length, number);
}

static bool intern_whole(ex_worker_t *worker, const void *marking, uint32_t *number)
{
    ex_scratch_t *scratch = worker->scratch;
    size_t length = pn_net.encode(marking, scratch->buffer, scratch->buffer_size);
    while (length == 0U) {
        if (!grow_buffer(worker, scratch->buffer_size)) {
            return false;
        }
        length = pn_net.encode(marking, scratch->buffer, scratch->buffer_size);
    }
    return intern(worker, pn_net.place_count, length, number);
}

static bool intern_time(ex_worker_t *worker, const void *marking, uint32_t *number)
{
    const pn_time_t now = pn_net.now(marking);
    (void)memcpy(worker->scratch->buffer, &now, sizeof now);
    return intern(worker, pn_net.place_count, sizeof now, number);
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

static bool number_lanes(ex_worker_t *worker, uint32_t table, const uint64_t lane[EX_TUPLE_LANES], uint32_t *number)
{
    ex_codec_t *codec = worker->run->codec;
    for (;;) {
        *number = ex_tuples_number(&codec->tuples[table], lane);
        if (*number != EX_NO_NUMBER) {
            return true;
        }
        if (!ex_pause(worker)) {
            worker->failed = true;
            return false;
        }
    }
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

/* The key of the cells. */
static inline void root_key(const ex_codec_t *codec, const uint32_t *cell, ex_key_t *key)
{
    uint32_t word[EX_KEY_WORDS] = { 0U, 0U, 0U, 0U };
    for (uint32_t i = 0U; i < codec->roots; i++) {
        word[i] = cell[codec->root[i]];
    }
    key->low = word[0] | ((uint64_t)word[1] << 32U);
    key->high = word[2] | ((uint64_t)word[3] << 32U);
}

/* A word of the vector from the packed part. */
static inline uint32_t slice_of(const ex_codec_t *codec, const void *marking, uint32_t w)
{
    const uint32_t bit = codec->slice_bit[w];
    uint64_t unit;
    (void)memcpy(&unit, (const unsigned char *)marking + ((bit / (uint32_t)UNIT_BITS) * sizeof unit), sizeof unit);
    return (uint32_t)((unit >> (bit % (uint32_t)UNIT_BITS)) & (((uint64_t)1U << codec->slice_width[w]) - 1U));
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

/* --- encoding -------------------------------------------------------------------------------------------------------------- */

bool ex_encode(ex_worker_t *worker, const void *marking, ex_key_t *key)
{
    const ex_codec_t *codec = worker->run->codec;
    ex_scratch_t *scratch = worker->scratch;
    uint32_t *cell = scratch->cell;
    bool is_fine = true;
    scratch->is_loaded = false;
    if (codec->is_whole) {
        is_fine = intern_whole(worker, marking, &cell[0]);
        root_key(codec, cell, key);
        return is_fine;
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
        if (pn_net.place[i].timed && (codec->word_of[i] != NONE)) {
            if (!intern_place(worker, i, worker->marking, &number)) {
                return false;
            }
            set_cell(worker, codec->word_of[i], number);
        }
    }
    if (!is_reduced && (codec->time_word != NONE)) {
        if (!intern_time(worker, worker->marking, &number)) {
            return false;
        }
        set_cell(worker, codec->time_word, number);
    }
    if (!number_dirty(worker)) {
        return false;
    }
    scratch->undone = 0U; /* it stays */
    return true;
}

/* A part of the key of a successor: a node over words, of which those of bags are in the cells already. */
static inline bool encode_part(ex_worker_t *worker, const ex_node_t *node, const void *next, bool is_different, uint32_t *number)
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
    for (uint32_t k = 0U; is_fine && (k < codec->touched_bag_count[transition]); k++) {
        const uint32_t place = codec->touched_bags[transition][k];
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
        word[i] = cell[c];
        if (!is_fine || (((codec->touched_parts[transition] >> i) & 1U) == 0U)) {
            continue;
        }
        if (c < codec->packed_words) {
            word[i] = slice_of(codec, next, c);
        } else if (c >= codec->words) {
            is_fine = encode_part(worker, &codec->node[c - codec->words], next, scratch->undone > 0U, &word[i]);
        }
    }
    key->low = word[0] | ((uint64_t)word[1] << 32U);
    key->high = word[2] | ((uint64_t)word[3] << 32U);
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
    for (uint32_t k = 0U; is_fine && (k < codec->touched_bag_count[transition]); k++) {
        const uint32_t place = codec->touched_bags[transition][k];
        is_fine = intern_place(worker, place, next, &number);
        if (is_fine) {
            set_cell(worker, codec->word_of[place], number);
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

bool ex_encode_next(ex_worker_t *worker, uint32_t transition, const void *next, ex_key_t *key)
{
    const ex_codec_t *codec = worker->run->codec;
    if (codec->is_plain) {
        ex_plain_key(codec, next, key);
        return true;
    }
    return codec->is_flat ? encode_flat(worker, transition, next, key) : encode_cells(worker, transition, next, key);
}

/* --- decoding -------------------------------------------------------------------------------------------------------------- */

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
        uint32_t number = ex_tuples_number(tuples, lane);
        while (number == EX_NO_NUMBER) {
            if (!ex_tuples_grow(tuples)) {
                return false;
            }
            number = ex_tuples_number(tuples, lane);
        }
        cell[codec->words + n] = number;
    }
    root_key(codec, cell, key);
    return true;
}

/* Decodes what is in a cell into the marking. */
static bool decode_cell(ex_worker_t *worker, uint32_t w)
{
    const ex_codec_t *codec = worker->run->codec;
    const ex_bytes_entry_t *of = &codec->bytes.of[worker->scratch->cell[w]];
    const unsigned char *byte = &codec->bytes.byte[of->offset];
    bool is_fine = false;
    if (codec->is_whole) {
        is_fine = pn_net.decode(&worker->cx, worker->marking, byte, of->length);
    } else if (w == codec->time_word) {
        pn_time_t now;
        (void)memcpy(&now, byte, sizeof now);
        pn_net.set_now(worker->marking, now);
        is_fine = true;
    } else {
        const uint32_t place = codec->place_of[w - codec->packed_words];
        is_fine = pn_net.place[place].decode(&worker->cx, worker->marking, byte, of->length) != SIZE_MAX;
    }
    if (!is_fine) {
        ex_fail(worker, -1);
    }
    return is_fine;
}

/* Whether there is still enough room behind what was decoded. */
static void tidy_arena(ex_scratch_t *scratch)
{
    const size_t most = scratch->arena.half / 4U;
    if (scratch->arena.used > ((most < (size_t)DECODED_MOST) ? most : (size_t)DECODED_MOST)) {
        pn_arena_release(&scratch->arena, 0U);
        scratch->is_loaded = false;
    }
}

bool ex_load(ex_worker_t *worker, const ex_key_t *key)
{
    const ex_codec_t *codec = worker->run->codec;
    ex_scratch_t *scratch = worker->scratch;
    uint32_t *cell = scratch->cell;
    unsigned char *packed = worker->marking;
    if (codec->is_plain) {
        const uint64_t plain[2] = { key->low, key->high };
        (void)memcpy(packed, plain, pn_net.packed_size);
        return true;
    }
    tidy_arena(scratch);
    uint32_t *old = scratch->undo_value; /* nothing else uses it now */
    (void)memcpy(old, &cell[codec->packed_words], (codec->words - codec->packed_words) * sizeof *old);
    ex_key_cells(codec, key, cell);
    (void)memset(packed, 0, pn_net.packed_size);
    for (uint32_t w = 0U; w < codec->packed_words; w++) {
        put_slice(codec, packed, w, cell[w]);
    }
    bool is_fine = true;
    for (uint32_t w = codec->packed_words; is_fine && (w < codec->words); w++) {
        if (!scratch->is_loaded || (cell[w] != old[w - codec->packed_words])) {
            is_fine = decode_cell(worker, w);
        }
    }
    scratch->is_loaded = is_fine;
    return is_fine;
}

const ex_bytes_t *ex_interned(const ex_run_t *run)
{
    for (uint32_t i = 0U; i < run->options.threads; i++) {
        run->worker[i].scratch->is_loaded = false; /* the caller decodes into these markings */
    }
    return run->codec->has_cells ? &run->codec->bytes : NULL;
}
