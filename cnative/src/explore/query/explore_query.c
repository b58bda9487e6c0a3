/* SPDX-License-Identifier: MIT
 * explore_query.c - the sets that questions need over the whole graph, and the answers.
 */
#include "explore_query.h"

#include <inttypes.h>
#include <stdlib.h>

#include "../search/explore_reduce.h"
#include "pn/pn_arena.h"
#include "pn/pn_num.h"

#define BLOCK 512U /* nodes; a multiple of the bits of a word, so that no two threads write the same one */

/* --- one state after the other ------------------------------------------------------------------------------------ */

typedef struct round {
    ex_queries_t *queries;
    ex_visit_t visit;
    void *user;
    _Atomic uint64_t next;
    _Atomic bool is_failed;
} round_t;

static void visit_blocks(ex_worker_t *worker, void *user)
{
    round_t *const round = user;
    const ex_graph_t *const graph = worker->run->graph;
    while (!atomic_load(&round->is_failed) && !ex_is_stopping(worker->run)) {
        const uint64_t first = atomic_fetch_add(&round->next, BLOCK);
        if (first >= graph->nodes) {
            break;
        }
        const uint64_t end = ((first + BLOCK) < graph->nodes) ? (first + BLOCK) : graph->nodes;
        for (uint64_t node = first; node < end; node++) {
            ex_key_t key;
            if (!ex_store_fetch(&worker->run->store, graph->slot[node], &key)
                || !round->visit(worker, round->user, (uint32_t)node, &key)) {
                atomic_store(&round->is_failed, true);
                break;
            }
        }
    }
}

bool ex_each_node(ex_queries_t *queries, ex_visit_t visit, void *user)
{
    round_t round = { .queries = queries, .visit = visit, .user = user };
    atomic_init(&round.next, 0U);
    atomic_init(&round.is_failed, false);
    ex_parallel(queries->run, visit_blocks, &round);
    return !atomic_load(&round.is_failed) && !ex_is_stopping(queries->run);
}

bool ex_leaf_holds(ex_worker_t *worker, const ex_item_t *item, uint64_t *tokens, bool *raised)
{
    pn_ctx_t *const cx = &worker->cx;
    *raised = false;
    if (item->kind == EX_ITEM_WITHIN) {
        *tokens = pn_multiset_total(pn_net.place[item->number].multiset, worker->marking);
        return (*tokens >= item->low) && (*tokens <= item->high);
    }
    const size_t mark = pn_arena_mark(&worker->scratch->arena);
    const bool holds = pn_net.predicate[item->number].holds(cx, worker->marking);
    pn_arena_release(&worker->scratch->arena, mark);
    if (cx->error == PN_OK) {
        return holds;
    }
    *raised = true;
    if (cx->error == PN_ERR_MEMORY) {
        ex_fail(worker, -1); /* lists and strings can have more */
        return false;
    }
    cx->error = PN_OK; /* the name stays */
    return false;
}

/* The items that have to be asked of each marking. */
typedef struct leaves {
    ex_queries_t *queries;
    uint32_t *item;
    uint32_t count;
} leaves_t;

static bool ask_leaves(ex_worker_t *worker, void *user, uint32_t node, const ex_key_t *key)
{
    const leaves_t *const leaves = user;
    if (!ex_load(worker, key)) {
        return false;
    }
    for (uint32_t i = 0U; i < leaves->count; i++) {
        ex_item_t *const item = &leaves->queries->item[leaves->item[i]];
        uint64_t tokens = 0U;
        bool raised = false;
        if (ex_leaf_holds(worker, item, &tokens, &raised)) {
            EX_SET_BIT(item->set, node);
        }
        if (!raised && (tokens <= item->most)) {
            continue;
        }
        (void)pthread_mutex_lock(&leaves->queries->lock);
        item->most = (tokens > item->most) ? tokens : item->most;
        if (raised && (node < item->raised_at)) {
            item->raised_at = node;
            (void)snprintf(item->raised, sizeof item->raised, "%s", worker->cx.error_name);
        }
        (void)pthread_mutex_unlock(&leaves->queries->lock);
        if (worker->failed) {
            return false;
        }
    }
    return true;
}

