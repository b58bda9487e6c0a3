/* SPDX-License-Identifier: MIT
 * explore_dependency.c - of the transitions that are enabled in a state, those that have to be looked at so that no
 * dead state is missed; for nets of which the binding elements cannot be listed.
 *
 * A strong stubborn set of transitions. It begins with an enabled one; then it is closed:
 *
 * - with an enabled one all those belong to the set that might disable one of its bindings, give it a new one, or be
 * disabled by it (`rivals`), and the more urgent ones, so that none of them comes to be enabled meanwhile,
 * - with a disabled one all those that can end one reason for its being disabled.
 *
 * Which these are follows from the arcs and inscriptions (src/pn2code/verify/exploring/dependency.py, where it is also
 * said why that is enough) and is read from a table. Of the sets that begin with each enabled transition the one with
 * the fewest enabled ones is taken. Sets in which something is enabled that might enable something more urgent, or that
 * might close a cycle (so that others would be put off for ever, and an exception be missed), are not.
 */
#include "explore_reduce.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define MAGIC "pn2code-dependency 1"

/* Transitions, in a row of numbers. */
typedef struct list {
    uint64_t first;
    uint32_t count;
} list_t;

/* Why a transition may be disabled, and what can end that. */
typedef struct reason {
    uint32_t place;
    uint32_t least; /* fewer tokens are too few; 0: any token is too many */
    list_t helpers;
} reason_t;

typedef struct member {
    bool is_spoiling; /* its occurrence may enable a more urgent one, or close a cycle */
    list_t rivals;
    list_t helpers; /* where it is not known why it is disabled */
    uint64_t reason;
    uint32_t reasons;
} member_t;

typedef struct ex_dependency {
    member_t *member; /* by transition */
    reason_t *reason;
    uint32_t *number; /* of the lists */
    uint64_t reasons;
    uint64_t numbers;
} dependency_t;

typedef struct ex_persistent {
    const dependency_t *dependency;
    bool *is_enabled; /* by transition */
    bool *is_in;      /* the set that is closed */
    bool *is_chosen;  /* is to be looked at */
    uint32_t *set;    /* in the order in which they came */
    uint64_t *total;  /* by place: tokens */
    uint32_t set_count;
    uint32_t set_enabled;
    int32_t priority; /* of what is enabled */
} persistent_t;

/* --- the table ---------------------------------------------------------------------------------------------------- */

typedef struct reader {
    ex_run_t *run;
    FILE *file;
    dependency_t *dependency;
    uint64_t room_numbers;
    uint64_t room_reasons;
    bool is_wrong;
} reader_t;

static uint32_t number(reader_t *r, uint64_t end)
{
    uint32_t value = 0U;
    if (!r->is_wrong && ((fscanf(r->file, "%" SCNu32, &value) != 1) || (value >= end))) {
        r->is_wrong = true;
    }
    return r->is_wrong ? 0U : value;
}

/* Room for one more at the end of a table that grows. */
static void *grown(reader_t *r, void *table, uint64_t used, uint64_t *room, size_t size)
{
    if (used < *room) {
        return table;
    }
    const uint64_t wanted = (*room * 2U) + 1024U;
    void *larger = ex_alloc(&r->run->memory, wanted * size);
    if (larger == NULL) {
        r->is_wrong = true;
        return table;
    }
    if (used > 0U) {
        (void)memcpy(larger, table, used * size);
    }
    if (table != NULL) {
        ex_free(&r->run->memory, table, *room * size);
    }
    *room = wanted;
    return larger;
}

static list_t read_list(reader_t *r)
{
    dependency_t *const made = r->dependency;
    list_t list = { .first = made->numbers, .count = number(r, (uint64_t)pn_net.transition_count + 1U) };
    for (uint32_t i = 0U; !r->is_wrong && (i < list.count); i++) {
        made->number = grown(r, made->number, made->numbers, &r->room_numbers, sizeof *made->number);
        if (!r->is_wrong) {
            made->number[made->numbers] = number(r, pn_net.transition_count);
            made->numbers++;
        }
    }
    return list;
}

static void read_member(reader_t *r, member_t *member)
{
    dependency_t *const made = r->dependency;
    member->is_spoiling = number(r, 2U) == 1U;
    member->rivals = read_list(r);
    member->helpers = read_list(r);
    member->reason = made->reasons;
    member->reasons = number(r, UINT32_MAX);
    for (uint32_t i = 0U; !r->is_wrong && (i < member->reasons); i++) {
        made->reason = grown(r, made->reason, made->reasons, &r->room_reasons, sizeof *made->reason);
        if (!r->is_wrong) {
            reason_t *const reason = &made->reason[made->reasons];
            made->reasons++;
            reason->place = number(r, pn_net.place_count);
            reason->least = number(r, UINT32_MAX);
            reason->helpers = read_list(r);
        }
    }
}

static void read_all(reader_t *r)
{
    char magic[sizeof MAGIC + 1U] = "";
    char last[8] = "";
    r->is_wrong = (fgets(magic, (int)sizeof magic, r->file) == NULL) || (strcmp(magic, MAGIC "\n") != 0);
    r->is_wrong = (number(r, UINT32_MAX) != pn_net.place_count) || r->is_wrong;
    r->is_wrong = (number(r, UINT32_MAX) != pn_net.transition_count) || r->is_wrong;
    for (uint32_t t = 0U; !r->is_wrong && (t < pn_net.transition_count); t++) {
        read_member(r, &r->dependency->member[t]);
    }
    r->is_wrong = r->is_wrong || (fscanf(r->file, " %7s", last) != 1) || (strcmp(last, "end") != 0);
}

