/* SPDX-License-Identifier: MIT
 * pn_text.h - text in a fixed buffer, and JSON as docs/trace.md writes it.
 *
 * A pn_text_t never writes beyond its buffer. What does not fit is cut, and `truncated` stays set until pn_text_clear:
 * look at it once, at the end.
 */
#ifndef PN_TEXT_H
#define PN_TEXT_H

#include "pn/pn_net.h"

/* Longest text that pn_text_real and pn_real_repr make, terminator included. */
#define PN_REAL_TEXT_SIZE 32U

/* Prepares a text over `capacity` bytes (at least 1) at `buffer`; the text is empty. */
void pn_text_init(pn_text_t *text, char *buffer, size_t capacity);
/* Makes it empty again. */
void pn_text_clear(pn_text_t *text);

void pn_text_char(pn_text_t *text, char c);
void pn_text_str(pn_text_t *text, const char *zero_terminated);
void pn_text_bytes(pn_text_t *text, const char *bytes, size_t length);
void pn_text_int(pn_text_t *text, int64_t value);
void pn_text_uint(pn_text_t *text, uint64_t value);
/* The shortest decimal that reads back to the same double, as Python's repr writes it: 5750.0, 0.1, 1e-05, 1e+16;
 * nan, inf, -inf for what is no number. */
void pn_text_real(pn_text_t *text, double value);
/* With a fixed number of decimals (0..17), as printf's %.4f, but never a negative zero. */
void pn_text_fixed(pn_text_t *text, double value, int decimals);

/* A JSON string with its quotes. Bytes that are not UTF-8 are taken as Latin-1. */
void pn_text_json_str(pn_text_t *text, const char *zero_terminated);
void pn_text_json_bytes(pn_text_t *text, const char *bytes, size_t length);
/* The same of a string of CPN ML: each byte is one character, whatever UTF-8 it looks like, so that no two look the
 * same. */
void pn_text_json_string(pn_text_t *text, const char *bytes, size_t length);
/* A JSON number, or "nan", "inf", "-inf". */
void pn_text_json_real(pn_text_t *text, double value);
/* One scalar as a JSON value. */
void pn_text_json_scalar(pn_text_t *text, const pn_scalar_value_t *scalar_value);

#endif /* PN_TEXT_H */
