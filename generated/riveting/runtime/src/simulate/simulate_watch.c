/* SPDX-License-Identifier: MIT
 * simulate_watch.c - the monitors of a net that need no function here: sizes of markings, lengths of lists, counts,
 * values that transitions leave in a place of their own, breakpoints.
 *
 * Each is given by `--watch "KIND INDEX WHEN"`:
 *
 *     s, l   the number of tokens of a place, the length of its only list; INDEX of the place
 *     i, r   the integer or real that is in a place, if any; the place is emptied (pn2code.monitors.compiling)
 *     c      1; INDEX is not looked at
 *     e, f   stops when the place is empty, or is not
 *     n, d   stops when transition INDEX is enabled now, or is not; looks also when model time goes on
 *
 * WHEN: `*`: after every step, else the indices of the transitions after whose occurrences it looks, with commas. Small
 * letters count every value the same; capital S, L, I, R weight it with the time for which it held. s and l look at the
 * start as well, and S and L once more at the end. Sums of integers are exact, or the run ends with "limit": "watch".
 */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "pn/pn_num.h"
#include "pn/pn_text.h"
#include "simulate_impl.h"
#include "simulate_statistics.h"

enum { MOST_WATCHES = 256 };

typedef struct watch {
    char kind; /* a small letter */
    uint32_t index;
    uint8_t *on; /* by transition; NULL: after every step */
    sim_statistics_t statistics;
} watch_t;

static watch_t s_watch[MOST_WATCHES];
static uint32_t s_count;

/* --- options ------------------------------------------------------------------------------------------------------ */

static bool read_when(const char *text, watch_t *watch)
{
    if (strcmp(text, "*") == 0) {
        return true;
    }
    watch->on = calloc((size_t)pn_net.transition_count + 1U, 1U);
    if (watch->on == NULL) {
        return false;
    }
    const char *at = text;
    while (*at != '\0') {
        char *end = NULL;
        const unsigned long transition = strtoul(at, &end, 10);
        if ((end == at) || (transition >= pn_net.transition_count)) {
            return false;
        }
        watch->on[transition] = 1U;
        at = (*end == ',') ? (end + 1) : end;
        if ((*end != ',') && (*end != '\0')) {
            return false;
        }
    }
    return true;
}

bool sim_watch_add(const char *text)
{
    char *end = NULL;
    if ((s_count >= MOST_WATCHES) || (text[0] == '\0') || (strchr("slircefndSLIR", text[0]) == NULL)
        || (text[1] != ' ')) {
        return false;
    }
    watch_t *watch = &s_watch[s_count];
    watch->statistics.is_timed = isupper((unsigned char)text[0]) != 0;
    watch->kind = (char)tolower((unsigned char)text[0]);
    watch->statistics.is_real = watch->kind == 'r';
    watch->index = (uint32_t)strtoul(&text[2], &end, 10);
    const bool is_transition = (watch->kind == 'n') || (watch->kind == 'd') || (watch->kind == 'c');
    if ((*end != ' ') || (watch->index >= (is_transition ? pn_net.transition_count : pn_net.place_count))) {
        return false;
    }
    s_count++;
    return read_when(end + 1, watch);
}

bool sim_watch_is_needed(void)
{
    return s_count > 0U;
}

/* --- values ------------------------------------------------------------------------------------------------------- */

/* The length of the only list in a place, from its JSON [[1, [...]]] or [[1, [...], stamp]]; -1 when it is not the only
 * token. */
static int64_t list_length(const sim_t *sim, uint32_t place)
{
    if (pn_multiset_total(pn_net.place[place].multiset, sim->marking) != 1U) {
        return -1;
    }
    pn_text_t text;
    pn_text_init(&text, sim_text_buffer, SIM_TEXT_SIZE);
    pn_multiset_json(pn_net.place[place].multiset, sim->marking, &text);
    int64_t length = 0;
    uint32_t depth = 0U;
    bool is_string = false;
    for (const char *at = text.buffer; *at != '\0'; at++) {
        if (is_string) {
            if ((*at == '\\') && (at[1] != '\0')) {
                at++;
            } else {
                is_string = *at != '"';
            }
        } else if (*at == '"') {
            is_string = true;
        } else if ((*at == '[') || (*at == '{')) {
            depth++;
            length += ((depth == 3U) && (at[1] != ']')) ? 1 : 0;
        } else if ((*at == ']') || (*at == '}')) {
            if (depth == 3U) {
                break;
            }
            depth--;
        } else if ((*at == ',') && (depth == 3U)) {
            length++;
        }
    }
    return length;
}

/* The number in a place that holds one token, from its JSON [[1, 2.5]]; a real that is not finite is a text. */
static sim_number_t number_in(const sim_t *sim, uint32_t place, bool is_real)
{
    static const char START[] = "[[1, ";
    pn_text_t text;
    pn_text_init(&text, sim_text_buffer, SIM_TEXT_SIZE);
    pn_multiset_json(pn_net.place[place].multiset, sim->marking, &text);
    const char *const at = &text.buffer[sizeof START - 1U];
    sim_number_t found = { 0 };
    if (is_real) {
        found.real = strtod((*at == '"') ? &at[1] : at, NULL);
    } else {
        found.integer = (int64_t)strtoll(at, NULL, 10);
    }
    return found;
}

