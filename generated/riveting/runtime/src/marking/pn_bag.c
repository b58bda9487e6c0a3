/* SPDX-License-Identifier: MIT */
#include "pn/pn_bag.h"

#include <string.h>

#include "pn/pn_arena.h"
#include "pn/pn_num.h"
#include "pn/pn_packed.h"
#include "pn/pn_text.h"
#include "pn_bag_impl.h"
#include "../value/pn_bytes_impl.h"
#include "../value/pn_type_impl.h"

int pn_time_order(bool is_real_time, pn_time_t a, pn_time_t b)
{
    return is_real_time ? pn_real_order(a.real, b.real) : pn_int_order(a.integer, b.integer);
}

/* --- entries ------------------------------------------------------------------------------------------------------ */

uint32_t pn_bag_used(const pn_bag_t *bag, const void *marking)
{
    if (bag->is_slot) {
        return *(const bool *)part(marking, bag->used) ? 1U : 0U;
    }
    return load_tag(part(marking, bag->used));
}

static void set_used(const pn_bag_t *bag, void *marking, uint32_t used)
{
    if (bag->is_slot) {
        *(bool *)part_of(marking, bag->used) = used > 0U;
        return;
    }
    (void)memcpy(part_of(marking, bag->used), &used, sizeof used);
}

void pn_bag_begin(const pn_bag_t *bag, void *marking)
{
    if (!PN_IS_PACKED(bag)) {
        set_used(bag, marking, 0U);
    }
}

const void *pn_bag_entry(const pn_bag_t *bag, const void *marking, uint32_t i)
{
    return part(marking, bag->first + (bag->stride * i));
}

static void *entry_of(const pn_bag_t *bag, void *marking, uint32_t i)
{
    return part_of(marking, bag->first + (bag->stride * i));
}

uint32_t pn_bag_count_of(const pn_bag_t *bag, const void *entry)
{
    return bag->is_slot ? 1U : load_tag(part(entry, bag->count));
}

static void set_count(const pn_bag_t *bag, void *entry, uint32_t count)
{
    if (bag->is_slot) {
        return; /* one */
    }
    (void)memcpy(part_of(entry, bag->count), &count, sizeof count);
}

pn_time_t pn_bag_stamp_of(const pn_bag_t *bag, const void *entry)
{
    pn_time_t stamp = { 0 };
    if (bag->is_timed) {
        (void)memcpy(&stamp, part(entry, bag->stamp), sizeof stamp);
    }
    return stamp;
}

uint32_t pn_bag_lower_bound(const pn_bag_t *bag, const void *marking, const void *value)
{
    uint32_t low = 0U;
    uint32_t high = pn_bag_used(bag, marking);
    while (low < high) {
        const uint32_t middle = low + ((high - low) / 2U);
        const void *entry = pn_bag_entry(bag, marking, middle);
        if (pn_compare(bag->type, part(entry, bag->value), value) < 0) {
            low = middle + 1U;
        } else {
            high = middle;
        }
    }
    return low;
}

bool pn_bag_is_at(const pn_bag_t *bag, const void *marking, uint32_t i, const void *value)
{
    return (i < pn_bag_used(bag, marking))
           && pn_same(bag->type, part(pn_bag_entry(bag, marking, i), bag->value), value);
}

static bool is_after(const pn_bag_t *bag, const void *entry, pn_time_t limit)
{
    return bag->is_timed && (pn_time_order(bag->is_real_time, pn_bag_stamp_of(bag, entry), limit) > 0);
}

/* --- packed places: the counters ---------------------------------------------------------------------------------- */

static uint32_t packed_next(const pn_bag_t *bag, const void *marking, uint32_t from)
{
    return pn_counter_next(marking, bag->bit, bag->colours, bag->width, from);
}

static uint32_t packed_count(const pn_bag_t *bag, const void *marking, uint32_t number)
{
    return pn_counter(marking, bag->bit, bag->width, number);
}

static uint64_t packed_total(const pn_bag_t *bag, const void *marking)
{
    uint64_t total = 0U;
    for (uint32_t i = packed_next(bag, marking, 0U); i < bag->colours; i = packed_next(bag, marking, i + 1U)) {
        total += packed_count(bag, marking, i);
    }
    return total;
}

