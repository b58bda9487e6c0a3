/* SPDX-License-Identifier: MIT
 * pn_packed.h - packed places: a multi-set over few colours as counters of a few bits each.
 *
 * The colours of the place's colour set are numbered from 0 in the colour set's order. Counter i, the number of tokens of colour i,
 * is `width` bits at bit `bit` + i * `width` of the packed part, the array of 64-bit words with which a marking begins (bit k is bit
 * k % 64 of word k / 64). A counter never lies across two words. Bits that belong to no counter are 0: equal markings, equal bytes.
 *
 * PN_PACKED_PLACE makes, for a place, what PN_UNTIMED_PLACE of pn_place.h makes for others, and
 *
 *     place_count_of(m, i)    the number of tokens of colour i
 *     place_next(m, i)        the first colour from i on of which there is a token; the number of colours if there is none
 *     place_is_empty(m)       whether there is no token
 *     place_check(cx, v)      raises PN_ERR_COLOUR at the place if the value is not in the colour set
 *
 * Unlike there, place_add changes nothing when a counter would overflow.
 */
#ifndef PN_PACKED_H
#define PN_PACKED_H

#include "pn/pn_bag.h"
#include "pn/pn_place.h"

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
PN_INLINE uint32_t pn_counter_next(const uint64_t *word, uint32_t bit, uint32_t colours, uint32_t width, uint32_t from)
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

#define PN_PACKED_PLACE(place, marking_t, value_t, number_of, first, colours, width, bag)                          \
    PN_INLINE uint32_t place##_count_of(const marking_t *m, uint32_t i)                                            \
    {                                                                                                              \
        return pn_counter(m->packed, (first), (width), i);                                                         \
    }                                                                                                              \
    PN_INLINE uint32_t place##_next(const marking_t *m, uint32_t i)                                                \
    {                                                                                                              \
        return pn_counter_next(m->packed, (first), (colours), (width), i);                                         \
    }                                                                                                              \
    PN_INLINE bool place##_is_empty(const marking_t *m)                                                            \
    {                                                                                                              \
        return place##_next(m, 0U) == (colours);                                                                   \
    }                                                                                                              \
    PN_INLINE uint32_t place##_held(const marking_t *m, const value_t *v)                                          \
    {                                                                                                              \
        const uint32_t i = number_of(v);                                                                           \
        return (i != PN_NO_COLOUR) ? place##_count_of(m, i) : 0U;                                                  \
    }                                                                                                              \
    PN_INLINE bool place##_holds(const marking_t *m, const value_t *v, const value_t *w)                           \
    {                                                                                                              \
        const uint32_t i = number_of(v);                                                                           \
        const uint32_t k = number_of(w);                                                                           \
        if ((i == PN_NO_COLOUR) || (k == PN_NO_COLOUR)) {                                                          \
            return false;                                                                                          \
        }                                                                                                          \
        return (i == k) ? (place##_count_of(m, i) >= 2U) : ((place##_count_of(m, i) >= 1U) && (place##_count_of(m, k) >= 1U)); \
    }                                                                                                              \
    PN_INLINE bool place##_take(marking_t *m, const value_t *v, uint32_t n)                                        \
    {                                                                                                              \
        const uint32_t i = number_of(v);                                                                           \
        if ((i == PN_NO_COLOUR) || (place##_count_of(m, i) < n)) {                                                 \
            return false;                                                                                          \
        }                                                                                                          \
        pn_counter_subtract(m->packed, (first), (width), i, n);                                                    \
        return true;                                                                                               \
    }                                                                                                              \
    PN_INLINE bool place##_add(pn_ctx_t *cx, marking_t *m, const value_t *v, uint32_t n)                           \
    {                                                                                                              \
        const uint32_t i = number_of(v);                                                                           \
        if ((i == PN_NO_COLOUR) || (n > (pn_counter_most(width) - place##_count_of(m, i)))) {                      \
            return pn_bag_fail_full(cx, &(bag));                                                                   \
        }                                                                                                          \
        pn_counter_add(m->packed, (first), (width), i, n);                                                         \
        return true;                                                                                               \
    }                                                                                                              \
    PN_INLINE void place##_check(pn_ctx_t *cx, value_t *v)                                                         \
    {                                                                                                              \
        if (number_of(v) == PN_NO_COLOUR) {                                                                        \
            pn_bag_check(cx, &(bag), v);                                                                           \
        }                                                                                                          \
    }

#endif /* PN_PACKED_H */
