/* SPDX-License-Identifier: MIT
 * explore_turns.c - of the programs of a cell those that have to be looked at in a state, so that each run is seen in
 * one of its orders.
 *
 * A set of owners F and a set of disabled transitions D. It begins with an owner that can do something; then it is
 * closed:
 *
 * - of an owner in F all that it was asked must keep its answer: with an enabled transition its rivals come, and those
 *   that it might enable; with a disabled one what can end one reason for its being disabled,
 * - with a transition in D the same.
 *
 * What comes and is disabled joins D, the owner of anything else joins F. Which transitions these are follows from the
 * arcs (src/pn2code/verify/exploring/turns.py, where it is also said what such sets keep) and is read from a table. Of
 * the sets that begin with each owner the one with the fewest enabled transitions is taken.
 */
#include "explore_turns.h"
#include "explore_reduce.h"

#include <stdlib.h>
#include <string.h>

#include "pn/pn_marking.h"

#define MAGIC "pn2code-turns 1"
#define MANY  ((uint64_t)1U << 24U) /* the cost of what is enabled, in transitions that are not */

/* Numbers in a row of the table. */
typedef struct row {
    const uint32_t *number;
    uint32_t count;
} row_t;

typedef struct member {
    row_t rivals;
    row_t enables;
    row_t taken; /* pairs: place, tokens */
    row_t helpers;
    row_t reasons; /* one after the other: place, least, count, helpers; `count` is that of the reasons */
} member_t;

typedef struct table {
    uint32_t *number;
    uint64_t numbers;
    member_t *member; /* by transition */
    uint32_t leading; /* owner + 1; 0: none */
    uint32_t owners;
} table_t;

struct ex_turns {
    const table_t *table;
    ex_asked_t *asked; /* by transition */
    uint64_t *total;   /* by place: tokens */
    bool *is_kept;     /* by transition: in D */
    uint32_t *kept;    /* D, in the order in which they came */
    uint32_t kept_count;
    bool is_in[EX_MOST_OWNERS]; /* F */
    uint32_t member[EX_MOST_OWNERS];
    uint32_t member_count;
    uint32_t enabled[EX_MOST_OWNERS]; /* transitions that can occur, by owner */
    bool is_chosen[EX_MOST_OWNERS];
};

/* --- the table ---------------------------------------------------------------------------------------------------- */

typedef struct reader {
    const table_t *table;
    uint64_t at;
    bool is_wrong;
} reader_t;

/* All numbers of the file between its first line and its last. False: it cannot be read, or has no end. */
static bool read_numbers(ex_run_t *run, table_t *table, FILE *file)
{
    char magic[sizeof MAGIC + 1U] = "";
    char last[8] = "";
    uint64_t room = 0U;
    unsigned long value = 0U;
    bool is_fine = (fgets(magic, (int)sizeof magic, file) != NULL) && (strcmp(magic, MAGIC "\n") == 0);
    while (is_fine && (fscanf(file, "%lu", &value) == 1)) {
        if (table->numbers == room) {
            const uint64_t wanted = (room * 2U) + 4096U;
            uint32_t *const larger = ex_alloc(&run->memory, wanted * sizeof *larger);
            is_fine = larger != NULL;
            if (is_fine && (room > 0U)) {
                (void)memcpy(larger, table->number, room * sizeof *larger);
                ex_free(&run->memory, table->number, room * sizeof *table->number);
            }
            table->number = is_fine ? larger : table->number;
            room = is_fine ? wanted : room;
        }
        if (is_fine) {
            table->number[table->numbers] = (uint32_t)value;
            table->numbers += 1U;
        }
    }
    return is_fine && (fscanf(file, " %7s", last) == 1) && (strcmp(last, "end") == 0);
}

static uint32_t next(reader_t *r, uint32_t end)
{
    uint32_t value = 0U;
    if (r->is_wrong || (r->at >= r->table->numbers)) {
        r->is_wrong = true;
    } else {
        value = r->table->number[r->at];
        r->at += 1U;
        r->is_wrong = value >= end;
    }
    return r->is_wrong ? 0U : value;
}

/* A count and so many transitions. */
static row_t next_row(reader_t *r)
{
    row_t row = { .count = next(r, pn_net.transition_count + 1U) };
    row.number = &r->table->number[r->at];
    for (uint32_t i = 0U; !r->is_wrong && (i < row.count); i++) {
        (void)next(r, pn_net.transition_count);
    }
    return row;
}

