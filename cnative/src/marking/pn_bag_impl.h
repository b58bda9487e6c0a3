/* SPDX-License-Identifier: MIT
 * pn_bag_impl.h - entries of a place's array, for pn_moves.c. Package-private.
 */
#ifndef PN_BAG_IMPL_H
#define PN_BAG_IMPL_H

#include "pn/pn_bag.h"

/* Number of entries in use, entry i, and what an entry holds. */
uint32_t pn_bag_used(const pn_bag_t *bag, const void *marking);
const void *pn_bag_entry(const pn_bag_t *bag, const void *marking, uint32_t i);
uint32_t pn_bag_count_of(const pn_bag_t *bag, const void *entry);
pn_time_t pn_bag_stamp_of(const pn_bag_t *bag, const void *entry);
/* The first entry that is not before the value, and whether entry i exists and has the value. */
uint32_t pn_bag_lower_bound(const pn_bag_t *bag, const void *marking, const void *value);
bool pn_bag_is_at(const pn_bag_t *bag, const void *marking, uint32_t i, const void *value);
/* Takes `count` tokens out of entry i, which has at least so many. */
void pn_bag_remove_at(const pn_bag_t *bag, void *marking, uint32_t i, uint32_t count);

/* Takes tokens of one value out of a packed place; false, and nothing taken, when there are fewer. */
bool pn_bag_take_packed(const pn_bag_t *bag, void *marking, const void *value, uint32_t count);

#endif /* PN_BAG_IMPL_H */
