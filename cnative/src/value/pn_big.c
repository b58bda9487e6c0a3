/* SPDX-License-Identifier: MIT */
#include "pn/pn_big.h"

#include <math.h>
#include <string.h>

#include "pn/pn_arena.h"
#include "pn/pn_num.h"
#include "pn/pn_random.h"

#define HEADER          4U
#define DIGIT           4U /* bytes */
#define DIGIT_BITS      32U
#define DIGITS_MAX      ((size_t)INT32_MAX / 2U)
#define STEPS_PER_ROUND 4U

static const pn_big_t zero = { 0, NULL };

/* --- digits ------------------------------------------------------------------------------------------------------- */

static uint32_t load(const uint8_t *at)
{
    return (uint32_t)at[0] | ((uint32_t)at[1] << 8U) | ((uint32_t)at[2] << 16U) | ((uint32_t)at[3] << 24U);
}

static void store(uint8_t *at, uint32_t digit)
{
    at[0] = (uint8_t)(digit & 0xFFU);
    at[1] = (uint8_t)((digit >> 8U) & 0xFFU);
    at[2] = (uint8_t)((digit >> 16U) & 0xFFU);
    at[3] = (uint8_t)((digit >> 24U) & 0xFFU);
}

/* Sign and digits of a number of either kind. */
typedef struct view {
    bool is_negative;
    size_t count;
    const uint8_t *digits; /* NULL: those of `own` */
    uint8_t own[2U * DIGIT];
} view_t;

static void look(view_t *v, pn_big_t a)
{
    if (a.large != NULL) {
        const uint32_t header = load(a.large);
        v->is_negative = (header & 1U) != 0U;
        v->count = header >> 1U;
        v->digits = &a.large[HEADER];
        return;
    }
    v->is_negative = a.small < 0;
    const uint64_t magnitude = v->is_negative ? (0U - (uint64_t)a.small) : (uint64_t)a.small;
    store(v->own, (uint32_t)(magnitude & UINT32_MAX));
    store(&v->own[DIGIT], (uint32_t)(magnitude >> DIGIT_BITS));
    v->count = (magnitude == 0U) ? 0U : ((magnitude > UINT32_MAX) ? 2U : 1U);
    v->digits = NULL;
}

static uint32_t digit_of(const view_t *v, size_t i)
{
    if (i >= v->count) {
        return 0U;
    }
    return load((v->digits != NULL) ? &v->digits[i * DIGIT] : &v->own[i * DIGIT]);
}

static int order_of_magnitudes(const view_t *a, const view_t *b)
{
    if (a->count != b->count) {
        return (a->count > b->count) ? 1 : -1;
    }
    for (size_t i = a->count; i > 0U; i--) {
        const uint32_t x = digit_of(a, i - 1U);
        const uint32_t y = digit_of(b, i - 1U);
        if (x != y) {
            return (x > y) ? 1 : -1;
        }
    }
    return 0;
}

/* A number in the making, at the end of the arena. */
typedef struct making {
    size_t mark;
    size_t count;
    uint8_t *bytes; /* NULL after an error */
} making_t;

static making_t begin(pn_ctx_t *cx, size_t count)
{
    making_t m = { pn_arena_mark(cx->arena), count, NULL };
    if (count > DIGITS_MAX) {
        pn_raise(cx, PN_ERR_MEMORY, NULL);
    } else {
        m.bytes = pn_arena_alloc(cx, HEADER + (count * DIGIT));
    }
    if (m.bytes != NULL) {
        (void)memset(m.bytes, 0, HEADER + (count * DIGIT));
    }
    return m;
}

static uint32_t get(const making_t *m, size_t i)
{
    return load(&m->bytes[HEADER + (i * DIGIT)]);
}

static void set(const making_t *m, size_t i, uint32_t digit)
{
    store(&m->bytes[HEADER + (i * DIGIT)], digit);
}

