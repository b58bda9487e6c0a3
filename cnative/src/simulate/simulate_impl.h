/* SPDX-License-Identifier: MIT
 * simulate_impl.h - what the parts of the simulator share: options, the state of a run, its report.
 */
#ifndef SIMULATE_IMPL_H
#define SIMULATE_IMPL_H

#include <signal.h>
#include <stdio.h>

#include "pn/pn_marking.h"
#include "pn/pn_net.h"
#include "pn/pn_trace.h"

typedef struct sim_options {
    uint64_t steps;
    uint64_t seed;
    uint64_t memory; /* bytes for lists and strings */
    uint64_t choice; /* of the choices after a replay */
    bool has_choice;
    const char *trace;   /* NULL: none */
    const char *report;  /* NULL: none */
    const char *files;   /* folder for the net's files; NULL: none */
    const char *initial; /* what the header of the trace says of initial markings; NULL: nothing */
    const char *replay;  /* NULL: none; "-": the standard input */
    double progress_s;   /* seconds between two progress lines of the report; 0: none */
    pn_time_t until;
    bool has_until;
    bool shows_enabled;
    bool shows_marking;
    bool shows_help;
} sim_options_t;

/* What became of an attempt to go on. */
typedef enum sim_next {
    SIM_FOUND,    /* something is enabled, at the marking's time */
    SIM_FINISHED, /* nothing is enabled, and nothing ever will be */
    SIM_BEYOND,   /* something will be, but only after the time of --until, which it is now */
    SIM_FAILED    /* an inscription raised an exception */
} sim_next_t;

typedef struct sim {
    sim_options_t options;
    pn_ctx_t cx;
    void *marking;
    void *binding;     /* of the occurrence that is being worked on */
    uint32_t *enabled; /* room for the indices of all transitions */
    uint32_t enabled_count;
    uint32_t *level_end; /* for each place in the order of trying: where the transitions of its priority end */
    uint64_t *ready;   /* the set of those that are known to be enabled; a bit for each place in the order of trying */
    uint64_t *unsure;  /* the set of those of which it is not known; in neither set: not enabled */
    uint64_t *touched; /* for each transition the set of those of which nothing is known after it has occurred */
    unsigned char *found; /* bindings of one transition, one after the other, as many as there is room for */
    size_t found_size;
    pn_trace_t trace;
    FILE *report;
    uint64_t steps; /* occurrences, replayed ones included */
    uint64_t replayed;
    const char *why;         /* see print_help in simulate.c */
    const char *doing;       /* "" or what went wrong while ... */
    char message[512];       /* of a replay that is refused */
    int64_t transition;      /* that went wrong; -1: none */
    bool has_binding;        /* `binding` is of that transition */
    bool is_watched;         /* there are monitors */
    bool time_grew;          /* in the last sim_advance_time */
    int64_t watch;           /* the monitor that stopped the run, or that failed; -1: none */
    const char *watch_limit; /* "watch": its numbers became too large */
} sim_t;

/* --- simulate_play.c: the search and the steps --- */

/* Moves time on to where something is enabled, if nothing is now; fills `enabled` with the transitions of the best
 * priority. */
sim_next_t sim_advance_time(sim_t *sim);
/* The first half of it: fills `enabled` with what is enabled now. False after an error. */
bool sim_find_enabled(sim_t *sim);
/* Makes room for what is known of transitions; false if there is none. */
bool sim_prepare(sim_t *sim);
/* Forgets what is known of all transitions: the marking or the time has changed from outside. */
void sim_forget(sim_t *sim);
/* The steps at random; `why` says how they ended. */
void sim_play(sim_t *sim);
/* Lets `binding` of a transition occur and writes it to the trace; false after an error. */
bool sim_fire(sim_t *sim, uint32_t transition);
/* Notes that the evaluation has failed: `why` is "error". */
void sim_fail(sim_t *sim, const char *doing, int64_t transition, bool has_binding);

/* --- simulate.c --- */

/* Zeroed memory, of which only what is used costs anything; NULL if there is none. Never given back: the program ends.
 */
void *sim_reserve(uint64_t size);
/* Writes an occurrence to the trace; false after an error, `why` is "trace". */
bool sim_trace_step(sim_t *sim, uint32_t transition, const void *binding);

/* --- simulate_signal.c: what comes from outside --- */

/* Set by signals; whoever makes steps looks at them after each. */
extern volatile sig_atomic_t sim_interrupted;
extern volatile sig_atomic_t sim_progress_due;
void sim_catch_signals(void);
/* From now on progress is due every so many seconds, and at once. */
void sim_time_progress(double seconds);

/* --- simulate_replay.c: steps that are given --- */

/* Repeats the steps of a script (see there); false when the run ends here. */
bool sim_replay(sim_t *sim);

/* --- simulate_watch.c: the monitors --- */

/* Takes a monitor from its text (see there); false when it is not well-formed. */
bool sim_watch_add(const char *text);
/* Whether there are any. */
bool sim_watch_is_needed(void);
/* Before the first step, after a step, after model time went on while something is enabled, after the last step. False:
 * the run ends here, `why` says why. */
bool sim_watch_start(sim_t *sim);
bool sim_watch_step(sim_t *sim, uint32_t transition);
bool sim_watch_time(sim_t *sim);
void sim_watch_stop(sim_t *sim);
/* A member "watched" for the report: what each has collected. */
void sim_text_watches(pn_text_t *text);

/* --- simulate_report.c: for the program that has started this one --- */

/* A JSON object on a line of its own: {"steps": 100, "t": 12}. */
void sim_report_progress(sim_t *sim);
/* The first line: the marking at the start. */
void sim_report_start(sim_t *sim);
/* The last line: how the run has ended, and the marking. False when it could not be written. */
bool sim_report_end(sim_t *sim);
/* The marking as JSON: {"Top.P": [[1, 5]], ...}; false when it could not be written. */
bool sim_print_marking(const void *marking, FILE *out);

/* Model time as a JSON number. */
void sim_text_time(pn_text_t *text, pn_time_t time);

/* Room for one long text at a time: a binding, the marking of a place. */
#define SIM_TEXT_SIZE ((size_t)1U << 26U)
extern char sim_text_buffer[SIM_TEXT_SIZE];

#endif /* SIMULATE_IMPL_H */
