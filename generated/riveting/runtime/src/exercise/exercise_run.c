/* SPDX-License-Identifier: MIT
 * exercise_run.c - where situations come from: random runs of the net, in which each transition that is enabled is
 * tried in the first few different ones; and markings of a single transition, in which only the places that it reads
 * have tokens, whether the net comes to such a marking or not.
 */
#include <string.h>

#include "exercise_impl.h"
#include "pn/pn_arena.h"
#include "pn/pn_num.h"
#include "pn/pn_random.h"

enum {
    EX_OF_RUNS = 12,     /* situations of a transition that are tried, of those that the runs come to */
    EX_COMPOSED = 12,    /* and of those that are put together */
    EX_ATTEMPTS = 400,   /* at putting one together in which the transition is enabled, */
    EX_PATIENCE = 20000, /* and as long as it has never been */
    EX_BYTES = 1 << 14,  /* of the places that a transition reads */
    EX_LARGE = 1 << 16   /* bytes of a marking from which on fewer are tried */
};

/* The situations in which a transition has been tried, by their hashes. */
typedef struct known {
    uint32_t count;
    uint64_t hash[EX_OF_RUNS + EX_COMPOSED];
} known_t;

static known_t *s_known;
static uint8_t *s_bytes;
static uint32_t *s_enabled;
static void *s_chosen;

typedef struct choice {
    uint64_t count;
    uint64_t wanted;
    void *binding;
    size_t size;
} choice_t;

void ex_run_prepare(ex_t *ex)
{
    ex->marking = ex_reserve(1U, pn_net.marking_size);
    s_known = ex_reserve(pn_net.transition_count, sizeof *s_known);
    s_enabled = ex_reserve(pn_net.transition_count, sizeof *s_enabled);
    s_bytes = ex_reserve(EX_BYTES, 1U);
    s_chosen = ex_reserve(1U, pn_binding_size(&pn_net));
}

static uint32_t as_large_allows(uint32_t most)
{
    const size_t share = pn_net.marking_size / (size_t)EX_LARGE;
    return (share >= most) ? 1U : (most / (uint32_t)(share + 1U));
}

/* Tries a transition in `situation` if it is a new one, as far as its places go; at most `most` of them. */
static void try_if_new(ex_t *ex, uint32_t transition, uint32_t most)
{
    const pn_transition_t *t = &pn_net.transition[transition];
    known_t *known = &s_known[transition];
    const bool has_memory = t->assigns || t->search_assigns || t->looks_outside;
    uint64_t hash = UINT64_C(0xCBF29CE484222325);
    if ((known->count >= as_large_allows(most)) || has_memory) {
        return;
    }
    for (uint32_t i = 0U; i < ex_read_count(t); i++) {
        const size_t length =
            pn_multiset_encode(pn_net.place[ex_read_place(t, i)].multiset, ex->situation, s_bytes, EX_BYTES);
        for (size_t k = 0U; (k < length) && (k < (size_t)EX_BYTES); k++) {
            hash = (hash ^ s_bytes[k]) * UINT64_C(0x100000001B3);
        }
    }
    for (uint32_t i = 0U; i < known->count; i++) {
        if (known->hash[i] == hash) {
            return;
        }
    }
    known->hash[known->count] = hash;
    known->count++;
    ex_try(ex, transition);
}

/* --- runs --------------------------------------------------------------------------------------------------------- */

static bool choose(void *user, uint32_t transition, const void *binding)
{
    choice_t *choice = user;
    (void)transition;
    if ((choice->binding != NULL) && (choice->count == choice->wanted)) {
        (void)memcpy(choice->binding, binding, choice->size);
        return false;
    }
    choice->count++;
    return true;
}

static uint64_t bindings_of(ex_t *ex, uint32_t transition)
{
    choice_t choice = { 0 };
    (void)pn_net.transition[transition].enumerate(&ex->cx, ex->marking, transition, choose, &choice);
    return pn_ok(&ex->cx) ? choice.count : 0U;
}

/* The transitions of the best priority that are enabled, and how many they are. */
static uint32_t find_enabled(ex_t *ex)
{
    uint32_t count = 0U;
    for (uint32_t k = 0U; k < pn_net.order_count; k++) {
        const uint32_t i = pn_net.order[k];
        if ((count > 0U) && (pn_net.transition[i].priority != pn_net.transition[s_enabled[0]].priority)) {
            break;
        }
        if (bindings_of(ex, i) > 0U) {
            s_enabled[count] = i;
            count++;
        }
    }
    return count;
}

