/* SPDX-License-Identifier: MIT
 * A firing is worked out as a list of moves and then done as a whole, or not at all.
 *
 * Timed places: of several admissible tokens of one value the one with the latest stamp is taken (Jensen's rule), moves
 * with the earliest limit first, so that a move with a later limit never takes what only an earlier one could have
 * used.
 */
#include <string.h>

#include "pn/pn_arena.h"
#include "pn/pn_multiset.h"
#include "pn/pn_num.h"
#include "pn_multiset_impl.h"
#include "../value/pn_type_impl.h"

/* The arena of a net without lists and strings is made for moves of this size (emission/arena_size.py). */
_Static_assert(sizeof(pn_move_t) <= 96U, "a move is larger than what the arena was made for");
_Static_assert(PN_ARENA_ALIGNMENT <= 32U, "values are aligned wider than what the arena was made for");

void pn_moves_init(pn_moves_t *moves, pn_ctx_t *cx)
{
    moves->cx = cx;
    moves->first = NULL;
    moves->last = NULL;
}

static void add(pn_moves_t *moves, pn_move_kind_t kind, const pn_multiset_t *multiset, const void *value,
                uint32_t count, pn_time_t time)
{
    pn_move_t *move = pn_arena_alloc(moves->cx, sizeof *move);
    if (move == NULL) {
        return;
    }
    *move = (pn_move_t){ NULL, kind, multiset, value, count, time, { 0 }, false };
    if (moves->last == NULL) {
        moves->first = move;
    } else {
        moves->last->next = move;
    }
    moves->last = move;
}

uint32_t pn_token_count(pn_ctx_t *cx, int64_t count)
{
    if (count > (int64_t)UINT32_MAX) {
        pn_raise(cx, PN_ERR_CAPACITY, NULL);
        return 0U;
    }
    return (count > 0) ? (uint32_t)count : 0U;
}

/* The caller's value may live in a block that ends before the moves are done. */
static void *copy_of(pn_ctx_t *cx, const pn_multiset_t *multiset, const void *value)
{
    void *copy = pn_arena_alloc(cx, multiset->type->size);
    if (copy != NULL) {
        (void)memcpy(copy, value, multiset->type->size);
    }
    return copy;
}

void pn_moves_take(pn_moves_t *moves, const pn_multiset_t *multiset, const void *value, int64_t count, pn_time_t limit)
{
    const uint32_t n = pn_token_count(moves->cx, count);
    const void *wanted = (n > 0U) ? copy_of(moves->cx, multiset, value) : NULL;
    /* Timed tokens are taken one by one, since they may have different stamps. */
    const uint32_t step = multiset->is_timed ? 1U : n;
    for (uint32_t done = 0U; (done < n) && pn_ok(moves->cx); done += step) {
        add(moves, PN_MOVE_TAKE, multiset, wanted, step, limit);
    }
}

void pn_moves_take_list(pn_moves_t *moves, const pn_multiset_t *multiset, const pn_type_t *list, const void *values,
                        pn_time_t limit)
{
    for (const void *rest = values; (rest != NULL) && pn_ok(moves->cx); rest = pn_list_tail(rest)) {
        add(moves, PN_MOVE_TAKE, multiset, pn_list_head(list, rest), 1U, limit);
    }
}

void pn_moves_put(pn_moves_t *moves, const pn_multiset_t *multiset, const void *value, int64_t count, pn_time_t stamp)
{
    pn_ctx_t *cx = moves->cx;
    const uint32_t n = pn_token_count(cx, count);
    if ((n == 0U) || !pn_ok(cx)) {
        return;
    }
    void *stored = copy_of(cx, multiset, value);
    if (stored == NULL) {
        return;
    }
    pn_multiset_check(cx, multiset, stored);
    add(moves, PN_MOVE_PUT, multiset, stored, n, stamp);
}

void pn_moves_put_list(pn_moves_t *moves, const pn_multiset_t *multiset, const pn_type_t *list, const void *values,
                       pn_time_t stamp)
{
    for (const void *rest = values; (rest != NULL) && pn_ok(moves->cx); rest = pn_list_tail(rest)) {
        pn_moves_put(moves, multiset, pn_list_head(list, rest), 1, stamp);
    }
}

