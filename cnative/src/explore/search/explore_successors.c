/* SPDX-License-Identifier: MIT
 * explore_successors.c - what is enabled in a state, and what becomes of it.
 */
#include "explore_local.h"
#include "explore_successors.h"
#include "../state/explore_roots.h"
#include "explore_counts.h"
#include "explore_reduce.h"
#include "explore_turns.h"

#include <string.h>

#include "pn/pn_arena.h"
#include "pn/pn_num.h"

typedef struct hunt {
    ex_worker_t *worker;
    ex_arc_sink_t sink;
    ex_times_sink_t times;       /* not NULL: instead of `sink` */
    ex_marking_sink_t all;       /* not NULL: gets every successor, as it is */
    pn_successor_sink_t on_next; /* what is done with each */
    void *user;
    bool is_found;
    bool is_stopped;       /* by the sink */
    bool is_local;         /* explore_local.c is asked first; other places than packed ones may not be loaded */
    bool is_single;        /* one successor of the transition at hand is enough */
    bool is_probe;         /* it is enough that there is one */
    bool seeks_choice;     /* it is looked whether there is more than what is taken */
    bool is_second;        /* what is enough has been found, and there may be more */
    bool has_aged;         /* worker->marking is later than the cells of the codec */
    const bool *is_chosen; /* by transition: what the reductions look at; NULL: all */
    ex_asked_t *asked;     /* not NULL: owners are only asked what is enabled, and it is noted here by transition */
    const bool *has_turn;  /* by owner: whether it is looked at; NULL: all are */
} hunt_t;

bool ex_is_repeatable(void)
{
    bool is_repeatable = true;
    for (uint32_t t = 0U; t < pn_net.transition_count; t++) {
        is_repeatable = is_repeatable && !pn_net.transition[t].looks_outside;
    }
    return is_repeatable;
}

/* Makes all stamps count from `by` on. */
static void age(void *marking, pn_time_t by)
{
    for (uint32_t i = 0U; i < pn_net.place_count; i++) {
        pn_multiset_age(pn_net.place[i].multiset, marking, by);
    }
}

/* What an occurrence has put with a stamp before the time (its delay is negative) is available like all that is. */
static void make_available(void *next, uint32_t transition)
{
    for (uint32_t k = 0U; k < pn_net.transition[transition].touched_count; k++) {
        const pn_place_t *place = &pn_net.place[pn_net.transition[transition].touched[k]];
        pn_multiset_age(place->multiset, next, (pn_time_t){ .integer = 0 });
    }
}

void ex_reduce_time(ex_worker_t *worker)
{
    if (worker->run->options.is_time_reduced) {
        age(worker->marking, (pn_time_t){ .integer = 0 });
    }
}

/* Whether the reductions look at a successor. */
static bool is_taken(const hunt_t *hunt, uint32_t transition, const void *next)
{
    bool is_known = true;
    const bool is_taken = ex_stubborn_takes(hunt->worker, transition, next, &is_known);
    if (!is_known) {
        ex_differs(hunt->worker, transition, "a binding element occurs that the table of elements lacks");
    }
    return is_taken;
}

/* The key of a successor, of that which stands for it if there are symmetries. */
static bool encode(const hunt_t *hunt, uint32_t transition, const void *next, ex_key_t *key)
{
    ex_worker_t *const worker = hunt->worker;
    const ex_reduction_t *reduction = worker->run->reduction;
    if ((reduction != NULL) && reduction->is_symmetric) {
        pn_arena_t *const arena = &worker->scratch->arena;
        const size_t mark = pn_arena_mark(arena);
        const size_t peak = arena->peak; /* what is needed to find it is no need of the net */
        const uint32_t root = worker->run->codec->root_word;
        uint32_t *const held = (root == UINT32_MAX) ? NULL : &worker->scratch->cell[root];
        const uint32_t before = (held == NULL) ? 0U : *held; /* what references are to hold again */
        const void *const marking = ex_canonical(worker, next);
        const bool is_fine = (marking != NULL) && ex_encode(worker, marking, key);
        if (held != NULL) {
            *held = before;
        }
        pn_arena_release(arena, mark);
        arena->peak = peak;
        return is_fine;
    }
    return ex_encode_next(hunt->worker, transition, next, key);
}