static bool packed_add(pn_ctx_t *cx, const pn_bag_t *bag, void *marking, const void *value, uint32_t count)
{
    const uint32_t number = bag->number_of(value);
    if ((number == PN_NO_COLOUR) || (count > (pn_counter_most(bag->width) - packed_count(bag, marking, number)))) {
        return pn_bag_fail_full(cx, bag);
    }
    pn_counter_add(marking, bag->bit, bag->width, number, count);
    return true;
}

bool pn_bag_take_packed(const pn_bag_t *bag, void *marking, const void *value, uint32_t count)
{
    const uint32_t number = bag->number_of(value);
    if ((number == PN_NO_COLOUR) || (packed_count(bag, marking, number) < count)) {
        return false;
    }
    pn_counter_subtract(marking, bag->bit, bag->width, number, count);
    return true;
}

static void packed_clear(const pn_bag_t *bag, void *marking)
{
    for (uint32_t i = packed_next(bag, marking, 0U); i < bag->colours; i = packed_next(bag, marking, i + 1U)) {
        pn_counter_subtract(marking, bag->bit, bag->width, i, packed_count(bag, marking, i));
    }
}

bool pn_bag_colour_json(const pn_bag_t *bag, uint32_t number, pn_text_t *out)
{
    pn_colour_t colour;
    if (!bag->is_packed || (number >= bag->colours)) {
        return false;
    }
    bag->colour_of(number, &colour);
    pn_json(bag->type, &colour, out);
    return true;
}

pn_sum_state_t pn_sum_make(pn_ctx_t *cx, const pn_bag_t *bag, const pn_type_t *list, const void *multiset,
                           uint64_t *sum)
{
    const uint32_t start = bag->bit % 64U;
    (void)memset(sum, 0, PN_SUM_WORDS(bag->bit, bag->colours, bag->width) * sizeof *sum);
    for (const void *rest = multiset; (rest != NULL) && pn_ok(cx); rest = pn_list_tail(rest)) {
        const void *value = pn_list_head(list, rest);
        const uint32_t number = bag->number_of(value);
        if ((number == PN_NO_COLOUR) || (pn_counter(sum, start, bag->width, number) == pn_counter_most(bag->width))
            || !pn_is_legal(cx, bag->type, value)) {
            return pn_ok(cx) ? PN_SUM_OTHER : PN_SUM_UNKNOWN;
        }
        pn_counter_add(sum, start, bag->width, number, 1U);
    }
    return pn_ok(cx) ? PN_SUM_KNOWN : PN_SUM_UNKNOWN;
}

/* --- counting ----------------------------------------------------------------------------------------------------- */

uint64_t pn_bag_total(const pn_bag_t *bag, const void *marking)
{
    if (PN_IS_PACKED(bag)) {
        return packed_total(bag, marking);
    }
    uint64_t total = 0U;
    for (uint32_t i = 0U; i < pn_bag_used(bag, marking); i++) {
        total += pn_bag_count_of(bag, pn_bag_entry(bag, marking, i));
    }
    return total;
}

uint64_t pn_bag_available(const pn_bag_t *bag, const void *marking, pn_time_t now)
{
    if (PN_IS_PACKED(bag)) {
        return packed_total(bag, marking);
    }
    uint64_t total = 0U;
    for (uint32_t i = 0U; i < pn_bag_used(bag, marking); i++) {
        const void *entry = pn_bag_entry(bag, marking, i);
        total += is_after(bag, entry, now) ? 0U : pn_bag_count_of(bag, entry);
    }
    return total;
}

uint64_t pn_bag_count(const pn_bag_t *bag, const void *marking, const void *value, pn_time_t limit)
{
    if (PN_IS_PACKED(bag)) {
        const uint32_t number = bag->number_of(value);
        return (number != PN_NO_COLOUR) ? packed_count(bag, marking, number) : 0U;
    }
    uint64_t total = 0U;
    for (uint32_t i = pn_bag_lower_bound(bag, marking, value); pn_bag_is_at(bag, marking, i, value); i++) {
        const void *entry = pn_bag_entry(bag, marking, i);
        total += is_after(bag, entry, limit) ? 0U : pn_bag_count_of(bag, entry);
    }
    return total;
}

/* --- change ------------------------------------------------------------------------------------------------------- */

bool pn_fail_missing(pn_ctx_t *cx)
{
    pn_raise(cx, PN_ERR_SUBTRACT, NULL);
    return false;
}

bool pn_bag_fail_full(pn_ctx_t *cx, const pn_bag_t *bag)
{
    const char *origin = cx->origin;
    cx->origin = bag->origin;
    pn_raise(cx, PN_ERR_CAPACITY, NULL);
    cx->origin = origin;
    return false;
}

