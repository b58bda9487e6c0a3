/* SPDX-License-Identifier: MIT
 * simulate_report.c - JSON lines for the program that has started the simulator.
 *
 *     {"initial": {"Top.P": [[1, 3]]}}                                                                  the start
 *     {"steps": 1000, "t": 12}                                                                          progress
 *     {"why": "finished", "steps": 1200, "replayed": 0, "t": 14, "marking": {"Top.P": [[1, 5]]}}        the end
 *
 * After an error the end also has "error", "origin", "doing", and where they are known "transition" (its index) and
 * "binding"; when it was one of the program and not of the net, "limit": "room" (a place is full), "memory" (of lists
 * and strings), "numbers" (a model time beyond 64 bits) or "watch" (numbers of a monitor); after a replay that was
 * refused "message"; after a breakpoint, or when a monitor failed, "watch": its index. "watched" has what each monitor
 * of --watch has collected.
 */
#include <inttypes.h>
#include <string.h>

#include "pn/pn_text.h"
#include "simulate_impl.h"

char sim_text_buffer[SIM_TEXT_SIZE];

void sim_text_time(pn_text_t *text, pn_time_t time)
{
    if (pn_net.real_time) {
        pn_text_json_real(text, time.real);
    } else {
        pn_text_int(text, time.integer);
    }
}

/* Writes the text and empties it. */
static bool put(pn_text_t *text, FILE *out)
{
    const bool is_whole = !text->truncated && (fwrite(text->buffer, 1U, text->length, out) == text->length);
    pn_text_clear(text);
    return is_whole;
}

static void text_start(pn_text_t *text)
{
    pn_text_init(text, sim_text_buffer, sizeof sim_text_buffer);
}

void sim_report_progress(sim_t *sim)
{
    pn_text_t text;
    sim_progress_due = 0;
    text_start(&text);
    pn_text_str(&text, "{\"steps\": ");
    pn_text_uint(&text, sim->steps);
    pn_text_str(&text, ", \"t\": ");
    sim_text_time(&text, pn_now(&pn_net, sim->marking));
    pn_text_str(&text, "}\n");
    (void)put(&text, sim->report);
    (void)fflush(sim->report);
}

bool sim_print_marking(const void *marking, FILE *out)
{
    pn_text_t text;
    text_start(&text);
    bool is_fine = true;
    pn_text_char(&text, '{');
    for (uint32_t i = 0U; i < pn_net.place_count; i++) {
        pn_text_str(&text, (i > 0U) ? ", " : "");
        pn_text_json_str(&text, pn_net.place[i].name);
        pn_text_str(&text, ": ");
        pn_multiset_json(pn_net.place[i].multiset, marking, &text);
        is_fine = put(&text, out) && is_fine;
    }
    pn_text_char(&text, '}');
    return put(&text, out) && is_fine;
}

static void text_member(pn_text_t *text, const char *name, const char *value)
{
    pn_text_str(text, ", \"");
    pn_text_str(text, name);
    pn_text_str(text, "\": ");
    pn_text_json_str(text, value);
}

static void text_error(pn_text_t *text, const sim_t *sim)
{
    text_member(text, "error", sim->cx.error_name);
    text_member(text, "origin", sim->cx.error_origin);
    text_member(text, "doing", sim->doing);
    if (sim->watch_limit[0] != '\0') {
        text_member(text, "limit", sim->watch_limit);
    } else if (sim->cx.error == PN_ERR_CAPACITY) {
        text_member(text, "limit", "room");
    } else if (sim->cx.error == PN_ERR_MEMORY) {
        text_member(text, "limit", "memory");
    } else if (sim->cx.error == PN_ERR_LARGE) {
        text_member(text, "limit", "numbers");
    }
    if (sim->transition >= 0) {
        pn_text_str(text, ", \"transition\": ");
        pn_text_int(text, sim->transition);
        if (sim->has_binding) {
            pn_text_str(text, ", \"binding\": ");
            pn_json(pn_net.transition[sim->transition].binding, sim->binding, text);
        }
    }
}

void sim_report_start(sim_t *sim)
{
    if (sim->report != NULL) {
        (void)fputs("{\"initial\": ", sim->report);
        (void)sim_print_marking(sim->marking, sim->report);
        (void)fputs("}\n", sim->report);
        (void)fflush(sim->report);
    }
}

bool sim_report_end(sim_t *sim)
{
    if (sim->report == NULL) {
        return true;
    }
    pn_text_t text;
    text_start(&text);
    pn_text_str(&text, "{\"why\": ");
    pn_text_json_str(&text, sim->why);
    pn_text_str(&text, ", \"steps\": ");
    pn_text_uint(&text, sim->steps);
    pn_text_str(&text, ", \"replayed\": ");
    pn_text_uint(&text, sim->replayed);
    pn_text_str(&text, ", \"t\": ");
    sim_text_time(&text, pn_now(&pn_net, sim->marking));
    if (strcmp(sim->why, "error") == 0) {
        text_error(&text, sim);
    }
    if (sim->watch >= 0) {
        pn_text_str(&text, ", \"watch\": ");
        pn_text_int(&text, sim->watch);
    }
    sim_text_watches(&text);
    if (sim->message[0] != '\0') {
        text_member(&text, "message", sim->message);
    }
    pn_text_str(&text, ", \"marking\": ");
    bool is_fine = put(&text, sim->report);
    is_fine = sim_print_marking(sim->marking, sim->report) && is_fine;
    is_fine = (fputs("}\n", sim->report) >= 0) && is_fine;
    return (fclose(sim->report) == 0) && is_fine;
}
