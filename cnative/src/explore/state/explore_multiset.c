/* SPDX-License-Identifier: MIT
 * explore_multiset.c - numbers for what places hold that are not packed.
 *
 * In a timed place the same values come with ever new stamps. So where the values are long they are a string of their
 * own, and what the place holds is the number of that string and the stamps. Real stamps, of which hardly any is short,
 * are numbers of strings, too: most of them are in many multi-sets.
 */
#include "../explore_run.h"
#include "explore_multiset.h"

#include <stdlib.h>
#include <string.h>

#include "pn/pn_multiset.h"
#include "../../value/pn_bytes_impl.h"

enum {
    LONG_VALUES = 24, /* bytes of values from which on they are stored apart */
    SHORT_STAMP = 4,  /* bytes of a real up to which it stays as it is */
    LONGEST_STAMP = 9 /* with the byte that says how many follow; so what is not less is none */
};

#define APART ((uint32_t)1U << 31U) /* with it: the number of the values, instead of their length */
#define EX_VALUES \
    (EX_ADDED + pn_net.place_count) /* kinds of strings, beside those of multi-sets: the values of a place, */
#define EX_STAMP (EX_VALUES + pn_net.place_count) /* and stamps */

bool ex_buffer_grow(ex_worker_t *worker, size_t size)
{
    ex_scratch_t *scratch = worker->scratch;
    unsigned char *larger = ex_alloc(&worker->run->memory, size * 2U);
    if (larger == NULL) {
        ex_stop(worker->run, EX_MEMORY);
        worker->failed = true;
        return false;
    }
    ex_free(&worker->run->memory, scratch->buffer, scratch->buffer_size);
    scratch->buffer = larger;
    scratch->buffer_size = size * 2U;
    return true;
}

bool ex_intern(ex_worker_t *worker, uint32_t kind, const unsigned char *byte, size_t length, uint32_t *number)
{
    ex_bytes_t *bytes = &worker->run->codec->bytes;
    for (;;) {
        *number = ex_bytes_number(bytes, kind, byte, (uint32_t)length);
        if (*number != EX_NO_NUMBER) {
            return true;
        }
        if (!ex_pause(worker)) {
            worker->failed = true;
            return false;
        }
    }
}

/* --- stamps ------------------------------------------------------------------------------------------------------- */

/* Real stamps in the buffer, from..*length, become shorter: each long one the number of a string. */
static bool shorten_stamps(ex_worker_t *worker, size_t from, size_t *length)
{
    unsigned char *buffer = worker->scratch->buffer;
    size_t end = from;
    size_t at = from;
    while (at < *length) {
        const size_t size = 1U + (size_t)buffer[at];
        if (size <= (1U + (size_t)SHORT_STAMP)) {
            (void)memmove(&buffer[end], &buffer[at], size);
            end += size;
        } else {
            uint32_t number = 0U;
            if (!ex_intern(worker, EX_STAMP, &buffer[at], size, &number)) {
                return false;
            }
            end = put_number(buffer, *length, end,
                             (uint64_t)number + (uint64_t)LONGEST_STAMP); /* at most five bytes of six or more */
        }
        at += size;
    }
    *length = end;
    return true;
}

/* The other way round, appended to the buffer, which has room. Returns the end. */
static size_t restore_stamps(ex_worker_t *worker, size_t end, const unsigned char *in, size_t length)
{
    const ex_bytes_t *bytes = &worker->run->codec->bytes;
    unsigned char *buffer = worker->scratch->buffer;
    for (size_t at = 0U; at < length;) {
        const unsigned char *stamp = &in[at];
        size_t size = 1U + (size_t)in[at];
        if (in[at] < (unsigned char)LONGEST_STAMP) {
            at += size;
        } else {
            uint64_t number = 0U;
            (void)get_number(in, length, &at, &number);
            const ex_bytes_entry_t *of = &bytes->of[number - (uint64_t)LONGEST_STAMP];
            stamp = &bytes->byte[of->offset];
            size = of->length;
        }
        (void)memcpy(&buffer[end], stamp, size);
        end += size;
    }
    return end;
}

/* --- multi-sets --------------------------------------------------------------------------------------------------- */

