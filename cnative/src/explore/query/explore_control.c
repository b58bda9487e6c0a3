/* SPDX-License-Identifier: MIT
 * explore_control.c - whether a supervisor may follow its execution scheme (docs/execution.md) in the cell whose state
 * space this is.
 *
 * A *step* is an arc of the supervisor that takes no time to wait for: one firing of its cycle. The supervisor *rests*
 * where there is none.
 *
 *   finite response   no run of steps goes on for ever
 *   restless          the same of the steps of a set (`instant`), and how many transitions of robots a run has
 *   bounded response  the longest run of steps
 *   confluence        from each node all runs of steps come to rest in the same node
 *   non-blocking      of its steps the supervisor does only the first in the documented order, all others do what they
 *                     like: from each node that can be reached so, a node can be reached in which it rests and that is
 *                     final
 *
 * The first three come of one walk over the steps, the last of a search forwards and one backwards. All are linear in
 * the graph.
 */
#include "explore_query.h"

#include <stdlib.h>

typedef struct ex_control {
    ex_queries_t *queries;
    const ex_graph_t *graph;
    uint32_t *length; /* by node: the longest run of steps from there; EX_NO_NODE: one without end */
    uint32_t *rest;   /* by node: where all runs of steps end; EX_NO_NODE: not in one node; UNKNOWN: arcs are missing */
    uint64_t *left;   /* a bit for each node whose runs are known */
    uint8_t set;      /* steps are those of this set of `instant` ones (a bit); 0: the supervisor's */
} control_t;

#define UNKNOWN (EX_NO_NODE - 1U)

static bool is_supervisor(const control_t *c, uint64_t arc)
{
    const ex_programs_t *const programs = c->queries->run->programs;
    const uint16_t transition = c->graph->label[arc];
    if (c->set != 0U) {
        return (programs != NULL) && ((programs->instant[transition] & c->set) != 0U);
    }
    return (c->queries->owner[transition] == 0U) && ((programs == NULL) || !programs->is_silent[transition]);
}

/* What a step adds to the length of a run; in a set only the transitions of robots count. */
static uint32_t weight(const control_t *c, uint64_t arc)
{
    const uint16_t transition = c->graph->label[arc];
    const bool is_other =
        (c->set != 0U) && ((c->queries->owner[transition] == 0U) || c->queries->run->programs->is_silent[transition]);
    return is_other ? 0U : 1U;
}

static bool is_late(const control_t *c, uint32_t node)
{
    return (c->graph->late != NULL) && (EX_BIT(c->graph->late, node) != 0U);
}

/* The first step of a node, or the next one after that; EX_NO_SLOT: there is none. */
static uint64_t next_step(const control_t *c, uint32_t node, uint64_t arc)
{
    const uint64_t end = is_late(c, node) ? arc : c->graph->row[node + 1U];
    uint64_t at = arc;
    while ((at < end) && !is_supervisor(c, at)) {
        at += 1U;
    }
    return (at < end) ? at : EX_NO_SLOT;
}

static uint64_t first_step(const control_t *c, uint32_t node)
{
    return next_step(c, node, c->graph->row[node]);
}

/* --- runs of steps ------------------------------------------------------------------------------------------------ */

/* All steps of the node lead to nodes that are known, or on the way to it. */
static void leave(control_t *c, uint32_t node)
{
    const ex_graph_t *const g = c->graph;
    uint32_t length = 0U;
    uint32_t rest = node;
    bool is_endless = false;
    bool is_first = true;
    bool is_known = (g->cut == NULL) || (EX_BIT(g->cut, node) == 0U);
    for (uint64_t arc = first_step(c, node); arc != EX_NO_SLOT; arc = next_step(c, node, arc + 1U)) {
        const uint32_t target = g->target[arc];
        is_endless = is_endless || (EX_BIT(c->left, target) == 0U) || (c->length[target] == EX_NO_NODE);
        if (!is_endless) {
            is_known = is_known && (c->rest[target] != UNKNOWN);
            const uint32_t own = c->length[target] + weight(c, arc);
            length = (length > own) ? length : own;
            rest = (is_first || (rest == c->rest[target])) ? c->rest[target] : EX_NO_NODE;
        }
        is_first = false;
    }
    c->length[node] = is_endless ? EX_NO_NODE : length;
    c->rest[node] = is_endless ? EX_NO_NODE : (is_known ? rest : UNKNOWN);
    EX_SET_BIT(c->left, node);
}

