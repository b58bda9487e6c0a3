/* SPDX-License-Identifier: MIT
 * explore_flat.c - the search where all places are packed, but into more than a key can hold: each part of a key is
 * then a word of the packed part, or the number of a tuple of such words. Successors are kept as tuples for a while:
 * until it is their turn to be looked up, the lines of the tables that know their numbers are on the way.
 */
#include "explore_search.h"
#include "explore_successors.h"

#include <string.h>

enum {
    KEPT = 16,
    CACHE_BITS = 12,
    CACHE_SIZE = 1 << CACHE_BITS, /* tuples of a part */
    UNIT_BITS = 64
};

#define SHORT 2U /* lanes */

/* A part of a key. */
typedef struct part {
    ex_tuples_t *tuples;   /* NULL: it is a word of the packed part */
    const ex_node_t *node; /* of the tuple */
    bool is_short;         /* it has no more than SHORT lanes */
    uint32_t unit;         /* of the word: where it is */
    uint32_t shift;
    uint64_t mask;
    uint64_t *cache; /* tuples that were looked up a short while ago, each as its number + 1 (0: none) and its lanes */
} part_t;

/* A successor that has not been given to the search yet. */
typedef struct kept {
    ex_key_t key;
    uint64_t hash;
    uint32_t missing; /* a bit for each part of which the number is not known: then there is no key yet */
    uint32_t word[EX_KEY_WORDS];
    uint64_t tuple_hash[EX_KEY_WORDS];
    uint64_t lane[EX_KEY_WORDS][EX_TUPLE_LANES];
} kept_t;

struct ex_flat {
    part_t part[EX_KEY_WORDS];
    uint32_t parts;
    bool is_ready;               /* keys are of this kind now */
    uint32_t word[EX_KEY_WORDS]; /* of the state that is opened */
    uint32_t kept;
    bool has_missing; /* one of them has no key */
    kept_t successor[KEPT];
    uint64_t cache[EX_KEY_WORDS][(EX_TUPLE_LANES + 1U) * CACHE_SIZE];
};

bool ex_flat_make(ex_worker_t *worker)
{
    const ex_run_t *run = worker->run;
    const ex_codec_t *codec = run->codec;
    if (!worker->search->is_exact || codec->is_whole || codec->is_plain || (codec->words != codec->packed_words)
        || (run->reduction != NULL) || pn_net.timed || (worker->local != NULL)) {
        return true;
    }
    worker->search->flat = ex_alloc(&worker->run->memory, sizeof *worker->search->flat);
    return worker->search->flat != NULL;
}

void ex_flat_lay(ex_worker_t *worker)
{
    ex_codec_t *codec = worker->run->codec;
    struct ex_flat *const own = worker->search->flat;
    if (own == NULL) {
        return;
    }
    own->is_ready = codec->is_flat;
    (void)memset(own->cache, 0, sizeof own->cache);
    own->parts = own->is_ready ? codec->roots : 0U;
    for (uint32_t i = 0U; i < own->parts; i++) {
        part_t *const part = &own->part[i];
        const uint32_t cell = codec->root[i];
        *part = (part_t){ .tuples = NULL };
        if (cell >= codec->words) {
            part->node = &codec->node[cell - codec->words];
            part->tuples = &codec->tuples[part->node->table];
            part->is_short = part->tuples->lanes <= SHORT;
            part->cache = own->cache[i];
        } else {
            part->unit = codec->slice_bit[cell] / (uint32_t)UNIT_BITS;
            part->shift = codec->slice_bit[cell] % (uint32_t)UNIT_BITS;
            part->mask = ((uint64_t)1U << codec->slice_width[cell]) - 1U;
        }
    }
}

bool ex_flat_is_ready(const ex_worker_t *worker)
{
    return (worker->search->flat != NULL) && worker->search->flat->is_ready;
}

/* --- keys --------------------------------------------------------------------------------------------------------- */

/* Some lanes of the tuple of a part in a marking: of lanes that there are not the mask is 0. */
static inline void read_lanes(const ex_node_t *node, const uint64_t *unit, uint64_t *lane, uint32_t lanes)
{
    lane[0] = unit[node->unit[0]] & node->mask[0];
    lane[1] = unit[node->unit[1]] & node->mask[1];
    if (lanes > SHORT) {
        lane[2] = unit[node->unit[2]] & node->mask[2];
        lane[3] = unit[node->unit[3]] & node->mask[3];
    }
}