/* --- sets --------------------------------------------------------------------------------------------------------- */

static void mark_event(ex_queries_t *queries, const ex_event_t *event)
{
    if (!event->is_transition) {
        queries->item[event->number].is_needed = true;
    }
}

static void mark_automaton(ex_queries_t *queries, const ex_automaton_t *automaton)
{
    for (uint32_t i = 0U; i < automaton->edges; i++) {
        for (uint32_t k = 0U; k < automaton->edge[i].literals; k++) {
            queries->item[automaton->edge[i].literal[k].item].is_needed = true;
        }
    }
    for (uint32_t i = 0U; i < automaton->fair_count; i++) {
        queries->item[automaton->fair_item[i]].is_needed = true;
    }
}

/* Whether a part of the graph tells for each of its nodes whether it is in an item: not of what can occur there, since
 * arcs may be missing. */
static bool is_known_in_part(const ex_queries_t *queries, uint32_t number)
{
    const ex_item_t *const item = &queries->item[number];
    switch (item->kind) {
    case EX_ITEM_TRUE:
    case EX_ITEM_DEAD:
    case EX_ITEM_INITIAL:
    case EX_ITEM_PRED:
    case EX_ITEM_WITHIN: return true;
    case EX_ITEM_NOT:
    case EX_ITEM_AND:
    case EX_ITEM_OR: return is_known_in_part(queries, item->a) && is_known_in_part(queries, item->b);
    case EX_ITEM_ENABLED:
    case EX_ITEM_EX:
    case EX_ITEM_AX:
    case EX_ITEM_EF:
    case EX_ITEM_AF:
    case EX_ITEM_EG:
    case EX_ITEM_AG:
    case EX_ITEM_EU:
    case EX_ITEM_AU:
    case EX_ITEM_EXA:
    default: return false;
    }
}

/* Whether a part of the graph may decide a question: a run that violates a formula or a response, two runs that show
 * that an order matters, or what a formula of CTL says whatever is missing. Whether a run is fair is not known there.
 */
static bool is_of_part(const ex_queries_t *queries, const ex_question_t *question)
{
    const ex_event_t *const first = &question->first;
    const ex_event_t *const second = &question->second;
    if ((question->kind == EX_ASK_FIRINGS) || (question->kind == EX_ASK_TIME)) {
        return (first->is_transition || is_known_in_part(queries, first->number))
               && (second->is_transition || is_known_in_part(queries, second->number));
    }
    if (question->kind == EX_ASK_CONFLUENT) {
        return !question->is_of_orders;
    }
    return (question->kind == EX_ASK_INITIALLY)
           || ((question->kind == EX_ASK_LASSO) && (question->automaton->fair_count == 0U));
}

/* Marks the items on which the questions rest that can be answered. */
static void mark_needed(ex_queries_t *queries)
{
    for (uint32_t i = 0U; i < queries->questions; i++) {
        const ex_question_t *const question = &queries->question[i];
        if (!ex_is_kept(queries, question) || (queries->is_part && !is_of_part(queries, question))) {
            continue;
        }
        switch (question->kind) {
        case EX_ASK_LASSO: mark_automaton(queries, question->automaton); break;
        case EX_ASK_FIRINGS:
        case EX_ASK_TIME:
            mark_event(queries, &question->first);
            mark_event(queries, &question->second);
            break;
        case EX_ASK_BLOCKING:
        case EX_ASK_ENDS:
            if (question->has_item) {
                queries->item[question->a].is_needed = true;
            }
            break;
        case EX_ASK_FINITE:
        case EX_ASK_RESTLESS:
        case EX_ASK_BOUNDED:
        case EX_ASK_CONFLUENT: break; /* they look at arcs alone */
        case EX_ASK_INVARIANT:
        case EX_ASK_BOUND:
        case EX_ASK_INITIALLY:
        default: queries->item[question->a].is_needed = true; break;
        }
    }
    for (uint32_t i = queries->items; i > 0U; i--) {
        const ex_item_t *const item = &queries->item[i - 1U];
        if (item->is_needed && (item->kind >= EX_ITEM_NOT)) {
            queries->item[item->a].is_needed = true;
            queries->item[item->b].is_needed = true;
        }
    }
}

