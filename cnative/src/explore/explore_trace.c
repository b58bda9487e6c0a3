/* SPDX-License-Identifier: MIT
 * explore_trace.c - a run to a node as a trace that can be replayed, and the whole graph as lines of JSON for pictures
 * and comparisons.
 */
#define _POSIX_C_SOURCE 200809L /* getpid */

#include "graph/explore_graph.h"
#include "search/explore_successors.h"
#include "search/explore_instances.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "pn/pn_text.h"
#include "pn/pn_trace.h"

#define LINE_SIZE ((size_t)1U << 22)

#define ANY_TRANSITION UINT32_MAX

/* Looks for the first arc to a state, and writes it into the trace. */
typedef struct step_search {
    ex_worker_t *worker;
    ex_key_t wanted;
    uint32_t transition; /* of the arc */
    pn_trace_t *trace;
    int64_t before; /* time that is in no state, because it is reduced */
    bool is_found;
} step_search_t;

/* The time at which the worker's state is, on the way of a trace. */
static pn_time_t time_of(const ex_worker_t *worker, int64_t before)
{
    pn_time_t now = pn_now(&pn_net, worker->marking);
    if (worker->run->options.is_time_reduced) {
        now.integer = before;
    }
    return now;
}

static bool is_same(const ex_key_t *a, const ex_key_t *b)
{
    return (a->low == b->low) && (a->high == b->high);
}

static bool write_step(void *user, uint32_t transition, const void *binding, const ex_key_t *key)
{
    step_search_t *const search = user;
    if (!is_same(key, &search->wanted)
        || ((search->transition != ANY_TRANSITION) && (search->transition != transition))) {
        return true;
    }
    search->is_found = true;
    const pn_time_t now = time_of(search->worker, search->before + search->worker->elapsed);
    const bool is_exchanged = search->worker->exchange != NULL;
    const uint32_t real = is_exchanged ? ex_instances_real(search->worker, transition) : transition;
    pn_trace_model_occurrence(search->trace, now, pn_net.real_time, &pn_net.transition[real], binding);
    if (is_exchanged) {
        ex_instances_follow(search->worker);
    }
    return false;
}

/* The nodes from the initial marking to `node`, both included; the caller frees them. NULL: no memory. */
static uint32_t *path_to(const ex_graph_t *graph, uint32_t node, uint64_t *length)
{
    uint64_t count = 1U;
    for (uint32_t at = node; at != 0U; at = graph->parent[at]) {
        count += 1U;
    }
    uint32_t *const on_path = malloc(count * sizeof *on_path);
    *length = count;
    if (on_path == NULL) {
        return NULL;
    }
    for (uint32_t at = node; count > 0U; at = graph->parent[at]) {
        count -= 1U;
        on_path[count] = at;
    }
    return on_path;
}

/* --- with symmetries: the states of the way stand for others, and a run goes through one of them after the other -- */

typedef struct walk {
    ex_worker_t *worker;
    const uint64_t *wanted; /* packed part of the state that is next on the way */
    void *marking;          /* where the run is, and then where it goes on */
    pn_trace_t *trace;
    bool is_found;
} walk_t;

static bool walk_step(void *user, uint32_t transition, const void *binding, const void *next)
{
    walk_t *const walk = user;
    if (memcmp(ex_canonical(walk->worker, next), walk->wanted, pn_net.packed_size) != 0) {
        return true;
    }
    walk->is_found = true;
    (void)memcpy(walk->marking, next, pn_net.marking_size);
    pn_trace_model_occurrence(walk->trace, pn_now(&pn_net, walk->worker->marking), pn_net.real_time,
                              &pn_net.transition[transition], binding);
    return false;
}

static bool write_walk(ex_run_t *run, const ex_graph_t *graph, const uint32_t *on_path, uint64_t length,
                       pn_trace_t *trace)
{
    ex_worker_t *const worker = &run->worker[0];
    uint64_t *const wanted = calloc(1U, pn_net.marking_size + sizeof *wanted);
    void *const marking = calloc(1U, pn_net.marking_size + sizeof *wanted);
    walk_t walk = { .worker = worker, .wanted = wanted, .marking = marking, .trace = trace };
    ex_key_t key;
    bool is_fine = (wanted != NULL) && (marking != NULL) && ex_load(worker, &run->initial);
    if (is_fine) {
        (void)memcpy(marking, worker->marking, pn_net.marking_size);
    }
    for (uint64_t i = 1U; is_fine && (i < length); i++) {
        is_fine = ex_store_fetch(&run->store, graph->slot[on_path[i]], &key) && ex_load(worker, &key);
        if (is_fine) {
            (void)memcpy(wanted, worker->marking, pn_net.packed_size);
            (void)memcpy(worker->marking, marking, pn_net.marking_size);
            ex_unload(worker);
            walk.is_found = false;
            is_fine = (ex_all_successors(worker, walk_step, &walk) == EX_STOPPED) && walk.is_found;
        }
    }
    if (is_fine) { /* where the run is now */
        (void)memcpy(worker->marking, marking, pn_net.marking_size);
        ex_unload(worker);
    }
    free(wanted);
    free(marking);
    return is_fine;
}

