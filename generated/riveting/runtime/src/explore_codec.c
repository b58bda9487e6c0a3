/* SPDX-License-Identifier: MIT
 * explore_codec.c - markings as vectors of words, vectors as keys, and back.
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
    KEY_BITS = 128,
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

/* Marks the bits of the packed part that places use, and where units lie in a direct key. Returns the bits used. */
static uint32_t lay_units(ex_codec_t *codec)
{
    for (uint32_t i = 0U; i < pn_net.place_count; i++) {
        const pn_place_t *place = &pn_net.place[i];
        if (!place->is_packed) {
            continue;
        }
        for (uint32_t k = 0U; k < (place->colours * place->width); k++) {
            const uint32_t bit = place->bit + k;
            codec->unit_mask[bit / 64U] |= (uint64_t)1U << (bit % 64U);
        }
    }
    uint32_t at = 0U;
    for (uint32_t u = 0U; u < codec->units; u++) {
        codec->unit_shift[u] = at;
        at += (codec->unit_mask[u] == 0U) ? 0U : (64U - (uint32_t)__builtin_clzll(codec->unit_mask[u]));
    }
    return at;
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
    for (uint32_t i = 0U; i < count; i++) {
        node->child[i] = cell[i];
        codec->parent[cell[i]] = codec->nodes;
    }
    codec->nodes++;
    return codec->words + codec->nodes - 1U;
}

/* Groups of four, until two cells are left. */
static void lay_tree(ex_codec_t *codec, uint32_t *cell)
{
    uint32_t count = codec->words;
    for (uint32_t i = 0U; i < count; i++) {
        cell[i] = i;
    }
    for (uint32_t i = 0U; i < (2U * count); i++) {
        codec->parent[i] = NONE;
    }
    while (count > 2U) {
        const uint32_t groups = (count <= 8U) ? 2U : rounded_up(count, 4U);
        uint32_t from = 0U;
        for (uint32_t g = 0U; g < groups; g++) {
            const uint32_t to = (uint32_t)(((uint64_t)count * (g + 1U)) / groups);
            cell[g] = add_node(codec, &cell[from], to - from);
            from = to;
        }
        count = groups;
    }
    codec->root[0] = cell[0];
    codec->root[1] = (count > 1U) ? cell[1] : cell[0];
    for (uint32_t n = 0U; n < codec->nodes; n++) {
        codec->node[n].parent = codec->parent[codec->words + n];
    }
}

static int by_number(const void *a, const void *b)
{
    const uint32_t first = *(const uint32_t *)a;
    const uint32_t second = *(const uint32_t *)b;
    return (first > second) - (first < second);
}

