/* SPDX-License-Identifier: MIT
 * exercise_impl.h - what the parts of the exerciser share: its options, its markings, what it counts.
 */
#ifndef EXERCISE_IMPL_H
#define EXERCISE_IMPL_H

#include "../marking/pn_multiset_impl.h"
#include "pn/pn_marking.h"
#include "pn/pn_net.h"

/* What became of a firing. */
typedef enum ex_outcome {
    EX_ACCEPTED,
    EX_NO_ROOM,   /* PN_ERR_CAPACITY */
    EX_NO_COLOUR, /* PN_ERR_COLOUR */
    EX_MISSING,   /* PN_ERR_SUBTRACT */
    EX_NO_MEMORY, /* PN_ERR_MEMORY */
    EX_RAISED,    /* an expression of the net raised something else */
    EX_OUTCOMES
} ex_outcome_t;

typedef struct ex_options {
    uint64_t runs;
    uint64_t steps;
    uint64_t seed;
    uint64_t resets; /* arcs that take what they do not need; UINT64_MAX: not known */
    bool shows_help;
} ex_options_t;

/* Whether a place from which a firing took a token was needed for it. */
typedef struct ex_need {
    bool is_needed; /* without the token it was not enabled */
    bool is_reset;  /* it was */
} ex_need_t;

typedef struct exercise {
    ex_options_t options;
    pn_ctx_t cx;
    uint64_t random;      /* state of the generator of what is drawn here */
    void *marking;        /* of the run */
    void *situation;      /* in which a transition is tried */
    void *result;         /* after it has fired there */
    void *changed;        /* the situation, one thing being different */
    void *after;          /* a firing that is tried */
    unsigned char *kept;  /* bindings that the last search has found */
    unsigned char *tried; /* those of the situation */
    void *binding;        /* that is being tried; firing may write into it */
    const char *said;     /* where the last refused firing says that the error is */
    ex_need_t **need;     /* for each transition and each of its touched places */
    bool *has_fired;      /* for each transition, in any marking */
    uint64_t firings;     /* of the runs */
    uint64_t situations;
    uint64_t outcome[EX_OUTCOMES];
    uint64_t taken;    /* tokens that were taken away */
    uint64_t replaced; /* or replaced */
    uint64_t filled;   /* places that were filled */
    uint64_t broken;   /* promises */
} ex_t;

/* --- exercise.c --- */

/* Zeroed memory, before anything runs. It ends the program if there is none. */
void *ex_reserve(uint64_t count, size_t size);
/* Tells of a broken promise. `place`: -1, or the place that it is about. */
void ex_complain(ex_t *ex, uint32_t transition, int64_t place, const char *what);

/* --- exercise_values.c: colours to try --- */

void ex_values_prepare(void);
/* Notes the colours that are in a place, to be tried in it and in others of its colour set. */
void ex_values_note(uint32_t place, const void *marking);
/* How many values there are to try in a place where `value` is (NULL: nothing), and number `k` of them. They need not
 * be in the colour set. False: there is no such value. */
uint32_t ex_values_count(const pn_type_t *type);
bool ex_values_get(ex_t *ex, const pn_type_t *type, const void *value, uint32_t k, void *out);
/* Changes one component of a value, in way `k` of so many; false: not possible. */
uint32_t ex_changes_count(const pn_type_t *type);
bool ex_change(const pn_type_t *type, uint32_t k, void *value);
/* Room for a value to try. */
void *ex_values_room(void);

/* --- exercise_situation.c: what is tried, and what is checked --- */

void ex_situation_prepare(ex_t *ex);
/* Tries a transition in the marking `situation`, and in those that differ from it in one thing. */
void ex_try(ex_t *ex, uint32_t transition);

/* --- exercise_run.c: where the situations come from --- */

void ex_run_prepare(ex_t *ex);
/* A run from the initial marking. False: that cannot be made. */
bool ex_run(ex_t *ex);
/* Situations of one transition alone, the places that it reads being filled with colours to try. */
void ex_compose(ex_t *ex, uint32_t transition);

/* --- what all need --- */

/* The places that decide about a transition; where that is not known, those that it may change. */
static inline uint32_t ex_read_count(const pn_transition_t *t)
{
    return (t->read != NULL) ? t->read_count : t->touched_count;
}
static inline uint32_t ex_read_place(const pn_transition_t *t, uint32_t i)
{
    return (t->read != NULL) ? t->read[i] : t->touched[i];
}

/* Entries of a place: none of one that is packed, which nets of generated programs do not have. */
static inline uint32_t ex_entries(const pn_multiset_t *multiset, const void *marking)
{
    return multiset->is_packed ? 0U : pn_multiset_used(multiset, marking);
}
static inline const void *ex_value_at(const pn_multiset_t *multiset, const void *marking, uint32_t i)
{
    return (const unsigned char *)pn_multiset_entry(multiset, marking, i) + multiset->value;
}

#endif /* EXERCISE_IMPL_H */
