/* SPDX-License-Identifier: MIT */
#include "pn/pn_library.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pn/pn_arena.h"
#include "pn/pn_num.h"

void pn_stop(pn_ctx_t *cx, pn_string_t text)
{
    pn_raise(cx, PN_ERR_UNSUPPORTED, text.bytes);
}

int64_t pn_real_exponent(double x)
{
    int exponent = 0;
    (void)frexp(x, &exponent);
    return exponent;
}

double pn_real_scale(double x, int64_t n)
{
    const int64_t most = 5000; /* beyond that everything is zero or infinite */
    const int64_t cut = (n > most) ? most : ((n < -most) ? -most : n);
    return ldexp(x, (int)cut);
}

double pn_real_next(double x, double towards)
{
    return nextafter(x, towards);
}

double pn_real_fused(double a, double b, double c)
{
    const double product = a * b;
    return product + c;
}

bool pn_real_sign_bit(double x)
{
    /* What is no number has the bit, as processors make it; what folds constants may not. */
    return (isnan(x) != 0) || (signbit(x) != 0);
}

double pn_real_copy_sign(double x, double sign)
{
    return copysign(x, pn_real_sign_bit(sign) ? -1.0 : 1.0);
}

bool pn_real_is_normal(double x)
{
    return isnormal(x) != 0;
}

/* --- texts -------------------------------------------------------------------------------------------------------- */

double pn_real_read(pn_string_t text)
{
    return strtod(text.bytes, NULL); /* arena strings and literals end with a zero */
}

/* A number as printf writes it in the notation of CPN ML: ~ for minus, E without plus sign and leading zeros. */
static pn_string_t in_sml(pn_ctx_t *cx, char *text)
{
    size_t n = 0U;
    for (const char *at = text; *at != '\0'; at++) {
        if (*at == '-') {
            text[n++] = '~';
        } else if (*at == 'e') {
            text[n++] = 'E';
            at++;
            if (*at == '-') {
                text[n++] = '~';
            }
            while ((at[1] == '0') && (at[2] != '\0')) {
                at++;
            }
        } else {
            text[n++] = *at;
        }
    }
    return pn_string_make(cx, text, n);
}

/* General notation as SML/NJ has it: so many significant digits without trailing zeros, but for one behind the point;
 * with an exponent of two digits at least when that is below -4 or not below the number of digits. */
static pn_string_t general(pn_ctx_t *cx, int64_t digits, double x, char *text, size_t size)
{
    (void)snprintf(text, size, "%.*e", (int)digits - 1, x);
    char *e = strchr(text, 'e');
    const int64_t exponent = (e != NULL) ? strtol(e + 1, NULL, 10) : 0;
    const bool is_scientific = (exponent < -4) || (exponent >= digits);
    if (is_scientific && (e != NULL)) {
        *e = '\0';
    } else {
        (void)snprintf(text, size, "%.*f", (int)(digits - 1 - exponent), x);
    }
    size_t end = strlen(text);
    if (memchr(text, '.', end) != NULL) {
        while (text[end - 1U] == '0') {
            end--;
        }
        if (text[end - 1U] == '.') {
            end--;
        }
        text[end] = '\0';
    }
    if (is_scientific) {
        (void)snprintf(&text[end], size - end, "E%s%02d", (exponent < 0) ? "~" : "", abs((int)exponent));
    } else if (memchr(text, '.', end) == NULL) {
        (void)snprintf(&text[end], size - end, ".0");
    }
    return in_sml(cx, text);
}

/* 0.d1d2...E<exponent>, the shortest digits that give the number back. */
static pn_string_t exact(pn_ctx_t *cx, double x, char *text, size_t size)
{
    char digits[32] = "0";
    for (int precision = 0; precision < 17; precision++) {
        (void)snprintf(digits, sizeof digits, "%.*e", precision, fabs(x));
        if (pn_real_equal(strtod(digits, NULL), fabs(x))) {
            break;
        }
    }
    const char *e = strchr(digits, 'e');
    const long exponent = strtol(e + 1, NULL, 10) + 1;
    size_t n = (size_t)snprintf(text, size, "%s0.", signbit(x) ? "~" : "");
    for (const char *at = digits; *at != 'e'; at++) {
        if (*at != '.') {
            text[n++] = *at;
        }
    }
    text[n] = '\0';
    if (exponent != 0) {
        (void)snprintf(&text[n], size - n, "E%s%ld", (exponent < 0) ? "~" : "", labs(exponent));
    }
    return pn_string_make(cx, text, strlen(text));
}

pn_string_t pn_real_styled(pn_ctx_t *cx, int64_t style, int64_t digits, double x)
{
    if (isnan(x)) {
        return PN_STRING("nan");
    }
    if (isinf(x)) {
        return (x < 0.0) ? PN_STRING("~inf") : PN_STRING("inf");
    }
    char text[1600];           /* the largest number has 309 digits in front of the point */
    const int64_t most = 1100; /* all further ones are zeros: Real.sml appends them */
    const int places = (int)((digits > most) ? most : digits);
    if (pn_real_equal(x, 0.0)) {
        x = 0.0; /* zero has no sign */
    }
    switch (style) {
    case 0: (void)snprintf(text, sizeof text, "%.*e", places, x); return in_sml(cx, text);
    case 1: (void)snprintf(text, sizeof text, "%.*f", places, x); return in_sml(cx, text);
    case 2: return general(cx, places, x, text, sizeof text);
    default:
        if (pn_real_equal(x, 0.0)) {
            return PN_STRING("0.0");
        }
        return exact(cx, x, text, sizeof text);
    }
}
