/* SPDX-License-Identifier: MIT
 * explore_roots.c - references that the net changes, as a part of the state.
 *
 * They are variables of C, and what they refer to lies here in an arena of its own. A state is loaded, and restored
 * after each occurrence, by decoding the same bytes into the same empty arena: so everything gets the address that it
 * had, and what a search for bindings has read from references before stays good.
 */
#include "../explore_run.h"
#include "explore_roots.h"
#include "explore_multiset.h"

#include "pn/pn_arena.h"
#include "pn/pn_root.h"

bool ex_roots_make(ex_worker_t *worker)
{
    const uint64_t size = worker->run->options.arena;
    if (pn_net.root_count == 0U) {
        return true;
    }
    void *const memory = ex_reserve(size);
    if (memory == NULL) {
        return false;
    }
    pn_arena_init(&worker->scratch->roots, memory, (size_t)size);
    return true;
}

bool ex_roots_number(ex_worker_t *worker, uint32_t *number)
{
    ex_scratch_t *const scratch = worker->scratch;
    size_t length = pn_roots_encode(pn_net.root, pn_net.root_count, scratch->buffer, scratch->buffer_size);
    while (length > scratch->buffer_size) {
        if (!ex_buffer_grow(worker, length)) {
            return false;
        }
        length = pn_roots_encode(pn_net.root, pn_net.root_count, scratch->buffer, scratch->buffer_size);
    }
    return ex_intern(worker, pn_net.place_count, scratch->buffer, length, number);
}

bool ex_roots_load(ex_worker_t *worker, uint32_t number)
{
    const ex_bytes_t *const bytes = &worker->run->codec->bytes;
    pn_arena_t *const arena = worker->cx.arena;
    pn_arena_reset(&worker->scratch->roots);
    worker->cx.arena = &worker->scratch->roots;
    const bool is_fine = pn_roots_decode(&worker->cx, pn_net.root, pn_net.root_count,
                                         &bytes->byte[bytes->of[number].offset], bytes->of[number].length);
    worker->cx.arena = arena;
    return is_fine;
}

bool ex_roots_restore(ex_worker_t *worker)
{
    const bool is_fine = !worker->failed && (worker->cx.error == PN_OK)
                         && ex_roots_load(worker, worker->scratch->cell[worker->run->codec->root_word]);
    if (!is_fine) {
        worker->scratch->decoded[worker->run->codec->root_word - worker->run->codec->packed_words] = EX_NO_NUMBER;
    }
    if (!is_fine && !worker->failed) {
        ex_fail(worker, -1);
    }
    return is_fine;
}
