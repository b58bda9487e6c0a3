/* SPDX-License-Identifier: MIT
 * pn_type.h - colour sets as tables, and what every value can do: compare, print, encode, check, copy.
 *
 * A generated net declares an ordinary C type for each colour set (`pose_t`), which its expressions use directly, and
 * one constant pn_type_t that describes it. Everything that is the same for all colour sets walks the table.
 *
 * Representation in C
 *
 *     unit             pn_unit_t                  int, index                  int64_t
 *     IntInf, time     pn_big_t                   real                        double
 *     bool             bool
 *     string           pn_string_t                char                        uint8_t
 *     enumeration      enum (as unsigned int)     product, record             struct
 *     list             pointer to a constant cell { tail; head; }, NULL is the empty list
 *     union            struct { enum tag; union { ... } as; }; a recursive argument is a pointer into the arena
 *     ref              pointer to what it holds: a cell of pn_ref_new, or a static variable
 *     function, exn    as unions: the constructors are the functions, or exceptions, that there are
 *
 * Records are walked by their tables of parts, without recursion. The functions recurse over lists, unions and what
 * references hold, never deeper than the value itself is nested; a net without any of these is compiled with
 * -DPN_FLAT_TYPES, which leaves that out.
 */
#ifndef PN_TYPE_H
#define PN_TYPE_H

#include "pn/pn_big.h"
#include "pn/pn_net.h"
#include "pn/pn_string.h"

typedef uint8_t pn_unit_t;
#define PN_UNIT ((pn_unit_t)0U)

typedef enum pn_kind {
    PN_KIND_UNIT,
    PN_KIND_BOOL,
    PN_KIND_INT, /* int, index */
    PN_KIND_BIG, /* intinf, time */
    PN_KIND_REAL,
    PN_KIND_STRING,
    PN_KIND_CHAR,
    PN_KIND_ENUM,
    PN_KIND_RECORD, /* product, record */
    PN_KIND_LIST,
    PN_KIND_UNION,
    PN_KIND_REF
} pn_kind_t;

struct pn_type;

/* A component of a product or record, in declared order; or a constructor of a union. */
typedef struct pn_field {
    const char *label;          /* record: the label; product: "1", "2", ...; union: the constructor */
    const struct pn_type *type; /* NULL: a constructor without argument */
    size_t offset;              /* in the struct */
    bool is_boxed;              /* union: the member is a pointer to the argument */
} pn_field_t;

/* What a record consists of after all its records have been taken apart, in order; and after its own parts a record
 * that is a subset. */
typedef struct pn_part {
    const struct pn_type *type;
    size_t offset; /* in the whole */
} pn_part_t;

typedef struct pn_type {
    pn_kind_t kind;
    const char *name; /* of the colour set */
    size_t size;      /* sizeof its C type */
    bool has_range;   /* INT: low..high; BIG: big_low..big_high; REAL: real_low..real_high; LIST: length low..high */
    bool is_index;    /* INT: a value of an index colour set: `name_of_value[0] (number)` */
    bool is_float32;  /* REAL: stored in single precision */
    bool is_narrow;   /* something in it is stored in single precision */
    bool is_tuple;    /* RECORD: printed as a JSON array; ENUM: a union of constants, printed as an array of one */
    int64_t low;
    int64_t high;
    pn_big_t big_low;
    pn_big_t big_high;
    double real_low;
    double real_high;
    bool has_chars; /* STRING: characters char_low..char_high */
    uint8_t char_low;
    uint8_t char_high;
    uint32_t count;          /* of fields, of names */
    const pn_field_t *field; /* RECORD, UNION */
    uint32_t part_count;
    const pn_part_t *part;            /* RECORD */
    const char *const *name_of_value; /* ENUM: constructors; UNIT, BOOL: as declared; INT with is_index: the stem */
    const struct pn_type *element;    /* LIST, REF */
    size_t head;                      /* LIST: offset of the head in a cell; the tail is first */
    size_t cell;                      /* LIST: size of a cell */
    bool (*member)(pn_ctx_t *cx, const void *value); /* SUBSET: further condition; NULL: none */
} pn_type_t;

/* -1, 0, 1 in the order of tokens: that of the colour set, where what is no number comes first and is like itself. */
int pn_compare(const pn_type_t *type, const void *a, const void *b);
/* Whether both are one token. */
bool pn_same(const pn_type_t *type, const void *a, const void *b);
/* As CPN ML compares: for `lt` what is no number is neither before nor after any; for `=` it is like nothing. */
int pn_order(const pn_type_t *type, const void *a, const void *b);
bool pn_equal(const pn_type_t *type, const void *a, const void *b);

