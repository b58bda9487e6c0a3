/* SPDX-License-Identifier: MIT
 * explore_query_early.c - questions that a single state can decide, while the net is explored.
 *
 * An invariant whose item looks at one state only is decided by a state that is not in it, or in which a predicate
 * raises an exception. When all questions are decided so, the exploration ends. Threads may find several such states;
 * which one is reported is found out by going through the known states in breadth-first order.
 */
#include "explore_query.h"
#include "../swarm/explore_swarm.h"
#include "../sweep/explore_sweep.h"
#include "../search/explore_successors.h"
#include "explore_early.h"

#include <inttypes.h>
#include <stdlib.h>

#include "../graph/explore_rescan.h"

/* What one thread knows of the state that it has expanded last. */
struct ex_early {
    bool *holds; /* by item; of those that open questions may need */
    bool *raised;
    uint64_t *tokens;
    uint64_t *most;  /* tokens in any state */
    uint64_t *fired; /* by transition: worker->fired before the state was expanded */
    char (*message)[EX_RAISED_SIZE];
};

static bool is_early(const ex_queries_t *queries, const ex_question_t *question)
{
    const bool is_of_states = (question->kind == EX_ASK_INVARIANT) || (question->kind == EX_ASK_BOUND);
    return is_of_states && queries->item[question->a].is_local && ex_is_kept(queries, question);
}

bool ex_early_make(ex_worker_t *worker)
{
    ex_queries_t *const queries = worker->run->queries;
    struct ex_early *const early = calloc(1U, sizeof *early);
    if (early == NULL) {
        return false;
    }
    worker->early = early;
    const size_t items = (size_t)queries->items + 1U;
    early->holds = calloc(items, sizeof *early->holds);
    early->raised = calloc(items, sizeof *early->raised);
    early->tokens = calloc(items, sizeof *early->tokens);
    early->most = calloc(items, sizeof *early->most);
    early->message = calloc(items, sizeof *early->message);
    early->fired = calloc((size_t)pn_net.transition_count + 1U, sizeof *early->fired);
    if (worker->index == 0U) {
        atomic_store(&queries->open, queries->questions);
        for (uint32_t i = 0U; i < queries->questions; i++) {
            if (is_early(queries, &queries->question[i])) {
                queries->item[queries->question[i].a].is_early = true;
                (void)atomic_fetch_add(&queries->open_early, 1U);
            }
        }
        if (queries->has_avoid) {
            queries->item[queries->avoid].is_early = true;
        }
        if (queries->has_seek) {
            queries->item[queries->seek].is_early = true;
        }
        for (uint32_t i = queries->items; i > 0U; i--) {
            const ex_item_t *const item = &queries->item[i - 1U];
            if (item->is_early && (item->kind >= EX_ITEM_NOT)) {
                queries->item[item->a].is_early = true;
                queries->item[item->b].is_early = true;
            }
            queries->needs_enabled = queries->needs_enabled || (item->is_early && (item->kind == EX_ITEM_ENABLED));
        }
    }
    return (early->holds != NULL) && (early->raised != NULL) && (early->tokens != NULL) && (early->most != NULL)
           && (early->message != NULL) && (early->fired != NULL);
}

/* Works out the items in the state of worker->marking. */
static void look(ex_worker_t *worker, bool is_initial, ex_found_t found)
{
    struct ex_early *const early = worker->early;
    const ex_queries_t *const queries = worker->run->queries;
    for (uint32_t i = 0U; (i < queries->items) && !worker->failed; i++) {
        const ex_item_t *const item = &queries->item[i];
        if (!item->is_early) {
            continue;
        }
        early->raised[i] = false;
        switch (item->kind) {
        case EX_ITEM_TRUE: early->holds[i] = true; break;
        case EX_ITEM_DEAD: early->holds[i] = found == EX_DEAD; break;
        case EX_ITEM_INITIAL: early->holds[i] = is_initial; break;
        case EX_ITEM_ENABLED: early->holds[i] = worker->fired[item->number] != early->fired[item->number]; break;
        case EX_ITEM_PRED:
        case EX_ITEM_WITHIN:
            early->holds[i] = ex_leaf_holds(worker, item, &early->tokens[i], &early->raised[i]);
            early->most[i] = (early->tokens[i] > early->most[i]) ? early->tokens[i] : early->most[i];
            if (early->raised[i]) {
                (void)snprintf(early->message[i], EX_RAISED_SIZE, "%s", worker->cx.error_name);
            }
            break;
        case EX_ITEM_NOT: early->holds[i] = !early->holds[item->a]; break;
        case EX_ITEM_AND: early->holds[i] = early->holds[item->a] && early->holds[item->b]; break;
        case EX_ITEM_OR: early->holds[i] = early->holds[item->a] || early->holds[item->b]; break;
        case EX_ITEM_EX:
        case EX_ITEM_AX:
        case EX_ITEM_EF:
        case EX_ITEM_AF:
        case EX_ITEM_EG:
        case EX_ITEM_AG:
        case EX_ITEM_EU:
        case EX_ITEM_AU:
        case EX_ITEM_EXA:
        default: /* not local */ break;
        }
        if (item->kind >= EX_ITEM_NOT) {
            const uint32_t from = early->raised[item->a] ? item->a : item->b;
            early->raised[i] = early->raised[from];
            (void)memcpy(early->message[i], early->message[from], early->raised[i] ? EX_RAISED_SIZE : 0U);
        }
    }
    if (queries->needs_enabled) {
        (void)memcpy(early->fired, worker->fired, pn_net.transition_count * sizeof *early->fired);
    }
}

