/* SPDX-License-Identifier: MIT
 * explore_fairness.c - how fair each transition is, over all infinite occurrence sequences (in a finite graph each is
 * in the end a walk in one component):
 *   impartial  t occurs infinitely often in each                        no cycle without t
 *   fair       ... in each in which it is enabled infinitely often      no cycle without t through a node at which t is
 *                                                                       enabled
 *   just       ... in each in which it is enabled from some point on    no cycle without t among the nodes at which t
 *                                                                       is enabled
 *
 * The first and the third ask whether a part of the graph has a cycle, and are worked out for up to 32 transitions
 * together: each node has a bit for each question, which tells whether a cycle of that part may be reached from it. A
 * bit without a successor that has it goes (an arc counts for the questions that do not leave out its transition). Bits
 * are gone through in sweeps over all arcs, as they lie in memory, until none goes; or along a way that goes back where
 * it comes to an end: should it come to itself, that is a cycle, and may answer the questions of many transitions. Such
 * ways are tried for a while first, and used when sweeps get nowhere. The second question is left only where the answer
 * to the first is that there is such a cycle, and to the third that there is none.
 */
#include "explore_graph.h"

#define GROUP 32U
#ifndef EX_TRIED
#define EX_TRIED 2000U /* nodes of a way that is tried */
#endif

/* Some transitions, and what is known of each: bit k is about `transition[k]`. */
typedef struct group {
    ex_run_t *run;
    const ex_graph_t *graph;
    uint32_t transition[GROUP];
    uint32_t count;
    uint64_t *bit_of;       /* by transition; 0: of another group */
    uint64_t not_impartial; /* there is such a cycle */
    uint64_t not_fair;
    uint64_t not_just;
    /* The questions: bit k is the first of transition[k], bit count + k the third. */
    uint64_t open; /* those without an answer, or of which the bits are wanted for the second question */
    void *alive;   /* of each node: `width` bytes */
    uint32_t width;
    uint64_t *is_on_way; /* bit set of nodes */
    /* A sweep. */
    bool is_upward;
    bool is_first;
    _Atomic uint32_t next; /* block */
    _Atomic uint64_t removed;
    _Atomic uint64_t some; /* bits that some node has */
} group_t;

/* --- bits of nodes ------------------------------------------------------------------------------------------------ */

static inline uint64_t load(const void *alive, uint32_t width, uint32_t node)
{
    switch (width) {
    case 1U: return __atomic_load_n(&((const uint8_t *)alive)[node], __ATOMIC_RELAXED);
    case 2U: return __atomic_load_n(&((const uint16_t *)alive)[node], __ATOMIC_RELAXED);
    case 4U: return __atomic_load_n(&((const uint32_t *)alive)[node], __ATOMIC_RELAXED);
    default: return __atomic_load_n(&((const uint64_t *)alive)[node], __ATOMIC_RELAXED);
    }
}

static inline void store(void *alive, uint32_t width, uint32_t node, uint64_t bits)
{
    switch (width) {
    case 1U: __atomic_store_n(&((uint8_t *)alive)[node], (uint8_t)bits, __ATOMIC_RELAXED); break;
    case 2U: __atomic_store_n(&((uint16_t *)alive)[node], (uint16_t)bits, __ATOMIC_RELAXED); break;
    case 4U: __atomic_store_n(&((uint32_t *)alive)[node], (uint32_t)bits, __ATOMIC_RELAXED); break;
    default: __atomic_store_n(&((uint64_t *)alive)[node], bits, __ATOMIC_RELAXED); break;
    }
}

static uint64_t all_of(uint32_t count)
{
    return (count == 64U) ? UINT64_MAX : (((uint64_t)1U << count) - 1U);
}

/* Of which transitions of the group there is an arc. */
static inline uint64_t enabled_at(const group_t *g, uint32_t node)
{
    uint64_t enabled = 0U;
    for (uint64_t arc = g->graph->row[node]; arc < g->graph->row[node + 1U]; arc++) {
        enabled |= g->bit_of[g->graph->label[arc]];
    }
    return enabled;
}

/* Questions that an arc of the transition does not count for. */
static inline uint64_t left_out(const group_t *g, uint16_t label)
{
    return g->bit_of[label] | (g->bit_of[label] << g->count);
}

/* --- ways --------------------------------------------------------------------------------------------------------- */

typedef struct step {
    uint64_t arc; /* the next one to look at */
    uint32_t node;
} step_t;

typedef struct search {
    group_t *group;
    uint32_t question;
    step_t *step;
    uint64_t room; /* steps */
    uint64_t depth;
    uint64_t left; /* nodes that may be entered */
    bool is_found;
} search_t;

static void clear(const search_t *s, uint32_t node)
{
    group_t *const g = s->group;
    store(g->alive, g->width, node, load(g->alive, g->width, node) & ~((uint64_t)1U << s->question));
}

