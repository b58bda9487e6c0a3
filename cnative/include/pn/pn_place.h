/* SPDX-License-Identifier: MIT
 * pn_place.h - the untimed place with the types known: what pn_multiset.h does through tables, as inline functions.
 *
 * PN_UNTIMED_ARRAY makes, for places whose tokens are in an `array_t`,
 *
 *     array_find(p, v)             the first entry that is not before *v
 *     array_held(p, v)             the number of tokens of that value
 *     array_holds(p, v, w)         whether there is a token v and another token w
 *     array_take(p, v, n)          takes n of them; false, and nothing taken, when there are fewer
 *     array_add(cx, p, multiset, v, n)
 *                                  puts n of them; false (PN_ERR_CAPACITY) when there are now more than the place may
 *                                  hold
 *     array_undo(p, v, n)          takes them out again, also where they are now more than can be counted
 *
 * Behind its capacity the array has room for all that one occurrence may put: nothing is ever written outside, and what
 * has been put beyond the capacity can be taken out again.
 */
#ifndef PN_PLACE_H
#define PN_PLACE_H

#include <string.h>

#include "pn/pn_multiset.h"

#if defined(__GNUC__)
#define PN_MAYBE_UNUSED __attribute__((unused))
#else
#define PN_MAYBE_UNUSED
#endif
/* Copies cost the compiler time. Without optimization they save none; in a net of many transitions (PN_MANY) the
 * compiler decides itself which ones are worth it. */
#if defined(__GNUC__) && defined(__OPTIMIZE__) && !defined(PN_MANY)
#define PN_INLINE __attribute__((always_inline, unused)) static inline
#else
#define PN_INLINE PN_MAYBE_UNUSED static inline
#endif

/* What would be copied into each transition of a large net is one function there, if it is worth a call. */
#if defined(__GNUC__) && defined(PN_MANY)
#define PN_SHARED __attribute__((noinline, unused)) static
#else
#define PN_SHARED PN_INLINE
#endif

/* What is seldom done, and would take the compiler long where it is copied to. */
#if defined(__GNUC__)
#define PN_APART __attribute__((noinline, unused)) static
#else
#define PN_APART static
#endif

/* Copies what an array place holds from one marking into another. */
#define PN_COPY_PLACE(place, to, from)                                                                         \
    do {                                                                                                       \
        (to)->place.used = (from)->place.used;                                                                 \
        (void)memcpy((to)->place.token, (from)->place.token, (from)->place.used * sizeof(to)->place.token[0]); \
    } while (false)

/* The order of values that C compares itself. */
#define PN_LESS(a, b) (*(a) < *(b))

#define PN_UNTIMED_ARRAY(array, value_t, less)                                                                    \
    PN_MAYBE_UNUSED static inline uint32_t array##_find(const array##_t *p, const value_t *v)                     \
    {                                                                                                             \
        uint32_t low = 0U;                                                                                        \
        uint32_t high = p->used;                                                                                  \
        while (low < high) {                                                                                      \
            const uint32_t middle = low + ((high - low) / 2U);                                                    \
            if (less(&p->token[middle].value, v)) {                                                               \
                low = middle + 1U;                                                                                \
            } else {                                                                                              \
                high = middle;                                                                                    \
            }                                                                                                     \
        }                                                                                                         \
        return low;                                                                                               \
    }                                                                                                             \
    PN_MAYBE_UNUSED static inline uint32_t array##_held(const array##_t *p, const value_t *v)                     \
    {                                                                                                             \
        const uint32_t i = array##_find(p, v);                                                                    \
        const bool is_there = (i < p->used) && !less(v, &p->token[i].value);                                      \
        return is_there ? p->token[i].count : 0U;                                                                 \
    }                                                                                                             \
    PN_MAYBE_UNUSED static inline bool array##_holds(const array##_t *p, const value_t *v, const value_t *w)      \
    {                                                                                                             \
        const bool is_same = !less(v, w) && !less(w, v);                                                          \
        return is_same ? (array##_held(p, v) >= 2U) : ((array##_held(p, v) >= 1U) && (array##_held(p, w) >= 1U)); \
    }                                                                                                             \
    PN_MAYBE_UNUSED static inline bool array##_take(array##_t *p, const value_t *v, uint32_t n)                   \
    {                                                                                                             \
        const uint32_t i = array##_find(p, v);                                                                    \
        const uint32_t used = p->used;                                                                            \
        if ((i >= used) || less(v, &p->token[i].value) || (p->token[i].count < n)) {                              \
            return false;                                                                                         \
        }                                                                                                         \
        p->token[i].count -= n;                                                                                   \
        if (p->token[i].count == 0U) {                                                                            \
            for (uint32_t k = i + 1U; k < used; k++) {                                                            \
                p->token[k - 1U] = p->token[k];                                                                   \
            }                                                                                                     \
            p->used = used - 1U;                                                                                  \
        }                                                                                                         \
        return true;                                                                                              \
    }                                                                                                             \
    PN_MAYBE_UNUSED static inline bool array##_add(pn_ctx_t *cx, array##_t *p, const pn_multiset_t *multiset,     \
                                                   const value_t *v, uint32_t n)                                  \
    {                                                                                                             \
        const uint32_t i = array##_find(p, v);                                                                    \
        const uint32_t used = p->used;                                                                            \
        if (n == 0U) {                                                                                            \
            return true;                                                                                          \
        }                                                                                                         \
        if ((i < used) && !less(v, &p->token[i].value)) {                                                         \
            p->token[i].count += n;                                                                               \
            return (p->token[i].count >= n) || pn_multiset_fail_full(cx, multiset);                               \
        }                                                                                                         \
        for (uint32_t k = used; k > i; k--) {                                                                     \
            p->token[k] = p->token[k - 1U];                                                                       \
        }                                                                                                         \
        p->token[i].value = *v;                                                                                   \
        p->token[i].count = n;                                                                                    \
        p->used = used + 1U;                                                                                      \
        return (used < multiset->capacity) || pn_multiset_fail_full(cx, multiset);                                \
    }                                                                                                             \
    PN_MAYBE_UNUSED static inline void array##_undo(array##_t *p, const value_t *v, uint32_t n)                   \
    {                                                                                                             \
        const uint32_t i = array##_find(p, v);                                                                    \
        if (n > 0U) {                                                                                             \
            p->token[i].count -= n;                                                                               \
            (void)((p->token[i].count == 0U) && array##_take(p, v, 0U));                                          \
        }                                                                                                         \
    }

#endif /* PN_PLACE_H */
