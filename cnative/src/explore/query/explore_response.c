/* SPDX-License-Identifier: MIT
 * explore_response.c - whether each event F is followed by an event G, and how long it may take.
 *
 * A run is marking 0, firing 1, marking 1, ... A node *waits* when a run can be there after an F without a G since. A
 * wait begins with 0 at a node that is an F (or is made by one) and no G; it goes on along arcs that neither are nor
 * lead to a G. If the nodes that wait have a cycle, or a dead node, G may never come. Else each wait ends, and the
 * longest ones are found by going through these nodes in an order in which each comes after those before it. What is
 * computed of a node is since when it waits at most,
 *
 *     since(w) = min of now(w), if a wait begins there, and of since(v) - shift(v) for the arcs from v
 *
 * with now = 0 and shift = 1 for firings; for time with the node's time and shift = 0, or, if the time is reduced, with
 * now = 0 and the time that goes by at the node before something occurs.
 */
#include "explore_query.h"
#include "../search/explore_successors.h"

typedef struct wait {
    ex_queries_t *queries;
    const ex_graph_t *graph;
    const ex_question_t *question;
    uint64_t *waits;  /* set of nodes */
    uint64_t *begins; /* set of nodes */
    uint32_t *maker;  /* where a wait begins with an arc: a node with such an arc; else EX_NO_NODE */
    uint32_t *before; /* where it goes on: the node before; EX_NO_NODE: it begins here */
    uint32_t *degree; /* arcs on which it comes, as far as they have not been looked at */
    uint32_t *stack;
    double *since;
    double *now;   /* NULL: 0 */
    double *shift; /* NULL: `step` */
    double step;
    bool has_event;
    bool is_endless;
    double longest;
    uint32_t last; /* the longest wait ends with this arc of this node */
    uint64_t last_arc;
} wait_t;

static bool is_event_node(const wait_t *w, const ex_event_t *event, uint32_t node)
{
    return !event->is_transition && ex_is_in(w->queries, event->number, node);
}

static bool is_event_arc(const wait_t *w, const ex_event_t *event, uint64_t arc)
{
    return event->is_transition && (EX_BIT(event->of, w->graph->label[arc]) != 0U);
}

/* Whether a wait goes on along an arc. */
static bool goes_on(const wait_t *w, uint64_t arc)
{
    const ex_event_t *const end = &w->question->second;
    return !is_event_arc(w, end, arc) && !is_event_node(w, end, w->graph->target[arc]);
}

static double now_of(const wait_t *w, uint32_t node)
{
    return (w->now != NULL) ? w->now[node] : 0.0;
}

/* What an arc adds: firings are those of the net alone. */
static double shift_of(const wait_t *w, uint32_t node, uint16_t label)
{
    const ex_programs_t *const programs = w->queries->run->programs;
    const bool is_silent = (programs != NULL) && programs->is_silent[label];
    return (w->shift != NULL) ? w->shift[node] : (is_silent ? 0.0 : w->step);
}

/* --- which nodes wait --------------------------------------------------------------------------------------------- */

static void begin_at(wait_t *w, uint32_t node, uint32_t maker)
{
    w->has_event = true;
    if (!is_event_node(w, &w->question->second, node) && (EX_BIT(w->begins, node) == 0U)) {
        EX_SET_BIT(w->begins, node);
        w->maker[node] = maker;
    }
}

static void find_beginnings(wait_t *w)
{
    const ex_event_t *const event = &w->question->first;
    for (uint32_t node = 0U; node < w->graph->nodes; node++) {
        if (is_event_node(w, event, node)) {
            begin_at(w, node, EX_NO_NODE);
        }
        for (uint64_t arc = w->graph->row[node]; arc < w->graph->row[node + 1U]; arc++) {
            if (is_event_arc(w, event, arc)) {
                begin_at(w, w->graph->target[arc], node);
            }
        }
    }
}

