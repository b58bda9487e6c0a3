/* SPDX-License-Identifier: MIT
 * pn_packed.h - packed places: a multi-set over few colours as counters of a few bits each.
 *
 * The colours of the place's colour set are numbered from 0 in the colour set's order. Counter i, the number of tokens
 * of colour i, is `width` bits at bit `bit` + i * `width` of the packed part, the array of 64-bit words with which a
 * marking begins (bit k is bit k % 64 of word k / 64). A counter never lies across two words. Bits that belong to no
 * counter are 0: equal markings, equal bytes.
 *
 * PN_PACKED_PLACE makes, for a place, what PN_UNTIMED_PLACE of pn_place.h makes for others, and
 *
 *     place_count_of(m, i)    the number of tokens of colour i
 *     place_next(m, i)        the first colour from i on of which there is a token; the number of colours if there is
 *                             none
 *     place_is_empty(m)       whether there is no token
 *     place_check(cx, v)      raises PN_ERR_COLOUR at the place if the value is not in the colour set: that is always
 *                             asked where not every number is that of a colour (`is_whole`: subsets), but only until it
 *                             is known of a colour
 *     place_has_sum(m, s)     whether there are all tokens of a sum; place_take_sum takes, place_add_sum puts them
 *
 * Unlike there, place_add changes nothing when a counter would overflow. PN_PACKED_KIND makes them for all places with
 * the same colours in counters of the same width: they have the table of the place before the marking.
 */
#ifndef PN_PACKED_H
#define PN_PACKED_H

#include "pn/pn_multiset.h"
#include "pn/pn_num.h"
#include "pn/pn_place.h"

/* Storage of a static variable that each thread has for itself. */
#if defined(__STDC_NO_THREADS__)
#define PN_OF_THREAD
#else
#define PN_OF_THREAD _Thread_local
#endif

/* The number of the lowest bit that is set, of bits that are not all 0. */
PN_INLINE uint32_t pn_lowest_bit(uint64_t bits)
{
#if defined(__GNUC__)
    return (uint32_t)__builtin_ctzll(bits);
#else
    uint32_t number = 0U;
    while (((bits >> number) & 1U) == 0U) {
        number++;
    }
    return number;
#endif
}

/* The largest count of a counter. */
PN_INLINE uint32_t pn_counter_most(uint32_t width)
{
    return UINT32_MAX >> (32U - width);
}

PN_INLINE uint32_t pn_counter(const uint64_t *word, uint32_t bit, uint32_t width, uint32_t i)
{
    const uint32_t at = bit + (i * width);
    return (uint32_t)(word[at / 64U] >> (at % 64U)) & pn_counter_most(width);
}

/* Adds to a counter, or subtracts: the caller has seen to it that it fits. */
PN_INLINE void pn_counter_add(uint64_t *word, uint32_t bit, uint32_t width, uint32_t i, uint32_t count)
{
    const uint32_t at = bit + (i * width);
    word[at / 64U] += (uint64_t)count << (at % 64U);
}

PN_INLINE void pn_counter_subtract(uint64_t *word, uint32_t bit, uint32_t width, uint32_t i, uint32_t count)
{
    const uint32_t at = bit + (i * width);
    word[at / 64U] -= (uint64_t)count << (at % 64U);
}

/* The first counter from `from` on that is not 0; `colours` if there is none. */
PN_SHARED uint32_t pn_counter_next(const uint64_t *word, uint32_t bit, uint32_t colours, uint32_t width, uint32_t from)
{
    const uint32_t end = bit + (colours * width);
    uint32_t at = bit + (from * width);
    while (at < end) {
        const uint64_t rest = word[at / 64U] >> (at % 64U);
        if (rest != 0U) {
            const uint32_t found = (at - bit + pn_lowest_bit(rest)) / width;
            return (found < colours) ? found : colours; /* what is behind the last counter belongs to other places */
        }
        at = (at | 63U) + 1U;
    }
    return colours;
}

/* Takes from a counter if there is as much; `i` may be no colour. */
PN_SHARED bool pn_counter_take(uint64_t *word, uint32_t bit, uint32_t width, uint32_t i, uint32_t count)
{
    if ((i == PN_NO_COLOUR) || (pn_counter(word, bit, width, i) < count)) {
        return false;
    }
    pn_counter_subtract(word, bit, width, i, count);
    return true;
}

