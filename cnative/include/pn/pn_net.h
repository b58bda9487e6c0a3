/* SPDX-License-Identifier: MIT
 * pn_net.h - the contract between a generated net (net.c) and the hosts that run it.
 *
 * A generated net is one constant table, `const pn_net_t pn_net`, and a marking type whose size the table gives. Hosts
 * (supervisor, simulate, explore, the program under test of `conform`) know nets only through this table. What is done
 * with markings in the same way in every net is in pn_marking.h, and with the multi-set of one place in pn_multiset.h.
 *
 * Several objects are made from a net, all with the same flags for the standard and for floating-point numbers:
 *
 *   deployed    net_own.o, linked with `./supervisor` of a generated folder: net.c without the transitions of robots
 *               (-DPN_OWN_ONLY). The folder's net.o has all of them, for the supervisor's traced and monitored variants
 *               and for `./simulate`.
 *   verified    `pn2code verify` makes a net.c of its own, with packed places where that is possible and arrays of
 *               other sizes, and compiles it into its explorer. What is proved is proved of that one.
 *   simulated   `pn2code simulate` makes a net.c of its own, too, with large arrays and in one piece with its
 *               simulator.
 *   compared    `pn2code conform` compiles the net.c of the generated folder, and the sources of the deployed
 *               supervisor except port_posix.c, likewise without the transitions of robots, into its program under
 *               test. It compares that program, and the explorer's graph, with the token game in every state that can
 *               be reached (docs/conform.md).
 *
 * Errors: a net's expressions may raise (integer overflow, division by zero, no matching rule, a colour out of range,
 * an array that is full). The first error of a context is kept in it (pn_ctx_t.error) and is sticky: from then on every
 * operation gives a harmless value. Hosts look at it after each call; nothing of a firing that failed becomes visible:
 * fire works out every output before it takes the first token.
 */
#ifndef PN_NET_H
#define PN_NET_H

#include "pn/pn_types.h"

