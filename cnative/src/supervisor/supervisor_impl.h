/* SPDX-License-Identifier: MIT
 * supervisor_impl.h - shared by the files of the supervisor host; see docs/execution.md for the scheme they carry out.
 *
 *   supervisor.c        options, start, end
 *   supervisor_play.c   firing: the documented order, errors, the bound
 *   supervisor_input.c  markings read from files
 *   supervisor_cell.c   the cell: channels, peers, real time and lock-step
 *   supervisor_monitor.c  with -DPN_MONITOR: each step checked against the rules of the net
 *   supervisor_alone.c  the whole net in memory: --dry-run, and nets without a cell
 *   supervisor_trace.c  with -DPN_TRACE: `--trace`, `--dry-run`, and colours as JSON. The deployed program has none of
 *                       it
 */
#ifndef SUPERVISOR_IMPL_H
#define SUPERVISOR_IMPL_H

#include "pn/pn_arena.h"
#include "pn/pn_cell.h"
#include "pn/pn_channel.h"
#include "pn/pn_marking.h"
#include "pn/pn_net.h"
#include "pn/pn_text.h"
#ifdef PN_TRACE
#include "pn/pn_trace.h"
#endif

/* Exit codes; docs/protocol.md and --help list them. */
typedef enum sup_exit {
    SUP_EXIT_FINISHED = 0,
    SUP_EXIT_MODEL = 1,   /* overflow, a value out of its colour set, no end of firing, deadlock */
    SUP_EXIT_USAGE = 2,   /* command line, input file */
    SUP_EXIT_PEER = 3,    /* a robot stopped, died or fell silent */
    SUP_EXIT_CHANNEL = 4, /* refused message, overrun */
    SUP_EXIT_IO = 5,      /* directory missing, read-only, full; trace cannot be written */
    SUP_EXIT_INTERNAL = 70,
    SUP_EXIT_INTERRUPTED = 130
} sup_exit_t;

typedef struct sup_options {
    const char *directory;
    const char *input;
    const char *files; /* folder for the net's files; NULL: none */
#ifdef PN_TRACE
    const char *trace; /* NULL: none */
#endif
    bool dry_run; /* with PN_TRACE only */
    bool lockstep;
    bool paced;        /* --time-scale was given */
    double time_scale; /* model time units per second */
    uint64_t poll_ns;  /* 0: use notices */
    double reply_timeout_s;
    uint64_t max_firings; /* in one cycle; of a net without a cell: in all */
    int verbosity;        /* 0 quiet, 1, 2 */
} sup_options_t;

typedef struct sup {
    sup_options_t options;
    const pn_net_t *net;
    const pn_cell_t *cell;
    pn_ctx_t cx;
    pn_arena_t arena;
    void *marking;
    void *binding; /* the binding that is fired */
#ifdef PN_TRACE
    pn_trace_t trace;
#endif
    double t; /* seconds since the start */
    uint64_t fired;
    uint64_t *fired_of; /* per transition */
    bool stopped;
    sup_exit_t exit_code;
    char reason[1024]; /* why it stopped, or went no further; empty: it has finished */
} sup_t;

/* Records why the program stops; the first reason counts. Always false, for `return`. */
bool sup_stop(sup_t *sup, sup_exit_t exit_code, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* A line for people: on standard output, or on standard error in lock-step. Printed when verbosity >= level. */
void sup_say(const sup_t *sup, int level, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* A warning on standard error. */
void sup_warn(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Stops for the context's error. */
bool sup_stop_error(sup_t *sup, const char *doing);

/* --- supervisor_play.c --- */

/* Looks for the first enabled transition of the owner (-1: of anybody) in the documented order, and keeps its binding
 * in `sup->binding`. Returns 1 when there is one, 0 when there is none, -1 after an error. */
int sup_find_one(sup_t *sup, int32_t owner, uint32_t *transition);

/* Fires the first enabled transition of the owner (-1: of anybody) in the documented order. Returns 1 when one fired, 0
 * when none is enabled, -1 when the program has to stop. */
int sup_fire_one(sup_t *sup, int32_t owner, uint32_t *transition);

/* Fires until none is enabled. False when the program has to stop. */
bool sup_play(sup_t *sup, int32_t owner, uint64_t *count);

/* Sets the model clock for `t` seconds (never back). */
void sup_set_time(sup_t *sup, double t);

/* When, in seconds, something may become enabled by time alone; false if never, or when the program has to stop. */
bool sup_next_time(sup_t *sup, double *t);

/* Whether a final place holds a token. */
bool sup_is_final(const sup_t *sup);

/* The names of the final places that hold a token, with commas between. */
void sup_final_places(const sup_t *sup, pn_text_t *text);

/* The scalars of the token in a channel's place as text. */
const char *sup_token_text(const sup_t *sup, const pn_cell_channel_t *channel, char *out, size_t capacity);

/* --- supervisor_input.c --- */

/* Replaces markings by what the input files hold. */
bool sup_read_inputs(sup_t *sup);

/* --- supervisor_monitor.c --- */

#ifdef PN_MONITOR
/* Remembers the marking; before the first step. Each of these is false when the program has to stop. */
bool sup_monitor_start(sup_t *sup);
/* `sup->binding` of a transition of an owner (-1: anybody's) is about to occur. */
bool sup_monitor_choice(sup_t *sup, int32_t owner, uint32_t transition);
/* It has occurred. */
bool sup_monitor_step(sup_t *sup, uint32_t transition);
/* Messages in that direction have been exchanged. */
bool sup_monitor_messages(sup_t *sup, pn_channel_direction_t direction);
#else
#define sup_monitor_start(sup)                     (true)
#define sup_monitor_choice(sup, owner, transition) (true)
#define sup_monitor_step(sup, transition)          (true)
#define sup_monitor_messages(sup, direction)       (true)
#endif

/* --- supervisor_trace.c --- */

#ifdef PN_TRACE
/* Opens the trace; after the input files have been read. False when the program has to stop. */
bool sup_trace_start(sup_t *sup);
/* A transition has occurred with `sup->binding`. */
void sup_trace_occurrence(sup_t *sup, uint32_t transition);
/* False, and the program has to stop, when something could not be written. */
bool sup_trace_is_written(sup_t *sup);
/* Why it ended; when it has come to its end, also where. */
void sup_trace_end(sup_t *sup);
/* What the places hold, for people. */
void sup_trace_marking(const sup_t *sup);
#else
#define sup_trace_start(sup) (true)
#define sup_trace_occurrence(sup, fired) \
    sup_say((sup), 2, "%10.3f s  %s", (sup)->t, (sup)->net->transition[(fired)].name)
#define sup_trace_is_written(sup) (true)
#define sup_trace_end(sup)        ((void)0)
#define sup_trace_marking(sup)    ((void)0)
#endif

/* supervisor_cell.c and supervisor_alone.c have sup_run_cell and sup_run_alone: see pn_cell.h. */

#endif /* SUPERVISOR_IMPL_H */
