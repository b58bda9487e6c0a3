/* SPDX-License-Identifier: MIT */
#include "pn/pn_multiset.h"

#include <string.h>

#include "pn/pn_arena.h"
#include "pn/pn_num.h"
#include "pn/pn_packed.h"
#include "pn/pn_text.h"
#include "pn_multiset_impl.h"
#include "../value/pn_bytes_impl.h"
#include "../value/pn_type_impl.h"

int pn_time_order(bool is_real_time, pn_time_t a, pn_time_t b)
{
    return is_real_time ? pn_real_order(a.real, b.real) : pn_int_order(a.integer, b.integer);
}

/* --- entries ------------------------------------------------------------------------------------------------------ */

uint32_t pn_multiset_used(const pn_multiset_t *multiset, const void *marking)
{
    if (multiset->is_slot) {
        return *(const bool *)part(marking, multiset->used) ? 1U : 0U;
    }
    return load_tag(part(marking, multiset->used));
}

static void set_used(const pn_multiset_t *multiset, void *marking, uint32_t used)
{
    if (multiset->is_slot) {
        *(bool *)part_of(marking, multiset->used) = used > 0U;
        return;
    }
    (void)memcpy(part_of(marking, multiset->used), &used, sizeof used);
}

void pn_multiset_begin(const pn_multiset_t *multiset, void *marking)
{
    if (!PN_IS_PACKED(multiset)) {
        set_used(multiset, marking, 0U);
    }
}

const void *pn_multiset_entry(const pn_multiset_t *multiset, const void *marking, uint32_t i)
{
    return part(marking, multiset->first + (multiset->stride * i));
}

static void *entry_of(const pn_multiset_t *multiset, void *marking, uint32_t i)
{
    return part_of(marking, multiset->first + (multiset->stride * i));
}

uint32_t pn_multiset_count_of(const pn_multiset_t *multiset, const void *entry)
{
    return multiset->is_slot ? 1U : load_tag(part(entry, multiset->count));
}

static void set_count(const pn_multiset_t *multiset, void *entry, uint32_t count)
{
    if (multiset->is_slot) {
        return; /* one */
    }
    (void)memcpy(part_of(entry, multiset->count), &count, sizeof count);
}

pn_time_t pn_multiset_stamp_of(const pn_multiset_t *multiset, const void *entry)
{
    pn_time_t stamp = { 0 };
    if (multiset->is_timed) {
        (void)memcpy(&stamp, part(entry, multiset->stamp), sizeof stamp);
    }
    return stamp;
}

uint32_t pn_multiset_lower_bound(const pn_multiset_t *multiset, const void *marking, const void *value)
{
    uint32_t low = 0U;
    uint32_t high = pn_multiset_used(multiset, marking);
    while (low < high) {
        const uint32_t middle = low + ((high - low) / 2U);
        const void *entry = pn_multiset_entry(multiset, marking, middle);
        if (pn_compare(multiset->type, part(entry, multiset->value), value) < 0) {
            low = middle + 1U;
        } else {
            high = middle;
        }
    }
    return low;
}

bool pn_multiset_is_at(const pn_multiset_t *multiset, const void *marking, uint32_t i, const void *value)
{
    return (i < pn_multiset_used(multiset, marking))
           && pn_same(multiset->type, part(pn_multiset_entry(multiset, marking, i), multiset->value), value);
}

static bool is_after(const pn_multiset_t *multiset, const void *entry, pn_time_t limit)
{
    return multiset->is_timed
           && (pn_time_order(multiset->is_real_time, pn_multiset_stamp_of(multiset, entry), limit) > 0);
}

/* --- packed places: the counters ---------------------------------------------------------------------------------- */

static uint32_t packed_next(const pn_multiset_t *multiset, const void *marking, uint32_t from)
{
    return pn_counter_next(marking, multiset->bit, multiset->colours, multiset->width, from);
}

static uint32_t packed_count(const pn_multiset_t *multiset, const void *marking, uint32_t number)
{
    return pn_counter(marking, multiset->bit, multiset->width, number);
}

