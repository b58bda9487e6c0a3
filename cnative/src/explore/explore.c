/* SPDX-License-Identifier: MIT
 * explore.c - the state space of the whole net: options, signals, progress.
 */
#define _POSIX_C_SOURCE 200809L
#if defined(__linux__)
#define _DEFAULT_SOURCE 1 /* prctl */
#endif

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#if defined(__linux__)
#include <sys/prctl.h>
#endif

#include "explore_bounds.h"
#include "explore_error.h"
#include "explore_report.h"
#include "explore_telling.h"
#include "graph/explore_bindings.h"
#include "query/explore_query.h"
#include "search/explore_reduce.h"
#include "swarm/explore_swarm.h"
#include "sweep/explore_sweep.h"
#include "pn/pn_file.h"

#define MEBI              ((uint64_t)1U << 20U)
#define DEFAULT_MEMORY    (4096U * MEBI)
#define DEFAULT_ARENA     (64U * MEBI)
#define DEFAULT_DEAD      1000U
#define DEFAULT_DEPTH     1000U
#define MOST_DEPTH        ((uint64_t)1U << 24U)
#define MOST_SKETCH       ((uint64_t)1U << 16U)
#define DEFAULT_LAY_AGAIN ((uint64_t)1U << 18U)

static ex_run_t s_run;

static void print_help(void)
{
    (void)printf(
        "explore: the state space of net `%s`, from %s\n\n"
        "usage: explore [--order bfs|dfs] [--threads N] [--max-states N] [--max-seconds S] [--memory MIB]\n\n"
        "  --order ORDER       bfs: breadth first (default), dfs: depth first\n"
        "  --threads N         threads that explore (default 1)\n"
        "  --max-states N      stop at N states\n"
        "  --max-seconds S     stop after S seconds\n"
        "  --late-seconds S    after S seconds work out nothing more about what was seen\n"
        "  --memory MIB        most memory of all tables together (default 4096)\n"
        "  --arena MIB         of each thread, for lists and strings (default 64)\n"
        "  --no-graph          states and bounds alone: no components, no traces\n"
        "  --approximate HOW   bitstate, hash: states may be missed; the report says how probably\n"
        "  --no-notes          work out in each state anew what transitions do; the same numbers, slower\n"
        "  --reduce time       states that differ only in how late it is are one\n"
        "  --reduce HOW        partial-order, symmetry: fewer states, the same answer whether there are dead ones\n"
        "  --elements FILE     the table of binding elements that these two need\n"
        "  --instances FILE    instead of it, for symmetry: which parts of the net can be exchanged\n"
        "  --dependency FILE   instead of it, for partial-order: which transitions depend on which\n"
        "  --turns FILE        the table by which programs take turns: each run is seen in one of its orders\n"
        "  --counts FILE       the table of places whose tokens are counted up to a limit only; needs --turns\n"
        "  --sweep FILE        in the order of weights of places, by one thread: what is behind is forgotten; no "
        "graph\n"
        "  --forgetful         for tests: of --sweep, after each layer, not only where the store would grow\n"
        "  --spill DIR         keep large tables in files of a folder\n"
        "  --progress          lines of JSON on the standard error\n"
        "  --progress-every S  seconds between them (default 0.5)\n"
        "  --dead-limit N      dead states that are listed (default 1000)\n"
        "  --write-graph FILE  all nodes and arcs as lines of JSON\n"
        "  --write-part        also where a limit was reached: then of the first nodes, `cut` where arcs are missing\n"
        "  --write-limit N     but none of a graph with more nodes\n"
        "  --trace-to NAME     a shortest trace to a dead state, as NAMEn.trace.jsonl with its number n\n"
        "  --traces N          so many of them (default 1)\n"
        "  --error-trace-to NAME  a shortest trace to an exception, as NAMEn.trace.jsonl\n"
        "  --queries FILE      questions about the states and runs; see explore_query_read.c\n"
        "  --query-trace-to NAME  runs that prove the answers, as NAMEn.trace.jsonl with the number n of the question\n"
        "  --seed N            of random numbers (default 1)\n"
        "  --shuffle N         depth first, successors the other way round (1), or by chance, of which N is the seed\n"
        "  --swarm SEED        one of many searches, by one thread, with bit states: depth first with --shuffle, or\n"
        "                      --walk; the hash and the order are its own, and each finding has its run\n"
        "  --walk              of it: from the initial state on at random, again and again; --max-states: so many "
        "steps\n"
        "  --max-depth N       of it: most steps of a run (default 1000)\n"
        "  --sketch N          of it: so many hashes of markings that were looked at (default 0)\n"
        "  --ending Q,R,..     of it: questions that end it when they are decided\n"
        "  --still             traces say that these are the same at each step\n"
        "  --multiset-limit N  colours of a multi-set bound that are printed (default: all)\n"
        "  --whole P,Q,..      places of which all colours are printed\n"
        "  --bindings T,U,..   transitions of which all bindings are printed, if the graph is not large\n"
        "  --ends-in PHASE     for tests: the time is over when explore, graph, components, properties or questions "
        "begins\n"
        "  --late-in PHASE     for tests: so does the time for telling what was seen\n"
        "  --parent PID        end at once when this process, which started it, has ended\n"
        "  --lay-again N       after N states see once more how they are stored best (default 262144)\n"
        "  --help              this text\n\n"
        "The report is one JSON object on the standard output.\n\n"
        "exit codes: 0 complete, 1 an inscription raised an exception, 2 wrong usage, 3 truncated or approximate\n",
        pn_net.name, pn_net.source);
}