static uint32_t find_next(ex_t *ex)
{
    uint32_t count = find_enabled(ex);
    pn_time_t next = pn_now(&pn_net, ex->marking);
    while (pn_ok(&ex->cx) && (count == 0U) && pn_net.timed && pn_next_time(&pn_net, &ex->cx, ex->marking, &next)) {
        pn_set_now(&pn_net, ex->marking, next);
        count = find_enabled(ex);
    }
    return pn_ok(&ex->cx) ? count : 0U;
}

/* A random binding of one of these transitions occurs. */
static bool go_on(ex_t *ex, uint32_t enabled)
{
    const uint32_t transition = s_enabled[pn_random_pick(&ex->random, enabled)];
    const pn_transition_t *t = &pn_net.transition[transition];
    const uint64_t wanted = pn_random_pick(&ex->random, bindings_of(ex, transition));
    choice_t choice = { .wanted = wanted, .binding = s_chosen, .size = t->binding->size };
    (void)t->enumerate(&ex->cx, ex->marking, transition, choose, &choice);
    ex->cx.step++;
    if (!pn_ok(&ex->cx) || !t->fire(&ex->cx, ex->marking, transition, s_chosen)) {
        return false;
    }
    ex->has_fired[transition] = true;
    ex->firings++;
    for (uint32_t k = 0U; k < t->touched_count; k++) {
        ex_values_note(t->touched[k], ex->marking);
    }
    if (pn_arena_is_crowded(ex->cx.arena)) {
        pn_marking_collect(&pn_net, &ex->cx, ex->marking);
    }
    return pn_ok(&ex->cx);
}

bool ex_run(ex_t *ex)
{
    ex->cx.seed = pn_random_draw(&ex->random);
    if (!pn_marking_init(&pn_net, &ex->cx, ex->marking)) {
        return false;
    }
    for (uint32_t p = 0U; p < pn_net.place_count; p++) {
        ex_values_note(p, ex->marking);
    }
    for (uint64_t step = 0U; step < ex->options.steps; step++) {
        const uint32_t enabled = find_next(ex);
        for (uint32_t k = 0U; k < enabled; k++) {
            (void)memcpy(ex->situation, ex->marking, pn_net.marking_size);
            try_if_new(ex, s_enabled[k], EX_OF_RUNS);
        }
        if ((enabled == 0U) || !go_on(ex, enabled)) {
            break; /* it has come to its end, or an inscription has raised an error: both may be */
        }
    }
    pn_clear_error(&ex->cx);
    ex->cx.depth = 0U;
    return true;
}

/* --- a transition alone ------------------------------------------------------------------------------------------- */

/* Tokens to try in the places that the transition reads, as many as the last attempt allows. */
static void fill_places(ex_t *ex, const pn_transition_t *t)
{
    for (uint32_t i = 0U; i < pn_net.place_count; i++) {
        pn_multiset_clear(pn_net.place[i].multiset, ex->situation);
    }
    for (uint32_t i = 0U; i < ex_read_count(t); i++) {
        const pn_multiset_t *multiset = pn_net.place[ex_read_place(t, i)].multiset;
        const uint32_t values = ex_values_count(multiset->type);
        void *value = ex_values_room();
        if ((values > 0U) && (pn_random_pick(&ex->random, 8U) > 0U)
            && ex_values_get(ex, multiset->type, NULL, (uint32_t)pn_random_pick(&ex->random, values), value)) {
            (void)pn_multiset_add(&ex->cx, multiset, ex->situation, value, 1U, pn_now(&pn_net, ex->situation));
        }
        pn_clear_error(&ex->cx);
    }
}

void ex_compose(ex_t *ex, uint32_t transition)
{
    const pn_transition_t *t = &pn_net.transition[transition];
    if (!pn_marking_init(&pn_net, &ex->cx, ex->marking)) {
        return;
    }
    const size_t mark = pn_arena_mark(ex->cx.arena);
    const uint32_t patience = as_large_allows(EX_PATIENCE);
    for (uint32_t attempt = 0U;
         (attempt < (uint32_t)EX_ATTEMPTS) || ((attempt < patience) && !ex->has_fired[transition]); attempt++) {
        choice_t choice = { 0 };
        (void)memcpy(ex->situation, ex->marking, pn_net.marking_size);
        fill_places(ex, t);
        (void)t->enumerate(&ex->cx, ex->situation, transition, choose, &choice);
        pn_clear_error(&ex->cx);
        ex->cx.depth = 0U;
        if (choice.count > 0U) {
            try_if_new(ex, transition, EX_OF_RUNS + EX_COMPOSED);
        }
        pn_arena_release(ex->cx.arena, mark);
    }
}