/* The nodes that wait, and how many arcs lead to each on which it goes on. */
static bool spread(wait_t *w)
{
    uint64_t used = 0U;
    for (uint32_t node = 0U; node < w->graph->nodes; node++) {
        if (EX_BIT(w->begins, node) != 0U) {
            EX_SET_BIT(w->waits, node);
            w->stack[used] = node;
            used += 1U;
        }
    }
    while (used > 0U) {
        used -= 1U;
        const uint32_t node = w->stack[used];
        w->is_endless = w->is_endless || ex_ends_at(w->graph, node);
        for (uint64_t arc = w->graph->row[node]; arc < w->graph->row[node + 1U]; arc++) {
            const uint32_t target = w->graph->target[arc];
            if (!goes_on(w, arc)) {
                continue;
            }
            w->degree[target] += 1U;
            if (EX_BIT(w->waits, target) == 0U) {
                EX_SET_BIT(w->waits, target);
                w->stack[used] = target;
                used += 1U;
            }
        }
        if (((node & 0xfffU) == 0U) && ex_is_stopping(w->queries->run)) {
            return false;
        }
    }
    return true;
}

/* --- how long ----------------------------------------------------------------------------------------------------- */

/* All waits at a node are known: they go on, or end. */
static void pass_on(wait_t *w, uint32_t node, uint64_t *used)
{
    for (uint64_t arc = w->graph->row[node]; arc < w->graph->row[node + 1U]; arc++) {
        const uint32_t target = w->graph->target[arc];
        const double since = w->since[node] - shift_of(w, node, w->graph->label[arc]);
        const bool is_over = !goes_on(w, arc);
        if (is_over || !w->graph->is_whole) { /* of a part it is not known how waits go on */
            const double length = now_of(w, target) - since;
            if ((w->last == EX_NO_NODE) || (length > w->longest)) {
                w->longest = length;
                w->last = node;
                w->last_arc = arc;
            }
        }
        if (is_over) {
            continue;
        }
        const bool is_new = (EX_BIT(w->begins, target) == 0U) && (w->before[target] == EX_NO_NODE);
        if (is_new || (since < w->since[target])) {
            w->since[target] = since;
            w->before[target] = node;
        }
        w->degree[target] -= 1U;
        if (w->degree[target] == 0U) {
            w->stack[*used] = target;
            *used += 1U;
        }
    }
}

static void measure(wait_t *w)
{
    uint64_t used = 0U;
    uint64_t done = 0U;
    uint64_t count = 0U;
    for (uint32_t node = 0U; node < w->graph->nodes; node++) {
        w->before[node] = EX_NO_NODE;
        if (EX_BIT(w->waits, node) == 0U) {
            continue;
        }
        count += 1U;
        w->since[node] = now_of(w, node);
        if (w->degree[node] == 0U) {
            w->stack[used] = node;
            used += 1U;
        }
    }
    for (; used > 0U; done++) {
        used -= 1U;
        pass_on(w, w->stack[used], &used);
    }
    w->is_endless = done < count; /* the rest lies on cycles, or behind them */
}

/* --- time --------------------------------------------------------------------------------------------------------- */

static bool note_time(ex_worker_t *worker, void *user, uint32_t node, const ex_key_t *key)
{
    const wait_t *const w = user;
    if (!ex_load(worker, key)) {
        return false;
    }
    const pn_time_t now = pn_now(&pn_net, worker->marking);
    w->now[node] = pn_net.real_time ? now.real : (double)now.integer;
    return true;
}

static bool stop_at_once(void *user, uint32_t transition, const void *binding, const ex_key_t *key)
{
    (void)user;
    (void)transition;
    (void)binding;
    (void)key;
    return false;
}

static bool note_elapsed(ex_worker_t *worker, void *user, uint32_t node, const ex_key_t *key)
{
    const wait_t *const w = user;
    const ex_found_t found = ex_successors(worker, key, stop_at_once, NULL);
    w->shift[node] = (double)worker->elapsed;
    return found != EX_FAILED;
}

static bool find_times(wait_t *w)
{
    ex_run_t *const run = w->queries->run;
    double *const table = ex_table(&run->memory, w->graph->nodes, sizeof *table);
    const bool is_reduced = run->options.is_time_reduced;
    w->shift = is_reduced ? table : NULL;
    w->now = is_reduced ? NULL : table;
    w->step = 0.0;
    return (table != NULL) && ex_each_node(w->queries, is_reduced ? note_elapsed : note_time, w);
}