static uint64_t packed_total(const pn_multiset_t *multiset, const void *marking)
{
    uint64_t total = 0U;
    for (uint32_t i = packed_next(multiset, marking, 0U); i < multiset->colours;
         i = packed_next(multiset, marking, i + 1U)) {
        total += packed_count(multiset, marking, i);
    }
    return total;
}

static bool packed_add(pn_ctx_t *cx, const pn_multiset_t *multiset, void *marking, const void *value, uint32_t count)
{
    const uint32_t number = multiset->number_of(value);
    if ((number == PN_NO_COLOUR)
        || (count > (pn_counter_most(multiset->width) - packed_count(multiset, marking, number)))) {
        return pn_multiset_fail_full(cx, multiset);
    }
    pn_counter_add(marking, multiset->bit, multiset->width, number, count);
    return true;
}

bool pn_multiset_take_packed(const pn_multiset_t *multiset, void *marking, const void *value, uint32_t count)
{
    const uint32_t number = multiset->number_of(value);
    if ((number == PN_NO_COLOUR) || (packed_count(multiset, marking, number) < count)) {
        return false;
    }
    pn_counter_subtract(marking, multiset->bit, multiset->width, number, count);
    return true;
}

static void packed_clear(const pn_multiset_t *multiset, void *marking)
{
    for (uint32_t i = packed_next(multiset, marking, 0U); i < multiset->colours;
         i = packed_next(multiset, marking, i + 1U)) {
        pn_counter_subtract(marking, multiset->bit, multiset->width, i, packed_count(multiset, marking, i));
    }
}

bool pn_multiset_colour_json(const pn_multiset_t *multiset, uint32_t number, pn_text_t *out)
{
    pn_colour_t colour;
    if (!multiset->is_packed || (number >= multiset->colours)) {
        return false;
    }
    multiset->colour_of(number, &colour);
    pn_json(multiset->type, &colour, out);
    return true;
}

pn_sum_state_t pn_sum_make(pn_ctx_t *cx, const pn_multiset_t *multiset, const pn_type_t *list, const void *values,
                           uint64_t *sum)
{
    const uint32_t start = multiset->bit % 64U;
    (void)memset(sum, 0, PN_SUM_WORDS(multiset->bit, multiset->colours, multiset->width) * sizeof *sum);
    for (const void *rest = values; (rest != NULL) && pn_ok(cx); rest = pn_list_tail(rest)) {
        const void *value = pn_list_head(list, rest);
        const uint32_t number = multiset->number_of(value);
        if ((number == PN_NO_COLOUR)
            || (pn_counter(sum, start, multiset->width, number) == pn_counter_most(multiset->width))
            || !pn_is_legal(cx, multiset->type, value)) {
            return pn_ok(cx) ? PN_SUM_OTHER : PN_SUM_UNKNOWN;
        }
        pn_counter_add(sum, start, multiset->width, number, 1U);
    }
    return pn_ok(cx) ? PN_SUM_KNOWN : PN_SUM_UNKNOWN;
}

/* --- counting ----------------------------------------------------------------------------------------------------- */

uint64_t pn_multiset_total(const pn_multiset_t *multiset, const void *marking)
{
    if (PN_IS_PACKED(multiset)) {
        return packed_total(multiset, marking);
    }
    uint64_t total = 0U;
    for (uint32_t i = 0U; i < pn_multiset_used(multiset, marking); i++) {
        total += pn_multiset_count_of(multiset, pn_multiset_entry(multiset, marking, i));
    }
    return total;
}

uint64_t pn_multiset_available(const pn_multiset_t *multiset, const void *marking, pn_time_t now)
{
    if (PN_IS_PACKED(multiset)) {
        return packed_total(multiset, marking);
    }
    uint64_t total = 0U;
    for (uint32_t i = 0U; i < pn_multiset_used(multiset, marking); i++) {
        const void *entry = pn_multiset_entry(multiset, marking, i);
        total += is_after(multiset, entry, now) ? 0U : pn_multiset_count_of(multiset, entry);
    }
    return total;
}