static void next_member(reader_t *r, member_t *member)
{
    member->rivals = next_row(r);
    member->enables = next_row(r);
    member->taken.count = next(r, UINT32_MAX);
    member->taken.number = &r->table->number[r->at];
    for (uint32_t i = 0U; !r->is_wrong && (i < member->taken.count); i++) {
        (void)next(r, pn_net.place_count);
        (void)next(r, UINT32_MAX);
    }
    member->helpers = next_row(r);
    member->reasons.count = next(r, UINT32_MAX);
    member->reasons.number = &r->table->number[r->at];
    for (uint32_t i = 0U; !r->is_wrong && (i < member->reasons.count); i++) {
        (void)next(r, pn_net.place_count);
        (void)next(r, UINT32_MAX);
        (void)next_row(r);
    }
}

static table_t *read_table(ex_run_t *run, const char *path)
{
    table_t *const table = ex_alloc(&run->memory, sizeof *table);
    FILE *const file = fopen(path, "r");
    bool is_fine = (table != NULL) && (file != NULL) && read_numbers(run, table, file) && (table->numbers > 0U);
    if (file != NULL) {
        (void)fclose(file);
    }
    if (!is_fine) {
        return NULL;
    }
    reader_t r = { .table = table };
    r.is_wrong = next(&r, UINT32_MAX) != pn_net.place_count;
    r.is_wrong = (next(&r, UINT32_MAX) != pn_net.transition_count) || r.is_wrong;
    table->leading = next(&r, EX_MOST_OWNERS);
    table->member = ex_alloc(&run->memory, ((uint64_t)pn_net.transition_count + 1U) * sizeof *table->member);
    is_fine = table->member != NULL;
    for (uint32_t t = 0U; is_fine && (t < pn_net.transition_count); t++) {
        next_member(&r, &table->member[t]);
        const uint32_t owner = run->owner_of[t] + 1U;
        table->owners = (owner > table->owners) ? owner : table->owners;
    }
    return (is_fine && !r.is_wrong && (r.at == table->numbers)) ? table : NULL;
}

static struct ex_turns *made_for(ex_run_t *run, const table_t *table)
{
    const uint64_t count = (uint64_t)pn_net.transition_count + 1U;
    struct ex_turns *const own = ex_alloc(&run->memory, sizeof *own);
    if (own == NULL) {
        return NULL;
    }
    own->table = table;
    own->asked = ex_alloc(&run->memory, count * sizeof *own->asked);
    own->is_kept = ex_alloc(&run->memory, count * sizeof *own->is_kept);
    own->kept = ex_alloc(&run->memory, count * sizeof *own->kept);
    own->total = ex_alloc(&run->memory, ((uint64_t)pn_net.place_count + 1U) * sizeof *own->total);
    const bool has_memory =
        (own->asked != NULL) && (own->is_kept != NULL) && (own->kept != NULL) && (own->total != NULL);
    return has_memory ? own : NULL;
}

bool ex_turns_make(ex_run_t *run)
{
    const char *problem = NULL;
    const bool is_possible = !pn_net.timed && (run->owner_of != NULL) && (run->programs != NULL)
                             && !run->programs->has_clock && (run->reduction == NULL);
    const table_t *const table = is_possible ? read_table(run, run->options.turns) : NULL;
    if (!is_possible) {
        problem = "turns need owners with priorities of their own, and go with no time and no other reduction";
    } else if (table == NULL) {
        problem = "the table of turns cannot be read, is malformed, or there is not enough memory";
    } else {
        run->has_turns = true;
    }
    for (uint32_t i = 0U; (problem == NULL) && (i < run->options.threads); i++) {
        run->worker[i].turns = made_for(run, table);
        problem = (run->worker[i].turns == NULL) ? "there is not enough memory for turns" : NULL;
    }
    if (problem != NULL) {
        ex_note(run, "reduction", problem, -1);
    }
    return problem == NULL;
}

/* --- closing ------------------------------------------------------------------------------------------------------ */

static uint32_t owner_of(const ex_worker_t *worker, uint32_t t)
{
    return worker->run->owner_of[t];
}

/* Whether a place shows why a transition of which it holds so many tokens is disabled; fewer than `least`, or any. */
static bool is_reason(uint64_t total, uint32_t least)
{
    return (least == 0U) ? (total > 0U) : (total < least);
}

