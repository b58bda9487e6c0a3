/* SPDX-License-Identifier: MIT
 * tables_reach.c - one question after the other, each by a search of its own over stubborn sets.
 *
 * The markings that seem nearest to the formula come first (tables_distance.c), so that a yes is found early; a no
 * takes all of them. The largest value of a sum needs one search, too: with the transitions that enlarge the sum as
 * seeds, a marking with the largest value stays reachable, whatever that value is.
 */
#include "tables.h"

#include <string.h>

/* How a marking was reached first. */
typedef struct step {
    uint32_t from;
    uint32_t by;
} step_t;

enum { FIRST_STEPS = 1 << 10 };

typedef struct search {
    tb_question_t *question;
    tb_store_t store;
    tb_cursor_t cursor;
    tb_stubborn_t stubborn;
    tb_heap_t heap;
    tb_count_t *marking;
    uint32_t *fire;
    step_t *step; /* of each marking, if runs are to be told; else NULL */
    uint32_t room;
} search_t;

static void note_step(search_t *s, uint32_t number, uint32_t from, uint32_t by)
{
    if (s->step != NULL) {
        if (number >= s->room) {
            s->step = tb_grown(s->step, s->room, 2U * (size_t)s->room, sizeof *s->step);
            s->room = 2U * s->room;
        }
        s->step[number] = (step_t){ from, by };
    }
}

static void tell_run(const search_t *s, uint32_t number)
{
    if (s->step != NULL) {
        uint32_t count = 0U;
        for (uint32_t at = number; at > 0U; at = s->step[at].from) {
            count++;
        }
        uint32_t *run = tb_new(count, sizeof *run);
        uint32_t left = count;
        for (uint32_t at = number; at > 0U; at = s->step[at].from) {
            left--;
            run[left] = s->step[at].by;
        }
        tb_say_run(s->question, run, count);
        tb_free(run, count, sizeof *run);
    }
}

/* Whether the question is answered by the marking at the cursor, which is entered. */
static bool found(search_t *s, uint32_t number)
{
    tb_question_t *q = s->question;
    if (q->kind == TB_REACH) {
        const double distance = tb_distance(q->formula, &s->cursor, true);
        if (tb_holds(q->formula, &s->cursor)) {
            tell_run(s, number);
            tb_say(q, TB_YES, "STUBBORN_SETS");
            return true;
        }
        tb_heap_push(&s->heap, distance, number);
        return false;
    }
    const int64_t sum = tb_sum(q->formula, s->cursor.marking);
    if (sum > q->least) {
        q->least = sum;
        tb_say_bound(q, sum, false, "STUBBORN_SETS");
    }
    tb_heap_push(&s->heap, -(double)sum, number);
    return false;
}

/* True: all was seen, and the answer is no (the largest value is the one seen). */
static bool searched(search_t *s)
{
    tb_question_t *q = s->question;
    uint32_t number = 0U;
    (void)tb_store_add(&s->store, s->cursor.marking, &number);
    if (found(s, number)) {
        return false;
    }
    while (s->heap.count > 0U) {
        const uint32_t from = tb_heap_pop(&s->heap);
        tb_store_get(&s->store, from, s->marking);
        tb_go_to(&s->cursor, s->marking);
        const bool is_reach = q->kind == TB_REACH;
        const uint32_t count =
            tb_stubborn(&s->stubborn, &s->cursor, is_reach ? q->formula : NULL, is_reach ? NULL : q->formula, s->fire);
        for (uint32_t i = 0U; i < count; i++) {
            if (tb_is_over() || !tb_move(&s->cursor, s->fire[i])) {
                return false;
            }
            const tb_added_t added = tb_store_add(&s->store, s->cursor.marking, &number);
            tb_unmove(&s->cursor, s->fire[i]);
            if (added == TB_FULL) {
                return false;
            }
            if (added == TB_ADDED) {
                note_step(s, number, from, s->fire[i]);
                if (!tb_fire(&s->cursor, s->fire[i]) || found(s, number)) {
                    return false;
                }
                tb_unfire(&s->cursor, s->fire[i]);
            }
        }
    }
    return true;
}

static void answer(const tb_net_t *net, tb_question_t *q, bool is_told)
{
    search_t s;
    s.room = is_told ? (uint32_t)FIRST_STEPS : 0U;
    s.step = is_told ? tb_new(s.room, sizeof *s.step) : NULL;
    s.question = q;
    tb_store_init(&s.store, net, NULL);
    tb_cursor_init(&s.cursor, net);
    tb_stubborn_init(&s.stubborn, net);
    (void)memset(&s.heap, 0, sizeof s.heap);
    s.marking = tb_new(net->places, sizeof *s.marking);
    s.fire = tb_new(net->transitions, sizeof *s.fire);
    if (searched(&s)) {
        if (q->kind == TB_REACH) {
            tb_say(q, TB_NO, "STUBBORN_SETS");
        } else {
            tb_say_bound(q, q->least, true, "STUBBORN_SETS");
        }
    }
    if (s.step != NULL) {
        tb_free(s.step, s.room, sizeof *s.step);
    }
    tb_free(s.fire, net->transitions, sizeof *s.fire);
    tb_free(s.marking, net->places, sizeof *s.marking);
    tb_heap_free(&s.heap);
    tb_stubborn_free(&s.stubborn);
    tb_cursor_free(&s.cursor);
    tb_store_free(&s.store);
}

void tb_reach(tb_job_t *job, double seconds, bool is_told)
{
    uint32_t open = 0U;
    for (uint32_t i = 0U; i < job->questions; i++) {
        open += ((job->question[i].kind == TB_REACH) || (job->question[i].kind == TB_BOUND)) ? 1U : 0U;
    }
    for (uint32_t i = 0U; i < job->questions; i++) {
        tb_question_t *q = &job->question[i];
        if ((q->kind == TB_REACH) || (q->kind == TB_BOUND)) {
            const double left = seconds - tb_elapsed();
            tb_limit_time(tb_elapsed() + (left / (double)open)); /* what one leaves over the others get */
            open--;
            answer(&job->net, q, is_told);
        }
    }
}
