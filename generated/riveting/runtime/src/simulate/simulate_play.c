/* SPDX-License-Identifier: MIT
 * simulate_play.c - what is enabled, one of them drawn, its occurrence.
 *
 * The draw is that of pn_random.h: a number below the number of enabled transitions of the best priority, then a number
 * below the number of its bindings. A transition counts as enabled as soon as one binding is found; the others are
 * looked for only when it has been drawn. What is known of a transition stays known until something occurs that may
 * change it.
 *
 * Compiled by itself, this file calls the net through the table of pn_net.h. With -DPN_NET_SOURCE='"net.c"' the net
 * becomes part of this file: each transition has its own copies of `look` and `occur`, into which the compiler puts the
 * net's functions. The steps are the same, several times as fast.
 */
#if defined(__GNUC__)
#define SIM_INLINE inline __attribute__((always_inline))
#else
#define SIM_INLINE inline
#endif

#ifdef PN_NET_SOURCE
#define PN_NET_SEARCH SIM_INLINE /* see net.c */
#include PN_NET_SOURCE
#endif

#include <string.h>

#include "pn/pn_arena.h"
#include "pn/pn_num.h"
#include "pn/pn_random.h"
#include "simulate_impl.h"

typedef bool (*sim_enumerate_t)(pn_ctx_t *cx, const void *marking, uint32_t self, pn_binding_sink_t sink, void *user);
typedef bool (*sim_fire_t)(pn_ctx_t *cx, void *marking, uint32_t self, void *binding);

enum { SIM_WORD = 64 }; /* bits of a word of the sets of transitions */

void sim_fail(sim_t *sim, const char *doing, int64_t transition, bool has_binding)
{
    sim->why = "error";
    sim->doing = doing;
    sim->transition = transition;
    sim->has_binding = has_binding;
}

/* --- what is known ------------------------------------------------------------------------------------------------ */

static uint32_t sim_words(void)
{
    return (pn_net.order_count + (uint32_t)SIM_WORD - 1U) / (uint32_t)SIM_WORD;
}

/* The number of the only bit that is set. */
static SIM_INLINE uint32_t sim_bit_number(uint64_t bit)
{
#if defined(__GNUC__)
    return (uint32_t)__builtin_ctzll(bit);
#else
    uint32_t number = 0U;
    while ((bit >> number) != 1U) {
        number++;
    }
    return number;
#endif
}

static void sim_set(uint64_t *set, uint32_t k)
{
    set[k / (uint32_t)SIM_WORD] |= UINT64_C(1) << (k % (uint32_t)SIM_WORD);
}

bool sim_prepare(sim_t *sim)
{
    const uint32_t count = pn_net.order_count;
    const uint64_t words = sim_words();
    sim->enabled = sim_reserve(((uint64_t)count + 1U) * sizeof *sim->enabled);
    sim->level_end = sim_reserve(((uint64_t)count + 1U) * sizeof *sim->level_end);
    sim->ready = sim_reserve(words * sizeof *sim->ready);
    sim->unsure = sim_reserve(words * sizeof *sim->unsure);
    sim->touched = sim_reserve(words * pn_net.transition_count * sizeof *sim->touched);
    uint32_t *const position = sim_reserve(((uint64_t)pn_net.transition_count + 1U) * sizeof *position);
    if ((sim->enabled == NULL) || (sim->level_end == NULL) || (sim->ready == NULL) || (sim->unsure == NULL)
        || (sim->touched == NULL) || (position == NULL)) {
        return false;
    }
    uint32_t end = count;
    for (uint32_t k = count; k > 0U; k--) {
        const uint32_t i = pn_net.order[k - 1U];
        if ((k < count) && (pn_net.transition[pn_net.order[k]].priority != pn_net.transition[i].priority)) {
            end = k;
        }
        sim->level_end[k - 1U] = end;
        position[i] = k - 1U;
    }
    for (uint32_t i = 0U; i < pn_net.transition_count; i++) {
        const pn_transition_t *t = &pn_net.transition[i];
        uint64_t *const touched = &sim->touched[i * words];
        for (uint32_t k = 0U; k < t->affected_count; k++) {
            sim_set(touched, position[t->affected[k]]);
        }
        for (uint32_t k = 0U; (t->affected == NULL) && (k < count); k++) {
            sim_set(touched, k);
        }
    }
    sim_forget(sim);
    return true;
}

