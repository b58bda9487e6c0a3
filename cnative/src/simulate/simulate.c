/* SPDX-License-Identifier: MIT
 * simulate.c - automatic simulation of the whole net: a random enabled binding element at each step.
 *
 * Among the transitions of the best priority that are enabled one is drawn, then one of its bindings, all equally
 * likely; the same seed gives the same run. When nothing is enabled, model time goes on to the next time at which
 * something is.
 *
 * simulate_play.c searches and fires, simulate_replay.c repeats given steps, simulate_report.c tells the caller.
 */
#define _POSIX_C_SOURCE 200809L
#define _DEFAULT_SOURCE 1 /* mmap without a file */

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include "pn/pn_arena.h"
#include "pn/pn_file.h"
#include "pn/pn_num.h"
#include "pn/pn_text.h"
#include "simulate_impl.h"

enum { EXIT_FINE = 0, EXIT_MODEL = 1, EXIT_USAGE = 2, EXIT_INTERRUPTED = 130 };

enum {
    FOUND_SIZE = 1 << 18 /* bytes of bindings that are kept between finding and drawing one */
};

static char s_line[SIM_TEXT_SIZE]; /* of the trace; pages that are never touched cost nothing */

static void print_help(void)
{
    (void)printf("simulate: plays net `%s` at random, from %s\n\n"
                 "usage: simulate [--steps N] [--until T] [--seed K] [--trace FILE] [--enabled] [--marking]\n\n"
                 "  --steps N      at most N steps (default 1000)\n"
                 "  --until T      no step after model time T\n"
                 "  --seed K       seed of all random choices (default 1)\n"
                 "  --trace FILE   write the run (docs/trace.md); - is the standard output\n"
                 "  --enabled      print what is enabled at the start, one JSON object a line, and do nothing else\n"
                 "  --marking      print the marking at the end as JSON\n"
                 "  --memory B     bytes for lists and strings (default 4 MB)\n"
                 "  --choice K     another seed for the choices after a replay alone\n"
                 "  --replay FILE  first repeat these steps (src/simulate_replay.c); - is the standard input; they do "
                 "not count for\n"
                 "                 --steps\n"
                 "  --files DIR    let the net read and write files below DIR; without it there are none\n"
                 "  --watch WHAT   a monitor (src/simulate_watch.c); may be repeated\n"
                 "  --report FILE  write how the run ended, as JSON (src/simulate_report.c)\n"
                 "  --progress S   with --report: a line every S seconds\n"
                 "  --help         this text\n\n"
                 "exit codes: 0 fine, 1 an inscription of the net raised an error or a replay was refused, 2 wrong "
                 "usage or a file that cannot be\n"
                 "written, 130 interrupted\n\n"
                 "examples:\n"
                 "  ./simulate --steps 100 --seed 7 --trace run.trace.jsonl\n"
                 "  ./simulate --enabled\n",
                 pn_net.name, pn_net.source);
}

static bool read_number(const char *text, uint64_t *number)
{
    char *end = NULL;
    errno = 0;
    const unsigned long long value = strtoull(text, &end, 10);
    *number = value;
    return (text[0] >= '0') && (text[0] <= '9') && (*end == '\0') && (errno == 0);
}

static bool read_real(const char *text, double *number)
{
    char *end = NULL;
    *number = strtod(text, &end);
    return (end != text) && (*end == '\0') && isfinite(*number);
}

static bool read_time(const char *text, sim_options_t *options)
{
    char *end = NULL;
    options->has_until = true;
    if (pn_net.real_time) {
        return read_real(text, &options->until.real);
    }
    errno = 0;
    options->until.integer = (int64_t)strtoll(text, &end, 10);
    return (end != text) && (*end == '\0') && (errno == 0);
}

/* An option that has a value; false when it is no such option or the value is wrong. */
static bool read_valued(const char *option, const char *value, sim_options_t *options)
{
    if (value == NULL) {
        return false;
    }
    if (strcmp(option, "--trace") == 0) {
        options->trace = value;
        return true;
    }
    if (strcmp(option, "--initial") == 0) {
        options->initial = value;
        return true;
    }
    if (strcmp(option, "--files") == 0) {
        options->files = value;
        return true;
    }
    if (strcmp(option, "--watch") == 0) {
        return sim_watch_add(value);
    }
    if (strcmp(option, "--report") == 0) {
        options->report = value;
        return true;
    }
    if (strcmp(option, "--replay") == 0) {
        options->replay = value;
        return true;
    }
    return ((strcmp(option, "--steps") == 0) && read_number(value, &options->steps))
           || ((strcmp(option, "--seed") == 0) && read_number(value, &options->seed))
           || ((strcmp(option, "--choice") == 0) && (options->has_choice = read_number(value, &options->choice)))
           || ((strcmp(option, "--memory") == 0) && read_number(value, &options->memory))
           || ((strcmp(option, "--until") == 0) && read_time(value, options))
           || ((strcmp(option, "--progress") == 0) && read_real(value, &options->progress_s));
}