static bool pass_on(const hunt_t *hunt, uint32_t transition, const void *binding, const ex_key_t *key)
{
    return (hunt->times != NULL) ? hunt->times(hunt->user, transition, 1U, key)
                                 : hunt->sink(hunt->user, transition, binding, key);
}

static bool is_seeking(const ex_run_t *run)
{
    return run->seeks_choice && !atomic_load_explicit(&run->has_choice, memory_order_relaxed);
}

/* A successor that is not taken: it is seen that there is one. */
static bool is_seen_only(hunt_t *hunt)
{
    if (hunt->is_second) {
        atomic_store_explicit(&hunt->worker->run->has_choice, true, memory_order_relaxed);
    }
    hunt->is_found = true;
    return hunt->is_second || hunt->is_probe;
}

/* Whether more successors of the transition are wanted after one that was taken. */
static bool wants_more(hunt_t *hunt)
{
    hunt->is_second = !hunt->is_stopped && hunt->is_single && hunt->seeks_choice;
    return !hunt->is_stopped && (!hunt->is_single || hunt->is_second);
}

/* One of those for which a successor stands that is counted up to a limit. */
typedef struct counted {
    hunt_t *hunt;
    uint32_t transition;
    const void *binding;
} counted_t;

static bool on_counted(void *user, const void *next)
{
    const counted_t *const counted = user;
    hunt_t *const hunt = counted->hunt;
    ex_key_t key;
    if (!ex_encode_next(hunt->worker, counted->transition, next, &key)) {
        return false;
    }
    hunt->is_stopped = !pass_on(hunt, counted->transition, counted->binding, &key);
    return !hunt->is_stopped;
}

/* The same where tokens are counted up to a limit. */
static bool on_counting(void *user, uint32_t transition, const void *binding, const void *next)
{
    hunt_t *const hunt = user;
    counted_t counted = { .hunt = hunt, .transition = transition, .binding = binding };
    if (is_seen_only(hunt)) {
        return false;
    }
    (void)next; /* that is *scratch->next */
    return ex_counts_each(hunt->worker, transition, hunt->worker->scratch->next, on_counted, &counted)
           && wants_more(hunt);
}

static bool on_successor(void *user, uint32_t transition, const void *binding, const void *next)
{
    hunt_t *hunt = user;
    const ex_reduction_t *reduction = hunt->worker->run->reduction;
    ex_key_t key;
    if (is_seen_only(hunt)) {
        return false;
    }
    if (hunt->all != NULL) {
        hunt->is_stopped = !hunt->all(hunt->user, transition, binding, next);
        return !hunt->is_stopped && !hunt->is_single;
    }
    if ((reduction != NULL) && reduction->is_stubborn && !is_taken(hunt, transition, next)) {
        return !hunt->worker->failed;
    }
    if (hunt->worker->run->options.is_time_reduced) {
        make_available(hunt->worker->scratch->next, transition); /* that is *next */
        if (hunt->has_aged && !ex_encode_time(hunt->worker)) {
            return false;
        }
        hunt->has_aged = false;
    }
    if (!encode(hunt, transition, next, &key)) {
        return false;
    }
    hunt->is_stopped = !pass_on(hunt, transition, binding, &key);
    return wants_more(hunt);
}

/* The same where nothing is reduced and the packed part of the marking is the key. */
static bool on_plain(void *user, uint32_t transition, const void *binding, const void *next)
{
    hunt_t *hunt = user;
    ex_key_t key;
    if (is_seen_only(hunt)) {
        return false;
    }
    ex_plain_key(hunt->worker->run->codec, next, &key);
    hunt->is_stopped = !pass_on(hunt, transition, binding, &key);
    return wants_more(hunt);
}

/* The same where occurrences may change references: they are as before afterwards. */
static bool on_assigning(void *user, uint32_t transition, const void *binding, const void *next)
{
    hunt_t *hunt = user;
    const bool goes_on = on_successor(user, transition, binding, next);
    return (!pn_net.transition[transition].assigns || ex_roots_restore(hunt->worker)) && goes_on;
}

