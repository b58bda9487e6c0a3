/* SPDX-License-Identifier: MIT
 * explore_programs.h - the programs of a cell: they may do less than the net, and take steps of their own.
 */
#ifndef EXPLORE_PROGRAMS_H
#define EXPLORE_PROGRAMS_H

#include <stdbool.h>
#include <stdint.h>

/* What is known of programs that carry out transitions (explore_query_read.c reads it): each may do less than the net.
 */
typedef enum ex_choice {
    EX_ANY,             /* whatever is enabled */
    EX_FIRST_BINDING,   /* of a group, in the documented order, the first binding element */
    EX_FIRST_TRANSITION /* of a group the first transition that is enabled, with all its bindings */
} ex_choice_t;

#define EX_MOST_GROUPS 256U
#define EX_MOST_SETS   8U

typedef struct ex_programs {
    uint32_t *group; /* by transition: one in which only the first is done; 0: none */
    ex_choice_t choice[EX_MOST_GROUPS];
    uint32_t *kin;    /* by transition: the one of which it is a part, which counts as the same in its group */
    bool *is_meek;    /* by transition: that it is enabled holds no other one back */
    bool *is_probe;   /* by transition: it only shows that something holds, and holds back others of its owner; it never
                         occurs */
    bool *is_silent;  /* by transition: a step that is no occurrence in the net */
    uint8_t *instant; /* by transition: a bit for each set of steps that it belongs to (`? restless`) */
    bool *is_clock;   /* by transition: it occurs one unit of time later, if something is waited for; with reduced time
                         only */
    bool has_clock;
} ex_programs_t;

#endif /* EXPLORE_PROGRAMS_H */