/* What a transition may change. */
static bool lay_touched(ex_run_t *run, ex_codec_t *codec, uint32_t t)
{
    const pn_transition_t *transition = &pn_net.transition[t];
    uint64_t words = 0U;
    for (uint32_t k = 0U; k < transition->touched_count; k++) {
        const pn_place_t *place = &pn_net.place[transition->touched[k]];
        words += place->is_packed ? (2U + rounded_up(place->colours * place->width, 32U)) : 0U;
    }
    codec->touched_words[t] = table(run, words, sizeof(uint32_t));
    codec->touched_bags[t] = table(run, transition->touched_count, sizeof(uint32_t));
    if ((codec->touched_words[t] == NULL) || (codec->touched_bags[t] == NULL)) {
        return false;
    }
    uint32_t *word = codec->touched_words[t];
    uint32_t count = 0U;
    for (uint32_t k = 0U; k < transition->touched_count; k++) {
        const uint32_t p = transition->touched[k];
        const pn_place_t *place = &pn_net.place[p];
        if (!place->is_packed) {
            codec->touched_bags[t][codec->touched_bag_count[t]++] = p;
            continue;
        }
        const uint32_t last = (place->bit + (place->colours * place->width) - 1U) / 32U;
        for (uint32_t w = place->bit / 32U; w <= last; w++) {
            word[count++] = w;
        }
    }
    qsort(word, count, sizeof *word, by_number);
    uint32_t kept = 0U;
    for (uint32_t k = 0U; k < count; k++) {
        if ((kept == 0U) || (word[kept - 1U] != word[k])) {
            word[kept++] = word[k];
        }
    }
    codec->touched_count[t] = kept;
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
    codec->packed_words = rounded_up(packed, 4U);
    codec->units = rounded_up(packed, (uint32_t)UNIT);
    const uint64_t most = (uint64_t)codec->packed_words + pn_net.place_count + 2U;
    codec->unit_mask = table(run, codec->units, sizeof(uint64_t));
    codec->unit_shift = table(run, codec->units, sizeof(uint32_t));
    codec->word_shift = table(run, most, sizeof(uint32_t));
    codec->word_of = table(run, pn_net.place_count, sizeof(uint32_t));
    codec->place_of = table(run, most, sizeof(uint32_t));
    codec->touched_words = table(run, pn_net.transition_count, sizeof(uint32_t *));
    codec->touched_count = table(run, pn_net.transition_count, sizeof(uint32_t));
    codec->touched_bags = table(run, pn_net.transition_count, sizeof(uint32_t *));
    codec->touched_bag_count = table(run, pn_net.transition_count, sizeof(uint32_t));
    codec->node = table(run, most, sizeof *codec->node);
    codec->parent = table(run, 2U * most, sizeof(uint32_t));
    uint32_t *cell = table(run, most, sizeof *cell);
    if ((codec->unit_mask == NULL) || (codec->unit_shift == NULL) || (codec->word_shift == NULL) || (codec->word_of == NULL)
        || (codec->place_of == NULL) || (codec->touched_words == NULL) || (codec->touched_count == NULL)
        || (codec->touched_bags == NULL) || (codec->touched_bag_count == NULL) || (codec->node == NULL)
        || (codec->parent == NULL) || (cell == NULL)) {
        return false;
    }
    uint32_t bits = codec->is_whole ? 0U : lay_units(codec);
    lay_words(codec);
    for (uint32_t w = codec->packed_words; w < codec->words; w++) {
        codec->word_shift[w - codec->packed_words] = bits;
        bits += 32U;
    }
    codec->is_direct = bits <= (uint32_t)KEY_BITS;
    codec->key_bytes = codec->is_direct ? rounded_up(bits, 8U) : 8U;
    if (!codec->is_direct) {
        lay_tree(codec, cell);
    }
    ex_free(run, cell, (most + 1U) * sizeof *cell);
    for (uint32_t t = 0U; !codec->is_whole && (t < pn_net.transition_count); t++) {
        if (!lay_touched(run, codec, t)) {
            return false;
        }
    }
    return ex_bytes_make(&codec->bytes, run) && (codec->is_direct || ex_quads_make(&codec->quads, run));
}

