/* SPDX-License-Identifier: MIT
 * exercise_situation.c - one transition in one marking, and in markings that differ from it in one thing; what `fire`
 * and `enumerate` promise (pn_net.h) is checked each time:
 *
 *   - a firing that is refused says why, and no place has changed
 *   - one that is accepted has changed only places that the table says it touches, and what it put there is in the
 *     colour set, if all that it read was
 *   - a search that the sink stops calls it no more
 *   - places that the table does not say it reads make no difference
 *   - without a token that a firing takes it is not enabled; an arc that takes what there is (a reset) never needs one
 *   - a firing whose token has no room is refused for that reason, and says in which place
 *   - a binding that the search does not give (one component is changed) does no harm either
 *   - with little memory for strings and lists a firing is refused for that reason, or does the same
 */
#include <string.h>

#include "exercise_impl.h"
#include "pn/pn_arena.h"
#include "pn/pn_num.h"

enum {
    EX_KEPT = 4,        /* bindings of a transition in a marking that are fired */
    EX_ENTRIES = 2,     /* tokens of a place that are replaced */
    EX_FOUND = 1000,    /* bindings that are looked at */
    EX_BYTES = 1 << 12, /* of a binding */
    EX_MEMORY = 1 << 12 /* bytes, of little memory the most */
};

typedef struct search {
    ex_t *ex;
    size_t size;     /* of a binding */
    bool stops;      /* at the first one */
    uint64_t wanted; /* a binding, by its hash */
    bool is_there;   /* it */
    uint32_t count;
    uint32_t kept;
    uint64_t hash; /* of all bindings, in their order */
} search_t;

static uint8_t s_bytes[EX_BYTES];
static max_align_t s_little[EX_MEMORY / sizeof(max_align_t)];

/* --- markings ----------------------------------------------------------------------------------------------------- */

static bool has(const uint32_t *list, uint32_t count, uint32_t wanted)
{
    uint32_t i = 0U;
    while ((i < count) && (list[i] != wanted)) {
        i++;
    }
    return i < count;
}

static bool is_read(const pn_transition_t *t, uint32_t place)
{
    return (t->read == NULL) || has(t->read, t->read_count, place);
}

static bool is_same_entry(const pn_multiset_t *multiset, const void *a, const void *b, uint32_t i, uint32_t k)
{
    const void *first = pn_multiset_entry(multiset, a, i);
    const void *second = pn_multiset_entry(multiset, b, k);
    return pn_same(multiset->type, ex_value_at(multiset, a, i), ex_value_at(multiset, b, k))
           && (pn_time_order(multiset->is_real_time, pn_multiset_stamp_of(multiset, first),
                             pn_multiset_stamp_of(multiset, second))
               == 0);
}

static bool is_same_place(const pn_multiset_t *multiset, const void *a, const void *b)
{
    const uint32_t used = ex_entries(multiset, a);
    bool is_same = used == ex_entries(multiset, b);
    for (uint32_t i = 0U; is_same && (i < used); i++) {
        is_same = is_same_entry(multiset, a, b, i, i)
                  && (pn_multiset_count_of(multiset, pn_multiset_entry(multiset, a, i))
                      == pn_multiset_count_of(multiset, pn_multiset_entry(multiset, b, i)));
    }
    return is_same;
}

/* How many tokens there are as those of an entry of another marking. */
static uint32_t count_like(const pn_multiset_t *multiset, const void *marking, const void *other, uint32_t entry)
{
    for (uint32_t i = 0U; i < ex_entries(multiset, marking); i++) {
        if (is_same_entry(multiset, marking, other, i, entry)) {
            return pn_multiset_count_of(multiset, pn_multiset_entry(multiset, marking, i));
        }
    }
    return 0U;
}

static void copy(void *to, const void *from)
{
    (void)memcpy(to, from, pn_net.marking_size);
}

static void forget_error(ex_t *ex)
{
    pn_clear_error(&ex->cx);
    ex->cx.depth = 0U;
}

static bool is_legal(ex_t *ex, const pn_multiset_t *multiset, const void *marking)
{
    bool is_fine = true;
    for (uint32_t i = 0U; is_fine && (i < ex_entries(multiset, marking)); i++) {
        is_fine = pn_is_legal(&ex->cx, multiset->type, ex_value_at(multiset, marking, i)) && pn_ok(&ex->cx);
    }
    forget_error(ex);
    return is_fine;
}

