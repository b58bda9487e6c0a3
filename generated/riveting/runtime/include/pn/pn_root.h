/* SPDX-License-Identifier: MIT
 * pn_root.h - the state of a net besides its marking: what its references hold, as canonical bytes.
 *
 * Roots are variables of C. What they hold may refer to cells, which may be shared, refer to other roots, or to
 * themselves. Equal bytes, equal state: cells are numbered as they are met.
 */
#ifndef PN_ROOT_H
#define PN_ROOT_H

#include "pn/pn_net.h"

/* Appended at `out` if there is room; returns their number in any case. */
size_t pn_roots_encode(const pn_root_t *root, uint32_t count, uint8_t *out, size_t room);
/* Lets the roots hold what they held; everything else that they refer to is new, in the arena. The same bytes in an
 * arena that is as full give the same addresses. False: an error, or malformed bytes; the roots then hold anything. */
PN_NODISCARD bool pn_roots_decode(pn_ctx_t *cx, const pn_root_t *root, uint32_t count, const uint8_t *in,
                                  size_t length);

#endif /* PN_ROOT_H */
