/* SPDX-License-Identifier: MIT
 * explore_team.h - threads that help with a work of several parts, as tables know them.
 */
#ifndef EXPLORE_TEAM_H
#define EXPLORE_TEAM_H

#include <stdint.h>

typedef struct ex_team {
    uint32_t threads;
    /* Does all parts of a work, which do not depend on each other: perhaps several at the same time. */
    void (*together)(void *self, uint32_t parts, void (*one)(void *user, uint32_t part), void *user);
    void *self;
} ex_team_t;

#endif /* EXPLORE_TEAM_H */
