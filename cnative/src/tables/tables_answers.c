/* SPDX-License-Identifier: MIT
 * tables_answers.c - answers, each on a line of its own as soon as it is known.
 *
 *     answer NUMBER yes|no METHOD
 *     bound NUMBER VALUE exact|least METHOD
 *     run NUMBER STEPS TRANSITION..              (before the answer that it shows)
 */
#include "tables.h"

#include <inttypes.h>
#include <stdio.h>

static void print_now(void)
{
    if (fflush(stdout) != 0) {
        tb_fail(TB_EXIT_WRONG, "the answers cannot be written");
    }
}

void tb_say(tb_question_t *q, tb_answer_t answer, const char *method)
{
    if (q->answer == TB_UNKNOWN) {
        q->answer = answer;
        (void)printf("answer %" PRIu32 " %s %s\n", q->number, (answer == TB_YES) ? "yes" : "no", method);
        print_now();
    }
}

void tb_say_bound(tb_question_t *q, int64_t bound, bool is_exact, const char *method)
{
    if (q->answer == TB_UNKNOWN) {
        q->answer = is_exact ? TB_YES : TB_UNKNOWN;
        (void)printf("bound %" PRIu32 " %" PRId64 " %s %s\n", q->number, bound, is_exact ? "exact" : "least", method);
        print_now();
    }
}

void tb_say_run(const tb_question_t *q, const uint32_t *step, uint32_t steps)
{
    (void)printf("run %" PRIu32 " %" PRIu32, q->number, steps);
    for (uint32_t i = 0U; i < steps; i++) {
        (void)printf(" %" PRIu32, step[i]);
    }
    (void)printf("\n");
    print_now();
}
