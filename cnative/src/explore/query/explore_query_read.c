/* SPDX-License-Identifier: MIT
 * explore_query_read.c - reads a file of questions.
 *
 *     pred 0                          items, numbered from 0; operands stand before
 *     not 0
 *     ef 1
 *     within 3 1 -                    place 3 has one token at least
 *     ? initially 2                   questions, answered in their order
 *     ? bound 3 0 4                   place 3 has 0 .. 4 tokens; `-`: any number
 *     ? within-firings s0 f2 10       after each node of item 0, transition 2 occurs in one of the next 10 firings
 *     ? lasso                         whether there is a run that this automaton accepts:
 *     automaton 2 0                   states, the initial one
 *     accepting 1
 *     arc 0 1 +0 -f3                  at a node of item 0, if transition 3 is not the next
 *     strong 2                        fairness that is assumed; weak
 *     end
 *     owner 0 2 5 7                   transitions of the supervisor; other numbers are robots and devices
 *                                     (explore_control.c)
 *     priorities own                  priorities count among the transitions of one owner only
 *     first 1 5 7                     of these (group 1) only the first binding element in the documented order occurs
 *     choose 2 8 9                    of these (group 2) only the first enabled transition occurs, with all its
 *                                     bindings
 *     kin 8 9                         count as one transition in their group
 *     meek 8                          though enabled it holds no other one back
 *     probe 9                         never occurs; while it is enabled it holds others of its owner back
 *     silent 10 11                    steps that are no occurrences of the net
 *     instant 0 8 9                   steps of set 0, such as those of scripts that neither wait nor take time
 *     clock 11                        occurs a unit of time later, where something is waited for
 *     ? ends 4                        item 4 is `ef` of the ends, which are reached whoever is slow
 *                                     (explore_running.c); `-`: as below
 *     ? finite-response
 *     ? restless 0 100                no run of steps of set 0 goes on for ever, nor has more transitions of robots
 *                                     than that
 *     ? bounded-response 100
 *     ? confluence 0                  0: with a run of the documented order, 1: with one that comes to another end
 *     ? non-blocking 3                nodes of item 3 are final; `-`: none is
 *     avoid 3                         states of item 3 are not expanded: what is not known of them is not known at all
 *     seek 4                          the exploration ends, as at a limit, where a dead state of item 4 is found
 *     orders                          what is asked from here on is about all orders in which `first` transitions can
 *                                     occur: it is answered only if in no state there is more than one to choose from
 */
#define _POSIX_C_SOURCE 200809L /* strtok_r */

#include "explore_query_read.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

bool ex_complain(const ex_reader_t *r, const char *what, const char *word)
{
    (void)fprintf(stderr, "explore: %s:%" PRIu64 ": %s: `%s`\n", r->path, r->line, what, word);
    return false;
}

/* --- words -------------------------------------------------------------------------------------------------------- */

/* The next line that says something, in words; false at the end. */
bool ex_next_line(ex_reader_t *r)
{
    r->words = 0U;
    while ((*r->rest != '\0') && (r->words == 0U)) {
        char *at = r->rest;
        char *const end = strchr(at, '\n');
        r->rest = (end != NULL) ? (end + 1) : (at + strlen(at));
        if (end != NULL) {
            *end = '\0';
        }
        r->line += 1U;
        if (*at == '#') {
            continue;
        }
        char *kept = NULL;
        for (char *word = strtok_r(at, " \t\r", &kept); word != NULL; word = strtok_r(NULL, " \t\r", &kept)) {
            if (r->words == EX_MOST_WORDS) {
                r->is_wrong = true;
                return ex_complain(r, "too many words", word);
            }
            r->word[r->words] = word;
            r->words += 1U;
        }
    }
    return r->words > 0U;
}

/* A number below `end`. */
bool ex_read_number(const ex_reader_t *r, const char *word, uint64_t end, const char *what, uint32_t *number)
{
    char *rest = NULL;
    errno = 0;
    const unsigned long long value = strtoull(word, &rest, 10);
    *number = (uint32_t)value;
    if ((word[0] < '0') || (word[0] > '9') || (*rest != '\0') || (errno != 0) || (value >= end)) {
        return ex_complain(r, what, word);
    }
    return true;
}

