/* SPDX-License-Identifier: MIT */
#include "pn/pn_random.h"

#include <math.h>

#include "pn/pn_num.h"

void pn_random_start(pn_ctx_t *cx, uint64_t purpose)
{
    cx->random = pn_random_key(cx->seed, cx->step, purpose);
}

uint64_t pn_random_next(pn_ctx_t *cx)
{
    return pn_random_draw(&cx->random);
}

/* 0 <= x < range; any 64 bits for 0. */
static uint64_t below(pn_ctx_t *cx, uint64_t range)
{
    return (range == 0U) ? pn_random_next(cx) : pn_random_pick(&cx->random, range);
}

int64_t pn_random_below(pn_ctx_t *cx, int64_t n)
{
    return (n <= 1) ? 0 : (int64_t)below(cx, (uint64_t)n);
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
    if (!require(cx, a <= b, "Discrete")) {
        return 0;
    }
    const uint64_t range = ((uint64_t)b - (uint64_t)a) + 1U;
    return (range == 1U) ? a : (int64_t)((uint64_t)a + below(cx, range));
}

static double normal01(pn_ctx_t *cx)
{
    const double radius = sqrt(-2.0 * log(pn_random_unit(cx)));
    return radius * cos((2.0 * PN_PI) * pn_random_unit(cx));
}

double pn_random_normal(pn_ctx_t *cx, double mean, double variance)
{
    return require(cx, variance >= 0.0, "Normal") ? (mean + (sqrt(variance) * normal01(cx))) : 0.0;
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

static double sum_of_squares(pn_ctx_t *cx, int64_t n)
{
    double sum = 0.0;
    for (int64_t i = 0; i < n; i++) {
        const double x = normal01(cx);
        sum += x * x;
    }
    return sum;
}

double pn_random_chisq(pn_ctx_t *cx, int64_t n)
{
    return require(cx, n >= 1, "Chisq") ? sum_of_squares(cx, n) : 0.0;
}

double pn_random_student(pn_ctx_t *cx, int64_t n)
{
    if (!require(cx, n >= 1, "Student")) {
        return 0.0;
    }
    const double x = normal01(cx);
    return x / sqrt(sum_of_squares(cx, n) / (double)n);
}

/* Gamma with rate 1 (Marsaglia and Tsang). */
static double gamma1(pn_ctx_t *cx, double shape)
{
    const bool is_small = shape < 1.0;
    const double d = (is_small ? (shape + 1.0) : shape) - (1.0 / 3.0);
    const double c = 1.0 / sqrt(9.0 * d);
    double v = 0.0;
    for (bool is_found = false; !is_found;) {
        double x = 0.0;
        do {
            x = normal01(cx);
            v = 1.0 + (c * x);
        } while (v <= 0.0);
        v = v * v * v;
        const double u = pn_random_unit(cx);
        is_found = log(u) < ((((0.5 * x * x) + d) - (d * v)) + (d * log(v)));
    }
    return is_small ? ((d * v) * pow(pn_random_unit(cx), 1.0 / shape)) : (d * v);
}

double pn_random_gamma(pn_ctx_t *cx, double shape, double rate)
{
    return require(cx, (shape > 0.0) && (rate > 0.0), "Gamma") ? (gamma1(cx, shape) / rate) : 0.0;
}

double pn_random_beta(pn_ctx_t *cx, double a, double b)
{
    if (!require(cx, (a > 0.0) && (b > 0.0), "Beta")) {
        return 0.0;
    }
    const double x = gamma1(cx, a);
    const double y = gamma1(cx, b);
    return x / (x + y);
}

double pn_random_weibull(pn_ctx_t *cx, double shape, double scale)
{
    return require(cx, (shape > 0.0) && (scale > 0.0), "Weibull") ? (scale * pow(-log(pn_random_unit(cx)), 1.0 / shape))
                                                                  : 0.0;
}

double pn_random_rayleigh(pn_ctx_t *cx, double scale)
{
    return require(cx, scale >= 0.0, "Rayleigh") ? (scale * sqrt(-2.0 * log(pn_random_unit(cx)))) : 0.0;
}
