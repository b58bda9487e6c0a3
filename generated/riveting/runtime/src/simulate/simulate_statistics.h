/* SPDX-License-Identifier: MIT
 * simulate_statistics.h - what a data collector keeps of its values: integers exactly, reals as they are added up.
 */
#ifndef SIMULATE_STATISTICS_H
#define SIMULATE_STATISTICS_H

#include <stdbool.h>
#include <stdint.h>

#include "pn/pn_net.h"
#include "pn/pn_text.h"

/* A value, or a sum of values; which member counts is known from the statistics. */
typedef struct sim_number {
    int64_t integer;
    double real;
} sim_number_t;

typedef struct sim_statistics {
    bool is_real;  /* the values are reals */
    bool is_timed; /* each is weighted with the model time for which it held */
    int64_t count;
    sim_number_t min;
    sim_number_t max;
    sim_number_t first;
    sim_number_t last;
    sim_number_t sum; /* real as well where the values are integers that are weighted with a real time */
    sim_number_t squares;
    pn_time_t start;
    pn_time_t updated;
} sim_statistics_t;

/* Takes a further value; false when an integer becomes too large. */
bool sim_statistics_add(sim_statistics_t *statistics, sim_number_t value, pn_time_t now);
/* A JSON object with all members. */
void sim_text_statistics(pn_text_t *text, const sim_statistics_t *statistics);

#endif /* SIMULATE_STATISTICS_H */
