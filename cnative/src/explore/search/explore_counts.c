/* SPDX-License-Identifier: MIT
 * explore_counts.c - numbers of tokens that are counted up to a limit only: whatever is greater is the limit.
 *
 * A state stands for all markings that agree with it but for such numbers: where it holds the limit, they hold so many
 * or more. When tokens are taken from a place that holds the limit, what is left may be the limit again, or less; all
 * that it may be are successors. Likewise the number that the one token of a place carries, if all that happens to it
 * is that something is added or subtracted.
 *
 * Of these successors those are left out that no marking agrees with: because of relations that each marking fulfils
 * (`sum of weight * tokens + sum of weight * value = total`). Which places these are, and why nothing is missed, is
 * said in src/pn2code/verify/exploring/counts.py, which writes the table.
 */
#include "explore_counts.h"
#include "explore_reduce.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "pn/pn_packed.h"

#define MAGIC "pn2code-counts 1"

typedef struct limit {
    uint32_t place;
    int64_t most;  /* what is greater is taken for this */
    bool is_value; /* of the number that the token is; else of the tokens of each colour */
} limit_t;

/* A place, or the number that its token is, in a relation. */
typedef struct summand {
    uint32_t place;
    int64_t weight;
} summand_t;

typedef struct relation {
    int64_t total;
    summand_t *tokens;
    uint32_t token_count;
    summand_t *values;
    uint32_t value_count;
} relation_t;

/* What an occurrence of a transition concerns: the relations with a place that it changes, and all of their places. */
typedef struct concern {
    uint32_t *relation;
    uint32_t relations;
    uint32_t *place;
    uint32_t places;
} concern_t;

typedef struct table {
    limit_t *limit;
    uint32_t limits;
    uint32_t *limit_of; /* by place, + 1; 0: all tokens count */
    relation_t *relation;
    uint32_t relations;
    concern_t *concern; /* by transition */
    uint32_t spots;     /* numbers that have limits */
} table_t;

/* What a place holds: so many tokens, or any greater number. */
typedef struct held {
    int64_t tokens;
    int64_t value; /* the number that its token is; 0 without one */
    bool may_be_more;
    bool may_be_greater;
} held_t;

/* A number of a successor that has a limit and has changed. */
typedef struct spot {
    const limit_t *limit;
    uint32_t colour;
    int64_t was; /* in the successor as it is */
    int64_t low; /* what it may be */
    int64_t high;
    int64_t now;
} spot_t;

struct ex_counts {
    table_t table;
    spot_t *spot[EX_MOST_THREADS]; /* by worker */
    held_t *held[EX_MOST_THREADS]; /* the same, by place */
};

/* --- the table ---------------------------------------------------------------------------------------------------- */

static bool read_one(FILE *file, int64_t low, int64_t high, int64_t *value)
{
    return (fscanf(file, "%" SCNd64, value) == 1) && (*value >= low) && (*value <= high);
}

static bool read_count(FILE *file, uint64_t most, uint32_t *count)
{
    int64_t value = 0;
    const bool is_fine = read_one(file, 0, (int64_t)most, &value);
    *count = (uint32_t)value;
    return is_fine;
}

static bool is_number(const pn_multiset_t *multiset)
{
    return !multiset->is_packed && (multiset->type->kind == PN_KIND_INT);
}

static bool read_limit(FILE *file, table_t *table, uint32_t i)
{
    limit_t *const limit = &table->limit[i];
    uint32_t is_value = 0U;
    if (!read_count(file, (uint64_t)pn_net.place_count - 1U, &limit->place)
        || !read_one(file, 0, (int64_t)UINT16_MAX, &limit->most) || !read_count(file, 1U, &is_value)) {
        return false;
    }
    const pn_multiset_t *const multiset = pn_net.place[limit->place].multiset;
    limit->is_value = is_value != 0U;
    table->limit_of[limit->place] = i + 1U;
    table->spots += limit->is_value ? 1U : multiset->colours;
    return limit->is_value ? is_number(multiset) : multiset->is_packed;
}

static bool read_summands(ex_run_t *run, FILE *file, summand_t **summand, uint32_t *count, bool are_values)
{
    bool is_fine = read_count(file, UINT16_MAX, count);
    *summand = is_fine ? ex_alloc(&run->memory, ((uint64_t)*count + 1U) * sizeof **summand) : NULL;
    is_fine = *summand != NULL;
    for (uint32_t i = 0U; is_fine && (i < *count); i++) {
        summand_t *const own = &(*summand)[i];
        is_fine = read_count(file, (uint64_t)pn_net.place_count - 1U, &own->place)
                  && read_one(file, INT32_MIN, INT32_MAX, &own->weight)
                  && (!are_values || is_number(pn_net.place[own->place].multiset));
    }
    return is_fine;
}