bool ex_read_item(const ex_reader_t *r, const char *word, uint32_t *number)
{
    return ex_read_number(r, word, r->queries->items, "there is no such item", number);
}

bool ex_read_transition(const ex_reader_t *r, const char *word, uint32_t *number)
{
    return ex_read_number(r, word, pn_net.transition_count, "there is no such transition", number);
}

/* `-` or a number of tokens. */
static bool read_limit(const ex_reader_t *r, const char *word, uint64_t none, uint64_t *limit)
{
    char *rest = NULL;
    errno = 0;
    if (strcmp(word, "-") == 0) {
        *limit = none;
        return true;
    }
    *limit = strtoull(word, &rest, 10);
    return ((word[0] >= '0') && (word[0] <= '9') && (*rest == '\0') && (errno == 0))
           || ex_complain(r, "not a number", word);
}

/* The numbers of transitions, `3,4`. */
static bool read_transitions(const ex_reader_t *r, const char *word, ex_event_t *event)
{
    const char *at = word;
    event->of = calloc(((size_t)pn_net.transition_count / 64U) + 1U, sizeof *event->of);
    if (event->of == NULL) {
        return ex_complain(r, "not enough memory", word);
    }
    while (at != NULL) {
        char *rest = NULL;
        const unsigned long long number = strtoull(at, &rest, 10);
        if ((at[0] < '0') || (at[0] > '9') || (number >= pn_net.transition_count)
            || ((*rest != ',') && (*rest != '\0'))) {
            return ex_complain(r, "there is no such transition", at);
        }
        EX_SET_BIT(event->of, number);
        at = (*rest == ',') ? (rest + 1) : NULL;
    }
    return true;
}

/* `s3`: nodes of item 3; `f3,4`: arcs of transitions 3 and 4. */
static bool read_event(const ex_reader_t *r, const char *word, ex_event_t *event)
{
    event->is_transition = word[0] == 'f';
    if (event->is_transition) {
        return read_transitions(r, &word[1], event);
    }
    return (word[0] == 's') ? ex_read_item(r, &word[1], &event->number) : ex_complain(r, "not an event", word);
}

/* Room for one more in a table; NULL: no memory. */
void *ex_with_room(void *table, uint64_t used, uint64_t *room, size_t size)
{
    if (used < *room) {
        return table;
    }
    const uint64_t more = (*room == 0U) ? 16U : (*room * 2U);
    unsigned char *const larger = realloc(table, more * size);
    if (larger != NULL) {
        (void)memset(&larger[*room * size], 0, (more - *room) * size);
        *room = more;
    }
    return larger;
}

/* --- items -------------------------------------------------------------------------------------------------------- */

typedef struct form {
    const char *word;
    ex_item_kind_t kind;
    uint32_t operands;
} form_t;

static const form_t s_forms[] = {
    { "true", EX_ITEM_TRUE, 0U }, { "dead", EX_ITEM_DEAD, 0U },       { "initial", EX_ITEM_INITIAL, 0U },
    { "pred", EX_ITEM_PRED, 0U }, { "enabled", EX_ITEM_ENABLED, 0U }, { "not", EX_ITEM_NOT, 1U },
    { "and", EX_ITEM_AND, 2U },   { "or", EX_ITEM_OR, 2U },           { "ex", EX_ITEM_EX, 1U },
    { "ax", EX_ITEM_AX, 1U },     { "ef", EX_ITEM_EF, 1U },           { "af", EX_ITEM_AF, 1U },
    { "eg", EX_ITEM_EG, 1U },     { "ag", EX_ITEM_AG, 1U },           { "eu", EX_ITEM_EU, 2U },
    { "au", EX_ITEM_AU, 2U },     { "exa", EX_ITEM_EXA, 1U },
};

