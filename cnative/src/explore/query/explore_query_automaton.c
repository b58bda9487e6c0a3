/* SPDX-License-Identifier: MIT
 * explore_query_automaton.c - reads the automaton of a question.
 */
#include "explore_query_read.h"

#include <stdlib.h>

#define MOST_STATES ((uint64_t)1U << 30U)

/* `+fT`: transition T is the next; `-fT`: it is not. */
static bool read_firing(const ex_reader_t *r, const char *word, ex_edge_t *edge)
{
    uint32_t transition = 0U;
    const uint64_t words = ((uint64_t)pn_net.transition_count / 64U) + 1U; /* one bit more than there are transitions */
    if (!ex_read_transition(r, &word[2], &transition)) {
        return false;
    }
    if (edge->allowed == NULL) {
        edge->allowed = malloc(words * sizeof *edge->allowed);
        if (edge->allowed == NULL) {
            return ex_complain(r, "not enough memory", word);
        }
        (void)memset(edge->allowed, 0xff, words * sizeof *edge->allowed);
    }
    const uint64_t bit = (uint64_t)1U << (transition % 64U);
    const uint64_t kept = edge->allowed[transition / 64U];
    if (word[0] == '+') {
        (void)memset(edge->allowed, 0, words * sizeof *edge->allowed);
        edge->allowed[transition / 64U] = kept & bit;
    } else {
        edge->allowed[transition / 64U] = kept & ~bit;
    }
    return true;
}

static bool read_literal(const ex_reader_t *r, const char *word, ex_edge_t *edge)
{
    if ((word[0] != '+') && (word[0] != '-')) {
        return ex_complain(r, "not a condition", word);
    }
    if (word[1] == 'f') {
        return read_firing(r, word, edge);
    }
    ex_literal_t *const literal = &edge->literal[edge->literals];
    literal->is_positive = word[0] == '+';
    edge->literals += 1U;
    return ex_read_item(r, &word[1], &literal->item);
}

static bool read_edge(ex_reader_t *r)
{
    ex_automaton_t *const automaton = r->automaton;
    ex_edge_t *const edges = ex_with_room(automaton->edge, automaton->edges, &r->edge_room, sizeof *edges);
    if ((edges == NULL) || (r->words < 3U)) {
        return ex_complain(r, "wrong number of operands", r->word[0]);
    }
    automaton->edge = edges;
    ex_edge_t *const edge = &edges[automaton->edges];
    edge->literal = calloc(r->words, sizeof *edge->literal);
    bool is_fine = (edge->literal != NULL)
                   && ex_read_number(r, r->word[1], automaton->states, "there is no such state", &edge->from)
                   && ex_read_number(r, r->word[2], automaton->states, "there is no such state", &edge->to);
    for (uint32_t i = 3U; is_fine && (i < r->words); i++) {
        is_fine = read_literal(r, r->word[i], edge);
    }
    automaton->edges += 1U;
    return is_fine;
}

/* A transition for which fairness is assumed, and an item for the nodes where it is enabled. */
static bool add_fair(ex_reader_t *r, const char *word, bool is_strong)
{
    ex_automaton_t *const automaton = r->automaton;
    uint32_t transition = 0U;
    const size_t count = (size_t)automaton->fair_count + 1U;
    if (!ex_read_transition(r, word, &transition)) {
        return false;
    }
    automaton->fair = realloc(automaton->fair, count * sizeof *automaton->fair);
    automaton->is_strong = realloc(automaton->is_strong, count * sizeof *automaton->is_strong);
    automaton->fair_item = realloc(automaton->fair_item, count * sizeof *automaton->fair_item);
    if ((automaton->fair == NULL) || (automaton->is_strong == NULL) || (automaton->fair_item == NULL)) {
        return ex_complain(r, "not enough memory", word);
    }
    automaton->fair[count - 1U] = transition;
    automaton->is_strong[count - 1U] = is_strong;
    automaton->fair_count += 1U;
    return true;
}

/* Fairness needs items, which must not get numbers that later lines count on: they are added at the end of the file. */
bool ex_add_fair_items(ex_reader_t *r, const ex_automaton_t *automaton)
{
    bool is_fine = true;
    for (uint32_t i = 0U; is_fine && (i < automaton->fair_count); i++) {
        const ex_item_t item = { .kind = EX_ITEM_ENABLED, .number = automaton->fair[i], .is_local = true };
        automaton->fair_item[i] = r->queries->items;
        is_fine = ex_add_item(r, &item);
    }
    return is_fine;
}

static int by_state(const void *a, const void *b)
{
    const ex_edge_t *const first = a;
    const ex_edge_t *const second = b;
    return (first->from < second->from) ? -1 : ((first->from > second->from) ? 1 : 0);
}

static bool finish_automaton(ex_reader_t *r)
{
    ex_automaton_t *const automaton = r->automaton;
    if (automaton->edges > 0U) {
        qsort(automaton->edge, automaton->edges, sizeof *automaton->edge, by_state);
    }
    automaton->first = calloc((size_t)automaton->states + 1U, sizeof *automaton->first);
    if (automaton->first == NULL) {
        return ex_complain(r, "not enough memory", r->path);
    }
    for (uint32_t i = 0U; i < automaton->edges; i++) {
        automaton->first[automaton->edge[i].from + 1U] += 1U;
    }
    for (uint32_t s = 0U; s < automaton->states; s++) {
        automaton->first[s + 1U] += automaton->first[s];
    }
    r->automaton = NULL;
    return true;
}

bool ex_begin_automaton(ex_reader_t *r)
{
    if (!ex_next_line(r) || (strcmp(r->word[0], "automaton") != 0) || (r->words != 3U)) {
        return ex_complain(r, "an automaton is missing", "lasso");
    }
    ex_automaton_t *const automaton = calloc(1U, sizeof *automaton);
    if (automaton == NULL) {
        return ex_complain(r, "not enough memory", r->path);
    }
    r->automaton = automaton;
    r->edge_room = 0U;
    r->queries->question[r->queries->questions - 1U].automaton = automaton;
    if (!ex_read_number(r, r->word[1], MOST_STATES, "not a number", &automaton->states)
        || !ex_read_number(r, r->word[2], automaton->states, "there is no such state", &automaton->initial)) {
        return false;
    }
    automaton->is_accepting = calloc(automaton->states, sizeof *automaton->is_accepting);
    return (automaton->is_accepting != NULL) || ex_complain(r, "not enough memory", r->path);
}

bool ex_read_automaton_line(ex_reader_t *r)
{
    bool is_fine = true;
    if (strcmp(r->word[0], "arc") == 0) {
        return read_edge(r);
    }
    if (strcmp(r->word[0], "end") == 0) {
        return finish_automaton(r);
    }
    const bool is_strong = strcmp(r->word[0], "strong") == 0;
    const bool is_fairness = is_strong || (strcmp(r->word[0], "weak") == 0);
    if (!is_fairness && (strcmp(r->word[0], "accepting") != 0)) {
        return ex_complain(r, "no part of an automaton", r->word[0]);
    }
    for (uint32_t i = 1U; is_fine && (i < r->words); i++) {
        uint32_t state = 0U;
        if (is_fairness) {
            is_fine = add_fair(r, r->word[i], is_strong);
        } else {
            is_fine = ex_read_number(r, r->word[i], r->automaton->states, "there is no such state", &state);
            r->automaton->is_accepting[state] = is_fine || r->automaton->is_accepting[state];
        }
    }
    return is_fine;
}
