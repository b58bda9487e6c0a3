/* SPDX-License-Identifier: MIT
 * explore_sweep.c - the search that forgets what lies behind it.
 *
 * Each state has a measure: weights of its tokens, and its time. States wait by their measure, and those with the least
 * one are expanded first. If no step makes it smaller, nobody comes back to a state with a smaller one than that of the
 * state at hand, so such states need not be known any more (S. Christensen, L. M. Kristensen, T. Mailund, A sweep-line
 * method for state space exploration, 2001). They leave the store when it would have to grow otherwise.
 *
 * What is said does not rest on the table: the measure of each state that the store does not know is computed. Where it
 * is smaller than that of the state at hand, the table is wrong, and the run ends with an error: the state may have
 * been forgotten. A state that the store does know has been expanded, or waits.
 */
#define _POSIX_C_SOURCE 200809L

#include "explore_sweep.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "../explore_bounds.h"
#include "../../marking/pn_multiset_impl.h"
#include "../search/explore_search.h"
#include "pn/pn_marking.h"
#include "pn/pn_packed.h"
#include "pn/pn_text.h"

#define MOST_DEAD  1000U      /* dead states to which there may be runs */
#define FIRST_ROOM 64U        /* of lists that grow */
#define NOWHERE    UINT64_MAX /* no state */
#define TEMPORARY  "/var/tmp" /* files that are large, where nothing else is said */

/* States of one measure: chunks from the first to the last. */
typedef struct group {
    int64_t measure;
    uint64_t count;
    ex_chunk_t *first;
    ex_chunk_t *last;
} group_t;

/* Of a token; or of the number in it, which is so far from its beginning. */
typedef struct weight {
    uint32_t place;
    int64_t each;
    bool is_of_value;
    size_t offset;
} weight_t;

struct ex_sweep {
    weight_t *weight;
    uint32_t weights;
    bool counts_time;
    bool needs_places; /* some place that counts is not packed */
    group_t *group;    /* by their measure */
    uint64_t groups;
    uint64_t group_room;
    ex_key_t *fresh; /* found from the state at hand, not measured yet */
    uint64_t fresh_count;
    uint64_t fresh_room;
    ex_sweep_log_t log;
    uint32_t length; /* bytes of a key */
    uint64_t at;     /* number of the state at hand */
    ex_key_t key;
    int64_t measure; /* of it */
    ex_chunk_t *expanding;
    uint64_t live; /* states that are known: they wait, or have the measure at hand */
    uint64_t most_live;
    uint64_t layers; /* different measures that were looked at */
    uint64_t forgettings;
    _Atomic uint64_t found; /* states */
    uint64_t *decided;      /* by question: the state that decides it */
    uint64_t dead[MOST_DEAD];
    uint64_t dead_count;
};

/* --- the table ---------------------------------------------------------------------------------------------------- */

/* The number in a value: "=", it is one; else the component with that label is. False: there is none. */
static bool find_number(const pn_type_t *type, const char *label, size_t *offset)
{
    *offset = 0U;
    if (strcmp(label, "=") == 0) {
        return type->kind == PN_KIND_INT;
    }
    for (uint32_t i = 0U; (type->kind == PN_KIND_RECORD) && (i < type->count); i++) {
        if (strcmp(type->field[i].label, label) == 0) {
            *offset = type->field[i].offset;
            return type->field[i].type->kind == PN_KIND_INT;
        }
    }
    return false;
}

/* A line without its end. */
static bool add_weight(ex_sweep_t *sweep, const char *line)
{
    char *end = NULL;
    errno = 0;
    const unsigned long place = strtoul(line, &end, 10);
    const long long each = strtoll(end, &end, 10);
    weight_t *const more = realloc(sweep->weight, ((size_t)sweep->weights + 1U) * sizeof *more);
    sweep->weight = (more != NULL) ? more : sweep->weight;
    if ((more == NULL) || (errno != 0) || (place >= pn_net.place_count) || ((*end != ' ') && (*end != '\0'))) {
        return false;
    }
    weight_t *const own = &more[sweep->weights];
    *own = (weight_t){ .place = (uint32_t)place, .each = each, .is_of_value = *end == ' ' };
    if (own->is_of_value && !find_number(pn_net.place[place].multiset->type, &end[1], &own->offset)) {
        return false;
    }
    sweep->weights++;
    sweep->needs_places = sweep->needs_places || !pn_net.place[place].multiset->is_packed;
    return true;
}