/* --- what shows it ------------------------------------------------------------------------------------------------ */

/* A run on which G never comes: the automaton guesses when the wait begins that never ends. */
static void show_endless(const wait_t *w, ex_question_t *question)
{
    const ex_event_t *const first = &question->first;
    const ex_event_t *const second = &question->second;
    const uint64_t words = ((uint64_t)pn_net.transition_count / 64U) + 1U;
    uint64_t *const other = ex_alloc(&w->queries->run->memory, words * sizeof *other); /* all transitions but G */
    uint64_t *const begin = ex_alloc(&w->queries->run->memory, words * sizeof *begin);
    if ((other == NULL) || (begin == NULL)) {
        return;
    }
    (void)memset(other, 0xff, words * sizeof *other);
    for (uint64_t i = 0U; i < words; i++) {
        other[i] &= second->is_transition ? ~second->of[i] : UINT64_MAX;
        begin[i] |= first->is_transition ? first->of[i] : 0U;
    }
    ex_literal_t no_end[2] = { { .item = second->number, .is_positive = false },
                               { .item = first->number, .is_positive = true } };
    const uint32_t ends = second->is_transition ? 0U : 1U;
    ex_literal_t is_first[2] = { no_end[1], no_end[0] };
    ex_edge_t edge[] = {
        { .from = 0U, .to = 0U },
        /* by an arc: what the node was before counts no more; by a node: it must be no G, nor the arc */
        { .from = 0U,
          .to = 1U,
          .literals = first->is_transition ? 0U : (1U + ends),
          .literal = is_first,
          .allowed = first->is_transition ? begin : other },
        { .from = 1U, .to = 1U, .literals = ends, .literal = no_end, .allowed = other },
    };
    bool is_accepting[] = { false, true };
    uint32_t row[] = { 0U, 2U, 3U };
    const ex_automaton_t automaton = {
        .states = 2U, .is_accepting = is_accepting, .edges = 3U, .edge = edge, .first = row
    };
    if (ex_path_begin(&question->path, 0U)) {
        (void)ex_lasso(w->queries, &automaton, 0U, &question->path);
    }
    ex_free(&w->queries->run->memory, other, words * sizeof *other);
    ex_free(&w->queries->run->memory, begin, words * sizeof *begin);
}

/* Adds an arc to a node on which the wait goes on. */
static bool add_arc(const wait_t *w, uint32_t node, ex_path_t *path)
{
    const uint32_t from = ex_path_end(path);
    for (uint64_t arc = w->graph->row[from]; arc < w->graph->row[from + 1U]; arc++) {
        if ((w->graph->target[arc] == node) && goes_on(w, arc)) {
            ex_path_step(path, w->graph->label[arc], node);
            return !path->is_failed;
        }
    }
    return false;
}

/* Adds the arc with which the wait begins. */
static void add_maker(const wait_t *w, uint32_t node, ex_path_t *path)
{
    const uint32_t from = ex_path_end(path);
    for (uint64_t arc = w->graph->row[from]; arc < w->graph->row[from + 1U]; arc++) {
        if ((w->graph->target[arc] == node) && is_event_arc(w, &w->question->first, arc)) {
            ex_path_step(path, w->graph->label[arc], node);
            return;
        }
    }
}

/* The way ends when the wait, which begins with step `first`, is too long. */
static void cut(const wait_t *w, uint64_t first, ex_path_t *path)
{
    double shifted = 0.0;
    for (uint64_t i = first; i < path->steps; i++) {
        shifted += shift_of(w, path->node[i], path->label[i + 1U]);
        if ((now_of(w, path->node[i + 1U]) - now_of(w, path->node[first]) + shifted) > w->question->most) {
            path->steps = i + 1U;
        }
    }
}