/* As docs/trace.md writes it. */
void pn_json(const pn_type_t *type, const void *value, pn_text_t *out);
/* As the colour set's `mkstr` writes it: (~2), "a", {x=1,y=2}, [1,2], Ack(3). */
void pn_mkstr(const pn_type_t *type, const void *value, pn_text_t *out);
/* The same as a string in the arena. */
pn_string_t pn_mkstr_string(pn_ctx_t *cx, const pn_type_t *type, const void *value);

/* Whether the value is in the colour set: ranges, lengths, members of subsets, finite numbers where they are stored
 * narrowly. */
bool pn_is_legal(pn_ctx_t *cx, const pn_type_t *type, const void *value);
/* Raises PN_ERR_COLOUR, and says which value is not in which colour set; a long value is cut. With -DPN_FLAT_TYPES only
 * integers are said, other values would take recursion. */
void pn_raise_colour(pn_ctx_t *cx, const pn_type_t *type, const void *value);
/* Rounds what is stored in single precision, in place; lists are copied into the arena. PN_ERR_COLOUR if it is not
 * finite then. */
void pn_narrow(pn_ctx_t *cx, const pn_type_t *type, void *value);

/* Canonical bytes: appended at `out` if there is room; returns their number in any case. */
size_t pn_encode(const pn_type_t *type, const void *value, uint8_t *out, size_t room);
/* Reads them back; returns the number of bytes read, SIZE_MAX when they are malformed or the arena is full. */
size_t pn_decode(pn_ctx_t *cx, const pn_type_t *type, void *value, const uint8_t *in, size_t length);

/* Moves what the value refers to into the active half of the arena. */
void pn_relocate(pn_ctx_t *cx, const pn_type_t *type, void *value);

/* Number of values of a small colour set, 0 if it is not small (unbounded, or more than 2^32). */
uint64_t pn_type_size(const pn_type_t *type);
/* Value number `i` (0 <= i < size): the last component of products and records runs fastest. */
void pn_type_value(const pn_type_t *type, uint64_t i, void *value);
/* The number of a value: inverse of pn_type_value. */
uint64_t pn_type_position(const pn_type_t *type, const void *value);
/* Whether all numbers in a value of a small colour set are within their bounds; those of an index are not looked at. */
bool pn_type_has_position(const pn_type_t *type, const void *value);

/* Scalars: see pn_net.h. How many there are in a value; 0: no fixed number. */
uint32_t pn_scalar_count(const pn_type_t *type);
/* How an input file is laid out: a line for each component, if any is composed itself; otherwise one line for all. 0:
 * not at all. */
uint32_t pn_line_count(const pn_type_t *type);
uint32_t pn_line_scalars(const pn_type_t *type, uint32_t line);
/* How many scalars describe a message: a list is one, and those of an element; 0: no message can hold a value. */
uint32_t pn_message_scalars(const pn_type_t *type);
/* Number of scalars written, 0 if there are more than `capacity`, or no message can hold the value. */
uint32_t pn_to_scalars(const pn_type_t *type, const void *value, pn_scalar_value_t *scalar_value, uint32_t capacity);
/* A value from its scalars. False (PN_ERR_COLOUR) when kinds, numbers or ranges do not fit. */
bool pn_from_scalars(pn_ctx_t *cx, const pn_type_t *type, void *value, const pn_scalar_value_t *scalar_value,
                     uint32_t scalars);

/* A cell in the arena that holds a copy of a value; NULL when the arena is full. */
void *pn_ref_new(pn_ctx_t *cx, const void *value, size_t size);

/* Raises an exception that is a value of the union `type`, unless there already is an error; the name of one. */
void pn_raise_value(pn_ctx_t *cx, const pn_type_t *type, const void *exception);
pn_string_t pn_exception_name(const pn_type_t *type, const void *exception);

/* --- lists: cells { const cell *tail; element head; } ------------------------------------------------------------- */

/* The tail of a cell, and the address of its head. */
const void *pn_list_tail(const void *list);
const void *pn_list_head(const pn_type_t *type, const void *list);
/* A cell with uninitialised head and the tail set, NULL when the arena is full; fill `pn_list_slot` of it. */
void *pn_list_new(pn_ctx_t *cx, const pn_type_t *type, const void *tail);
void *pn_list_slot(const pn_type_t *type, void *cell);
/* head :: tail; tail itself when the arena is full. */
const void *pn_list_cons(pn_ctx_t *cx, const pn_type_t *type, const void *head, const void *tail);
int64_t pn_list_length(const void *list);
const void *pn_list_append(pn_ctx_t *cx, const pn_type_t *type, const void *first, const void *second);
const void *pn_list_reverse(pn_ctx_t *cx, const pn_type_t *type, const void *list);
/* reverse first @ second */
const void *pn_list_reverse_onto(pn_ctx_t *cx, const pn_type_t *type, const void *first, const void *second);
/* The cell of element i, from 0 (NULL with Subscript when there is none), of the first, of the last (NULL with Empty).
 */
