/* SPDX-License-Identifier: MIT
 * Lists are built from the front to the back by keeping the last cell open: no recursion, one pass.
 */
#include "pn/pn_arena.h"
#include "pn/pn_num.h"
#include "pn/pn_random.h"
#include "pn/pn_type.h"
#include "pn_type_impl.h"

typedef struct builder {
    pn_ctx_t *cx;
    const pn_type_t *type;
    const void *first;
    void *last;
} builder_t;

static void push(builder_t *b, const void *head)
{
    void *cell = pn_list_new(b->cx, b->type, NULL);
    if (cell == NULL) {
        return;
    }
    (void)memcpy(pn_list_slot(b->type, cell), head, b->type->element->size);
    if (b->last == NULL) {
        b->first = cell;
    } else {
        store_pointer(b->last, cell);
    }
    b->last = cell;
}

static const void *finish(const builder_t *b, const void *tail)
{
    if (b->last == NULL) {
        return tail;
    }
    store_pointer(b->last, tail);
    return b->first;
}

const void *pn_list_tail(const void *list)
{
    return load_pointer(list);
}

const void *pn_list_head(const pn_type_t *type, const void *list)
{
    return part(list, type->head);
}

void *pn_list_new(pn_ctx_t *cx, const pn_type_t *type, const void *tail)
{
    void *cell = pn_arena_alloc(cx, type->cell);
    if (cell != NULL) {
        store_pointer(cell, tail);
    }
    return cell;
}

void *pn_list_slot(const pn_type_t *type, void *cell)
{
    return part_of(cell, type->head);
}

const void *pn_list_cons(pn_ctx_t *cx, const pn_type_t *type, const void *head, const void *tail)
{
    void *cell = pn_list_new(cx, type, tail);
    if (cell == NULL) {
        return tail;
    }
    (void)memcpy(pn_list_slot(type, cell), head, type->element->size);
    return cell;
}

int64_t pn_list_length(const void *list)
{
    int64_t length = 0;
    for (const void *rest = list; rest != NULL; rest = pn_list_tail(rest)) {
        length++;
    }
    return length;
}

const void *pn_list_append(pn_ctx_t *cx, const pn_type_t *type, const void *first, const void *second)
{
    builder_t b = { cx, type, NULL, NULL };
    for (const void *rest = first; (rest != NULL) && pn_ok(cx); rest = pn_list_tail(rest)) {
        push(&b, pn_list_head(type, rest));
    }
    return finish(&b, second);
}

const void *pn_list_reverse_onto(pn_ctx_t *cx, const pn_type_t *type, const void *first, const void *second)
{
    const void *result = second;
    for (const void *rest = first; (rest != NULL) && pn_ok(cx); rest = pn_list_tail(rest)) {
        result = pn_list_cons(cx, type, pn_list_head(type, rest), result);
    }
    return result;
}

const void *pn_list_reverse(pn_ctx_t *cx, const pn_type_t *type, const void *list)
{
    return pn_list_reverse_onto(cx, type, list, NULL);
}

const void *pn_list_nth_cell(pn_ctx_t *cx, const void *list, int64_t i)
{
    const void *rest = list;
    for (int64_t k = 0; (k < i) && (rest != NULL); k++) {
        rest = pn_list_tail(rest);
    }
    if ((i < 0) || (rest == NULL)) {
        pn_raise(cx, PN_ERR_SUBSCRIPT, NULL);
        return NULL;
    }
    return rest;
}

const void *pn_list_first_cell(pn_ctx_t *cx, const void *list)
{
    if (list == NULL) {
        pn_raise(cx, PN_ERR_EMPTY, NULL);
    }
    return list;
}

const void *pn_list_last_cell(pn_ctx_t *cx, const void *list)
{
    const void *last = list;
    for (const void *rest = list; rest != NULL; rest = pn_list_tail(rest)) {
        last = rest;
    }
    return pn_list_first_cell(cx, last);
}

const void *pn_list_rest(pn_ctx_t *cx, const void *list)
{
    if (list == NULL) {
        pn_raise(cx, PN_ERR_EMPTY, NULL);
        return NULL;
    }
    return pn_list_tail(list);
}