void pn_bag_check(pn_ctx_t *cx, const pn_bag_t *bag, void *value)
{
    const char *origin = cx->origin;
    cx->origin = bag->origin;
    if (!pn_is_legal(cx, bag->type, value)) {
        pn_raise(cx, PN_ERR_COLOUR, NULL);
    }
    pn_narrow(cx, bag->type, value);
    cx->origin = origin;
}

bool pn_bag_add(pn_ctx_t *cx, const pn_bag_t *bag, void *marking, const void *value, uint32_t count, pn_time_t stamp)
{
    if (PN_IS_PACKED(bag)) {
        return packed_add(cx, bag, marking, value, count);
    }
    if (bag->is_slot && ((count > 1U) || (pn_bag_used(bag, marking) > 0U))) {
        return pn_bag_fail_full(cx, bag);
    }
    uint32_t i = pn_bag_lower_bound(bag, marking, value);
    bool is_there = pn_bag_is_at(bag, marking, i, value);
    while (bag->is_timed && is_there) {
        const int order = pn_time_order(bag->is_real_time, pn_bag_stamp_of(bag, pn_bag_entry(bag, marking, i)), stamp);
        if (order == 0) {
            break;
        }
        is_there = false;
        if (order < 0) {
            i++;
            is_there = pn_bag_is_at(bag, marking, i, value);
        }
    }
    if (is_there) {
        void *entry = entry_of(bag, marking, i);
        const uint32_t before = pn_bag_count_of(bag, entry);
        if (count > (UINT32_MAX - before)) {
            return pn_bag_fail_full(cx, bag);
        }
        set_count(bag, entry, before + count);
        return true;
    }
    const uint32_t used = pn_bag_used(bag, marking);
    if (used >= bag->capacity) {
        return pn_bag_fail_full(cx, bag);
    }
    void *entry = entry_of(bag, marking, i);
    (void)memmove(part_of(entry, bag->stride), entry, (used - i) * bag->stride);
    (void)memset(entry, 0, bag->stride);
    (void)memcpy(part_of(entry, bag->value), value, bag->type->size);
    set_count(bag, entry, count);
    if (bag->is_timed) {
        (void)memcpy(part_of(entry, bag->stamp), &stamp, sizeof stamp);
    }
    set_used(bag, marking, used + 1U);
    return true;
}

void pn_bag_remove_at(const pn_bag_t *bag, void *marking, uint32_t i, uint32_t count)
{
    void *entry = entry_of(bag, marking, i);
    const uint32_t before = pn_bag_count_of(bag, entry);
    if (count < before) {
        set_count(bag, entry, before - count);
        return;
    }
    const uint32_t used = pn_bag_used(bag, marking);
    (void)memmove(entry, part(entry, bag->stride), (used - i - 1U) * bag->stride);
    (void)memset(entry_of(bag, marking, used - 1U), 0, bag->stride);
    set_used(bag, marking, used - 1U);
}

void pn_bag_clear(const pn_bag_t *bag, void *marking)
{
    if (PN_IS_PACKED(bag)) {
        packed_clear(bag, marking);
        return;
    }
    (void)memset(entry_of(bag, marking, 0U), 0, bag->stride * pn_bag_used(bag, marking));
    set_used(bag, marking, 0U);
}

void pn_bag_age(const pn_bag_t *bag, void *marking, pn_time_t by)
{
    if (!bag->is_timed || bag->is_real_time) {
        return;
    }
    const uint32_t used = pn_bag_used(bag, marking);
    uint32_t kept = 0U;
    for (uint32_t i = 0U; i < used; i++) {
        const void *entry = pn_bag_entry(bag, marking, i);
        const void *before = (kept > 0U) ? pn_bag_entry(bag, marking, kept - 1U) : NULL;
        pn_time_t stamp = pn_bag_stamp_of(bag, entry);
        stamp.integer = (stamp.integer > by.integer) ? (stamp.integer - by.integer) : 0;
        const uint32_t count = pn_bag_count_of(bag, entry);
        /* Only what is available now can have become the same. */
        if ((before != NULL) && (stamp.integer == 0) && (pn_bag_stamp_of(bag, before).integer == 0)
            && pn_same(bag->type, part(before, bag->value), part(entry, bag->value))
            && (count <= (UINT32_MAX - pn_bag_count_of(bag, before)))) {
            set_count(bag, entry_of(bag, marking, kept - 1U), pn_bag_count_of(bag, before) + count);
            continue;
        }
        void *target = entry_of(bag, marking, kept);
        (void)memmove(target, entry, bag->stride);
        (void)memcpy(part_of(target, bag->stamp), &stamp, sizeof stamp);
        kept++;
    }
    (void)memset(entry_of(bag, marking, kept), 0, bag->stride * (used - kept));
    set_used(bag, marking, kept);
}

