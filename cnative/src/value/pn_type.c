/* SPDX-License-Identifier: MIT */
#include "pn/pn_type.h"

#include <math.h>

#include "pn/pn_arena.h"
#include "pn/pn_num.h"
#include "pn/pn_text.h"
#include "pn_type_impl.h"

/* --- order -------------------------------------------------------------------------------------------------------- */

/* -1, 0, 1 of two reals: what differs between the order of tokens, that of `lt`, and equality. */
typedef int (*reals_t)(double, double);

#ifndef PN_FLAT_TYPES

static int compare(const pn_type_t *type, const void *a, const void *b, reals_t reals);

static int compare_lists(const pn_type_t *type, const void *a, const void *b, reals_t reals)
{
    const void *rest_a = load_pointer(a);
    const void *rest_b = load_pointer(b);
    while ((rest_a != NULL) && (rest_b != NULL)) {
        const int order = compare(type->element, part(rest_a, type->head), part(rest_b, type->head), reals);
        if (order != 0) {
            return order;
        }
        rest_a = pn_list_tail(rest_a);
        rest_b = pn_list_tail(rest_b);
    }
    return (rest_a != NULL) - (rest_b != NULL);
}

static int compare_unions(const pn_type_t *type, const void *a, const void *b, reals_t reals)
{
    const void *argument_a = NULL;
    const void *argument_b = NULL;
    const pn_field_t *constructor_a = constructor_of(type, a, &argument_a);
    const pn_field_t *constructor_b = constructor_of(type, b, &argument_b);
    if (constructor_a != constructor_b) {
        return (constructor_a > constructor_b) ? 1 : -1;
    }
    return (argument_a == NULL) ? 0 : compare(constructor_a->type, argument_a, argument_b, reals);
}

#endif

/* Two values that are no records. */
static int compare_part(const pn_type_t *type, const void *a, const void *b, reals_t reals)
{
    switch (type->kind) {
    case PN_KIND_BOOL: return (int)load_bool(a) - (int)load_bool(b);
    case PN_KIND_INT: return pn_int_order(load_int(a), load_int(b));
    case PN_KIND_BIG: return pn_big_order(load_big(a), load_big(b));
    case PN_KIND_REAL: return reals(load_real(a), load_real(b));
    case PN_KIND_STRING: return pn_string_order(load_string(a), load_string(b));
    case PN_KIND_CHAR: return (int)load_byte(a) - (int)load_byte(b);
    case PN_KIND_ENUM: return pn_int_order((int64_t)load_tag(a), (int64_t)load_tag(b));
#ifndef PN_FLAT_TYPES
    case PN_KIND_LIST: return compare_lists(type, a, b, reals);
    case PN_KIND_UNION: return compare_unions(type, a, b, reals);
#else
    case PN_KIND_LIST:
    case PN_KIND_UNION:
#endif
    case PN_KIND_REF:
        /* Equality is all that matters, but it is an order as well. */
        return (load_pointer(a) == load_pointer(b)) ? 0 : 1;
    case PN_KIND_RECORD: /* a subset: its parts have been compared */
    case PN_KIND_UNIT:
    default: return 0;
    }
}

static int compare_parts(const pn_type_t *type, const void *a, const void *b, reals_t reals)
{
    int order = 0;
    for (uint32_t i = 0U; (order == 0) && (i < parts_of(type)); i++) {
        const pn_part_t one = part_at(type, i);
        order = compare_part(one.type, part(a, one.offset), part(b, one.offset), reals);
    }
    return order;
}

static int compare(const pn_type_t *type, const void *a, const void *b, reals_t reals)
{
    if ((type->kind != PN_KIND_RECORD) || (type->part_count > 0U)) {
        return compare_parts(type, a, b, reals);
    }
    int order = 0;
    for (uint32_t i = 0U; (order == 0) && (i < type->count); i++) { /* a binding: its variables */
        const pn_field_t *const field = &type->field[i];
        order = compare_parts(field->type, part(a, field->offset), part(b, field->offset), reals);
    }
    return order;
}