static bool is_leaf(const ex_item_t *item)
{
    return (item->kind == EX_ITEM_PRED) || (item->kind == EX_ITEM_WITHIN);
}

static bool find_leaves(ex_queries_t *queries)
{
    leaves_t leaves = { .queries = queries };
    bool is_fine = true;
    leaves.item = malloc(((size_t)queries->items + 1U) * sizeof *leaves.item);
    for (uint32_t i = 0U; (leaves.item != NULL) && is_fine && (i < queries->items); i++) {
        if (queries->item[i].is_needed && is_leaf(&queries->item[i])) {
            queries->item[i].set = ex_set(queries);
            queries->item[i].may = queries->item[i].set;
            is_fine = queries->item[i].set != NULL;
            leaves.item[leaves.count] = i;
            leaves.count += 1U;
        }
    }
    is_fine = is_fine && (leaves.item != NULL) && ((leaves.count == 0U) || ex_each_node(queries, ask_leaves, &leaves));
    for (uint32_t i = 0U; !is_fine && (i < leaves.count); i++) {
        queries->item[leaves.item[i]].set = NULL; /* some nodes are missing */
    }
    free(leaves.item);
    return is_fine;
}

/* The same set, and some nodes of a part (NULL: of none). NULL: no memory. */
static uint64_t *with_more(const ex_queries_t *queries, uint64_t *set, const uint64_t *more)
{
    const ex_graph_t *const graph = queries->run->graph;
    if ((set == NULL) || (more == NULL)) {
        return set;
    }
    uint64_t *const may = ex_set(queries);
    for (uint64_t i = 0U; (may != NULL) && (i < ex_set_words(graph)); i++) {
        may[i] = set[i] | more[i];
    }
    return may;
}

/* Where transitions are enabled, in one pass over the arcs. Items of the same transition share a set. */
static bool find_enabled(ex_queries_t *queries)
{
    const ex_graph_t *const graph = queries->run->graph;
    uint64_t **const set = calloc((size_t)pn_net.transition_count + 1U, sizeof *set);
    bool is_fine = set != NULL;
    bool is_needed = false;
    for (uint32_t i = 0U; is_fine && (i < queries->items); i++) {
        ex_item_t *const item = &queries->item[i];
        if (!item->is_needed || (item->kind != EX_ITEM_ENABLED)) {
            continue;
        }
        is_needed = true;
        if (set[item->number] == NULL) {
            set[item->number] = ex_set(queries);
        }
        item->set = set[item->number];
        is_fine = item->set != NULL;
    }
    for (uint32_t node = 0U; is_fine && is_needed && (node < graph->nodes); node++) {
        for (uint64_t arc = graph->row[node]; arc < graph->row[node + 1U]; arc++) {
            if (set[graph->label[arc]] != NULL) {
                EX_SET_BIT(set[graph->label[arc]], node);
            }
        }
    }
    for (uint32_t i = 0U; i < queries->items; i++) {
        ex_item_t *const item = &queries->item[i];
        if (item->is_needed && (item->kind == EX_ITEM_ENABLED)) {
            item->may = is_fine ? with_more(queries, item->set, graph->cut) : NULL;
            item->set = (item->may != NULL) ? item->set : NULL;
        }
    }
    free(set);
    return is_fine;
}

/* Of a part, a node may be dead of which it is not known whether it has arcs; one whose arcs lead out of the part is
 * not. */
static bool may_be_dead(const ex_queries_t *queries, ex_item_t *item)
{
    item->may = with_more(queries, item->set, queries->run->graph->open);
    item->set = (item->may != NULL) ? item->set : NULL;
    return item->may != NULL;
}

static bool find_simple(ex_queries_t *queries, ex_item_t *item)
{
    const ex_graph_t *const graph = queries->run->graph;
    item->set = ex_set(queries);
    item->may = item->set;
    if (item->set == NULL) {
        return false;
    }
    if (item->kind == EX_ITEM_INITIAL) {
        EX_SET_BIT(item->set, 0U);
    }
    for (uint32_t node = 0U; (item->kind != EX_ITEM_INITIAL) && (node < graph->nodes); node++) {
        if ((item->kind == EX_ITEM_TRUE) || (EX_BIT(graph->dead, node) != 0U)) {
            EX_SET_BIT(item->set, node);
        }
    }
    return (item->kind != EX_ITEM_DEAD) || may_be_dead(queries, item);
}

