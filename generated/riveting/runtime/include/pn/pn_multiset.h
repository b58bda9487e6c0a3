/* SPDX-License-Identifier: MIT
 * pn_multiset.h - the multi-set of a place inside a marking, and the moves of a firing.
 *
 * The generated marking holds, for each place, a number of used entries and a fixed array of tokens
 *
 *     struct { uint32_t used; struct { pose_t value; uint32_t count; } token[64]; } Waiting;           untimed
 *     struct { uint32_t used; struct { pose_t value; uint32_t count; pn_time_t stamp; } token[64]; }   timed
 *
 * sorted by value, then stamp, without equal neighbours; or, if it is packed, a counter for each colour (pn_packed.h);
 * or, if it holds one token at most, a slot
 *
 *     struct { pose_t value; bool full; } Waiting;
 *
 * A pn_multiset_t tells where they are.
 */
#ifndef PN_MULTISET_H
#define PN_MULTISET_H

#include "pn/pn_type.h"

typedef struct pn_multiset {
    const char *origin;    /* "page `Robot`, place `Waiting` (ID1407)" */
    const pn_type_t *type; /* colour set */
    uint32_t capacity;     /* entries: so many distinct colours, with so many stamps, fit */
    bool is_timed;
    bool is_real_time; /* stamps are reals */
    size_t at;         /* offset in the marking of what holds its tokens */
    bool is_slot;      /* `used` is a bool, and there is one entry, of one token, which is a value and nothing else */
    size_t used;       /* offset of `used` in the marking */
    size_t first;      /* offset of token[0] in the marking */
    size_t stride;     /* size of a token */
    size_t value;      /* offsets in a token */
    size_t count;
    size_t stamp;
    uint32_t early_count; /* of the constant delays of input arcs (`x@+3`), by which tokens may be taken before their
                             stamps */
    const pn_time_t *early;
    /* A packed place holds, for each colour, a counter of `width` bits in the packed part of the marking. Counter i, of
     * colour i in the order of the colour set, starts at bit `bit` + i * `width`; bit k of the packed part is bit k % 8
     * of byte k / 8. And the number of a colour (PN_NO_COLOUR: it is none), and the colour of a number. */
    bool is_packed;
    uint32_t bit;
    uint32_t colours; /* number of counters; 0 if it is not packed */
    uint32_t width;
    uint32_t (*number_of)(const void *value);
    void (*colour_of)(uint32_t number, void *value);
} pn_multiset_t;

#define PN_NO_COLOUR UINT32_MAX

/* Whether a place is packed; a net without packed places is compiled with -DPN_ARRAYS_ONLY, which leaves their code
 * out. */
#if defined(PN_ARRAYS_ONLY)
#define PN_IS_PACKED(multiset) (false)
#else
#define PN_IS_PACKED(multiset) ((multiset)->is_packed)
#endif

/* Room for a colour of a packed place. */
typedef union pn_colour {
    max_align_t align;
    unsigned char bytes[256];
} pn_colour_t;

/* The offsets of a place `member` of a marking, for the initialiser of a pn_multiset_t. */
#define PN_MULTISET_TOKENS(marking_type, member)                                                                 \
    .at = offsetof(marking_type, member), .used = offsetof(marking_type, member.used),                           \
    .first = offsetof(marking_type, member.token), .stride = sizeof(((const marking_type *)0)->member.token[0]), \
    .value = offsetof(marking_type, member.token[0].value) - offsetof(marking_type, member.token),               \
    .count = offsetof(marking_type, member.token[0].count) - offsetof(marking_type, member.token)
/* The same for a slot, and for a timed array. */
#define PN_MULTISET_SLOT(marking_type, member)                                                          \
    .at = offsetof(marking_type, member), .is_slot = true, .used = offsetof(marking_type, member.full), \
    .first = offsetof(marking_type, member.value), .stride = sizeof(((const marking_type *)0)->member.value)