/* Depth first. `stack` holds nodes, `at` their next arc. False: told to stop. */
static bool walk(control_t *c, uint64_t *entered, uint32_t *stack, uint64_t *at)
{
    const ex_graph_t *const g = c->graph;
    uint64_t turns = 0U;
    for (uint32_t root = 0U; root < g->nodes; root++) {
        uint64_t depth = 0U;
        if (EX_BIT(entered, root) == 0U) {
            EX_SET_BIT(entered, root);
            stack[0] = root;
            at[0] = first_step(c, root);
            depth = 1U;
        }
        while (depth > 0U) {
            const uint32_t node = stack[depth - 1U];
            const uint64_t arc = at[depth - 1U];
            turns += 1U;
            if (((turns & 0xfffU) == 0U) && ex_is_stopping(c->queries->run)) {
                return false;
            }
            if (arc == EX_NO_SLOT) {
                leave(c, node);
                depth -= 1U;
                continue;
            }
            const uint32_t target = g->target[arc];
            at[depth - 1U] = next_step(c, node, arc + 1U);
            if (EX_BIT(entered, target) == 0U) {
                EX_SET_BIT(entered, target);
                stack[depth] = target;
                at[depth] = first_step(c, target);
                depth += 1U;
            }
        }
    }
    return true;
}

static void forget(control_t *c)
{
    ex_run_t *const run = c->queries->run;
    const uint64_t nodes = c->graph->nodes;
    ex_free_table(&run->memory, c->length, nodes, sizeof *c->length);
    ex_free_table(&run->memory, c->rest, nodes, sizeof *c->rest);
    ex_free(&run->memory, c->left, ex_set_words(c->graph) * sizeof *c->left);
    ex_free(&run->memory, c, sizeof *c);
}

/* What is known of the steps. NULL: no memory, or told to stop. */
static control_t *worked_out(ex_queries_t *queries, uint8_t set)
{
    ex_run_t *const run = queries->run;
    const uint64_t nodes = run->graph->nodes;
    control_t *const c = ex_alloc(&run->memory, sizeof *c);
    if (c == NULL) {
        return NULL;
    }
    *c = (control_t){ .queries = queries, .graph = run->graph, .set = set };
    c->length = ex_table(&run->memory, nodes, sizeof *c->length);
    c->rest = ex_table(&run->memory, nodes, sizeof *c->rest);
    c->left = ex_set(queries);
    uint64_t *const entered = ex_set(queries);
    uint32_t *const stack = ex_table(&run->memory, nodes, sizeof *stack);
    uint64_t *const at = ex_table(&run->memory, nodes, sizeof *at);
    const bool has_memory = (c->length != NULL) && (c->rest != NULL) && (c->left != NULL) && (entered != NULL)
                            && (stack != NULL) && (at != NULL);
    const bool is_done = has_memory && walk(c, entered, stack, at);
    ex_free(&run->memory, entered, ex_set_words(run->graph) * sizeof *entered);
    ex_free_table(&run->memory, stack, nodes, sizeof *stack);
    ex_free_table(&run->memory, at, nodes, sizeof *at);
    if (!is_done) {
        forget(c);
        return NULL;
    }
    return c;
}

/* That of the supervisor's steps, worked out once. */
static const control_t *known(ex_queries_t *queries)
{
    if (queries->control == NULL) {
        queries->control = worked_out(queries, 0U);
    }
    return queries->control;
}

/* --- searches ----------------------------------------------------------------------------------------------------- */

/* Breadth first: by node, the one from which it was reached and the arc; EX_NO_NODE: it was not. */
typedef struct search {
    uint32_t *from;
    uint64_t *by;
    uint32_t *queue;
    uint64_t used;
} search_t;