static bool read_table(ex_run_t *run, FILE *file, table_t *table)
{
    char magic[sizeof MAGIC + 1U] = "";
    char last[8] = "";
    uint32_t places = 0U;
    bool is_fine = (fgets(magic, (int)sizeof magic, file) != NULL) && (strcmp(magic, MAGIC "\n") == 0);
    is_fine = is_fine && read_count(file, UINT32_MAX, &places) && (places == pn_net.place_count)
              && read_count(file, pn_net.place_count, &table->limits)
              && read_count(file, UINT16_MAX, &table->relations);
    if (!is_fine) {
        return false;
    }
    table->limit = ex_alloc(&run->memory, ((uint64_t)table->limits + 1U) * sizeof *table->limit);
    table->limit_of = ex_alloc(&run->memory, ((uint64_t)places + 1U) * sizeof *table->limit_of);
    table->relation = ex_alloc(&run->memory, ((uint64_t)table->relations + 1U) * sizeof *table->relation);
    is_fine = (table->limit != NULL) && (table->limit_of != NULL) && (table->relation != NULL);
    for (uint32_t i = 0U; is_fine && (i < table->limits); i++) {
        is_fine = read_limit(file, table, i);
    }
    for (uint32_t i = 0U; is_fine && (i < table->relations); i++) {
        relation_t *const own = &table->relation[i];
        is_fine = read_one(file, INT64_MIN / 2, INT64_MAX / 2, &own->total)
                  && read_summands(run, file, &own->tokens, &own->token_count, false)
                  && read_summands(run, file, &own->values, &own->value_count, true);
    }
    return is_fine && (fscanf(file, " %7s", last) == 1) && (strcmp(last, "end") == 0);
}

static bool mentions(const relation_t *relation, uint32_t place)
{
    bool is_found = false;
    for (uint32_t i = 0U; !is_found && (i < relation->token_count); i++) {
        is_found = relation->tokens[i].place == place;
    }
    for (uint32_t i = 0U; !is_found && (i < relation->value_count); i++) {
        is_found = relation->values[i].place == place;
    }
    return is_found;
}

static bool find_concern(ex_run_t *run, const table_t *table, const pn_transition_t *t, concern_t *concern)
{
    concern->relation = ex_table(&run->memory, table->relations, sizeof *concern->relation);
    concern->place = ex_table(&run->memory, pn_net.place_count, sizeof *concern->place);
    if ((concern->relation == NULL) || (concern->place == NULL)) {
        return false;
    }
    for (uint32_t i = 0U; i < table->relations; i++) {
        bool is_concerned = false;
        for (uint32_t k = 0U; !is_concerned && (k < t->touched_count); k++) {
            is_concerned = mentions(&table->relation[i], t->touched[k]);
        }
        concern->relation[concern->relations] = i;
        concern->relations += is_concerned ? 1U : 0U;
    }
    for (uint32_t p = 0U; p < pn_net.place_count; p++) {
        bool is_in = false;
        for (uint32_t i = 0U; !is_in && (i < concern->relations); i++) {
            is_in = mentions(&table->relation[concern->relation[i]], p);
        }
        concern->place[concern->places] = p;
        concern->places += is_in ? 1U : 0U;
    }
    return true;
}

/* Which relations have to be looked at after an occurrence: of the others nothing has changed. */
static bool find_concerns(ex_run_t *run, table_t *table)
{
    table->concern = ex_table(&run->memory, pn_net.transition_count, sizeof *table->concern);
    bool is_fine = table->concern != NULL;
    for (uint32_t t = 0U; is_fine && (t < pn_net.transition_count); t++) {
        is_fine = find_concern(run, table, &pn_net.transition[t], &table->concern[t]);
    }
    return is_fine;
}