int pn_compare(const pn_type_t *type, const void *a, const void *b)
{
    return compare(type, a, b, pn_real_order);
}

bool pn_same(const pn_type_t *type, const void *a, const void *b)
{
    return pn_compare(type, a, b) == 0;
}

/* What is no number is neither before nor after any. */
static int real_order_of_lt(double a, double b)
{
    return (a > b) - (a < b);
}

int pn_order(const pn_type_t *type, const void *a, const void *b)
{
    return compare(type, a, b, real_order_of_lt);
}

static int real_differs(double a, double b)
{
    return pn_real_equal(a, b) ? 0 : 1;
}

bool pn_equal(const pn_type_t *type, const void *a, const void *b)
{
    return compare(type, a, b, real_differs) == 0;
}

/* --- text --------------------------------------------------------------------------------------------------------- */

static void json_record(const pn_type_t *type, const void *value, pn_text_t *out)
{
    pn_text_char(out, type->is_tuple ? '[' : '{');
    for (uint32_t i = 0U; i < type->count; i++) {
        const pn_field_t *field = &type->field[i];
        pn_text_str(out, (i > 0U) ? ", " : "");
        if (!type->is_tuple) {
            pn_text_json_str(out, field->label);
            pn_text_str(out, ": ");
        }
        pn_json(field->type, part(value, field->offset), out);
    }
    pn_text_char(out, type->is_tuple ? ']' : '}');
}

static void json_list(const pn_type_t *type, const void *value, pn_text_t *out)
{
    pn_text_char(out, '[');
    const char *separator = "";
    for (const void *rest = load_pointer(value); rest != NULL; rest = pn_list_tail(rest)) {
        pn_text_str(out, separator);
        pn_json(type->element, part(rest, type->head), out);
        separator = ", ";
    }
    pn_text_char(out, ']');
}

static void json_union(const pn_type_t *type, const void *value, pn_text_t *out)
{
    const void *argument = NULL;
    const pn_field_t *constructor = constructor_of(type, value, &argument);
    pn_text_char(out, '[');
    pn_text_json_str(out, constructor->label);
    if (argument != NULL) {
        pn_text_str(out, ", ");
        pn_json(constructor->type, argument, out);
    }
    pn_text_char(out, ']');
}

/* A large number; what has no room is left out. */
static void text_big(pn_big_t value, char minus, pn_text_t *out)
{
    const size_t length = pn_big_decimal(value, minus, &out->buffer[out->length], out->capacity - out->length);
    if (length == SIZE_MAX) {
        out->buffer[out->length] = '\0';
        out->truncated = true;
    } else {
        out->length += length;
    }
}

void pn_json(const pn_type_t *type, const void *value, pn_text_t *out)
{
    switch (type->kind) {
    case PN_KIND_BOOL: pn_text_str(out, load_bool(value) ? "true" : "false"); break;
    case PN_KIND_INT: pn_text_int(out, load_int(value)); break;
    case PN_KIND_BIG: text_big(load_big(value), '-', out); break;
    case PN_KIND_REAL: pn_text_json_real(out, load_real(value)); break;
    case PN_KIND_STRING: {
        const pn_string_t text = load_string(value);
        pn_text_json_string(out, text.bytes, text.length);
        break;
    }
    case PN_KIND_CHAR: {
        const char c = (char)load_byte(value);
        pn_text_json_string(out, &c, 1U);
        break;
    }
    case PN_KIND_ENUM:
        pn_text_str(out, type->is_tuple ? "[" : "");
        pn_text_json_str(out, type->name_of_value[load_tag(value)]);
        pn_text_str(out, type->is_tuple ? "]" : "");
        break;
    case PN_KIND_RECORD: json_record(type, value, out); break;
    case PN_KIND_LIST: json_list(type, value, out); break;
    case PN_KIND_UNION: json_union(type, value, out); break;
    case PN_KIND_REF:
    case PN_KIND_UNIT:
    default: pn_text_str(out, "null"); break;
    }
}

