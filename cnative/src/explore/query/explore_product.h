/* SPDX-License-Identifier: MIT
 * explore_product.h - the product of the graph and an automaton, for explore_ltl.c and explore_lasso.c.
 *
 * State (v, s), number v * states + s, is a run at node v with the automaton in s. It goes on by an arc of the graph
 * and an arc of the automaton that reads v and the transition of the arc. A dead node is repeated for ever, by no
 * transition.
 */
#ifndef EXPLORE_PRODUCT_H
#define EXPLORE_PRODUCT_H

#include "explore_query.h"

#define EX_NO_STATE      UINT32_MAX
#define EX_NO_TRANSITION UINT32_MAX        /* the label of a step that stays at a dead node */
#define EX_AT_BEGINNING  (UINT32_MAX - 1U) /* a label that no step has */

typedef struct ex_product {
    ex_queries_t *queries;
    const ex_graph_t *graph;
    const ex_automaton_t *automaton;
    uint32_t states; /* of the automaton */
    uint64_t size;   /* of the product */
    uint32_t start;
    uint64_t *active; /* states that may still lie on an accepted cycle */
    uint32_t *rank;   /* see explore_scc.c; of active states, in the end: the component */
    uint32_t *stack;
    uint8_t *is_root;
    uint64_t waiting;
    uint32_t next;
    uint32_t done;
    bool is_changed; /* in this round states have been taken out */
    bool is_found;   /* in this round a component was good */
    uint64_t steps;
    bool *occurs;     /* by fair transition, of one component */
    bool *is_enabled; /* somewhere */
    bool *is_disabled;
} ex_product_t;

/* The successors of a state, one after the other: for each arc of the automaton all arcs of the graph. */
typedef struct ex_cursor {
    uint32_t state;
    uint32_t edge;
    uint32_t arc; /* within the node */
} ex_cursor_t;

static inline ex_cursor_t ex_first_of(const ex_product_t *p, uint32_t state)
{
    return (ex_cursor_t){ .state = state, .edge = p->automaton->first[state % p->states] };
}

static inline bool ex_is_readable(const ex_product_t *p, const ex_edge_t *edge, uint32_t node)
{
    for (uint32_t i = 0U; i < edge->literals; i++) {
        if (!ex_is_known(p->queries, edge->literal[i].item, node, edge->literal[i].is_positive)) {
            return false;
        }
    }
    return true;
}

static inline bool ex_is_allowed(const ex_edge_t *edge, uint32_t label)
{
    const uint32_t bit = (label == EX_NO_TRANSITION) ? pn_net.transition_count : label;
    return (edge->allowed == NULL) || (EX_BIT(edge->allowed, bit) != 0U);
}

/* The next successor; EX_NO_STATE at the end. */
static inline uint32_t ex_next_of(const ex_product_t *p, ex_cursor_t *cursor, uint32_t *label)
{
    const ex_graph_t *const graph = p->graph;
    const uint32_t node = cursor->state / p->states;
    const uint64_t row = graph->row[node];
    const uint32_t arcs = (uint32_t)(graph->row[node + 1U] - row);
    const bool is_end = ex_ends_at(graph, node);
    const uint32_t end = p->automaton->first[(cursor->state % p->states) + 1U];
    for (; cursor->edge < end; cursor->edge++, cursor->arc = 0U) {
        const ex_edge_t *const edge = &p->automaton->edge[cursor->edge];
        if ((cursor->arc == 0U) && !ex_is_readable(p, edge, node)) {
            continue;
        }
        if (is_end && (cursor->arc == 0U) && ex_is_allowed(edge, EX_NO_TRANSITION)) {
            cursor->arc = 1U;
            *label = EX_NO_TRANSITION;
            return (node * p->states) + edge->to;
        }
        while (cursor->arc < arcs) {
            const uint64_t arc = row + cursor->arc;
            cursor->arc += 1U;
            if (ex_is_allowed(edge, graph->label[arc])) {
                *label = graph->label[arc];
                return (graph->target[arc] * p->states) + edge->to;
            }
        }
    }
    return EX_NO_STATE;
}

static inline void ex_take_out(ex_product_t *p, uint64_t state)
{
    p->active[state >> 6U] &= ~((uint64_t)1U << (state & 63U));
}

/* --- explore_lasso.c --- */

/* When the active states are those of the good components: adds a run from the start to the way, as short as is found
 * without long search. */
bool ex_show_lasso(ex_product_t *p, ex_path_t *path);

#endif /* EXPLORE_PRODUCT_H */
