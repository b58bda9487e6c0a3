/* SPDX-License-Identifier: MIT
 * pn_big.h - IntInf.int: integers without limit.
 *
 * A number of up to 64 bits is kept as it is. A larger one is a sequence of bytes in the arena (or in a literal): a
 * header of four bytes, twice the number of digits, plus one if the number is negative; then the digits to the base
 * 2^32, the lowest first, each as four bytes, the lowest first. The highest digit is not zero, and what has up to 64
 * bits is never kept so: equal numbers are equal bytes. On error the value is 0; PN_ERR_MEMORY if a number is too large
 * for the arena, PN_ERR_ENDLESS if computing it would take too long.
 */
#ifndef PN_BIG_H
#define PN_BIG_H

#include "pn/pn_string.h"
#include "pn/pn_types.h"

typedef struct pn_big {
    int64_t small; /* the number where `large` is NULL, else 0 */
    const uint8_t *large;
} pn_big_t;

/* A number of up to 64 bits; one of the bytes of a string literal. */
#define PN_BIG(number)      ((pn_big_t){ (number), NULL })
#define PN_BIG_BYTES(bytes) ((pn_big_t){ 0, (const uint8_t *)(bytes) })

/* The same as initialisers of static variables. */
#define PN_BIG_INIT(number)      { (number), NULL }
#define PN_BIG_INIT_BYTES(bytes) { 0, (const uint8_t *)(bytes) }

/* The bytes of a large number, header included. */
size_t pn_big_size(const uint8_t *large);
/* Whether `length` bytes are a large number as described above. */
bool pn_big_is_valid(const uint8_t *bytes, size_t length);
/* A copy whose digits are in the arena. */
pn_big_t pn_big_copy(pn_ctx_t *cx, pn_big_t a);

static inline pn_big_t pn_big_of(int64_t number)
{
    return PN_BIG(number);
}

static inline pn_big_t pn_big_step(const pn_ctx_t *cx)
{
    return PN_BIG((int64_t)cx->step);
}

/* As `int` of 31 bits and of 64 bits: Overflow; as a model time: PN_ERR_LARGE. */
int64_t pn_big_to_int(pn_ctx_t *cx, pn_big_t a);
int64_t pn_big_to_wide(pn_ctx_t *cx, pn_big_t a);
int64_t pn_big_to_time(pn_ctx_t *cx, pn_big_t a);
/* The nearest real, infinite where that is too large. */
double pn_big_to_real(pn_big_t a);
/* Without its fraction; Domain for nan, Overflow for what is infinite. */
pn_big_t pn_big_of_real(pn_ctx_t *cx, double x);

pn_big_t pn_big_sum(pn_ctx_t *cx, pn_big_t a, pn_big_t b);
pn_big_t pn_big_difference(pn_ctx_t *cx, pn_big_t a, pn_big_t b);

static inline pn_big_t pn_big_add(pn_ctx_t *cx, pn_big_t a, pn_big_t b)
{
    const bool is_near = (a.large == NULL) && (b.large == NULL) && (a.small < (INT64_MAX / 2))
                         && (a.small > (INT64_MIN / 2)) && (b.small < (INT64_MAX / 2)) && (b.small > (INT64_MIN / 2));
    return is_near ? PN_BIG(a.small + b.small) : pn_big_sum(cx, a, b);
}

static inline pn_big_t pn_big_sub(pn_ctx_t *cx, pn_big_t a, pn_big_t b)
{
    const bool is_near = (a.large == NULL) && (b.large == NULL) && (a.small < (INT64_MAX / 2))
                         && (a.small > (INT64_MIN / 2)) && (b.small < (INT64_MAX / 2)) && (b.small > (INT64_MIN / 2));
    return is_near ? PN_BIG(a.small - b.small) : pn_big_difference(cx, a, b);
}

pn_big_t pn_big_mul(pn_ctx_t *cx, pn_big_t a, pn_big_t b);
/* Rounded down; towards zero; Div. */
pn_big_t pn_big_div(pn_ctx_t *cx, pn_big_t a, pn_big_t b);
pn_big_t pn_big_mod(pn_ctx_t *cx, pn_big_t a, pn_big_t b);
pn_big_t pn_big_quot(pn_ctx_t *cx, pn_big_t a, pn_big_t b);
pn_big_t pn_big_rem(pn_ctx_t *cx, pn_big_t a, pn_big_t b);
pn_big_t pn_big_neg(pn_ctx_t *cx, pn_big_t a);
pn_big_t pn_big_abs(pn_ctx_t *cx, pn_big_t a);

/* -1, 0, 1. */
int64_t pn_big_sign(pn_big_t a);
int pn_big_order_large(pn_big_t a, pn_big_t b);
static inline int pn_big_order(pn_big_t a, pn_big_t b)
{
    if ((a.large == NULL) && (b.large == NULL)) {
        return (a.small > b.small) - (a.small < b.small);
    }
    return pn_big_order_large(a, b);
}

static inline bool pn_big_equal(pn_big_t a, pn_big_t b)
{
    return pn_big_order(a, b) == 0;
}

static inline pn_big_t pn_big_min(pn_big_t a, pn_big_t b)
{
    return (pn_big_order(a, b) > 0) ? b : a;
}

static inline pn_big_t pn_big_max(pn_big_t a, pn_big_t b)
{
    return (pn_big_order(a, b) < 0) ? b : a;
}

/* Bitwise, in two's complement. */
pn_big_t pn_big_and(pn_ctx_t *cx, pn_big_t a, pn_big_t b);
pn_big_t pn_big_or(pn_ctx_t *cx, pn_big_t a, pn_big_t b);
pn_big_t pn_big_xor(pn_ctx_t *cx, pn_big_t a, pn_big_t b);
pn_big_t pn_big_not(pn_ctx_t *cx, pn_big_t a);
/* a * 2^n and a div 2^n, n >= 0. */
pn_big_t pn_big_shift_left(pn_ctx_t *cx, pn_big_t a, int64_t n);
pn_big_t pn_big_shift_right(pn_ctx_t *cx, pn_big_t a, int64_t n);

/* The number of these decimal digits. */
pn_big_t pn_big_of_digits(pn_ctx_t *cx, const char *digits, size_t length, bool is_negative);
/* In decimal, with `minus` in front of what is negative: at most `capacity` bytes, the terminator included. The length;
 * SIZE_MAX where there is no room. */
size_t pn_big_decimal(pn_big_t a, char minus, char *out, size_t capacity);
/* As CPN ML writes it. */
pn_string_t pn_big_string(pn_ctx_t *cx, pn_big_t a);

/* A number from 0 to n - 1; n has up to 64 bits. */
pn_big_t pn_big_random_below(pn_ctx_t *cx, pn_big_t n);

#endif /* PN_BIG_H */
