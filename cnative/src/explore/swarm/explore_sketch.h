/* SPDX-License-Identifier: MIT
 * explore_sketch.h - of a large set of states a small one, by which sets can be compared (explore_sketch.c).
 */
#ifndef EXPLORE_SKETCH_H
#define EXPLORE_SKETCH_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "../state/explore_key.h"

struct ex_worker;

typedef struct ex_sketch {
    uint32_t most; /* hashes that are kept; 0: there is no sketch */
    uint32_t count;
    uint64_t *least;   /* the least hashes, in ascending order */
    uint64_t *content; /* by number of a string of bytes: its hash; 0: not known yet */
    uint64_t contents;
} ex_sketch_t;

/* False: no memory. */
bool ex_sketch_make(struct ex_worker *worker, ex_sketch_t *sketch, uint32_t most);
/* Opens a state and takes it into the set. False after an error. */
bool ex_sketch_see(struct ex_worker *worker, ex_sketch_t *sketch, const ex_key_t *key);
/* As a list of JSON. */
void ex_sketch_json(const ex_sketch_t *sketch, FILE *out);

#endif /* EXPLORE_SKETCH_H */
