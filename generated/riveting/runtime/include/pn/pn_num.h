/* SPDX-License-Identifier: MIT
 * pn_num.h - numbers of CPN ML: checked integers, real functions.
 *
 * `int` is the 31-bit integer of the real tool, kept in an int64_t; what does not fit is reported, not wrapped. `div`
 * and `mod` round down, `quot` and `rem` toward zero. On error the value is 0.
 */
#ifndef PN_NUM_H
#define PN_NUM_H

#include "pn/pn_types.h"

#define PN_INT_MIN (-INT64_C(1073741824))
#define PN_INT_MAX INT64_C(1073741823)

/* Notes an error unless there already is one. `name` is the exception's name; NULL: that of the error. */
void pn_raise(pn_ctx_t *cx, pn_error_t error, const char *name);
/* The name CPN ML gives an error ("Overflow", "Div", ...). */
const char *pn_error_name(pn_error_t error);

static inline bool pn_ok(const pn_ctx_t *cx)
{
    return cx->error == PN_OK;
}

/* Finds out how deep the recursion may be: as deep as the stack of the calling thread, which is made larger if
 * possible; PN_DEPTH_MAX calls where the system says nothing. Called by pn_ctx_init. */
void pn_stack_init(pn_ctx_t *cx);

/* Begins a call of a recursive function: false when an error is set or the recursion is too deep (PN_ERR_DEPTH). */
#ifndef PN_DEPTH_MAX
#define PN_DEPTH_MAX 10000U
#endif
static inline bool pn_is_deep(const pn_ctx_t *cx)
{
#if defined(__GNUC__)
    if (cx->stack_limit != 0U) {
        return (uintptr_t)__builtin_frame_address(0) < cx->stack_limit;
    }
#endif
    return cx->depth >= PN_DEPTH_MAX;
}

/* Begins a round of a loop or of a recursion: false when an error is set, or after so many rounds that the evaluation
 * of an inscription is taken to have no end (PN_ERR_ENDLESS; some seconds). */
#ifndef PN_ROUNDS_MAX
#define PN_ROUNDS_MAX UINT64_C(1000000000)
#endif
static inline bool pn_goes_on(pn_ctx_t *cx)
{
    cx->rounds++;
    if (cx->rounds > PN_ROUNDS_MAX) {
        pn_raise(cx, PN_ERR_ENDLESS, NULL);
    }
    return cx->error == PN_OK;
}

static inline bool pn_enter(pn_ctx_t *cx)
{
    if (pn_is_deep(cx)) {
        pn_raise(cx, PN_ERR_DEPTH, NULL);
    }
    if (!pn_goes_on(cx)) {
        return false;
    }
    cx->depth++;
    return true;
}
/* Ends it; only after pn_enter was true. */
static inline void pn_leave(pn_ctx_t *cx)
{
    cx->depth--;
}

/* Whether the error is an exception of CPN ML that a handler may catch, and whether it has this name. */
bool pn_is_exception(const pn_ctx_t *cx);
bool pn_is_raised(const pn_ctx_t *cx, const char *name);
/* The exception has been handled. */
void pn_clear_error(pn_ctx_t *cx);

#define PN_PI 3.141592653589793
#define PN_E  2.718281828459045

/* Integers: `int` has 31 bits (pn_int_*), or 64 (pn_wide_*) in nets generated so; beyond them Overflow is raised. Model
 * time has 64 bits, beyond which is PN_ERR_LARGE, that no handler catches. IntInf.int has no limit: see pn_big.h. */
#define PN_INT_MAX INT64_C(1073741823)
#define PN_INT_MIN (-INT64_C(1073741824))

/* Raises Overflow. */
int64_t pn_int_overflow(pn_ctx_t *cx);
/* The value if it is in the 31-bit range; else Overflow. */
static inline int64_t pn_int_checked(pn_ctx_t *cx, int64_t value)
{
    return ((value <= PN_INT_MAX) && (value >= PN_INT_MIN)) ? value : pn_int_overflow(cx);
}

static inline int64_t pn_step(const pn_ctx_t *cx)
{
    return (int64_t)cx->step;
}

static inline int64_t pn_int_add(pn_ctx_t *cx, int64_t a, int64_t b)
{
    return pn_int_checked(cx, a + b);
}

static inline int64_t pn_int_sub(pn_ctx_t *cx, int64_t a, int64_t b)
{
    return pn_int_checked(cx, a - b);
}

static inline int64_t pn_int_mul(pn_ctx_t *cx, int64_t a, int64_t b)
{
    return pn_int_checked(cx, a * b);
}

static inline int64_t pn_int_neg(pn_ctx_t *cx, int64_t a)
{
    return pn_int_checked(cx, -a);
}

static inline int64_t pn_int_abs(pn_ctx_t *cx, int64_t a)
{
    return pn_int_checked(cx, (a < 0) ? -a : a);
}