const void *pn_list_take(pn_ctx_t *cx, const pn_type_t *type, const void *list, int64_t n)
{
    builder_t b = { cx, type, NULL, NULL };
    const void *rest = list;
    for (int64_t k = 0; (k < n) && (rest != NULL) && pn_ok(cx); k++) {
        push(&b, pn_list_head(type, rest));
        rest = pn_list_tail(rest);
    }
    const void *result = finish(&b, NULL);
    if ((n < 0) || (pn_list_length(result) < n)) {
        pn_raise(cx, PN_ERR_SUBSCRIPT, NULL);
    }
    return result;
}

const void *pn_list_drop(pn_ctx_t *cx, const void *list, int64_t n)
{
    const void *rest = list;
    for (int64_t k = 0; k < n; k++) {
        if (rest == NULL) {
            pn_raise(cx, PN_ERR_SUBSCRIPT, NULL);
            return NULL;
        }
        rest = pn_list_tail(rest);
    }
    if (n < 0) {
        pn_raise(cx, PN_ERR_SUBSCRIPT, NULL);
    }
    return rest;
}

const void *pn_list_copies(pn_ctx_t *cx, const pn_type_t *type, int64_t n, const void *value)
{
    const void *result = NULL;
    for (int64_t k = 0; (k < n) && pn_ok(cx); k++) {
        result = pn_list_cons(cx, type, value, result);
    }
    return result;
}

const void *pn_list_concat(pn_ctx_t *cx, const pn_type_t *type, const void *lists)
{
    builder_t b = { cx, type, NULL, NULL };
    for (const void *outer = lists; outer != NULL; outer = pn_list_tail(outer)) {
        /* A cell is { tail; head; } and the head of the outer one is a pointer: it comes right after the tail. */
        const void *inner = load_pointer(part(outer, sizeof(void *)));
        for (const void *rest = inner; (rest != NULL) && pn_ok(cx); rest = pn_list_tail(rest)) {
            push(&b, pn_list_head(type, rest));
        }
    }
    return finish(&b, NULL);
}

bool pn_list_has(const pn_type_t *type, const void *list, const void *value)
{
    return pn_list_count(type, list, value) > 0;
}

bool pn_list_contains(const pn_type_t *type, const void *larger, const void *smaller)
{
    for (const void *rest = smaller; rest != NULL; rest = pn_list_tail(rest)) {
        if (!pn_list_has(type, larger, pn_list_head(type, rest))) {
            return false;
        }
    }
    return true;
}

bool pn_list_all_true(const void *list)
{
    for (const void *rest = list; rest != NULL; rest = pn_list_tail(rest)) {
        if (!load_bool(part(rest, sizeof(void *)))) {
            return false;
        }
    }
    return true;
}

int64_t pn_list_count(const pn_type_t *type, const void *list, const void *value)
{
    int64_t count = 0;
    for (const void *rest = list; rest != NULL; rest = pn_list_tail(rest)) {
        count += pn_equal(type->element, pn_list_head(type, rest), value) ? 1 : 0;
    }
    return count;
}

const void *pn_list_remove(pn_ctx_t *cx, const pn_type_t *type, const void *list, const void *value)
{
    builder_t b = { cx, type, NULL, NULL };
    const void *rest = list;
    for (; (rest != NULL) && pn_ok(cx); rest = pn_list_tail(rest)) {
        if (pn_equal(type->element, pn_list_head(type, rest), value)) {
            return finish(&b, pn_list_tail(rest));
        }
        push(&b, pn_list_head(type, rest));
    }
    return list;
}

const void *pn_list_remove_all(pn_ctx_t *cx, const pn_type_t *type, const void *list, const void *value)
{
    builder_t b = { cx, type, NULL, NULL };
    for (const void *rest = list; (rest != NULL) && pn_ok(cx); rest = pn_list_tail(rest)) {
        if (!pn_equal(type->element, pn_list_head(type, rest), value)) {
            push(&b, pn_list_head(type, rest));
        }
    }
    return finish(&b, NULL);
}

