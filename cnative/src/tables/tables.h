/* SPDX-License-Identifier: MIT
 * tables.h - place/transition nets as tables, for questions that are asked once: nothing is generated, nothing is
 * compiled.
 *
 * A net is read from text (tables_read.c), a cursor stands in one of its markings and knows what is enabled there
 * (tables_cursor.c), a store keeps markings as packed words (tables_store.c). Everything else is a method that answers
 * questions with these three.
 */
#ifndef PN_TABLES_H
#define PN_TABLES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef uint32_t tb_count_t; /* tokens in a place */

#define TB_MOST_TOKENS ((tb_count_t)1 << 30U)

/* One arc, from the side of a place or of a transition, or how much a transition changes a place (put minus taken,
 * never 0). */
typedef struct tb_arc {
    uint32_t node; /* the other end */
    int32_t weight;
} tb_arc_t;

/* Arcs of all nodes of a kind, one node after the other: those of node n are arc[first[n]] to arc[first[n + 1] - 1]. */
typedef struct tb_arcs {
    uint32_t *first;
    tb_arc_t *arc;
} tb_arcs_t;

typedef struct tb_net {
    uint32_t places;
    uint32_t transitions;
    tb_count_t *initial;
    tb_arcs_t takes;    /* transition -> places */
    tb_arcs_t puts;     /* transition -> places */
    tb_arcs_t changes;  /* transition -> places */
    tb_arcs_t takers;   /* place -> transitions that need tokens there */
    tb_arcs_t changers; /* place -> transitions that change it */
} tb_net_t;

/* --- questions ---------------------------------------------------------------------------------------------------- */

typedef enum tb_op {
    TB_TRUE,
    TB_FALSE,
    TB_NOT,
    TB_AND,
    TB_OR,
    TB_SUM,     /* the sum of coefficient * tokens is at most `limit` */
    TB_ENABLED, /* one of the transitions is enabled */
    TB_DEAD,    /* none is */
    TB_EX,
    TB_AX,
    TB_EF,
    TB_AF,
    TB_EG,
    TB_AG,
    TB_EU,
    TB_AU
} tb_op_t;

typedef struct tb_term {
    uint32_t place;
    int64_t factor;
} tb_term_t;

/* A formula as a tree. */
typedef struct tb_formula {
    tb_op_t op;
    uint32_t count;           /* of parts, terms or transitions */
    struct tb_formula **part; /* NOT, AND, OR and the operators of time */
    tb_term_t *term;          /* SUM */
    uint32_t *transition;     /* ENABLED */
    uint64_t *is_one;         /* ENABLED: a bit for each transition of the net, whether it is one; NULL: they are few */
    int64_t limit;            /* SUM */
    uint32_t number;          /* among all formulas of its question, children first */
    bool is_temporal;         /* an operator of time is in it */
} tb_formula_t;

typedef enum tb_kind {
    TB_REACH, /* is a marking reachable in which the formula is true? */
    TB_BOUND, /* the most tokens that the places of a sum hold together */
    TB_CTL,   /* does the formula hold in the initial marking? */
    TB_LTL    /* does the automaton accept a run? one that ends in a dead marking stays there */
} tb_kind_t;

/* An arc of a Buechi automaton: where the atoms have these values it may go to `target`. */
typedef struct tb_move {
    uint32_t target;
    uint64_t is_true;  /* bits: atoms that must be true */
    uint64_t is_false; /* bits: atoms that must be false */
} tb_move_t;

/* State 0 is the initial one. */
typedef struct tb_automaton {
    uint32_t atoms;
    tb_formula_t **atom;
    uint32_t states;
    bool *is_accepting;
    uint32_t *first; /* state -> its moves */
    tb_move_t *move;
} tb_automaton_t;

enum {
    TB_MOST_ATOMS = 63,
    TB_FEW = 256 /* transitions of which one is enabled; of more, not all are looked at */
};

typedef enum tb_answer { TB_UNKNOWN, TB_NO, TB_YES } tb_answer_t;

typedef struct tb_question {
    tb_kind_t kind;
    uint32_t number;          /* as the asker counts */
    tb_formula_t *formula;    /* REACH, CTL; BOUND: a SUM whose limit does not count */
    tb_automaton_t automaton; /* LTL */
    uint32_t formulas;        /* numbers given in `formula` */
    tb_answer_t answer;
    int64_t least;   /* BOUND: seen */
    uint32_t *guide; /* transition -> how often it may occur on the way; NULL: nobody has a guess */
} tb_question_t;

