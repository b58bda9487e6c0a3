/* SPDX-License-Identifier: MIT
 * explore_wake.c - when the time has to go on to, noted by what places hold.
 *
 * When nothing is enabled, the time goes on to the earliest stamp after it. Most places of a marking hold what they
 * held in many others, so this is noted for each multi-set, which need not be decoded then.
 */
#include "explore_local.h"

#include "pn/pn_multiset.h"

enum { WAKES = 1 << 12 };

/* When tokens of a timed place become available: after each time in from .. next the next ones do at `next`. */
struct ex_wake {
    uint32_t multiset; /* its number + 1; 0: none */
    bool is_some;      /* otherwise there are none after `from` */
    pn_time_t from;
    pn_time_t next;
};

/* Whether each timed place can say for itself when its tokens become available. */
static bool has_wakes(void)
{
    return pn_net.timed && (pn_net.thresholds == NULL);
}

bool ex_wakes_make(ex_worker_t *worker)
{
    if (!has_wakes()) {
        return true;
    }
    worker->wake = ex_alloc(&worker->run->memory, (uint64_t)WAKES * sizeof *worker->wake);
    return worker->wake != NULL;
}

/* What is known of a place's multi-set at a time, found out if need be. NULL: an error. */
static const ex_wake_t *wake_of(ex_worker_t *worker, uint32_t place, uint32_t number, pn_time_t now)
{
    ex_wake_t *wake = &worker->wake[number % (uint32_t)WAKES];
    if ((wake->multiset == (number + 1U)) && (pn_time_order(pn_net.real_time, wake->from, now) <= 0)
        && (!wake->is_some || (pn_time_order(pn_net.real_time, now, wake->next) < 0))) {
        return wake;
    }
    if (!ex_load_place(worker, place, number)) {
        return NULL;
    }
    *wake = (ex_wake_t){ .multiset = number + 1U, .from = now };
    pn_multiset_next_time(pn_net.place[place].multiset, worker->marking, now, &wake->is_some, &wake->next);
    return wake;
}

bool ex_next_time(ex_worker_t *worker, pn_time_t *next)
{
    const ex_codec_t *codec = worker->run->codec;
    bool is_some = false;
    if (worker->wake == NULL) {
        return ex_load_places(worker) && pn_next_time(&pn_net, &worker->cx, worker->marking, next);
    }
    const pn_time_t now = pn_now(&pn_net, worker->marking);
    for (uint32_t w = codec->packed_words; w < codec->words; w++) {
        const bool is_place = (w != codec->time_word) && (w != codec->root_word);
        const uint32_t place = is_place ? codec->place_of[w - codec->packed_words] : 0U;
        if (!is_place || !pn_net.place[place].multiset->is_timed) {
            continue;
        }
        const ex_wake_t *wake = wake_of(worker, place, worker->scratch->cell[w], now);
        if (wake == NULL) {
            return false;
        }
        if (wake->is_some && (!is_some || (pn_time_order(pn_net.real_time, wake->next, *next) < 0))) {
            *next = wake->next;
            is_some = true;
        }
    }
    return is_some;
}