/* Goes on to a node that may lead to a cycle. */
static void enter(search_t *s, uint32_t node)
{
    group_t *const g = s->group;
    s->left -= 1U;
    if ((s->question >= g->count) && ((enabled_at(g, node) & ((uint64_t)1U << (s->question - g->count))) == 0U)) {
        clear(s, node);
        return;
    }
    s->step[s->depth] = (step_t){ .arc = g->graph->row[node], .node = node };
    s->depth += 1U;
    EX_SET_BIT(g->is_on_way, node);
}

static void go_back(search_t *s)
{
    s->depth -= 1U;
    const uint32_t node = s->step[s->depth].node;
    s->group->is_on_way[node >> 6U] &= ~((uint64_t)1U << (node & 63U));
}

/* The way has come back to one of its nodes: what that says about all transitions. */
static void note_cycle(search_t *s, uint32_t node)
{
    group_t *const g = s->group;
    uint64_t occurs = 0U;
    uint64_t sometimes = 0U;
    uint64_t always = all_of(g->count);
    bool is_begun = false;
    for (uint64_t i = s->depth; !is_begun;) {
        i -= 1U;
        const uint64_t enabled = enabled_at(g, s->step[i].node);
        occurs |= g->bit_of[g->graph->label[s->step[i].arc - 1U]]; /* the one that was followed */
        sometimes |= enabled;
        always &= enabled;
        is_begun = s->step[i].node == node;
    }
    const uint64_t without = all_of(g->count) & ~occurs;
    g->not_impartial |= without;
    g->not_fair |= without & sometimes;
    g->not_just |= without & always;
    s->is_found = true;
}

/* From a node, until a cycle is found, it is clear that none can be reached, or it has taken too long. */
static void search_from(search_t *s, uint32_t start)
{
    group_t *const g = s->group;
    const uint64_t bit = (uint64_t)1U << s->question;
    enter(s, start);
    while ((s->depth > 0U) && !s->is_found && (s->left > 0U)) {
        step_t *const step = &s->step[s->depth - 1U];
        if (step->arc == g->graph->row[step->node + 1U]) {
            clear(s, step->node);
            go_back(s);
            continue;
        }
        const uint64_t arc = step->arc;
        const uint32_t target = g->graph->target[arc];
        step->arc += 1U;
        if ((left_out(g, g->graph->label[arc]) & bit) != 0U) {
            continue;
        }
        if (EX_BIT(g->is_on_way, target) != 0U) {
            note_cycle(s, target);
        } else if ((load(g->alive, g->width, target) & bit) != 0U) {
            enter(s, target);
        }
        if (((s->left & 0xffffU) == 0U) && ex_is_stopping(g->run)) {
            s->left = 0U;
        }
    }
    while (s->depth > 0U) {
        go_back(s);
    }
}

/* Searches from one node after the other, from `first` on. False: no memory. */
static bool search(group_t *g, uint32_t question, uint32_t first, uint64_t most)
{
    search_t s = { .group = g, .question = question, .left = most };
    s.room = (most < g->graph->nodes) ? most : g->graph->nodes;
    s.step = ex_alloc(&g->run->memory, s.room * sizeof *s.step);
    if (s.step == NULL) {
        return false;
    }
    for (uint32_t node = first; (node < g->graph->nodes) && !s.is_found && (s.left > 0U); node++) {
        if ((load(g->alive, g->width, node) & ((uint64_t)1U << question)) != 0U) {
            search_from(&s, node);
        }
    }
    ex_free(&g->run->memory, s.step, s.room * sizeof *s.step);
    return true;
}

/* --- sweeps ------------------------------------------------------------------------------------------------------- */

typedef struct swept {
    uint64_t removed;
    uint64_t some;
} swept_t;

/* The bits that a node keeps. */
static inline uint64_t kept(const group_t *g, uint32_t width, uint32_t node, uint64_t bits)
{
    const ex_graph_t *const graph = g->graph;
    uint64_t found = 0U;
    uint64_t enabled = 0U;
    for (uint64_t arc = graph->row[node]; arc < graph->row[node + 1U]; arc++) {
        const uint16_t label = graph->label[arc];
        found |= load(g->alive, width, graph->target[arc]) & ~left_out(g, label);
        enabled |= g->bit_of[label];
        if (!g->is_first && ((found & bits) == bits)) {
            return bits;
        }
    }
    /* Which are enabled matters the first time alone: the bits of others are gone then. */
    return bits & found & (g->is_first ? (all_of(g->count) | (enabled << g->count)) : UINT64_MAX);
}

