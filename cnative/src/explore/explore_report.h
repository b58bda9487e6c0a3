/* SPDX-License-Identifier: MIT
 * explore_report.h - the report of an exploration (explore_report.c).
 */
#ifndef EXPLORE_REPORT_H
#define EXPLORE_REPORT_H

#include "explore_run.h"

enum { EX_EXIT_FINE = 0, EX_EXIT_MODEL = 1, EX_EXIT_USAGE = 2, EX_EXIT_TRUNCATED = 3 };

/* Between two parts of the work: what is known now, for ex_report_late. */
void ex_report_keep(ex_run_t *run);
/* The time is over: prints what was kept last and ends the process. Nothing happens where nothing was kept, or when the
 * report has been printed. */
void ex_report_late(void);
/* The end: prints all. False: it cannot be written. */
bool ex_report(ex_run_t *run);

#endif /* EXPLORE_REPORT_H */
