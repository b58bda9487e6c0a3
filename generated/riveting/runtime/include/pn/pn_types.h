/* SPDX-License-Identifier: MIT
 * pn_types.h - basic types of the runtime: the evaluation context and its errors.
 */
#ifndef PN_TYPES_H
#define PN_TYPES_H

#include <float.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The values of a net are those of the token game only where a double is a double and sums keep their order. */
#if defined(__FAST_MATH__)
#error "compile without -ffast-math: a net would compute other values than those that were verified"
#endif
#if FLT_EVAL_METHOD != 0
#error "this compiler computes with another precision than double's (32-bit x86: add -msse2 -mfpmath=sse)"
#endif

/* Model time: an integer, or a real (option `realtimestamp` of the net). pn_net_t.real_time says which member counts.
 */
typedef union pn_time {
    int64_t integer;
    double real;
} pn_time_t;

typedef enum pn_error {
    PN_OK = 0,
    PN_ERR_OVERFLOW,    /* CPN ML exception Overflow */
    PN_ERR_DIV,         /* Div */
    PN_ERR_MATCH,       /* Match: no rule fits */
    PN_ERR_BIND,        /* Bind: a val pattern does not fit */
    PN_ERR_SUBSCRIPT,   /* Subscript */
    PN_ERR_EMPTY,       /* Empty: hd, tl of an empty list */
    PN_ERR_DOMAIN,      /* Domain, Size, Chr and the like */
    PN_ERR_COLOUR,      /* a value that is not in the colour set */
    PN_ERR_CAPACITY,    /* a place or array is full */
    PN_ERR_MEMORY,      /* the arena is full */
    PN_ERR_DEPTH,       /* recursion too deep */
    PN_ERR_SUBTRACT,    /* multi-set difference of what is not contained */
    PN_ERR_RAISED,      /* an exception of the net itself */
    PN_ERR_ENDLESS,     /* an evaluation that does not come to an end; not an exception of CPN ML */
    PN_ERR_LARGE,       /* a model time beyond 64 bits; not an exception of CPN ML */
    PN_ERR_UNSUPPORTED, /* a library function that exists in CPN Tools and cannot run here; the name says which and why
                         */
    PN_ERR_INTERNAL     /* a contract of the runtime was broken */
} pn_error_t;

struct pn_arena;

/* Longest text about a value that raised an error, terminator included. */
#define PN_SAID_SIZE 256U

/* What an evaluation needs: where values are allocated, and the first error. */
typedef struct pn_ctx {
    struct pn_arena *arena;
    pn_error_t error;
    const char *error_name;   /* "Overflow", or the exception's name; of PN_ERR_COLOUR what is wrong */
    const void *exception;    /* the exception as a value, in the arena; NULL: its name says it all */
    const char *error_origin; /* net element being evaluated when it was raised */
    const char *origin;       /* net element being evaluated now */
    uint32_t depth;           /* of recursion */
    uint64_t rounds;          /* of recursion and loops since the evaluation began; see pn_goes_on */
    uintptr_t stack_limit;    /* lowest address that recursion may reach; 0: not known, the depth counts */
    pn_time_t now;            /* model time of the marking being looked at; set by enumerate, fire and init */
    uint64_t step;            /* number of occurrences so far, for step(); the host counts */
    uint64_t seed;            /* of all random numbers of the run */
    uint64_t random;          /* state of the generator for CS.ran() and the distributions; see pn_random.h */
    char said[PN_SAID_SIZE];  /* what error_name is, where it says a value */
} pn_ctx_t;

/* An element of the net is evaluated from here on. */
static inline void pn_begin(pn_ctx_t *cx, const char *origin, pn_time_t now)
{
    cx->origin = origin;
    cx->now = now;
    cx->rounds = 0U;
}

#endif /* PN_TYPES_H */