/* Adds to a counter of a place, which is called `multiset` in the error when it would overflow. */
PN_SHARED bool pn_counter_put(pn_ctx_t *cx, uint64_t *word, uint32_t bit, uint32_t width, uint32_t i, uint32_t count,
                              const pn_multiset_t *multiset)
{
    if (count == 0U) {
        return true;
    }
    if ((i == PN_NO_COLOUR) || (count > (pn_counter_most(width) - pn_counter(word, bit, width, i)))) {
        return pn_multiset_fail_full(cx, multiset);
    }
    pn_counter_add(word, bit, width, i, count);
    return true;
}

/* --- sums: whole multi-sets as counters, in words of their own that lie as those of the place do ------------------ */

/* Words of a sum. */
#define PN_SUM_WORDS(first, colours, width) (((((first) % 64U) + ((colours) * (width))) + 63U) / 64U)

/* Whether it is known, for some values of its variables. */
typedef enum pn_sum_state {
    PN_SUM_UNKNOWN,
    PN_SUM_KNOWN,
    PN_SUM_OTHER /* it does not fit into the counters, or is not in the colour set */
} pn_sum_state_t;

/* Makes a sum of a list with cells of `list`; unknown after an error. */
pn_sum_state_t pn_sum_make(pn_ctx_t *cx, const pn_multiset_t *multiset, const pn_type_t *list, const void *values,
                           uint64_t *sum);

PN_INLINE bool pn_sum_is_in(const uint64_t *word, uint32_t bit, uint32_t colours, uint32_t width, const uint64_t *sum)
{
    bool is_in = true;
    if (width == 1U) {
        for (uint32_t k = 0U; k < PN_SUM_WORDS(bit, colours, width); k++) {
            is_in = is_in && ((sum[k] & ~word[(bit / 64U) + k]) == 0U);
        }
        return is_in;
    }
    const uint32_t start = bit % 64U;
    for (uint32_t i = pn_counter_next(sum, start, colours, width, 0U); is_in && (i < colours);
         i = pn_counter_next(sum, start, colours, width, i + 1U)) {
        is_in = pn_counter(sum, start, width, i) <= pn_counter(word, bit, width, i);
    }
    return is_in;
}

PN_INLINE bool pn_sum_has_room(const uint64_t *word, uint32_t bit, uint32_t colours, uint32_t width,
                               const uint64_t *sum)
{
    bool has_room = true;
    if (width == 1U) {
        for (uint32_t k = 0U; k < PN_SUM_WORDS(bit, colours, width); k++) {
            has_room = has_room && ((sum[k] & word[(bit / 64U) + k]) == 0U);
        }
        return has_room;
    }
    const uint32_t start = bit % 64U;
    for (uint32_t i = pn_counter_next(sum, start, colours, width, 0U); has_room && (i < colours);
         i = pn_counter_next(sum, start, colours, width, i + 1U)) {
        has_room = pn_counter(sum, start, width, i) <= (pn_counter_most(width) - pn_counter(word, bit, width, i));
    }
    return has_room;
}

/* Where it fits, no counter runs over into the next. */
PN_INLINE void pn_sum_add(uint64_t *word, uint32_t bit, uint32_t colours, uint32_t width, const uint64_t *sum)
{
    for (uint32_t k = 0U; k < PN_SUM_WORDS(bit, colours, width); k++) {
        word[(bit / 64U) + k] += sum[k];
    }
}

PN_INLINE void pn_sum_subtract(uint64_t *word, uint32_t bit, uint32_t colours, uint32_t width, const uint64_t *sum)
{
    for (uint32_t k = 0U; k < PN_SUM_WORDS(bit, colours, width); k++) {
        word[(bit / 64U) + k] -= sum[k];
    }
}

/* What the functions of places that are alike have before the marking, and give to one another: the place's table. */
#define PN_PACKED_PARAMETER const pn_multiset_t *at,
#define PN_PACKED_ARGUMENT  at,

/* The functions of a place; `first`, `multiset`: the first bit and the table. */
#define PN_PACKED_PLACE(place, marking_t, value_t, number_of, first, colours, width, is_whole, multiset) \
    PN_PACKED_FUNCTIONS(place, , , marking_t, value_t, number_of, (first), colours, width, is_whole, multiset)

/* The functions of all places that have the same colours in counters of the same width, each given by its table. */
#define PN_PACKED_KIND(kind, marking_t, value_t, number_of, colours, width, is_whole)                            \
    PN_PACKED_FUNCTIONS(kind, PN_PACKED_PARAMETER, PN_PACKED_ARGUMENT, marking_t, value_t, number_of, (at->bit), \
                        colours, width, is_whole, *at)

