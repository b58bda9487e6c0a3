/* SPDX-License-Identifier: MIT */
#include "pn/pn_random.h"

#include <math.h>

#include "pn/pn_num.h"

uint64_t pn_random_next(pn_ctx_t *cx)
{
    cx->random += UINT64_C(0x9E3779B97F4A7C15);
    uint64_t z = cx->random;
    z = (z ^ (z >> 30U)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27U)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31U);
}

int64_t pn_random_below(pn_ctx_t *cx, int64_t n)
{
    if (n <= 1) {
        return 0;
    }
    const uint64_t range = (uint64_t)n;
    const uint64_t limit = UINT64_MAX - (UINT64_MAX % range);
    uint64_t x = pn_random_next(cx);
    while (x >= limit) { /* less than one more draw on average */
        x = pn_random_next(cx);
    }
    return (int64_t)(x % range);
}

double pn_random_unit(pn_ctx_t *cx)
{
    return ((double)(pn_random_next(cx) >> 11U) + 0.5) / 9007199254740992.0;
}

/* Raises the exception unless the parameters are in range. */
static bool require(pn_ctx_t *cx, bool in_range, const char *exception)
{
    if (!in_range) {
        pn_raise(cx, PN_ERR_DOMAIN, exception);
    }
    return pn_ok(cx);
}

int64_t pn_random_bernoulli(pn_ctx_t *cx, double p)
{
    return (require(cx, (p >= 0.0) && (p <= 1.0), "Bernoulli") && (pn_random_unit(cx) < p)) ? 1 : 0;
}

int64_t pn_random_binomial(pn_ctx_t *cx, int64_t n, double p)
{
    int64_t successes = 0;
    if (require(cx, (n >= 1) && (p >= 0.0) && (p <= 1.0), "Binomial")) {
        for (int64_t i = 0; i < n; i++) {
            successes += (pn_random_unit(cx) < p) ? 1 : 0;
        }
    }
    return successes;
}

double pn_random_uniform(pn_ctx_t *cx, double a, double b)
{
    return require(cx, a <= b, "Uniform") ? (a + ((b - a) * pn_random_unit(cx))) : 0.0;
}

int64_t pn_random_discrete(pn_ctx_t *cx, int64_t a, int64_t b)
{
    return require(cx, a <= b, "Discrete") ? (a + pn_random_below(cx, (b - a) + 1)) : 0;
}

double pn_random_normal(pn_ctx_t *cx, double mean, double variance)
{
    if (!require(cx, variance >= 0.0, "Normal")) {
        return 0.0;
    }
    const double radius = sqrt(-2.0 * log(pn_random_unit(cx)));
    return mean + (sqrt(variance) * radius * cos(2.0 * PN_PI * pn_random_unit(cx)));
}

double pn_random_exponential(pn_ctx_t *cx, double rate)
{
    return require(cx, rate > 0.0, "Exponential") ? (-log(pn_random_unit(cx)) / rate) : 0.0;
}

int64_t pn_random_poisson(pn_ctx_t *cx, double mean)
{
    if (!require(cx, mean > 0.0, "Poisson")) {
        return 0;
    }
    int64_t events = -1;
    for (double left = mean; left >= 0.0; events++) {
        left += log(pn_random_unit(cx));
    }
    return events;
}

double pn_random_erlang(pn_ctx_t *cx, int64_t n, double rate)
{
    double sum = 0.0;
    if (require(cx, (n >= 1) && (rate > 0.0), "Erlang")) {
        for (int64_t i = 0; i < n; i++) {
            sum += pn_random_exponential(cx, rate);
        }
    }
    return sum;
}

double pn_random_chisq(pn_ctx_t *cx, int64_t n)
{
    double sum = 0.0;
    if (require(cx, n >= 1, "Chisq")) {
        for (int64_t i = 0; i < n; i++) {
            const double x = pn_random_normal(cx, 0.0, 1.0);
            sum += x * x;
        }
    }
    return sum;
}
