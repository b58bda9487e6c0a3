/* SPDX-License-Identifier: MIT
 * explore_impl.h - what the parts of the explorer share.
 *
 * A marking is made into a *vector* of words (explore_codec.c) and a vector into a *key* of at most four words: those
 * of the vector themselves when they are so few, else the numbers of its parts. Equal markings, equal keys; a key can
 * be made into a marking again. The store (explore_store.c) is a set of keys. Its slots are numbered; a key stays in
 * its slot unless the store grows, which happens during the exploration only (explore_search.c). After a complete
 * exploration the graph phase (explore_graph.c) goes through the slots, makes the successors of each key once more and
 * looks up their slots.
 */
#ifndef EXPLORE_IMPL_H
#define EXPLORE_IMPL_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include "state/explore_intern.h"
#include "query/explore_programs.h"
#include "pn/pn_arena.h"
#include "pn/pn_marking.h"
#include "pn/pn_net.h"

#define EX_MOST_THREADS 64U
#define EX_MOST_OWNERS  256U
#define EX_NO_SLOT      UINT64_MAX
#define EX_CACHE_LINE   128   /* two: they are fetched in pairs */
#define EX_SPARE_KEYS   1024U /* a store grows when less room than for so many is left below its limit */

__extension__ typedef unsigned __int128 ex_wide_t;

typedef struct ex_options {
    bool is_depth_first;
    uint32_t threads;
    uint64_t max_states; /* UINT64_MAX: no limit; so the others */
    double max_seconds;  /* 0: no limit */
    uint64_t memory;     /* bytes */
    uint64_t arena;      /* bytes of each thread, for lists and strings */
    uint64_t seed;
    bool is_still;      /* traces say that random numbers are the same at each step */
    uint64_t lay_again; /* states after which the layout of keys is looked at once more */
    bool has_graph;     /* wanted */
    bool has_notes;     /* what transitions do is remembered (explore_local.c) */
    bool is_bitstate;
    bool is_hashed;       /* hash compaction */
    bool is_time_reduced; /* stamps count from the model time on, which is always 0; those that are not after it are
                             equal */
    bool shows_progress;
    bool shows_help;
    bool is_stubborn; /* reductions: see explore_reduce.h */
    bool is_symmetric;
    const char *elements;    /* file: the table that these need */
    const char *dependency;  /* file: the table that partial order needs where there is no such table */
    const char *spill;       /* folder; NULL: none */
    const char *write_graph; /* file; NULL: none */
    uint64_t write_limit;    /* most nodes of a graph that is written */
    double progress_every;   /* seconds between lines */
    const char *trace_to;    /* what the names of traces to dead markings begin with; NULL: none */
    const char *initial; /* JSON: initial markings that a trace names, because the file of the net has others; NULL */
    uint64_t dead_limit;
    uint64_t traces;            /* most traces in trace_to */
    const char *queries;        /* file of questions; NULL: none */
    const char *query_trace_to; /* what the names of traces that prove their answers begin with */
    const char *error_trace_to; /* the same for the trace to an exception */
    const char *ends_in; /* phase in which the time ends as soon as it begins, whatever the clock says; NULL: none */
    uint64_t multiset_limit; /* colours of a multi-set bound that are printed */
    const char *whole;       /* places of which all are, numbers with commas between; NULL: none */
    uint64_t parent;         /* process that started it, and without which it is to end; 0: none */
} ex_options_t;

/* Why it ended, in the order of importance. */
typedef enum ex_why {
    EX_COMPLETE,
    EX_DECIDED,     /* all questions have been answered before that */
    EX_APPROXIMATE, /* nothing was in the way, but states may have been taken for others: it is never complete */
    EX_STATES,
    EX_SECONDS,
    EX_MEMORY,
    EX_INFINITE, /* whoever started it knows that there is no end */
    EX_INTERRUPTED,
    EX_CAPACITY, /* a place has too little room, or an arena: the program can be built or started with more */
    EX_ERROR     /* an inscription raised an exception */
} ex_why_t;

/* The first error of an evaluation. */
typedef struct ex_error {
    char message[256];
    char where[512];
    const char *kind;   /* "capacity": of the place; "memory": of lists and strings; "exception" */
    int64_t place;      /* index, -1: none */
    int64_t transition; /* index, -1: none */
} ex_error_t;