/* Of transitions that can only be enumerated and fired. */
static bool on_binding(void *user, uint32_t transition, const void *binding)
{
    hunt_t *hunt = user;
    ex_worker_t *worker = hunt->worker;
    ex_scratch_t *scratch = worker->scratch;
    const size_t mark = pn_arena_mark(&scratch->arena);
    const uint64_t random = worker->cx.random; /* the search goes on with its own numbers */
    (void)memcpy(scratch->binding, binding, pn_net.transition[transition].binding->size);
    (void)memcpy(scratch->next, worker->marking, pn_net.marking_size);
    const bool is_done = pn_net.transition[transition].fire(&worker->cx, scratch->next, transition, scratch->binding)
                         && hunt->on_next(user, transition, scratch->binding, scratch->next);
    worker->cx.random = random;
    pn_arena_release(&scratch->arena, mark);
    return is_done;
}

static bool load_places(ex_worker_t *worker, const uint32_t *place, uint32_t count)
{
    bool is_fine = true;
    for (uint32_t i = 0U; is_fine && (i < count); i++) {
        if (!pn_net.place[place[i]].multiset->is_packed) {
            is_fine = ex_load_place(worker, place[i], worker->scratch->cell[worker->run->codec->word_of[place[i]]]);
        }
    }
    return is_fine;
}

/* All that a transition looks at. */
static bool load_places_of(ex_worker_t *worker, uint32_t t)
{
    const pn_transition_t *transition = &pn_net.transition[t];
    if (transition->read == NULL) {
        return ex_load_places(worker);
    }
    return load_places(worker, transition->read, transition->read_count)
           && load_places(worker, transition->touched, transition->touched_count);
}

/* The same as hunt_transition from what is remembered; false: that has to be done itself. */
static bool hunt_local(hunt_t *hunt, uint32_t t, bool *goes_on)
{
    const ex_local_found_t found = ex_local_successors(hunt->worker, t, hunt->times, hunt->user);
    hunt->is_found = hunt->is_found || (found >= EX_LOCAL_SOME);
    hunt->is_stopped = found == EX_LOCAL_STOPPED;
    *goes_on = (found == EX_LOCAL_NONE) || (found == EX_LOCAL_SOME);
    return found != EX_LOCAL_UNKNOWN;
}

/* The transition at position k of the order is next. */
static void look_ahead(const hunt_t *hunt, uint32_t k)
{
    if (hunt->is_local && ((k % EX_AHEAD) == 0U)) {
        const uint32_t left = pn_net.order_count - k;
        ex_local_ahead(hunt->worker, &pn_net.order[k], (left < EX_AHEAD) ? left : EX_AHEAD);
    }
}

/* What is looked at only to see whether there is a choice may raise an exception that nothing else comes to. */
static void forget_error(const hunt_t *hunt)
{
    if (hunt->worker->cx.error != PN_OK) {
        hunt->worker->cx.error = PN_OK;
        atomic_store_explicit(&hunt->worker->run->has_choice, true, memory_order_relaxed);
    }
}

/* All bindings of a transition; false when it is to go no further. */
static bool hunt_transition(hunt_t *hunt, uint32_t t)
{
    ex_worker_t *worker = hunt->worker;
    bool goes_on = true;
    if (hunt->is_local) {
        if (!hunt->is_single && !hunt->is_probe && !hunt->is_second && hunt_local(hunt, t, &goes_on)) {
            return goes_on;
        }
        if (!load_places_of(worker, t)) {
            return false;
        }
    }
    const pn_transition_t *transition = &pn_net.transition[t];
    const size_t mark = ex_arena_begin(worker);
    if (transition->successors != NULL) {
        (void)transition->successors(&worker->cx, worker->marking, t, worker->scratch->next, hunt->on_next, hunt);
    } else {
        (void)transition->enumerate(&worker->cx, worker->marking, t, on_binding, hunt);
    }
    ex_arena_end(worker, mark);
    if (hunt->is_second) {
        forget_error(hunt);
    }
    if (worker->cx.error != PN_OK) {
        ex_fail(worker, (int64_t)t);
        return false;
    }
    return !worker->failed && !hunt->is_stopped;
}

/* Whether a transition is tried at all: it is no step of the clock, and nothing before it in its group has been chosen.
 * `chosen` is by group the transition, + 1; 0: none. */