static void search_close(const control_t *c, search_t *s)
{
    ex_run_t *const run = c->queries->run;
    const uint64_t nodes = c->graph->nodes;
    ex_free_table(&run->memory, s->from, nodes, sizeof *s->from);
    ex_free_table(&run->memory, s->by, nodes, sizeof *s->by);
    ex_free_table(&run->memory, s->queue, nodes, sizeof *s->queue);
}

static bool search_open(const control_t *c, search_t *s)
{
    ex_run_t *const run = c->queries->run;
    const uint64_t nodes = c->graph->nodes;
    s->used = 0U;
    s->from = ex_table(&run->memory, nodes, sizeof *s->from);
    s->by = ex_table(&run->memory, nodes, sizeof *s->by);
    s->queue = ex_table(&run->memory, nodes, sizeof *s->queue);
    if ((s->from == NULL) || (s->by == NULL) || (s->queue == NULL)) {
        search_close(c, s);
        return false;
    }
    (void)memset(s->from, 0xff, nodes * sizeof *s->from);
    return true;
}

static void search_add(search_t *s, uint32_t node, uint32_t from, uint64_t by)
{
    if (s->from[node] == EX_NO_NODE) {
        s->from[node] = from;
        s->by[node] = by;
        s->queue[s->used] = node;
        s->used += 1U;
    }
}

/* Adds what leads from where the search began to `node`, which it has reached. */
static void search_path(const control_t *c, const search_t *s, uint32_t node, ex_path_t *path)
{
    const uint32_t begin = s->queue[0];
    uint64_t count = 0U;
    for (uint32_t at = node; at != begin; at = s->from[at]) {
        count += 1U;
    }
    uint32_t *const list = malloc((count + 1U) * sizeof *list);
    if (list == NULL) {
        path->is_failed = true;
        return;
    }
    uint64_t i = count;
    for (uint32_t at = node; at != begin; at = s->from[at]) {
        i -= 1U;
        list[i] = at;
    }
    for (i = 0U; i < count; i++) {
        ex_path_step(path, c->graph->label[s->by[list[i]]], list[i]);
    }
    free(list);
}

/* --- answers ------------------------------------------------------------------------------------------------------ */

static void say_number(ex_question_t *question, uint64_t number)
{
    question->value_kind = EX_INTEGER;
    question->value = (double)number;
}

/* A way to a node, from the initial one. */
static void begin_path(const control_t *c, ex_question_t *question, uint32_t node)
{
    question->node = node;
    if (ex_path_begin(&question->path, 0U)) {
        ex_path_from_start(c->graph, node, &question->path);
    }
}

/* The first node with a run of steps without end; EX_NO_NODE: there is none. */
static uint32_t first_endless(const control_t *c)
{
    uint32_t node = 0U;
    while ((node < c->graph->nodes) && (c->length[node] != EX_NO_NODE)) {
        node += 1U;
    }
    return (node < c->graph->nodes) ? node : EX_NO_NODE;
}

/* A node to which a run of steps without end comes again and again; EX_NO_NODE: no memory. */
static uint32_t on_cycle(const control_t *c, uint32_t begin)
{
    ex_run_t *const run = c->queries->run;
    uint64_t *const seen = ex_set(c->queries);
    uint32_t node = begin;
    if (seen == NULL) {
        return EX_NO_NODE;
    }
    while (EX_BIT(seen, node) == 0U) {
        EX_SET_BIT(seen, node);
        uint64_t arc = first_step(c, node);
        while (c->length[c->graph->target[arc]] != EX_NO_NODE) {
            arc = next_step(c, node, arc + 1U); /* one of them is endless */
        }
        node = c->graph->target[arc];
    }
    ex_free(&run->memory, seen, ex_set_words(c->graph) * sizeof *seen);
    return node;
}