bool ex_part_name(char name[EX_PATH_SIZE], const char *path)
{
    const int length = snprintf(name, EX_PATH_SIZE, "%s.%ld.part", path, (long)getpid());
    return (length > 0) && ((size_t)length < (size_t)EX_PATH_SIZE);
}

/* A trace with its first line; `line` is what it writes in, and may be NULL. False: it cannot be had. */
static bool begin_trace(const ex_run_t *run, pn_trace_t *trace, const char *path, char part[EX_PATH_SIZE], char *line)
{
    char members[64];
    if ((line == NULL) || !ex_part_name(part, path) || !pn_trace_open(trace, part, line, LINE_SIZE)) {
        return false;
    }
    (void)snprintf(members, sizeof members, "\"seed\": %" PRIu64 "%s", run->options.seed,
                   run->options.is_still ? ", \"still\": true" : "");
    pn_trace_header_with(trace, &pn_net, "simulate", run->options.initial, members);
    return true;
}

/* Gives it its name, if all is fine; else nothing is left of it. */
static bool end_trace(pn_trace_t *trace, const char *path, const char *part, char *line, bool is_fine)
{
    is_fine = pn_trace_close(trace) && is_fine;
    is_fine = is_fine && (rename(part, path) == 0);
    if (!is_fine) {
        (void)unlink(part);
    }
    free(line);
    return is_fine;
}

int64_t ex_write_trace(ex_run_t *run, const ex_graph_t *graph, uint32_t node, const char *path)
{
    return ex_write_run(run, graph, node, path, NULL);
}

int64_t ex_write_run(ex_run_t *run, const ex_graph_t *graph, uint32_t node, const char *path, const char *why)
{
    uint64_t length = 0U;
    uint32_t *const on_path = path_to(graph, node, &length);
    const int64_t steps = (on_path != NULL) ? ex_write_path(run, graph, on_path, NULL, length - 1U, path, why) : -1;
    free(on_path);
    return steps;
}

int64_t ex_write_path(ex_run_t *run, const ex_graph_t *graph, const uint32_t *on_path, const uint16_t *label,
                      uint64_t steps, const char *path, const char *why)
{
    ex_worker_t *const worker = &run->worker[0];
    pn_trace_t trace;
    char part[EX_PATH_SIZE];
    const uint64_t length = steps + 1U;
    int64_t elapsed = 0;
    char *const line = malloc(LINE_SIZE);
    bool is_fine = begin_trace(run, &trace, path, part, line);
    if (!is_fine) {
        free(line);
        return -1;
    }
    const bool is_exchanged = worker->exchange != NULL;
    const bool is_symmetric = (run->reduction != NULL) && run->reduction->is_symmetric && !is_exchanged;
    if (is_exchanged) {
        ex_instances_start(worker);
    }
    if (is_symmetric) {
        is_fine = write_walk(run, graph, on_path, length, &trace);
    }
    for (uint64_t i = 0U; is_fine && !is_symmetric && ((i + 1U) < length); i++) {
        ex_key_t from;
        step_search_t search = { .worker = worker, .trace = &trace, .before = elapsed };
        search.transition = (label != NULL) ? label[i + 1U] : ANY_TRANSITION;
        is_fine = ex_store_fetch(&run->store, graph->slot[on_path[i]], &from)
                  && ex_store_fetch(&run->store, graph->slot[on_path[i + 1U]], &search.wanted);
        is_fine = is_fine && (ex_successors(worker, &from, write_step, &search) == EX_STOPPED) && search.is_found;
        elapsed += worker->elapsed;
    }
    ex_key_t last;
    is_fine = is_fine
              && (is_symmetric
                  || (ex_store_fetch(&run->store, graph->slot[on_path[steps]], &last) && ex_load(worker, &last)));
    if (is_fine) {
        const char *const usual = (EX_BIT(graph->dead, on_path[steps]) != 0U) ? "finished" : "steps";
        pn_trace_model_end(&trace, time_of(worker, elapsed), pn_net.real_time, (why != NULL) ? why : usual);
    }
    return end_trace(&trace, path, part, line, is_fine) ? (int64_t)steps : -1;
}