static void mkstr_int(const pn_type_t *type, int64_t value, pn_text_t *out)
{
    char digits[24];
    (void)pn_int_sml(digits, sizeof digits, value);
    const bool has_parentheses = type->is_index || (value < 0);
    pn_text_str(out, type->is_index ? type->name_of_value[0] : "");
    pn_text_str(out, has_parentheses ? "(" : "");
    pn_text_str(out, digits);
    pn_text_str(out, has_parentheses ? ")" : "");
}

static void mkstr_record(const pn_type_t *type, const void *value, pn_text_t *out)
{
    pn_text_char(out, type->is_tuple ? '(' : '{');
    for (uint32_t i = 0U; i < type->count; i++) {
        const pn_field_t *field = &type->field[i];
        pn_text_str(out, (i > 0U) ? "," : "");
        if (!type->is_tuple) {
            pn_text_str(out, field->label);
            pn_text_char(out, '=');
        }
        pn_mkstr(field->type, part(value, field->offset), out);
    }
    pn_text_char(out, type->is_tuple ? ')' : '}');
}

static void mkstr_list(const pn_type_t *type, const void *value, pn_text_t *out)
{
    pn_text_char(out, '[');
    const char *separator = "";
    for (const void *rest = load_pointer(value); rest != NULL; rest = pn_list_tail(rest)) {
        pn_text_str(out, separator);
        pn_mkstr(type->element, part(rest, type->head), out);
        separator = ",";
    }
    pn_text_char(out, ']');
}

static void mkstr_union(const pn_type_t *type, const void *value, pn_text_t *out)
{
    const void *argument = NULL;
    const pn_field_t *constructor = constructor_of(type, value, &argument);
    pn_text_str(out, constructor->label);
    if (argument != NULL) {
        pn_text_char(out, '(');
        pn_mkstr(constructor->type, argument, out);
        pn_text_char(out, ')');
    }
}

void pn_mkstr(const pn_type_t *type, const void *value, pn_text_t *out)
{
    switch (type->kind) {
    case PN_KIND_BOOL:
        if (type->name_of_value != NULL) {
            pn_text_str(out, type->name_of_value[load_bool(value) ? 1 : 0]);
        } else {
            pn_text_str(out, load_bool(value) ? "true" : "false");
        }
        break;
    case PN_KIND_INT: mkstr_int(type, load_int(value), out); break;
    case PN_KIND_BIG: text_big(load_big(value), '~', out); break;
    case PN_KIND_REAL: {
        char digits[40];
        (void)pn_real_sml(digits, sizeof digits, load_real(value));
        pn_text_str(out, digits);
        break;
    }
    case PN_KIND_STRING: {
        const pn_string_t text = load_string(value);
        pn_text_char(out, '"');
        pn_text_bytes(out, text.bytes, text.length);
        pn_text_char(out, '"');
        break;
    }
    case PN_KIND_CHAR:
        pn_text_str(out, "#\"");
        pn_text_char(out, (char)load_byte(value));
        pn_text_char(out, '"');
        break;
    case PN_KIND_ENUM: pn_text_str(out, type->name_of_value[load_tag(value)]); break;
    case PN_KIND_RECORD: mkstr_record(type, value, out); break;
    case PN_KIND_LIST: mkstr_list(type, value, out); break;
    case PN_KIND_UNION: mkstr_union(type, value, out); break;
    case PN_KIND_REF:
    case PN_KIND_UNIT:
    default: pn_text_str(out, (type->name_of_value != NULL) ? type->name_of_value[0] : "()"); break;
    }
}