bool ex_add_item(ex_reader_t *r, const ex_item_t *item)
{
    ex_queries_t *const queries = r->queries;
    ex_item_t *const items = ex_with_room(queries->item, queries->items, &r->item_room, sizeof *items);
    if (items == NULL) {
        return ex_complain(r, "not enough memory", r->path);
    }
    queries->item = items;
    items[queries->items] = *item;
    items[queries->items].raised_at = EX_NO_NODE;
    queries->items += 1U;
    return true;
}

/* What is known of an item by its form. */
static void classify(const ex_queries_t *queries, ex_item_t *item, bool has_operands)
{
    const ex_item_t *const a = has_operands ? &queries->item[item->a] : NULL;
    const ex_item_t *const b = has_operands ? &queries->item[item->b] : NULL;
    const bool is_and = item->kind == EX_ITEM_AND;
    const bool is_or = item->kind == EX_ITEM_OR;
    const bool is_not = item->kind == EX_ITEM_NOT;
    const bool is_formed = is_and || is_or || is_not;
    item->is_local = (item->kind < EX_ITEM_EX) && (!has_operands || (a->is_local && b->is_local));
    item->is_nameless = (item->kind <= EX_ITEM_DEAD) || (is_formed && a->is_nameless && b->is_nameless);
    item->is_about_dead = (item->kind == EX_ITEM_TRUE) || (is_not && (a->kind == EX_ITEM_DEAD))
                          || (is_and && a->is_about_dead && b->is_about_dead)
                          || (is_or && (a->is_about_dead || b->is_about_dead));
}

/* The nodes in which a place has so many tokens. */
static bool read_within(ex_reader_t *r)
{
    ex_item_t item = { .kind = EX_ITEM_WITHIN, .is_local = true };
    if (r->words != 4U) {
        return ex_complain(r, "wrong number of operands", r->word[0]);
    }
    return ex_read_number(r, r->word[1], pn_net.place_count, "there is no such place", &item.number)
           && read_limit(r, r->word[2], 0U, &item.low) && read_limit(r, r->word[3], UINT64_MAX, &item.high)
           && ex_add_item(r, &item);
}

static bool read_state_item(ex_reader_t *r)
{
    const form_t *form = NULL;
    for (uint32_t i = 0U; i < (sizeof s_forms / sizeof s_forms[0]); i++) {
        form = (strcmp(r->word[0], s_forms[i].word) == 0) ? &s_forms[i] : form;
    }
    if (strcmp(r->word[0], "within") == 0) {
        return read_within(r);
    }
    if (form == NULL) {
        return ex_complain(r, "no such item", r->word[0]);
    }
    const bool has_number =
        (form->kind == EX_ITEM_PRED) || (form->kind == EX_ITEM_ENABLED) || (form->kind == EX_ITEM_EXA);
    const uint32_t wanted = 1U + form->operands + (has_number ? 1U : 0U);
    if (r->words != wanted) {
        return ex_complain(r, "wrong number of operands", r->word[0]);
    }
    ex_item_t item = { .kind = form->kind };
    bool is_fine = true;
    if (form->kind == EX_ITEM_PRED) {
        is_fine = ex_read_number(r, r->word[1], pn_net.predicate_count, "the net has no such predicate", &item.number);
    } else if (has_number) {
        is_fine = ex_read_transition(r, r->word[1], &item.number);
    }
    is_fine = is_fine && ((form->operands == 0U) || ex_read_item(r, r->word[wanted - form->operands], &item.a))
              && ((form->operands < 2U) || ex_read_item(r, r->word[wanted - 1U], &item.b));
    if (!is_fine) {
        return false;
    }
    item.b = (form->operands < 2U) ? item.a : item.b;
    classify(r->queries, &item, form->operands > 0U);
    return ex_add_item(r, &item);
}

/* --- questions ---------------------------------------------------------------------------------------------------- */