static bool reads_legal(ex_t *ex, const pn_transition_t *t, const void *marking)
{
    bool is_fine = true;
    for (uint32_t i = 0U; is_fine && (i < ex_read_count(t)); i++) {
        is_fine = is_legal(ex, pn_net.place[ex_read_place(t, i)].multiset, marking);
    }
    return is_fine;
}

/* --- searching ---------------------------------------------------------------------------------------------------- */

static uint64_t hash_of(uint32_t transition, const void *binding)
{
    uint64_t hash = UINT64_C(0xCBF29CE484222325);
    const size_t length = pn_encode(pn_net.transition[transition].binding, binding, s_bytes, EX_BYTES);
    for (size_t i = 0U; (i < length) && (i < (size_t)EX_BYTES); i++) {
        hash = (hash ^ s_bytes[i]) * UINT64_C(0x100000001B3);
    }
    return hash;
}

static bool find(void *user, uint32_t transition, const void *binding)
{
    search_t *search = user;
    const uint64_t hash = hash_of(transition, binding);
    search->is_there = search->is_there || (hash == search->wanted);
    search->hash = (search->hash * UINT64_C(0x100000001B3)) ^ hash;
    search->count++;
    if (search->kept < (uint32_t)EX_KEPT) {
        (void)memcpy(&search->ex->kept[search->kept * search->size], binding, search->size);
        search->kept++;
    }
    return !search->stops && (search->count < (uint32_t)EX_FOUND);
}

static search_t look_for(ex_t *ex, uint32_t transition, const void *marking, uint64_t wanted, bool stops)
{
    const pn_transition_t *t = &pn_net.transition[transition];
    search_t search = { .ex = ex, .size = t->binding->size, .wanted = wanted, .stops = stops };
    const bool is_complete = t->enumerate(&ex->cx, marking, transition, find, &search);
    if (is_complete == ((stops && (search.count > 0U)) || (search.count == (uint32_t)EX_FOUND))) {
        ex_complain(ex, transition, -1, "the search does not say whether it was stopped");
    }
    if (stops && (search.count > 1U)) {
        ex_complain(ex, transition, -1, "the search went on when it was stopped");
    }
    forget_error(ex);
    return search;
}

static search_t look(ex_t *ex, uint32_t transition, const void *marking)
{
    return look_for(ex, transition, marking, 0U, false);
}

/* --- firing ------------------------------------------------------------------------------------------------------- */

static ex_outcome_t outcome_of(pn_error_t error)
{
    static const struct {
        pn_error_t error;
        ex_outcome_t outcome;
    } s_known[] = { { PN_OK, EX_ACCEPTED },
                    { PN_ERR_CAPACITY, EX_NO_ROOM },
                    { PN_ERR_COLOUR, EX_NO_COLOUR },
                    { PN_ERR_SUBTRACT, EX_MISSING },
                    { PN_ERR_MEMORY, EX_NO_MEMORY } };
    ex_outcome_t outcome = EX_RAISED;
    for (size_t i = 0U; i < (sizeof s_known / sizeof s_known[0]); i++) {
        outcome = (s_known[i].error == error) ? s_known[i].outcome : outcome;
    }
    return outcome;
}

static void check_unchanged(ex_t *ex, uint32_t transition, const void *before)
{
    for (uint32_t p = 0U; p < pn_net.place_count; p++) {
        if (!is_same_place(pn_net.place[p].multiset, before, ex->after)) {
            ex_complain(ex, transition, p, "a firing was refused, and has changed it");
        }
    }
}

static void check_changed(ex_t *ex, uint32_t transition, const void *before, bool is_strict)
{
    const pn_transition_t *t = &pn_net.transition[transition];
    for (uint32_t p = 0U; p < pn_net.place_count; p++) {
        const pn_multiset_t *multiset = pn_net.place[p].multiset;
        if (!has(t->touched, t->touched_count, p)) {
            if (!is_same_place(multiset, before, ex->after)) {
                ex_complain(ex, transition, p, "a firing has changed it, which the table does not say");
            }
        } else if (is_strict && !is_legal(ex, multiset, ex->after)) {
            ex_complain(ex, transition, p, "a firing has put there what is not in the colour set");
        }
    }
}