/* What is rare is kept out of what is frequent. */
#if defined(__GNUC__)
#define EX_APART __attribute__((noinline))
#else
#define EX_APART
#endif

/* The same number, in a register of its own: two words that were stored one by one are not to be loaded as one. */
static inline uint64_t ex_alone(uint64_t x)
{
#if defined(__GNUC__)
    __asm__("" : "+r"(x));
#endif
    return x;
}

/* What stands for a state: up to four words, the lower half of `low` first; the rest zero. */
typedef struct ex_key {
    uint64_t low;
    uint64_t high;
} ex_key_t;

#define EX_KEY_WORDS 4U

struct ex_run;
struct ex_worker;

/* --- memory (explore_memory.c) ------------------------------------------------------------------------------------ */

/* Zeroed memory, page-aligned; counted, refused (NULL) beyond the limit of --memory. With --spill it lies in a file.
 * Pages that are never touched cost nothing but count. Large blocks get huge pages. Thread-safe. */
void *ex_alloc(struct ex_run *run, uint64_t size);
/* Room for `count` things and one more, zeroed. */
void *ex_table(struct ex_run *run, uint64_t count, uint64_t size);
void ex_free_table(struct ex_run *run, void *memory, uint64_t count, uint64_t size);
void ex_free(struct ex_run *run, void *memory, uint64_t size);
/* Whether so much could be had now. */
bool ex_has_room(const struct ex_run *run, uint64_t size);
/* Counts memory that is used of a reservation; false beyond the limit. */
bool ex_count(struct ex_run *run, uint64_t size);
void ex_uncount(struct ex_run *run, uint64_t size);
/* As ex_alloc, but the caller has counted it. */
void *ex_map(struct ex_run *run, uint64_t size);
/* Zeroed addresses that cost nothing and do not count until they are used. NULL: not so many. */
void *ex_reserve(uint64_t size);
/* Gives back the pages of a part of a block that is going to be freed; they still count. */
void ex_discard(struct ex_run *run, void *memory, uint64_t size, uint64_t from, uint64_t to);
/* ex_free without counting. */
void ex_unmap(void *memory, uint64_t size);
/* Whether a block of that size lies in a file and does not count. */
bool ex_is_spilled(const struct ex_run *run, uint64_t size);

/* --- codec (explore_shape.c, explore_codec.c) --------------------------------------------------------------------- */

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
 * bag (the number of its bytes), one for the time if the net is timed, one for what its references hold if it changes
 * them. Where places cannot be encoded one by one, there is one word for the whole marking. */
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
    uint32_t **touched_words; /* by transition: words of the packed part that an occurrence may change */
    uint32_t *touched_count;
    uint32_t **touched_bags; /* by transition: places */
    uint32_t *touched_bag_count;
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

/* --- references (explore_roots.c) --------------------------------------------------------------------------------- */

bool ex_roots_make(struct ex_worker *worker);
/* The number of what they hold now. False: no memory. */
bool ex_roots_number(struct ex_worker *worker, uint32_t *number);
/* Lets them hold what has that number; false after an error (the context has it). */
bool ex_roots_load(struct ex_worker *worker, uint32_t number);
/* After an occurrence in the loaded state: they hold again what they hold there. False: the worker has failed. */
bool ex_roots_restore(struct ex_worker *worker);

/* --- multi-sets (explore_multiset.c) ------------------------------------------------------------------------------ */

/* Room for `size` bytes in the scratch buffer, which is empty then. False: no memory. */
bool ex_buffer_grow(struct ex_worker *worker, size_t size);
/* The number of a string of bytes. False: no memory. */
bool ex_intern(struct ex_worker *worker, uint32_t kind, const unsigned char *byte, size_t length, uint32_t *number);
/* What a place of `next` holds as the number of a multi-set of `kind`: the place, or EX_ADDED + the place for what is
 * added to it. False: no memory. */
#define EX_ADDED (pn_net.place_count + 1U)
bool ex_number_place(struct ex_worker *worker, uint32_t place, uint32_t kind, const void *next, uint32_t *number);
/* The bytes of such a multi-set as its place decodes them, until the next one is numbered or looked at. NULL: no
 * memory. */
const unsigned char *ex_multiset_bytes(struct ex_worker *worker, uint32_t number, size_t *length);