/* Adds a shortest run of steps from the end of the way to `goal`, of one step at least. */
static void steps_to(const control_t *c, uint32_t goal, ex_path_t *path)
{
    search_t s;
    const uint32_t begin = ex_path_end(path);
    uint64_t closing = EX_NO_SLOT; /* the step to the goal, and where it comes from */
    uint32_t last = begin;
    if (!search_open(c, &s)) {
        path->is_failed = true;
        return;
    }
    search_add(&s, begin, begin, 0U);
    for (uint64_t i = 0U; (i < s.used) && (closing == EX_NO_SLOT) && !ex_is_stopping(c->queries->run); i++) {
        const uint32_t node = s.queue[i];
        for (uint64_t arc = first_step(c, node); arc != EX_NO_SLOT; arc = next_step(c, node, arc + 1U)) {
            if (c->graph->target[arc] == goal) {
                closing = arc;
                last = node;
                break;
            }
            search_add(&s, c->graph->target[arc], node, arc);
        }
    }
    if (closing != EX_NO_SLOT) {
        search_path(c, &s, last, path);
        ex_path_step(path, c->graph->label[closing], goal);
    } else {
        path->is_failed = true;
    }
    search_close(c, &s);
}

static void answer_finite(const control_t *c, ex_question_t *question)
{
    const uint32_t node = first_endless(c);
    question->answer = (node == EX_NO_NODE) ? EX_YES : EX_NO;
    if (node == EX_NO_NODE) {
        return;
    }
    begin_path(c, question, node);
    const uint32_t again = question->path.is_failed ? EX_NO_NODE : on_cycle(c, node);
    if (again == EX_NO_NODE) {
        question->path.is_failed = true;
        return;
    }
    if (again != node) {
        steps_to(c, again, &question->path);
    }
    if (!question->path.is_failed) {
        question->path.loop = (int64_t)question->path.steps;
        steps_to(c, again, &question->path);
    }
}

static void answer_bounded(const control_t *c, ex_question_t *question)
{
    uint32_t node = 0U;
    for (uint32_t i = 1U; i < c->graph->nodes; i++) {
        node = (c->length[i] > c->length[node]) ? i : node;
    }
    const uint64_t most = c->length[node];
    question->answer = ((double)most <= question->most) ? EX_YES : EX_NO;
    say_number(question, most);
    begin_path(c, question, node);
    while ((c->length[node] > 0U) && !question->path.is_failed) {
        uint64_t arc = first_step(c, node);
        while ((c->length[c->graph->target[arc]] + weight(c, arc)) != c->length[node]) {
            arc = next_step(c, node, arc + 1U);
        }
        node = c->graph->target[arc];
        ex_path_step(&question->path, c->graph->label[arc], node);
    }
}

/* Where the order matters and after the next step no more; EX_NO_NODE: nowhere. */
static uint32_t first_branch(const control_t *c)
{
    for (uint32_t node = 0U; node < c->graph->nodes; node++) {
        bool is_last = c->rest[node] == EX_NO_NODE;
        for (uint64_t arc = first_step(c, node); is_last && (arc != EX_NO_SLOT); arc = next_step(c, node, arc + 1U)) {
            is_last = c->rest[c->graph->target[arc]] != EX_NO_NODE;
        }
        if (is_last) {
            return node;
        }
    }
    return EX_NO_NODE;
}

/* `a` says which of the two outcomes the way shows: 0 the one of the documented order. */
static void answer_confluent(const control_t *c, ex_question_t *question)
{
    const uint32_t branch = first_branch(c);
    question->answer = (branch == EX_NO_NODE) ? EX_YES : EX_NO;
    if (branch == EX_NO_NODE) {
        return;
    }
    begin_path(c, question, branch);
    say_number(question, question->path.steps);
    uint64_t arc = first_step(c, branch);
    const uint32_t usual = c->rest[c->graph->target[arc]];
    while ((question->a > 0U) && (c->rest[c->graph->target[arc]] == usual)) {
        arc = next_step(c, branch, arc + 1U);
    }
    while ((arc != EX_NO_SLOT) && !question->path.is_failed) {
        const uint32_t node = c->graph->target[arc];
        ex_path_step(&question->path, c->graph->label[arc], node);
        arc = first_step(c, node);
    }
}