const void *pn_list_nth_cell(pn_ctx_t *cx, const void *list, int64_t i);
const void *pn_list_first_cell(pn_ctx_t *cx, const void *list);
const void *pn_list_last_cell(pn_ctx_t *cx, const void *list);
/* All but the first; NULL with Empty. */
const void *pn_list_rest(pn_ctx_t *cx, const void *list);
/* The first n elements, and what is left after them; Subscript when there are fewer. */
const void *pn_list_take(pn_ctx_t *cx, const pn_type_t *type, const void *list, int64_t n);
const void *pn_list_drop(pn_ctx_t *cx, const void *list, int64_t n);
/* n copies of a value; none if n <= 0. */
const void *pn_list_copies(pn_ctx_t *cx, const pn_type_t *type, int64_t n, const void *value);
/* The elements of the elements; `type` is that of the inner lists. */
const void *pn_list_concat(pn_ctx_t *cx, const pn_type_t *type, const void *lists);
/* Number of elements equal to a value; whether there is one. */
int64_t pn_list_count(const pn_type_t *type, const void *list, const void *value);
bool pn_list_has(const pn_type_t *type, const void *list, const void *value);
/* Whether every element of the second is in the first. */
bool pn_list_contains(const pn_type_t *type, const void *larger, const void *smaller);
/* Whether all of a list of truth values are true. */
bool pn_list_all_true(const void *list);
/* Without the first, without every element that is equal to a value. */
const void *pn_list_remove(pn_ctx_t *cx, const pn_type_t *type, const void *list, const void *value);
const void *pn_list_remove_all(pn_ctx_t *cx, const pn_type_t *type, const void *list, const void *value);
/* Without duplicates: of each value the last occurrence stays. */
const void *pn_list_remdupl(pn_ctx_t *cx, const pn_type_t *type, const void *list);
/* Position of the first element equal to a value, from 0; Match. */
int64_t pn_list_position(pn_ctx_t *cx, const pn_type_t *type, const void *list, const void *value);
/* Strings and lists: concatenation of a string list, characters to string, string to characters. */
pn_string_t pn_string_join(pn_ctx_t *cx, const void *strings);
pn_string_t pn_string_implode(pn_ctx_t *cx, const void *chars);
const void *pn_string_explode(pn_ctx_t *cx, const pn_type_t *type, pn_string_t s);
/* Multi-sets are lists: equality, containment, difference (Subtract if not contained). */
bool pn_ms_equal(const pn_type_t *type, const void *a, const void *b);
bool pn_ms_contains(const pn_type_t *type, const void *larger, const void *smaller);
bool pn_ms_contains_strictly(const pn_type_t *type, const void *larger, const void *smaller);
const void *pn_ms_subtract(pn_ctx_t *cx, const pn_type_t *type, const void *a, const void *b);
const void *pn_ms_intersect(pn_ctx_t *cx, const pn_type_t *type, const void *a, const void *b);
/* n times the multi-set; empty if n <= 0. */
const void *pn_ms_times(pn_ctx_t *cx, const pn_type_t *type, int64_t n, const void *multiset);
/* The cell of the only element (NULL with no_singleton), of one at random (NULL with Empty). */
const void *pn_ms_only_cell(pn_ctx_t *cx, const void *multiset);
const void *pn_ms_random_cell(pn_ctx_t *cx, const void *multiset);

/* --- functions of a colour set ------------------------------------------------------------------------------------ */

/* CPN'Error when the colour set is not small, or there is no such value. `value` is filled in any case. */
int64_t pn_colset_size(pn_ctx_t *cx, const pn_type_t *type);
int64_t pn_colset_ord(pn_ctx_t *cx, const pn_type_t *type, const void *value);
void pn_colset_col(pn_ctx_t *cx, const pn_type_t *type, void *value, int64_t position);
void pn_colset_ran(pn_ctx_t *cx, const pn_type_t *type, void *value);
void pn_colset_base(pn_ctx_t *cx, const pn_type_t *type, void *value);
/* All values, in order, as a list with cells of `list`. */
const void *pn_colset_all(pn_ctx_t *cx, const pn_type_t *type, const pn_type_t *list);

#endif /* PN_TYPE_H */