static bool is_tried(const hunt_t *hunt, uint32_t t, const uint32_t *chosen)
{
    const ex_programs_t *const programs = hunt->worker->run->programs;
    if (programs == NULL) {
        return true;
    }
    const uint32_t group = programs->group[t];
    const bool is_same = (chosen[group] == (programs->kin[t] + 1U)) && (programs->choice[group] == EX_FIRST_TRANSITION);
    return !programs->is_clock[t] && ((chosen[group] == 0U) || is_same);
}

/* All of a transition that the program of its owner can do. Whether it is enabled is *is_enabled. */
static bool hunt_choice(hunt_t *hunt, uint32_t t, uint32_t *chosen, bool *is_enabled)
{
    const ex_programs_t *const programs = hunt->worker->run->programs;
    const uint32_t group = (programs != NULL) ? programs->group[t] : 0U;
    const bool was_found = hunt->is_found;
    hunt->is_found = false;
    hunt->is_single = (group != 0U) && (programs->choice[group] == EX_FIRST_BINDING);
    const bool is_probe = (programs != NULL) && programs->is_probe[t];
    hunt->is_probe = is_probe || (hunt->asked != NULL);
    hunt->seeks_choice = hunt->is_single && (hunt->asked == NULL) && is_seeking(hunt->worker->run);
    const bool goes_on = hunt_transition(hunt, t);
    *is_enabled = hunt->is_found;
    hunt->is_found = hunt->is_found && !is_probe;
    hunt->is_single = false;
    hunt->is_probe = false;
    hunt->is_second = false;
    if ((group != 0U) && hunt->is_found && !programs->is_meek[t]) {
        chosen[group] = programs->kin[t] + 1U;
    }
    hunt->is_found = hunt->is_found || was_found;
    return goes_on;
}

/* Whether a transition that is passed over, since one before it in its group has been chosen, is enabled, too. Nothing
 * comes of it but run->has_choice. */
static bool seek_choice(hunt_t *hunt, uint32_t t)
{
    const ex_programs_t *const programs = hunt->worker->run->programs;
    if (!is_seeking(hunt->worker->run) || (programs->choice[programs->group[t]] != EX_FIRST_BINDING)) {
        return true;
    }
    const bool was_found = hunt->is_found;
    const bool was_stopped = hunt->is_stopped;
    hunt->is_second = true;
    const bool goes_on = hunt_transition(hunt, t);
    hunt->is_second = false;
    hunt->is_found = was_found;
    hunt->is_stopped = was_stopped;
    return goes_on;
}

/* The same where priorities count among the transitions of an owner only. */
static bool hunt_by_owner(hunt_t *hunt)
{
    const uint32_t *const owner_of = hunt->worker->run->owner_of;
    const ex_programs_t *const programs = hunt->worker->run->programs;
    int32_t priority[EX_MOST_OWNERS];
    bool has_found[EX_MOST_OWNERS] = { false }; /* one that holds others back */
    bool has_any[EX_MOST_OWNERS] = { false };   /* any: it holds back what is no occurrence, if that is less urgent */
    int32_t last[EX_MOST_OWNERS];
    uint32_t chosen[EX_MOST_GROUPS] = { 0U };
    bool goes_on = true;
    for (uint32_t k = 0U; goes_on && (k < pn_net.order_count); k++) {
        const uint32_t t = pn_net.order[k];
        look_ahead(hunt, k);
        const uint32_t owner = owner_of[t];
        const int32_t own = pn_net.transition[t].priority;
        const bool is_step = (programs != NULL) && programs->is_silent[t];
        bool is_enabled = false;
        if ((hunt->has_turn != NULL) && !hunt->has_turn[owner]) {
            continue;
        }
        if ((has_found[owner] && (own != priority[owner])) || (is_step && has_any[owner] && (own != last[owner]))) {
            continue;
        }
        if (!is_tried(hunt, t, chosen)) {
            goes_on = (hunt->asked != NULL) || seek_choice(hunt, t);
            continue;
        }
        goes_on = hunt_choice(hunt, t, chosen, &is_enabled);
        if (hunt->asked != NULL) {
            hunt->asked[t] = is_enabled ? EX_ENABLED : EX_DISABLED;
        }
        if (is_enabled) {
            has_any[owner] = true;
            last[owner] = own;
        }
        if (is_enabled && ((programs == NULL) || !programs->is_meek[t])) {
            has_found[owner] = true;
            priority[owner] = own;
        }
    }
    return goes_on;
}