bool ex_sweep_read(ex_run_t *run)
{
    char line[256];
    ex_sweep_t *const sweep = calloc(1U, sizeof *sweep);
    FILE *const file = fopen(run->options.sweep, "r");
    bool is_fine = (sweep != NULL) && (file != NULL);
    while (is_fine && (fgets(line, (int)sizeof line, file) != NULL)) {
        line[strcspn(line, "\n")] = '\0';
        const bool is_time = strcmp(line, "time") == 0;
        sweep->counts_time = sweep->counts_time || (is_time && !pn_net.real_time);
        is_fine = is_time || add_weight(sweep, line);
    }
    if (file != NULL) {
        (void)fclose(file);
    }
    if (!is_fine) {
        (void)fprintf(stderr, "explore: wrong table of weights: `%s`\n", run->options.sweep);
    }
    run->sweep = sweep;
    return is_fine;
}

/* --- the measure -------------------------------------------------------------------------------------------------- */

/* A sum that is too large stays the largest one: that is no worse a measure, and what is wrong is found out. */
static int64_t added(int64_t a, int64_t b)
{
    int64_t sum = 0;
    if (!__builtin_add_overflow(a, b, &sum)) {
        return sum;
    }
    return (b > 0) ? INT64_MAX : INT64_MIN;
}

static int64_t product(uint64_t count, int64_t each)
{
    int64_t found = 0;
    if ((count <= (uint64_t)INT64_MAX) && !__builtin_mul_overflow((int64_t)count, each, &found)) {
        return found;
    }
    return (each > 0) ? INT64_MAX : INT64_MIN;
}

/* The number in so many equal tokens. */
static int64_t numbers(const weight_t *weight, const void *value, uint64_t count)
{
    int64_t number = 0;
    (void)memcpy(&number, (const unsigned char *)value + weight->offset, sizeof number);
    return product(count, number);
}

/* The sum of the numbers in the tokens of a place. */
static int64_t sum_of(const weight_t *weight, const void *marking)
{
    const pn_multiset_t *const multiset = pn_net.place[weight->place].multiset;
    const uint64_t *const word = marking;
    int64_t sum = 0;
    for (uint32_t i = 0U; multiset->is_packed && (i < multiset->colours); i++) {
        const uint32_t count = pn_counter(word, multiset->bit, multiset->width, i);
        if (count > 0U) {
            pn_colour_t colour;
            multiset->colour_of(i, &colour);
            sum = added(sum, numbers(weight, &colour, count));
        }
    }
    for (uint32_t i = 0U; !multiset->is_packed && (i < pn_multiset_used(multiset, marking)); i++) {
        const unsigned char *const entry = pn_multiset_entry(multiset, marking, i);
        sum = added(sum, numbers(weight, &entry[multiset->value], pn_multiset_count_of(multiset, entry)));
    }
    return sum;
}

/* Of a state, which is loaded for it. False after an error. */
static bool measure_of(ex_worker_t *worker, const ex_key_t *key, int64_t *measure)
{
    const ex_sweep_t *const sweep = worker->run->sweep;
    if (!(sweep->needs_places ? ex_load(worker, key) : ex_open(worker, key))) {
        return false;
    }
    *measure = sweep->counts_time ? pn_now(&pn_net, worker->marking).integer : 0;
    for (uint32_t i = 0U; i < sweep->weights; i++) {
        const weight_t *const weight = &sweep->weight[i];
        if (weight->is_of_value) {
            const int64_t sum = sum_of(weight, worker->marking);
            const uint64_t size = (sum < 0) ? (0U - (uint64_t)sum) : (uint64_t)sum;
            *measure = added(*measure, product(size, (sum < 0) ? -weight->each : weight->each));
        } else {
            const pn_multiset_t *const multiset = pn_net.place[weight->place].multiset;
            *measure = added(*measure, product(pn_multiset_total(multiset, worker->marking), weight->each));
        }
    }
    return true;
}