int64_t ex_write_keys(ex_run_t *run, const ex_key_t *way, uint64_t steps, const char *path, const char *why)
{
    ex_worker_t *const worker = &run->worker[0];
    pn_trace_t trace;
    char part[EX_PATH_SIZE];
    char *const line = malloc(LINE_SIZE);
    int64_t elapsed = 0;
    bool is_fine = begin_trace(run, &trace, path, part, line);
    if (!is_fine) {
        free(line);
        return -1;
    }
    for (uint64_t i = 0U; is_fine && (i < steps); i++) {
        step_search_t search = { .worker = worker, .wanted = way[i + 1U], .trace = &trace, .before = elapsed };
        search.transition = ANY_TRANSITION;
        is_fine = (ex_successors(worker, &way[i], write_step, &search) == EX_STOPPED) && search.is_found;
        elapsed += worker->elapsed;
    }
    is_fine = is_fine && ex_load(worker, &way[steps]);
    if (is_fine) {
        pn_trace_model_end(&trace, time_of(worker, elapsed), pn_net.real_time, why);
    }
    return end_trace(&trace, path, part, line, is_fine) ? (int64_t)steps : -1;
}

/* --- the whole graph ---------------------------------------------------------------------------------------------- */

typedef struct graph_writer {
    ex_worker_t *worker;
    const ex_graph_t *graph;
    FILE *file;
    pn_text_t text;
    uint32_t node;
    bool is_fine;
} graph_writer_t;

static bool write_text(graph_writer_t *w)
{
    w->is_fine = w->is_fine && !w->text.truncated && (fputs(w->text.buffer, w->file) >= 0);
    return w->is_fine;
}

static void time_json(pn_text_t *text, pn_time_t now)
{
    if (pn_net.real_time) {
        pn_text_json_real(text, now.real);
    } else {
        pn_text_int(text, now.integer);
    }
}

static bool write_arc(void *user, uint32_t transition, const void *binding, const ex_key_t *key)
{
    graph_writer_t *const w = user;
    const ex_store_t *const store = &w->worker->run->store;
    const uint64_t slot = ex_store_find(store, key, ex_hash(key));
    if ((slot == EX_NO_SLOT) || (w->graph->number[slot] == 0U)) {
        return true; /* of a part of a graph */
    }
    pn_text_clear(&w->text);
    pn_text_str(&w->text, "{\"from\": ");
    pn_text_uint(&w->text, (uint64_t)w->node + 1U);
    pn_text_str(&w->text, ", \"to\": ");
    pn_text_uint(&w->text, w->graph->number[slot]);
    pn_text_str(&w->text, ", \"t\": ");
    time_json(&w->text, pn_now(&pn_net, w->worker->marking));
    pn_text_str(&w->text, ", \"transition\": ");
    pn_text_json_str(&w->text, pn_net.transition[transition].name);
    pn_text_str(&w->text, ", \"index\": ");
    pn_text_uint(&w->text, transition);
    pn_text_str(&w->text, ", \"binding\": ");
    pn_json(pn_net.transition[transition].binding, binding, &w->text);
    pn_text_str(&w->text, "}\n");
    return write_text(w);
}

static bool write_node(graph_writer_t *w, const ex_key_t *key)
{
    const bool is_cut = (w->graph->cut != NULL) && (EX_BIT(w->graph->cut, w->node) != 0U);
    if (!ex_load(w->worker, key)) {
        return false;
    }
    pn_text_clear(&w->text);
    pn_text_str(&w->text, "{\"node\": ");
    pn_text_uint(&w->text, (uint64_t)w->node + 1U);
    pn_text_str(&w->text, is_cut ? ", \"cut\": true" : "");
    pn_text_str(&w->text, ", \"t\": ");
    time_json(&w->text, pn_now(&pn_net, w->worker->marking));
    pn_text_str(&w->text, ", \"marking\": {");
    for (uint32_t i = 0U; i < pn_net.place_count; i++) {
        pn_text_str(&w->text, (i > 0U) ? ", " : "");
        pn_text_json_str(&w->text, pn_net.place[i].name);
        pn_text_str(&w->text, ": ");
        pn_multiset_json(pn_net.place[i].multiset, w->worker->marking, &w->text);
    }
    pn_text_str(&w->text, "}}\n");
    return write_text(w);
}

bool ex_write_graph(ex_run_t *run, const ex_graph_t *graph, const char *path)
{
    char *const line = malloc(LINE_SIZE);
    FILE *const file = fopen(path, "w");
    graph_writer_t w = {
        .worker = &run->worker[0], .graph = graph, .file = file, .is_fine = (line != NULL) && (file != NULL)
    };
    if (w.is_fine) {
        pn_text_init(&w.text, line, LINE_SIZE);
    }
    for (uint32_t node = 0U; w.is_fine && (node < graph->nodes); node++) {
        ex_key_t key;
        w.node = node;
        w.is_fine = ex_store_fetch(&run->store, graph->slot[node], &key) && write_node(&w, &key);
        w.is_fine = w.is_fine && (ex_successors(w.worker, &key, write_arc, &w) != EX_FAILED) && w.is_fine;
    }
    if (file != NULL) {
        w.is_fine = (fclose(file) == 0) && w.is_fine;
        if (!w.is_fine) {
            (void)unlink(path); /* half of it would look like a graph */
        }
    }
    free(line);
    return w.is_fine;
}
