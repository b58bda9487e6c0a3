/* SPDX-License-Identifier: MIT */
#include "pn/pn_string.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pn/pn_arena.h"
#include "pn/pn_num.h"

static const pn_string_t s_empty = { "", 0U };

/* Room for a string in the arena, NULL when it is full. */
static char *new_bytes(pn_ctx_t *cx, size_t length)
{
    if (length >= UINT32_MAX) {
        pn_raise(cx, PN_ERR_DOMAIN, "Size");
        return NULL;
    }
    char *bytes = pn_arena_alloc(cx, length + 1U);
    if (bytes != NULL) {
        bytes[length] = '\0';
    }
    return bytes;
}

pn_string_t pn_string_make(pn_ctx_t *cx, const char *bytes, size_t length)
{
    if (length == 0U) {
        return s_empty;
    }
    char *copy = new_bytes(cx, length);
    if (copy == NULL) {
        return s_empty;
    }
    (void)memcpy(copy, bytes, length);
    return (pn_string_t){ copy, (uint32_t)length };
}

int pn_string_compare(pn_string_t a, pn_string_t b)
{
    const uint32_t common = (a.length < b.length) ? a.length : b.length;
    const int order = (common > 0U) ? memcmp(a.bytes, b.bytes, common) : 0;
    if (order != 0) {
        return (order > 0) ? 1 : -1;
    }
    return (a.length > b.length) - (a.length < b.length);
}

pn_string_t pn_string_concat(pn_ctx_t *cx, pn_string_t a, pn_string_t b)
{
    if (b.length == 0U) {
        return a;
    }
    if (a.length == 0U) {
        return b;
    }
    const size_t length = (size_t)a.length + b.length;
    char *bytes = new_bytes(cx, length);
    if (bytes == NULL) {
        return s_empty;
    }
    (void)memcpy(bytes, a.bytes, a.length);
    (void)memcpy(&bytes[a.length], b.bytes, b.length);
    return (pn_string_t){ bytes, (uint32_t)length };
}

pn_string_t pn_string_sub(pn_ctx_t *cx, pn_string_t s, int64_t start, int64_t length)
{
    const int64_t size = (int64_t)s.length;
    if ((start < 0) || (length < 0) || (start > size) || (length > (size - start))) {
        pn_raise(cx, PN_ERR_SUBSCRIPT, NULL);
        return s_empty;
    }
    return pn_string_make(cx, &s.bytes[start], (size_t)length);
}

uint8_t pn_string_at(pn_ctx_t *cx, pn_string_t s, int64_t i)
{
    if ((i < 0) || (i >= (int64_t)s.length)) {
        pn_raise(cx, PN_ERR_SUBSCRIPT, NULL);
        return 0U;
    }
    return (uint8_t)s.bytes[i];
}

pn_string_t pn_string_of_char(pn_ctx_t *cx, uint8_t c)
{
    const char byte = (char)c;
    return pn_string_make(cx, &byte, 1U);
}

bool pn_string_is_prefix(pn_string_t part, pn_string_t s)
{
    return (part.length == 0U) || ((part.length <= s.length) && (memcmp(part.bytes, s.bytes, part.length) == 0));
}

bool pn_string_is_suffix(pn_string_t part, pn_string_t s)
{
    return (part.length == 0U)
           || ((part.length <= s.length) && (memcmp(part.bytes, &s.bytes[s.length - part.length], part.length) == 0));
}

bool pn_string_is_substring(pn_string_t part, pn_string_t s)
{
    if (part.length == 0U) {
        return s.length > 0U; /* as SML/NJ has it */
    }
    for (uint32_t at = 0U; (at + part.length) <= s.length; at++) {
        if (memcmp(part.bytes, &s.bytes[at], part.length) == 0) {
            return true;
        }
    }
    return false;
}

uint8_t pn_char_of_int(pn_ctx_t *cx, int64_t code)
{
    if ((code < 0) || (code > 255)) {
        pn_raise(cx, PN_ERR_DOMAIN, "Chr");
        return 0U;
    }
    return (uint8_t)code;
}

bool pn_char_is_digit(uint8_t c)
{
    return (c >= (uint8_t)'0') && (c <= (uint8_t)'9');
}

bool pn_char_is_upper(uint8_t c)
{
    return (c >= (uint8_t)'A') && (c <= (uint8_t)'Z');
}

bool pn_char_is_lower(uint8_t c)
{
    return (c >= (uint8_t)'a') && (c <= (uint8_t)'z');
}

bool pn_char_is_alpha(uint8_t c)
{
    return pn_char_is_upper(c) || pn_char_is_lower(c);
}