uint64_t pn_multiset_count(const pn_multiset_t *multiset, const void *marking, const void *value, pn_time_t limit)
{
    if (PN_IS_PACKED(multiset)) {
        const uint32_t number = multiset->number_of(value);
        return (number != PN_NO_COLOUR) ? packed_count(multiset, marking, number) : 0U;
    }
    uint64_t total = 0U;
    for (uint32_t i = pn_multiset_lower_bound(multiset, marking, value); pn_multiset_is_at(multiset, marking, i, value);
         i++) {
        const void *entry = pn_multiset_entry(multiset, marking, i);
        total += is_after(multiset, entry, limit) ? 0U : pn_multiset_count_of(multiset, entry);
    }
    return total;
}

/* --- change ------------------------------------------------------------------------------------------------------- */

bool pn_fail_missing(pn_ctx_t *cx)
{
    pn_raise(cx, PN_ERR_SUBTRACT, NULL);
    return false;
}

bool pn_multiset_fail_full(pn_ctx_t *cx, const pn_multiset_t *multiset)
{
    const char *origin = cx->origin;
    cx->origin = multiset->origin;
    pn_raise(cx, PN_ERR_CAPACITY, NULL);
    cx->origin = origin;
    return false;
}

void pn_multiset_check(pn_ctx_t *cx, const pn_multiset_t *multiset, void *value)
{
    const char *origin = cx->origin;
    cx->origin = multiset->origin;
    if (!pn_is_legal(cx, multiset->type, value)) {
        pn_raise_colour(cx, multiset->type, value);
    }
    pn_narrow(cx, multiset->type, value);
    cx->origin = origin;
}

bool pn_multiset_add(pn_ctx_t *cx, const pn_multiset_t *multiset, void *marking, const void *value, uint32_t count,
                     pn_time_t stamp)
{
    if (PN_IS_PACKED(multiset)) {
        return packed_add(cx, multiset, marking, value, count);
    }
    if (multiset->is_slot && ((count > 1U) || (pn_multiset_used(multiset, marking) > 0U))) {
        return pn_multiset_fail_full(cx, multiset);
    }
    uint32_t i = pn_multiset_lower_bound(multiset, marking, value);
    bool is_there = pn_multiset_is_at(multiset, marking, i, value);
    while (multiset->is_timed && is_there) {
        const int order = pn_time_order(multiset->is_real_time,
                                        pn_multiset_stamp_of(multiset, pn_multiset_entry(multiset, marking, i)), stamp);
        if (order == 0) {
            break;
        }
        is_there = false;
        if (order < 0) {
            i++;
            is_there = pn_multiset_is_at(multiset, marking, i, value);
        }
    }
    if (is_there) {
        void *entry = entry_of(multiset, marking, i);
        const uint32_t before = pn_multiset_count_of(multiset, entry);
        if (count > (UINT32_MAX - before)) {
            return pn_multiset_fail_full(cx, multiset);
        }
        set_count(multiset, entry, before + count);
        return true;
    }
    const uint32_t used = pn_multiset_used(multiset, marking);
    if (used >= multiset->capacity) {
        return pn_multiset_fail_full(cx, multiset);
    }
    void *entry = entry_of(multiset, marking, i);
    (void)memmove(part_of(entry, multiset->stride), entry, (used - i) * multiset->stride);
    (void)memset(entry, 0, multiset->stride);
    (void)memcpy(part_of(entry, multiset->value), value, multiset->type->size);
    set_count(multiset, entry, count);
    if (multiset->is_timed) {
        (void)memcpy(part_of(entry, multiset->stamp), &stamp, sizeof stamp);
    }
    set_used(multiset, marking, used + 1U);
    return true;
}

void pn_multiset_remove_at(const pn_multiset_t *multiset, void *marking, uint32_t i, uint32_t count)
{
    void *entry = entry_of(multiset, marking, i);
    const uint32_t before = pn_multiset_count_of(multiset, entry);
    if (count < before) {
        set_count(multiset, entry, before - count);
        return;
    }
    const uint32_t used = pn_multiset_used(multiset, marking);
    (void)memmove(entry, part(entry, multiset->stride), (used - i - 1U) * multiset->stride);
    (void)memset(entry_of(multiset, marking, used - 1U), 0, multiset->stride);
    set_used(multiset, marking, used - 1U);
}