/* The number that was made, without zeros in front; what has up to 64 bits leaves nothing in the arena. */
static pn_big_t finish(pn_ctx_t *cx, const making_t *m, bool is_negative)
{
    size_t count = m->count;
    while ((count > 0U) && (get(m, count - 1U) == 0U)) {
        count--;
    }
    if (count <= 2U) {
        const uint64_t high = (count > 1U) ? get(m, 1U) : 0U;
        const uint64_t magnitude = (high << DIGIT_BITS) | ((count > 0U) ? get(m, 0U) : 0U);
        const uint64_t limit = (uint64_t)INT64_MAX + (is_negative ? 1U : 0U);
        if (magnitude <= limit) {
            pn_arena_release(cx->arena, m->mark);
            if (!is_negative) {
                return PN_BIG((int64_t)magnitude);
            }
            return PN_BIG((magnitude > (uint64_t)INT64_MAX) ? INT64_MIN : -(int64_t)magnitude);
        }
    }
    store(m->bytes, ((uint32_t)count << 1U) | (is_negative ? 1U : 0U));
    return (pn_big_t){ 0, m->bytes };
}

/* So many steps of work are part of the rounds that an evaluation may take. */
static bool is_affordable(pn_ctx_t *cx, size_t steps, size_t times)
{
    const double rounds = (double)steps * (double)times / (double)STEPS_PER_ROUND;
    if (rounds > (double)PN_ROUNDS_MAX) {
        pn_raise(cx, PN_ERR_ENDLESS, NULL);
        return false;
    }
    cx->rounds += (uint64_t)rounds;
    return pn_goes_on(cx);
}

/* --- bytes -------------------------------------------------------------------------------------------------------- */

size_t pn_big_size(const uint8_t *large)
{
    return HEADER + ((size_t)(load(large) >> 1U) * DIGIT);
}

bool pn_big_is_valid(const uint8_t *bytes, size_t length)
{
    if ((length < HEADER) || (pn_big_size(bytes) > length)) {
        return false;
    }
    view_t v;
    look(&v, (pn_big_t){ 0, bytes });
    const bool fits = (v.count == 2U) && ((digit_of(&v, 1U) >> (DIGIT_BITS - 1U)) == 0U);
    const bool is_least =
        v.is_negative && (v.count == 2U) && (digit_of(&v, 1U) == (UINT32_C(1) << 31U)) && (digit_of(&v, 0U) == 0U);
    return (v.count >= 2U) && (digit_of(&v, v.count - 1U) != 0U) && !fits && !is_least;
}

pn_big_t pn_big_copy(pn_ctx_t *cx, pn_big_t a)
{
    if (a.large == NULL) {
        return a;
    }
    const uint8_t *copy = pn_arena_copy(cx, a.large, pn_big_size(a.large));
    return (copy == NULL) ? zero : (pn_big_t){ 0, copy };
}

/* --- other numbers ------------------------------------------------------------------------------------------------ */

static int64_t narrow(pn_ctx_t *cx, pn_big_t a, pn_error_t error)
{
    if (a.large != NULL) {
        pn_raise(cx, error, NULL);
        return 0;
    }
    return a.small;
}

int64_t pn_big_to_int(pn_ctx_t *cx, pn_big_t a)
{
    return pn_int_checked(cx, narrow(cx, a, PN_ERR_OVERFLOW));
}

int64_t pn_big_to_wide(pn_ctx_t *cx, pn_big_t a)
{
    return narrow(cx, a, PN_ERR_OVERFLOW);
}

int64_t pn_big_to_time(pn_ctx_t *cx, pn_big_t a)
{
    return narrow(cx, a, PN_ERR_LARGE);
}

double pn_big_to_real(pn_big_t a)
{
    if (a.large == NULL) {
        return (double)a.small;
    }
    view_t v;
    look(&v, a);
    /* The highest 64 bits, of which the last says whether there is anything behind: rounded once, by the conversion. */
    const uint64_t highest = digit_of(&v, v.count - 1U);
    uint32_t shift = 0U;
    while ((highest << shift) < (UINT64_C(1) << (DIGIT_BITS - 1U))) {
        shift++;
    }
    uint64_t top = (highest << DIGIT_BITS) | digit_of(&v, v.count - 2U);
    const uint32_t third = (v.count > 2U) ? digit_of(&v, v.count - 3U) : 0U;
    if (shift > 0U) {
        top = (top << shift) | ((uint64_t)third >> (DIGIT_BITS - shift));
    }
    bool is_exact = (uint32_t)(third << shift) == 0U;
    for (size_t i = 0U; is_exact && ((i + 3U) < v.count); i++) {
        is_exact = digit_of(&v, i) == 0U;
    }
    if (!is_exact) {
        top |= 1U;
    }
    const size_t behind = (v.count - 2U) * DIGIT_BITS;
    const double magnitude = (behind > 2000U) ? (double)INFINITY : ldexp((double)top, (int)behind - (int)shift);
    return v.is_negative ? -magnitude : magnitude;
}