static inline void sweep_nodes(const group_t *g, uint32_t width, uint32_t first, uint32_t count, swept_t *swept)
{
    for (uint32_t k = 0U; k < count; k++) {
        const uint32_t node = g->is_upward ? (first + k) : (first + (count - 1U - k));
        const uint64_t had = load(g->alive, width, node);
        const uint64_t bits = had & g->open;
        if (bits != 0U) {
            const uint64_t has = kept(g, width, node, bits);
            if (has != had) {
                store(g->alive, width, node, has);
            }
            swept->removed += (has != bits) ? 1U : 0U;
            swept->some |= has;
        }
    }
}

static void sweep_blocks(ex_worker_t *worker, void *user)
{
    group_t *const g = user;
    const uint32_t nodes = g->graph->nodes;
    const uint32_t blocks = ((nodes - 1U) / EX_SWEEP_BLOCK) + 1U;
    swept_t swept = { 0U, 0U };
    while (!ex_is_stopping(worker->run)) {
        const uint32_t index = atomic_fetch_add(&g->next, 1U);
        if (index >= blocks) {
            break;
        }
        const uint32_t first = (g->is_upward ? index : (blocks - 1U - index)) * EX_SWEEP_BLOCK;
        const uint32_t count = ((nodes - first) < EX_SWEEP_BLOCK) ? (nodes - first) : EX_SWEEP_BLOCK;
        switch (g->width) { /* a loop for each */
        case 1U: sweep_nodes(g, 1U, first, count, &swept); break;
        case 2U: sweep_nodes(g, 2U, first, count, &swept); break;
        case 4U: sweep_nodes(g, 4U, first, count, &swept); break;
        default: sweep_nodes(g, 8U, first, count, &swept); break;
        }
    }
    (void)atomic_fetch_add(&g->removed, swept.removed);
    (void)atomic_fetch_or(&g->some, swept.some);
}

/* Sweeps until no bit goes, or that is not worth it any more. Whether none goes. */
static bool sweep_all(group_t *g)
{
    uint64_t last[2] = { UINT64_MAX, UINT64_MAX }; /* removed in the last sweep downwards, upwards */
    g->is_first = true;
    for (uint32_t i = 0U; (g->open != 0U) && (i < EX_MOST_SWEEPS); i++) {
        g->is_upward = last[1] > last[0];
        atomic_store(&g->next, 0U);
        atomic_store(&g->removed, 0U);
        atomic_store(&g->some, 0U);
        if (g->graph->nodes > EX_SWEEP_BLOCK) {
            ex_parallel(g->run, sweep_blocks, g);
        } else {
            sweep_blocks(&g->run->worker[0], g);
        }
        if (ex_is_stopping(g->run)) {
            return false;
        }
        g->is_first = false;
        g->open &= atomic_load(&g->some);
        const uint64_t removed = atomic_load(&g->removed);
        last[g->is_upward ? 1 : 0] = removed;
        if (removed == 0U) {
            return true;
        }
        if ((i >= EX_LEAST_SWEEPS) && ((removed * 64U) < g->graph->nodes)) {
            break;
        }
    }
    return g->open == 0U;
}

/* --- answers ------------------------------------------------------------------------------------------------------ */

/* Questions without an answer, and those of which the bits are still wanted. */
static uint64_t wanted(const group_t *g)
{
    const uint64_t undecided = all_of(g->count) & ~g->not_just;
    return undecided | (undecided << g->count);
}

/* The first and the third question of all transitions. False: no memory, or told to stop. */
static bool find_cycles(group_t *g)
{
    bool is_fine = true;
    for (uint32_t k = 0U; is_fine && (k < g->count); k++) {
        if ((g->not_just & ((uint64_t)1U << k)) == 0U) {
            is_fine = search(g, g->count + k, g->graph->nodes / 2U, EX_TRIED);
        }
    }
    g->open = wanted(g);
    if (is_fine && sweep_all(g)) {
        g->not_impartial |= g->open & all_of(g->count);
        g->not_just |= g->open >> g->count;
        return true;
    }
    for (uint32_t k = 0U; is_fine && !ex_is_stopping(g->run) && (k < (2U * g->count)); k++) {
        const uint64_t known = (k < g->count) ? (g->not_impartial >> k) : (g->not_just >> (k - g->count));
        if (((g->open >> k) & ~known & 1U) != 0U) {
            is_fine = search(g, k, 0U, UINT64_MAX);
        }
    }
    return is_fine && !ex_is_stopping(g->run);
}

/* The second question, of those that need it. */
typedef struct fair_work {
    group_t *group;
    _Atomic uint32_t next;
    _Atomic uint64_t not_fair;
    _Atomic bool is_unknown;
} fair_work_t;