/* --- options ------------------------------------------------------------------------------------------------------ */

static bool read_number(const char *text, uint64_t most, uint64_t *number)
{
    char *end = NULL;
    errno = 0;
    const unsigned long long value = strtoull(text, &end, 10);
    *number = value;
    return (text[0] >= '0') && (text[0] <= '9') && (*end == '\0') && (errno == 0) && (value <= most);
}

static bool read_mebi(const char *text, uint64_t *bytes)
{
    uint64_t number = 0U;
    const bool is_fine = read_number(text, UINT64_MAX / (4U * MEBI), &number) && (number > 0U);
    *bytes = number * MEBI;
    return is_fine;
}

static bool read_seconds(const char *text, double *seconds)
{
    char *end = NULL;
    *seconds = strtod(text, &end);
    return (end != text) && (*end == '\0') && isfinite(*seconds) && (*seconds > 0.0);
}

static bool read_threads(const char *text, uint32_t *threads)
{
    uint64_t number = 0U;
    const bool is_fine = read_number(text, (uint64_t)EX_MOST_THREADS, &number) && (number > 0U);
    *threads = (uint32_t)number;
    return is_fine;
}

static bool read_depth(const char *text, uint64_t *depth)
{
    return read_number(text, (uint64_t)MOST_DEPTH, depth) && (*depth > 0U);
}

static bool read_order(const char *text, bool *is_depth_first)
{
    *is_depth_first = strcmp(text, "dfs") == 0;
    return *is_depth_first || (strcmp(text, "bfs") == 0);
}

static bool read_approximation(const char *text, ex_options_t *options)
{
    options->is_bitstate = strcmp(text, "bitstate") == 0;
    options->is_hashed = strcmp(text, "hash") == 0;
    return options->is_bitstate || options->is_hashed;
}

static bool read_reduction(const char *text, ex_options_t *options)
{
    const bool is_time = (strcmp(text, "time") == 0) && !pn_net.real_time;
    const bool is_stubborn = strcmp(text, "partial-order") == 0;
    const bool is_symmetric = strcmp(text, "symmetry") == 0;
    options->is_time_reduced = options->is_time_reduced || (is_time && pn_net.timed);
    options->is_stubborn = options->is_stubborn || is_stubborn;
    options->is_symmetric = options->is_symmetric || is_symmetric;
    return is_time || is_stubborn || is_symmetric;
}

static bool read_text(const char *text, const char **option)
{
    *option = text;
    return true;
}

