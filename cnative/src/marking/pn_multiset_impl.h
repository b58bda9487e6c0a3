/* SPDX-License-Identifier: MIT
 * pn_multiset_impl.h - entries of a place's array, for pn_moves.c. Package-private.
 */
#ifndef PN_MULTISET_IMPL_H
#define PN_MULTISET_IMPL_H

#include "pn/pn_multiset.h"

/* Number of entries in use, entry i, and what an entry holds. */
uint32_t pn_multiset_used(const pn_multiset_t *multiset, const void *marking);
const void *pn_multiset_entry(const pn_multiset_t *multiset, const void *marking, uint32_t i);
uint32_t pn_multiset_count_of(const pn_multiset_t *multiset, const void *entry);
pn_time_t pn_multiset_stamp_of(const pn_multiset_t *multiset, const void *entry);
/* The first entry that is not before the value, and whether entry i exists and has the value. */
uint32_t pn_multiset_lower_bound(const pn_multiset_t *multiset, const void *marking, const void *value);
bool pn_multiset_is_at(const pn_multiset_t *multiset, const void *marking, uint32_t i, const void *value);
/* Takes `count` tokens out of entry i, which has at least so many. */
void pn_multiset_remove_at(const pn_multiset_t *multiset, void *marking, uint32_t i, uint32_t count);

/* Takes tokens of one value out of a packed place; false, and nothing taken, when there are fewer. */
bool pn_multiset_take_packed(const pn_multiset_t *multiset, void *marking, const void *value, uint32_t count);

#endif /* PN_MULTISET_IMPL_H */