pn_big_t pn_big_of_real(pn_ctx_t *cx, double x)
{
    if (isnan(x) || isinf(x)) {
        pn_raise(cx, isnan(x) ? PN_ERR_DOMAIN : PN_ERR_OVERFLOW, NULL);
        return zero;
    }
    if (fabs(x) < 9223372036854775808.0) {
        return PN_BIG((int64_t)x);
    }
    int exponent = 0;
    const double mantissa = frexp(x, &exponent);
    return pn_big_shift_left(cx, PN_BIG((int64_t)ldexp(mantissa, 62)), (int64_t)exponent - 62);
}

/* --- order -------------------------------------------------------------------------------------------------------- */

int64_t pn_big_sign(pn_big_t a)
{
    if (a.large != NULL) {
        return ((a.large[0] & 1U) != 0U) ? -1 : 1;
    }
    return (a.small > 0) - (a.small < 0);
}

int pn_big_order_large(pn_big_t a, pn_big_t b)
{
    view_t x;
    view_t y;
    look(&x, a);
    look(&y, b);
    if (x.is_negative != y.is_negative) {
        return x.is_negative ? -1 : 1;
    }
    return x.is_negative ? order_of_magnitudes(&y, &x) : order_of_magnitudes(&x, &y);
}

/* --- sums --------------------------------------------------------------------------------------------------------- */

static pn_big_t add_magnitudes(pn_ctx_t *cx, const view_t *a, const view_t *b, bool is_negative)
{
    const size_t count = ((a->count > b->count) ? a->count : b->count) + 1U;
    const making_t m = begin(cx, count);
    if (m.bytes == NULL) {
        return zero;
    }
    uint64_t carry = 0U;
    for (size_t i = 0U; i < count; i++) {
        const uint64_t sum = (uint64_t)digit_of(a, i) + digit_of(b, i) + carry;
        set(&m, i, (uint32_t)(sum & UINT32_MAX));
        carry = sum >> DIGIT_BITS;
    }
    return finish(cx, &m, is_negative);
}

/* a - b of magnitudes, a >= b. */
static pn_big_t subtract_magnitudes(pn_ctx_t *cx, const view_t *a, const view_t *b, bool is_negative)
{
    const making_t m = begin(cx, a->count);
    if (m.bytes == NULL) {
        return zero;
    }
    uint64_t borrow = 0U;
    for (size_t i = 0U; i < a->count; i++) {
        const uint64_t difference = (uint64_t)digit_of(a, i) - digit_of(b, i) - borrow;
        set(&m, i, (uint32_t)(difference & UINT32_MAX));
        borrow = (difference >> DIGIT_BITS) & 1U;
    }
    return finish(cx, &m, is_negative);
}

static pn_big_t sum(pn_ctx_t *cx, const view_t *a, const view_t *b)
{
    if (a->is_negative == b->is_negative) {
        return add_magnitudes(cx, a, b, a->is_negative);
    }
    if (order_of_magnitudes(a, b) >= 0) {
        return subtract_magnitudes(cx, a, b, a->is_negative);
    }
    return subtract_magnitudes(cx, b, a, b->is_negative);
}

pn_big_t pn_big_sum(pn_ctx_t *cx, pn_big_t a, pn_big_t b)
{
    view_t x;
    view_t y;
    look(&x, a);
    look(&y, b);
    return sum(cx, &x, &y);
}

pn_big_t pn_big_difference(pn_ctx_t *cx, pn_big_t a, pn_big_t b)
{
    view_t x;
    view_t y;
    look(&x, a);
    look(&y, b);
    y.is_negative = !y.is_negative;
    return sum(cx, &x, &y);
}

pn_big_t pn_big_neg(pn_ctx_t *cx, pn_big_t a)
{
    return pn_big_sub(cx, zero, a);
}