/* --- successors (explore_successors.c) ---------------------------------------------------------------------------- */

/* Whether the net always does the same in a state: no files. */
bool ex_is_repeatable(void);
/* An arc: the binding, outputs of the code segment included, lives until the call returns. False: stop. */
typedef bool (*ex_arc_sink_t)(void *user, uint32_t transition, const void *binding, const ex_key_t *key);

typedef enum ex_found {
    EX_SOME,    /* at least one successor */
    EX_DEAD,    /* none, now and at any later time */
    EX_STOPPED, /* the sink said so */
    EX_FAILED   /* an inscription raised an exception, or memory is used up: worker->failed */
} ex_found_t;

/* Arcs from a state to one other by the same transition, so many at a time. False: stop. */
typedef bool (*ex_times_sink_t)(void *user, uint32_t transition, uint32_t times, const ex_key_t *key);

/* If the time is reduced: worker->marking, at the time 0, becomes the state that stands for all that are like it. */
void ex_reduce_time(struct ex_worker *worker);
/* All binding elements of the best priority that are enabled in the state, or at the next time at which there are any;
 * in the documented order. worker->marking is then the state at the time of these occurrences (pn_net.now). */
ex_found_t ex_successors(struct ex_worker *worker, const ex_key_t *key, ex_arc_sink_t sink, void *user);

/* The same for those who do not want to know the bindings, and faster (explore_local.c). Afterwards only packed places
 * of worker->marking are worth something; for the others there is ex_load_places. */
ex_found_t ex_arcs(struct ex_worker *worker, const ex_key_t *key, ex_times_sink_t sink, void *user);

/* As ex_arc_sink_t, with the marking that follows. */
typedef bool (*ex_marking_sink_t)(void *user, uint32_t transition, const void *binding, const void *next);
/* As ex_successors, of worker->marking, where nothing is reduced and there is no time. */
ex_found_t ex_next_markings(struct ex_worker *worker, ex_marking_sink_t sink, void *user);
/* All binding elements that are enabled in worker->marking now, whatever the reductions. */
ex_found_t ex_all_successors(struct ex_worker *worker, ex_marking_sink_t sink, void *user);

/* --- store (explore_store.c) -------------------------------------------------------------------------------------- */

/* The largest `low` of keys that are kept as one word. */
#define EX_MOST_WORD (UINT64_MAX >> 1U)

typedef struct ex_store {
    struct ex_run *run;
    bool is_word;          /* of keys of one word: see explore_words.h */
    unsigned char *bucket; /* lines of 64 bytes */
    uint64_t buckets;
    uint64_t limit;               /* keys from which on it ought to grow */
    uint32_t slots;               /* of a bucket */
    uint32_t length;              /* bytes of a key */
    uint32_t width[EX_KEY_WORDS]; /* bits of each word of a key that are kept */
    uint64_t low_mask;            /* the same as masks of ex_key_t */
    uint64_t high_mask;
    /* Written by all threads, in a cache line of its own: the rest is read with each insertion. */
    _Alignas(EX_CACHE_LINE) _Atomic uint64_t used; /* keys; exact while nobody inserts */
} ex_store_t;

typedef enum ex_insertion {
    EX_NEW,
    EX_KNOWN,
    EX_FULL /* nothing was done: it has to grow first (ex_pause) */
} ex_insertion_t;

/* `width`: bits of each word of a key. */
bool ex_store_make(ex_store_t *store, struct ex_run *run, const uint32_t width[EX_KEY_WORDS], uint64_t keys);
void ex_store_free(ex_store_t *store);
/* Makes room, and words of keys as wide as they have to be; does nothing when all is well. False when there is no
 * memory (the store stays as it was, or has lost keys: the run ends). Nobody else uses it. */
bool ex_store_grow(ex_store_t *store, const uint32_t width[EX_KEY_WORDS]);
uint64_t ex_store_bytes(const ex_store_t *store);

__extension__ typedef unsigned __int128 ex_wide_t;

/* Of a key of one word. */
static inline uint64_t ex_word_hash(uint64_t low)
{
    const ex_wide_t product = (ex_wide_t)(low ^ 0x9e3779b97f4a7c15U) * 0xe7037ed1a0b428dbU;
    return (uint64_t)product ^ (uint64_t)(product >> 64U);
}