void pn_multiset_clear(const pn_multiset_t *multiset, void *marking)
{
    if (PN_IS_PACKED(multiset)) {
        packed_clear(multiset, marking);
        return;
    }
    (void)memset(entry_of(multiset, marking, 0U), 0, multiset->stride * pn_multiset_used(multiset, marking));
    set_used(multiset, marking, 0U);
}

void pn_multiset_age(const pn_multiset_t *multiset, void *marking, pn_time_t by)
{
    if (!multiset->is_timed || multiset->is_real_time) {
        return;
    }
    const uint32_t used = pn_multiset_used(multiset, marking);
    uint32_t kept = 0U;
    for (uint32_t i = 0U; i < used; i++) {
        const void *entry = pn_multiset_entry(multiset, marking, i);
        const void *before = (kept > 0U) ? pn_multiset_entry(multiset, marking, kept - 1U) : NULL;
        pn_time_t stamp = pn_multiset_stamp_of(multiset, entry);
        stamp.integer = (stamp.integer > by.integer) ? (stamp.integer - by.integer) : 0;
        const uint32_t count = pn_multiset_count_of(multiset, entry);
        /* Only what is available now can have become the same. */
        if ((before != NULL) && (stamp.integer == 0) && (pn_multiset_stamp_of(multiset, before).integer == 0)
            && pn_same(multiset->type, part(before, multiset->value), part(entry, multiset->value))
            && (count <= (UINT32_MAX - pn_multiset_count_of(multiset, before)))) {
            set_count(multiset, entry_of(multiset, marking, kept - 1U), pn_multiset_count_of(multiset, before) + count);
            continue;
        }
        void *target = entry_of(multiset, marking, kept);
        (void)memmove(target, entry, multiset->stride);
        (void)memcpy(part_of(target, multiset->stamp), &stamp, sizeof stamp);
        kept++;
    }
    (void)memset(entry_of(multiset, marking, kept), 0, multiset->stride * (used - kept));
    set_used(multiset, marking, kept);
}

/* --- seen from outside -------------------------------------------------------------------------------------------- */

static void consider(const pn_multiset_t *multiset, pn_time_t time, pn_time_t now, bool *found, pn_time_t *next)
{
    const bool is_later = pn_time_order(multiset->is_real_time, time, now) > 0;
    if (is_later && (!*found || (pn_time_order(multiset->is_real_time, time, *next) < 0))) {
        *found = true;
        *next = time;
    }
}

/* When a token becomes available to an arc that takes it so much before its stamp. */
static void consider_early(const pn_multiset_t *multiset, pn_time_t stamp, pn_time_t early, pn_time_t now, bool *found,
                           pn_time_t *next)
{
    if (multiset->is_real_time) {
        consider(multiset, (pn_time_t){ .real = stamp.real - early.real }, now, found, next);
        return;
    }
    int64_t time = 0;
    if (!__builtin_sub_overflow(stamp.integer, early.integer, &time)) {
        consider(multiset, (pn_time_t){ .integer = time }, now, found, next);
    }
}

void pn_multiset_threshold(const pn_multiset_t *multiset, const void *marking, pn_time_t now, pn_time_t early,
                           bool *found, pn_time_t *next)
{
    for (uint32_t i = 0U; multiset->is_timed && (i < pn_multiset_used(multiset, marking)); i++) {
        consider_early(multiset, pn_multiset_stamp_of(multiset, pn_multiset_entry(multiset, marking, i)), early, now,
                       found, next);
    }
}

void pn_multiset_next_time(const pn_multiset_t *multiset, const void *marking, pn_time_t now, bool *found,
                           pn_time_t *next)
{
    if (!multiset->is_timed) {
        return;
    }
    for (uint32_t i = 0U; i < pn_multiset_used(multiset, marking); i++) {
        const pn_time_t stamp = pn_multiset_stamp_of(multiset, pn_multiset_entry(multiset, marking, i));
        consider(multiset, stamp, now, found, next);
        for (uint32_t k = 0U; k < multiset->early_count; k++) {
            consider_early(multiset, stamp, multiset->early[k], now, found, next);
        }
    }
}

