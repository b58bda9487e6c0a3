/* SPDX-License-Identifier: MIT */
#include "pn/pn_num.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pn/pn_text.h"

const char *pn_error_name(pn_error_t error)
{
    switch (error) {
    case PN_OK: return "no error";
    case PN_ERR_OVERFLOW: return "Overflow";
    case PN_ERR_DIV: return "Div";
    case PN_ERR_MATCH: return "Match";
    case PN_ERR_BIND: return "Bind";
    case PN_ERR_SUBSCRIPT: return "Subscript";
    case PN_ERR_EMPTY: return "Empty";
    case PN_ERR_DOMAIN: return "Domain";
    case PN_ERR_COLOUR: return "colour outside its colour set";
    case PN_ERR_CAPACITY: return "place is full";
    case PN_ERR_MEMORY: return "memory for lists and strings is full";
    case PN_ERR_DEPTH: return "recursion too deep";
    case PN_ERR_SUBTRACT: return "Subtract";
    case PN_ERR_RAISED: return "exception of the net";
    case PN_ERR_ENDLESS: return "an evaluation without end";
    case PN_ERR_LARGE: return "a model time beyond 64 bits";
    case PN_ERR_UNSUPPORTED: return "a function that is not available here";
    case PN_ERR_INTERNAL: return "internal error";
    default: return "unknown error";
    }
}

void pn_raise(pn_ctx_t *cx, pn_error_t error, const char *name)
{
    if (cx->error == PN_OK) {
        cx->error = error;
        cx->error_name = (name != NULL) ? name : pn_error_name(error);
        cx->error_origin = cx->origin;
        cx->exception = NULL;
    }
}

bool pn_is_exception(const pn_ctx_t *cx)
{
    switch (cx->error) {
    case PN_ERR_OVERFLOW:
    case PN_ERR_DIV:
    case PN_ERR_MATCH:
    case PN_ERR_BIND:
    case PN_ERR_SUBSCRIPT:
    case PN_ERR_EMPTY:
    case PN_ERR_DOMAIN:
    case PN_ERR_SUBTRACT:
    case PN_ERR_RAISED: return true;
    case PN_OK:
    case PN_ERR_COLOUR:
    case PN_ERR_CAPACITY:
    case PN_ERR_MEMORY:
    case PN_ERR_DEPTH:
    case PN_ERR_ENDLESS:
    case PN_ERR_LARGE:
    case PN_ERR_UNSUPPORTED:
    case PN_ERR_INTERNAL:
    default: return false;
    }
}

bool pn_is_raised(const pn_ctx_t *cx, const char *name)
{
    return pn_is_exception(cx) && (strcmp(cx->error_name, name) == 0);
}

void pn_clear_error(pn_ctx_t *cx)
{
    cx->error = PN_OK;
    cx->error_name = "";
    cx->error_origin = "";
    cx->exception = NULL;
}

/* --- integers ----------------------------------------------------------------------------------------------------- */

int64_t pn_int_overflow(pn_ctx_t *cx)
{
    pn_raise(cx, PN_ERR_OVERFLOW, NULL);
    return 0;
}

int64_t pn_int_quot(pn_ctx_t *cx, int64_t a, int64_t b)
{
    return pn_int_checked(cx, pn_wide_quot(cx, a, b));
}

int64_t pn_int_rem(pn_ctx_t *cx, int64_t a, int64_t b)
{
    return pn_wide_rem(cx, a, b);
}

/* 64-bit arithmetic; `error` is raised for what has more bits. */

static int64_t beyond(pn_ctx_t *cx, pn_error_t error)
{
    pn_raise(cx, error, NULL);
    return 0;
}

static int64_t add(pn_ctx_t *cx, int64_t a, int64_t b, pn_error_t error)
{
    if ((b > 0) ? (a > (INT64_MAX - b)) : (a < (INT64_MIN - b))) {
        return beyond(cx, error);
    }
    return a + b;
}