/* --- states that wait --------------------------------------------------------------------------------------------- */

/* Twice the room of a list, when it is full; its pages are counted. NULL: no memory. */
static void *grown(ex_memory_t *memory, void *list, uint64_t count, uint64_t *room, uint64_t size)
{
    if (count < *room) {
        return list;
    }
    const uint64_t larger = (*room == 0U) ? FIRST_ROOM : (*room * 2U);
    void *const new = ex_alloc(memory, larger * size);
    if (new == NULL) {
        return NULL;
    }
    if (list != NULL) {
        (void)memcpy(new, list, count * size);
        ex_free(memory, list, *room * size);
    }
    *room = larger;
    return new;
}

/* The group of a measure; a new one if there is none. NULL: no memory. */
static group_t *group_of(ex_run_t *run, int64_t measure)
{
    ex_sweep_t *const sweep = run->sweep;
    uint64_t low = 0U;
    uint64_t high = sweep->groups;
    while (low < high) {
        const uint64_t middle = (low + high) / 2U;
        if (sweep->group[middle].measure < measure) {
            low = middle + 1U;
        } else {
            high = middle;
        }
    }
    if ((low < sweep->groups) && (sweep->group[low].measure == measure)) {
        return &sweep->group[low];
    }
    group_t *const group = grown(&run->memory, sweep->group, sweep->groups, &sweep->group_room, sizeof *sweep->group);
    if (group == NULL) {
        return NULL;
    }
    sweep->group = group;
    (void)memmove(&group[low + 1U], &group[low], (sweep->groups - low) * sizeof *group);
    group[low] = (group_t){ .measure = measure };
    sweep->groups++;
    return &group[low];
}

static uint32_t stride_of(const ex_sweep_t *sweep)
{
    return sweep->length + EX_INDEX_BYTES;
}

static uint64_t get(const ex_sweep_t *sweep, const ex_chunk_t *chunk, uint32_t i, ex_key_t *key)
{
    const unsigned char *const at = &chunk->byte[(size_t)i * stride_of(sweep)];
    uint64_t index = 0U;
    *key = (ex_key_t){ 0U, 0U };
    (void)memcpy(key, at, sweep->length);
    (void)memcpy(&index, &at[sweep->length], EX_INDEX_BYTES);
    return index;
}

/* A state with its measure. False: no memory. */
static bool wait_for(ex_run_t *run, const ex_key_t *key, int64_t measure, uint64_t index)
{
    ex_sweep_t *const sweep = run->sweep;
    group_t *const group = group_of(run, measure);
    const uint32_t stride = stride_of(sweep);
    if (group == NULL) {
        ex_stop(run, EX_MEMORY);
        return false;
    }
    if ((group->last == NULL)
        || (((group->last->count + 1U) * stride) > ((size_t)EX_CHUNK_SIZE - sizeof(ex_chunk_t)))) {
        ex_chunk_t *const chunk = ex_chunk_new(run->level);
        if (chunk == NULL) {
            return false;
        }
        if (group->last == NULL) {
            group->first = chunk;
        } else {
            group->last->next = chunk;
        }
        group->last = chunk;
    }
    unsigned char *const at = &group->last->byte[(size_t)group->last->count * stride];
    (void)memcpy(at, key, sweep->length);
    (void)memcpy(&at[sweep->length], &index, EX_INDEX_BYTES);
    group->last->count++;
    group->count++;
    sweep->live++;
    sweep->most_live = (sweep->live > sweep->most_live) ? sweep->live : sweep->most_live;
    return true;
}