static ex_cycle_t is_fairness_violated(ex_run_t *run, const group_t *g, uint32_t k)
{
    const uint64_t bytes = ((g->graph->nodes / 64U) + 1U) * sizeof(uint64_t);
    const uint64_t bit = (uint64_t)1U << k;
    uint64_t *const only = ex_alloc(&run->memory, bytes);
    uint64_t *const enabled = ex_alloc(&run->memory, bytes);
    ex_cycle_t found = EX_CYCLE_UNKNOWN;
    if ((only != NULL) && (enabled != NULL)) {
        bool is_possible = false;
        for (uint32_t node = 0U; node < g->graph->nodes; node++) {
            if ((load(g->alive, g->width, node) & bit) != 0U) {
                EX_SET_BIT(only, node);
                if ((enabled_at(g, node) & bit) != 0U) {
                    EX_SET_BIT(enabled, node);
                    is_possible = true;
                }
            }
        }
        const ex_part_t part = { .without = g->transition[k], .only = only };
        found = is_possible ? ex_has_cycle(run, g->graph, &part, enabled) : EX_NO_CYCLE;
    }
    ex_free(&run->memory, only, bytes);
    ex_free(&run->memory, enabled, bytes);
    return found;
}

static void find_some_fair(ex_worker_t *worker, void *user)
{
    fair_work_t *const work = user;
    group_t *const g = work->group;
    for (;;) {
        const uint32_t k = atomic_fetch_add(&work->next, 1U);
        if ((k >= g->count) || atomic_load(&work->is_unknown)) {
            return;
        }
        if (((g->not_impartial & ~g->not_fair) >> k) & 1U) {
            const ex_cycle_t found = is_fairness_violated(worker->run, g, k);
            if (found == EX_CYCLE) {
                (void)atomic_fetch_or(&work->not_fair, (uint64_t)1U << k);
            } else if (found == EX_CYCLE_UNKNOWN) {
                atomic_store(&work->is_unknown, true);
            }
        }
    }
}

static bool find_fair(group_t *g)
{
    fair_work_t work = { .group = g };
    atomic_init(&work.next, 0U);
    atomic_init(&work.not_fair, 0U);
    atomic_init(&work.is_unknown, false);
    g->not_fair |= g->not_just;
    if ((g->not_impartial & ~g->not_fair) != 0U) {
        ex_parallel(g->run, find_some_fair, &work);
        g->not_fair |= atomic_load(&work.not_fair);
    }
    return !atomic_load(&work.is_unknown);
}

static bool work_out(group_t *g, uint8_t *fairness)
{
    const uint64_t nodes = g->graph->nodes;
    const uint64_t bytes = ((nodes / 64U) + 1U) * sizeof *g->is_on_way;
    g->width = (g->count <= 4U) ? 1U : ((g->count <= 8U) ? 2U : ((g->count <= 16U) ? 4U : 8U));
    g->alive = ex_alloc(&g->run->memory, nodes * g->width);
    g->is_on_way = ex_alloc(&g->run->memory, bytes);
    bool is_fine = (g->alive != NULL) && (g->is_on_way != NULL);
    if (is_fine) {
        (void)memset(g->alive, 0xff, nodes * g->width);
        is_fine = find_cycles(g) && find_fair(g);
    }
    for (uint32_t k = 0U; is_fine && (k < g->count); k++) {
        const uint64_t bit = (uint64_t)1U << k;
        fairness[g->transition[k]] = (uint8_t)(((g->not_just & bit) != 0U)        ? EX_UNFAIR
                                               : ((g->not_fair & bit) != 0U)      ? EX_JUST
                                               : ((g->not_impartial & bit) != 0U) ? EX_FAIR
                                                                                  : EX_IMPARTIAL);
    }
    ex_free(&g->run->memory, g->alive, nodes * g->width);
    ex_free(&g->run->memory, g->is_on_way, bytes);
    return is_fine;
}

bool ex_fairness(ex_run_t *run, ex_graph_t *graph)
{
    const uint32_t transitions = pn_net.transition_count;
    uint64_t *const bit_of = ex_table(&run->memory, transitions, sizeof *bit_of);
    graph->fairness = ex_table(&run->memory, transitions, sizeof *graph->fairness);
    bool is_fine = (bit_of != NULL) && (graph->fairness != NULL);
    for (uint32_t t = 0U; is_fine && (t < transitions); t += GROUP) {
        group_t g = { .run = run, .graph = graph, .bit_of = bit_of };
        atomic_init(&g.next, 0U);
        atomic_init(&g.removed, 0U);
        atomic_init(&g.some, 0U);
        g.count = ((transitions - t) < GROUP) ? (transitions - t) : GROUP;
        for (uint32_t k = 0U; k < g.count; k++) {
            g.transition[k] = t + k;
            bit_of[t + k] = (uint64_t)1U << k;
        }
        is_fine = work_out(&g, graph->fairness);
        for (uint32_t k = 0U; k < g.count; k++) {
            bit_of[t + k] = 0U;
        }
    }
    ex_free_table(&run->memory, bit_of, transitions, sizeof *bit_of);
    return is_fine;
}
