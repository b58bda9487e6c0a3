/* SPDX-License-Identifier: MIT
 * explore_instances.c - one marking for all in which equal parts of the net (robots, devices: page instances with what
 * belongs to them) are exchanged: the contents of the parts, sorted.
 *
 * A family is a list of parts, and a part a list of places and a list of transitions; what stands at the same position
 * is mapped to each other when two parts are exchanged. That this maps the net to itself is proved in
 * src/pn2code/verify/exploring/instances.py, which writes the table. Families that lie in a part of another one come
 * before it.
 */
#include "explore_instances.h"

#include <inttypes.h>
#include <string.h>

#define MAGIC        "pn2code-instances 1"
#define FIRST_BUFFER ((size_t)1024U)

/* Parts that can be exchanged. */
typedef struct family {
    uint32_t parts;
    uint32_t places; /* of a part */
    uint32_t transitions;
    uint32_t *place; /* part by part */
    uint32_t *transition;
} family_t;

struct ex_instances {
    family_t *family;
    uint32_t families;
    uint32_t most_parts;
    uint32_t most_places; /* of a part */
};

/* Where the content of a place lies, as canonical bytes. */
typedef struct span {
    size_t at;
    size_t length;
} span_t;

struct ex_exchange {
    const struct ex_instances *of;
    span_t *span;    /* by part and place */
    uint32_t *order; /* by family, most_parts each: the part that comes to this position */
    uint32_t *moved; /* room for what is exchanged */
    uint32_t *place; /* of the way -> of the run */
    uint32_t *transition;
    unsigned char *marking; /* the result */
    unsigned char *buffer;  /* of the contents */
    size_t buffer_size;
};

/* --- the table ---------------------------------------------------------------------------------------------------- */

static bool read_number(FILE *file, uint64_t most, uint32_t *number)
{
    uint64_t value = 0U;
    const bool is_fine = (fscanf(file, "%" SCNu64, &value) == 1) && (value <= most);
    *number = (uint32_t)value;
    return is_fine;
}

static bool read_family(ex_run_t *run, FILE *file, family_t *family)
{
    bool is_fine = read_number(file, (uint64_t)pn_net.place_count, &family->parts) && (family->parts >= 2U)
                   && read_number(file, (uint64_t)pn_net.place_count / family->parts, &family->places)
                   && read_number(file, (uint64_t)pn_net.transition_count / family->parts, &family->transitions);
    if (!is_fine) {
        return false;
    }
    family->place = ex_table(&run->memory, (uint64_t)family->parts * family->places, sizeof *family->place);
    family->transition =
        ex_table(&run->memory, (uint64_t)family->parts * family->transitions, sizeof *family->transition);
    is_fine = (family->place != NULL) && (family->transition != NULL);
    for (uint32_t i = 0U; is_fine && (i < family->parts); i++) {
        for (uint32_t k = 0U; is_fine && (k < family->places); k++) {
            is_fine = read_number(file, (uint64_t)pn_net.place_count - 1U, &family->place[(i * family->places) + k]);
        }
        for (uint32_t k = 0U; is_fine && (k < family->transitions); k++) {
            is_fine = read_number(file, (uint64_t)pn_net.transition_count - 1U,
                                  &family->transition[(i * family->transitions) + k]);
        }
    }
    return is_fine;
}

static bool read_table(ex_run_t *run, FILE *file, struct ex_instances *table)
{
    char magic[sizeof MAGIC + 1U] = "";
    char last[8] = "";
    uint32_t places = 0U;
    uint32_t transitions = 0U;
    bool is_fine = (fgets(magic, (int)sizeof magic, file) != NULL) && (strcmp(magic, MAGIC "\n") == 0)
                   && read_number(file, UINT32_MAX, &places) && (places == pn_net.place_count)
                   && read_number(file, UINT32_MAX, &transitions) && (transitions == pn_net.transition_count)
                   && read_number(file, pn_net.place_count, &table->families);
    table->family = is_fine ? ex_table(&run->memory, table->families, sizeof *table->family) : NULL;
    is_fine = table->family != NULL;
    for (uint32_t i = 0U; is_fine && (i < table->families); i++) {
        family_t *const family = &table->family[i];
        is_fine = read_family(run, file, family);
        table->most_parts = (family->parts > table->most_parts) ? family->parts : table->most_parts;
        table->most_places = (family->places > table->most_places) ? family->places : table->most_places;
    }
    return is_fine && (fscanf(file, "%7s", last) == 1) && (strcmp(last, "end") == 0);
}

