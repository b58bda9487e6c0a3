/* SPDX-License-Identifier: MIT
 * Values as canonical bytes, and moved between the halves of the arena.
 */
#include "pn/pn_arena.h"
#include "pn/pn_num.h"
#include "pn/pn_type.h"
#include "pn_bytes_impl.h"
#include "pn_type_impl.h"

/* --- bytes -------------------------------------------------------------------------------------------------------- */

/* What a reference refers to: nothing, a root, a cell that comes with it, one that has come before. */
enum {
    CELL_NONE = 0,
    CELL_ROOT = 1, /* and its number */
    CELL_NEW = 2,  /* and its contents */
    CELL_KNOWN = 3 /* and its number */
};

static size_t encode_at(pn_cells_t *cells, const pn_type_t *type, const void *value, uint8_t *out, size_t room,
                        size_t at);

static size_t encode_cell(pn_cells_t *cells, const pn_type_t *type, const void *contents, uint8_t *out, size_t room,
                          size_t at)
{
    if (contents == NULL) {
        return put_number(out, room, at, CELL_NONE);
    }
    for (uint32_t i = 0U; i < cells->roots; i++) {
        if (cells->root[i].variable == contents) {
            return put_number(out, room, put_number(out, room, at, CELL_ROOT), i);
        }
    }
    unsigned char *const left = cell_of(contents);
    pn_cell_t cell;
    (void)memcpy(&cell, left, sizeof cell);
    if (cell.pass == cells->pass) {
        return put_number(out, room, put_number(out, room, at, CELL_KNOWN), cell.number);
    }
    cells->count++;
    cell.pass = cells->pass;
    cell.number = cells->count;
    (void)memcpy(left, &cell, sizeof cell);
    return encode_at(cells, type->element, contents, out, room, put_number(out, room, at, CELL_NEW));
}

static size_t encode_at(pn_cells_t *cells, const pn_type_t *type, const void *value, uint8_t *out, size_t room,
                        size_t at)
{
    size_t end = at;
    switch (type->kind) {
    case PN_KIND_BOOL: {
        const uint8_t flag = load_bool(value) ? 1U : 0U;
        return put_bytes(out, room, at, &flag, 1U);
    }
    case PN_KIND_INT: return put_integer(out, room, at, load_int(value));
    case PN_KIND_REAL: return put_real(out, room, at, load_real(value));
    case PN_KIND_CHAR: return put_bytes(out, room, at, value, type->size);
    case PN_KIND_ENUM: return put_number(out, room, at, load_tag(value));
    case PN_KIND_BIG: {
        const pn_big_t number = load_big(value);
        const size_t size = (number.large == NULL) ? 0U : pn_big_size(number.large);
        end = put_number(out, room, at, size);
        return (size == 0U) ? put_integer(out, room, end, number.small) : put_bytes(out, room, end, number.large, size);
    }
    case PN_KIND_STRING: {
        const pn_string_t text = load_string(value);
        end = put_number(out, room, at, text.length);
        return put_bytes(out, room, end, text.bytes, text.length);
    }
    case PN_KIND_RECORD:
        for (uint32_t i = 0U; i < type->count; i++) {
            end = encode_at(cells, type->field[i].type, part(value, type->field[i].offset), out, room, end);
        }
        return end;
    case PN_KIND_LIST: {
        const void *list = load_pointer(value);
        end = put_number(out, room, at, (uint64_t)pn_list_length(list));
        for (const void *rest = list; rest != NULL; rest = pn_list_tail(rest)) {
            end = encode_at(cells, type->element, pn_list_head(type, rest), out, room, end);
        }
        return end;
    }
    case PN_KIND_UNION: {
        const void *argument = NULL;
        const pn_field_t *constructor = constructor_of(type, value, &argument);
        end = put_number(out, room, at, load_tag(value));
        return (argument == NULL) ? end : encode_at(cells, constructor->type, argument, out, room, end);
    }
    case PN_KIND_REF: return (cells != NULL) ? encode_cell(cells, type, load_pointer(value), out, room, at) : end;
    case PN_KIND_UNIT:
    default: return end;
    }
}

size_t pn_encode_with(pn_cells_t *cells, const pn_type_t *type, const void *value, uint8_t *out, size_t room, size_t at)
{
    return encode_at(cells, type, value, out, room, at);
}

size_t pn_encode(const pn_type_t *type, const void *value, uint8_t *out, size_t room)
{
    return encode_at(NULL, type, value, out, room, 0U);
}

/* A reader that stays failed once something is missing. */
typedef struct reader {
    pn_ctx_t *cx;
    const uint8_t *in;
    size_t length;
    size_t at;
    bool failed;
    pn_cells_t *cells; /* NULL: there are no references */
} reader_t;

static void get_bytes(reader_t *r, void *out, size_t length)
{
    if (r->failed || (length > (r->length - r->at))) {
        r->failed = true;
        (void)memset(out, 0, length);
    } else {
        (void)memcpy(out, &r->in[r->at], length);
        r->at += length;
    }
}

static uint64_t read_number(reader_t *r)
{
    uint64_t number = 0U;
    r->failed = r->failed || !get_number(r->in, r->length, &r->at, &number);
    return r->failed ? 0U : number;
}