static void packed_json(const pn_multiset_t *multiset, const void *marking, pn_text_t *out)
{
    pn_text_char(out, '[');
    const char *separator = "[";
    for (uint32_t i = packed_next(multiset, marking, 0U); i < multiset->colours;
         i = packed_next(multiset, marking, i + 1U)) {
        pn_text_str(out, separator);
        pn_text_uint(out, packed_count(multiset, marking, i));
        pn_text_str(out, ", ");
        (void)pn_multiset_colour_json(multiset, i, out);
        pn_text_char(out, ']');
        separator = ", [";
    }
    pn_text_char(out, ']');
}

void pn_multiset_json(const pn_multiset_t *multiset, const void *marking, pn_text_t *out)
{
    if (PN_IS_PACKED(multiset)) {
        packed_json(multiset, marking, out);
        return;
    }
    pn_text_char(out, '[');
    for (uint32_t i = 0U; i < pn_multiset_used(multiset, marking); i++) {
        const void *entry = pn_multiset_entry(multiset, marking, i);
        pn_text_str(out, (i > 0U) ? ", [" : "[");
        pn_text_uint(out, pn_multiset_count_of(multiset, entry));
        pn_text_str(out, ", ");
        pn_json(multiset->type, part(entry, multiset->value), out);
        if (multiset->is_timed) {
            const pn_time_t stamp = pn_multiset_stamp_of(multiset, entry);
            pn_text_str(out, ", ");
            if (multiset->is_real_time) {
                pn_text_json_real(out, stamp.real);
            } else {
                pn_text_int(out, stamp.integer);
            }
        }
        pn_text_char(out, ']');
    }
    pn_text_char(out, ']');
}

uint32_t pn_multiset_token(const pn_multiset_t *multiset, const void *marking, uint32_t i,
                           pn_scalar_value_t *scalar_value, uint32_t capacity)
{
    if (PN_IS_PACKED(multiset)) {
        pn_colour_t colour;
        uint32_t number = packed_next(multiset, marking, 0U);
        for (uint32_t k = 0U; (k < i) && (number < multiset->colours); k++) {
            number = packed_next(multiset, marking, number + 1U);
        }
        if (number >= multiset->colours) {
            return 0U;
        }
        multiset->colour_of(number, &colour);
        return pn_to_scalars(multiset->type, &colour, scalar_value, capacity);
    }
    if (i >= pn_multiset_used(multiset, marking)) {
        return 0U;
    }
    return pn_to_scalars(multiset->type, part(pn_multiset_entry(multiset, marking, i), multiset->value), scalar_value,
                         capacity);
}

/* Whether a token made of these scalars refers to the arena: only its strings and lists do. */
static bool refers(const pn_scalar_value_t *scalar_value, uint32_t scalars)
{
    bool has = false;
    for (uint32_t i = 0U; (i < scalars) && !has; i++) {
        has = (scalar_value[i].kind == PN_VALUE_STRING) || (scalar_value[i].kind == PN_VALUE_LIST);
    }
    return has;
}

bool pn_multiset_put(pn_ctx_t *cx, const pn_multiset_t *multiset, void *marking, const pn_scalar_value_t *scalar_value,
                     uint32_t scalars)
{
    const char *origin = cx->origin;
    const size_t mark = pn_arena_mark(cx->arena);
    pn_colour_t small;
    cx->origin = multiset->origin;
    void *value = (multiset->type->size <= sizeof small) ? &small : pn_arena_alloc(cx, multiset->type->size);
    if ((value != NULL) && pn_from_scalars(cx, multiset->type, value, scalar_value, scalars)) {
        pn_narrow(cx, multiset->type, value);
        if (!pn_is_legal(cx, multiset->type, value)) {
            pn_raise_colour(cx, multiset->type, value);
        }
    }
    const bool is_put = pn_ok(cx) && (value != NULL) && pn_multiset_add(cx, multiset, marking, value, 1U, cx->now);
    if (!is_put || !refers(scalar_value, scalars)) {
        pn_arena_release(cx->arena, mark); /* a refused message may come again and again */
    }
    cx->origin = origin;
    return is_put;
}