static bool read_options(int argc, char **argv, sim_options_t *options)
{
    *options = (sim_options_t){ .steps = 1000U, .seed = 1U, .memory = PN_ARENA_DEFAULT_SIZE };
    for (int i = 1; i < argc; i++) {
        const char *option = argv[i];
        if (strcmp(option, "--enabled") == 0) {
            options->shows_enabled = true;
        } else if (strcmp(option, "--marking") == 0) {
            options->shows_marking = true;
        } else if (strcmp(option, "--help") == 0) {
            options->shows_help = true;
        } else if (read_valued(option, ((i + 1) < argc) ? argv[i + 1] : NULL, options)) {
            i++;
        } else {
            (void)fprintf(stderr, "simulate: wrong option or value: `%s` (see --help)\n", option);
            return false;
        }
    }
    return true;
}

/* --- what is enabled ---------------------------------------------------------------------------------------------- */

static bool print_binding(void *user, uint32_t transition, const void *binding)
{
    pn_text_t text;
    (void)user;
    pn_text_init(&text, sim_text_buffer, SIM_TEXT_SIZE);
    pn_text_str(&text, "{\"transition\": ");
    pn_text_json_str(&text, pn_net.transition[transition].name);
    pn_text_str(&text, ", \"binding\": ");
    pn_json(pn_net.transition[transition].binding, binding, &text);
    pn_text_str(&text, "}");
    (void)puts(text.buffer);
    return true;
}

/* Prints every enabled binding element of the best priority, without going on in time. */
static void print_enabled(sim_t *sim)
{
    const pn_time_t start = pn_now(&pn_net, sim->marking);
    const sim_next_t next = sim_advance_time(sim);
    const pn_time_t now = pn_now(&pn_net, sim->marking);
    if ((next != SIM_FOUND) || (pn_net.real_time ? (now.real > start.real) : (now.integer > start.integer))) {
        return;
    }
    for (uint32_t k = 0U; (k < sim->enabled_count) && pn_ok(&sim->cx); k++) {
        const uint32_t i = sim->enabled[k];
        (void)pn_net.transition[i].enumerate(&sim->cx, sim->marking, i, print_binding, NULL);
        if (!pn_ok(&sim->cx)) {
            sim_fail(sim, "looking for its bindings", (int64_t)i, false);
        }
    }
}

/* --- the run ------------------------------------------------------------------------------------------------------ */

static void play(sim_t *sim)
{
    if (!sim_watch_start(sim) || ((sim->options.replay != NULL) && !sim_replay(sim))) {
        return;
    }
    sim_play(sim);
}

bool sim_trace_step(sim_t *sim, uint32_t transition, const void *binding)
{
    pn_trace_model_occurrence(&sim->trace, pn_now(&pn_net, sim->marking), pn_net.real_time,
                              &pn_net.transition[transition], binding);
    if (sim->trace.failed) {
        (void)snprintf(sim->message, sizeof sim->message, "%s", strerror(errno));
        sim->why = "trace";
    }
    return !sim->trace.failed;
}

/* The header of the trace, the run, its end; false when the trace cannot be written. */
static bool play_with_trace(sim_t *sim)
{
    char seed[64];
    if (!pn_trace_open(&sim->trace, sim->options.trace, s_line, sizeof s_line)) {
        (void)snprintf(sim->message, sizeof sim->message, "%s", strerror(errno));
        (void)fprintf(stderr, "simulate: cannot write `%s`: %s\n", sim->options.trace, sim->message);
        sim->why = "trace";
        return false;
    }
    (void)snprintf(seed, sizeof seed, "\"seed\": %llu", (unsigned long long)sim->options.seed);
    pn_trace_header_with(&sim->trace, &pn_net, "simulate", sim->options.initial, seed);
    if (sim->trace.failed) {
        (void)snprintf(sim->message, sizeof sim->message, "%s", strerror(errno));
    } else {
        play(sim);
        sim_watch_stop(sim);
        pn_trace_model_end(&sim->trace, pn_now(&pn_net, sim->marking), pn_net.real_time, sim->why);
    }
    if (!pn_trace_close(&sim->trace)) {
        (void)fprintf(stderr, "simulate: `%s` could not be written completely\n", sim->options.trace);
        if (sim->message[0] == '\0') {
            (void)snprintf(sim->message, sizeof sim->message, "%s", strerror(errno));
        }
        sim->why = "trace";
        return false;
    }
    return true;
}

