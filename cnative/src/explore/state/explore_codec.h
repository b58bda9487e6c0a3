/* SPDX-License-Identifier: MIT
 * explore_codec.h - markings as vectors, and vectors as keys (explore_shape.c, explore_codec.c).
 *
 * A marking is made into a *vector* of words (explore_codec.c) and a vector into a *key* of at most four words: those
 * of the vector themselves when they are so few, else the numbers of its parts. Equal markings, equal keys; a key can
 * be made into a marking again.
 */
#ifndef EXPLORE_CODEC_H
#define EXPLORE_CODEC_H

#include <string.h>

#include "explore_intern.h"
#include "explore_key.h"
#include "pn/pn_arena.h"
#include "pn/pn_net.h"

struct ex_run;
struct ex_worker;

/* A group of words that share a number: an inner node of the tree. */
typedef struct ex_node {
    uint32_t child[EX_TUPLE_WORDS]; /* cells */
    uint32_t count;
    uint32_t parent; /* node; UINT32_MAX: it is a part of the key */
    uint32_t table;  /* of numbers */
    bool is_direct;  /* each lane of its tuple is some bits of a unit of the packed part, in their place */
    uint32_t unit[EX_TUPLE_LANES];
    uint64_t mask[EX_TUPLE_LANES];
} ex_node_t;

/* Counters within one unit of 64 bits of the packed part that follow from others: a constant less the terms. */
typedef struct ex_term {
    uint32_t unit;
    uint32_t shift;
    uint64_t mask;
    uint64_t weight;
} ex_term_t;

typedef struct ex_derived {
    ex_term_t of; /* weight 1 */
    uint64_t constant;
    uint32_t first; /* of its terms */
    uint32_t terms;
} ex_derived_t;

#define EX_TABLES (EX_KEY_WORDS + 1U) /* of numbers: for each part of the key, and for all nodes below */

/* The shape of the vectors: found once, from the tables of the net.
 *
 * A vector consists of cells: slices of the packed part (of one long place, or of several short ones), a word for each
 * multiset (the number of its bytes), one for the time if the net is timed, one for what its references hold if it
 * changes them. Where places cannot be encoded one by one, there is one word for the whole marking. */
typedef struct ex_codec {
    bool is_whole;
    bool is_plain;      /* the key is the beginning of the packed part; all else follows from it */
    bool is_word;       /* then: it is at most EX_MOST_WORD */
    uint64_t plain_low; /* then: the bits of the marking that belong to it */
    uint64_t plain_high;
    ex_derived_t *derived; /* what follows from the rest of the packed part */
    uint32_t derived_count;
    ex_term_t *term;
    bool has_cells; /* there is more than the packed part */
    uint32_t packed_words;
    uint32_t words;           /* cells, without those of the inner nodes */
    uint32_t time_word;       /* UINT32_MAX: none */
    uint32_t root_word;       /* of what references hold (explore_roots.c); UINT32_MAX: there are none that change */
    uint32_t zero_cell;       /* a cell that is always 0 */
    uint32_t *slice_bit;      /* of the packed part, by word of the vector: its first bit there */
    uint32_t *slice_width;    /* and the number of bits, at most 32 */
    bool *is_joined;          /* whether it goes on with the place of the word before */
    uint32_t *word_of;        /* by place: its word; UINT32_MAX: packed */
    uint32_t *place_of;       /* by word behind the packed part */
    bool *is_heap;            /* by place: whether more than `most_heaped` tokens end the exploration; NULL: none */
    uint32_t **touched_words; /* by transition: words of the packed part that an occurrence may change */
    uint32_t *touched_count;
    uint32_t **touched_multisets; /* by transition: places */
    uint32_t *touched_multiset_count;
    uint32_t *part_of;      /* by word: the part of the key in which it is */
    uint8_t *touched_parts; /* by transition: a bit for each of them */
    bool is_flat;           /* no part is more than one node over words */
    ex_node_t *node;
    uint32_t nodes;
    uint32_t *parent;            /* by cell: node */
    uint32_t root[EX_KEY_WORDS]; /* cells that make the key */
    uint32_t roots;
    ex_bytes_t bytes;
    ex_tuples_t tuples[EX_TABLES];
    uint32_t tuple_words[EX_TABLES]; /* 0: there is no such table */
} ex_codec_t;

/* The key of a marking that is nothing but a short packed part. */
static inline void ex_plain_key(const ex_codec_t *codec, const void *marking, ex_key_t *key)
{
    uint64_t low;
    uint64_t high;
    (void)memcpy(&low, marking, sizeof low); /* there is room for so much */
    (void)memcpy(&high, (const unsigned char *)marking + sizeof low, sizeof high);
    key->low = ex_alone(low) & codec->plain_low;
    key->high = ex_alone(high) & codec->plain_high;
}

/* explore_derive.c: tables of what follows from others; the sums, from the initial marking; the counters themselves,
 * which are 0 before. */