static pn_time_t later(pn_ctx_t *cx, bool is_real_time, pn_time_t time, pn_time_t delay)
{
    pn_time_t sum = { 0 };
    if (is_real_time) {
        sum.real = time.real + delay.real;
    } else {
        sum.integer = pn_time_sum(cx, time.integer, delay.integer);
    }
    return sum;
}

void pn_moves_put_timed(pn_moves_t *moves, const pn_multiset_t *multiset, const pn_type_t *list, const void *values,
                        pn_time_t delay)
{
    const pn_field_t *value = &list->element->field[0];
    const pn_field_t *stamp = &list->element->field[1];
    for (const void *rest = values; (rest != NULL) && pn_ok(moves->cx); rest = pn_list_tail(rest)) {
        const void *token = pn_list_head(list, rest);
        pn_time_t time = { 0 };
        (void)memcpy(&time, part(token, stamp->offset), sizeof time);
        pn_moves_put(moves, multiset, part(token, value->offset), 1,
                     later(moves->cx, multiset->is_real_time, time, delay));
    }
}

void pn_moves_reset(pn_moves_t *moves, const pn_multiset_t *multiset, pn_time_t now)
{
    add(moves, PN_MOVE_RESET, multiset, NULL, 0U, now);
}

/* --- enabling ----------------------------------------------------------------------------------------------------- */

/* Whether two moves want the same value of the same place. */
static bool is_rival(const pn_move_t *a, const pn_move_t *b)
{
    return (b->kind == PN_MOVE_TAKE) && (a->multiset == b->multiset)
           && ((a->value == b->value) || pn_same(a->multiset->type, a->value, b->value));
}

bool pn_moves_are_possible(const pn_moves_t *moves, const void *marking)
{
    if (!pn_ok(moves->cx)) {
        return false;
    }
    /* For each limit: what is wanted up to it must be there up to it. (Hall's condition, as limits are nested.) */
    for (const pn_move_t *move = moves->first; move != NULL; move = move->next) {
        if (move->kind != PN_MOVE_TAKE) {
            continue;
        }
        uint64_t wanted = 0U;
        for (const pn_move_t *other = moves->first; other != NULL; other = other->next) {
            const bool counts = is_rival(move, other)
                                && (!move->multiset->is_timed
                                    || (pn_time_order(move->multiset->is_real_time, other->time, move->time) <= 0));
            wanted += counts ? other->count : 0U;
        }
        if (wanted > pn_multiset_count(move->multiset, marking, move->value, move->time)) {
            return false;
        }
    }
    return true;
}

/* --- doing -------------------------------------------------------------------------------------------------------- */

/* The next move of a kind that is not done: in order; takes from timed places by limit. */
static pn_move_t *next_move(const pn_moves_t *moves, pn_move_kind_t kind)
{
    pn_move_t *best = NULL;
    for (pn_move_t *move = moves->first; move != NULL; move = move->next) {
        if ((move->kind != kind) || move->is_done) {
            continue;
        }
        if (best == NULL) {
            best = move;
        } else if ((kind == PN_MOVE_TAKE) && (move->multiset == best->multiset) && move->multiset->is_timed
                   && (pn_time_order(move->multiset->is_real_time, move->time, best->time) < 0)) {
            best = move;
        }
    }
    return best;
}

static bool take(pn_ctx_t *cx, pn_move_t *move, void *marking)
{
    const pn_multiset_t *multiset = move->multiset;
    if (PN_IS_PACKED(multiset)) {
        const bool is_taken = pn_multiset_take_packed(multiset, marking, move->value, move->count);
        if (!is_taken) {
            pn_raise(cx, PN_ERR_SUBTRACT, NULL);
        }
        return is_taken;
    }
    uint32_t i = pn_multiset_lower_bound(multiset, marking, move->value);
    bool is_there = pn_multiset_is_at(multiset, marking, i, move->value);
    if (multiset->is_timed) {
        is_there = false;
        uint32_t at = i;
        while (pn_multiset_is_at(multiset, marking, at, move->value)) {
            const pn_time_t stamp = pn_multiset_stamp_of(multiset, pn_multiset_entry(multiset, marking, at));
            if (pn_time_order(multiset->is_real_time, stamp, move->time) > 0) {
                break;
            }
            i = at;
            is_there = true;
            at++;
        }
    }
    if (!is_there || (pn_multiset_count_of(multiset, pn_multiset_entry(multiset, marking, i)) < move->count)) {
        pn_raise(cx, PN_ERR_SUBTRACT, NULL);
        return false;
    }
    move->taken = pn_multiset_stamp_of(multiset, pn_multiset_entry(multiset, marking, i));
    pn_multiset_remove_at(multiset, marking, i, move->count);
    return true;
}

