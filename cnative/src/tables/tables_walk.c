/* SPDX-License-Identifier: MIT
 * tables_walk.c - random walks, which find quickly what is found in many places.
 *
 * Every other walk is drawn towards one of the open questions: among a few enabled transitions the one is taken that
 * brings its formula nearest (tables_distance.c). If there is a guess which transitions have to occur how often, such
 * as a solution of the state equation, half of these walks follow it as far as they can. A quarter of them is eager:
 * they look at many more of the enabled transitions, and nearly never take another one than the best. So they come to
 * the most tokens of a place, where only one step in a hundred does not lead away.
 */
#include "tables.h"

#include <string.h>

enum {
    LENGTH = 20000, /* steps of a walk at most */
    CANDIDATES = 6,
    MANY_CANDIDATES = 4096, /* of an eager walk */
    EAGER_STEPS = 64,       /* one in so many steps of an eager walk is random */
    PATIENCE = 200,         /* steps of an eager walk that bring it no nearer than it was */
    PLAIN_STEPS = 4,        /* one in so many steps of a drawn walk is random */
    GUIDED_STEPS = 40       /* one in so many steps of a guided walk is not guided */
};

static uint64_t state = 1U;

/* The steps of the walk so far, if runs are to be told; NULL: they are not. */
static uint32_t *taken = NULL;
static uint32_t taken_count = 0U;

static void go_to_start(const tb_job_t *job, tb_cursor_t *c)
{
    tb_go_to(c, job->net.initial);
    taken_count = 0U;
}

static bool step_by(tb_cursor_t *c, uint32_t t)
{
    const bool is_done = tb_fire(c, t);
    if (is_done && (taken != NULL)) {
        taken[taken_count] = t;
        taken_count++;
    }
    return is_done;
}

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
            if (taken != NULL) {
                tb_say_run(q, taken, taken_count);
            }
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

/* Enabled transitions among which one is chosen; all, if there are not too many for an eager walk. */
static uint32_t candidates(const tb_cursor_t *c, bool is_eager, uint32_t *found)
{
    const uint32_t first = drawn(c->enabled_count);
    if (is_eager && (c->enabled_count <= (uint32_t)MANY_CANDIDATES)) {
        for (uint32_t i = 0U; i < c->enabled_count; i++) {
            found[i] = c->enabled[(first + i) % c->enabled_count];
        }
        return c->enabled_count;
    }
    const uint32_t count = is_eager ? (uint32_t)MANY_CANDIDATES : (uint32_t)CANDIDATES;
    for (uint32_t i = 0U; i < count; i++) {
        found[i] = c->enabled[drawn(c->enabled_count)];
    }
    return count;
}

static uint32_t chosen(tb_cursor_t *c, const tb_question_t *goal, bool is_eager)
{
    const uint32_t plain = is_eager ? (uint32_t)EAGER_STEPS : (uint32_t)PLAIN_STEPS;
    if ((goal == NULL) || (drawn(plain) == 0U)) {
        return c->enabled[drawn(c->enabled_count)];
    }
    const bool is_over_enabled = (goal->kind == TB_REACH) && tb_counts_enabled(goal->formula);
    uint32_t candidate[MANY_CANDIDATES];
    const uint32_t count = candidates(c, is_eager, candidate);
    uint32_t best = UINT32_MAX;
    double nearest = 0.0;
    for (uint32_t i = 0U; i < count; i++) {
        const uint32_t t = candidate[i];
        if (is_over_enabled ? tb_fire(c, t) : tb_move(c, t)) {
            const double d = aim(goal, c);
            if (is_over_enabled) {
                tb_unfire(c, t);
            } else {
                tb_unmove(c, t);
            }
            if ((best == UINT32_MAX) || (d < nearest)) {
                best = t;
                nearest = d;
            }
        }
    }
    return (best == UINT32_MAX) ? c->enabled[drawn(c->enabled_count)] : best;
}