static bool read_bound(const ex_reader_t *r, ex_question_t *question)
{
    /* `a` is the place until all lines are read: its item comes at the end of the file. */
    return ex_read_number(r, r->word[2], pn_net.place_count, "there is no such place", &question->a)
           && read_limit(r, r->word[3], 0U, &question->low) && read_limit(r, r->word[4], UINT64_MAX, &question->high);
}

static bool read_response(const ex_reader_t *r, ex_question_t *question)
{
    char *rest = NULL;
    if (!read_event(r, r->word[2], &question->first) || !read_event(r, r->word[3], &question->second)) {
        return false;
    }
    question->has_most = strcmp(r->word[4], "-") != 0;
    question->most = question->has_most ? strtod(r->word[4], &rest) : 0.0;
    if (question->has_most && ((rest == r->word[4]) || (*rest != '\0') || !isfinite(question->most))) {
        return ex_complain(r, "not a number", r->word[4]);
    }
    return (question->kind == EX_ASK_FIRINGS) || pn_net.timed || ex_complain(r, "the net has no time", r->word[1]);
}

/* Of a supervisor. */
static bool read_control(const ex_reader_t *r, ex_question_t *question)
{
    uint32_t most = 0U;
    bool is_fine = (r->queries->owner != NULL) || ex_complain(r, "the owners of transitions are not told", r->word[1]);
    if ((question->kind == EX_ASK_BOUNDED) || (question->kind == EX_ASK_RESTLESS)) {
        const bool of_set = question->kind == EX_ASK_RESTLESS;
        is_fine = is_fine && ex_read_number(r, r->word[of_set ? 3 : 2], (uint64_t)UINT32_MAX, "not a number", &most);
        is_fine =
            is_fine && (!of_set || ex_read_number(r, r->word[2], EX_MOST_SETS, "there are not so many", &question->a));
        question->has_most = true;
        question->most = (double)most;
    } else if (question->kind == EX_ASK_CONFLUENT) {
        is_fine = is_fine && ex_read_number(r, r->word[2], 2U, "there is no such run", &question->a);
    } else if ((question->kind == EX_ASK_BLOCKING) || (question->kind == EX_ASK_ENDS)) {
        question->has_item = strcmp(r->word[2], "-") != 0;
        is_fine = is_fine && (!question->has_item || ex_read_item(r, r->word[2], &question->a));
        if (is_fine && question->has_item && (question->kind == EX_ASK_ENDS)) {
            is_fine = (r->queries->item[question->a].kind == EX_ITEM_EF) || ex_complain(r, "not an `ef`", r->word[2]);
        }
    } else {
        /* there is nothing more to read */
    }
    return is_fine;
}

typedef struct asking {
    const char *word;
    ex_question_kind_t kind;
    uint32_t words;
} asking_t;

static const asking_t s_askings[] = {
    { "invariant", EX_ASK_INVARIANT, 3U },
    { "initially", EX_ASK_INITIALLY, 3U },
    { "bound", EX_ASK_BOUND, 5U },
    { "finite-response", EX_ASK_FINITE, 2U },
    { "restless", EX_ASK_RESTLESS, 4U },
    { "bounded-response", EX_ASK_BOUNDED, 3U },
    { "confluence", EX_ASK_CONFLUENT, 3U },
    { "non-blocking", EX_ASK_BLOCKING, 3U },
    { "ends", EX_ASK_ENDS, 3U },
    { "lasso", EX_ASK_LASSO, 2U },
    { "within-firings", EX_ASK_FIRINGS, 5U },
    { "within-time", EX_ASK_TIME, 5U },
};