bool pn_char_is_alphanum(uint8_t c)
{
    return pn_char_is_alpha(c) || pn_char_is_digit(c);
}

bool pn_char_is_space(uint8_t c)
{
    return (c == (uint8_t)' ') || ((c >= 9U) && (c <= 13U));
}

uint8_t pn_char_to_upper(uint8_t c)
{
    return pn_char_is_lower(c) ? (uint8_t)(c - 32U) : c;
}

uint8_t pn_char_to_lower(uint8_t c)
{
    return pn_char_is_upper(c) ? (uint8_t)(c + 32U) : c;
}

size_t pn_int_sml(char *out, size_t capacity, int64_t value)
{
    const uint64_t magnitude = (value < 0) ? (0U - (uint64_t)value) : (uint64_t)value;
    return (size_t)snprintf(out, capacity, "%s%llu", (value < 0) ? "~" : "", (unsigned long long)magnitude);
}

int pn_real_digits(double value, int64_t wanted, bool behind, char *digit, int *exponent)
{
    double rest = value;
    int power = 0;
    for (; rest < 1.0; power--) {
        rest = 10.0 * rest;
    }
    for (; rest >= 10.0; power++) {
        rest = 0.1 * rest;
    }
    const int64_t most = behind ? (wanted + power + 1) : wanted;
    int count = 0;
    for (; (count < most) && (count < PN_REAL_DIGITS); count++) {
        const int next = (int)rest;
        digit[count] = (char)('0' + next);
        rest = 10.0 * (rest - (double)next);
    }
    const bool is_odd = (count > 0) && (((digit[count - 1] - '0') % 2) == 1);
    if ((rest > 5.0) || ((rest >= 5.0) && is_odd)) {
        int at = count - 1;
        for (; (at >= 0) && (digit[at] == '9'); at--) {
            digit[at] = '0';
        }
        if (at >= 0) {
            digit[at]++;
        } else {
            (void)memmove(&digit[1], digit, (size_t)count);
            digit[0] = '1';
            count++;
            power++;
        }
    }
    digit[count] = '\0';
    *exponent = power;
    return count;
}

size_t pn_real_general(char *out, size_t capacity, double value, int64_t digits)
{
    const char *sign = (signbit(value) != 0) ? "~" : "";
    if (isnan(value)) {
        return (size_t)snprintf(out, capacity, "nan");
    }
    if (isinf(value)) {
        return (size_t)snprintf(out, capacity, "%sinf", sign);
    }
    char digit[PN_REAL_DIGITS + 2] = "0";
    int exponent = 0;
    int count = (pn_real_equal(value, 0.0)) ? 1 : pn_real_digits(fabs(value), digits, false, digit, &exponent);
    while ((count > 1) && (digit[count - 1] == '0')) {
        count--;
    }
    digit[count] = '\0';
    if ((exponent < -4) || (exponent >= digits)) {
        return (size_t)snprintf(out, capacity, "%s%c%s%sE%s%02d", sign, digit[0], (count > 1) ? "." : "", &digit[1],
                                (exponent < 0) ? "~" : "", abs(exponent));
    }
    if (exponent < 0) {
        return (size_t)snprintf(out, capacity, "%s0.%.*s%s", sign, -exponent - 1, "0000", digit);
    }
    if (count > (exponent + 1)) {
        return (size_t)snprintf(out, capacity, "%s%.*s.%s", sign, exponent + 1, digit, &digit[exponent + 1]);
    }
    const int length = snprintf(out, capacity, "%s%s", sign, digit);
    const size_t zeros = (size_t)(exponent + 1 - count);
    (void)memset(&out[length], '0', zeros);
    return (size_t)length + zeros
           + (size_t)snprintf(&out[(size_t)length + zeros], capacity - (size_t)length - zeros, ".0");
}

/* SML/NJ's Real.toString: 12 significant digits, at least one decimal, E notation outside 1E~04 .. 1E12. */
size_t pn_real_sml(char *out, size_t capacity, double value)
{
    return pn_real_general(out, capacity, value, 12);
}

pn_string_t pn_string_of_int(pn_ctx_t *cx, int64_t value)
{
    char digits[24];
    return pn_string_make(cx, digits, pn_int_sml(digits, sizeof digits, value));
}

pn_string_t pn_string_of_real(pn_ctx_t *cx, double value)
{
    char digits[40];
    return pn_string_make(cx, digits, pn_real_sml(digits, sizeof digits, value));
}

pn_string_t pn_string_of_bool(bool value)
{
    return value ? PN_STRING("true") : PN_STRING("false");
}
