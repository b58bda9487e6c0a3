/* SPDX-License-Identifier: MIT
 * explore_impl.h - what the parts of the explorer share.
 *
 * A marking is made into a *vector* of words (explore_codec.c) and a vector into a *key* of at most 16 bytes: the bytes of the vector
 * themselves when they are few enough, else the two numbers at the root of its tree of pairs (explore_tree.c). Equal markings, equal
 * keys; a key can be made into a marking again. The store (explore_store.c) is a set of keys. Its slots are numbered; a key stays in its
 * slot unless the store grows, which happens during the exploration only (explore_search.c). After a complete exploration the graph phase
 * (explore_graph.c) goes through the slots, makes the successors of each key once more and looks up their slots.
 */
#ifndef EXPLORE_IMPL_H
#define EXPLORE_IMPL_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>

#include "pn/pn_net.h"

#define EX_NO_SLOT UINT64_MAX

typedef struct ex_options {
    bool is_depth_first;
    uint32_t threads;
    uint64_t max_states;   /* UINT64_MAX: no limit; so the others */
    double max_seconds;    /* 0: no limit */
    uint64_t memory;       /* bytes */
    uint64_t arena;        /* bytes of each thread, for lists and strings */
    uint64_t seed;
    bool has_graph;        /* wanted */
    bool is_bitstate;
    bool is_hashed;        /* hash compaction */
    bool shows_progress;
    bool shows_help;
    const char *spill;       /* folder; NULL: none */
    const char *write_graph; /* file; NULL: none */
    const char *trace_to;    /* folder; NULL: none */
    uint64_t dead_limit;
} ex_options_t;

