/* SPDX-License-Identifier: MIT */
#include "pn/pn_read.h"

#include <string.h>

#include "pn/pn_arena.h"
#include "pn/pn_library.h"
#include "pn/pn_num.h"
#include "pn_type_impl.h"

static pn_string_t named(const char *name)
{
    return (pn_string_t){ name, (uint32_t)strlen(name) };
}

static uint8_t character(pn_string_t text, int64_t at)
{
    return (at < (int64_t)text.length) ? (uint8_t)text.bytes[at] : 0U;
}

static void skip(pn_string_t text, int64_t *at)
{
    while ((*at < (int64_t)text.length) && pn_char_is_space(character(text, *at))) {
        (*at)++;
    }
}

void pn_read_fail(pn_ctx_t *cx)
{
    pn_raise(cx, PN_ERR_RAISED, "IOError");
}

/* After an error references are NULL: there is nothing to read then. */
bool pn_read_accept(pn_string_t text, int64_t *at, pn_string_t word)
{
    if (at == NULL) {
        return false;
    }
    skip(text, at);
    const int64_t left = (int64_t)text.length - *at;
    if ((word.length == 0U) || ((int64_t)word.length > left)
        || (memcmp(&text.bytes[*at], word.bytes, word.length) != 0)) {
        return false;
    }
    const int64_t end = *at + (int64_t)word.length;
    const uint8_t next = character(text, end);
    const bool goes_on = pn_char_is_alphanum(next) || (next == (uint8_t)'_') || (next == (uint8_t)'\'');
    if (pn_char_is_alphanum((uint8_t)word.bytes[word.length - 1U]) && goes_on) {
        return false;
    }
    *at = end;
    return true;
}

static void expect(pn_ctx_t *cx, pn_string_t text, int64_t *at, pn_string_t word)
{
    if (pn_ok(cx) && !pn_read_accept(text, at, word)) {
        pn_read_fail(cx);
    }
}

bool pn_read_is_done(pn_string_t text, int64_t *at)
{
    if (at == NULL) {
        return true;
    }
    skip(text, at);
    return *at >= (int64_t)text.length;
}

/* Minus or plus; whether it was minus. */
static bool sign(pn_string_t text, int64_t *at)
{
    const uint8_t c = character(text, *at);
    const bool is_minus = (c == (uint8_t)'~') || (c == (uint8_t)'-');
    if (is_minus || (c == (uint8_t)'+')) {
        (*at)++;
    }
    return is_minus;
}

pn_big_t pn_read_integer(pn_ctx_t *cx, pn_string_t text, int64_t *at)
{
    pn_big_t number = PN_BIG(0);
    if (at == NULL) {
        return number;
    }
    const int64_t start = *at;
    const bool has_bracket = pn_read_accept(text, at, PN_STRING("("));
    skip(text, at);
    const bool is_minus = sign(text, at);
    const int64_t first = *at;
    while (pn_char_is_digit(character(text, *at))) {
        (*at)++;
    }
    if (*at == first) {
        *at = start;
        pn_read_fail(cx);
        return number;
    }
    number = pn_big_of_digits(cx, &text.bytes[first], (size_t)(*at - first), is_minus);
    if (has_bracket) {
        expect(cx, text, at, PN_STRING(")"));
    }
    return number;
}

static void digits(pn_string_t text, int64_t *at, char *out, size_t *length, size_t capacity)
{
    while (pn_char_is_digit(character(text, *at))) {
        if (*length < capacity) {
            out[(*length)++] = (char)character(text, *at);
        }
        (*at)++;
    }
}