pn_string_t pn_mkstr_string(pn_ctx_t *cx, const pn_type_t *type, const void *value)
{
    char buffer[4096];
    pn_text_t text;
    pn_text_init(&text, buffer, sizeof buffer);
    pn_mkstr(type, value, &text);
    for (size_t room = 4U * sizeof buffer; text.truncated; room *= 4U) {
        const size_t mark = pn_arena_mark(cx->arena);
        char *bytes = pn_arena_alloc(cx, room);
        if (bytes == NULL) {
            return PN_STRING("");
        }
        pn_text_init(&text, bytes, room);
        pn_mkstr(type, value, &text);
        if (!text.truncated) {
            return (pn_string_t){ bytes, (uint32_t)text.length };
        }
        pn_arena_release(cx->arena, mark);
    }
    return pn_string_make(cx, buffer, text.length);
}

/* --- references and exceptions ------------------------------------------------------------------------------------ */

void *pn_ref_new(pn_ctx_t *cx, const void *value, size_t size)
{
    unsigned char *cell = pn_arena_alloc(cx, PN_REF_HEADER + size);
    if (cell == NULL) {
        return NULL;
    }
    const pn_cell_t header = { NULL, 0U, 0U };
    (void)memcpy(cell, &header, sizeof header);
    if (value == NULL) {
        (void)memset(&cell[PN_REF_HEADER], 0, size);
    } else {
        (void)memcpy(&cell[PN_REF_HEADER], value, size);
    }
    return &cell[PN_REF_HEADER];
}

/* The error that an exception of the runtime has by its name; an exception of the net itself otherwise. */
static pn_error_t error_of(const char *name)
{
    static const pn_error_t known[] = {
        PN_ERR_OVERFLOW,  PN_ERR_DIV,   PN_ERR_MATCH,  PN_ERR_BIND,
        PN_ERR_SUBSCRIPT, PN_ERR_EMPTY, PN_ERR_DOMAIN, PN_ERR_SUBTRACT,
    };
    for (size_t i = 0U; i < (sizeof known / sizeof known[0]); i++) {
        if (strcmp(pn_error_name(known[i]), name) == 0) {
            return known[i];
        }
    }
    return PN_ERR_RAISED;
}

void pn_raise_value(pn_ctx_t *cx, const pn_type_t *type, const void *exception)
{
    if (pn_ok(cx)) {
        const char *name = type->field[load_tag(exception)].label;
        const void *packet = pn_arena_copy(cx, exception, type->size);
        pn_raise(cx, error_of(name), name);
        cx->exception = (cx->error == PN_ERR_MEMORY) ? NULL : packet;
    }
}

pn_string_t pn_exception_name(const pn_type_t *type, const void *exception)
{
    const char *name = type->field[load_tag(exception)].label;
    const pn_string_t text = { name, (uint32_t)strlen(name) };
    return text;
}

/* --- legality ----------------------------------------------------------------------------------------------------- */

static bool is_legal_string(const pn_type_t *type, pn_string_t text)
{
    if (type->has_range && (((int64_t)text.length < type->low) || ((int64_t)text.length > type->high))) {
        return false;
    }
    for (uint32_t i = 0U; type->has_chars && (i < text.length); i++) {
        const uint8_t c = (uint8_t)text.bytes[i];
        if ((c < type->char_low) || (c > type->char_high)) {
            return false;
        }
    }
    return true;
}

#ifndef PN_FLAT_TYPES

static bool is_legal_list(pn_ctx_t *cx, const pn_type_t *type, const void *list)
{
    int64_t length = 0;
    for (const void *rest = list; rest != NULL; rest = pn_list_tail(rest)) {
        if (!pn_is_legal(cx, type->element, part(rest, type->head))) {
            return false;
        }
        length++;
    }
    return !type->has_range || ((length >= type->low) && (length <= type->high));
}

static bool is_legal_union(pn_ctx_t *cx, const pn_type_t *type, const void *value)
{
    const void *argument = NULL;
    const pn_field_t *constructor = constructor_of(type, value, &argument);
    return (argument == NULL) || pn_is_legal(cx, constructor->type, argument);
}

#endif

