/* SPDX-License-Identifier: MIT
 * exercise.c - tries what a net can do, and what it must refuse, without knowing the net: see exercise_situation.c for
 * what is checked, and exercise_run.c for where. `make coverage` counts the lines and branches of net.c to which this
 * comes.
 */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "exercise_impl.h"
#include "pn/pn_arena.h"
#include "pn/pn_num.h"
#include "pn/pn_random.h"

enum { EXIT_FINE = 0, EXIT_MODEL = 1, EXIT_USAGE = 2, EXIT_BROKEN = 3 };
enum { EX_TOLD = 20 /* complaints that are printed */ };

void *ex_reserve(uint64_t count, size_t size)
{
    void *memory = calloc((count > 0U) ? (size_t)count : 1U, size);
    if (memory == NULL) {
        (void)fprintf(stderr, "exercise: not enough memory\n");
        exit(EXIT_USAGE);
    }
    return memory;
}

void ex_complain(ex_t *ex, uint32_t transition, int64_t place, const char *what)
{
    ex->broken++;
    if (ex->broken <= (uint64_t)EX_TOLD) {
        (void)fprintf(stderr, "exercise: %s: %s%s%s\n", pn_net.transition[transition].name,
                      (place >= 0) ? pn_net.place[place].name : "", (place >= 0) ? ": " : "", what);
    }
}

static void print_help(void)
{
    (void)printf("exercise: tries what net `%s`, from %s, can do and what it must refuse\n\n"
                 "usage: exercise [--runs N] [--steps N] [--seed K] [--resets N]\n\n"
                 "  --runs N    random runs (default 20)\n"
                 "  --steps N   of at most N firings (default 1000)\n"
                 "  --seed K    of all choices (default 1)\n"
                 "  --resets N  arcs of the net that take all there is: no more than these may take what they do not "
                 "need\n"
                 "  --help      this text\n\n"
                 "exit codes: 0 all is as promised, 1 the initial marking raises an error, 2 wrong usage, 3 a promise "
                 "of the net's functions\n"
                 "or tables is broken\n",
                 pn_net.name, pn_net.source);
}

static bool read_number(const char *text, uint64_t *number)
{
    char *end = NULL;
    errno = 0;
    const unsigned long long value = (text != NULL) ? strtoull(text, &end, 10) : 0U;
    *number = value;
    return (text != NULL) && (text[0] >= '0') && (text[0] <= '9') && (*end == '\0') && (errno == 0);
}

static bool read_options(int argc, char **argv, ex_options_t *options)
{
    *options = (ex_options_t){ .runs = 20U, .steps = 1000U, .seed = 1U, .resets = UINT64_MAX };
    for (int i = 1; i < argc; i++) {
        const char *option = argv[i];
        const char *value = ((i + 1) < argc) ? argv[i + 1] : NULL;
        if (strcmp(option, "--help") == 0) {
            options->shows_help = true;
        } else if (((strcmp(option, "--runs") == 0) && read_number(value, &options->runs))
                   || ((strcmp(option, "--steps") == 0) && read_number(value, &options->steps))
                   || ((strcmp(option, "--seed") == 0) && read_number(value, &options->seed))
                   || ((strcmp(option, "--resets") == 0) && read_number(value, &options->resets))) {
            i++;
        } else {
            (void)fprintf(stderr, "exercise: wrong option or value: `%s` (see --help)\n", option);
            return false;
        }
    }
    return true;
}

/* Arcs that take what there is, without needing it; complains of those that the net does not have. */
static uint32_t count_resets(ex_t *ex)
{
    uint32_t count = 0U;
    for (uint32_t i = 0U; i < pn_net.transition_count; i++) {
        const pn_transition_t *t = &pn_net.transition[i];
        for (uint32_t k = 0U; k < t->touched_count; k++) {
            if (ex->need[i][k].is_reset && !ex->need[i][k].is_needed) {
                count++;
                if (count > ex->options.resets) {
                    ex_complain(ex, i, t->touched[k], "a token is taken from it that is not needed");
                }
            }
        }
    }
    return count;
}

static int report(ex_t *ex)
{
    const uint32_t resets = count_resets(ex);
    uint32_t fired = 0U;
    uint64_t tried = 0U;
    for (uint32_t i = 0U; i < pn_net.transition_count; i++) {
        fired += ex->has_fired[i] ? 1U : 0U;
    }
    for (uint32_t i = 0U; i < (uint32_t)EX_OUTCOMES; i++) {
        tried += ex->outcome[i];
    }
    (void)printf("exercise: %llu firings in %llu runs; %u of %u transitions tried with success, in %llu situations\n",
                 (unsigned long long)ex->firings, (unsigned long long)ex->options.runs, fired, pn_net.transition_count,
                 (unsigned long long)ex->situations);
    (void)printf("exercise: of %llu firings %llu were accepted; refused: %llu no room, %llu not in the colour set, "
                 "%llu no token, %llu no memory, %llu an exception\n",
                 (unsigned long long)tried, (unsigned long long)ex->outcome[EX_ACCEPTED],
                 (unsigned long long)ex->outcome[EX_NO_ROOM], (unsigned long long)ex->outcome[EX_NO_COLOUR],
                 (unsigned long long)ex->outcome[EX_MISSING], (unsigned long long)ex->outcome[EX_NO_MEMORY],
                 (unsigned long long)ex->outcome[EX_RAISED]);
    (void)printf("exercise: %llu tokens taken away, %llu replaced, %llu places filled; %u arcs take what they do not "
                 "need; %llu promises broken\n",
                 (unsigned long long)ex->taken, (unsigned long long)ex->replaced, (unsigned long long)ex->filled,
                 resets, (unsigned long long)ex->broken);
    return (ex->broken > 0U) ? EXIT_BROKEN : EXIT_FINE;
}

static int run(ex_t *ex)
{
    static pn_arena_t arena;
    pn_arena_init(&arena, ex_reserve(1U, PN_ARENA_DEFAULT_SIZE), PN_ARENA_DEFAULT_SIZE);
    pn_ctx_init(&ex->cx, &arena, ex->options.seed);
    ex->random = pn_random_mix(ex->options.seed);
    ex_values_prepare();
    ex_situation_prepare(ex);
    ex_run_prepare(ex);
    for (uint64_t i = 0U; i < ex->options.runs; i++) {
        if (!ex_run(ex)) {
            (void)fprintf(stderr, "exercise: %s: %s, while the initial marking was made\n", ex->cx.error_origin,
                          ex->cx.error_name);
            return EXIT_MODEL;
        }
    }
    for (uint32_t i = 0U; (ex->options.runs > 0U) && (i < pn_net.transition_count); i++) {
        ex_compose(ex, i);
    }
    return report(ex);
}

int main(int argc, char **argv)
{
    static ex_t s_exercise;
    if (!read_options(argc, argv, &s_exercise.options)) {
        return EXIT_USAGE;
    }
    if (s_exercise.options.shows_help) {
        print_help();
        return EXIT_FINE;
    }
    if (pn_net.abi != PN_NET_ABI) {
        (void)fprintf(stderr,
                      "exercise: the net was generated for another version of the runtime; generate it again\n");
        return EXIT_USAGE;
    }
    return run(&s_exercise);
}
