/* SPDX-License-Identifier: MIT
 * explore_limit.c - the limit of states, also where threads that insert at the same moment have gone beyond it.
 */
#include "explore/search/explore_search.h"

#include <stdio.h>
#include <stdlib.h>

static bool is_near(ex_run_t *run, uint64_t used, uint64_t most, uint32_t threads)
{
    atomic_store(&run->store.used, used);
    run->options.max_states = most;
    run->options.threads = threads;
    return ex_is_near_limit(run);
}

int main(void)
{
    ex_run_t *const run = calloc(1U, sizeof *run);
    if (run == NULL) {
        return 2;
    }
    const bool is_fine = !is_near(run, 10U, 3000U, 2U) && is_near(run, 2900U, 3000U, 2U)
                         && is_near(run, 3000U, 3000U, 2U) && is_near(run, 3010U, 3000U, 2U) && is_near(run, 5U, 1U, 1U)
                         && !is_near(run, 1000000U, UINT64_MAX, 2U);
    free(run);
    (void)puts(is_fine ? "fine" : "wrong");
    return is_fine ? 0 : 1;
}
