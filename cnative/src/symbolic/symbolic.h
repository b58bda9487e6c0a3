/* SPDX-License-Identifier: MIT
 * symbolic.h - sets of markings as decision diagrams.
 *
 * A node stands at the level of a place and has an edge for each number of tokens with which something follows. Levels
 * that an edge leaves out hold no tokens, so that places without tokens cost nothing: multi-valued diagrams, reduced as
 * zero-suppressed ones are (Minato 1993). Nodes that are equal are one node; a set is equal to another if its node is.
 *
 * Nodes are never given back: when there is no room for more of them, the program ends, and what it has said stands.
 */
#ifndef PN_SYMBOLIC_H
#define PN_SYMBOLIC_H

#include "../tables/tables.h"

#include <setjmp.h>

typedef uint32_t sy_node_t; /* a node: its index in the pool */
typedef uint32_t sy_path_t; /* the places that a transition looks at or changes, from one of them downwards */

enum {
    SY_NONE = 0, /* no marking */
    SY_UNIT = 1, /* the marking without tokens, at the levels that are left */
    SY_ANY = 2,  /* all markings; as a limit only */
    SY_END = 0   /* the empty path */
};

/* What a cached result is the result of; sums have numbers of their own from SY_SUM on. */
typedef enum sy_op {
    SY_UNION = 1,
    SY_INTERSECTION,
    SY_DIFFERENCE,
    SY_PLAIN,
    SY_WITHOUT,
    SY_SATURATION = 8,
    SY_SUM = 32
} sy_op_t;

typedef struct sy_result {
    uint32_t op;
    uint32_t key[3];
    sy_node_t node;
} sy_result_t;

/* A place on a path: with at least `take` tokens, and at most `most`, there are `change` more after the transition. */
typedef struct sy_step {
    uint32_t level;
    tb_count_t take;
    tb_count_t most;
    int64_t change;
    sy_path_t rest;
} sy_step_t;

/* Whether all reachable markings lead back to the initial one. */
typedef enum sy_home { SY_NOT_TRIED, SY_NOT_HOME, SY_HOME } sy_home_t;

/* Transitions, forwards or backwards. */
typedef struct sy_events {
    sy_op_t op;         /* of saturation with them */
    sy_path_t *path;    /* transition -> all its places */
    sy_path_t *event;   /* those that change something, by the level at which they begin */
    uint32_t *first;    /* level -> the first of its events; one level more */
    uint32_t *creating; /* level -> the next one, from there on, with an event that needs no token there; or too high */
} sy_events_t;

typedef struct sy_diagrams {
    const tb_net_t *net;
    uint32_t *const *exact; /* of the job */
    uint32_t levels;
    uint32_t *place; /* level -> place; levels begin with 1 */
    uint32_t *level; /* place -> level */

    uint32_t *pool; /* a node: its level, how many edges, (tokens, node)... by tokens */
    uint64_t words;
    uint64_t room;
    sy_node_t *slot;
    uint64_t slots; /* a power of two */
    uint64_t nodes;

    sy_result_t *result;
    uint64_t results; /* a power of two */
    uint64_t noted;   /* since it has grown */

    uint32_t *edges; /* nodes in the making, one above the other: (tokens, node, is new)... */
    uint64_t edge_words;
    uint64_t edge_room;

    sy_step_t *step;
    uint32_t steps;
    uint32_t step_room;
    uint32_t sums; /* that have been asked for */

    sy_path_t *test; /* transition -> the places that it needs tokens in, none of which it changes */
    sy_events_t forwards;
    sy_events_t backwards;
    tb_count_t *most; /* level -> the most tokens, once the state space is known */
    sy_node_t space;  /* all reachable markings */
    sy_node_t dead;   /* those in which nothing is enabled; SY_ANY: not worked out yet */
    sy_home_t home;
    sy_node_t idle;   /* those in which a transition is enabled that changes nothing; likewise */
    jmp_buf given_up; /* where to go on when time is over, or a number is too large */
} sy_diagrams_t;

/* --- nodes (symbolic_nodes.c) ------------------------------------------------------------------------------------- */

enum { SY_EDGE = 2, SY_MAKING = 3 /* words of an edge in the pool, and of one in the making */ };

void sy_init(sy_diagrams_t *d, const tb_net_t *net, const uint32_t *order);
_Noreturn void sy_give_up(sy_diagrams_t *d);

/* NULL: the place of a level holds tokens; otherwise how many values it may have, and leaves by value. */
static inline const uint32_t *sy_exact(const sy_diagrams_t *d, uint32_t level)
{
    return ((d->exact != NULL) && (level > 0U)) ? d->exact[d->place[level]] : NULL;
}

/* Whether a step may be made with so many tokens. */
static inline bool sy_permits(const sy_step_t *s, tb_count_t tokens)
{
    return (tokens >= s->take) && (tokens <= s->most);
}

static inline uint32_t sy_level(const sy_diagrams_t *d, sy_node_t n)
{
    return d->pool[n];
}

static inline uint32_t sy_count(const sy_diagrams_t *d, sy_node_t n)
{
    return d->pool[n + 1U];
}

static inline tb_count_t sy_tokens(const sy_diagrams_t *d, sy_node_t n, uint32_t edge)
{
    return d->pool[n + 2U + ((uint32_t)SY_EDGE * edge)];
}

static inline sy_node_t sy_child(const sy_diagrams_t *d, sy_node_t n, uint32_t edge)
{
    return d->pool[n + 3U + ((uint32_t)SY_EDGE * edge)];
}

