/* SPDX-License-Identifier: MIT
 * simulate_play.c - what is enabled, one of them drawn, its occurrence.
 *
 * The draw is that of pn_random.h: a number below the number of enabled transitions of the best priority, then a number below
 * the number of its bindings. A transition counts as enabled as soon as one binding is found; the others are looked for only
 * when it has been drawn.
 */
#define _POSIX_C_SOURCE 200809L /* sigaction */
#define _XOPEN_SOURCE 700

#include <errno.h>
#include <signal.h>
#include <string.h>

#include "pn/pn_arena.h"
#include "pn/pn_num.h"
#include "pn/pn_random.h"
#include "simulate_impl.h"

static volatile sig_atomic_t s_interrupted;

static void on_signal(int number)
{
    (void)number;
    s_interrupted = 1;
}

bool sim_is_interrupted(void)
{
    return s_interrupted != 0;
}

void sim_catch_signals(void)
{
    struct sigaction action;
    (void)memset(&action, 0, sizeof action);
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART | (int)SA_RESETHAND; /* the second one ends the program at once */
    (void)sigemptyset(&action.sa_mask);
    (void)sigaction(SIGINT, &action, NULL);
    (void)sigaction(SIGTERM, &action, NULL);
    action.sa_handler = SIG_IGN; /* a file that may not grow any more is an error of writing */
    action.sa_flags = 0;
    (void)sigaction(SIGXFSZ, &action, NULL);
}

void sim_fail(sim_t *sim, const char *doing, int64_t transition, bool has_binding)
{
    sim->why = "error";
    sim->doing = doing;
    sim->transition = transition;
    sim->has_binding = has_binding;
}

/* --- search -------------------------------------------------------------------------------------------------------- */

static bool stop_at_first(void *user, uint32_t transition, const void *binding)
{
    (void)transition;
    (void)binding;
    *(bool *)user = true;
    return false;
}

/* The bindings of a transition: counted, and kept while there is room; or only binding number `wanted`. */
typedef struct search {
    uint64_t count;
    uint64_t wanted;
    void *binding;
    size_t size;
    unsigned char *kept;
    size_t used; /* bytes of what is kept */
    size_t room; /* bytes */
} search_t;

static bool keep_binding(void *user, uint32_t transition, const void *binding)
{
    search_t *search = user;
    (void)transition;
    if (search->size <= (search->room - search->used)) {
        (void)memcpy(&search->kept[search->used], binding, search->size);
        search->used += search->size;
    }
    search->count++;
    return true;
}

static bool find_binding(void *user, uint32_t transition, const void *binding)
{
    search_t *search = user;
    (void)transition;
    if (search->count == search->wanted) {
        (void)memcpy(search->binding, binding, search->size);
        return false;
    }
    search->count++;
    return true;
}

void sim_forget(sim_t *sim)
{
    (void)memset(sim->known, SIM_UNKNOWN, pn_net.transition_count);
}

/* Whether a transition is enabled; looks only when it is not known. */
static bool is_enabled(sim_t *sim, uint32_t transition)
{
    if (sim->known[transition] == (uint8_t)SIM_UNKNOWN) {
        bool is_found = false;
        const size_t mark = pn_arena_mark(sim->cx.arena);
        (void)pn_net.transition[transition].enumerate(&sim->cx, sim->marking, transition, stop_at_first, &is_found);
        pn_arena_release(sim->cx.arena, mark);
        sim->known[transition] = (uint8_t)((is_found && pn_ok(&sim->cx)) ? SIM_ENABLED : SIM_DISABLED);
    }
    return sim->known[transition] == (uint8_t)SIM_ENABLED;
}

void sim_find_levels(sim_t *sim)
{
    uint32_t end = pn_net.order_count;
    for (uint32_t k = pn_net.order_count; k > 0U; k--) {
        const int32_t priority = pn_net.transition[pn_net.order[k - 1U]].priority;
        if ((k < pn_net.order_count) && (pn_net.transition[pn_net.order[k]].priority != priority)) {
            end = k;
        }
        sim->level_end[k - 1U] = end;
    }
}

/* Fills `enabled` with the transitions of the best priority that are enabled now. False after an error. */
bool sim_find_enabled(sim_t *sim)
{
    uint32_t count = 0U;
    uint32_t last = pn_net.order_count;
    for (uint32_t k = 0U; k < last; k++) {
        const uint32_t i = pn_net.order[k];
        if (is_enabled(sim, i)) {
            sim->enabled[count] = i;
            if (count == 0U) {
                last = sim->level_end[k]; /* what comes after is less urgent */
            }
            count++;
        } else if (!pn_ok(&sim->cx)) {
            sim_fail(sim, "looking for its bindings", (int64_t)i, false);
            return false;
        }
    }
    sim->enabled_count = count;
    return true;
}

static bool is_after(pn_time_t a, pn_time_t b)
{
    return pn_net.real_time ? (a.real > b.real) : (a.integer > b.integer);
}

