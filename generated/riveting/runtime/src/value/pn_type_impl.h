/* SPDX-License-Identifier: MIT
 * pn_type_impl.h - how the runtime reads values through their tables. Package-private.
 *
 * Pointers and enumerations of generated types are read with memcpy, which no aliasing rule forbids.
 */
#ifndef PN_TYPE_IMPL_H
#define PN_TYPE_IMPL_H

#include <string.h>

#include "pn/pn_type.h"

/* Before the contents of a cell of pn_ref_new. */
typedef struct pn_cell {
    const void *moved; /* where its contents have been moved to; NULL: nowhere */
    uint64_t pass;     /* in which it was encoded last (pn_root.c), and its number then, from 1 on */
    uint64_t number;
} pn_cell_t;

#define PN_REF_HEADER ((sizeof(pn_cell_t) + sizeof(max_align_t) - 1U) / sizeof(max_align_t) * sizeof(max_align_t))

static inline const void *load_pointer(const void *at)
{
    const void *pointer = NULL;
    (void)memcpy(&pointer, at, sizeof pointer);
    return pointer;
}

static inline void store_pointer(void *at, const void *pointer)
{
    (void)memcpy(at, &pointer, sizeof pointer);
}

static inline int64_t load_int(const void *at)
{
    int64_t value = 0;
    (void)memcpy(&value, at, sizeof value);
    return value;
}

static inline pn_big_t load_big(const void *at)
{
    pn_big_t value = { 0, NULL };
    (void)memcpy(&value, at, sizeof value);
    return value;
}

static inline double load_real(const void *at)
{
    double value = 0.0;
    (void)memcpy(&value, at, sizeof value);
    return value;
}

static inline bool load_bool(const void *at)
{
    bool value = false;
    (void)memcpy(&value, at, sizeof value);
    return value;
}

static inline uint8_t load_byte(const void *at)
{
    uint8_t value = 0U;
    (void)memcpy(&value, at, sizeof value);
    return value;
}

/* An enumeration, or the tag of a union. */
static inline uint32_t load_tag(const void *at)
{
    uint32_t value = 0U;
    (void)memcpy(&value, at, sizeof value);
    return value;
}

static inline pn_string_t load_string(const void *at)
{
    pn_string_t value = { "", 0U };
    (void)memcpy(&value, at, sizeof value);
    return value;
}

static inline const void *part(const void *value, size_t offset)
{
    return (const unsigned char *)value + offset;
}

static inline void *part_of(void *value, size_t offset)
{
    return (unsigned char *)value + offset;
}

/* The constructor's entry and the address of its argument, NULL for a constant constructor. */
static inline const pn_field_t *constructor_of(const pn_type_t *type, const void *value, const void **argument)
{
    const pn_field_t *field = &type->field[load_tag(value)];
    *argument = NULL;
    if (field->type != NULL) {
        const void *at = part(value, field->offset);
        *argument = field->is_boxed ? load_pointer(at) : at;
    }
    return field;
}

/* Number of parts of a value, and part i: of a record as its table says, of anything else itself. Bindings have no
 * parts. */
static inline uint32_t parts_of(const pn_type_t *type)
{
    return (type->kind == PN_KIND_RECORD) ? type->part_count : 1U;
}

static inline pn_part_t part_at(const pn_type_t *type, uint32_t i)
{
    const pn_part_t whole = { type, 0U };
    return (type->kind == PN_KIND_RECORD) ? type->part[i] : whole;
}

/* The header of the cell with these contents. */
static inline unsigned char *cell_of(const void *contents)
{
    unsigned char *at = NULL;
    (void)memcpy(&at, &contents, sizeof at); /* cells are not constant */
    return at - PN_REF_HEADER;
}

/* What is met on the way through references (pn_root.c). */
typedef struct pn_cells {
    const pn_root_t *root;
    uint32_t roots;
    uint64_t pass;         /* encoding: another one each time, never 0 */
    uint64_t count;        /* cells so far */
    uint64_t most;         /* decoding: cells that there are */
    const void **contents; /* decoding: of each of them */
} pn_cells_t;

/* pn_encode and pn_decode of types in which there may be references; encoding begins at `at`. NULL: there are none. */
size_t pn_encode_with(pn_cells_t *cells, const pn_type_t *type, const void *value, uint8_t *out, size_t room,
                      size_t at);
size_t pn_decode_with(pn_ctx_t *cx, pn_cells_t *cells, const pn_type_t *type, void *value, const uint8_t *in,
                      size_t length);

/* Enumerations and union tags are C enums, which gcc and clang store as unsigned int. */
_Static_assert(sizeof(enum pn_kind_probe{ PN_KIND_PROBE = 0 }) == sizeof(uint32_t), "enums must have 32 bits");

#endif /* PN_TYPE_IMPL_H */