/* An exception in an operand is one in the item. */
static void inherit(ex_queries_t *queries, ex_item_t *item)
{
    const ex_item_t *const a = &queries->item[item->a];
    const ex_item_t *const b = &queries->item[item->b];
    const ex_item_t *const from = (b->raised_at < a->raised_at) ? b : a;
    if (from->raised_at != EX_NO_NODE) {
        item->raised_at = from->raised_at;
        (void)memcpy(item->raised, from->raised, sizeof item->raised);
    }
}

/* The sets of all items that are needed, as far as there is memory and time. */
static void find_sets(ex_queries_t *queries)
{
    mark_needed(queries);
    (void)find_leaves(queries);
    (void)find_enabled(queries);
    for (uint32_t i = 0U; i < queries->items; i++) {
        ex_item_t *const item = &queries->item[i];
        if (!item->is_needed || (item->set != NULL) || is_leaf(item) || ex_is_stopping(queries->run)) {
            continue;
        }
        if (item->kind <= EX_ITEM_INITIAL) {
            (void)find_simple(queries, item);
        } else if (item->kind >= EX_ITEM_NOT) {
            inherit(queries, item);
            if ((queries->item[item->a].set != NULL) && (queries->item[item->b].set != NULL)) {
                (void)ex_ctl(queries, item);
            }
        }
    }
}

/* --- answers ------------------------------------------------------------------------------------------------------ */

void ex_doubt(const ex_run_t *run, ex_question_t *question)
{
    const ex_why_t why = (ex_why_t)atomic_load(&run->why);
    question->answer = EX_UNKNOWN;
    question->why = (why == EX_COMPLETE) ? "memory" : ex_why_text(why);
}

bool ex_is_kept(const ex_queries_t *queries, const ex_question_t *question)
{
    const ex_options_t *const options = &queries->run->options;
    if (!options->is_stubborn && !options->is_symmetric) {
        return true;
    }
    const bool is_branching = (question->kind == EX_ASK_BOUND) || (question->kind == EX_ASK_INITIALLY);
    if (options->instances != NULL) { /* each exchange leaves what is asked as it is, and all that it is made of */
        return !options->is_stubborn && ((question->kind == EX_ASK_INVARIANT) || is_branching);
    }
    if (question->kind != EX_ASK_INVARIANT) {
        return false;
    }
    const ex_item_t *const item = &queries->item[question->a];
    return (!options->is_stubborn || item->is_about_dead) && (!options->is_symmetric || item->is_nameless);
}

/* The first node that is not in a set; EX_NO_NODE: all are. */
static uint32_t first_outside(const ex_graph_t *graph, const uint64_t *set)
{
    for (uint64_t i = 0U; i < ex_set_words(graph); i++) {
        for (uint64_t node = i * 64U; (set[i] != UINT64_MAX) && (node < ((i + 1U) * 64U)) && (node < graph->nodes);
             node++) {
            if (EX_BIT(set, node) == 0U) {
                return (uint32_t)node;
            }
        }
    }
    return EX_NO_NODE;
}

static void raise_doubt(const ex_item_t *item, ex_question_t *question)
{
    question->answer = EX_UNKNOWN;
    question->why = item->raised;
    question->node = item->raised_at;
}

static void answer_invariant(ex_queries_t *queries, ex_question_t *question)
{
    const ex_graph_t *const graph = queries->run->graph;
    const ex_item_t *const item = &queries->item[question->a];
    const uint32_t node = first_outside(graph, item->set);
    if ((item->raised_at != EX_NO_NODE) && (item->raised_at <= node)) {
        raise_doubt(item, question);
        return;
    }
    question->answer = (node == EX_NO_NODE) ? EX_YES : EX_NO;
    question->node = node;
    if (question->kind == EX_ASK_BOUND) {
        ex_worker_t *const worker = &queries->run->worker[0];
        ex_key_t key;
        question->value_kind = EX_INTEGER;
        question->value = (double)item->most;
        if ((node != EX_NO_NODE) && ex_store_fetch(&queries->run->store, graph->slot[node], &key)
            && ex_load(worker, &key)) {
            question->value = (double)pn_multiset_total(pn_net.place[item->number].multiset, worker->marking);
        }
    }
}

