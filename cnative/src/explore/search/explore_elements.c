/* SPDX-License-Identifier: MIT
 * explore_elements.c - reads the table of binding elements: numbers in a text (src/pn2code/verify/exploring/elements.py
 * writes it).
 */
#include "explore_reduce.h"
#include "explore_counts.h"
#include "explore_instances.h"
#include "explore_turns.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define MAGIC "pn2code-elements 1"

typedef struct reader {
    ex_run_t *run;
    FILE *file;
    const char *problem; /* NULL: none yet */
} reader_t;

static bool refuse(reader_t *r, const char *problem)
{
    if (r->problem == NULL) {
        r->problem = problem;
    }
    return false;
}

/* The next number, less than `end`; 0 after a problem. */
static uint32_t number(reader_t *r, uint64_t end)
{
    uint32_t value = 0U;
    if ((r->problem == NULL) && ((fscanf(r->file, "%" SCNu32, &value) != 1) || (value >= end))) {
        (void)refuse(r, "the table of elements is malformed");
        value = 0U;
    }
    return value;
}

static void *table(reader_t *r, uint64_t count, size_t size)
{
    void *memory = ex_alloc(&r->run->memory, (count + 1U) * size);
    if (memory == NULL) {
        (void)refuse(r, "there is not enough memory for the table of elements");
    }
    return memory;
}

static bool read_places(reader_t *r)
{
    char magic[sizeof MAGIC + 1U];
    if ((fgets(magic, (int)sizeof magic, r->file) == NULL) || (strcmp(magic, MAGIC "\n") != 0)) {
        return refuse(r, "the table of elements is none");
    }
    if (number(r, UINT32_MAX) != pn_net.place_count) {
        return refuse(r, "the table of elements has other places");
    }
    if ((pn_net.multiset_count > 0U) || pn_net.timed || (pn_net.root_count > 0U)) {
        return refuse(r, "a place is not packed");
    }
    for (uint32_t i = 0U; i < pn_net.place_count; i++) {
        if (number(r, UINT32_MAX) != pn_net.place[i].multiset->colours) {
            return refuse(r, "a place has another number of colours");
        }
    }
    return true;
}

static bool read_counters(reader_t *r, ex_reduction_t *reduction)
{
    reduction->words = (uint32_t)((pn_net.packed_size + 7U) / 8U);
    reduction->counters = number(r, 1U << 30U);
    reduction->counter = table(r, reduction->counters, sizeof *reduction->counter);
    for (uint32_t c = 0U; (r->problem == NULL) && (c < reduction->counters); c++) {
        const pn_place_t *place = &pn_net.place[number(r, pn_net.place_count)];
        const uint32_t bit = place->multiset->bit + (number(r, place->multiset->colours) * place->multiset->width);
        reduction->counter[c].word = bit / 64U;
        reduction->counter[c].shift = bit % 64U;
        reduction->counter[c].mask = ((uint64_t)1U << place->multiset->width) - 1U;
    }
    return r->problem == NULL;
}

/* The touch of an element with a counter, made if there is none yet. */
static ex_touch_t *touch_of(ex_touch_t *touch, uint32_t *count, uint32_t counter)
{
    for (uint32_t i = 0U; i < *count; i++) {
        if (touch[i].other == counter) {
            return &touch[i];
        }
    }
    touch[*count] = (ex_touch_t){ .other = counter };
    (*count)++;
    return &touch[*count - 1U];
}

/* The touches of one element, in `touch`, which has room for all counters. */
static uint32_t read_element(reader_t *r, const ex_reduction_t *reduction, ex_touch_t *touch)
{
    uint32_t touches = 0U;
    for (uint32_t list = 0U; list < 4U; list++) {
        const uint32_t count = number(r, (uint64_t)reduction->counters + 1U);
        for (uint32_t i = 0U; (r->problem == NULL) && (i < count); i++) {
            ex_touch_t *own = touch_of(touch, &touches, number(r, reduction->counters));
            switch (list) {
            case 0U: own->pre = number(r, UINT32_MAX); break;
            case 1U: own->post = number(r, UINT32_MAX); break;
            case 2U: own->is_inhibitor = true; break;
            default: own->is_reset = true; break;
            }
        }
    }
    return touches;
}

/* The same touches, counter by counter. */
static bool turn_over(reader_t *r, ex_reduction_t *reduction, uint64_t touches)
{
    reduction->use = table(r, touches, sizeof *reduction->use);
    if (r->problem != NULL) {
        return false;
    }
    for (uint64_t i = 0U; i < touches; i++) {
        reduction->counter[reduction->touch[i].other].end++;
    }
    uint64_t at = 0U;
    for (uint32_t c = 0U; c < reduction->counters; c++) {
        const uint64_t count = reduction->counter[c].end;
        reduction->counter[c].first = at;
        reduction->counter[c].end = at;
        at += count;
    }
    for (uint32_t e = 0U; e < reduction->elements; e++) {
        for (uint64_t i = reduction->element[e].first; i < reduction->element[e].end; i++) {
            ex_counter_t *counter = &reduction->counter[reduction->touch[i].other];
            reduction->use[counter->end] = reduction->touch[i];
            reduction->use[counter->end].other = e;
            counter->end++;
        }
    }
    return true;
}