static bool is_same(const ex_key_t *a, const ex_key_t *b)
{
    return (a->low == b->low) && (a->high == b->high);
}

/* The state as it was before time went on, with all its places. */
static bool load(ex_worker_t *worker, const ex_key_t *key)
{
    return (!pn_net.timed && (worker->local == NULL)) || ex_load(worker, key);
}

static bool is_decided(const ex_worker_t *worker, const ex_question_t *question)
{
    return !worker->early->holds[question->a] || worker->early->raised[question->a];
}

bool ex_early_avoids(ex_worker_t *worker, const ex_key_t *key)
{
    const ex_queries_t *const queries = worker->run->queries;
    if (!queries->has_avoid || !ex_load(worker, key)) {
        return false;
    }
    look(worker, is_same(key, &worker->run->initial), EX_SOME);
    return worker->early->holds[queries->avoid] && !worker->early->raised[queries->avoid];
}

void ex_early_see(ex_worker_t *worker, const ex_key_t *key, ex_found_t found)
{
    ex_run_t *const run = worker->run;
    ex_queries_t *const queries = run->queries;
    const bool is_sought = queries->has_seek && (found == EX_DEAD);
    const bool is_open = atomic_load_explicit(&queries->open_early, memory_order_relaxed) > 0U;
    if ((!is_open && !is_sought) || !load(worker, key)) {
        return;
    }
    look(worker, is_same(key, &run->initial), found);
    if (is_sought && worker->early->holds[queries->seek] && !worker->early->raised[queries->seek]) {
        ex_stop(run, EX_STATES);
    }
    for (uint32_t i = 0U; (i < queries->questions) && !worker->failed; i++) {
        ex_question_t *const question = &queries->question[i];
        if (!is_early(queries, question) || !is_decided(worker, question) || atomic_load(&question->is_decided)) {
            continue;
        }
        if (worker->early->raised[question->a]) {
            atomic_store(&question->is_raised, true);
        }
        if (!atomic_exchange(&question->is_decided, true)) {
            (void)atomic_fetch_sub(&queries->open_early, 1U);
            if (run->swarm != NULL) {
                ex_swarm_decided(worker, question, i, found);
            }
            if (run->sweep != NULL) {
                ex_sweep_decided(run, i);
            }
            if (atomic_fetch_sub(&queries->open, 1U) == 1U) {
                ex_stop(run, EX_DECIDED);
            }
        }
    }
}

/* --- what was decided --------------------------------------------------------------------------------------------- */

typedef struct finding {
    ex_run_t *run;
    uint32_t open; /* questions whose states have not been met yet */
} finding_t;

static void forget(finding_t *finding)
{
    const ex_queries_t *const queries = finding->run->queries;
    finding->open = 0U;
    for (uint32_t i = 0U; i < queries->questions; i++) {
        queries->question[i].node = EX_NO_NODE;
        finding->open += atomic_load(&queries->question[i].is_decided) ? 1U : 0U;
    }
}

static void decide(const ex_worker_t *worker, ex_question_t *question, uint32_t node)
{
    const ex_item_t *const item = &worker->run->queries->item[question->a];
    const struct ex_early *const early = worker->early;
    question->node = node;
    if (early->raised[question->a]) {
        question->answer = EX_UNKNOWN;
        (void)memcpy(question->message, early->message[question->a], sizeof question->message);
        question->why = question->message;
        return;
    }
    question->answer = EX_NO;
    if (item->kind == EX_ITEM_WITHIN) {
        question->value_kind = EX_INTEGER;
        question->value = (double)early->tokens[question->a];
    }
}