typedef struct tb_job {
    tb_net_t net;
    tb_question_t *question;
    uint32_t questions;
    uint32_t *order;  /* all places, from the top of a diagram downwards; NULL: none is given */
    uint32_t *leaves; /* place -> places that share its tokens in each possible way, for `sizes`; NULL: one each */
    uint32_t **exact; /* place -> NULL, or how many values it may have, and leaves by value; NULL: there is none */
} tb_job_t;

/* Read a job from a file; an error ends the program with a message. */
void tb_read(tb_job_t *job, const char *path);

/* --- memory and time ---------------------------------------------------------------------------------------------- */

/* Zeroed memory; the program ends with exit code 4 when the limit is met. */
void *tb_new(size_t count, size_t size);
void *tb_grown(void *old, size_t old_count, size_t count, size_t size);
void tb_free(void *memory, size_t count, size_t size);
void tb_limit_memory(uint64_t bytes);
bool tb_has_room(uint64_t bytes);
void tb_start_clock(double seconds);
double tb_elapsed(void);
bool tb_is_over(void);            /* looks at the clock once in some thousand calls */
void tb_limit_time(double until); /* seconds since tb_start_clock */
_Noreturn void tb_fail(int code, const char *format, ...) __attribute__((format(printf, 2, 3)));

enum { TB_EXIT_WRONG = 2, TB_EXIT_TIME = 3, TB_EXIT_MEMORY = 4 };

/* --- a place in the state space ----------------------------------------------------------------------------------- */

/* A marking, and what is enabled in it; kept up to date by differences. */
typedef struct tb_cursor {
    const tb_net_t *net;
    tb_count_t *marking;
    uint32_t *missing;  /* transition -> input places with too few tokens */
    uint32_t *enabled;  /* in no special order */
    uint32_t *position; /* transition -> its index in `enabled`, or UINT32_MAX */
    uint32_t enabled_count;
} tb_cursor_t;

void tb_cursor_init(tb_cursor_t *c, const tb_net_t *net);
void tb_cursor_free(tb_cursor_t *c);
void tb_set(tb_cursor_t *c, uint32_t place, tb_count_t tokens);
void tb_go_to(tb_cursor_t *c, const tb_count_t *marking);

/* False: a place would hold more than TB_MOST_TOKENS; nothing has changed. */
bool tb_fire(tb_cursor_t *c, uint32_t transition);
void tb_unfire(tb_cursor_t *c, uint32_t transition);
/* The same of the marking alone: what is enabled stays as it was, so that it costs little where a place has many
   takers. */
bool tb_move(tb_cursor_t *c, uint32_t transition);
void tb_unmove(tb_cursor_t *c, uint32_t transition);

static inline bool tb_is_enabled(const tb_cursor_t *c, uint32_t transition)
{
    return c->missing[transition] == 0U;
}

/* The value of a formula without operators of time. */
bool tb_holds(const tb_formula_t *f, const tb_cursor_t *c);
/* A guess how much is missing until the formula is as wanted; 0 if it is, and has no operator of time. */
double tb_distance(const tb_formula_t *f, const tb_cursor_t *c, bool wanted);

/* Whether it depends on how many transitions are enabled. */
bool tb_counts_enabled(const tb_formula_t *f);
int64_t tb_sum(const tb_formula_t *sum, const tb_count_t *marking);

/* --- known markings ----------------------------------------------------------------------------------------------- */

typedef struct tb_store {
    uint32_t places;
    uint8_t *width; /* place -> bits */
    uint32_t *at;   /* place -> first bit; a place lies within one word */
    uint32_t words; /* of a record */
    uint64_t *record;
    uint64_t records;
    uint64_t room;    /* records that fit */
    uint32_t *slot;   /* hash -> record + 1 */
    uint64_t slots;   /* a power of two */
    uint64_t *packed; /* one record, in the making */
} tb_store_t;

/* `most`: for each place a bound that is known, or 0. */
void tb_store_init(tb_store_t *s, const tb_net_t *net, const tb_count_t *most);
void tb_store_free(tb_store_t *s);

typedef enum tb_added { TB_ADDED, TB_KNOWN, TB_FULL } tb_added_t;

/* The number of a marking; a new one is the next number. TB_FULL: there is no room for it. */
tb_added_t tb_store_add(tb_store_t *s, const tb_count_t *marking, uint32_t *number);
void tb_store_get(const tb_store_t *s, uint32_t number, tb_count_t *marking);