static void answer_initially(ex_queries_t *queries, ex_question_t *question)
{
    const bool holds = ex_is_in(queries, question->a, 0U);
    if (!holds && !ex_is_known(queries, question->a, 0U, false)) {
        ex_doubt(queries->run, question); /* of a part */
        return;
    }
    question->answer = holds ? EX_YES : EX_NO;
    if (ex_path_begin(&question->path, 0U)) {
        question->path.is_failed = !ex_ctl_explain(queries, question->a, holds, &question->path);
    }
}

static void answer_lasso(ex_queries_t *queries, ex_question_t *question)
{
    if (ex_path_begin(&question->path, 0U)) {
        question->answer = ex_lasso(queries, question->automaton, 0U, &question->path);
    }
    if (question->answer != EX_YES) {
        question->path.is_failed = true;
    }
    if (question->answer == EX_UNKNOWN) {
        ex_doubt(queries->run, question);
    }
}

/* Whether the sets are there that an item stands for, and none of its predicates raised an exception. */
static bool is_ready(const ex_queries_t *queries, uint32_t number, ex_question_t *question)
{
    const ex_item_t *const item = &queries->item[number];
    const bool is_first_counted = (question->kind == EX_ASK_INVARIANT) || (question->kind == EX_ASK_BOUND);
    if ((item->raised_at != EX_NO_NODE) && !is_first_counted) {
        raise_doubt(item, question);
        return false;
    }
    if (item->set == NULL) {
        ex_doubt(queries->run, question);
        return false;
    }
    return true;
}

static bool is_automaton_ready(const ex_queries_t *queries, ex_question_t *question)
{
    const ex_automaton_t *const automaton = question->automaton;
    bool is_fine = true;
    for (uint32_t i = 0U; is_fine && (i < automaton->edges); i++) {
        for (uint32_t k = 0U; is_fine && (k < automaton->edge[i].literals); k++) {
            is_fine = is_ready(queries, automaton->edge[i].literal[k].item, question);
        }
    }
    for (uint32_t i = 0U; is_fine && (i < automaton->fair_count); i++) {
        is_fine = is_ready(queries, automaton->fair_item[i], question);
    }
    return is_fine;
}

static void answer(ex_queries_t *queries, ex_question_t *question)
{
    const ex_event_t *const first = &question->first;
    const ex_event_t *const second = &question->second;
    if (!ex_is_kept(queries, question)) {
        question->why = "reduction";
        return;
    }
    if (question->is_of_orders && !queries->run->is_choiceless) {
        question->why = "orders";
        return;
    }
    switch (question->kind) {
    case EX_ASK_LASSO:
        if (is_automaton_ready(queries, question)) {
            answer_lasso(queries, question);
        }
        break;
    case EX_ASK_FIRINGS:
    case EX_ASK_TIME:
        if ((first->is_transition || is_ready(queries, first->number, question))
            && (second->is_transition || is_ready(queries, second->number, question))) {
            ex_response(queries, question);
        }
        break;
    case EX_ASK_FINITE:
    case EX_ASK_RESTLESS:
    case EX_ASK_BOUNDED:
    case EX_ASK_CONFLUENT:
    case EX_ASK_BLOCKING:
        if ((!question->has_item || is_ready(queries, question->a, question)) && !ex_control(queries, question)) {
            ex_doubt(queries->run, question);
        }
        break;
    case EX_ASK_ENDS:
        if ((!question->has_item || is_ready(queries, question->a, question)) && !ex_running(queries, question)) {
            ex_doubt(queries->run, question);
        }
        break;
    case EX_ASK_INITIALLY:
        if (is_ready(queries, question->a, question)) {
            answer_initially(queries, question);
        }
        break;
    case EX_ASK_INVARIANT:
    case EX_ASK_BOUND:
    default:
        if (is_ready(queries, question->a, question)) {
            answer_invariant(queries, question);
        }
        break;
    }
}

