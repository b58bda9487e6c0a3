/* SPDX-License-Identifier: MIT
 * explore_query.h - questions about the state space: sets of nodes (*items*), and what is asked of them.
 *
 * A file of questions has one item or question on a line (explore_query_read.c); items are numbered from 0 and come
 * after those of which they are made. Items that look at one state only are *local*: a question about them may be
 * answered before everything is explored (explore_query_early.c). All others are worked out over the whole graph, in
 * time linear in it: CTL by going backwards (explore_ctl.c), runs that an automaton accepts by the components of the
 * product of graph and automaton (explore_ltl.c), the longest waits by going through the states in which one waits
 * (explore_response.c). What proves an answer is a way through the graph (explore_path.c).
 */
#ifndef EXPLORE_QUERY_H
#define EXPLORE_QUERY_H

#include "../graph/explore_graph.h"

typedef enum ex_item_kind {
    EX_ITEM_TRUE,
    EX_ITEM_DEAD,
    EX_ITEM_INITIAL,
    EX_ITEM_PRED,    /* predicate `number` of the net */
    EX_ITEM_ENABLED, /* an arc of transition `number` leaves the node */
    EX_ITEM_WITHIN,  /* place `number` has low .. high tokens */
    EX_ITEM_NOT,     /* of `a`, and so on */
    EX_ITEM_AND,
    EX_ITEM_OR,
    EX_ITEM_EX,
    EX_ITEM_AX,
    EX_ITEM_EF,
    EX_ITEM_AF,
    EX_ITEM_EG,
    EX_ITEM_AG,
    EX_ITEM_EU,
    EX_ITEM_AU,
    EX_ITEM_EXA /* an arc of transition `number` leads to a node of `a` */
} ex_item_kind_t;

#define EX_RAISED_SIZE 256U

typedef struct ex_item {
    ex_item_kind_t kind;
    uint32_t a;
    uint32_t b;
    uint32_t number;
    uint64_t low;
    uint64_t high;
    bool is_local;
    bool is_about_dead; /* it holds in all nodes that are not dead, by its form */
    bool is_nameless;   /* made of EX_ITEM_DEAD alone: no colour has a name in it */
    bool is_needed;
    bool is_early;      /* looked at during the exploration */
    uint64_t *set;      /* a bit for each node; NULL: not known. Of a part: those that are surely in it */
    uint64_t *may;      /* of a part: those that may be in it; else, and where that is the same, `set` */
    uint64_t most;      /* EX_ITEM_WITHIN: tokens */
    uint32_t raised_at; /* the first node in which a predicate of it raised an exception; EX_NO_NODE: none */
    char raised[EX_RAISED_SIZE];
} ex_item_t;

/* What happens in a run: a node of an item, or an arc of some transitions. */
typedef struct ex_event {
    bool is_transition;
    uint32_t number; /* of the item */
    uint64_t *of;    /* a bit for each transition */
} ex_event_t;

/* One condition of an arc of an automaton: whether the node is in an item. */
typedef struct ex_literal {
    uint32_t item;
    bool is_positive;
} ex_literal_t;

typedef struct ex_edge {
    uint32_t from;
    uint32_t to;
    uint32_t literals;
    ex_literal_t *literal;
    uint64_t *allowed; /* a bit for each transition, and one more for no arc at all at a dead node; NULL: all */
} ex_edge_t;

/* States of runs, which read the node where the run is and the arc that it takes next. */
typedef struct ex_automaton {
    uint32_t states;
    uint32_t initial;
    bool *is_accepting;
    uint32_t edges;
    ex_edge_t *edge; /* in the order of the states from which they go */
    uint32_t *first; /* of each state, and the end */
    uint32_t fair_count;
    uint32_t *fair; /* transitions for which fairness is assumed */
    bool *is_strong;
    uint32_t *fair_item; /* where they are enabled */
} ex_automaton_t;