/* Fires a binding in a copy of a marking, which is `after` then. */
static ex_outcome_t fire(ex_t *ex, uint32_t transition, const void *before, const void *binding, bool is_strict)
{
    const pn_transition_t *t = &pn_net.transition[transition];
    copy(ex->after, before);
    (void)memcpy(ex->binding, binding, t->binding->size);
    const bool is_accepted = t->fire(&ex->cx, ex->after, transition, ex->binding);
    const ex_outcome_t outcome = outcome_of(ex->cx.error);
    ex->said = ex->cx.error_origin;
    ex->outcome[outcome]++;
    if (is_accepted != pn_ok(&ex->cx)) {
        ex_complain(ex, transition, -1,
                    is_accepted ? "a firing was accepted, with an error"
                                : "a firing was refused, and does not say why");
    }
    forget_error(ex);
    if (is_accepted) {
        ex->has_fired[transition] = true;
        check_changed(ex, transition, before, is_strict);
    } else {
        check_unchanged(ex, transition, before);
    }
    return outcome;
}

/* Fires what is enabled in the changed marking. */
static void fire_changed(ex_t *ex, uint32_t transition)
{
    const pn_transition_t *t = &pn_net.transition[transition];
    const search_t found = look(ex, transition, ex->changed);
    const bool is_strict = (found.kept > 0U) && reads_legal(ex, t, ex->changed);
    for (uint32_t i = 0U; i < found.kept; i++) {
        (void)fire(ex, transition, ex->changed, &ex->kept[i * t->binding->size], is_strict);
    }
}

/* --- one thing changed -------------------------------------------------------------------------------------------- */

/* Leaves one token less than the firing took. Of tokens with stamps another one may serve, so none is left. */
static void take_away(ex_t *ex, const pn_multiset_t *multiset, uint32_t entry, uint32_t lost)
{
    const void *value = ex_value_at(multiset, ex->situation, entry);
    copy(ex->changed, ex->situation);
    const uint32_t first = pn_multiset_lower_bound(multiset, ex->changed, value);
    while (multiset->is_timed && pn_multiset_is_at(multiset, ex->changed, first, value)) {
        pn_multiset_remove_at(multiset, ex->changed, first,
                              pn_multiset_count_of(multiset, pn_multiset_entry(multiset, ex->changed, first)));
    }
    if (!multiset->is_timed) {
        const uint32_t count = pn_multiset_count_of(multiset, pn_multiset_entry(multiset, ex->changed, entry));
        pn_multiset_remove_at(multiset, ex->changed, entry, count - lost + 1U);
    }
}

/* What a firing took was needed. */
static void check_taken(ex_t *ex, uint32_t transition, const void *binding)
{
    const pn_transition_t *t = &pn_net.transition[transition];
    const uint64_t wanted = hash_of(transition, binding);
    for (uint32_t k = 0U; k < t->touched_count; k++) {
        const pn_multiset_t *multiset = pn_net.place[t->touched[k]].multiset;
        ex_need_t *need = &ex->need[transition][k];
        for (uint32_t i = 0U; i < ex_entries(multiset, ex->situation); i++) {
            const uint32_t before = pn_multiset_count_of(multiset, pn_multiset_entry(multiset, ex->situation, i));
            const uint32_t left = count_like(multiset, ex->result, ex->situation, i);
            if (left >= before) {
                continue;
            }
            take_away(ex, multiset, i, before - left);
            const bool is_enabled = look_for(ex, transition, ex->changed, wanted, false).is_there;
            need->is_needed = need->is_needed || !is_enabled;
            need->is_reset = need->is_reset || is_enabled;
            if (need->is_needed && need->is_reset) {
                ex_complain(ex, transition, t->touched[k], "a token is taken from it that is needed only sometimes");
            }
            ex->taken++;
        }
    }
}

/* The changed marking has no room for what the firing puts into a place. */
static void expect_no_room(ex_t *ex, uint32_t transition, uint32_t place, const void *binding)
{
    const ex_outcome_t outcome = fire(ex, transition, ex->changed, binding, false);
    if (outcome != EX_NO_ROOM) {
        ex_complain(ex, transition, place, "a firing was not refused when it was full");
    } else if (strcmp(ex->said, pn_net.place[place].multiset->origin) != 0) {
        ex_complain(ex, transition, place, "a firing was refused when it was full, and said that another place was");
    }
    ex->filled++;
}