/* --- seen from outside -------------------------------------------------------------------------------------------- */

static void consider(const pn_bag_t *bag, pn_time_t time, pn_time_t now, bool *found, pn_time_t *next)
{
    const bool is_later = pn_time_order(bag->is_real_time, time, now) > 0;
    if (is_later && (!*found || (pn_time_order(bag->is_real_time, time, *next) < 0))) {
        *found = true;
        *next = time;
    }
}

/* When a token becomes available to an arc that takes it so much before its stamp. */
static void consider_early(const pn_bag_t *bag, pn_time_t stamp, pn_time_t early, pn_time_t now, bool *found,
                           pn_time_t *next)
{
    if (bag->is_real_time) {
        consider(bag, (pn_time_t){ .real = stamp.real - early.real }, now, found, next);
        return;
    }
    int64_t time = 0;
    if (!__builtin_sub_overflow(stamp.integer, early.integer, &time)) {
        consider(bag, (pn_time_t){ .integer = time }, now, found, next);
    }
}

void pn_bag_threshold(const pn_bag_t *bag, const void *marking, pn_time_t now, pn_time_t early, bool *found,
                      pn_time_t *next)
{
    for (uint32_t i = 0U; bag->is_timed && (i < pn_bag_used(bag, marking)); i++) {
        consider_early(bag, pn_bag_stamp_of(bag, pn_bag_entry(bag, marking, i)), early, now, found, next);
    }
}

void pn_bag_next_time(const pn_bag_t *bag, const void *marking, pn_time_t now, bool *found, pn_time_t *next)
{
    if (!bag->is_timed) {
        return;
    }
    for (uint32_t i = 0U; i < pn_bag_used(bag, marking); i++) {
        const pn_time_t stamp = pn_bag_stamp_of(bag, pn_bag_entry(bag, marking, i));
        consider(bag, stamp, now, found, next);
        for (uint32_t k = 0U; k < bag->early_count; k++) {
            consider_early(bag, stamp, bag->early[k], now, found, next);
        }
    }
}

static void packed_json(const pn_bag_t *bag, const void *marking, pn_text_t *out)
{
    pn_text_char(out, '[');
    const char *separator = "[";
    for (uint32_t i = packed_next(bag, marking, 0U); i < bag->colours; i = packed_next(bag, marking, i + 1U)) {
        pn_text_str(out, separator);
        pn_text_uint(out, packed_count(bag, marking, i));
        pn_text_str(out, ", ");
        (void)pn_bag_colour_json(bag, i, out);
        pn_text_char(out, ']');
        separator = ", [";
    }
    pn_text_char(out, ']');
}

void pn_bag_json(const pn_bag_t *bag, const void *marking, pn_text_t *out)
{
    if (PN_IS_PACKED(bag)) {
        packed_json(bag, marking, out);
        return;
    }
    pn_text_char(out, '[');
    for (uint32_t i = 0U; i < pn_bag_used(bag, marking); i++) {
        const void *entry = pn_bag_entry(bag, marking, i);
        pn_text_str(out, (i > 0U) ? ", [" : "[");
        pn_text_uint(out, pn_bag_count_of(bag, entry));
        pn_text_str(out, ", ");
        pn_json(bag->type, part(entry, bag->value), out);
        if (bag->is_timed) {
            const pn_time_t stamp = pn_bag_stamp_of(bag, entry);
            pn_text_str(out, ", ");
            if (bag->is_real_time) {
                pn_text_json_real(out, stamp.real);
            } else {
                pn_text_int(out, stamp.integer);
            }
        }
        pn_text_char(out, ']');
    }
    pn_text_char(out, ']');
}

