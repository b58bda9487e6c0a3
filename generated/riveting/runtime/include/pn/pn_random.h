/* SPDX-License-Identifier: MIT
 * pn_random.h - random numbers from the context's state: the same seed, the same numbers. Not those of CPN Tools.
 *
 * Parameters out of range raise an exception with the function's capitalised name, as in CPN Tools.
 */
#ifndef PN_RANDOM_H
#define PN_RANDOM_H

#include "pn/pn_types.h"

/* 64 random bits (splitmix64). */
uint64_t pn_random_next(pn_ctx_t *cx);
/* 0 <= x < n; 0 for n <= 1. */
int64_t pn_random_below(pn_ctx_t *cx, int64_t n);
/* 0 < x < 1. */
double pn_random_unit(pn_ctx_t *cx);

int64_t pn_random_bernoulli(pn_ctx_t *cx, double p);
int64_t pn_random_binomial(pn_ctx_t *cx, int64_t n, double p);
double pn_random_uniform(pn_ctx_t *cx, double a, double b);
int64_t pn_random_discrete(pn_ctx_t *cx, int64_t a, int64_t b);
double pn_random_normal(pn_ctx_t *cx, double mean, double variance);
double pn_random_exponential(pn_ctx_t *cx, double rate);
int64_t pn_random_poisson(pn_ctx_t *cx, double mean);
double pn_random_erlang(pn_ctx_t *cx, int64_t n, double rate);
double pn_random_chisq(pn_ctx_t *cx, int64_t n);

#endif /* PN_RANDOM_H */