/* Whether a transition is known to be disabled, be it asked or not. */
static bool is_disabled(const struct ex_turns *own, uint32_t t)
{
    const row_t reasons = own->table->member[t].reasons;
    const uint32_t *at = reasons.number;
    bool is_known = own->asked[t] == EX_DISABLED;
    for (uint32_t i = 0U; !is_known && (own->asked[t] == EX_NOT_ASKED) && (i < reasons.count); i++) {
        is_known = is_reason(own->total[at[0]], at[1]);
        at = &at[3U + at[2]];
    }
    return is_known;
}

static void join(struct ex_turns *own, uint32_t owner)
{
    if (!own->is_in[owner]) {
        own->is_in[owner] = true;
        own->member[own->member_count] = owner;
        own->member_count += 1U;
    }
}

static void need(const ex_worker_t *worker, uint32_t t)
{
    struct ex_turns *const own = worker->turns;
    if (own->is_in[owner_of(worker, t)] || own->is_kept[t]) {
        return;
    }
    if (is_disabled(own, t)) {
        own->is_kept[t] = true;
        own->kept[own->kept_count] = t;
        own->kept_count += 1U;
    } else {
        join(own, owner_of(worker, t));
    }
}

static void need_all(const ex_worker_t *worker, row_t row)
{
    for (uint32_t i = 0U; i < row.count; i++) {
        need(worker, row.number[i]);
    }
}

static uint64_t cost_of(const ex_worker_t *worker, row_t row)
{
    const struct ex_turns *const own = worker->turns;
    uint64_t cost = 0U;
    for (uint32_t i = 0U; i < row.count; i++) {
        const uint32_t t = row.number[i];
        if (!own->is_in[owner_of(worker, t)] && !own->is_kept[t]) {
            cost += is_disabled(own, t) ? 1U : MANY;
        }
    }
    return cost;
}

static bool is_listed(row_t row, uint32_t t)
{
    bool is_found = false;
    for (uint32_t i = 0U; !is_found && (i < row.count); i++) {
        is_found = row.number[i] == t;
    }
    return is_found;
}

/* Tokens that an occurrence of a transition takes from a place and does not put back. */
static uint32_t taken_by(const member_t *member, uint32_t place)
{
    uint32_t taken = 0U;
    for (uint32_t i = 0U; i < member->taken.count; i++) {
        taken = (member->taken.number[2U * i] == place) ? member->taken.number[(2U * i) + 1U] : taken;
    }
    return taken;
}

/* The cheapest reason for which a transition is disabled, as what can end it; where `after` is a transition, one for
 * which it is disabled after that has occurred, too. False: none is known. */
static bool find_reason(const ex_worker_t *worker, uint32_t t, uint32_t after, row_t *best)
{
    const struct ex_turns *const own = worker->turns;
    const member_t *const members = own->table->member;
    const uint32_t *at = members[t].reasons.number;
    uint64_t least = UINT64_MAX;
    for (uint32_t i = 0U; (i < members[t].reasons.count) && (least > 0U); i++) {
        const uint32_t place = at[0];
        const row_t helpers = { .number = &at[3], .count = at[2] };
        const bool is_helped = (after != UINT32_MAX) && is_listed(helpers, after);
        const uint32_t taken = (after != UINT32_MAX) ? taken_by(&members[after], place) : 0U;
        const uint64_t total = (own->total[place] > taken) ? (own->total[place] - taken) : 0U;
        const bool is_one = is_reason((at[1] == 0U) ? own->total[place] : total, at[1]);
        const uint64_t cost = (is_one && !is_helped) ? cost_of(worker, helpers) : UINT64_MAX;
        if (cost < least) {
            least = cost;
            *best = helpers;
        }
        at = &at[3U + at[2]];
    }
    return least < UINT64_MAX;
}

/* What keeps a disabled transition disabled. */
static void keep(const ex_worker_t *worker, uint32_t t)
{
    row_t helpers = worker->turns->table->member[t].helpers;
    (void)find_reason(worker, t, UINT32_MAX, &helpers);
    need_all(worker, helpers);
}

