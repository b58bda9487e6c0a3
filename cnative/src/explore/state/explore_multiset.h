/* SPDX-License-Identifier: MIT
 * explore_multiset.h - numbers of multi-sets (explore_multiset.c).
 */
#ifndef EXPLORE_MULTISET_H
#define EXPLORE_MULTISET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct ex_run;
struct ex_worker;

/* Room for `size` bytes in the scratch buffer, which is empty then. False: no memory. */
bool ex_buffer_grow(struct ex_worker *worker, size_t size);
/* The number of a string of bytes. False: no memory. */
bool ex_intern(struct ex_worker *worker, uint32_t kind, const unsigned char *byte, size_t length, uint32_t *number);
/* The table of the places that `--heaps` names. False: no memory. */
bool ex_heaps_make(struct ex_run *run);
/* What a place of `next` holds as the number of a multi-set of `kind`: the place, or EX_ADDED + the place for what is
 * added to it. False: no memory, or the place is a heap that holds more than it needs to. */
#define EX_ADDED (pn_net.place_count + 1U)
bool ex_number_place(struct ex_worker *worker, uint32_t place, uint32_t kind, const void *next, uint32_t *number);
/* The bytes of such a multi-set as its place decodes them, until the next one is numbered or looked at. NULL: no
 * memory. */
const unsigned char *ex_multiset_bytes(struct ex_worker *worker, uint32_t number, size_t *length);

#endif /* EXPLORE_MULTISET_H */
