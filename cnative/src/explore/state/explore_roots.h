/* SPDX-License-Identifier: MIT
 * explore_roots.h - what references hold as a part of the state (explore_roots.c).
 */
#ifndef EXPLORE_ROOTS_H
#define EXPLORE_ROOTS_H

#include <stdbool.h>
#include <stdint.h>

struct ex_worker;

bool ex_roots_make(struct ex_worker *worker);
/* The number of what they hold now. False: no memory. */
bool ex_roots_number(struct ex_worker *worker, uint32_t *number);
/* Lets them hold what has that number; false after an error (the context has it). */
bool ex_roots_load(struct ex_worker *worker, uint32_t number);
/* After an occurrence in the loaded state: they hold again what they hold there. False: the worker has failed. */
bool ex_roots_restore(struct ex_worker *worker);

#endif /* EXPLORE_ROOTS_H */
