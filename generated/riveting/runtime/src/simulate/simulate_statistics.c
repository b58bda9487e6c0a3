/* SPDX-License-Identifier: MIT
 * simulate_statistics.c - count, least, greatest, first, last, sum and sum of squares of what a data collector sees.
 *
 * The formulas are those of the token game (pn2code.monitors.statistics), operation by operation, so that reals agree
 * in their last digit.
 */
#include "simulate_statistics.h"

#include "pn/pn_num.h"
#include "simulate_impl.h"

static bool add(int64_t *sum, int64_t value, int64_t factor)
{
    int64_t product = 0;
    return !__builtin_mul_overflow(value, factor, &product) && !__builtin_add_overflow(*sum, product, sum);
}

static bool sums_are_real(const sim_statistics_t *s)
{
    return s->is_real || (s->is_timed && pn_net.real_time);
}

/* Counts the last value for the time that has passed since. */
static bool weigh(sim_statistics_t *s, pn_time_t now)
{
    if (sums_are_real(s)) {
        const double lasted =
            pn_net.real_time ? (now.real - s->updated.real) : (double)(now.integer - s->updated.integer);
        const double last = s->is_real ? s->last.real : (double)s->last.integer;
        s->sum.real += lasted * last;
        s->squares.real += lasted * last * last;
        return true;
    }
    const int64_t lasted = now.integer - s->updated.integer;
    int64_t weighted = 0;
    return !__builtin_mul_overflow(lasted, s->last.integer, &weighted) && add(&s->sum.integer, weighted, 1)
           && add(&s->squares.integer, weighted, s->last.integer);
}

static bool add_up(sim_statistics_t *s, sim_number_t value)
{
    if (s->is_real) {
        s->sum.real += value.real;
        s->squares.real += value.real * value.real;
        return true;
    }
    return add(&s->sum.integer, value.integer, 1) && add(&s->squares.integer, value.integer, value.integer);
}

static bool is_less(const sim_statistics_t *s, sim_number_t a, sim_number_t b)
{
    return s->is_real ? (a.real < b.real) : (a.integer < b.integer);
}

bool sim_statistics_add(sim_statistics_t *statistics, sim_number_t value, pn_time_t now)
{
    sim_statistics_t *const s = statistics;
    bool is_fine = true;
    if (s->count == 0) {
        s->min = value;
        s->max = value;
        s->first = value;
        s->start = now;
    } else if (s->is_timed) {
        is_fine = weigh(s, now);
    }
    if (!s->is_timed) {
        is_fine = add_up(s, value);
    }
    s->min = is_less(s, value, s->min) ? value : s->min;
    s->max = is_less(s, s->max, value) ? value : s->max;
    s->last = value;
    s->updated = now;
    s->count++;
    return is_fine;
}

static void text_number(pn_text_t *text, const char *name, sim_number_t value, bool is_real)
{
    pn_text_str(text, ", \"");
    pn_text_str(text, name);
    pn_text_str(text, "\": ");
    if (is_real) {
        pn_text_json_real(text, value.real);
    } else {
        pn_text_int(text, value.integer);
    }
}

void sim_text_statistics(pn_text_t *text, const sim_statistics_t *statistics)
{
    const sim_statistics_t *const s = statistics;
    pn_text_str(text, "{\"start\": ");
    sim_text_time(text, s->start);
    pn_text_str(text, ", \"updated\": ");
    sim_text_time(text, s->updated);
    pn_text_str(text, ", \"count\": ");
    pn_text_int(text, s->count);
    text_number(text, "min", s->min, s->is_real);
    text_number(text, "max", s->max, s->is_real);
    text_number(text, "first", s->first, s->is_real);
    text_number(text, "last", s->last, s->is_real);
    text_number(text, "sum", s->sum, sums_are_real(s));
    text_number(text, "ss", s->squares, sums_are_real(s));
    pn_text_char(text, '}');
}