/* One that is enabled and that the guess still has, or UINT32_MAX. */
static uint32_t guided(const tb_cursor_t *c, const uint32_t *left)
{
    uint32_t found = UINT32_MAX;
    uint32_t seen = 0U;
    for (uint32_t i = 0U; i < c->enabled_count; i++) {
        if (left[c->enabled[i]] > 0U) {
            seen++;
            found = (drawn(seen) == 0U) ? c->enabled[i] : found;
        }
    }
    return found;
}

/* The next step: what the guess has, now and then something else, so that no walk is like the one before. */
static uint32_t next_step(tb_cursor_t *c, const tb_question_t *goal, uint32_t *left)
{
    uint32_t t = UINT32_MAX;
    if ((left != NULL) && (drawn((uint32_t)GUIDED_STEPS) > 0U)) {
        t = guided(c, left);
    }
    t = (t == UINT32_MAX) ? chosen(c, goal, false) : t;
    if ((left != NULL) && (left[t] > 0U)) {
        left[t]--;
    }
    return t;
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

/* Until it comes no nearer to its goal; returns how many questions are open. */
static uint32_t eager_walk(tb_job_t *job, tb_cursor_t *c, const tb_question_t *goal, uint32_t length)
{
    uint32_t open = look(job, c);
    double nearest = aim(goal, c);
    uint32_t waited = 0U;
    for (uint32_t step = 0U; (step < length) && (c->enabled_count > 0U) && !tb_is_over(); step++) {
        if (!step_by(c, chosen(c, goal, true))) {
            break;
        }
        open = look(job, c);
        const double d = aim(goal, c);
        waited = (d < nearest) ? 0U : (waited + 1U);
        nearest = (d < nearest) ? d : nearest;
        if ((open == 0U) || (goal->answer != TB_UNKNOWN) || (waited > (uint32_t)PATIENCE)) {
            break;
        }
    }
    return open;
}

void tb_walk(tb_job_t *job, uint64_t seed, double seconds, bool is_told)
{
    tb_cursor_t c;
    taken = is_told ? tb_new((size_t)LENGTH, sizeof *taken) : NULL;
    tb_cursor_init(&c, &job->net);
    state = (seed * 0x9e3779b97f4a7c15U) | 1U;
    uint32_t open = look(job, &c);
    const double until = tb_elapsed() + seconds;
    const size_t size = job->net.transitions * sizeof(uint32_t);
    uint32_t *guess = tb_new(job->net.transitions, sizeof *guess);
    for (uint64_t walk = 0U; (open > 0U) && !tb_is_over() && (tb_elapsed() < until); walk++) {
        const tb_question_t *goal = ((walk % 2U) == 1U) ? goal_of(job, walk / 4U) : NULL;
        const uint32_t length = (walk < 64U) ? (uint32_t)(LENGTH / 20) : (uint32_t)LENGTH;
        uint32_t *left = NULL;
        if ((goal != NULL) && (goal->guide != NULL) && ((walk % 4U) == 1U)) {
            left = guess;
            (void)memcpy(left, goal->guide, size);
        }
        go_to_start(job, &c);
        if ((goal != NULL) && ((walk % 8U) == 7U)) {
            open = eager_walk(job, &c, goal, length);
            continue;
        }
        for (uint32_t step = 0U; (open > 0U) && (step < length) && (c.enabled_count > 0U) && !tb_is_over(); step++) {
            if (!step_by(&c, next_step(&c, goal, left))) {
                break;
            }
            open = look(job, &c);
            if ((goal != NULL) && (goal->answer != TB_UNKNOWN)) {
                goal = NULL;
            }
        }
    }
    tb_free(guess, job->net.transitions, sizeof *guess);
    if (taken != NULL) {
        tb_free(taken, (size_t)LENGTH, sizeof *taken);
        taken = NULL;
    }
    tb_cursor_free(&c);
}
