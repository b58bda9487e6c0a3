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

/* Fills `enabled` with the transitions of the best priority that are enabled now. False after an error. */
static bool find_enabled(sim_t *sim)
{
    int32_t best = 0;
    sim->enabled_count = 0U;
    for (uint32_t k = 0U; k < pn_net.order_count; k++) {
        const uint32_t i = pn_net.order[k];
        if ((sim->enabled_count > 0U) && (pn_net.transition[i].priority > best)) {
            break;
        }
        bool is_enabled = false;
        const size_t mark = pn_arena_mark(sim->cx.arena);
        (void)pn_net.transition[i].enumerate(&sim->cx, sim->marking, i, stop_at_first, &is_enabled);
        pn_arena_release(sim->cx.arena, mark);
        if (!pn_ok(&sim->cx)) {
            sim_fail(sim, "looking for its bindings", (int64_t)i, false);
            return false;
        }
        if (is_enabled) {
            best = pn_net.transition[i].priority;
            sim->enabled[sim->enabled_count] = i;
            sim->enabled_count++;
        }
    }
    return true;
}

static bool is_after(pn_time_t a, pn_time_t b)
{
    return pn_net.real_time ? (a.real > b.real) : (a.integer > b.integer);
}

sim_next_t sim_settle(sim_t *sim)
{
    const pn_time_t start = pn_net.now(sim->marking);
    pn_time_t next = start;
    bool is_fine = find_enabled(sim);
    while (is_fine && (sim->enabled_count == 0U) && pn_net.timed && pn_net.next_time(sim->marking, &next)) {
        pn_net.set_now(sim->marking, next);
        is_fine = find_enabled(sim);
    }
    if (!is_fine) {
        return SIM_FAILED;
    }
    if (sim->enabled_count == 0U) {
        pn_net.set_now(sim->marking, start);
        return SIM_FINISHED;
    }
    const bool is_beyond = sim->options.has_until && is_after(pn_net.now(sim->marking), sim->options.until);
    if (is_beyond) {
        pn_net.set_now(sim->marking, is_after(start, sim->options.until) ? start : sim->options.until);
    }
    return is_beyond ? SIM_BEYOND : SIM_FOUND;
}

/* Draws one of the enabled transitions and one of its bindings. False after an error. */
static bool draw(sim_t *sim, uint32_t *transition)
{
    pn_ctx_t *cx = &sim->cx;
    const uint64_t seed = cx->seed;
    cx->seed = sim->options.has_choice ? sim->options.choice : seed;
    pn_random_start(cx, PN_RANDOM_CHOICE);
    cx->seed = seed;
    const uint32_t i = sim->enabled[pn_random_below(cx, (int64_t)sim->enabled_count)];
    const uint64_t state = cx->random; /* enumerating starts streams of its own */
    search_t search = { 0U, 0U, NULL, pn_net.transition[i].binding_size };
    const size_t mark = pn_arena_mark(cx->arena);
    (void)pn_net.transition[i].enumerate(cx, sim->marking, i, count_binding, &search);
    pn_arena_release(cx->arena, mark);
    *transition = i;
    if (!pn_ok(cx)) {
        sim_fail(sim, "looking for its bindings", (int64_t)i, false);
        return false;
    }
    cx->random = state;
    search.wanted = (uint64_t)pn_random_below(cx, (int64_t)search.count);
    search.binding = sim->binding;
    search.count = 0U;
    (void)pn_net.transition[i].enumerate(cx, sim->marking, i, count_binding, &search);
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
    pn_trace_model_occurrence(&sim->trace, pn_net.now(sim->marking), pn_net.real_time, &pn_net.transition[transition],
                              sim->binding);
    if (sim->trace.failed) {
        (void)snprintf(sim->message, sizeof sim->message, "%s", strerror(errno));
        sim->why = "trace";
        return false;
    }
    if (pn_arena_is_crowded(cx->arena)) {
        pn_net.collect(cx, sim->marking);
        if (!pn_ok(cx)) {
            sim_fail(sim, "room was made after it", (int64_t)transition, true);
            return false;
        }
    }
    return true;
}

bool sim_step(sim_t *sim)
{
    uint32_t transition = 0U;
    sim->cx.step = sim->steps;
    switch (sim_settle(sim)) {
    case SIM_FOUND:
        return draw(sim, &transition) && sim_fire(sim, transition);
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
