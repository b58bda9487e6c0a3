/* SPDX-License-Identifier: MIT
 * explore_counting.h - transitions that only count: constant numbers of `()` from and to packed places.
 *
 * Such a transition has no code of its own in an explorer, only a table, pn_transition_t.places, with a row for each
 * place. All of the net's places are packed, so that a marking is its packed part and its time.
 */
#ifndef EXPLORE_COUNTING_H
#define EXPLORE_COUNTING_H

#include "pn/pn_multiset.h"
#include "pn/pn_net.h"

typedef struct pn_count {
    const pn_multiset_t *multiset; /* a place with one counter */
    uint32_t bit;                  /* of that counter */
    uint32_t width;
    uint32_t needs; /* an occurrence is possible if so many tokens are there */
    uint32_t takes; /* not more than it needs */
    uint32_t puts;  /* after it has taken */
} pn_count_t;

typedef struct pn_counting {
    uint32_t count;
    const pn_count_t *row;
    uint64_t key; /* the bits of the first word of the packed part from which all else follows */
} pn_counting_t;

/* A binding of no variables. */
typedef struct pn_counting_binding {
    uint8_t none;
} pn_counting_binding_t;

extern const pn_type_t pn_counting_type;

bool pn_counting_enumerate(pn_ctx_t *cx, const void *marking, uint32_t self, pn_binding_sink_t sink, void *user);
bool pn_counting_fire(pn_ctx_t *cx, void *marking, uint32_t self, void *binding);
bool pn_counting_successors(pn_ctx_t *cx, const void *marking, uint32_t self, void *next, pn_successor_sink_t sink,
                            void *user);
bool pn_counting_words(pn_words_t *words, uint32_t self);

/* Members of a row of the table of transitions; of a row of what it counts. */
#define PN_COUNTING(rows, n)                                                                    \
    .enumerate = pn_counting_enumerate, .fire = pn_counting_fire, .binding = &pn_counting_type, \
    .successors = pn_counting_successors, .places = &(const pn_counting_t)                      \
    {                                                                                           \
        .count = (n), .row = (rows)                                                             \
    }
/* The same where markings have a short key. */
#define PN_COUNTING_WORDS(rows, n, bits)                                                               \
    .enumerate = pn_counting_enumerate, .fire = pn_counting_fire, .binding = &pn_counting_type,        \
    .successors = pn_counting_successors, .words = pn_counting_words, .places = &(const pn_counting_t) \
    {                                                                                                  \
        .count = (n), .row = (rows), .key = (bits)                                                     \
    }
#define PN_COUNT(place, at, bits, needed, taken, added) \
    { .multiset = (place), .bit = (at), .width = (bits), .needs = (needed), .takes = (taken), .puts = (added) }

#endif /* EXPLORE_COUNTING_H */