static inline uint64_t ex_hash(const ex_key_t *key)
{
    if (key->high == 0U) {
        return ex_word_hash(key->low);
    }
    /* Product of 128 bits, folded, twice. */
    const ex_wide_t first = (ex_wide_t)(key->low ^ 0x9e3779b97f4a7c15U) * (key->high ^ 0xd6e8feb86659fd93U);
    const uint64_t folded = (uint64_t)first ^ (uint64_t)(first >> 64U) ^ key->low;
    const ex_wide_t second = (ex_wide_t)(folded ^ 0xa0761d6478bd642fU) * 0xe7037ed1a0b428dbU;
    return (uint64_t)second ^ (uint64_t)(second >> 64U);
}

/* Of a tuple of `lanes` lanes. */
static inline uint64_t ex_tuple_hash(const uint64_t *lane, uint32_t lanes)
{
    ex_key_t key = { lane[0], (lanes > 1U) ? lane[1] : 0U };
    if (lanes > 2U) {
        const uint64_t last = (lanes > 3U) ? lane[3] : 0U;
        const ex_wide_t more = (ex_wide_t)(lane[2] ^ 0x8ebc6af09c88c6e3U) * (last ^ 0x589965cc75374cc3U);
        key.low ^= (uint64_t)more;
        key.high += (uint64_t)(more >> 64U) ^ lane[2];
    }
    return ex_hash(&key);
}

/* A hash, scaled to 0 .. count - 1; in the same order. */
static inline uint64_t ex_scaled(uint64_t hash, uint64_t count)
{
    return (uint64_t)(((ex_wide_t)hash * count) >> 64U);
}

static inline void ex_store_prefetch(const ex_store_t *store, uint64_t hash)
{
    __builtin_prefetch(&store->bucket[ex_scaled(hash, store->buckets) * 64U], 1, 3);
}

/* For ex_tuples_number: its entry in the index is sent for; then, if it seems to be one, the tuple itself. */
static inline void ex_tuples_prefetch(const ex_tuples_t *tuples, uint64_t hash)
{
    __builtin_prefetch(&tuples->index.entry[ex_scaled(hash, tuples->index.entries)], 0, 3);
}

static inline void ex_tuples_send(const ex_tuples_t *tuples, uint64_t hash)
{
    const ex_index_t *const index = &tuples->index;
    const uint64_t entry = atomic_load_explicit(&index->entry[ex_scaled(hash, index->entries)], memory_order_relaxed);
    if ((uint32_t)(entry >> 32U) == (uint32_t)hash) {
        __builtin_prefetch(&tuples->lane[((uint64_t)(uint32_t)entry - 1U) * tuples->lanes], 0, 3);
    }
}

/* `hash` is ex_hash of the key. Threads may insert at the same time. `slot`: where it is, NULL if that is of no
 * interest. */
ex_insertion_t ex_store_insert(ex_store_t *store, const ex_key_t *key, uint64_t hash, uint64_t *slot);
/* The slot of a key, EX_NO_SLOT when it is not there. */
uint64_t ex_store_find(const ex_store_t *store, const ex_key_t *key, uint64_t hash);
/* Slots are 0 .. ex_store_slots - 1. */
uint64_t ex_store_slots(const ex_store_t *store);
/* The key in a slot; false when the slot is empty. */
bool ex_store_fetch(const ex_store_t *store, uint64_t slot, ex_key_t *key);

/* --- bit states (explore_bits.c) ---------------------------------------------------------------------------------- */

/* Three bits of a word for each state. */
typedef struct ex_bits {
    _Atomic uint64_t *word;
    uint64_t words;
    uint64_t bytes;
    _Atomic uint64_t inserted;
    pthread_mutex_t lock; /* of what follows */
    double expected;      /* states that have been missed, as far as estimated */
    double last;          /* probability that the next one is */
} ex_bits_t;

bool ex_bits_make(ex_bits_t *bits, struct ex_run *run);
/* `hash` has to be a good one, and is all that counts of a state. */
ex_insertion_t ex_bits_insert(ex_bits_t *bits, uint64_t hash);
bool ex_bits_hold(const ex_bits_t *bits, uint64_t hash);
/* The probability that at least one state was missed. */
double ex_bits_omission(ex_bits_t *bits);