/* --- the state space, as far as it is needed ---------------------------------------------------------------------- */

/* Markings by number with their successors, which are looked up when they are first asked for (tables_graph.c). */
typedef struct tb_graph {
    const tb_net_t *net;
    tb_store_t store;
    tb_cursor_t cursor;
    uint64_t *first; /* marking -> index of its first successor + 1; 0: not looked up */
    uint32_t *count; /* marking -> successors, each once */
    uint64_t room;   /* markings for which there are entries */
    uint32_t *successor;
    uint64_t successors;
    uint64_t successor_room;
    uint32_t at; /* the marking at the cursor */
    tb_count_t *marking;
    uint32_t *fire;
    uint64_t random;  /* state of the numbers drawn for the order of successors; 0: none are */
    uint32_t *rank;   /* transition -> its place in an order that is the same everywhere; NULL: there is none */
    uint32_t *ranked; /* that order */
    bool is_full;     /* memory is exhausted, a place is, or the time is over: successors are missing */
} tb_graph_t;

/* `seed`: from 1 on another order of the successors each. That of the first one is as they come, those of even ones are
 * the same in all markings. */
void tb_graph_init(tb_graph_t *g, const tb_net_t *net, uint64_t seed);
void tb_graph_free(tb_graph_t *g);

/* Look up the successors of a marking; false: not all of them can be had (g->is_full from then on). */
bool tb_expand(tb_graph_t *g, uint32_t marking);

/* Move the cursor to a marking. */
void tb_visit(tb_graph_t *g, uint32_t marking);

static inline uint32_t tb_successor(const tb_graph_t *g, uint32_t marking, uint32_t which)
{
    return g->successor[g->first[marking] - 1U + which];
}

/* --- markings that wait ------------------------------------------------------------------------------------------- */

typedef struct tb_waiting {
    double distance;
    uint32_t number;
} tb_waiting_t;

/* The nearest first, and of equal ones the one with the lowest number. All zero: empty. */
typedef struct tb_heap {
    tb_waiting_t *item;
    uint32_t count;
    uint32_t room;
} tb_heap_t;

void tb_heap_free(tb_heap_t *h);
void tb_heap_push(tb_heap_t *h, double distance, uint32_t number);
uint32_t tb_heap_pop(tb_heap_t *h);

/* --- stubborn sets ------------------------------------------------------------------------------------------------ */

/* What has to be looked at in a marking, so that no marking is missed in which a formula is true (tables_stubborn.c).
 */
typedef struct tb_stubborn {
    const tb_net_t *net;
    uint32_t *is_in; /* transition -> the number of the set it was last in */
    uint32_t set;
    uint32_t *todo;
    uint32_t todo_count;
} tb_stubborn_t;

void tb_stubborn_init(tb_stubborn_t *s, const tb_net_t *net);
void tb_stubborn_free(tb_stubborn_t *s);

/* The enabled transitions that suffice, in `fire`; how many. `f` is not as wanted here; NULL with `sum`: it is to
 * become larger. */
uint32_t tb_stubborn(tb_stubborn_t *s, const tb_cursor_t *c, const tb_formula_t *f, const tb_formula_t *sum,
                     uint32_t *fire);

/* --- answers ------------------------------------------------------------------------------------------------------ */

/* Print an answer at once, so that it is known even if the program is ended in the next moment. */
void tb_say(tb_question_t *q, tb_answer_t answer, const char *method);
void tb_say_bound(tb_question_t *q, int64_t bound, bool is_exact, const char *method);
void tb_say_run(const tb_question_t *q, const uint32_t *step, uint32_t steps);

/* --- methods ------------------------------------------------------------------------------------------------------ */

void tb_walk(tb_job_t *job, uint64_t seed, double seconds, bool is_told);
void tb_explore(tb_job_t *job, bool count);
void tb_reach(tb_job_t *job, double each, bool is_told);
void tb_ctl(tb_job_t *job, uint64_t seed, double seconds);
/* With seeds above 4 a run is hunted for first (tables_ltl_hunt.c). */
void tb_ltl(tb_job_t *job, uint64_t seed, double seconds);
/* Formulas of branching time are looked at nearby first if the seed is odd, and in all markings first if it is even. */
void tb_diagrams(tb_job_t *job, bool is_sizes, uint64_t seed, double seconds, double patience); /* symbolic/ */

#endif