static int64_t subtract(pn_ctx_t *cx, int64_t a, int64_t b)
{
    if ((b > 0) ? (a < (INT64_MIN + b)) : (a > (INT64_MAX + b))) {
        return beyond(cx, PN_ERR_OVERFLOW);
    }
    return a - b;
}

static int64_t multiply(pn_ctx_t *cx, int64_t a, int64_t b)
{
    bool fits = true;
    if ((a > 0) && (b > 0)) {
        fits = a <= (INT64_MAX / b);
    } else if ((a > 0) && (b < 0)) {
        fits = b >= (INT64_MIN / a);
    } else if ((a < 0) && (b > 0)) {
        fits = a >= (INT64_MIN / b);
    } else if (a < 0) {
        fits = b >= (INT64_MAX / a);
    }
    return fits ? (a * b) : beyond(cx, PN_ERR_OVERFLOW);
}

static int64_t negate(pn_ctx_t *cx, int64_t a)
{
    return (a == INT64_MIN) ? beyond(cx, PN_ERR_OVERFLOW) : -a;
}

static int64_t quotient(pn_ctx_t *cx, int64_t a, int64_t b)
{
    if (b == 0) {
        return beyond(cx, PN_ERR_DIV);
    }
    return (b == -1) ? negate(cx, a) : (a / b);
}

static int64_t divide(pn_ctx_t *cx, int64_t a, int64_t b)
{
    const int64_t towards_zero = quotient(cx, a, b);
    const bool is_inexact = (b != 0) && (b != -1) && ((a % b) != 0);
    return (is_inexact && ((a < 0) != (b < 0))) ? (towards_zero - 1) : towards_zero;
}

int64_t pn_wide_rem(pn_ctx_t *cx, int64_t a, int64_t b)
{
    if (b == 0) {
        return beyond(cx, PN_ERR_DIV);
    }
    return (b == -1) ? 0 : (a % b);
}

int64_t pn_wide_mod(pn_ctx_t *cx, int64_t a, int64_t b)
{
    const int64_t remainder = pn_wide_rem(cx, a, b);
    return ((remainder != 0) && ((remainder < 0) != (b < 0))) ? (remainder + b) : remainder;
}

int64_t pn_time_sum(pn_ctx_t *cx, int64_t a, int64_t b)
{
    return add(cx, a, b, PN_ERR_LARGE);
}

int64_t pn_wide_add(pn_ctx_t *cx, int64_t a, int64_t b)
{
    return add(cx, a, b, PN_ERR_OVERFLOW);
}

int64_t pn_wide_sub(pn_ctx_t *cx, int64_t a, int64_t b)
{
    return subtract(cx, a, b);
}

int64_t pn_wide_mul(pn_ctx_t *cx, int64_t a, int64_t b)
{
    return multiply(cx, a, b);
}

int64_t pn_wide_quot(pn_ctx_t *cx, int64_t a, int64_t b)
{
    return quotient(cx, a, b);
}

int64_t pn_wide_div(pn_ctx_t *cx, int64_t a, int64_t b)
{
    return divide(cx, a, b);
}

int64_t pn_wide_neg(pn_ctx_t *cx, int64_t a)
{
    return negate(cx, a);
}

int64_t pn_wide_abs(pn_ctx_t *cx, int64_t a)
{
    return (a < 0) ? negate(cx, a) : a;
}

/* --- reals -------------------------------------------------------------------------------------------------------- */

double pn_real_round_even(double x)
{
    const double below = floor(x);
    const double rest = x - below;
    const bool is_up = (rest > 0.5) || ((rest >= 0.5) && (fabs(fmod(below, 2.0)) >= 1.0));
    return is_up ? (below + 1.0) : below;
}

/* What C rounds to a negative zero is a zero without a sign. */
static double unsigned_zero(double x, double whole)
{
    return (fabs(x) > 0.0) ? (whole + 0.0) : x;
}