/* Why it ended, in the order of importance. */
typedef enum ex_why {
    EX_COMPLETE,
    EX_STATES,
    EX_SECONDS,
    EX_MEMORY,
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

/* A state as it is stored: `length` bytes (ex_store_t.length), the rest zero. */
typedef struct ex_key {
    uint64_t low;
    uint64_t high;
} ex_key_t;

struct ex_run;
struct ex_worker;

/* --- memory (explore_memory.c) ------------------------------------------------------------------------------------- */

/* Zeroed memory, page-aligned; counted, refused (NULL) beyond the limit of --memory. With --spill it lies in a file. Pages that are
 * never touched cost nothing but count. Large blocks get huge pages. Thread-safe. */
void *ex_alloc(struct ex_run *run, uint64_t size);
void ex_free(struct ex_run *run, void *memory, uint64_t size);
/* Whether so much could be had now. */
bool ex_has_room(const struct ex_run *run, uint64_t size);
/* Gives back the pages of a part of a block that is going to be freed: it counts no longer. */
void ex_discard(struct ex_run *run, void *memory, uint64_t size);

/* --- codec (explore_codec.c) --------------------------------------------------------------------------------------- */

/* The shape of the vectors: found once, from the tables of the net. */
struct ex_codec;
bool ex_codec_make(struct ex_run *run);
/* Bytes of the tables of interned places and of pairs. */
uint64_t ex_codec_bytes(const struct ex_run *run);

/* The key of a marking; false after an error or when memory is used up (the worker's `failed` tells). */
bool ex_encode(struct ex_worker *worker, const void *marking, ex_key_t *key);
/* Makes worker->marking that of the key, at the time at which the state was created. False after an error. */
bool ex_load(struct ex_worker *worker, const ex_key_t *key);

/* --- successors (explore_successors.c) ----------------------------------------------------------------------------- */

/* An arc: the binding, outputs of the code segment included, lives until the call returns. False: stop. */
typedef bool (*ex_arc_sink_t)(void *user, uint32_t transition, const void *binding, const ex_key_t *key);

typedef enum ex_found {
    EX_SOME,    /* at least one successor */
    EX_DEAD,    /* none, now and at any later time */
    EX_STOPPED, /* the sink said so */
    EX_FAILED   /* an inscription raised an exception, or memory is used up: worker->failed */
} ex_found_t;

/* All binding elements of the best priority that are enabled in the state, or at the next time at which there are any; in the
 * documented order. worker->marking is then the state at the time of these occurrences (pn_net.now). */
ex_found_t ex_successors(struct ex_worker *worker, const ex_key_t *key, ex_arc_sink_t sink, void *user);

/* --- store (explore_store.c) --------------------------------------------------------------------------------------- */

typedef struct ex_store {
    struct ex_run *run;
    unsigned char *bucket;   /* lines of 64 bytes */
    uint64_t home_count;     /* buckets in which a key can be at home; some more follow for those that did not fit */
    uint64_t bucket_count;
    uint64_t limit;          /* keys from which on it ought to grow */
    uint32_t slots;          /* of a bucket */
    uint32_t length;         /* bytes of a key */
    uint64_t low_mask;       /* of ex_key_t: which bytes are part of a key */
    uint64_t high_mask;
    _Atomic uint64_t used;   /* keys; exact while nobody inserts */
} ex_store_t;

typedef enum ex_insertion {
    EX_NEW,
    EX_KNOWN,
    EX_FULL /* nothing was done: ex_store_grow first, while no other thread uses the store */
} ex_insertion_t;

bool ex_store_make(ex_store_t *store, struct ex_run *run, uint32_t length, uint64_t keys);
void ex_store_free(ex_store_t *store);
/* Makes room; false when there is no memory (the store stays as it was). */
bool ex_store_grow(ex_store_t *store);
uint64_t ex_store_bytes(const ex_store_t *store);

static inline uint64_t ex_hash(const ex_key_t *key)
{
    /* Product of 128 bits, folded, twice. */
    const __extension__ unsigned __int128 first =
        (__extension__ (unsigned __int128)(key->low ^ 0x9e3779b97f4a7c15U)) * (key->high ^ 0xd6e8feb86659fd93U);
    const uint64_t folded = (uint64_t)first ^ (uint64_t)(first >> 64U) ^ key->low;
    const __extension__ unsigned __int128 second =
        (__extension__ (unsigned __int128)(folded ^ 0xa0761d6478bd642fU)) * 0xe7037ed1a0b428dbU;
    return (uint64_t)second ^ (uint64_t)(second >> 64U);
}

static inline void ex_store_prefetch(const ex_store_t *store, uint64_t hash)
{
    const __extension__ unsigned __int128 product = (__extension__ (unsigned __int128)hash) * store->home_count;
    __builtin_prefetch(&store->bucket[(uint64_t)(product >> 64U) * 64U], 1, 3);
}

/* `hash` is ex_hash of the key. Threads may insert at the same time. `slot`: where it is, NULL if that is of no interest. */
ex_insertion_t ex_store_insert(ex_store_t *store, const ex_key_t *key, uint64_t hash, uint64_t *slot);
/* The slot of a key, EX_NO_SLOT when it is not there. */
uint64_t ex_store_find(const ex_store_t *store, const ex_key_t *key, uint64_t hash);
/* Slots are 0 .. ex_store_slots - 1. */
uint64_t ex_store_slots(const ex_store_t *store);
/* The key in a slot; false when the slot is empty. */
bool ex_store_fetch(const ex_store_t *store, uint64_t slot, ex_key_t *key);

/* --- the run ------------------------------------------------------------------------------------------------------- */

/* What one thread has. */
typedef struct ex_worker {
    struct ex_run *run;
    uint32_t index;
    pn_ctx_t cx;
    void *marking;           /* of the state last loaded */
    bool failed;             /* an evaluation or an allocation has failed: see run->error, run->why */
    struct ex_scratch *scratch; /* of the codec and the successors */
    struct ex_search *search;   /* of the search */
    struct ex_bounds *bounds;   /* of explore_bounds.c */
    /* Counted during the exploration. */
    uint64_t states;         /* expanded */
    uint64_t arcs;
    uint64_t dead;
    uint64_t *fired;         /* by transition */
} ex_worker_t;

typedef struct ex_run {
    ex_options_t options;
    struct ex_codec *codec;
    ex_store_t store;
    ex_worker_t *worker;     /* options.threads of them */
    ex_key_t initial;
    double started;          /* seconds of the monotonic clock */
    _Atomic int why;         /* ex_why_t: EX_COMPLETE until something has happened */
    _Atomic bool is_stopping;
    pthread_mutex_t error_lock;
    ex_error_t error;        /* where why is EX_ERROR or EX_CAPACITY, or EX_MEMORY with a kind that is not NULL */
    _Atomic uint64_t memory_used;
    /* Results of the exploration. */
    uint64_t nodes;
    uint64_t arcs;
    uint64_t depth;
    uint64_t dead_count;
    uint64_t *fired;         /* by transition */
    uint64_t expanded;
    double seconds;          /* of the exploration, without the graph */
    double cpu_seconds;
    double omission_probability;
    _Atomic(const char *) phase; /* for the progress lines */
    struct ex_graph *graph;  /* of explore_graph.c; NULL: none */
} ex_run_t;

/* Notes why the run has to end, unless something more important is known, and makes all threads stop. */
void ex_stop(ex_run_t *run, ex_why_t why);
/* The same for the error in the worker's context. */
void ex_fail(ex_worker_t *worker, int64_t transition);
/* Whether to stop: asked often (once in a few states or arcs), it looks at signals and, now and then, at the clock. */
static inline bool ex_is_stopping(const ex_run_t *run)
{
    return atomic_load_explicit(&run->is_stopping, memory_order_relaxed);
}
double ex_clock(void);
/* Calls `work` on each worker, in a thread of its own when there are several, and waits for all of them. */
void ex_parallel(ex_run_t *run, void (*work)(ex_worker_t *worker, void *user), void *user);

/* The exploration: fills the results. False when it could not begin. */
bool ex_explore(ex_run_t *run);

/* --- bounds (explore_bounds.c) ------------------------------------------------------------------------------------- */

bool ex_bounds_make(ex_worker_t *worker);
/* Called once for each state, with worker->marking that of the state. */
void ex_bounds_see(ex_worker_t *worker);
/* After the exploration: ,"bounds": [...] as a member of the report. */
void ex_bounds_json(ex_run_t *run, FILE *out);

/* --- graph (explore_graph.c) --------------------------------------------------------------------------------------- */

/* After a complete exploration with an exact store. False: there is no graph (no memory, stopped: run->why says so). */
bool ex_graph(ex_run_t *run);
/* Members of the report: "dead": [...], "graph": {...} or null, "traces": [...]; without a graph too. */
void ex_graph_json(ex_run_t *run, FILE *out);

#endif /* EXPLORE_IMPL_H */