#define PN_MULTISET_STAMPS(marking_type, member) \
    PN_MULTISET_TOKENS(marking_type, member),    \
        .stamp = offsetof(marking_type, member.token[0].stamp) - offsetof(marking_type, member.token)

/* What holds the tokens of a place that is not packed. */
static inline const void *pn_multiset_look(const pn_multiset_t *multiset, const void *marking)
{
    return (const unsigned char *)marking + multiset->at;
}
static inline void *pn_multiset_reach(const pn_multiset_t *multiset, void *marking)
{
    return (unsigned char *)marking + multiset->at;
}

/* Number of tokens. */
uint64_t pn_multiset_total(const pn_multiset_t *multiset, const void *marking);
/* Number of tokens with a stamp not after `now`; all of them in an untimed place. */
uint64_t pn_multiset_available(const pn_multiset_t *multiset, const void *marking, pn_time_t now);
/* Number of tokens of one value with a stamp not after `limit`. */
uint64_t pn_multiset_count(const pn_multiset_t *multiset, const void *marking, const void *value, pn_time_t limit);
/* Adds tokens. False (PN_ERR_CAPACITY, nothing changed) when there is no room. */
bool pn_multiset_add(pn_ctx_t *cx, const pn_multiset_t *multiset, void *marking, const void *value, uint32_t count,
                     pn_time_t stamp);
/* Raises PN_ERR_CAPACITY at the place; false. */
bool pn_multiset_fail_full(pn_ctx_t *cx, const pn_multiset_t *multiset);
/* Raises that if a slot is full: whether a token can be put there. */
static inline bool pn_has_room(pn_ctx_t *cx, bool is_full, const pn_multiset_t *multiset)
{
    return !is_full || pn_multiset_fail_full(cx, multiset);
}
/* Raises PN_ERR_SUBTRACT: a token that an occurrence takes is not there; false. */
bool pn_fail_missing(pn_ctx_t *cx);
/* Narrows a value and raises PN_ERR_COLOUR at the place if it is not in the colour set. */
void pn_multiset_check(pn_ctx_t *cx, const pn_multiset_t *multiset, void *value);
void pn_multiset_clear(const pn_multiset_t *multiset, void *marking);
/* No tokens, in memory that may hold anything; a packed place has to be cleared with the packed part. */
void pn_multiset_begin(const pn_multiset_t *multiset, void *marking);
/* Integer stamps count from `by` on, and those that are not after it are 0 and equal. */
void pn_multiset_age(const pn_multiset_t *multiset, void *marking, pn_time_t by);
/* The earliest time after `now` at which a token becomes available to arcs with constant delays, if it is before *next
 * or *found is false; and the same for arcs with one delay, which was computed. */
void pn_multiset_next_time(const pn_multiset_t *multiset, const void *marking, pn_time_t now, bool *found,
                           pn_time_t *next);
void pn_multiset_threshold(const pn_multiset_t *multiset, const void *marking, pn_time_t now, pn_time_t early,
                           bool *found, pn_time_t *next);
void pn_multiset_json(const pn_multiset_t *multiset, const void *marking, pn_text_t *out);
uint32_t pn_multiset_token(const pn_multiset_t *multiset, const void *marking, uint32_t i,
                           pn_scalar_value_t *scalar_value, uint32_t capacity);
/* Adds one token made of scalars, stamped with the context's time. */
bool pn_multiset_put(pn_ctx_t *cx, const pn_multiset_t *multiset, void *marking, const pn_scalar_value_t *scalar_value,
                     uint32_t scalars);
/* Of a timed place they begin with the length of what comes before the stamps, as a uint32_t. */
#define PN_STAMPS_AT sizeof(uint32_t)
size_t pn_multiset_encode(const pn_multiset_t *multiset, const void *marking, uint8_t *out, size_t room);
size_t pn_multiset_decode(pn_ctx_t *cx, const pn_multiset_t *multiset, void *marking, const uint8_t *in, size_t length);
/* As pn_multiset_decode, but what is there stays. */
size_t pn_multiset_add_bytes(pn_ctx_t *cx, const pn_multiset_t *multiset, void *marking, const uint8_t *in,
                             size_t length);
