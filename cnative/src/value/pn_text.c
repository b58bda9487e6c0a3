/* SPDX-License-Identifier: MIT */
#include "pn/pn_text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "pn/pn_num.h"

void pn_text_init(pn_text_t *text, char *buffer, size_t capacity)
{
    text->buffer = buffer;
    text->capacity = capacity;
    text->flush = NULL;
    text->user = NULL;
    pn_text_clear(text);
}

void pn_text_clear(pn_text_t *text)
{
    text->length = 0U;
    text->truncated = false;
    text->buffer[0] = '\0';
}

void pn_text_bytes(pn_text_t *text, const char *bytes, size_t length)
{
    size_t done = 0U;
    while ((done < length) && !text->truncated) {
        const size_t room = text->capacity - 1U - text->length;
        const size_t left = length - done;
        const size_t n = (left < room) ? left : room;
        (void)memcpy(&text->buffer[text->length], &bytes[done], n);
        text->length += n;
        done += n;
        if ((done < length) && (text->flush != NULL)) {
            text->flush(text);
        } else {
            text->truncated = done < length;
        }
    }
    text->buffer[text->length] = '\0';
}

void pn_text_str(pn_text_t *text, const char *zero_terminated)
{
    pn_text_bytes(text, zero_terminated, strlen(zero_terminated));
}

void pn_text_char(pn_text_t *text, char c)
{
    pn_text_bytes(text, &c, 1U);
}

void pn_text_uint(pn_text_t *text, uint64_t value)
{
    char digits[20];
    size_t n = sizeof digits;
    uint64_t rest = value;
    do {
        n--;
        digits[n] = (char)('0' + (char)(rest % 10U));
        rest /= 10U;
    } while (rest > 0U);
    pn_text_bytes(text, &digits[n], sizeof digits - n);
}

void pn_text_int(pn_text_t *text, int64_t value)
{
    if (value < 0) {
        pn_text_char(text, '-');
        pn_text_uint(text, 0U - (uint64_t)value);
    } else {
        pn_text_uint(text, (uint64_t)value);
    }
}

void pn_text_real(pn_text_t *text, double value)
{
    char digits[PN_REAL_TEXT_SIZE];
    pn_text_bytes(text, digits, pn_real_repr(digits, value));
}

void pn_text_fixed(pn_text_t *text, double value, int decimals)
{
    char digits[352]; /* the largest double has 309 digits before the point */
    (void)snprintf(digits, sizeof digits, "%.*f", decimals, value);
    const bool is_zero = strspn(digits, "-0.") == strlen(digits);
    pn_text_str(text, (is_zero && (digits[0] == '-')) ? &digits[1] : digits);
}

/* Length of the UTF-8 sequence at `at`, 0 if it is none. */
static size_t utf8_length(const unsigned char *at, size_t left)
{
    size_t length = 0U;
    if ((at[0] >= 0xC2U) && (at[0] <= 0xDFU)) {
        length = 2U;
    } else if ((at[0] >= 0xE0U) && (at[0] <= 0xEFU)) {
        length = 3U;
    } else if ((at[0] >= 0xF0U) && (at[0] <= 0xF4U)) {
        length = 4U;
    } else {
        return 0U;
    }
    if (length > left) {
        return 0U;
    }
    for (size_t i = 1U; i < length; i++) {
        if ((at[i] & 0xC0U) != 0x80U) {
            return 0U;
        }
    }
    /* Overlong forms, surrogates and what is beyond U+10FFFF. */
    const bool is_bad = ((at[0] == 0xE0U) && (at[1] < 0xA0U)) || ((at[0] == 0xEDU) && (at[1] > 0x9FU))
                        || ((at[0] == 0xF0U) && (at[1] < 0x90U)) || ((at[0] == 0xF4U) && (at[1] > 0x8FU));
    return is_bad ? 0U : length;
}

/* One character of Latin-1 within a JSON string. */
static void json_char(pn_text_t *text, unsigned char c)
{
    if ((c == (unsigned char)'"') || (c == (unsigned char)'\\')) {
        pn_text_char(text, '\\');
        pn_text_char(text, (char)c);
    } else if (c == (unsigned char)'\n') {
        pn_text_str(text, "\\n");
    } else if (c == (unsigned char)'\r') {
        pn_text_str(text, "\\r");
    } else if (c == (unsigned char)'\t') {
        pn_text_str(text, "\\t");
    } else if ((c < 0x20U) || (c == 0x7FU)) {
        char escape[8];
        (void)snprintf(escape, sizeof escape, "\\u%04x", (unsigned int)c);
        pn_text_str(text, escape);
    } else if (c < 0x80U) {
        pn_text_char(text, (char)c);
    } else {
        pn_text_char(text, (char)(0xC0U | (c >> 6U)));
        pn_text_char(text, (char)(0x80U | (c & 0x3FU)));
    }
}

void pn_text_json_bytes(pn_text_t *text, const char *bytes, size_t length)
{
    pn_text_char(text, '"');
    for (size_t i = 0U; i < length; i++) {
        const size_t n = utf8_length((const unsigned char *)&bytes[i], length - i);
        if (n > 0U) {
            pn_text_bytes(text, &bytes[i], n);
            i += n - 1U;
        } else {
            json_char(text, (unsigned char)bytes[i]);
        }
    }
    pn_text_char(text, '"');
}

void pn_text_json_string(pn_text_t *text, const char *bytes, size_t length)
{
    pn_text_char(text, '"');
    for (size_t i = 0U; i < length; i++) {
        json_char(text, (unsigned char)bytes[i]);
    }
    pn_text_char(text, '"');
}

void pn_text_json_str(pn_text_t *text, const char *zero_terminated)
{
    pn_text_json_bytes(text, zero_terminated, strlen(zero_terminated));
}

void pn_text_json_real(pn_text_t *text, double value)
{
    const bool is_number = isfinite(value);
    if (!is_number) {
        pn_text_char(text, '"');
    }
    pn_text_real(text, value);
    if (!is_number) {
        pn_text_char(text, '"');
    }
}

void pn_text_json_scalar(pn_text_t *text, const pn_scalar_value_t *scalar_value)
{
    switch (scalar_value->kind) {
    case PN_VALUE_BOOL: pn_text_str(text, (scalar_value->integer != 0) ? "true" : "false"); break;
    case PN_VALUE_REAL: pn_text_json_real(text, scalar_value->real); break;
    case PN_VALUE_STRING: pn_text_json_string(text, scalar_value->text, scalar_value->length); break;
    case PN_VALUE_ENUM:
        if (scalar_value->text != NULL) {
            pn_text_json_str(text, scalar_value->text);
        } else {
            pn_text_int(text, scalar_value->integer);
        }
        break;
    case PN_VALUE_INT:
    case PN_VALUE_LIST:
    default: pn_text_int(text, scalar_value->integer); break;
    }
}
