/* SPDX-License-Identifier: MIT
 * Values as scalars, of which messages and input files are made.
 */
#include "pn/pn_arena.h"
#include "pn/pn_num.h"
#include "pn/pn_type.h"
#include "pn_type_impl.h"

/* --- how many, and on which lines --------------------------------------------------------------------------------- */

/* Whether a value is one scalar. */
static bool is_scalar(const pn_type_t *type)
{
    return (type->kind != PN_KIND_CHAR) && (type->kind != PN_KIND_LIST) && (type->kind != PN_KIND_UNION)
           && (type->kind != PN_KIND_REF) && (type->kind != PN_KIND_RECORD);
}

uint32_t pn_scalar_count(const pn_type_t *type)
{
    uint32_t count = 0U;
    for (uint32_t i = 0U; i < parts_of(type); i++) {
        const pn_type_t *const one = part_at(type, i).type;
        if (is_scalar(one)) {
            count++;
        } else if (one->kind != PN_KIND_RECORD) {
            return 0U;
        } else {
            /* a record that is a subset: its parts have been counted */
        }
    }
    return count;
}

uint32_t pn_message_scalars(const pn_type_t *type)
{
#ifdef PN_FLAT_TYPES
    return pn_scalar_count(type);
#else
    uint32_t count = 0U;
    for (uint32_t i = 0U; i < parts_of(type); i++) {
        const pn_type_t *const one = part_at(type, i).type;
        if (one->kind == PN_KIND_LIST) {
            const uint32_t own = pn_scalar_count(one->element);
            if (own == 0U) {
                return 0U;
            }
            count += 1U + own;
        } else if (is_scalar(one)) {
            count++;
        } else if (one->kind != PN_KIND_RECORD) {
            return 0U;
        } else {
            /* a record that is a subset: its parts have been counted */
        }
    }
    return count;
#endif
}

uint32_t pn_line_count(const pn_type_t *type)
{
    const uint32_t scalars = pn_scalar_count(type);
    if (scalars == 0U) {
        return 0U;
    }
    return ((type->kind == PN_KIND_RECORD) && (scalars != type->count)) ? type->count : 1U;
}

uint32_t pn_line_scalars(const pn_type_t *type, uint32_t line)
{
    return (pn_line_count(type) > 1U) ? pn_scalar_count(type->field[line].type) : pn_scalar_count(type);
}

/* --- there and back ----------------------------------------------------------------------------------------------- */

static bool push_scalar(pn_scalar_value_t *scalar_value, uint32_t capacity, uint32_t *used, pn_scalar_value_t value)
{
    if (*used >= capacity) {
        return false;
    }
    scalar_value[*used] = value;
    (*used)++;
    return true;
}

static bool scalar_of(const pn_type_t *type, const void *value, pn_scalar_value_t *scalar_value, uint32_t capacity,
                      uint32_t *used)
{
    pn_scalar_value_t one = { PN_VALUE_ENUM, 0, 0.0, NULL, 0U };
    switch (type->kind) {
    case PN_KIND_BOOL:
        one.kind = PN_VALUE_BOOL;
        one.integer = load_bool(value) ? 1 : 0;
        return push_scalar(scalar_value, capacity, used, one);
    case PN_KIND_INT:
        one.kind = type->is_index ? PN_VALUE_ENUM : PN_VALUE_INT;
        one.integer = load_int(value);
        return push_scalar(scalar_value, capacity, used, one);
    case PN_KIND_BIG:
        one.kind = PN_VALUE_INT;
        one.integer = load_big(value).small;
        return (load_big(value).large == NULL) && push_scalar(scalar_value, capacity, used, one);
    case PN_KIND_REAL:
        one.kind = PN_VALUE_REAL;
        one.real = load_real(value);
        return push_scalar(scalar_value, capacity, used, one);
    case PN_KIND_STRING:
        one.kind = PN_VALUE_STRING;
        one.text = load_string(value).bytes;
        one.length = load_string(value).length;
        return push_scalar(scalar_value, capacity, used, one);
    case PN_KIND_ENUM:
        one.integer = (int64_t)load_tag(value);
        one.text = type->name_of_value[load_tag(value)];
        return push_scalar(scalar_value, capacity, used, one);
    case PN_KIND_UNIT: return push_scalar(scalar_value, capacity, used, one);
    case PN_KIND_RECORD: return true; /* its parts have been taken */
    case PN_KIND_CHAR:
    case PN_KIND_LIST:
    case PN_KIND_UNION:
    case PN_KIND_REF:
    default: return false;
    }
}

/* A value without lists. */
static bool scalars_of(const pn_type_t *type, const void *value, pn_scalar_value_t *scalar_value, uint32_t capacity,
                       uint32_t *used)
{
    bool is_good = true;
    for (uint32_t i = 0U; is_good && (i < parts_of(type)); i++) {
        const pn_part_t one = part_at(type, i);
        is_good = scalar_of(one.type, part(value, one.offset), scalar_value, capacity, used);
    }
    return is_good;
}

#ifdef PN_FLAT_TYPES
uint32_t pn_to_scalars(const pn_type_t *type, const void *value, pn_scalar_value_t *scalar_value, uint32_t capacity)
{
    uint32_t used = 0U;
    return scalars_of(type, value, scalar_value, capacity, &used) ? used : 0U;
}
#else
/* A list: how long it is, and its elements. */
static bool list_scalars_of(const pn_type_t *type, const void *value, pn_scalar_value_t *scalar_value,
                            uint32_t capacity, uint32_t *used)
{
    const uint32_t at = *used;
    const pn_scalar_value_t length = { PN_VALUE_LIST, 0, 0.0, NULL, 0U };
    bool is_good = push_scalar(scalar_value, capacity, used, length);
    for (const void *rest = load_pointer(value); is_good && (rest != NULL); rest = pn_list_tail(rest)) {
        is_good = scalars_of(type->element, pn_list_head(type, rest), scalar_value, capacity, used);
        scalar_value[at].integer++;
    }
    return is_good;
}