static int64_t read_integer(reader_t *r)
{
    int64_t value = 0;
    r->failed = r->failed || !get_integer(r->in, r->length, &r->at, &value);
    return r->failed ? 0 : value;
}

static double read_real(reader_t *r)
{
    double value = 0.0;
    r->failed = r->failed || !get_real(r->in, r->length, &r->at, &value);
    return r->failed ? 0.0 : value;
}

/* The number of a constructor. */
static uint32_t read_tag(reader_t *r, const pn_type_t *type)
{
    const uint64_t tag = read_number(r);
    r->failed = r->failed || (tag >= type->count);
    return r->failed ? 0U : (uint32_t)tag;
}

static void decode_value(reader_t *r, const pn_type_t *type, void *value);

static void decode_string(reader_t *r, void *value)
{
    const uint64_t length = read_number(r);
    pn_string_t text = { "", 0U };
    if (r->failed || (length > (r->length - r->at))) {
        r->failed = true;
    } else {
        text = pn_string_make(r->cx, (const char *)&r->in[r->at], (uint32_t)length);
        r->at += length;
    }
    (void)memcpy(value, &text, sizeof text);
}

static void decode_big(reader_t *r, void *value)
{
    pn_big_t number = { 0, NULL };
    const uint64_t size = read_number(r);
    const uint8_t *start = &r->in[r->failed ? 0U : r->at];
    if (size == 0U) {
        number.small = read_integer(r);
    } else if (!r->failed && pn_big_is_valid(start, r->length - r->at) && (pn_big_size(start) == size)) {
        number = pn_big_copy(r->cx, PN_BIG_BYTES(start));
        r->at += size;
    } else {
        r->failed = true;
    }
    (void)memcpy(value, &number, sizeof number);
}

static void decode_list(reader_t *r, const pn_type_t *type, void *value)
{
    const uint64_t length = read_number(r);
    const void *first = NULL;
    void *last = NULL;
    for (uint64_t i = 0U; (i < length) && !r->failed; i++) {
        void *cell = pn_list_new(r->cx, type, NULL);
        if (cell == NULL) {
            r->failed = true;
            break;
        }
        decode_value(r, type->element, pn_list_slot(type, cell));
        if (last == NULL) {
            first = cell;
        } else {
            store_pointer(last, cell);
        }
        last = cell;
    }
    store_pointer(value, first);
}

static void decode_union(reader_t *r, const pn_type_t *type, void *value)
{
    const uint32_t tag = read_tag(r, type);
    (void)memset(value, 0, type->size);
    (void)memcpy(value, &tag, sizeof tag);
    const pn_field_t *constructor = &type->field[tag];
    if ((constructor->type == NULL) || r->failed) {
        return;
    }
    if (constructor->is_boxed) {
        void *box = pn_arena_alloc(r->cx, constructor->type->size);
        if (box == NULL) {
            r->failed = true;
            return;
        }
        decode_value(r, constructor->type, box);
        store_pointer(part_of(value, constructor->offset), box);
    } else {
        decode_value(r, constructor->type, part_of(value, constructor->offset));
    }
}

/* A cell has its number before its contents, which may refer to it. */
static void decode_cell(reader_t *r, const pn_type_t *type, void *value)
{
    const uint64_t what = (r->cells != NULL) ? read_number(r) : (uint64_t)CELL_NONE;
    const void *contents = NULL;
    if (what == (uint64_t)CELL_NEW) {
        void *fresh = NULL;
        r->failed = r->failed || (r->cells->count >= r->cells->most);
        if (!r->failed) {
            fresh = pn_ref_new(r->cx, NULL, type->element->size);
            r->failed = fresh == NULL;
        }
        if (!r->failed) {
            r->cells->contents[r->cells->count] = fresh;
            r->cells->count++;
            decode_value(r, type->element, fresh);
        }
        contents = fresh;
    } else if (what != (uint64_t)CELL_NONE) {
        const uint64_t number = read_number(r);
        const uint64_t most = (what == (uint64_t)CELL_ROOT) ? r->cells->roots : r->cells->count;
        const bool is_there = (what == (uint64_t)CELL_ROOT) ? (number < most) : ((number > 0U) && (number <= most));
        r->failed = r->failed || (what > (uint64_t)CELL_KNOWN) || !is_there;
        if (!r->failed) {
            contents =
                (what == (uint64_t)CELL_ROOT) ? r->cells->root[number].variable : r->cells->contents[number - 1U];
        }
    }
    store_pointer(value, contents);
}