/* A way through the graph: node[0] and, for step i from 1 on, the transition label[i] that leads to node[i]. */
typedef struct ex_path {
    uint32_t *node;
    uint16_t *label;
    uint64_t steps;
    uint64_t room;
    bool is_failed; /* no memory */
    int64_t loop;   /* steps before the cycle with which it ends; -1: there is none */
} ex_path_t;

typedef enum ex_question_kind {
    EX_ASK_INVARIANT, /* of item `a`; bounds of places are invariants too */
    EX_ASK_BOUND,
    EX_ASK_INITIALLY,
    EX_ASK_LASSO,
    EX_ASK_FIRINGS,
    EX_ASK_TIME,
    EX_ASK_FINITE,   /* of a supervisor: explore_control.c */
    EX_ASK_RESTLESS, /* of scripts: the same of their steps that take no time */
    EX_ASK_BOUNDED,
    EX_ASK_CONFLUENT, /* `a`: 0 the run of the documented order, 1 another one */
    EX_ASK_BLOCKING,
    EX_ASK_ENDS /* of a cell as it runs: explore_running.c */
} ex_question_kind_t;

typedef enum ex_answer { EX_UNKNOWN, EX_YES, EX_NO } ex_answer_t;

/* A number of an answer. */
typedef enum ex_value_kind { EX_NO_VALUE, EX_INTEGER, EX_REAL } ex_value_kind_t;

typedef struct ex_question {
    ex_question_kind_t kind;
    uint32_t a;
    ex_event_t first;
    ex_event_t second;
    bool has_item; /* `a` is one */
    bool has_most; /* a limit of the wait */
    double most;
    uint64_t low; /* of a bound */
    uint64_t high;
    ex_automaton_t *automaton;
    bool is_of_orders; /* asked of the graph in which programs choose anything: answered where they never choose */
    _Atomic bool is_decided; /* during the exploration: a state has been seen that decides it */
    _Atomic bool is_raised;  /* by an exception, as far as is known */
    char message[EX_RAISED_SIZE];
    /* The answer. */
    ex_answer_t answer;
    const char *why; /* NULL: no reason is needed */
    uint32_t node;   /* EX_NO_NODE: none */
    ex_path_t path;  /* node NULL: none */
    int64_t steps;   /* of the trace; -1: there is none */
    ex_value_kind_t value_kind;
    double value;
} ex_question_t;

typedef struct ex_queries {
    ex_run_t *run;
    uint32_t items;
    ex_item_t *item;
    uint32_t questions;
    ex_question_t *question;
    bool asks_orders;   /* there are questions that are answered only where programs never choose */
    bool is_part;       /* the graph is a part of the whole one: a run in it is certain, that there is none is not */
    bool needs_enabled; /* what is enabled in a state may decide a question */
    bool has_avoid;     /* states of item `avoid` are not expanded */
    bool has_seek;      /* the exploration ends at a dead state of item `seek` */
    uint32_t avoid;
    uint32_t seek;
    _Atomic uint32_t open;       /* questions that no state has decided; those that no single state can decide count */
    _Atomic uint32_t open_early; /* without those */
    pthread_mutex_t lock;
    uint32_t *owner;            /* by transition; 0: the supervisor's. NULL: not told */
    struct ex_control *control; /* of explore_control.c */
    uint64_t *in_row;           /* arcs backwards: those to node i are in_source[in_row[i]] .. */
    uint32_t *in_source;
} ex_queries_t;

/* The set of a needed item. */
static inline bool ex_is_in(const ex_queries_t *queries, uint32_t item, uint32_t node)
{
    return EX_BIT(queries->item[item].set, node) != 0U;
}

/* Whether a node is known to be in a needed item, or is known not to be. */
static inline bool ex_is_known(const ex_queries_t *queries, uint32_t item, uint32_t node, bool is_positive)
{
    return is_positive ? ex_is_in(queries, item, node) : (EX_BIT(queries->item[item].may, node) == 0U);
}

static inline uint64_t ex_set_words(const ex_graph_t *graph)
{
    return ((uint64_t)graph->nodes + 63U) / 64U;
}

/* A set for all nodes, empty. NULL: no memory. */
uint64_t *ex_set(const ex_queries_t *queries);