static inline int64_t pn_int_min(int64_t a, int64_t b)
{
    return (a < b) ? a : b;
}

static inline int64_t pn_int_max(int64_t a, int64_t b)
{
    return (a > b) ? a : b;
}

static inline int64_t pn_int_sign(int64_t a)
{
    return (a > 0) ? 1 : ((a < 0) ? -1 : 0);
}

int64_t pn_int_quot(pn_ctx_t *cx, int64_t a, int64_t b);
int64_t pn_int_rem(pn_ctx_t *cx, int64_t a, int64_t b);

int64_t pn_wide_add(pn_ctx_t *cx, int64_t a, int64_t b);
int64_t pn_wide_sub(pn_ctx_t *cx, int64_t a, int64_t b);
int64_t pn_wide_mul(pn_ctx_t *cx, int64_t a, int64_t b);
int64_t pn_wide_neg(pn_ctx_t *cx, int64_t a);
int64_t pn_wide_abs(pn_ctx_t *cx, int64_t a);
int64_t pn_wide_div(pn_ctx_t *cx, int64_t a, int64_t b);
int64_t pn_wide_quot(pn_ctx_t *cx, int64_t a, int64_t b);
int64_t pn_wide_mod(pn_ctx_t *cx, int64_t a, int64_t b);
int64_t pn_wide_rem(pn_ctx_t *cx, int64_t a, int64_t b);
/* The sum of two model times; PN_ERR_LARGE. */
int64_t pn_time_sum(pn_ctx_t *cx, int64_t a, int64_t b);

/* Whether 0 <= a and 0 < b, both below 2^32: then unsigned division gives the same, several times as fast. */
static inline bool pn_is_narrow(int64_t a, int64_t b)
{
    return ((((uint64_t)a | (uint64_t)b) >> 32U) == 0U) && (b != 0);
}

static inline int64_t pn_int_div(pn_ctx_t *cx, int64_t a, int64_t b)
{
    return pn_int_checked(cx, pn_is_narrow(a, b) ? (int64_t)((uint32_t)a / (uint32_t)b) : pn_wide_div(cx, a, b));
}

static inline int64_t pn_int_mod(pn_ctx_t *cx, int64_t a, int64_t b)
{
    return pn_is_narrow(a, b) ? (int64_t)((uint32_t)a % (uint32_t)b) : pn_wide_mod(cx, a, b);
}

static inline double pn_int_to_real(int64_t a)
{
    return (double)a;
}

/* Rounding to `int`: Overflow outside the 31-bit range, Domain for nan. `round` goes to the even neighbour at a half.
 */
int64_t pn_real_floor(pn_ctx_t *cx, double x);
int64_t pn_real_ceil(pn_ctx_t *cx, double x);
int64_t pn_real_round(pn_ctx_t *cx, double x);
int64_t pn_real_trunc(pn_ctx_t *cx, double x);
/* Rounds a half to even, as a real. */
double pn_real_round_even(double x);
/* Rounds up and towards zero, as reals; a zero has the sign of `x` only if that is zero, too. */
double pn_ceil(double x);
double pn_trunc(double x);
/* The same to 64-bit integers. */
int64_t pn_wide_floor(pn_ctx_t *cx, double x);
int64_t pn_wide_ceil(pn_ctx_t *cx, double x);
int64_t pn_wide_round(pn_ctx_t *cx, double x);
int64_t pn_wide_trunc(pn_ctx_t *cx, double x);

double pn_real_rem(double a, double b);

/* Real.min and Real.max: the other argument if one is nan, the second if they are equal. */
double pn_real_min(double a, double b);
double pn_real_max(double a, double b);
/* -1, 0, 1; Unordered for nan. */
int pn_real_compare(pn_ctx_t *cx, double a, double b);
/* Math.pow: not a number where the exponent is none, and for 1.0 and -1.0 to an infinite power. */
double pn_real_power(double a, double b);
/* -1, 0, 1; Domain for nan. */
int64_t pn_real_sign(pn_ctx_t *cx, double x);
/* IEEE comparisons; functions because -Wfloat-equal is on in some projects that take this code over. */
static inline bool pn_real_equal(double a, double b)
{
    return (a <= b) && (a >= b);
}

bool pn_real_is_nan(double x);
bool pn_real_is_finite(double x);

/* Shortest decimal that reads back to the same double, as Python's repr writes it; `out` has PN_REAL_TEXT_SIZE bytes.
 * Returns the length. */
size_t pn_real_repr(char *out, double x);

/* -1, 0, 1 in the order of colour sets: nan before every number, 0.0 and -0.0 equal. */
int pn_real_order(double a, double b);
/* The latest stamp with stamp - early <= now, as these are computed: what an input arc with a delay accepts. */
double pn_real_latest(double now, double early);
static inline int pn_int_order(int64_t a, int64_t b)
{
    return (a > b) - (a < b);
}

#endif /* PN_NUM_H */
