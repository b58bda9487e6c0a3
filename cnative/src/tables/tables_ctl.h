/* SPDX-License-Identifier: MIT
 * tables_ctl.h - what formulas of computation tree logic and the searches for their operators share.
 *
 * Three values: yes, no, and not known. A search has a limit on its steps, and when that is used up the value is not
 * known; then the search that asked goes on without it. Nothing is concluded from what is not known.
 */
#ifndef PN_TABLES_CTL_H
#define PN_TABLES_CTL_H

#include "tables.h"

/* A marking that a search has met, and which one of those met it was met from. */
typedef struct tb_meeting {
    uint32_t marking;
    uint32_t from;
} tb_meeting_t;

/* A marking on the path of a search, depth first. */
typedef struct tb_frame {
    uint32_t marking;
    uint32_t next;    /* successor */
    uint32_t index;   /* when it was met */
    uint32_t low;     /* the lowest index that it leads to, as far as is seen */
    bool is_doubtful; /* it leads to something that is not known */
} tb_frame_t;

/* The memory of the searches for one operator; a search for it never stands within another one. All zero: nothing. */
typedef struct tb_search {
    uint32_t *met; /* marking -> its number in `all` from 1 on; TB_LEFT; 0: not met in this search */
    uint64_t room;
    tb_meeting_t *all;
    uint32_t all_count;
    uint32_t all_room;
    tb_frame_t *path;
    uint32_t path_count;
    uint32_t path_room;
    uint32_t *open; /* markings: of components that are not complete */
    uint32_t open_count;
    uint32_t open_room;
    tb_heap_t heap;
} tb_search_t;

#define TB_LEFT UINT32_MAX /* looked at to the end, and still not known */

typedef struct tb_checker {
    tb_graph_t graph;
    uint32_t formulas;
    uint8_t *value; /* marking * formulas + formula -> tb_answer_t, and how hard it was tried: see tables_ctl.c */
    uint64_t rows;
    tb_search_t *search; /* formula -> its memory */
    uint64_t fuel;       /* steps that may still be taken */
    uint64_t share;      /* of the steps of a search, one in so many may go into one value that it asks for */
    bool is_nearest;     /* E[p U q] is searched nearest first, else depth first */
} tb_checker_t;

typedef struct tb_until {
    const tb_formula_t *formula; /* under which values are kept */
    const tb_formula_t *p;       /* NULL: true */
    const tb_formula_t *q;
    bool is_negated; /* q is wanted to be false */
} tb_until_t;

/* The value of a formula in a marking, with `limit` steps at most. */
tb_answer_t tb_value(tb_checker_t *c, uint32_t marking, const tb_formula_t *f, uint64_t limit);

/* What is kept of it. */
tb_answer_t tb_kept(tb_checker_t *c, uint32_t marking, const tb_formula_t *f);
void tb_keep(tb_checker_t *c, uint32_t marking, const tb_formula_t *f, tb_answer_t value);

/* Take a step; false: there is none left, or the time is over. */
bool tb_step(tb_checker_t *c);

/* E[p U q] and A[p U q] where the first look does not decide; `is_doubtful`: it was TB_MAYBE. */
tb_answer_t tb_exists_until(tb_checker_t *c, uint32_t from, const tb_until_t *u, bool is_doubtful);
tb_answer_t tb_always_until(tb_checker_t *c, uint32_t from, const tb_until_t *u, bool is_doubtful);

/* What a marking says before its successors are looked at. */
typedef enum tb_first_look {
    TB_IS,     /* the value is yes */
    TB_IS_NOT, /* no */
    TB_PASSES, /* its successors decide */
    TB_MAYBE,  /* they may decide: it is yes, or no, if they say so, and not known otherwise */
    TB_DOUBTFUL
} tb_first_look_t;

tb_first_look_t tb_look(tb_checker_t *c, uint32_t marking, const tb_until_t *u, bool is_existential, uint64_t limit);

/* --- the memory of a search (tables_ctl_search.c) ----------------------------------------------------------------- */

void tb_search_free(tb_search_t *s);
/* Forget what was met. */
void tb_search_end(tb_search_t *s);
/* Where it is written when a marking was met. */
uint32_t *tb_met(tb_checker_t *c, tb_search_t *s, uint32_t marking);
/* Its number, from 1 on. */
uint32_t tb_meet(tb_checker_t *c, tb_search_t *s, uint32_t marking, uint32_t from);
/* Meet it, and put it on the path and among the open ones. */
void tb_enter(tb_checker_t *c, tb_search_t *s, uint32_t marking, bool is_doubtful);

#endif