#ifdef __cplusplus
extern "C" {
#endif

#define PN_NET_ABI 3U

#if defined(__GNUC__)
#define PN_NODISCARD __attribute__((warn_unused_result))
#else
#define PN_NODISCARD
#endif

/* One scalar of a token, in the declared order of the colour set's components; how tokens cross the border of the net.
 */
typedef enum pn_scalar_value_kind {
    PN_VALUE_BOOL,
    PN_VALUE_INT,
    PN_VALUE_REAL,
    PN_VALUE_STRING,
    PN_VALUE_ENUM, /* value: position of the constructor; also unit (0) and index (its number) */
    PN_VALUE_LIST  /* value: how many elements; their values follow */
} pn_scalar_value_kind_t;

typedef struct pn_scalar_value {
    pn_scalar_value_kind_t kind;
    int64_t integer;  /* BOOL, INT, ENUM */
    double real;      /* REAL */
    const char *text; /* STRING, and the constructor's name for ENUM; valid until the next firing */
    uint32_t length;  /* of a STRING's text, in which any byte may be */
} pn_scalar_value_t;

/* Called for each enabled binding element; returns false to stop the enumeration. The binding lives until the call
 * returns. */
typedef bool (*pn_binding_sink_t)(void *user, uint32_t transition, const void *binding);

/* Called for each enabled binding element with the marking after its occurrence; returns false to stop. Both live until
 * it returns. */
typedef bool (*pn_successor_sink_t)(void *user, uint32_t transition, const void *binding, const void *next);

/* Sink for text: bytes are appended to a host's buffer or file. */
typedef struct pn_text {
    char *buffer;    /* zero-terminated after each append */
    size_t capacity; /* bytes, terminator included */
    size_t length;   /* bytes used; > capacity - 1 never; `truncated` says that something was cut */
    bool truncated;
    void (*flush)(struct pn_text *text); /* called when the buffer is full: writes it somewhere and empties it; NULL:
                                            the rest is cut */
    void *user;
} pn_text_t;

/* Markings after a marking, of each only the first word of its packed part, from which all else follows
 * (pn_transition_t.words). */
typedef struct pn_words {
    pn_ctx_t *cx;
    const void *marking;
    uint64_t *word;
    uint32_t count;                          /* of words that are there */
    uint32_t room;                           /* for so many */
    bool (*is_full)(struct pn_words *words); /* called when there is no room left: makes some; false: stop */
    void *user;
} pn_words_t;

static inline bool pn_words_add(pn_words_t *words, uint64_t word)
{
    words->word[words->count] = word;
    words->count++;
    return (words->count < words->room) || words->is_full(words);
}

/* A part of a sum of markings that never changes. */
typedef struct pn_share {
    uint32_t place;
    uint32_t weight;
} pn_share_t;

struct pn_multiset;
struct pn_type;

typedef struct pn_place {
    const char *name;   /* "Top.Robot1.Waiting" */
    const char *colset; /* "POSE" */
    int32_t owner;      /* index in pn_net_t.owner; -1: a channel */
    bool is_bounded;    /* more tokens than `bound` have been proven impossible, or declared to be */
    uint32_t bound;
    /* Of a packed place that follows from others: its counters and those of these places, so often, are always the same
     * in sum. All of them have as many counters of as many bits, or one counter each; no sum is more than a counter of
     * this place can hold. */
    uint32_t share_count;
    const pn_share_t *share;
    const struct pn_multiset
        *multiset; /* where its tokens are in a marking; what to do with them is in pn_multiset.h */
    /* Puts the tokens of the initial marking. False on error. NULL: it is empty. */
    bool (*initial)(pn_ctx_t *cx, void *marking);
} pn_place_t;

typedef struct pn_transition {
    const char *name;   /* "Top.Robot1.Accept" */
    const char *id;     /* XML id */
    const char *origin; /* "page `Robot`, transition `Accept` (ID1412)" */
    int32_t owner;
    int32_t priority; /* smaller is more urgent */
    /* Calls the sink for every binding enabled at the marking's time, in a fixed order; priorities are the host's
     * business. Returns false when the sink stopped it. */
    bool (*enumerate)(pn_ctx_t *cx, const void *marking, uint32_t self, pn_binding_sink_t sink, void *user);
    /* Fires an enabled binding and stores the code segment's outputs in it. On error (context error set, false) the
     * marking is unchanged; not so where there is `successors`: such hosts fire in copies only. `binding` is the
     * host's copy (pn_binding_size) of what the sink was given. */
    bool (*fire)(pn_ctx_t *cx, void *marking, uint32_t self, void *binding);
    /* Where the functions are those of all instances of a page, the places that are this instance's: a struct of the
     * generated net. */
    const void *places;
    /* The type of a binding: a record of the variables. Outputs of the code segment are there after `fire`. */
    const struct pn_type *binding;
    /* The transitions that may be enabled in another way after this one has occurred, model time being the same. NULL:
     * all. */
    uint32_t affected_count;
    const uint32_t *affected;
    /* The places whose marking an occurrence may change: not those from which it only takes what it puts there again.
     */
    uint32_t touched_count;
    const uint32_t *touched;
    /* The places whose marking decides, with the time, which occurrences there are, and what each takes and puts: not
     * those in which it only puts tokens. NULL: not known. */
    uint32_t read_count;
    const uint32_t *read;
    /* Files or references decide about it: what is possible in a marking depends on more than the marking. Not so for
     * random numbers: their stream starts anew each time (pn_random.h), and is the same for the same seed and step. */
    bool looks;
    /* Files decide about it: in the same state it may do something else another time. */
    bool looks_outside;
    /* An occurrence may change references (pn_net_t.root). */
    bool assigns;
    /* The search for bindings may: when, is not determined. */
    bool search_assigns;
    /* For every enabled binding, in the order of `enumerate`: makes in *next the marking after its occurrence and calls
     * the sink. Returns false when the sink stopped it; errors are in the context. NULL: enumerate, copy and fire. */
    bool (*successors)(pn_ctx_t *cx, const void *marking, uint32_t self, void *next, pn_successor_sink_t sink,
                       void *user);
    /* The same, adding to *words the first word of each marking that follows. NULL: not where more than that word, and
     * what follows from it (pn_place_t.share), changes. */
    bool (*words)(pn_words_t *words, uint32_t self);
} pn_transition_t;

/* For rows of the table of transitions: their functions and binding by the stem of the names; a list of indices with
 * its length. */
#define PN_CODE(code) .enumerate = code##_enumerate, .fire = code##_fire, .binding = &s_binding_##code
/* The same for transitions of robots. The deployed supervisor never tries one, and has none of their code
 * (-DPN_OWN_ONLY). */
#if defined(PN_OWN_ONLY)
#define PN_OTHERS(code) .binding = &s_binding_##code
#else
#define PN_OTHERS(code) PN_CODE(code)
#endif
#define PN_INDICES(member, ...)                                                                 \
    .member##_count = (uint32_t)(sizeof((const uint32_t[]){ __VA_ARGS__ }) / sizeof(uint32_t)), \
    .member = (const uint32_t[])                                                                \
    {                                                                                           \
        __VA_ARGS__                                                                             \
    }

/* A condition on markings, asked by those who explore the net. */
typedef struct pn_predicate {
    const char *name;
    const char *text; /* as its author wrote it */
    /* Errors are in the context. What it needs of the arena the host releases. */
    bool (*holds)(pn_ctx_t *cx, const void *marking);
} pn_predicate_t;

/* A variable outside the marking that the net changes, and through which it may reach cells of references (pn_root.h).
 */
typedef struct pn_root {
    const struct pn_type *type;
    void *variable;
} pn_root_t;

typedef struct pn_owner {
    const char *name; /* "supervisor", "robot1" */
} pn_owner_t;

typedef struct pn_net {
    uint32_t abi;       /* PN_NET_ABI */
    const char *name;   /* "cell" */
    const char *source; /* "cell.cpn" */
    const char *digest; /* SHA-256 of the .cpn file and of what cell.toml contributes, hex */
    bool timed;
    bool real_time;      /* the clock is real: times are double; else int64_t */
    size_t marking_size; /* bytes of a marking; may hold pointers into the context's arena */
    uint32_t place_count;
    const pn_place_t *place;
    uint32_t transition_count;
    const pn_transition_t *transition;
    uint32_t owner_count; /* 0: no cell, everything belongs to nobody */
    const pn_owner_t *owner;
    uint32_t order_count; /* transition indices by priority, then page and name: the documented order of trying */
    const uint32_t *order;
    size_t now_at; /* offset in a marking of its model time */
    /* Gives the variables outside the marking the values that they have at the start, before anything else is
     * evaluated. NULL: there are none. Errors are in the context. */
    void (*set_up)(pn_ctx_t *cx);
    /* Of nets in which delays of input arcs are computed: lets *next be the earliest time after now at which a token
     * becomes available to such an arc, if it is before *next or *found is false. NULL: stamps and constant delays
     * (pn_multiset_t.early) say it. */
    void (*thresholds)(pn_ctx_t *cx, const void *marking, bool *found, pn_time_t *next);
    uint32_t refer_count; /* the places whose values refer into the arena */
    const uint32_t *refer;
    uint32_t held_count; /* and the variables outside the marking that do */
    const pn_root_t *held;
    size_t packed_size; /* bytes of the packed part, with which a marking begins, a multiple of 4; equal markings, equal
                           bytes */
    uint32_t multiset_count; /* the places that are not packed */
    const uint32_t *multisets;
    uint32_t root_count; /* state outside the marking: the references that the net changes. 0: there is none */
    const pn_root_t *root;
    uint32_t predicate_count; /* 0: none was generated with the net */
    const pn_predicate_t *predicate;
} pn_net_t;

extern const pn_net_t pn_net;

#ifdef __cplusplus
}
#endif

#endif /* PN_NET_H */
