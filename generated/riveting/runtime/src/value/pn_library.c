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

/* So many characters at the end of a text. */
static size_t filled(char *text, size_t length, char c, int64_t count)
{
    for (int64_t n = 0; n < count; n++) {
        text[length++] = c;
    }
    return length;
}

/* So many digits behind the point; zeros behind those that SML/NJ finds. */
static size_t fixed(char *text, size_t length, double x, int64_t places)
{
    char digit[PN_REAL_DIGITS + 2] = "0";
    int exponent = 0;
    const int count = pn_real_equal(x, 0.0) ? 1 : pn_real_digits(x, places, true, digit, &exponent);
    const int before = (exponent < 0) ? -exponent : 0; /* zeros in front of the digits */
    const int64_t whole = (exponent > 0) ? (exponent + 1) : 1;
    for (int64_t n = 0; n < (whole + places); n++) {
        if (n == whole) {
            text[length++] = '.';
        }
        text[length++] = ((n >= before) && ((n - before) < count)) ? digit[n - before] : '0';
    }
    return length;
}

/* So many digits behind the point and an exponent; SML/NJ loses some of the zeros behind the last of 15 digits. */
static size_t scientific(char *text, size_t length, double x, int64_t places, size_t size)
{
    char digit[PN_REAL_DIGITS + 2] = "0";
    int exponent = 0;
    const bool is_zero = pn_real_equal(x, 0.0);
    const int count = is_zero ? 1 : pn_real_digits(x, places + 1, false, digit, &exponent);
    const int64_t more = ((count - 1) < places) ? (count - 1) : places;
    text[length++] = digit[0];
    if (places > 0) {
        text[length++] = '.';
    }
    (void)memcpy(&text[length], &digit[1], (size_t)more);
    length += (size_t)more;
    length = filled(text, length, '0', (places - more) - (is_zero ? 0 : (2 + more)));
    return length + (size_t)snprintf(&text[length], size - length, "E%s%d", (exponent < 0) ? "~" : "", abs(exponent));
}

pn_string_t pn_real_styled(pn_ctx_t *cx, int64_t style, int64_t digits, double x)
{
    char text[1600];           /* the largest number has 309 digits in front of the point */
    const int64_t most = 1100; /* all further ones are zeros: Real.sml appends them */
    if (!isfinite(x) || (style == 2)) {
        return pn_string_make(cx, text, pn_real_general(text, sizeof text, x, digits));
    }
    const int64_t places = (digits > most) ? most : digits;
    size_t length = 0U;
    if (signbit(x) != 0) {
        text[length++] = '~';
    }
    if (style == 0) {
        length = scientific(text, length, fabs(x), places, sizeof text);
    } else {
        length = fixed(text, length, fabs(x), places);
    }
    return pn_string_make(cx, text, length);
}