void sim_forget(sim_t *sim)
{
    for (uint32_t k = 0U; k < pn_net.order_count; k++) {
        sim_set(sim->unsure, k);
    }
    (void)memset(sim->ready, 0, sim_words() * sizeof *sim->ready);
}

/* Forgets what the occurrence of a transition may have changed. */
static SIM_INLINE void sim_forget_touched(sim_t *sim, uint32_t transition)
{
    const uint32_t words = sim_words();
    const uint64_t *const touched = &sim->touched[(size_t)transition * words];
    for (uint32_t w = 0U; w < words; w++) {
        sim->unsure[w] |= touched[w];
        sim->ready[w] &= ~touched[w];
    }
}

/* --- search ------------------------------------------------------------------------------------------------------- */

static inline bool sim_stop_at_first(void *user, uint32_t transition, const void *binding)
{
    (void)transition;
    (void)binding;
    *(bool *)user = true;
    return false;
}

/* Whether a transition has a binding now. */
static SIM_INLINE bool sim_look(sim_t *sim, uint32_t transition, sim_enumerate_t enumerate)
{
    bool is_found = false;
    const size_t mark = pn_arena_mark(sim->cx.arena);
    (void)enumerate(&sim->cx, sim->marking, transition, sim_stop_at_first, &is_found);
    pn_arena_release(sim->cx.arena, mark);
    return is_found;
}

/* The bindings of a transition: counted, and kept while there is room; or only binding number `wanted`. */
typedef struct sim_search {
    uint64_t count;
    uint64_t wanted;
    unsigned char *binding;
    size_t size;
    size_t used; /* bytes of what is kept */
    size_t room; /* bytes */
} sim_search_t;

/* The place for one more binding, which is counted; NULL: there is no more room. */
static SIM_INLINE void *sim_next_kept(sim_search_t *search, size_t size)
{
    const bool fits = size <= (search->room - search->used);
    unsigned char *const at = &search->binding[search->used];
    search->count++;
    search->used += fits ? size : 0U;
    return fits ? at : NULL;
}

static inline bool sim_pick(void *user, uint32_t transition, const void *binding)
{
    sim_search_t *search = user;
    (void)transition;
    if (search->count == search->wanted) {
        (void)memcpy(search->binding, binding, search->size);
        return false;
    }
    search->count++;
    return true;
}

/* The same, for calls through the table. */
static bool sim_find(void *user, uint32_t transition, const void *binding)
{
    return sim_pick(user, transition, binding);
}

#ifdef PN_NET_SOURCE
static inline bool sim_count(void *user, uint32_t transition, const void *binding)
{
    (void)transition;
    (void)binding;
    *(uint64_t *)user += 1U;
    return true;
}
#endif

/* --- draws -------------------------------------------------------------------------------------------------------- */

/* A number below `count` from the stream of the choice, which is started when the first is needed: of one thing there
 * is no choice, and no number is drawn. */
static SIM_INLINE uint64_t sim_choose(const sim_t *sim, uint64_t count, uint64_t *state)
{
    if (count <= 1U) {
        return 0U;
    }
    if (*state == 0U) {
        const uint64_t seed = sim->options.has_choice ? sim->options.choice : sim->cx.seed;
        *state = pn_random_key(seed, sim->cx.step, PN_RANDOM_CHOICE);
    }
    return pn_random_pick(state, count);
}

