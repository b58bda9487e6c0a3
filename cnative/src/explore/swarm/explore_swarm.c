/* SPDX-License-Identifier: MIT
 * explore_swarm.c - the way to the state at hand, and what is written of it.
 *
 * Depth first, with one thread, the states that were expanded last at depths 0, 1, 2, ... are a way to the one at hand:
 * what is expanded between a state and its successor is reached through other successors of it, so it is deeper. So
 * there is a run to whatever is found, although no state is stored.
 */
#include "explore_swarm.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "pn/pn_text.h"

bool ex_swarm_make(ex_run_t *run)
{
    ex_swarm_t *const swarm = ex_alloc(&run->memory, sizeof *swarm);
    if (swarm == NULL) {
        return false;
    }
    run->swarm = swarm;
    swarm->dead_steps = -1;
    swarm->way = ex_table(&run->memory, run->options.max_depth + ex_trap_room(), sizeof *swarm->way);
    /* Numbers that are near each other make very different ones. */
    swarm->random = (run->options.swarm * 0x9e3779b97f4a7c15U) | 1U;
    return (swarm->way != NULL) && ex_sketch_make(&run->worker[0], &swarm->sketch, (uint32_t)run->options.sketch);
}

bool ex_swarm_at(ex_worker_t *worker, const ex_key_t *key, uint64_t depth)
{
    ex_swarm_t *const swarm = worker->run->swarm;
    swarm->way[depth] = *key;
    swarm->depth = depth;
    return ex_sketch_see(worker, &swarm->sketch, key);
}

bool ex_swarm_is_end(const ex_run_t *run)
{
    return run->swarm->depth >= run->options.max_depth;
}

/* --- ways without loops: a walk may come to a state more than once ------------------------------------------------ */

typedef struct place {
    ex_key_t key;
    uint64_t last; /* where it is on the way for the last time, + 1; 0: a free place */
} place_t;

static place_t *place_of(place_t *table, uint64_t size, const ex_key_t *key)
{
    uint64_t at = ex_hash(key) % size;
    while ((table[at].last != 0U) && ((table[at].key.low != key->low) || (table[at].key.high != key->high))) {
        at = (at + 1U) % size;
    }
    return &table[at];
}

/* The way to the state at hand without what leads back to where it was; the caller frees it. NULL: no memory. */
static ex_key_t *short_way(const ex_swarm_t *swarm, uint64_t *steps)
{
    const uint64_t size = 2U * (swarm->depth + 1U);
    place_t *const table = calloc(size, sizeof *table);
    ex_key_t *const way = calloc(swarm->depth + 1U, sizeof *way);
    uint64_t count = 0U;
    for (uint64_t i = 0U; (table != NULL) && (i <= swarm->depth); i++) {
        place_t *const own = place_of(table, size, &swarm->way[i]);
        own->key = swarm->way[i];
        own->last = i + 1U;
    }
    for (uint64_t i = 0U; (table != NULL) && (way != NULL) && (i <= swarm->depth); i++) {
        i = place_of(table, size, &swarm->way[i])->last - 1U;
        way[count] = swarm->way[i];
        count++;
    }
    free(table);
    if (count == 0U) {
        free(way);
        return NULL;
    }
    *steps = count - 1U;
    return way;
}

int64_t ex_swarm_write(ex_run_t *run, const char *path, const char *why)
{
    uint64_t steps = 0U;
    ex_key_t *const way = short_way(run->swarm, &steps);
    const int64_t written = (way != NULL) ? ex_write_keys(run, way, steps, path, why) : -1;
    free(way);
    return written;
}

/* --- what was found ----------------------------------------------------------------------------------------------- */

void ex_swarm_dead(ex_worker_t *worker)
{
    ex_run_t *const run = worker->run;
    ex_swarm_t *const swarm = run->swarm;
    if ((swarm->dead_steps >= 0) || (run->options.trace_to == NULL) || (run->options.traces == 0U)) {
        return;
    }
    (void)snprintf(swarm->dead_path, sizeof swarm->dead_path, "%s0.trace.jsonl", run->options.trace_to);
    swarm->dead_steps = ex_swarm_write(run, swarm->dead_path, "finished");
}

void ex_swarm_decided(ex_worker_t *worker, ex_question_t *question, uint32_t number, ex_found_t found)
{
    ex_run_t *const run = worker->run;
    char path[EX_PATH_SIZE];
    if (!atomic_load(&question->is_raised) && (run->options.query_trace_to != NULL)) {
        (void)snprintf(path, sizeof path, "%s%" PRIu32 ".trace.jsonl", run->options.query_trace_to, number);
        question->steps = ex_swarm_write(run, path, (found == EX_DEAD) ? "finished" : "steps");
    }
    if (ex_is_listed(run->options.ending, number)) {
        ex_stop(run, EX_DECIDED);
    }
}

void ex_swarm_json(ex_run_t *run, FILE *out)
{
    const ex_swarm_t *const swarm = run->swarm;
    char quoted[2U * EX_PATH_SIZE];
    pn_text_t text;
    (void)fprintf(out,
                  ",\n \"swarm\": {\"seed\": %" PRIu64 ", \"occupancy\": %.6f, \"dead_trace\": ", run->options.swarm,
                  (run->bits.word != NULL) ? ex_bits_occupancy(&run->bits) : 0.0);
    if (swarm->dead_steps >= 0) {
        pn_text_init(&text, quoted, sizeof quoted);
        pn_text_json_str(&text, swarm->dead_path);
        (void)fprintf(out, "{\"node\": 0, \"file\": %s, \"steps\": %" PRId64 "}", quoted, swarm->dead_steps);
    } else {
        (void)fprintf(out, "null");
    }
    (void)fprintf(out, ", \"sketch\": ");
    ex_sketch_json(&swarm->sketch, out);
    (void)fprintf(out, "}");
}
