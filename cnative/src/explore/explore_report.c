/* SPDX-License-Identifier: MIT
 * explore_report.c - what an exploration has found, as one JSON object; and what there is to say when the time is over.
 *
 * What is done with the states after they have been seen may take as long as seeing them, and parts of it cannot be
 * broken off. So where there is a limit of time, the report of what is known is written into memory before each such
 * part. When the time is over the thread that looks at the clock prints the last one, and the process ends.
 */
#define _POSIX_C_SOURCE 200809L

#include "explore_report.h"

#include "explore_bounds.h"
#include "explore_error.h"
#include "graph/explore_bindings.h"
#include "query/explore_query.h"
#include "query/explore_early.h"
#include "swarm/explore_swarm.h"
#include "sweep/explore_sweep.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "pn/pn_text.h"

#define MEBI ((uint64_t)1U << 20U)

const char *ex_why_text(ex_why_t why)
{
    static const char *const s_texts[] = {
        [EX_COMPLETE] = "complete", [EX_DECIDED] = "decided",         [EX_APPROXIMATE] = "approximation",
        [EX_STATES] = "states",     [EX_SECONDS] = "seconds",         [EX_MEMORY] = "memory",
        [EX_INFINITE] = "infinite", [EX_INTERRUPTED] = "interrupted", [EX_CAPACITY] = "capacity",
        [EX_ERROR] = "error",
    };
    return s_texts[why];
}

static void print_string(const char *string, FILE *out)
{
    static char s_buffer[8192];
    pn_text_t text;
    pn_text_init(&text, s_buffer, sizeof s_buffer);
    pn_text_json_str(&text, string);
    (void)fprintf(out, "%s", s_buffer);
}

static void print_index(int64_t index, FILE *out)
{
    if (index < 0) {
        (void)fprintf(out, "null");
    } else {
        (void)fprintf(out, "%" PRId64, index);
    }
}

static void print_error(const ex_run_t *run, FILE *out)
{
    const ex_error_t *const error = &run->error;
    if (error->kind == NULL) {
        (void)fprintf(out, "null");
        return;
    }
    (void)fprintf(out, "{\"message\": ");
    print_string(error->message, out);
    (void)fprintf(out, ", \"where\": ");
    print_string(error->where, out);
    (void)fprintf(out, ", \"place\": ");
    print_index(error->place, out);
    (void)fprintf(out, ", \"transition\": ");
    print_index(error->transition, out);
    (void)fprintf(out, ", \"kind\": \"%s\"", error->kind);
    ex_raised_json(run, out);
    (void)fprintf(out, "}");
}

/* Of this program: where Linux tells it. What the system counts for the process is no less than what the one had that
 * started it. */
static uint64_t peak_mib(void)
{
    struct rusage usage;
    char line[256];
    unsigned long long kib = 0U;
    FILE *const status = fopen("/proc/self/status", "r");
    while ((status != NULL) && (kib == 0U) && (fgets(line, (int)sizeof line, status) != NULL)) {
        kib = (strncmp(line, "VmHWM:", 6U) == 0) ? strtoull(&line[6], NULL, 10) : 0U;
    }
    if (status != NULL) {
        (void)fclose(status);
    }
    if (kib > 0U) {
        return (uint64_t)kib / 1024U;
    }
    (void)getrusage(RUSAGE_SELF, &usage);
    return (uint64_t)usage.ru_maxrss / 1024U;
}

static void print_reductions(const ex_options_t *options, FILE *out)
{
    const bool is_used[] = { options->is_time_reduced, options->is_stubborn, options->is_symmetric,
                             options->turns != NULL, options->counts != NULL };
    static const char *const s_names[] = { "time", "partial-order", "symmetry", "turns", "counts" };
    const char *between = "";
    (void)fprintf(out, ",\n \"reductions\": [");
    for (uint32_t i = 0U; i < (sizeof is_used / sizeof is_used[0]); i++) {
        if (is_used[i]) {
            (void)fprintf(out, "%s\"%s\"", between, s_names[i]);
            between = ", ";
        }
    }
    (void)fprintf(out, "]");
}