/* After an occurrence: trace, room, monitors. */
static bool sim_follow(sim_t *sim, uint32_t transition, const void *binding)
{
    bool is_fine = (sim->options.trace == NULL) || sim_trace_step(sim, transition, binding);
    if (is_fine && pn_arena_is_crowded(sim->cx.arena)) {
        pn_marking_collect(&pn_net, &sim->cx, sim->marking);
        if (!pn_ok(&sim->cx)) {
            sim_fail(sim, "room was made after it", (int64_t)transition, true);
            is_fine = false;
        }
    }
    if (is_fine && sim->is_watched && !sim_watch_step(sim, transition)) {
        if ((strcmp(sim->why, "error") == 0) && (sim->watch >= 0)) {
            sim->transition = (int64_t)transition;
            sim->has_binding = true;
        }
        is_fine = false;
    }
    if (!is_fine && (binding != sim->binding)) {
        (void)memcpy(sim->binding, binding, pn_net.transition[transition].binding->size);
    }
    return is_fine;
}

/* Lets a binding occur, which may be overwritten; false when the run ends here. */
static SIM_INLINE bool sim_fire_with(sim_t *sim, uint32_t transition, sim_fire_t fire, void *binding, size_t size)
{
    pn_ctx_t *const cx = &sim->cx;
    cx->step = sim->steps + 1U;
    if (!fire(cx, sim->marking, transition, binding)) {
        (void)memmove(sim->binding, binding, size);
        sim_fail(sim, "it occurred", (int64_t)transition, true);
        return false;
    }
    sim->steps++;
    sim_forget_touched(sim, transition);
    const bool is_quick = (sim->options.trace == NULL) && !sim->is_watched && !pn_arena_is_crowded(cx->arena);
    return is_quick || sim_follow(sim, transition, binding);
}

/* Draws one of the bindings of a transition and lets it occur; false when the run ends here. */
static SIM_INLINE bool sim_occur(sim_t *sim, uint32_t transition, uint64_t state, sim_enumerate_t enumerate,
                                 pn_binding_sink_t keep, sim_fire_t fire, size_t size)
{
    pn_ctx_t *const cx = &sim->cx;
    sim_search_t search = { .binding = sim->found, .size = size, .room = sim->found_size };
    const size_t mark = pn_arena_mark(cx->arena);
    (void)enumerate(cx, sim->marking, transition, keep, &search);
    if (!pn_ok(cx)) {
        sim_fail(sim, "looking for its bindings", (int64_t)transition, false);
        return false;
    }
    const uint64_t wanted = sim_choose(sim, search.count, &state);
    unsigned char *binding = &sim->found[wanted * size];
    if ((wanted * size) >= search.used) {
        sim_search_t again = { .binding = sim->binding, .size = size, .wanted = wanted };
        binding = sim->binding;
        pn_arena_release(cx->arena, mark);
        (void)pn_net.transition[transition].enumerate(cx, sim->marking, transition, sim_find, &again);
    }
    return sim_fire_with(sim, transition, fire, binding, size);
}

#ifdef PN_NET_SOURCE
/* The same where each choice of tokens is a binding: the compiler makes products of the loops that count, so nothing is
 * kept. */
static SIM_INLINE bool sim_occur_plain(sim_t *sim, uint32_t transition, uint64_t state, sim_enumerate_t enumerate,
                                       sim_fire_t fire, size_t size)
{
    sim_search_t search = { .binding = sim->binding, .size = size };
    uint64_t count = 0U;
    (void)enumerate(&sim->cx, sim->marking, transition, sim_count, &count);
    search.wanted = sim_choose(sim, count, &state);
    (void)enumerate(&sim->cx, sim->marking, transition, sim_pick, &search);
    return sim_fire_with(sim, transition, fire, sim->binding, size);
}
#endif

bool sim_fire(sim_t *sim, uint32_t transition)
{
    const pn_transition_t *t = &pn_net.transition[transition];
    return sim_fire_with(sim, transition, t->fire, sim->binding, t->binding->size);
}

/* --- the net's own, or those of its table ------------------------------------------------------------------------- */

#ifdef PN_NET_SOURCE

