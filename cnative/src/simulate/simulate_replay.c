/* SPDX-License-Identifier: MIT
 * simulate_replay.c - repeats given steps. Each must be enabled when its turn comes, by the rules of time and priority.
 *
 * The script has a line for each step, with four fields and a tab after each of the first three:
 *
 *     INDEX TIME PREFIX BINDING
 *
 * INDEX of the transition; TIME as a JSON number, or nothing when any will do; BINDING as the JSON object of a trace,
 * outputs of the code segment included, or nothing; PREFIX: what BINDING starts with, as far as the variables go that
 * are bound before the code segment runs, without the closing brace. JSON as pn_text.h writes it: texts are compared,
 * not values.
 */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "pn/pn_arena.h"
#include "pn/pn_num.h"
#include "pn/pn_text.h"
#include "simulate_impl.h"

#define SCRIPT_LINE_SIZE ((size_t)1U << 26U)

static char s_script[SCRIPT_LINE_SIZE];

typedef struct given {
    uint32_t transition;
    const char *time;
    const char *prefix;
    const char *binding;
} given_t;

/* The search for a given binding. */
typedef struct match {
    sim_t *sim;
    const char *prefix;
    bool is_found;
} match_t;

static bool refuse(sim_t *sim, const char *text, const char *detail)
{
    sim->why = "replay";
    (void)snprintf(sim->message, sizeof sim->message, "%s%s", text, detail);
    return false;
}

static bool compare(void *user, uint32_t transition, const void *binding)
{
    match_t *match = user;
    pn_text_t text;
    pn_text_init(&text, sim_text_buffer, sizeof sim_text_buffer);
    pn_json(pn_net.transition[transition].binding, binding, &text);
    const size_t length = strlen(match->prefix);
    const bool is_same = (strncmp(text.buffer, match->prefix, length) == 0)
                         && ((text.buffer[length] == '}') || (text.buffer[length] == ',') || (length <= 1U));
    if (is_same) {
        (void)memcpy(match->sim->binding, binding, pn_net.transition[transition].binding->size);
        match->is_found = true;
    }
    return !is_same;
}

/* Cuts a line of the script into its fields. */
static bool read_step(char *line, given_t *given)
{
    char *end = NULL;
    errno = 0;
    const unsigned long index = strtoul(line, &end, 10);
    char *const time = (*end == '\t') ? (end + 1) : NULL;
    char *const prefix = (time != NULL) ? strchr(time, '\t') : NULL;
    char *const binding = (prefix != NULL) ? strchr(prefix + 1, '\t') : NULL;
    if ((errno != 0) || (end == line) || (binding == NULL) || (index >= pn_net.transition_count)) {
        return false;
    }
    *prefix = '\0';
    *binding = '\0';
    binding[1U + strcspn(binding + 1, "\n")] = '\0';
    *given = (given_t){ (uint32_t)index, time, prefix + 1, binding + 1 };
    return true;
}

static bool check_time(sim_t *sim, const given_t *given)
{
    char now[PN_REAL_TEXT_SIZE];
    pn_text_t text;
    pn_text_init(&text, now, sizeof now);
    sim_text_time(&text, pn_now(&pn_net, sim->marking));
    if ((given->time[0] == '\0') || (strcmp(given->time, now) == 0)) {
        return true;
    }
    (void)snprintf(sim->message, sizeof sim->message, "it says time %.40s, but the clock shows %s", given->time, now);
    sim->why = "replay";
    return false;
}

/* Whether the outputs of the code segment are what the script says. */
static bool check_outputs(sim_t *sim, const given_t *given)
{
    if (given->binding[0] == '\0') {
        return true;
    }
    pn_text_t text;
    pn_text_init(&text, sim_text_buffer, sizeof sim_text_buffer);
    pn_json(pn_net.transition[given->transition].binding, sim->binding, &text);
    return (strcmp(text.buffer, given->binding) == 0) || refuse(sim, "the code segment gives ", text.buffer);
}

static bool repeat(sim_t *sim, const given_t *given)
{
    const pn_transition_t *t = &pn_net.transition[given->transition];
    sim->cx.step = sim->steps;
    const sim_next_t next = sim_advance_time(sim);
    if (next == SIM_FAILED) {
        return false;
    }
    if (next != SIM_FOUND) {
        return refuse(sim, "not enabled: nothing is", (next == SIM_BEYOND) ? " until the given time" : "");
    }
    if (sim->time_grew && !sim_watch_time(sim)) {
        return false;
    }
    if (!check_time(sim, given)) {
        return false;
    }
    const uint32_t best = sim->enabled[0];
    if (t->priority > pn_net.transition[best].priority) {
        return refuse(sim, "not enabled, because of the higher priority of ", pn_net.transition[best].name);
    }
    match_t match = { sim, given->prefix, false };
    (void)t->enumerate(&sim->cx, sim->marking, given->transition, compare, &match);
    if (!pn_ok(&sim->cx)) {
        sim_fail(sim, "looking for its bindings", (int64_t)given->transition, false);
        return false;
    }
    if (!match.is_found) {
        return refuse(sim, "not enabled with this binding: ", t->name);
    }
    return sim_fire(sim, given->transition) && check_outputs(sim, given);
}

static bool repeat_all(sim_t *sim, FILE *script)
{
    while (fgets(s_script, (int)sizeof s_script, script) != NULL) {
        given_t given;
        if (!read_step(s_script, &given)) {
            return refuse(sim, "the script of the replay is not well-formed", "");
        }
        if (!repeat(sim, &given)) {
            return false;
        }
        sim->replayed++;
        if (sim_progress_due != 0) {
            sim_report_progress(sim);
        }
        if (sim_interrupted != 0) {
            sim->why = "interrupted";
            return false;
        }
    }
    return true;
}

bool sim_replay(sim_t *sim)
{
    const bool is_input = strcmp(sim->options.replay, "-") == 0;
    FILE *script = is_input ? stdin : fopen(sim->options.replay, "r");
    if (script == NULL) {
        return refuse(sim, "the script of the replay cannot be read: ", strerror(errno));
    }
    const bool is_done = repeat_all(sim, script);
    if (!is_input) {
        (void)fclose(script);
    }
    return is_done;
}
