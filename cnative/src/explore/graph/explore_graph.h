/* SPDX-License-Identifier: MIT
 * explore_graph.h - the graph of a state space: nodes in breadth-first order, the arcs of each, and what is computed
 * over them.
 *
 * Node 0 is the initial marking (reports count from 1). Arcs lie node by node: those of node i are row[i] .. row[i + 1]
 * - 1.
 */
#ifndef EXPLORE_GRAPH_H
#define EXPLORE_GRAPH_H

#include "../explore_run.h"

#define EX_NO_NODE UINT32_MAX

typedef struct ex_graph {
    uint32_t nodes;
    uint64_t arcs;
    uint64_t room;    /* arcs that `target` and `label` have room for */
    uint64_t *slot;   /* node -> slot of the store */
    uint32_t *number; /* slot -> node + 1; 0: not seen yet. NULL: nobody needs it any more */
    uint32_t *parent; /* node -> the one it was first reached from; the initial marking's own */
    uint64_t *row;    /* nodes + 1 of them */
    uint32_t *target;
    uint16_t *label; /* arc -> transition */
    uint64_t dead_count;
    uint64_t *dead; /* a bit for each node; without reductions the dead ones are those without arcs */
    uint64_t *late; /* a bit for each node at whose time nothing is enabled, so that its arcs come later; NULL: the net
                       is untimed */
    uint64_t *cut;  /* of a part: a bit for each node of which arcs are missing; NULL: of none */
    uint64_t *open; /* the same, of which it is not known whether they have any */
    uint64_t node_room; /* nodes that there is memory for */
    bool is_whole;      /* all successors of all nodes are there */
    bool is_reduced;    /* it lacks states or arcs: components and properties are not computed */
    /* Components: those that can be reached have smaller numbers than those from which they are reached. */
    uint32_t *component; /* node -> component */
    uint32_t components;
    uint64_t component_arcs; /* between different components */
    bool is_acyclic;
    /* Properties. */
    uint64_t home_count;
    uint32_t home_component; /* EX_NO_NODE: there is none */
    bool *is_live;           /* by transition */
    uint8_t *fairness;       /* by transition: ex_fairness_t */
    double seconds;
} ex_graph_t;

typedef enum ex_fairness { EX_IMPARTIAL, EX_FAIR, EX_JUST, EX_UNFAIR } ex_fairness_t;

/* What of a graph is looked at: arcs without those of a transition, nodes only if they are in a set. */
typedef struct ex_part {
    uint32_t without;     /* transition; EX_NO_NODE: all arcs */
    const uint64_t *only; /* bit set of nodes; NULL: all of them */
} ex_part_t;

/* Sweeps over all arcs: nodes that a thread takes at a time (whole words of a bit set), and when they are given up.
 * Tests have others. */
#ifndef EX_SWEEP_BLOCK
#define EX_SWEEP_BLOCK 65536U
#endif
#ifndef EX_LEAST_SWEEPS
#define EX_LEAST_SWEEPS 16U
#endif
#ifndef EX_MOST_SWEEPS
#define EX_MOST_SWEEPS 256U
#endif

/* --- explore_scc.c --- */

/* Fills component, components, component_arcs, is_acyclic. False: no memory, or told to stop. */
bool ex_components(ex_run_t *run, ex_graph_t *graph);

typedef enum ex_cycle {
    EX_CYCLE,
    EX_NO_CYCLE,
    EX_CYCLE_UNKNOWN /* no memory, or told to stop */
} ex_cycle_t;

/* Whether the part has a cycle that goes through one of the nodes of a bit set. */
ex_cycle_t ex_has_cycle(ex_run_t *run, const ex_graph_t *graph, const ex_part_t *part, const uint64_t *through);

/* --- explore_properties.c --- */

/* Fills home and live. False: no memory. */
bool ex_properties(ex_run_t *run, ex_graph_t *graph);

/* --- explore_fairness.c --- */

/* Fills fairness, of a graph that is not acyclic. False: no memory, or told to stop. */
bool ex_fairness(ex_run_t *run, ex_graph_t *graph);

/* --- explore_trace.c --- */

#define EX_PATH_SIZE 4096U

/* A shortest run to a node as a file, which appears as a whole; steps < 0: it could not be written. worker[0].marking
 * is then where it ends. */
int64_t ex_write_trace(ex_run_t *run, const ex_graph_t *graph, uint32_t node, const char *path);
/* The same; `why` it ends there (NULL: nothing is enabled there, or that is far enough). */
int64_t ex_write_run(ex_run_t *run, const ex_graph_t *graph, uint32_t node, const char *path, const char *why);
/* The same for the run through way[0] .. way[steps], by transition label[i] to way[i]; label NULL: by any. */
int64_t ex_write_path(ex_run_t *run, const ex_graph_t *graph, const uint32_t *on_path, const uint16_t *label,
                      uint64_t steps, const char *path, const char *why);
/* The same for the run through the states of way[0] .. way[steps], which need not be stored; `why` it ends there. */
int64_t ex_write_keys(ex_run_t *run, const ex_key_t *way, uint64_t steps, const char *path, const char *why);
/* What a file is called while it is being written: the process's own, beside `path`. False: too long. */
bool ex_part_name(char name[EX_PATH_SIZE], const char *path);
/* The whole graph as lines of JSON. */
bool ex_write_graph(ex_run_t *run, const ex_graph_t *graph, const char *path);

#define EX_BIT(set, i)     ((((set)[(i) >> 6U]) >> ((i) & 63U)) & 1U)
#define EX_SET_BIT(set, i) ((set)[(i) >> 6U] |= (uint64_t)1U << ((i) & 63U))

/* After a complete exploration with an exact store. False: there is no graph (no memory, stopped: run->why says so). */
bool ex_graph(ex_run_t *run);
/* Members of the report: "dead": [...], "graph": {...} or null, "traces": [...]; without a graph too. */
void ex_graph_json(ex_run_t *run, FILE *out);
/* The file of nodes and arcs, if one is wanted. */
void ex_graph_write(ex_run_t *run);
/* Whether runs end at a node: nothing can occur. Of a part, arcs may be missing. */
static inline bool ex_ends_at(const ex_graph_t *graph, uint32_t node)
{
    return (graph->row[node] == graph->row[node + 1U]) && (graph->is_whole || (EX_BIT(graph->dead, node) != 0U));
}

#endif /* EXPLORE_GRAPH_H */
