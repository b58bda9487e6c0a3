/* SPDX-License-Identifier: MIT
 * explore_tokens.h - the marking of a place as a list of CPN ML, for the predicates of a net that is explored.
 */
#ifndef EXPLORE_TOKENS_H
#define EXPLORE_TOKENS_H

#include "pn/pn_multiset.h"

/* All tokens in order, as a list with cells of `list`: colours; of a timed place records of a colour and its stamp.
 * NULL is the empty one, and what is given with PN_ERR_MEMORY. */
const void *explore_tokens(pn_ctx_t *cx, const pn_multiset_t *multiset, const pn_type_t *list, const void *marking);

#endif /* EXPLORE_TOKENS_H */
