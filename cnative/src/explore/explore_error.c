/* SPDX-License-Identifier: MIT
 * explore_error.c - the way to an exception.
 *
 * Threads stop at the exception that one of them meets first. So the states that are known are gone through once more,
 * in breadth-first order: the first one in which an inscription raises an exception is the same one whatever the number
 * of threads, and with breadth-first exploration none is nearer to the initial state.
 */
#include "explore_error.h"
#include "search/explore_successors.h"
#include "state/explore_roots.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "graph/explore_rescan.h"
#include "swarm/explore_swarm.h"
#include "sweep/explore_sweep.h"
#include "search/explore_reduce.h"
#include "pn/pn_arena.h"
#include "pn/pn_text.h"

enum { BINDING_SIZE = 1 << 20 };

static bool ignore(void *user, uint32_t transition, const void *binding, const ex_key_t *key)
{
    (void)user;
    (void)transition;
    (void)binding;
    (void)key;
    return true;
}

static bool ignore_marking(void *user, uint32_t transition, const void *binding, const void *next)
{
    (void)user;
    (void)transition;
    (void)binding;
    (void)next;
    return true;
}

/* The first worker can go on after an error. */
static void revive(ex_worker_t *worker)
{
    worker->cx.error = PN_OK;
    worker->failed = false;
    ex_unload(worker);
}

/* The same, and the error is forgotten. */
static void clear(ex_run_t *run)
{
    revive(&run->worker[0]);
    run->error.kind = NULL;
    run->at_work = 1U;
    atomic_store(&run->is_stopping, false);
}

static bool is_no_error(void *user, uint32_t node, const ex_key_t *key, ex_found_t found)
{
    (void)user;
    (void)node;
    (void)key;
    return found != EX_FAILED;
}

/* The first node in which there is an exception; EX_NO_NODE: none was found. */
static uint32_t find(ex_run_t *run, ex_graph_t *graph)
{
    clear(run);
    const uint32_t node = ex_rescan(run, graph, is_no_error, NULL);
    return (run->error.kind != NULL) ? node : EX_NO_NODE;
}

/* --- the binding element ------------------------------------------------------------------------------------------ */

/* Fires the bindings of a transition one after the other, and writes down the one that cannot. */
typedef struct trial {
    ex_worker_t *worker;
    pn_text_t text;
    bool is_found;
} trial_t;

static bool on_binding(void *user, uint32_t transition, const void *binding)
{
    trial_t *const trial = user;
    ex_worker_t *const worker = trial->worker;
    ex_scratch_t *const scratch = worker->scratch;
    const size_t mark = pn_arena_mark(&scratch->arena);
    (void)memcpy(scratch->binding, binding, pn_net.transition[transition].binding->size);
    (void)memcpy(scratch->next, worker->marking, pn_net.marking_size);
    const bool is_fired = pn_net.transition[transition].fire(&worker->cx, scratch->next, transition, scratch->binding);
    if (!is_fired) {
        pn_json(pn_net.transition[transition].binding, binding, &trial->text);
        trial->is_found = true;
    }
    pn_arena_release(&scratch->arena, mark);
    if (pn_net.root_count > 0U) {
        return is_fired && ex_roots_restore(worker); /* where the exception is raised, nobody goes on */
    }
    return is_fired;
}

/* The binding whose occurrence raises the exception in worker->marking, as JSON; NULL: it is raised before one occurs.
 */
static char *raising_binding(ex_worker_t *worker, uint32_t transition)
{
    trial_t trial = { .worker = worker };
    char *const buffer = malloc((size_t)BINDING_SIZE);
    if (buffer == NULL) {
        return NULL;
    }
    pn_text_init(&trial.text, buffer, (size_t)BINDING_SIZE);
    worker->cx.error = PN_OK;
    (void)pn_net.transition[transition].enumerate(&worker->cx, worker->marking, transition, on_binding, &trial);
    if (!trial.is_found || trial.text.truncated) {
        free(buffer);
        return NULL;
    }
    return buffer;
}

/* --- both --------------------------------------------------------------------------------------------------------- */

