/* SPDX-License-Identifier: MIT
 * pn_library.h - the operations that the library functions written in CPN ML (lowering/prelude) are made from.
 */
#ifndef PN_LIBRARY_H
#define PN_LIBRARY_H

#include "pn/pn_string.h"
#include "pn/pn_types.h"

/* Stops the run with an error that no handler of CPN ML catches: the text says what is not available, and why. */
void pn_stop(pn_ctx_t *cx, pn_string_t text);

/* x = m * 2^e with 0.5 <= |m| < 1: e. */
int64_t pn_real_exponent(double x);
/* x * 2^n. */
double pn_real_scale(double x, int64_t n);
double pn_real_next(double x, double towards);
double pn_real_fused(double a, double b, double c);
bool pn_real_sign_bit(double x);
double pn_real_copy_sign(double x, double sign);
bool pn_real_is_normal(double x);

/* The number that a text of digits, point and exponent (as C writes them) is. */
double pn_real_read(pn_string_t text);
/* Real.fmt: style 0 SCI, 1 FIX, 2 GEN with so many digits. */
pn_string_t pn_real_styled(pn_ctx_t *cx, int64_t style, int64_t digits, double x);

#endif /* PN_LIBRARY_H */