bool ex_sweep_begin(ex_run_t *run)
{
    ex_sweep_t *const sweep = run->sweep;
    const ex_options_t *const options = &run->options;
    const char *folder = (options->spill != NULL) ? options->spill : getenv("TMPDIR");
    const uint64_t questions = (run->queries != NULL) ? run->queries->questions : 0U;
    folder = ((folder != NULL) && (folder[0] != '\0')) ? folder : TEMPORARY;
    sweep->length = run->codec->roots * (uint32_t)sizeof(uint32_t);
    if ((options->trace_to != NULL) || (options->error_trace_to != NULL) || (options->query_trace_to != NULL)) {
        ex_sweep_log_open(&sweep->log, folder, sweep->length);
    }
    sweep->decided = ex_table(&run->memory, questions, sizeof *sweep->decided);
    if (sweep->decided == NULL) {
        ex_stop(run, EX_MEMORY);
        return false;
    }
    for (uint64_t i = 0U; i < questions; i++) {
        sweep->decided[i] = NOWHERE;
    }
    if (!measure_of(&run->worker[0], &run->initial, &sweep->measure)) {
        return false;
    }
    ex_sweep_log_add(&sweep->log, &run->initial, 0U);
    atomic_store(&sweep->found, 1U);
    return wait_for(run, &run->initial, sweep->measure, 0U);
}

bool ex_sweep_found(ex_run_t *run, const ex_key_t *key)
{
    ex_sweep_t *const sweep = run->sweep;
    ex_key_t *const fresh =
        grown(&run->memory, sweep->fresh, sweep->fresh_count, &sweep->fresh_room, sizeof *sweep->fresh);
    if (fresh == NULL) {
        ex_stop(run, EX_MEMORY);
        return false;
    }
    sweep->fresh = fresh;
    fresh[sweep->fresh_count] = *key;
    sweep->fresh_count++;
    return true;
}

/* The table is wrong: what is behind may have been forgotten, and nothing is known. */
static void fall_back(ex_run_t *run)
{
    (void)snprintf(run->error.message, sizeof run->error.message, "the measure of progress becomes smaller");
    run->error.where[0] = '\0';
    run->error.kind = "sweep";
    run->error.place = -1;
    run->error.transition = -1;
    ex_stop(run, EX_ERROR);
}

/* What was found from the state at hand waits. False when the run stops. */
static bool settle(ex_worker_t *worker)
{
    ex_run_t *const run = worker->run;
    ex_sweep_t *const sweep = run->sweep;
    bool goes_on = true;
    for (uint64_t i = 0U; goes_on && (i < sweep->fresh_count); i++) {
        const ex_key_t *const key = &sweep->fresh[i];
        const uint64_t index = atomic_load_explicit(&sweep->found, memory_order_relaxed);
        int64_t measure = 0;
        if (index >= run->options.max_states) {
            ex_stop(run, EX_STATES);
            return false;
        }
        if (!measure_of(worker, key, &measure)) {
            return false;
        }
        if (measure < sweep->measure) {
            fall_back(run);
            return false;
        }
        ex_sweep_log_add(&sweep->log, key, sweep->at);
        atomic_store_explicit(&sweep->found, index + 1U, memory_order_relaxed);
        goes_on = wait_for(run, key, measure, index);
    }
    sweep->fresh_count = 0U;
    return goes_on;
}

/* --- forgetting --------------------------------------------------------------------------------------------------- */

/* Into an empty store. Keys do not become wider, so there is room for them. */
static bool know(ex_run_t *run, const ex_key_t *key)
{
    if (ex_store_insert(&run->store, key, ex_hash(key), NULL) != EX_NEW) {
        ex_stop(run, EX_MEMORY);
        return false;
    }
    return true;
}

/* The store holds what waits, what has the measure at hand, and what was found just now. False: the run stops. */
static bool refill(ex_run_t *run)
{
    ex_sweep_t *const sweep = run->sweep;
    ex_store_empty(&run->store);
    sweep->forgettings++;
    bool is_fine = true;
    for (uint64_t g = 0U; g < sweep->groups; g++) {
        for (const ex_chunk_t *chunk = sweep->group[g].first; is_fine && (chunk != NULL); chunk = chunk->next) {
            for (uint32_t i = 0U; is_fine && (i < chunk->count); i++) {
                ex_key_t key;
                (void)get(sweep, chunk, i, &key);
                is_fine = know(run, &key);
            }
        }
    }
    for (uint64_t i = 0U; is_fine && (i < sweep->fresh_count); i++) {
        is_fine = know(run, &sweep->fresh[i]);
    }
    atomic_store(&run->store.used, sweep->live + sweep->fresh_count);
    return is_fine;
}

