/* SPDX-License-Identifier: MIT
 * explore_run.h - a run: what its threads share, and what each has for itself (explore_run.c).
 */
#ifndef EXPLORE_RUN_H
#define EXPLORE_RUN_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include "explore_options.h"
#include "query/explore_programs.h"
#include "state/explore_codec.h"
#include "store/explore_bits.h"
#include "store/explore_store.h"
#include "pn/pn_arena.h"
#include "pn/pn_marking.h"
#include "pn/pn_net.h"

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
    struct ex_exchange *exchange;     /* of explore_instances.c */
    struct ex_turns *turns;           /* of explore_turns.c */
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
    ex_memory_t memory;
    ex_team_t team;
    ex_codec_t *codec;
    ex_store_t store; /* of approximations: of hashes, or `used` alone */
    ex_bits_t bits;
    ex_worker_t *worker; /* options.threads of them */
    ex_worker_t
        *teller; /* one more that explores nothing, to measure what telling takes; NULL: there is all the time */
    _Atomic double telling; /* seconds for one multi-set; 0: not known, or too few to count */
    _Atomic double seeing;  /* the same for a state that has not been expanded */
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
    struct ex_level *level;         /* of explore_search.c */
    _Atomic bool has_begun;         /* the search: what is atomic in level and store may be read by other threads */
    bool is_laid_again;             /* ex_layout_again has been done */
    struct ex_reduction *reduction; /* of explore_elements.c; NULL: none that needs a table */
    _Atomic(const char *) phase;    /* for the progress lines */
    const uint32_t
        *owner_of; /* by transition: whose it is; priorities count among those of one owner. NULL: among all */
    struct ex_programs *programs; /* how programs choose among what is enabled; NULL: nobody chooses */
    bool has_turns;               /* in a state only some owners are looked at (explore_turns.c) */
    struct ex_counts *counts;     /* of explore_counts.c; NULL: all tokens are counted */
    bool seeks_choice;            /* now it is looked whether programs ever do the first of several (`first`) */
    _Atomic bool has_choice;      /* they do, or it is not known */
    bool is_choiceless;           /* it has been looked in all states, and they never do: all orders are one */
    struct ex_graph *graph;       /* of explore_graph.c; NULL: none */
    struct ex_bindings *bindings; /* of explore_bindings.c; NULL: none are told */
    _Atomic bool has_avoided;     /* states have not been expanded, as was asked for */
    bool is_searched;             /* the search has come to its end: no state is left that was not expanded */
    bool is_seen_whole;           /* all states have been expanded, and none was taken for another one */
    bool has_arcs;                /* the graph of them has been made, with all arcs */
    bool has_components;          /* and gone through: components, home, liveness, fairness */
    struct ex_queries *queries;   /* of explore_query_read.c; NULL: nothing is asked */
    struct ex_swarm *swarm;       /* of explore_swarm.c; NULL: it is not one of many searches */
    struct ex_sweep *sweep;       /* of explore_sweep.c; NULL: nothing is forgotten */
    ex_key_t turned;              /* the seed of what is kept of a state by approximations */
    struct ex_raised *raised;     /* of explore_error.c; NULL: the way to the exception is not known */
} ex_run_t;

/* Waits until all threads are here, or idle, and one of them has made the tables grow. Asked for where a table is full;
 * a thread that works for long without asking looks at ex_is_pausing now and then. False: the run stops. */
bool ex_pause(ex_worker_t *worker);
static inline bool ex_is_pausing(const ex_run_t *run)
{
    return atomic_load_explicit(&run->is_pausing, memory_order_relaxed);
}
/* Memory and team of a run of which the options are known. In a pause the threads that wait help with the parts. */
void ex_equip(ex_run_t *run);
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
double ex_clock(void);
/* Seconds of processor time that all threads have used. */
double ex_cpu_clock(void);
/* Seconds from the start after which nothing more is worked out about what was seen, where there is a limit of time. */
static inline double ex_late_seconds(const ex_run_t *run)
{
    return (run->options.late_seconds > 0.0) ? run->options.late_seconds : ((run->options.max_seconds * 1.1) + 1.0);
}
/* The time was over some time ago: what is left to look at may be as much as all that was explored. */
static inline bool ex_is_late(const ex_run_t *run)
{
    return (run->options.max_seconds > 0.0) && ((ex_clock() - run->started) > ex_late_seconds(run));
}
/* Whether the store has keys of one word. */
static inline bool ex_has_words(const ex_run_t *run)
{
    return (run->codec != NULL) && run->codec->is_word && !run->options.is_hashed;
}
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
/* After it: the states that were found and not expanded belong to the bounds, too. False: there is no time for it. */
bool ex_see_rest(ex_run_t *run);
/* While all threads pause: seconds that one of them takes, of so many at most; 0: there is none to be seen. */
double ex_rest_measure(ex_worker_t *teller, uint32_t most);

#endif /* EXPLORE_RUN_H */