/* A binding is kept by assignment: the compiler then leaves out what it need not put together first. */
#define SIM_TRANSITION(index, code, is_plain)                                                                   \
    static inline bool sim_keep_##index(void *user, uint32_t transition, const void *binding)                   \
    {                                                                                                           \
        code##_binding_t *const at = sim_next_kept(user, sizeof *at);                                           \
        (void)transition;                                                                                       \
        if (at != NULL) {                                                                                       \
            *at = *(const code##_binding_t *)binding;                                                           \
        }                                                                                                       \
        return true;                                                                                            \
    }                                                                                                           \
    static bool sim_look_##index(sim_t *sim)                                                                    \
    {                                                                                                           \
        return sim_look(sim, index, code##_enumerate);                                                          \
    }                                                                                                           \
    static bool sim_occur_##index(sim_t *sim, uint64_t state)                                                   \
    {                                                                                                           \
        if (is_plain) {                                                                                         \
            return sim_occur_plain(sim, index, state, code##_enumerate, code##_fire, sizeof(code##_binding_t)); \
        }                                                                                                       \
        return sim_occur(sim, index, state, code##_enumerate, sim_keep_##index, code##_fire,                    \
                         sizeof(code##_binding_t));                                                             \
    }
#define SIM_ROW(index, code, is_plain) { sim_look_##index, sim_occur_##index },
#ifndef NET_TRANSITIONS /* there is none */
#define NET_TRANSITIONS(EACH)
#endif

NET_TRANSITIONS(SIM_TRANSITION)

typedef struct sim_row {
    bool (*look)(sim_t *sim);
    bool (*occur)(sim_t *sim, uint64_t state);
} sim_row_t;

static const sim_row_t sim_table[] = { NET_TRANSITIONS(SIM_ROW){ NULL, NULL } };

static SIM_INLINE bool sim_look_at(sim_t *sim, uint32_t transition)
{
    return sim_table[transition].look(sim);
}

static SIM_INLINE bool sim_occur_at(sim_t *sim, uint32_t transition, uint64_t state)
{
    return sim_table[transition].occur(sim, state);
}

#else

static bool sim_keep(void *user, uint32_t transition, const void *binding)
{
    const size_t size = pn_net.transition[transition].binding->size;
    void *const at = sim_next_kept(user, size);
    if (at != NULL) {
        (void)memcpy(at, binding, size);
    }
    return true;
}

static bool sim_look_at(sim_t *sim, uint32_t transition)
{
    return sim_look(sim, transition, pn_net.transition[transition].enumerate);
}

static bool sim_occur_at(sim_t *sim, uint32_t transition, uint64_t state)
{
    const pn_transition_t *t = &pn_net.transition[transition];
    return sim_occur(sim, transition, state, t->enumerate, sim_keep, t->fire, t->binding->size);
}

#endif

/* --- steps -------------------------------------------------------------------------------------------------------- */

/* Fills `enabled` with the transitions of the best priority that are enabled now. False after an error. */
static SIM_INLINE bool sim_find_them(sim_t *sim)
{
    uint32_t count = 0U;
    uint32_t last = pn_net.order_count;
    for (uint32_t w = 0U; (w * (uint32_t)SIM_WORD) < last; w++) {
        uint64_t ready = sim->ready[w];
        uint64_t looked_at = 0U;
        uint64_t left = ready | sim->unsure[w];
        while (left != 0U) {
            const uint64_t bit = left & (~left + 1U);
            const uint32_t k = (w * (uint32_t)SIM_WORD) + sim_bit_number(bit);
            left ^= bit;
            if (k >= last) {
                break;
            }
            const uint32_t i = pn_net.order[k];
            if ((ready & bit) == 0U) {
                const bool is_enabled = sim_look_at(sim, i);
                if (!pn_ok(&sim->cx)) {
                    sim_fail(sim, "looking for its bindings", (int64_t)i, false);
                    return false;
                }
                looked_at |= bit;
                if (!is_enabled) {
                    continue;
                }
                ready |= bit;
            }
            sim->enabled[count] = i;
            if (count == 0U) {
                last = sim->level_end[k]; /* what comes after is less urgent */
            }
            count++;
        }
        sim->ready[w] = ready;
        sim->unsure[w] &= ~looked_at;
    }
    sim->enabled_count = count;
    return true;
}

bool sim_find_enabled(sim_t *sim)
{
    return sim_find_them(sim);
}

static bool sim_is_after(pn_time_t a, pn_time_t b)
{
    return pn_net.real_time ? (a.real > b.real) : (a.integer > b.integer);
}

/* Moves time on if nothing is enabled now, and keeps to --until. */
static sim_next_t sim_move_on(sim_t *sim)
{
    bool is_fine = true;
    const pn_time_t start = pn_now(&pn_net, sim->marking);
    pn_time_t next = start;
    while (is_fine && (sim->enabled_count == 0U) && pn_net.timed
           && pn_next_time(&pn_net, &sim->cx, sim->marking, &next)) {
        pn_set_now(&pn_net, sim->marking, next);
        sim_forget(sim);
        is_fine = sim_find_enabled(sim);
        sim->time_grew = true;
    }
    if (is_fine && !pn_ok(&sim->cx)) {
        sim_fail(sim, "looking for the next time", -1, false);
        is_fine = false;
    }
    if (!is_fine) {
        return SIM_FAILED;
    }
    if (sim->enabled_count == 0U) {
        pn_set_now(&pn_net, sim->marking, start);
        sim_forget(sim);
        return SIM_FINISHED;
    }
    const bool is_beyond = sim->options.has_until && sim_is_after(pn_now(&pn_net, sim->marking), sim->options.until);
    if (is_beyond) {
        pn_set_now(&pn_net, sim->marking, sim_is_after(start, sim->options.until) ? start : sim->options.until);
        sim_forget(sim);
    }
    return is_beyond ? SIM_BEYOND : SIM_FOUND;
}

static SIM_INLINE sim_next_t sim_advance_time_here(sim_t *sim)
{
    sim->time_grew = false;
    if (!sim_find_them(sim)) {
        return SIM_FAILED;
    }
    return ((sim->enabled_count > 0U) && !sim->options.has_until) ? SIM_FOUND : sim_move_on(sim);
}

sim_next_t sim_advance_time(sim_t *sim)
{
    return sim_advance_time_here(sim);
}

/* One occurrence at random; false when the run ends here (`why` says why). */
static SIM_INLINE bool sim_step(sim_t *sim)
{
    uint64_t state = 0U;
    sim->cx.step = sim->steps;
    switch (sim_advance_time_here(sim)) {
    case SIM_FOUND:
        if (!sim->time_grew || sim_watch_time(sim)) {
            const uint64_t drawn = sim_choose(sim, sim->enabled_count, &state);
            return sim_occur_at(sim, sim->enabled[drawn], state);
        }
        return false;
    case SIM_FINISHED: sim->why = "finished"; return false;
    case SIM_BEYOND: sim->why = "until"; return false;
    case SIM_FAILED:
    default: return false;
    }
}

/* The run was to be no longer; whether anything is left to occur, now or later. */
static void end_at_limit(sim_t *sim)
{
    const pn_time_t now = pn_now(&pn_net, sim->marking);
    sim->cx.step = sim->steps;
    switch (sim_advance_time_here(sim)) {
    case SIM_FINISHED: sim->why = "finished"; break;
    case SIM_FOUND:
    case SIM_BEYOND:
        if (pn_net.timed) {
            pn_set_now(&pn_net, sim->marking, now); /* the time goes on with the next occurrence only */
            sim_forget(sim);
        }
        break;
    case SIM_FAILED:
    default: break;
    }
}

void sim_play(sim_t *sim)
{
    sim->why = "steps";
    for (uint64_t step = 0U; step < sim->options.steps; step++) {
        if (sim_interrupted != 0) {
            sim->why = "interrupted";
            return;
        }
        if (!sim_step(sim)) {
            return;
        }
        if (sim_progress_due != 0) {
            sim_report_progress(sim);
        }
    }
    if (sim->options.steps > 0U) {
        end_at_limit(sim);
    }
}
