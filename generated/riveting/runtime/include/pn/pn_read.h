/* SPDX-License-Identifier: MIT
 * pn_read.h - values read from text, as `CS.output` writes them. Blanks and line ends may stand between any two signs;
 * a string ends at the next quotation mark.
 *
 * `at` is where reading goes on in the text; after an error (exception IOError) it is where it was.
 */
#ifndef PN_READ_H
#define PN_READ_H

#include "pn/pn_big.h"
#include "pn/pn_string.h"
#include "pn/pn_type.h"

/* Reads a word or sign if it is there; what begins a longer word is not. */
bool pn_read_accept(pn_string_t text, int64_t *at, pn_string_t word);
/* Numbers, perhaps in parentheses. */
pn_big_t pn_read_integer(pn_ctx_t *cx, pn_string_t text, int64_t *at);
double pn_read_number(pn_ctx_t *cx, pn_string_t text, int64_t *at);
/* Whether only blanks are left, which are read. */
bool pn_read_is_done(pn_string_t text, int64_t *at);
/* Raises IOError. */
void pn_read_fail(pn_ctx_t *cx);
/* A value of a colour set; bounds are not checked. */
void pn_colset_input(pn_ctx_t *cx, const pn_type_t *type, void *value, pn_string_t text, int64_t *at);

#endif /* PN_READ_H */