/* --- non-blocking ------------------------------------------------------------------------------------------------- */

/* The run is over: the supervisor rests, and the node is final. */
static bool is_over(const control_t *c, const ex_question_t *question, uint32_t node)
{
    return question->has_item && ex_is_in(c->queries, question->a, node) && (first_step(c, node) == EX_NO_SLOT);
}

/* The first arc of the supervisor, at whatever time; EX_NO_SLOT: there is none. */
static uint64_t chosen(const control_t *c, uint32_t node)
{
    for (uint64_t arc = c->graph->row[node]; arc < c->graph->row[node + 1U]; arc++) {
        if (is_supervisor(c, arc)) {
            return arc;
        }
    }
    return EX_NO_SLOT;
}

/* What can be reached under control. False: told to stop. */
static bool reach(const control_t *c, const ex_question_t *question, search_t *s)
{
    search_add(s, 0U, 0U, 0U);
    for (uint64_t i = 0U; i < s->used; i++) {
        const uint32_t node = s->queue[i];
        if (((i & 0xfffU) == 0U) && ex_is_stopping(c->queries->run)) {
            return false;
        }
        if (is_over(c, question, node)) {
            continue;
        }
        const uint64_t own = chosen(c, node);
        for (uint64_t arc = c->graph->row[node]; arc < c->graph->row[node + 1U]; arc++) {
            if ((arc == own) || !is_supervisor(c, arc)) {
                search_add(s, c->graph->target[arc], node, arc);
            }
        }
    }
    return true;
}

/* The arcs under control backwards: those to node i come from source[row[i]] .. source[row[i + 1] - 1]. Counted first,
 * then filled from behind; row[i + 1] is where node i's begin meanwhile. */
static void turn(const control_t *c, const ex_question_t *question, const search_t *s, uint64_t *row, uint32_t *source)
{
    const uint32_t nodes = c->graph->nodes;
    uint64_t all = 0U;
    for (uint32_t pass = 0U; pass < 2U; pass++) {
        for (uint64_t i = 0U; i < s->used; i++) {
            const uint32_t node = s->queue[i];
            const uint64_t own = chosen(c, node);
            const uint64_t end = is_over(c, question, node) ? c->graph->row[node] : c->graph->row[node + 1U];
            for (uint64_t arc = c->graph->row[node]; arc < end; arc++) {
                uint64_t *const at = &row[c->graph->target[arc] + 1U];
                if ((arc != own) && is_supervisor(c, arc)) {
                    continue;
                }
                if (pass == 0U) {
                    *at += 1U;
                } else {
                    *at -= 1U;
                    source[*at] = node;
                }
            }
        }
        for (uint32_t node = 0U; (pass == 0U) && (node < nodes); node++) {
            row[node + 1U] += row[node];
        }
        all = (pass == 0U) ? row[nodes] : all;
    }
    for (uint32_t node = 0U; node < nodes; node++) {
        row[node] = row[node + 1U];
    }
    row[nodes] = all;
}

/* The nodes from which a node where the run is over can be reached. False: told to stop. */
static bool grow(const control_t *c, const ex_question_t *question, const search_t *s, const uint64_t *row,
                 const uint32_t *source, uint64_t *good, uint32_t *stack)
{
    uint64_t used = 0U;
    uint64_t turns = 0U;
    for (uint64_t i = 0U; i < s->used; i++) {
        if (is_over(c, question, s->queue[i])) {
            EX_SET_BIT(good, s->queue[i]);
            stack[used] = s->queue[i];
            used += 1U;
        }
    }
    while (used > 0U) {
        used -= 1U;
        const uint32_t node = stack[used];
        turns += 1U;
        if (((turns & 0xfffU) == 0U) && ex_is_stopping(c->queries->run)) {
            return false;
        }
        for (uint64_t i = row[node]; i < row[node + 1U]; i++) {
            if (EX_BIT(good, source[i]) == 0U) {
                EX_SET_BIT(good, source[i]);
                stack[used] = source[i];
                used += 1U;
            }
        }
    }
    return true;
}

