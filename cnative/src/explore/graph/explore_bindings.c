/* SPDX-License-Identifier: MIT
 * explore_bindings.c - the bindings with which some transitions occur, as texts in a table.
 *
 * Colours of places say what tokens there ever are, not which of them are together: this does.
 */
#include "explore_bindings.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "../search/explore_reduce.h"
#include "../search/explore_successors.h"
#include "pn/pn_text.h"

#define MOST_NODES    ((uint64_t)100000U)
#define MOST_BINDINGS ((uint32_t)10000U)
#define SLOTS         ((uint32_t)1U << 15U) /* a power of two, more than twice the bindings */
#define TEXT_SIZE     ((size_t)1U << 16U)

/* The same text with another transition is another entry. */
typedef struct entry {
    uint32_t transition;
    char *text; /* JSON; NULL: the slot is free */
} entry_t;

struct ex_bindings {
    entry_t slot[SLOTS];
    uint32_t count;
    bool is_fine; /* false: not all of them are there */
    bool *is_wanted;
    char buffer[TEXT_SIZE];
};

static uint32_t slot_of(uint32_t transition, const char *text)
{
    uint32_t hash = 2166136261U ^ transition; /* FNV-1a */
    for (const char *c = text; *c != '\0'; c++) {
        hash = (hash ^ (uint32_t)(unsigned char)*c) * 16777619U;
    }
    return hash & (SLOTS - 1U);
}

/* False: there is no room for it. */
static bool keep(struct ex_bindings *all, uint32_t transition)
{
    uint32_t at = slot_of(transition, all->buffer);
    while (all->slot[at].text != NULL) {
        if ((all->slot[at].transition == transition) && (strcmp(all->slot[at].text, all->buffer) == 0)) {
            return true;
        }
        at = (at + 1U) & (SLOTS - 1U);
    }
    const size_t size = strlen(all->buffer) + 1U;
    char *const text = (all->count < MOST_BINDINGS) ? malloc(size) : NULL;
    if (text == NULL) {
        return false;
    }
    (void)memcpy(text, all->buffer, size);
    all->slot[at] = (entry_t){ .transition = transition, .text = text };
    all->count += 1U;
    return true;
}

static bool on_arc(void *user, uint32_t transition, const void *binding, const ex_key_t *key)
{
    struct ex_bindings *const all = user;
    (void)key;
    if (all->is_wanted[transition]) {
        pn_text_t text;
        pn_text_init(&text, all->buffer, sizeof all->buffer);
        pn_json(pn_net.transition[transition].binding, binding, &text);
        all->is_fine = !text.truncated && keep(all, transition);
    }
    return all->is_fine;
}

void ex_bindings(ex_run_t *run)
{
    const ex_graph_t *const graph = run->graph;
    if ((run->options.bindings == NULL) || !graph->is_whole || graph->is_reduced || run->has_turns
        || !ex_is_repeatable() || (graph->nodes > MOST_NODES)) {
        return;
    }
    struct ex_bindings *const all = calloc(1U, sizeof *all);
    if (all == NULL) {
        return;
    }
    run->bindings = all;
    all->is_wanted = calloc((size_t)pn_net.transition_count + 1U, sizeof *all->is_wanted);
    all->is_fine = all->is_wanted != NULL;
    for (uint32_t t = 0U; all->is_fine && (t < pn_net.transition_count); t++) {
        all->is_wanted[t] = ex_is_listed(run->options.bindings, t);
    }
    for (uint64_t node = 0U; all->is_fine && (node < graph->nodes); node++) {
        ex_key_t key;
        all->is_fine = !ex_is_stopping(run) && ex_store_fetch(&run->store, graph->slot[node], &key);
        if (all->is_fine) {
            const ex_found_t found = ex_successors(&run->worker[0], &key, on_arc, all);
            all->is_fine = (found == EX_SOME) || (found == EX_DEAD);
        }
    }
}

static void list_json(const struct ex_bindings *all, uint32_t transition, FILE *out)
{
    const char *between = "";
    for (uint32_t i = 0U; i < SLOTS; i++) {
        if ((all->slot[i].text != NULL) && (all->slot[i].transition == transition)) {
            (void)fprintf(out, "%s%s", between, all->slot[i].text);
            between = ", ";
        }
    }
}

void ex_bindings_json(const ex_run_t *run, FILE *out)
{
    const struct ex_bindings *const all = run->bindings;
    if ((all == NULL) || !all->is_fine) {
        (void)fprintf(out, "null");
        return;
    }
    const char *between = "";
    (void)fprintf(out, "{");
    for (uint32_t t = 0U; t < pn_net.transition_count; t++) {
        if (all->is_wanted[t]) {
            (void)fprintf(out, "%s\"%" PRIu32 "\": [", between, t);
            list_json(all, t, out);
            (void)fprintf(out, "]");
            between = ", ";
        }
    }
    (void)fprintf(out, "}");
}