static void decode_value(reader_t *r, const pn_type_t *type, void *value)
{
    switch (type->kind) {
    case PN_KIND_BOOL: {
        uint8_t byte = 0U;
        get_bytes(r, &byte, 1U);
        const bool flag = byte == 1U;
        r->failed = r->failed || (byte > 1U);
        (void)memcpy(value, &flag, sizeof flag);
        break;
    }
    case PN_KIND_INT: {
        const int64_t number = read_integer(r);
        (void)memcpy(value, &number, sizeof number);
        break;
    }
    case PN_KIND_REAL: {
        const double number = read_real(r);
        (void)memcpy(value, &number, sizeof number);
        break;
    }
    case PN_KIND_CHAR: get_bytes(r, value, type->size); break;
    case PN_KIND_ENUM: {
        const uint32_t tag = read_tag(r, type);
        (void)memcpy(value, &tag, sizeof tag);
        break;
    }
    case PN_KIND_BIG: decode_big(r, value); break;
    case PN_KIND_STRING: decode_string(r, value); break;
    case PN_KIND_RECORD:
        (void)memset(value, 0, type->size);
        for (uint32_t i = 0U; i < type->count; i++) {
            decode_value(r, type->field[i].type, part_of(value, type->field[i].offset));
        }
        break;
    case PN_KIND_LIST: decode_list(r, type, value); break;
    case PN_KIND_UNION: decode_union(r, type, value); break;
    case PN_KIND_REF: decode_cell(r, type, value); break;
    case PN_KIND_UNIT:
    default: (void)memset(value, 0, type->size); break;
    }
}

size_t pn_decode(pn_ctx_t *cx, const pn_type_t *type, void *value, const uint8_t *in, size_t length)
{
    return pn_decode_with(cx, NULL, type, value, in, length);
}

size_t pn_decode_with(pn_ctx_t *cx, pn_cells_t *cells, const pn_type_t *type, void *value, const uint8_t *in,
                      size_t length)
{
    reader_t r = { cx, in, length, 0U, false, cells };
    decode_value(&r, type, value);
    /* A unit has no bytes: its callers ask for nothing and must not take 0 for a failure. */
    return (r.failed || !pn_ok(cx)) ? SIZE_MAX : r.at;
}

/* --- moving between halves ---------------------------------------------------------------------------------------- */

static void relocate_list(pn_ctx_t *cx, const pn_type_t *type, void *value)
{
    const void *first = NULL;
    void *last = NULL;
    for (const void *rest = load_pointer(value); rest != NULL; rest = pn_list_tail(rest)) {
        void *cell = pn_list_new(cx, type, NULL);
        if (cell == NULL) {
            break;
        }
        void *head = pn_list_slot(type, cell);
        (void)memcpy(head, pn_list_head(type, rest), type->element->size);
        pn_relocate(cx, type->element, head);
        if (last == NULL) {
            first = cell;
        } else {
            store_pointer(last, cell);
        }
        last = cell;
    }
    store_pointer(value, first);
}

static bool is_within(const unsigned char *at, const unsigned char *start, size_t size)
{
    return (at >= start) && (at < &start[size]);
}

/* A cell is moved once: the one left behind says where it is now. Static variables stay where they are. */
static void relocate_ref(pn_ctx_t *cx, const pn_type_t *type, void *value)
{
    const pn_arena_t *arena = cx->arena;
    const unsigned char *contents = load_pointer(value);
    const unsigned char *active = &arena->memory[arena->permanent + (arena->active * arena->half)];
    if ((contents == NULL) || !is_within(contents, arena->memory, arena->size)
        || is_within(contents, active, arena->half)) {
        return;
    }
    unsigned char *left = &arena->memory[(size_t)(contents - arena->memory) - PN_REF_HEADER];
    const void *moved = load_pointer(left);
    if (moved == NULL) {
        void *fresh = pn_ref_new(cx, contents, type->element->size);
        if (fresh == NULL) {
            return;
        }
        store_pointer(left, fresh);
        store_pointer(value, fresh);
        pn_relocate(cx, type->element, fresh);
    } else {
        store_pointer(value, moved);
    }
}

void pn_relocate(pn_ctx_t *cx, const pn_type_t *type, void *value)
{
    if (type->kind == PN_KIND_REF) {
        relocate_ref(cx, type, value);
    } else if (type->kind == PN_KIND_STRING) {
        const pn_string_t text = load_string(value);
        const pn_string_t copy = pn_string_make(cx, text.bytes, text.length);
        (void)memcpy(value, &copy, sizeof copy);
    } else if (type->kind == PN_KIND_BIG) {
        const pn_big_t copy = pn_big_copy(cx, load_big(value));
        (void)memcpy(value, &copy, sizeof copy);
    } else if (type->kind == PN_KIND_RECORD) {
        for (uint32_t i = 0U; i < type->count; i++) {
            pn_relocate(cx, type->field[i].type, part_of(value, type->field[i].offset));
        }
    } else if (type->kind == PN_KIND_LIST) {
        relocate_list(cx, type, value);
    } else if (type->kind == PN_KIND_UNION) {
        const pn_field_t *constructor = &type->field[load_tag(value)];
        if ((constructor->type != NULL) && constructor->is_boxed) {
            void *box = pn_arena_alloc(cx, constructor->type->size);
            if (box != NULL) {
                (void)memcpy(box, load_pointer(part(value, constructor->offset)), constructor->type->size);
                pn_relocate(cx, constructor->type, box);
                store_pointer(part_of(value, constructor->offset), box);
            }
        } else if (constructor->type != NULL) {
            pn_relocate(cx, constructor->type, part_of(value, constructor->offset));
        }
    }
}