static bool do_move(pn_ctx_t *cx, pn_move_t *move, void *marking)
{
    if (move->kind == PN_MOVE_TAKE) {
        return take(cx, move, marking);
    }
    return pn_multiset_add(cx, move->multiset, marking, move->value, move->count, move->time);
}

/* Puts back what was taken: there is room, since it was there before. */
static void undo_move(pn_ctx_t *cx, const pn_move_t *move, void *marking)
{
    const pn_multiset_t *multiset = move->multiset;
    if (move->kind == PN_MOVE_TAKE) {
        (void)pn_multiset_add(cx, multiset, marking, move->value, move->count, move->taken);
        return;
    }
    if (PN_IS_PACKED(multiset)) {
        (void)pn_multiset_take_packed(multiset, marking, move->value, move->count);
        return;
    }
    for (uint32_t i = pn_multiset_lower_bound(multiset, marking, move->value);
         pn_multiset_is_at(multiset, marking, i, move->value); i++) {
        const pn_time_t stamp = pn_multiset_stamp_of(multiset, pn_multiset_entry(multiset, marking, i));
        if (!multiset->is_timed || (pn_time_order(multiset->is_real_time, stamp, move->time) == 0)) {
            pn_multiset_remove_at(multiset, marking, i, move->count);
            return;
        }
    }
}

static void undo(const pn_moves_t *moves, void *marking)
{
    /* Puts first, so that what was taken finds its room again. */
    for (pn_move_t *move = moves->first; move != NULL; move = move->next) {
        if (move->is_done && (move->kind == PN_MOVE_PUT)) {
            undo_move(moves->cx, move, marking);
        }
    }
    for (pn_move_t *move = moves->first; move != NULL; move = move->next) {
        if (move->is_done && (move->kind == PN_MOVE_TAKE)) {
            undo_move(moves->cx, move, marking);
        }
    }
}

static void reset(const pn_move_t *move, void *marking)
{
    const pn_multiset_t *multiset = move->multiset;
    if (!multiset->is_timed) {
        pn_multiset_clear(multiset, marking);
        return;
    }
    for (uint32_t i = pn_multiset_used(multiset, marking); i > 0U; i--) {
        const void *entry = pn_multiset_entry(multiset, marking, i - 1U);
        const bool stays =
            multiset->is_timed
            && (pn_time_order(multiset->is_real_time, pn_multiset_stamp_of(multiset, entry), move->time) > 0);
        if (!stays) {
            pn_multiset_remove_at(multiset, marking, i - 1U, pn_multiset_count_of(multiset, entry));
        }
    }
}

bool pn_moves_commit(pn_moves_t *moves, void *marking)
{
    static const pn_move_kind_t order[] = { PN_MOVE_TAKE, PN_MOVE_PUT };
    for (size_t phase = 0U; (phase < (sizeof order / sizeof order[0])) && pn_ok(moves->cx); phase++) {
        for (pn_move_t *move = next_move(moves, order[phase]); move != NULL; move = next_move(moves, order[phase])) {
            if (!do_move(moves->cx, move, marking)) {
                undo(moves, marking);
                return false;
            }
            move->is_done = true;
        }
    }
    if (!pn_ok(moves->cx)) {
        return false;
    }
    for (pn_move_t *move = next_move(moves, PN_MOVE_RESET); move != NULL; move = next_move(moves, PN_MOVE_RESET)) {
        reset(move, marking);
        move->is_done = true;
    }
    return true;
}
