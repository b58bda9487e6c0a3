/* SPDX-License-Identifier: MIT
 * explore_shape.c - the shape of vectors and keys, found once from the tables of the net: which bits of the packed part
 * are words, where the other places have theirs, how words are put together into the parts of a key, and what each
 * transition may change of it.
 */
#include "../explore_run.h"
#include "explore_multiset.h"

#include <stdlib.h>
#include <string.h>

enum { WORD_BITS = 32, UNIT_BITS = 64 };

#define NONE UINT32_MAX

static uint32_t rounded_up(uint32_t bits, uint32_t unit)
{
    return (bits + unit - 1U) / unit;
}

/* Of what is part of a vector: not of what follows from it. */
static uint32_t bits_in(const pn_place_t *place)
{
    return (place->multiset->is_packed && (place->share_count == 0U))
               ? (place->multiset->colours * place->multiset->width)
               : 0U;
}

/* The end of the packed part without what follows from it. */
static uint32_t kept_end(void)
{
    uint32_t end = 0U;
    for (uint32_t i = 0U; i < pn_net.place_count; i++) {
        const pn_place_t *place = &pn_net.place[i];
        if ((bits_in(place) > 0U) && ((place->multiset->bit + bits_in(place)) > end)) {
            end = place->multiset->bit + bits_in(place);
        }
    }
    return end;
}

static int by_bit(const void *a, const void *b)
{
    const pn_place_t *first = &pn_net.place[*(const uint32_t *)a];
    const pn_place_t *second = &pn_net.place[*(const uint32_t *)b];
    return (first->multiset->bit > second->multiset->bit) - (first->multiset->bit < second->multiset->bit);
}

static void add_slice(ex_codec_t *codec, uint32_t bit, uint32_t width)
{
    codec->slice_bit[codec->packed_words] = bit;
    codec->slice_width[codec->packed_words] = width;
    codec->packed_words++;
}

/* Whether a place goes into a slice: slices lie within one of the units in which generated code handles the packed
 * part. */
static bool is_short(const pn_place_t *place)
{
    const uint32_t last = place->multiset->bit + bits_in(place) - 1U;
    return (bits_in(place) <= (uint32_t)WORD_BITS)
           && ((place->multiset->bit / (uint32_t)UNIT_BITS) == (last / (uint32_t)UNIT_BITS));
}

/* Slices of the packed part: first those of short places, as many in one as possible, then those of long ones. `order`
 * has room for the indices of all places. */
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
        const uint32_t end = place->multiset->bit + bits_in(place);
        const uint32_t last = codec->packed_words - 1U;
        if (!is_short(place)) {
            continue;
        }
        if ((codec->packed_words > 0U) && ((end - codec->slice_bit[last]) <= (uint32_t)WORD_BITS)
            && (((end - 1U) / (uint32_t)UNIT_BITS) == (codec->slice_bit[last] / (uint32_t)UNIT_BITS))) {
            codec->slice_width[last] =
                end - codec->slice_bit[last]; /* what lies between, if anything, belongs to nobody else */
        } else {
            add_slice(codec, place->multiset->bit, bits_in(place));
        }
    }
    for (uint32_t k = 0U; k < count; k++) {
        const pn_place_t *place = &pn_net.place[order[k]];
        const uint32_t end = place->multiset->bit + bits_in(place);
        for (uint32_t at = place->multiset->bit; !is_short(place) && (at < end);) {
            const uint32_t next = ((at / (uint32_t)WORD_BITS) + 1U) * (uint32_t)WORD_BITS;
            codec->is_joined[codec->packed_words] = at > place->multiset->bit;
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
        for (uint32_t k = place->multiset->bit; k < (place->multiset->bit + bits_in(place)); k++) {
            uint32_t *width = &codec->slice_width[k / (uint32_t)WORD_BITS];
            const uint32_t needed = (k % (uint32_t)WORD_BITS) + 1U;
            *width = (needed > *width) ? needed : *width;
        }
    }
}