static bool is_legal_part(pn_ctx_t *cx, const pn_type_t *type, const void *value)
{
    (void)cx; /* only lists and unions look at it */
    switch (type->kind) {
    case PN_KIND_INT: {
        const int64_t number = load_int(value);
        return !type->has_range || ((number >= type->low) && (number <= type->high));
    }
    case PN_KIND_BIG: {
        const pn_big_t number = load_big(value);
        return !type->has_range
               || ((pn_big_order(number, type->big_low) >= 0) && (pn_big_order(number, type->big_high) <= 0));
    }
    case PN_KIND_REAL: {
        const double number = load_real(value);
        const bool is_in_range = !type->has_range || ((number >= type->real_low) && (number <= type->real_high));
        return is_in_range && (!type->is_float32 || isfinite(number));
    }
    case PN_KIND_STRING: return is_legal_string(type, load_string(value));
    case PN_KIND_ENUM: return load_tag(value) < type->count;
#ifndef PN_FLAT_TYPES
    case PN_KIND_LIST: return is_legal_list(cx, type, load_pointer(value));
    case PN_KIND_UNION: return is_legal_union(cx, type, value);
#else
    case PN_KIND_LIST:
    case PN_KIND_UNION:
#endif
    case PN_KIND_RECORD: /* its parts come before it */
    case PN_KIND_UNIT:
    case PN_KIND_BOOL:
    case PN_KIND_CHAR:
    case PN_KIND_REF:
    default: return true;
    }
}

bool pn_is_legal(pn_ctx_t *cx, const pn_type_t *type, const void *value)
{
    for (uint32_t i = 0U; i < parts_of(type); i++) {
        const pn_part_t one = part_at(type, i);
        const void *const at = part(value, one.offset);
        if (!is_legal_part(cx, one.type, at) || ((one.type->member != NULL) && !one.type->member(cx, at))) {
            return false;
        }
    }
    return (type->kind != PN_KIND_RECORD) || (type->member == NULL) || type->member(cx, value);
}

#ifndef PN_FLAT_TYPES
/* Appends at most so many bytes of a text on one line; three dots stand for the rest. */
static void say_shortly(pn_text_t *out, const char *bytes, size_t length, size_t most)
{
    static const char dots[] = "...";
    size_t said = length;
    if (length > most) {
        said = most - (sizeof dots - 1U);
        while ((said > 0U) && ((((unsigned char)bytes[said]) & 0xC0U) == 0x80U)) {
            said--; /* a character of UTF-8 is not cut in two */
        }
    }
    for (size_t i = 0U; i < said; i++) {
        pn_text_char(out, (((unsigned char)bytes[i]) < 0x20U) ? '?' : bytes[i]);
    }
    pn_text_str(out, (length > most) ? dots : "");
}
#endif

void pn_raise_colour(pn_ctx_t *cx, const pn_type_t *type, const void *value)
{
    if (pn_ok(cx)) {
        pn_text_t said;
        pn_text_init(&said, cx->said, sizeof cx->said);
        pn_text_str(&said, "illegal colour");
#ifdef PN_FLAT_TYPES /* the text of a record takes recursion, which a supervisor without nested values does not have */
        if (type->kind == PN_KIND_INT) {
            pn_text_char(&said, ' ');
            mkstr_int(type, load_int(value), &said);
        }
        pn_text_str(&said, ": it is not in the colour set `");
        pn_text_str(&said, type->name);
#else
        char buffer[PN_SAID_SIZE];
        pn_text_t colour;
        pn_text_init(&colour, buffer, sizeof buffer);
        pn_mkstr(type, value, &colour);
        pn_text_char(&said, ' ');
        say_shortly(&said, colour.buffer, colour.length, PN_SAID_SIZE / 2U);
        pn_text_str(&said, ": it is not in the colour set `");
        say_shortly(&said, type->name, strlen(type->name), PN_SAID_SIZE / 4U);
#endif
        pn_text_str(&said, "`");
        pn_raise(cx, PN_ERR_COLOUR, cx->said);
    }
}

#ifndef PN_FLAT_TYPES