/* An option that has a value; false when it is no such option or the value is wrong. */
static bool read_valued(const char *option, const char *value, ex_options_t *options)
{
    if (value == NULL) {
        return false;
    }
    return ((strcmp(option, "--order") == 0) && read_order(value, &options->is_depth_first))
           || ((strcmp(option, "--threads") == 0) && read_threads(value, &options->threads))
           || ((strcmp(option, "--max-states") == 0) && read_number(value, UINT64_MAX, &options->max_states))
           || ((strcmp(option, "--max-seconds") == 0) && read_seconds(value, &options->max_seconds))
           || ((strcmp(option, "--memory") == 0) && read_mebi(value, &options->memory))
           || ((strcmp(option, "--arena") == 0) && read_mebi(value, &options->arena))
           || ((strcmp(option, "--approximate") == 0) && read_approximation(value, options))
           || ((strcmp(option, "--reduce") == 0) && read_reduction(value, options))
           || ((strcmp(option, "--elements") == 0) && read_text(value, &options->elements))
           || ((strcmp(option, "--instances") == 0) && read_text(value, &options->instances))
           || ((strcmp(option, "--dependency") == 0) && read_text(value, &options->dependency))
           || ((strcmp(option, "--turns") == 0) && read_text(value, &options->turns))
           || ((strcmp(option, "--counts") == 0) && read_text(value, &options->counts))
           || ((strcmp(option, "--sweep") == 0) && read_text(value, &options->sweep))
           || ((strcmp(option, "--spill") == 0) && read_text(value, &options->spill))
           || ((strcmp(option, "--traces") == 0) && read_number(value, UINT32_MAX, &options->traces))
           || ((strcmp(option, "--dead-limit") == 0) && read_number(value, UINT32_MAX, &options->dead_limit))
           || ((strcmp(option, "--write-graph") == 0) && read_text(value, &options->write_graph))
           || ((strcmp(option, "--write-limit") == 0) && read_number(value, UINT64_MAX, &options->write_limit))
           || ((strcmp(option, "--late-seconds") == 0) && read_seconds(value, &options->late_seconds))
           || ((strcmp(option, "--progress-every") == 0) && read_seconds(value, &options->progress_every))
           || ((strcmp(option, "--trace-to") == 0) && read_text(value, &options->trace_to))
           || ((strcmp(option, "--parent") == 0) && read_number(value, INT32_MAX, &options->parent))
           || ((strcmp(option, "--error-trace-to") == 0) && read_text(value, &options->error_trace_to))
           || ((strcmp(option, "--queries") == 0) && read_text(value, &options->queries))
           || ((strcmp(option, "--query-trace-to") == 0) && read_text(value, &options->query_trace_to))
           || ((strcmp(option, "--lay-again") == 0) && read_number(value, UINT64_MAX, &options->lay_again))
           || ((strcmp(option, "--ends-in") == 0) && read_text(value, &options->ends_in))
           || ((strcmp(option, "--late-in") == 0) && read_text(value, &options->late_in))
           || ((strcmp(option, "--multiset-limit") == 0) && read_number(value, UINT64_MAX, &options->multiset_limit))
           || ((strcmp(option, "--whole") == 0) && read_text(value, &options->whole))
           || ((strcmp(option, "--bindings") == 0) && read_text(value, &options->bindings))
           || ((strcmp(option, "--heaps") == 0) && read_text(value, &options->heaps))
           || ((strcmp(option, "--most-heaped") == 0) && read_number(value, UINT64_MAX, &options->most_heaped))
           || ((strcmp(option, "--initial") == 0) && read_text(value, &options->initial))
           || ((strcmp(option, "--shuffle") == 0) && read_number(value, UINT64_MAX, &options->shuffle))
           || ((strcmp(option, "--swarm") == 0) && read_number(value, UINT64_MAX, &options->swarm))
           || ((strcmp(option, "--max-depth") == 0) && read_depth(value, &options->max_depth))
           || ((strcmp(option, "--sketch") == 0) && read_number(value, (uint64_t)MOST_SKETCH, &options->sketch))
           || ((strcmp(option, "--ending") == 0) && read_text(value, &options->ending))
           || ((strcmp(option, "--seed") == 0) && read_number(value, UINT64_MAX, &options->seed));
}

/* States that are left out, or taken for others, and programs that take turns have orders of their own. */
static bool can_sweep(const ex_options_t *options)
{
    const bool is_other = options->is_bitstate || options->is_hashed || options->is_stubborn || options->is_symmetric
                          || (options->turns != NULL) || (options->counts != NULL);
    if ((options->sweep != NULL) && is_other) {
        (void)fprintf(stderr, "explore: --sweep goes with no approximation, and no reduction but that of time\n");
        return false;
    }
    return true;
}