/* The number of the multi-set of a timed place that is in the buffer. */
static bool intern_timed(ex_worker_t *worker, uint32_t place, uint32_t kind, size_t length, uint32_t *number)
{
    unsigned char *buffer = worker->scratch->buffer;
    uint32_t first = 0U;
    uint32_t values = 0U;
    (void)memcpy(&first, buffer, sizeof first);
    if (first < (uint32_t)LONG_VALUES) {
        return ex_intern(worker, kind, buffer, length, number);
    }
    if (!ex_intern(worker, EX_VALUES + place, buffer, first, &values)) {
        return false;
    }
    if ((values & APART) != 0U) {
        return ex_intern(worker, kind, buffer, length, number); /* there are too many of them */
    }
    if (pn_net.real_time && !shorten_stamps(worker, first, &length)) {
        return false;
    }
    values |= APART;
    const size_t from = first - sizeof values;
    (void)memcpy(&buffer[from], &values, sizeof values);
    return ex_intern(worker, kind, &buffer[from], length - from, number);
}

bool ex_heaps_make(ex_run_t *run)
{
    if (run->options.heaps == NULL) {
        return true;
    }
    run->codec->is_heap = ex_table(&run->memory, pn_net.place_count, sizeof(bool));
    for (uint32_t place = 0U; (run->codec->is_heap != NULL) && (place < pn_net.place_count); place++) {
        run->codec->is_heap[place] = ex_is_listed(run->options.heaps, place);
    }
    return run->codec->is_heap != NULL;
}

/* Tokens of one value are one entry however many there are: nothing is ever full. */
static bool is_heaped(const ex_run_t *run, uint32_t place, const void *marking)
{
    const bool *const is_heap = run->codec->is_heap;
    return (is_heap != NULL) && is_heap[place]
           && (pn_multiset_total(pn_net.place[place].multiset, marking) > run->options.most_heaped);
}

static void fail_heaped(ex_worker_t *worker, uint32_t place)
{
    ex_run_t *const run = worker->run;
    worker->failed = true;
    (void)pthread_mutex_lock(&run->error_lock);
    if (run->error.kind == NULL) {
        run->error.kind = "heap";
        run->error.place = (int64_t)place;
        run->error.transition = -1;
    }
    (void)pthread_mutex_unlock(&run->error_lock);
    ex_stop(run, EX_CAPACITY);
}

bool ex_number_place(ex_worker_t *worker, uint32_t place, uint32_t kind, const void *marking, uint32_t *number)
{
    ex_scratch_t *scratch = worker->scratch;
    if ((kind == place) && is_heaped(worker->run, place, marking)) {
        fail_heaped(worker, place);
        return false;
    }
    size_t length = pn_multiset_encode(pn_net.place[place].multiset, marking, scratch->buffer, scratch->buffer_size);
    while (length > scratch->buffer_size) {
        if (!ex_buffer_grow(worker, length)) {
            return false;
        }
        length = pn_multiset_encode(pn_net.place[place].multiset, marking, scratch->buffer, scratch->buffer_size);
    }
    return pn_net.place[place].multiset->is_timed ? intern_timed(worker, place, kind, length, number)
                                                  : ex_intern(worker, kind, scratch->buffer, length, number);
}

const unsigned char *ex_multiset_bytes(ex_worker_t *worker, uint32_t number, size_t *length)
{
    ex_scratch_t *scratch = worker->scratch;
    const ex_bytes_t *bytes = &worker->run->codec->bytes;
    const ex_bytes_entry_t *of = &bytes->of[number];
    const unsigned char *byte = &bytes->byte[of->offset];
    const uint32_t place = (of->place >= EX_ADDED) ? (of->place - EX_ADDED) : of->place;
    uint32_t values = 0U;
    *length = of->length;
    if (!pn_net.place[place].multiset->is_timed) {
        return byte;
    }
    (void)memcpy(&values, byte, sizeof values);
    if ((values & APART) == 0U) {
        return byte;
    }
    const ex_bytes_entry_t *first = &bytes->of[values & ~APART];
    const size_t stamps = of->length - sizeof values;
    const size_t most = first->length + (stamps * (size_t)LONGEST_STAMP);
    if ((most > scratch->buffer_size) && !ex_buffer_grow(worker, most)) {
        return NULL;
    }
    (void)memcpy(scratch->buffer, &bytes->byte[first->offset], first->length);
    if (pn_net.real_time) {
        *length = restore_stamps(worker, first->length, &byte[sizeof values], stamps);
    } else {
        (void)memcpy(&scratch->buffer[first->length], &byte[sizeof values], stamps);
        *length = first->length + stamps;
    }
    return scratch->buffer;
}