static void narrow_list(pn_ctx_t *cx, const pn_type_t *type, void *value)
{
    const void *list = pn_list_append(cx, type, load_pointer(value), NULL);
    store_pointer(value, list);
    /* The cells are fresh copies: nobody else sees the change. */
    for (const void *rest = list; rest != NULL; rest = pn_list_tail(rest)) {
        const size_t offset = (size_t)((const unsigned char *)rest - cx->arena->memory);
        pn_narrow(cx, type->element, &cx->arena->memory[offset + type->head]);
    }
}

static void narrow_union(pn_ctx_t *cx, const pn_type_t *type, void *value)
{
    const pn_field_t *constructor = &type->field[load_tag(value)];
    if ((constructor->type != NULL) && !constructor->is_boxed) {
        pn_narrow(cx, constructor->type, part_of(value, constructor->offset));
    }
}

#endif

static void narrow_part(pn_ctx_t *cx, const pn_type_t *type, void *value)
{
    if (!type->is_narrow) {
        return;
    }
    if (type->kind == PN_KIND_REAL) {
        const double rounded = (double)(float)load_real(value);
        if (!isfinite(rounded)) {
            pn_raise(cx, PN_ERR_COLOUR, NULL);
        }
        (void)memcpy(value, &rounded, sizeof rounded);
#ifndef PN_FLAT_TYPES
    } else if (type->kind == PN_KIND_LIST) {
        narrow_list(cx, type, value);
    } else if (type->kind == PN_KIND_UNION) {
        narrow_union(cx, type, value);
#endif
    } else {
        /* a record: its parts have been narrowed */
    }
}

void pn_narrow(pn_ctx_t *cx, const pn_type_t *type, void *value)
{
    if (type->is_narrow) {
        for (uint32_t i = 0U; i < parts_of(type); i++) {
            const pn_part_t one = part_at(type, i);
            narrow_part(cx, one.type, part_of(value, one.offset));
        }
    }
}

/* --- small colour sets -------------------------------------------------------------------------------------------- */

static uint64_t limited(uint64_t size)
{
    return (size > (UINT64_C(1) << 32U)) ? 0U : size;
}

/* The number of integers from low to high. */
static uint64_t size_of_range(int64_t low, int64_t high)
{
    const uint64_t difference = (uint64_t)high - (uint64_t)low;
    return ((high < low) || (difference == UINT64_MAX)) ? 0U : limited(difference + 1U);
}

uint64_t pn_type_size(const pn_type_t *type)
{
    switch (type->kind) {
    case PN_KIND_UNIT: return 1U;
    case PN_KIND_BOOL: return 2U;
    case PN_KIND_CHAR: return 256U;
    case PN_KIND_INT: return type->has_range ? size_of_range(type->low, type->high) : 0U;
    case PN_KIND_BIG:
        if (!type->has_range || (type->big_low.large != NULL) || (type->big_high.large != NULL)) {
            return 0U;
        }
        return size_of_range(type->big_low.small, type->big_high.small);
    case PN_KIND_ENUM: return type->count;
    case PN_KIND_RECORD: {
        uint64_t size = 1U;
        for (uint32_t i = 0U; (i < type->count) && (size > 0U); i++) {
            size = limited(size * pn_type_size(type->field[i].type));
        }
        return size;
    }
    case PN_KIND_UNION: {
        uint64_t size = 0U;
        for (uint32_t i = 0U; i < type->count; i++) {
            const pn_type_t *argument = type->field[i].type;
            if (type->field[i].is_boxed) {
                return 0U;
            }
            const uint64_t values = (argument == NULL) ? 1U : pn_type_size(argument);
            if (values == 0U) {
                return 0U;
            }
            size += values;
        }
        return limited(size);
    }
    case PN_KIND_REAL:
    case PN_KIND_STRING:
    case PN_KIND_LIST:
    case PN_KIND_REF:
    default: return 0U;
    }
}