/* The transitions of the best priority at which something is enabled now. False when it is to go no further. */
static bool hunt_now(hunt_t *hunt)
{
    int32_t priority = 0;
    uint32_t chosen[EX_MOST_GROUPS] = { 0U };
    if (hunt->worker->run->owner_of != NULL) {
        return hunt_by_owner(hunt);
    }
    for (uint32_t k = 0U; k < pn_net.order_count; k++) {
        const uint32_t t = pn_net.order[k];
        bool is_enabled = false;
        look_ahead(hunt, k);
        if (hunt->is_found && (pn_net.transition[t].priority != priority)) {
            break;
        }
        if (!is_tried(hunt, t, chosen) || ((hunt->is_chosen != NULL) && !hunt->is_chosen[t])) {
            continue;
        }
        priority = pn_net.transition[t].priority;
        if (!hunt_choice(hunt, t, chosen, &is_enabled)) {
            return false;
        }
    }
    return true;
}

/* Which transitions are to be looked at. False when it is to go no further. */
static bool choose_transitions(hunt_t *hunt)
{
    ex_worker_t *const worker = hunt->worker;
    bool *const is_enabled = ex_persistent_enabled(worker);
    int32_t priority = 0;
    bool is_any = false;
    (void)memset(is_enabled, 0, pn_net.transition_count * sizeof *is_enabled);
    for (uint32_t k = 0U; k < pn_net.order_count; k++) {
        const uint32_t t = pn_net.order[k];
        if (is_any && (pn_net.transition[t].priority != priority)) {
            break;
        }
        hunt->is_probe = true;
        hunt->is_found = false;
        const bool goes_on = hunt_transition(hunt, t);
        is_enabled[t] = hunt->is_found;
        is_any = is_any || hunt->is_found;
        priority = pn_net.transition[t].priority;
        hunt->is_probe = false;
        hunt->is_found = false;
        if (!goes_on) {
            return false;
        }
    }
    hunt->is_chosen = ex_persistent_choose(worker, priority);
    return true;
}

/* Which owners are to be looked at. False when it is to go no further. */
static bool choose_owners(hunt_t *hunt)
{
    hunt->asked = ex_turns_asked(hunt->worker);
    for (uint32_t t = 0U; t < pn_net.transition_count; t++) {
        hunt->asked[t] = EX_NOT_ASKED;
    }
    const bool goes_on = hunt_by_owner(hunt);
    hunt->asked = NULL;
    hunt->is_found = false;
    hunt->has_turn = ex_turns_choose(hunt->worker);
    return goes_on;
}

/* When something can be enabled that is not so now; false: never, or an error. */
static bool next_time(const hunt_t *hunt, pn_time_t *next)
{
    ex_worker_t *worker = hunt->worker;
    return hunt->is_local ? ex_next_time(worker, next) : pn_next_time(&pn_net, &worker->cx, worker->marking, next);
}

/* Lets the time go on. */
static bool advance(hunt_t *hunt, pn_time_t next)
{
    ex_worker_t *worker = hunt->worker;
    worker->has_waited = true;
    if (worker->run->options.is_time_reduced) {
        age(worker->marking, next);
        worker->elapsed += next.integer;
        hunt->has_aged = true;
        return true;
    }
    pn_set_now(&pn_net, worker->marking, next);
    return ex_encode_time(worker);
}

/* With a clock that goes on by itself: one unit later, if something is waited for, its steps occur. False: it is to go
 * no further. */
static bool hunt_clock(hunt_t *hunt)
{
    ex_worker_t *worker = hunt->worker;
    const ex_programs_t *const programs = worker->run->programs;
    const pn_time_t unit = { .integer = 1 };
    pn_time_t next = { 0 };
    if (!next_time(hunt, &next)) {
        return worker->cx.error == PN_OK;
    }
    bool goes_on = advance(hunt, unit);
    for (uint32_t k = 0U; goes_on && (k < pn_net.order_count); k++) {
        if (programs->is_clock[pn_net.order[k]]) {
            goes_on = hunt_transition(hunt, pn_net.order[k]);
        }
    }
    worker->has_waited = false; /* it is a step of its own */
    return goes_on;
}

