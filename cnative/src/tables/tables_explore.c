/* SPDX-License-Identifier: MIT
 * tables_explore.c - all markings, breadth first: what holds in one of them, the largest sums, and how many there are.
 */
#include "tables.h"

#include <inttypes.h>
#include <stdio.h>

typedef struct totals {
    uint64_t arcs;
    uint64_t in_place;   /* the most tokens in a place */
    uint64_t in_marking; /* the most tokens in a marking */
    uint64_t dead;
} totals_t;

/* Answer what this marking answers; the number of questions that remain open. */
static uint32_t look(tb_job_t *job, const tb_cursor_t *c)
{
    uint32_t open = 0U;
    for (uint32_t i = 0U; i < job->questions; i++) {
        tb_question_t *q = &job->question[i];
        if ((q->answer == TB_UNKNOWN) && (q->kind == TB_REACH) && tb_holds(q->formula, c)) {
            tb_say(q, TB_YES, "EXPLICIT");
        } else if ((q->answer == TB_UNKNOWN) && (q->kind == TB_BOUND)) {
            const int64_t sum = tb_sum(q->formula, c->marking);
            q->least = (sum > q->least) ? sum : q->least;
        } else {
            /* the marking does not say */
        }
        open += (q->answer == TB_UNKNOWN) ? 1U : 0U;
    }
    return open;
}

static void count_tokens(const tb_net_t *net, const tb_count_t *marking, totals_t *totals)
{
    uint64_t sum = 0U;
    for (uint32_t p = 0U; p < net->places; p++) {
        sum += marking[p];
        totals->in_place = (marking[p] > totals->in_place) ? marking[p] : totals->in_place;
    }
    totals->in_marking = (sum > totals->in_marking) ? sum : totals->in_marking;
}

static void answer_all(tb_job_t *job)
{
    for (uint32_t i = 0U; i < job->questions; i++) {
        tb_question_t *q = &job->question[i];
        if (q->kind == TB_REACH) {
            tb_say(q, TB_NO, "EXPLICIT");
        } else if (q->kind == TB_BOUND) {
            tb_say_bound(q, q->least, true, "EXPLICIT");
        } else {
            /* not for this method */
        }
    }
}

/* Without `count` the search ends with the last open question. */
void tb_explore(tb_job_t *job, bool count)
{
    const tb_net_t *net = &job->net;
    tb_store_t store;
    tb_cursor_t c;
    totals_t totals = { 0U, 0U, 0U, 0U };
    uint32_t number = 0U;
    bool is_whole = true;
    tb_store_init(&store, net, NULL);
    tb_cursor_init(&c, net);
    tb_count_t *marking = tb_new(net->places, sizeof *marking);
    uint32_t *fire = tb_new(net->transitions, sizeof *fire);
    (void)tb_store_add(&store, c.marking, &number);
    bool is_wanted = (look(job, &c) > 0U) || count;
    count_tokens(net, c.marking, &totals);
    for (uint64_t at = 0U; is_whole && is_wanted && (at < store.records); at++) {
        tb_store_get(&store, (uint32_t)at, marking);
        tb_go_to(&c, marking);
        const uint32_t enabled = c.enabled_count;
        for (uint32_t i = 0U; i < enabled; i++) {
            fire[i] = c.enabled[i];
        }
        totals.arcs += enabled;
        totals.dead += (enabled == 0U) ? 1U : 0U;
        for (uint32_t i = 0U; is_whole && is_wanted && (i < enabled); i++) {
            is_whole = tb_move(&c, fire[i]);
            if (!is_whole) {
                break;
            }
            const tb_added_t added = tb_store_add(&store, c.marking, &number);
            is_whole = (added != TB_FULL) && !tb_is_over();
            if (added == TB_ADDED) {
                count_tokens(net, c.marking, &totals);
            }
            tb_unmove(&c, fire[i]);
            if ((added == TB_ADDED) && (job->questions > 0U) && tb_fire(&c, fire[i])) {
                is_wanted = (look(job, &c) > 0U) || count;
                tb_unfire(&c, fire[i]);
            }
        }
    }
    if (is_whole && is_wanted) {
        answer_all(job);
        if (count) {
            (void)printf("space %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 "\n", store.records,
                         totals.arcs, totals.in_place, totals.in_marking, totals.dead);
        }
    }
    (void)printf("seen %" PRIu64 " markings, %" PRIu64 " arcs, %" PRIu32 " words each\n", store.records, totals.arcs,
                 store.words);
    tb_free(marking, net->places, sizeof *marking);
    tb_free(fire, net->transitions, sizeof *fire);
    tb_cursor_free(&c);
    tb_store_free(&store);
}