static bool read_options(int argc, char **argv, ex_options_t *options)
{
    *options = (ex_options_t){ .threads = 1U,
                               .max_states = UINT64_MAX,
                               .memory = DEFAULT_MEMORY,
                               .arena = DEFAULT_ARENA,
                               .seed = 1U,
                               .max_depth = DEFAULT_DEPTH,
                               .lay_again = DEFAULT_LAY_AGAIN,
                               .has_graph = true,
                               .has_notes = true,
                               .dead_limit = (uint64_t)DEFAULT_DEAD,
                               .traces = 1U,
                               .write_limit = UINT64_MAX,
                               .multiset_limit = UINT64_MAX,
                               .progress_every = 0.5 };
    for (int i = 1; i < argc; i++) {
        const char *option = argv[i];
        if (strcmp(option, "--write-part") == 0) {
            options->writes_part = true;
        } else if (strcmp(option, "--no-graph") == 0) {
            options->has_graph = false;
        } else if (strcmp(option, "--still") == 0) {
            options->is_still = true;
        } else if (strcmp(option, "--no-notes") == 0) {
            options->has_notes = false;
        } else if (strcmp(option, "--forgetful") == 0) {
            options->is_forgetful = true;
        } else if (strcmp(option, "--walk") == 0) {
            options->is_walk = true;
        } else if (strcmp(option, "--progress") == 0) {
            options->shows_progress = true;
        } else if (strcmp(option, "--help") == 0) {
            options->shows_help = true;
        } else if (read_valued(option, ((i + 1) < argc) ? argv[i + 1] : NULL, options)) {
            i++;
        } else {
            (void)fprintf(stderr, "explore: wrong option or value: `%s` (see --help)\n", option);
            return false;
        }
    }
    if (options->swarm != 0U) {
        options->is_bitstate = true;
        options->is_hashed = false;
        options->is_depth_first = true;
        options->has_graph = false;
        options->threads = 1U;
    }
    if (options->sweep != NULL) {
        options->is_depth_first = false;
        options->has_graph = false;
        options->threads = 1U;
    }
    options->is_walk = options->is_walk && (options->swarm != 0U);
    /* What is remembered of transitions does not say which of them a program asks. */
    options->has_notes = options->has_notes && (options->turns == NULL);
    return can_sweep(options);
}

/* --- signals and the watch ---------------------------------------------------------------------------------------- */

static void on_signal(int number)
{
    ex_stop(&s_run, (number == SIGUSR1) ? EX_INFINITE : EX_INTERRUPTED); /* atomic operations alone */
}

static void catch_signals(void)
{
    struct sigaction action;
    (void)memset(&action, 0, sizeof action);
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART | (int)SA_RESETHAND; /* the second one ends the program at once */
    (void)sigemptyset(&action.sa_mask);
    (void)sigaction(SIGINT, &action, NULL);
    (void)sigaction(SIGTERM, &action, NULL);
    action.sa_flags = SA_RESTART;
    (void)sigaction(SIGUSR1, &action, NULL); /* the states have no end: it answers what it can, and ends */
    action.sa_handler = SIG_IGN;
    action.sa_flags = 0;
    (void)sigaction(SIGXFSZ, &action, NULL); /* a file that must not become larger is one that cannot be written */
}

