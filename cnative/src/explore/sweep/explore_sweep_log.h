/* SPDX-License-Identifier: MIT
 * explore_sweep_log.h - how each state was found, in a file (explore_sweep_log.c).
 */
#ifndef EXPLORE_SWEEP_LOG_H
#define EXPLORE_SWEEP_LOG_H

#include "../explore_run.h"

#define EX_LOG_PATH_SIZE 4096U
#define EX_INDEX_BYTES   5U /* of the number of a state; there are never so many */

typedef struct ex_sweep_log {
    FILE *file;      /* NULL: there is none */
    bool is_lost;    /* it could not be had, or not be written */
    uint32_t length; /* bytes of a key */
    uint64_t count;  /* entries */
} ex_sweep_log_t;

/* In a folder, without a name. Where it cannot be had, there are no runs. */
void ex_sweep_log_open(ex_sweep_log_t *log, const char *folder, uint32_t length);
/* The next state, with the number of the one from which it was found. */
void ex_sweep_log_add(ex_sweep_log_t *log, const ex_key_t *key, uint64_t parent);
/* All keys become other ones. */
void ex_sweep_log_replace(ex_sweep_log_t *log, ex_replace_t one, const void *layout);
/* The states from the first one to one of them, both included; the caller frees them. NULL: they are not known. */
ex_key_t *ex_sweep_log_way(const ex_sweep_log_t *log, uint64_t index, uint64_t *steps);

#endif /* EXPLORE_SWEEP_LOG_H */
