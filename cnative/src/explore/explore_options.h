/* SPDX-License-Identifier: MIT
 * explore_options.h - what the explorer was asked for, and how it ended.
 */
#ifndef EXPLORE_OPTIONS_H
#define EXPLORE_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#define EX_MOST_THREADS 64U
#define EX_MOST_OWNERS  256U

typedef struct ex_options {
    bool is_depth_first;
    uint32_t threads;
    uint64_t max_states; /* UINT64_MAX: no limit; so the others */
    double max_seconds;  /* 0: no limit */
    double late_seconds; /* when nothing more is worked out about what was seen; 0: a tenth and a second later */
    uint64_t memory;     /* bytes */
    uint64_t arena;      /* bytes of each thread, for lists and strings */
    uint64_t seed;
    uint64_t shuffle;   /* the order of successors, depth first: 0 as they are found, 1 the other way round, others by
                         chance */
    uint64_t swarm;     /* seed of one of many searches: of its hash, of its walks (explore_swarm.c); 0: it is none */
    bool is_walk;       /* it goes from the initial state on at random */
    uint64_t max_depth; /* of it: most steps of a way */
    uint64_t sketch;    /* of it: hashes of markings that it tells */
    const char
        *ending;   /* of it: questions that end it when they are decided, numbers with commas between; NULL: none */
    bool is_still; /* traces say that random numbers are the same at each step */
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
    const char *instances;   /* file: the parts that symmetry exchanges; NULL: it is of colours */
    const char *dependency;  /* file: the table that partial order needs where there is no such table */
    const char *turns;       /* file: the table by which programs take turns; NULL: they do not */
    const char *counts;      /* file: the places whose tokens are counted up to a limit only; NULL: there are none */
    const char *sweep;       /* file: the weights by which states are swept; NULL: they are not */
    bool is_forgetful;       /* of it: after each measure all is forgotten that can be */
    const char *spill;       /* folder; NULL: none */
    const char *write_graph; /* file; NULL: none */
    bool writes_part;        /* also of a part of the graph, where a limit was reached */
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
    const char *late_in; /* the same of the time that is left then; NULL: none */
    uint64_t multiset_limit; /* colours of a multi-set bound that are printed */
    const char *whole;       /* places of which all are, numbers with commas between; NULL: none */
    const char *bindings;    /* transitions of which all bindings are, likewise; NULL: none */
    const char *heaps;       /* places that need not hold more tokens than `most_heaped`, as in `whole`; NULL: none */
    uint64_t most_heaped;
    uint64_t parent; /* process that started it, and without which it is to end; 0: none */
} ex_options_t;

/* Whether a number is in an option that is numbers with commas between; NULL has none. */
bool ex_is_listed(const char *list, uint32_t number);

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
    /* "capacity": of the place; "heap": it has more than `most_heaped`; "memory": of lists and strings; "exception" */
    const char *kind;
    int64_t place;      /* index, -1: none */
    int64_t transition; /* index, -1: none */
} ex_error_t;

#endif /* EXPLORE_OPTIONS_H */