bool ex_counts_make(ex_run_t *run)
{
    const char *problem = NULL;
    struct ex_counts *const counts = ex_alloc(&run->memory, sizeof *counts);
    FILE *const file = fopen(run->options.counts, "r");
    if (!run->has_turns || (run->codec->derived_count > 0U) || (pn_net.root_count > 0U)) {
        problem = "numbers up to a limit need programs that take turns, no places that follow from others, and no "
                  "references";
    } else if ((counts == NULL) || (file == NULL) || !read_table(run, file, &counts->table)
               || !find_concerns(run, &counts->table)) {
        problem = "the table of limits cannot be read, is malformed, or there is not enough memory";
    } else {
        run->counts = counts;
    }
    if (file != NULL) {
        (void)fclose(file);
    }
    for (uint32_t i = 0U; (problem == NULL) && (i < run->options.threads); i++) {
        counts->spot[i] = ex_alloc(&run->memory, ((uint64_t)counts->table.spots + 1U) * sizeof *counts->spot[i]);
        counts->held[i] = ex_table(&run->memory, pn_net.place_count, sizeof *counts->held[i]);
        problem =
            ((counts->spot[i] == NULL) || (counts->held[i] == NULL)) ? "there is not enough memory for limits" : NULL;
    }
    if (problem != NULL) {
        ex_note(run, "reduction", problem, -1);
    }
    return problem == NULL;
}

/* --- numbers of a marking ----------------------------------------------------------------------------------------- */

static const pn_multiset_t *place_of(const limit_t *limit)
{
    return pn_net.place[limit->place].multiset;
}

static int64_t number_in(const pn_multiset_t *multiset, const void *marking)
{
    int64_t value;
    (void)memcpy(&value, (const unsigned char *)marking + multiset->first + multiset->value, sizeof value);
    return value;
}

static bool has_token(const pn_multiset_t *multiset, const void *marking)
{
    return pn_multiset_total(multiset, marking) > 0U;
}

static int64_t get(const limit_t *limit, uint32_t colour, const void *marking)
{
    const pn_multiset_t *const multiset = place_of(limit);
    return limit->is_value ? number_in(multiset, marking)
                           : (int64_t)pn_counter(marking, multiset->bit, multiset->width, colour);
}

static void set(const limit_t *limit, uint32_t colour, void *marking, int64_t value)
{
    const pn_multiset_t *const multiset = place_of(limit);
    if (limit->is_value) {
        (void)memcpy((unsigned char *)marking + multiset->first + multiset->value, &value, sizeof value);
        return;
    }
    const uint32_t old = pn_counter(marking, multiset->bit, multiset->width, colour);
    pn_counter_subtract(marking, multiset->bit, multiset->width, colour, old);
    pn_counter_add(marking, multiset->bit, multiset->width, colour, (uint32_t)value);
}

static uint32_t numbers_of(const limit_t *limit, const void *marking)
{
    const pn_multiset_t *const multiset = place_of(limit);
    return limit->is_value ? (has_token(multiset, marking) ? 1U : 0U) : multiset->colours;
}

void ex_counts_begin(const ex_run_t *run, void *marking)
{
    const table_t *const table = &run->counts->table;
    for (uint32_t i = 0U; i < table->limits; i++) {
        const limit_t *const limit = &table->limit[i];
        for (uint32_t c = 0U; c < numbers_of(limit, marking); c++) {
            if (get(limit, c, marking) > limit->most) {
                set(limit, c, marking, limit->most);
            }
        }
    }
}

/* --- relations ---------------------------------------------------------------------------------------------------- */

/* What a sum may be. */
typedef struct range {
    int64_t low;
    int64_t high;
    bool is_low_open;  /* any smaller number, too */
    bool is_high_open; /* any greater one */
} range_t;

static void add(range_t *range, int64_t weight, int64_t least, bool may_be_more)
{
    range->low += weight * least;
    range->high += weight * least;
    range->is_high_open = range->is_high_open || (may_be_more && (weight > 0));
    range->is_low_open = range->is_low_open || (may_be_more && (weight < 0));
}

static bool is_limited(const table_t *table, uint32_t place, bool is_value, const void *marking)
{
    const uint32_t own = table->limit_of[place];
    if ((own == 0U) || (table->limit[own - 1U].is_value != is_value)) {
        return false;
    }
    const limit_t *const limit = &table->limit[own - 1U];
    bool is_found = false;
    for (uint32_t c = 0U; !is_found && (c < numbers_of(limit, marking)); c++) {
        is_found = get(limit, c, marking) >= limit->most;
    }
    return is_found;
}

static void look_at(const table_t *table, uint32_t place, const void *marking, held_t *held)
{
    const pn_multiset_t *const multiset = pn_net.place[place].multiset;
    const uint64_t total = pn_multiset_total(multiset, marking);
    *held = (held_t){ .tokens = (int64_t)total };
    held->may_be_more = is_limited(table, place, false, marking);
    if (is_number(multiset) && (total > 0U)) {
        held->value = number_in(multiset, marking);
        held->may_be_greater = is_limited(table, place, true, marking);
    }
}