uint64_t ex_codec_bytes(const ex_run_t *run)
{
    const ex_codec_t *codec = run->codec;
    return (codec->has_cells ? ex_bytes_bytes(&codec->bytes) : 0U) + (codec->is_direct ? 0U : ex_quads_bytes(&codec->quads));
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
    const uint64_t cells = (uint64_t)codec->words + codec->nodes;
    scratch->cell = table(run, cells, sizeof *scratch->cell);
    scratch->dirty = table(run, (codec->nodes / 64U) + 1U, sizeof *scratch->dirty);
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
        const uint32_t parent = worker->run->codec->is_direct ? NONE : worker->run->codec->parent[c];
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

static ex_quad_t quad_of(const ex_node_t *node, const uint32_t *cell)
{
    uint64_t value[4] = { 0U, 0U, 0U, 0U };
    for (uint32_t i = 0U; i < node->count; i++) {
        value[i] = cell[node->child[i]];
    }
    return (ex_quad_t){ value[0] | (value[1] << 32U), value[2] | (value[3] << 32U) };
}

static bool number_node(ex_worker_t *worker, uint32_t n, uint32_t *number)
{
    ex_codec_t *codec = worker->run->codec;
    const ex_quad_t quad = quad_of(&codec->node[n], worker->scratch->cell);
    for (;;) {
        *number = ex_quads_number(&codec->quads, quad);
        if (*number != EX_NO_NUMBER) {
            return true;
        }
        if (!ex_pause(worker)) {
            worker->failed = true;
            return false;
        }
    }
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

static inline uint64_t unit_of(const void *marking, uint32_t u, uint64_t mask)
{
    uint64_t unit;
    (void)memcpy(&unit, (const unsigned char *)marking + ((size_t)u * sizeof unit), sizeof unit);
    return unit & mask;
}

/* The key of the packed part of a marking and of the other cells. */
static inline void direct_key(const ex_codec_t *codec, const void *marking, const uint32_t *cell, ex_key_t *key)
{
    ex_wide_t wide = 0U;
    for (uint32_t u = 0U; u < codec->units; u++) {
        wide |= (ex_wide_t)unit_of(marking, u, codec->unit_mask[u]) << codec->unit_shift[u];
    }
    for (uint32_t w = codec->packed_words; w < codec->words; w++) {
        wide |= (ex_wide_t)cell[w] << codec->word_shift[w - codec->packed_words];
    }
    key->low = (uint64_t)wide;
    key->high = (uint64_t)(wide >> 64U);
}

static inline void root_key(const ex_codec_t *codec, const uint32_t *cell, ex_key_t *key)
{
    key->low = cell[codec->root[0]] | ((uint64_t)cell[codec->root[1]] << 32U);
    key->high = 0U;
}

static inline uint32_t packed_word(const void *marking, uint32_t w)
{
    uint32_t word;
    (void)memcpy(&word, (const unsigned char *)marking + ((size_t)w * sizeof word), sizeof word);
    return word;
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
        direct_key(codec, marking, cell, key);
        return is_fine;
    }
    for (uint32_t w = 0U; w < codec->packed_words; w++) {
        cell[w] = packed_word(marking, w);
    }
    for (uint32_t i = 0U; is_fine && (i < pn_net.place_count); i++) {
        is_fine = (codec->word_of[i] == NONE) || intern_place(worker, i, marking, &cell[codec->word_of[i]]);
    }
    if (is_fine && (codec->time_word != NONE)) {
        is_fine = intern_time(worker, marking, &cell[codec->time_word]);
    }
    if (codec->is_direct) {
        direct_key(codec, marking, cell, key);
        return is_fine;
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
    uint32_t number;
    if (codec->time_word == NONE) {
        return true;
    }
    if (!intern_time(worker, worker->marking, &number)) {
        return false;
    }
    set_cell(worker, codec->time_word, number);
    if (!codec->is_direct && !number_dirty(worker)) {
        return false;
    }
    scratch->undone = 0U; /* it stays */
    return true;
}

bool ex_encode_next(ex_worker_t *worker, uint32_t transition, const void *next, ex_key_t *key)
{
    const ex_codec_t *codec = worker->run->codec;
    ex_scratch_t *scratch = worker->scratch;
    if (!codec->has_cells && codec->is_direct) {
        direct_key(codec, next, scratch->cell, key);
        return true;
    }
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
    if (codec->is_direct) {
        direct_key(codec, next, scratch->cell, key);
    } else {
        for (uint32_t k = 0U; k < codec->touched_count[transition]; k++) {
            const uint32_t w = codec->touched_words[transition][k];
            set_cell(worker, w, packed_word(next, w));
        }
        is_fine = is_fine && number_dirty(worker);
        root_key(codec, scratch->cell, key);
    }
    undo(scratch);
    return is_fine;
}

/* --- decoding -------------------------------------------------------------------------------------------------------------- */

/* The cells below a node. */
static void open_tree(const ex_codec_t *codec, uint32_t *cell)
{
    for (uint32_t n = codec->nodes; n > 0U; n--) {
        const ex_node_t *node = &codec->node[n - 1U];
        const ex_quad_t quad = codec->quads.quad[cell[codec->words + n - 1U]];
        const uint32_t value[4] = { (uint32_t)quad.low, (uint32_t)(quad.low >> 32U), (uint32_t)quad.high,
                                    (uint32_t)(quad.high >> 32U) };
        for (uint32_t i = 0U; i < node->count; i++) {
            cell[node->child[i]] = value[i];
        }
    }
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
    if (!codec->has_cells && codec->is_direct) {
        const ex_wide_t wide = ((ex_wide_t)key->high << 64U) | key->low;
        for (uint32_t u = 0U; u < codec->units; u++) {
            const uint64_t unit = (uint64_t)(wide >> codec->unit_shift[u]) & codec->unit_mask[u];
            const size_t at = (size_t)u * sizeof unit;
            (void)memcpy(&packed[at], &unit, ((pn_net.packed_size - at) < sizeof unit) ? (pn_net.packed_size - at) : sizeof unit);
        }
        return true;
    }
    tidy_arena(scratch);
    uint32_t *old = scratch->undo_value; /* nothing else uses it now */
    (void)memcpy(old, &cell[codec->packed_words], (codec->words - codec->packed_words) * sizeof *old);
    if (codec->is_direct) {
        const ex_wide_t wide = ((ex_wide_t)key->high << 64U) | key->low;
        for (uint32_t u = 0U; u < codec->units; u++) {
            const uint64_t unit = (uint64_t)(wide >> codec->unit_shift[u]) & codec->unit_mask[u];
            const size_t at = (size_t)u * sizeof unit;
            (void)memcpy(&packed[at], &unit, ((pn_net.packed_size - at) < sizeof unit) ? (pn_net.packed_size - at) : sizeof unit);
        }
        for (uint32_t w = codec->packed_words; w < codec->words; w++) {
            cell[w] = (uint32_t)(wide >> codec->word_shift[w - codec->packed_words]);
        }
    } else {
        cell[codec->root[0]] = (uint32_t)key->low;
        cell[codec->root[1]] = (uint32_t)(key->low >> 32U);
        open_tree(codec, cell);
        (void)memcpy(packed, cell, codec->packed_words * sizeof *cell);
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