/* What follows at a level if there are so many tokens; the node is not above it. */
sy_node_t sy_below(const sy_diagrams_t *d, sy_node_t n, uint32_t level, tb_count_t tokens);
/* What follows at a level and below if there are no tokens above it. */
sy_node_t sy_down_to(const sy_diagrams_t *d, sy_node_t n, uint32_t level);

/* A node in the making: begin, put edges by growing numbers of tokens (those to SY_NONE are left out), end. */
uint64_t sy_begin(const sy_diagrams_t *d);
void sy_put(sy_diagrams_t *d, tb_count_t tokens, sy_node_t child);
sy_node_t sy_end(sy_diagrams_t *d, uint64_t begun, uint32_t level);
/* Room for one more edge at the end. */
void sy_make_room(sy_diagrams_t *d);

bool sy_find(const sy_diagrams_t *d, uint32_t op, uint32_t a, uint32_t b, uint32_t c, sy_node_t *found);
void sy_note(sy_diagrams_t *d, uint32_t op, uint32_t a, uint32_t b, uint32_t c, sy_node_t node);

/* --- sets (symbolic_sets.c) --------------------------------------------------------------------------------------- */

sy_node_t sy_union(sy_diagrams_t *d, sy_node_t a, sy_node_t b);
sy_node_t sy_intersection(sy_diagrams_t *d, sy_node_t a, sy_node_t b);
sy_node_t sy_difference(sy_diagrams_t *d, sy_node_t a, sy_node_t b);
sy_node_t sy_one(sy_diagrams_t *d, const tb_count_t *marking);
bool sy_contains(const sy_diagrams_t *d, sy_node_t n, const tb_count_t *marking);

/* --- transitions (symbolic_events.c, symbolic_fire.c) ------------------------------------------------------------- */

void sy_make_events(sy_diagrams_t *d);

/* What a path makes of a set, as far as it lies in `within`. */
sy_node_t sy_fire(sy_diagrams_t *d, sy_node_t n, sy_node_t within, sy_path_t path);
/* What all transitions that change something make of a set, once, as far as it lies in `within` (not SY_ANY). */
sy_node_t sy_step_of_all(sy_diagrams_t *d, const sy_events_t *e, sy_node_t n, sy_node_t within);
/* A set with all that transitions make of it, again and again, as far as that lies in `within`. */
sy_node_t sy_saturated(sy_diagrams_t *d, const sy_events_t *e, sy_node_t n, sy_node_t within);

/* --- sizes (symbolic_sizes.c) ------------------------------------------------------------------------------------- */

/* A set as an array of nodes: node 0 is the unit, children come before their parents, the last node is the root. */
typedef struct sy_frozen {
    uint32_t nodes;
    uint32_t *level;
    uint64_t *first; /* node -> its first edge; one node more */
    tb_count_t *tokens;
    uint32_t *child;
    uint32_t *at;     /* nodes by their levels */
    uint32_t *levels; /* level -> its first node in `at`; one level more */
    uint64_t all_edges;
    uint64_t bits_words;
} sy_frozen_t;

void sy_freeze(sy_diagrams_t *d, sy_node_t n, sy_frozen_t *f);
void sy_unfreeze(const sy_diagrams_t *d, sy_frozen_t *f);
/* The largest sum of factor * tokens, by level; false: it is too large. */
bool sy_largest(const sy_frozen_t *f, const int64_t *factor, int64_t *sum);
/* The same of a formula; what an exact place adds depends on its value. */
bool sy_largest_of(const sy_diagrams_t *d, const sy_frozen_t *f, const tb_formula_t *sum, int64_t *most);
/* Print the numbers of markings and arcs, and the most tokens in a place and in a marking. Bounds that are asked say of
 * a net that was made smaller what a marking (the first) and further places (the others) hold, less their limits. */
void sy_say_sizes(sy_diagrams_t *d, const sy_frozen_t *f, const tb_job_t *job);

/* --- formulas (symbolic_formula.c) -------------------------------------------------------------------------------- */

/* The reachable markings in which a formula holds. */
sy_node_t sy_where(sy_diagrams_t *d, const tb_formula_t *f);
/* sum <= limit, of some reachable markings */
sy_node_t sy_where_sum(sy_diagrams_t *d, const tb_formula_t *f, sy_node_t within);
/* Nothing is enabled. */
sy_node_t sy_where_dead(sy_diagrams_t *d);
/* The markings of `within` from which a transition leads into a set. */
sy_node_t sy_before(sy_diagrams_t *d, sy_node_t n, sy_node_t within);
/* The markings to which a transition leads from a set. */
sy_node_t sy_after(sy_diagrams_t *d, sy_node_t n);
/* The markings from which a path stays in a set of reachable ones for ever, or until it ends (symbolic_always.c).
 * If any will do, some of them, and none only if there is none. */
sy_node_t sy_always(sy_diagrams_t *d, sy_node_t p, bool is_any);
/* Those of some reachable markings in which none of some transitions is enabled (symbolic_enabled.c). */
sy_node_t sy_where_none(sy_diagrams_t *d, const uint32_t *transition, uint32_t count, sy_node_t within);
/* Whether a formula holds in the initial marking (symbolic_local.c). `known` has an entry for each formula of the
 * question, SY_ANY at first. */
bool sy_holds_at_first(sy_diagrams_t *d, const tb_formula_t *f, sy_node_t *known);

/* --- automata (symbolic_linear.c) --------------------------------------------------------------------------------- */

/* Whether an automaton accepts a run from the initial marking; a run that ends in a dead marking stays there. */
bool sy_accepts(sy_diagrams_t *d, const tb_automaton_t *a);

#endif