/* Nobody is left to hear of what is explored when the parent has been killed. False: it has been, already. */
static bool follow_parent(uint64_t parent)
{
#if defined(__linux__)
    (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    return (uint64_t)getppid() == parent;
}

typedef struct watch {
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    bool is_over;
    bool is_started;
    uint64_t states; /* at the last line */
    double shown;
} watch_t;

static void show_progress(ex_run_t *run, watch_t *watch)
{
    ex_progress_t progress;
    const double now = ex_clock();
    const char *phase = atomic_load(&run->phase);
    ex_progress(run, &progress);
    const double rate = (now > watch->shown) ? ((double)(progress.states - watch->states) / (now - watch->shown)) : 0.0;
    (void)fprintf(stderr,
                  "{\"states\": %" PRIu64 ", \"arcs\": %" PRIu64 ", \"rate\": %.0f, \"frontier\": %" PRIu64
                  ", \"depth\": %" PRIu64 ", \"mib\": %.1f, \"seconds\": %.3f, \"phase\": \"%s\"}\n",
                  progress.states, progress.arcs, rate, progress.frontier, progress.depth,
                  (double)atomic_load(&run->memory.used) / (double)MEBI, now - run->started,
                  (phase != NULL) ? phase : "explore");
    (void)fflush(stderr);
    watch->states = progress.states;
    watch->shown = now;
}

/* After so large a part of the time until it is late, a process that has not ended says what it has kept, and ends. */
#define LAST_PART 1.03
/* The search goes on for so large a part of its time at least, however long it takes to tell what it has seen. */
#define SEARCH_PART 0.4

/* When the search ends: early enough to tell the bounds of what was seen until now. */
static double search_end(ex_run_t *run)
{
    const char *const phase = atomic_load(&run->phase);
    double seconds = run->options.max_seconds;
    if ((phase != NULL) && (strcmp(phase, "explore") == 0)) {
        const double left = ex_late_seconds(run) - ex_telling_seconds(run);
        const double least = seconds * SEARCH_PART;
        seconds = (left >= seconds) ? seconds : ((left > least) ? left : least);
    }
    return run->started + seconds;
}

/* The thread that looks at the clock. */
static void *keep_watch(void *user)
{
    watch_t *watch = user;
    ex_run_t *run = &s_run;
    (void)pthread_mutex_lock(&watch->lock);
    watch->shown = run->started;
    while (!watch->is_over) {
        const double now = ex_clock();
        double until = now + run->options.progress_every;
        if (run->options.shows_progress && ((now - watch->shown) >= run->options.progress_every)) {
            show_progress(run, watch);
        }
        if (run->options.max_seconds > 0.0) {
            const double end = search_end(run);
            if (now >= end) {
                ex_stop(run, EX_SECONDS);
            } else if (end < until) {
                until = end;
            }
            const double last = run->started + (ex_late_seconds(run) * LAST_PART);
            if (now >= last) {
                ex_report_late();
            } else if (last < until) {
                until = last;
            }
        }
        struct timespec at;
        (void)clock_gettime(CLOCK_REALTIME, &at);
        const double step = (until - now) + 0.001;
        at.tv_nsec += (long)(step * 1e9);
        at.tv_sec += at.tv_nsec / 1000000000L;
        at.tv_nsec %= 1000000000L;
        (void)pthread_cond_timedwait(&watch->changed, &watch->lock, &at);
    }
    (void)pthread_mutex_unlock(&watch->lock);
    return NULL;
}

static void start_watch(watch_t *watch)
{
    (void)pthread_mutex_init(&watch->lock, NULL);
    (void)pthread_cond_init(&watch->changed, NULL);
    if (s_run.options.shows_progress || (s_run.options.max_seconds > 0.0)) {
        watch->is_started = pthread_create(&watch->thread, NULL, keep_watch, watch) == 0;
    }
}

static void end_watch(watch_t *watch)
{
    if (watch->is_started) {
        (void)pthread_mutex_lock(&watch->lock);
        watch->is_over = true;
        (void)pthread_cond_signal(&watch->changed);
        (void)pthread_mutex_unlock(&watch->lock);
        (void)pthread_join(watch->thread, NULL);
        if (s_run.options.shows_progress) {
            show_progress(&s_run, watch);
        }
    }
}

/* --- the run ------------------------------------------------------------------------------------------------------ */

static bool make(ex_run_t *run)
{
    const ex_options_t *options = &run->options;
    (void)pthread_mutex_init(&run->error_lock, NULL);
    (void)pthread_mutex_init(&run->gate, NULL);
    (void)pthread_cond_init(&run->gate_changed, NULL);
    if ((pn_net.root_count > 0U)) {
        run->options.threads = 1U; /* they are shared by all evaluations */
    }
    run->fired = ex_alloc(&run->memory, ((uint64_t)pn_net.transition_count + 1U) * sizeof *run->fired);
    run->worker = ex_alloc(&run->memory, options->threads * sizeof *run->worker);
    if ((run->fired == NULL) || (run->worker == NULL) || !ex_codec_make(run)) {
        return false;
    }
    for (uint32_t i = 0U; i < options->threads; i++) {
        ex_worker_t *worker = &run->worker[i];
        worker->run = run;
        worker->index = i;
        worker->fired = ex_alloc(&run->memory, ((uint64_t)pn_net.transition_count + 1U) * sizeof *worker->fired);
        if ((worker->fired == NULL) || !ex_scratch_make(worker) || !ex_bounds_make(worker)
            || ((run->queries != NULL) && !ex_early_make(worker))) {
            return false;
        }
    }
    run->has_bounds = true;
    ex_telling_make(run);
    if (options->swarm != 0U) {
        run->turned = (ex_key_t){ options->swarm * 0x9e3779b97f4a7c15U, options->swarm * 0xd6e8feb86659fd93U };
        return ex_swarm_make(run);
    }
    return true;
}

static int explore(ex_run_t *run)
{
    watch_t watch;
    (void)memset(&watch, 0, sizeof watch);
    run->started = ex_clock();
    start_watch(&watch);
    ex_phase(run, "explore");
    const bool is_explored = ex_reduction_make(run) && ex_explore(run);
    const bool is_exact = ex_is_exact(run);
    if (is_explored && !is_exact && (atomic_load(&run->why) == (int)EX_COMPLETE)) {
        atomic_store(&run->why, (int)EX_APPROXIMATE);
    }
    run->is_seen_whole = is_explored && (atomic_load(&run->why) == (int)EX_COMPLETE);
    if (is_explored) {
        ex_report_keep(run);
    }
    if (run->is_seen_whole && run->options.has_graph) {
        if (ex_graph(run)) {
            ex_bindings(run);
        }
    }
    if (is_explored && is_exact && (run->sweep == NULL) && (atomic_load(&run->why) == (int)EX_ERROR)
        && (strcmp(run->error.kind, "exception") == 0)) {
        ex_phase(run, "trace");
        ex_follow_error(run);
    }
    if (is_explored && ((run->swarm != NULL) || (run->sweep != NULL)) && atomic_load(&run->has_begun)
        && (atomic_load(&run->why) == (int)EX_ERROR) && (strcmp(run->error.kind, "exception") == 0)) {
        ex_follow_way_error(run);
    }
    if (is_explored && (run->queries != NULL)) {
        ex_report_keep(run);
        ex_phase(run, "questions");
        ex_queries_answer(run);
    }
    if (run->graph != NULL) {
        ex_graph_write(run);
    }
    const bool is_written = ex_report(run);
    end_watch(&watch);
    switch ((ex_why_t)atomic_load(&run->why)) {
    case EX_COMPLETE:
    case EX_DECIDED: return is_written ? EX_EXIT_FINE : EX_EXIT_USAGE;
    case EX_ERROR:
    case EX_CAPACITY: return EX_EXIT_MODEL;
    case EX_APPROXIMATE:
    case EX_STATES:
    case EX_SECONDS:
    case EX_MEMORY:
    case EX_INFINITE:
    case EX_INTERRUPTED:
    default: return EX_EXIT_TRUNCATED;
    }
}

int main(int argc, char **argv)
{
    ex_run_t *run = &s_run;
    if (!read_options(argc, argv, &run->options)) {
        return EX_EXIT_USAGE;
    }
    if (run->options.shows_help) {
        print_help();
        return EX_EXIT_FINE;
    }
    if (pn_net.abi != PN_NET_ABI) {
        (void)fprintf(stderr, "explore: the net was generated for another version of the runtime; generate it again\n");
        return EX_EXIT_USAGE;
    }
    ex_equip(run);
    if (((run->options.queries != NULL) && !ex_queries_read(run))
        || ((run->options.sweep != NULL) && !ex_sweep_read(run))) {
        return EX_EXIT_USAGE;
    }
    catch_signals();
    if ((run->options.parent != 0U) && !follow_parent(run->options.parent)) {
        return EX_EXIT_TRUNCATED;
    }
    if (!make(run)) {
        ex_stop(run, EX_MEMORY);
        return ex_report(run) ? EX_EXIT_TRUNCATED : EX_EXIT_USAGE;
    }
    return explore(run);
}