static inline void ex_bits_prefetch(const ex_bits_t *bits, uint64_t hash)
{
    __builtin_prefetch(&bits->word[ex_scaled(hash, bits->words)], 1, 3);
}

/* --- the run ------------------------------------------------------------------------------------------------------ */

/* What one thread has. */
typedef struct ex_worker {
    _Alignas(EX_CACHE_LINE) struct ex_run *run; /* no line is shared with another one */
    uint32_t index;
    pn_ctx_t cx;
    void *marking;                    /* of the state last loaded */
    bool failed;                      /* an evaluation or an allocation has failed: see run->error, run->why */
    ex_scratch_t *scratch;            /* of the codec and the successors */
    struct ex_search *search;         /* of the search */
    struct ex_bounds *bounds;         /* of explore_bounds.c */
    struct ex_stubborn *stubborn;     /* of explore_stubborn.c */
    struct ex_persistent *persistent; /* of explore_dependency.c */
    struct ex_symmetry *symmetry;     /* of explore_symmetry.c */
    struct ex_early *early;           /* of explore_query_early.c */
    struct ex_local *local;           /* of explore_local.c; NULL: nothing is remembered */
    struct ex_wake *wake;             /* of explore_wake.c; NULL: nothing is remembered */
    bool has_waited;                  /* the time went on in ex_successors before something was enabled */
    int64_t
        elapsed; /* when the time is reduced: how much of it went by in ex_successors before something was enabled */
    /* Counted during the exploration. */
    uint64_t states; /* expanded */
    uint64_t arcs;
    uint64_t dead;
    uint64_t *fired;     /* by transition */
    uint64_t arena_most; /* bytes that a transition's bindings and one occurrence of it needed of the arena */
} ex_worker_t;

/* Around all that is done for the bindings and occurrences of a transition: what it leaves in the arena is forgotten,
 * how much that was is not. */
static inline size_t ex_arena_begin(ex_worker_t *worker)
{
    pn_arena_t *const arena = worker->cx.arena;
    arena->peak = arena->used;
    return pn_arena_mark(arena);
}

static inline void ex_arena_end(ex_worker_t *worker, size_t mark)
{
    const uint64_t most = worker->cx.arena->peak - mark;
    worker->arena_most = (most > worker->arena_most) ? most : worker->arena_most;
    pn_arena_release(worker->cx.arena, mark);
}

typedef struct ex_run {
    ex_options_t options;
    ex_codec_t *codec;
    ex_store_t store; /* of approximations: of hashes, or `used` alone */
    ex_bits_t bits;
    ex_worker_t *worker; /* options.threads of them */
    ex_key_t initial;
    double started;  /* seconds of the monotonic clock */
    _Atomic int why; /* ex_why_t: EX_COMPLETE until something has happened */
    _Atomic bool is_stopping;
    _Atomic bool is_pausing; /* a table has to grow: all threads are to come to ex_pause */
    pthread_mutex_t gate;    /* of what follows */
    pthread_cond_t gate_changed;
    uint32_t at_work;                          /* threads that may use the tables */
    uint32_t paused;                           /* of them, in ex_pause */
    uint64_t pauses;                           /* done */
    bool is_growing;                           /* one thread makes the tables grow */
    void (*shared)(void *user, uint32_t part); /* what those that wait can help with; NULL: nothing */
    void *shared_user;
    uint32_t shared_parts;
    uint32_t shared_taken; /* parts that have been begun */
    uint32_t shared_done;
    pthread_mutex_t error_lock;
    ex_error_t error; /* where why is EX_ERROR or EX_CAPACITY, or EX_MEMORY with a kind that is not NULL */
    _Atomic uint64_t memory_used;
    /* Results of the exploration. */
    uint64_t nodes;
    uint64_t arcs;
    uint64_t depth;
    uint64_t dead_count;
    uint64_t *fired; /* by transition */
    uint64_t expanded;
    double seconds; /* of the exploration, without the graph */
    double cpu_seconds;
    double omission_probability;
    uint64_t approximate_bytes; /* of what stands for the store */
    bool has_bounds;
    _Atomic int spill_error;        /* errno of a file of --spill that could not be had; 0: none */
    struct ex_level *level;         /* of explore_search.c */
    bool is_laid_again;             /* ex_layout_again has been done */
    struct ex_reduction *reduction; /* of explore_elements.c; NULL: none that needs a table */
    _Atomic(const char *) phase;    /* for the progress lines */
    const uint32_t
        *owner_of; /* by transition: whose it is; priorities count among those of one owner. NULL: among all */
    struct ex_programs *programs; /* how programs choose among what is enabled; NULL: nobody chooses */
    struct ex_graph *graph;       /* of explore_graph.c; NULL: none */
    bool is_seen_whole;           /* all states have been expanded, and none was taken for another one */
    bool has_arcs;                /* the graph of them has been made, with all arcs */
    bool has_components;          /* and gone through: components, home, liveness, fairness */
    struct ex_queries *queries;   /* of explore_query_read.c; NULL: nothing is asked */
    struct ex_raised *raised;     /* of explore_error.c; NULL: the way to the exception is not known */
} ex_run_t;

