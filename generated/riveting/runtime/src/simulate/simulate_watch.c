/* SPDX-License-Identifier: MIT
 * simulate_watch.c - the simple monitors of a net: sizes of markings, lengths of lists, counts, breakpoints without
 * functions.
 *
 * Each is given by `--watch "KIND INDEX WHEN"`:
 *
 *     s, l   the number of tokens of a place, the length of its only list; INDEX of the place
 *     c      1; INDEX is not looked at
 *     e, f   stops when the place is empty, or is not
 *     n, d   stops when transition INDEX is enabled now, or is not; looks also when model time goes on
 *
 * WHEN: `*`: after every step, else the indices of the transitions after whose occurrences it looks, with commas. Small
 * letters s and l count every value the same; capital ones weight it with the time for which it held, and look once
 * more at the end. Both look at the start. Sums are exact, or the run ends with "limit": "watch".
 */
#include <stdlib.h>
#include <string.h>

#include "pn/pn_num.h"
#include "pn/pn_text.h"
#include "simulate_impl.h"

enum { MOST_WATCHES = 256 };

typedef struct watch {
    char kind;
    bool is_timed;
    uint32_t index;
    uint8_t *on; /* by transition; NULL: after every step */
    int64_t count;
    int64_t min;
    int64_t max;
    int64_t first;
    int64_t last;
    int64_t sum;
    int64_t squares;
    double real_sum; /* of timed ones, where the clock is real */
    double real_squares;
    pn_time_t start;
    pn_time_t updated;
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
    if ((s_count >= MOST_WATCHES) || (text[0] == '\0') || (strchr("slcefndSL", text[0]) == NULL) || (text[1] != ' ')) {
        return false;
    }
    watch_t *watch = &s_watch[s_count];
    watch->is_timed = (text[0] == 'S') || (text[0] == 'L');
    watch->kind = (text[0] == 'S') ? 's' : ((text[0] == 'L') ? 'l' : text[0]);
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
    if (pn_bag_total(pn_net.place[place].bag, sim->marking) != 1U) {
        return -1;
    }
    pn_text_t text;
    pn_text_init(&text, sim_text_buffer, SIM_TEXT_SIZE);
    pn_bag_json(pn_net.place[place].bag, sim->marking, &text);
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

static bool add(int64_t *sum, int64_t value, int64_t factor)
{
    int64_t product = 0;
    return !__builtin_mul_overflow(value, factor, &product) && !__builtin_add_overflow(*sum, product, sum);
}

/* Counts the last value for the time that has passed since. */
static bool weigh(watch_t *watch, pn_time_t now)
{
    if (pn_net.real_time) {
        const double lasted = now.real - watch->updated.real;
        watch->real_sum += lasted * (double)watch->last;
        watch->real_squares += lasted * (double)watch->last * (double)watch->last;
        return true;
    }
    const int64_t lasted = now.integer - watch->updated.integer;
    int64_t weighted = 0;
    return !__builtin_mul_overflow(lasted, watch->last, &weighted) && add(&watch->sum, weighted, 1)
           && add(&watch->squares, weighted, watch->last);
}

static bool update(watch_t *watch, int64_t value, pn_time_t now)
{
    bool is_fine = true;
    if (watch->count == 0) {
        watch->min = value;
        watch->max = value;
        watch->first = value;
        watch->start = now;
    } else if (watch->is_timed) {
        is_fine = weigh(watch, now);
    }
    if (!watch->is_timed) {
        is_fine = add(&watch->sum, value, 1) && add(&watch->squares, value, value);
    }
    watch->min = (value < watch->min) ? value : watch->min;
    watch->max = (value > watch->max) ? value : watch->max;
    watch->last = value;
    watch->updated = now;
    watch->count++;
    return is_fine;
}

/* Looks at what a collector collects. */
static bool collect(sim_t *sim, watch_t *watch)
{
    int64_t value = 1;
    if (watch->kind == 's') {
        value = (int64_t)pn_bag_total(pn_net.place[watch->index].bag, sim->marking);
    } else if (watch->kind == 'l') {
        value = list_length(sim, watch->index);
    }
    const bool is_list = value >= 0;
    if (is_list && update(watch, value, pn_now(&pn_net, sim->marking))) {
        return true;
    }
    sim->watch = (int64_t)(watch - s_watch);
    sim->watch_limit = is_list ? "watch" : "";
    sim->why = "error";
    return false;
}

static bool is_collector(const watch_t *watch)
{
    return strchr("slc", watch->kind) != NULL;
}

/* Whether a breakpoint is reached. */
static bool is_reached(sim_t *sim, const watch_t *watch)
{
    if ((watch->kind == 'e') || (watch->kind == 'f')) {
        return (pn_bag_total(pn_net.place[watch->index].bag, sim->marking) == 0U) == (watch->kind == 'e');
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
        if (s_watch[i].is_timed && !collect(sim, &s_watch[i])) {
            sim->watch = has_failed ? failed : sim->watch; /* the first error counts */
            return;
        }
    }
}

/* --- report ------------------------------------------------------------------------------------------------------- */

static void text_int(pn_text_t *text, const char *name, int64_t value)
{
    pn_text_str(text, ", \"");
    pn_text_str(text, name);
    pn_text_str(text, "\": ");
    pn_text_int(text, value);
}

void sim_text_watches(pn_text_t *text)
{
    pn_text_str(text, ", \"watched\": [");
    for (uint32_t i = 0U; i < s_count; i++) {
        const watch_t *watch = &s_watch[i];
        const bool is_real = watch->is_timed && pn_net.real_time;
        pn_text_str(text, (i > 0U) ? ", {\"start\": " : "{\"start\": ");
        sim_text_time(text, watch->start);
        pn_text_str(text, ", \"updated\": ");
        sim_text_time(text, watch->updated);
        text_int(text, "count", watch->count);
        text_int(text, "min", watch->min);
        text_int(text, "max", watch->max);
        text_int(text, "first", watch->first);
        text_int(text, "last", watch->last);
        if (is_real) {
            pn_text_str(text, ", \"sum\": ");
            pn_text_json_real(text, watch->real_sum);
            pn_text_str(text, ", \"ss\": ");
            pn_text_json_real(text, watch->real_squares);
        } else {
            text_int(text, "sum", watch->sum);
            text_int(text, "ss", watch->squares);
        }
        pn_text_char(text, '}');
    }
    pn_text_char(text, ']');
}