static bool read_question(ex_reader_t *r)
{
    ex_queries_t *const queries = r->queries;
    const asking_t *asking = NULL;
    for (uint32_t i = 0U; (r->words > 1U) && (i < (sizeof s_askings / sizeof s_askings[0])); i++) {
        asking = (strcmp(r->word[1], s_askings[i].word) == 0) ? &s_askings[i] : asking;
    }
    if ((asking == NULL) || (r->words != asking->words)) {
        return ex_complain(r, "no such question, or the wrong number of operands", (r->words > 1U) ? r->word[1] : "?");
    }
    ex_question_t *const questions =
        ex_with_room(queries->question, queries->questions, &r->question_room, sizeof *questions);
    if (questions == NULL) {
        return ex_complain(r, "not enough memory", r->path);
    }
    queries->question = questions;
    ex_question_t *const question = &questions[queries->questions];
    question->kind = asking->kind;
    question->node = EX_NO_NODE;
    question->steps = -1;
    question->is_of_orders = r->is_of_orders;
    queries->questions += 1U;
    switch (asking->kind) {
    case EX_ASK_INVARIANT:
    case EX_ASK_INITIALLY: return ex_read_item(r, r->word[2], &question->a);
    case EX_ASK_BOUND: return read_bound(r, question);
    case EX_ASK_LASSO: return ex_begin_automaton(r);
    case EX_ASK_FINITE:
    case EX_ASK_RESTLESS:
    case EX_ASK_BOUNDED:
    case EX_ASK_CONFLUENT:
    case EX_ASK_BLOCKING:
    case EX_ASK_ENDS: return read_control(r, question);
    case EX_ASK_FIRINGS:
    case EX_ASK_TIME:
    default: return read_response(r, question);
    }
}

/* --- the file ----------------------------------------------------------------------------------------------------- */

/* What only the questions need gets items with numbers that no line mentions. */
static bool add_hidden_items(ex_reader_t *r)
{
    ex_queries_t *const queries = r->queries;
    bool is_fine = true;
    for (uint32_t i = 0U; is_fine && (i < queries->questions); i++) {
        ex_question_t *const question = &queries->question[i];
        if (question->kind == EX_ASK_BOUND) {
            const ex_item_t item = { .kind = EX_ITEM_WITHIN,
                                     .number = question->a,
                                     .low = question->low,
                                     .high = question->high,
                                     .is_local = true };
            question->a = queries->items;
            is_fine = ex_add_item(r, &item);
        } else if (question->automaton != NULL) {
            is_fine = ex_add_fair_items(r, question->automaton);
        }
    }
    return is_fine;
}

/* The whole file as a string to be freed; NULL: it cannot be read. */
static char *read_file(const char *path)
{
    FILE *const file = fopen(path, "rb");
    char *text = NULL;
    size_t used = 0U;
    size_t room = 0U;
    bool is_fine = file != NULL;
    while (is_fine && (feof(file) == 0)) {
        if ((used + 1U) >= room) {
            room = (room == 0U) ? 65536U : (room * 2U);
            char *const larger = realloc(text, room);
            is_fine = larger != NULL;
            text = is_fine ? larger : text;
        }
        used += is_fine ? fread(&text[used], 1U, room - used - 1U, file) : 0U;
        is_fine = is_fine && (ferror(file) == 0);
    }
    if (file != NULL) {
        (void)fclose(file);
    }
    if (!is_fine) {
        free(text);
        return NULL;
    }
    text[used] = '\0';
    return text;
}

/* `owner O T...`: whose transitions they are; all that are not mentioned are the supervisor's, who has the number 0. */
static bool read_owner(ex_reader_t *r)
{
    ex_queries_t *const queries = r->queries;
    uint32_t owner = 0U;
    uint32_t transition = 0U;
    if (queries->owner == NULL) {
        queries->owner = calloc((size_t)pn_net.transition_count + 1U, sizeof *queries->owner);
    }
    if (queries->owner == NULL) {
        return ex_complain(r, "not enough memory", r->path);
    }
    bool is_fine = (r->words > 1U)
                   && ex_read_number(r, r->word[1], (uint64_t)EX_MOST_OWNERS, "there are not so many owners", &owner);
    for (uint32_t i = 2U; is_fine && (i < r->words); i++) {
        is_fine = ex_read_transition(r, r->word[i], &transition);
        if (is_fine) {
            queries->owner[transition] = owner;
        }
    }
    return is_fine;
}

