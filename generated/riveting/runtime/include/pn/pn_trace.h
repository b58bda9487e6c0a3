/* SPDX-License-Identifier: MIT
 * pn_trace.h - writes `*.trace.jsonl` files (docs/trace.md).
 *
 * A trace that is not open (path NULL) swallows everything, so that hosts need not ask. Each line is flushed when it is
 * whole; a line that is longer than the buffer is written part by part. A write error sets `failed`; nothing is written
 * after that, and what was written of a line that is not whole is cut off when the trace is closed.
 */
#ifndef PN_TRACE_H
#define PN_TRACE_H

#include <stdio.h>

#include "pn/pn_net.h"

typedef struct pn_trace {
    FILE *file;     /* NULL: closed, or never opened */
    pn_text_t line; /* the line being made */
    uint64_t step;  /* of the last occurrence written */
    bool failed;
    const char *path;
    uint64_t good; /* bytes of the lines that were written whole */
    uint64_t part; /* bytes written of the line being made */
} pn_trace_t;

/* Opens `path` for writing ("-": standard output; NULL: no trace). `buffer` holds one line at a time and must live as
 * long as the trace. False when the file cannot be opened (errno tells why). */
PN_NODISCARD bool pn_trace_open(pn_trace_t *trace, const char *path, char *buffer, size_t capacity);

/* The first line. `by`: "supervisor", "simulate", ... `initial_json`: a JSON object with the markings that differ from
 * the net's own initial marking, or NULL for none. */
void pn_trace_header(pn_trace_t *trace, const pn_net_t *net, const char *by, const char *initial_json);

/* The same with further members, without the outer braces, such as "\"seed\": 7". */
void pn_trace_header_with(pn_trace_t *trace, const pn_net_t *net, const char *by, const char *initial_json,
                          const char *members_json);

/* One occurrence at `t` seconds; `binding` as it is after the fire, code-segment outputs included. Numbers the steps.
 */
void pn_trace_occurrence(pn_trace_t *trace, double t, const pn_transition_t *transition, const void *binding);

/* The same at a model time. */
void pn_trace_model_occurrence(pn_trace_t *trace, pn_time_t now, bool is_real, const pn_transition_t *transition,
                               const void *binding);

/* A note: {"t": t, "event": event, MEMBERS}; `members_json` is NULL or further members without the outer braces,
 * such as "\"robot\": \"robot1\"". */
void pn_trace_note(pn_trace_t *trace, double t, const char *event, const char *members_json);

/* The last line of a complete trace: {"t": t, "event": "end", "why": why, MEMBERS}; `members_json` as of a note. */
void pn_trace_end(pn_trace_t *trace, double t, const char *why, const char *members_json);
void pn_trace_model_end(pn_trace_t *trace, pn_time_t now, bool is_real, const char *why);

/* Closes the file. False when anything could not be written. */
bool pn_trace_close(pn_trace_t *trace);

#endif /* PN_TRACE_H */
