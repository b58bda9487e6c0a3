/* SPDX-License-Identifier: MIT
 * pn_place.h - the untimed place with the types known: what pn_bag.h does through tables, as inline functions.
 *
 * PN_UNTIMED_PLACE makes, for the member `place` of the marking,
 *
 *     place_find(m, v)        the first entry that is not before *v
 *     place_held(m, v)        the number of tokens of that value
 *     place_holds(m, v, w)    whether there is a token v and another token w
 *     place_take(m, v, n)     takes n of them; false, and nothing taken, when there are fewer
 *     place_add(cx, m, v, n)  puts n of them; false (PN_ERR_CAPACITY) when there are now more than the place may hold
 *
 * Behind its capacity the array has room for all that one occurrence may put: nothing is ever written outside, and what has been
 * put beyond the capacity can be taken out again.
 */
#ifndef PN_PLACE_H
#define PN_PLACE_H

#include <string.h>

#include "pn/pn_bag.h"

#if defined(__GNUC__)
#define PN_MAYBE_UNUSED __attribute__((unused))
#else
#define PN_MAYBE_UNUSED
#endif
/* Copies cost the compiler time. Without optimization they save none; in a net of many transitions (PN_MANY) the compiler decides
 * itself which ones are worth it. */
#if defined(__GNUC__) && defined(__OPTIMIZE__) && !defined(PN_MANY)
#define PN_INLINE __attribute__((always_inline, unused)) static inline
#else
#define PN_INLINE PN_MAYBE_UNUSED static inline
#endif

/* Copies what an array place holds from one marking into another. */
#define PN_COPY_PLACE(place, to, from)                                                                              \
    do {                                                                                                            \
        (to)->place.used = (from)->place.used;                                                                      \
        (void)memcpy((to)->place.token, (from)->place.token, (from)->place.used * sizeof (to)->place.token[0]);     \
    } while (false)

/* The order of values that C compares itself. */
#define PN_LESS(a, b) (*(a) < *(b))

#define PN_UNTIMED_PLACE(place, marking_t, value_t, less, bag)                                                      \
    PN_MAYBE_UNUSED static inline uint32_t place##_find(const marking_t *m, const value_t *v)                       \
    {                                                                                                               \
        uint32_t low = 0U;                                                                                          \
        uint32_t high = m->place.used;                                                                              \
        while (low < high) {                                                                                        \
            const uint32_t middle = low + ((high - low) / 2U);                                                      \
            if (less(&m->place.token[middle].value, v)) {                                                           \
                low = middle + 1U;                                                                                  \
            } else {                                                                                                \
                high = middle;                                                                                      \
            }                                                                                                       \
        }                                                                                                           \
        return low;                                                                                                 \
    }                                                                                                               \
    PN_MAYBE_UNUSED static inline uint32_t place##_held(const marking_t *m, const value_t *v)                       \
    {                                                                                                               \
        const uint32_t i = place##_find(m, v);                                                                      \
        const bool is_there = (i < m->place.used) && !less(v, &m->place.token[i].value);                            \
        return is_there ? m->place.token[i].count : 0U;                                                             \
    }                                                                                                               \
    PN_MAYBE_UNUSED static inline bool place##_holds(const marking_t *m, const value_t *v, const value_t *w)        \
    {                                                                                                               \
        const bool is_same = !less(v, w) && !less(w, v);                                                            \
        return is_same ? (place##_held(m, v) >= 2U) : ((place##_held(m, v) >= 1U) && (place##_held(m, w) >= 1U));   \
    }                                                                                                               \
    PN_MAYBE_UNUSED static inline bool place##_take(marking_t *m, const value_t *v, uint32_t n)                     \
    {                                                                                                               \
        const uint32_t i = place##_find(m, v);                                                                      \
        const uint32_t used = m->place.used;                                                                        \
        if ((i >= used) || less(v, &m->place.token[i].value) || (m->place.token[i].count < n)) {                    \
            return false;                                                                                           \
        }                                                                                                           \
        m->place.token[i].count -= n;                                                                               \
        if (m->place.token[i].count == 0U) {                                                                        \
            for (uint32_t k = i + 1U; k < used; k++) {                                                              \
                m->place.token[k - 1U] = m->place.token[k];                                                         \
            }                                                                                                       \
            m->place.used = used - 1U;                                                                              \
        }                                                                                                           \
        return true;                                                                                                \
    }                                                                                                               \
    PN_MAYBE_UNUSED static inline bool place##_add(pn_ctx_t *cx, marking_t *m, const value_t *v, uint32_t n)        \
    {                                                                                                               \
        const uint32_t i = place##_find(m, v);                                                                      \
        const uint32_t used = m->place.used;                                                                        \
        if (n == 0U) {                                                                                              \
            return true;                                                                                            \
        }                                                                                                           \
        if ((i < used) && !less(v, &m->place.token[i].value)) {                                                     \
            m->place.token[i].count += n;                                                                           \
            return (m->place.token[i].count >= n) || pn_bag_fail_full(cx, &(bag));                                  \
        }                                                                                                           \
        for (uint32_t k = used; k > i; k--) {                                                                       \
            m->place.token[k] = m->place.token[k - 1U];                                                             \
        }                                                                                                           \
        m->place.token[i].value = *v;                                                                               \
        m->place.token[i].count = n;                                                                                \
        m->place.used = used + 1U;                                                                                  \
        return (used < (bag).capacity) || pn_bag_fail_full(cx, &(bag));                                             \
    }

#endif /* PN_PLACE_H */