/* Which bits of them are the key. */
static void mask_plain(ex_codec_t *codec)
{
    uint64_t mask[2] = { 0U, 0U };
    for (uint32_t w = 0U; w < codec->packed_words; w++) {
        const uint64_t own = ((uint64_t)1U << codec->slice_width[w]) - 1U;
        mask[w / 2U] |= own << ((uint32_t)WORD_BITS * (w % 2U));
    }
    codec->plain_low = mask[0];
    codec->plain_high = mask[1];
    codec->is_word = (mask[1] == 0U) && (mask[0] <= EX_MOST_WORD);
}

/* The words behind the packed part. */
static void lay_words(ex_codec_t *codec)
{
    uint32_t word = codec->packed_words;
    codec->time_word = NONE;
    codec->root_word = NONE;
    for (uint32_t i = 0U; i < pn_net.place_count; i++) {
        codec->word_of[i] = NONE;
        if (!codec->is_whole && !pn_net.place[i].multiset->is_packed) {
            codec->place_of[word - codec->packed_words] = i;
            codec->word_of[i] = word++;
        }
    }
    if (codec->is_whole) {
        word++;
    } else if (pn_net.timed) {
        codec->time_word = word++;
    }
    if (pn_net.root_count > 0U) {
        codec->root_word = word++;
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
        for (uint32_t k = 0U; k < codec->touched_multiset_count[t]; k++) {
            parts |= 1U << codec->part_of[codec->word_of[codec->touched_multisets[t][k]]];
        }
        codec->touched_parts[t] = (uint8_t)parts;
    }
}