uint32_t pn_bag_token(const pn_bag_t *bag, const void *marking, uint32_t i, pn_leaf_t *leaf, uint32_t capacity)
{
    if (PN_IS_PACKED(bag)) {
        pn_colour_t colour;
        uint32_t number = packed_next(bag, marking, 0U);
        for (uint32_t k = 0U; (k < i) && (number < bag->colours); k++) {
            number = packed_next(bag, marking, number + 1U);
        }
        if (number >= bag->colours) {
            return 0U;
        }
        bag->colour_of(number, &colour);
        return pn_to_leaves(bag->type, &colour, leaf, capacity);
    }
    if (i >= pn_bag_used(bag, marking)) {
        return 0U;
    }
    return pn_to_leaves(bag->type, part(pn_bag_entry(bag, marking, i), bag->value), leaf, capacity);
}

/* Whether a token made of these leaves refers to the arena: only its strings do. */
static bool has_strings(const pn_leaf_t *leaf, uint32_t leaves)
{
    bool has = false;
    for (uint32_t i = 0U; (i < leaves) && !has; i++) {
        has = (leaf[i].kind == PN_LEAF_STRING);
    }
    return has;
}

bool pn_bag_put(pn_ctx_t *cx, const pn_bag_t *bag, void *marking, const pn_leaf_t *leaf, uint32_t leaves)
{
    const char *origin = cx->origin;
    const size_t mark = pn_arena_mark(cx->arena);
    pn_colour_t small;
    cx->origin = bag->origin;
    void *value = (bag->type->size <= sizeof small) ? &small : pn_arena_alloc(cx, bag->type->size);
    if ((value != NULL) && pn_from_leaves(cx, bag->type, value, leaf, leaves)) {
        pn_narrow(cx, bag->type, value);
        if (!pn_is_legal(cx, bag->type, value)) {
            pn_raise(cx, PN_ERR_COLOUR, NULL);
        }
    }
    const bool is_put = pn_ok(cx) && (value != NULL) && pn_bag_add(cx, bag, marking, value, 1U, cx->now);
    if (!is_put || !has_strings(leaf, leaves)) {
        pn_arena_release(cx->arena, mark); /* a refused message may come again and again */
    }
    cx->origin = origin;
    return is_put;
}

/* --- bytes and arena ---------------------------------------------------------------------------------------------- */

/* How many multi-set entries there are, then of each how many tokens, and its value. In a timed place their stamps
 * follow, in the same order, and before all there is the length of what is not stamps (PN_STAMPS_AT): stamps vary more
 * than what they are of. */
static size_t encode_entries(const pn_bag_t *bag, const void *marking, uint8_t *out, size_t room, size_t at)
{
    const uint32_t used = pn_bag_used(bag, marking);
    at = put_number(out, room, at, used);
    for (uint32_t i = 0U; i < used; i++) {
        const void *entry = pn_bag_entry(bag, marking, i);
        at = put_number(out, room, at, pn_bag_count_of(bag, entry));
        const size_t left = (at < room) ? (room - at) : 0U;
        at += pn_encode(bag->type, part(entry, bag->value), &out[(at < room) ? at : 0U], left);
    }
    return at;
}

/* The same bytes as those of a place that is not packed. */
static size_t packed_encode(const pn_bag_t *bag, const void *marking, uint8_t *out, size_t room)
{
    uint32_t used = 0U;
    for (uint32_t i = packed_next(bag, marking, 0U); i < bag->colours; i = packed_next(bag, marking, i + 1U)) {
        used++;
    }
    size_t at = put_number(out, room, 0U, used);
    for (uint32_t i = packed_next(bag, marking, 0U); i < bag->colours; i = packed_next(bag, marking, i + 1U)) {
        pn_colour_t colour;
        bag->colour_of(i, &colour);
        at = put_number(out, room, at, packed_count(bag, marking, i));
        const size_t left = (at < room) ? (room - at) : 0U;
        at += pn_encode(bag->type, &colour, &out[(at < room) ? at : 0U], left);
    }
    return at;
}

static size_t put_stamp(const pn_bag_t *bag, uint8_t *out, size_t room, size_t at, pn_time_t stamp)
{
    return bag->is_real_time ? put_real(out, room, at, stamp.real) : put_integer(out, room, at, stamp.integer);
}

static bool get_stamp(const pn_bag_t *bag, const uint8_t *in, size_t length, size_t *at, pn_time_t *stamp)
{
    return bag->is_real_time ? get_real(in, length, at, &stamp->real) : get_integer(in, length, at, &stamp->integer);
}