bool ex_dependency_read(ex_run_t *run, ex_reduction_t *reduction, const char *path)
{
    reader_t r = { .run = run, .file = fopen(path, "r"), .dependency = ex_alloc(&run->memory, sizeof *r.dependency) };
    r.is_wrong = (r.file == NULL) || (r.dependency == NULL);
    if (!r.is_wrong) {
        r.dependency->member =
            ex_alloc(&run->memory, ((uint64_t)pn_net.transition_count + 1U) * sizeof *r.dependency->member);
        r.is_wrong = r.dependency->member == NULL;
    }
    if (!r.is_wrong) {
        read_all(&r);
    }
    if (r.file != NULL) {
        (void)fclose(r.file);
    }
    reduction->dependency = r.dependency;
    return !r.is_wrong;
}

bool ex_persistent_make(ex_worker_t *worker, const ex_reduction_t *reduction)
{
    ex_run_t *const run = worker->run;
    const uint64_t count = (uint64_t)pn_net.transition_count + 1U;
    persistent_t *own = ex_alloc(&run->memory, sizeof *own);
    if (own == NULL) {
        return false;
    }
    worker->persistent = own;
    own->dependency = reduction->dependency;
    own->is_enabled = ex_alloc(&run->memory, count * sizeof *own->is_enabled);
    own->is_in = ex_alloc(&run->memory, count * sizeof *own->is_in);
    own->is_chosen = ex_alloc(&run->memory, count * sizeof *own->is_chosen);
    own->set = ex_alloc(&run->memory, count * sizeof *own->set);
    own->total = ex_alloc(&run->memory, ((uint64_t)pn_net.place_count + 1U) * sizeof *own->total);
    return (own->is_enabled != NULL) && (own->is_in != NULL) && (own->is_chosen != NULL) && (own->set != NULL)
           && (own->total != NULL);
}

/* --- closing ------------------------------------------------------------------------------------------------------ */

static void add(persistent_t *own, uint32_t t)
{
    if (!own->is_in[t]) {
        own->is_in[t] = true;
        own->set[own->set_count++] = t;
        own->set_enabled += own->is_enabled[t] ? 1U : 0U;
    }
}

static void add_all(persistent_t *own, list_t list)
{
    for (uint32_t i = 0U; i < list.count; i++) {
        add(own, own->dependency->number[list.first + i]);
    }
}

/* What it costs to have these, too: enabled ones have to be looked at. */
static uint64_t cost_of(const persistent_t *own, list_t list)
{
    uint64_t cost = 0U;
    for (uint32_t i = 0U; i < list.count; i++) {
        const uint32_t t = own->dependency->number[list.first + i];
        if (!own->is_in[t]) {
            cost += own->is_enabled[t] ? ((uint64_t)1U << 24U) : 1U;
        }
    }
    return cost;
}

static void add_urgent(persistent_t *own, uint32_t t)
{
    const int32_t priority = pn_net.transition[t].priority;
    for (uint32_t k = 0U; (k < pn_net.order_count) && (pn_net.transition[pn_net.order[k]].priority < priority); k++) {
        add(own, pn_net.order[k]);
    }
}

static void add_helpers(persistent_t *own, uint32_t t)
{
    const member_t *const member = &own->dependency->member[t];
    list_t best = member->helpers;
    uint64_t least = UINT64_MAX;
    for (uint32_t i = 0U; (i < member->reasons) && (least > 0U); i++) {
        const reason_t *const reason = &own->dependency->reason[member->reason + i];
        const uint64_t total = own->total[reason->place];
        const bool is_one = (reason->least == 0U) ? (total > 0U) : (total < reason->least);
        const uint64_t cost = is_one ? cost_of(own, reason->helpers) : UINT64_MAX;
        if (cost < least) {
            least = cost;
            best = reason->helpers;
        }
    }
    add_all(own, best);
}

/* Closes a set that begins with an enabled transition. False: it is not smaller than `most`. */
static bool is_closed(persistent_t *own, uint32_t first, uint32_t most)
{
    own->set_count = 0U;
    own->set_enabled = 0U;
    (void)memset(own->is_in, 0, pn_net.transition_count * sizeof *own->is_in);
    add(own, first);
    for (uint32_t i = 0U; (i < own->set_count) && (own->set_enabled < most); i++) {
        const uint32_t t = own->set[i];
        if (own->is_enabled[t]) {
            if (own->dependency->member[t].is_spoiling) {
                return false;
            }
            add_all(own, own->dependency->member[t].rivals);
            add_urgent(own, t);
        } else if (pn_net.transition[t].priority <= own->priority) {
            add_helpers(own, t);
        } else {
            /* what is enabled in the set is more urgent, and stays so until something of the set occurs */
        }
    }
    return own->set_enabled < most;
}

bool *ex_persistent_enabled(const ex_worker_t *worker)
{
    return worker->persistent->is_enabled;
}

const bool *ex_persistent_choose(ex_worker_t *worker, int32_t priority)
{
    persistent_t *const own = worker->persistent;
    uint32_t most = 0U;
    own->priority = priority;
    for (uint32_t t = 0U; t < pn_net.transition_count; t++) {
        own->is_chosen[t] = own->is_enabled[t];
        most += own->is_enabled[t] ? 1U : 0U;
    }
    for (uint32_t p = 0U; (most > 1U) && (p < pn_net.place_count); p++) {
        own->total[p] = pn_multiset_total(pn_net.place[p].multiset, worker->marking);
    }
    for (uint32_t t = 0U; (most > 1U) && (t < pn_net.transition_count); t++) {
        if (own->is_enabled[t] && is_closed(own, t, most)) {
            most = own->set_enabled;
            for (uint32_t u = 0U; u < pn_net.transition_count; u++) {
                own->is_chosen[u] = own->is_enabled[u] && own->is_in[u];
            }
        }
    }
    return own->is_chosen;
}