double pn_ceil(double x)
{
    return unsigned_zero(x, ceil(x));
}

/* A zero, too, loses its sign there. */
double pn_trunc(double x)
{
    return trunc(x) + 0.0;
}

/* Where nothing remains, the zero has the sign of the divisor. */
double pn_real_rem(double a, double b)
{
    const double rest = fmod(a, b);
    return (fpclassify(rest) == FP_ZERO) ? copysign(0.0, b) : rest;
}

static int64_t to_integer(pn_ctx_t *cx, double x)
{
    if (isnan(x)) {
        return beyond(cx, PN_ERR_DOMAIN);
    }
    if ((x < -9223372036854775808.0) || (x >= 9223372036854775808.0)) {
        return beyond(cx, PN_ERR_OVERFLOW);
    }
    return (int64_t)x;
}

int64_t pn_wide_floor(pn_ctx_t *cx, double x)
{
    return to_integer(cx, floor(x));
}

int64_t pn_real_floor(pn_ctx_t *cx, double x)
{
    return pn_int_checked(cx, pn_wide_floor(cx, x));
}

/* As SML/NJ has it: its sum rounds, so that 3.0000000000000004 is 3 and 1E~20 is 0. */
int64_t pn_wide_ceil(pn_ctx_t *cx, double x)
{
    return -1 - to_integer(cx, floor(-1.0 - x));
}

int64_t pn_real_ceil(pn_ctx_t *cx, double x)
{
    return pn_int_checked(cx, pn_wide_ceil(cx, x));
}

int64_t pn_wide_round(pn_ctx_t *cx, double x)
{
    return to_integer(cx, pn_real_round_even(x));
}

int64_t pn_real_round(pn_ctx_t *cx, double x)
{
    return pn_int_checked(cx, pn_wide_round(cx, x));
}

int64_t pn_wide_trunc(pn_ctx_t *cx, double x)
{
    return to_integer(cx, trunc(x));
}

int64_t pn_real_trunc(pn_ctx_t *cx, double x)
{
    return pn_int_checked(cx, pn_wide_trunc(cx, x));
}

double pn_real_min(double a, double b)
{
    return ((a < b) || isnan(b)) ? a : b;
}

double pn_real_max(double a, double b)
{
    return ((a > b) || isnan(b)) ? a : b;
}

int64_t pn_real_sign(pn_ctx_t *cx, double x)
{
    if (isnan(x)) {
        pn_raise(cx, PN_ERR_DOMAIN, NULL);
    }
    return (x > 0.0) ? 1 : ((x < 0.0) ? -1 : 0);
}

int pn_real_compare(pn_ctx_t *cx, double a, double b)
{
    if (isnan(a) || isnan(b)) {
        pn_raise(cx, PN_ERR_DOMAIN, "Unordered");
    }
    return pn_real_order(a, b);
}

double pn_real_power(double a, double b)
{
    /* C has 1.0 for 1.0 to any power, and for -1.0 to an infinite one. */
    return (isnan(b) || (isinf(b) && pn_real_equal(fabs(a), 1.0))) ? (double)NAN : pow(a, b);
}

bool pn_real_is_nan(double x)
{
    return isnan(x) != 0;
}

bool pn_real_is_finite(double x)
{
    return isfinite(x) != 0;
}

int pn_real_order(double a, double b)
{
    if (isnan(a) || isnan(b)) {
        return (isnan(b) ? 1 : 0) - (isnan(a) ? 1 : 0);
    }
    return (a > b) - (a < b);
}

/* The reals in their order as integers, and back. */
static int64_t real_rank(double x)
{
    int64_t bits = 0;
    (void)memcpy(&bits, &x, sizeof bits);
    return (bits >= 0) ? bits : (INT64_MIN - bits);
}

