/* SPDX-License-Identifier: MIT
 * pn_string.h - strings of CPN ML: constant bytes with a length, literals or in the arena.
 */
#ifndef PN_STRING_H
#define PN_STRING_H

#include "pn/pn_types.h"

typedef struct pn_string {
    const char *bytes; /* not zero-terminated in general, but arena strings and literals are */
    uint32_t length;
} pn_string_t;

/* A literal: PN_STRING("abc"). */
#define PN_STRING(literal) ((pn_string_t){ (literal), (uint32_t)(sizeof(literal) - 1U) })

/* A copy in the arena; the empty string when it is full. */
pn_string_t pn_string_make(pn_ctx_t *cx, const char *bytes, size_t length);
int pn_string_compare(pn_string_t a, pn_string_t b);
/* The order of strings: < 0, 0, > 0. Copies of a token share their bytes, so most that are equal are the same. */
static inline int pn_string_order(pn_string_t a, pn_string_t b)
{
    return ((a.bytes == b.bytes) && (a.length == b.length)) ? 0 : pn_string_compare(a, b);
}
static inline bool pn_string_equal(pn_string_t a, pn_string_t b)
{
    return pn_string_order(a, b) == 0;
}
pn_string_t pn_string_concat(pn_ctx_t *cx, pn_string_t a, pn_string_t b);
static inline int64_t pn_string_size(pn_string_t s)
{
    return (int64_t)s.length;
}
/* substring (s, start, length); Subscript. */
pn_string_t pn_string_sub(pn_ctx_t *cx, pn_string_t s, int64_t start, int64_t length);
/* Character i; Subscript. */
uint8_t pn_string_at(pn_ctx_t *cx, pn_string_t s, int64_t i);
pn_string_t pn_string_of_char(pn_ctx_t *cx, uint8_t c);
bool pn_string_is_prefix(pn_string_t part, pn_string_t s);
bool pn_string_is_suffix(pn_string_t part, pn_string_t s);
bool pn_string_is_substring(pn_string_t part, pn_string_t s);
/* chr: PN_ERR_DOMAIN named Chr outside 0..255. */
uint8_t pn_char_of_int(pn_ctx_t *cx, int64_t code);

static inline int64_t pn_char_code(uint8_t c)
{
    return (int64_t)c;
}
/* Classes of ASCII characters. */
bool pn_char_is_digit(uint8_t c);
bool pn_char_is_alpha(uint8_t c);
bool pn_char_is_alphanum(uint8_t c);
bool pn_char_is_space(uint8_t c);
bool pn_char_is_upper(uint8_t c);
bool pn_char_is_lower(uint8_t c);
uint8_t pn_char_to_upper(uint8_t c);
uint8_t pn_char_to_lower(uint8_t c);

/* Writes to the run's output (pn_file.h). */
void pn_print(pn_ctx_t *cx, pn_string_t s);

/* As CPN ML writes them: ~5, 1.5, 1E~05 (12 significant digits), true. */
pn_string_t pn_string_of_int(pn_ctx_t *cx, int64_t value);
pn_string_t pn_string_of_real(pn_ctx_t *cx, double value);
pn_string_t pn_string_of_bool(bool value);
/* Writes at most `capacity` bytes with the terminator; returns the length. */
size_t pn_int_sml(char *out, size_t capacity, int64_t value);
size_t pn_real_sml(char *out, size_t capacity, double value);
/* The same with another number of significant digits. */
size_t pn_real_general(char *out, size_t capacity, double value, int64_t digits);
/* The digits of a positive finite number as SML/NJ finds them, `wanted` in all or behind the point, and the exponent of
 * the first; returns how many. It multiplies by ten with rounded arithmetic, and finds at most PN_REAL_DIGITS, one more
 * if they are rounded up to a power of ten; a last digit that is just in the middle becomes even. `digit` ends with a
 * zero. */
#define PN_REAL_DIGITS 15
int pn_real_digits(double value, int64_t wanted, bool behind, char *digit, int *exponent);

#endif /* PN_STRING_H */