/* A run with the longest wait. */
static void show_longest(const wait_t *w, ex_question_t *question)
{
    ex_path_t *const path = &question->path;
    uint64_t count = 0U;
    uint32_t node = w->last;
    /* The nodes of the wait, the last one first; the stack is free now. */
    w->stack[0] = node;
    while (w->before[node] != EX_NO_NODE) {
        node = w->before[node];
        count += 1U;
        w->stack[count] = node;
    }
    if (!ex_path_begin(path, 0U)) {
        return;
    }
    if (w->maker[node] == EX_NO_NODE) {
        ex_path_from_start(w->graph, node, path);
    } else {
        ex_path_from_start(w->graph, w->maker[node], path);
        add_maker(w, node, path);
    }
    const uint64_t first = path->steps;
    bool is_fine = !path->is_failed;
    for (; is_fine && (count > 0U); count--) {
        is_fine = add_arc(w, w->stack[count - 1U], path);
    }
    ex_path_step(path, w->graph->label[w->last_arc], w->graph->target[w->last_arc]);
    if (is_fine && !path->is_failed) {
        cut(w, first, path);
    }
    path->is_failed = path->is_failed || !is_fine;
}

/* --- the answer --------------------------------------------------------------------------------------------------- */

static void answer(wait_t *w, ex_question_t *question)
{
    if (w->is_endless) {
        question->answer = EX_NO;
        show_endless(w, question);
        return;
    }
    const bool is_real = (question->kind == EX_ASK_TIME) && pn_net.real_time;
    question->answer = (question->has_most && (w->longest > question->most)) ? EX_NO : EX_YES;
    if (w->has_event) {
        question->value_kind = is_real ? EX_REAL : EX_INTEGER;
        question->value = w->longest;
    }
    if (question->answer == EX_NO) {
        show_longest(w, question);
    }
}

static bool open_tables(wait_t *w)
{
    ex_run_t *const run = w->queries->run;
    const uint64_t nodes = w->graph->nodes;
    w->waits = ex_set(w->queries);
    w->begins = ex_set(w->queries);
    w->maker = ex_table(&run->memory, nodes, sizeof *w->maker);
    w->before = ex_table(&run->memory, nodes, sizeof *w->before);
    w->degree = ex_table(&run->memory, nodes, sizeof *w->degree);
    w->stack = ex_table(&run->memory, nodes, sizeof *w->stack);
    w->since = ex_table(&run->memory, nodes, sizeof *w->since);
    return (w->waits != NULL) && (w->begins != NULL) && (w->maker != NULL) && (w->before != NULL) && (w->degree != NULL)
           && (w->stack != NULL) && (w->since != NULL);
}

static void close_tables(const wait_t *w)
{
    ex_run_t *const run = w->queries->run;
    const uint64_t nodes = w->graph->nodes;
    ex_free(&run->memory, w->waits, ex_set_words(w->graph) * sizeof *w->waits);
    ex_free(&run->memory, w->begins, ex_set_words(w->graph) * sizeof *w->begins);
    ex_free_table(&run->memory, w->maker, nodes, sizeof *w->maker);
    ex_free_table(&run->memory, w->before, nodes, sizeof *w->before);
    ex_free_table(&run->memory, w->degree, nodes, sizeof *w->degree);
    ex_free_table(&run->memory, w->stack, nodes, sizeof *w->stack);
    ex_free_table(&run->memory, w->since, nodes, sizeof *w->since);
    ex_free_table(&run->memory, w->now, nodes, sizeof *w->now);
    ex_free_table(&run->memory, w->shift, nodes, sizeof *w->shift);
}

void ex_response(ex_queries_t *queries, ex_question_t *question)
{
    wait_t w = {
        .queries = queries, .graph = queries->run->graph, .question = question, .last = EX_NO_NODE, .step = 1.0
    };
    bool is_fine = open_tables(&w);
    if (is_fine) {
        find_beginnings(&w);
        is_fine = spread(&w) && ((question->kind == EX_ASK_FIRINGS) || find_times(&w));
    }
    if (is_fine && !w.is_endless) {
        measure(&w);
    }
    if (is_fine) {
        answer(&w, question);
    } else {
        ex_doubt(queries->run, question);
    }
    close_tables(&w);
}