static double real_of_rank(int64_t rank)
{
    const int64_t bits = (rank >= 0) ? rank : (INT64_MIN - rank);
    double x = 0.0;
    (void)memcpy(&x, &bits, sizeof x);
    return x;
}

double pn_real_latest(double now, double early)
{
    const double most = (double)INFINITY;
    if (isnan(early) || isnan(now) || !((-most - early) <= now)) {
        return -most;
    }
    if ((most - early) <= now) {
        return most;
    }
    /* stamp - early grows with the stamp: the first rank is one of those accepted, the last is not. */
    int64_t first = real_rank(-most);
    int64_t last = real_rank(most);
    const double guess = now + early;
    if (isfinite(guess)) {
        /* nearly always it is this one */
        const int64_t rank = real_rank(guess);
        if ((guess - early) <= now) {
            first = rank;
            last = ((real_of_rank(rank + 1) - early) <= now) ? last : (rank + 1);
        } else {
            last = rank;
            first = ((real_of_rank(rank - 1) - early) <= now) ? (rank - 1) : first;
        }
    }
    while ((last - 1) > first) {
        const int64_t middle = (first & last) + ((first ^ last) >> 1);
        if ((real_of_rank(middle) - early) <= now) {
            first = middle;
        } else {
            last = middle;
        }
    }
    return real_of_rank(first);
}

/* The shortest digits that read back to x > 0: 15 digits always come back from decimal, 17 from binary; below the
 * normal range fewer than 15 may do. Gives d.ddd...e[+-]xx as printf writes it. */
static void shortest_digits(char *out, double x)
{
    const int least = (x < 2.2250738585072014e-308) ? 0 : 14;
    for (int digits = least; digits <= 16; digits++) {
        (void)snprintf(out, PN_REAL_TEXT_SIZE, "%.*e", digits, x);
        if (pn_real_equal(strtod(out, NULL), x)) {
            return;
        }
    }
}

size_t pn_real_repr(char *out, double x)
{
    if (isnan(x) || isinf(x)) {
        (void)strcpy(out, isnan(x) ? "nan" : ((x < 0.0) ? "-inf" : "inf"));
        return strlen(out);
    }
    size_t n = 0U;
    if (signbit(x)) {
        out[n++] = '-';
    }
    char scientific[PN_REAL_TEXT_SIZE] = "0e+00";
    if (pn_real_order(x, 0.0) != 0) {
        shortest_digits(scientific, fabs(x));
    }
    /* Split "d.ddde-xx" into its digits, without trailing zeros, and its exponent. */
    char digit[PN_REAL_TEXT_SIZE];
    int count = 0;
    const char *at = scientific;
    for (; *at != 'e'; at++) {
        if (*at != '.') {
            digit[count++] = *at;
        }
    }
    while ((count > 1) && (digit[count - 1] == '0')) {
        count--;
    }
    const int exponent = (int)strtol(at + 1, NULL, 10);

    if ((exponent < -4) || (exponent >= 16)) {
        out[n++] = digit[0];
        if (count > 1) {
            out[n++] = '.';
            (void)memcpy(&out[n], &digit[1], (size_t)count - 1U);
            n += (size_t)count - 1U;
        }
        n += (size_t)snprintf(&out[n], PN_REAL_TEXT_SIZE - n, "e%c%02d", (exponent < 0) ? '-' : '+', abs(exponent));
        return n;
    }
    if (exponent < 0) {
        out[n++] = '0';
        out[n++] = '.';
        for (int i = -1; i > exponent; i--) {
            out[n++] = '0';
        }
        (void)memcpy(&out[n], digit, (size_t)count);
        n += (size_t)count;
    } else {
        for (int i = 0; (i < count) || (i <= exponent); i++) {
            out[n++] = (i < count) ? digit[i] : '0';
            if (i == exponent) {
                out[n++] = '.';
            }
        }
        if (count <= (exponent + 1)) {
            out[n++] = '0';
        }
    }
    out[n] = '\0';
    return n;
}