uint32_t pn_to_scalars(const pn_type_t *type, const void *value, pn_scalar_value_t *scalar_value, uint32_t capacity)
{
    uint32_t used = 0U;
    bool is_good = true;
    for (uint32_t i = 0U; is_good && (i < parts_of(type)); i++) {
        const pn_part_t one = part_at(type, i);
        const void *const at = part(value, one.offset);
        is_good = (one.type->kind == PN_KIND_LIST) ? list_scalars_of(one.type, at, scalar_value, capacity, &used)
                                                   : scalars_of(one.type, at, scalar_value, capacity, &used);
    }
    return is_good ? used : 0U;
}
#endif

static bool enum_from_scalar(const pn_type_t *type, const pn_scalar_value_t *scalar_value, void *value)
{
    uint32_t tag = 0U;
    if (scalar_value->text != NULL) {
        while ((tag < type->count) && (strcmp(scalar_value->text, type->name_of_value[tag]) != 0)) {
            tag++;
        }
    } else {
        tag = ((scalar_value->integer >= 0) && (scalar_value->integer < (int64_t)type->count))
                  ? (uint32_t)scalar_value->integer
                  : type->count;
    }
    (void)memcpy(value, &tag, sizeof tag);
    return tag < type->count;
}

static bool part_from(pn_ctx_t *cx, const pn_type_t *type, void *value, const pn_scalar_value_t *scalar_value,
                      uint32_t scalars, uint32_t *used)
{
    if (type->kind == PN_KIND_RECORD) {
        return true; /* its parts are there */
    }
    if (*used >= scalars) {
        return false;
    }
    const pn_scalar_value_t *one = &scalar_value[*used];
    const bool is_integer = one->kind == (type->is_index ? PN_VALUE_ENUM : PN_VALUE_INT);
    (*used)++;
    switch (type->kind) {
    case PN_KIND_BOOL: {
        const bool flag = one->integer != 0;
        (void)memcpy(value, &flag, sizeof flag);
        return one->kind == PN_VALUE_BOOL;
    }
    case PN_KIND_INT: (void)memcpy(value, &one->integer, sizeof one->integer); return is_integer;
    case PN_KIND_BIG: {
        const pn_big_t number = PN_BIG(one->integer);
        (void)memcpy(value, &number, sizeof number);
        return is_integer;
    }
    case PN_KIND_REAL: {
        const double number = (one->kind == PN_VALUE_INT) ? (double)one->integer : one->real;
        (void)memcpy(value, &number, sizeof number);
        return (one->kind == PN_VALUE_REAL) || (one->kind == PN_VALUE_INT);
    }
    case PN_KIND_STRING: {
        if ((one->kind != PN_VALUE_STRING) || (one->text == NULL)) {
            return false;
        }
        const pn_string_t text = pn_string_make(cx, one->text, one->length);
        (void)memcpy(value, &text, sizeof text);
        return true;
    }
    case PN_KIND_ENUM: return (one->kind == PN_VALUE_ENUM) && enum_from_scalar(type, one, value);
    case PN_KIND_UNIT: (void)memset(value, 0, type->size); return one->kind == PN_VALUE_ENUM;
    case PN_KIND_CHAR:
    case PN_KIND_RECORD:
    case PN_KIND_LIST:
    case PN_KIND_UNION:
    case PN_KIND_REF:
    default: return false;
    }
}

#ifndef PN_FLAT_TYPES
static bool list_from(pn_ctx_t *cx, const pn_type_t *type, void *value, const pn_scalar_value_t *scalar_value,
                      uint32_t scalars, uint32_t *used)
{
    if ((*used >= scalars) || (scalar_value[*used].kind != PN_VALUE_LIST)) {
        return false;
    }
    const int64_t length = scalar_value[*used].integer;
    bool is_good = true;
    unsigned char *last = NULL; /* the cell before */
    (*used)++;
    for (int64_t i = 0; is_good && (i < length); i++) {
        unsigned char *const cell = pn_list_new(cx, type, NULL);
        if (cell == NULL) {
            return false;
        }
        store_pointer((last == NULL) ? value : last, cell); /* the tail is the first member of a cell */
        void *const slot = pn_list_slot(type, cell);
        (void)memset(slot, 0, type->element->size);
        for (uint32_t k = 0U; is_good && (k < parts_of(type->element)); k++) {
            const pn_part_t one = part_at(type->element, k);
            is_good = part_from(cx, one.type, part_of(slot, one.offset), scalar_value, scalars, used);
        }
        last = cell;
    }
    return is_good;
}
#endif

bool pn_from_scalars(pn_ctx_t *cx, const pn_type_t *type, void *value, const pn_scalar_value_t *scalar_value,
                     uint32_t scalars)
{
    uint32_t used = 0U;
    bool is_good = true;
    (void)memset(value, 0, type->size);
    for (uint32_t i = 0U; is_good && (i < parts_of(type)); i++) {
        const pn_part_t one = part_at(type, i);
#ifndef PN_FLAT_TYPES
        if (one.type->kind == PN_KIND_LIST) {
            is_good = list_from(cx, one.type, part_of(value, one.offset), scalar_value, scalars, &used);
            continue;
        }
#endif
        is_good = part_from(cx, one.type, part_of(value, one.offset), scalar_value, scalars, &used);
    }
    if (!is_good || (used != scalars)) {
        pn_raise(cx, PN_ERR_COLOUR, NULL);
    }
    return pn_ok(cx);
}
