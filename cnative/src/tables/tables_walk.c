/* SPDX-License-Identifier: MIT
 * tables_walk.c - random walks, which find quickly what is found in many places.
 *
 * Every other walk is drawn towards one of the open questions: among a few enabled transitions the one is taken that
 * brings its formula nearest (tables_distance.c).
 */
#include "tables.h"

enum {
    LENGTH = 20000, /* steps of a walk at most */
    CANDIDATES = 6,
    PLAIN_STEPS = 4 /* one in so many steps of a drawn walk is random */
};

static uint64_t state = 1U;

static uint32_t drawn(uint32_t below)
{
    state ^= state << 13U;
    state ^= state >> 7U;
    state ^= state << 17U;
    return (uint32_t)(((state >> 32U) * below) >> 32U);
}

static uint32_t look(tb_job_t *job, const tb_cursor_t *c)
{
    uint32_t open = 0U;
    for (uint32_t i = 0U; i < job->questions; i++) {
        tb_question_t *q = &job->question[i];
        if (q->answer != TB_UNKNOWN) {
            continue;
        }
        if ((q->kind == TB_REACH) && tb_holds(q->formula, c)) {
            tb_say(q, TB_YES, "RANDOM_WALK");
        } else if (q->kind == TB_BOUND) {
            const int64_t sum = tb_sum(q->formula, c->marking);
            if (sum > q->least) {
                q->least = sum;
                tb_say_bound(q, sum, false, "RANDOM_WALK");
            }
            open++;
        } else if (q->kind == TB_REACH) {
            open++;
        } else {
            /* not for this method */
        }
    }
    return open;
}

static double aim(const tb_question_t *q, const tb_cursor_t *c)
{
    return (q->kind == TB_REACH) ? tb_distance(q->formula, c, true) : -(double)tb_sum(q->formula, c->marking);
}

static uint32_t chosen(tb_cursor_t *c, const tb_question_t *goal)
{
    if ((goal == NULL) || (drawn(PLAIN_STEPS) == 0U)) {
        return c->enabled[drawn(c->enabled_count)];
    }
    uint32_t best = UINT32_MAX;
    double nearest = 0.0;
    for (uint32_t i = 0U; i < (uint32_t)CANDIDATES; i++) {
        const uint32_t t = c->enabled[drawn(c->enabled_count)];
        if (tb_fire(c, t)) {
            const double d = aim(goal, c);
            tb_unfire(c, t);
            if ((best == UINT32_MAX) || (d < nearest)) {
                best = t;
                nearest = d;
            }
        }
    }
    return (best == UINT32_MAX) ? c->enabled[drawn(c->enabled_count)] : best;
}

static const tb_question_t *goal_of(const tb_job_t *job, uint64_t walk)
{
    for (uint32_t i = 0U; i < job->questions; i++) {
        const tb_question_t *q = &job->question[(walk + i) % job->questions];
        if ((q->answer == TB_UNKNOWN) && ((q->kind == TB_REACH) || (q->kind == TB_BOUND))) {
            return q;
        }
    }
    return NULL;
}

void tb_walk(tb_job_t *job, uint64_t seed, double seconds)
{
    tb_cursor_t c;
    tb_cursor_init(&c, &job->net);
    state = (seed * 0x9e3779b97f4a7c15U) | 1U;
    uint32_t open = look(job, &c);
    const double until = tb_elapsed() + seconds;
    for (uint64_t walk = 0U; (open > 0U) && !tb_is_over() && (tb_elapsed() < until); walk++) {
        const tb_question_t *goal = ((walk % 2U) == 1U) ? goal_of(job, walk / 2U) : NULL;
        const uint32_t length = (walk < 64U) ? (uint32_t)(LENGTH / 20) : (uint32_t)LENGTH;
        tb_go_to(&c, job->net.initial);
        for (uint32_t step = 0U; (open > 0U) && (step < length) && (c.enabled_count > 0U) && !tb_is_over(); step++) {
            if (!tb_fire(&c, chosen(&c, goal))) {
                break;
            }
            open = look(job, &c);
            if ((goal != NULL) && (goal->answer != TB_UNKNOWN)) {
                goal = NULL;
            }
        }
    }
    tb_cursor_free(&c);
}
