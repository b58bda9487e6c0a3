/* SPDX-License-Identifier: MIT
 * pn_marking.h - whole markings of a net: what is done in the same way in every net, from the tables of pn_net_t alone.
 */
#ifndef PN_MARKING_H
#define PN_MARKING_H

#include <string.h>

#include "pn/pn_multiset.h"
#include "pn/pn_net.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Model time. */
static inline pn_time_t pn_now(const pn_net_t *net, const void *marking)
{
    pn_time_t now;
    (void)memcpy(&now, (const unsigned char *)marking + net->now_at, sizeof now);
    return now;
}

static inline void pn_set_now(const pn_net_t *net, void *marking, pn_time_t now)
{
    (void)memcpy((unsigned char *)marking + net->now_at, &now, sizeof now);
}

/* Bytes of the largest binding; 1 where there are no transitions. */
size_t pn_binding_size(const pn_net_t *net);
/* Makes the initial marking in any memory, and gives the variables outside the marking their first values. Empties the
 * arena before. False on error. */
PN_NODISCARD bool pn_marking_init(const pn_net_t *net, pn_ctx_t *cx, void *marking);
/* Puts one token made of scalars into a place, stamped with the marking's time. False (the context has the error) when
 * they do not fit the colour set or the place is full. */
PN_NODISCARD bool pn_marking_put(const pn_net_t *net, pn_ctx_t *cx, void *marking, uint32_t place,
                                 const pn_scalar_value_t *scalar_value, uint32_t scalars);
/* The earliest time after now at which something may become enabled: a stamp ends, or the delay of an input arc lets a
 * token be taken before that. False if there is none, or after an error (delays are computed). */
bool pn_next_time(const pn_net_t *net, pn_ctx_t *cx, const void *marking, pn_time_t *next);
/* Canonical bytes of a marking: equal markings, equal bytes. Returns the length, 0 when `capacity` is too small. */
size_t pn_marking_encode(const pn_net_t *net, const void *marking, uint8_t *out, size_t capacity);
/* Reads them back into any memory. False when they are malformed or a place is full. */
PN_NODISCARD bool pn_marking_decode(const pn_net_t *net, pn_ctx_t *cx, void *marking, const uint8_t *in, size_t length);
/* Between occurrences: moves what the marking and the variables outside refer to into the other half of the arena
 * (pn_arena.h). */
void pn_marking_collect(const pn_net_t *net, pn_ctx_t *cx, void *marking);

#ifdef __cplusplus
}
#endif

#endif /* PN_MARKING_H */