/* Waits until all threads are here, or idle, and one of them has made the tables grow. Asked for where a table is full;
 * a thread that works for long without asking looks at ex_is_pausing now and then. False: the run stops. */
bool ex_pause(ex_worker_t *worker);
static inline bool ex_is_pausing(const ex_run_t *run)
{
    return atomic_load_explicit(&run->is_pausing, memory_order_relaxed);
}
/* Does all parts of a work, which do not depend on each other: in a pause with the help of the threads that wait. */
void ex_together(ex_run_t *run, uint32_t parts, void (*one)(void *user, uint32_t part), void *user);
/* With the gate locked: waits until something changes that others broadcast, or helps while tables grow. */
void ex_wait(ex_run_t *run);
/* With the gate locked, when a thread has become idle: the pause may begin. */
void ex_check_pause(ex_run_t *run);
/* Notes why the run has to end, unless something more important is known, and makes all threads stop. */
void ex_stop(ex_run_t *run, ex_why_t why);
/* The same for the error in the worker's context. */
void ex_fail(ex_worker_t *worker, int64_t transition);
/* Another part of the work begins; the name is for the progress lines. */
void ex_phase(ex_run_t *run, const char *phase);
/* Whether the states are stored as they are. */
static inline bool ex_is_exact(const ex_run_t *run)
{
    return !run->options.is_bitstate && !run->options.is_hashed;
}
/* As the report has it. */
const char *ex_why_text(ex_why_t why);
/* Whether to stop: asked often (once in a few states or arcs), it looks at signals and, now and then, at the clock. */
static inline bool ex_is_stopping(const ex_run_t *run)
{
    return atomic_load_explicit(&run->is_stopping, memory_order_relaxed);
}
double ex_clock(void);
/* Calls `work` on each worker, in a thread of its own when there are several, and waits for all of them. */
void ex_parallel(ex_run_t *run, void (*work)(ex_worker_t *worker, void *user), void *user);

/* For the progress lines; about right while threads explore. */
typedef struct ex_progress {
    uint64_t states;
    uint64_t arcs;
    uint64_t frontier;
    uint64_t depth;
} ex_progress_t;
void ex_progress(ex_run_t *run, ex_progress_t *progress);

/* The exploration: fills the results. False when it could not begin. */
bool ex_explore(ex_run_t *run);

/* --- bounds (explore_bounds.c) ------------------------------------------------------------------------------------ */

typedef struct ex_bounds ex_bounds_t;
bool ex_bounds_make(ex_worker_t *worker);
/* Called once for each state, with worker->marking that of the state. */
void ex_bounds_see(ex_worker_t *worker);
/* After the exploration: ,"bounds": [...] as a member of the report. */
void ex_bounds_json(ex_run_t *run, FILE *out);

/* --- questions (explore_query_early.c) ---------------------------------------------------------------------------- */

/* Where questions are asked: a state has been expanded. */
void ex_early_see(ex_worker_t *worker, const ex_key_t *key, ex_found_t found);

/* --- graph (explore_graph.c) -------------------------------------------------------------------------------------- */

/* After a complete exploration with an exact store. False: there is no graph (no memory, stopped: run->why says so). */
bool ex_graph(ex_run_t *run);
/* Members of the report: "dead": [...], "graph": {...} or null, "traces": [...]; without a graph too. */
void ex_graph_json(ex_run_t *run, FILE *out);

#endif /* EXPLORE_IMPL_H */