bool ex_sweep_forget(ex_run_t *run)
{
    const ex_sweep_t *const sweep = run->sweep;
    const ex_store_t *const store = &run->store;
    const uint64_t used = atomic_load(&store->used);
    const uint64_t kept = sweep->live + sweep->fresh_count;
    const bool is_worth_it = ((used - kept) * 4U) >= used;
    const bool may_grow = ex_has_room(&run->memory, ex_store_bytes(store) / 2U);
    if (!is_worth_it && (may_grow || ((used - kept) < (4U * EX_SPARE_KEYS)))) {
        return false;
    }
    return refill(run) && ((kept + (2U * (uint64_t)EX_BATCH)) <= store->limit);
}

/* As soon as it can be, and nothing is remembered in any other way, so that what is wrong is found out. */
static bool forget_at_once(ex_worker_t *worker)
{
    (void)memset(worker->search->recent, 0, sizeof worker->search->recent);
    return refill(worker->run);
}

/* The group with the least measure, all of which has been expanded. */
static void drop_first(ex_run_t *run)
{
    ex_sweep_t *const sweep = run->sweep;
    ex_chunk_t *chunk = sweep->group[0].first;
    while (chunk != NULL) {
        ex_chunk_t *const next = chunk->next;
        chunk->next = run->level->spare;
        run->level->spare = chunk;
        chunk = next;
    }
    sweep->live -= sweep->group[0].count;
    sweep->groups--;
    (void)memmove(&sweep->group[0], &sweep->group[1], sweep->groups * sizeof *sweep->group);
}

/* --- the loop ----------------------------------------------------------------------------------------------------- */

static void replace_waiting(ex_run_t *run, ex_replace_t one, const void *layout)
{
    ex_sweep_t *const sweep = run->sweep;
    for (uint64_t g = 0U; g < sweep->groups; g++) {
        for (ex_chunk_t *chunk = sweep->group[g].first; chunk != NULL; chunk = chunk->next) {
            for (uint32_t i = 0U; i < chunk->count; i++) {
                ex_key_t key;
                (void)get(sweep, chunk, i, &key);
                one(layout, &key);
                (void)memcpy(&chunk->byte[(size_t)i * stride_of(sweep)], &key, sweep->length);
            }
        }
    }
    ex_sweep_log_replace(&sweep->log, one, layout);
}

/* As in explore_search.c, when there are enough states to see how they are stored best. */
static bool lay_again(ex_worker_t *worker)
{
    ex_run_t *const run = worker->run;
    if (run->is_laid_again || (ex_sweep_states(run) < run->options.lay_again)) {
        return true;
    }
    run->is_laid_again = true;
    if (!ex_layout_again(run, replace_waiting)) {
        ex_stop(run, EX_MEMORY);
        return false;
    }
    ex_unload(worker);
    ex_flat_lay(worker);
    (void)memset(worker->search->recent, 0, sizeof worker->search->recent);
    return true;
}

static bool expand_group(ex_worker_t *worker)
{
    ex_run_t *const run = worker->run;
    ex_sweep_t *const sweep = run->sweep;
    sweep->measure = sweep->group[0].measure;
    sweep->layers++;
    /* It grows at its end while it is expanded. */
    for (ex_chunk_t *chunk = sweep->group[0].first; chunk != NULL; chunk = chunk->next) {
        for (chunk->taken = 0U; chunk->taken < chunk->count; chunk->taken++) {
            sweep->at = get(sweep, chunk, chunk->taken, &sweep->key);
            if (ex_is_stopping(run) || !ex_expand_state(worker, &sweep->key) || !ex_flush_all(worker)
                || !settle(worker)) {
                return false;
            }
        }
    }
    return true;
}

void ex_sweep_work(ex_worker_t *worker, void *user)
{
    ex_run_t *const run = worker->run;
    ex_sweep_t *const sweep = run->sweep;
    (void)user;
    bool goes_on = true;
    while (goes_on && (sweep->groups > 0U) && lay_again(worker) && expand_group(worker)) {
        drop_first(run);
        goes_on = !run->options.is_forgetful || forget_at_once(worker);
    }
}