/* What of the nodes under control can come to an end: `good`. False: no memory, or told to stop. */
static bool find_good(const control_t *c, const ex_question_t *question, const search_t *s, uint64_t *good)
{
    ex_run_t *const run = c->queries->run;
    const uint64_t nodes = c->graph->nodes;
    uint64_t *const row = ex_table(&run->memory, nodes + 1U, sizeof *row);
    uint32_t *const source = ex_table(&run->memory, c->graph->arcs, sizeof *source);
    uint32_t *const stack = ex_table(&run->memory, nodes, sizeof *stack);
    bool is_done = (row != NULL) && (source != NULL) && (stack != NULL);
    if (is_done) {
        turn(c, question, s, row, source);
        is_done = grow(c, question, s, row, source, good, stack);
    }
    ex_free_table(&run->memory, row, nodes + 1U, sizeof *row);
    ex_free_table(&run->memory, source, c->graph->arcs, sizeof *source);
    ex_free_table(&run->memory, stack, nodes, sizeof *stack);
    return is_done;
}

/* Of the nodes that have no way to an end the first dead one, or the first. */
static void judge(const control_t *c, ex_question_t *question, const search_t *s, const uint64_t *good)
{
    uint32_t bad = EX_NO_NODE;
    bool is_dead = false;
    for (uint64_t i = 0U; (i < s->used) && !is_dead; i++) {
        const uint32_t node = s->queue[i];
        const bool is_end = EX_BIT(c->graph->dead, node) != 0U;
        const bool is_bad = (good != NULL) ? (EX_BIT(good, node) == 0U) : is_end;
        if (is_bad && ((bad == EX_NO_NODE) || is_end)) {
            bad = node;
            is_dead = is_end;
        }
    }
    question->answer = (bad == EX_NO_NODE) ? EX_YES : EX_NO;
    say_number(question, s->used);
    if (bad != EX_NO_NODE) {
        question->node = bad;
        question->why = is_dead ? "deadlock" : "endless";
        if (ex_path_begin(&question->path, 0U)) {
            search_path(c, s, bad, &question->path);
        }
    }
}

/* False: no memory, or told to stop. */
static bool answer_blocking(const control_t *c, ex_question_t *question)
{
    search_t s;
    if (!search_open(c, &s)) {
        return false;
    }
    bool is_done = reach(c, question, &s);
    if (is_done && question->has_item) {
        uint64_t *const good = ex_set(c->queries);
        is_done = (good != NULL) && find_good(c, question, &s, good);
        if (is_done) {
            judge(c, question, &s, good);
        }
        ex_free(&c->queries->run->memory, good, ex_set_words(c->graph) * sizeof *good);
    } else if (is_done) {
        judge(c, question, &s, NULL); /* nothing is final: it must only never come to a standstill */
    }
    search_close(c, &s);
    return is_done;
}

/* False: no memory, or told to stop. */
static bool answer_restless(ex_queries_t *queries, ex_question_t *question)
{
    control_t *const c = worked_out(queries, (uint8_t)(1U << question->a));
    if (c == NULL) {
        return false;
    }
    answer_finite(c, question);
    if (question->answer == EX_YES) {
        answer_bounded(c, question);
    }
    forget(c);
    return true;
}

bool ex_control(ex_queries_t *queries, ex_question_t *question)
{
    if (question->kind == EX_ASK_RESTLESS) {
        return answer_restless(queries, question);
    }
    const control_t *const c = known(queries);
    if (c == NULL) {
        return false;
    }
    if (question->kind == EX_ASK_FINITE) {
        answer_finite(c, question);
        return true;
    }
    if (question->kind == EX_ASK_BLOCKING) {
        return answer_blocking(c, question);
    }
    if (first_endless(c) != EX_NO_NODE) {
        question->answer = EX_UNKNOWN;
        question->why = "endless";
    } else if (question->kind == EX_ASK_BOUNDED) {
        answer_bounded(c, question);
    } else {
        answer_confluent(c, question);
    }
    return true;
}