static bool make_exchange(ex_worker_t *worker, const struct ex_instances *table)
{
    ex_memory_t *const memory = &worker->run->memory;
    struct ex_exchange *const own = ex_alloc(memory, sizeof *own);
    const uint64_t parts = (uint64_t)table->most_parts + 1U;
    if (own == NULL) {
        return false;
    }
    const uint64_t nodes = (uint64_t)pn_net.place_count + pn_net.transition_count + 1U;
    worker->exchange = own;
    own->of = table;
    own->span = ex_table(memory, parts * ((uint64_t)table->most_places + 1U), sizeof *own->span);
    own->order = ex_table(memory, parts * ((uint64_t)table->families + 1U), sizeof *own->order);
    own->moved = ex_table(memory, nodes, sizeof *own->moved);
    own->place = ex_table(memory, nodes, sizeof *own->place);
    own->transition = ex_table(memory, nodes, sizeof *own->transition);
    own->marking = ex_alloc(memory, pn_net.marking_size + sizeof(uint64_t));
    own->buffer_size = FIRST_BUFFER;
    own->buffer = ex_alloc(memory, own->buffer_size);
    if ((own->span == NULL) || (own->order == NULL) || (own->moved == NULL) || (own->place == NULL)
        || (own->transition == NULL) || (own->marking == NULL) || (own->buffer == NULL)) {
        return false;
    }
    ex_instances_start(worker);
    return true;
}

bool ex_instances_make(ex_run_t *run, ex_reduction_t *reduction)
{
    struct ex_instances *const table = ex_alloc(&run->memory, sizeof *table);
    FILE *const file = (table != NULL) ? fopen(run->options.instances, "r") : NULL;
    bool is_fine = file != NULL;
    if (is_fine) {
        is_fine = read_table(run, file, table);
        (void)fclose(file);
    }
    for (uint32_t i = 0U; is_fine && (i < run->options.threads); i++) {
        is_fine = make_exchange(&run->worker[i], table);
    }
    reduction->instances = is_fine ? table : NULL;
    return is_fine;
}

/* --- contents ----------------------------------------------------------------------------------------------------- */

/* More room for contents; those that are there stay. */
static bool grow(ex_worker_t *worker, size_t size)
{
    struct ex_exchange *const own = worker->exchange;
    unsigned char *const larger = ex_alloc(&worker->run->memory, size * 2U);
    if (larger == NULL) {
        ex_stop(worker->run, EX_MEMORY);
        worker->failed = true;
        return false;
    }
    (void)memcpy(larger, own->buffer, own->buffer_size);
    ex_free(&worker->run->memory, own->buffer, own->buffer_size);
    own->buffer = larger;
    own->buffer_size = size * 2U;
    return true;
}

/* Writes the content of a place behind `at`, making room; SIZE_MAX: no memory. */
static size_t put_content(ex_worker_t *worker, uint32_t place, const void *marking, size_t at, span_t *span)
{
    const pn_multiset_t *const multiset = pn_net.place[place].multiset;
    struct ex_exchange *const own = worker->exchange;
    size_t length = pn_multiset_encode(multiset, marking, &own->buffer[at], own->buffer_size - at);
    while (length > (own->buffer_size - at)) {
        if (!grow(worker, at + length)) {
            return SIZE_MAX;
        }
        length = pn_multiset_encode(multiset, marking, &own->buffer[at], own->buffer_size - at);
    }
    *span = (span_t){ .at = at, .length = length };
    return at + length;
}

/* The contents of all parts of a family. */
static bool put_family(ex_worker_t *worker, const family_t *family, const void *marking)
{
    size_t at = 0U;
    for (uint32_t i = 0U; (at != SIZE_MAX) && (i < (family->parts * family->places)); i++) {
        at = put_content(worker, family->place[i], marking, at, &worker->exchange->span[i]);
    }
    return at != SIZE_MAX;
}

/* The order of two parts: by their places, one after the other. */
static int order_of(const ex_worker_t *worker, const family_t *family, uint32_t a, uint32_t b)
{
    const unsigned char *const buffer = worker->exchange->buffer;
    int order = 0;
    for (uint32_t k = 0U; (order == 0) && (k < family->places); k++) {
        const span_t *const x = &worker->exchange->span[(a * family->places) + k];
        const span_t *const y = &worker->exchange->span[(b * family->places) + k];
        order = (x->length != y->length) ? ((x->length < y->length) ? -1 : 1)
                                         : memcmp(&buffer[x->at], &buffer[y->at], x->length);
    }
    return order;
}