pn_big_t pn_big_abs(pn_ctx_t *cx, pn_big_t a)
{
    return (pn_big_sign(a) < 0) ? pn_big_neg(cx, a) : a;
}

/* --- products ----------------------------------------------------------------------------------------------------- */

pn_big_t pn_big_mul(pn_ctx_t *cx, pn_big_t a, pn_big_t b)
{
    const int64_t narrow_limit = INT64_C(3037000499); /* squared, it still has 63 bits */
    if ((a.large == NULL) && (b.large == NULL) && (a.small <= narrow_limit) && (a.small >= -narrow_limit)
        && (b.small <= narrow_limit) && (b.small >= -narrow_limit)) {
        return PN_BIG(a.small * b.small);
    }
    view_t x;
    view_t y;
    look(&x, a);
    look(&y, b);
    if (!is_affordable(cx, x.count, y.count)) {
        return zero;
    }
    const making_t m = begin(cx, x.count + y.count);
    if (m.bytes == NULL) {
        return zero;
    }
    for (size_t i = 0U; i < x.count; i++) {
        const uint64_t factor = digit_of(&x, i);
        uint64_t carry = 0U;
        for (size_t k = 0U; k < y.count; k++) {
            const uint64_t product = (factor * digit_of(&y, k)) + get(&m, i + k) + carry;
            set(&m, i + k, (uint32_t)(product & UINT32_MAX));
            carry = product >> DIGIT_BITS;
        }
        set(&m, i + y.count, (uint32_t)carry);
    }
    return finish(cx, &m, x.is_negative != y.is_negative);
}

/* The digits of a number, shifted to the left by less than a digit, with one more digit in front, in the arena. */
static uint32_t *shifted_digits(pn_ctx_t *cx, const view_t *v, uint32_t shift)
{
    uint32_t *digits = pn_arena_alloc(cx, (v->count + 1U) * sizeof *digits);
    uint64_t carry = 0U;
    for (size_t i = 0U; (digits != NULL) && (i <= v->count); i++) {
        const uint64_t wide = ((uint64_t)digit_of(v, i) << shift) | carry;
        digits[i] = (uint32_t)(wide & UINT32_MAX);
        carry = wide >> DIGIT_BITS;
    }
    return digits;
}

/* One digit of the quotient: how often the divisor goes into the digits of the rest from `rest` on, which is taken off.
 */
static uint32_t quotient_digit(uint32_t *rest, const uint32_t *divisor, size_t n)
{
    const uint64_t base = UINT64_C(1) << DIGIT_BITS;
    const uint64_t top = ((uint64_t)rest[n] << DIGIT_BITS) | rest[n - 1U];
    uint64_t guess = top / divisor[n - 1U];
    uint64_t left = top % divisor[n - 1U];
    while ((guess >= base) || ((n > 1U) && ((guess * divisor[n - 2U]) > ((left << DIGIT_BITS) | rest[n - 2U])))) {
        guess--;
        left += divisor[n - 1U];
        if (left >= base) {
            break;
        }
    }
    uint64_t carry = 0U;
    uint64_t borrow = 0U;
    for (size_t i = 0U; i < n; i++) {
        const uint64_t product = (guess * divisor[i]) + carry;
        const uint64_t difference = (uint64_t)rest[i] - (product & UINT32_MAX) - borrow;
        rest[i] = (uint32_t)(difference & UINT32_MAX);
        borrow = (difference >> DIGIT_BITS) & 1U;
        carry = product >> DIGIT_BITS;
    }
    const uint64_t difference = (uint64_t)rest[n] - carry - borrow;
    rest[n] = (uint32_t)(difference & UINT32_MAX);
    if (((difference >> DIGIT_BITS) & 1U) != 0U) { /* guessed one too many */
        guess--;
        carry = 0U;
        for (size_t i = 0U; i < n; i++) {
            const uint64_t total = (uint64_t)rest[i] + divisor[i] + carry;
            rest[i] = (uint32_t)(total & UINT32_MAX);
            carry = total >> DIGIT_BITS;
        }
        rest[n] += (uint32_t)carry;
    }
    return (uint32_t)guess;
}

/* Quotient rounded towards zero and remainder with the sign of a, of numbers of which one is large, |a| >= |b| > 0:
 * long division (Knuth, The Art of Computer Programming, volume 2, 4.3.1, algorithm D). */