/* None of those that an enabled transition might enable may come to hold others of its owner back. */
static void keep_enabled(const ex_worker_t *worker, uint32_t t)
{
    const struct ex_turns *const own = worker->turns;
    const row_t enables = own->table->member[t].enables;
    for (uint32_t i = 0U; i < enables.count; i++) {
        const uint32_t other = enables.number[i];
        row_t helpers = { 0 };
        if (own->is_in[owner_of(worker, other)]) {
            continue;
        }
        if (find_reason(worker, other, t, &helpers)) {
            need_all(worker, helpers);
        } else {
            join(worker->turns, owner_of(worker, other));
        }
    }
}

static void keep_answers(const ex_worker_t *worker, uint32_t owner)
{
    const struct ex_turns *const own = worker->turns;
    for (uint32_t t = 0U; t < pn_net.transition_count; t++) {
        if (owner_of(worker, t) != owner) {
            continue;
        }
        if (own->asked[t] == EX_ENABLED) {
            need_all(worker, own->table->member[t].rivals);
            if (!worker->run->programs->is_probe[t]) {
                keep_enabled(worker, t);
            }
        } else if (own->asked[t] == EX_DISABLED) {
            keep(worker, t);
        } else {
            /* the owner does not ask */
        }
    }
}

/* Closes a set that begins with an owner. How many enabled transitions it has: at least `most`, if it was given up. */
static uint32_t close_from(const ex_worker_t *worker, uint32_t first, uint32_t most)
{
    struct ex_turns *const own = worker->turns;
    uint32_t members = 0U;
    uint32_t kept = 0U;
    uint32_t cost = 0U;
    (void)memset(own->is_in, 0, sizeof own->is_in);
    (void)memset(own->is_kept, 0, pn_net.transition_count * sizeof *own->is_kept);
    own->member_count = 0U;
    own->kept_count = 0U;
    join(own, first);
    while ((cost < most) && ((members < own->member_count) || (kept < own->kept_count))) {
        if (members < own->member_count) {
            const uint32_t owner = own->member[members];
            members += 1U;
            cost += own->enabled[owner];
            keep_answers(worker, owner);
        } else {
            keep(worker, own->kept[kept]);
            kept += 1U;
        }
    }
    return cost;
}

ex_asked_t *ex_turns_asked(const ex_worker_t *worker)
{
    return worker->turns->asked;
}

/* Whether the leading owner does something that is seen by itself. */
static bool is_led(const ex_worker_t *worker)
{
    const struct ex_turns *const own = worker->turns;
    bool is_found = false;
    for (uint32_t t = 0U; !is_found && (own->table->leading > 0U) && (t < pn_net.transition_count); t++) {
        is_found = ((owner_of(worker, t) + 1U) == own->table->leading) && (own->asked[t] == EX_ENABLED)
                   && !worker->run->programs->is_silent[t];
    }
    return is_found;
}

/* Counts what can occur, in all and by owner. */
static uint32_t count_enabled(const ex_worker_t *worker)
{
    struct ex_turns *const own = worker->turns;
    uint32_t all = 0U;
    (void)memset(own->enabled, 0, sizeof own->enabled);
    for (uint32_t t = 0U; t < pn_net.transition_count; t++) {
        if ((own->asked[t] == EX_ENABLED) && !worker->run->programs->is_probe[t]) {
            own->enabled[owner_of(worker, t)] += 1U;
            all += 1U;
        }
    }
    return all;
}

const bool *ex_turns_choose(ex_worker_t *worker)
{
    struct ex_turns *const own = worker->turns;
    const bool has_lead = is_led(worker);
    const uint32_t leader = has_lead ? (own->table->leading - 1U) : 0U;
    uint32_t most = count_enabled(worker);
    for (uint32_t o = 0U; o < own->table->owners; o++) {
        own->is_chosen[o] = true;
    }
    for (uint32_t p = 0U; (most > 1U) && (p < pn_net.place_count); p++) {
        own->total[p] = pn_multiset_total(pn_net.place[p].multiset, worker->marking);
    }
    for (uint32_t o = has_lead ? leader : 0U; (most > 1U) && (o < (has_lead ? (leader + 1U) : own->table->owners));
         o++) {
        const uint32_t cost = (own->enabled[o] > 0U) ? close_from(worker, o, most) : most;
        if ((cost < most) && (!has_lead || (cost == own->enabled[leader]))) {
            most = cost;
            (void)memcpy(own->is_chosen, own->is_in, sizeof own->is_chosen);
        }
    }
    return own->is_chosen;
}