static int tell(const sim_t *sim)
{
    if (strcmp(sim->why, "error") == 0) {
        (void)fprintf(stderr, "simulate: %s: %s, while %s\n", sim->cx.error_origin, sim->cx.error_name, sim->doing);
        return EXIT_MODEL;
    }
    if (strcmp(sim->why, "replay") == 0) {
        (void)fprintf(stderr, "simulate: after %llu steps: %s\n", (unsigned long long)sim->replayed, sim->message);
        return EXIT_MODEL;
    }
    return (strcmp(sim->why, "interrupted") == 0) ? EXIT_INTERRUPTED : EXIT_FINE;
}

static int run(sim_t *sim)
{
    bool is_written = true;
    sim_catch_signals();
    if ((sim->report != NULL) && (sim->options.progress_s > 0.0)) {
        sim_time_progress(sim->options.progress_s);
    }
    if (!pn_marking_init(&pn_net, &sim->cx, sim->marking)) {
        sim_fail(sim, "the declarations and the initial marking were made", -1, false);
    } else if (sim->options.shows_enabled) {
        sim->why = "steps";
        print_enabled(sim);
    } else {
        sim_report_start(sim);
        is_written = play_with_trace(sim);
    }
    int code = tell(sim);
    if (!is_written) {
        code = EXIT_USAGE;
    }
    if (sim->options.shows_marking && (code == EXIT_FINE)) {
        is_written = sim_print_marking(sim->marking, stdout) && (putchar('\n') >= 0) && is_written;
    }
    is_written = (fflush(stdout) == 0) && is_written;
    is_written = sim_report_end(sim) && is_written;
    return is_written ? code : EXIT_USAGE;
}

void *sim_reserve(uint64_t size)
{
    const size_t bytes = (size > 0U) ? (size_t)size : 1U;
    void *memory = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    return (memory == MAP_FAILED) ? NULL : memory;
}

static bool make(sim_t *sim, pn_arena_t *arena)
{
    /* Before anything runs; nothing is allocated later. */
    void *memory = sim_reserve(sim->options.memory);
    sim->marking = sim_reserve(pn_net.marking_size);
    sim->binding = sim_reserve(pn_binding_size(&pn_net));
    sim->found_size = FOUND_SIZE;
    sim->found = sim_reserve(FOUND_SIZE);
    if ((memory == NULL) || (sim->marking == NULL) || (sim->binding == NULL) || (sim->found == NULL)
        || !sim_prepare(sim)) {
        (void)fprintf(stderr, "simulate: not enough memory\n");
        return false;
    }
    if (sim->options.report != NULL) {
        sim->report = fopen(sim->options.report, "w");
        if (sim->report == NULL) {
            (void)fprintf(stderr, "simulate: cannot write `%s`: %s\n", sim->options.report, strerror(errno));
            return false;
        }
    }
    if ((sim->options.files != NULL) && !pn_file_allow(sim->options.files)) {
        (void)fprintf(stderr, "simulate: there is no folder `%s`\n", sim->options.files);
        return false;
    }
    pn_file_set_output(stdout);
    pn_arena_init(arena, memory, (size_t)sim->options.memory);
    pn_ctx_init(&sim->cx, arena, sim->options.seed);
    sim->is_watched = sim_watch_is_needed();
    sim->why = "";
    sim->doing = "";
    sim->transition = -1;
    sim->watch = -1;
    sim->watch_limit = "";
    return true;
}

int main(int argc, char **argv)
{
    static sim_t s_sim;
    pn_arena_t arena;
    if (!read_options(argc, argv, &s_sim.options)) {
        return EXIT_USAGE;
    }
    if (s_sim.options.shows_help) {
        print_help();
        return EXIT_FINE;
    }
    if (pn_net.abi != PN_NET_ABI) {
        (void)fprintf(stderr,
                      "simulate: the net was generated for another version of the runtime; generate it again\n");
        return EXIT_USAGE;
    }
    return make(&s_sim, &arena) ? run(&s_sim) : EXIT_USAGE;
}