/* What is known of programs; NULL: no memory. */
static ex_programs_t *programs_of(const ex_reader_t *r)
{
    ex_run_t *const run = r->queries->run;
    const size_t count = (size_t)pn_net.transition_count + 1U;
    if (run->programs == NULL) {
        ex_programs_t *const programs = calloc(1U, sizeof *programs);
        if (programs == NULL) {
            return NULL;
        }
        programs->group = calloc(count, sizeof *programs->group);
        programs->kin = calloc(count, sizeof *programs->kin);
        for (uint32_t t = 0U; (programs->kin != NULL) && (t < pn_net.transition_count); t++) {
            programs->kin[t] = t;
        }
        programs->is_meek = calloc(count, sizeof *programs->is_meek);
        programs->is_probe = calloc(count, sizeof *programs->is_probe);
        programs->is_silent = calloc(count, sizeof *programs->is_silent);
        programs->instant = calloc(count, sizeof *programs->instant);
        programs->is_clock = calloc(count, sizeof *programs->is_clock);
        run->programs = programs;
    }
    const ex_programs_t *const made = run->programs;
    const bool is_made = (made->group != NULL) && (made->kin != NULL) && (made->is_meek != NULL)
                         && (made->is_probe != NULL) && (made->is_silent != NULL) && (made->instant != NULL)
                         && (made->is_clock != NULL);
    return is_made ? run->programs : NULL;
}

/* `first G T...`, `choose G T...`: of the transitions of a group only some are done. */
static bool read_group(ex_reader_t *r, ex_choice_t choice)
{
    ex_programs_t *const programs = programs_of(r);
    uint32_t group = 0U;
    uint32_t transition = 0U;
    if (programs == NULL) {
        return ex_complain(r, "not enough memory", r->path);
    }
    bool is_fine = (r->words > 1U)
                   && ex_read_number(r, r->word[1], (uint64_t)EX_MOST_GROUPS, "there are not so many groups", &group);
    is_fine = is_fine && ((group > 0U) || ex_complain(r, "groups are counted from 1", r->word[1]));
    for (uint32_t i = 2U; is_fine && (i < r->words); i++) {
        is_fine = ex_read_transition(r, r->word[i], &transition);
        if (is_fine) {
            programs->group[transition] = group;
            programs->choice[group] = choice;
        }
    }
    return is_fine;
}

/* `instant S T...`: steps of a set. */
static bool read_instant(ex_reader_t *r)
{
    ex_programs_t *const programs = programs_of(r);
    uint32_t set = 0U;
    uint32_t transition = 0U;
    if (programs == NULL) {
        return ex_complain(r, "not enough memory", r->path);
    }
    bool is_fine = (r->words > 1U) && ex_read_number(r, r->word[1], EX_MOST_SETS, "there are not so many sets", &set);
    for (uint32_t i = 2U; is_fine && (i < r->words); i++) {
        is_fine = ex_read_transition(r, r->word[i], &transition);
        if (is_fine) {
            programs->instant[transition] |= (uint8_t)(1U << set);
        }
    }
    return is_fine;
}

/* `meek T...` and the like. */
static bool read_kind(ex_reader_t *r)
{
    ex_programs_t *const programs = programs_of(r);
    uint32_t transition = 0U;
    uint32_t first = 0U;
    bool is_fine = (programs != NULL) || ex_complain(r, "not enough memory", r->path);
    for (uint32_t i = 1U; is_fine && (i < r->words); i++) {
        is_fine = ex_read_transition(r, r->word[i], &transition);
        if (!is_fine) {
            break;
        }
        first = (i == 1U) ? transition : first;
        if (strcmp(r->word[0], "kin") == 0) {
            programs->kin[transition] = first;
        } else if (strcmp(r->word[0], "meek") == 0) {
            programs->is_meek[transition] = true;
        } else if (strcmp(r->word[0], "probe") == 0) {
            programs->is_probe[transition] = true;
        } else if (strcmp(r->word[0], "silent") == 0) {
            programs->is_silent[transition] = true;
        } else {
            programs->is_clock[transition] = true;
            programs->has_clock = true;
            is_fine = r->queries->run->options.is_time_reduced || ex_complain(r, "the time is not reduced", r->word[0]);
        }
    }
    return is_fine;
}