static void divide_large(pn_ctx_t *cx, const view_t *a, const view_t *b, pn_big_t *quotient, pn_big_t *remainder)
{
    const size_t n = b->count;
    if (!is_affordable(cx, a->count - n + 1U, n)) {
        return;
    }
    const making_t q = begin(cx, a->count - n + 1U);
    const making_t r = begin(cx, n);
    const size_t mark = pn_arena_mark(cx->arena);
    uint32_t shift = 0U;
    while ((digit_of(b, n - 1U) << shift) < (UINT32_C(1) << (DIGIT_BITS - 1U))) {
        shift++;
    }
    uint32_t *divisor = shifted_digits(cx, b, shift);
    uint32_t *rest = shifted_digits(cx, a, shift);
    if ((q.bytes == NULL) || (r.bytes == NULL) || (divisor == NULL) || (rest == NULL)) {
        return;
    }
    for (size_t k = q.count; k > 0U; k--) {
        set(&q, k - 1U, quotient_digit(&rest[k - 1U], divisor, n));
    }
    for (size_t i = 0U; i < n; i++) {
        const uint32_t above =
            (shift > 0U) ? (uint32_t)(((uint64_t)rest[i + 1U] << (DIGIT_BITS - shift)) & UINT32_MAX) : 0U;
        set(&r, i, (rest[i] >> shift) | above);
    }
    pn_arena_release(cx->arena, mark);
    *remainder = finish(cx, &r, a->is_negative);
    /* The quotient stays where it is: it cannot be given back while the remainder is behind it. */
    making_t kept = q;
    kept.mark = pn_arena_mark(cx->arena);
    *quotient = finish(cx, &kept, a->is_negative != b->is_negative);
}

static void divide(pn_ctx_t *cx, pn_big_t a, pn_big_t b, pn_big_t *quotient, pn_big_t *remainder)
{
    *quotient = zero;
    *remainder = zero;
    if (pn_big_sign(b) == 0) {
        pn_raise(cx, PN_ERR_DIV, NULL);
    } else if ((a.large == NULL) && (b.large == NULL) && !((a.small == INT64_MIN) && (b.small == -1))) {
        *quotient = PN_BIG(a.small / b.small);
        *remainder = PN_BIG(a.small % b.small);
    } else {
        view_t x;
        view_t y;
        look(&x, a);
        look(&y, b);
        if (order_of_magnitudes(&x, &y) < 0) {
            *remainder = a;
        } else {
            divide_large(cx, &x, &y, quotient, remainder);
        }
    }
}

pn_big_t pn_big_quot(pn_ctx_t *cx, pn_big_t a, pn_big_t b)
{
    pn_big_t quotient;
    pn_big_t remainder;
    divide(cx, a, b, &quotient, &remainder);
    return quotient;
}

pn_big_t pn_big_rem(pn_ctx_t *cx, pn_big_t a, pn_big_t b)
{
    pn_big_t quotient;
    pn_big_t remainder;
    divide(cx, a, b, &quotient, &remainder);
    return remainder;
}

pn_big_t pn_big_div(pn_ctx_t *cx, pn_big_t a, pn_big_t b)
{
    pn_big_t quotient;
    pn_big_t remainder;
    divide(cx, a, b, &quotient, &remainder);
    const bool is_above = (pn_big_sign(remainder) * pn_big_sign(b)) < 0;
    return is_above ? pn_big_sub(cx, quotient, PN_BIG(1)) : quotient;
}

pn_big_t pn_big_mod(pn_ctx_t *cx, pn_big_t a, pn_big_t b)
{
    const pn_big_t remainder = pn_big_rem(cx, a, b);
    return ((pn_big_sign(remainder) * pn_big_sign(b)) < 0) ? pn_big_add(cx, remainder, b) : remainder;
}

/* --- bits --------------------------------------------------------------------------------------------------------- */

typedef enum bit_operation { BITS_AND, BITS_OR, BITS_XOR } bit_operation_t;

static uint32_t combined(uint32_t x, uint32_t y, bit_operation_t operation)
{
    switch (operation) {
    case BITS_AND: return x & y;
    case BITS_OR: return x | y;
    case BITS_XOR:
    default: return x ^ y;
    }
}

