/* SPDX-License-Identifier: MIT
 * simulate_signal.c - what reaches the simulator from outside between two steps: it shall end, or a line of progress is
 * due.
 */
#define _POSIX_C_SOURCE 200809L /* sigaction */
#define _XOPEN_SOURCE   700     /* setitimer */

#include <signal.h>
#include <string.h>
#include <sys/time.h>

#include "simulate_impl.h"

volatile sig_atomic_t sim_interrupted;
volatile sig_atomic_t sim_progress_due;

static void on_interrupt(int number)
{
    (void)number;
    sim_interrupted = 1;
}

static void on_timer(int number)
{
    (void)number;
    sim_progress_due = 1;
}

static void handle(int number, void (*handler)(int), int flags)
{
    struct sigaction action;
    (void)memset(&action, 0, sizeof action);
    action.sa_handler = handler;
    action.sa_flags = flags;
    (void)sigemptyset(&action.sa_mask);
    (void)sigaction(number, &action, NULL);
}

void sim_catch_signals(void)
{
    const int once = SA_RESTART | (int)SA_RESETHAND; /* the second one ends the program at once */
    handle(SIGINT, on_interrupt, once);
    handle(SIGTERM, on_interrupt, once);
    handle(SIGXFSZ, SIG_IGN, 0); /* a file that may not grow any more is an error of writing */
}

void sim_time_progress(double seconds)
{
    struct timeval period = { .tv_sec = (time_t)seconds };
    period.tv_usec = (suseconds_t)((seconds - (double)period.tv_sec) * 1e6);
    if ((period.tv_sec == 0) && (period.tv_usec == 0)) {
        period.tv_usec = 1;
    }
    const struct itimerval timer = { .it_interval = period, .it_value = period };
    handle(SIGALRM, on_timer, SA_RESTART);
    sim_progress_due = 1;
    (void)setitimer(ITIMER_REAL, &timer, NULL);
}