/* As many tokens as can be counted, or as many colours as can be held, other than those that the firing puts. */
static void fill_array(ex_t *ex, uint32_t transition, uint32_t place, uint32_t entry, const void *binding)
{
    const pn_multiset_t *multiset = pn_net.place[place].multiset;
    const pn_time_t stamp = pn_multiset_stamp_of(multiset, pn_multiset_entry(multiset, ex->result, entry));
    const uint32_t before = count_like(multiset, ex->situation, ex->result, entry);
    const void *put = ex_value_at(multiset, ex->result, entry);
    copy(ex->changed, ex->situation);
    if (pn_multiset_add(&ex->cx, multiset, ex->changed, put, UINT32_MAX - before, stamp)) {
        expect_no_room(ex, transition, place, binding);
    }
    copy(ex->changed, ex->situation);
    bool is_full = before > 0U;
    for (uint32_t k = 0U; !is_full && (k < ex_values_count(multiset->type)); k++) {
        void *value = ex_values_room();
        if (ex_values_get(ex, multiset->type, put, k, value) && !pn_same(multiset->type, value, put)) {
            is_full = !pn_multiset_add(&ex->cx, multiset, ex->changed, value, 1U, stamp);
        }
    }
    forget_error(ex);
    if (is_full && (before == 0U)) {
        expect_no_room(ex, transition, place, binding);
    }
}

/* What a firing puts needs room. */
static void check_filled(ex_t *ex, uint32_t transition, const void *binding)
{
    const pn_transition_t *t = &pn_net.transition[transition];
    for (uint32_t k = 0U; k < t->touched_count; k++) {
        const uint32_t place = t->touched[k];
        const pn_multiset_t *multiset = pn_net.place[place].multiset;
        for (uint32_t i = 0U; !is_read(t, place) && (i < ex_entries(multiset, ex->result)); i++) {
            const uint32_t put = pn_multiset_count_of(multiset, pn_multiset_entry(multiset, ex->result, i));
            if (put <= count_like(multiset, ex->situation, ex->result, i)) {
                continue;
            }
            if (multiset->is_slot) {
                copy(ex->changed, ex->situation);
                (void)pn_multiset_add(&ex->cx, multiset, ex->changed, ex_value_at(multiset, ex->result, i), 1U,
                                      PN_NO_TIME);
                expect_no_room(ex, transition, place, binding);
            } else {
                fill_array(ex, transition, place, i, binding);
            }
        }
    }
}

/* With little memory a firing does the same, or says that there is too little. */
static void check_memory(ex_t *ex, uint32_t transition, const void *binding)
{
    const pn_transition_t *t = &pn_net.transition[transition];
    pn_arena_t *const arena = ex->cx.arena;
    pn_arena_t little;
    for (size_t size = EX_MEMORY; size > 0U; size /= 4U) {
        pn_arena_init(&little, s_little, size);
        ex->cx.arena = &little;
        const ex_outcome_t outcome = fire(ex, transition, ex->situation, binding, false);
        ex->cx.arena = arena;
        bool is_same = outcome == EX_ACCEPTED;
        for (uint32_t k = 0U; is_same && (k < t->touched_count); k++) {
            is_same = is_same_place(pn_net.place[t->touched[k]].multiset, ex->result, ex->after);
        }
        if (!is_same && (outcome != EX_NO_MEMORY)) {
            ex_complain(ex, transition, -1, "a firing did something else with little memory");
        }
    }
}

/* Bindings of which one component is another. */
static void check_bindings(ex_t *ex, uint32_t transition, const void *binding)
{
    const pn_type_t *type = pn_net.transition[transition].binding;
    for (uint32_t k = 0U; k < ex_changes_count(type); k++) {
        (void)memcpy(ex->kept, binding, type->size);
        if (ex_change(type, k, ex->kept)) {
            (void)fire(ex, transition, ex->situation, ex->kept, false);
        }
    }
}

