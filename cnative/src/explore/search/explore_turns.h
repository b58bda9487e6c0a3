/* SPDX-License-Identifier: MIT
 * explore_turns.h - which programs of a cell are looked at in a state (explore_turns.c).
 */
#ifndef EXPLORE_TURNS_H
#define EXPLORE_TURNS_H

#include "../explore_run.h"

/* What an owner has been asked of a transition in a state. */
typedef enum ex_asked {
    EX_NOT_ASKED, /* one before it holds it back */
    EX_DISABLED,
    EX_ENABLED
} ex_asked_t;

/* Reads the table of run->options.turns and makes what the workers need; false: run->error says why. */
bool ex_turns_make(ex_run_t *run);
/* By transition what has been asked of it in worker->marking; whoever asks for a choice fills this in. */
ex_asked_t *ex_turns_asked(const ex_worker_t *worker);
/* By owner whether it is to be looked at in worker->marking. It lives until the next call. */
const bool *ex_turns_choose(ex_worker_t *worker);

#endif /* EXPLORE_TURNS_H */