const void *pn_list_remdupl(pn_ctx_t *cx, const pn_type_t *type, const void *list)
{
    builder_t b = { cx, type, NULL, NULL };
    for (const void *rest = list; (rest != NULL) && pn_ok(cx); rest = pn_list_tail(rest)) {
        if (!pn_list_has(type, pn_list_tail(rest), pn_list_head(type, rest))) {
            push(&b, pn_list_head(type, rest));
        }
    }
    return finish(&b, NULL);
}

int64_t pn_list_position(pn_ctx_t *cx, const pn_type_t *type, const void *list, const void *value)
{
    int64_t position = 0;
    for (const void *rest = list; rest != NULL; rest = pn_list_tail(rest)) {
        if (pn_equal(type->element, pn_list_head(type, rest), value)) {
            return position;
        }
        position++;
    }
    pn_raise(cx, PN_ERR_MATCH, NULL);
    return 0;
}

/* The head of a cell of strings or characters, which comes right after the tail. */
static const void *plain_head(const void *cell)
{
    return part(cell, sizeof(void *));
}

pn_string_t pn_string_join(pn_ctx_t *cx, const void *strings)
{
    pn_string_t result = { "", 0U };
    for (const void *rest = strings; (rest != NULL) && pn_ok(cx); rest = pn_list_tail(rest)) {
        result = pn_string_concat(cx, result, load_string(plain_head(rest)));
    }
    return result;
}

pn_string_t pn_string_implode(pn_ctx_t *cx, const void *chars)
{
    const size_t length = (size_t)pn_list_length(chars);
    char *bytes = pn_arena_alloc(cx, length + 1U);
    if (bytes == NULL) {
        return (pn_string_t){ "", 0U };
    }
    size_t at = 0U;
    for (const void *rest = chars; rest != NULL; rest = pn_list_tail(rest)) {
        bytes[at] = (char)load_byte(plain_head(rest));
        at++;
    }
    bytes[at] = '\0';
    return (pn_string_t){ bytes, (uint32_t)length };
}

const void *pn_string_explode(pn_ctx_t *cx, const pn_type_t *type, pn_string_t s)
{
    const void *result = NULL;
    for (uint32_t i = s.length; (i > 0U) && pn_ok(cx); i--) {
        const uint8_t c = (uint8_t)s.bytes[i - 1U];
        result = pn_list_cons(cx, type, &c, result);
    }
    return result;
}

const void *pn_ms_intersect(pn_ctx_t *cx, const pn_type_t *type, const void *a, const void *b)
{
    builder_t out = { cx, type, NULL, NULL };
    const void *left = b;
    for (const void *rest = a; (rest != NULL) && pn_ok(cx); rest = pn_list_tail(rest)) {
        const void *value = pn_list_head(type, rest);
        if (pn_list_has(type, left, value)) {
            push(&out, value);
            left = pn_list_remove(cx, type, left, value);
        }
    }
    return finish(&out, NULL);
}

bool pn_ms_contains(const pn_type_t *type, const void *larger, const void *smaller)
{
    for (const void *rest = smaller; rest != NULL; rest = pn_list_tail(rest)) {
        const void *value = pn_list_head(type, rest);
        const int64_t wanted = pn_list_count(type, smaller, value);
        /* What is no number is not even like itself. */
        if ((wanted == 0) || (wanted > pn_list_count(type, larger, value))) {
            return false;
        }
    }
    return true;
}

bool pn_ms_contains_strictly(const pn_type_t *type, const void *larger, const void *smaller)
{
    return pn_ms_contains(type, larger, smaller) && (pn_list_length(larger) > pn_list_length(smaller));
}

bool pn_ms_equal(const pn_type_t *type, const void *a, const void *b)
{
    return (pn_list_length(a) == pn_list_length(b)) && pn_ms_contains(type, a, b);
}

