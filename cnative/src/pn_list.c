/* SPDX-License-Identifier: MIT
 * Lists are built from the front to the back by keeping the last cell open: no recursion, one pass.
 */
#include "pn/pn_arena.h"
#include "pn/pn_num.h"
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

const void *pn_list_nth(pn_ctx_t *cx, const pn_type_t *type, const void *list, int64_t i)
{
    const void *rest = list;
    for (int64_t k = 0; (k < i) && (rest != NULL); k++) {
        rest = pn_list_tail(rest);
    }
    if ((i < 0) || (rest == NULL)) {
        pn_raise(cx, PN_ERR_SUBSCRIPT, NULL);
        return NULL;
    }
    return pn_list_head(type, rest);
}

const void *pn_list_first(pn_ctx_t *cx, const pn_type_t *type, const void *list)
{
    if (list == NULL) {
        pn_raise(cx, PN_ERR_EMPTY, NULL);
        return NULL;
    }
    return pn_list_head(type, list);
}

const void *pn_list_last(pn_ctx_t *cx, const pn_type_t *type, const void *list)
{
    const void *last = list;
    for (const void *rest = list; rest != NULL; rest = pn_list_tail(rest)) {
        last = rest;
    }
    return pn_list_first(cx, type, last);
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

const void *pn_list_repeat(pn_ctx_t *cx, const pn_type_t *type, int64_t n, const void *value, const void *tail)
{
    const void *result = tail;
    for (int64_t k = 0; (k < n) && pn_ok(cx); k++) {
        result = pn_list_cons(cx, type, value, result);
    }
    return result;
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

bool pn_ms_contains(const pn_type_t *type, const void *larger, const void *smaller)
{
    for (const void *rest = smaller; rest != NULL; rest = pn_list_tail(rest)) {
        const void *value = pn_list_head(type, rest);
        if (pn_list_count(type, smaller, value) > pn_list_count(type, larger, value)) {
            return false;
        }
    }
    return true;
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

const void *pn_list_all(pn_ctx_t *cx, const pn_type_t *type)
{
    const void *result = NULL;
    for (uint64_t i = pn_type_size(type->element); (i > 0U) && pn_ok(cx); i--) {
        void *cell = pn_list_new(cx, type, result);
        if (cell != NULL) {
            pn_type_value(type->element, i - 1U, pn_list_slot(type, cell));
            result = cell;
        }
    }
    return result;
}