/* --- bytes and arena ---------------------------------------------------------------------------------------------- */

/* How many multi-set entries there are, then of each how many tokens, and its value. In a timed place their stamps
 * follow, in the same order, and before all there is the length of what is not stamps (PN_STAMPS_AT): stamps vary more
 * than what they are of. */
static size_t encode_entries(const pn_multiset_t *multiset, const void *marking, uint8_t *out, size_t room, size_t at)
{
    const uint32_t used = pn_multiset_used(multiset, marking);
    at = put_number(out, room, at, used);
    for (uint32_t i = 0U; i < used; i++) {
        const void *entry = pn_multiset_entry(multiset, marking, i);
        at = put_number(out, room, at, pn_multiset_count_of(multiset, entry));
        const size_t left = (at < room) ? (room - at) : 0U;
        at += pn_encode(multiset->type, part(entry, multiset->value), &out[(at < room) ? at : 0U], left);
    }
    return at;
}

/* The same bytes as those of a place that is not packed. */
static size_t packed_encode(const pn_multiset_t *multiset, const void *marking, uint8_t *out, size_t room)
{
    uint32_t used = 0U;
    for (uint32_t i = packed_next(multiset, marking, 0U); i < multiset->colours;
         i = packed_next(multiset, marking, i + 1U)) {
        used++;
    }
    size_t at = put_number(out, room, 0U, used);
    for (uint32_t i = packed_next(multiset, marking, 0U); i < multiset->colours;
         i = packed_next(multiset, marking, i + 1U)) {
        pn_colour_t colour;
        multiset->colour_of(i, &colour);
        at = put_number(out, room, at, packed_count(multiset, marking, i));
        const size_t left = (at < room) ? (room - at) : 0U;
        at += pn_encode(multiset->type, &colour, &out[(at < room) ? at : 0U], left);
    }
    return at;
}

static size_t put_stamp(const pn_multiset_t *multiset, uint8_t *out, size_t room, size_t at, pn_time_t stamp)
{
    return multiset->is_real_time ? put_real(out, room, at, stamp.real) : put_integer(out, room, at, stamp.integer);
}

static bool get_stamp(const pn_multiset_t *multiset, const uint8_t *in, size_t length, size_t *at, pn_time_t *stamp)
{
    return multiset->is_real_time ? get_real(in, length, at, &stamp->real)
                                  : get_integer(in, length, at, &stamp->integer);
}

size_t pn_multiset_encode(const pn_multiset_t *multiset, const void *marking, uint8_t *out, size_t room)
{
    if (PN_IS_PACKED(multiset)) {
        return packed_encode(multiset, marking, out, room);
    }
    if (!multiset->is_timed) {
        return encode_entries(multiset, marking, out, room, 0U);
    }
    size_t at = encode_entries(multiset, marking, out, room, PN_STAMPS_AT);
    const uint32_t first = (uint32_t)at;
    (void)put_bytes(out, room, 0U, &first, sizeof first);
    for (uint32_t i = 0U; i < pn_multiset_used(multiset, marking); i++) {
        at =
            put_stamp(multiset, out, room, at, pn_multiset_stamp_of(multiset, pn_multiset_entry(multiset, marking, i)));
    }
    return at;
}

/* The bytes of a multi-set while they are read: values in one place, stamps in another. */
typedef struct source {
    const uint8_t *in;
    size_t length;
    size_t at;
    size_t stamp_at;
    size_t end;    /* of the values */
    uint64_t used; /* entries */
} source_t;