double pn_read_number(pn_ctx_t *cx, pn_string_t text, int64_t *at)
{
    char out[800]; /* more digits than any double needs */
    if (at == NULL) {
        return 0.0;
    }
    const size_t capacity = sizeof out - 16U;
    const int64_t start = *at;
    const bool has_bracket = pn_read_accept(text, at, PN_STRING("("));
    skip(text, at);
    const bool is_minus = sign(text, at);
    size_t n = 0U;
    double number = 0.0;
    digits(text, at, out, &n, capacity);
    if ((character(text, *at) == (uint8_t)'.') && pn_char_is_digit(character(text, *at + 1))) {
        out[n++] = '.';
        (*at)++;
        digits(text, at, out, &n, capacity);
    }
    if (n > 0U) {
        int64_t behind = *at;
        if ((character(text, behind) | 32U) == (uint8_t)'e') {
            behind++;
            const bool is_small = sign(text, &behind);
            if (pn_char_is_digit(character(text, behind))) {
                out[n++] = 'e';
                out[n++] = is_small ? '-' : '+';
                digits(text, &behind, out, &n, sizeof out - 1U);
                *at = behind;
            }
        }
        out[n] = '\0';
        number = pn_real_read((pn_string_t){ out, (uint32_t)n });
    } else if (pn_read_accept(text, at, PN_STRING("inf"))) {
        number = pn_real_read(PN_STRING("inf"));
    } else if (pn_read_accept(text, at, PN_STRING("nan"))) {
        number = pn_real_read(PN_STRING("nan"));
    } else {
        *at = start;
        pn_read_fail(cx);
    }
    if (has_bracket) {
        expect(cx, text, at, PN_STRING(")"));
    }
    return is_minus ? -number : number;
}

/* --- values ------------------------------------------------------------------------------------------------------- */

static void input(pn_ctx_t *cx, const pn_type_t *type, void *value, pn_string_t text, int64_t *at);

/* The number of the name that is there. */
static uint32_t one_of(pn_ctx_t *cx, const pn_type_t *type, pn_string_t text, int64_t *at)
{
    for (uint32_t i = 0U; i < type->count; i++) {
        const bool has_fields = (type->kind == PN_KIND_UNION) || (type->kind == PN_KIND_RECORD);
        if (pn_read_accept(text, at, named(has_fields ? type->field[i].label : type->name_of_value[i]))) {
            return i;
        }
    }
    pn_read_fail(cx);
    return 0U;
}

static void input_string(pn_ctx_t *cx, void *value, pn_string_t text, int64_t *at)
{
    expect(cx, text, at, PN_STRING("\""));
    const int64_t start = *at;
    while ((*at < (int64_t)text.length) && (character(text, *at) != (uint8_t)'"')) {
        (*at)++;
    }
    if (pn_ok(cx) && (*at >= (int64_t)text.length)) {
        pn_read_fail(cx);
    }
    if (pn_ok(cx)) {
        const pn_string_t found = pn_string_make(cx, &text.bytes[start], (size_t)(*at - start));
        (void)memcpy(value, &found, sizeof found);
        (*at)++;
    }
}

/* The fields of a record may come in any order. */
static void input_record(pn_ctx_t *cx, const pn_type_t *type, void *value, pn_string_t text, int64_t *at)
{
    uint64_t seen = 0U;
    expect(cx, text, at, type->is_tuple ? PN_STRING("(") : PN_STRING("{"));
    for (uint32_t i = 0U; (i < type->count) && pn_ok(cx); i++) {
        if (i > 0U) {
            expect(cx, text, at, PN_STRING(","));
        }
        uint32_t k = i;
        if (!type->is_tuple && pn_ok(cx)) {
            k = one_of(cx, type, text, at);
            expect(cx, text, at, PN_STRING("="));
            const uint64_t bit = UINT64_C(1) << (k % 64U);
            if (((seen & bit) != 0U) && (type->count <= 64U)) {
                pn_read_fail(cx);
            }
            seen |= bit;
        }
        if (pn_ok(cx)) {
            input(cx, type->field[k].type, part_of(value, type->field[k].offset), text, at);
        }
    }
    expect(cx, text, at, type->is_tuple ? PN_STRING(")") : PN_STRING("}"));
}