/* Whether some marking for which this one stands may fulfil a relation. */
static bool may_hold(const relation_t *relation, const held_t *held)
{
    range_t range = { .low = -relation->total, .high = -relation->total };
    for (uint32_t i = 0U; i < relation->token_count; i++) {
        const held_t *const own = &held[relation->tokens[i].place];
        add(&range, relation->tokens[i].weight, own->tokens, own->may_be_more);
    }
    for (uint32_t i = 0U; i < relation->value_count; i++) {
        const held_t *const own = &held[relation->values[i].place];
        add(&range, relation->values[i].weight, own->value, own->may_be_greater);
    }
    return (range.is_low_open || (range.low <= 0)) && (range.is_high_open || (range.high >= 0));
}

/* The marking before fulfils all relations; `held` is of the places that the transition concerns. */
static bool is_possible(const table_t *table, const concern_t *concern, const held_t *held)
{
    bool is_fine = true;
    for (uint32_t i = 0U; is_fine && (i < concern->relations); i++) {
        is_fine = may_hold(&table->relation[concern->relation[i]], held);
    }
    return is_fine;
}

/* --- successors --------------------------------------------------------------------------------------------------- */

/* What a number may be that was `before` and is `after` in the successor as it is. */
static void allow(spot_t *spot, int64_t before, int64_t after)
{
    const int64_t most = spot->limit->most;
    spot->was = after;
    spot->low = (after < most) ? after : most;
    spot->high = (before >= most) ? most : spot->low; /* it may have been any greater number */
    spot->now = spot->low;
}

/* The numbers that have changed, or are beyond the limit. */
static uint32_t find_spots(const ex_worker_t *worker, uint32_t transition, const void *next, spot_t *spot)
{
    const table_t *const table = &worker->run->counts->table;
    const pn_transition_t *const t = &pn_net.transition[transition];
    uint32_t found = 0U;
    for (uint32_t k = 0U; k < t->touched_count; k++) {
        const uint32_t own = table->limit_of[t->touched[k]];
        const limit_t *const limit = (own > 0U) ? &table->limit[own - 1U] : NULL;
        for (uint32_t c = 0U; (limit != NULL) && (c < numbers_of(limit, next)); c++) {
            const bool was_there = !limit->is_value || has_token(place_of(limit), worker->marking);
            const int64_t after = get(limit, c, next);
            const int64_t before = was_there ? get(limit, c, worker->marking) : (after - 1);
            if ((before != after) || (after > limit->most)) {
                spot[found] = (spot_t){ .limit = limit, .colour = c };
                allow(&spot[found], was_there ? before : (limit->most - 1), after);
                found += 1U;
            }
        }
    }
    return found;
}

/* The next of all combinations; false: that was the last. */
static bool turn(spot_t *spot, uint32_t count)
{
    uint32_t i = 0U;
    while ((i < count) && (spot[i].now == spot[i].high)) {
        spot[i].now = spot[i].low;
        i += 1U;
    }
    if (i < count) {
        spot[i].now += 1;
    }
    return i < count;
}

bool ex_counts_each(const ex_worker_t *worker, uint32_t transition, void *next, ex_counts_sink_t sink, void *user)
{
    const table_t *const table = &worker->run->counts->table;
    const concern_t *const concern = &table->concern[transition];
    spot_t *const spot = worker->run->counts->spot[worker->index];
    held_t *const held = worker->run->counts->held[worker->index];
    const uint32_t count = find_spots(worker, transition, next, spot);
    bool goes_on = true;
    bool is_more = true;
    for (uint32_t i = 0U; (count > 0U) && (i < concern->places); i++) {
        look_at(table, concern->place[i], next, &held[concern->place[i]]);
    }
    while (goes_on && is_more) {
        for (uint32_t i = 0U; i < count; i++) {
            set(spot[i].limit, spot[i].colour, next, spot[i].now);
        }
        for (uint32_t i = 0U; i < count; i++) {
            look_at(table, spot[i].limit->place, next, &held[spot[i].limit->place]);
        }
        if ((count == 0U) || is_possible(table, concern, held)) {
            goes_on = sink(user, next);
        }
        is_more = turn(spot, count);
    }
    for (uint32_t i = 0U; i < count; i++) {
        set(spot[i].limit, spot[i].colour, next, spot[i].was);
    }
    return goes_on;
}