/* The opened state, which is loaded unless `is_local`. */
static ex_found_t hunt_state(hunt_t *hunt)
{
    const ex_programs_t *const programs = hunt->worker->run->programs;
    const bool has_clock = (programs != NULL) && programs->has_clock;
    ex_worker_t *worker = hunt->worker;
    const ex_reduction_t *reduction = worker->run->reduction;
    worker->elapsed = 0;
    worker->has_waited = false;
    if ((reduction != NULL) && reduction->is_stubborn) {
        ex_stubborn_begin(worker);
    }
    bool goes_on = true;
    if ((reduction != NULL) && (reduction->dependency != NULL)) {
        goes_on = choose_transitions(hunt);
    }
    if (worker->run->has_turns) {
        goes_on = choose_owners(hunt);
    }
    goes_on = goes_on && hunt_now(hunt);
    pn_time_t next = { 0 };
    if (goes_on && has_clock) {
        goes_on = hunt_clock(hunt);
    }
    while (goes_on && !hunt->is_found && pn_net.timed && !has_clock && next_time(hunt, &next)) {
        goes_on = advance(hunt, next) && hunt_now(hunt);
    }
    if (goes_on && !hunt->is_found && (worker->cx.error != PN_OK)) {
        ex_fail(worker, -1); /* a delay could not be computed */
        goes_on = false;
    }
    if (hunt->has_aged) {
        ex_unload(worker);
    }
    if (hunt->is_stopped) {
        return EX_STOPPED;
    }
    if (!goes_on || worker->failed) {
        return EX_FAILED;
    }
    if ((reduction != NULL) && reduction->is_stubborn && !ex_stubborn_is_even(worker)) {
        ex_differs(worker, UINT32_MAX, "a binding element of the table of elements does not occur");
        return EX_FAILED;
    }
    return hunt->is_found ? EX_SOME : EX_DEAD;
}

/* Where the packed part of the marking is the key there is no time either. */
static pn_successor_sink_t successor_sink(const ex_run_t *run)
{
    if (run->counts != NULL) {
        return on_counting;
    }
    if (pn_net.root_count > 0U) {
        return on_assigning;
    }
    return (run->codec->is_plain && (run->reduction == NULL)) ? on_plain : on_successor;
}

ex_found_t ex_successors(ex_worker_t *worker, const ex_key_t *key, ex_arc_sink_t sink, void *user)
{
    hunt_t hunt = { .worker = worker, .sink = sink, .user = user, .on_next = successor_sink(worker->run) };
    return ex_load(worker, key) ? hunt_state(&hunt) : EX_FAILED;
}

ex_found_t ex_arcs(ex_worker_t *worker, const ex_key_t *key, ex_times_sink_t sink, void *user)
{
    const bool is_local = worker->local != NULL;
    hunt_t hunt = {
        .worker = worker, .times = sink, .user = user, .on_next = successor_sink(worker->run), .is_local = is_local
    };
    return (is_local ? ex_open(worker, key) : ex_load(worker, key)) ? hunt_state(&hunt) : EX_FAILED;
}

ex_found_t ex_next_markings(struct ex_worker *worker, ex_marking_sink_t sink, void *user)
{
    hunt_t hunt = {
        .worker = worker, .all = sink, .user = user, .on_next = (pn_net.root_count > 0U) ? on_assigning : on_successor
    };
    return hunt_state(&hunt);
}

ex_found_t ex_all_successors(ex_worker_t *worker, ex_marking_sink_t sink, void *user)
{
    hunt_t hunt = {
        .worker = worker, .all = sink, .user = user, .on_next = (pn_net.root_count > 0U) ? on_assigning : on_successor
    };
    const bool goes_on = hunt_now(&hunt);
    if (hunt.is_stopped) {
        return EX_STOPPED;
    }
    if (!goes_on) {
        return EX_FAILED;
    }
    return hunt.is_found ? EX_SOME : EX_DEAD;
}
