/* SPDX-License-Identifier: MIT
 * supervisor_trace.c - what the deployed program does without (-DPN_TRACE): the trace of a run (docs/trace.md), and
 * colours as JSON.
 */
#ifdef PN_TRACE

#include "supervisor_impl.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#define TRACE_LINE 65536U

static char s_trace_line[TRACE_LINE];
static char s_initial[(size_t)1U << 20U]; /* tokens of input files, as JSON */

/* The places that input files have filled, as the object that traces begin with. */
static void describe_inputs(const sup_t *sup, pn_text_t *json)
{
    pn_text_char(json, '{');
    for (uint32_t i = 0U; i < sup->cell->input_count; i++) {
        const pn_place_t *const place = &sup->net->place[sup->cell->input[i].place];
        pn_text_str(json, (i > 0U) ? ", " : "");
        pn_text_json_str(json, place->name);
        pn_text_str(json, ": ");
        pn_multiset_json(place->multiset, sup->marking, json);
    }
    pn_text_char(json, '}');
}

bool sup_trace_start(sup_t *sup)
{
    pn_text_t initial;
    pn_text_init(&initial, s_initial, sizeof s_initial);
    describe_inputs(sup, &initial);
    if (initial.truncated) {
        return sup_stop(sup, SUP_EXIT_USAGE, "the tokens of the input files are too long for the trace");
    }
    if (!pn_trace_open(&sup->trace, sup->options.trace, s_trace_line, sizeof s_trace_line)) {
        return sup_stop(sup, SUP_EXIT_IO, "cannot write the trace %s: %s", sup->options.trace, strerror(errno));
    }
    pn_trace_header(&sup->trace, sup->net, sup->options.dry_run ? "run" : sup->cell->side, s_initial);
    return true;
}

void sup_trace_occurrence(sup_t *sup, uint32_t transition)
{
    const pn_transition_t *const fired = &sup->net->transition[transition];
    pn_trace_occurrence(&sup->trace, sup->t, fired, sup->binding);
    if (sup->options.verbosity >= 2) {
        char text[1024];
        pn_text_t json;
        pn_text_init(&json, text, sizeof text);
        pn_json(fired->binding, sup->binding, &json);
        sup_say(sup, 2, "%10.3f s  %s %s", sup->t, fired->name, text);
    }
}

bool sup_trace_is_written(sup_t *sup)
{
    if (sup->trace.failed) {
        return sup_stop(sup, SUP_EXIT_IO, "cannot write the trace %s", sup->options.trace);
    }
    return true;
}

/* The names of the final places that hold a token, as JSON strings. */
static void final_places(const sup_t *sup, pn_text_t *text)
{
    const char *separator = "";
    for (uint32_t i = 0U; i < sup->cell->final_count; i++) {
        const pn_place_t *const place = &sup->net->place[sup->cell->final_place[i]];
        if (pn_multiset_total(place->multiset, sup->marking) > 0U) {
            pn_text_str(text, separator);
            pn_text_json_str(text, place->name);
            separator = ", ";
        }
    }
}

void sup_trace_end(sup_t *sup)
{
    static char places[8192];
    const char *members = NULL;
    if (!sup->stopped && sup_is_final(sup)) {
        pn_text_t text;
        pn_text_init(&text, places, sizeof places);
        pn_text_str(&text, "\"final\": [");
        final_places(sup, &text);
        pn_text_char(&text, ']');
        members = text.truncated ? NULL : places;
    }
    pn_trace_end(&sup->trace, sup->t, (sup->reason[0] != '\0') ? sup->reason : "finished", members);
    if (!pn_trace_close(&sup->trace)) {
        (void)sup_stop(sup, SUP_EXIT_IO, "cannot write the trace %s", sup->options.trace);
    }
}

void sup_trace_marking(const sup_t *sup)
{
    static char text[65536];
    pn_text_t json;
    sup_say(sup, 1, "marking at the end:");
    for (uint32_t i = 0U; i < sup->net->place_count; i++) {
        const pn_place_t *const place = &sup->net->place[i];
        if (pn_multiset_total(place->multiset, sup->marking) > 0U) {
            pn_text_init(&json, text, sizeof text);
            pn_multiset_json(place->multiset, sup->marking, &json);
            sup_say(sup, 1, "  %s  %s%s", place->name, text, json.truncated ? "..." : "");
        }
    }
}

#else

typedef int sup_trace_is_empty_t; /* a translation unit has at least one declaration */

#endif