#define PN_PACKED_FUNCTIONS(place, parameter, argument, marking_t, value_t, number_of, first, colours, width,   \
                            is_whole, multiset)                                                                 \
    PN_INLINE uint32_t place##_count_of(parameter const marking_t *m, uint32_t i)                               \
    {                                                                                                           \
        return pn_counter(m->packed, (first), (width), i);                                                      \
    }                                                                                                           \
    PN_INLINE uint32_t place##_next(parameter const marking_t *m, uint32_t i)                                   \
    {                                                                                                           \
        return pn_counter_next(m->packed, (first), (colours), (width), i);                                      \
    }                                                                                                           \
    PN_INLINE bool place##_is_empty(parameter const marking_t *m)                                               \
    {                                                                                                           \
        return place##_next(argument m, 0U) == (colours);                                                       \
    }                                                                                                           \
    PN_INLINE uint32_t place##_held(parameter const marking_t *m, const value_t *v)                             \
    {                                                                                                           \
        const uint32_t i = number_of(v);                                                                        \
        return (i != PN_NO_COLOUR) ? place##_count_of(argument m, i) : 0U;                                      \
    }                                                                                                           \
    PN_INLINE bool place##_holds(parameter const marking_t *m, const value_t *v, const value_t *w)              \
    {                                                                                                           \
        const uint32_t i = number_of(v);                                                                        \
        const uint32_t k = number_of(w);                                                                        \
        if ((i == PN_NO_COLOUR) || (k == PN_NO_COLOUR)) {                                                       \
            return false;                                                                                       \
        }                                                                                                       \
        return (i == k) ? (place##_count_of(argument m, i) >= 2U)                                               \
                        : ((place##_count_of(argument m, i) >= 1U) && (place##_count_of(argument m, k) >= 1U)); \
    }                                                                                                           \
    PN_INLINE bool place##_take(parameter marking_t *m, const value_t *v, uint32_t n)                           \
    {                                                                                                           \
        return pn_counter_take(m->packed, (first), (width), number_of(v), n);                                   \
    }                                                                                                           \
    PN_INLINE bool place##_add(pn_ctx_t *cx, parameter marking_t *m, const value_t *v, uint32_t n)              \
    {                                                                                                           \
        return pn_counter_put(cx, m->packed, (first), (width), number_of(v), n, &(multiset));                   \
    }                                                                                                           \
    PN_INLINE void place##_check(pn_ctx_t *cx, parameter value_t *v)                                            \
    {                                                                                                           \
        static PN_OF_THREAD bool is_colour[(is_whole) ? 1U : (colours)];                                        \
        const uint32_t i = number_of(v);                                                                        \
        if ((i == PN_NO_COLOUR) || !((is_whole) || is_colour[(is_whole) ? 0U : i])) {                           \
            pn_multiset_check(cx, &(multiset), v);                                                              \
            if ((i != PN_NO_COLOUR) && !(is_whole) && pn_ok(cx)) {                                              \
                is_colour[i] = true;                                                                            \
            }                                                                                                   \
        }                                                                                                       \
    }                                                                                                           \
    PN_INLINE bool place##_has_sum(parameter const marking_t *m, const uint64_t *sum)                           \
    {                                                                                                           \
        return pn_sum_is_in(m->packed, (first), (colours), (width), sum);                                       \
    }                                                                                                           \
    PN_INLINE bool place##_take_sum(parameter marking_t *m, const uint64_t *sum)                                \
    {                                                                                                           \
        const bool is_in = pn_sum_is_in(m->packed, (first), (colours), (width), sum);                           \
        if (is_in) {                                                                                            \
            pn_sum_subtract(m->packed, (first), (colours), (width), sum);                                       \
        }                                                                                                       \
        return is_in;                                                                                           \
    }                                                                                                           \
    PN_INLINE bool place##_add_sum(pn_ctx_t *cx, parameter marking_t *m, const uint64_t *sum)                   \
    {                                                                                                           \
        if (!pn_sum_has_room(m->packed, (first), (colours), (width), sum)) {                                    \
            return pn_multiset_fail_full(cx, &(multiset));                                                      \
        }                                                                                                       \
        pn_sum_add(m->packed, (first), (colours), (width), sum);                                                \
        return true;                                                                                            \
    }

#endif /* PN_PACKED_H */