/* The same where its words do not lie two and two. */
static EX_APART void gather(const ex_codec_t *codec, const ex_node_t *node, const uint64_t *unit,
                            uint64_t lane[EX_TUPLE_LANES])
{
    for (uint32_t i = 0U; i < node->count; i++) {
        lane[i / 2U] |= (uint64_t)ex_packed_word(codec, unit, node->child[i]) << (32U * (i % 2U));
    }
}

/* Where a tuple is remembered, if it is. */
static inline uint64_t *memory_of(const part_t *part, const uint64_t *lane, uint32_t lanes)
{
    uint64_t mixed = (lane[0] * 0x9e3779b97f4a7c15U) + (lane[1] * 0xd6e8feb86659fd93U);
    if (lanes > SHORT) {
        mixed += (lane[2] * 0xa0761d6478bd642fU) + (lane[3] * 0xe7037ed1a0b428dbU);
    }
    const uint64_t at = (mixed ^ (mixed >> 32U)) * 0x8ebc6af09c88c6e3U;
    return &part->cache[(at >> (64U - (uint32_t)CACHE_BITS)) * (lanes + 1U)];
}

/* Its number; EX_NO_NUMBER: it is not. */
static inline uint32_t recall(const part_t *part, const uint64_t *lane, uint32_t lanes)
{
    const uint64_t *const memory = memory_of(part, lane, lanes);
    uint64_t difference = (memory[1] ^ lane[0]) | (memory[2] ^ lane[1]);
    if (lanes > SHORT) {
        difference |= (memory[3] ^ lane[2]) | (memory[4] ^ lane[3]);
    }
    return (difference == 0U) ? ((uint32_t)memory[0] - 1U) : EX_NO_NUMBER; /* no number: 0 - 1 */
}

static void remember(const part_t *part, const uint64_t lane[EX_TUPLE_LANES], uint32_t number)
{
    const uint32_t lanes = part->is_short ? SHORT : EX_TUPLE_LANES;
    uint64_t *const memory = memory_of(part, lane, lanes);
    memory[0] = (uint64_t)number + 1U;
    (void)memcpy(&memory[1], lane, lanes * sizeof lane[0]);
}

/* Makes worker->marking the state of a key. */
static void open(ex_worker_t *worker, const ex_key_t *key)
{
    const ex_codec_t *codec = worker->run->codec;
    struct ex_flat *const own = worker->search->flat;
    uint64_t *const unit = worker->marking;
    const uint32_t word[EX_KEY_WORDS] = { (uint32_t)key->low, (uint32_t)(key->low >> 32U), (uint32_t)key->high,
                                          (uint32_t)(key->high >> 32U) };
    (void)memcpy(own->word, word, sizeof own->word);
    (void)memset(unit, 0, pn_net.packed_size);
    for (uint32_t i = 0U; i < own->parts; i++) {
        const part_t *const part = &own->part[i];
        if (part->tuples == NULL) {
            unit[part->unit] |= (uint64_t)word[i] << part->shift;
            continue;
        }
        const ex_node_t *const node = part->node;
        const uint64_t *const lane = &part->tuples->lane[(uint64_t)word[i] * part->tuples->lanes];
        if (node->is_direct) {
            for (uint32_t k = 0U; k < part->tuples->lanes; k++) {
                unit[node->unit[k]] |= lane[k];
            }
            continue;
        }
        for (uint32_t k = 0U; k < node->count; k++) {
            const uint32_t bit = codec->slice_bit[node->child[k]];
            unit[bit / (uint32_t)UNIT_BITS] |= ((lane[k / 2U] >> (32U * (k % 2U))) & UINT32_MAX)
                                               << (bit % (uint32_t)UNIT_BITS);
        }
    }
    ex_derive(codec, unit);
}

/* All parts are known. */
static inline void make_key(const ex_worker_t *worker, kept_t *successor)
{
    const uint32_t *const word = successor->word;
    successor->key.low = ex_alone(word[0]) | (ex_alone(word[1]) << 32U);
    successor->key.high = ex_alone(word[2]) | (ex_alone(word[3]) << 32U);
    successor->hash = ex_hash(&successor->key);
    ex_take_soon(worker->search, successor->hash);
}

