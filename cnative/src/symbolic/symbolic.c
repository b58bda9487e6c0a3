/* SPDX-License-Identifier: MIT
 * symbolic.c - the method `diagrams`: all reachable markings as a set, then their numbers, or the questions.
 *
 * Questions about markings come before those about time, each with its share of the time that is left. Before the set
 * is whole nothing is said: a place that fills for ever ends with time, memory or too many tokens.
 */
#include "symbolic.h"

#include <inttypes.h>
#include <pthread.h>
#include <stdio.h>

#define METHOD "DECISION_DIAGRAMS"

enum { STACK = 1 << 26, STACK_OF_LEVEL = 1 << 12, MOST_LEVELS = 1 << 20 };

typedef struct run {
    tb_job_t *job;
    double seconds;
    double patience; /* until the set is whole */
    bool is_sizes;
    bool is_nearby_first;
    sy_diagrams_t d;
    sy_frozen_t frozen;
    sy_node_t *known; /* of one question (answer_nearby) */
} run_t;

#define NEARBY 0.25 /* of the time for formulas of branching time, for those that can do with a part of the markings */

/* --- questions ---------------------------------------------------------------------------------------------------- */

static void answer_bound(run_t *r, tb_question_t *q)
{
    int64_t bound = 0;
    if (sy_largest_of(&r->d, &r->frozen, q->formula, &bound)) {
        tb_say_bound(q, bound, true, METHOD);
    }
}

static void answer(run_t *r, tb_question_t *q)
{
    if (q->kind == TB_BOUND) {
        answer_bound(r, q);
        return;
    }
    if (q->kind == TB_LTL) {
        tb_say(q, sy_accepts(&r->d, &q->automaton) ? TB_YES : TB_NO, METHOD);
        return;
    }
    const sy_node_t where = sy_where(&r->d, q->formula);
    const bool is_so =
        (q->kind == TB_REACH) ? (where != (sy_node_t)SY_NONE) : sy_contains(&r->d, where, r->job->net.initial);
    tb_say(q, is_so ? TB_YES : TB_NO, METHOD);
}

/* Of branching time, as far as it can be seen without a look at all markings. */
static void answer_nearby(run_t *r, tb_question_t *q)
{
    for (uint32_t i = 0U; i < q->formulas; i++) {
        r->known[i] = (sy_node_t)SY_ANY;
    }
    tb_say(q, sy_holds_at_first(&r->d, q->formula, r->known) ? TB_YES : TB_NO, METHOD);
}

static bool is_asked(const tb_question_t *q, tb_kind_t kind)
{
    return (q->kind == kind) && (q->answer == TB_UNKNOWN);
}

static void answer_all(run_t *r, tb_kind_t kind, void (*with)(run_t *r, tb_question_t *q), double until)
{
    volatile uint32_t left = 0U;
    for (uint32_t i = 0U; i < r->job->questions; i++) {
        left += is_asked(&r->job->question[i], kind) ? 1U : 0U;
    }
    for (volatile uint32_t i = 0U; i < r->job->questions; i++) {
        tb_question_t *q = &r->job->question[i];
        if (!is_asked(q, kind)) {
            continue;
        }
        const double now = tb_elapsed();
        tb_limit_time(now + ((until - now) / (double)left));
        left--;
        if (setjmp(r->d.given_up) == 0) {
            with(r, q);
        } else {
            r->d.edge_words = 0U; /* nodes that were in the making */
        }
    }
}

/* --- the state space ---------------------------------------------------------------------------------------------- */

static void find_space(run_t *r)
{
    sy_diagrams_t *d = &r->d;
    d->space = sy_saturated(d, &d->forwards, sy_one(d, r->job->net.initial), (sy_node_t)SY_ANY);
    sy_freeze(d, d->space, &r->frozen);
    d->most = tb_new((size_t)d->levels + 1U, sizeof *d->most);
    for (uint32_t i = 1U; i < r->frozen.nodes; i++) {
        const tb_count_t most = r->frozen.tokens[r->frozen.first[i + 1U] - 1U];
        const uint32_t level = r->frozen.level[i];
        d->most[level] = (most > d->most[level]) ? most : d->most[level];
    }
    (void)printf("seen %" PRIu32 " nodes, %" PRIu64 " in all, %.3f s\n", r->frozen.nodes, d->nodes, tb_elapsed());
    (void)fflush(stdout);
}

/* Two ways; the seed says which comes first. */
static void answer_branching(run_t *r)
{
    const double left = r->seconds - tb_elapsed();
    uint32_t most = 1U;
    for (uint32_t i = 0U; i < r->job->questions; i++) {
        most = (r->job->question[i].formulas > most) ? r->job->question[i].formulas : most;
    }
    r->known = tb_new(most, sizeof *r->known);
    if (r->is_nearby_first) {
        answer_all(r, TB_CTL, answer_nearby, tb_elapsed() + (NEARBY * left));
        answer_all(r, TB_CTL, answer, r->seconds);
    } else {
        answer_all(r, TB_CTL, answer, tb_elapsed() + ((1.0 - NEARBY) * left));
        answer_all(r, TB_CTL, answer_nearby, r->seconds);
    }
}

static void *work(void *argument)
{
    run_t *r = argument;
    sy_init(&r->d, &r->job->net, r->job->order);
    r->d.exact = r->job->exact;
    if (setjmp(r->d.given_up) != 0) {
        tb_fail(TB_EXIT_TIME, "time is over");
    }
    tb_limit_time((r->patience < r->seconds) ? r->patience : r->seconds);
    sy_make_events(&r->d);
    find_space(r);
    tb_limit_time(r->seconds);
    if (r->is_sizes) {
        sy_say_sizes(&r->d, &r->frozen, r->job);
    } else {
        answer_all(r, TB_BOUND, answer, r->seconds);
        answer_all(r, TB_REACH, answer, r->seconds);
        answer_branching(r);
        answer_all(r, TB_LTL, answer, r->seconds);
    }
    return NULL;
}

/* The functions call themselves from level to level: they need a stack of their own. */
void tb_diagrams(tb_job_t *job, bool is_sizes, uint64_t seed, double seconds, double patience)
{
    static run_t r;
    pthread_attr_t attributes;
    pthread_t worker;
    r.job = job;
    r.is_sizes = is_sizes;
    r.is_nearby_first = (seed % 2U) == 1U;
    r.seconds = seconds;
    r.patience = patience;
    if (job->net.places > (uint32_t)MOST_LEVELS) {
        tb_fail(TB_EXIT_MEMORY, "there are too many places");
    }
    const size_t stack = (size_t)STACK + ((size_t)STACK_OF_LEVEL * job->net.places);
    if ((pthread_attr_init(&attributes) != 0) || (pthread_attr_setstacksize(&attributes, stack) != 0)
        || (pthread_create(&worker, &attributes, work, &r) != 0) || (pthread_join(worker, NULL) != 0)) {
        tb_fail(TB_EXIT_MEMORY, "there is no room for a stack");
    }
}