static void input_list(pn_ctx_t *cx, const pn_type_t *type, void *value, pn_string_t text, int64_t *at)
{
    const void *reversed = NULL;
    expect(cx, text, at, PN_STRING("["));
    while (pn_ok(cx) && !pn_read_accept(text, at, PN_STRING("]"))) {
        if (reversed != NULL) {
            expect(cx, text, at, PN_STRING(","));
        }
        void *cell = pn_list_new(cx, type, reversed);
        if (cell != NULL) {
            (void)memset(pn_list_slot(type, cell), 0, type->element->size);
            input(cx, type->element, pn_list_slot(type, cell), text, at);
            reversed = cell;
        }
    }
    store_pointer(value, pn_list_reverse(cx, type, reversed));
}

static void input_union(pn_ctx_t *cx, const pn_type_t *type, void *value, pn_string_t text, int64_t *at)
{
    const uint32_t tag = one_of(cx, type, text, at);
    (void)memcpy(value, &tag, sizeof tag);
    const pn_field_t *field = &type->field[tag];
    if ((field->type == NULL) || !pn_ok(cx)) {
        return;
    }
    expect(cx, text, at, PN_STRING("("));
    void *argument = part_of(value, field->offset);
    if (field->is_boxed) {
        argument = pn_arena_alloc(cx, field->type->size);
        store_pointer(part_of(value, field->offset), argument);
    }
    if (pn_ok(cx)) {
        (void)memset(argument, 0, field->type->size);
        input(cx, field->type, argument, text, at);
    }
    expect(cx, text, at, PN_STRING(")"));
}

static void input_bool(pn_ctx_t *cx, const pn_type_t *type, void *value, pn_string_t text, int64_t *at)
{
    const bool has_names = type->name_of_value != NULL;
    bool is_true = pn_read_accept(text, at, has_names ? named(type->name_of_value[1]) : PN_STRING("true"));
    if (!is_true) {
        expect(cx, text, at, has_names ? named(type->name_of_value[0]) : PN_STRING("false"));
    }
    (void)memcpy(value, &is_true, sizeof is_true);
}

static void input(pn_ctx_t *cx, const pn_type_t *type, void *value, pn_string_t text, int64_t *at)
{
    switch (type->kind) {
    case PN_KIND_UNIT:
        if (type->name_of_value != NULL) {
            expect(cx, text, at, named(type->name_of_value[0]));
        } else {
            expect(cx, text, at, PN_STRING("()"));
        }
        break;
    case PN_KIND_BOOL: input_bool(cx, type, value, text, at); break;
    case PN_KIND_INT: {
        if (type->is_index) {
            expect(cx, text, at, named(type->name_of_value[0]));
        }
        const int64_t number = pn_ok(cx) ? pn_big_to_wide(cx, pn_read_integer(cx, text, at)) : 0;
        (void)memcpy(value, &number, sizeof number);
        break;
    }
    case PN_KIND_BIG: {
        const pn_big_t number = pn_ok(cx) ? pn_read_integer(cx, text, at) : PN_BIG(0);
        (void)memcpy(value, &number, sizeof number);
        break;
    }
    case PN_KIND_REAL: {
        const double number = pn_read_number(cx, text, at);
        (void)memcpy(value, &number, sizeof number);
        break;
    }
    case PN_KIND_STRING: input_string(cx, value, text, at); break;
    case PN_KIND_ENUM: {
        const uint32_t tag = one_of(cx, type, text, at);
        (void)memcpy(value, &tag, sizeof tag);
        break;
    }
    case PN_KIND_RECORD: input_record(cx, type, value, text, at); break;
    case PN_KIND_LIST: input_list(cx, type, value, text, at); break;
    case PN_KIND_UNION: input_union(cx, type, value, text, at); break;
    case PN_KIND_CHAR:
    case PN_KIND_REF:
    default:
        pn_read_fail(cx); /* no colour set has such values */
        break;
    }
}

void pn_colset_input(pn_ctx_t *cx, const pn_type_t *type, void *value, pn_string_t text, int64_t *at)
{
    (void)memset(value, 0, type->size);
    if (at == NULL) {
        return;
    }
    const int64_t start = *at;
    input(cx, type, value, text, at);
    if (!pn_ok(cx)) {
        *at = start;
        (void)memset(value, 0, type->size);
    }
}