/* Puts a content into a place. */
static bool take_content(ex_worker_t *worker, uint32_t place, void *marking, const span_t *span)
{
    const bool is_fine = pn_multiset_decode(&worker->cx, pn_net.place[place].multiset, marking,
                                            &worker->exchange->buffer[span->at], span->length)
                         != SIZE_MAX;
    if (!is_fine) {
        ex_fail(worker, -1);
    }
    return is_fine;
}

/* Sorts the parts of a family; equal ones stay in their order. */
static bool sort_family(ex_worker_t *worker, const family_t *family, uint32_t *order, void *marking)
{
    bool is_sorted = true;
    if (!put_family(worker, family, marking)) {
        return false;
    }
    for (uint32_t i = 0U; i < family->parts; i++) {
        uint32_t at = i;
        for (; (at > 0U) && (order_of(worker, family, order[at - 1U], i) > 0); at--) {
            order[at] = order[at - 1U];
        }
        order[at] = i;
        is_sorted = is_sorted && (at == i);
    }
    bool is_fine = true;
    for (uint32_t i = 0U; is_fine && !is_sorted && (i < family->parts); i++) {
        for (uint32_t k = 0U; is_fine && (order[i] != i) && (k < family->places); k++) {
            const span_t *const span = &worker->exchange->span[(order[i] * family->places) + k];
            is_fine = take_content(worker, family->place[(i * family->places) + k], marking, span);
        }
    }
    return is_fine;
}

const void *ex_instances_canonical(ex_worker_t *worker, const void *marking)
{
    struct ex_exchange *const own = worker->exchange;
    bool is_fine = true;
    (void)memcpy(own->marking, marking, pn_net.marking_size);
    for (uint32_t f = 0U; is_fine && (f < own->of->families); f++) {
        is_fine = sort_family(worker, &own->of->family[f], &own->order[f * own->of->most_parts], own->marking);
    }
    return is_fine ? own->marking : NULL;
}

bool ex_instances_are_even(ex_worker_t *worker, const void *marking)
{
    const struct ex_instances *const of = worker->exchange->of;
    bool is_even = true;
    for (uint32_t f = 0U; is_even && (f < of->families); f++) {
        is_even = put_family(worker, &of->family[f], marking);
        for (uint32_t i = 1U; is_even && (i < of->family[f].parts); i++) {
            is_even = order_of(worker, &of->family[f], 0U, i) == 0;
        }
    }
    return is_even;
}

/* --- runs --------------------------------------------------------------------------------------------------------- */

void ex_instances_start(ex_worker_t *worker)
{
    for (uint32_t i = 0U; i < pn_net.place_count; i++) {
        worker->exchange->place[i] = i;
    }
    for (uint32_t i = 0U; i < pn_net.transition_count; i++) {
        worker->exchange->transition[i] = i;
    }
}

/* What was at part order[i] is at part i now. */
static void exchange(uint32_t *of, uint32_t *moved, const uint32_t *node, uint32_t parts, uint32_t nodes,
                     const uint32_t *order)
{
    for (uint32_t i = 0U; i < parts; i++) {
        for (uint32_t k = 0U; k < nodes; k++) {
            moved[(i * nodes) + k] = of[node[(order[i] * nodes) + k]];
        }
    }
    for (uint32_t i = 0U; i < (parts * nodes); i++) {
        of[node[i]] = moved[i];
    }
}

void ex_instances_follow(ex_worker_t *worker)
{
    struct ex_exchange *const own = worker->exchange;
    for (uint32_t f = 0U; f < own->of->families; f++) {
        const family_t *const family = &own->of->family[f];
        const uint32_t *const order = &own->order[f * own->of->most_parts];
        exchange(own->place, own->moved, family->place, family->parts, family->places, order);
        exchange(own->transition, own->moved, family->transition, family->parts, family->transitions, order);
    }
}

uint32_t ex_instances_real(const ex_worker_t *worker, uint32_t transition)
{
    return worker->exchange->transition[transition];
}

bool ex_instances_restore(ex_worker_t *worker)
{
    struct ex_exchange *const own = worker->exchange;
    bool is_fine = true;
    (void)memcpy(own->marking, worker->marking, pn_net.marking_size);
    for (uint32_t i = 0U; is_fine && (i < pn_net.place_count); i++) {
        span_t span;
        is_fine = (own->place[i] == i)
                  || ((put_content(worker, i, own->marking, 0U, &span) != SIZE_MAX)
                      && take_content(worker, own->place[i], worker->marking, &span));
    }
    ex_unload(worker);
    return is_fine;
}