static bool find(void *user, uint32_t node, const ex_key_t *key, ex_found_t found)
{
    finding_t *const finding = user;
    ex_worker_t *const worker = &finding->run->worker[0];
    ex_queries_t *const queries = finding->run->queries;
    if ((found == EX_FAILED) || !load(worker, key)) {
        return false;
    }
    if (node == 0U) { /* perhaps once more, since a table has grown */
        forget(finding);
    }
    look(worker, node == 0U, found);
    for (uint32_t i = 0U; i < queries->questions; i++) {
        ex_question_t *const question = &queries->question[i];
        if (is_early(queries, question) && (question->node == EX_NO_NODE) && is_decided(worker, question)) {
            decide(worker, question, node);
            finding->open -= atomic_load(&question->is_decided) ? 1U : 0U;
        }
    }
    return finding->open > 0U;
}

static void write_traces(ex_run_t *run, const ex_graph_t *graph)
{
    for (uint32_t i = 0U; i < run->queries->questions; i++) {
        ex_question_t *const question = &run->queries->question[i];
        char path[EX_PATH_SIZE];
        if ((question->answer == EX_NO) && (question->node != EX_NO_NODE) && (run->options.query_trace_to != NULL)) {
            (void)snprintf(path, sizeof path, "%s%" PRIu32 ".trace.jsonl", run->options.query_trace_to, i);
            question->steps = ex_write_trace(run, graph, question->node, path);
        }
    }
}

/* The most tokens that were seen, of a question that asks for them. */
static void give_most(const ex_run_t *run, ex_question_t *question)
{
    for (uint32_t i = 0U; (question->kind == EX_ASK_BOUND) && (i < run->options.threads); i++) {
        const double most = (double)run->worker[i].early->most[question->a];
        question->value_kind = EX_INTEGER;
        question->value = (most > question->value) ? most : question->value;
    }
}

/* What the states alone say, without the way there. False: nothing. */
static bool answer_by_states(const ex_run_t *run, ex_question_t *question)
{
    if ((question->kind == EX_ASK_ENDS) && atomic_load(&question->is_decided)) { /* explore_trap.c */
        question->answer = EX_NO;
        question->why = "endless";
        return true;
    }
    if (!is_early(run->queries, question)) {
        return false;
    }
    if (atomic_load(&question->is_raised)) {
        question->why = "exception";
    } else if (atomic_load(&question->is_decided)) {
        question->answer = EX_NO;
        give_most(run, question);
    } else if (run->is_seen_whole) { /* no state decided it */
        question->answer = EX_YES;
        give_most(run, question);
    } else {
        return false;
    }
    return true;
}

void ex_early_conclude(const ex_run_t *run, ex_question_t *question)
{
    if ((question->answer == EX_UNKNOWN) && (question->node == EX_NO_NODE) && answer_by_states(run, question)) {
        question->why = (question->answer == EX_UNKNOWN) ? question->why : NULL;
    }
}

void ex_early_expect(const ex_run_t *run, ex_question_t *question)
{
    const ex_why_t why = (ex_why_t)atomic_load(&run->why);
    if (!ex_is_kept(run->queries, question)) {
        question->why = "reduction";
    } else if (!answer_by_states(run, question)) {
        question->why = ex_why_text((why == EX_COMPLETE) ? EX_SECONDS : why);
    }
}

static void answer_roughly(ex_run_t *run)
{
    ex_queries_t *const queries = run->queries;
    for (uint32_t i = 0U; i < queries->questions; i++) {
        ex_question_t *const question = &queries->question[i];
        if ((question->node != EX_NO_NODE) || answer_by_states(run, question)) {
            continue;
        }
        if (!ex_is_kept(queries, question)) {
            question->why = "reduction";
        } else if (atomic_load(&run->why) != (int)EX_COMPLETE) {
            ex_doubt(run, question);
        } else {
            question->why = (run->sweep != NULL) ? "sweep" : (run->options.has_graph ? "memory" : "no graph");
        }
    }
}

void ex_early_answer(ex_run_t *run)
{
    const bool is_exact = ex_is_exact(run);
    const int why = atomic_load(&run->why);
    finding_t finding = { .run = run };
    ex_graph_t graph;
    forget(&finding);
    if (run->sweep != NULL) {
        ex_sweep_answer(run);
    } else if ((finding.open > 0U) && is_exact && (why != (int)EX_INTERRUPTED) && (why < (int)EX_CAPACITY)
               && ex_rescan_make(run, &graph)) {
        (void)memcpy(run->worker[0].early->fired, run->worker[0].fired,
                     pn_net.transition_count * sizeof *run->worker[0].fired);
        (void)ex_rescan(run, &graph, find, &finding);
        write_traces(run, &graph);
    }
    answer_roughly(run);
}