static bool is_kind(const char *word)
{
    return (strcmp(word, "probe") == 0) || (strcmp(word, "kin") == 0) || (strcmp(word, "meek") == 0)
           || (strcmp(word, "silent") == 0) || (strcmp(word, "clock") == 0);
}

/* `avoid 3`, `seek 3`: a search for what shows something, of items about one state. */
static bool read_search(ex_reader_t *r)
{
    ex_queries_t *const queries = r->queries;
    const bool is_avoid = strcmp(r->word[0], "avoid") == 0;
    uint32_t item = 0U;
    if (r->words != 2U) {
        return ex_complain(r, "wrong number of operands", r->word[0]);
    }
    if (!ex_read_item(r, r->word[1], &item)) {
        return false;
    }
    if (!queries->item[item].is_local) {
        return ex_complain(r, "it is not about one state", r->word[1]);
    }
    if (!queries->run->options.is_depth_first) {
        return ex_complain(r, "the search is not depth first", r->word[0]);
    }
    queries->has_avoid = queries->has_avoid || is_avoid;
    queries->has_seek = queries->has_seek || !is_avoid;
    if (is_avoid) {
        queries->avoid = item;
    } else {
        queries->seek = item;
    }
    return true;
}

static bool is_search(const char *word)
{
    return (strcmp(word, "avoid") == 0) || (strcmp(word, "seek") == 0);
}

static bool read_lines(ex_reader_t *r)
{
    bool is_fine = true;
    while (is_fine && ex_next_line(r)) {
        if (r->automaton != NULL) {
            is_fine = ex_read_automaton_line(r);
        } else if (strcmp(r->word[0], "?") == 0) {
            is_fine = read_question(r);
        } else if (strcmp(r->word[0], "owner") == 0) {
            is_fine = read_owner(r);
        } else if ((strcmp(r->word[0], "orders") == 0) && (r->words == 1U)) {
            r->is_of_orders = true;
            r->queries->asks_orders = true;
        } else if (strcmp(r->word[0], "first") == 0) {
            is_fine = read_group(r, EX_FIRST_BINDING);
        } else if (strcmp(r->word[0], "choose") == 0) {
            is_fine = read_group(r, EX_FIRST_TRANSITION);
        } else if (strcmp(r->word[0], "instant") == 0) {
            is_fine = read_instant(r);
        } else if (is_kind(r->word[0])) {
            is_fine = read_kind(r);
        } else if (is_search(r->word[0])) {
            is_fine = read_search(r);
        } else if ((strcmp(r->word[0], "priorities") == 0) && (r->words == 2U) && (strcmp(r->word[1], "own") == 0)) {
            is_fine =
                (r->queries->owner != NULL) || ex_complain(r, "the owners of transitions are not told", r->word[0]);
            r->queries->run->owner_of = r->queries->owner;
        } else {
            is_fine = read_state_item(r);
        }
    }
    is_fine = is_fine && !r->is_wrong;
    return is_fine && ((r->automaton == NULL) || ex_complain(r, "the automaton has no end", "lasso"));
}

bool ex_queries_read(ex_run_t *run)
{
    ex_queries_t *const queries = calloc(1U, sizeof *queries);
    char *const text = read_file(run->options.queries);
    ex_reader_t *const r = calloc(1U, sizeof *r);
    if ((queries == NULL) || (text == NULL) || (r == NULL)) {
        (void)fprintf(stderr, "explore: cannot read `%s`\n", run->options.queries);
        free(text);
        free(r);
        return false;
    }
    queries->run = run;
    (void)pthread_mutex_init(&queries->lock, NULL);
    r->queries = queries;
    r->path = run->options.queries;
    r->rest = text;
    const bool is_fine = read_lines(r) && add_hidden_items(r);
    free(text);
    free(r);
    run->queries = is_fine ? queries : NULL;
    return is_fine;
}
