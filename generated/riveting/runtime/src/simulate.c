/* SPDX-License-Identifier: MIT
 * simulate.c - automatic simulation of the whole net: a random enabled binding element at each step.
 *
 * Among the transitions of the best priority that are enabled one is drawn, then one of its bindings, all equally likely; the same
 * seed gives the same run. When nothing is enabled, model time goes on to the next time at which something is.
 */
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pn/pn_arena.h"
#include "pn/pn_net.h"
#include "pn/pn_num.h"
#include "pn/pn_random.h"
#include "pn/pn_text.h"
#include "pn/pn_trace.h"

enum {
    EXIT_FINE = 0,
    EXIT_MODEL = 1,
    EXIT_USAGE = 2
};

static max_align_t s_memory[PN_ARENA_DEFAULT_SIZE / sizeof(max_align_t)];
static char s_line[1U << 20U];
static char s_text[1U << 20U];

typedef struct options {
    uint64_t steps;
    uint64_t seed;
    const char *trace;
    bool has_trace;
    bool shows_enabled;
    bool shows_marking;
    bool shows_help;
} options_t;

static void print_help(void)
{
    (void)printf("simulate: plays net `%s` at random, from %s\n\n"
                 "usage: simulate [--steps N] [--seed K] [--trace FILE] [--enabled] [--marking]\n\n"
                 "  --steps N     at most N steps (default 1000)\n"
                 "  --seed K      seed of all random choices (default 1)\n"
                 "  --trace FILE  write the run (docs/trace.md); - is the standard output\n"
                 "  --enabled     print what is enabled at the start, one JSON object a line, and do nothing else\n"
                 "  --marking     print the marking at the end as JSON\n"
                 "  --help        this text\n\n"
                 "exit codes: 0 fine, 1 the net raised an error, 2 wrong usage or a file that cannot be written\n\n"
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

static bool read_options(int argc, char **argv, options_t *options)
{
    *options = (options_t){ .steps = 1000U, .seed = 1U };
    for (int i = 1; i < argc; i++) {
        const char *option = argv[i];
        const char *value = ((i + 1) < argc) ? argv[i + 1] : NULL;
        if (strcmp(option, "--enabled") == 0) {
            options->shows_enabled = true;
        } else if (strcmp(option, "--marking") == 0) {
            options->shows_marking = true;
        } else if (strcmp(option, "--help") == 0) {
            options->shows_help = true;
        } else if ((strcmp(option, "--trace") == 0) && (value != NULL)) {
            options->trace = value;
            i++;
        } else if ((strcmp(option, "--steps") == 0) && (value != NULL) && read_number(value, &options->steps)) {
            i++;
        } else if ((strcmp(option, "--seed") == 0) && (value != NULL) && read_number(value, &options->seed)) {
            i++;
        } else {
            (void)fprintf(stderr, "simulate: wrong option or value: `%s` (see --help)\n", option);
            return false;
        }
    }
    return true;
}

static int fail(const pn_ctx_t *cx, const char *doing)
{
    (void)fprintf(stderr, "simulate: %s: %s, while %s\n", cx->error_origin, cx->error_name, doing);
    return EXIT_MODEL;
}

/* --- search -------------------------------------------------------------------------------------------------------- */

/* What a search is for: the number of bindings, or binding number `wanted`. */
typedef struct search {
    uint64_t count;
    uint64_t wanted;
    void *binding;
    size_t size;
} search_t;

static bool count_binding(void *user, uint32_t transition, const void *binding)
{
    search_t *search = user;
    (void)transition;
    if ((search->binding != NULL) && (search->count == search->wanted)) {
        (void)memcpy(search->binding, binding, search->size);
        return false;
    }
    search->count++;
    return true;
}

static bool print_binding(void *user, uint32_t transition, const void *binding)
{
    pn_text_t text;
    pn_text_init(&text, s_text, sizeof s_text);
    pn_text_str(&text, "{\"transition\": ");
    pn_text_json_str(&text, pn_net.transition[transition].name);
    pn_text_str(&text, ", \"binding\": ");
    pn_net.transition[transition].binding_json(binding, &text);
    pn_text_str(&text, "}");
    (void)puts(text.buffer);
    (*(uint64_t *)user)++;
    return true;
}

/* Number of bindings of a transition; what the search used of the arena is given back. */
static uint64_t count_bindings(pn_ctx_t *cx, const void *marking, uint32_t transition)
{
    search_t search = { 0U, 0U, NULL, 0U };
    const size_t mark = pn_arena_mark(cx->arena);
    (void)pn_net.transition[transition].enumerate(cx, marking, transition, count_binding, &search);
    pn_arena_release(cx->arena, mark);
    return search.count;
}

/* Prints every enabled binding element of the best priority. */
static bool print_enabled(pn_ctx_t *cx, const void *marking)
{
    uint64_t printed = 0U;
    int32_t best = 0;
    for (uint32_t k = 0U; (k < pn_net.order_count) && pn_ok(cx); k++) {
        const uint32_t i = pn_net.order[k];
        if ((printed > 0U) && (pn_net.transition[i].priority > best)) {
            break;
        }
        best = pn_net.transition[i].priority;
        (void)pn_net.transition[i].enumerate(cx, marking, i, print_binding, &printed);
    }
    return pn_ok(cx);
}

/* Goes through the transitions of the best priority that are enabled: number `wanted` of them, with its number of bindings. Gives
 * how many there are, or `wanted` + 1 when it stops there. */
static uint32_t go_through(pn_ctx_t *cx, const void *marking, uint32_t wanted, uint32_t *transition, uint64_t *bindings)
{
    uint32_t enabled = 0U;
    int32_t best = 0;
    for (uint32_t k = 0U; (k < pn_net.order_count) && (enabled <= wanted) && pn_ok(cx); k++) {
        const uint32_t i = pn_net.order[k];
        if ((enabled > 0U) && (pn_net.transition[i].priority > best)) {
            break;
        }
        const uint64_t count = count_bindings(cx, marking, i);
        if (count > 0U) {
            enabled++;
            best = pn_net.transition[i].priority;
            *transition = i;
            *bindings = count;
        }
    }
    return pn_ok(cx) ? enabled : 0U;
}

/* Draws a transition among those enabled at the best priority, and the number of one of its bindings (pn_random.h). */
static bool draw(pn_ctx_t *cx, const void *marking, uint32_t *transition, uint64_t *number)
{
    uint64_t bindings = 0U;
    const uint32_t enabled = go_through(cx, marking, UINT32_MAX, transition, &bindings);
    if (enabled == 0U) {
        return false;
    }
    pn_random_start(cx, PN_RANDOM_CHOICE);
    const uint32_t wanted = (uint32_t)pn_random_below(cx, (int64_t)enabled);
    const uint64_t state = cx->random; /* enumerating starts streams of its own */
    (void)go_through(cx, marking, wanted, transition, &bindings);
    cx->random = state;
    *number = (uint64_t)pn_random_below(cx, (int64_t)bindings);
    return true;
}

/* The same, moving time on to where something is enabled; time stays where it is when nothing ever will be. */
static bool draw_in_time(pn_ctx_t *cx, void *marking, uint32_t *transition, uint64_t *number)
{
    const pn_time_t start = pn_net.now(marking);
    bool found = draw(cx, marking, transition, number);
    pn_time_t next = start;
    while (!found && pn_ok(cx) && pn_net.timed && pn_net.next_time(marking, &next)) {
        pn_net.set_now(marking, next);
        found = draw(cx, marking, transition, number);
    }
    if (!found) {
        pn_net.set_now(marking, start);
    }
    return found;
}

static double seconds(const void *marking)
{
    const pn_time_t now = pn_net.now(marking);
    return pn_net.real_time ? now.real : (double)now.integer;
}

static void print_marking(const void *marking)
{
    pn_text_t text;
    pn_text_init(&text, s_text, sizeof s_text);
    pn_text_char(&text, '{');
    for (uint32_t i = 0U; i < pn_net.place_count; i++) {
        pn_text_str(&text, (i > 0U) ? ", " : "");
        pn_text_json_str(&text, pn_net.place[i].name);
        pn_text_str(&text, ": ");
        pn_net.place[i].json(marking, &text);
    }
    pn_text_char(&text, '}');
    (void)puts(text.buffer);
}

/* --- the run ------------------------------------------------------------------------------------------------------- */

static int play(pn_ctx_t *cx, void *marking, void *binding, const options_t *options, pn_trace_t *trace)
{
    const char *why = "steps";
    for (uint64_t step = 0U; step < options->steps; step++) {
        uint32_t transition = 0U;
        search_t search = { 0U, 0U, binding, 0U };
        cx->step = step;
        if (!draw_in_time(cx, marking, &transition, &search.wanted)) {
            if (!pn_ok(cx)) {
                return fail(cx, "looking for what is enabled");
            }
            why = "finished";
            break;
        }
        const pn_transition_t *chosen = &pn_net.transition[transition];
        search.size = chosen->binding_size;
        (void)chosen->enumerate(cx, marking, transition, count_binding, &search);
        cx->step = step + 1U;
        if (!chosen->fire(cx, marking, binding)) {
            return fail(cx, "firing");
        }
        pn_trace_occurrence(trace, seconds(marking), chosen, binding);
        if (pn_arena_is_crowded(cx->arena)) {
            pn_net.collect(cx, marking);
            if (!pn_ok(cx)) {
                return fail(cx, "making room between firings");
            }
        }
    }
    pn_trace_end(trace, seconds(marking), why);
    return EXIT_FINE;
}

static int run(pn_ctx_t *cx, void *marking, void *binding, const options_t *options)
{
    if (!pn_net.init(cx, marking)) {
        return fail(cx, "making the initial marking");
    }
    if (options->shows_enabled) {
        return print_enabled(cx, marking) ? EXIT_FINE : fail(cx, "looking for what is enabled");
    }
    pn_trace_t trace;
    if (!pn_trace_open(&trace, options->trace, s_line, sizeof s_line)) {
        (void)fprintf(stderr, "simulate: cannot write `%s`: %s\n", options->trace, strerror(errno));
        return EXIT_USAGE;
    }
    pn_trace_header(&trace, &pn_net, "simulate", NULL);
    const int code = play(cx, marking, binding, options, &trace);
    if (!pn_trace_close(&trace)) {
        (void)fprintf(stderr, "simulate: `%s` could not be written completely\n", options->trace);
        return EXIT_USAGE;
    }
    if (options->shows_marking) {
        print_marking(marking);
    }
    return code;
}

int main(int argc, char **argv)
{
    options_t options;
    if (!read_options(argc, argv, &options)) {
        return EXIT_USAGE;
    }
    if (options.shows_help) {
        print_help();
        return EXIT_FINE;
    }
    if (pn_net.abi != PN_NET_ABI) {
        (void)fprintf(stderr, "simulate: the net was generated for another version of the runtime; generate it again\n");
        return EXIT_USAGE;
    }
    /* The only use of the heap, before anything runs. */
    void *marking = malloc(pn_net.marking_size);
    void *binding = malloc(pn_net.binding_size);
    int code = EXIT_USAGE;
    if ((marking == NULL) || (binding == NULL)) {
        (void)fprintf(stderr, "simulate: not enough memory\n");
    } else {
        pn_arena_t arena;
        pn_ctx_t cx;
        pn_arena_init(&arena, s_memory, sizeof s_memory);
        pn_ctx_init(&cx, &arena, options.seed);
        code = run(&cx, marking, binding, &options);
    }
    free(marking);
    free(binding);
    return code;
}