/* Looks up what is missing. */
static EX_APART bool complete(ex_worker_t *worker)
{
    struct ex_flat *const own = worker->search->flat;
    for (uint32_t s = 0U; s < own->kept; s++) {
        const kept_t *const successor = &own->successor[s];
        for (uint32_t rest = successor->missing; rest != 0U; rest &= rest - 1U) {
            const uint32_t i = (uint32_t)__builtin_ctz(rest);
            ex_tuples_send(own->part[i].tuples, successor->tuple_hash[i]);
        }
    }
    for (uint32_t s = 0U; s < own->kept; s++) {
        kept_t *const successor = &own->successor[s];
        if (successor->missing == 0U) {
            continue;
        }
        for (uint32_t rest = successor->missing; rest != 0U; rest &= rest - 1U) {
            const uint32_t i = (uint32_t)__builtin_ctz(rest);
            const part_t *const part = &own->part[i];
            if (!ex_number_tuple(worker, part->tuples, successor->lane[i], successor->tuple_hash[i],
                                 &successor->word[i])) {
                return false;
            }
            remember(part, successor->lane[i], successor->word[i]);
        }
        make_key(worker, successor);
    }
    own->has_missing = false;
    return true;
}

bool ex_flat_finish(ex_worker_t *worker)
{
    struct ex_flat *const own = worker->search->flat;
    if (own->has_missing && !complete(worker)) {
        return false;
    }
    const uint32_t kept = own->kept;
    own->kept = 0U;
    for (uint32_t s = 0U; s < kept; s++) {
        const kept_t *const successor = &own->successor[s];
        if (!ex_take(worker, &successor->key, successor->hash)) {
            return false;
        }
    }
    return true;
}

/* --- successors --------------------------------------------------------------------------------------------------- */

static bool on_marking(void *user, uint32_t transition, const void *binding, const void *next)
{
    ex_worker_t *const worker = user;
    const ex_codec_t *const codec = worker->run->codec;
    struct ex_flat *const own = worker->search->flat;
    const uint64_t *const unit = next;
    kept_t *const successor = &own->successor[own->kept];
    uint32_t missing = 0U;
    (void)binding;
    worker->fired[transition]++;
    worker->arcs++;
    (void)memcpy(successor->word, own->word, sizeof successor->word);
    for (uint32_t rest = codec->touched_parts[transition]; rest != 0U; rest &= rest - 1U) {
        const uint32_t i = (uint32_t)__builtin_ctz(rest);
        const part_t *const part = &own->part[i];
        if (part->tuples == NULL) {
            successor->word[i] = (uint32_t)((unit[part->unit] >> part->shift) & part->mask);
            continue;
        }
        uint64_t lane[EX_TUPLE_LANES] = { 0U, 0U, 0U, 0U };
        if (!part->node->is_direct) {
            gather(codec, part->node, unit, lane);
            successor->word[i] = recall(part, lane, part->is_short ? SHORT : EX_TUPLE_LANES);
        } else if (part->is_short) {
            read_lanes(part->node, unit, lane, SHORT);
            successor->word[i] = recall(part, lane, SHORT);
        } else {
            read_lanes(part->node, unit, lane, EX_TUPLE_LANES);
            successor->word[i] = recall(part, lane, EX_TUPLE_LANES);
        }
        if (successor->word[i] == EX_NO_NUMBER) {
            missing |= 1U << i;
            (void)memcpy(successor->lane[i], lane, sizeof lane);
            successor->tuple_hash[i] = ex_tuple_hash(lane, part->tuples->lanes);
            ex_tuples_prefetch(part->tuples, successor->tuple_hash[i]);
        }
    }
    successor->missing = missing;
    if (missing == 0U) {
        make_key(worker, successor);
    } else {
        own->has_missing = true;
    }
    own->kept++;
    return (own->kept < (uint32_t)KEPT) || ex_flat_finish(worker);
}

ex_found_t ex_flat_successors(ex_worker_t *worker, const ex_key_t *key)
{
    open(worker, key);
    return ex_next_markings(worker, on_marking, worker);
}
