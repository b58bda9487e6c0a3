/* SPDX-License-Identifier: MIT
 * exercise_values.c - colours to try in a place: those that the runs put into places of its colour set, all of a small
 * colour set, and those that differ from one that is there in one component, be they in the colour set or not.
 *
 * What is kept are canonical bytes: a value may refer into the arena, which the runs use again and again.
 */
#include <math.h>
#include <string.h>

#include "exercise_impl.h"
#include "pn/pn_arena.h"
#include "pn/pn_num.h"
#include "pn/pn_random.h"

enum {
    EX_SEEN = 24,       /* colours that are kept of a colour set */
    EX_SMALL = 16,      /* a colour set of so many colours is tried as a whole */
    EX_BYTES = 1 << 12, /* of a colour that is kept */
    EX_CHANGES = 7      /* ways in which a component is changed */
};

/* What is known of a colour set. */
typedef struct pool {
    const pn_type_t *type;
    uint32_t count;
    uint32_t length[EX_SEEN];
    uint8_t *bytes[EX_SEEN];
} pool_t;

static pool_t *s_pool;
static uint32_t s_pools;
static uint8_t *s_bytes;
static void *s_value;

static pool_t *pool_of(const pn_type_t *type)
{
    uint32_t i = 0U;
    while ((i < s_pools) && (s_pool[i].type != type)) {
        i++;
    }
    return (i < s_pools) ? &s_pool[i] : NULL;
}

void ex_values_prepare(void)
{
    size_t most = 1U;
    s_pool = ex_reserve(pn_net.place_count, sizeof *s_pool);
    s_bytes = ex_reserve(EX_BYTES, 1U);
    for (uint32_t i = 0U; i < pn_net.place_count; i++) {
        const pn_type_t *type = pn_net.place[i].multiset->type;
        most = (type->size > most) ? type->size : most;
        if (pool_of(type) == NULL) {
            s_pool[s_pools].type = type;
            s_pools++;
        }
    }
    s_value = ex_reserve(1U, most);
}

void *ex_values_room(void)
{
    return s_value;
}

static void note(pool_t *pool, const void *value)
{
    const size_t length = pn_encode(pool->type, value, s_bytes, EX_BYTES);
    if ((length > (size_t)EX_BYTES) || (pool->count == (uint32_t)EX_SEEN)) {
        return;
    }
    for (uint32_t i = 0U; i < pool->count; i++) {
        if ((pool->length[i] == length) && (memcmp(pool->bytes[i], s_bytes, length) == 0)) {
            return;
        }
    }
    pool->bytes[pool->count] = ex_reserve(length, 1U);
    pool->length[pool->count] = (uint32_t)length;
    (void)memcpy(pool->bytes[pool->count], s_bytes, length);
    pool->count++;
}

void ex_values_note(uint32_t place, const void *marking)
{
    const pn_multiset_t *multiset = pn_net.place[place].multiset;
    pool_t *pool = pool_of(multiset->type);
    for (uint32_t i = 0U; i < ex_entries(multiset, marking); i++) {
        note(pool, ex_value_at(multiset, marking, i));
    }
}

/* --- one component changed ---------------------------------------------------------------------------------------- */

/* Components of a value that can be changed; those in lists and unions cannot. */
static uint32_t components(const pn_type_t *type)
{
    if (type->kind != PN_KIND_RECORD) {
        return 1U;
    }
    uint32_t count = 0U;
    for (uint32_t i = 0U; i < type->count; i++) {
        count += components(type->field[i].type);
    }
    return count;
}

static void change_int(const pn_type_t *type, uint32_t how, int64_t *value)
{
    const int64_t ranged[EX_CHANGES] = { type->low, type->high, type->low - 1, type->high + 1, 0, 1, *value + 1 };
    const int64_t free[EX_CHANGES] = { 0, 1, -1, *value + 1, *value - 1, PN_INT_MAX, PN_INT_MIN };
    *value = type->has_range ? ranged[how] : free[how];
}

static void change_real(const pn_type_t *type, uint32_t how, double *value)
{
    const double changes[EX_CHANGES] = { 0.0,
                                         *value + 1.0,
                                         -*value,
                                         1e300,
                                         (double)NAN,
                                         (double)INFINITY,
                                         type->has_range ? (type->real_high + 1.0) : -1.0 };
    *value = changes[how];
}

/* Changes component `which`, by way `how`; false: not possible. */
static bool change(const pn_type_t *type, uint32_t which, uint32_t how, unsigned char *value)
{
    switch (type->kind) {
    case PN_KIND_RECORD:
        for (uint32_t i = 0U; i < type->count; i++) {
            const uint32_t own = components(type->field[i].type);
            if (which < own) {
                return change(type->field[i].type, which, how, value + type->field[i].offset);
            }
            which -= own;
        }
        return false;
    case PN_KIND_INT: change_int(type, how, (int64_t *)(void *)value); return true;
    case PN_KIND_REAL: change_real(type, how, (double *)(void *)value); return true;
    case PN_KIND_BOOL: *(bool *)value = how == 0U; return how < 2U;
    case PN_KIND_ENUM: *(unsigned int *)(void *)value = how; return how < type->count;
    case PN_KIND_CHAR: *value = (unsigned char)(*value + how); return true;
    case PN_KIND_STRING: ((pn_string_t *)(void *)value)->length = 0U; return how == 0U;
    case PN_KIND_LIST: *(const void **)(void *)value = NULL; return how == 0U;
    case PN_KIND_UNIT:
    case PN_KIND_BIG:
    case PN_KIND_UNION:
    case PN_KIND_REF:
    default: return false;
    }
}

uint32_t ex_changes_count(const pn_type_t *type)
{
    return components(type) * (uint32_t)EX_CHANGES;
}

bool ex_change(const pn_type_t *type, uint32_t k, void *value)
{
    return change(type, k / (uint32_t)EX_CHANGES, k % (uint32_t)EX_CHANGES, value);
}

/* --- all that is tried -------------------------------------------------------------------------------------------- */

static uint32_t small_size(const pn_type_t *type)
{
    const uint64_t size = pn_type_size(type);
    return (size <= (uint64_t)EX_SMALL) ? (uint32_t)size : 0U;
}

uint32_t ex_values_count(const pn_type_t *type)
{
    return pool_of(type)->count + small_size(type) + ex_changes_count(type);
}

static bool get_seen(ex_t *ex, const pool_t *pool, uint32_t k, void *out)
{
    (void)memset(out, 0, pool->type->size);
    return (k < pool->count) && (pn_decode(&ex->cx, pool->type, out, pool->bytes[k], pool->length[k]) != SIZE_MAX);
}

bool ex_values_get(ex_t *ex, const pn_type_t *type, const void *value, uint32_t k, void *out)
{
    const pool_t *pool = pool_of(type);
    const uint32_t small = small_size(type);
    if (k < pool->count) {
        return get_seen(ex, pool, k, out);
    }
    k -= pool->count;
    if (k < small) {
        (void)memset(out, 0, type->size);
        pn_type_value(type, k, out);
        return true;
    }
    k -= small;
    if (value != NULL) {
        (void)memmove(out, value, type->size);
    } else if (!get_seen(ex, pool, (uint32_t)pn_random_pick(&ex->random, (pool->count > 0U) ? pool->count : 1U), out)) {
        return false;
    }
    return ex_change(type, k, out);
}