/* Writes the trace, if it is wanted, and makes the exception be raised once more where it ends. */
static bool follow(ex_run_t *run, const ex_graph_t *graph, uint32_t node, ex_raised_t *raised)
{
    ex_worker_t *const worker = &run->worker[0];
    ex_key_t key;
    clear(run);
    raised->node = (uint64_t)node + 1U;
    raised->steps = -1;
    if (run->options.error_trace_to != NULL) {
        (void)snprintf(raised->path, sizeof raised->path, "%s%" PRIu64 ".trace.jsonl", run->options.error_trace_to,
                       raised->node);
        raised->steps = ex_write_run(run, graph, node, raised->path, "error");
    }
    const bool is_symmetric = (run->reduction != NULL) && run->reduction->is_symmetric && (raised->steps >= 0);
    const bool is_exchanged = is_symmetric && (worker->exchange != NULL);
    if (is_exchanged) { /* the trace does not end in the state itself */
        clear(run);
        (void)(ex_store_fetch(&run->store, graph->slot[node], &key) && ex_load(worker, &key)
               && ex_instances_restore(worker) && (ex_next_markings(worker, ignore_marking, NULL) == EX_FAILED));
    } else if (is_symmetric) { /* nor here, but the run is still where it ends */
        (void)ex_all_successors(worker, ignore_marking, NULL);
    } else {
        clear(run);
        (void)(ex_store_fetch(&run->store, graph->slot[node], &key)
               && (ex_successors(worker, &key, ignore, NULL) == EX_FAILED));
    }
    if (run->error.kind == NULL) {
        return false;
    }
    raised->binding = (run->error.transition >= 0) ? raising_binding(worker, (uint32_t)run->error.transition) : NULL;
    return true;
}

void ex_follow_error(ex_run_t *run)
{
    const ex_error_t met = run->error;
    ex_graph_t graph;
    ex_raised_t *const raised = ex_alloc(&run->memory, sizeof *raised);
    const uint32_t node = ((raised != NULL) && ex_rescan_make(run, &graph)) ? find(run, &graph) : EX_NO_NODE;
    if ((node != EX_NO_NODE) && follow(run, &graph, node, raised)) {
        run->raised = raised;
    } else {
        run->error = met;
    }
    revive(&run->worker[0]);
}

void ex_follow_way_error(ex_run_t *run)
{
    ex_worker_t *const worker = &run->worker[0];
    const ex_error_t met = run->error;
    ex_raised_t *const raised = ex_alloc(&run->memory, sizeof *raised);
    const ex_key_t key = (run->swarm != NULL) ? run->swarm->way[run->swarm->depth] : ex_sweep_at(run);
    clear(run);
    if ((raised != NULL) && (run->options.error_trace_to != NULL)) {
        (void)snprintf(raised->path, sizeof raised->path, "%s0.trace.jsonl", run->options.error_trace_to);
        raised->steps = (run->swarm != NULL) ? ex_swarm_write(run, raised->path, "error")
                                             : ex_sweep_write(run, raised->path, "error");
        clear(run);
    } else if (raised != NULL) {
        raised->steps = -1;
    }
    if ((raised != NULL) && (ex_successors(worker, &key, ignore, NULL) == EX_FAILED) && (run->error.kind != NULL)) {
        raised->binding =
            (run->error.transition >= 0) ? raising_binding(worker, (uint32_t)run->error.transition) : NULL;
        run->raised = raised;
    } else {
        run->error = met;
    }
    revive(worker);
}

static void string_json(const char *string, FILE *out)
{
    char quoted[2U * EX_PATH_SIZE];
    pn_text_t text;
    pn_text_init(&text, quoted, sizeof quoted);
    pn_text_json_str(&text, string);
    (void)fputs(quoted, out);
}

void ex_raised_json(const ex_run_t *run, FILE *out)
{
    const ex_raised_t *const raised = run->raised;
    if (raised == NULL) {
        (void)fprintf(out, ", \"node\": null, \"binding\": null, \"trace\": null");
        return;
    }
    if (raised->node > 0U) {
        (void)fprintf(out, ", \"node\": %" PRIu64, raised->node);
    } else {
        (void)fprintf(out, ", \"node\": null"); /* states have no numbers */
    }
    (void)fprintf(out, ", \"binding\": %s, \"trace\": ", (raised->binding != NULL) ? raised->binding : "null");
    if (raised->steps < 0) {
        (void)fprintf(out, "null");
        return;
    }
    (void)fprintf(out, "{\"node\": %" PRIu64 ", \"file\": ", raised->node);
    string_json(raised->path, out);
    (void)fprintf(out, ", \"steps\": %" PRId64 "}", raised->steps);
}