void pn_multiset_relocate(pn_ctx_t *cx, const pn_multiset_t *multiset, void *marking);
/* A colour of a packed place as JSON; false if there is no such one. */
bool pn_multiset_colour_json(const pn_multiset_t *multiset, uint32_t number, pn_text_t *out);

/* Times as the context and the tokens hold them. */
#define PN_NO_TIME ((pn_time_t){ .integer = 0 })
static inline pn_time_t pn_time_int(int64_t time)
{
    return (pn_time_t){ .integer = time };
}
static inline pn_time_t pn_time_real(double time)
{
    return (pn_time_t){ .real = time };
}
/* Order of two times. */
int pn_time_order(bool is_real_time, pn_time_t a, pn_time_t b);

/* --- moves: what a firing takes and puts -------------------------------------------------------------------------- */

typedef enum pn_move_kind { PN_MOVE_TAKE, PN_MOVE_PUT, PN_MOVE_RESET } pn_move_kind_t;

typedef struct pn_move {
    struct pn_move *next;
    pn_move_kind_t kind;
    const pn_multiset_t *multiset;
    const void *value;
    uint32_t count;
    pn_time_t time;  /* TAKE: latest stamp; PUT: the stamp */
    pn_time_t taken; /* TAKE, once done: the stamp of the token that was taken */
    bool is_done;
} pn_move_t;

/* The moves of one firing, collected in the arena: first everything is worked out, then pn_moves_commit does it. */
typedef struct pn_moves {
    pn_ctx_t *cx;
    pn_move_t *first;
    pn_move_t *last;
} pn_moves_t;

/* A coefficient as a number of tokens, 0 if it is negative. Raises PN_ERR_CAPACITY when it is beyond all places. */
uint32_t pn_token_count(pn_ctx_t *cx, int64_t count);
void pn_moves_init(pn_moves_t *moves, pn_ctx_t *cx);
/* Wants `count` tokens (none if count <= 0) of a value with stamps not after `limit`. The value is copied. */
void pn_moves_take(pn_moves_t *moves, const pn_multiset_t *multiset, const void *value, int64_t count, pn_time_t limit);
/* Wants every element of a multi-set, a list with cells of `list`. */
void pn_moves_take_list(pn_moves_t *moves, const pn_multiset_t *multiset, const pn_type_t *list, const void *values,
                        pn_time_t limit);
/* Puts tokens: narrowed, then checked against the colour set (PN_ERR_COLOUR). */
void pn_moves_put(pn_moves_t *moves, const pn_multiset_t *multiset, const void *value, int64_t count, pn_time_t stamp);
void pn_moves_put_list(pn_moves_t *moves, const pn_multiset_t *multiset, const pn_type_t *list, const void *values,
                       pn_time_t stamp);
/* Puts a timed multi-set: a list of { value; stamp } whose element type is the record `timed`; `delay` is added to each
 * stamp. */
void pn_moves_put_timed(pn_moves_t *moves, const pn_multiset_t *multiset, const pn_type_t *list, const void *values,
                        pn_time_t delay);
/* Empties a place at the end; a timed one keeps what is stamped after `now`. */
void pn_moves_reset(pn_moves_t *moves, const pn_multiset_t *multiset, pn_time_t now);
/* Whether the marking holds all that is wanted, together. Changes nothing. */
bool pn_moves_are_possible(const pn_moves_t *moves, const void *marking);
/* Takes, then puts, then resets. On error (also one that is there already) the marking is as before, and the answer
 * false. */
bool pn_moves_commit(pn_moves_t *moves, void *marking);

#endif /* PN_MULTISET_H */
