/* SPDX-License-Identifier: MIT
 * tables.c - answer questions about a place/transition net.
 *
 *     tables FILE METHOD SECONDS MIB SEED [PATIENCE]
 *
 * METHOD is walk, explore, count, reach, ctl, ltl, diagrams or sizes (diagrams, for the numbers of markings); or run,
 * a walk, and way, a search, that tell the steps to what they find. Diagrams that are not whole after PATIENCE (in
 * seconds, too) are given up; the others go on. The exit code is 0 when the method came to its end, 2 if the tables are
 * wrong, 3 if a set was not whole in time, 4 if memory ran out.
 */
#include "tables.h"

#include <stdlib.h>
#include <string.h>
#ifdef __linux__
#include <signal.h>
#include <sys/prctl.h>
#endif

enum { ARGUMENTS = 6, WITH_PATIENCE };

/* Nobody works for one who was killed. */
static void end_with_parent(void)
{
#ifdef __linux__
    (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
}

int main(int count, char **argument)
{
    static tb_job_t job;
    if ((count != (int)ARGUMENTS) && (count != (int)WITH_PATIENCE)) {
        tb_fail(TB_EXIT_WRONG, "usage: tables FILE METHOD SECONDS MIB SEED [PATIENCE]");
    }
    end_with_parent();
    const char *method = argument[2];
    const double seconds = strtod(argument[3], NULL);
    const uint64_t seed = strtoull(argument[5], NULL, 10);
    const double patience = (count == (int)WITH_PATIENCE) ? strtod(argument[6], NULL) : seconds;
    tb_start_clock(seconds);
    tb_limit_memory(strtoull(argument[4], NULL, 10) << 20U);
    tb_read(&job, argument[1]);
    if ((strcmp(method, "walk") == 0) || (strcmp(method, "run") == 0)) {
        tb_walk(&job, seed, seconds, strcmp(method, "run") == 0);
    } else if ((strcmp(method, "explore") == 0) || (strcmp(method, "count") == 0)) {
        tb_explore(&job, strcmp(method, "count") == 0);
    } else if ((strcmp(method, "reach") == 0) || (strcmp(method, "way") == 0)) {
        tb_reach(&job, seconds, strcmp(method, "way") == 0);
    } else if (strcmp(method, "ctl") == 0) {
        tb_ctl(&job, seed, seconds);
    } else if (strcmp(method, "ltl") == 0) {
        tb_ltl(&job, seed, seconds);
    } else if ((strcmp(method, "diagrams") == 0) || (strcmp(method, "sizes") == 0)) {
        tb_diagrams(&job, strcmp(method, "sizes") == 0, seed, seconds, patience);
    } else {
        tb_fail(TB_EXIT_WRONG, "`%s` is no method", method);
    }
    return 0;
}