/* `is_last`: nothing is left to do. Else it is what there is to say if the time is over before the next report. */
static void print_report(ex_run_t *run, bool is_last, FILE *out)
{
    const ex_why_t known = (ex_why_t)atomic_load(&run->why);
    const ex_why_t why = ((known == EX_COMPLETE) && !is_last) ? EX_SECONDS : known;
    const ex_options_t *options = &run->options;
    const uint64_t store_bytes = ((run->store.bucket != NULL) ? ex_store_bytes(&run->store) : run->approximate_bytes)
                                 + (run->has_bounds ? ex_codec_bytes(run) : 0U); /* that is: all was made */
    (void)fprintf(out, "{\"complete\": %s, \"why\": \"%s\", \"error\": ", (why == EX_COMPLETE) ? "true" : "false",
                  ex_why_text(why));
    print_error(run, out);
    (void)fprintf(out, ",\n \"seen\": {\"markings\": %s, \"arcs\": %s, \"components\": %s}",
                  run->is_seen_whole ? "true" : "false", run->has_arcs ? "true" : "false",
                  run->has_components ? "true" : "false");
    (void)fprintf(out,
                  ",\n \"nodes\": %" PRIu64 ", \"arcs\": %" PRIu64 ", \"depth\": %" PRIu64 ", \"expanded\": %" PRIu64,
                  run->nodes, run->arcs, run->depth, run->expanded);
    (void)fprintf(out, ",\n \"seconds\": %.6f, \"cpu_seconds\": %.6f, \"states_per_second\": %.0f", run->seconds,
                  run->cpu_seconds, (run->seconds > 0.0) ? ((double)run->nodes / run->seconds) : 0.0);
    (void)fprintf(out,
                  ",\n \"bytes_per_state\": %.3f, \"store_bytes\": %" PRIu64 ", \"peak_mib\": %" PRIu64
                  ", \"threads\": %" PRIu32 ", \"order\": \"%s\"",
                  (run->nodes > 0U) ? ((double)store_bytes / (double)run->nodes) : 0.0, store_bytes, peak_mib(),
                  options->threads, options->is_depth_first ? "dfs" : "bfs");
    (void)fprintf(out, ",\n \"approximate\": ");
    if (!ex_is_exact(run)) {
        (void)fprintf(out, "{\"kind\": \"%s\", \"omission_probability\": %.6g}",
                      options->is_bitstate ? "bitstate" : "hash", run->omission_probability);
    } else {
        (void)fprintf(out, "null");
    }
    print_reductions(options, out);
    const int spill_error = atomic_load(&run->memory.spill_error);
    if (spill_error != 0) {
        (void)fprintf(out, ",\n \"spill_error\": ");
        print_string(strerror(spill_error), out);
    }
    (void)fprintf(out, ",\n \"fired\": [");
    for (uint32_t t = 0U; t < pn_net.transition_count; t++) {
        (void)fprintf(out, "%s%" PRIu64, (t > 0U) ? ", " : "", (run->fired != NULL) ? run->fired[t] : 0U);
    }
    (void)fprintf(out, "],\n \"dead_count\": %" PRIu64 ",\n ", run->dead_count);
    if (run->has_bounds && (is_last || ex_bounds_are_found(run))) {
        ex_bounds_json(run, out);
        (void)fprintf(out, ",\n ");
    }
    (void)fprintf(out, "\"bindings\": ");
    ex_bindings_json(run, out);
    (void)fprintf(out, ",\n ");
    ex_graph_json(run, out);
    ex_queries_json(run, !is_last, out);
    if (run->swarm != NULL) {
        ex_swarm_json(run, out);
    }
    if (run->sweep != NULL) {
        ex_sweep_json(run, out);
    }
    (void)fprintf(out, "}\n");
}

/* --- the last word ------------------------------------------------------------------------------------------------ */

static pthread_mutex_t s_lock = PTHREAD_MUTEX_INITIALIZER; /* of what follows, and of the standard output */
static char *s_kept;                                       /* the last report that was kept; NULL: none */
static bool s_is_said;                                     /* a report has been printed */

/* The report in memory; NULL: there is none. */
static char *written(ex_run_t *run, bool is_last)
{
    char *text = NULL;
    size_t size = 0U;
    FILE *const out = open_memstream(&text, &size);
    if (out == NULL) {
        return NULL;
    }
    print_report(run, is_last, out);
    const bool is_fine = ferror(out) == 0;
    if ((fclose(out) != 0) || !is_fine) {
        free(text);
        return NULL;
    }
    return text;
}

static void keep(ex_run_t *run)
{
    char *const text = written(run, false);
    (void)pthread_mutex_lock(&s_lock);
    char *const before = s_kept;
    s_kept = (text != NULL) ? text : before;
    (void)pthread_mutex_unlock(&s_lock);
    free((text != NULL) ? before : NULL);
}

void ex_report_keep(ex_run_t *run)
{
    if ((run->options.max_seconds <= 0.0) && (run->options.late_in == NULL)) {
        return; /* there is all the time */
    }
    keep(run);
    if (run->has_bounds && !ex_bounds_are_found(run)) {
        ex_phase(run, "bounds");
        ex_bounds_find(run);
        keep(run);
    }
}

void ex_report_late(void)
{
    (void)pthread_mutex_lock(&s_lock);
    if (!s_is_said && (s_kept != NULL)) {
        (void)fputs(s_kept, stdout);
        (void)fflush(stdout);
        _exit(EX_EXIT_TRUNCATED); /* with the lock: nobody else says anything more */
    }
    (void)pthread_mutex_unlock(&s_lock);
}

bool ex_report(ex_run_t *run)
{
    char *const text = written(run, true);
    (void)pthread_mutex_lock(&s_lock);
    s_is_said = true;
    if (text != NULL) {
        (void)fputs(text, stdout);
    } else {
        print_report(run, true, stdout); /* there is no memory for it */
    }
    const bool is_written = fflush(stdout) == 0;
    (void)pthread_mutex_unlock(&s_lock);
    free(text);
    return is_written && (ferror(stdout) == 0);
}