static bool read_elements(reader_t *r, ex_reduction_t *reduction)
{
    uint64_t used = 0U;
    uint64_t room = 0U;
    reduction->elements = number(r, 1U << 30U);
    reduction->element = table(r, reduction->elements, sizeof *reduction->element);
    ex_touch_t *one = table(r, reduction->counters, sizeof *one);
    for (uint32_t e = 0U; (r->problem == NULL) && (e < reduction->elements); e++) {
        ex_element_t *element = &reduction->element[e];
        element->transition = number(r, pn_net.transition_count);
        element->is_useful = number(r, 2U) == 1U;
        const uint32_t touches = read_element(r, reduction, one);
        if ((used + touches) > room) {
            const uint64_t wanted = (used + touches) * 2U;
            ex_touch_t *larger = table(r, wanted, sizeof *larger);
            if (larger == NULL) {
                return false;
            }
            if (used > 0U) {
                (void)memcpy(larger, reduction->touch, used * sizeof *larger);
                ex_free(&r->run->memory, reduction->touch, (room + 1U) * sizeof *larger);
            }
            reduction->touch = larger;
            room = wanted;
        }
        if (touches > 0U) {
            (void)memcpy(&reduction->touch[used], one, touches * sizeof *one);
        }
        element->first = used;
        used += touches;
        element->end = used;
        for (uint64_t i = element->first; i < used; i++) {
            reduction->touch[i].is_useful = element->is_useful;
        }
    }
    return (r->problem == NULL) && turn_over(r, reduction, used);
}

static uint32_t *read_permutation(reader_t *r, uint32_t count)
{
    uint32_t *permutation = table(r, count, sizeof *permutation);
    for (uint32_t c = 0U; (r->problem == NULL) && (c < count); c++) {
        permutation[c] = number(r, count);
    }
    return permutation;
}

static bool read_rotations(reader_t *r, ex_reduction_t *reduction)
{
    reduction->rotation_count = number(r, 1U << 16U);
    reduction->rotations = table(r, reduction->rotation_count, sizeof *reduction->rotations);
    for (uint32_t i = 0U; (r->problem == NULL) && (i < reduction->rotation_count); i++) {
        ex_rotations_t *rotations = &reduction->rotations[i];
        rotations->order = number(r, UINT32_MAX);
        const bool has_reflection = number(r, 2U) == 1U;
        rotations->rotation = read_permutation(r, reduction->counters);
        rotations->reflection = has_reflection ? read_permutation(r, reduction->counters) : NULL;
    }
    return r->problem == NULL;
}

/* Points in the order of their classes. */
static void sort_points(ex_exchanges_t *exchanges)
{
    uint32_t at = 0U;
    for (uint32_t label = 0U; at < exchanges->points; label++) {
        for (uint32_t x = 0U; x < exchanges->points; x++) {
            if (exchanges->label[x] == label) {
                exchanges->slot[at++] = x;
            }
        }
    }
}

static bool read_exchanges(reader_t *r, ex_reduction_t *reduction)
{
    ex_exchanges_t *exchanges = &reduction->exchanges;
    const uint32_t counters = reduction->counters;
    exchanges->points = number(r, 1U << 16U);
    if ((r->problem != NULL) || (exchanges->points == 0U)) {
        return r->problem == NULL;
    }
    exchanges->label = table(r, exchanges->points, sizeof *exchanges->label);
    exchanges->slot = table(r, exchanges->points, sizeof *exchanges->slot);
    exchanges->shape = table(r, counters, sizeof *exchanges->shape);
    exchanges->first = table(r, counters, sizeof *exchanges->first);
    uint64_t room = 4U * (uint64_t)counters;
    exchanges->point = table(r, room, sizeof *exchanges->point);
    for (uint32_t x = 0U; (r->problem == NULL) && (x < exchanges->points); x++) {
        exchanges->label[x] = number(r, exchanges->points);
    }
    uint64_t used = 0U;
    for (uint32_t c = 0U; (r->problem == NULL) && (c < counters); c++) {
        exchanges->shape[c] = number(r, counters);
        const uint32_t count = number(r, 1U << 16U);
        if ((used + count) > room) {
            const uint64_t wanted = (used + count) * 2U;
            uint32_t *larger = table(r, wanted, sizeof *larger);
            if (larger == NULL) {
                return false;
            }
            (void)memcpy(larger, exchanges->point, used * sizeof *larger);
            exchanges->point = larger;
            room = wanted;
        }
        exchanges->first[c] = used;
        for (uint32_t i = 0U; i < count; i++) {
            exchanges->point[used++] = number(r, exchanges->points);
        }
    }
    if (r->problem != NULL) {
        return false;
    }
    exchanges->first[counters] = used;
    sort_points(exchanges);
    return ex_exchanges_index(r->run, reduction) || refuse(r, "there is not enough memory for the table of elements");
}