void pn_type_value(const pn_type_t *type, uint64_t i, void *value)
{
    (void)memset(value, 0, type->size);
    if (type->kind == PN_KIND_BOOL) {
        const bool flag = i != 0U;
        (void)memcpy(value, &flag, sizeof flag);
    } else if (type->kind == PN_KIND_CHAR) {
        const uint8_t c = (uint8_t)i;
        (void)memcpy(value, &c, sizeof c);
    } else if (type->kind == PN_KIND_INT) {
        const int64_t number = type->low + (int64_t)i;
        (void)memcpy(value, &number, sizeof number);
    } else if (type->kind == PN_KIND_BIG) {
        const pn_big_t number = PN_BIG(type->big_low.small + (int64_t)i);
        (void)memcpy(value, &number, sizeof number);
    } else if (type->kind == PN_KIND_ENUM) {
        const uint32_t tag = (uint32_t)i;
        (void)memcpy(value, &tag, sizeof tag);
    } else if (type->kind == PN_KIND_RECORD) {
        uint64_t rest = i;
        for (uint32_t k = type->count; k > 0U; k--) {
            const pn_field_t *field = &type->field[k - 1U];
            const uint64_t size = pn_type_size(field->type);
            pn_type_value(field->type, rest % size, part_of(value, field->offset));
            rest /= size;
        }
    } else if (type->kind == PN_KIND_UNION) {
        uint64_t rest = i;
        for (uint32_t tag = 0U; tag < type->count; tag++) {
            const pn_type_t *argument = type->field[tag].type;
            const uint64_t size = (argument == NULL) ? 1U : pn_type_size(argument);
            if (rest < size) {
                (void)memcpy(value, &tag, sizeof tag);
                if (argument != NULL) {
                    pn_type_value(argument, rest, part_of(value, type->field[tag].offset));
                }
                return;
            }
            rest -= size;
        }
    }
}

bool pn_type_has_position(const pn_type_t *type, const void *value)
{
    bool has = true;
    if (type->kind == PN_KIND_INT) {
        has = type->is_index || ((load_int(value) >= type->low) && (load_int(value) <= type->high));
    } else if (type->kind == PN_KIND_BIG) {
        has =
            (pn_big_order(load_big(value), type->big_low) >= 0) && (pn_big_order(load_big(value), type->big_high) <= 0);
    } else if (type->kind == PN_KIND_RECORD) {
        for (uint32_t k = 0U; (k < type->count) && has; k++) {
            has = pn_type_has_position(type->field[k].type, part(value, type->field[k].offset));
        }
    } else if (type->kind == PN_KIND_UNION) {
        const void *argument = NULL;
        const pn_field_t *constructor = constructor_of(type, value, &argument);
        has = (argument == NULL) || pn_type_has_position(constructor->type, argument);
    }
    return has;
}

uint64_t pn_type_position(const pn_type_t *type, const void *value)
{
    switch (type->kind) {
    case PN_KIND_BOOL: return load_bool(value) ? 1U : 0U;
    case PN_KIND_CHAR: return load_byte(value);
    case PN_KIND_INT: return (uint64_t)load_int(value) - (uint64_t)type->low;
    case PN_KIND_BIG: return (uint64_t)load_big(value).small - (uint64_t)type->big_low.small;
    case PN_KIND_ENUM: return load_tag(value);
    case PN_KIND_RECORD: {
        uint64_t position = 0U;
        for (uint32_t k = 0U; k < type->count; k++) {
            const pn_field_t *field = &type->field[k];
            position =
                (position * pn_type_size(field->type)) + pn_type_position(field->type, part(value, field->offset));
        }
        return position;
    }
    case PN_KIND_UNION: {
        const void *argument = NULL;
        const pn_field_t *constructor = constructor_of(type, value, &argument);
        uint64_t position = (argument == NULL) ? 0U : pn_type_position(constructor->type, argument);
        for (const pn_field_t *before = type->field; before < constructor; before++) {
            position += (before->type == NULL) ? 1U : pn_type_size(before->type);
        }
        return position;
    }
    case PN_KIND_UNIT:
    case PN_KIND_REAL:
    case PN_KIND_STRING:
    case PN_KIND_LIST:
    case PN_KIND_REF:
    default: return 0U;
    }
}
