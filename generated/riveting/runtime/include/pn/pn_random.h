/* SPDX-License-Identifier: MIT
 * pn_random.h - random numbers: the same seed, the same run. The distributions are those of CPN Tools, the numbers are
 * not.
 *
 * What is written here is exact: whoever computes it as written, in IEEE doubles and with the same libm, gets the same
 * bits. All integers are unsigned 64-bit (sums and products modulo 2^64) unless said otherwise.
 *
 * The stream (splitmix64)
 *
 *     next()      state = state + 0x9E3779B97F4A7C15;  z = state
 *                 z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9
 *                 z = (z ^ (z >> 27)) * 0x94D049BB133111EB
 *                 result z ^ (z >> 31)
 *     mix(z)      what next() gives for the state z: the same four lines
 *
 * Where it starts anew: each piece of work has a stream of its own, so that what is enabled does not depend on how
 * often or in which order somebody asks. state = key(seed, step, purpose) = mix(mix(mix(seed) ^ step) ^ purpose), where
 *
 *     purpose 0, step 0               declarations, then the initial marking, place by place
 *     purpose 1, step n               the choice of the next binding element, n = occurrences so far: below(number of
 *                                     enabled transition instances of the best priority), in the order of trying, then
 *                                     below(number of enabled bindings of that one); both are drawn, even when there is
 *                                     only one
 *     purpose 2 + 2 t, step n         the bindings of transition t (index in the net's table) after n occurrences:
 *                                     starts anew each time they are enumerated
 *     purpose 3 + 2 t, step n + 1     the occurrence of t: code segment, inscriptions of input arcs (again), delay,
 *                                     inscriptions of output arcs; arcs in the order of the file
 *
 * Drawing. `unit()`, `normal01()` and so on are drawn where they stand, from left to right; x / y, x * y * z from the
 * left; log, exp, sqrt, cos, pow are those of libm (so pow overflows to infinity). PI = 3.14159265358979323846.
 *
 *     below(n)               n <= 1: 0, nothing is drawn. Else limit = (2^64 - 1) - (2^64 - 1) mod n; x = next(), again
 *                            while x >= limit; result x mod n
 *     unit()                 ((double)(next() >> 11) + 0.5) / 9007199254740992.0, which is never 0 and never 1
 *     normal01()             r = sqrt(-2.0 * log(unit())); result r * cos((2.0 * PI) * unit())
 *     gamma1(a)              a < 1: g = gamma1(a + 1.0); result g * pow(unit(), 1.0 / a)
 *                            else d = a - 1.0 / 3.0; c = 1.0 / sqrt(9.0 * d); again and again:
 *                              x = normal01(); v = 1.0 + c * x, both again while v <= 0; v = v * v * v; u = unit();
 *                              result d * v if log(u) < 0.5 * x * x + d - d * v + d * log(v)       (sums from the left)
 *
 * Distributions: parameters, condition (else the exception with the function's name capitalised, nothing drawn), result
 *
 *     bernoulli p            0 <= p <= 1                unit() < p ? 1 : 0
 *     binomial(n, p)         n >= 1, 0 <= p <= 1        number of i in 1..n with unit() < p; always n draws
 *     uniform(a, b)          a <= b                     a + (b - a) * unit()
 *     discrete(a, b)         a <= b                     a + below(b - a + 1)    (the number as an unsigned 64-bit one;
 *                                                                               0: next())
 *     normal(mean, variance) variance >= 0              mean + sqrt(variance) * normal01()
 *     exponential rate       rate > 0                   -log(unit()) / rate
 *     poisson mean           mean > 0                   n = -1; left = mean; while left >= 0: left = left +
 *                                                       log(unit()), n = n + 1; result n
 *     erlang(n, rate)        n >= 1, rate > 0           0.0 + exponential(rate) + ..., n of them, from the left
 *     chisq n                n >= 1                     0.0 + x1 * x1 + ..., n of them, each xi = normal01()
 *     student n              n >= 1                     x = normal01(); result x / sqrt(chisq(n) / (double)n)
 *     gamma(shape, rate)     shape > 0, rate > 0        gamma1(shape) / rate
 *     beta(a, b)             a > 0, b > 0               x = gamma1(a); y = gamma1(b); result x / (x + y)
 *     weibull(shape, scale)  shape > 0, scale > 0       scale * pow(-log(unit()), 1.0 / shape)
 *     rayleigh scale         scale >= 0                 scale * sqrt(-2.0 * log(unit()))
 *     CS.ran()               CS.size() is known         CS.col(below(CS.size())); for a subset the value at that
 *                                                       position among its values; else CPN'Error as CS.size() raises
 *                                                       it
 *     random ms              not empty (else Empty)     element number below(length of the list), from 0, in the order
 *                                                       of the list
 *
 * A result that is not finite is given as it is.
 */
#ifndef PN_RANDOM_H
#define PN_RANDOM_H

#include "pn/pn_types.h"

/* The purposes of streams. */
#define PN_RANDOM_START                  UINT64_C(0)
#define PN_RANDOM_CHOICE                 UINT64_C(1)
#define PN_RANDOM_BINDINGS(transition)   (UINT64_C(2) + (UINT64_C(2) * (uint64_t)(transition)))
#define PN_RANDOM_OCCURRENCE(transition) (UINT64_C(3) + (UINT64_C(2) * (uint64_t)(transition)))

/* mix, key, next and below as above, with a state of the caller's own. */
static inline uint64_t pn_random_mix(uint64_t state)
{
    uint64_t z = state + UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ (z >> 30U)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27U)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31U);
}

static inline uint64_t pn_random_key(uint64_t seed, uint64_t step, uint64_t purpose)
{
    return pn_random_mix(pn_random_mix(pn_random_mix(seed) ^ step) ^ purpose);
}

static inline uint64_t pn_random_draw(uint64_t *state)
{
    const uint64_t bits = pn_random_mix(*state);
    *state += UINT64_C(0x9E3779B97F4A7C15);
    return bits;
}

/* n > 0. The limit is looked at only where a number could be beyond it: divisions of 64 bits take their time. */
static inline uint64_t pn_random_pick(uint64_t *state, uint64_t n)
{
    uint64_t x = pn_random_draw(state);
    while ((x > (UINT64_MAX - n)) && (x >= (UINT64_MAX - (UINT64_MAX % n)))) {
        x = pn_random_draw(state);
    }
    return x % n;
}

/* Starts the stream for a purpose; the context has the seed and the step. */
void pn_random_start(pn_ctx_t *cx, uint64_t purpose);

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
double pn_random_student(pn_ctx_t *cx, int64_t n);
double pn_random_gamma(pn_ctx_t *cx, double shape, double rate);
double pn_random_beta(pn_ctx_t *cx, double a, double b);
double pn_random_weibull(pn_ctx_t *cx, double shape, double scale);
double pn_random_rayleigh(pn_ctx_t *cx, double scale);

#endif /* PN_RANDOM_H */