/* The next digit in two's complement; `carry` is 1 at first. */
static uint32_t complement_digit(uint32_t digit, bool is_negative, uint64_t *carry)
{
    if (!is_negative) {
        return digit;
    }
    const uint64_t wide = (uint64_t)(uint32_t)~digit + *carry;
    *carry = wide >> DIGIT_BITS;
    return (uint32_t)(wide & UINT32_MAX);
}

static pn_big_t bitwise(pn_ctx_t *cx, pn_big_t a, pn_big_t b, bit_operation_t operation)
{
    view_t x;
    view_t y;
    look(&x, a);
    look(&y, b);
    const bool is_negative = combined(x.is_negative ? 1U : 0U, y.is_negative ? 1U : 0U, operation) != 0U;
    const size_t count = ((x.count > y.count) ? x.count : y.count) + 1U;
    const making_t m = begin(cx, count);
    if (m.bytes == NULL) {
        return zero;
    }
    uint64_t carry_x = 1U;
    uint64_t carry_y = 1U;
    uint64_t carry = 1U;
    for (size_t i = 0U; i < count; i++) {
        const uint32_t digit_x = complement_digit(digit_of(&x, i), x.is_negative, &carry_x);
        const uint32_t digit_y = complement_digit(digit_of(&y, i), y.is_negative, &carry_y);
        set(&m, i, complement_digit(combined(digit_x, digit_y, operation), is_negative, &carry));
    }
    return finish(cx, &m, is_negative);
}

pn_big_t pn_big_and(pn_ctx_t *cx, pn_big_t a, pn_big_t b)
{
    const bool is_small = (a.large == NULL) && (b.large == NULL) && (a.small >= 0) && (b.small >= 0);
    return is_small ? PN_BIG((int64_t)((uint64_t)a.small & (uint64_t)b.small)) : bitwise(cx, a, b, BITS_AND);
}

pn_big_t pn_big_or(pn_ctx_t *cx, pn_big_t a, pn_big_t b)
{
    const bool is_small = (a.large == NULL) && (b.large == NULL) && (a.small >= 0) && (b.small >= 0);
    return is_small ? PN_BIG((int64_t)((uint64_t)a.small | (uint64_t)b.small)) : bitwise(cx, a, b, BITS_OR);
}

pn_big_t pn_big_xor(pn_ctx_t *cx, pn_big_t a, pn_big_t b)
{
    const bool is_small = (a.large == NULL) && (b.large == NULL) && (a.small >= 0) && (b.small >= 0);
    return is_small ? PN_BIG((int64_t)((uint64_t)a.small ^ (uint64_t)b.small)) : bitwise(cx, a, b, BITS_XOR);
}

pn_big_t pn_big_not(pn_ctx_t *cx, pn_big_t a)
{
    return pn_big_sub(cx, PN_BIG(-1), a);
}

pn_big_t pn_big_shift_left(pn_ctx_t *cx, pn_big_t a, int64_t n)
{
    view_t x;
    look(&x, a);
    if (x.count == 0U) {
        return zero;
    }
    const size_t whole = (size_t)n / DIGIT_BITS;
    const uint32_t shift = (uint32_t)((uint64_t)n % DIGIT_BITS);
    const making_t m = begin(cx, (whole > DIGITS_MAX) ? SIZE_MAX : (x.count + whole + 1U));
    if (m.bytes == NULL) {
        return zero;
    }
    uint64_t carry = 0U;
    for (size_t i = 0U; i <= x.count; i++) {
        const uint64_t wide = ((uint64_t)digit_of(&x, i) << shift) | carry;
        set(&m, i + whole, (uint32_t)(wide & UINT32_MAX));
        carry = wide >> DIGIT_BITS;
    }
    return finish(cx, &m, x.is_negative);
}