sim_next_t sim_settle(sim_t *sim)
{
    bool is_fine = sim_find_enabled(sim);
    sim->time_grew = false;
    if (is_fine && (sim->enabled_count > 0U) && !sim->options.has_until) {
        return SIM_FOUND;
    }
    const pn_time_t start = pn_net.now(sim->marking);
    pn_time_t next = start;
    while (is_fine && (sim->enabled_count == 0U) && pn_net.timed && pn_net.next_time(sim->marking, &next)) {
        pn_net.set_now(sim->marking, next);
        sim_forget(sim);
        is_fine = sim_find_enabled(sim);
        sim->time_grew = true;
    }
    if (!is_fine) {
        return SIM_FAILED;
    }
    if (sim->enabled_count == 0U) {
        pn_net.set_now(sim->marking, start);
        sim_forget(sim);
        return SIM_FINISHED;
    }
    const bool is_beyond = sim->options.has_until && is_after(pn_net.now(sim->marking), sim->options.until);
    if (is_beyond) {
        pn_net.set_now(sim->marking, is_after(start, sim->options.until) ? start : sim->options.until);
        sim_forget(sim);
    }
    return is_beyond ? SIM_BEYOND : SIM_FOUND;
}

/* A number below `count` from the stream of the choice, which is started when the first is needed: of one thing there is no
 * choice, and no number is drawn. */
static uint64_t choose(sim_t *sim, uint64_t count, uint64_t *state)
{
    pn_ctx_t *cx = &sim->cx;
    if (count <= 1U) {
        return 0U;
    }
    if (*state == 0U) {
        const uint64_t seed = cx->seed;
        cx->seed = sim->options.has_choice ? sim->options.choice : seed;
        pn_random_start(cx, PN_RANDOM_CHOICE);
        cx->seed = seed;
    } else {
        cx->random = *state; /* enumerating has started streams of its own */
    }
    const int64_t chosen = pn_random_below(cx, (int64_t)count);
    *state = cx->random;
    return (uint64_t)chosen;
}

/* Draws one of the enabled transitions and one of its bindings. False after an error. */
static bool draw(sim_t *sim, uint32_t *transition)
{
    pn_ctx_t *cx = &sim->cx;
    uint64_t state = 0U;
    const uint32_t i = sim->enabled[choose(sim, sim->enabled_count, &state)];
    search_t search = { .binding = sim->binding, .size = pn_net.transition[i].binding_size };
    search.kept = sim->found;
    search.room = sim->found_size;
    const size_t mark = pn_arena_mark(cx->arena);
    (void)pn_net.transition[i].enumerate(cx, sim->marking, i, keep_binding, &search);
    *transition = i;
    if (!pn_ok(cx)) {
        sim_fail(sim, "looking for its bindings", (int64_t)i, false);
        return false;
    }
    search.wanted = choose(sim, search.count, &state);
    if ((search.wanted * search.size) < search.used) {
        (void)memcpy(sim->binding, &sim->found[search.wanted * search.size], search.size);
        return true;
    }
    pn_arena_release(cx->arena, mark);
    search.count = 0U;
    (void)pn_net.transition[i].enumerate(cx, sim->marking, i, find_binding, &search);
    return true;
}

/* --- steps --------------------------------------------------------------------------------------------------------- */

bool sim_fire(sim_t *sim, uint32_t transition)
{
    pn_ctx_t *cx = &sim->cx;
    cx->step = sim->steps + 1U;
    if (!pn_net.transition[transition].fire(cx, sim->marking, sim->binding)) {
        sim_fail(sim, "it occurred", (int64_t)transition, true);
        return false;
    }
    sim->steps++;
    const pn_transition_t *done = &pn_net.transition[transition];
    if (done->affected == NULL) {
        sim_forget(sim);
    }
    for (uint32_t k = 0U; k < done->affected_count; k++) {
        sim->known[done->affected[k]] = (uint8_t)SIM_UNKNOWN;
    }
    if (sim->options.trace != NULL) {
        pn_trace_model_occurrence(&sim->trace, pn_net.now(sim->marking), pn_net.real_time, done, sim->binding);
        if (sim->trace.failed) {
            (void)snprintf(sim->message, sizeof sim->message, "%s", strerror(errno));
            sim->why = "trace";
            return false;
        }
    }
    if (pn_arena_is_crowded(cx->arena)) {
        pn_net.collect(cx, sim->marking);
        if (!pn_ok(cx)) {
            sim_fail(sim, "room was made after it", (int64_t)transition, true);
            return false;
        }
    }
    if (!sim_watch_step(sim, transition)) {
        if ((strcmp(sim->why, "error") == 0) && (sim->watch >= 0)) {
            sim->transition = (int64_t)transition;
            sim->has_binding = true;
        }
        return false;
    }
    return true;
}

bool sim_step(sim_t *sim)
{
    uint32_t transition = 0U;
    sim->cx.step = sim->steps;
    switch (sim_settle(sim)) {
    case SIM_FOUND:
        return (!sim->time_grew || sim_watch_time(sim)) && draw(sim, &transition) && sim_fire(sim, transition);
    case SIM_FINISHED:
        sim->why = "finished";
        return false;
    case SIM_BEYOND:
        sim->why = "until";
        return false;
    case SIM_FAILED:
    default:
        return false;
    }
}