/* --- explore_query_read.c --- */

/* Reads run->options.queries. False: what is wrong has been said. */
bool ex_queries_read(ex_run_t *run);

/* --- explore_query_early.c --- */

bool ex_early_make(ex_worker_t *worker);
/* Without the whole graph: what has been decided, with the way there. */
void ex_early_answer(ex_run_t *run);
/* After the graph has left a question open (there was no time, or no memory): what was seen of the states while they
 * were explored. */
void ex_early_conclude(const ex_run_t *run, ex_question_t *question);
/* For a report before the questions have been answered: what there is to say of one if the time is over now. */
void ex_early_expect(const ex_run_t *run, ex_question_t *question);

/* --- explore_query.c --- */

/* After the exploration: answers all questions, writes traces. */
void ex_queries_answer(ex_run_t *run);
/* Calls `visit` for each node, by all threads; false: it said so, or the run stops. */
typedef bool (*ex_visit_t)(ex_worker_t *worker, void *user, uint32_t node, const ex_key_t *key);
bool ex_each_node(ex_queries_t *queries, ex_visit_t visit, void *user);
/* Whether predicate `item` (EX_ITEM_PRED) or EX_ITEM_WITHIN holds in worker->marking; false with *raised set: an
 * exception, for which the worker's context has the name until the next call. */
bool ex_leaf_holds(ex_worker_t *worker, const ex_item_t *item, uint64_t *tokens, bool *raised);
/* The question cannot be answered: the reason is that of the run, or there is no memory. */
void ex_doubt(const ex_run_t *run, ex_question_t *question);
/* Whether the reductions that are used keep the answer. */
bool ex_is_kept(const ex_queries_t *queries, const ex_question_t *question);

/* --- explore_query_report.c --- */

/* Member of the report: ,"queries": [...]; nothing if there are none. `is_early`: they have not been answered. */
void ex_queries_json(const ex_run_t *run, bool is_early, FILE *out);

/* --- explore_ctl.c --- */

/* The set of an item whose operands' sets are there; of a part both sets. False: no memory, or told to stop. */
bool ex_ctl(ex_queries_t *queries, ex_item_t *item);
/* As far as one way shows it, why `item` holds at a node (or does not): added to a way that ends in this node. */
bool ex_ctl_explain(ex_queries_t *queries, uint32_t item, bool holds, ex_path_t *path);

/* --- explore_ltl.c --- */

/* Whether a run from `start` is accepted; if so, it is added to the way, which ends in `start`. */
ex_answer_t ex_lasso(ex_queries_t *queries, const ex_automaton_t *automaton, uint32_t start, ex_path_t *path);

/* --- explore_response.c --- */

void ex_response(ex_queries_t *queries, ex_question_t *question);

/* --- explore_control.c --- */

/* Answers a question about a supervisor. False: no memory, or told to stop. */
bool ex_control(ex_queries_t *queries, ex_question_t *question);

/* --- explore_running.c --- */

/* Whether a cell comes to its end. False: no memory, or told to stop. */
bool ex_running(ex_queries_t *queries, ex_question_t *question);

/* --- explore_path.c --- */

bool ex_path_begin(ex_path_t *path, uint32_t node);
void ex_path_step(ex_path_t *path, uint16_t label, uint32_t node);
static inline uint32_t ex_path_end(const ex_path_t *path)
{
    return path->node[path->steps];
}
/* Adds a shortest way from the initial node. `way` ends there. */
void ex_path_from_start(const ex_graph_t *graph, uint32_t node, ex_path_t *path);
/* Adds a shortest way from its end to a node of `goal` (the end itself may be one) on which all nodes before that are
 * in `through` (NULL: any). False: there is none, or no memory. */
bool ex_path_search(ex_queries_t *queries, const uint64_t *through, const uint64_t *goal, ex_path_t *path);
/* Adds an arc from its end to `node`, of a transition (UINT32_MAX: any). */
bool ex_path_arc(const ex_graph_t *graph, uint32_t label, uint32_t node, ex_path_t *path);

#endif /* EXPLORE_QUERY_H */