pn_big_t pn_big_shift_right(pn_ctx_t *cx, pn_big_t a, int64_t n)
{
    view_t x;
    look(&x, a);
    const size_t whole = (size_t)n / DIGIT_BITS;
    const uint32_t shift = (uint32_t)((uint64_t)n % DIGIT_BITS);
    if (whole >= x.count) {
        return PN_BIG(x.is_negative ? -1 : 0);
    }
    const size_t count = x.count - whole;
    const making_t m = begin(cx, count);
    if (m.bytes == NULL) {
        return zero;
    }
    bool is_exact = (digit_of(&x, whole) & ((UINT32_C(1) << shift) - 1U)) == 0U;
    for (size_t i = 0U; is_exact && (i < whole); i++) {
        is_exact = digit_of(&x, i) == 0U;
    }
    for (size_t i = 0U; i < count; i++) {
        const uint64_t wide = ((uint64_t)digit_of(&x, i + whole + 1U) << DIGIT_BITS) | digit_of(&x, i + whole);
        set(&m, i, (uint32_t)((wide >> shift) & UINT32_MAX));
    }
    const pn_big_t towards_zero = finish(cx, &m, x.is_negative);
    return (x.is_negative && !is_exact) ? pn_big_sub(cx, towards_zero, PN_BIG(1)) : towards_zero;
}

/* --- text --------------------------------------------------------------------------------------------------------- */

pn_big_t pn_big_of_digits(pn_ctx_t *cx, const char *digits, size_t length, bool is_negative)
{
    const making_t m = begin(cx, (length / 9U) + 1U); /* nine decimal digits are less than 2^32 */
    if ((m.bytes == NULL) || !is_affordable(cx, length, m.count)) {
        return zero;
    }
    size_t count = 0U;
    for (size_t i = 0U; i < length; i++) {
        uint64_t carry = (uint64_t)((uint8_t)digits[i] - (uint8_t)'0');
        for (size_t k = 0U; k < count; k++) {
            const uint64_t wide = ((uint64_t)get(&m, k) * 10U) + carry;
            set(&m, k, (uint32_t)(wide & UINT32_MAX));
            carry = wide >> DIGIT_BITS;
        }
        if (carry > 0U) {
            set(&m, count, (uint32_t)carry);
            count++;
        }
    }
    return finish(cx, &m, is_negative);
}

size_t pn_big_decimal(pn_big_t a, char minus, char *out, size_t capacity)
{
    view_t v;
    look(&v, a);
    /* Decimal digits from the lowest on, in `out`: digits to the base 2^32 are shifted in from the highest on. */
    size_t n = 0U;
    for (size_t i = v.count; i > 0U; i--) {
        uint64_t carry = digit_of(&v, i - 1U);
        for (size_t k = 0U; (k < n) || (carry > 0U); k++) {
            if (k >= n) {
                if ((n + 3U) > capacity) {
                    return SIZE_MAX;
                }
                out[n++] = '\0';
            }
            const uint64_t wide = ((uint64_t)(uint8_t)out[k] << DIGIT_BITS) + carry;
            out[k] = (char)(wide % 10U);
            carry = wide / 10U;
        }
    }
    if (capacity < 3U) {
        return SIZE_MAX;
    }
    if (n == 0U) {
        out[n++] = '\0';
    }
    for (size_t k = 0U; k < n; k++) {
        out[k] = (char)('0' + out[k]);
    }
    if (v.is_negative) {
        out[n++] = minus;
    }
    for (size_t k = 0U; k < (n / 2U); k++) {
        const char other = out[n - 1U - k];
        out[n - 1U - k] = out[k];
        out[k] = other;
    }
    out[n] = '\0';
    return n;
}

pn_string_t pn_big_string(pn_ctx_t *cx, pn_big_t a)
{
    if (a.large == NULL) {
        return pn_string_of_int(cx, a.small);
    }
    view_t v;
    look(&v, a);
    const size_t most = (v.count * 10U) + 3U; /* ten decimal digits are more than 2^32 */
    if (!is_affordable(cx, v.count, most / 2U)) {
        return PN_STRING("");
    }
    char *text = pn_arena_alloc(cx, most);
    if (text == NULL) {
        return PN_STRING("");
    }
    const size_t length = pn_big_decimal(a, '~', text, most);
    return (pn_string_t){ text, (uint32_t)length };
}

/* --- random numbers ----------------------------------------------------------------------------------------------- */

pn_big_t pn_big_random_below(pn_ctx_t *cx, pn_big_t n)
{
    const int64_t limit = pn_big_to_time(cx, n);
    return pn_ok(cx) ? PN_BIG(pn_random_below(cx, limit)) : zero;
}