static bool read_all(reader_t *r, ex_reduction_t *reduction)
{
    char last[8] = "";
    return read_places(r) && read_counters(r, reduction) && read_elements(r, reduction) && read_rotations(r, reduction)
           && read_exchanges(r, reduction)
           && (((fscanf(r->file, " %7s", last) == 1) && (strcmp(last, "end") == 0))
               || refuse(r, "the table of elements has no end"));
}

void ex_note(ex_run_t *run, const char *kind, const char *message, int64_t transition)
{
    (void)pthread_mutex_lock(&run->error_lock);
    if (run->error.kind == NULL) {
        (void)snprintf(run->error.message, sizeof run->error.message, "%s", message);
        run->error.kind = kind;
        run->error.place = -1;
        run->error.transition = transition;
    }
    (void)pthread_mutex_unlock(&run->error_lock);
    ex_stop(run, EX_ERROR);
}

bool ex_elements_read(ex_run_t *run, ex_reduction_t *reduction, const char *path)
{
    reader_t r = { .run = run, .file = fopen(path, "r") };
    if (r.file == NULL) {
        (void)refuse(&r, "the table of elements cannot be read");
    } else {
        (void)read_all(&r, reduction);
        (void)fclose(r.file);
    }
    if (r.problem != NULL) {
        ex_note(run, "reduction", r.problem, -1);
    }
    return r.problem == NULL;
}

void ex_differs(ex_worker_t *worker, uint32_t transition, const char *how)
{
    worker->failed = true;
    ex_note(worker->run, "mismatch", how, (int64_t)transition);
}

/* The same where partial order goes by transitions. */
static bool make_dependency(ex_run_t *run, ex_reduction_t *reduction)
{
    const char *problem = NULL;
    if (run->options.is_symmetric || pn_net.timed || (run->owner_of != NULL) || (run->programs != NULL)) {
        problem = "it goes neither with symmetry, nor with time, nor with priorities of owners";
    } else if (!ex_dependency_read(run, reduction, run->options.dependency)) {
        problem = "the table of dependencies cannot be read, is malformed, or there is not enough memory";
    } else {
        run->reduction = reduction;
    }
    for (uint32_t i = 0U; (problem == NULL) && (i < run->options.threads); i++) {
        if (!ex_persistent_make(&run->worker[i], reduction)) {
            problem = "there is not enough memory for the reductions";
        }
    }
    if (problem != NULL) {
        ex_note(run, "reduction", problem, -1);
    }
    return problem == NULL;
}

/* The same where parts of the net are exchanged, and nothing else is reduced. */
static bool make_instances(ex_run_t *run, ex_reduction_t *reduction)
{
    const bool is_fine = (run->owner_of == NULL) && (run->programs == NULL) && ex_instances_make(run, reduction);
    if (is_fine) {
        reduction->is_symmetric = true;
        run->reduction = reduction;
    } else {
        ex_note(
            run, "reduction",
            "the table of parts cannot be read, is malformed, there is not enough memory, or owners have priorities "
            "of their own",
            -1);
    }
    return is_fine;
}

bool ex_reduction_make(ex_run_t *run)
{
    if ((run->options.turns != NULL) || (run->options.counts != NULL)) {
        const bool is_fine = (run->options.turns == NULL) || ex_turns_make(run);
        return is_fine && ((run->options.counts == NULL) || ex_counts_make(run));
    }
    if (!run->options.is_stubborn && !run->options.is_symmetric) {
        return true;
    }
    ex_reduction_t *reduction = ex_alloc(&run->memory, sizeof *reduction);
    if (!run->options.is_stubborn && (run->options.instances != NULL)) {
        return (reduction != NULL) && make_instances(run, reduction);
    }
    if (run->options.dependency != NULL) {
        return (reduction != NULL) && make_dependency(run, reduction);
    }
    if (run->options.elements == NULL) {
        ex_note(run, "reduction", "there is no table of elements", -1);
        return false;
    }
    if (reduction == NULL) {
        ex_note(run, "reduction", "there is not enough memory for the table of elements", -1);
        return false;
    }
    reduction->is_stubborn = run->options.is_stubborn;
    reduction->is_symmetric = run->options.is_symmetric;
    if (!ex_elements_read(run, reduction, run->options.elements)) {
        return false;
    }
    run->reduction = reduction;
    for (uint32_t i = 0U; i < run->options.threads; i++) {
        if ((reduction->is_stubborn && !ex_stubborn_make(&run->worker[i], reduction))
            || (reduction->is_symmetric && !ex_symmetry_make(&run->worker[i], reduction))) {
            ex_note(run, "reduction", "there is not enough memory for the reductions", -1);
            return false;
        }
    }
    return true;
}