/* Ends the run: a monitor cannot go on. */
static bool fail(sim_t *sim, const watch_t *watch, const char *limit)
{
    sim->watch = (int64_t)(watch - s_watch);
    sim->watch_limit = limit;
    sim->why = "error";
    return false;
}

/* Looks at what a collector collects. */
static bool collect(sim_t *sim, watch_t *watch)
{
    sim_number_t value = { .integer = 1 };
    switch (watch->kind) {
    case 's': value.integer = (int64_t)pn_multiset_total(pn_net.place[watch->index].multiset, sim->marking); break;
    case 'l': value.integer = list_length(sim, watch->index); break;
    case 'i':
    case 'r':
        if (pn_multiset_total(pn_net.place[watch->index].multiset, sim->marking) == 0U) {
            return true;
        }
        value = number_in(sim, watch->index, watch->kind == 'r');
        pn_multiset_clear(pn_net.place[watch->index].multiset, sim->marking);
        break;
    case 'c':
    default: break;
    }
    if ((watch->kind == 'l') && (value.integer < 0)) {
        return fail(sim, watch, "");
    }
    return sim_statistics_add(&watch->statistics, value, pn_now(&pn_net, sim->marking)) || fail(sim, watch, "watch");
}

static bool is_collector(const watch_t *watch)
{
    return strchr("slirc", watch->kind) != NULL;
}

/* Whether a breakpoint is reached. */
static bool is_reached(sim_t *sim, const watch_t *watch)
{
    if ((watch->kind == 'e') || (watch->kind == 'f')) {
        return (pn_multiset_total(pn_net.place[watch->index].multiset, sim->marking) == 0U) == (watch->kind == 'e');
    }
    bool is_enabled = false;
    for (uint32_t i = 0U; i < sim->enabled_count; i++) {
        is_enabled = is_enabled || (sim->enabled[i] == watch->index);
    }
    return is_enabled == (watch->kind == 'n');
}

static bool stop_at(sim_t *sim, const watch_t *watch)
{
    if (sim->watch < 0) {
        sim->watch = (int64_t)(watch - s_watch);
        sim->why = "breakpoint";
    }
    return false;
}

/* --- when they look ----------------------------------------------------------------------------------------------- */

bool sim_watch_start(sim_t *sim)
{
    for (uint32_t i = 0U; i < s_count; i++) {
        if (((s_watch[i].kind == 's') || (s_watch[i].kind == 'l')) && !collect(sim, &s_watch[i])) {
            return false;
        }
    }
    return true;
}

static bool look(sim_t *sim, watch_t *watch)
{
    if (is_collector(watch)) {
        return collect(sim, watch);
    }
    return !is_reached(sim, watch) || stop_at(sim, watch);
}

bool sim_watch_step(sim_t *sim, uint32_t transition)
{
    bool is_going_on = true;
    bool needs_enabled = false;
    for (uint32_t i = 0U; i < s_count; i++) {
        needs_enabled = needs_enabled || (s_watch[i].kind == 'n') || (s_watch[i].kind == 'd');
    }
    sim->cx.step = sim->steps;
    if (needs_enabled && !sim_find_enabled(sim)) {
        return false;
    }
    /* First those of the transition, then the others; also after a breakpoint, but not after an error. */
    for (uint32_t i = 0U; (i < s_count) && (strcmp(sim->why, "error") != 0); i++) {
        if ((s_watch[i].on != NULL) && (s_watch[i].on[transition] != 0U)) {
            is_going_on = look(sim, &s_watch[i]) && is_going_on;
        }
    }
    for (uint32_t i = 0U; (i < s_count) && (strcmp(sim->why, "error") != 0); i++) {
        if (s_watch[i].on == NULL) {
            is_going_on = look(sim, &s_watch[i]) && is_going_on;
        }
    }
    return is_going_on;
}

bool sim_watch_time(sim_t *sim)
{
    for (uint32_t i = 0U; i < s_count; i++) {
        if (((s_watch[i].kind == 'n') || (s_watch[i].kind == 'd')) && is_reached(sim, &s_watch[i])) {
            return stop_at(sim, &s_watch[i]);
        }
    }
    return true;
}

void sim_watch_stop(sim_t *sim)
{
    const bool has_failed = strcmp(sim->why, "error") == 0;
    const int64_t failed = sim->watch;
    for (uint32_t i = 0U; i < s_count; i++) {
        const bool is_measured = (s_watch[i].kind == 's') || (s_watch[i].kind == 'l');
        if (is_measured && s_watch[i].statistics.is_timed && !collect(sim, &s_watch[i])) {
            sim->watch = has_failed ? failed : sim->watch; /* the first error counts */
            return;
        }
    }
}

/* --- report ------------------------------------------------------------------------------------------------------- */

void sim_text_watches(pn_text_t *text)
{
    pn_text_str(text, ", \"watched\": [");
    for (uint32_t i = 0U; i < s_count; i++) {
        pn_text_str(text, (i > 0U) ? ", " : "");
        sim_text_statistics(text, &s_watch[i].statistics);
    }
    pn_text_char(text, ']');
}