/* Whether a node's tuple can be read from the packed part as it lies there, two words at a time, and where. */
static void find_lanes(const ex_codec_t *codec, ex_node_t *node)
{
    node->is_direct = true;
    for (uint32_t i = 0U; i < EX_TUPLE_LANES; i++) {
        node->unit[i] = 0U;
        node->mask[i] = 0U;
    }
    for (uint32_t i = 0U; node->is_direct && (i < node->count); i++) {
        const uint32_t c = node->child[i];
        const uint32_t shift = (uint32_t)WORD_BITS * (i % 2U);
        const bool is_there = (c < codec->packed_words) && ((codec->slice_bit[c] % (uint32_t)UNIT_BITS) == shift);
        const uint32_t unit = is_there ? (codec->slice_bit[c] / (uint32_t)UNIT_BITS) : 0U;
        node->is_direct = is_there && ((shift == 0U) || (node->unit[i / 2U] == unit));
        if (node->is_direct) {
            node->unit[i / 2U] = unit;
            node->mask[i / 2U] |= (((uint64_t)1U << codec->slice_width[c]) - 1U) << shift;
        }
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
    codec->is_flat = !codec->is_whole && (codec->root_word == NONE);
    for (uint32_t n = 0U; n < codec->nodes; n++) {
        codec->is_flat = codec->is_flat && (codec->node[n].table < EX_KEY_WORDS);
        codec->node[n].parent = codec->parent[codec->words + n];
        find_lanes(codec, &codec->node[n]);
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
    codec->touched_words[t] = ex_table(&run->memory, codec->packed_words, sizeof(uint32_t));
    codec->touched_multisets[t] = ex_table(&run->memory, transition->touched_count, sizeof(uint32_t));
    if ((codec->touched_words[t] == NULL) || (codec->touched_multisets[t] == NULL)) {
        return false;
    }
    for (uint32_t k = 0U; k < transition->touched_count; k++) {
        const uint32_t p = transition->touched[k];
        if (!pn_net.place[p].multiset->is_packed) {
            codec->touched_multisets[t][codec->touched_multiset_count[t]++] = p;
        }
    }
    for (uint32_t w = 0U; w < codec->packed_words; w++) {
        bool is_touched = false;
        for (uint32_t k = 0U; !is_touched && (k < transition->touched_count); k++) {
            const pn_place_t *place = &pn_net.place[transition->touched[k]];
            is_touched = (place->multiset->bit < (codec->slice_bit[w] + codec->slice_width[w]))
                         && (codec->slice_bit[w] < (place->multiset->bit + bits_in(place)));
        }
        if (is_touched) {
            codec->touched_words[t][codec->touched_count[t]++] = w;
        }
    }
    return true;
}

bool ex_codec_make(ex_run_t *run)
{
    ex_codec_t *codec = ex_alloc(&run->memory, sizeof *codec);
    if (codec == NULL) {
        return false;
    }
    run->codec = codec;
    codec->is_whole = pn_net.place_count == 0U;
    const uint32_t packed = codec->is_whole ? 0U : (uint32_t)pn_net.packed_size;
    const uint32_t packed_words = rounded_up(packed, 4U);
    const uint64_t most = (2U * (uint64_t)packed_words) + (2U * (uint64_t)pn_net.place_count) + 3U;
    codec->slice_bit = ex_table(&run->memory, most, sizeof(uint32_t));
    codec->slice_width = ex_table(&run->memory, most, sizeof(uint32_t));
    codec->word_of = ex_table(&run->memory, pn_net.place_count, sizeof(uint32_t));
    codec->place_of = ex_table(&run->memory, most, sizeof(uint32_t));
    codec->touched_words = ex_table(&run->memory, pn_net.transition_count, sizeof(uint32_t *));
    codec->touched_count = ex_table(&run->memory, pn_net.transition_count, sizeof(uint32_t));
    codec->touched_multisets = ex_table(&run->memory, pn_net.transition_count, sizeof(uint32_t *));
    codec->touched_multiset_count = ex_table(&run->memory, pn_net.transition_count, sizeof(uint32_t));
    codec->touched_parts = ex_table(&run->memory, pn_net.transition_count, sizeof(uint8_t));
    codec->part_of = ex_table(&run->memory, most, sizeof(uint32_t));
    codec->node = ex_table(&run->memory, most, sizeof *codec->node);
    codec->parent = ex_table(&run->memory, 2U * most, sizeof(uint32_t));
    uint32_t *cell = ex_table(&run->memory, most, sizeof *cell);
    codec->is_joined = ex_table(&run->memory, most, sizeof(bool));
    if ((codec->slice_bit == NULL) || (codec->slice_width == NULL) || (codec->is_joined == NULL)
        || (codec->word_of == NULL) || (codec->place_of == NULL) || (codec->touched_words == NULL)
        || (codec->touched_parts == NULL) || (codec->part_of == NULL) || (codec->touched_count == NULL)
        || (codec->touched_multisets == NULL) || (codec->touched_multiset_count == NULL) || (codec->node == NULL)
        || (codec->parent == NULL) || (cell == NULL)) {
        return false;
    }
    const uint32_t kept_words = rounded_up(kept_end(), (uint32_t)WORD_BITS);
    codec->is_plain = !codec->is_whole && !pn_net.timed && (pn_net.root_count == 0U) && (pn_net.multiset_count == 0U)
                      && (kept_words > 0U) && (kept_words <= EX_KEY_WORDS);
    if (codec->is_plain) {
        lay_plain(codec, kept_words);
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
        mask_plain(codec);
    }
    ex_free_table(&run->memory, cell, most, sizeof *cell);
    return ex_derived_make(run) && ex_heaps_make(run) && ex_bytes_make(&codec->bytes, &run->memory, &run->team)
           && ex_codec_number(run);
}

bool ex_codec_number(ex_run_t *run)
{
    ex_codec_t *codec = run->codec;
    for (uint32_t i = 0U; i < EX_TABLES; i++) {
        if (codec->tuples[i].lane != NULL) {
            ex_tuples_free(&codec->tuples[i]);
        }
        if ((codec->tuple_words[i] > 0U)
            && !ex_tuples_make(&codec->tuples[i], &run->memory, &run->team, codec->tuple_words[i])) {
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
            const ex_index_t *index = (cell < codec->words)
                                          ? &codec->bytes.index
                                          : &codec->tuples[codec->node[cell - codec->words].table].index;
            const uint64_t count = atomic_load(&index->count);
            width[i] = bits_of(count + (count / 4U) + 64U);
        }
    }
}