bool ex_derived_make(struct ex_run *run);
void ex_derived_start(struct ex_run *run, const void *initial);
static inline void ex_derive(const ex_codec_t *codec, void *marking)
{
    uint64_t *const unit = marking;
    for (uint32_t i = 0U; i < codec->derived_count; i++) {
        const ex_derived_t *const derived = &codec->derived[i];
        uint64_t value = derived->constant;
        for (uint32_t k = 0U; k < derived->terms; k++) {
            const ex_term_t *const term = &codec->term[derived->first + k];
            value -= term->weight * ((unit[term->unit] >> term->shift) & term->mask);
        }
        unit[derived->of.unit] |= value << derived->of.shift;
    }
}

/* What a thread needs for it. */
typedef struct ex_scratch {
    uint32_t *cell;    /* of the state that is loaded: words, then inner nodes */
    uint32_t *decoded; /* by word behind the packed part: the number of what worker->marking holds there; EX_NO_NUMBER:
                          anything */
    uint64_t *dirty;   /* a bit for each inner node: its cell is to be found out */
    uint64_t *stale;   /* the same for as long as the state is loaded: the time has gone on since */
    uint32_t *undo_cell;
    uint32_t *undo_value;
    uint32_t undone;
    unsigned char *buffer;
    size_t buffer_size;
    void *next; /* marking */
    void *binding;
    pn_arena_t arena;
    pn_arena_t roots; /* what references hold, and nothing else */
} ex_scratch_t;

bool ex_codec_make(struct ex_run *run);
/* Other parts of the key: words `end[i - 1]` .. `end[i] - 1` of the permutation `word` (which is overwritten) become
 * part i. */
void ex_codec_group(ex_codec_t *codec, uint32_t *word, const uint32_t end[EX_KEY_WORDS], uint32_t parts);
/* New tables for the numbers of nodes. */
bool ex_codec_number(struct ex_run *run);
/* Finds good parts (explore_layout.c) by going at random from the marking of the first worker, if that is harmless;
 * keys made before are worth nothing then. False: no memory. */
bool ex_layout(struct ex_run *run);
/* The same with what the store holds, when nobody uses it: its keys become other ones, and so do those that `replace`
 * gives to the function that it is called with. False: no memory. */
typedef void (*ex_replace_t)(const void *layout, ex_key_t *key);
bool ex_layout_again(struct ex_run *run, void (*replace)(struct ex_run *run, ex_replace_t one, const void *layout));
/* The cells of a key, in a table of at least zero_cell + 1 of them that are 0. */
void ex_key_cells(const ex_codec_t *codec, const ex_key_t *key, uint32_t *cell);
/* The key of cells of which the words are there; false: no memory. Nobody else uses the tables. */
bool ex_cells_key(ex_codec_t *codec, uint32_t *cell, ex_key_t *key);
bool ex_scratch_make(struct ex_worker *worker);
/* For ex_successors: the key of `next`, which is what has become of the loaded state by a transition; the time is the
 * same. */
bool ex_encode_next(struct ex_worker *worker, uint32_t transition, const void *next, ex_key_t *key);
/* Bits that the words of the keys need now. */
void ex_key_widths(const struct ex_run *run, uint32_t width[EX_KEY_WORDS]);
/* The words of the time and, when it is reduced, of the timed places have to be those of worker->marking. */
bool ex_encode_time(struct ex_worker *worker);
/* Bytes of the tables of interned places and of pairs. */
uint64_t ex_codec_bytes(const struct ex_run *run);
/* The canonical bytes of all multi-sets that places which are not packed ever held; NULL: all places are packed. */
const ex_bytes_t *ex_interned(const struct ex_run *run);

/* The key of a marking; false after an error or when memory is used up (the worker's `failed` tells). */
bool ex_encode(struct ex_worker *worker, const void *marking, ex_key_t *key);
/* Makes worker->marking that of the key, at the time at which the state was created. False after an error. */
bool ex_load(struct ex_worker *worker, const ex_key_t *key);
/* The same in two steps: its cells, packed places and time; then the other places, or one of them. */
bool ex_open(struct ex_worker *worker, const ex_key_t *key);
bool ex_load_places(struct ex_worker *worker);
bool ex_load_place(struct ex_worker *worker, uint32_t place, uint32_t number);
/* A place that is not packed holds nothing in worker->marking. */
void ex_clear_place(struct ex_worker *worker, uint32_t place);
/* Somebody else has written into worker->marking. */
void ex_unload(struct ex_worker *worker);
/* A word of the packed part. */
uint32_t ex_packed_word(const ex_codec_t *codec, const void *marking, uint32_t w);
/* The number of a tuple, of which the hash is known (ex_tuple_hash). False: no memory. */
bool ex_number_tuple(struct ex_worker *worker, ex_tuples_t *tuples, const uint64_t lane[EX_TUPLE_LANES], uint64_t hash,
                     uint32_t *number);
/* A cell that is to become another one. */
typedef struct ex_change {
    uint32_t cell;
    uint32_t value;
} ex_change_t;
/* The key of what becomes of the opened state when words change. False: no memory. */
bool ex_encode_changes(struct ex_worker *worker, const ex_change_t *change, uint32_t count, ex_key_t *key);

#endif /* EXPLORE_CODEC_H */