static bool open_source(source_t *s, const pn_multiset_t *multiset, const uint8_t *in, size_t length)
{
    *s = (source_t){ .in = in, .length = length, .stamp_at = length, .end = length };
    if (multiset->is_timed) {
        uint32_t first = 0U;
        if (length < PN_STAMPS_AT) {
            return false;
        }
        (void)memcpy(&first, in, sizeof first);
        s->at = PN_STAMPS_AT;
        s->end = first;
        s->stamp_at = first;
    }
    return (s->end >= s->at) && (s->end <= length) && get_number(in, s->end, &s->at, &s->used);
}

/* The next entry. */
static bool read_entry(pn_ctx_t *cx, const pn_multiset_t *multiset, source_t *s, void *value, uint32_t *count,
                       pn_time_t *stamp)
{
    uint64_t number = 0U;
    if (!get_number(s->in, s->end, &s->at, &number) || (number > UINT32_MAX)
        || (multiset->is_timed && !get_stamp(multiset, s->in, s->length, &s->stamp_at, stamp))) {
        return false;
    }
    const size_t size = pn_decode(cx, multiset->type, value, &s->in[s->at], s->end - s->at);
    *count = (uint32_t)number;
    s->at += (size == SIZE_MAX) ? 0U : size;
    return size != SIZE_MAX;
}

/* Where the bytes end. */
static size_t source_end(const pn_multiset_t *multiset, const source_t *s)
{
    return !multiset->is_timed ? s->at : ((s->at == s->end) ? s->stamp_at : SIZE_MAX);
}

size_t pn_multiset_decode(pn_ctx_t *cx, const pn_multiset_t *multiset, void *marking, const uint8_t *in, size_t length)
{
    if (PN_IS_PACKED(multiset)) {
        packed_clear(multiset, marking);
        return pn_multiset_add_bytes(cx, multiset, marking, in, length);
    }
    source_t source;
    pn_multiset_clear(multiset, marking);
    if (!open_source(&source, multiset, in, length)) {
        return SIZE_MAX;
    }
    if (source.used > multiset->capacity) {
        (void)pn_multiset_fail_full(cx, multiset);
        return SIZE_MAX;
    }
    for (uint32_t i = 0U; i < source.used; i++) {
        void *entry = entry_of(multiset, marking, i);
        uint32_t count = 0U;
        pn_time_t stamp = { 0 };
        (void)memset(entry, 0, multiset->stride);
        if (!read_entry(cx, multiset, &source, part_of(entry, multiset->value), &count, &stamp)) {
            return SIZE_MAX;
        }
        if (multiset->is_slot && (count != 1U)) {
            (void)pn_multiset_fail_full(cx, multiset);
            return SIZE_MAX;
        }
        set_count(multiset, entry, count);
        if (multiset->is_timed) {
            (void)memcpy(part_of(entry, multiset->stamp), &stamp, sizeof stamp);
        }
        set_used(multiset, marking, i + 1U);
    }
    return source_end(multiset, &source);
}

size_t pn_multiset_add_bytes(pn_ctx_t *cx, const pn_multiset_t *multiset, void *marking, const uint8_t *in,
                             size_t length)
{
    source_t source;
    pn_colour_t small;
    void *value = (multiset->type->size <= sizeof small) ? &small : pn_arena_alloc(cx, multiset->type->size);
    if (!open_source(&source, multiset, in, length) || (value == NULL)) {
        return SIZE_MAX;
    }
    for (uint64_t i = 0U; i < source.used; i++) {
        uint32_t count = 0U;
        pn_time_t stamp = { 0 };
        (void)memset(value, 0, multiset->type->size);
        if (!read_entry(cx, multiset, &source, value, &count, &stamp)
            || !pn_multiset_add(cx, multiset, marking, value, count, stamp)) {
            return SIZE_MAX;
        }
    }
    return source_end(multiset, &source);
}

void pn_multiset_relocate(pn_ctx_t *cx, const pn_multiset_t *multiset, void *marking)
{
    if (PN_IS_PACKED(multiset)) {
        return; /* a colour of few refers to nothing */
    }
    for (uint32_t i = 0U; i < pn_multiset_used(multiset, marking); i++) {
        pn_relocate(cx, multiset->type, part_of(entry_of(multiset, marking, i), multiset->value));
    }
}