/* What is in other places makes no difference. */
static void check_unread(ex_t *ex, uint32_t transition, uint64_t hash)
{
    const pn_transition_t *t = &pn_net.transition[transition];
    if ((t->read == NULL) || t->looks) {
        return;
    }
    copy(ex->changed, ex->situation);
    for (uint32_t p = 0U; p < pn_net.place_count; p++) {
        if (!is_read(t, p)) {
            pn_multiset_clear(pn_net.place[p].multiset, ex->changed);
        }
    }
    if (look(ex, transition, ex->changed).hash != hash) {
        ex_complain(ex, transition, -1, "a place that the table does not say it reads makes a difference");
    }
}

/* Each place that it reads without a token, and with another one. */
static void try_others(ex_t *ex, uint32_t transition)
{
    const pn_transition_t *t = &pn_net.transition[transition];
    for (uint32_t k = 0U; k < ex_read_count(t); k++) {
        const pn_multiset_t *multiset = pn_net.place[ex_read_place(t, k)].multiset;
        const uint32_t used = ex_entries(multiset, ex->situation);
        copy(ex->changed, ex->situation);
        pn_multiset_clear(multiset, ex->changed);
        fire_changed(ex, transition);
        for (uint32_t i = 0U; (i < used) && (i < (uint32_t)EX_ENTRIES); i++) {
            for (uint32_t v = 0U; v < ex_values_count(multiset->type); v++) {
                void *value = ex_values_room();
                const size_t mark = pn_arena_mark(ex->cx.arena);
                const pn_time_t stamp = pn_multiset_stamp_of(multiset, pn_multiset_entry(multiset, ex->situation, i));
                copy(ex->changed, ex->situation);
                pn_multiset_remove_at(multiset, ex->changed, i, 1U);
                if (ex_values_get(ex, multiset->type, ex_value_at(multiset, ex->situation, i), v, value)
                    && pn_multiset_add(&ex->cx, multiset, ex->changed, value, 1U, stamp)) {
                    fire_changed(ex, transition);
                    ex->replaced++;
                }
                forget_error(ex);
                pn_arena_release(ex->cx.arena, mark);
            }
        }
    }
}

/* --- a situation -------------------------------------------------------------------------------------------------- */

void ex_situation_prepare(ex_t *ex)
{
    const size_t size = pn_binding_size(&pn_net);
    ex->situation = ex_reserve(1U, pn_net.marking_size);
    ex->result = ex_reserve(1U, pn_net.marking_size);
    ex->changed = ex_reserve(1U, pn_net.marking_size);
    ex->after = ex_reserve(1U, pn_net.marking_size);
    ex->kept = ex_reserve(EX_KEPT, size);
    ex->tried = ex_reserve(EX_KEPT, size);
    ex->binding = ex_reserve(1U, size);
    ex->has_fired = ex_reserve(pn_net.transition_count, sizeof *ex->has_fired);
    ex->need = ex_reserve(pn_net.transition_count, sizeof *ex->need);
    for (uint32_t i = 0U; i < pn_net.transition_count; i++) {
        ex->need[i] = ex_reserve(pn_net.transition[i].touched_count, sizeof *ex->need[i]);
    }
}

void ex_try(ex_t *ex, uint32_t transition)
{
    const size_t size = pn_net.transition[transition].binding->size;
    const size_t mark = pn_arena_mark(ex->cx.arena);
    const bool is_strict = reads_legal(ex, &pn_net.transition[transition], ex->situation);
    const search_t found = look(ex, transition, ex->situation);
    ex->situations++;
    (void)memcpy(ex->tried, ex->kept, EX_KEPT * size);
    (void)look_for(ex, transition, ex->situation, 0U, true);
    for (uint32_t i = 0U; i < found.kept; i++) {
        const void *binding = &ex->tried[i * size];
        const ex_outcome_t outcome = fire(ex, transition, ex->situation, binding, is_strict);
        if (outcome == EX_MISSING) {
            ex_complain(ex, transition, -1, "a firing misses a token that the search has found");
        }
        if (outcome == EX_ACCEPTED) {
            copy(ex->result, ex->after);
            check_taken(ex, transition, binding);
            check_filled(ex, transition, binding);
            check_memory(ex, transition, binding);
            check_bindings(ex, transition, binding);
        }
    }
    check_unread(ex, transition, found.hash);
    try_others(ex, transition);
    pn_arena_release(ex->cx.arena, mark);
}
