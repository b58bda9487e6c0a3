/* SPDX-License-Identifier: MIT
 * explore_telling.c - how long it will take to tell the bounds of what has been seen.
 *
 * After the search the states that were found and not expanded are looked at, and each multi-set that a place which is
 * not packed ever held (explore_bounds.c). That may take as long as the search itself, so a search with a limit of time
 * has to end early enough. What one of them takes is measured while the threads pause.
 */
#include "explore_telling.h"

#include "explore_bounds.h"

#include <stdlib.h>

#include "pn/pn_num.h"

#define SAMPLE       512U   /* multi-sets that are looked at to know what one takes */
#define LEAST_NEEDED 20000U /* fewer take no time that counts */
#define MARGIN       1.5    /* the colours are more than in the sample, and are sorted and printed, too */
#define MOST_CROWD   2.5    /* threads without work look the same as threads that wait for a processor */

void ex_telling_make(ex_run_t *run)
{
    if ((run->options.max_seconds <= 0.0) || (pn_net.root_count > 0U)) {
        return;
    }
    ex_worker_t *const teller = ex_alloc(&run->memory, sizeof *teller);
    if (teller == NULL) {
        return;
    }
    teller->run = run;
    teller->index = run->options.threads;
    run->teller = (ex_scratch_make(teller) && ex_bounds_make(teller)) ? teller : NULL;
}

void ex_telling_measure(ex_run_t *run)
{
    ex_worker_t *const teller = run->teller;
    const ex_bytes_t *const all = ex_interned(run);
    if ((teller == NULL) || (run->level == NULL)) {
        return;
    }
    pn_stack_init(&teller->cx); /* any thread may be the one that is here */
    ex_unload(teller);
    const double seeing = ex_rest_measure(teller, (uint32_t)SAMPLE);
    if (seeing > 0.0) {
        atomic_store(&run->seeing, seeing);
    }
    const uint64_t count = (all != NULL) ? atomic_load(&all->index.count) : 0U;
    char *const buffer = (count >= LEAST_NEEDED) ? malloc(EX_TEXT_SIZE) : NULL;
    if (buffer == NULL) {
        return;
    }
    const double began = ex_clock();
    bool is_fine = true;
    for (uint64_t k = 0U; is_fine && (k < SAMPLE); k++) {
        is_fine = ex_bounds_see_number(teller, (k * count) / SAMPLE, buffer);
    }
    free(buffer);
    if (is_fine) {
        atomic_store(&run->telling, (ex_clock() - began) / (double)SAMPLE);
    }
}

/* How much longer things take since others use the processors as well, as it was until now. */
static double crowd(const ex_run_t *run)
{
    const double used = ex_cpu_clock();
    const double most = (ex_clock() - run->started) * (double)run->options.threads;
    const double times = (used > 0.0) ? (most / used) : 1.0;
    return (times < 1.0) ? 1.0 : ((times > MOST_CROWD) ? MOST_CROWD : times);
}

double ex_telling_seconds(ex_run_t *run)
{
    const ex_bytes_t *const all = ex_interned(run);
    const uint64_t count = (all != NULL) ? atomic_load(&all->index.count) : 0U;
    ex_progress_t progress = { 0U, 0U, 0U, 0U };
    ex_progress(run, &progress);
    const double rest = atomic_load(&run->seeing) * (double)progress.frontier;
    return MARGIN * crowd(run) * (rest + (atomic_load(&run->telling) * (double)count));
}
