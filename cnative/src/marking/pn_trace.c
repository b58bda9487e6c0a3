/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L /* truncate */

#include "pn/pn_trace.h"

#include <string.h>
#include <sys/types.h>
#include <unistd.h>

#include "pn/pn_text.h"
#include "pn/pn_type.h"

/* Writes what there is of a line, and empties the buffer. */
static void write_part(pn_text_t *line)
{
    pn_trace_t *const trace = line->user;
    const size_t written = fwrite(line->buffer, 1U, line->length, trace->file);
    trace->failed = trace->failed || (written != line->length);
    trace->part += written;
    pn_text_clear(line);
}

bool pn_trace_open(pn_trace_t *trace, const char *path, char *buffer, size_t capacity)
{
    pn_text_init(&trace->line, buffer, capacity);
    trace->line.flush = write_part;
    trace->line.user = trace;
    trace->part = 0U;
    trace->file = NULL;
    trace->step = 0U;
    trace->failed = false;
    trace->path = path;
    trace->good = 0U;
    if (path == NULL) {
        return true;
    }
    trace->file = (strcmp(path, "-") == 0) ? stdout : fopen(path, "w");
    return trace->file != NULL;
}

/* Writes the line that was made, or notes that it cannot be. */
static void write_line(pn_trace_t *trace)
{
    pn_text_char(&trace->line, '\n');
    if (!trace->failed) {
        write_part(&trace->line);
        trace->failed = trace->failed || (fflush(trace->file) != 0);
    }
    if (!trace->failed) {
        trace->good += trace->part;
    }
    trace->part = 0U;
    pn_text_clear(&trace->line);
}

static bool is_writing(const pn_trace_t *trace)
{
    return (trace->file != NULL) && !trace->failed;
}

void pn_trace_header(pn_trace_t *trace, const pn_net_t *net, const char *by, const char *initial_json)
{
    pn_trace_header_with(trace, net, by, initial_json, NULL);
}

void pn_trace_header_with(pn_trace_t *trace, const pn_net_t *net, const char *by, const char *initial_json,
                          const char *members_json)
{
    if (!is_writing(trace)) {
        return;
    }
    pn_text_t *line = &trace->line;
    pn_text_str(line, "{\"trace\": 1, \"net\": ");
    pn_text_json_str(line, net->name);
    pn_text_str(line, ", \"source\": ");
    pn_text_json_str(line, net->source);
    pn_text_str(line, ", \"digest\": ");
    pn_text_json_str(line, net->digest);
    pn_text_str(line, ", \"by\": ");
    pn_text_json_str(line, by);
    pn_text_str(line, ", \"initial\": ");
    pn_text_str(line, (initial_json != NULL) ? initial_json : "{}");
    if (members_json != NULL) {
        pn_text_str(line, ", ");
        pn_text_str(line, members_json);
    }
    pn_text_char(line, '}');
    write_line(trace);
}

static void text_time(pn_text_t *line, pn_time_t now, bool is_real)
{
    if (is_real) {
        pn_text_json_real(line, now.real);
    } else {
        pn_text_int(line, now.integer);
    }
}

void pn_trace_occurrence(pn_trace_t *trace, double t, const pn_transition_t *transition, const void *binding)
{
    pn_trace_model_occurrence(trace, (pn_time_t){ .real = t }, true, transition, binding);
}

void pn_trace_model_occurrence(pn_trace_t *trace, pn_time_t now, bool is_real, const pn_transition_t *transition,
                               const void *binding)
{
    trace->step++;
    if (!is_writing(trace)) {
        return;
    }
    pn_text_t *line = &trace->line;
    pn_text_str(line, "{\"step\": ");
    pn_text_uint(line, trace->step);
    pn_text_str(line, ", \"t\": ");
    text_time(line, now, is_real);
    pn_text_str(line, ", \"transition\": ");
    pn_text_json_str(line, transition->name);
    pn_text_str(line, ", \"binding\": ");
    pn_json(transition->binding, binding, line);
    pn_text_str(line, ", \"origin\": ");
    pn_text_json_str(line, transition->id);
    pn_text_char(line, '}');
    write_line(trace);
}

void pn_trace_note(pn_trace_t *trace, double t, const char *event, const char *members_json)
{
    if (!is_writing(trace)) {
        return;
    }
    pn_text_t *line = &trace->line;
    pn_text_str(line, "{\"t\": ");
    pn_text_json_real(line, t);
    pn_text_str(line, ", \"event\": ");
    pn_text_json_str(line, event);
    if (members_json != NULL) {
        pn_text_str(line, ", ");
        pn_text_str(line, members_json);
    }
    pn_text_char(line, '}');
    write_line(trace);
}

static void end_line(pn_trace_t *trace, pn_time_t now, bool is_real, const char *why, const char *members_json)
{
    if (!is_writing(trace)) {
        return;
    }
    pn_text_t *line = &trace->line;
    pn_text_str(line, "{\"t\": ");
    text_time(line, now, is_real);
    pn_text_str(line, ", \"event\": \"end\", \"why\": ");
    pn_text_json_str(line, why);
    if (members_json != NULL) {
        pn_text_str(line, ", ");
        pn_text_str(line, members_json);
    }
    pn_text_char(line, '}');
    write_line(trace);
}

void pn_trace_end(pn_trace_t *trace, double t, const char *why, const char *members_json)
{
    end_line(trace, (pn_time_t){ .real = t }, true, why, members_json);
}

void pn_trace_model_end(pn_trace_t *trace, pn_time_t now, bool is_real, const char *why)
{
    end_line(trace, now, is_real, why, NULL);
}

bool pn_trace_close(pn_trace_t *trace)
{
    if (trace->file != NULL) {
        const bool is_flushed = (trace->file == stdout) ? (fflush(trace->file) == 0) : (fclose(trace->file) == 0);
        trace->failed = trace->failed || !is_flushed;
        if (trace->failed && (trace->file != stdout)) {
            /* Without effect on what is no ordinary file; the failure is reported in any case. */
            const int ignored = truncate(trace->path, (off_t)trace->good);
            (void)ignored;
        }
        trace->file = NULL;
    }
    return !trace->failed;
}