static void write_trace(ex_run_t *run, ex_question_t *question, uint32_t number)
{
    char file[EX_PATH_SIZE];
    ex_path_t *const path = &question->path;
    if ((question->kind == EX_ASK_INITIALLY) && (run->options.instances != NULL)) {
        path->is_failed = true; /* where it comes back to a representative, a run of the net need not */
    }
    const bool is_shown =
        (question->answer != EX_UNKNOWN) || ((question->kind == EX_ASK_ENDS) && (question->node != EX_NO_NODE));
    if ((path->node != NULL) && !path->is_failed && (question->answer != EX_UNKNOWN)) {
        question->node = ex_path_end(path);
    }
    if ((run->options.query_trace_to == NULL) || !is_shown) {
        return;
    }
    (void)snprintf(file, sizeof file, "%s%" PRIu32 ".trace.jsonl", run->options.query_trace_to, number);
    if (path->node == NULL) {
        question->steps = (question->node != EX_NO_NODE) ? ex_write_trace(run, run->graph, question->node, file) : -1;
    } else if (!path->is_failed) {
        question->steps = ex_write_path(run, run->graph, path->node, path->label, path->steps, file, NULL);
    }
}

/* What has stopped the run stops it no more. */
static void revive(ex_run_t *run)
{
    for (uint32_t i = 0U; i < run->options.threads; i++) {
        run->worker[i].cx.error = PN_OK;
        run->worker[i].failed = false;
        ex_unload(&run->worker[i]);
    }
    atomic_store(&run->is_stopping, false);
}

/* A run of a part of the graph that was found to violate a question, or a formula of CTL that is known; else the
 * question stays open. */
static void answer_in_part(ex_queries_t *queries, ex_question_t *question)
{
    const ex_answer_t violated = (question->kind == EX_ASK_LASSO) ? EX_YES : EX_NO;
    answer(queries, question);
    if ((question->answer != violated) && (question->kind != EX_ASK_INITIALLY)) {
        question->path.is_failed = true;
        question->node = EX_NO_NODE;
        question->value_kind = EX_NO_VALUE;
        ex_doubt(queries->run, question);
    }
}

/* After an exploration that came to a limit: whether the first nodes have a run that violates what is asked of runs.
 * The graph of these nodes may be wanted in any case. */
static void answer_by_part(ex_run_t *run)
{
    ex_queries_t *const queries = run->queries;
    const int why = atomic_load(&run->why);
    bool is_asked = run->options.writes_part;
    for (uint32_t i = 0U; i < queries->questions; i++) {
        is_asked = is_asked || is_of_part(queries, &queries->question[i]);
    }
    if (!is_asked || (why < (int)EX_STATES) || (why > (int)EX_INFINITE) || !ex_is_exact(run) || (run->reduction != NULL)
        || !run->options.has_graph || run->is_seen_whole) {
        return;
    }
    revive(run);
    queries->is_part = true;
    const bool is_made = ex_graph(run);
    int now = atomic_load(&run->why);
    if (now <= (int)EX_INFINITE) {
        atomic_store(&run->why, why); /* that this found no room is not why the run has ended */
    }
    if (is_made) {
        find_sets(queries);
    }
    for (uint32_t i = 0U; is_made && (i < queries->questions); i++) {
        ex_question_t *const question = &queries->question[i];
        if (is_of_part(queries, question) && (question->answer == EX_UNKNOWN)) {
            answer_in_part(queries, question);
            write_trace(run, question, i);
        }
    }
    now = atomic_load(&run->why);
    if (now <= (int)EX_INFINITE) {
        atomic_store(&run->why, why);
    }
}

void ex_queries_answer(ex_run_t *run)
{
    ex_queries_t *const queries = run->queries;
    if ((run->graph == NULL) || !run->graph->is_whole) {
        ex_early_answer(run);
        answer_by_part(run);
        return;
    }
    find_sets(queries);
    for (uint32_t i = 0U; i < queries->questions; i++) {
        answer(queries, &queries->question[i]);
        ex_early_conclude(run, &queries->question[i]);
        write_trace(run, &queries->question[i], i);
    }
}