size_t pn_bag_encode(const pn_bag_t *bag, const void *marking, uint8_t *out, size_t room)
{
    if (PN_IS_PACKED(bag)) {
        return packed_encode(bag, marking, out, room);
    }
    if (!bag->is_timed) {
        return encode_entries(bag, marking, out, room, 0U);
    }
    size_t at = encode_entries(bag, marking, out, room, PN_STAMPS_AT);
    const uint32_t first = (uint32_t)at;
    (void)put_bytes(out, room, 0U, &first, sizeof first);
    for (uint32_t i = 0U; i < pn_bag_used(bag, marking); i++) {
        at = put_stamp(bag, out, room, at, pn_bag_stamp_of(bag, pn_bag_entry(bag, marking, i)));
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

static bool open_source(source_t *s, const pn_bag_t *bag, const uint8_t *in, size_t length)
{
    *s = (source_t){ .in = in, .length = length, .stamp_at = length, .end = length };
    if (bag->is_timed) {
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
static bool read_entry(pn_ctx_t *cx, const pn_bag_t *bag, source_t *s, void *value, uint32_t *count, pn_time_t *stamp)
{
    uint64_t number = 0U;
    if (!get_number(s->in, s->end, &s->at, &number) || (number > UINT32_MAX)
        || (bag->is_timed && !get_stamp(bag, s->in, s->length, &s->stamp_at, stamp))) {
        return false;
    }
    const size_t size = pn_decode(cx, bag->type, value, &s->in[s->at], s->end - s->at);
    *count = (uint32_t)number;
    s->at += (size == SIZE_MAX) ? 0U : size;
    return size != SIZE_MAX;
}

/* Where the bytes end. */
static size_t source_end(const pn_bag_t *bag, const source_t *s)
{
    return !bag->is_timed ? s->at : ((s->at == s->end) ? s->stamp_at : SIZE_MAX);
}

size_t pn_bag_decode(pn_ctx_t *cx, const pn_bag_t *bag, void *marking, const uint8_t *in, size_t length)
{
    if (PN_IS_PACKED(bag)) {
        packed_clear(bag, marking);
        return pn_bag_add_bytes(cx, bag, marking, in, length);
    }
    source_t source;
    pn_bag_clear(bag, marking);
    if (!open_source(&source, bag, in, length)) {
        return SIZE_MAX;
    }
    if (source.used > bag->capacity) {
        (void)pn_bag_fail_full(cx, bag);
        return SIZE_MAX;
    }
    for (uint32_t i = 0U; i < source.used; i++) {
        void *entry = entry_of(bag, marking, i);
        uint32_t count = 0U;
        pn_time_t stamp = { 0 };
        (void)memset(entry, 0, bag->stride);
        if (!read_entry(cx, bag, &source, part_of(entry, bag->value), &count, &stamp)) {
            return SIZE_MAX;
        }
        if (bag->is_slot && (count != 1U)) {
            (void)pn_bag_fail_full(cx, bag);
            return SIZE_MAX;
        }
        set_count(bag, entry, count);
        if (bag->is_timed) {
            (void)memcpy(part_of(entry, bag->stamp), &stamp, sizeof stamp);
        }
        set_used(bag, marking, i + 1U);
    }
    return source_end(bag, &source);
}

size_t pn_bag_add_bytes(pn_ctx_t *cx, const pn_bag_t *bag, void *marking, const uint8_t *in, size_t length)
{
    source_t source;
    pn_colour_t small;
    void *value = (bag->type->size <= sizeof small) ? &small : pn_arena_alloc(cx, bag->type->size);
    if (!open_source(&source, bag, in, length) || (value == NULL)) {
        return SIZE_MAX;
    }
    for (uint64_t i = 0U; i < source.used; i++) {
        uint32_t count = 0U;
        pn_time_t stamp = { 0 };
        (void)memset(value, 0, bag->type->size);
        if (!read_entry(cx, bag, &source, value, &count, &stamp)
            || !pn_bag_add(cx, bag, marking, value, count, stamp)) {
            return SIZE_MAX;
        }
    }
    return source_end(bag, &source);
}

void pn_bag_relocate(pn_ctx_t *cx, const pn_bag_t *bag, void *marking)
{
    if (PN_IS_PACKED(bag)) {
        return; /* a colour of few refers to nothing */
    }
    for (uint32_t i = 0U; i < pn_bag_used(bag, marking); i++) {
        pn_relocate(cx, bag->type, part_of(entry_of(bag, marking, i), bag->value));
    }
}