const void *pn_ms_subtract(pn_ctx_t *cx, const pn_type_t *type, const void *a, const void *b)
{
    if (!pn_ms_contains(type, a, b)) {
        pn_raise(cx, PN_ERR_SUBTRACT, NULL);
        return NULL;
    }
    const void *result = a;
    for (const void *rest = b; (rest != NULL) && pn_ok(cx); rest = pn_list_tail(rest)) {
        result = pn_list_remove(cx, type, result, pn_list_head(type, rest));
    }
    return result;
}

const void *pn_ms_times(pn_ctx_t *cx, const pn_type_t *type, int64_t n, const void *multiset)
{
    const void *result = NULL;
    for (const void *rest = pn_list_reverse(cx, type, multiset); (rest != NULL) && pn_ok(cx);
         rest = pn_list_tail(rest)) {
        for (int64_t k = 0; (k < n) && pn_ok(cx); k++) {
            result = pn_list_cons(cx, type, pn_list_head(type, rest), result);
        }
    }
    return result;
}

const void *pn_ms_only_cell(pn_ctx_t *cx, const void *multiset)
{
    if ((multiset == NULL) || (pn_list_tail(multiset) != NULL)) {
        pn_raise(cx, PN_ERR_DOMAIN, "no_singleton");
        return NULL;
    }
    return multiset;
}

const void *pn_ms_random_cell(pn_ctx_t *cx, const void *multiset)
{
    const int64_t length = pn_list_length(multiset);
    if (length == 0) {
        pn_raise(cx, PN_ERR_EMPTY, NULL);
        return NULL;
    }
    return pn_list_nth_cell(cx, multiset, pn_random_below(cx, length));
}

/* --- functions of a colour set ------------------------------------------------------------------------------------ */

static bool is_small(pn_ctx_t *cx, const pn_type_t *type)
{
    const uint64_t size = pn_type_size(type);
    if ((size == 0U) || (size > (uint64_t)PN_INT_MAX)) {
        pn_raise(cx, PN_ERR_DOMAIN, "CPN'Error");
        return false;
    }
    return true;
}

int64_t pn_colset_size(pn_ctx_t *cx, const pn_type_t *type)
{
    return is_small(cx, type) ? (int64_t)pn_type_size(type) : 0;
}

int64_t pn_colset_ord(pn_ctx_t *cx, const pn_type_t *type, const void *value)
{
    if (is_small(cx, type) && !pn_type_has_position(type, value)) {
        pn_raise(cx, PN_ERR_DOMAIN, "CPN'Error");
    }
    return pn_ok(cx) ? (int64_t)pn_type_position(type, value) : 0;
}

void pn_colset_col(pn_ctx_t *cx, const pn_type_t *type, void *value, int64_t position)
{
    (void)memset(value, 0, type->size);
    if (is_small(cx, type) && (type->kind == PN_KIND_INT)) {
        (void)pn_int_add(cx, type->low, position);
    }
    if (pn_ok(cx)) {
        if (!type->is_index && ((position < 0) || (position >= (int64_t)pn_type_size(type)))) {
            pn_raise(cx, PN_ERR_DOMAIN, "CPN'Error");
        } else {
            pn_type_value(type, (uint64_t)position, value);
        }
    }
}

void pn_colset_ran(pn_ctx_t *cx, const pn_type_t *type, void *value)
{
    pn_colset_col(cx, type, value, pn_random_below(cx, pn_colset_size(cx, type)));
}

void pn_colset_base(pn_ctx_t *cx, const pn_type_t *type, void *value)
{
    (void)memset(value, 0, type->size);
    if (pn_type_size(type) > 0U) {
        pn_colset_col(cx, type, value, 0);
    }
}

const void *pn_colset_all(pn_ctx_t *cx, const pn_type_t *type, const pn_type_t *list)
{
    const void *result = NULL;
    for (int64_t i = pn_colset_size(cx, type); (i > 0) && pn_ok(cx); i--) {
        void *cell = pn_list_new(cx, list, result);
        if (cell != NULL) {
            pn_type_value(type, (uint64_t)(i - 1), pn_list_slot(list, cell));
            result = cell;
        }
    }
    return result;
}