uint64_t ex_sweep_states(const ex_run_t *run)
{
    return atomic_load_explicit(&run->sweep->found, memory_order_relaxed);
}

bool ex_sweep_see_rest(ex_run_t *run)
{
    const ex_sweep_t *const sweep = run->sweep;
    ex_worker_t *const worker = &run->worker[0];
    for (uint64_t g = 0U; g < sweep->groups; g++) {
        for (const ex_chunk_t *chunk = sweep->group[g].first; chunk != NULL; chunk = chunk->next) {
            if (ex_is_late(run)) {
                return false;
            }
            for (uint32_t i = chunk->taken; i < chunk->count; i++) {
                ex_key_t key;
                (void)get(sweep, chunk, i, &key);
                if (ex_load(worker, &key)) {
                    ex_bounds_see(worker);
                }
            }
        }
    }
    return true;
}

/* --- what was found ----------------------------------------------------------------------------------------------- */

void ex_sweep_dead(ex_run_t *run)
{
    ex_sweep_t *const sweep = run->sweep;
    if ((run->options.trace_to != NULL) && (sweep->dead_count < run->options.traces)
        && (sweep->dead_count < (uint64_t)MOST_DEAD)) {
        sweep->dead[sweep->dead_count] = sweep->at;
        sweep->dead_count++;
    }
}

void ex_sweep_decided(const ex_run_t *run, uint32_t question)
{
    run->sweep->decided[question] = run->sweep->at;
}

ex_key_t ex_sweep_at(const ex_run_t *run)
{
    return run->sweep->key;
}

/* A run to a state. */
static int64_t write_to(ex_run_t *run, uint64_t index, const char *path, const char *why)
{
    uint64_t steps = 0U;
    ex_key_t *const way = ex_sweep_log_way(&run->sweep->log, index, &steps);
    const int64_t written = (way != NULL) ? ex_write_keys(run, way, steps, path, why) : -1;
    free(way);
    return written;
}

int64_t ex_sweep_write(ex_run_t *run, const char *path, const char *why)
{
    return write_to(run, run->sweep->at, path, why);
}

void ex_sweep_answer(ex_run_t *run)
{
    for (uint32_t i = 0U; (run->options.query_trace_to != NULL) && (i < run->queries->questions); i++) {
        ex_question_t *const question = &run->queries->question[i];
        const uint64_t index = run->sweep->decided[i];
        if ((index != NOWHERE) && !atomic_load(&question->is_raised)) {
            char path[EX_PATH_SIZE];
            (void)snprintf(path, sizeof path, "%s%" PRIu32 ".trace.jsonl", run->options.query_trace_to, i);
            question->steps = write_to(run, index, path, "steps");
        }
    }
}

void ex_sweep_traces_json(ex_run_t *run, FILE *out)
{
    const ex_sweep_t *const sweep = run->sweep;
    uint64_t written = 0U;
    (void)fprintf(out, "\"traces\": [");
    for (uint64_t i = 0U; i < sweep->dead_count; i++) {
        char path[EX_PATH_SIZE];
        char quoted[2U * sizeof path];
        (void)snprintf(path, sizeof path, "%s%" PRIu64 ".trace.jsonl", run->options.trace_to, i);
        const int64_t steps = write_to(run, sweep->dead[i], path, "finished");
        if (steps >= 0) {
            pn_text_t text;
            pn_text_init(&text, quoted, sizeof quoted);
            pn_text_json_str(&text, path);
            (void)fprintf(out, "%s{\"node\": 0, \"file\": %s, \"steps\": %" PRId64 "}", (written > 0U) ? ", " : "",
                          quoted, steps);
            written++;
        }
    }
    (void)fprintf(out, "]");
}

void ex_sweep_json(const ex_run_t *run, FILE *out)
{
    const ex_sweep_t *const sweep = run->sweep;
    (void)fprintf(out,
                  ",\n \"sweep\": {\"layers\": %" PRIu64 ", \"most_known\": %" PRIu64 ", \"forgettings\": %" PRIu64
                  ", \"runs_lost\": %s}",
                  sweep->layers, sweep->most_live, sweep->forgettings, sweep->log.is_lost ? "true" : "false");
}
